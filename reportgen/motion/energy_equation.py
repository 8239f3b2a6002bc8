"""The equation of energy of a machine reduced to its crank, dT/dφ = M, along the crank's path.

With J the moment of inertia reduced to the crank and M = M_r(φ) + M_d(ω) the torque on it, T = ½Jω². The path is split
where loads jump, and T is a polynomial in each part that satisfies the equation at the Gauss–Legendre nodes
(collocation). Newton's method linearises the equation about the previous T. Each part then maps T to αT + β, and so
does the whole cycle, whose fixed point β/(1 − α) is the steady motion. Near rest T is not a polynomial of the angle:
there the motion is integrated in time (`time_integration`).
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from reportgen.base.arrays import Floats
from reportgen.base.records import Record
from reportgen.machine.analysis import Machine, breaks
from reportgen.machine.cycle_torque import CycleTorque
from reportgen.machine.load_laws import FULL_TURN
from reportgen.machine.quadrature import gauss
from reportgen.machine.reduction import reduced
from reportgen.motion.drives import Drive

PARTS = 180
"""Smallest number of parts of a turn: two degrees each."""
STAGES = 6
"""Number of nodes in a part; the error is of the order h¹³ at its end and h⁷ within it."""
SAME_ANGLE = 1e-9
"""Angles closer than this (rad) are equal."""
SETTLED = 1e-13
"""Newton's method ends when T changes by less than this share of itself."""
ROUNDING = 1e-9
"""Relative change below which a value that no longer decreases from step to step is rounding."""
MOST_STEPS = 60
MOST_CHANGE = 2.5
"""Largest factor by which T may change in a part."""
ACCURATE = 1e-8
"""Largest contribution of the highest polynomials in a part to T and to the time, as a share; at its end both are
far better.
"""
FEW = 8
"""Number of parts in the first attempt."""
LEAST_ENERGY = 1e-12
"""Smallest energy, as a share of the greatest, since the torque of a drive is evaluated at a speed."""
LEFT = 1 / 4
"""Every Newton step leaves at least this share of the energy at each node."""


def _stages() -> tuple[Floats, Floats, Floats]:
    """Return the nodes c and weights b of the rule on 0…1, and its matrix A: ∫₀^{c_j} f = Σ A_jl f_l."""
    places, weights = gauss(np.zeros(1), np.ones(1), STAGES)
    c, b = places[0], weights[0]
    powers = np.arange(STAGES)
    matrix = (c[:, None] ** (powers + 1) / (powers + 1)) @ np.linalg.inv(c[:, None] ** powers)
    return c, b, matrix


C, B, A = _stages()
MODES = np.linalg.inv(np.polynomial.legendre.legvander(2 * C - 1, STAGES - 1))
"""Matrix from the values at the nodes of a part to the coefficients of Legendre polynomials."""


def tail(values: Floats) -> float:
    """Return the size of the two highest Legendre coefficients, in the unit of the values [s] at the nodes of a
    part.
    """
    return float(np.abs(MODES[-2:] @ values).max())


# --- the machine over the way ------------------------------------------------------------------------


class ReducedTravel(Record):
    """A path between rising cycle angles `edges` (rad) [n + 1], with values at the nodes in its n parts [n, s].

    `angle` (rad) of the nodes; `measure` (rad), dφ/dx times the length of the part, so that dT = M·measure over 0…1; J,
    J′ (kg·m²) and M_r (N·m) there, and at the edges.
    """

    edges: Floats
    angle: Floats
    measure: Floats
    inertia: Floats
    slope: Floats
    torque: Floats
    at_edges: tuple[Floats, Floats, Floats]

    @property
    def size(self) -> int:
        return len(self.edges) - 1

    def parts(self, first: int, last: int) -> ReducedTravel:
        """Return the parts from number `first` up to `last`, which is left out."""
        within = {name: getattr(self, name)[first:last] for name in ("angle", "measure", "inertia", "slope", "torque")}
        inertia, slope, torque = (values[first : last + 1] for values in self.at_edges)
        return ReducedTravel(self.edges[first : last + 1], **within, at_edges=(inertia, slope, torque))


