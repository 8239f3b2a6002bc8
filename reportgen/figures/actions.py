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


def forces(items: Sequence[Force], arms: Sequence[ArmOf] = ()) -> Draft:
    """Arrows with their labels and the arms to their lines; forces without direction are left out."""
    acting = [force for force in items if abs(force.direction) > 0]
    tips = _tips(acting)
    drawn: list[Item] = []
    requests: list[Request] = []
    for force, tip in zip(acting, tips, strict=True):
        drawn.append(Arrow(force.at, tip, ACTIVE if force.kind == "load" else REACTION, HEAD, force.id))
        requests.append(_at_head(force.at, tip, force.label))
    by_id = {force.id: (force, tip) for force, tip in zip(acting, tips, strict=True) if force.id}
    for arm in arms:
        if arm.force in by_id:
            part = _arm(arm, *by_id[arm.force])
            drawn += part.items
            requests += part.requests
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


def _at_head(start: complex, end: complex, content: Content) -> Request:
    way = end - start
    along, across = cmath.phase(way), cmath.phase(way) + math.pi / 2
    places = [end - unit(way) * HEAD / 2, end - unit(way) * 2 * HEAD]
    return label(end, content, prefer=(along, across, across + math.pi), also=places)


def _arm(arm: ArmOf, force: Force, tip: complex) -> Draft:
    """The arm's dimension line, the force's line drawn on to its foot, and the right angle there."""
    base = foot(arm.about, force.at, force.direction)
    reach = base - arm.about
    if abs(reach) < 0.5:
        return Draft()
    u = unit(force.direction)
    ends = sorted((force.at, tip, base), key=lambda p: ((p - force.at) * u.conjugate()).real)
    beyond = 3.0 * u
    items: list[Item] = []
    if ends[0] == base:
        items.append(Line(base - beyond, force.at, CONSTRUCTION))
    elif ends[-1] == base:
        items.append(Line(tip, base + beyond, CONSTRUCTION))
    both = abs(reach) > 4 * DIMENSION_HEAD
    items.append(Arrow(arm.about, base, DIMENSION, DIMENSION_HEAD))
    if both:
        middle = arm.about + reach / 2
        items.append(Arrow(middle, arm.about, DIMENSION, DIMENSION_HEAD))
    back, side = -unit(reach) * 1.4, u * 1.4
    if abs(reach) > 3:
        items.append(Polyline((base + back, base + back + side, base + side), DIMENSION))
    across = cmath.phase(reach) + math.pi / 2
    places = [arm.about + reach * share for share in (0.5, 0.35, 0.65, 0.2, 0.8)]
    request = label(places[0], arm.label, prefer=(across, across + math.pi), also=places[1:])
    return Draft(tuple(items), (request,))
