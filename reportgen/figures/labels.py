"""Where labels stand: near their point, clear of every stroke and of each other.

Each label tries spots around its point, the preferred directions first, nearest first.  The label with
the fewest free spots chooses first.  Where nothing near is free the label moves out and a thin
leader ties it to its point; where that fails too, the labels without room choose first in a new
attempt.  Everything is deterministic.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from reportgen.figures.geometry import Complexes, Flags, Floats, corners, frame, overlap, segments
from reportgen.figures.metrics import Box, box
from reportgen.figures.scene import Circle, Item, Label, Line, Scene
from reportgen.figures.style import LABEL, LEADER, THIN
from reportgen.notation.expressions import Expression

Content = Expression | str
Indices = NDArray[np.intp]

DIRECTIONS = np.exp(2j * np.pi * np.arange(24) / 24)
CORNERS = np.clip(DIRECTIONS.real * math.sqrt(2), -1, 1) + 1j * np.clip(DIRECTIONS.imag * math.sqrt(2), -1, 1)
"""Where a box of half size 1 has its middle when the box stands off its point in each direction."""
NEAR = (0.0, 0.7, 1.6)
"""Extra distances (mm) at which a label still reads as belonging to its point."""
FAR = (3.5, 6.0, 9.0, 13.0, 18.0, 24.0, 32.0, 42.0)
CLEAR = 0.55
"""White kept between a label's ink and strokes; it also takes up what two typesetters differ by."""
FIRST = 72
"""Candidates weighed at once; the others only where none of these is free."""
CHEAPEST = 12
"""Of the spots farther out, how many are weighed in full before the dearer ones are left out."""
ATTEMPTS = 4
"""How often the labels that found no room are let choose first."""
KEPT = 1024
"""Sizes of labels and sets of preferred directions whose spots are kept."""
APART = 0.7
"""White kept between two labels."""


@dataclass(frozen=True, slots=True)
class Request:
    """A label to be placed: `parts` stand in a row on one baseline.

    `at` is the point it belongs to, `also` further points it may stand at as well (places along an
    arrow); `prefer` are directions in radians, any where empty; `gap` is the distance in mm kept from
    the point itself (the radius of the circle drawn there).  A `ring` goes round a link's number.
    """

    at: complex
    parts: tuple[Content, ...]
    prefer: tuple[float, ...] = ()
    gap: float = 0.6
    size: float = LABEL
    also: tuple[complex, ...] = ()
    ring: bool = False


def label(
    at: complex,
    *parts: Content,
    prefer: Sequence[float] = (),
    gap: float = 0.6,
    size: float = LABEL,
    also: Sequence[complex] = (),
    ring: bool = False,
) -> Request:
    """A request, written short."""
    return Request(at, parts, tuple(prefer), gap, size, tuple(also), ring)


def row(at: complex, parts: Sequence[Content], size: float) -> tuple[Label, ...]:
    """Labels side by side on one baseline, their common box centred on `at`."""
    boxes = [box(part, size) for part in parts]
    total = _around(boxes)
    x = at.real - total.width / 2
    base = at.imag - (total.height - total.depth) / 2
    result = []
    for part, own in zip(parts, boxes, strict=True):
        centre = complex(x + own.width / 2, base + (own.height - own.depth) / 2)
        result.append(Label(centre, part, "center", size))
        x += own.width
    return tuple(result)


def _around(boxes: Sequence[Box]) -> Box:
    return Box(sum(b.width for b in boxes), max(b.height for b in boxes), max(b.depth for b in boxes))


class _Ink:
    """The strokes of a figure with the corners of their boxes, kept so that those near a place are found fast."""

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

    def __init__(self, frames: Sequence[tuple[complex, float, float]]) -> None:
        self.centres = [centre for centre, _, _ in frames]
        self.halves = [complex(width, height) / 2 for _, width, height in frames]
        self.ties: list[tuple[complex, complex]] = []

    def add(self, centre: complex, half: complex, tie: tuple[complex, complex] | None) -> None:
        self.centres.append(centre)
        self.halves.append(half)
        if tie:
            self.ties.append(tie)

    def clear(self, centres: Complexes, half: complex) -> Flags:
        """Which of the boxes keep apart from every label and leader."""
        free: Flags = np.ones(len(centres), dtype=np.bool_)
        if self.centres:
            apart = centres[:, None] - np.asarray(self.centres)
            room = np.asarray(self.halves) + (half + APART * (1 + 1j))
            free = ((np.abs(apart.real) >= room.real) | (np.abs(apart.imag) >= room.imag)).all(axis=1)
        if self.ties:
            free &= ~_touched(centres, half, np.array(self.ties))
        return free

    def crossed(self, leaders: Complexes) -> Flags:
        """Which leaders run through a label."""
        if not self.centres:
            return np.zeros(len(leaders), dtype=np.bool_)
        return np.asarray(overlap(np.array(self.centres), np.array(self.halves), leaders, 0.2).any(axis=0))


