"""Laws of loads: the size of a force or torque over the cycle, and the data with which the report describes it.

Angles (rad) are the driver's turn in the direction of rotation. A course (`Stroke`) counts them from its `top`, one of
its two dead centres. A table of one turn is repeated to fill a cycle of two turns, so that the tables of
`machine.gas_pressure` serve both the gas of a four-stroke engine (Pa) and a working force over two strokes (N).
"""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Callable, Iterable
from typing import ClassVar, Literal

import numpy as np
from numpy.typing import NDArray

from reportgen.base.arrays import Flags, Floats
from reportgen.base.records import AbstractRecord, Record
from reportgen.formula import Expression, Symbol, ids
from reportgen.formula.calculation import Calculation
from reportgen.machine.gas_pressure import AngleIndicator, Bracket, IndicatorTable, StrokeIndicator, Tabled, crossings
from reportgen.machine.kinematics import Motion
from reportgen.machine.spring_geometry import Coil

FULL_TURN = 2 * np.pi
STEPS = 720
"""Number of samples of a turn, half a degree apart, in a search for reversals and unreachable angles."""
AT_ONCE = 5
"""Number of halvings made in one step."""
BEFORE_A_TURN = 1e-9
"""Angles (rad) closer than this below the end of the cycle, or below a turning point, belong to the next part."""

EDGE_OF_CUT = 1e-9
"""A share of the stroke this near to the beginning or end of the cut counts as that place."""

MotionAt = Callable[[Floats], Motion]
"""Function that returns the machine's motion at rising cycle angles [N] (rad)."""


class Stroke(Record):
    """The travel of the slider `link` between its dead centres; the link `rod` joins its `pin` to `crank_pin`.

    `top` and `bottom` are the pin's places (m) at the dead centres, `top_angle` and `bottom_angle` the driver's turn
    (rad) there, `phase` the slider's own cycle angle (rad) at position 1.
    """

    link: int
    rod: int
    pin: str
    crank_pin: str
    top: complex
    bottom: complex
    top_angle: float
    bottom_angle: float
    phase: float

    @property
    def stroke(self) -> float:
        """H, the distance of the dead centres (m)."""
        return abs(self.top - self.bottom)

    @property
    def inward(self) -> complex:
        """The unit vector from top to bottom."""
        return (self.bottom - self.top) / self.stroke

    @property
    def dead_centres(self) -> Floats:
        """Its own cycle angles [4] (rad) at which it turns back in two turns; the first is 0, the top."""
        inward_turn = (self.bottom_angle - self.top_angle) % FULL_TURN or np.pi
        return np.array([0.0, inward_turn, FULL_TURN, FULL_TURN + inward_turn])

    def fraction(self, motion: Motion) -> Floats:
        """Return s/H [N], the pin's distance from its top over the stroke, from 0 to 1."""
        fraction = np.real(np.conj(self.inward) * (motion.points[self.pin].p - self.top)) / self.stroke
        return np.asarray(np.clip(fraction, 0.0, 1.0))

    def fraction_rate(self, motion: Motion) -> Floats:
        """Return d(s/H)/dφ [N] (1/rad), where φ is the driver's turn in the direction of rotation."""
        speed = np.real(np.conj(self.inward) * motion.points[self.pin].v)
        return np.asarray(speed / (self.stroke * np.abs(motion.rate)))

    def share_at(self, motion_at: MotionAt) -> Callable[[Floats], Floats]:
        """Return the function that gives s/H [N] at the slider's own cycle angles [N] (rad), in any order."""

        def share(angle: Floats) -> Floats:
            order = np.argsort(angle)
            result = np.empty_like(angle)
            result[order] = self.fraction(motion_at(angle[order] - self.phase))
            return result

        return share


# --- laws ------------------------------------------------------------------------------------------


