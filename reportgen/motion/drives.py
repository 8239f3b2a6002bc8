"""Drives of a machine, or machines driven by it: the torque of the shaft at any speed, from a characteristic.

Torques are in N·m, speeds in rad/s, both positive in the sense of the crank's rotation.
"""

from __future__ import annotations

from abc import abstractmethod

import numpy as np
from numpy.typing import NDArray

from reportgen.base.arrays import Floats
from reportgen.base.records import AbstractRecord, Record


class Motor(Record):
    """A motor of a list: rated `power` (W) at the rated `speed` (rad/s), starting and breakdown torque (N·m)."""

    name: str
    power: float
    speed: float
    start: float
    breakdown: float

    @property
    def rated(self) -> float:
        """M_n = P/ω (N·m)."""
        return self.power / self.speed


class Drive(AbstractRecord):
    """A characteristic: the torque M(ω) (N·m) [N] on the shaft at speeds ω (rad/s) [N], and its slope dM/dω (N·m·s)
    [N].
    """

    @abstractmethod
    def torque(self, speed: Floats) -> Floats:
        """Return M [N] (N·m) at ω [N] (rad/s)."""

    @abstractmethod
    def slope(self, speed: Floats) -> Floats:
        """Return dM/dω [N] (N·m·s) at ω [N] (rad/s)."""

    @property
    def governs(self) -> bool:
        """True if its torque depends on the speed, so that the speed converges without being prescribed."""
        return True

    @property
    def corners(self) -> tuple[float, ...]:
        """Speeds (rad/s) at which the characteristic bends, crosses zero, or has an extreme."""
        return ()


class ConstantDrive(Drive):
    """The same torque M = `size` (N·m) at every speed [N]; a brake if it is negative."""

    size: float

    def torque(self, speed: Floats) -> Floats:
        return np.full(np.shape(speed), self.size)

    def slope(self, speed: Floats) -> Floats:
        return np.zeros(np.shape(speed))

    @property
    def governs(self) -> bool:
        return False


class LinearDrive(Drive):
    """M = M₀ − k ω (N·m) [N] with M₀ = `start` (N·m) and k = `fall` (N·m·s); with M₀ = 0 a load that grows with the
    speed.
    """

    start: float
    fall: float

    def torque(self, speed: Floats) -> Floats:
        return self.start - self.fall * np.asarray(speed)

    def slope(self, speed: Floats) -> Floats:
        return np.full(np.shape(speed), -self.fall)

    @property
    def governs(self) -> bool:
        return self.fall != 0

    @property
    def corners(self) -> tuple[float, ...]:
        return (self.start / self.fall,) if self.fall else ()


class KlossDrive(Drive):
    """An induction motor by Kloss: M = 2 M_k/(s/s_k + s_k/s) (N·m) [N] with the slip s = 1 − ω/ω₀.

    `breakdown` is the torque M_k (N·m) at the slip `slip` s_k, `synchronous` the synchronous speed ω₀ (rad/s).
    """

    breakdown: float
    slip: float
    synchronous: float

    def torque(self, speed: Floats) -> Floats:
        s = 1 - np.asarray(speed) / self.synchronous
        return np.asarray(2 * self.breakdown * s * self.slip / (s**2 + self.slip**2))

    def slope(self, speed: Floats) -> Floats:
        s = 1 - np.asarray(speed) / self.synchronous
        by_slip = 2 * self.breakdown * self.slip * (self.slip**2 - s**2) / (s**2 + self.slip**2) ** 2
        return np.asarray(-by_slip / self.synchronous)

    @property
    def corners(self) -> tuple[float, ...]:
        return tuple(self.synchronous * (1 + sense * self.slip) for sense in (-1, 0, 1))


class TableDrive(Drive):
    """Torques (N·m) [N] at speeds (rad/s) that rise from 0, linear between them; extrapolated beyond the last one."""

    speeds: tuple[float, ...]
    torques: tuple[float, ...]

    def _slopes(self) -> Floats:
        return np.diff(self.torques) / np.diff(self.speeds)

    def _part(self, speed: Floats) -> NDArray[np.int64]:
        return np.clip(np.searchsorted(self.speeds, speed, side="right") - 1, 0, len(self.speeds) - 2)

    def torque(self, speed: Floats) -> Floats:
        part = self._part(speed)
        return np.asarray(np.asarray(self.torques)[part] + self.slope(speed) * (speed - np.asarray(self.speeds)[part]))

    def slope(self, speed: Floats) -> Floats:
        return np.asarray(self._slopes()[self._part(speed)])

    @property
    def governs(self) -> bool:
        return bool(np.any(self._slopes()))

    @property
    def corners(self) -> tuple[float, ...]:
        return self.speeds


class Geared(Drive):
    """A drive behind a gear: the crank turns `ratio` times as fast, M = M_motor/i (N·m) [N] at ω_motor = ω/i."""

    motor: Drive
    ratio: float

    def torque(self, speed: Floats) -> Floats:
        return self.motor.torque(np.asarray(speed) / self.ratio) / self.ratio

    def slope(self, speed: Floats) -> Floats:
        return self.motor.slope(np.asarray(speed) / self.ratio) / self.ratio**2

    @property
    def governs(self) -> bool:
        return self.motor.governs

    @property
    def corners(self) -> tuple[float, ...]:
        return tuple(corner * self.ratio for corner in self.motor.corners)


class MotionAsked(Record):
    """Request for the true motion of a machine.

    `drive` is the drive reduced to the crank, None for the constant torque that balances the mean of the loads;
    `inertia` (kg·m²) is that of motor and gear, reduced to the crank. `start_from` and `stop_from` are the cycle angles
    (rad) where the machine starts from rest and where the motor is switched off and the `brake` (N·m) acts; None if not
    requested. Start and stop include the flywheel if `wheeled`. `forces` requests the forces at the true speeds and
    accelerations. One of the `motors` is chosen, behind a gear by which the crank turns `ratio` times as fast.
    """

    drive: Drive | None
    inertia: float = 0.0
    start_from: float | None = None
    stop_from: float | None = None
    brake: float = 0.0
    wheeled: bool = False
    forces: bool = False
    motors: tuple[Motor, ...] = ()
    ratio: float = 1.0
