"""Weights and inertia forces, their work, and means over a turn."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from reportgen.mechanism.dyads import Complexes, Floats, cross, dot, solve2
from reportgen.mechanism.motion import Motion
from reportgen.mechanism.structure import Linkage

CONVERGED = 1e-12
ORDER = 16
MOST_PARTS = 4096


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


# --- work and means -------------------------------------------------------------------------------


def virtual_work_torque(linkage: Linkage, motion: Motion, loads: Sequence[Load]) -> Floats:
    """The driver's balancing torque M = −(ΣF·v + ΣMω)/ω₁ (N·m); with a sliding driver the force (N).

    Loads on links of `linkage` include inertia forces, so that this is D'Alembert's principle.
    Raises `ValueError` when the driver stands still.
    """
    if motion.rate == 0:
        raise ValueError("virtual work needs a moving driver")
    power = np.where(motion.reachable, 0.0, np.nan)
    for load in loads:
        moved = motion.of(load.link, load.point).v
        power = power + dot(load.force, moved) + load.couple * motion.links[load.link].omega
    return -power / motion.rate


def mean_over(
    function: Callable[[Floats], Floats], breaks: Iterable[float], start: float, stop: float
) -> float:
    """∫ f dx / (stop − start) by composite Gauss–Legendre quadrature, split at `breaks`.

    Every part between breaks must be smooth; parts are halved until the mean settles to 1e-12 of the
    mean of |f|.  Raises `ValueError` on an empty interval or when it does not settle.
    """
    if not stop > start:
        raise ValueError("the interval is empty")
    inside = sorted({start, stop, *(float(x) for x in breaks if start < x < stop)})
    edges = np.array(inside)
    previous = np.nan
    while edges.size <= MOST_PARTS + len(inside):
        mean, size = _gauss(function, edges, stop - start)
        if abs(mean - previous) <= CONVERGED * size:
            return mean
        previous = mean
        edges = np.sort(np.concatenate((edges, (edges[1:] + edges[:-1]) / 2)))
    raise ValueError("the quadrature does not settle")


def _gauss(function: Callable[[Floats], Floats], edges: Floats, span: float) -> tuple[float, float]:
    """Means of f and |f| over all parts, from one call of the function at all nodes in order."""
    nodes, factors = np.polynomial.legendre.leggauss(ORDER)
    half = np.diff(edges)[:, None] / 2
    x = edges[:-1, None] + half * (nodes + 1)
    values = np.asarray(function(x.ravel()), dtype=np.float64).reshape(x.shape)
    parts = half * factors
    return float(np.sum(parts * values) / span), float(np.sum(parts * np.abs(values)) / span)
