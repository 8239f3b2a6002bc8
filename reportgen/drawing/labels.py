"""Where labels stand: near their point, clear of every stroke and of each other.

Each label tries spots around its point, the preferred directions first, nearest first, and never one that is nearer
to a point that another label names.  The label with the fewest free spots chooses first.  If no spot nearby is free,
the label moves out and a short leader, which crosses no other, ties it to its point; if that fails too, the labels
without room are said shorter and choose first in a new attempt.  The same figure always gets the same labels.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache, reduce
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from reportgen.drawing import Circle, Content, Item, Label, Line, Scene, style
from reportgen.drawing.geometry import (
    Box,
    Complexes,
    Flags,
    Floats,
    bounds,
    box,
    corners_of,
    frame,
    moved,
    overlap,
    segments,
)

Indices = NDArray[np.intp]
Segment = tuple[complex, complex]

DIRECTIONS = np.exp(2j * np.pi * np.arange(24) / 24)
CORNERS = np.clip(DIRECTIONS.real * math.sqrt(2), -1, 1) + 1j * np.clip(DIRECTIONS.imag * math.sqrt(2), -1, 1)
"""Where a box of half size 1 has its middle when the box stands off its point in each direction."""
NEAR = (0.0, 0.7, 1.6)
"""Extra distances (mm) at which a label still reads as belonging to its point."""
FAR = (2.6, 3.6, 4.8, 6.0, 7.2, 8.4, 9.6, 10.8, 12.0)
LONGEST = 12.0
"""A longer leader (mm) is not followed."""
CLEAR = 0.55
"""White kept between a label's ink and strokes; it also takes up what two typesetters differ by."""
FIRST = 72
"""This many spots are tested at once; the others only if none of these is free."""
CHEAPEST = 6
"""Of the spots farther out, this many are rated in full before the worse ones are left out."""
ATTEMPTS = 3
"""How often the labels that found no room may choose first."""
KEPT = 1024
"""For so many sizes of labels and sets of preferred directions the spots are cached."""
APART = 0.7
"""White kept between two labels."""


@dataclass(frozen=True, slots=True)
class Request:
    """A label to be placed, made by `label`."""

    points: tuple[complex, ...]
    parts: tuple[Content, ...]
    prefer: tuple[float, ...]
    gap: float
    size: float
    ring: bool
    named: tuple[complex, ...]
    short: tuple[Content, ...] | None


def label(
    at: complex | Sequence[complex],
    *parts: Content,
    prefer: Sequence[float] = (),
    gap: float = 0.6,
    size: float = style.LABEL,
    ring: bool = False,
    each: bool = False,
    short: Sequence[Content] | None = None,
) -> Request:
    """A label whose `parts` stand in a row on one baseline, near the point `at`.

    Of several points (places along an arrow, say) it belongs to the first, but may stand at any.  `prefer` are
    directions in radians, any where empty; `gap` is the distance in mm kept from the point itself (the radius of the
    circle drawn there).  A `ring` goes round a link's number, which stands on a leader.  A label that names its point,
    or `each` of several, stands nearer to it than to any point that another label names.  Where there is no room for
    it, what is `short` stands there: less, nothing, or the number of a `KEY`.
    """
    points = tuple(at) if isinstance(at, Sequence) else (at,)
    named = points if each or len(points) == 1 else ()
    less = None if short is None else tuple(short)
    return Request(points, parts, tuple(prefer), gap, size, ring=ring, named=named, short=less)


KEY = ("№",)
"""Short for a label: a number, which a line below the figure explains."""


def joined(contents: Iterable[Content], by: str = ", ") -> list[Content]:
    """Parts of one label: the contents with a separator between each two."""
    parts = [part for content in contents for part in (by, content)]
    return parts[1:]


def _row(at: complex, parts: Sequence[Content], size: float, over: bool = False) -> tuple[Label, ...]:
    """Labels side by side on one baseline, their common box centred on `at`; `over` lines they stand on paper."""
    boxes = [box(part, size) for part in parts]
    total = reduce(Box.beside, boxes)
    x = at.real - total.width / 2
    base = at.imag - (total.height - total.depth) / 2
    result = []
    for part, own in zip(parts, boxes, strict=True):
        centre = complex(x + own.width / 2, base + (own.height - own.depth) / 2)
        result.append(Label(centre, part, "center", size, background=over))
        x += own.width
    return tuple(result)


