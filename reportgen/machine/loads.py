"""Forces and torques that load a machine, and the sliders whose way they go by.

Angles are the driver's turn in the direction of rotation; a course counts them from its `top`, the dead centre
where crank and rod are stretched in one line.  A table of one turn is laid out twice, as a cycle of two: so gas in
four strokes and a working force of two share one reader (`machine.gas`), whose values are then newtons instead
of pascals.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from reportgen.assignment.common import Positions
from reportgen.formula import ids
from reportgen.machine import GROUND, Dyad, Guide, Linkage
from reportgen.machine.gas import AngleIndicator, Indicator, StrokeIndicator, crossings
from reportgen.machine.motion import Motion, solve_motion

Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]
FULL_TURN = 2 * np.pi
STEPS = 720
"""Places in a turn, half a degree apart: whether a machine gets there, whether a link turns back."""
HALVINGS = 50
AT_ONCE = 5
"""Halvings made in one step."""
BEFORE_A_TURN = 1e-9
"""Angles (rad) this near below the end of the cycle, or below a turning point, belong to what begins there."""

EDGE_OF_CUT = 1e-9
"""A share of the stroke this near to the tool's way in or out is rounding of it."""

MotionAt = Callable[[Floats], Motion]
"""The machine's motion at cycle angles [N] that grow from one to the next."""


@dataclass(frozen=True)
class Stroke:
    """The way of slider `link`, whose pin `pin` is joined by `rod` to `crank_pin`.

    `top` and `bottom` are the pin's places at the dead centres, `top_angle` and `bottom_angle` the
    driver's turn there, `phase` the slider's own cycle angle at position 1.
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
        """Its own cycle angles over two turns at which it turns back [4]; the first is 0, the top."""
        way = (self.bottom_angle - self.top_angle) % FULL_TURN or np.pi
        return np.array([0.0, way, FULL_TURN, FULL_TURN + way])

    def fraction(self, motion: Motion) -> Floats:
        """s/H [N]: the pin's way from its top over the stroke."""
        way = np.real(np.conj(self.inward) * (motion.points[self.pin].p - self.top)) / self.stroke
        return np.asarray(np.clip(way, 0.0, 1.0))

    def fraction_rate(self, motion: Motion) -> Floats:
        """d(s/H)/dφ [N] over the driver's turn φ in the direction of rotation."""
        speed = np.real(np.conj(self.inward) * motion.points[self.pin].v)
        return np.asarray(speed / (self.stroke * abs(motion.rate)))

    def share_at(self, motion_at: MotionAt) -> Callable[[Floats], Floats]:
        """s/H [N] at the slider's own cycle angles [N], in any order."""

        def share(angle: Floats) -> Floats:
            order = np.argsort(angle)
            result = np.empty_like(angle)
            result[order] = self.fraction(motion_at(angle[order] - self.phase))
            return result

        return share


# --- how a load varies over the cycle ---------------------------------------------------------------


class Law(Protocol):
    """The size of a force over the machine's cycle angles (0 at position 1)."""

    def value(self, angle: Floats, motion: Motion) -> Floats:
        """The force (N) [N] at cycle angles [N] with the motion there."""

    def breaks(self, motion_at: MotionAt) -> Iterable[float]:
        """Cycle angles where the force bends or jumps, in any order and any turn."""

    @property
    def acts(self) -> bool:
        """Whether it is anything at all at some place of the cycle."""


@dataclass(frozen=True)
class TableLaw:
    """A table read by a slider's own cycle angle and s/H, times `factor` (the area, for a pressure).

    `turns` is how many turns of it were given: a table of one turn stands twice in `table`.
    """

    course: Stroke
    table: Indicator
    factor: float = 1.0
    turns: int = 2

    def value(self, angle: Floats, motion: Motion) -> Floats:
        return self.factor * self.reading(angle, motion)

    def reading(self, angle: Floats, motion: Motion) -> Floats:
        """What stands in the table [N]."""
        course = self.course
        return self.table.pressure(course.phase + angle, course.fraction(motion), course.dead_centres)

    def breaks(self, motion_at: MotionAt) -> Iterable[float]:
        course = self.course
        corners = (*self.table.breaks(course.share_at(motion_at), course.dead_centres), *course.dead_centres)
        return (corner - course.phase for corner in corners)

    @property
    def acts(self) -> bool:
        return any(map(any, self.table.rows))


