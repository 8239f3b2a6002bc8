"""Where labels stand: near their point, clear of every stroke and of each other.

Each label tries spots around its point, the preferred directions first, nearest first.  The label with
the fewest free spots chooses first.  Where nothing near is free the label moves out and a thin
leader ties it to its point.  Everything is deterministic.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from reportgen.figures.geometry import Complexes, Flags, Floats, corners, frame, overlap, segments
from reportgen.figures.metrics import Box, box
from reportgen.figures.scene import Circle, Item, Label, Line, Scene
from reportgen.figures.style import LABEL, LEADER, THIN
from reportgen.notation.expressions import Expression

Content = Expression | str

DIRECTIONS = np.exp(2j * np.pi * np.arange(24) / 24)
NEAR = (0.0, 0.7, 1.6)
"""Extra distances (mm) at which a label still reads as belonging to its point."""
FAR = (3.5, 6.0, 9.0, 13.0, 18.0, 24.0, 32.0, 42.0)
CLEAR = 0.55
"""White kept between a label's ink and strokes; it also takes up what two typesetters differ by."""
MANY = 20_000
"""Pairs of a box and a stroke above which it pays to part the boxes by place."""
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


@dataclass(frozen=True, slots=True)
class _Spots:
    """A label's candidates in order of preference: centres [K], the points they belong to, free or not."""

    centres: Complexes
    anchors: Complexes
    half: complex
    free: Flags


def place(items: Sequence[Item], requests: Sequence[Request]) -> tuple[Item, ...]:
    """Labels (and leaders) for the requests among the items, in the order of the requests."""
    strokes = segments(items)
    taken = [frame(item) for item in items if isinstance(item, Label)]
    spots = [_near(request, strokes) for request in requests]
    order = sorted(range(len(requests)), key=lambda i: (int(spots[i].free.sum()), i))
    placed: dict[int, tuple[Item, ...]] = {}
    ties: list[tuple[complex, complex]] = []
    for i in order:
        request, spot = requests[i], spots[i]
        free = spot.free & _clear(spot, taken) & ~_hit(spot, ties)
        tie: tuple[complex, complex] | None = None
        if free.any():
            centre = complex(spot.centres[int(np.argmax(free))])
        else:
            centre, tie = _away(request, spot.half, strokes, taken, ties)
        labels: tuple[Item, ...] = row(centre, request.parts, request.size)
        if request.ring:
            labels = (Circle(centre, spot.half.real, THIN), *labels)
        if tie:
            ties.append(tie)
            labels = (Line(*tie, LEADER), *labels)
        taken.append((centre, 2 * spot.half.real, 2 * spot.half.imag))
        placed[i] = labels
    return tuple(item for i in range(len(requests)) for item in placed[i])


def _half(request: Request) -> complex:
    total = _around([box(part, request.size) for part in request.parts])
    half = complex(total.width, total.height + total.depth) / 2
    return (abs(half) + 0.4) * (1 + 1j) if request.ring else half


def _ring(half: complex, distances: Floats) -> Complexes:
    """Offsets [D, 24] of a box from its point: its nearest edge or corner at the distance."""
    x = np.clip(DIRECTIONS.real * math.sqrt(2), -1, 1) * half.real
    y = np.clip(DIRECTIONS.imag * math.sqrt(2), -1, 1) * half.imag
    return np.asarray(x + 1j * y + distances[:, None] * DIRECTIONS)


def _turned(request: Request) -> Floats:
    """How far each direction is from the nearest preferred one: 0 … 2."""
    if not request.prefer:
        # Free choice: up and to the right reads best.
        return np.asarray(0.35 * (1 - (DIRECTIONS * np.exp(-0.25j * np.pi)).real))
    wanted = np.exp(-1j * np.asarray(request.prefer))
    return np.asarray((1 - (DIRECTIONS[:, None] * wanted).real).min(axis=1))


def _near(request: Request, strokes: Complexes) -> _Spots:
    half = _half(request)
    anchors = np.array([request.at, *request.also])
    ring = _ring(half, np.asarray(NEAR) + request.gap)
    cost = np.asarray(NEAR)[:, None] * 0.45 + _turned(request)
    offsets, cost = ring.ravel(), cost.ravel()
    centres = (anchors[:, None] + offsets).ravel()
    total = (0.25 * np.arange(len(anchors))[:, None] + cost).ravel()
    owner = np.repeat(anchors, len(offsets))
    best = np.argsort(total, kind="stable")
    centres, owner = centres[best], owner[best]
    free = ~_touched(centres, half, _around_here(strokes, centres, half))
    return _Spots(centres, owner, half, free)


