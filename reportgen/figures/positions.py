"""The position plan: all positions of a mechanism in one drawing, true to scale, with paths of points.

Also the mechanism at one position with the instant centres of its links.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from reportgen.figures import style
from reportgen.figures.draft import Draft, finish
from reportgen.figures.geometry import Complexes, clusters, polar, unit
from reportgen.figures.labels import Request, joined, label
from reportgen.figures.scene import Arc, Arrow, Circle, Content, Item, Line, Polyline, Scene, Stroke
from reportgen.figures.scheme import Looks, Skeleton, driver_arrow, driver_marks, mechanism, skeleton
from reportgen.mechanism.motion import Motion
from reportgen.mechanism.structure import GROUND, Crank, Linkage
from reportgen.notation import vocabulary
from reportgen.notation.expressions import Symbol

TOGETHER = 0.3
"""Points nearer than this (mm) share one label."""
CROWDED = 24
"""With more positions than this only the emphasised one is numbered."""
DOT = 0.55
VELOCITY, ANGLE = 20.0, 11.0
"""Length of a velocity's arrow and radius of an angle's arc (mm) beside instant centres."""
LEAST_ANGLE = 0.03
"""A smaller angle (radians) has no arc that can be seen."""
BEYOND = 3.0
"""How far (mm) a normal goes on beyond the centre."""


@dataclass(frozen=True, slots=True)
class PositionPlan:
    """What a position plan shows.

    `numbered` are points labelled with each position's number (A₁ … A₈), `paths` points whose curves are
    drawn from a dense motion, `emphasised` the index (from 0) of the position drawn heavy, if any;
    `labels` replaces the positions' numbers.
    """

    numbered: tuple[str, ...]
    paths: tuple[str, ...] = ()
    emphasised: int | None = None
    labels: tuple[str, ...] = ()

    def label(self, k: int) -> str:
        """What the position of index `k` (from 0) is called."""
        return self.labels[k] if self.labels else str(k + 1)


def position_plan(
    linkage: Linkage,
    motion: Motion,
    dense: Motion,
    scale: float,
    shows: PositionPlan,
    notes: Sequence[Content] = (),
    *,
    beside: Draft | None = None,
) -> Scene:
    """The scene, `scale` mm of paper per m, with a drawing `beside` it about the same origin (an indicator diagram)."""
    count = len(motion.driver)
    every = [skeleton(linkage, motion, k, scale) for k in range(count)]
    reached = [bones for bones in every if bones.reached]
    items: list[Item] = []
    requests: list[Request] = []
    # A point that carries numbers needs no name of its own.
    unnumbered = [name for name in shows.paths if name not in shows.numbered]
    if isinstance(linkage.driver, Crank):
        centre = linkage.driver.centre
        radii = _radii(dense, centre, shows.numbered, scale)
        items += [Circle(every[0].points[centre], radius, style.THIN) for radius in radii]
    items += [line for bones in reached[:1] for line in _axes(bones)]
    for bones in reached:
        items += _links(bones, style.THIN, shows.numbered)
    drawn: list[Complexes] = []
    for name in shows.paths:
        curve = dense.points[name].p[dense.reachable] * scale
        # Two points that describe one curve share its line, whose dashes would else fill each other's gaps.
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
            # The name of a path stands where it goes farthest out, or elsewhere along it.
            curve = dense.points[name].p[dense.reachable] * scale
            far = np.argsort(-np.abs(curve - curve.mean()), kind="stable")
            requests.append(
                label([complex(p) for p in curve[far][:: max(1, len(curve) // 10)]], vocabulary.point(name))
            )
    if reached:
        shown = shows.emphasised if shows.emphasised is not None and every[shows.emphasised].reached else None
        turning = driver_arrow(linkage, motion, every[shown] if shown is not None else reached[0])
        items += turning.items
        requests += turning.requests
    for name in reached[0].pivots if reached else ():
        items += style.pivot(reached[0].points[name])
        requests.append(label(reached[0].points[name], vocabulary.point(name), gap=style.JOINT + 0.4))
    numbers = range(count) if count <= CROWDED else [k for k in (shows.emphasised,) if k is not None]
    draft = Draft(tuple(items), tuple(requests)) + _numbers(every, numbers, shows)
    return finish(draft + beside if beside else draft, notes=notes)


@dataclass(frozen=True, slots=True)
class Centre:
    """The instant centre of a link, at `at` (mm), where the normals of the velocities of two `points` meet."""

    name: Content
    at: complex
    points: tuple[str, str]


@dataclass(frozen=True, slots=True)
class PlaneMotion:
    """A link in plane motion by two of its points: their velocities (any size), names of the angles with it."""

    points: tuple[str, ...]
    velocities: tuple[complex, ...]
    names: tuple[Content, ...]
    angles: tuple[Content, ...]


def centre_plan(
    linkage: Linkage,
    motion: Motion,
    index: int,
    scale: float,
    centres: Sequence[Centre],
    looks: Looks,
    moving: Sequence[PlaneMotion] = (),
) -> Scene:
    """The mechanism at position `index` of `motion` with its links' instant centres and the normals to them.

    Of links that are `moving` the velocities are drawn, not to scale, with their angles.
    """
    bones = skeleton(linkage, motion, index, scale)
    draft = mechanism(bones, (GROUND, *linkage.links), looks) + driver_marks(linkage, motion, bones)
    normals: list[Item] = []
    marks: list[Item] = []
    names: list[Request] = []
    for centre in centres:
        for start in (bones.points[name] for name in centre.points):
            way = centre.at - start
            if abs(way) > style.JOINT:
                normals.append(Line(start, centre.at + way / abs(way) * BEYOND, style.NORMAL))
        marks.append(Circle(centre.at, DOT, Stroke(0.2, style.RED), style.PAPER))
        names.append(label(centre.at, centre.name, gap=DOT + 0.5))
    whole = Draft((*normals, *draft.items, *marks), (*draft.requests, *names))
    return finish(whole + _inclined(bones, moving), notes=looks.notes)


def _inclined(bones: Skeleton, moving: Sequence[PlaneMotion]) -> Draft:
    """Velocities at their points and their angles with the links, counted from the way from base to point."""
    items: list[Item] = []
    requests: list[Request] = []
    drawn: list[str] = []
    for one in moving:
        base, end = (bones.points[name] for name in one.points)
        rod = unit(end - base)
        if one.velocities[1]:
            items.append(Line(end, end + rod * (ANGLE + BEYOND), style.CONSTRUCTION))
        for name, v, letter, angle in zip(one.points, one.velocities, one.names, one.angles, strict=True):
            if v == 0:
                continue
            at, along = bones.points[name], unit(v)
            if name not in drawn:
                drawn.append(name)
                items.append(Arrow(at, at + VELOCITY * along, style.ACTIVE, style.HEAD))
                requests.append(label(at + VELOCITY * along, letter, prefer=(float(np.angle(along)),)))
            start, turn = float(np.angle(rod)), float(np.angle(along / rod))
            if abs(turn) > LEAST_ANGLE:
                items.append(Arc(at, ANGLE, start, start + turn, style.DIMENSION, style.DIMENSION_HEAD))
            middle = at + ANGLE * polar(start + turn / 2)
            requests.append(label(middle, angle, prefer=(start + turn / 2,), size=style.SMALL))
    return Draft(tuple(items), tuple(requests))


def _covers(one: Complexes, other: Complexes) -> bool:
    """Whether a curve lies on another one."""
    starts, ways = one[:-1], np.diff(one)
    sizes = np.where(np.abs(ways) > 0, np.abs(ways) ** 2, 1.0)
    off = other[:, None] - starts
    share = np.clip((off * ways.conj()).real / sizes, 0.0, 1.0)
    return bool(np.abs(off - share * ways).min(axis=1).max(initial=0.0) < TOGETHER)


def _radii(dense: Motion, centre: str, numbered: Sequence[str], scale: float) -> list[float]:
    """Radii of the circles that numbered points describe about the driver's centre, each once."""
    radii: list[float] = []
    for name in numbered:
        arms = dense.points[name].p[dense.reachable] - dense.points[centre].p[dense.reachable]
        sizes = np.abs(arms) * scale
        if sizes.size and np.ptp(sizes) < 1e-6 and not any(abs(r - sizes[0]) < 1e-3 for r in radii):
            radii.append(float(sizes[0]))
    return radii


