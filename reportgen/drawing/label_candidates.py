"""Candidate places for a label around a point, their costs, and the leaders that connect them to the point."""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from reportgen.base.arrays import Complexes, Flags, Floats
from reportgen.base.stable_digits import settled
from reportgen.drawing.geometry import Ink, overlap

Indices = NDArray[np.intp]

DIRECTIONS = settled(np.exp(2j * np.pi * np.arange(24) / 24))
"""Unit vectors of the directions [24] in which most candidates lie."""
FINE = settled(np.exp(2j * np.pi * np.arange(120) / 120))
"""Unit vectors of the directions [120] of labels that break lines."""
NEAR = (0.0, 0.7, 1.6)
"""Additional distances (mm) at which a label is still recognised as that of its point."""
FAR = (2.6, 3.6, 4.8, 6.0, 7.2, 8.4, 9.6, 10.8, 12.0)
"""Distances (mm) of labels that need a leader."""
ALL = (0.0, 0.4, 0.8, 1.2, 1.6, *np.arange(2.0, 12.0, 0.4))
"""Distances of labels that break lines, in `FINE` directions; the first `LEADERLESS` of them need no leader."""
LEADERLESS = 5
LONGEST = 12.0
"""Longest leader (mm) that a reader follows."""
CLEAR = 0.55
"""Gap between a label's ink and strokes; it also covers the differences between two typesetters."""
KEPT = 1024
"""Number of combinations of label size and preferred directions whose candidates are cached."""
PLACES = np.linspace(0.15, 0.95, 9)
"""Points on a leader that are checked against strokes, in shares of its length."""


def ring(half: complex, distances: Floats, directions: Complexes = DIRECTIONS) -> Complexes:
    """Return offsets (mm) [D, K] of a box from its point, at the `distances` [D] (mm) in the `directions` [K].

    The distance is that of the nearest edge or corner; `half` is half the size of the box, as width + i height.
    """
    corners = np.clip(directions.real * math.sqrt(2), -1, 1) + 1j * np.clip(directions.imag * math.sqrt(2), -1, 1)
    return settled(
        np.asarray(corners.real * half.real + 1j * corners.imag * half.imag + distances[:, None] * directions)
    )


@lru_cache(maxsize=KEPT)
def nearby(half: complex, gap: float) -> Complexes:
    """Return the offsets [72] (mm) of a box at the near distances; cached, since names recur from plan to plan."""
    return ring(half, np.asarray(NEAR) + gap).ravel()


@lru_cache(maxsize=KEPT)
def ranking(prefer: tuple[float, ...], anchors: int) -> Indices:
    """Return the indices [72 × anchors] of nearby candidates in the order in which they are tried.

    The first anchor, short distances and the directions `prefer` (rad) are first.
    """
    cost = (np.asarray(NEAR)[:, None] * 0.45 + turned(prefer)).ravel()
    total = (0.25 * np.arange(anchors)[:, None] + cost).ravel()
    return np.argsort(settled(total), kind="stable")


def turned(prefer: tuple[float, ...], directions: Complexes = DIRECTIONS) -> Floats:
    """Return the cost of each direction [N]: 1 − cos of its angle to the nearest one of `prefer` (rad).

    Without preference it is 0.35 times that for the direction up and to the right.
    """
    if not prefer:
        # Without preference: up and to the right reads best.
        return settled(np.asarray(0.35 * (1 - (directions * np.exp(-0.25j * np.pi)).real)))
    wanted = np.exp(-1j * np.asarray(prefer))
    return settled(np.asarray((1 - (directions[:, None] * wanted).real).min(axis=1)))


@lru_cache(maxsize=KEPT)
def around(half: complex, gap: float, prefer: tuple[float, ...]) -> tuple[Complexes, Floats, Complexes]:
    """Return candidates in fine directions, the near ones first, relative to their point.

    They are centres [K] (mm), costs [K] and leaders [K, 2] (mm).
    """
    centres = ring(half, np.asarray(ALL) + gap, FINE).ravel()
    cost = settled((np.asarray(ALL)[:, None] * 0.2 + turned(prefer, FINE)).ravel())
    return centres, cost, leaders_to(gap, centres, half)


@lru_cache(maxsize=KEPT)
def beyond(half: complex, gap: float, prefer: tuple[float, ...]) -> tuple[Complexes, Floats, Complexes]:
    """Return the candidates farther out, the cheapest first, relative to their point; those with too long a leader are
    left out.

    They are centres [K] (mm), costs [K] and leaders [K, 2] (mm).
    """
    centres = ring(half, np.asarray(FAR) + gap).ravel()
    cost = settled((np.asarray(FAR)[:, None] * 0.2 + turned(prefer)).ravel())
    leaders = leaders_to(gap, centres, half)
    order = np.argsort(cost, kind="stable")
    order = order[settled(np.abs(leaders[order, 1] - leaders[order, 0])) <= LONGEST]
    return centres[order], cost[order], leaders[order]


def touched(centres: Complexes, half: complex, strokes: Complexes) -> Flags:
    """Return flags of the boxes [N] (mm) of one half size that are within `CLEAR` of any of the strokes [S, 2]."""
    return np.asarray(overlap(centres, np.array([half]), strokes, CLEAR).any(axis=1), dtype=np.bool_)


def leaders_to(gap: float, centres: Complexes, half: complex) -> Complexes:
    """Return the leaders [K, 2] (mm) from the edge of a point to just before the nearest place on each box.

    All places are relative to the point; `gap` is the point's radius (mm).
    """
    foot = (centres.real - np.clip(centres.real, -half.real, half.real)) + 1j * (
        centres.imag - np.clip(centres.imag, -half.imag, half.imag)
    )
    u = foot / np.abs(foot)
    return settled(np.column_stack((u * min(gap, 0.8), foot - u * (CLEAR + 0.1))))


def crossings(leaders: Complexes, strokes: Complexes) -> Floats:
    """Return the number [K] of strokes [S, 2] that each leader [K, 2] crosses; all ends in mm."""

    def side(a: Complexes, b: Complexes, p: Complexes) -> Floats:
        return settled(np.asarray(((b - a).conj() * (p - a)).imag))

    a, b = leaders[:, :1], leaders[:, 1:]
    c, d = strokes[:, 0], strokes[:, 1]
    across = (side(a, b, c) * side(a, b, d) < 0) & (side(c, d, a) * side(c, d, b) < 0)
    return np.asarray(across.sum(axis=1), dtype=np.float64)


def distances(leaders: Complexes, points: Complexes) -> Floats:
    """Return the distances (mm) [K, P] of points [P] from leaders [K, 2]."""
    start, direction = leaders[:, :1], leaders[:, 1:] - leaders[:, :1]
    share = np.clip(((points - start) / direction).real, 0.0, 1.0)
    return settled(np.asarray(np.abs(points - start - share * direction)))


def inked(ink: Ink, leaders: Complexes) -> Floats:
    """Return the number [K] of `PLACES` at which each leader [K, 2] (mm) crosses a stroke or lies on one."""
    places = leaders[:, :1] + (leaders[:, 1:] - leaders[:, :1]) * PLACES
    return np.asarray(ink.touches(places, np.array(0.25 + 0.25j)).sum(axis=1), dtype=np.float64)