def _around_here(strokes: Complexes, centres: Complexes, half: complex) -> Complexes:
    """Only the strokes that any of the candidate boxes could touch."""
    low = complex(centres.real.min(), centres.imag.min()) - half - CLEAR * (1 + 1j)
    high = complex(centres.real.max(), centres.imag.max()) + half + CLEAR * (1 + 1j)
    first, last = strokes[:, 0], strokes[:, 1]
    keep = (np.minimum(first.real, last.real) <= high.real) & (np.maximum(first.real, last.real) >= low.real)
    keep &= (np.minimum(first.imag, last.imag) <= high.imag) & (np.maximum(first.imag, last.imag) >= low.imag)
    return strokes[keep]


def _clear(spot: _Spots, taken: Sequence[tuple[complex, float, float]]) -> Flags:
    """Which candidates keep apart from the labels already placed."""
    free: Flags = np.ones(len(spot.centres), dtype=np.bool_)
    for centre, width, height in taken:
        apart = spot.centres - centre
        free &= (np.abs(apart.real) >= spot.half.real + width / 2 + APART) | (
            np.abs(apart.imag) >= spot.half.imag + height / 2 + APART
        )
    return free


def _hit(spot: _Spots, ties: Sequence[tuple[complex, complex]]) -> Flags:
    if not ties:
        return np.zeros(len(spot.centres), dtype=np.bool_)
    return _touched(spot.centres, spot.half, np.array(ties))


def _touched(centres: Complexes, half: complex, strokes: Complexes) -> Flags:
    """Which boxes come too close to any stroke."""
    if len(centres) * len(strokes) > MANY and len(centres) > 1:
        # Half of the boxes are near far fewer of the strokes.
        order = np.argsort(centres.real if np.ptp(centres.real) > np.ptp(centres.imag) else centres.imag)
        touched: Flags = np.empty(len(centres), dtype=np.bool_)
        for part in np.array_split(order, 2):
            touched[part] = _touched(centres[part], half, _around_here(strokes, centres[part], half))
        return touched
    return np.asarray(overlap(centres, np.array([half]), strokes, CLEAR).any(axis=1), dtype=np.bool_)


def _away(
    request: Request,
    half: complex,
    strokes: Complexes,
    taken: Sequence[tuple[complex, float, float]],
    ties: Sequence[tuple[complex, complex]],
) -> tuple[complex, tuple[complex, complex]]:
    """The nearest free spot farther out and the leader to it, which crosses no label."""
    distances = np.asarray(FAR) + request.gap
    centres = (request.at + _ring(half, distances)).ravel()
    cost = (np.asarray(FAR)[:, None] * 0.2 + _turned(request)).ravel()
    leaders = _leaders(request, centres, half)
    near = _around_here(strokes, centres, half)
    busy = _touched(centres, half, near)
    spot = _Spots(centres, centres, half, ~busy)
    free = ~busy & _clear(spot, taken) & ~_hit(spot, ties)
    for centre, width, height in taken:
        free &= ~overlap(np.array([centre]), np.array([complex(width, height) / 2]), leaders, 0.2)[0]
    # Where any spot is free only those are weighed: the rest would stand far behind them.
    weighed = np.flatnonzero(free) if free.any() else np.arange(len(centres))
    tried = leaders[weighed]
    cost = cost[weighed] + 0.3 * _crossings(tried, near) + 0.8 * _grazes(tried, near)
    best = int(weighed[np.argmin(cost)])
    return complex(centres[best]), (complex(leaders[best, 0]), complex(leaders[best, 1]))


def _leaders(request: Request, centres: Complexes, half: complex) -> Complexes:
    """From the point's edge to the nearest place on each box, just short of it: segments [K, 2]."""
    away = centres - request.at
    foot = (away.real - np.clip(away.real, -half.real, half.real)) + 1j * (
        away.imag - np.clip(away.imag, -half.imag, half.imag)
    )
    u = foot / np.abs(foot)
    return np.column_stack((request.at + u * min(request.gap, 0.8), request.at + foot - u * (CLEAR + 0.1)))


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