class _Ink:
    """The strokes of a figure with their bounding boxes, to find those near a place fast."""

    def __init__(self, strokes: Complexes) -> None:
        first, last = strokes[:, 0], strokes[:, 1]
        self.strokes = strokes
        self.left, self.right = np.minimum(first.real, last.real), np.maximum(first.real, last.real)
        self.low, self.high = np.minimum(first.imag, last.imag), np.maximum(first.imag, last.imag)

    def near(self, centres: Complexes, half: complex) -> Complexes:
        """Only the strokes that any of the boxes could touch."""
        x, y = half.real + CLEAR, half.imag + CLEAR
        keep = (self.left <= centres.real.max() + x) & (self.right >= centres.real.min() - x)
        keep &= (self.low <= centres.imag.max() + y) & (self.high >= centres.imag.min() - y)
        return np.asarray(self.strokes[keep])


class _Taken:
    """The labels already placed, as boxes, and the leaders of some of them."""

    def __init__(self, frames: Sequence[tuple[complex, complex]]) -> None:
        self.centres = [centre for centre, _ in frames]
        self.halves = [half for _, half in frames]
        self.leaders: list[Segment] = []

    def add(self, centre: complex, half: complex, leader: Segment | None) -> None:
        self.centres.append(centre)
        self.halves.append(half)
        if leader:
            self.leaders.append(leader)

    def clear(self, centres: Complexes, half: complex) -> Flags:
        """Which of the boxes keep apart from every label and leader."""
        free: Flags = np.ones(len(centres), dtype=np.bool_)
        if self.centres:
            apart = centres[:, None] - np.asarray(self.centres)
            room = np.asarray(self.halves) + (half + APART * (1 + 1j))
            free = ((np.abs(apart.real) >= room.real) | (np.abs(apart.imag) >= room.imag)).all(axis=1)
        if self.leaders:
            free &= ~_touched(centres, half, np.array(self.leaders))
        return free

    def crossed(self, leaders: Complexes) -> Flags:
        """Which leaders run through a label or another leader."""
        through = np.zeros(len(leaders), dtype=np.bool_)
        if self.centres:
            through |= overlap(np.array(self.centres), np.array(self.halves), leaders, 0.2).any(axis=0)
        if self.leaders:
            through |= _crossings(leaders, np.array(self.leaders)) > 0
        return through


class _Spots:
    """The spots a label may stand at, in the order of preference."""

    def __init__(self, request: Request, ink: _Ink, others: Complexes) -> None:
        self.request = request
        self.half = _half(request)
        self.own, self.others = np.array(request.points), others if request.named else others[:0]
        offsets = _nearby(self.half, request.gap)
        self.centres = (self.own[:, None] + offsets).ravel()[_ranking(request.prefer, len(self.own))]
        self.ink = ink
        self.first = self._free(0)

    @property
    def room(self) -> int:
        """How many of the first spots are free of strokes."""
        return int(np.count_nonzero(self.first))

    def best(self, taken: _Taken) -> complex | None:
        """The first spot free of strokes, labels and leaders; None where there is none."""
        for start in range(0, len(self.centres), FIRST):
            free = self.first if start == 0 else self._free(start)
            found = np.flatnonzero(free) + start
            if found.size and (clear := taken.clear(self.centres[found], self.half)).any():
                return complex(self.centres[found[int(np.argmax(clear))]])
        return None

    def _free(self, start: int) -> Flags:
        """Which of the next spots are free of strokes and nearest to their own point."""
        centres = self.centres[start : start + FIRST]
        free = ~_touched(centres, self.half, self.ink.near(centres, self.half))
        free[free] = self.nearest(centres[free])
        return free

    def nearest(self, centres: Complexes) -> Flags:
        """Where the label is nearer to its own point than to any that another label names."""
        return np.asarray(_distance(centres, self.half, self.own) <= _distance(centres, self.half, self.others))


