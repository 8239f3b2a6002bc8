"""The steady motion of a machine under a drive, and a run of it over any way: ω(φ), ε(φ), t(φ).

With J reduced to the crank and M = M_r(φ) + M_d(ω) the torque on it, T = ½Jω² grows by dT/dφ = M (`machine.energy`);
then ω = √(2T/J),  ε = (M − ½ω²J′)/J,  dt = dφ/ω.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from reportgen.machine.drives import ConstantDrive, Drive
from reportgen.machine.energy import (
    LEAST_ENERGY,
    LEFT,
    MOST_STEPS,
    SAME_ANGLE,
    SETTLED,
    STAGES,
    A,
    B,
    EnergyAlong,
    ReducedMachine,
    ReducedWay,
    closed,
    energy_at_edges,
    follow,
    linear,
)

Floats = NDArray[np.float64]
BALANCED = 1e-9
"""A mean torque below this share of the mean of its size is none."""
MOST_CYCLES = 400
"""A start that takes more cycles than this is told of instead."""
LOOKED_AT = 400
"""Speeds at which a drive is compared with the mean of the loads."""


class NoMotionError(Exception):
    """A motion that is asked for does not come about.

    `code` is "stalls", "does-not-start", "runs-away", "runs-down", "no-steady-motion" or "starts-too-slowly"; `angle`
    (rad) the cycle angle there, `missing` the torque (N·m) that is missing, `ranges` the angles (rad) from which the
    machine would start, `speed` (rad/s) that meant.
    """

    def __init__(
        self,
        code: str,
        angle: float = 0.0,
        missing: float = 0.0,
        ranges: Sequence[tuple[float, float]] = (),
        speed: float = 0.0,
    ) -> None:
        super().__init__(code)
        self.code, self.angle, self.missing, self.ranges, self.speed = code, angle, missing, tuple(ranges), speed


# --- a run -------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class MotionRun:
    """A run of a machine over samples [K]: the edges of its way and the places between.

    `angle` φ (rad), J and J′ (kg·m²), M_r and M_d (N·m), T (J), ω (rad/s), ε (rad/s²) and the time t (s) from its
    beginning.  `at` are the indices of the edges among the samples [n + 1].
    """

    angle: Floats
    inertia: Floats
    slope: Floats
    torque: Floats
    drive: Floats
    energy: Floats
    speed: Floats
    acceleration: Floats
    time: Floats
    at: NDArray[np.int64]

    def place(self, angle: float) -> int:
        """The index of the edge at an angle (rad)."""
        edges = self.angle[self.at]
        return int(self.at[int(np.abs(edges - angle).argmin())])

    def joined(self, *after: MotionRun) -> MotionRun:
        """This run and those that go on where it ends, one after the other."""
        runs = (self, *after)
        names = ("angle", "inertia", "slope", "torque", "drive", "energy", "speed", "acceleration")
        both = {
            name: np.concatenate([*(getattr(run, name)[:-1] for run in runs[:-1]), getattr(runs[-1], name)])
            for name in names
        }
        begins = np.cumsum([0.0, *(run.time[-1] for run in runs[:-1])])
        time = [run.time + begin for run, begin in zip(runs, begins, strict=True)]
        first = np.cumsum([0, *(len(run.angle) - 1 for run in runs[:-1])])
        at = [run.at + begin for run, begin in zip(runs, first, strict=True)]
        return MotionRun(
            **both,
            time=np.concatenate([*(one[:-1] for one in time[:-1]), time[-1]]),
            at=np.concatenate([*(one[:-1] for one in at[:-1]), at[-1]]),
        )

    def shifted(self, angle: float) -> MotionRun:
        """The same further on by an angle (rad)."""
        return replace(self, angle=self.angle + angle)

    def backwards(self, about: float) -> MotionRun:
        """The run of a machine that goes back over the way x = φ_s − φ from φ_s = `about` (rad)."""
        turned = {name: -getattr(self, name) for name in ("slope", "torque", "drive", "speed", "acceleration")}
        return replace(self, angle=about - self.angle, **turned)


def run_along(path: ReducedWay, drive: Drive, energy: EnergyAlong, backwards: bool = False) -> MotionRun:
    """The run along a way with the energy found; one that was followed `backwards` is turned round."""
    n = path.size

    def woven(edges: Floats, inside: Floats) -> Floats:
        return np.append(np.column_stack((edges[:-1], inside)).ravel(), edges[-1])

    inertia, slope, torque = (
        woven(at, inside) for at, inside in zip(path.at_edges, (path.inertia, path.slope, path.torque), strict=True)
    )
    T = np.maximum(woven(energy.edges, energy.inside), 0.0)
    speed = np.sqrt(2 * T / inertia)
    driven = drive.torque(speed)
    inside = speed[:-1].reshape(n, STAGES + 1)[:, 1:]
    step = path.measure / inside
    time = np.concatenate(([0.0], np.cumsum(step @ B)))
    every = MotionRun(
        angle=woven(path.edges, path.angle),
        inertia=inertia,
        slope=slope,
        torque=torque,
        drive=driven,
        energy=T,
        speed=speed,
        acceleration=(torque + driven - speed**2 * slope / 2) / inertia,
        time=woven(time, time[:-1, None] + step @ A.T),
        at=np.arange(n + 1) * (STAGES + 1),
    )
    if not backwards:
        return every
    turned = {name: values[::-1] for name, values in vars(every).items() if name not in ("at", "time")}
    return MotionRun(**turned, time=(every.time - every.time[-1])[::-1], at=every.at)


# --- steady motion -----------------------------------------------------------------------------------


@dataclass(frozen=True)
class ExtremeSpeed:
    """The greatest or the least speed (rad/s) and the cycle angle (rad) where it is."""

    speed: float
    angle: float


@dataclass(frozen=True)
class SteadyMotion:
    """The steady motion over one cycle.

    `fastest` and `slowest` by the polynomials of the parts, `mean` = (ω_max + ω_min)/2, `unevenness` δ =
    (ω_max − ω_min)/mean, `period` (s), `work` of the drive in a cycle (J) and its mean `power` (W); `settles` is the
    factor by which a deviation of T grows in a cycle, 1 where no torque depends on the speed.
    """

    run: MotionRun
    fastest: ExtremeSpeed
    slowest: ExtremeSpeed
    work: float
    settles: float

    @property
    def mean(self) -> float:
        return (self.fastest.speed + self.slowest.speed) / 2

    @property
    def unevenness(self) -> float:
        return (self.fastest.speed - self.slowest.speed) / self.mean

    @property
    def period(self) -> float:
        return float(self.run.time[-1])

    @property
    def power(self) -> float:
        return self.work / self.period


SHARES = np.linspace(0.0, 1.0, 201)


def _extreme(run: MotionRun, sense: int) -> ExtremeSpeed:
    """The greatest (+1) or least (−1) speed: of the samples, and of the polynomials of the parts beside the best."""
    best = int((sense * run.speed).argmax())
    candidates = [ExtremeSpeed(float(run.speed[best]), float(run.angle[best]))]
    part = best // (STAGES + 1)
    for number in (part - 1, part):
        if 0 <= number < len(run.at) - 1:
            first, last = run.at[number], run.at[number + 1] + 1
            x, y = run.angle[first:last], run.speed[first:last]
            middle, half = (x[0] + x[-1]) / 2, (x[-1] - x[0]) / 2
            fit = np.polynomial.Polynomial.fit((x - middle) / half, y - y[0], len(x) - 1, domain=[-1, 1])
            roots = fit.deriv().roots()
            inner = np.real(roots[(np.abs(np.imag(roots)) < SAME_ANGLE) & (np.abs(np.real(roots)) <= 1)])
            candidates += [ExtremeSpeed(float(fit(at) + y[0]), float(middle + half * at)) for at in inner]
    return max(candidates, key=lambda extreme: sense * extreme.speed)


def _described(path: ReducedWay, drive: Drive, energy: EnergyAlong, settles: float) -> SteadyMotion:
    run = run_along(path, drive, energy)
    speed = np.sqrt(2 * energy.inside / path.inertia)
    work = float((path.measure * drive.torque(speed) * B).sum())
    return SteadyMotion(run, _extreme(run, 1), _extreme(run, -1), work, settles)


def mean_torque(body: ReducedMachine, path: ReducedWay) -> tuple[float, float]:
    """The mean of M_r over a cycle and that of its size (N·m)."""
    return (
        float((path.measure * path.torque * B).sum()) / body.whole,
        float((path.measure * np.abs(path.torque) * B).sum()) / body.whole,
    )


def levels(drive: Drive, mean: float, speed: float) -> list[float]:
    """Speeds (rad/s) at which a drive balances a mean torque of the loads and returns to it, the highest first."""
    most = 2 * max((speed, *drive.corners))
    rest = mean + drive.torque(np.array([most]))[0]
    while rest > 0 and most < 1e3 * max((speed, *drive.corners)):
        most *= 2
        rest = mean + drive.torque(np.array([most]))[0]
    at = np.linspace(0.0, most, LOOKED_AT + 1)
    left = mean + drive.torque(at)
    falls = np.flatnonzero((left[:-1] > 0) & (left[1:] <= 0))
    result = at[falls] + (at[1] - at[0]) * left[falls] / (left[falls] - left[falls + 1])
    return [float(each) for each in result[::-1]]


def steady(body: ReducedMachine, drive: Drive, speed: float, own: Sequence[float] = ()) -> SteadyMotion:
    """The steady motion of a machine under a drive; the edges of its parts have the `own` angles (rad) among them.

    Where no torque depends on the speed there is one only if the mean torque is 0, and its level is set by
    (ω_max + ω_min)/2 = `speed`.  Raises `NoMotionError`.
    """
    path = body.along(body.parted(0.0, own))
    mean, size = mean_torque(body, path)
    if not drive.governs:
        return _level(body, path, drive, speed, mean, size)
    guesses = levels(drive, mean, speed)
    for guess in guesses:
        result = closed(path, drive, guess**2 / 2 * np.full(path.angle.shape, float(path.inertia.mean())))
        if result is not None and abs(result[1]) < 1:
            return _described(path, drive, *result)
    if not guesses:
        at_rest = mean + float(drive.torque(np.zeros(1))[0])
        raise NoMotionError("runs-away" if at_rest > 0 else "runs-down", missing=-at_rest)
    _simulated(body, path, drive, guesses[0])
    raise NoMotionError("no-steady-motion", speed=guesses[0])


def _simulated(body: ReducedMachine, path: ReducedWay, drive: Drive, speed: float) -> None:
    """Raises `NoMotionError` where the machine stalls in the cycles after it had this speed (rad/s)."""
    energy = speed**2 / 2 * float(path.at_edges[0][0])
    for _ in range(MOST_CYCLES // 4):
        result, reached = follow(path, drive, energy)
        if reached < path.size:
            stalled(body, path, drive, result, reached)
        energy = float(result.edges[-1])


def stalled(body: ReducedMachine, path: ReducedWay, drive: Drive, energy: EnergyAlong, reached: int) -> None:
    """Raises `NoMotionError` for a machine that comes to a stop in part number `reached`."""
    last = to_the_stop(body, path, drive, energy, reached)
    angle = float(last.angle[-1])
    missing = -float(last.torque[-1] + last.drive[-1])
    raise NoMotionError("stalls", angle=float(np.mod(angle, body.whole)), missing=missing)


def _level(
    body: ReducedMachine, path: ReducedWay, drive: Drive, speed: float, mean: float, size: float
) -> SteadyMotion:
    """The steady motion without a torque that depends on the speed, its mean set to `speed`."""
    torque = float(drive.torque(np.zeros(1))[0])
    if abs(mean + torque) > BALANCED * max(size, abs(torque)):
        raise NoMotionError("runs-away" if mean + torque > 0 else "runs-down", missing=-(mean + torque))
    # What is left of the mean is rounding.
    even = ConstantDrive(-mean)
    p, r, alpha, beta = linear(path, even, np.ones_like(path.angle))
    edges = energy_at_edges(0.0, alpha, beta)
    inside = p * edges[:-1, None] + r
    least = -min(float(edges.min()), float(inside.min()))
    mean_inertia = float(path.inertia.mean())

    def at(level: float) -> SteadyMotion:
        return _described(path, even, EnergyAlong(edges + level, inside + level), 1.0)

    level = max(speed**2 / 2 * mean_inertia, least * (1 + 1e-6) + LEAST_ENERGY)
    for _ in range(MOST_STEPS):
        made = at(level)
        # dω/dT = 1/(Jω) at both extremes.
        rate = sum(
            1
            / (made.run.inertia[int(np.abs(made.run.angle - each.angle).argmin())] * max(each.speed, 1e-9 * speed))
            / 2
            for each in (made.fastest, made.slowest)
        )
        wanted = level + (speed - made.mean) / rate
        if abs(wanted - level) <= SETTLED * level:
            return made
        if wanted <= least:
            wanted = least + (level - least) * LEFT
            if wanted - least <= 1e-9 * max(least, 1e-300):
                raise NoMotionError("stalls", angle=_emptiest(path, edges, inside), missing=0.0)
        level = wanted
    return made


def _emptiest(path: ReducedWay, edges: Floats, inside: Floats) -> float:
    """Where (rad) the energy is least."""
    return float(
        path.edges[int(edges.argmin())] if edges.min() < inside.min() else path.angle.ravel()[int(inside.argmin())]
    )


def to_the_stop(body: ReducedMachine, path: ReducedWay, drive: Drive, energy: EnergyAlong, reached: int) -> MotionRun:
    """The run to where the energy is used up in part number `reached`, found backwards from there.

    It begins a part earlier, so that no part is left in which T changes much.
    """
    begin = max(reached - 1, 0)
    before, low, high = path.edges[begin : reached + 1], float(path.edges[reached]), float(path.edges[reached + 1])
    first = float(energy.edges[begin])

    def from_stop(at: float) -> tuple[ReducedWay, EnergyAlong]:
        back = body.to_rest(np.append(before, at))
        return back, follow(back, drive, 0.0, first * (at - back.angle) / (at - before[0]))[0]

    inside, outside = low, high
    at = (low + high) / 2
    for _ in range(MOST_STEPS):
        back, result = from_stop(at)
        left = float(result.edges[-1]) - first
        # The farther the stop, the more energy it takes to get there.
        inside, outside = (at, outside) if left < 0 else (inside, at)
        speed = np.sqrt(2 * result.edges[-1:] / back.at_edges[0][-1:])
        torque = float(back.at_edges[2][-1] + drive.torque(speed)[0])
        better = at + left / torque if torque < 0 else np.nan
        if not inside < better < outside:
            better = (inside + outside) / 2
        if abs(better - at) <= SETTLED * max(1.0, at):
            break
        at = better
    return run_along(back, drive, result, backwards=True)
