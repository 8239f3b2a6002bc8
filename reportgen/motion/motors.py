"""Choose the motors that are strong enough for a machine: by heating, at the start, at its greatest load."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from reportgen.base.records import Record
from reportgen.motion.drives import Motor
from reportgen.motion.steady_running import SteadyMotion


class DriveDemand(Record):
    """Requirements of a steady motion for its drive, at the crank (N·m).

    `mean` is the mean torque of the drive over the angle, `effective` its root mean square over time, `most` its
    greatest value; `resistance` is the greatest torque of the loads, against which the machine must start.
    """

    mean: float
    effective: float
    most: float
    resistance: float

    @classmethod
    def of(cls, steady: SteadyMotion, whole: float) -> DriveDemand:
        """Return the requirements of a steady motion over a cycle of `whole` (rad)."""
        run = steady.run
        square = np.diff(run.time) @ (run.drive[1:] ** 2 + run.drive[:-1] ** 2) / 2
        return cls(
            mean=steady.work / whole,
            effective=float(np.sqrt(square / steady.period)),
            most=float(np.abs(run.drive).max()),
            resistance=max(float((-run.torque).max()), 0.0),
        )


class MotorChecks(Record):
    """A motor with the checks that it passes, its torques reduced to the crank (N·m)."""

    motor: Motor
    rated: float
    start: float
    breakdown: float
    demand: DriveDemand

    @property
    def endures(self) -> bool:
        """True if it does not overheat: M_eff ≤ M_n."""
        return self.demand.effective <= self.rated

    @property
    def starts(self) -> bool:
        """True if it starts against the greatest resistance."""
        return self.start >= self.demand.resistance

    @property
    def holds(self) -> bool:
        """True if it is not overloaded at any moment: M_max ≤ M_k."""
        return self.demand.most <= self.breakdown

    @property
    def fits(self) -> bool:
        return self.endures and self.starts and self.holds


def judged(motors: Sequence[Motor], demand: DriveDemand, ratio: float) -> list[MotorChecks]:
    """Return the motors by rising power, behind a gear by which the crank turns `ratio` times as fast."""
    rising = sorted(motors, key=lambda motor: motor.power)
    return [
        MotorChecks(motor, motor.rated / ratio, motor.start / ratio, motor.breakdown / ratio, demand)
        for motor in rising
    ]
