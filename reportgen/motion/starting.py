"""Start of a machine from rest under a drive, and its run-down to rest under a brake."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from reportgen.base.arrays import Floats
from reportgen.base.records import Record
from reportgen.motion.drives import Drive
from reportgen.motion.energy_equation import PARTS, SAME_ANGLE, ReducedMachine
from reportgen.motion.steady_running import (
    MOST_CYCLES,
    MotionRun,
    NoMotionError,
    SteadyMotion,
    passage,
    run_in_time,
    stalled,
)
from reportgen.motion.time_integration import TimeStepper

NEAR_STEADY = 0.01
"""A start ends with the first cycle whose last speed differs from the steady one by less than this share."""
STALLS = "start-stalls"
NEAR_ENOUGH = np.radians(1.0)
"""Accuracy (rad) of the limits of the angles from which a machine starts."""
MOST_SWINGS = 50


class StartFromRest(Record):
    """A start from rest: its run, and the indices of the ends of its cycles among the samples.

    `turns_back` are the cycle angles (rad) at which loads stronger than the drive push the crank back.
    """

    run: MotionRun
    ends: tuple[int, ...]
    turns_back: tuple[float, ...] = ()

    @property
    def time(self) -> float:
        return float(self.run.time[-1])


def starting_ranges(body: ReducedMachine, drive: Drive) -> list[tuple[float, float]]:
    """Return the ranges of cycle angles (rad) from which a machine at rest starts and completes a cycle.

    The farther it starts before a place where the loads are too strong, the more energy it has when it reaches that
    place.
    """
    angle = np.linspace(0.0, body.whole, body.machine.turns * 2 * PARTS + 1)
    moves = body.reduced(angle)[2] + drive.torque(np.zeros_like(angle)) > 0
    edges = np.flatnonzero(np.diff(np.concatenate(([False], moves, [False])).astype(int)))
    ranges = []
    for first, last in zip(edges[::2], edges[1::2] - 1, strict=True):
        low, high = float(angle[first]), float(angle[last])
        if not _comes_through(body, drive, low):
            continue
        if not _comes_through(body, drive, high):
            inside, outside = low, high
            while outside - inside > NEAR_ENOUGH:
                middle = (inside + outside) / 2
                inside, outside = (middle, outside) if _comes_through(body, drive, middle) else (inside, middle)
            high = inside
        ranges.append((low, high))
    return ranges


def _comes_through(body: ReducedMachine, drive: Drive, angle: float) -> bool:
    """Return True if a machine that starts from rest at an angle (rad) completes a cycle."""
    if not _moves(body, drive, angle):
        return False
    try:
        _first_cycle(body, drive, body.parted(angle))
    except NoMotionError:
        return False
    return True


def start(
    body: ReducedMachine, drive: Drive, to: SteadyMotion, angle: float = 0.0, own: Sequence[float] = ()
) -> StartFromRest:
    """Run from rest at a cycle angle (rad) until the steady motion is practically reached.

    Raises `NoMotionError` if the machine does not start, or stalls.
    """
    edges = body.parted(angle, own)
    torque = float(body.reduced(edges[:1])[2][0] + drive.torque(np.zeros(1))[0])
    if torque <= 0:
        ranges = starting_ranges(body, drive)
        code = "does-not-start" if ranges else "starts-nowhere"
        raise NoMotionError(code, angle=angle, missing=-torque, ranges=ranges)
    run, turns_back = _first_cycle(body, drive, edges)
    wanted = float(to.run.speed[to.run.place(np.mod(angle, body.whole))])
    cycles, path = [run], body.along(edges)
    while abs(cycles[-1].speed[-1] - wanted) > NEAR_STEADY * wanted:
        if len(cycles) >= MOST_CYCLES:
            raise NoMotionError("starts-too-slowly", speed=float(cycles[-1].speed[-1]))
        run, arrives = passage(body, edges, drive, float(cycles[-1].speed[-1]), path)
        if not arrives:
            raise stalled(body, run, STALLS)
        cycles.append(run.shifted(len(cycles) * body.whole))
    ends = np.cumsum([len(cycle.angle) - 1 for cycle in cycles])
    return StartFromRest(cycles[0].joined(*cycles[1:]), tuple(map(int, ends)), turns_back)


def _first_cycle(body: ReducedMachine, drive: Drive, edges: Floats) -> tuple[MotionRun, tuple[float, ...]]:
    """Run from rest to the last of the edges (rad), swinging back where the loads push; also return the angles where it
    turns back.

    A crank that swings back less far than its last start gets less far at every further swing, since curves of speed
    over angle do not cross: it stalls.
    """
    turns_back: list[float] = []
    run, arrives = passage(body, edges, drive, 0.0)
    every, set_out = np.concatenate((edges[:-1] - body.whole, edges)), float(edges[0])
    while not arrives:
        at = float(run.angle[-1])
        torque = float(body.reduced(np.array([at]), -1)[2][0] + run.drive[-1])
        if not body.yields or torque >= 0 or len(turns_back) >= MOST_SWINGS:
            raise stalled(body, run, STALLS)
        behind = _swing(body, drive, at)
        if behind is None or behind.angle[-1] >= set_out or not _moves(body, drive, float(behind.angle[-1])):
            raise stalled(body, run, STALLS)
        turns_back.append(at)
        set_out = float(behind.angle[-1])
        forward, arrives = passage(body, np.append(set_out, every[every > set_out + SAME_ANGLE]), drive, 0.0)
        run = run.joined(behind, forward)
    return run, tuple(turns_back)


def _moves(body: ReducedMachine, drive: Drive, angle: float) -> bool:
    """Return True if the crank moves forward from rest at an angle (rad)."""
    return bool(body.reduced(np.array([angle]))[2][0] + drive.torque(np.zeros(1))[0] > 0)


def _swing(body: ReducedMachine, drive: Drive, at: float) -> MotionRun | None:
    """Return the backward run from rest at an angle (rad) to the next rest; None if that is a full cycle back."""
    stepper, speed, runs = TimeStepper(body, drive, sense=-1), 0.0, list[MotionRun]()
    end = at - body.whole
    corners = np.concatenate([body.corners + turn * body.whole for turn in (-1, 0)])
    for edge in [*corners[(corners > end) & (corners < at - SAME_ANGLE)][::-1], end]:
        run, rests = run_in_time(stepper, at, speed, float(edge))
        runs.append(run)
        if rests:
            return runs[0].joined(*runs[1:])
        at, speed = float(edge), float(run.speed[-1])
    return None


def stop(body: ReducedMachine, brake: Drive, speed: float, angle: float = 0.0, own: Sequence[float] = ()) -> MotionRun:
    """Return the run-down to rest from a speed (rad/s) at a cycle angle (rad), with the motor off and a brake on.

    Raises `NoMotionError` if the loads keep the machine moving.
    """
    edges = body.parted(angle, own)
    path = body.along(edges)
    first = speed**2 / 2 * float(path.at_edges[0][0])
    runs: list[MotionRun] = []
    for number in range(MOST_CYCLES):
        run, goes_on = passage(body, edges, brake, speed, path)
        runs.append(run.shifted(number * body.whole))
        if not goes_on:
            return runs[0].joined(*runs[1:])
        if run.energy[-1] >= first:
            break
        first, speed = float(run.energy[-1]), float(run.speed[-1])
    raise NoMotionError("does-not-stop")
