"""How a force of the cycle varies: by a table over the stroke or the crank angle of a slider.

A table of one turn is laid out twice, as a cycle of two: so gas in four strokes and a working force of
two share one reader (`cycle.indicator`), whose values are then newtons instead of pascals.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from reportgen.catalogue.course import FULL_TURN, Course, Floats
from reportgen.cycle.applied import AngleIndicator, Indicator, StrokeIndicator
from reportgen.mechanism.motion import Motion

ROUND = 1e-9
"""A cycle angle this near below the end of the cycle (rad) is its beginning."""

MotionAt = Callable[[Floats], Motion]
"""The machine's motion at cycle angles [N] that grow from one to the next."""


class Law(Protocol):
    """The size of a force over the machine's cycle angles (0 at position 1)."""

    def value(self, angle: Floats, motion: Motion) -> Floats:
        """The force (N) [N] at cycle angles [N] with the motion there."""

    def breaks(self, motion_at: MotionAt) -> Iterable[float]:
        """Cycle angles where the force bends or jumps, in any order and any turn."""


@dataclass(frozen=True)
class TableLaw:
    """A table read by a slider's own cycle angle and s/H, times `factor` (the area, for a pressure).

    `turns` is how many turns of it were given: a table of one turn stands twice in `table`.
    """

    course: Course
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

        def share(angle: Floats) -> Floats:
            order = np.argsort(angle)
            result = np.empty_like(angle)
            result[order] = course.fraction(motion_at(angle[order] - course.phase))
            return result

        corners = (*self.table.breaks(share, course.dead_centres), *course.dead_centres)
        return (corner - course.phase for corner in corners)


@dataclass(frozen=True)
class AngleLaw:
    """Values at cycle angles from 0 to the end of the cycle, linear between.

    The last value closes the cycle, or jumps to the first.
    """

    angles: tuple[float, ...]
    values: tuple[float, ...]

    def value(self, angle: Floats, motion: Motion) -> Floats:
        within = np.maximum(np.mod(angle + ROUND, self.angles[-1]) - ROUND, 0.0)
        return np.asarray(np.interp(within, self.angles, self.values))

    def breaks(self, motion_at: MotionAt) -> Iterable[float]:
        return self.angles


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


def by_stroke(
    fractions: tuple[float, ...], inward: tuple[float, ...], outward: tuple[float, ...]
) -> Indicator:
    """Forces over s/H from the top: a row for the way in, towards the crank, and one for the way out."""
    return StrokeIndicator(fractions, inward, outward, inward, outward)


def by_angle(angles: tuple[float, ...], values: tuple[float, ...]) -> Indicator:
    """Forces over one turn from the top, 0…2π; the table's last value closes the turn or jumps to the first."""
    second = tuple(angle + FULL_TURN for angle in angles)
    if values[0] == values[-1]:
        return AngleIndicator((*angles, *second[1:]), (*values, *values[1:]))
    just_after = np.nextafter(second[0], np.inf)
    return AngleIndicator((*angles, float(just_after), *second[1:]), (*values, *values))
