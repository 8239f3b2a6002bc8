"""Place labels near their points, clear of every stroke and of each other (`place`); make requests with `label`.

Each label tries candidates around its point, preferred directions first, nearest first, and never one that is nearer to
a point that another label names.  The label with the fewest free candidates chooses first.  If no candidate nearby is
free, the label moves out and a short leader, which crosses no other, connects it to its point.  A label still without
room chooses first in a new attempt, shortened if possible; if that is not enough it breaks gray construction lines,
like the number of a dimension, where it hides least of them.  Labels are never merged. The same figure always gets the
same labels.
"""

from __future__ import annotations

import dataclasses
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache, reduce

import numpy as np

from reportgen.base.arrays import Complexes, Flags, Floats
from reportgen.base.records import Record, replace
from reportgen.base.stable_digits import settled
from reportgen.drawing import Arc, Circle, Content, Item, Label, Line, Pen, Polyline, style
from reportgen.drawing.geometry import Ink, frame, overlap, segments
from reportgen.drawing.label_candidates import (
    CLEAR,
    FINE,
    LEADERLESS,
    Indices,
    around,
    beyond,
    crossings,
    distances,
    inked,
    nearby,
    ranking,
    touched,
)
from reportgen.drawing.label_size import Box, box
from reportgen.drawing.style import Segment

FIRST = 72
"""Number of candidates that are tested first; the others are tested only if none of these is free."""
FIGURES = 16
"""Number of figures whose labels are cached: some are drawn twice, first to see whether they fit."""
HIDING = 0.05
"""Cost of hiding a cell of gray lines: four of them cost as much as a millimetre of distance."""
ASIDE, BY = 1.6, 0.9
"""Least distances (mm) from other labels' points, of a label connected only by its leader, and of the leader."""
LED = 2
"""Number of failed attempts after which a label may be connected to its point by its leader alone."""
APART = 0.7
"""Gap between two labels (mm)."""


class Request(Record):
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
    """Return a request for a label whose `parts` are in a row on one baseline, near the point `at` (mm).

    Given several points (places along an arrow, say), it belongs to the first, but may be placed at any.  `prefer` are
    directions (rad), any if empty; `gap` is the distance (mm) from the point itself (the radius of the circle drawn
    there).  A `ring` surrounds a link's number, which has a leader.  A label that names its point, or `each` of
    several, is nearer to it than to any point that another label names.  If it has no room, `short` replaces it: less,
    nothing, or the number of a `KEY`.
    """
    points = tuple(at) if isinstance(at, Sequence) else (at,)
    named = points if each or len(points) == 1 else ()
    less = None if short is None else tuple(short)
    return Request(points, parts, tuple(prefer), gap, size, ring=ring, named=named, short=less)


KEY = ("№",)
"""Short form of a label: a number, which a line below the figure explains."""
LEFT_OUT = ()
"""Short form of one of many marks of a curve: on a leader it may be beyond others; without room it is left out."""


def joined(contents: Iterable[Content], by: str = ", ") -> list[Content]:
    """Return the contents as parts of one label, with a separator between each two."""
    parts = [part for content in contents for part in (by, content)]
    return parts[1:]


def label_row(at: complex, parts: Sequence[Content], size: float, over: bool = False) -> tuple[Label, ...]:
    """Return labels side by side on a baseline, their common box centred on `at` (mm); with `over`, on white paper."""
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
        """Collect the boxes of fixed labels, with room for `further` ones."""
        self.count = len(frames)
        boxes = np.zeros((self.count + further, 2), dtype=np.complex128)
        boxes[: self.count] = np.reshape(frames, (-1, 2))
        self._centres, self._halves = boxes[:, 0], boxes[:, 1]
        self.leaders: list[Segment] = []

    @property
    def centres(self) -> Complexes:
        """Return the centres of the boxes of all placed labels (mm) [N]."""
        return self._centres[: self.count]

    @property
    def halves(self) -> Complexes:
        """Return half their sizes (mm) [N]."""
        return self._halves[: self.count]

    def add(self, centre: complex, half: complex, leader: Segment | None) -> None:
        """Enter a label by its centre and half size (mm), with its leader."""
        self._centres[self.count], self._halves[self.count] = centre, half
        self.count += 1
        if leader:
            self.leaders.append(leader)

    def clear(self, centres: Complexes, half: complex) -> Flags:
        """Return flags of the boxes [N] (mm) that are clear of every label and leader."""
        apart, room = centres[:, None] - self.centres, self.halves + (half + APART * (1 + 1j))
        free: Flags = np.asarray(((np.abs(apart.real) >= room.real) | (np.abs(apart.imag) >= room.imag)).all(axis=1))
        if self.leaders:
            free &= ~touched(centres, half, np.array(self.leaders))
        return free

    def crossed(self, leaders: Complexes) -> Flags:
        """Return flags of the leaders [K, 2] (mm) that run through a label or another leader."""
        through: Flags = np.asarray(overlap(self.centres, self.halves, leaders, 0.2).any(axis=0))
        if self.leaders:
            through |= crossings(leaders, np.array(self.leaders)) > 0
        return through


