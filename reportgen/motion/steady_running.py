"""The steady motion of a machine under a drive, and its run along any path: ω(φ), ε(φ), t(φ).

With J reduced to the crank and M = M_r(φ) + M_d(ω) the torque on it, T = ½Jω² grows by dT/dφ = M (`energy_equation`);
then ω = √(2T/J),  ε = (M − ½ω²J′)/J,  dt = dφ/ω.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from reportgen.base.arrays import Floats
from reportgen.base.records import Record, replace
from reportgen.motion.drives import ConstantDrive, Drive
from reportgen.motion.energy_equation import (
    LEAST_ENERGY,
    LEFT,
    MOST_STEPS,
    ROUNDING,
    SAME_ANGLE,
    SETTLED,
    STAGES,
    A,
    B,
    EnergyAlong,
    ReducedMachine,
    ReducedTravel,
    closed,
    energy_at_edges,
    follow,
    linear,
    smooth,
)
from reportgen.motion.time_integration import TimeStepper, UnsettledError, times

BALANCED = 1e-9
"""A mean torque below this share of the mean of its absolute value is zero."""
MOST_CYCLES = 400
"""Largest number of cycles of a start; a longer start is reported instead."""
MOST_REFINED = 12
"""Largest number of halvings of a part of the cycle in which T changes too much."""
HEAVIER = 4.0
"""Factor by which the inertia is increased until a steady motion is found; it is the start value for the machine
itself.
"""
MOST_HEAVIER = 12
HARDLY = 1e-3
"""A reduced moment of inertia below this share of its greatest value is so small that T may not determine the speed
there.
"""
NEAREST = 1.01
"""Inertias that differ by less than this factor are not tried."""


class NoMotionError(Exception):
    """A requested motion is impossible.

    `code` is "stalls", "start-stalls", "does-not-start", "starts-nowhere", "starts-too-slowly", "does-not-stop",
    "runs-away", "runs-down", "no-inertia" or "no-steady-motion"; `angle` (rad) is the cycle angle, `missing` (N·m) the
    missing torque, `ranges` (rad) the angles from which the machine would start, `speed` (rad/s) the speed in question.
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


class MotionRun(Record):
    """A run of a machine over samples [K]: the edges of its path and the nodes between them.

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
        """Return the index among the samples of the edge at an angle (rad)."""
        edges = self.angle[self.at]
        return int(self.at[int(np.abs(edges - angle).argmin())])

    def joined(self, *after: MotionRun) -> MotionRun:
        """Return this run and those that continue it, joined one after the other."""
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
        """Return the same run, starting later by an angle (rad)."""
        return replace(self, angle=self.angle + angle)


def run_along(path: ReducedTravel, drive: Drive, energy: EnergyAlong) -> MotionRun:
    """Return the run along a path with a known energy."""
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
    return MotionRun(
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


def run_in_time(stepper: TimeStepper, angle: float, speed: float, edge: float) -> tuple[MotionRun, bool]:
    """Return the run from an angle (rad) to an edge, integrated in time, and True if the crank stops before the edge.

    `speed` is in rad/s.  Raises `NoMotionError` if the machine approaches a place without ever reaching it.
    """
    try:
        leg = stepper.leg(angle, speed, edge)
    except UnsettledError as error:
        raise NoMotionError("stalls", angle=float(np.mod(error.angle, stepper.body.whole)), missing=0.0) from error
    steps = leg.steps
    angles = np.concatenate(([angle], *(np.append(step.angle, step.end_angle) for step in steps)))
    speeds = np.concatenate(([speed], *(np.append(step.speed, step.end_speed) for step in steps)))
    inertia, slope, torque = stepper.reduced(angles)
    driven = stepper.drive.torque(speeds)
    run = MotionRun(
        angle=angles,
        inertia=inertia,
        slope=slope,
        torque=torque,
        drive=driven,
        energy=inertia * speeds**2 / 2,
        speed=speeds,
        acceleration=(torque + driven - speeds**2 * slope / 2) / inertia,
        time=times(steps),
        at=np.arange(len(steps) + 1) * (STAGES + 1),
    )
    return run, leg.rests


def passage(
    body: ReducedMachine, edges: Floats, drive: Drive, speed: float, known: ReducedTravel | None = None
) -> tuple[MotionRun, bool]:
    """Return the forward run between edges (rad) [n + 1], along their path if it is `known`, and True if it reaches the
    last one.

    The `speed` at the first edge (rad/s) may be 0; then the torque there is positive. The equation of energy is used
    while T is close to a polynomial of the angle, time steps for the rest. Raises `NoMotionError`.
    """
    path = known or body.along(edges)
    runs, at, stepper = list[MotionRun](), 0, TimeStepper(body, drive)
    while at < path.size:
        if speed > 0:
            left = path.parts(at, path.size)
            energy, count = follow(left, drive, speed**2 / 2 * float(left.at_edges[0][0]))
            if count:
                runs.append(run_along(left.parts(0, count), drive, energy))
                at, speed = at + count, float(runs[-1].speed[-1])
        if at < path.size:
            run, rests = run_in_time(stepper, float(path.edges[at]), speed, float(path.edges[at + 1]))
            runs.append(run)
            if rests:
                return runs[0].joined(*runs[1:]), False
            at, speed = at + 1, float(run.speed[-1])
    return runs[0].joined(*runs[1:]), True


# --- steady motion -----------------------------------------------------------------------------------


class ExtremeSpeed(Record):
    """The greatest or the least speed (rad/s) and the cycle angle (rad) where it is."""

    speed: float
    angle: float


class SteadyMotion(Record):
    """The steady motion over one cycle.

    `fastest` and `slowest` come from the polynomials of the parts; `mean` = (ω_max + ω_min)/2 (rad/s), `unevenness` δ =
    (ω_max − ω_min)/mean, `period` (s), `work` of the drive in a cycle (J) and its mean `power` (W); `settles` is the
    factor by which a deviation of T grows in a cycle, 1 if no torque depends on the speed.
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
    """Return the greatest (+1) or least (−1) speed, from the samples and the polynomials of the parts next to the best
    one.
    """
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