def place(items: Sequence[Item], requests: Sequence[Request]) -> tuple[tuple[Item, ...], list[tuple[Content, ...]]]:
    """Labels (and leaders) for the requests among the items, in their order, and the key's lines, each of parts."""
    ink = _Ink(segments(items))
    frames = [frame(item) for item in items if isinstance(item, Label)]
    named = np.array([point for request in requests for point in request.named])
    spots = {i: _Spots(request, ink, named) for i, request in enumerate(requests)}
    order = sorted(spots, key=lambda i: (spots[i].room, i))
    placed, crowded = _place_in(order, spots, frames)
    keyed: list[int] = []
    for _ in range(ATTEMPTS):
        if not crowded:
            break
        # What found no room is said shorter and chooses first.
        for i in sorted(crowded):
            short = requests[i].short
            if short == KEY and i not in keyed:
                keyed.append(i)
                short = (str(len(keyed)),)
            if short and spots[i].request.short is not None:
                spots[i] = _Spots(replace(requests[i], parts=short, short=None), ink, named)
        order = [*crowded, *(i for i in order if i not in crowded)]
        placed, crowded = _place_in(order, spots, frames)
    key = [(f"{number} – ", *requests[i].parts) for number, i in enumerate(keyed, 1)]
    return tuple(item for i in range(len(requests)) for item in placed[i]), key


def _place_in(
    order: Sequence[int], spots: Mapping[int, _Spots], frames: Sequence[tuple[complex, complex]]
) -> tuple[dict[int, tuple[Item, ...]], list[int]]:
    """The labels placed one after the other, and those for which no place is free."""
    taken = _Taken(frames)
    placed: dict[int, tuple[Item, ...]] = {}
    crowded: list[int] = []
    for i in order:
        spot = spots[i]
        request = spot.request
        away = _away(spot, taken) if request.ring else None
        centre, leader = away[:2] if away and away[2] else (spot.best(taken), None)
        if centre is None:
            centre, leader, free = away or _away(spot, taken)
            if not free and request.short == ():
                placed[i] = ()
                continue
            if not free:
                crowded.append(i)
        labels: tuple[Item, ...] = _row(centre, request.parts, request.size, over=i in crowded)
        if request.ring:
            labels = (Circle(centre, spot.half.real, style.THIN), *labels)
        if leader:
            labels = (Line(*leader, style.LEADER), *labels)
        taken.add(centre, spot.half, leader)
        placed[i] = labels
    return placed, crowded


def _half(request: Request) -> complex:
    total = reduce(Box.beside, (box(part, request.size) for part in request.parts))
    half = complex(total.width, total.height + total.depth) / 2
    return (abs(half) + 0.4) * (1 + 1j) if request.ring else half


def _ring(half: complex, distances: Floats) -> Complexes:
    """Offsets [D, 24] of a box from its point: its nearest edge or corner at the distance."""
    return np.asarray(CORNERS.real * half.real + 1j * CORNERS.imag * half.imag + distances[:, None] * DIRECTIONS)


@lru_cache(maxsize=KEPT)
def _nearby(half: complex, gap: float) -> Complexes:
    """Offsets [72] at the near distances; cached, since names recur from plan to plan."""
    return _ring(half, np.asarray(NEAR) + gap).ravel()


@lru_cache(maxsize=KEPT)
def _ranking(prefer: tuple[float, ...], anchors: int) -> Indices:
    """The order [72 × anchors] of nearby spots: the first point and the preferred directions first."""
    cost = (np.asarray(NEAR)[:, None] * 0.45 + _turned(prefer)).ravel()
    total = (0.25 * np.arange(anchors)[:, None] + cost).ravel()
    return np.argsort(total, kind="stable")


def _turned(prefer: tuple[float, ...]) -> Floats:
    """How far each direction is from the nearest preferred one: 0 … 2."""
    if not prefer:
        # Free choice: up and to the right reads best.
        return np.asarray(0.35 * (1 - (DIRECTIONS * np.exp(-0.25j * np.pi)).real))
    wanted = np.exp(-1j * np.asarray(prefer))
    return np.asarray((1 - (DIRECTIONS[:, None] * wanted).real).min(axis=1))


def _distance(centres: Complexes, half: complex, points: Complexes) -> Floats:
    """From each box to the nearest of some points, mm; infinite for none."""
    apart = centres[:, None] - points
    aside, above = np.abs(apart.real) - half.real, np.abs(apart.imag) - half.imag
    return np.asarray(np.hypot(np.maximum(aside, 0.0), np.maximum(above, 0.0)).min(axis=1, initial=math.inf))


def _touched(centres: Complexes, half: complex, strokes: Complexes) -> Flags:
    """Which boxes come too close to any stroke."""
    return np.asarray(overlap(centres, np.array([half]), strokes, CLEAR).any(axis=1), dtype=np.bool_)


