"""The gas pressure of a four-stroke engine over its cycle, interpolated in a table.

A cycle angle (rad) is the crank's turn from the piston's own top dead centre at the start of intake, in the
direction of rotation; a fraction is s/H, the piston's distance from its top dead centre over the stroke. Pressures
(Pa) are gauge pressures and push the piston towards the crank when positive.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import Literal, get_args

import numpy as np
from numpy.typing import ArrayLike, NDArray

from reportgen.base.arrays import Floats
from reportgen.base.records import Record, replace
from reportgen.formula import Expression, Fraction, Symbol
from reportgen.machine.quadrature import gauss

Stroke = Literal["intake", "compression", "expansion", "exhaust"]
STROKES: tuple[Stroke, ...] = get_args(Stroke)
OUTWARD = (1, -1, 1, -1)
"""Direction of the piston in each stroke: +1 away from its top dead centre, −1 towards it."""

CYCLE = 4 * math.pi
DEAD_CENTRES = (0.0, math.pi, 2 * math.pi, 3 * math.pi)
"""Cycle angles at which the strokes begin if the guide passes through the crank's centre."""

AT_DEAD_CENTRE = 1e-9
"""An angle less than this (rad) below a dead centre counts as the dead centre itself."""

HALVINGS = 60
"""A stroke halved so often is below the spacing of floats there."""
DRAWN_IN_A_STROKE = 91
"""Points of a stroke's line that is drawn from a table over the angle, two degrees apart."""
NODE = 1e-9
"""A place closer than this to a node, relative to its size, counts as at the node."""
SETTLED = 1e-9
"""A last step (rad) whose square is far below rounding."""


def stroke_at(cycle_angle: ArrayLike, dead_centres: ArrayLike = DEAD_CENTRES) -> NDArray[np.int64]:
    """Return the stroke [N] (0…3 of `STROKES`) at cycle angles (rad); a dead centre belongs to the stroke that it
    begins.

    `dead_centres` are the cycle angles at which the four strokes begin, the first of them 0.
    """
    return np.searchsorted(np.asarray(dead_centres), _within(cycle_angle) + AT_DEAD_CENTRE, side="right") - 1


def _within(cycle_angle: ArrayLike) -> Floats:
    """Return the angle in [0, 4π), where rounding just below 4π counts as 0."""
    turned = np.mod(np.asarray(cycle_angle, dtype=np.float64) + AT_DEAD_CENTRE, CYCLE) - AT_DEAD_CENTRE
    return np.maximum(turned, 0.0)


class Tabled(Record):
    """A table as given: sizes (SI) at nodes, in a row for each stroke or in one for the whole cycle.

    `over` is the symbol of the nodes' quantity, `kind` its kind.
    """

    over: Expression
    kind: str
    nodes: tuple[float, ...]
    rows: tuple[tuple[float, ...], ...]


class Bracket(Record):
    """Adjacent nodes of a table on both sides of the places `at`, with their pressures (Pa); all arrays have shape [N].

    `kind` is the kind of quantity of the nodes: the "ratio" s/H, the "angle" of the cycle, or a "length", the travel.
    In a table of loads the pressures are sizes of the load (N or N·m).
    """

    kind: str
    at: Floats
    before: Floats
    after: Floats
    pressure_before: Floats
    pressure_after: Floats

    @classmethod
    def among(cls, kind: str, at: Floats, nodes: Sequence[float], pressures: Floats) -> Bracket:
        """Return the bracket of each place `at` [N] among rising nodes [K], with the pressures at each position [N, K].

        Places outside the nodes get the first or last pair.
        """
        index = np.clip(np.searchsorted(nodes, at, side="right") - 1, 0, len(nodes) - 2)
        each, places = np.arange(len(at)), np.asarray(nodes)
        return cls(
            kind=kind,
            at=at,
            before=places[index],
            after=places[index + 1],
            pressure_before=pressures[each, index],
            pressure_after=pressures[each, index + 1],
        )

    @property
    def between(self) -> np.ndarray:
        """Flags [N]: True if the value is interpolated, that is not at a node and not between two equal values."""
        ends = np.array([self.before, self.after])
        room = NODE * np.max(np.abs(ends), axis=0)
        at_node = (np.abs(self.at - ends) <= room).any(axis=0)
        return np.asarray((self.pressure_before != self.pressure_after) & ~at_node)

    def in_first(self, turn: float) -> Bracket:
        """Return the bracket shifted by whole turns, each `turn` (rad), so that its nodes `before` are in the first."""
        before = turn * np.floor(self.before / turn)
        return replace(self, at=self.at - before, before=self.before - before, after=self.after - before)


Branch = tuple[tuple[float, ...], tuple[float, ...]]
"""The line of a stroke in a diagram: fractions s/H and the pressures (Pa) there."""


