"""Starts, stops and steady motion that are over in a few degrees, against all links integrated in time."""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import pairwise

import numpy as np
import pytest
from test_running import EIGHTHS, OUTWARD, R3, SLIDER_CRANK, made_at_random, with_load
from time_integration import in_time, integrate

from reportgen.base.records import replace
from reportgen.machine import Inertia
from reportgen.machine.analysis import Machine, breaks
from reportgen.machine.load_laws import FULL_TURN, TableLaw, by_stroke
from reportgen.motion.drives import ConstantDrive, Drive, KlossDrive, LinearDrive, TableDrive
from reportgen.motion.energy_equation import ReducedMachine
from reportgen.motion.starting import start, stop
from reportgen.motion.steady_running import MotionRun, NoMotionError, levels, mean_torque, steady
from tests.lanes import matrix

STRONG = LinearDrive(1000.0, 40.0)


def light(moment: float) -> Machine:
    """The machine of the worked figures with another moment of inertia of its crank (kg·m²)."""
    inertias = (Inertia(1, "O", 0.0, moment), *SLIDER_CRANK.inertias[1:])
    return replace(R3, linkage=replace(SLIDER_CRANK, inertias=inertias))


def of(drive: Drive) -> Callable[[float], float]:
    return lambda speed: float(drive.torque(np.array([speed]))[0])


