"""Where a plan of known shape lies among the lines of a drawing: found by its corners, fitted by least squares.

A plan may be drawn at any place and to any scale, but not turned: a corner z of the report's figure lies at f z + t, with
a real f > 0.  Two lines that share an end are tried for each two vectors that share a corner; what they say of f and t
is tested at all other corners, and fitted to all lines that lie there.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from reportgen.handin.plan_shapes import PlanShape

FURTHEST = 5.0
"""A plan is drawn at most so many times larger or smaller than in the report."""
ANYWHERE = float(np.log(FURTHEST**2))
"""The range of scales, as a logarithm."""
FEWEST_CORNERS = 3
"""Fewer corners have no shape."""
HALF = 0.5
"""So many of the corners must be ends of lines before anything is fitted."""
MOST_PAIRS = 400_000
"""Lines that share an end; more are no drawing of plans."""
MOST_TRIED = 40
"""Placings of a plan that are fitted, those that meet most ends first."""
ROUNDS = 4


@dataclass(frozen=True)
class Lines:
    """Lines [M, 2] (mm) of a drawing whose ends lie within ±`error` (mm) in each direction of where they should."""

    ends: np.ndarray
    error: float

    @property
    def reach(self) -> float:
        """How far an end may lie off its place (mm)."""
        return float(np.sqrt(2) * self.error)

    @cached_property
    def points(self) -> np.ndarray:
        """All ends [2 M]: those of the starts first."""
        return np.concatenate((self.ends[:, 0], self.ends[:, 1]))

    @cached_property
    def pairs(self) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """All two lines with a common end: which, that end, and both as vectors from it, sorted by the first's angle."""
        first, second = _near(self.points, 2 * self.reach)
        count = len(self.ends)
        other = first % count != second % count
        first, second = first[other][:MOST_PAIRS], second[other][:MOST_PAIRS]
        first, second = np.concatenate((first, second)), np.concatenate((second, first))
        far = np.concatenate((self.ends[:, 1], self.ends[:, 0]))
        along, beside = far[first] - self.points[first], far[second] - self.points[second]
        at = (self.points[first] + self.points[second]) / 2
        order = np.argsort(np.angle(along), kind="stable")
        return np.angle(along)[order], at[order], along[order], beside[order]

    @cached_property
    def cells(self) -> np.ndarray:
        """The numbers of all cells of a grid that an end lies in or beside, sorted."""
        keys = _keys(self.points, self.cell)
        beside = [keys + _key(x, y) for x in (-1, 0, 1) for y in (-1, 0, 1)]
        return np.unique(np.concatenate(beside)) if len(keys) else keys

    @property
    def cell(self) -> float:
        """The width of a cell (mm): what a first guess of scale and place may be off by."""
        return 4 * self.reach

    def meet(self, places: np.ndarray) -> np.ndarray:
        """Whether an end lies near each of some places."""
        keys = _keys(places, self.cell)
        if not len(self.cells):
            return np.zeros(keys.shape, dtype=bool)
        found = np.searchsorted(self.cells, keys).clip(max=len(self.cells) - 1)
        met: np.ndarray = self.cells[found] == keys
        return met


def _key(x: int, y: int) -> int:
    return (x << 32) + y


def _keys(points: np.ndarray, cell: float) -> np.ndarray:
    """The number of the cell that each point lies in."""
    x, y = np.floor(points.real / cell), np.floor(points.imag / cell)
    keys: np.ndarray = (x.astype(np.int64) << 32) + y.astype(np.int64)
    return keys


def _near(points: np.ndarray, reach: float) -> tuple[np.ndarray, np.ndarray]:
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
        # A crowd of ends is a hatching.
        count = np.minimum(count, MOST_TRIED)
        first = np.repeat(np.arange(len(ranked)), count)
        second = np.arange(len(first)) - np.repeat(np.cumsum(count) - count, count) + np.repeat(low, count)
        a, b = order[first], order[second]
        close = np.abs(points[a] - points[b]) <= reach
        firsts.append(a[close])
        seconds.append(b[close])
    return np.concatenate(firsts), np.concatenate(seconds)


