"""Where labels stand: near their point, clear of every stroke and of each other.

Each label tries spots around its point, the preferred directions first, nearest first, and never one that is nearer
to a point that another label names.  The label with the fewest free spots chooses first.  If no spot nearby is free,
the label moves out and a short leader, which crosses no other, ties it to its point.  One that finds no room so
chooses first in a new attempt, said shorter if it can be; one that did so already shares the label of its neighbour.
The same figure always gets the same labels.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache, reduce

import numpy as np
from numpy.typing import NDArray

from reportgen.drawing import Circle, Content, Item, Label, Line, Scene, style
from reportgen.drawing.geometry import (
    Box,
    Complexes,
    Flags,
    Floats,
    Ink,
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
KEPT = 1024
"""For so many sizes of labels and sets of preferred directions the spots are cached."""
FIGURES = 16
"""Of so many figures the labels are kept: some are drawn once to see whether they fit and then again."""
PLACES = np.linspace(0.15, 0.95, 9)
"""Where on a leader it is seen whether it meets strokes, in shares of its length."""
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
LEFT_OUT = ()
"""Short for one of many marks of a curve: on a leader it may stand past others; without room it is left out."""


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


class _Taken:
    """The labels already placed, as boxes, and the leaders of some of them."""

    def __init__(self, frames: Sequence[tuple[complex, complex]], further: int) -> None:
        """The boxes of labels that stand where they are, with room for `further` ones."""
        self.count = len(frames)
        boxes = np.zeros((self.count + further, 2), dtype=np.complex128)
        boxes[: self.count] = np.reshape(frames, (-1, 2))
        self._centres, self._halves = boxes[:, 0], boxes[:, 1]
        self.leaders: list[Segment] = []

    @property
    def centres(self) -> Complexes:
        return self._centres[: self.count]

    @property
    def halves(self) -> Complexes:
        return self._halves[: self.count]

    def add(self, centre: complex, half: complex, leader: Segment | None) -> None:
        self._centres[self.count], self._halves[self.count] = centre, half
        self.count += 1
        if leader:
            self.leaders.append(leader)

    def clear(self, centres: Complexes, half: complex) -> Flags:
        """Which of the boxes keep apart from every label and leader."""
        apart, room = centres[:, None] - self.centres, self.halves + (half + APART * (1 + 1j))
        free: Flags = np.asarray(((np.abs(apart.real) >= room.real) | (np.abs(apart.imag) >= room.imag)).all(axis=1))
        if self.leaders:
            free &= ~_touched(centres, half, np.array(self.leaders))
        return free

    def crossed(self, leaders: Complexes) -> Flags:
        """Which leaders run through a label or another leader."""
        through: Flags = np.asarray(overlap(self.centres, self.halves, leaders, 0.2).any(axis=0))
        if self.leaders:
            through |= _crossings(leaders, np.array(self.leaders)) > 0
        return through


class _Field:
    """What is on paper before labels are placed: strokes, and the points that labels name, each with its label."""

    def __init__(self, items: Sequence[Item], requests: Sequence[Request]) -> None:
        self.ink = Ink(segments(items))
        self.points = np.array([point for request in requests for point in request.named], dtype=np.complex128)
        self.owners = np.repeat(np.arange(len(requests)), [len(request.named) for request in requests])

    def spots(self, requests: Mapping[int, Request]) -> dict[int, _Spots]:
        """The spots of some labels by their numbers; all their first ones are tested together."""
        offered = {i: _offered(request) for i, request in requests.items()}
        first = np.array([centres[:FIRST] for _, centres in offered.values()])
        half = np.array([half for half, _ in offered.values()])
        free = ~self.ink.touches(first, half[:, None] + CLEAR * (1 + 1j))
        row, spot = np.nonzero(free)
        free[row, spot] = self.nearest(first[row, spot], half[row], np.array(list(offered))[row])
        rows = zip(offered.items(), free, strict=True)
        return {i: _Spots(self, i, requests[i], half, centres, flags) for (i, (half, centres)), flags in rows}

    def nearest(self, centres: Complexes, half: Complexes, labels: Indices) -> Flags:
        """Where boxes [K] of labels are nearer to a point of their own than to any that another label names."""
        apart = centres[:, None] - self.points
        aside, above = np.abs(apart.real) - half.real[:, None], np.abs(apart.imag) - half.imag[:, None]
        away = np.hypot(np.maximum(aside, 0.0), np.maximum(above, 0.0))
        own = labels[:, None] == self.owners
        to_own = np.where(own, away, np.inf).min(axis=1, initial=np.inf)
        to_others = np.where(own, np.inf, away).min(axis=1, initial=np.inf)
        return np.asarray((to_own <= to_others) | ~own.any(axis=1))


@dataclass
class _Spots:
    """The spots a label may stand at, in the order of preference, and which of the first are free of strokes."""

    field: _Field
    number: int
    request: Request
    half: complex
    centres: Complexes
    first: Flags
    far: dict[complex, tuple[Complexes, Complexes]] = dataclasses.field(default_factory=dict)

    @property
    def room(self) -> int:
        """How many of the first spots are free of strokes."""
        return int(np.count_nonzero(self.first))

    def best(self, taken: _Taken) -> complex | None:
        """The first spot free of strokes, labels and leaders; None where there is none."""
        for start in range(0, len(self.centres), FIRST):
            free = self.first if start == 0 else self.free(self.centres[start : start + FIRST])
            centres = self.centres[start : start + FIRST][free]
            if centres.size and (clear := taken.clear(centres, self.half)).any():
                return complex(centres[int(np.argmax(clear))])
        return None

    def free(self, centres: Complexes, nearest: bool = True) -> Flags:
        """Which spots are free of strokes and nearest to their own point."""
        free: Flags = ~self.field.ink.touches(centres, np.array(self.half + CLEAR * (1 + 1j)))
        if nearest:
            free[free] = self.nearest(centres[free])
        return free

    def nearest(self, centres: Complexes) -> Flags:
        """Where the label is nearer to its own point than to any that another label names."""
        return self.field.nearest(centres, np.array([self.half]), np.array([self.number]))

    def beyond(self, at: complex) -> tuple[Complexes, Complexes]:
        """The free spots farther out from a point, the cheapest first, and their leaders [K, 2]."""
        if at not in self.far:
            offsets, cost, ways = _beyond(self.half, self.request.gap, self.request.prefer)
            free = self.free(at + offsets, self.request.short != LEFT_OUT)
            centres, leaders = at + offsets[free], at + ways[free]
            past = ~self.nearest(centres)
            order = np.argsort(cost[free] + 0.3 * _inked(self.field.ink, leaders) + past, kind="stable")
            self.far[at] = centres[order], leaders[order]
        return self.far[at]


def _offered(request: Request) -> tuple[complex, Complexes]:
    """Half the size of a label, and its spots [72 × points] nearby in the order of preference."""
    half = _half(request)
    spots = (np.array(request.points)[:, None] + _nearby(half, request.gap)).ravel()
    return half, spots[_ranking(request.prefer, len(request.points))]


@lru_cache(maxsize=FIGURES)
def place(items: tuple[Item, ...], requests: tuple[Request, ...]) -> tuple[tuple[Item, ...], list[tuple[Content, ...]]]:
    """Labels (and leaders) for the requests among the items, in their order, and the key's lines, each of parts."""
    field = _Field(items, requests)
    frames = [frame(item) for item in items if isinstance(item, Label)]
    spots = field.spots(dict(enumerate(requests))) if requests else {}
    order = sorted(spots, key=lambda i: (spots[i].room, i))
    first: set[int] = set()
    keyed: list[int] = []
    placed, crowded = _place_in(order, spots, frames)
    while crowded:
        before = len(first), len(spots)
        changed: dict[int, Request] = {}
        for i in crowded:
            request = changed.get(i) or spots[i].request
            if request.short is not None:
                keyed += [i] if request.short == KEY else []
                changed[i] = replace(request, parts=request.short, short=None)
            elif i in first and (to := _neighbour(i, spots)) is not None:
                pair = {j: changed.pop(j, spots[j].request) for j in sorted((i, to))}
                names = (replace(one, parts=requests[j].parts) if j in keyed else one for j, one in pair.items())
                changed[to] = _shared(*names)
                keyed = [j for j in keyed if j not in pair]
                field.owners[field.owners == i] = to
                del spots[i]
            first.add(i)
        for n, i in enumerate(keyed, 1):
            if (one := changed.get(i, spots[i].request)).parts != (str(n),):
                changed[i] = replace(one, parts=(str(n),))
        if changed:
            spots |= field.spots(changed)
        if before == (len(first), len(spots)):
            break
        order = [i for i in (*crowded, *(i for i in order if i not in crowded)) if i in spots]
        placed, crowded = _place_in(order, spots, frames)
    key = [(f"{number} – ", *requests[i].parts) for number, i in enumerate(keyed, 1)]
    return tuple(item for i in sorted(placed) for item in placed[i]), key


