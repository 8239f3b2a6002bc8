"""Find a plan of known shape among the lines of a drawing by its corners, and fit it by least squares.

A plan may be drawn at any place and to any scale, but not turned: a corner z (mm) of the report's figure lies at f z +
t (mm) in the drawing, with a real f > 0. For each two vectors that share a corner, all pairs of lines that share an end
are tried. The resulting f and t are tested at all other corners, and fitted to all lines there.

Shapes of arrays: E vectors of a plan, M lines of the drawing, K lines found. Points are complex.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from reportgen.handin.line_set import Lines
from reportgen.handin.plan_shapes import PlanShape

FURTHEST = 5.0
"""Largest factor by which a plan is drawn larger or smaller than in the report."""
ANYWHERE = float(np.log(FURTHEST**2))
"""The range of scales, as a logarithm."""
FEWEST_CORNERS = 3
"""Smallest number of corners that have a shape."""
HALF = 0.5
"""Share of the visible vectors that must have a line before anything is fitted."""
MOST_TRIED = 15
"""Largest number of placements of a plan that are fitted, those with most lines first."""
ROUNDS = 4
LONG = 10.0
"""Length in errors of an end (5 mm) below which a line has hardly any direction, and a vector has no arrowhead."""
REACH = float(np.sqrt(6))
"""Largest distance of an end from its place, in deviations: √3 in each direction for evenly spread errors."""
SEEN = 6.0
"""Length in errors of an end (3 mm) from which a vector is visible; a shorter one is drawn enlarged beside it."""


@dataclass(frozen=True, eq=False)
class Fit:
    """A plan found among lines: corners z at `scale` z + `shift` (mm), and the line of each vector.

    `scale` is the ratio of lengths in the drawing to those in the report's figure. `lines` [E] are numbers, −1 for a
    vector without a line; `turned` [E] is True if the line begins where its vector ends. `rest` [2 K] are the ends of
    the K lines found, vector starts first, minus their places (mm). `size` is the extent of the lines found (mm).
    """

    shape: PlanShape
    scale: float
    shift: complex
    lines: np.ndarray
    turned: np.ndarray
    rest: np.ndarray
    size: float
    off_centre: float
    """The sum of the squared distances (mm², report's scale) of the fitted corners from their middle."""
    reach: np.ndarray
    """Largest distance (mm) of the ends of each vector from their places [E]."""
    used: frozenset[int]
    """The pieces of the lines that it explains."""

    @property
    def present(self) -> np.ndarray:
        """The numbers [K] of the vectors that have a line."""
        return np.flatnonzero(self.lines >= 0)

    @cached_property
    def explained(self) -> frozenset[int]:
        """The lines that it explains."""
        return frozenset(int(line) for line in self.lines[self.lines >= 0])

    @property
    def square(self) -> float:
        """The sum of the squared distances (mm²) of all ends from their places."""
        return float((np.abs(self.rest) ** 2).sum())

    def missing(self, least: float) -> int:
        """Return the number of vectors without a line that would be visible, being longer than `least` (mm)."""
        lengths = self.scale * np.abs(self.shape.ends - self.shape.starts)
        drawn = np.array([vector.drawn for vector in self.shape.vectors])
        return int((drawn & (self.lines < 0) & (lengths > least)).sum())

    def at(self, corners: np.ndarray) -> np.ndarray:
        """Return the places in the drawing (mm) of corners of the report's figure (mm, any shape)."""
        return self.scale * corners + self.shift

    def corners_met(self, apart: float) -> tuple[np.ndarray, float]:
        """Return the corners [n] of the lines (mm, relative to `shift`), and their squared error (mm²).

        Corners closer than `apart` (mm) are merged. The squared error is the sum over the corners of the squared mean
        distance of their ends, weighted with the number of ends. The distances of the ends of one corner from each
        other are evidence neither for nor against this plan.
        """
        shape, present = self.shape, self.present
        met = [shape.vectors[number].start for number in present] + [shape.vectors[number].end for number in present]
        places = (self.scale * shape.corners).tolist()
        kept: list[complex] = []
        at: list[int] = []
        for corner in met:
            near = next((n for n, one in enumerate(kept) if abs(places[corner] - one) <= apart), None)
            if near is None:
                near = len(kept)
                kept.append(places[corner])
            at.append(near)
        count = np.bincount(at)
        means = (np.bincount(at, self.rest.real) + 1j * np.bincount(at, self.rest.imag)) / count
        return np.array(kept), float((count * np.abs(means) ** 2).sum())

    def scale_error(self, deviation: float) -> float:
        """Return the standard deviation of the scale (a ratio) if every end has a `deviation` (mm) in each direction.

        It is σ/√Σ|z − z̄|² over the fitted corners z, infinite if they are all at one place.
        """
        return float(deviation / np.sqrt(self.off_centre)) if self.off_centre > 0 else np.inf


def fits(shape: PlanShape, lines: Lines, scales: Sequence[float] = ()) -> list[Fit]:
    """Return all placements in which a plan fits some of the lines, each once.

    `scales` are ratios of lengths in the drawing to those in the report's figure, near which the plan is searched for;
    without them any scale from 1/`FURTHEST` to `FURTHEST` is tried. At most `MOST_TRIED` placements are fitted.
    """
    tried = [_by_corners(shape, lines)] if not scales else [_by_vectors(shape, lines, scale) for scale in scales]
    scale, shift = (np.concatenate(part) for part in zip(*tried, strict=True))
    if not len(scale):
        return []
    starts, ends = (scale[:, None] * part + shift[:, None] for part in (shape.starts, shape.ends))
    seen = (np.abs(ends - starts) >= SEEN * lines.error) & np.array([vector.drawn for vector in shape.vectors])
    met = (lines.run_between(starts, ends) & seen).sum(axis=1)
    enough = np.flatnonzero(met >= np.maximum(2, HALF * seen.sum(axis=1)))
    enough = enough[np.argsort(-met[enough], kind="stable")]
    placed: dict[frozenset[int], Fit] = {}
    tried_about: set[tuple[int, int, int]] = set()
    for number in enough:
        step = lines.cell / 2
        about = (round(np.log(scale[number]) * 50), round(shift[number].real / step), round(shift[number].imag / step))
        if about in tried_about:
            continue
        tried_about.add(about)
        if len(tried_about) > MOST_TRIED:
            break
        fit = fitted(shape, lines, float(scale[number]), complex(shift[number]))
        if fit is not None and (fit.explained not in placed or fit.square < placed[fit.explained].square):
            placed[fit.explained] = fit
    return list(placed.values())


def _by_corners(shape: PlanShape, lines: Lines) -> tuple[np.ndarray, np.ndarray]:
    """Return scales [P] and shifts [P] (mm) of a plan from all pairs of lines that meet as two of its vectors do."""
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
    """Yield each corner where two different vectors meet, and both vectors from it, the longer one first (mm)."""
    touching: dict[int, list[complex]] = {}
    for vector in shape.vectors:
        start, end = complex(shape.corners[vector.start]), complex(shape.corners[vector.end])
        touching.setdefault(vector.start, []).append(end - start)
        touching.setdefault(vector.end, []).append(start - end)
    for corner, vectors in touching.items():
        vectors = sorted(vectors, key=abs, reverse=True)
        for number, first in enumerate(vectors):
            for second in vectors[number + 1 :]:
                if first != second:
                    yield complex(shape.corners[corner]), first, second


def _window(angle: np.ndarray, middle: float, turn: float) -> Iterator[tuple[int, int]]:
    """Yield the index ranges of sorted angles (rad) within ±`turn` of `middle`, around the circle."""
    for whole in (-2 * np.pi, 0.0, 2 * np.pi):
        low, high = np.searchsorted(angle, (middle - turn + whole, middle + turn + whole))
        if high > low:
            yield int(low), int(high)


def _by_vectors(shape: PlanShape, lines: Lines, scale: float) -> tuple[np.ndarray, np.ndarray]:
    """Return scales [P] and shifts [P] (mm) of a plan of known scale.

    The shifts follow from every line with the length and direction of one of the plan's vectors.
    """
    starts, vectors = shape.starts, scale * (shape.ends - shape.starts)
    shifts = []
    for sense, start in ((1, lines.ends[:, 0]), (-1, lines.ends[:, 1])):
        along = sense * (lines.ends[:, 1] - lines.ends[:, 0])
        vector, line = np.nonzero(np.abs(vectors[:, None] - along) <= 2 * lines.reach)
        shifts.append(start[line] - scale * starts[vector])
    shift = np.concatenate(shifts)
    return np.full(len(shift), scale), shift


def fitted(shape: PlanShape, lines: Lines, scale: float, shift: complex, deviation: float | None = None) -> Fit | None:
    """Return the best fit of a plan near a first guess of scale (a ratio) and shift (mm).

    `deviation` is the standard deviation of an end in each direction (mm), by default error/√3 of evenly spread errors.
    None is returned if fewer than two vectors have lines, if all their ends are at one corner, or if the scale is not
    between 1/`FURTHEST` and `FURTHEST`.
    """
    starts, ends = shape.starts, shape.ends
    sigma = lines.error / np.sqrt(3) if deviation is None else deviation
    near_by = _around(lines, scale * shape.corners + shift)
    if not len(near_by):
        return None
    some = lines.ends[near_by]
    reach = np.full(len(starts), lines.cell)
    rows = np.arange(len(starts))
    for turn in range(ROUNDS):
        a, b = scale * starts + shift, scale * ends + shift
        farthest, turned, squares = off_place(some, a, b)
        # A vector shorter than the errors of its two ends has no direction.
        fits_there = (farthest <= reach[:, None]) & (np.abs(b - a) > 2 * REACH * sigma)[:, None]
        line = _with_own_pieces(np.where(fits_there, squares, np.inf), lines, near_by)
        seen = line >= 0
        kept = np.flatnonzero(seen)
        if len(kept) < 2:
            return None
        z = np.concatenate((starts[kept], ends[kept]))
        w = _ends_of(some[line[kept]], turned[kept, line[kept]])
        off_centre = float((np.abs(z - z.mean()) ** 2).sum())
        if off_centre == 0.0:
            return None
        scale = float(((w - w.mean()) * (z - z.mean()).conjugate()).real.sum() / off_centre)
        shift = complex(w.mean() - scale * z.mean())
        if not 1 / FURTHEST < scale < FURTHEST:
            return None
        reach = _reach(shape, z, sigma)
        # The first guess is finer than the cells, but not as fine as the fit.
        reach = np.maximum(reach, lines.cell / 2) if turn == 0 else reach
    numbers = np.where(seen, near_by[line], -1)
    extent = float(np.abs(w[:, None] - w).max())
    return Fit(
        shape,
        scale,
        shift,
        numbers,
        turned=turned[rows, line],
        rest=w - (scale * z + shift),
        size=extent,
        off_centre=off_centre,
        reach=reach,
        used=frozenset().union(*(lines.pieces[number] for number in numbers[seen])),
    )


def off_place(some: np.ndarray, a: np.ndarray, b: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the distances of some lines [M, 2] (mm) from the vectors from a [E] to b [E] (mm), in three arrays [E, M].

    These are the distance of the farther end (mm), True if the line is reversed, and the sum of both squares (mm²).
    """
    starts, ends = [np.abs(some[:, n] - a[:, None]) for n in (0, 1)], [np.abs(some[:, n] - b[:, None]) for n in (0, 1)]
    straight, opposite = np.maximum(starts[0], ends[1]), np.maximum(starts[1], ends[0])
    turned = opposite < straight
    squares = np.where(turned, starts[1] ** 2 + ends[0] ** 2, starts[0] ** 2 + ends[1] ** 2)
    return np.minimum(straight, opposite), turned, squares


def _with_own_pieces(squares: np.ndarray, lines: Lines, some: np.ndarray) -> np.ndarray:
    """Return the line of each vector [E] like `_each_its_own`; pieces that are vectors themselves do not form a run.

    `squares` [E, M] are the misfits (mm²) and are changed; `some` [M] are the numbers of the lines.
    """
    line = _each_its_own(squares)
    if not lines.in_runs[some].any():
        return line
    while True:
        chosen = set(line[line >= 0].tolist())
        pieces = {n: lines.pieces[some[n]] for n in chosen}
        used = Counter(piece for own in pieces.values() for piece in own)
        twice = [n for n, own in pieces.items() if len(own) > 1 and any(used[piece] > 1 for piece in own)]
        if not twice:
            return line
        # If a piece remains unused, the pieces belong to the whole line.
        whole = next((n for n in twice if any(used[piece] == 1 for piece in pieces[n])), None)
        gone = twice if whole is None else [n for n in chosen if n != whole and pieces[n] & pieces[whole]]
        squares[:, gone] = np.inf
        line = _each_its_own(squares)


def _each_its_own(squares: np.ndarray) -> np.ndarray:
    """Return the line of each vector [E], −1 for none, from the misfits [E, M] (mm²).

    The best pairs are assigned first, and no line twice. A vector left without a line may share that of another: both
    are one line on paper if there is no further line.
    """
    best = np.where(np.isfinite(squares.min(axis=1)), squares.argmin(axis=1), -1)
    kept = best[best >= 0]
    if len(set(kept.tolist())) == len(kept):
        return best
    chosen, used = np.full(len(best), -1), set()
    vectors, lines = np.nonzero(np.isfinite(squares))
    for number in np.argsort(squares[vectors, lines], kind="stable"):
        vector, line = int(vectors[number]), int(lines[number])
        if chosen[vector] < 0 and line not in used:
            chosen[vector] = line
            used.add(line)
    return np.where(chosen < 0, best, chosen)


def _ends_of(some: np.ndarray, turned: np.ndarray) -> np.ndarray:
    """Return the ends [2 K] (mm) of lines [K, 2], first those where their vectors start."""
    return np.concatenate((np.where(turned, some[:, 1], some[:, 0]), np.where(turned, some[:, 0], some[:, 1])))


def _reach(shape: PlanShape, fitted_to: np.ndarray, sigma: float) -> np.ndarray:
    """Return the largest distance (mm) of the ends of each vector from their places [E].

    It is an end's own error plus three deviations of the fit. Evenly spread errors reach to √3 deviations in each
    direction. The fit's own deviation is σ √h, with the leverage h = 1/n + |z − z̄|²/Σ|z − z̄|².
    """
    middle = fitted_to.mean()
    spread = float((np.abs(fitted_to - middle) ** 2).sum())
    from_middle = np.maximum(np.abs(shape.starts - middle), np.abs(shape.ends - middle))
    leverage = 1 / len(fitted_to) + from_middle**2 / spread
    reach: np.ndarray = REACH * sigma + 3 * sigma * np.sqrt(leverage)
    return reach


Beside = Callable[[int, int], bool]
"""Returns True if the name of a vector, by its number, is written beside a line, by its number."""


def named(fit: Fit, lines: Lines, deviation: float, odds: float, beside: Beside) -> np.ndarray:
    """Return a mask [E] of the vectors of a fit whose line certainly belongs to them and to no other vector.

    A fragment of a longer line belongs to the vector only if the plan has vectors for all pieces of that line. The
    `odds` (logarithm) are required against every other line at its place, and against every other vector at the place
    of its line, for the standard `deviation` (mm) of an end in each direction. A name written beside this line and not
    beside the other is enough, too. Vectors whose ends are closer than the error of a drawn point are one line on
    paper, which is both.
    """
    a, b = fit.at(fit.shape.starts), fit.at(fit.shape.ends)
    near = _around(lines, fit.at(fit.shape.corners))
    farthest, _, squares = off_place(lines.ends[near], a, b)
    place = {int(line): column for column, line in enumerate(near)}
    own = {int(number): place[int(fit.lines[number])] for number in fit.present}
    fits_there = farthest <= fit.reach[:, None]
    least = 2 * odds * deviation**2
    sure = (fit.lines >= 0) & (np.abs(b - a) >= SEEN * lines.error)
    for i, column in own.items():
        if any(not run <= fit.used for run in lines.longer[int(fit.lines[i])]):
            sure[i] = False
        free = fits_there[i].copy()
        free[list(own.values())] = False
        if (squares[i, free] - squares[i, column] < least).any():
            sure[i] = False
        for j in np.flatnonzero(fits_there[:, column]):
            if j == i or _off_place_of(a, b, i, int(j)) < lines.error:
                continue
            # A name is weak evidence for a line that two vectors share.
            alone = own.get(int(j)) != column
            if alone and beside(i, int(fit.lines[i])) and not beside(int(j), int(fit.lines[i])):
                continue
            against = squares[j, column] - squares[i, column]
            if j in own and own[int(j)] != column:
                against += squares[i, own[int(j)]] - squares[j, own[int(j)]]
            if against < least:
                sure[i] = False
    return np.asarray(sure)


def _off_place_of(a: np.ndarray, b: np.ndarray, first: int, second: int) -> float:
    """Return the largest distance (mm) between the ends of two vectors, in the better orientation."""
    straight = max(abs(a[first] - a[second]), abs(b[first] - b[second]))
    return float(min(straight, max(abs(a[first] - b[second]), abs(b[first] - a[second]))))


def _around(lines: Lines, places: np.ndarray) -> np.ndarray:
    """Return the numbers [K] of the lines that lie entirely around some places (mm)."""
    room = lines.cell
    low = complex(places.real.min() - room, places.imag.min() - room)
    high = complex(places.real.max() + room, places.imag.max() + room)
    x, y = lines.ends.real, lines.ends.imag
    within = (x >= low.real) & (x <= high.real) & (y >= low.imag) & (y <= high.imag)
    return np.flatnonzero(within.all(axis=1))