class Law(AbstractRecord):
    """Size (N or N·m) of a load over the machine's cycle angles (0 at position 1), with the data to describe it.

    Code that describes a load asks its law through this interface and does not test the law's class.
    """

    kind: ClassVar[Literal["constant", "opposing", "tabled", "cutting", "spring"]]
    """Behaviour of the load: constant, always opposing the motion, given by a table, cutting (acts while a tool
    cuts), or proportional to the stretch of a spring.
    """

    @abstractmethod
    def value(self, angle: Floats, motion: Motion) -> Floats:
        """Return the size [N] (N or N·m) at cycle angles [N] (rad) with the motion there."""

    @abstractmethod
    def breaks(self, motion_at: MotionAt) -> Iterable[float]:
        """Return the cycle angles (rad) where the size bends or jumps, in any order and any turn."""

    @property
    @abstractmethod
    def sizes(self) -> tuple[float, ...]:
        """The sizes (N or N·m) by which it is given."""

    @property
    def acts(self) -> bool:
        """True if it is not zero everywhere in the cycle."""
        return any(self.sizes)

    @property
    def constant(self) -> bool:
        """True if it has one size over the whole cycle."""
        return False

    @property
    def tabled(self) -> Tabled | None:
        """The table by which it is given; None if it is not given by a table."""
        return None

    def bracket(self, angle: Floats, motion: Motion) -> Bracket | None:
        """Return the nodes of its table on both sides of cycle angles [N] (rad); None if it has no table."""
        return None

    @property
    def symbol(self) -> Symbol | None:
        """Symbol of the quantity in its table, if that is not the load itself; else None."""
        return None

    @property
    def read_along(self) -> Stroke | None:
        """The course of the slider by whose place its table is read; None without such a table."""
        return None

    @property
    def coil(self) -> Coil | None:
        """The spring that exerts it; None if no spring does."""
        return None

    def formula(self, q: Calculation, link: int) -> Expression | None:
        """Return the formula of the size in quantities of the calculation, for the load on `link`.

        None if the size is given or read from a table.
        """
        return None


class TableLaw(Law):
    """A table interpolated by a slider's own cycle angle and s/H.

    `turns` is the number of turns given: a table of one turn is repeated in `table`.
    """

    course: Stroke
    table: IndicatorTable
    turns: int = 2
    kind = "tabled"

    def value(self, angle: Floats, motion: Motion) -> Floats:
        return self.reading(angle, motion)

    def reading(self, angle: Floats, motion: Motion) -> Floats:
        """Return the values [N] of the table (N or Pa) at cycle angles [N] (rad) with the motion there."""
        course = self.course
        return self.table.pressure(course.phase + angle, course.fraction(motion), course.dead_centres)

    def bracket(self, angle: Floats, motion: Motion) -> Bracket:
        course = self.course
        read = self.table.bracket(course.phase + angle, course.fraction(motion), course.dead_centres)
        # A table of one turn is repeated; readings of the repetition are printed as those of the given turn.
        return read if read.kind == "ratio" or self.turns > 1 else read.in_first(FULL_TURN)

    def breaks(self, motion_at: MotionAt) -> Iterable[float]:
        course = self.course
        corners = (*self.table.breaks(course.share_at(motion_at), course.dead_centres), *course.dead_centres)
        return (corner - course.phase for corner in corners)

    @property
    def sizes(self) -> tuple[float, ...]:
        return tuple(size for row in self.table.rows for size in row)

    @property
    def constant(self) -> bool:
        return len({*self.sizes}) == 1

    @property
    def tabled(self) -> Tabled:
        return self.table.tabled(self.turns)

    @property
    def read_along(self) -> Stroke:
        return self.course


class GasLaw(TableLaw, kw_only=True):
    """The gas on a piston: the pressure p (Pa) in the table times the piston's area F (m²), P = p F."""

    area: float

    def value(self, angle: Floats, motion: Motion) -> Floats:
        return self.area * self.reading(angle, motion)

    @property
    def symbol(self) -> Symbol:
        return Symbol("p")

    def formula(self, q: Calculation, link: int) -> Expression | None:
        p = q.find(ids.pressure(link))
        return None if p is None else p * q["F"]


class ListedLaw(Law):
    """`values` (N or N·m) at `nodes`, linear between them; subclasses define the quantity of the nodes."""

    nodes: tuple[float, ...]
    values: tuple[float, ...]
    kind = "tabled"

    @property
    def sizes(self) -> tuple[float, ...]:
        return self.values

    @property
    def constant(self) -> bool:
        return len({*self.values}) == 1


class AngleLaw(ListedLaw):
    """Values over cycle angles (rad) from 0 to the end of the cycle; there the last one is followed by the first."""

    def value(self, angle: Floats, motion: Motion) -> Floats:
        return np.asarray(np.interp(self._within(angle), self.nodes, self.values))

    def _within(self, angle: Floats) -> Floats:
        """Return the angles [N] (rad) reduced to the cycle; an angle just below its end counts as 0."""
        return np.maximum(np.mod(angle + BEFORE_A_TURN, self.nodes[-1]) - BEFORE_A_TURN, 0.0)

    def bracket(self, angle: Floats, motion: Motion) -> Bracket:
        return Bracket.among("angle", self._within(angle), self.nodes, np.tile(self.values, (angle.size, 1)))

    def breaks(self, motion_at: MotionAt) -> Iterable[float]:
        return self.nodes

    @property
    def tabled(self) -> Tabled:
        return Tabled(Symbol("φ"), "angle", self.nodes, (self.values,))


