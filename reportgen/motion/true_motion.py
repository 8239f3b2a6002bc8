"""The requested true motion of a machine: steady with and without its flywheel, start and stop.

`motion_in(analysis)` returns it, computed once.
"""

from __future__ import annotations

from typing import Literal

import numpy as np

from reportgen.base.records import Record, replace
from reportgen.machine.analysis import Analysis, Machine
from reportgen.machine.force_analysis import inertia_loads, solve_forces, virtual_work_torque, weights
from reportgen.machine.kinematics import solve_motion
from reportgen.machine.load_laws import FULL_TURN
from reportgen.machine.regulated_cycle import RegulatedCycle
from reportgen.machine.shared_results import LOST_TORQUE, REGULATED_CYCLE
from reportgen.motion.drives import ConstantDrive, Drive, MotionAsked
from reportgen.motion.energy_equation import ReducedMachine, ReducedTravel
from reportgen.motion.motors import DriveDemand, MotorChecks, judged
from reportgen.motion.starting import StartFromRest, start, stop
from reportgen.motion.steady_running import MotionRun, NoMotionError, SteadyMotion, mean_torque, steady

NO_INERTIA = 1e-12
"""A reduced moment of inertia below this share of its greatest is zero."""
LOW, FINER, CLOSER = 1e-2, 16, 7
"""Minima below this share of the greatest are refined: `FINER` angles on either side, `CLOSER` times."""
OFF_SPEED = 0.1
"""The user is warned if a machine runs faster or slower than planned by more than this share."""
WheelState = Literal["", "wheel"]
"""Without the flywheel, and with it."""


class TrueMotion(Record):
    """The true motion of a machine: its steady motion `alone`, and `wheeled` with the flywheel if it has one.

    `drive` is reduced to the crank, `mean` is the mean of the reduced torque (N·m), `wheel` J_d (kg·m²); `started` and
    `stopped` are None unless requested.
    """

    asked: MotionAsked
    drive: Drive
    mean: float
    alone: SteadyMotion
    wheel: float = 0.0
    wheeled: SteadyMotion | None = None
    started: StartFromRest | None = None
    stopped: MotionRun | None = None

    @property
    def states(self) -> dict[WheelState, SteadyMotion]:
        """The steady motions, the one without the flywheel first."""
        return {"": self.alone} if self.wheeled is None else {"": self.alone, "wheel": self.wheeled}

    def off_speed(self, machine: Machine) -> float:
        """Return the difference of the mean speed from the planned one, as a share of it, for the motion that starts
        and stops.
        """
        return abs(self.states[self.main_state].mean / machine.speed - 1)

    def added(self, state: WheelState) -> float:
        """Return the inertia that turns with the crank in addition to the links (kg·m²): motor and gear, the
        flywheel.
        """
        return self.asked.inertia + (self.wheel if state else 0.0)

    def demand(self, machine: Machine) -> DriveDemand:
        """Return the requirements for the drive in the steady motion, with the flywheel if start and stop
        include it.
        """
        return DriveDemand.of(self.states[self.main_state], machine.turns * FULL_TURN)

    def motors(self, machine: Machine) -> list[MotorChecks]:
        """Return the motors to choose from by rising power, with their checks."""
        return judged(self.asked.motors, self.demand(machine), self.asked.ratio) if self.asked.motors else []

    @property
    def main_state(self) -> WheelState:
        """The state that starts and stops: "wheel" with the flywheel, else ""."""
        return "wheel" if self.asked.wheeled and self.wheeled is not None else ""