def _away(spot: _Spots, taken: _Taken) -> tuple[complex, Segment, bool]:
    """The nearest free spot farther out, the leader to it, which crosses no label, and whether it is free.

    The leader starts at the label's first point, or at another one if no spot around the first is free.
    """
    tried = (_off(spot, at, taken) for at in spot.request.points)
    first = next(tried)
    return first if first[2] else next((other for other in tried if other[2]), first)


def _off(spot: _Spots, at: complex, taken: _Taken) -> tuple[complex, Segment, bool]:
    """As `_away`, around one point of the label."""
    request, half = spot.request, spot.half
    centres = (at + _ring(half, np.asarray(FAR) + request.gap)).ravel()
    cost = (np.asarray(FAR)[:, None] * 0.2 + _turned(request.prefer)).ravel()
    leaders = _leaders(at, request.gap, centres, half)
    near = spot.ink.near(centres, half)
    apart = np.flatnonzero(np.abs(leaders[:, 1] - leaders[:, 0]) <= LONGEST)
    apart = apart[taken.clear(centres[apart], half)]
    apart = apart[~taken.crossed(leaders[apart])]
    free = apart[~_touched(centres[apart], half, near)]
    nearest = free[spot.nearest(centres[free])]
    # If any spot is free, only free spots are rated, and of these only those nearest to their own point.
    rated = next(spots for spots in (nearest, free, apart, np.arange(len(centres))) if spots.size)
    if not free.size:
        cost[rated] += overlap(centres[rated], np.array([half]), near, CLEAR).sum(axis=1)

    def full_cost(spots: Indices) -> Floats:
        tried = leaders[spots]
        return np.asarray(cost[spots] + 0.3 * _crossings(tried, near) + 0.8 * _grazes(tried, near))

    # Crossings only add to the cost: a spot dearer without them than another with them cannot be best.
    cheapest = rated[np.argsort(cost[rated], kind="stable")[:CHEAPEST]]
    rated = rated[cost[rated] <= full_cost(cheapest).min()]
    best = int(rated[np.argmin(full_cost(rated))])
    # What may be said shorter rather stands beside its point.
    room = nearest if request.short else free
    return complex(centres[best]), (complex(leaders[best, 0]), complex(leaders[best, 1])), best in room


def _leaders(at: complex, gap: float, centres: Complexes, half: complex) -> Complexes:
    """From the point's edge to just before the nearest place on each box: segments [K, 2]."""
    away = centres - at
    foot = (away.real - np.clip(away.real, -half.real, half.real)) + 1j * (
        away.imag - np.clip(away.imag, -half.imag, half.imag)
    )
    u = foot / np.abs(foot)
    return np.column_stack((at + u * min(gap, 0.8), at + foot - u * (CLEAR + 0.1)))


def _crossings(leaders: Complexes, strokes: Complexes) -> Floats:
    """How many strokes each leader crosses."""

    def side(a: Complexes, b: Complexes, p: Complexes) -> Floats:
        return np.asarray(((b - a).conj() * (p - a)).imag)

    a, b = leaders[:, :1], leaders[:, 1:]
    c, d = strokes[:, 0], strokes[:, 1]
    across = (side(a, b, c) * side(a, b, d) < 0) & (side(c, d, a) * side(c, d, b) < 0)
    return np.asarray(across.sum(axis=1), dtype=np.float64)


def _grazes(leaders: Complexes, strokes: Complexes) -> Floats:
    """At how many of four places each leader lies on a stroke and would be taken for part of it."""
    shares = np.array([0.35, 0.55, 0.75, 0.95])
    places = leaders[:, :1] + (leaders[:, 1:] - leaders[:, :1]) * shares
    on = overlap(places.ravel(), np.array([0.25 + 0.25j]), strokes, 0.0).any(axis=1)
    return np.asarray(on.reshape(places.shape).sum(axis=1), dtype=np.float64)


# --- from drafts to finished scenes, and scenes of one scale together on sheets of paper ------------
# Every figure makes a `Canvas` in mm about any origin; drafts with the same origin can be added. `finish` places the
# labels, crops to the content and gives the `Scene`.

Part = TypeVar("Part")

