"""A machine's start from rest under a drive, and its run-down to rest under a brake."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from reportgen.machine.drives import Backwards, Drive
from reportgen.machine.energy import PARTS, SAME_ANGLE, EnergyAlong, ReducedMachine, ReducedWay, TurnedBack, march
from reportgen.machine.running import (
    MOST_CYCLES,
    MotionRun,
    NoMotionError,
    SteadyMotion,
    run_along,
    stalled,
    to_the_stop,
)

Floats = NDArray[np.float64]
NEAR_STEADY = 0.01
"""A start is over at the end of the first cycle whose last speed is as near to the steady one."""
AT_REST = 2
"""Parts beside rest over which the way is reckoned by √φ."""
MOST_SWINGS = 50
SAME_SWING = 1e-6
"""A machine that comes to rest where it did before (rad) but for this stays there."""


@dataclass(frozen=True)
class StartFromRest:
    """A start from rest: its run, and the indices of the ends of its cycles among the samples.

    Where the loads are stronger than the drive and push the crank back, `turns_back` are the cycle angles (rad) there.
    """

    run: MotionRun
    ends: tuple[int, ...]
    turns_back: tuple[float, ...] = ()

    @property
    def time(self) -> float:
        return float(self.run.time[-1])


def starting_ranges(body: ReducedMachine, drive: Drive) -> list[tuple[float, float]]:
    """From which cycle angles to which (rad) a machine at rest begins to move forward."""
    angle = np.linspace(0.0, body.whole, body.machine.turns * 2 * PARTS + 1)
    moves = body.reduced(angle)[2] + drive.torque(np.zeros_like(angle)) > 0
    edges = np.flatnonzero(np.diff(np.concatenate(([False], moves, [False])).astype(int)))
    return [(float(angle[low]), float(angle[high - 1])) for low, high in zip(edges[::2], edges[1::2], strict=True)]


def start(
    body: ReducedMachine, drive: Drive, to: SteadyMotion, angle: float = 0.0, own: Sequence[float] = ()
) -> StartFromRest:
    """From rest at a cycle angle (rad) until the steady motion is as good as reached.

    Raises `NoMotionError` where the machine does not start, or stalls on the way.
    """
    edges = body.parted(angle, own)
    torque = float(body.reduced(edges[:1])[2][0] + drive.torque(np.zeros(1))[0])
    if torque <= 0:
        ranges = starting_ranges(body, drive)
        raise NoMotionError("does-not-start", angle=angle, missing=-torque, ranges=ranges)
    run, turns_back = _first_cycle(body, drive, edges)
    wanted = float(to.run.speed[to.run.place(np.mod(angle, body.whole))])
    cycles, path = [run], body.along(edges)
    while abs(cycles[-1].speed[-1] - wanted) > NEAR_STEADY * wanted:
        if len(cycles) >= MOST_CYCLES:
            raise NoMotionError("starts-too-slowly", speed=float(cycles[-1].speed[-1]))
        gone, energy, reached = march(body, edges, drive, float(cycles[-1].energy[-1]), known=path)
        if reached < gone.size:
            stalled(body, gone, drive, energy, reached)
        cycles.append(run_along(gone, drive, energy).shifted(len(cycles) * body.whole))
    ends = np.cumsum([len(cycle.angle) - 1 for cycle in cycles])
    return StartFromRest(run.joined(*cycles[1:]), tuple(map(int, ends)), turns_back)


def _first_cycle(body: ReducedMachine, drive: Drive, edges: Floats) -> tuple[MotionRun, tuple[float, ...]]:
    """From rest to the last of the edges (rad), swinging back where the loads push; and where it turns back."""
    turns_back: list[float] = []
    before: MotionRun | None = None
    while True:
        run, arrives = _from_rest(body, drive, edges)
        before = run if before is None else before.joined(run)
        if arrives:
            return before, tuple(turns_back)
        at = float(run.angle[-1])
        swing = abs(at - turns_back[-1]) if turns_back else np.inf
        missing = -float(run.torque[-1] + run.drive[-1])
        stalls = NoMotionError("stalls", angle=float(np.mod(at, body.whole)), missing=missing)
        if not body.yields or swing < SAME_SWING or len(turns_back) >= MOST_SWINGS:
            raise stalls
        turns_back.append(at)
        back = TurnedBack(body.machine, body.added, at)
        behind, turns_round = _from_rest(back, Backwards(drive), back.parted(0.0))
        if turns_round:
            raise stalls
        behind = behind.backwards(at)
        before = before.joined(behind)
        again = float(behind.angle[-1])
        every = np.concatenate((edges[:-1] - body.whole, edges))
        edges = np.append(again, every[every > again + SAME_ANGLE])


def _from_rest(body: ReducedMachine, drive: Drive, edges: Floats) -> tuple[MotionRun, bool]:
    """From rest at the first edge to the last one, or to where it comes to rest again; and whether it arrives."""
    path, energy, reached = march(body, edges[: AT_REST + 1], drive, 0.0, rest=True)
    if reached < path.size:
        least = float((path.torque + drive.torque(np.zeros_like(path.torque))).min())
        raise NoMotionError("stalls", angle=float(np.mod(edges[0], body.whole)), missing=-least)
    run = run_along(path, drive, energy)
    path, energy, reached = march(body, edges[AT_REST:], drive, float(energy.edges[-1]))
    rest, arrives = _through(body, path, drive, energy, reached)
    return (run if rest is None else run.joined(rest)), arrives


def _through(
    body: ReducedMachine, path: ReducedWay, drive: Drive, energy: EnergyAlong, reached: int
) -> tuple[MotionRun | None, bool]:
    """The run along a way, to its end or to the stop on it, and whether it comes to the end."""
    arrives = reached == path.size
    kept = reached if arrives else max(reached - 1, 0)
    first = EnergyAlong(energy.edges[: kept + 1], energy.inside[:kept])
    run = run_along(path.parts(0, kept), drive, first) if kept else None
    if arrives:
        return run, True
    last = to_the_stop(body, path, drive, energy, reached)
    return (last if run is None else run.joined(last)), False


def stop(body: ReducedMachine, brake: Drive, speed: float, angle: float = 0.0, own: Sequence[float] = ()) -> MotionRun:
    """The run-down from a speed (rad/s) at a cycle angle (rad), the motor off, under a brake, to rest.

    Raises `NoMotionError` where the loads keep the machine going.
    """
    edges = body.parted(angle, own)
    path = body.along(edges)
    first = speed**2 / 2 * float(path.at_edges[0][0])
    runs: list[MotionRun] = []
    for number in range(MOST_CYCLES):
        gone, energy, reached = march(body, edges, brake, first, known=path)
        through, goes_on = _through(body, gone, brake, energy, reached)
        assert through is not None, "a way has parts"
        runs.append(through.shifted(number * body.whole))
        if not goes_on:
            return runs[0].joined(*runs[1:])
        if energy.edges[-1] >= first:
            break
        first = float(energy.edges[-1])
    raise NoMotionError("does-not-stop")