def true_motion(machine: Machine, asked: MotionAsked, regulated: RegulatedCycle | None) -> TrueMotion:
    """Return the requested true motion of a machine, with the flywheel that regulates it.

    Raises `NoMotionError`.
    """
    own = [float(angle) for angle in machine.cycle_angles]
    own += [angle for angle in (asked.start_from, asked.stop_from) if angle is not None]
    alone = ReducedMachine(machine, asked.inertia, LOST_TORQUE.of(machine))
    path = alone.along(alone.parted(0.0, own))
    empty, least = least_inertia(alone, path)
    if least <= NO_INERTIA * float(path.inertia.max()):
        raise NoMotionError("no-inertia", angle=empty)
    mean, _ = mean_torque(alone, path)
    drive = ConstantDrive(-mean) if asked.drive is None else asked.drive
    motion = TrueMotion(asked, drive, mean, steady(alone, drive, machine.speed, own))
    if regulated is not None and regulated.moment > 0:
        wheeled = replace(alone, added=asked.inertia + regulated.moment)
        with_wheel = steady(wheeled, drive, machine.speed, own)
        motion = replace(motion, wheel=regulated.moment, wheeled=with_wheel)
    body = replace(alone, added=motion.added(motion.main_state))
    to = motion.states[motion.main_state]
    if asked.start_from is not None:
        motion = replace(motion, started=start(body, drive, to, asked.start_from, own))
    if asked.stop_from is not None:
        speed = float(to.run.speed[to.run.place(asked.stop_from)])
        motion = replace(motion, stopped=stop(body, ConstantDrive(-asked.brake), speed, asked.stop_from, own))
    return motion


def true_motion_of(machine: Machine) -> TrueMotion | None:
    """Return the true motion of a machine with its flywheel, None if the file does not request it.

    Raises `NoMotionError`.
    """
    asked = machine.topic("motion", MotionAsked)
    return None if asked is None else true_motion(machine, asked, REGULATED_CYCLE.of(machine))


def motion_in(analysis: Analysis) -> TrueMotion:
    """Return the true motion of a machine whose file requests it; it is computed once."""
    return analysis.derived(_motion)


def _motion(analysis: Analysis) -> TrueMotion:
    motion = true_motion_of(analysis.machine)
    assert motion is not None, "the file asks for the true motion"
    return motion


def least_inertia(body: ReducedMachine, path: ReducedTravel) -> tuple[float, float]:
    """Return the cycle angle (rad) of the least reduced moment of inertia, and that value (kg·m²).

    The search also covers angles between the samples of the path: if all masses are at rest at once, it touches 0 at a
    single angle.
    """
    angles = np.concatenate((path.angle.ravel(), path.edges[:-1]))
    order = np.argsort(angles)
    angles, inertia = angles[order], np.concatenate((path.inertia.ravel(), path.at_edges[0][:-1]))[order]
    neighbours = np.minimum(np.roll(inertia, 1), np.roll(inertia, -1))
    lowest = np.flatnonzero(inertia <= np.minimum(neighbours, LOW * inertia.max()))
    minima = [(float(angles[inertia.argmin()]), float(inertia.min()))]
    for at in lowest:
        middle, reach = float(angles[at]), 2 * body.whole / path.size
        for _ in range(CLOSER):
            near = middle + np.linspace(-reach, reach, 2 * FINER + 1) + body.whole
            around = body.reduced(near)[0]
            middle, reach = float(near[around.argmin()]) - body.whole, reach / FINER
        minima.append((middle % body.whole, float(around.min())))
    return min(minima, key=lambda one: one[1])


def at_positions(machine: Machine, motion: SteadyMotion) -> np.ndarray:
    """Return the indices among the samples [N] of a steady motion at which the machine is at its positions."""
    return np.array([motion.run.place(float(angle)) for angle in machine.cycle_angles])


def at_true_speeds(analysis: Analysis, steady: SteadyMotion) -> Analysis:
    """Return the analysis of the same positions with the crank's angular velocity and acceleration in steady motion."""
    machine, at = analysis.machine, at_positions(analysis.machine, steady)
    rate, acceleration = machine.turn * steady.run.speed[at], machine.turn * steady.run.acceleration[at]
    motion = solve_motion(machine.linkage, machine.angles(analysis.cycle_angle), rate, acceleration)
    applied = tuple(load.load(analysis.cycle_angle, motion) for load in machine.loads)
    heavy, inert = weights(machine.linkage, motion), inertia_loads(machine.linkage, motion)
    loads = (*heavy, *inert, *applied)
    forces = solve_forces(machine.linkage, motion, loads)
    return replace(
        analysis,
        motion=motion,
        weights=heavy,
        inertia=inert,
        applied=applied,
        forces=forces,
        torque=forces.torque,
        torque_by_work=virtual_work_torque(machine.linkage, motion, loads),
    )
