"""Forces as a sketch shows them: arrows of readable, not proportional, length at their points, with arms."""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from reportgen.figures.draft import Draft
from reportgen.figures.geometry import polar, unit
from reportgen.figures.labels import Content, Request, label
from reportgen.figures.scene import Arc, Arrow, Item, Line, Polyline, Stroke
from reportgen.figures.style import ACTIVE, CONSTRUCTION, DIMENSION, DIMENSION_HEAD, HEAD, REACTION

SHORTEST, STEP, LONGEST = 13.0, 6.5, 26.0
"""Drawn lengths of forces at one point, mm: those of one direction come out one longer than the other."""
ALIKE = math.radians(9)
"""Arrows of one point closer than this in direction would lie on each other."""
COUPLE_RADIUS = 6.0
LEAST_ARM = 0.5
"""An arm shorter than this (mm) is not drawn: the force goes through the point."""
TOGETHER = 0.3


@dataclass(frozen=True, slots=True)
class Force:
    """A force at `at` (mm on the drawing) along `direction` (any size); `id` ties an arm to it."""

    label: Content
    at: complex
    direction: complex
    kind: Literal["load", "reaction"] = "load"
    id: str = ""


@dataclass(frozen=True, slots=True)
class Couple:
    """A couple drawn as an arc about `at`, anticlockwise when `sense` > 0."""

    label: Content
    at: complex
    sense: float


@dataclass(frozen=True, slots=True)
class ArmOf:
    """The distance from the moment point `about` to the line of the force called `force`."""

    label: Content
    about: complex
    force: str


def foot(about: complex, at: complex, direction: complex) -> complex:
    """The foot of the perpendicular from `about` on the line through `at` along `direction`."""
    u = unit(direction)
    return at + u * ((about - at) * u.conjugate()).real


def forces(
    items: Sequence[Force],
    arms: Sequence[ArmOf] = (),
    body: Sequence[tuple[complex, complex]] = (),
) -> Draft:
    """Arrows with their labels and the arms to their lines; forces without direction are left out.

    A force that would lie along a bar of `body` from its end pushes from outside instead.
    """
    acting = [force for force in items if abs(force.direction) > 0]
    drawn: list[Item] = []
    requests: list[Request] = []
    shafts: dict[str, tuple[complex, complex]] = {}
    for force, tip in zip(acting, _tips(acting), strict=True):
        start, end = force.at, tip
        if _along(force, body):
            start, end = force.at - (tip - force.at), force.at
        shafts[force.id] = start, end
        drawn.append(Arrow(start, end, ACTIVE if force.kind == "load" else REACTION, HEAD, force.id))
        requests.append(_named(start, end, force))
    feet: dict[str, complex] = {}
    for arm in arms:
        if arm.force in shafts:
            feet[arm.force] = foot(arm.about, *_point_and_way(shafts[arm.force]))
    for arm in arms:
        # Arms that coincide are one dimension with all their names.
        if arm.force not in feet or abs(feet[arm.force] - arm.about) < LEAST_ARM:
            continue
        same = [
            other
            for other in arms
            if other.force in feet
            and abs(other.about - arm.about) < TOGETHER
            and abs(feet[other.force] - feet[arm.force]) < TOGETHER
        ]
        drawn += _extension(feet[arm.force], shafts[arm.force])
        if same[0] is arm:
            u = _point_and_way(shafts[arm.force])[1]
            drawn += _dimension(arm.about, feet[arm.force], u)
            requests.append(_arm_names(arm.about, feet[arm.force], same))
    return Draft(tuple(drawn), tuple(requests))


def couples(items: Sequence[Couple]) -> Draft:
    """Arcs of three quarters of a turn about their points."""
    arcs: list[Item] = []
    requests: list[Request] = []
    for couple in items:
        if couple.sense == 0:
            continue
        start, stop = (-0.35, 1.05) if couple.sense > 0 else (1.05, -0.35)
        arcs.append(
            Arc(couple.at, COUPLE_RADIUS, start * math.pi, stop * math.pi, Stroke(0.3, ACTIVE.colour), HEAD)
        )
        places = [couple.at + COUPLE_RADIUS * polar(angle) for angle in (0.35, 0.9, 1.6, 2.4, -0.6)]
        requests.append(label(places[0], couple.label, also=places[1:]))
    return Draft(tuple(arcs), tuple(requests))


def _tips(acting: Sequence[Force]) -> list[complex]:
    """Where the arrows end: the later of two that would coincide is drawn longer."""
    tips: list[complex] = []
    for n, force in enumerate(acting):
        u = unit(force.direction)
        crowd = sum(
            abs(other.at - force.at) < 1.0 and abs(cmath.phase(unit(other.direction) / u)) < ALIKE
            for other in acting[:n]
        )
        tips.append(force.at + u * min(SHORTEST + STEP * crowd, LONGEST + 2 * crowd))
    return tips


def _along(force: Force, body: Sequence[tuple[complex, complex]]) -> bool:
    u = unit(force.direction)
    for bar in body:
        for here, there in (bar, bar[::-1]):
            if abs(here - force.at) < 1.0 and abs(cmath.phase(unit(there - here) / u)) < ALIKE:
                return True
    return False


def _named(start: complex, end: complex, force: Force) -> Request:
    """The name at the head, or at the tail of an arrow that pushes."""
    u = unit(end - start)
    along, across = cmath.phase(u), cmath.phase(u) + math.pi / 2
    if end == force.at:
        sides = (along + math.pi, across, across + math.pi)
        return label(start, force.label, prefer=sides, also=(start + u * 3, start + u * 6))
    places = (end - u * HEAD / 2, end - u * 2 * HEAD)
    return label(end, force.label, prefer=(along, across, across + math.pi), also=places)


def _point_and_way(shaft: tuple[complex, complex]) -> tuple[complex, complex]:
    return shaft[0], shaft[1] - shaft[0]


def _extension(base: complex, shaft: tuple[complex, complex]) -> list[Item]:
    """The force's line drawn on from its arrow to the foot of the arm and a little beyond."""
    start, way = _point_and_way(shaft)
    u = unit(way)
    along = ((base - start) * u.conjugate()).real
    if along < 0:
        return [Line(start, base - 3.0 * u, CONSTRUCTION)]
    if along > abs(way):
        return [Line(start + way, base + 3.0 * u, CONSTRUCTION)]
    return []


def _dimension(about: complex, base: complex, direction: complex) -> list[Item]:
    """The arm with a head at each end where there is room, and the right angle at its foot."""
    reach = base - about
    items: list[Item] = [Arrow(about, base, DIMENSION, DIMENSION_HEAD)]
    if abs(reach) > 4 * DIMENSION_HEAD:
        items.append(Arrow(about + reach / 2, about, DIMENSION, DIMENSION_HEAD))
    if abs(reach) > 3:
        back, side = -unit(reach) * 1.4, unit(direction) * 1.4
        items.append(Polyline((base + back, base + back + side, base + side), DIMENSION))
    return items


def _arm_names(about: complex, base: complex, arms: Sequence[ArmOf]) -> Request:
    reach = base - about
    across = cmath.phase(reach) + math.pi / 2
    places = [about + reach * share for share in (0.5, 0.35, 0.65, 0.2, 0.8)]
    parts: list[Content] = []
    for arm in arms:
        if arm.label not in parts:
            parts += [", ", arm.label] if parts else [arm.label]
    return label(places[0], *parts, prefer=(across, across + math.pi), also=places[1:])
