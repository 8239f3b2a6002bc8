"""Figures of forces: separated links, Zhukovsky's lever, the rule of 90° for a Coriolis acceleration.

Forces are arrows of readable, not proportional, length at their points; arms of moments are dimensioned.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from itertools import combinations
from typing import Literal

from reportgen.base.records import Record, replace
from reportgen.base.stable_digits import settled
from reportgen.drawing import Arc, Arrow, Circle, Content, Item, Line, Polyline, Scene, style
from reportgen.drawing.canvas import Canvas, finish
from reportgen.drawing.drawing_description import Fact, PaperLength, direction, fact, pointing, turning
from reportgen.drawing.geometry import clusters, on_one_line, polar, unit
from reportgen.drawing.labels import Request, joined, label
from reportgen.drawing.scheme import Looks, mechanism, skeleton
from reportgen.drawing.vector_plan import CROWDED, Plan, point_names, vector_facts
from reportgen.formula import Symbol, constructions
from reportgen.machine import Linkage
from reportgen.machine.kinematics import Motion

SHORTEST, STEP, LONGEST = 13.0, 6.5, 26.0
"""Drawn lengths of forces at one point (mm); if two have one direction, the second is longer by a step."""
ON_EACH_OTHER = math.radians(9)
"""Arrows at one point closer than this in direction would overlap."""
COUPLE_RADIUS = 6.0
"""Radius of the arc of a couple (mm)."""
LEAST_ARM = 0.5
"""An arm shorter than this (mm) is not drawn: the force passes through the point."""
TOGETHER, EQUAL = 0.3, 0.002
"""Arms whose ends are nearer than this (mm) share one label and one dimension."""
ROUNDING = 0.05
"""A printed arm differs from the drawn one by less than this (mm)."""
BEYOND, BESIDE = 22.0, -34.0
"""Ends of a guide's line (mm from the point); the sense of ω is drawn at the second, away from the vectors."""
QUARTER = 8.0
"""Radius of the arc of 90° (mm)."""


class Force(Record):
    """A force at `at` (mm on the drawing) along `direction` (any length); an arm refers to its `id`."""

    label: Content
    at: complex
    direction: complex
    kind: Literal["load", "reaction"] = "load"
    id: str = ""


class Couple(Record):
    """A couple drawn as an arc about `at`, anticlockwise when `sense` > 0."""

    label: Content
    at: complex
    sense: float


class ArmOf(Record):
    """The distance from the moment point `about` to the line of the force with the id `force`.

    `length` is the printed length (mm on the drawing), or None.
    """

    label: Content
    about: complex
    force: str
    length: float | None = None


class Sliding(Record):
    """A relative velocity along a rotating guide: labels, directions (any length), and the sense of ω (±1)."""

    point: Symbol
    velocity: tuple[Symbol, complex]
    coriolis: tuple[Symbol, complex]
    omega: tuple[Symbol, float]


# --- figures --------------------------------------------------------------------------------------


def bodies(
    linkage: Linkage,
    motion: Motion,
    index: int,
    scale: float,
    links: Sequence[int],
    forces: Sequence[Force] = (),
    *,
    arms: Sequence[ArmOf] = (),
    turning: Sequence[Couple] = (),
    extra: Canvas | None = None,
    looks: Looks,
    title: str = "",
) -> Scene:
    """Draw chosen links at position `index`, to `scale` (mm per m), with all forces on them.

    `extra` is added to the drawing.  Points of forces, couples and moments are in mm of the drawing: metres times
    `scale`, from the mechanism's origin.
    """
    bones = skeleton(linkage, motion, index, scale)
    joints = [[bones.points[name] for name in bones.bars.get(link, ())] for link in links]
    bars = [bar for ends in joints for bar in combinations(ends, 2)]
    draft = mechanism(bones, links, looks) + draw_forces(forces, arms, bars) + draw_couples(turning)
    return finish(draft + extra if extra else draft, notes=looks.notes, title=title)


def lever(
    plan: Plan, forces: Sequence[Force], arms: Sequence[ArmOf] = (), *, sense: int = 1, notes: Sequence[Content] = ()
) -> Scene:
    """Draw Zhukovsky's lever: the velocity plan turned by 90° as a rigid lever about its pole, loaded by all forces.

    It is turned anticlockwise for `sense` = +1.  The forces act at the images of their points, in the *turned* plan's
    coordinates.  Σ F h = 0 with the balancing force at the crank pin's image gives the driver's torque.
    """
    rigid = plan.scaled(1j * sense)
    items: list[Item] = [Line(vector.start, vector.end, style.VISIBLE) for vector in rigid.drawn()]
    # The pole is the fixed pivot.
    items += [Circle(point.at, 0.7, style.VISIBLE, style.PAPER) for point in rigid.points[1:]]
    items += [Circle(point.at, 1.1, style.VISIBLE, style.PAPER) for point in rigid.points[:1]]
    groups = clusters(rigid.points, CROWDED, lambda point: point.at)
    names = tuple(label(group[0].at, *point_names(group), gap=1.3) for group in groups)
    return finish(Canvas(tuple(items), names, vector_facts(rigid.drawn())) + draw_forces(forces, arms), notes=notes)