def _described(path: ReducedTravel, drive: Drive, energy: EnergyAlong, settles: float) -> SteadyMotion:
    run = run_along(path, drive, energy)
    speed = np.sqrt(2 * energy.inside / path.inertia)
    work = float((path.measure * drive.torque(speed) * B).sum())
    return SteadyMotion(run, _extreme(run, 1), _extreme(run, -1), work, settles)


def mean_torque(body: ReducedMachine, path: ReducedTravel) -> tuple[float, float]:
    """Return the mean of M_r over a cycle and the mean of |M_r| (N·m)."""
    return (
        float((path.measure * path.torque * B).sum()) / body.whole,
        float((path.measure * np.abs(path.torque) * B).sum()) / body.whole,
    )


def levels(drive: Drive, mean: float, speed: float) -> list[float]:
    """Return the speeds (rad/s) at which a drive stably balances a `mean` torque of the loads (N·m), the highest first.

    Between the corners of a characteristic its torque rises or falls throughout, and it continues beyond the last
    corner.
    """

    def rest(at: float) -> float:
        return mean + float(drive.torque(np.array([at]))[0])

    most = 2 * max((speed, *drive.corners))
    while rest(most) > 0 and most < 1e3 * max((speed, *drive.corners)):
        most *= 2
    marks = sorted({0.0, most, *(corner for corner in drive.corners if corner > 0)})
    result = []
    for low, high in pairwise(marks):
        if rest(low) > 0 >= rest(high):
            inside, outside = low, high
            while outside - inside > SETTLED * most:
                middle = (inside + outside) / 2
                inside, outside = (middle, outside) if rest(middle) > 0 else (inside, middle)
            result.append((inside + outside) / 2)
    return result[::-1]


def steady(body: ReducedMachine, drive: Drive, speed: float, own: Sequence[float] = ()) -> SteadyMotion:
    """Return the steady motion of a machine under a drive; the edges of its parts include the angles in `own` (rad).

    If no torque depends on the speed, a steady motion exists only if the mean torque is 0, and (ω_max + ω_min)/2 =
    `speed` (rad/s) determines its level.  Raises `NoMotionError`.
    """
    path = body.along(body.parted(0.0, own))
    mean, size = mean_torque(body, path)
    if not drive.governs:
        return _level(body, path, drive, speed, mean, size)
    guesses = levels(drive, mean, speed)
    for guess in guesses:
        result = _cycle(path, drive, guess)
        if result is not None:
            return _refined(body, path, drive, *result)
    if not guesses:
        at_rest = mean + float(drive.torque(np.zeros(1))[0])
        raise NoMotionError("runs-away" if at_rest > 0 else "runs-down", missing=-at_rest)
    _simulated(body, path, drive, guesses[0])
    raise _light(path) or NoMotionError("no-steady-motion", speed=guesses[0])