def _neighbour(i: int, spots: Mapping[int, _Spots]) -> int | None:
    """The label, of those that name points, whose point is the nearest to one that label `i` names."""
    own = spots[i].request.named
    others = [j for j, spot in spots.items() if spot.request.named and j != i]
    if not own:
        return None
    return min(others, key=lambda j: min(abs(p - q) for p in own for q in spots[j].request.named), default=None)


def _shared(one: Request, other: Request) -> Request:
    """One label for the points of two."""
    points, parts = (*one.points, *other.points), (*one.parts, ", ", *other.parts)
    gap, size = max(one.gap, other.gap), min(one.size, other.size)
    return replace(one, points=points, named=points, parts=parts, gap=gap, size=size, short=None)


def _place_in(
    order: Sequence[int], spots: Mapping[int, _Spots], frames: Sequence[tuple[complex, complex]]
) -> tuple[dict[int, tuple[Item, ...]], list[int]]:
    """The labels placed one after the other, and those for which no place is free."""
    taken = _Taken(frames, len(order))
    placed: dict[int, tuple[Item, ...]] = {}
    crowded: list[int] = []
    for i in order:
        spot = spots[i]
        request = spot.request
        centre, leader = (_away(spot, taken) if request.ring else None) or (spot.best(taken), None)
        if centre is None:
            found = _away(spot, taken)
            if found is None and request.short == LEFT_OUT:
                placed[i] = ()
                continue
            if found is None:
                crowded.append(i)
            centre, leader = found or _least_touched(spot, taken)
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