def coriolis(sliding: Sliding) -> Scene:
    """Draw the rule of 90°: the relative velocity, turned in the sense of ω, has the direction of aᵏ = 2 ω × v_r.

    Lengths are not to scale.
    """
    along, sense = unit(sliding.velocity[1]), sliding.omega[1]
    start = cmath.phase(along)
    quarter = Arc(0j, QUARTER, start, start + sense * math.pi / 2, style.CONSTRUCTION, style.DIMENSION_HEAD)
    right_angle = fact("quarter", sliding.velocity[0], sliding.coriolis[0])
    guide = Canvas((Line(BESIDE * along, BEYOND * along, style.OLD), quarter), says=(right_angle,))
    ends = Canvas(
        (Circle(0j, 0.7, style.VISIBLE, style.PAPER), Circle(BESIDE * along, 0.7, style.VISIBLE, style.PAPER)),
        (label(0j, sliding.point, gap=1.4),),
    )
    vectors = draw_forces(
        (
            Force(sliding.velocity[0], 0j, sliding.velocity[1], "load", "v"),
            Force(sliding.coriolis[0], 0j, sliding.coriolis[1], "reaction", "a"),
        )
    )
    turning = draw_couples((Couple(sliding.omega[0], BESIDE * along, sense),))
    return finish(guide + ends + vectors + turning)


# --- why plans work -------------------------------------------------------------------------------
# These links belong to no machine; their motions are chosen to be easy to see.

ARM = 44 * polar(math.radians(25))
"""A point A of a link that rotates about O (mm)."""
NORMAL_SHARE, TANGENT_SHARE = 0.5, 0.3
"""aⁿ and aᵗ of A as shares of OA: ε/ω² = 0.6."""
TRIANGLE = {"B": 0j, "C": 42 + 6j, "E": 15 + 27j}
"""Points of a link (mm)."""
RATE = {"v": 0.9j, "a": 0.9 * (-1 + 0.6j)}
"""Factor from a line on the link (mm) to its image in the plan: iω, and −ω² + iε with the same ε/ω²."""
OF_B = {"v": 34 + 10j, "a": -20 - 12j}
"""The velocity and the acceleration of B on paper (mm)."""


def inclination() -> Scene:
    """Draw the normal and the tangential acceleration of a point A about O, and the angle α of their sum with AO."""
    normal, tangent = -NORMAL_SHARE * ARM, 1j * TANGENT_SHARE * ARM
    whole, inward = normal + tangent, cmath.phase(-ARM)
    angle = cmath.phase(whole / normal)
    arrows = (("n", normal, style.KNOWN), ("τ", tangent, style.KNOWN), ("", whole, style.ACTIVE))
    items: list[Item] = [Line(0j, ARM, style.HEAVY), *style.pivot(0j), style.point(ARM)]
    items += [Arrow(ARM, ARM + vector, pen, style.HEAD) for _, vector, pen in arrows]
    items += [Line(ARM + part, ARM + whole, style.CONSTRUCTION) for part in (normal, tangent)]
    items.append(Arc(ARM, QUARTER / 2, inward, inward + angle, style.DIMENSION, style.DIMENSION_HEAD))
    names = [label(ARM + vector, Symbol("a", "A", part, "vector")) for part, vector, _ in arrows]
    names.append(label(ARM + QUARTER / 2 * polar(inward + angle / 2), Symbol("α"), size=style.SMALL))
    names += [label(0j, Symbol("O"), gap=style.JOINT + 0.4), label(ARM, Symbol("A"), gap=1.0)]
    facts = (
        fact("link", Symbol("O"), Symbol("A"), direction(ARM)),
        *(pointing(Symbol("a", "A", part, "vector"), vector) for part, vector, _ in arrows),
        fact("angle-between", Symbol("α"), Symbol("a", "A", over="vector"), Symbol("AO")),
    )
    couple = draw_couples((Couple(Symbol("ω, ε"), 0j, 1.0),))
    return finish(Canvas(tuple(items), tuple(names), facts) + couple)


