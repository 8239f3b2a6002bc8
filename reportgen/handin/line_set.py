"""The lines of a drawing among which plans are sought, and which of their ends may be one point."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass
from functools import cached_property

import numpy as np

CROWD = 40
"""Ends nearer to one than others; more are a hatching."""
MOST_PAIRS = 400_000
"""Lines that share an end; more are no drawing of plans."""


@dataclass(frozen=True)
class Lines:
    """Lines [M, 2] (mm) of a drawing whose ends lie within ±`error` (mm) in each direction of where they should.

    `parts` are the pieces of each line by the numbers of drawn lines: its own number, or those of a run of pieces.
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
        """Whether each line [M] is a run of pieces."""
        return np.array([len(pieces) > 1 for pieces in self.pieces], dtype=bool)

    @cached_property
    def longer(self) -> tuple[tuple[frozenset[int], ...], ...]:
        """The pieces of the runs that each line [M] is a fragment of."""
        runs = [self.pieces[n] for n in np.flatnonzero(self.in_runs)]
        by_piece: dict[int, list[frozenset[int]]] = {}
        for run in runs:
            for piece in run:
                by_piece.setdefault(piece, []).append(run)
        return tuple(tuple(run for run in by_piece.get(min(own), ()) if own < run) for own in self.pieces)

    def without(self, taken: Collection[int]) -> np.ndarray:
        """The numbers of the lines of which no piece is taken."""
        gone = frozenset(taken)
        return np.array([n for n, pieces in enumerate(self.pieces) if not pieces & gone], dtype=int)

    def only(self, index: np.ndarray) -> Lines:
        """Some of the lines."""
        return Lines(self.ends[index], self.error, tuple(self.pieces[n] for n in index))

    @property
    def reach(self) -> float:
        """How far an end may lie off its place (mm)."""
        return float(np.sqrt(2) * self.error)

    @cached_property
    def points(self) -> np.ndarray:
        """All ends [2 M]: those of the starts first."""
        return np.concatenate((self.ends[:, 0], self.ends[:, 1]))

    @cached_property
    def touching(self) -> tuple[np.ndarray, np.ndarray]:
        """The numbers of all two ends, of two lines, that may be one, each pair in either order."""
        first, second = close_pairs(self.points, 2 * self.reach)
        several = np.flatnonzero(first % len(self.ends) != second % len(self.ends))[:MOST_PAIRS]
        first, second = first[several], second[several]
        return np.concatenate((first, second)), np.concatenate((second, first))

    @cached_property
    def ways(self) -> np.ndarray:
        """The lines as vectors from each of their ends [2 M]."""
        along = self.ends[:, 1] - self.ends[:, 0]
        return np.concatenate((along, -along))

    @cached_property
    def pairs(self) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Two lines each with a common end: the first angle, that end, both as vectors from it, by the angle."""
        first, second = self.touching
        along, beside = self.ways[first], self.ways[second]
        at = (self.points[first] + self.points[second]) / 2
        angle = np.angle(along)
        order = np.argsort(angle, kind="stable")
        return angle[order], at[order], along[order], beside[order]

    @property
    def cell(self) -> float:
        """The width of a cell (mm): what a first guess of scale and place may be off by."""
        return 3 * self.reach

    @cached_property
    def cells(self) -> np.ndarray:
        """The numbers of the cells of a grid that lines run between, or of cells beside these, sorted."""
        keys = np.concatenate([_between(self.ends[:, n], self.ends[:, 1 - n], self.cell) for n in (0, 1)])
        steps = np.array([-1, 0, 1], dtype=np.int64)
        for factor in _FACTORS:
            keys = (keys[:, None] + steps * factor).ravel()
        return np.unique(keys)

    def run_between(self, starts: np.ndarray, ends: np.ndarray) -> np.ndarray:
        """Whether a line runs between places about these."""
        keys = _between(starts, ends, self.cell)
        if not len(self.cells):
            return np.zeros(keys.shape, dtype=bool)
        place = np.searchsorted(self.cells, keys).clip(max=len(self.cells) - 1)
        run: np.ndarray = self.cells[place] == keys
        return run


_FACTORS = tuple(np.int64(factor) for factor in (1, 0x1F123BB5, 0x2545F4914F6CDD1D, 0x369DEA0F31A53F85))
"""What rows and columns of two cells are multiplied by: it is unlikely that two others have the same sum."""


def _between(starts: np.ndarray, ends: np.ndarray, cell: float) -> np.ndarray:
    """A number for the cells that each line starts and ends in."""
    numbers = (np.floor(part / cell).astype(np.int64) for part in (starts.real, starts.imag, ends.real, ends.imag))
    with np.errstate(over="ignore"):
        parts = [number * factor for number, factor in zip(numbers, _FACTORS, strict=True)]
        total: np.ndarray = np.sum(parts, axis=0)
    return total


def _key(x: int, y: int) -> int:
    return (x << 32) + y


def _keys(points: np.ndarray, cell: float) -> np.ndarray:
    """The number of the cell that each point lies in."""
    x, y = np.floor(points.real / cell), np.floor(points.imag / cell)
    keys: np.ndarray = (x.astype(np.int64) << 32) + y.astype(np.int64)
    return keys


def close_pairs(points: np.ndarray, reach: float) -> tuple[np.ndarray, np.ndarray]:
    """All two points nearer than `reach`, each pair once: sought in each cell of a grid and its next ones."""
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
