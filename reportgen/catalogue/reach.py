"""Whether a linkage goes round: groups that do not assemble, dead points, rockers that are cranks."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from reportgen.assignment.faults import Finding, Where
from reportgen.catalogue.course import FULL_TURN
from reportgen.mechanism.motion import Motion, solve_motion
from reportgen.mechanism.plane import SINGULAR, Floats, unit
from reportgen.mechanism.structure import Dyad, Linkage

STEPS = 720
HALVINGS = 40
NEAR = 0.1
"""Only where the sine of a group's angle of transmission falls below this is its least value sought."""


@dataclass(frozen=True, slots=True)
class Member:
    """How a group is spoken of: its links by their letters ("BC, CD"), and the key at fault in the file."""

    rods: str
    where: Where


def findings(linkage: Linkage, members: Mapping[tuple[int, int], Member]) -> Iterator[Finding]:
    """The first group that the crank cannot carry through a whole turn: with its links and crank angles."""
    angles = np.linspace(0.0, FULL_TURN, STEPS, endpoint=False)
    motion = solve_motion(linkage, angles, 1.0)
    for dyad in linkage.dyads:
        member = members[dyad.links]
        about = {"group": f"{dyad.links[0]}, {dyad.links[1]}", "rods": member.rods}
        placed = _placed(motion, dyad)
        if not placed.any():
            yield Finding("never-assembled", member.where, about)
            return
        if not placed.all():
            first, last = _gap(linkage, dyad, angles, placed)
            yield Finding("no-assembly", member.where, {**about, "first": _degrees(first), "last": _degrees(last)})
            return
        least = _least_transmission(linkage, dyad, angles, motion)
        if least is not None:
            yield Finding("dead-point", member.where, {**about, "angle": _degrees(least)})
            return


def turns_fully(linkage: Linkage, link: int) -> bool:
    """Whether a link makes whole turns with the crank, rather than swinging."""
    angle = solve_motion(linkage, np.linspace(0.0, FULL_TURN, STEPS + 1), 1.0).links[link].angle
    return bool(abs(angle[-1] - angle[0]) > np.pi)


def _placed(motion: Motion, dyad: Dyad) -> np.ndarray:
    return np.isfinite(motion.points[dyad.middle].p) & np.isfinite(motion.links[dyad.links[1]].angle)


def _gap(linkage: Linkage, dyad: Dyad, angles: Floats, placed: np.ndarray) -> tuple[float, float]:
    """The ends of the first range of crank angles where the group does not assemble."""
    order = np.roll(np.arange(angles.size), -int(np.flatnonzero(placed)[0]))
    outside = np.flatnonzero(~placed[order])
    start = int(outside[0])
    length = int(np.argmax(placed[order][start:])) if placed[order][start:].any() else len(order) - start
    step = FULL_TURN / STEPS
    first = float(angles[order[start]])
    last = first + (length - 1) * step
    return _edge(linkage, dyad, first - step, first), _edge(linkage, dyad, last + step, last)


def _edge(linkage: Linkage, dyad: Dyad, inside: float, outside: float) -> float:
    """The crank angle between a reachable and an unreachable one at which the links just reach each other."""
    for _ in range(HALVINGS):
        middle = (inside + outside) / 2
        if _placed(solve_motion(linkage, middle, 1.0), dyad)[0]:
            inside = middle
        else:
            outside = middle
    return inside


def _least_transmission(linkage: Linkage, dyad: Dyad, angles: Floats, motion: Motion) -> float | None:
    """The crank angle of a dead point of the group, None if it has none."""
    sine = transmission(dyad, motion)
    k = int(np.argmin(sine))
    if sine[k] > NEAR:
        return None
    low, high = angles[k] - FULL_TURN / STEPS, angles[k] + FULL_TURN / STEPS
    for _ in range(HALVINGS):
        third = (high - low) / 3
        left, right = transmission(dyad, solve_motion(linkage, np.array([low + third, high - third]), 1.0))
        low, high = (low, high - third) if left < right else (low + third, high)
    least = float(transmission(dyad, solve_motion(linkage, (low + high) / 2, 1.0))[0])
    return float((low + high) / 2) if min(least, float(sine[k])) < SINGULAR else None


def transmission(dyad: Dyad, motion: Motion) -> Floats:
    """|sin| of a group's angle of transmission [N]: between its rods, or of the rod and the guide's normal."""
    i, j = (unit(motion.links[link].angle) for link in dyad.links)
    along = np.conj(i) * j
    if dyad.kind == "RRR":
        return np.asarray(np.abs(along.imag))
    if dyad.kind == "RRP":
        return np.asarray(np.abs(along.real))
    return np.ones(i.shape)


def _degrees(angle: float) -> str:
    """An angle in degrees, −180…180, without trailing zeros."""
    return f"{np.degrees(np.angle(np.exp(1j * angle))):.4g}"