def link_and_plan(what: Literal["v", "a"]) -> tuple[Scene, Scene]:
    """Return two scenes: a link with its points B, C, E, and its plan of velocities ("v") or accelerations ("a").

    The plan of velocities also has the lines that meet in e.
    """
    places = {name: OF_B[what] + RATE[what] * place for name, place in TRIANGLE.items()}
    link = (*style.body(tuple(TRIANGLE.values())), *(style.point(place) for place in TRIANGLE.values()))
    named = tuple(label(place, Symbol(name), gap=1.0) for name, place in TRIANGLE.items())
    prime, pole = ("", Symbol("p")) if what == "v" else ("′", Symbol("π"))
    drawn = ("B", "C") if what == "v" else tuple(TRIANGLE)
    plan: list[Item] = [Arrow(0j, places[name], style.KNOWN, style.HEAD) for name in drawn]
    sides = tuple(combinations(places, 2))
    plan += [Line(places[start], places[end], style.RELATIVE) for start, end in sides]
    if what == "v":
        plan.append(Arrow(0j, places["E"], style.FOUND, style.HEAD))
        plan += [
            Line(places[name], places["E"] + 6 * unit(places["E"] - places[name]), style.CONSTRUCTION) for name in "BC"
        ]
    ends = {name: Symbol(name.lower(), "", prime) for name in places}
    letters = [label(place, ends[name], gap=0.8) for name, place in places.items()]
    corners = tuple(
        fact("side", Symbol(start + end), direction(TRIANGLE[end] - TRIANGLE[start])) for start, end in sides
    )
    facts = (
        *(pointing(Symbol(what, name, over="vector"), place) for name, place in places.items()),
        *(fact("side", (ends[start], ends[end]), direction(places[end] - places[start])) for start, end in sides),
    )
    whole = Canvas(tuple(plan), (*letters, label(0j, pole, gap=0.8)), facts)
    return finish(Canvas(link, named, corners)), finish(whole)


# --- arrows and arcs ------------------------------------------------------------------------------


def draw_forces(
    forces: Sequence[Force], arms: Sequence[ArmOf] = (), bars: Sequence[tuple[complex, complex]] = ()
) -> Canvas:
    """Draw arrows with their labels, and the arms to their lines (mm); forces without direction are left out.

    A force that would lie along one of the `bars` from its end is drawn pushing from outside instead; one that would
    overlap another force is drawn beside it, with a thin line from its point.
    """
    printed = {arm.force: arm for arm in arms if arm.length is not None}
    directed = [_as_printed(force, printed.get(force.id)) for force in forces if force.direction != 0]
    items: list[Item] = []
    requests: list[Request] = []
    facts: list[Fact] = []
    shafts: dict[str, tuple[complex, complex]] = {}
    drawn: list[tuple[complex, complex]] = []
    for force, tip in zip(directed, _tips(directed), strict=True):
        start, end = force.at, tip
        if _lies_along(force, bars):
            start, end = force.at - (tip - force.at), force.at
        by = _aside((start, end), drawn)
        shafts[force.id] = start, end
        drawn.append((start + by, end + by))
        if by:
            items.append(Line(force.at, force.at + by, style.LEADER))
        pen = style.ACTIVE if force.kind == "load" else style.REACTION
        items.append(Arrow(start + by, end + by, pen, style.HEAD, force.id))
        requests.append(_name(start + by, end + by, force, force.at + by))
        facts.append(pointing(force.label, end - start))
    feet = {arm.force: foot(arm.about, *shafts[arm.force]) for arm in arms if arm.force in shafts}
    long = [arm for arm in arms if arm.force in feet and abs(feet[arm.force] - arm.about) >= LEAST_ARM]
    for arm in long:
        end = feet[arm.force]
        same = [
            another
            for another in long
            if abs(another.about - arm.about) < TOGETHER and abs(feet[another.force] - end) < TOGETHER
        ]
        items += _extension(end, *shafts[arm.force])
        equal = [other for other in same if abs(feet[other.force] - end) < EQUAL]
        if equal[0] is arm:
            items += _dimension(arm.about, end, *shafts[arm.force], name=" ".join(["h", *(one.force for one in equal)]))
        if same[0] is arm:
            requests.append(_arm_name(arm.about, end, same))
        facts.append(fact("arm", arm.label, PaperLength(abs(end - arm.about))))
    return Canvas(tuple(items), tuple(requests), tuple(facts))


def _as_printed(force: Force, arm: ArmOf | None) -> Force:
    """Return a force at the printed distance from the moment point: rounding shifts it by hundredths of a
    millimetre.
    """
    if arm is None or arm.length is None:
        return force
    reach = foot(arm.about, force.at, force.at + force.direction) - arm.about
    further = arm.length - abs(reach)
    return replace(force, at=force.at + further * unit(reach)) if abs(further) < ROUNDING else force