class _Field:
    """Paper before labels are placed: strokes, and the points that labels name, each with its label."""

    def __init__(self, items: Sequence[Item], requests: Sequence[Request]) -> None:
        self.items = items
        self.ink = Ink(segments(items))
        self.points = np.array([point for request in requests for point in request.named], dtype=np.complex128)
        self.owners = np.repeat(np.arange(len(requests)), [len(request.named) for request in requests])

    @cached_property
    def firm(self) -> Ink:
        """Return the strokes that no label may break: all except gray lines."""
        return Ink(segments(item for item in self.items if not _breakable(item)))

    def spots(self, requests: Mapping[int, Request]) -> dict[int, _Spots]:
        """Return the candidates of labels by their numbers; the first ones of all are tested together."""
        offered = {i: _offered(request) for i, request in requests.items()}
        first = np.array([centres[:FIRST] for _, centres in offered.values()])
        half = np.array([half for half, _ in offered.values()])
        free = ~self.ink.touches(first, half[:, None] + CLEAR * (1 + 1j))
        row, spot = np.nonzero(free)
        free[row, spot] = self.nearest(first[row, spot], half[row], np.array(list(offered))[row])
        rows = zip(offered.items(), free, strict=True)
        return {i: _Spots(self, i, requests[i], half, centres, flags) for (i, (half, centres)), flags in rows}

    def nearest(self, centres: Complexes, half: Complexes, labels: Indices) -> Flags:
        """Return flags of the boxes [K] of labels nearer to a point of their own than to any that another label
        names.
        """
        to_own, to_others = self.away(centres, half, labels)
        return np.asarray((to_own <= to_others) | np.isinf(to_own))

    def away(self, centres: Complexes, half: Complexes, labels: Indices) -> tuple[Floats, Floats]:
        """Return the distances of boxes [K] of labels from the nearest of their own points, and of those of others
        (mm).
        """
        apart = centres[:, None] - self.points
        aside, above = np.abs(apart.real) - half.real[:, None], np.abs(apart.imag) - half.imag[:, None]
        away = settled(np.hypot(np.maximum(aside, 0.0), np.maximum(above, 0.0)))
        own = labels[:, None] == self.owners
        to_own, to_others = np.where(own, away, np.inf), np.where(own, np.inf, away)
        return to_own.min(axis=1, initial=np.inf), to_others.min(axis=1, initial=np.inf)