class TravelLaw(ListedLaw):
    """Values over the travel (m) of a sliding driver from its start; the whole travel `span` (m) is not a cycle."""

    span: float

    def value(self, angle: Floats, motion: Motion) -> Floats:
        return np.asarray(np.interp(angle * self.span / FULL_TURN, self.nodes, self.values))

    def bracket(self, angle: Floats, motion: Motion) -> Bracket:
        travel = angle * self.span / FULL_TURN
        return Bracket.among("length", travel, self.nodes, np.tile(self.values, (angle.size, 1)))

    def breaks(self, motion_at: MotionAt) -> Iterable[float]:
        return (way / self.span * FULL_TURN for way in self.nodes)

    @property
    def tabled(self) -> Tabled:
        return Tabled(Symbol("s"), "segment", self.nodes, (self.values,))


class CuttingLaw(Law):
    """The `force` (N) on a ram while the tool cuts: on the stroke of the ram's `course` that begins at the top.

    The tool runs free over the share `free` of the stroke at each end.
    """

    course: Stroke
    force: float
    free: float
    kind = "cutting"

    def value(self, angle: Floats, motion: Motion) -> Floats:
        """Return the force (N) [N] at cycle angles [N] (rad); a dead centre belongs to the stroke that it begins."""
        turned = np.mod(self.course.phase + angle + BEFORE_A_TURN, FULL_TURN) - BEFORE_A_TURN
        working = turned < self.course.bottom_angle - BEFORE_A_TURN
        share = self.course.fraction(motion)
        cuts = (share >= self.free - EDGE_OF_CUT) & (share <= 1 - self.free + EDGE_OF_CUT)
        return np.where(working & cuts, self.force, 0.0)

    def breaks(self, motion_at: MotionAt) -> Iterable[float]:
        course, corners = self.course, np.array([0.0, self.course.bottom_angle])
        if self.free:
            wanted, share_at = np.array([self.free, 1 - self.free]), course.share_at(motion_at)
            corners = crossings(lambda angle: share_at(angle) - wanted, np.zeros(2), np.full(2, course.bottom_angle))
        return (corner - course.phase for corner in corners)

    @property
    def sizes(self) -> tuple[float, ...]:
        return (self.force,)


class ConstantLaw(Law):
    """The same size at every position."""

    size: float
    kind = "constant"

    def value(self, angle: Floats, motion: Motion) -> Floats:
        return np.full(angle.shape, self.size)

    def breaks(self, motion_at: MotionAt) -> Iterable[float]:
        return ()

    @property
    def sizes(self) -> tuple[float, ...]:
        return (self.size,)

    @property
    def constant(self) -> bool:
        return True


class Opposing(Law):
    """−`size`·sgn(rate), the sign of the rate changing at the cycle angles `reversals` of one turn.

    `before` is the rate's sign before the first of them.
    """

    size: float
    reversals: tuple[float, ...]
    before: float
    kind = "opposing"

    def value(self, angle: Floats, motion: Motion) -> Floats:
        passed = np.searchsorted(self.reversals, np.mod(angle + BEFORE_A_TURN, FULL_TURN), side="right")
        return np.where(passed % 2, 1.0, -1.0) * self.before * self.size

    def breaks(self, motion_at: MotionAt) -> Iterable[float]:
        return self.reversals

    @property
    def sizes(self) -> tuple[float, ...]:
        return (self.size,)


class Resistance(Law):
    """−`size`·sgn(rate) over the travel of a sliding driver, which does not return to its start."""

    size: float
    rate: Callable[[Motion], Floats]
    reversals: tuple[float, ...]
    kind = "opposing"

    def value(self, angle: Floats, motion: Motion) -> Floats:
        return -self.size * np.sign(self.rate(motion))

    def breaks(self, motion_at: MotionAt) -> Iterable[float]:
        return self.reversals

    @property
    def sizes(self) -> tuple[float, ...]:
        return (self.size,)


def by_stroke(fractions: tuple[float, ...], inward: tuple[float, ...], outward: tuple[float, ...]) -> IndicatorTable:
    """Return the table of forces (N) over s/H: the row `inward` for the stroke away from the top, `outward` back.

    Raises `ValueError` if a row has another length than the fractions, or these do not rise from 0 to 1.
    """
    return StrokeIndicator(fractions, inward, outward, inward, outward)