class _Spots:
    """A label's candidates in the order of preference, the first of them weighed against the strokes at once."""

    def __init__(self, request: Request, ink: _Ink) -> None:
        self.half = _half(request)
        anchors = np.array([request.at, *request.also])
        offsets = _nearby(self.half, request.gap)
        self.centres = (anchors[:, None] + offsets).ravel()[_ranking(request.prefer, len(anchors))]
        self.ink = ink
        self.first = self._clear_of_ink(0)

    @property
    def room(self) -> int:
        """How many of the first candidates are free of strokes."""
        return int(np.count_nonzero(self.first))

    def best(self, taken: _Taken) -> complex | None:
        """The first candidate free of strokes, labels and leaders; None where there is none."""
        for start in range(0, len(self.centres), FIRST):
            free = self.first if start == 0 else self._clear_of_ink(start)
            found = np.flatnonzero(free) + start
            if found.size and (clear := taken.clear(self.centres[found], self.half)).any():
                return complex(self.centres[found[int(np.argmax(clear))]])
        return None

    def _clear_of_ink(self, start: int) -> Flags:
        centres = self.centres[start : start + FIRST]
        return ~_touched(centres, self.half, self.ink.near(centres, self.half))


def place(items: Sequence[Item], requests: Sequence[Request]) -> tuple[Item, ...]:
    """Labels (and leaders) for the requests among the items, in the order of the requests."""
    ink = _Ink(segments(items))
    frames = [frame(item) for item in items if isinstance(item, Label)]
    spots = [_Spots(request, ink) for request in requests]
    order = sorted(range(len(requests)), key=lambda i: (spots[i].room, i))
    placed, crowded = _place_in(order, requests, spots, frames)
    for _ in range(ATTEMPTS):
        if not crowded:
            break
        # What found no room chooses first.
        order = [*crowded, *(i for i in order if i not in crowded)]
        again, still = _place_in(order, requests, spots, frames)
        if len(still) < len(crowded):
            placed = again
        crowded = still
    return tuple(item for i in range(len(requests)) for item in placed[i])


def _place_in(
    order: Sequence[int],
    requests: Sequence[Request],
    spots: Sequence[_Spots],
    frames: Sequence[tuple[complex, float, float]],
) -> tuple[dict[int, tuple[Item, ...]], list[int]]:
    """The labels placed one after the other, and those for which no place is free."""
    taken = _Taken(frames)
    placed: dict[int, tuple[Item, ...]] = {}
    crowded: list[int] = []
    for i in order:
        request, spot = requests[i], spots[i]
        centre, tie = spot.best(taken), None
        if centre is None:
            centre, tie, free = _away(request, spot, taken)
            if not free:
                crowded.append(i)
        labels: tuple[Item, ...] = row(centre, request.parts, request.size)
        if request.ring:
            labels = (Circle(centre, spot.half.real, THIN), *labels)
        if tie:
            labels = (Line(*tie, LEADER), *labels)
        taken.add(centre, spot.half, tie)
        placed[i] = labels
    return placed, crowded


def _half(request: Request) -> complex:
    total = _around([box(part, request.size) for part in request.parts])
    half = complex(total.width, total.height + total.depth) / 2
    return (abs(half) + 0.4) * (1 + 1j) if request.ring else half


def _ring(half: complex, distances: Floats) -> Complexes:
    """Offsets [D, 24] of a box from its point: its nearest edge or corner at the distance."""
    return np.asarray(CORNERS.real * half.real + 1j * CORNERS.imag * half.imag + distances[:, None] * DIRECTIONS)


