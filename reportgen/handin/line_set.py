"""The lines of a drawing in which plans are searched for, with an index of ends that may be the same point.

Points and ends are complex numbers in mm. The ends of M lines are numbered as in `Lines.points`: 0 … M − 1 are the
starts, M … 2 M − 1 the ends.
"""

from __future__ import annotations

from collections.abc import Collection
from functools import cached_property

import numpy as np

from reportgen.base.records import Record

CROWD = 40
"""Largest number of ends near another one that are paired with it; more are a hatching."""
MOST_PAIRS = 400_000
"""Largest number of pairs of lines that share an end; a drawing of plans has fewer."""


class Lines(Record, dict=True):
    """Lines [M, 2] (complex, mm) of a drawing, with ends within ±`error` (mm) of their right places in each direction.

    `parts` are the pieces of each line by the numbers of drawn lines: its own number, or the numbers of a run of
    pieces. None means that each line is drawn in one piece.
    """

    ends: np.ndarray
    error: float
    parts: tuple[frozenset[int], ...] | None = None

    @cached_property
    def pieces(self) -> tuple[frozenset[int], ...]:
        """The pieces of each line [M]."""
        return tuple(frozenset({n}) for n in range(len(self.ends))) if self.parts is None else self.parts

    @cached_property
    def in_runs(self) -> np.ndarray:
        """Mask [M] of the lines that are runs of pieces."""
        return np.array([len(pieces) > 1 for pieces in self.pieces], dtype=bool)

    @cached_property
    def longer(self) -> tuple[tuple[frozenset[int], ...], ...]:
        """For each line [M], the pieces of the runs that it is a fragment of."""
        runs = [self.pieces[n] for n in np.flatnonzero(self.in_runs)]
        by_piece: dict[int, list[frozenset[int]]] = {}
        for run in runs:
            for piece in run:
                by_piece.setdefault(piece, []).append(run)
        return tuple(tuple(run for run in by_piece.get(min(own), ()) if own < run) for own in self.pieces)

    def without(self, taken: Collection[int]) -> np.ndarray:
        """Return the numbers [K] of the lines that have no piece among the `taken` ones."""
        gone = frozenset(taken)
        return np.array([n for n, pieces in enumerate(self.pieces) if not pieces & gone], dtype=int)

    def only(self, index: np.ndarray) -> Lines:
        """Return the lines with the numbers `index` [K], as lines [K, 2] (mm) that keep their pieces."""
        return Lines(self.ends[index], self.error, tuple(self.pieces[n] for n in index))

    @property
    def reach(self) -> float:
        """Largest distance (mm) of an end from its right place."""
        return float(np.sqrt(2) * self.error)

    @cached_property
    def points(self) -> np.ndarray:
        """All ends [2 M] (mm), the starts first."""
        return np.concatenate((self.ends[:, 0], self.ends[:, 1]))

    @cached_property
    def touching(self) -> tuple[np.ndarray, np.ndarray]:
        """The numbers [K] and [K] of the pairs of ends, of two lines, that may be one point, each in both orders."""
        first, second = close_pairs(self.points, 2 * self.reach)
        several = np.flatnonzero(first % len(self.ends) != second % len(self.ends))[:MOST_PAIRS]
        first, second = first[several], second[several]
        return np.concatenate((first, second)), np.concatenate((second, first))

    @cached_property
    def vectors(self) -> np.ndarray:
        """The lines as vectors (mm) from each of their ends [2 M]."""
        along = self.ends[:, 1] - self.ends[:, 0]
        return np.concatenate((along, -along))

    @cached_property
    def pairs(self) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Pairs of lines with a common end: the first line's angle (rad, sorted), that end, both vectors from it.

        All four arrays are [K]; the end and the vectors are in mm.
        """
        first, second = self.touching
        along, beside = self.vectors[first], self.vectors[second]
        at = (self.points[first] + self.points[second]) / 2
        angle = np.angle(along)
        order = np.argsort(angle, kind="stable")
        return angle[order], at[order], along[order], beside[order]

    @property
    def cell(self) -> float:
        """The width of a cell (mm): the largest error of a first guess of scale and shift."""
        return 3 * self.reach

    @cached_property
    def cells(self) -> np.ndarray:
        """The sorted numbers [C] of the pairs of grid cells that lines connect, and of pairs of neighbouring cells."""
        keys = np.concatenate([_between(self.ends[:, n], self.ends[:, 1 - n], self.cell) for n in (0, 1)])
        steps = np.array([-1, 0, 1], dtype=np.int64)
        for factor in _FACTORS:
            keys = (keys[:, None] + steps * factor).ravel()
        return np.unique(keys)

    def run_between(self, starts: np.ndarray, ends: np.ndarray) -> np.ndarray:
        """Return a mask of the pairs of places (mm) that a line approximately connects.

        `starts`, `ends` and the mask have the same shape. Two places match a line in any direction if both are at most
        one cell away from its ends.
        """
        keys = _between(starts, ends, self.cell)
        if not len(self.cells):
            return np.zeros(keys.shape, dtype=bool)
        place = np.searchsorted(self.cells, keys).clip(max=len(self.cells) - 1)
        run: np.ndarray = self.cells[place] == keys
        return run


_FACTORS = tuple(np.int64(factor) for factor in (1, 0x1F123BB5, 0x2545F4914F6CDD1D, 0x369DEA0F31A53F85))
"""Factors for the rows and columns of two cells; two different pairs are unlikely to have the same sum."""


def _between(starts: np.ndarray, ends: np.ndarray, cell: float) -> np.ndarray:
    """Return a number for the pair of cells, `cell` (mm) wide, in which each line starts and ends (same shape)."""
    numbers = (np.floor(part / cell).astype(np.int64) for part in (starts.real, starts.imag, ends.real, ends.imag))
    with np.errstate(over="ignore"):
        parts = [number * factor for number, factor in zip(numbers, _FACTORS, strict=True)]
        total: np.ndarray = np.sum(parts, axis=0)
    return total


def _key(x: int, y: int) -> int:
    return (x << 32) + y


def _keys(points: np.ndarray, cell: float) -> np.ndarray:
    """Return the number of the cell of each point [P]."""
    x, y = np.floor(points.real / cell), np.floor(points.imag / cell)
    keys: np.ndarray = (x.astype(np.int64) << 32) + y.astype(np.int64)
    return keys


def close_pairs(points: np.ndarray, reach: float) -> tuple[np.ndarray, np.ndarray]:
    """Return the numbers [K] and [K] of all pairs of points [P] that are at most `reach` apart, each pair once.

    Points and `reach` are in one unit (mm). The pairs are found with a grid of cells. A point is paired with at most
    `CROWD` others of each neighbouring cell.
    """
    keys = _keys(points, reach)
    order = np.argsort(keys, kind="stable")
    ranked = keys[order]
    firsts, seconds = [], []
    for step in (_key(0, 0), _key(0, 1), _key(1, -1), _key(1, 0), _key(1, 1)):
        low, high = (np.searchsorted(ranked, ranked + step, side=side) for side in ("left", "right"))
        if step == 0:
            low = np.arange(1, len(ranked) + 1)
        count = np.maximum(high - low, 0)
        count = np.minimum(count, CROWD)
        first = np.repeat(np.arange(len(ranked)), count)
        second = np.arange(len(first)) - np.repeat(np.cumsum(count) - count, count) + np.repeat(low, count)
        a, b = order[first], order[second]
        close = np.abs(points[a] - points[b]) <= reach
        firsts.append(a[close])
        seconds.append(b[close])
    return np.concatenate(firsts), np.concatenate(seconds)