def _light(path: ReducedTravel) -> NoMotionError | None:
    """Return an error if the machine has so little inertia at some angle that T does not determine a speed there; else
    None.
    """
    inside = path.inertia.ravel()
    if inside.min() > HARDLY * inside.max():
        return None
    return NoMotionError("no-inertia", angle=float(path.angle.ravel()[inside.argmin()]))


def _cycle(path: ReducedTravel, drive: Drive, speed: float) -> tuple[EnergyAlong, float] | None:
    """Return T along a steady cycle about a speed (rad/s), and the factor of a deviation; None if no cycle is found.

    If Newton's method does not converge directly, the motion of a machine with more inertia is the start value.
    """

    def of(extra: float, squared: Floats) -> tuple[EnergyAlong, float] | None:
        heavier = replace(path, inertia=path.inertia + extra)
        result = closed(heavier, drive, squared * heavier.inertia / 2)
        return None if result is None or abs(result[1]) >= 1 else result

    even = np.full(path.angle.shape, speed**2)
    if (result := of(0.0, even)) is not None:
        return result
    mean = float(path.inertia.mean())
    sizes = [mean * HEAVIER**k for k in range(MOST_HEAVIER)]
    extra, result = next(((size, of(size, even)) for size in sizes if of(size, even)), (0.0, None))
    step = HEAVIER
    while result is not None and extra:
        squared = 2 * result[0].inside / (path.inertia + extra)
        lighter = extra / step if extra / step > mean / 1e3 else 0.0
        if (nearer := of(lighter, squared)) is not None:
            extra, result, step = lighter, nearer, min(step**2, HEAVIER)
        elif step > NEAREST:
            step = float(np.sqrt(step))
        else:
            return None
    return result


def _refined(
    body: ReducedMachine, path: ReducedTravel, drive: Drive, energy: EnergyAlong, settles: float
) -> SteadyMotion:
    """Return the steady motion, with parts halved while T changes too much in them."""
    for _ in range(MOST_REFINED):
        rough = np.flatnonzero(~smooth(path, drive, energy))
        if not rough.size:
            return _described(path, drive, energy, settles)
        edges = np.sort(np.concatenate((path.edges, (path.edges[rough] + path.edges[rough + 1]) / 2)))
        finer = body.along(edges)
        before = np.interp(finer.angle, path.angle.ravel(), energy.inside.ravel())
        result = closed(finer, drive, before)
        if result is None:
            break
        path, (energy, settles) = finer, result
    if (error := _light(path)) is not None:
        raise error
    return _described(path, drive, energy, settles)


def _simulated(body: ReducedMachine, path: ReducedTravel, drive: Drive, speed: float) -> None:
    """Raise `NoMotionError` if the machine stalls in the cycles after it had this speed (rad/s)."""
    for _ in range(MOST_CYCLES // 4):
        before = speed
        run, arrives = passage(body, path.edges, drive, speed, path)
        if not arrives:
            raise stalled(body, run)
        speed = float(run.speed[-1])
        if abs(speed - before) <= ROUNDING * speed:
            break


def stalled(body: ReducedMachine, run: MotionRun, code: str = "stalls") -> NoMotionError:
    """Return the error for a machine that comes to rest at the end of a run."""
    missing = -float(run.torque[-1] + run.drive[-1])
    return NoMotionError(code, angle=float(np.mod(run.angle[-1], body.whole)), missing=missing)


def _level(
    body: ReducedMachine, path: ReducedTravel, drive: Drive, speed: float, mean: float, size: float
) -> SteadyMotion:
    """Return the steady motion without a torque that depends on the speed, with its mean set to `speed` (rad/s)."""
    torque = float(drive.torque(np.zeros(1))[0])
    if abs(mean + torque) > BALANCED * max(size, abs(torque)):
        raise NoMotionError("runs-away" if mean + torque > 0 else "runs-down", missing=-(mean + torque))
    # The remaining mean is rounding.
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


def _emptiest(path: ReducedTravel, edges: Floats, inside: Floats) -> float:
    """Return the angle (rad) at which the energy is least."""
    return float(
        path.edges[int(edges.argmin())] if edges.min() < inside.min() else path.angle.ravel()[int(inside.argmin())]
    )