def draw_couples(couples: Sequence[Couple]) -> Canvas:
    """Draw couples as arcs of seven tenths of a turn about their points (mm); couples of sense 0 are left out."""
    arcs: list[Item] = []
    requests: list[Request] = []
    for couple in couples:
        if couple.sense == 0:
            continue
        start, stop = (-0.35, 1.05) if couple.sense > 0 else (1.05, -0.35)
        arcs.append(Arc(couple.at, COUPLE_RADIUS, start * math.pi, stop * math.pi, style.ACTIVE, style.HEAD))
        places = [couple.at + COUPLE_RADIUS * polar(angle) for angle in (0.35, 0.9, 1.6, 2.4, -0.6)]
        requests.append(label(places, couple.label))
    facts = tuple(turning(couple.label, couple.sense) for couple in couples if couple.sense)
    return Canvas(tuple(arcs), tuple(requests), facts)


def foot(about: complex, start: complex, end: complex) -> complex:
    """Return the foot of the perpendicular from `about` on the line through two points, in their unit."""
    return complex(constructions.foot(about, start, unit(end - start)))


def _parallel(u: complex, v: complex) -> bool:
    return abs(cmath.phase(unit(v) / unit(u))) < ON_EACH_OTHER


def _tips(forces: Sequence[Force]) -> list[complex]:
    """Return the ends of the arrows: the later of two that would coincide is drawn longer."""
    tips: list[complex] = []
    for n, force in enumerate(forces):
        before = sum(
            abs(earlier.at - force.at) < 1.0 and _parallel(force.direction, earlier.direction) for earlier in forces[:n]
        )
        length = min(SHORTEST + STEP * before, LONGEST + 2 * before)
        tips.append(force.at + length * unit(force.direction))
    return tips


def _lies_along(force: Force, bars: Sequence[tuple[complex, complex]]) -> bool:
    return any(
        abs(here - force.at) < 1.0 and _parallel(force.direction, there - here)
        for bar in bars
        for here, there in (bar, bar[::-1])
    )


def _aside(shaft: tuple[complex, complex], drawn: Sequence[tuple[complex, complex]]) -> complex:
    """Return the offset (mm) of an arrow from its line, so that it lies on no arrow already drawn."""
    step = -1j * unit(shaft[1] - shaft[0]) * style.BESIDE
    shifts = (step * number for number in range(len(drawn) + 1))
    return next(
        by
        for by in shifts
        if not any(on_one_line((shaft[0] + by, shaft[1] + by), one, style.ON_LINE, style.HEAD) for one in drawn)
    )


def _name(start: complex, end: complex, force: Force, at: complex) -> Request:
    """Return the label at the head of an arrow, or at the tail of an arrow that pushes."""
    u = unit(end - start)
    along, across = cmath.phase(u), cmath.phase(u) + math.pi / 2
    if end == at:
        sides = (along + math.pi, across, across + math.pi)
        return label((start, start + u * 3, start + u * 6), force.label, prefer=sides)
    sides = (along, across, across + math.pi)
    return label((end, end - u * style.HEAD / 2, end - u * 2 * style.HEAD), force.label, prefer=sides)


def _extension(base: complex, start: complex, end: complex) -> list[Item]:
    """Return the force's line extended from its arrow to the foot of the arm and a little beyond."""
    u = unit(end - start)
    along = settled(((base - start) * u.conjugate()).real)
    if along < 0:
        return [Line(start, base - 3.0 * u, style.CONSTRUCTION)]
    if along > settled(abs(end - start)):
        return [Line(end, base + 3.0 * u, style.CONSTRUCTION)]
    return []


def _dimension(about: complex, base: complex, start: complex, end: complex, name: str) -> list[Item]:
    """Draw the arm with a head at each end if there is room, and the right angle at its foot."""
    reach = base - about
    items: list[Item] = [Arrow(about, base, style.DIMENSION, style.DIMENSION_HEAD, name)]
    if abs(reach) > 4 * style.DIMENSION_HEAD:
        items.append(Arrow(about + reach / 2, about, style.DIMENSION, style.DIMENSION_HEAD))
    if abs(reach) > 3:
        back, side = -unit(reach) * 1.4, unit(end - start) * 1.4
        items.append(Polyline((base + back, base + back + side, base + side), style.DIMENSION))
    return items


def _arm_name(about: complex, base: complex, arms: Sequence[ArmOf]) -> Request:
    reach = base - about
    across = cmath.phase(reach) + math.pi / 2
    places = [about + reach * share for share in (0.5, 0.35, 0.65, 0.2, 0.8)]
    names = dict.fromkeys(arm.label for arm in arms)
    return label(places, *joined(names), prefer=(across, across + math.pi))
