"""A machine's motion in time by Newton and Euler for each link with multipliers: an independent witness.

No moment of inertia is reduced here: at each instant the multiplier of the driver's constraint, the torque that the
crank needs, is linear in its acceleration, and that acceleration is taken at which it is the torque of the drive.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from itertools import pairwise

import linkages as made
import newton_euler as ne
import numpy as np

from reportgen.base.records import replace
from reportgen.machine.analysis import Machine
from reportgen.machine.kinematics import solve_motion

HARMONIC = (2, 4, 6, 8, 10, 12)
"""Steps of the modified midpoint rule that are extrapolated to none: the error is of the order h¹³."""

BESIDE = 1e-8
"""What jumps at an angle has jumped so far beside it (rad): a law takes the last 1e-9 before it for rounding."""


def acceleration(machine: Machine, added: float, torque: Callable[[float], float], phi: float, omega: float) -> float:
    """ε₁ in the sense of rotation at the cycle angle φ with the speed ω."""
    at = np.array([phi])
    motion = solve_motion(machine.linkage, machine.angles(at), float(machine.turn))
    bodies, joints, _ = made.told(machine.linkage)
    bodies = bodies | {1: replace(bodies[1], moment=bodies[1].moment + added)}
    (pose,) = made.poses(motion)
    loads = []
    for number, body in bodies.items():
        origin, angle = pose[number]
        centre = origin + body.centre * np.exp(1j * angle)
        loads.append((number, body.mass * machine.linkage.gravity, centre, 0.0))
    for load in (one.load(at, motion) for one in machine.loads):
        loads.append((load.link, complex(load.force[0]), complex(load.point[0]), float(load.couple[0])))
    turn = machine.turn
    needed = []
    for epsilon in (0.0, 1.0):
        answer = ne.solve(bodies, joints, True, turn * omega, pose, loads, 1e9, turn * epsilon)
        assert answer is not None
        assert answer.residual < 1e-9
        needed.append(turn * answer.effort)
    return (torque(omega) - needed[0]) / (needed[1] - needed[0])


def harmonic(rate: Callable[[float, np.ndarray], np.ndarray], low: float, high: float, state: np.ndarray) -> np.ndarray:
    """One step of Gragg, Bulirsch and Stoer."""
    table: list[list[np.ndarray]] = []
    for row, n in enumerate(HARMONIC):
        h = (high - low) / n
        before, now = state, state + h * rate(low, state)
        for j in range(1, n):
            before, now = now, before + 2 * h * rate(low + j * h, now)
        line = [(before + now + h * rate(high, now)) / 2]
        for m in range(1, row + 1):
            line.append(line[m - 1] + (line[m - 1] - table[row - 1][m - 1]) / ((n / HARMONIC[row - m]) ** 2 - 1))
        table.append(line)
    return table[-1][-1]


def in_time(
    machine: Machine, added: float, torque: Callable[[float], float], angle: float, speed: float, times: np.ndarray
) -> list[tuple[float, float]]:
    """(φ, ω) at the `times` [N] (s), from these at the first, which may be rest; one step between neighbours."""

    def rate(_: float, state: np.ndarray) -> np.ndarray:
        return np.array([state[1], acceleration(machine, added, torque, *map(float, state))])

    state = np.array([angle, speed])
    passed = [(angle, speed)]
    for low, high in pairwise(times):
        state = harmonic(rate, low, high, state)
        passed.append((float(state[0]), float(state[1])))
    return passed


def integrate(
    machine: Machine, added: float, torque: Callable[[float], float], stops: np.ndarray, speed: float, steps: int
) -> list[tuple[float, float]]:
    """(t, ω) at the cycle angles `stops` [N], from `speed` at the first; so many steps between neighbours.

    dt/dφ = 1/ω and dω/dφ = ε/ω by Gragg, Bulirsch and Stoer.
    """

    def rate(phi: float, state: np.ndarray) -> np.ndarray:
        _, omega = state
        return np.array([1.0, acceleration(machine, added, torque, phi, omega)]) / omega

    def within(ends: tuple[float, float], phi: float, state: np.ndarray) -> np.ndarray:
        return rate(min(max(phi, ends[0]), ends[1]), state)

    state = np.array([0.0, speed])
    found = [(0.0, speed)]
    for low, high in pairwise(stops):
        width = (high - low) / steps
        inset = BESIDE
        for k in range(steps):
            start = low + k * width
            ends = max(start, low + inset), min(start + width, high - inset)
            state = harmonic(partial(within, ends), start, start + width, state)
        found.append((float(state[0]), float(state[1])))
    return found