@dataclass(frozen=True, eq=False)
class Fit:
    """A plan found among lines: corners z at `scale` z + `shift`; the line of each vector by number, −1 for none.

    `turned` lines begin where their vector ends.  `square` is the sum of the squared distances of all ends from their
    places (mm²), `size` the extent of what was found (mm).
    """

    shape: PlanShape
    scale: float
    shift: complex
    lines: np.ndarray
    turned: np.ndarray
    square: float
    size: float
    off_centre: float
    """The sum of the squared distances (mm², report's scale) of the fitted corners from their middle."""

    @property
    def found(self) -> np.ndarray:
        """The numbers of the vectors that have a line."""
        return np.flatnonzero(self.lines >= 0)

    @cached_property
    def used(self) -> frozenset[int]:
        """The lines that it explains."""
        return frozenset(int(line) for line in self.lines[self.lines >= 0])

    @property
    def missing(self) -> int:
        """Vectors of the report's figure without a line."""
        return sum(vector.drawn and line < 0 for vector, line in zip(self.shape.vectors, self.lines, strict=True))

    def at(self, corners: np.ndarray) -> np.ndarray:
        """Where corners of the report's figure lie in the drawing (mm)."""
        return self.scale * corners + self.shift

    def corners_met(self, apart: float) -> int:
        """How many corners the lines have, those nearer than `apart` (mm) being one."""
        shape = self.shape
        met = {end for number in self.found for end in (shape.vectors[number].start, shape.vectors[number].end)}
        kept: list[complex] = []
        for corner in met:
            place = complex(shape.corners[corner] * self.scale)
            if all(abs(place - one) > apart for one in kept):
                kept.append(place)
        return len(kept)

    def scale_error(self, deviation: float) -> float:
        """The standard deviation of the scale where every end has that `deviation` (mm) in each direction."""
        return float(deviation / np.sqrt(self.off_centre)) if self.off_centre > 0 else np.inf


def fits(shape: PlanShape, lines: Lines, scales: Sequence[float] = ()) -> list[Fit]:
    """All places where a plan fits some of the lines, at any scale or at about those given; each once."""
    tried = [_by_corners(shape, lines)] if not scales else [_by_vectors(shape, lines, scale) for scale in scales]
    scale, shift = (np.concatenate(part) for part in zip(*tried, strict=True))
    if not len(scale):
        return []
    # Two vectors say the place of others the less exactly the longer these are.
    met = lines.meet(scale[:, None] * shape.corners + shift[:, None]).sum(axis=1)
    enough = np.flatnonzero(met >= max(FEWEST_CORNERS if not scales else 2, HALF * len(shape.corners)))
    enough = enough[np.argsort(-met[enough], kind="stable")]
    found: dict[frozenset[int], Fit] = {}
    seen: set[tuple[int, int, int]] = set()
    for number in enough:
        step = lines.cell / 2
        about = (round(np.log(scale[number]) * 50), round(shift[number].real / step), round(shift[number].imag / step))
        if about in seen:
            continue
        seen.add(about)
        if len(seen) > MOST_TRIED:
            break
        fit = fitted(shape, lines, float(scale[number]), complex(shift[number]))
        if fit is not None and (fit.used not in found or fit.square < found[fit.used].square):
            found[fit.used] = fit
    return list(found.values())


def _by_corners(shape: PlanShape, lines: Lines) -> tuple[np.ndarray, np.ndarray]:
    """Scales and shifts of a plan by all two lines that meet as two of its vectors do."""
    angle, at, along, beside = lines.pairs
    scales, shifts = [np.zeros(0)], [np.zeros(0, dtype=complex)]
    off = 2 * lines.reach
    for corner, first, second in _meeting(shape):
        longest = abs(first)
        turn = np.arcsin(min(off / (longest / FURTHEST), 0.3))
        for low, high in _window(angle, float(np.angle(first)), float(turn)):
            u, v = along[low:high], beside[low:high]
            scale = (u * first.conjugate() + v * second.conjugate()).real / (longest**2 + abs(second) ** 2)
            fits = (np.abs(u - scale * first) <= off) & (np.abs(v - scale * second) <= off)
            fits &= (scale > 1 / FURTHEST) & (scale < FURTHEST)
            some = scale[fits]
            places = at[low:high][fits] + (u[fits] + v[fits] - some * (first + second)) / 3
            scales.append(some)
            shifts.append(places - some * corner)
    return np.concatenate(scales), np.concatenate(shifts)


def _meeting(shape: PlanShape) -> Iterator[tuple[complex, complex, complex]]:
    """Each corner at which two vectors meet, and both from there, the longer one first; those along one line too."""
    touching: dict[int, list[complex]] = {}
    for vector in shape.vectors:
        start, end = complex(shape.corners[vector.start]), complex(shape.corners[vector.end])
        touching.setdefault(vector.start, []).append(end - start)
        touching.setdefault(vector.end, []).append(start - end)
    for corner, ways in touching.items():
        ways = sorted(ways, key=abs, reverse=True)
        for number, first in enumerate(ways):
            for second in ways[number + 1 :]:
                if first != second:
                    yield complex(shape.corners[corner]), first, second