@dataclass(frozen=True)
class AngleLaw:
    """Values at cycle angles from 0 to the end of the cycle, linear between.

    The last value closes the cycle, or jumps to the first.
    """

    angles: tuple[float, ...]
    values: tuple[float, ...]

    def value(self, angle: Floats, motion: Motion) -> Floats:
        within = np.maximum(np.mod(angle + BEFORE_A_TURN, self.angles[-1]) - BEFORE_A_TURN, 0.0)
        return np.asarray(np.interp(within, self.angles, self.values))

    def breaks(self, motion_at: MotionAt) -> Iterable[float]:
        return self.angles

    @property
    def acts(self) -> bool:
        return any(self.values)


@dataclass(frozen=True)
class WayLaw:
    """Values over the way (m) of a sliding driver from its start, linear between; `span` is the whole way."""

    ways: tuple[float, ...]
    values: tuple[float, ...]
    span: float

    def value(self, angle: Floats, motion: Motion) -> Floats:
        return np.asarray(np.interp(angle * self.span / FULL_TURN, self.ways, self.values))

    def breaks(self, motion_at: MotionAt) -> Iterable[float]:
        return (way / self.span * FULL_TURN for way in self.ways)

    @property
    def acts(self) -> bool:
        return any(self.values)


@dataclass(frozen=True)
class CuttingLaw:
    """`force` (N) on the ram while the tool cuts, which it does on the way from the top of the ram's `course`.

    It runs free over the share `free` of the stroke at each end of that way.
    """

    course: Stroke
    force: float
    free: float

    def value(self, angle: Floats, motion: Motion) -> Floats:
        """The force (N) [N]; at a dead centre that of the stroke which begins there."""
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
    def acts(self) -> bool:
        return self.force != 0


@dataclass(frozen=True)
class ConstantLaw:
    """The same size at every position."""

    size: float

    def value(self, angle: Floats, motion: Motion) -> Floats:
        return np.full(angle.shape, self.size)

    def breaks(self, motion_at: MotionAt) -> Iterable[float]:
        return ()

    @property
    def acts(self) -> bool:
        return self.size != 0


@dataclass(frozen=True)
class Opposing:
    """−`size`·sgn(rate), the sign of the rate changing at the cycle angles `reversals` of one turn.

    `before` is the rate's sign before the first of them.
    """

    size: float
    reversals: tuple[float, ...]
    before: float

    def value(self, angle: Floats, motion: Motion) -> Floats:
        passed = np.searchsorted(self.reversals, np.mod(angle + BEFORE_A_TURN, FULL_TURN), side="right")
        return np.where(passed % 2, 1.0, -1.0) * self.before * self.size

    def breaks(self, motion_at: MotionAt) -> Iterable[float]:
        return self.reversals

    @property
    def acts(self) -> bool:
        return self.size != 0


def by_stroke(fractions: tuple[float, ...], inward: tuple[float, ...], outward: tuple[float, ...]) -> Indicator:
    """Forces over s/H from the top: a row for the way in, towards the crank, and one for the way out."""
    return StrokeIndicator(fractions, inward, outward, inward, outward)


def by_angle(angles: tuple[float, ...], values: tuple[float, ...]) -> Indicator:
    """Forces over one turn from the top, 0…2π; the table's last value closes the turn or jumps to the first."""
    second = tuple(angle + FULL_TURN for angle in angles)
    if values[0] == values[-1]:
        return AngleIndicator((*angles, *second[1:]), (*values, *values[1:]))
    just_after = np.nextafter(second[0], np.inf)
    return AngleIndicator((*angles, float(just_after), *second[1:]), (*values, *values))


def opposing(size: float, rate: Callable[[Floats], Floats]) -> Opposing:
    """What resists a `rate` over the cycle angle (0…2π) with a constant size."""
    edges = np.linspace(0.0, FULL_TURN, STEPS + 1) - FULL_TURN / STEPS / np.pi
    signs = np.sign(rate(edges))
    changes = np.flatnonzero(signs[1:] != signs[:-1])
    first = signs[changes]
    halvings = HALVINGS if changes.size else 0

    def unchanged(angle: Floats) -> Flags:
        return np.asarray(np.sign(rate(angle.ravel()).reshape(angle.shape)) == first[:, None])

    _, high = halved(edges[changes], edges[changes + 1], unchanged, halvings)
    found = np.sort(np.mod(high + BEFORE_A_TURN, FULL_TURN) - BEFORE_A_TURN)
    # The first of them in the turn is where the sign before it ends.
    after = rate(np.array([(found[0] + found[1]) / 2])) if found.size > 1 else -rate(np.array([0.0]))
    return Opposing(size, tuple(map(float, found)), -float(np.sign(after[0])))


