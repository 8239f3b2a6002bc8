"""The excess torque over a cycle, from harmonics and straight lines: where it changes its sign, and its integral."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from functools import cached_property
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from reportgen.base.arrays import Floats
from reportgen.base.records import Record

NOTHING = 1e-12
"""A torque below this share of the greatest is zero."""
SAMPLES = 240
"""Angles per period of the highest harmonic at which a change of sign is looked for."""
SAME_ANGLE = 1e-9
HALVINGS = 80
NEAR = 0.02
"""A torque that comes this near to zero, as a share of the greatest, may cross it twice between two samples."""

Nodes = Sequence[tuple[float, float]]


class Harmonic(NamedTuple):
    """A term a cos nφ + b sin nφ of a torque (N·m)."""

    order: float
    cos: float
    sin: float


class StraightPart(NamedTuple):
    """A straight part of a torque: its ends (rad), and the torque there (N·m)."""

    start: float
    stop: float
    first: float
    last: float


def lines_of(nodes: Nodes) -> list[StraightPart]:
    """Return the straight parts of a table of angles and torques; two rows at one angle are a jump."""
    return [StraightPart(x0, x1, y0, y1) for (x0, y0), (x1, y1) in pairwise(nodes) if x1 > x0]


def value_in(lines: Sequence[StraightPart], start: float, stop: float, at: float) -> float:
    """Return the torque at an angle of the part that contains start…stop."""
    middle = (start + stop) / 2
    line = next(line for line in lines if line.start <= middle <= line.stop)
    return line.first + (line.last - line.first) * (at - line.start) / (line.stop - line.start)


def added(tables: Sequence[tuple[float, Sequence[StraightPart]]], cycle: float) -> tuple[StraightPart, ...]:
    """Return the sum of tables with their factors, as straight parts over the cycle."""
    ends = sorted({0.0, cycle, *(end for _, lines in tables for line in lines for end in line[:2])})
    return tuple(
        StraightPart(
            x0, x1, *(sum(factor * value_in(lines, x0, x1, at) for factor, lines in tables) for at in (x0, x1))
        )
        for x0, x1 in pairwise(ends)
    )


class TurningDiagram(Record, dict=True):
    """Excess of the driving over the resisting torque (N·m) over a cycle (rad), whose mean is zero."""

    cycle: float
    harmonics: tuple[Harmonic, ...]
    lines: tuple[StraightPart, ...]

    def waves(self, angle: Floats | float) -> Floats:
        """Return the sum of the harmonics at angles [N] (rad)."""
        φ = np.asarray(angle, float)
        waves = np.zeros_like(φ)
        for n, a, b in self.harmonics:
            waves = waves + a * np.cos(n * φ) + b * np.sin(n * φ)
        return waves

    def on_line(self, line: StraightPart, angle: Floats | float) -> Floats:
        """Return the excess torque (N·m) at angles [N] (rad) of one straight part."""
        slope = (line.last - line.first) / (line.stop - line.start)
        return line.first + slope * (np.asarray(angle, float) - line.start) + self.waves(angle)

    def integral(self, angle: Floats | float) -> Floats:
        """Return the work (J) of the excess torque from the start of the cycle to angles [N] (rad)."""
        φ = np.asarray(angle, float)
        work = np.zeros_like(φ)
        for n, a, b in self.harmonics:
            work = work + a / n * np.sin(n * φ) + b / n * (1 - np.cos(n * φ))
        for line in self.lines:
            width = np.clip(φ, line.start, line.stop) - line.start
            slope = (line.last - line.first) / (line.stop - line.start)
            work = work + line.first * width + slope * width**2 / 2
        return work

    def samples_of(self, line: StraightPart) -> Floats:
        """Return angles [N] (rad) from end to end of a straight part, close enough to see each change of sign."""
        highest = max((one.order for one in self.harmonics), default=0.0)
        count = math.ceil((line.stop - line.start) * highest * SAMPLES / (2 * math.pi))
        return np.linspace(line.start, line.stop, max(count, 1) + 1)

    @cached_property
    def sampled(self) -> tuple[Floats, Floats]:
        """Angles [N] (rad) over the cycle and the excess torque there (N·m); a jump has two at one angle."""
        angles = [self.samples_of(line) for line in self.lines]
        values = [self.on_line(line, at) for line, at in zip(self.lines, angles, strict=True)]
        return np.concatenate(angles), np.concatenate(values)

    @cached_property
    def least(self) -> float:
        """The torque (N·m) below which it counts as zero."""
        return NOTHING * max(
            float(np.abs(self.sampled[1]).max()), *(abs(a) + abs(b) for _, a, b in self.harmonics or ((1, 0.0, 0.0),))
        )

    @cached_property
    def crossings(self) -> tuple[float, ...]:
        """Angles (rad) within the cycle, above 0, at which the excess torque changes its sign."""
        zeros: list[float] = []
        before, zero_since = 0.0, None
        for at, value in self._telling():
            if abs(value) <= self.least:
                zero_since = at if zero_since is None else zero_since
                continue
            if before * value < 0:
                zeros.append(at if zero_since is None else zero_since)
            before, zero_since = value, None
        # A torque that is zero up to the end of the cycle changes its sign where it became zero.
        first = next((value for _, value in self._telling() if abs(value) > self.least), 0.0)
        if zero_since is not None and before * first < 0:
            zeros.append(zero_since)
        return tuple(at for at in zeros if SAME_ANGLE < at < self.cycle - SAME_ANGLE)

    def _telling(self) -> Iterator[tuple[float, float]]:
        """Yield samples and, where two neighbours differ in sign, the zero between them."""
        for line in self.lines:
            angles = self.samples_of(line)
            values = self.on_line(line, angles)
            greatest = float(np.abs(values).max())
            for i, (at, value) in enumerate(zip(angles, values, strict=True)):
                if i and values[i - 1] * value < 0 and min(abs(value), abs(values[i - 1])) > self.least:
                    yield self._zero(line, float(angles[i - 1]), float(at)), 0.0
                elif 0 < i < len(angles) - 1 and abs(value) < NEAR * greatest:
                    yield from self._touched(line, angles[i - 1 : i + 2], values[i - 1 : i + 2])
                yield float(at), float(value)

    def _touched(self, line: StraightPart, at: Floats, values: Floats) -> Iterator[tuple[float, float]]:
        """Yield the far side of zero if the torque reaches it between three samples of one sign."""
        side = np.sign(values[1])
        if abs(values[1]) <= self.least or np.any(side * values <= 0) or abs(values[1]) > min(abs(values[::2])):
            return
        low, high = float(at[0]), float(at[2])
        for _ in range(HALVINGS):
            first, second = low + (high - low) / 3, high - (high - low) / 3
            if side * self.on_line(line, first) < side * self.on_line(line, second):
                high = second
            else:
                low = first
        extreme = (low + high) / 2
        beyond = float(self.on_line(line, extreme))
        if side * beyond < -self.least:
            yield self._zero(line, float(at[0]), extreme), 0.0
            yield extreme, beyond
            yield self._zero(line, extreme, float(at[2])), 0.0

    def _zero(self, line: StraightPart, low: float, high: float) -> float:
        """Return the angle of the zero between two angles with torques of opposite signs."""
        sign = math.copysign(1.0, float(self.on_line(line, low)))
        for _ in range(HALVINGS):
            middle = (low + high) / 2
            if sign * float(self.on_line(line, middle)) > 0:
                low = middle
            else:
                high = middle
        return (low + high) / 2

    @cached_property
    def points(self) -> tuple[float, ...]:
        """Angles (rad) that divide the cycle into areas: its start, and the changes of sign."""
        return (0.0, *self.crossings)