def _touched(centres: Complexes, half: complex, strokes: Complexes) -> Flags:
    """Which boxes come too close to any stroke."""
    return np.asarray(overlap(centres, np.array([half]), strokes, CLEAR).any(axis=1), dtype=np.bool_)


@lru_cache(maxsize=KEPT)
def _beyond(half: complex, gap: float, prefer: tuple[float, ...]) -> tuple[Complexes, Floats, Complexes]:
    """Of the spots farther out, the cheapest first, seen from their point: centres, costs and leaders [K, 2]."""
    centres = _ring(half, np.asarray(FAR) + gap).ravel()
    cost = (np.asarray(FAR)[:, None] * 0.2 + _turned(prefer)).ravel()
    leaders = _leaders(gap, centres, half)
    order = np.argsort(cost, kind="stable")
    order = order[np.abs(leaders[order, 1] - leaders[order, 0]) <= LONGEST]
    return centres[order], cost[order], leaders[order]


def _away(spot: _Spots, taken: _Taken) -> tuple[complex, Segment] | None:
    """The best free spot farther out, and the leader to it, which crosses no label; None where there is none.

    The leader starts at the label's first point, or at another one if no spot around the first is free.
    """
    for at in spot.request.points:
        centres, leaders = spot.beyond(at)
        some = np.flatnonzero(taken.clear(centres, spot.half))
        some = some[~taken.crossed(leaders[some])]
        if some.size:
            first, last = leaders[some[0]]
            return complex(centres[some[0]]), (complex(first), complex(last))
    return None


def _least_touched(spot: _Spots, taken: _Taken) -> tuple[complex, Segment]:
    """Where none is free: the cheapest spot farther out, off all labels if any is, then off strokes."""
    at, half = spot.request.points[0], spot.half
    offsets, cost, ways = _beyond(half, spot.request.gap, spot.request.prefer)
    centres = at + offsets
    touches = spot.field.ink.touches(centres, np.array(half))
    apart = taken.clear(centres, half) & ~taken.crossed(at + ways)
    best = int(np.argmin(cost + len(cost) * (touches + 2.0 * ~apart)))
    first, last = at + ways[best]
    return complex(centres[best]), (complex(first), complex(last))


def _leaders(gap: float, centres: Complexes, half: complex) -> Complexes:
    """From a point's edge to just before the nearest place on each box, seen from the point: segments [K, 2]."""
    foot = (centres.real - np.clip(centres.real, -half.real, half.real)) + 1j * (
        centres.imag - np.clip(centres.imag, -half.imag, half.imag)
    )
    u = foot / np.abs(foot)
    return np.column_stack((u * min(gap, 0.8), foot - u * (CLEAR + 0.1)))


def _crossings(leaders: Complexes, strokes: Complexes) -> Floats:
    """How many strokes each leader crosses."""

    def side(a: Complexes, b: Complexes, p: Complexes) -> Floats:
        return np.asarray(((b - a).conj() * (p - a)).imag)

    a, b = leaders[:, :1], leaders[:, 1:]
    c, d = strokes[:, 0], strokes[:, 1]
    across = (side(a, b, c) * side(a, b, d) < 0) & (side(c, d, a) * side(c, d, b) < 0)
    return np.asarray(across.sum(axis=1), dtype=np.float64)


def _inked(ink: Ink, leaders: Complexes) -> Floats:
    """At how many of `PLACES` each leader meets strokes: where it crosses one, or lies on it like a part of it."""
    places = leaders[:, :1] + (leaders[:, 1:] - leaders[:, :1]) * PLACES
    return np.asarray(ink.touches(places, np.array(0.25 + 0.25j)).sum(axis=1), dtype=np.float64)


# --- from drafts to finished scenes ---------------------------------------------------------------
# Every figure makes a `Canvas` in mm about any origin; drafts with the same origin can be added. `finish` places the
# labels, crops to the content and gives the `Scene`.

MARGIN = 6.0


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
    low, high = corners_of((low, high, *(bounds(below) if below else ())))
    white = complex(margin, margin)
    size = high + white - (low - white)
    items = tuple(moved(item, -(low - white)) for item in (*done.items, *below))
    return Scene(size.real, size.imag, items, title, margin)


def _notes(notes: Iterable[Sequence[Content]], x: float, y: float) -> tuple[Item, ...]:
    """Lines of text, each of several parts, centred on x, the first below y."""
    lines: list[Item] = []
    for note in notes:
        extent = reduce(Box.beside, (box(part, style.LABEL) for part in note))
        height = extent.height + extent.depth
        lines += _row(complex(x, y - height / 2), note, style.LABEL)
        y -= height + 1.5
    return tuple(lines)