def _window(angle: np.ndarray, middle: float, turn: float) -> Iterator[tuple[int, int]]:
    """The ranges of sorted angles within ±`turn` of one, around the circle."""
    for whole in (-2 * np.pi, 0.0, 2 * np.pi):
        low, high = np.searchsorted(angle, (middle - turn + whole, middle + turn + whole))
        if high > low:
            yield int(low), int(high)


def _by_vectors(shape: PlanShape, lines: Lines, scale: float) -> tuple[np.ndarray, np.ndarray]:
    """Shifts of a plan of known scale by every line that is as long as one of its vectors, and of its direction."""
    starts, ways = shape.starts, scale * (shape.ends - shape.starts)
    shifts = []
    for way, start in ((1, lines.ends[:, 0]), (-1, lines.ends[:, 1])):
        along = way * (lines.ends[:, 1] - lines.ends[:, 0])
        vector, line = np.nonzero(np.abs(ways[:, None] - along) <= 2 * lines.reach)
        shifts.append(start[line] - scale * starts[vector])
    shift = np.concatenate(shifts)
    return np.full(len(shift), scale), shift


def fitted(shape: PlanShape, lines: Lines, scale: float, shift: complex, deviation: float | None = None) -> Fit | None:
    """The best fit of a plan about a first guess of scale and shift; None where less than two of its vectors lie there.

    An end belongs to a corner if it lies no farther off than `reach` and three deviations of the fit itself.
    """
    starts, ends = shape.starts, shape.ends
    sigma = lines.error / np.sqrt(3) if deviation is None else deviation
    near = _around(lines, scale * shape.corners + shift)
    first, second = lines.ends[near, 0], lines.ends[near, 1]
    reach = np.full(len(starts), lines.cell)
    chosen, turned = np.full(len(starts), -1), np.zeros(len(starts), dtype=bool)
    if not len(near):
        return None
    off_centre = 0.0
    for turn in range(ROUNDS):
        a, b = scale * starts + shift, scale * ends + shift
        straight = np.maximum(np.abs(first - a[:, None]), np.abs(second - b[:, None]))
        opposite = np.maximum(np.abs(second - a[:, None]), np.abs(first - b[:, None]))
        nearest = np.minimum(straight, opposite)
        line = nearest.argmin(axis=1)
        rows = np.arange(len(starts))
        chosen = np.where(nearest[rows, line] <= reach, line, -1)
        # What is shorter than two ends may lie off has no direction.
        chosen[np.abs(b - a) < 2 * np.sqrt(2) * sigma * np.sqrt(3)] = -1
        turned = opposite[rows, line] < straight[rows, line]
        kept = np.flatnonzero(chosen >= 0)
        if len(kept) < 2:
            return None
        z = np.concatenate((starts[kept], ends[kept]))
        w = np.concatenate(
            (
                np.where(turned[kept], second[chosen[kept]], first[chosen[kept]]),
                np.where(turned[kept], first[chosen[kept]], second[chosen[kept]]),
            )
        )
        middle = z.mean()
        off_centre = float((np.abs(z - middle) ** 2).sum())
        if off_centre == 0.0:
            return None
        scale = float(((w - w.mean()) * (z - middle).conjugate()).real.sum() / off_centre)
        shift = complex(w.mean() - scale * middle)
        if not 1 / FURTHEST < scale < FURTHEST:
            return None
        leverage = np.maximum(np.abs(starts - middle), np.abs(ends - middle)) ** 2 / off_centre + 1 / len(z)
        exact = np.sqrt(2) * np.sqrt(3) * sigma + 3 * sigma * np.sqrt(leverage)
        reach = exact if turn >= 1 else np.maximum(exact, lines.cell / 2)
    a, b = scale * starts + shift, scale * ends + shift
    rest = w - (scale * z + shift)
    extent = float(np.abs(w[:, None] - w).max())
    numbers = np.where(chosen >= 0, near[chosen], -1)
    return Fit(shape, scale, shift, numbers, turned, float((np.abs(rest) ** 2).sum()), extent, off_centre)


def _around(lines: Lines, places: np.ndarray) -> np.ndarray:
    """The numbers of the lines that lie wholly about some places."""
    room = lines.cell
    low = complex(places.real.min() - room, places.imag.min() - room)
    high = complex(places.real.max() + room, places.imag.max() + room)
    x, y = lines.ends.real, lines.ends.imag
    within = (x >= low.real) & (x <= high.real) & (y >= low.imag) & (y <= high.imag)
    return np.flatnonzero(within.all(axis=1))
