"""Still scenes of an animated drawing at some of its samples; animations are made from them frame by frame.

Labels are placed as on a page: where fewest lines run through them, on no other label, and from one scene to the next
at the same place if that is hardly worse.  A label without a place is left out.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np

from reportgen.base.records import Record, replace
from reportgen.base.stable_digits import settled
from reportgen.drawing import Arc, Arrow, Circle, Content, Hatch, Item, Label, Line, Polyline, Scene, style
from reportgen.drawing.animation import (
    Animation,
    MovingBody,
    MovingItem,
    MovingName,
    MovingVector,
    Pane,
    Still,
    Track,
    scale_bars,
)
from reportgen.drawing.geometry import frame, moved, overlap, polar, rectangle, segments, unit
from reportgen.drawing.style import LABEL, SMALL

NOTHING = 0.02
"""A vector shorter than this (mm) is not drawn."""
SHORT = 3.0
"""A vector shorter than this (mm) has no label."""
SHARES = (0.5, 0.38, 0.62, 0.27, 0.73)
"""Places along a vector for its label."""
BESIDE = (0.9, 2.2)
"""Gap between a vector and its label (mm)."""
ABOUT = tuple(eighth * math.pi / 4 for eighth in (0, 1, -1, 2, -2, 3, -3, 4))
"""Directions from a point for its name, relative to its free side (rad)."""
FURTHER = (0.0, 1.2, 3.0)
"""Additional distances from it (mm)."""
BALANCED = 0.35
"""Largest sum of unit vectors at which a point counts as surrounded: it has no free side."""
RANK, STAYS = 0.06, 0.3
"""Cost of a later candidate and bonus for staying, relative to a line through the label."""
CLEAR = 0.25
"""Gap between two labels (mm)."""


class Moment(Record):
    """A sample of an animation's cycle, from 0."""

    animation: Animation
    sample: int

    def of(self, track: Track) -> complex:
        """Return a track's value (mm, rad), for a constant track, one that repeats every turn, or one of the cycle."""
        turn = self.animation.knots.size - 1
        if track.values.size == 1:
            return complex(track.values[0])
        repeats = track.values.size == turn + 1 and self.sample > turn
        return complex(track.values[self.sample % turn if repeats else self.sample])


