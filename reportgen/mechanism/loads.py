"""Weights, inertia forces, and an inertia force and couple joined into one force."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from reportgen.mechanism.motion import Motion
from reportgen.mechanism.plane import Complexes, Floats, cross, solve2
from reportgen.mechanism.structure import Linkage


@dataclass(frozen=True, slots=True)
class Load:
    """A force (N) at a point (m) of a link, and a couple (N·m); arrays over positions [N]."""

    name: str
    link: int
    force: Complexes
    point: Complexes
    couple: Floats

    def moment(self, about: Complexes | complex) -> Floats:
        """Moment about a point: (point − about) × force + couple."""
        return cross(self.point - about, self.force) + self.couple


def weights(linkage: Linkage, motion: Motion) -> tuple[Load, ...]:
    """Weights m·g at the mass centres, named "G" and the link's number; a massless link has none."""
    still = np.zeros_like(motion.driver)
    return tuple(
        Load(
            f"G{body.link}",
            body.link,
            np.full(still.shape, body.mass * linkage.gravity, dtype=np.complex128),
            motion.points[body.centre].p,
            still,
        )
        for body in linkage.inertias
        if body.mass
    )


def inertia_loads(linkage: Linkage, motion: Motion) -> tuple[Load, ...]:
    """D'Alembert's loads −m a_S at S with the couple −J ε, named "Pqt" and the link's number."""
    return tuple(
        Load(
            f"Pqt{body.link}",
            body.link,
            -body.mass * motion.points[body.centre].a,
            motion.points[body.centre].p,
            -body.moment * motion.links[body.link].epsilon,
        )
        for body in linkage.inertias
        if body.mass or body.moment
    )


def as_single_force(load: Load, negligible: float = 0.0) -> Complexes:
    """Where a force F at S with couple M acts as the force alone: the point S − i F M / F².

    It lies at the distance |M|/|F| = J|ε|/(m|a_S|) from S, square to the force, on the side that gives
    M.  It is S itself where M = 0, and nan where |F| ≤ `negligible` (N) with M ≠ 0: a pure couple.
    """
    square = np.abs(load.force) ** 2
    with np.errstate(divide="ignore", invalid="ignore"):
        arm = -1j * load.force * (load.couple / np.where(square > negligible**2, square, np.nan))
    return np.where(load.couple == 0, load.point, load.point + arm)


def percussion_centre(l_as: float, mass: float, moment: float) -> float:
    """The distance from S to the centre of percussion K, l_SK = J/(m l_AS).

    Raises `ZeroDivisionError` for a massless link or A at S: there is no such point.
    """
    return moment / (mass * l_as)


def percussion_meeting(a: Complexes, s: Complexes, a_a: Complexes, a_s: Complexes, l_sk: float) -> Complexes:
    """The point Q on the line of a link's single inertia force, as it is found by drawing.

    Split a_S = a_A + a_SA: the part −m a_A acts along the line through S parallel to a_A, the part of
    the turning about A along the line through K parallel to a_SA, K on AS beyond S at `l_sk`.  The
    lines meet in Q; nan where they are parallel.  a, s in m, a_a, a_s in m/s².
    """
    k = s + (s - a) / np.abs(s - a) * l_sk
    along, _ = solve2(a_a, a_a - a_s, k - s)
    return s + along * a_a