def prove_in_time(
    machine: Machine, added: float, drive: Drive, run: MotionRun, last: int, steps: int = 12, lasts: float = math.inf
) -> None:
    """φ and ω to 1e-8 at four times until sample number `last`, and so many seconds; no load jumps meanwhile."""
    until = min(float(run.time[last]), lasts)
    chosen = np.unique(np.searchsorted(run.time[: last + 1], np.linspace(0.0, until, 5)).clip(max=last))
    instants = [np.linspace(low, high, steps // 4 + 1)[:-1] for low, high in pairwise(run.time[chosen])]
    times = np.append(np.concatenate(instants), run.time[chosen[-1]])
    passed = in_time(machine, added, of(drive), float(run.angle[0]), float(run.speed[0]), times)[:: steps // 4]
    fastest = float(np.abs(run.speed[: last + 1]).max())
    way = float(np.ptp(run.angle[: chosen[-1] + 1]))
    for place, (angle, speed) in zip(chosen, passed, strict=True):
        assert run.angle[place] == pytest.approx(angle, abs=1e-8 * way)
        assert run.speed[place] == pytest.approx(speed, abs=1e-8 * fastest)


# --- starts -----------------------------------------------------------------------------------------------


def test_a_start_that_is_over_in_a_few_degrees() -> None:
    """A motor of 1000 N·m on 0.03 kg·m² has its speed after 3 ms."""
    body = ReducedMachine(light(0.005))
    run = start(body, STRONG, steady(body, STRONG, 27.0), 0.0, EIGHTHS).run
    prove_in_time(body.machine, 0.0, STRONG, run, run.place(math.radians(8.0)), 24)


@pytest.mark.parametrize("begin", matrix([0.0, 20.0], [20.0]))
def test_a_start_that_the_load_stops(begin: float) -> None:
    """80 N·m come no farther than where their work is used up, and swing back to less; from 20° that is within 4°."""
    drive = LinearDrive(80.0, 1.0)
    body = ReducedMachine(R3)
    wheeled = steady(ReducedMachine(R3, 5.0), drive, 27.0)
    with pytest.raises(NoMotionError) as told:
        start(body, drive, wheeled, math.radians(begin))
    assert told.value.code == "start-stalls"
    # In time from rest: between the instants about the stop the speed is all but linear.
    times = np.linspace(0.0, 0.4, 41)
    passed = in_time(R3, 0.0, of(drive), math.radians(begin), 0.0, times)
    before, after = next((a, b) for a, b in pairwise(passed) if b[1] <= 0)
    share = before[1] / (before[1] - after[1])
    (again,) = in_time(R3, 0.0, of(drive), *before, np.array([0.0, share * 0.01]))[1:]
    assert told.value.angle == pytest.approx(again[0], abs=1e-5)


def test_a_crank_that_comes_back_less_far_stalls() -> None:
    """It would take its whole life to swing to rest at 25.8°, where the load is as strong as the motor."""
    drive = LinearDrive(80.0, 1.0)
    body = ReducedMachine(R3)
    with pytest.raises(NoMotionError) as told:
        start(body, drive, steady(ReducedMachine(R3, 5.0), drive, 27.0))
    assert told.value.angle > math.radians(25.8)


# --- stops ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("brake", [300.0, 2e4, 1e6])
def test_a_brake_that_stops_within_degrees(brake: float) -> None:
    body = ReducedMachine(R3)
    speed = 29.8
    run = stop(body, ConstantDrive(-brake), speed)
    assert run.speed[-1] == 0
    prove_in_time(R3, 0.0, ConstantDrive(-brake), run, len(run.angle) - 1)


def test_the_strongest_brake() -> None:
    """In so short a way nothing changes: φ = ½Jω²/M, t = Jω/M."""
    run = stop(ReducedMachine(R3), ConstantDrive(-1e9), 29.8)
    assert run.angle[-1] == pytest.approx(0.8219 * 29.8**2 / 2e9, rel=1e-6)
    assert run.time[-1] == pytest.approx(0.8219 * 29.8 / 1e9, rel=1e-6)


# --- steady motion ------------------------------------------------------------------------------------------


@pytest.mark.parametrize("moment", matrix([0.1, 0.02, 0.005], [0.005]))
@pytest.mark.parametrize("breakdown", [200.0, 500.0])
def test_an_induction_motor_of_little_inertia(moment: float, breakdown: float) -> None:
    """It follows the load so closely that nothing of an earlier cycle is left; ω and t to 1e-8."""
    drive = KlossDrive(breakdown, 0.2, 33.0)
    machine = light(moment)
    stops = np.radians([10.0, 16.0, 22.0])
    run = steady(ReducedMachine(machine), drive, 27.0, stops).run
    places = [run.place(at) for at in stops]
    passed = integrate(machine, 0.0, of(drive), stops, float(run.speed[places[0]]), 6)
    for (time, speed), place in zip(passed, places, strict=True):
        assert run.speed[place] == pytest.approx(speed, rel=1e-8)
        assert run.time[place] - run.time[places[0]] == pytest.approx(time, abs=1e-8 * run.time[-1])


def test_a_motor_brakes_a_load_that_drives() -> None:
    """A load of 54 N·m in the mean drives an induction motor beyond its synchronous speed: there is steady motion."""
    law = TableLaw(OUTWARD, by_stroke((0.0, 1.0), (-1500.0, -1500.0), (200.0, 200.0)), turns=1)
    machine, drive = with_load(law), KlossDrive(150.0, 0.2, 25.0)
    motion = steady(ReducedMachine(machine), drive, 27.0)
    assert motion.mean > 25.0
    assert motion.work == pytest.approx(-340.0, rel=1e-9)
    # 54.11 N·m of 150: s/s_k = M_k/M − √((M_k/M)² − 1) by Kloss.
    share = 150.0 / (340 / FULL_TURN)
    slip = -0.2 * (share - math.sqrt(share**2 - 1))
    assert levels(drive, 340 / FULL_TURN, 27.0) == pytest.approx([25.0 * (1 - slip)])


def test_a_load_beyond_the_breakdown_torque_runs_away() -> None:
    law = TableLaw(OUTWARD, by_stroke((0.0, 1.0), (-1500.0, -1500.0), (200.0, 200.0)), turns=1)
    with pytest.raises(NoMotionError) as told:
        steady(ReducedMachine(with_load(law)), KlossDrive(50.0, 0.2, 25.0), 27.0)
    assert told.value.code == "runs-away"


def test_levels_lie_between_the_corners_of_a_characteristic() -> None:
    """A table that falls, rises and falls again balances 50 N·m at three speeds, and returns to two of them."""
    table = TableDrive((0.0, 10.0, 20.0, 30.0), (80.0, 40.0, 70.0, 10.0))
    assert levels(table, -50.0, 27.0) == pytest.approx([20 + 10 * 20 / 60, 7.5])
    assert levels(LinearDrive(0.0, 2.0), 50.0, 1.0) == pytest.approx([25.0])


# --- many machines ------------------------------------------------------------------------------------------


@pytest.mark.parametrize("seed", matrix(range(30), (0, 1)))
def test_starts_and_stops_of_machines_made_at_random(seed: int) -> None:
    """Machines of many sizes under motors and brakes of any strength, as far as the first jump of a load."""
    machine, added, _ = made_at_random(seed)
    rng = np.random.default_rng(seed)
    added *= 10 ** rng.uniform(-3.0, 0.0)
    body = ReducedMachine(machine, added)
    mean, _ = mean_torque(body, body.along(body.parted(0.0)))
    size = float(np.abs(body.reduced(np.linspace(0.0, FULL_TURN, 200))[2]).max())
    torque = (abs(mean) + size) * 10 ** rng.uniform(0.0, 2.0)
    drive: Drive = LinearDrive(torque, torque / 30.0)
    if seed % 2:
        drive = KlossDrive(2 * torque, 0.3, 30.0)
    motion = steady(body, drive, machine.speed)
    run = start(body, drive, motion).run
    jumps = np.append(breaks(machine), FULL_TURN)
    first_jump = min(float(jumps[jumps > 1e-6].min()), 0.2)
    settles = float(body.reduced(np.zeros(1))[0][0] / np.abs(drive.slope(np.linspace(0.0, 30.0, 60))).max())
    prove_in_time(machine, added, drive, run, run.place(first_jump), 24, 16 * settles)
    brake = ConstantDrive(-torque)
    stopped = stop(body, brake, float(motion.run.speed[0]))
    last = int(np.searchsorted(stopped.angle, min(first_jump, float(stopped.angle[-1])), side="right")) - 1
    prove_in_time(machine, added, brake, stopped, last)