class ReducedMachine(Record, dict=True):
    """A machine with additional inertia on its crank: `added` moment of inertia (kg·m²) of motor, gear, flywheel.

    `loss` is the torque that friction takes from its crank, if any joint has friction.
    """

    machine: Machine
    added: float = 0.0
    loss: CycleTorque | None = None

    @property
    def whole(self) -> float:
        """The length of the cycle (rad)."""
        return self.machine.turns * FULL_TURN

    def reduced(self, angle: Floats, sense: int = 1) -> tuple[Floats, Floats, Floats]:
        """Return J, J′ (kg·m²) and M_r (N·m) at rising cycle angles (rad) [N], which may lie beyond the cycle.

        Friction acts against the `sense` in which the crank moves.
        """
        inertia, slope, torque = reduced(self.machine, angle)
        if self.loss is not None:
            torque = torque - sense * self.loss.torque(angle)
        return inertia + self.added, slope, torque

    @property
    def yields(self) -> bool:
        """True if its loads can push the crank back where they exceed the drive; False if they only resist."""
        return not any(load.law.kind in ("opposing", "cutting") for load in self.machine.loads)

    def along(self, edges: Floats) -> ReducedTravel:
        """Return the path with these rising edges (rad) [n + 1]."""
        return self._reduced_travel(
            edges, edges[:-1, None] + np.diff(edges)[:, None] * C, np.diff(edges)[:, None] * np.ones(STAGES)
        )

    def _reduced_travel(self, edges: Floats, angle: Floats, measure: Floats) -> ReducedTravel:
        every = np.concatenate((angle.ravel(), edges))
        order = np.argsort(every, kind="stable")
        values = np.empty((3, every.size))
        values[:, order] = self.reduced(every[order])
        inside = values[:, : angle.size].reshape(3, *angle.shape)
        J, slope, torque = inside
        at_edges = values[0, angle.size :], values[1, angle.size :], values[2, angle.size :]
        return ReducedTravel(edges, angle, measure, inertia=J, slope=slope, torque=torque, at_edges=at_edges)

    @cached_property
    def corners(self) -> Floats:
        """Cycle angles (rad) [N] at which loads jump or bend."""
        own = np.empty(0) if self.loss is None else self.loss.edges[:-1]
        return np.unique(np.concatenate((breaks(self.machine), own)))

    def parted(self, start: float, own: Sequence[float] = ()) -> Floats:
        """Return the edges (rad) [n + 1] of a cycle from `start`: evenly spaced ones, angles where loads jump, and the
        angles in `own`.
        """
        grid = start + np.linspace(0.0, self.whole, self.machine.turns * PARTS + 1)
        inner = start + np.mod(np.concatenate((self.corners, np.asarray(own, dtype=float))) - start, self.whole)
        edges = np.sort(np.concatenate((grid, inner)))
        kept = np.concatenate((edges[:-1][np.diff(edges) > SAME_ANGLE], [grid[-1]]))
        # A place slightly before an edge is that edge: the exact place of a jump counts.
        kept[0] = start
        return kept


# --- the equation of energy --------------------------------------------------------------------------


class EnergyAlong(Record):
    """T (J) along a path: at its edges [n + 1] and at the nodes in its parts [n, s]."""

    edges: Floats
    inside: Floats

    def first(self, count: int) -> EnergyAlong:
        """Return the energy along the first parts."""
        return EnergyAlong(self.edges[: count + 1], self.inside[:count])


def linear(path: ReducedTravel, drive: Drive, energy: Floats) -> tuple[Floats, Floats, Floats, Floats]:
    """Return p, r [n, s], α, β [n] of the equation linearised about T (J) [n, s]: T = p T₀ + r inside each part, α T₀ +
    β at its end.
    """
    speed = np.sqrt(2 * energy / path.inertia)
    gain = path.measure * drive.slope(speed) / (path.inertia * speed)
    rest = path.measure * (path.torque + drive.torque(speed)) - gain * energy
    matrix = np.eye(STAGES) - A * gain[:, None, :]
    right = np.stack((np.ones_like(rest), rest @ A.T), axis=-1)
    p, r = np.moveaxis(np.linalg.solve(matrix, right), -1, 0)
    return p, r, 1 + (B * gain * p).sum(axis=1), (B * (rest + gain * r)).sum(axis=1)


def energy_at_edges(first: float, alpha: Floats, beta: Floats) -> Floats:
    """Return T (J) at the edges [n + 1] from T at the first one: α T + β [n] at the end of each part."""
    at = [first]
    for a, b in zip(alpha.tolist(), beta.tolist(), strict=True):
        at.append(a * at[-1] + b)
    return np.array(at)


def _first_empty(edges: Floats, inside: Floats) -> int:
    """Return the first part in which the energy falls to zero; the number of parts if there is none."""
    empty = (inside <= 0).any(axis=1) | (edges[1:] <= 0)
    return int(empty.argmax()) if empty.any() else len(empty)