@lru_cache(maxsize=KEPT)
def _nearby(half: complex, gap: float) -> Complexes:
    """Offsets [72] at the near distances, kept for the next label of that size: names recur from plan to plan."""
    return _ring(half, np.asarray(NEAR) + gap).ravel()


@lru_cache(maxsize=KEPT)
def _ranking(prefer: tuple[float, ...], anchors: int) -> Indices:
    """The order [72 a anchor] in which nearby spots are tried: the first point and the preferred directions first."""
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


def _away(
    request: Request, spot: _Spots, taken: _Taken
) -> tuple[complex, tuple[complex, complex], bool]:
    """The nearest free spot farther out, the leader to it, which crosses no label, and whether it is free.

    The leader starts at the label's point, or at a further point of it where no spot about that is free.
    """
    first = _off(request, request.at, spot, taken)
    if first[2]:
        return first
    others = (_off(request, at, spot, taken) for at in request.also)
    return next((other for other in others if other[2]), first)


def _off(
    request: Request, at: complex, spot: _Spots, taken: _Taken
) -> tuple[complex, tuple[complex, complex], bool]:
    """The best spot some way off one point of a label."""
    half = spot.half
    centres = (at + _ring(half, np.asarray(FAR) + request.gap)).ravel()
    cost = (np.asarray(FAR)[:, None] * 0.2 + _turned(request.prefer)).ravel()
    leaders = _leaders(at, request.gap, centres, half)
    near = spot.ink.near(centres, half)
    free = taken.clear(centres, half) & ~taken.crossed(leaders)
    free[free] = ~_touched(centres[free], half, near)
    # Where any spot is free only those are weighed: the rest would stand far behind them.
    weighed = np.flatnonzero(free) if free.any() else np.arange(len(centres))

    def whole(spots: Indices) -> Floats:
        tried = leaders[spots]
        return np.asarray(cost[spots] + 0.3 * _crossings(tried, near) + 0.8 * _grazes(tried, near))

    # What a leader crosses only adds to the cost: whoever is dearer without it than another with it is out.
    cheapest = weighed[np.argsort(cost[weighed], kind="stable")[:CHEAPEST]]
    weighed = weighed[cost[weighed] <= whole(cheapest).min()]
    best = int(weighed[np.argmin(whole(weighed))])
    return complex(centres[best]), (complex(leaders[best, 0]), complex(leaders[best, 1])), bool(free[best])


def _leaders(at: complex, gap: float, centres: Complexes, half: complex) -> Complexes:
    """From the point's edge to the nearest place on each box, just short of it: segments [K, 2]."""
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
    """At how many of four places each leader lies on a stroke, where it would be taken for part of it."""
    shares = np.array([0.35, 0.55, 0.75, 0.95])
    places = leaders[:, :1] + (leaders[:, 1:] - leaders[:, :1]) * shares
    on = overlap(places.ravel(), np.array([0.25 + 0.25j]), strokes, 0.0).any(axis=1)
    return np.asarray(on.reshape(places.shape).sum(axis=1), dtype=np.float64)


def overlaps(scene: Scene, clearance: float = 0.1) -> list[str]:
    """Faults of a finished scene: labels on strokes, on one another, or off the sheet."""
    faults: list[str] = []
    labels = [item for item in scene.items if isinstance(item, Label)]
    strokes = segments(scene.items)
    frames = [frame(item) for item in labels]
    for n, (item, (centre, width, height)) in enumerate(zip(labels, frames, strict=True)):
        half = complex(width, height) / 2
        if not item.background and len(strokes):
            hits = overlap(np.array([centre]), np.array([half]), strokes, clearance)[0]
            if hits.any():
                where = strokes[int(np.argmax(hits))]
                faults.append(f"{item.content} stands on the stroke {where[0]:.1f} – {where[1]:.1f}")
        for other, (middle, w, h) in zip(labels[:n], frames[:n], strict=True):
            gap = centre - middle
            if abs(gap.real) < (width + w) / 2 - 1e-6 and abs(gap.imag) < (height + h) / 2 - 1e-6:
                faults.append(f"{item.content} stands on {other.content}")
        low, high = corners(item)
        if low.real < 0 or low.imag < 0 or high.real > scene.width or high.imag > scene.height:
            faults.append(f"{item.content} is off the sheet")
    return faults