def halved(low: Floats, high: Floats, before: Callable[[Floats], Flags], times: int) -> tuple[Floats, Floats]:
    """The intervals [N] from `low` to `high` halved so often, each towards where `before` ends to be true.

    `before` is asked of many places [N, K] at once, since the motion at one takes as long as at fifty.
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


# --- sliders of a linkage ---------------------------------------------------------------------------


def crank_motion(linkage: Linkage, positions: Positions, start: float, speed: float = 1.0) -> MotionAt:
    """The motion at cycle angles [N] of a linkage whose crank stands at the angle `start` in position 1."""
    turn = positions.sign
    return lambda angle: solve_motion(linkage, start + turn * angle, turn * speed)


class NotToAndFro(ValueError):
    """A slider that does not go once to and fro in a turn of the driver; carries its number of reversals."""

    def __init__(self, reversals: int) -> None:
        self.reversals = reversals
        super().__init__(f"{reversals} reversals")


def rails(linkage: Linkage) -> dict[int, tuple[Dyad, Guide]]:
    """The sliders on guides of the frame, by link: their group and guide."""
    found = {}
    for dyad in linkage.dyads:
        for link, end in zip(dyad.links, (dyad.start, dyad.end), strict=True):
            if isinstance(end, Guide) and end.link == GROUND:
                found[link] = dyad, end
    return found


def course(linkage: Linkage, link: int, motion_at: MotionAt, turns: int = 1, top: int = 1) -> Stroke:
    """The way of a slider on the frame; its top is the end farther along the guide.

    Intake starts at the passage number `top` of the top.  Raises `NotToAndFro` for a slider that turns
    back more than twice in a turn of the driver.
    """
    dyad, guide = rails(linkage)[link]
    along = cmath.exp(1j * guide.angle)

    def rate(angle: Floats) -> Floats:
        return np.asarray(np.real(np.conj(along) * motion_at(angle).points[dyad.middle].v))

    reversals = opposing(1.0, rate).reversals
    if len(reversals) != 2:
        raise NotToAndFro(len(reversals))
    ends = motion_at(np.array(reversals)).points[dyad.middle].p
    high = int(np.argmax(np.real(np.conj(along) * ends)))
    first = float(np.mod(reversals[high] + BEFORE_A_TURN, FULL_TURN) - BEFORE_A_TURN)
    way = (reversals[1 - high] - reversals[high]) % FULL_TURN
    whole = turns * FULL_TURN
    phase = (-(first + FULL_TURN * (top - 1)) + BEFORE_A_TURN) % whole - BEFORE_A_TURN
    crank_pin = dyad.start if isinstance(dyad.start, str) else dyad.middle
    other = dyad.links[0] if dyad.links[1] == link else dyad.links[1]
    return Stroke(
        link=link,
        rod=other,
        pin=dyad.middle,
        crank_pin=crank_pin,
        top=complex(ends[high]),
        bottom=complex(ends[1 - high]),
        top_angle=0.0,
        bottom_angle=way,
        phase=phase,
    )


# --- what is loaded ---------------------------------------------------------------------------------


@dataclass(frozen=True)
class Piston(Stroke):
    """A piston and the gas on it; its cycle angle counts from its top at the start of intake.

    A positive pressure pushes it along `inward`, towards the crank.
    """

    bore: float
    indicator: Indicator

    @classmethod
    def on(cls, course: Stroke, bore: float, indicator: Indicator) -> Piston:
        """The piston that is the slider of a course."""
        return cls(**vars(course), bore=bore, indicator=indicator)

    @property
    def name(self) -> str:
        """The id of its gas force."""
        return ids.applied_force(self.link)

    @property
    def area(self) -> float:
        """A = π D²/4 (m²)."""
        return float(np.pi * self.bore**2 / 4)

    @property
    def law(self) -> TableLaw:
        """Pressure times area."""
        return TableLaw(self, self.indicator, self.area)


@dataclass(frozen=True)
class Applied:
    """A force that is neither weight nor inertia: its law times the unit vector `direction`, at `point`."""

    name: str
    link: int
    point: str
    direction: complex
    law: Law


@dataclass(frozen=True)
class Torque:
    """A torque on a link that is no inertia couple: its law (N·m), anticlockwise positive."""

    name: str
    link: int
    law: Law


def gas_forces(pistons: Iterable[Piston]) -> tuple[Applied, ...]:
    """The gas on each piston."""
    return tuple(Applied(one.name, one.link, one.pin, one.inward, one.law) for one in pistons)
