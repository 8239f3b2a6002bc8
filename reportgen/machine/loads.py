"""The forces and torques that load a machine, and the motion of the sliders whose travel they depend on."""

from __future__ import annotations

import cmath
from collections.abc import Callable, Iterable

import numpy as np

from reportgen.assignment.common import Positions
from reportgen.base.arrays import Complexes, Floats
from reportgen.base.records import Record, asdict
from reportgen.formula import ids
from reportgen.machine import GROUND, Dyad, Guide, Linkage
from reportgen.machine.force_analysis import Load
from reportgen.machine.gas_pressure import IndicatorTable
from reportgen.machine.kinematics import Motion, solve_motion
from reportgen.machine.load_laws import (
    BEFORE_A_TURN,
    FULL_TURN,
    GasLaw,
    Law,
    MotionAt,
    Stroke,
    opposing,
    reversal_count,
)
from reportgen.machine.motion_sense import greatest_speed, moving

# --- sliders of a linkage ---------------------------------------------------------------------------


def crank_motion(linkage: Linkage, positions: Positions, start: float, speed: float = 1.0) -> MotionAt:
    """Return the function that gives the motion of a linkage at cycle angles [N] (rad).

    The crank is at the angle `start` (rad) in position 1 and turns at `speed` (rad/s).
    """
    turn = positions.sign
    return lambda angle: solve_motion(linkage, start + turn * angle, turn * speed)


def rails(linkage: Linkage) -> dict[int, tuple[Dyad, Guide]]:
    """Return the sliders on guides of the frame, by link: their group and guide."""
    rails = {}
    for dyad in linkage.dyads:
        for link, end in zip(dyad.links, (dyad.start, dyad.end), strict=True):
            if isinstance(end, Guide) and end.link == GROUND:
                rails[link] = dyad, end
    return rails


def carriers(linkage: Linkage) -> dict[int, int]:
    """Return the links that slide along a guide, with the link that has the guide."""
    return {
        link: end.link
        for dyad in linkage.dyads
        for link, end in zip(dyad.links, (dyad.start, dyad.end), strict=True)
        if isinstance(end, Guide)
    }


def turning_points(linkage: Linkage, link: int, motion_at: MotionAt) -> tuple[float, ...]:
    """Return the cycle angles (rad) of one turn, rising, at which a slider on the frame turns back."""
    return opposing(1.0, _rate_along(linkage, link, motion_at)).reversals


def turning_count(linkage: Linkage, link: int, motion_at: MotionAt) -> int:
    """Return how often a slider on the frame turns back in a turn: the number of its `turning_points`, found sooner."""
    return reversal_count(_rate_along(linkage, link, motion_at))


def _rate_along(linkage: Linkage, link: int, motion_at: MotionAt) -> Callable[[Floats], Floats]:
    """Return the function that gives a slider's speed along its guide [N] at cycle angles [N] (rad)."""
    dyad, guide = rails(linkage)[link]
    along = cmath.exp(1j * guide.angle)

    def rate(angle: Floats) -> Floats:
        motion = motion_at(angle)
        return moving(np.real(np.conj(along) * motion.points[dyad.middle].v), greatest_speed(motion, "P"))

    return rate


def course(linkage: Linkage, link: int, motion_at: MotionAt, turns: int = 1, top: int = 1) -> Stroke:
    """Return the travel of a slider on the frame between its dead centres; its top is the end farther along the guide.

    Intake starts when the slider passes the top for the time number `top`.  Raises `ValueError` for a slider that does
    not move once to and fro in a turn of the driver; the checks of a file report such a slider earlier
    (`catalogue.assembly.to_and_fro`).
    """
    dyad, guide = rails(linkage)[link]
    along = cmath.exp(1j * guide.angle)
    reversals = turning_points(linkage, link, motion_at)
    if len(reversals) != 2:
        raise ValueError(f"slider {link} turns back {len(reversals)} times")
    ends = motion_at(np.array(reversals)).points[dyad.middle].p
    high = int(np.argmax(np.real(np.conj(along) * ends)))
    first = float(np.mod(reversals[high] + BEFORE_A_TURN, FULL_TURN) - BEFORE_A_TURN)
    inward_turn = (reversals[1 - high] - reversals[high]) % FULL_TURN
    whole = turns * FULL_TURN
    phase = (-(first + FULL_TURN * (top - 1)) + BEFORE_A_TURN) % whole - BEFORE_A_TURN
    crank_pin = dyad.start if isinstance(dyad.start, str) else dyad.middle
    rod = dyad.links[0] if dyad.links[1] == link else dyad.links[1]
    return Stroke(
        link=link,
        rod=rod,
        pin=dyad.middle,
        crank_pin=crank_pin,
        top=complex(ends[high]),
        bottom=complex(ends[1 - high]),
        top_angle=0.0,
        bottom_angle=inward_turn,
        phase=phase,
    )