MARGIN = 6.0
TITLE_HEIGHT = 4.5
NOTE_HEIGHT = 6.0
TRIM = 3.5
"""What of a drawing's white margin (mm, each side) its neighbours on a sheet may use."""


@dataclass(frozen=True, slots=True)
class Canvas:
    """Items in the order of painting and the labels still to be placed."""

    items: tuple[Item, ...] = ()
    requests: tuple[Request, ...] = ()

    def __add__(self, other: Canvas) -> Canvas:
        return Canvas(self.items + other.items, self.requests + other.requests)

    def moved(self, by: complex) -> Canvas:
        """The draft shifted by a vector; its labels must have been placed before."""
        return Canvas(tuple(moved(item, by) for item in self.items))


def settle(draft: Canvas) -> Canvas:
    """The draft with its labels placed."""
    return Canvas(draft.items + place(draft.items, draft.requests)[0])


def finish(
    draft: Canvas,
    *,
    notes: Sequence[Content] = (),
    title: str = "",
    margin: float = MARGIN,
    frame: tuple[complex, complex] | None = None,
) -> Scene:
    """The scene: labels placed, `notes` (the figure's scale) below, cropped with `margin` mm around.

    `frame` (lower left, upper right) is kept even where nothing is drawn, so that several scenes get
    the same paper.
    """
    labels, key = place(draft.items, draft.requests)
    done = Canvas(draft.items + labels)
    low, high = corners_of((*bounds(done.items), *(frame or ())))
    below = _notes([*key, *((note,) for note in notes)], (low.real + high.real) / 2, low.imag - 3.0)
    low, high = corners_of((low, high, *bounds((*done.items, *below))))
    white = complex(margin, margin)
    size = high + white - (low - white)
    items = tuple(moved(item, -(low - white)) for item in (*done.items, *below))
    return Scene(size.real, size.imag, items, title)


def _notes(notes: Iterable[Sequence[Content]], x: float, y: float) -> tuple[Item, ...]:
    """Lines of text, each of several parts, centred on x, the first below y."""
    lines: list[Item] = []
    for note in notes:
        extent = reduce(Box.beside, (box(part, style.LABEL) for part in note))
        height = extent.height + extent.depth
        lines += _row(complex(x, y - height / 2), note, style.LABEL)
        y -= height + 1.5
    return tuple(lines)


def sheets(
    scenes: Sequence[Scene], width: float, height: float, note: Content | None = None, trim: float = TRIM
) -> tuple[Scene, ...]:
    """The scenes in true size on as many sheets of `width` × `height` mm as they need.

    Rows are filled in order and spread over the width; each scene's title stands below it and `note` (the
    common scale) below all.  Of each scene's margin `trim` mm are given up.  A scene larger than the sheet
    gets one of its own size.
    """
    foot = NOTE_HEIGHT if note is not None else 0.0

    def wide(scene: Scene) -> float:
        return scene.width - 2 * trim

    def high(row: Sequence[Scene]) -> float:
        return max(scene.height for scene in row) - 2 * trim + TITLE_HEIGHT

    def sheet(rows: Sequence[Sequence[Scene]]) -> Scene:
        """As high as its rows; the scenes of a row stand on a common base line."""
        across = max(width, *(sum(map(wide, row)) for row in rows))
        top = full = foot + sum(map(high, rows))
        items: list[Item] = []
        for row in rows:
            top -= high(row)
            x = space = (across - sum(map(wide, row))) / (len(row) + 1)
            for scene in row:
                corner = complex(x - trim, top + TITLE_HEIGHT - trim)
                items += [moved(item, corner) for item in scene.items]
                if scene.title:
                    items.append(Label(complex(x + wide(scene) / 2, top + TITLE_HEIGHT / 2), scene.title))
                x += wide(scene) + space
        if note is not None:
            items.append(Label(complex(across / 2, NOTE_HEIGHT / 3), note))
        return Scene(across, full, tuple(items))

    rows = _filled(scenes, wide, width)
    return tuple(map(sheet, _filled(rows, high, height - foot)))


def _filled(parts: Iterable[Part], size: Callable[[Part], float], room: float) -> list[list[Part]]:
    """The parts in groups, in order, each group as large as the room allows."""
    groups: list[list[Part]] = []
    for part in parts:
        if groups and sum(map(size, groups[-1])) + size(part) <= room:
            groups[-1].append(part)
        else:
            groups.append([part])
    return groups