def sample_at(animation: Animation, degrees: float) -> int:
    """Return the sample of the cycle that is nearest to a cycle angle (degrees)."""
    turn = min(int(degrees // 360.0), animation.turns - 1)
    return turn * (animation.knots.size - 1) + int(np.abs(animation.knots - (degrees - 360.0 * turn)).argmin())


def stills(animation: Animation, pane: Pane, samples: Sequence[int], layers: Collection[str] = ()) -> Iterator[Scene]:
    """Yield a scene of a pane at each of the `samples`, with the given layers visible.

    Labels and moving arrows and lines are enlarged as the pane requires (`Pane.enlargement`).
    """
    low, bars = scale_bars(pane, animation.units)
    size, foot = pane.high - low, complex(pane.high.real, pane.low.imag)
    visible = [item for item in pane.items if not item.layer or item.layer in layers]
    # The previous place of each label, by the index of its item.
    last: dict[int, int] = {}
    for sample in samples:
        now = Moment(animation, sample)
        number = round(now.of(pane.finer).real) if pane.finer else 0
        zoom = pane.scales[0].per / pane.scales[number].per if pane.finer else 1.0
        labels = _Labels(pane.low, pane.high, last)
        items: list[Item] = []
        for place, item in enumerate(visible):
            items += _drawn(item, now, zoom, pane.enlargement)
            if request := _request(item, now, zoom, pane.enlargement):
                labels.requests[place] = request
        items += labels.placed(items)
        # Items that are visible only in part, such as two teeth of a wheel, continue beyond the box, but not below the
        # bars.
        items.append(Polyline(rectangle((low + foot) / 2, size.real, (foot - low).imag), None, True, style.PAPER))
        for index, (scale, bar) in enumerate(bars):
            if index == number if pane.finer else not scale.layers or set(scale.layers) & set(layers):
                items += bar
        yield Scene(size.real, size.imag, tuple(moved(item, -low) for item in items))


def _drawn(item: MovingItem, now: Moment, zoom: float, enlargement: float) -> Iterator[Item]:
    """Yield the drawn items of an item, except its label."""
    match item:
        case Still(items):
            yield from items
        case MovingBody(items, at, angle):
            place = zoom * now.of(at)
            if cmath.isfinite(place):
                by = now.of(angle).real if angle is not None else 0.0
                yield from (moved(_turned(one, by), place) for one in items)
        case MovingVector(stroke=stroke):
            start, end = zoom * now.of(item.start), zoom * now.of(item.end)
            if not NOTHING < abs(end - start) < math.inf:
                return
            pen = replace(
                stroke, width=stroke.width * enlargement, dash=tuple(part * enlargement for part in stroke.dash)
            )
            if item.head:
                yield Arrow(start, end, pen, item.head * enlargement, item.name)
            else:
                yield Line(start, end + item.beyond * unit(end - start), pen)


class _Request(Record):
    """Requested label, its places in order of preference, and whether it is placed before others."""

    label: Label
    places: Sequence[complex]
    first: bool


def _request(item: MovingItem, now: Moment, zoom: float, enlargement: float) -> _Request | None:
    """Return the label of a vector beside it, that of a point about it; None without a label."""
    match item:
        case MovingVector(label=content) if content is not None:
            start, end = zoom * now.of(item.start), zoom * now.of(item.end)
            if SHORT < abs(end - start) < math.inf:
                label, half = _sized(content, SMALL * enlargement)
                across = 1j * unit(end - start)
                off = abs(across.real) * half.real + abs(across.imag) * half.imag
                sides = [(off + gap, share, side) for gap in BESIDE for share in SHARES for side in (1, -1)]
                places = [start + share * (end - start) + side * by * across for by, share, side in sides]
                return _Request(label, places, False)
        case MovingName(content, at, neighbours, gap):
            place = zoom * now.of(at)
            if cmath.isfinite(place):
                label, half = _sized(content, LABEL * enlargement)
                free = cmath.phase(_away(place, [zoom * now.of(one) for one in neighbours]))
                rays = [(gap * enlargement + further, polar(free + turn)) for further in FURTHER for turn in ABOUT]
                return _Request(label, [place + (by + _reach(half, ray)) * ray for by, ray in rays], True)
    return None


def _sized(content: Content, size: float) -> tuple[Label, complex]:
    label = Label(0j, content, size=size)
    return label, frame(label)[1]


def _reach(half: complex, direction: complex) -> float:
    """Return the distance (mm) from the middle of a box to its edge, along a unit vector."""
    return min(half.real / max(abs(direction.real), 1e-9), half.imag / max(abs(direction.imag), 1e-9))


def _away(place: complex, others: Sequence[complex]) -> complex:
    """Return the direction away from the points that a point is joined to; if they surround it, normal to the last of
    them.
    """
    directions = [unit(place - other) for other in others if 0.5 < abs(place - other) < math.inf]
    away = sum(directions, 0j)
    if abs(away) < BALANCED:
        away += 1j * directions[-1] if directions else 0.8 + 0.6j
    return away


@dataclass
class _Labels:
    """The labels of one scene during placement in the box from `low` to `high` (mm)."""

    low: complex
    high: complex
    last: dict[int, int]
    requests: dict[int, _Request] = field(default_factory=dict)

    def placed(self, drawn: Sequence[Item]) -> Iterator[Label]:
        strokes = segments(drawn)
        middles, halves = np.empty(0, complex), np.empty(0, complex)
        for number, request in sorted(self.requests.items(), key=lambda pair: not pair[1].first):
            half, places = frame(request.label)[1], settled(np.array(request.places, complex))
            lines = overlap(places, np.full(places.shape, half), strokes, 0.0).sum(axis=1)
            cost = lines + RANK * np.arange(places.size)
            if (before := self.last.get(number)) is not None:
                cost[before] -= STAYS
            off, room = places[:, None] - middles, half + halves + complex(CLEAR, CLEAR)
            taken = ((np.abs(off.real) < room.real) & (np.abs(off.imag) < room.imag)).any(axis=1)
            low, high = places - half - self.low, self.high - places - half
            cost[taken | (np.minimum(low.real, high.real) < 0) | (np.minimum(low.imag, high.imag) < 0)] = np.inf
            best = int(cost.argmin())
            if cost[best] < np.inf:
                self.last[number] = best
                middles, halves = np.append(middles, places[best]), np.append(halves, half)
                yield replace(request.label, at=complex(places[best]))


def _turned(item: Item, by: float) -> Item:
    """Return the item turned about the origin by an angle (rad); labels stay upright."""
    turning = cmath.rect(1.0, by)
    match item:
        case Line(start, end) | Arrow(start, end):
            return replace(item, start=start * turning, end=end * turning)
        case Circle(centre):
            return replace(item, centre=centre * turning)
        case Arc(centre, _, start, stop):
            return replace(item, centre=centre * turning, start=start + by, stop=stop + by)
        case Polyline(points):
            return replace(item, points=tuple(point * turning for point in points))
        case Hatch(points, turn=turn):
            return replace(item, points=tuple(point * turning for point in points), turn=turn + by)
        case Label(at):
            return replace(item, at=at * turning)
