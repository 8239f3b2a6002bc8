"""The position plan: all positions of a mechanism in one drawing, true to scale, with paths of points.

Also the mechanism at one position with the instant centres of its links (`centre_plan`).
"""

from __future__ import annotations

import cmath
from collections.abc import Sequence

import numpy as np

from reportgen.base.arrays import Complexes
from reportgen.base.records import Record
from reportgen.base.stable_digits import settled
from reportgen.drawing import Arc, Arrow, Circle, Content, Item, Line, Pen, Polyline, Scene, style
from reportgen.drawing.canvas import Canvas, finish
from reportgen.drawing.drawing_description import Description, Fact, PaperLength, fact, listed, pointing, turning
from reportgen.drawing.drawing_description import angle as angle_told
from reportgen.drawing.geometry import coincident, polar, unit
from reportgen.drawing.labels import Request, joined, label
from reportgen.drawing.scheme import Looks, Skeleton, driver_arrow, driver_marks, mechanism, skeleton
from reportgen.formula import Number, Symbol, vocabulary
from reportgen.machine import GROUND, Crank, Linkage
from reportgen.machine.kinematics import Motion

TOGETHER = 0.3
"""Points nearer to one another than this (mm of paper) coincide and share a label."""
CROWDED = 24
"""Above this number of positions only the emphasised one is numbered."""
DOT = 0.55
"""Radius of the circle at a numbered position or an instant centre (mm)."""
VELOCITY, ANGLE = 20.0, 11.0
"""Length of a velocity's arrow and radius of an angle's arc (mm) beside instant centres."""
LEAST_ANGLE = 0.03
"""A smaller angle (rad) has no visible arc."""
ARC_OVER = 9.0
"""Length (mm) of an arc on either side of its point."""
BEYOND_BOTH = 0.7
"""Radius of the arc of the angle at the crank's centre, as a share of the distance to the second end."""
FAR = 1.5
"""A circle is drawn with its centre if the radius is less than this multiple of the reach from the crank's centre."""
BEYOND = 3.0
"""Length (mm) of a normal beyond the centre."""


class PositionPlan(Record):
    """Contents of a position plan.

    `numbered` are points labelled with each position's number (A₁ … A₈), `paths` points whose curves are drawn from a
    dense motion, `emphasised` the index (from 0) of the position drawn heavy, or None; `labels` replaces the positions'
    numbers; the drawing is `enlarged` by this factor afterwards.
    """

    numbered: tuple[str, ...]
    paths: tuple[str, ...] = ()
    emphasised: int | None = None
    labels: tuple[str, ...] = ()
    enlarged: float = 1.0

    def label(self, k: int) -> str:
        """Return the label of the position of index `k` (from 0)."""
        return self.labels[k] if self.labels else str(k + 1)