def _axes(bones: Skeleton) -> list[Item]:
    """The axes of the ground guides, a little longer than the ways on them; equal ones are drawn once."""
    lines: list[Item] = []
    for slide in bones.slides:
        if slide.on == GROUND and abs(slide.high - slide.low) > 0:
            on = (slide.high - slide.low) / abs(slide.high - slide.low) * 8
            line = Line(slide.low - on, slide.high + on, style.AXIS)
            if line not in lines:
                lines.append(line)
    return lines


def _links(bones: Skeleton, pen: Stroke, further: Sequence[str] = ()) -> list[Item]:
    """Bars between the joints of each link; a plate where one of its `further` points lies off them.

    A link with a slideway reaches from its joint to the way's near end, as a lever through its pivot does.
    """
    result: list[Item] = []
    for link, names in bones.bars.items():
        own = [*names, *(name for name in further if bones.owners.get(name) == link and name not in names)]
        points = [bones.points[name] for name in own]
        for slide in bones.slides:
            if slide.on == link and points:
                points.append(min((slide.low, slide.high), key=lambda end: abs(end - points[0])))
        result += style.body(points, pen, fill=None)
    for slide in bones.slides:
        if slide.on != GROUND:
            result.append(Line(slide.low, slide.high, pen))
    return result


def _numbers(every: Sequence[Skeleton], numbers: Sequence[int], shows: PositionPlan) -> Draft:
    """Dots at the numbered positions and their names, one label for points that coincide."""
    shown = [
        (every[k].points[name], Symbol(vocabulary.point(name).base, shows.label(k)))
        for name in shows.numbered
        for k in numbers
        if every[k].reached
    ]
    middle = sum(at for at, _ in shown) / len(shown) if shown else 0j
    items: list[Item] = []
    requests: list[Request] = []
    for group in clusters(shown, TOGETHER, lambda one: one[0]):
        at = group[0][0]
        items.append(Circle(at, DOT, Stroke(0.2), style.PAPER))
        out = (float(np.angle(at - middle)),) if abs(at - middle) > 1 else ()
        size = style.LABEL if len(group) < 3 else style.SMALL
        requests.append(label(at, *joined(name for _, name in group), prefer=out, gap=DOT + 0.5, size=size))
    return Draft(tuple(items), tuple(requests))
