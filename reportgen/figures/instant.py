"""One instant of a system of bodies to scale: bodies, joints, guides, instant centres, velocities or accelerations."""

from __future__ import annotations

import cmath
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from reportgen.figures import style
from reportgen.figures.draft import Draft, finish, settle
from reportgen.figures.geometry import bounds, clusters
from reportgen.figures.labels import Request, joined, label
from reportgen.figures.scene import Arc, Arrow, Circle, Content, Item, Line, Scene, Stroke
from reportgen.notation import vocabulary
from reportgen.notation.expressions import Symbol

TOGETHER = 0.3
"""Points nearer than this (mm) share one label."""
GUIDE = 9.0
"""Half the length (mm) of the piece of a guide that is drawn, beside the block."""
WALL = 16.0
"""Half the length (mm) of the ground that a disc rolls on."""
BEYOND = 6.0
"""How far (mm) a guide on a body reaches beyond its points."""
CORNER, COORDINATE = 6.0, 9.0
"""How far left of the drawing (mm) the axes of the coordinates stand, and their length."""
BEFORE, AFTER = 5.0, 14.0
"""How far (mm) an axis of projection reaches beyond the points it is about, back and forward."""
AXIS_HEAD = 2.0
DRIVER_ARROW = 7.0
"""Radius (mm) of the arrow of an angular velocity."""
ARROWS_APART = 3.2
"""Between the arrows of several bodies about one point."""


@dataclass(frozen=True, slots=True)
class Rail:
    """A point guided along a direction; `block` where a slider's block is drawn, on the ground with its walls."""

    at: complex
    way: complex
    on_ground: bool


@dataclass(frozen=True, slots=True)
class Disc:
    centre: complex
    radius: float
    fixed: bool = False


@dataclass(frozen=True, slots=True)
class Ground:
    """Ground that a disc rolls on, at the point of contact; `out` points into the ground."""

    at: complex
    out: complex


@dataclass(frozen=True, slots=True)
class Rotation:
    """The sense of rotation of a body about a point."""

    at: complex
    sense: float
    symbol: Content


@dataclass(frozen=True, slots=True)
class Axis:
    """An axis of projection towards `way`, from `start` to `end` of the points it is about, which may be one."""

    symbol: Symbol
    way: complex
    start: complex
    end: complex


@dataclass(frozen=True, slots=True)
class Drawn:
    """A system in mm about any origin.

    `bodies` are the outlines, by the points of each; `joints` and `pivots` are names of points, others are dots.
    `normals` are lines from points to instant centres, `vectors` arrows by the point they start from, `axes` those that
    the solution projects on; with `coordinates` x and y are shown beside the drawing.
    """

    points: Mapping[str, complex]
    bodies: Mapping[int, Sequence[complex]]
    discs: Sequence[Disc] = ()
    pivots: Sequence[str] = ()
    joints: Sequence[str] = ()
    rails: Sequence[Rail] = ()
    slots: Sequence[tuple[complex, complex]] = ()
    """Lines on bodies along which others slide."""
    cords: Sequence[tuple[complex, complex]] = ()
    """Taut cords, and the straight parts of belts."""
    grounds: Sequence[Ground] = ()
    normals: Sequence[tuple[complex, complex]] = ()
    vectors: Sequence[tuple[complex, complex, Content]] = ()
    rotations: Sequence[Rotation] = ()
    axes: Sequence[Axis] = ()
    coordinates: bool = False
    pen: Stroke = field(default=style.ACTIVE)


def instant(drawn: Drawn, notes: Sequence[Content] = ()) -> Scene:
    """The scene, with what its vectors are measured with below."""
    items: list[Item] = []
    for ground in drawn.grounds:
        along = 1j * ground.out * WALL
        items += style.ground(ground.at + along, ground.at - along, 1)
    items += [Circle(disc.centre, disc.radius, style.THIN if disc.fixed else style.VISIBLE) for disc in drawn.discs]
    items += [Line(start, end, style.HEAVY) for start, end in drawn.slots]
    items += [Line(start, end, style.VISIBLE) for start, end in drawn.cords]
    for rail in drawn.rails:
        on = rail.way * GUIDE
        if rail.on_ground:
            items += style.guide(rail.at - on / 2, rail.at + on / 2, style.BLOCK)
        size = style.BLOCK if rail.on_ground else style.SMALL_BLOCK
        items.append(style.block(rail.at, cmath.phase(rail.way), size))
    for points in drawn.bodies.values():
        items += style.body(points)
    items += [Line(start, end, style.NORMAL) for start, end in drawn.normals]
    for axis in drawn.axes:
        tip = axis.end + AFTER * axis.way
        name = axis.symbol.base + axis.symbol.sub
        items.append(Arrow(axis.start - BEFORE * axis.way, tip, style.PROJECTION, AXIS_HEAD, name))
    for name, at in drawn.points.items():
        if name in drawn.pivots:
            items += style.pivot(at)
        else:
            items.append(style.joint(at) if name in drawn.joints else style.point(at))
    requests = _names(drawn.points)
    for start, end, symbol in drawn.vectors:
        items.append(Arrow(start, end, drawn.pen, style.HEAD))
        way = cmath.phase(end - start)
        places = [start + (end - start) * share for share in (1.0, 0.7, 0.5)]
        requests.append(label(places, symbol, prefer=(way + cmath.pi / 2, way - cmath.pi / 2), gap=0.8))
    for axis in drawn.axes:
        tip, across = axis.end + AFTER * axis.way, cmath.phase(1j * axis.way)
        requests.append(label((tip, tip - 2 * axis.way), axis.symbol, prefer=(across, across + cmath.pi), gap=0.8))
    for index, rotation in enumerate(drawn.rotations):
        start = 0.6 if rotation.sense > 0 else 2.5
        stop = start + rotation.sense * 1.9
        inner = sum(abs(other.at - rotation.at) < TOGETHER for other in drawn.rotations[:index])
        radius = DRIVER_ARROW + inner * ARROWS_APART
        items.append(Arc(rotation.at, radius, start, stop, Stroke(0.25), style.HEAD))
        ends = [rotation.at + radius * cmath.exp(1j * (start + (stop - start) * share)) for share in (0.5, 0.8, 0.2)]
        requests.append(label(ends, rotation.symbol, prefer=((start + stop) / 2,)))
    draft = settle(Draft(tuple(items), tuple(requests)))
    if drawn.coordinates:
        draft += _coordinates(draft)
    return finish(draft, notes=notes)


def _coordinates(draft: Draft) -> Draft:
    """The axes of the coordinates at the lower left corner of a drawing."""
    low, _ = bounds(draft.items)
    corner = low - CORNER - COORDINATE
    ends = {"x": corner + COORDINATE, "y": corner + 1j * COORDINATE}
    arrows = (Arrow(corner, end, style.PROJECTION, AXIS_HEAD, letter) for letter, end in ends.items())
    names = (label(end, Symbol(letter), prefer=(cmath.phase(end - corner),)) for letter, end in ends.items())
    return Draft((*arrows,), (*names,))


def _names(points: Mapping[str, complex]) -> list[Request]:
    """One label for points that coincide."""
    return [
        label(points[group[0]], *joined(map(vocabulary.point, group), " ≡ "), gap=style.JOINT + 0.5)
        for group in clusters(list(points), TOGETHER, points.__getitem__)
    ]