def position_plan(
    linkage: Linkage,
    motion: Motion,
    dense: Motion,
    scale: float,
    shows: PositionPlan,
    notes: Sequence[Content] = (),
    *,
    beside: Canvas | None = None,
) -> Scene:
    """Draw a position plan at `scale` mm of paper per m.

    `motion` gives the numbered positions, `dense` the curves of points; curves are drawn only if every position of
    `dense` can be reached.  The drawing `beside` it has the same origin (an indicator diagram, say); `notes` are
    printed below.
    """
    count = len(motion.driver)
    every = [skeleton(linkage, motion, k, scale) for k in range(count)]
    reached = [bones for bones in every if bones.reached]
    items: list[Item] = []
    requests: list[Request] = []
    # A point with numbers needs no name.
    unnumbered = [name for name in shows.paths if name not in shows.numbered]
    if isinstance(linkage.driver, Crank):
        centre = linkage.driver.centre
        radii = _radii(dense, centre, shows.numbered, scale)
        items += [Circle(every[0].points[centre], radius, style.THIN) for radius in radii]
    items += [line for bones in reached[:1] for line in _axes(bones)]
    for bones in reached:
        items += _links(bones, style.THIN, shows.numbered)
    drawn: list[Complexes] = []
    # If the mechanism does not turn fully, no path is complete.
    for name in shows.paths if dense.reachable.all() else ():
        curve = dense.points[name].p[dense.reachable] * scale
        # Two points that trace one curve share its line; otherwise their dashes would fill each other's gaps.
        if not any(_covers(other, curve) for other in drawn):
            items.append(Polyline(tuple(complex(p) for p in curve), style.PATH))
            drawn.append(curve)
    if shows.emphasised is not None and every[shows.emphasised].reached:
        bones = every[shows.emphasised]
        items += _links(bones, style.HEAVY, (*shows.paths, *shows.numbered))
        items += [style.point(bones.points[name]) for name in shows.paths]
        requests += [label(bones.points[name], vocabulary.point(name), gap=style.POINT + 0.4) for name in unnumbered]
    else:
        for name in unnumbered:
            # The name of a path is placed at its outermost point, or elsewhere along it.
            curve = dense.points[name].p[dense.reachable] * scale
            far = np.argsort(-np.abs(curve - curve.mean()), kind="stable")
            requests.append(
                label([complex(p) for p in curve[far][:: max(1, len(curve) // 10)]], vocabulary.point(name))
            )
    if reached:
        emphasised = shows.emphasised if shows.emphasised is not None and every[shows.emphasised].reached else None
        turning = driver_arrow(linkage, motion, every[emphasised] if emphasised is not None else reached[0])
        items += turning.items
        requests += turning.requests
    for name in reached[0].pivots if reached else ():
        items += style.pivot(reached[0].points[name])
        requests.append(label(reached[0].points[name], vocabulary.point(name), gap=style.JOINT + 0.4))
    numbers = range(count) if count <= CROWDED else [k for k in (shows.emphasised,) if k is not None]
    facts = _position_facts(linkage, motion, shows, len(reached))
    draft = Canvas(tuple(items), tuple(requests), facts) + _numbers(every, numbers, shows)
    return finish(draft + beside if beside else draft, notes=notes)


def _position_facts(linkage: Linkage, motion: Motion, shows: PositionPlan, count: int) -> Description:
    """Return the facts of a position plan: number of positions, numbered points, curves, the emphasised position."""
    facts = [fact("positions", Number(count), listed(map(vocabulary.point, shows.numbered)))]
    if shows.paths:
        facts.append(fact("paths", listed(map(vocabulary.point, shows.paths))))
    if shows.emphasised is not None:
        facts.append(fact("emphasised", shows.label(shows.emphasised)))
    if isinstance(linkage.driver, Crank):
        facts.append(turning(Symbol("ω", "1"), float(motion.rate[0])))
    return tuple(facts)


class DrawnCentre(Record):
    """The instant centre of a link, at `at` (mm), where the normals of the velocities of two `points` meet."""

    name: Content
    at: complex
    points: tuple[str, str]


class PlaneMotion(Record):
    """A link in plane motion by its points: their velocities (any size), and the names of their angles with
    the link.
    """

    points: tuple[str, ...]
    velocities: tuple[complex, ...]
    names: tuple[Content, ...]
    angles: tuple[Content, ...]


def centre_plan(
    linkage: Linkage,
    motion: Motion,
    index: int,
    scale: float,
    centres: Sequence[DrawnCentre],
    looks: Looks,
    moving: Sequence[PlaneMotion] = (),
) -> Scene:
    """Draw the mechanism at position `index`, `scale` mm per m, with its links' instant centres and normals to them.

    The velocities of links in `moving` are drawn with their angles, not to scale.
    """
    bones = skeleton(linkage, motion, index, scale)
    draft = mechanism(bones, (GROUND, *linkage.links), looks) + driver_marks(linkage, motion, bones)
    normals: list[Item] = []
    marks: list[Item] = []
    names: list[Request] = []
    for centre in centres:
        for start in (bones.points[name] for name in centre.points):
            normal = centre.at - start
            if abs(normal) > style.JOINT:
                normals.append(Line(start, centre.at + normal / abs(normal) * BEYOND, style.NORMAL))
        marks.append(Circle(centre.at, DOT, Pen(0.2, style.RED), style.PAPER))
        names.append(label(centre.at, centre.name, gap=DOT + 0.5))
    facts = tuple(
        fact("centre", centre.name, vocabulary.point(name), PaperLength(abs(centre.at - bones.points[name])))
        for centre in centres
        for name in centre.points
    )
    whole = Canvas((*normals, *draft.items, *marks), (*draft.requests, *names), (*facts, *draft.says))
    return finish(whole + _inclined(bones, moving), notes=looks.notes)


def _inclined(bones: Skeleton, moving: Sequence[PlaneMotion]) -> Canvas:
    """Draw velocities at their points and their angles with the links, measured from the direction from base
    to point.
    """
    items: list[Item] = []
    requests: list[Request] = []
    facts: list[Fact] = []
    drawn: list[str] = []
    for moved_rod in moving:
        base, end = (bones.points[name] for name in moved_rod.points)
        rod = unit(end - base)
        if moved_rod.velocities[1]:
            items.append(Line(end, end + rod * (ANGLE + BEYOND), style.CONSTRUCTION))
        for name, v, letter, angle in zip(
            moved_rod.points, moved_rod.velocities, moved_rod.names, moved_rod.angles, strict=True
        ):
            if v == 0:
                continue
            at, along = bones.points[name], unit(v)
            if name not in drawn:
                drawn.append(name)
                items.append(Arrow(at, at + VELOCITY * along, style.ACTIVE, style.HEAD))
                requests.append(label(at + VELOCITY * along, letter, prefer=(float(np.angle(along)),)))
                facts.append(pointing(letter, v))
            start, turn = float(np.angle(rod)), float(np.angle(along / rod))
            if abs(turn) > LEAST_ANGLE:
                items.append(Arc(at, ANGLE, start, start + turn, style.DIMENSION, style.DIMENSION_HEAD))
            middle = at + ANGLE * polar(start + turn / 2)
            requests.append(label(middle, angle, prefer=(start + turn / 2,), size=style.SMALL))
            facts.append(angle_told(angle, turn))
    return Canvas(tuple(items), tuple(requests), tuple(facts))


class SwingMarks(Record):
    """Construction of both ends of a pin's path (m): the crank's `centre`, the rocker's `pivot`, the pin's `ends`.

    `angles` are the names of the angles between the lines to the ends, seen from both. A slider has no pivot and only
    the angle at the crank's centre. `circle` is the centre O of a circle through the ends and the crank's centre, with
    the name of its radius, or None.
    """

    centre: complex
    pivot: complex | None
    ends: tuple[complex, complex]
    angles: tuple[Content, ...]
    circle: tuple[complex, Content] | None = None


def swing_marks(marks: SwingMarks, scale: float) -> Canvas:
    """Draw the construction of `SwingMarks` at `scale` mm of paper per m.

    It has the lines from the crank's centre to both ends with arcs about it, both named angles, and the arc of the
    circle, if there is one, with its centre if that is near the mechanism.
    """
    centre = marks.centre * scale
    ends = [end * scale for end in marks.ends]
    items: list[Item] = []
    requests: list[Request] = []
    facts: list[Fact] = []
    for end in ends:
        middle, radius = cmath.phase(end - centre), abs(end - centre)
        half = ARC_OVER / radius
        items += [Line(centre, end, style.CONSTRUCTION), Arc(centre, radius, middle - half, middle + half, style.THIN)]
    seen_from = [(centre, abs(ends[1] - centre) * BEYOND_BOTH)]
    if marks.pivot is not None:
        seen_from.append((marks.pivot * scale, ANGLE))
    for (at, radius), name in zip(seen_from, marks.angles, strict=True):
        start, turn = cmath.phase(ends[0] - at), cmath.phase((ends[1] - at) / (ends[0] - at))
        items.append(Arc(at, radius, start, start + turn, style.DIMENSION, style.DIMENSION_HEAD))
        middle = start + turn / 2
        requests.append(label(at + radius * polar(middle), name, prefer=(middle,), size=style.SMALL))
        facts.append(angle_told(name, turn))
    if marks.circle is not None:
        at, radius = marks.circle[0] * scale, abs(ends[0] - marks.circle[0] * scale)
        turns = sorted(cmath.phase((one - at) / (ends[0] - at)) for one in (*ends, centre))
        start, over = cmath.phase(ends[0] - at), ARC_OVER / radius
        items.append(Arc(at, radius, start + turns[0] - over, start + turns[-1] + over, style.NORMAL))
        requests.append(label(at + radius * polar(start + turns[0] - over), marks.circle[1], size=style.SMALL))
        reach = max(abs(one - centre) for one in (*ends, *(place for place, _ in seen_from)))
        if radius < FAR * reach:
            items += [style.point(at), Line(at, centre, style.CONSTRUCTION)]
            requests.append(label(at, Symbol("O"), gap=1.2))
    return Canvas(tuple(items), tuple(requests), tuple(facts))


def _covers(curve: Complexes, covered: Complexes) -> bool:
    """Return True if a curve lies on another one."""
    starts, steps = curve[:-1], np.diff(curve)
    sizes = np.where(np.abs(steps) > 0, np.abs(steps) ** 2, 1.0)

    def away(point: complex) -> float:
        off = point - starts
        share = np.clip((off * steps.conj()).real / sizes, 0.0, 1.0)
        return float(np.abs(off - share * steps).min())

    # Most curves differ at their first points.
    return all(away(point) < TOGETHER for point in covered)


def _radii(dense: Motion, centre: str, numbered: Sequence[str], scale: float) -> list[float]:
    """Return the radii (mm) of the circles that numbered points trace about the driver's centre, each once."""
    radii: list[float] = []
    for name in numbered:
        arms = dense.points[name].p[dense.reachable] - dense.points[centre].p[dense.reachable]
        sizes = np.abs(arms) * scale
        if sizes.size and np.ptp(sizes) < 1e-6 and not any(abs(r - sizes[0]) < 1e-3 for r in radii):
            radii.append(float(sizes[0]))
    return radii


def _axes(bones: Skeleton) -> list[Item]:
    """Return the axes of the ground guides, a little longer than the travel on them; equal ones are drawn once."""
    lines: list[Item] = []
    for slide in bones.slides:
        if slide.on == GROUND and abs(slide.high - slide.low) > 0:
            on = (slide.high - slide.low) / abs(slide.high - slide.low) * 8
            line = Line(slide.low - on, slide.high + on, style.AXIS)
            if line not in lines:
                lines.append(line)
    return lines


def _links(bones: Skeleton, pen: Pen, further: Sequence[str] = ()) -> list[Item]:
    """Return bars between the joints of each link; a plate if one of its `further` points lies off them.

    A link with a slideway reaches from its joint to the near end of the slideway, like a lever through its pivot.
    """
    result: list[Item] = []
    for link, names in bones.bars.items():
        own = [*names, *(name for name in further if bones.owners.get(name) == link and name not in names)]
        points = [bones.points[name] for name in own]
        for slide in bones.slides:
            if slide.on == link and points:
                points.append(min((slide.low, slide.high), key=lambda end: settled(abs(end - points[0]))))
        result += style.body(points, pen, fill=None)
    for slide in bones.slides:
        if slide.on != GROUND:
            result.append(Line(slide.low, slide.high, pen))
    return result


def _numbers(every: Sequence[Skeleton], numbers: Sequence[int], shows: PositionPlan) -> Canvas:
    """Draw dots at the numbered positions with their names; points that coincide share one label."""
    dots = [
        (every[k].points[name], Symbol(vocabulary.point(name).base, shows.label(k)))
        for name in shows.numbered
        for k in numbers
        if every[k].reached
    ]
    middle = sum(at for at, _ in dots) / len(dots) if dots else 0j
    items: list[Item] = []
    requests: list[Request] = []
    for group in coincident(dots, TOGETHER / shows.enlarged, lambda one: one[0]):
        at, names = group[0][0], [name for _, name in group]
        items.append(Circle(at, DOT, Pen(0.2), style.PAPER))
        out = (float(np.angle(at - middle)),) if abs(at - middle) > 1 else ()
        size = style.LABEL if len(group) < 3 else style.SMALL
        requests.append(label(at, *joined(names), prefer=out, gap=DOT + 0.5, size=size))
    return Canvas(tuple(items), tuple(requests))