def follow(path: ReducedTravel, drive: Drive, first: float) -> tuple[EnergyAlong, int]:
    """Return T along a path from T = `first` (J), and the number of parts over which it is accurate.

    It ends before the first part in which T changes too much for a polynomial, is used up, or Newton's method fails.
    Since no part depends on later ones, a few parts are tried first, then more and more.
    """
    edges, inside = [np.array([first])], []
    done, size, start = 0, min(FEW, path.size), first
    while done < path.size:
        part = path.parts(done, done + size)
        result, reached = _newton(part, drive, start, np.full(part.angle.shape, start))
        accurate = smooth(part.parts(0, reached), drive, result.first(reached))
        kept = reached if accurate.all() else int(accurate.argmin())
        if kept:
            edges.append(result.edges[1 : kept + 1])
            inside.append(result.inside[:kept])
            start = float(result.edges[kept])
        done += kept
        if kept < size:
            if kept < reached or size == 1:
                break
            size = 1 if reached else size // 2
        else:
            size = min(2 * size, path.size - done)
    return EnergyAlong(np.concatenate(edges), np.concatenate((*inside, np.empty((0, STAGES))))), done


def smooth(path: ReducedTravel, drive: Drive, energy: EnergyAlong) -> NDArray[np.bool_]:
    """Return flags [n] of the parts in which polynomials are accurate: T (J) changes little, and the highest terms are
    negligible.
    """
    every = np.column_stack((energy.edges[:-1], energy.inside, energy.edges[1:]))
    most, least = every.max(axis=1, initial=0.0), every.min(axis=1, initial=np.inf)
    speed = np.sqrt(2 * np.maximum(energy.inside, LEAST_ENERGY * most[:, None]) / path.inertia)
    work, time = path.measure * (path.torque + drive.torque(speed)), path.measure / speed

    def left_out(values: Floats) -> Floats:
        return np.asarray(np.abs(values @ MODES[-2:].T).max(axis=1, initial=0.0))

    accurate = (left_out(work) <= ACCURATE * most) & (left_out(time) <= ACCURATE * time.sum(axis=1))
    return np.asarray((least > 0) & (most <= MOST_CHANGE * least) & accurate)


def _newton(path: ReducedTravel, drive: Drive, first: float, energy: Floats) -> tuple[EnergyAlong, int]:
    """Return T along a path by Newton's method from a guess [n, s], and the number of its parts that have converged."""
    scale = first + float(np.abs(path.measure * path.torque).sum())
    for _ in range(MOST_STEPS):
        energy = np.maximum(energy, LEAST_ENERGY * scale)
        p, r, alpha, beta = linear(path, drive, energy)
        edges = energy_at_edges(first, alpha, beta)
        inside = p * edges[:-1, None] + r
        reached = _first_empty(edges, inside)
        moved = (np.abs(inside - energy) <= SETTLED * np.abs(inside).max(initial=0.0, where=inside > 0)).all(axis=1)
        sure = len(moved) if moved.all() else int(moved.argmin())
        if reached <= sure:
            return EnergyAlong(edges, inside), reached
        energy = np.maximum(inside, LEFT * energy)
    return EnergyAlong(edges, inside), sure


def closed(path: ReducedTravel, drive: Drive, guess: Floats) -> tuple[EnergyAlong, float] | None:
    """Return T along a cycle that ends as it began, from a guess (J) [n, s], and the factor α of a deviation in a
    cycle.

    Return None if Newton's method does not converge, or converges to a motion without energy.
    """
    energy, before = guess, np.inf
    for _ in range(MOST_STEPS):
        p, r, alpha, beta = linear(path, drive, energy)
        whole = energy_at_edges(1.0, alpha, beta)[-1] - (free := energy_at_edges(0.0, alpha, beta)[-1])
        if not np.isfinite(free) or whole == 1:
            return None
        edges = energy_at_edges(free / (1 - whole), alpha, beta)
        inside = p * edges[:-1, None] + r
        moved = float(np.abs(inside - energy).max() / np.abs(inside).max())
        energy = np.maximum(inside, LEFT * energy)
        # A cycle that hardly governs itself lets rounding grow by 1/(1 − α).
        if moved <= SETTLED or (moved <= ROUNDING and 2 * moved >= before):
            return (EnergyAlong(edges, inside), float(whole)) if min(edges.min(), inside.min()) > 0 else None
        before = moved
    return None