@dataclass
class _Spots:
    """Candidate places of a label in order of preference, with flags of the first ones that are free of strokes."""

    field: _Field
    number: int
    request: Request
    half: complex
    centres: Complexes
    first: Flags
    far: dict[complex, tuple[Complexes, Complexes]] = dataclasses.field(default_factory=dict)
    over: dict[bool, tuple[Complexes, Complexes, Flags]] = dataclasses.field(default_factory=dict)

    @property
    def room(self) -> int:
        """Return the number of first candidates that are free of strokes."""
        return int(np.count_nonzero(self.first))

    def best(self, taken: _Taken) -> complex | None:
        """Return the first candidate (mm) free of strokes, labels and leaders; None without one."""
        for start in range(0, len(self.centres), FIRST):
            free = self.first if start == 0 else self.free(self.centres[start : start + FIRST])
            centres = self.centres[start : start + FIRST][free]
            if centres.size and (clear := taken.clear(centres, self.half)).any():
                return complex(centres[int(np.argmax(clear))])
        return None

    def free(self, centres: Complexes, nearest: bool = True) -> Flags:
        """Return flags of the spots [N] (mm) that are free of strokes and nearest to their own point."""
        free: Flags = ~self.field.ink.touches(centres, np.array(self.half + CLEAR * (1 + 1j)))
        if nearest:
            free[free] = self.nearest(centres[free])
        return free

    def nearest(self, centres: Complexes) -> Flags:
        """Return flags [N] of the places nearer to the label's own point (mm) than to any that another label names."""
        return self.field.nearest(centres, np.array([self.half]), np.array([self.number]))

    def beyond(self, at: complex) -> tuple[Complexes, Complexes]:
        """Return the free candidates farther out from a point, the cheapest first, and their leaders [K, 2]."""
        if at not in self.far:
            offsets, cost, lines = beyond(self.half, self.request.gap, self.request.prefer)
            free = self.free(at + offsets, self.request.short != LEFT_OUT)
            centres, leaders = at + offsets[free], at + lines[free]
            past = ~self.nearest(centres)
            order = np.argsort(settled(cost[free] + 0.3 * inked(self.field.ink, leaders) + past), kind="stable")
            self.far[at] = centres[order], leaders[order]
        return self.far[at]

    def breaking(self, taken: _Taken, led: bool) -> tuple[complex, Segment | None] | None:
        """Return the best candidate (mm), clear of labels, that hides gray lines, and its leader if it is far; None
        without one.
        """
        if led not in self.over:
            self.over[led] = self._over(led)
        centres, leaders, near = self.over[led]
        some = np.flatnonzero(taken.clear(centres, self.half))
        some = some[near[some] | ~taken.crossed(leaders[some])]
        if not some.size:
            return None
        first, last = leaders[some[0]]
        return complex(centres[some[0]]), None if near[some[0]] else (complex(first), complex(last))

    def _over(self, led: bool) -> tuple[Complexes, Complexes, Flags]:
        """Return spots that touch gray lines alone, those that hide least first, and their leaders [K, 2], with
        flags.

        With `led`, a spot is nearer to another's point, but clear of it, and no other point is near its leader.
        """
        field, half, points = self.field, self.half, self.request.points
        offsets, cost, lines = around(half, self.request.gap, self.request.prefer)
        centres = np.concatenate([at + offsets for at in points])
        free = np.flatnonzero(~field.firm.touches(centres, np.array(half + CLEAR * (1 + 1j))))
        leaders, centres = np.concatenate([at + lines for at in points])[free], centres[free]
        near = free % len(offsets) < len(FINE) * LEADERLESS
        if led:
            others = field.points[field.owners != self.number]
            fit = ~near & (field.away(centres, np.array([half]), np.array([self.number]))[1] > ASIDE)
            fit[fit] = distances(leaders[fit], others).min(axis=1, initial=np.inf) > BY
        else:
            fit = self.nearest(centres)
        centres, leaders, near, costs = centres[fit], leaders[fit], near[fit], cost[free[fit] % len(offsets)]
        # A leader along a line would look like a part of it.
        costs = costs + np.where(near, 0.0, 0.1 * inked(field.ink, leaders) ** 2)
        order = np.argsort(settled(costs + HIDING * field.ink.covered(centres, np.array(half))), kind="stable")
        return centres[order], leaders[order], near[order]


def _breakable(item: Item) -> bool:
    """Return True if an item is a line of construction, which letters may break."""
    match item:
        case Line(stroke=stroke) | Arc(stroke=stroke, head=0.0):
            return stroke.colour == style.GRAY
        case Circle(stroke=Pen(colour=style.GRAY), fill=None) | Polyline(stroke=Pen(colour=style.GRAY), fill=None):
            return True
        case _:
            return False


def _offered(request: Request) -> tuple[complex, Complexes]:
    """Return half the size of a label (mm), and its nearby candidates [72 × points] in order of preference."""
    half = _half(request)
    spots = (np.array(request.points)[:, None] + nearby(half, request.gap)).ravel()
    return half, spots[ranking(request.prefer, len(request.points))]


class Placed(Record):
    """The labels of a figure, the lines of its key, each of parts, and True if the figure is too small for them.

    If it is `crowded`, some label is connected to its point only by its leader, or hides more than gray lines.
    """

    items: tuple[Item, ...]
    key: Sequence[tuple[Content, ...]]
    crowded: bool