class StrokeIndicator(Record):
    """Four rows of pressure (Pa) over the same fractions s/H, which rise from 0 to 1; linear between.

    Raises `ValueError` for rows of other lengths or fractions that do not rise from 0 to 1.
    """

    fractions: tuple[float, ...]
    intake: tuple[float, ...]
    compression: tuple[float, ...]
    expansion: tuple[float, ...]
    exhaust: tuple[float, ...]

    def __post_init__(self) -> None:
        _rising(self.fractions, 0.0, 1.0)
        if any(len(row) != len(self.fractions) for row in self.rows):
            raise ValueError("every row needs one pressure for each fraction")

    @property
    def rows(self) -> tuple[tuple[float, ...], ...]:
        """The four rows of pressures (Pa), each [K], in the order of `STROKES`."""
        return self.intake, self.compression, self.expansion, self.exhaust

    def tabled(self, turns: int = 2) -> Tabled:
        """Return the table as it was given for the first `turns` turns, two strokes each."""
        return Tabled(Fraction(Symbol("s"), Symbol("H")), "ratio", self.fractions, self.rows[: 2 * turns])

    def bracket(self, cycle_angle: Floats, fraction: Floats, dead_centres: ArrayLike = DEAD_CENTRES) -> Bracket:
        """Return the nodes of the stroke's row around the piston at cycle angles [N] (rad) and fractions [N]."""
        rows = np.asarray(self.rows)[stroke_at(cycle_angle, dead_centres)]
        return Bracket.among("ratio", fraction, self.fractions, rows)

    def branches(
        self, fraction_of: Callable[[Floats], Floats], dead_centres: ArrayLike = DEAD_CENTRES
    ) -> tuple[Branch, ...]:
        """Return each stroke's line over s/H; `fraction_of` and `dead_centres` are ignored here."""
        return tuple((self.fractions, row) for row in self.rows)

    def pressure(self, cycle_angle: ArrayLike, fraction: ArrayLike, dead_centres: ArrayLike = DEAD_CENTRES) -> Floats:
        """Return the pressure (Pa) [N] at cycle angles [N] (rad), with the piston at fractions [N] of its stroke."""
        stroke, at = stroke_at(cycle_angle, dead_centres), np.asarray(fraction)
        nodes, rows = np.asarray(self.fractions), np.asarray(self.rows)
        # Beyond the last node, s/H = 1, the pressure stays constant.
        slopes = np.diff(rows, append=rows[:, -1:]) / np.diff(nodes, append=np.inf)
        before = np.clip(np.searchsorted(nodes, at, side="right") - 1, 0, nodes.size - 1)
        return np.asarray(slopes[stroke, before] * (at - nodes[before]) + rows[stroke, before], dtype=np.float64)

    def breaks(
        self, fraction_of: Callable[[Floats], Floats], dead_centres: ArrayLike = DEAD_CENTRES
    ) -> tuple[float, ...]:
        """Return all cycle angles in [0, 4π] (rad) where the pressure bends or jumps, rising.

        `fraction_of` gives s/H at cycle angles [N]; it is monotonic between dead centres, so each
        stroke crosses every node once.
        """
        starts = np.asarray(dead_centres, dtype=np.float64)
        edges = np.append(starts, CYCLE)
        inner = np.asarray(self.fractions[1:-1])
        low = np.repeat(edges[:-1], inner.size)
        high = np.repeat(edges[1:], inner.size)
        wanted = np.tile(inner, starts.size)
        outward = np.repeat(np.asarray(OUTWARD), inner.size)
        bends = crossings(lambda angle: outward * (fraction_of(angle) - wanted), low, high)
        return tuple(sorted({*edges.tolist(), *bends.tolist()}))

    def work(self, area: float, stroke: float) -> float:
        """Return the indicated work of one cylinder per cycle (J), W = A H Σ ±∫ p d(s/H), exact for the table.

        `area` A of the piston (m²), `stroke` H (m).
        """
        rows = np.asarray(self.rows)
        means = (rows[:, 1:] + rows[:, :-1]) / 2 @ np.diff(self.fractions)
        return float(area * stroke * np.dot(OUTWARD, means))


