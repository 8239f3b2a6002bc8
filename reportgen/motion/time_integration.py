"""The motion of a machine integrated in time: near rest, and wherever the speed changes within a degree.

With J reduced to the crank and M = M_r(φ) + M_d(ω) the torque on it,  dφ/dt = ω,  dω/dt = ε = (M − ½ω²J′)/J. In each
step ω is a polynomial of time that satisfies the equation at the Gauss–Legendre nodes (collocation), so a drive that
settles within microseconds needs no shorter steps than the speed itself. A step ends after its time, at an angle, or
where the crank comes to rest.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from reportgen.base.arrays import Floats
from reportgen.base.records import Record
from reportgen.motion.drives import Drive
from reportgen.motion.energy_equation import STAGES, A, B, C, ReducedMachine, tail

SETTLED = 1e-13
"""The iterations of a step end when ω changes by less than this share of its greatest value in the step."""
MOST_ROUNDS = 30
ACCURATE = 1e-9
"""Largest contribution of the highest polynomials in a step to ω, as a share of it; the end of the step is far better.
"""
LONGEST = 0.05
"""The travel of the first step (rad)."""
GROWS, SHRINKS = 4.0, 0.1
"""Largest and smallest length of a step, as multiples of the step before it."""
MOST_STEPS = 3000
CREEPS = 1e-9
"""A crank slower than this share of its greatest speed so far is at rest."""
SPACING = 4 * float(np.finfo(float).eps)


class UnsettledError(Exception):
    """The largest number of steps does not lead to an edge or to rest; they end at `angle` (rad)."""

    def __init__(self, angle: float) -> None:
        super().__init__(angle)
        self.angle = angle


class TimeStep(Record):
    """A step: its `duration` (s), φ (rad) and ω (rad/s) at its nodes [s] and at its end, and the `error` of ω there."""

    duration: float
    angle: Floats
    speed: Floats
    end_angle: float
    end_speed: float
    error: float


class Leg(Record):
    """The steps to the next edge, or to the place before it where the crank `rests`."""

    steps: tuple[TimeStep, ...]
    rests: bool


class TimeStepper(Record):
    """A machine under a drive; `sense` is +1 while the crank moves forward, −1 while it moves back."""

    body: ReducedMachine
    drive: Drive
    sense: int = 1

    def reduced(self, angle: Floats) -> tuple[Floats, Floats, Floats]:
        """Return J, J′ (kg·m²) and M_r (N·m) at angles (rad) [N], in the order in which the crank reaches them."""
        if self.sense > 0:
            return self.body.reduced(angle)
        inertia, slope, torque = (values[::-1] for values in self.body.reduced(angle[::-1], -1))
        return inertia, slope, torque

    def leg(self, angle: float, speed: float, edge: float) -> Leg:
        """Run from an angle (rad) and a speed (rad/s) until the crank is at an edge (rad), or at rest.

        Raises `UnsettledError`.
        """
        steps, most = list[TimeStep](), abs(speed)
        length = self._first(angle, speed)
        for _ in range(MOST_STEPS):
            step = self._towards(angle, speed, length, edge)
            if step is None or step.error > ACCURATE:
                length *= SHRINKS if step is None else max(SHRINKS, 0.9 * (ACCURATE / step.error) ** (1 / STAGES))
                continue
            steps.append(step)
            angle, speed = step.end_angle, step.end_speed
            most = max(most, abs(speed))
            if abs(speed) <= CREEPS * most:
                return Leg(tuple(steps), rests=True)
            if angle == edge:
                return Leg(tuple(steps), rests=False)
            factor = 0.9 * (ACCURATE / max(step.error, 1e-300)) ** (1 / STAGES)
            length = step.duration * min(max(factor, SHRINKS), GROWS)
        raise UnsettledError(angle)

    def _first(self, angle: float, speed: float) -> float:
        """Return a length (s) for the first step: its travel is short, and the drive hardly changes."""
        (J,), (slope,), (torque,) = self.reduced(np.array([angle]))
        ω = np.array([speed])
        ε = abs(float(torque + self.drive.torque(ω)[0] - speed**2 * slope / 2) / J)
        fall = abs(float(self.drive.slope(ω)[0]) / J)
        lengths = [LONGEST / abs(speed) if speed else np.inf, 1 / fall if fall else np.inf]
        lengths += [np.sqrt(2 * LONGEST / ε)] if ε else []
        return float(min(lengths))

    def _towards(self, angle: float, speed: float, length: float, edge: float) -> TimeStep | None:
        """Return a step of this length (s), or a shorter one to the edge or to rest, whichever comes first."""
        step = self._step(angle, speed, length)
        if step is None:
            return None
        if self.sense * step.end_speed <= 0:
            step = self._step(angle, speed, length / 2, to_rest=True)
            if step is None:
                return None
        if self.sense * (step.end_angle - edge) > 0:
            share = (edge - angle) / (step.end_angle - angle)
            step = self._step(angle, speed, step.duration * share, edge=edge)
        return step

    def _step(
        self, angle: float, speed: float, length: float, edge: float | None = None, *, to_rest: bool = False
    ) -> TimeStep | None:
        """Return a step by Newton's method for ω, from which the angles follow; None if it does not converge."""
        ω, h = np.full(STAGES, speed), length
        path = h * speed * C
        before = np.inf
        for _ in range(MOST_ROUNDS):
            J, slope, torque = self.reduced(angle + path) if path[0] or path[-1] else self._beside(angle)
            ε = (torque + self.drive.torque(ω) - ω**2 * slope / 2) / J
            gain = (self.drive.slope(ω) - ω * slope) / J
            moved = np.linalg.solve(np.eye(STAGES) - h * A * gain, speed + h * A @ ε - ω)
            ω, ε = ω + moved, ε + gain * moved
            end, size = speed + h * float(B @ ε), max(float(np.abs(ω).max()), abs(speed))
            further = h * A @ ω
            gone = h * float(B @ ω)
            if not np.isfinite(size) or size == 0:
                return None
            off = max(float(np.abs(moved).max()) / size, float(np.abs(further - path).max()) / (h * size))
            path = further
            rounding = SPACING * max(abs(angle), abs(gone)) / (h * size)
            change = 0.0
            if to_rest:
                change = -end / float(ε[-1]) if ε[-1] else np.nan
            elif edge is not None:
                change = (edge - angle - gone) / end if end else np.nan
            off = max(off, abs(change) / h)
            settled = off <= max(SETTLED, rounding) or (off <= 1e3 * max(SETTLED, rounding) and off >= before)
            if settled:
                error = h * tail(ε) / size
                at_end = edge if edge is not None else angle + gone
                return TimeStep(h, angle + path, ω, at_end, 0.0 if to_rest else end, error)
            before = off
            if not 0 < h + change < 4 * length:
                return None
            path, h = path * (1 + change / h), h + change
        return None

    def _beside(self, angle: float) -> tuple[Floats, Floats, Floats]:
        """Return J, J′ and M_r just after an angle, for all nodes of a step that starts from rest."""
        J, slope, torque = self.reduced(np.full(STAGES, angle + self.sense * SPACING * max(abs(angle), 1.0)))
        return J, slope, torque


def times(steps: Sequence[TimeStep]) -> Floats:
    """Return the times (s) at the start of the first step and at the nodes and the end of each step [(s + 1) n + 1]."""
    ends = np.cumsum([step.duration for step in steps])
    within = [np.append(end - step.duration * (1 - C), end) for step, end in zip(steps, ends, strict=True)]
    return np.concatenate(([0.0], *within))