# --- forces and torques -----------------------------------------------------------------------------


class Piston(Stroke):
    """A piston and the gas on it; its cycle angle counts from its top at the start of intake.

    A positive pressure pushes it along `inward`, towards the crank.
    """

    bore: float
    indicator: IndicatorTable

    @classmethod
    def on(cls, course: Stroke, bore: float, indicator: IndicatorTable) -> Piston:
        """Return the piston with a `bore` (m) whose travel is the `course`."""
        return cls(**asdict(course), bore=bore, indicator=indicator)

    @property
    def name(self) -> str:
        """The id of its gas force."""
        return ids.applied_force(self.link)

    @property
    def area(self) -> float:
        """A = π D²/4 (m²)."""
        return float(np.pi * self.bore**2 / 4)

    @property
    def law(self) -> GasLaw:
        """The law of the gas force: pressure times area."""
        return GasLaw(self, self.indicator, area=self.area)


Direction = Callable[[Motion], Complexes]
"""The unit vectors [N] of a force's positive sense with the motion at N positions."""


def fixed(direction: complex) -> Direction:
    """Return the function that gives the same `direction`, of length 1, at every position [N]."""
    return lambda motion: np.full(motion.driver.shape, direction, dtype=np.complex128)


class Applied(Record):
    """A force P e that is neither weight nor inertia: its law P times the unit vector e along it, at `point`."""

    name: str
    link: int
    point: str
    direction: Direction
    law: Law

    def load(self, angle: Floats, motion: Motion) -> Load:
        """Return the force [N] (N) at cycle angles [N] (rad) with the motion there."""
        force = self.law.value(angle, motion) * self.direction(motion)
        return Load(self.name, self.link, force, motion.points[self.point].p, np.zeros_like(angle))


class Torque(Record):
    """A torque on a link other than an inertia couple: its law (N·m), anticlockwise positive."""

    name: str
    link: int
    law: Law

    def load(self, angle: Floats, motion: Motion) -> Load:
        """Return the couple [N] (N·m) at cycle angles [N] (rad) with the motion there."""
        nothing = np.zeros(angle.shape, dtype=np.complex128)
        return Load(self.name, self.link, nothing, motion.origins[self.link].p, self.law.value(angle, motion))


def gas_forces(pistons: Iterable[Piston]) -> tuple[Applied, ...]:
    """Return the gas force on each piston, along `inward`."""
    return tuple(Applied(piston.name, piston.link, piston.pin, fixed(piston.inward), piston.law) for piston in pistons)


class LoadsByKind(Record):
    """The loads of a file: forces and torques that act, and the names of those that are zero throughout."""

    applied: tuple[Applied, ...]
    torques: tuple[Torque, ...]
    idle: tuple[str, ...]

    @classmethod
    def of(cls, loads: Iterable[Applied | Torque]) -> LoadsByKind:
        """Sort loads by kind, each kind in the given order."""
        loads = tuple(loads)
        acting = [load for load in loads if load.law.acts]
        return cls(
            applied=tuple(load for load in acting if isinstance(load, Applied)),
            torques=tuple(load for load in acting if isinstance(load, Torque)),
            idle=tuple(load.name for load in loads if not load.law.acts),
        )

    @property
    def act(self) -> bool:
        """True if some load acts."""
        return bool(self.applied or self.torques)