class AngleIndicator(Record):
    """Pressures (Pa) at cycle angles (rad) that rise from 0 to 4π; linear between.

    Raises `ValueError` for unequal lengths or angles that do not rise from 0 to 4π.
    """

    angles: tuple[float, ...]
    pressures: tuple[float, ...]

    def __post_init__(self) -> None:
        _rising(self.angles, 0.0, CYCLE)
        if len(self.pressures) != len(self.angles):
            raise ValueError("every angle needs one pressure")

    @property
    def rows(self) -> tuple[tuple[float, ...], ...]:
        """The only row of pressures (Pa) [K]."""
        return (self.pressures,)

    def tabled(self, turns: int = 2) -> Tabled:
        """Return the table as it was given for the first `turns` turns."""
        count = sum(angle <= turns * 2 * math.pi * (1 + 1e-15) for angle in self.angles)
        return Tabled(Symbol("φ"), "angle", self.angles[:count], (self.pressures[:count],))

    def bracket(self, cycle_angle: Floats, fraction: Floats, dead_centres: ArrayLike = DEAD_CENTRES) -> Bracket:
        """Return the nodes on both sides of the cycle angles [N] (rad); `fraction` is ignored here."""
        rows = np.tile(self.pressures, (len(cycle_angle), 1))
        return Bracket.among("angle", np.mod(cycle_angle, CYCLE), self.angles, rows)

    def branches(
        self, fraction_of: Callable[[Floats], Floats], dead_centres: ArrayLike = DEAD_CENTRES
    ) -> tuple[Branch, ...]:
        """Return each stroke's line over s/H, from the piston's motion: `fraction_of` gives s/H [K] at cycle angles [K]
        (rad).
        """
        corners = []
        for start, end in pairwise((*np.asarray(dead_centres), CYCLE)):
            nodes = [angle for angle in self.angles if start < angle < end]
            angle = np.array(sorted({*np.linspace(start, end, DRAWN_IN_A_STROKE), *nodes}))
            pressure = np.interp(angle, self.angles, self.pressures)
            corners.append((tuple(map(float, fraction_of(angle))), tuple(map(float, pressure))))
        return tuple(corners)

    def pressure(
        self, cycle_angle: ArrayLike, fraction: ArrayLike = 0.0, dead_centres: ArrayLike = DEAD_CENTRES
    ) -> Floats:
        """Return the pressure (Pa) [N] at cycle angles [N] (rad); `fraction` is ignored here."""
        return np.interp(_within(cycle_angle), self.angles, self.pressures)

    def breaks(
        self, fraction_of: Callable[[Floats], Floats] | None = None, dead_centres: ArrayLike = DEAD_CENTRES
    ) -> tuple[float, ...]:
        """Return all cycle angles in [0, 4π] (rad) where the pressure bends, rising."""
        return self.angles

    def work(self, volume_rate: Callable[[Floats], Floats]) -> float:
        """Return the indicated work of one cylinder per cycle (J), W = ∫ p (dV/dφ) dφ over 4π.

        `volume_rate` gives dV/dφ (m³/rad) at cycle angles [N].  Gauss–Legendre quadrature with 16
        nodes between table nodes, on parts of at most 15°: exact to rounding for a slider-crank.
        """
        edges = np.array(sorted({*self.angles, *np.linspace(0.0, CYCLE, 49)}))
        angle, weights = gauss(edges[:-1], edges[1:])
        rate = np.asarray(volume_rate(angle.ravel())).reshape(angle.shape)
        return float(np.sum(weights * rate * np.interp(angle, self.angles, self.pressures)))


IndicatorTable = StrokeIndicator | AngleIndicator


def indicated_work(
    indicator: IndicatorTable, area: float, stroke: float, fraction_rate: Callable[[Floats], Floats]
) -> float:
    """Return the indicated work of one cylinder per cycle (J) for either form; `area` in m², `stroke` in m.

    `fraction_rate` gives d(s/H)/dφ (1/rad) at cycle angles [N]; the form by stroke does not need it.
    """
    if isinstance(indicator, StrokeIndicator):
        return indicator.work(area, stroke)
    return indicator.work(lambda angle: area * stroke * fraction_rate(angle))


def crossings(rise: Callable[[Floats], Floats], low: Floats, high: Floats) -> Floats:
    """Return the zeros [N] (rad) of a function that is negative at `low` [N] and positive at `high` [N].

    Ridders' method: with f_m at the middle, x = m − (m − low) f_m/√(f_m² − f_low f_high) lies between
    both ends, and its error falls with the square of the step before.
    """
    below, above = rise(low), rise(high)
    root_at = low
    for _ in range(HALVINGS):
        middle = (low + high) / 2
        between = rise(middle)
        root = np.sqrt(np.maximum(between**2 - below * above, 0.0))
        step = np.divide(between, root, out=np.zeros_like(root), where=root > 0)
        before, root_at = root_at, middle - (middle - low) * step
        there = rise(root_at)
        if np.all(np.abs(root_at - before) <= SETTLED):
            break
        for angle, value in ((middle, between), (root_at, there)):
            short = (value < 0) & (angle > low)
            low, below = np.where(short, angle, low), np.where(short, value, below)
            past = (value >= 0) & (angle < high)
            high, above = np.where(past, angle, high), np.where(past, value, above)
    return root_at


def _rising(nodes: tuple[float, ...], first: float, last: float) -> None:
    steps = np.diff(np.asarray(nodes, dtype=np.float64))
    if not steps.size or (steps <= 0).any() or not np.allclose((nodes[0], nodes[-1]), (first, last)):
        raise ValueError(f"the nodes must rise from {first:g} to {last:g}")