def by_angle(angles: tuple[float, ...], values: tuple[float, ...]) -> IndicatorTable:
    """Return the table of forces (N) over two turns from one over a turn from the top, at angles 0…2π (rad).

    If its last value differs from the first, the force jumps there.  Raises `ValueError` for unequal lengths, or angles
    that do not rise from 0 to 2π.
    """
    second = tuple(angle + FULL_TURN for angle in angles)
    if values[0] == values[-1]:
        return AngleIndicator((*angles, *second[1:]), (*values, *values[1:]))
    just_after = np.nextafter(second[0], np.inf)
    return AngleIndicator((*angles, float(just_after), *second[1:]), (*values, *values))


def opposing(size: float, rate: Callable[[Floats], Floats]) -> Opposing:
    """Return a load of constant size (N or N·m) that opposes a rate.

    `rate` returns the rate [N] (m/s or rad/s) at cycle angles [N] (rad) of one turn.  A zero of a smooth rate is
    computed with few calls of it, a jump of its sign with more.
    """
    edges, rates, changes = _changes(rate)
    zeros = zeros_between(rate, edges[np.stack((changes, changes + 1))], rates[np.stack((changes, changes + 1))])
    reversals = np.mod(zeros + BEFORE_A_TURN, FULL_TURN) - BEFORE_A_TURN
    order = np.argsort(reversals)
    before = np.sign(rates[changes[order[0]] if order.size else 0])
    return Opposing(size, tuple(map(float, reversals[order])), float(before))


def reversal_count(rate: Callable[[Floats], Floats]) -> int:
    """Return how often a rate, as in `opposing`, changes its sign in a turn; the places are not computed."""
    return int(_changes(rate)[2].size)


def _changes(rate: Callable[[Floats], Floats]) -> tuple[Floats, Floats, NDArray[np.int64]]:
    """Return the samples (rad) of a turn, the rates there, and after which of them the rate changes its sign."""
    edges = np.linspace(0.0, FULL_TURN, STEPS + 1) - FULL_TURN / STEPS / np.pi
    rates = rate(edges)
    signs = np.sign(rates)
    return edges, rates, np.flatnonzero(signs[1:] != signs[:-1])


def zeros_between(rate: Callable[[Floats], Floats], ends: Floats, rates: Floats) -> Floats:
    """Return the zeros [N] (rad) of a rate between the `ends` [2, N] (rad) of intervals, with unlike `rates` [2, N].

    The zero of the chord over an interval of the width w (rad) is off by w²|f″/f′|/8 at most, so that the places at the
    distance w² on both sides of it enclose the zero of a smooth rate.  The middle halves the interval of any other.
    """
    first, each = np.sign(rates[0]), np.arange(ends.shape[1])
    while (ends[1] - ends[0] > 4 * BEFORE_A_TURN).any():
        (low, high), chord = ends, _chord(ends, rates)
        near = np.maximum((high - low) ** 2, BEFORE_A_TURN)
        inner = np.sort(np.clip((chord - near, (low + high) / 2, chord + near), low, high), axis=0)
        # Motion is solved along rising angles, interval by interval.
        inside = rate(inner.T.ravel()).reshape(inner.T.shape).T
        changed = np.argmax(np.vstack((np.sign(inside) != first, np.ones_like(each, dtype=bool))), axis=0)
        pair = np.stack((changed, changed + 1)), each
        ends, rates = np.vstack((low, inner, high))[pair], np.vstack((rates[0], inside, rates[1]))[pair]
    return _chord(ends, rates)


def _chord(ends: Floats, rates: Floats) -> Floats:
    """Return the zeros [N] of straight lines through `rates` [2, N] at `ends` [2, N]."""
    return np.asarray(ends[0] + (ends[1] - ends[0]) * rates[0] / (rates[0] - rates[1]))


def halved(low: Floats, high: Floats, before: Callable[[Floats], Flags], times: int) -> tuple[Floats, Floats]:
    """Halve the intervals [N] from `low` to `high` at least `times` times, and return the ends [N] of the small ones.

    Each of them contains the place where `before` becomes False.  `before` is called with many places [N, K] together,
    since the motion at one takes as long as at fifty.
    """
    shares = np.linspace(0.0, 1.0, 2**AT_ONCE + 1)
    each = np.arange(low.size)
    for _ in range(math.ceil(times / AT_ONCE)):
        places = low[:, None] + (high - low)[:, None] * shares
        places[:, -1] = high
        same = before(places[:, 1:-1])
        last = np.where(same.all(axis=1), same.shape[1], same.argmin(axis=1))
        low, high = places[each, last], places[each, last + 1]
    return low, high