@lru_cache(maxsize=FIGURES)
def place(items: tuple[Item, ...], requests: tuple[Request, ...]) -> Placed:
    """Place the labels of all requests, clear of the items, and return them with their leaders, in order.

    The module docstring describes the order of attempts.  Results are cached.
    """
    requests = tuple(map(_settled, requests))
    field = _Field(items, requests)
    frames = [(settled(centre), settled(half)) for centre, half in map(frame, _labels(items))]
    spots = field.spots(dict(enumerate(requests))) if requests else {}
    order = sorted(spots, key=lambda i: (spots[i].room, i))
    pressed: Counter[int] = Counter()
    keyed: list[int] = []
    placed, crowded = _place_in(order, spots, frames, pressed)
    while crowded:
        changed: dict[int, Request] = {}
        for i in crowded:
            request = spots[i].request
            if request.short is not None:
                keyed += [i] if request.short == KEY else []
                changed[i] = replace(request, parts=request.short, short=None)
        if not changed and all(pressed[i] == LED for i in crowded):
            break
        for n, i in enumerate(keyed, 1):
            if (numbered := changed.get(i, spots[i].request)).parts != (str(n),):
                changed[i] = replace(numbered, parts=(str(n),))
        if changed:
            spots |= field.spots(changed)
        pressed.update(i for i in crowded if pressed[i] < LED)
        order = [*crowded, *(i for i in order if i not in crowded)]
        placed, crowded = _place_in(order, spots, frames, pressed)
    key = [(f"{number} – ", *requests[i].parts) for number, i in enumerate(keyed, 1)]
    labels = tuple(item for i in sorted(placed) for item in placed[i])
    return Placed(labels, key, crowded=bool(crowded) or LED in pressed.values())


def _labels(items: Iterable[Item]) -> Iterator[Label]:
    return (item for item in items if isinstance(item, Label))


def _settled(request: Request) -> Request:
    """Return the request with numbers rounded, so that they are the same on every processor."""
    points, named = (tuple(map(settled, places)) for places in (request.points, request.named))
    return replace(
        request, points=points, named=named, prefer=tuple(map(settled, request.prefer)), gap=settled(request.gap)
    )


def _place_in(
    order: Sequence[int],
    spots: Mapping[int, _Spots],
    frames: Sequence[tuple[complex, complex]],
    pressed: Mapping[int, int],
) -> tuple[dict[int, tuple[Item, ...]], list[int]]:
    """Place the labels one after the other; return them, and those for which no place is free.

    A label `pressed` once may break lines, one pressed twice may be nearer to another's point.
    """
    taken = _Taken(frames, len(order))
    placed: dict[int, tuple[Item, ...]] = {}
    crowded: list[int] = []
    for i in order:
        spot = spots[i]
        request = spot.request
        over = False
        centre, leader = (_away(spot, taken) if request.ring else None) or (spot.best(taken), None)
        if centre is None:
            labelled = _away(spot, taken)
            if labelled is None and request.short == LEFT_OUT:
                placed[i] = ()
                continue
            if over := labelled is None:
                tries = (spot.breaking(taken, led) for led in (False, True)[: pressed.get(i, 0)])
                labelled = next((one for one in tries if one), None)
            if labelled is None:
                crowded.append(i)
            centre, leader = labelled or _least_touched(spot, taken)
        labels: tuple[Item, ...] = label_row(centre, request.parts, request.size, over)
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
    return settled((abs(half) + 0.4) * (1 + 1j) if request.ring else half)


def _away(spot: _Spots, taken: _Taken) -> tuple[complex, Segment | None] | None:
    """Return the best free candidate farther out and its leader, which crosses no label; None without one.

    The leader starts at the label's first point, or at another one if no candidate around the first is free.
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
    """Return, if no spot is free, the cheapest spot farther out: off all labels if possible, then off strokes."""
    at, half = spot.request.points[0], spot.half
    offsets, cost, ways = beyond(half, spot.request.gap, spot.request.prefer)
    centres = at + offsets
    touches = spot.field.ink.touches(centres, np.array(half))
    apart = taken.clear(centres, half) & ~taken.crossed(at + ways)
    best = int(np.argmin(cost + len(cost) * (touches + 2.0 * ~apart)))
    first, last = at + ways[best]
    return complex(centres[best]), (complex(first), complex(last))
