"""The one place that joins machine, mechanism and cycle: Machine → Analysis (arrays over positions)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property, partial

import numpy as np

from reportgen.catalogue.loads import Applied, Piston, Torque
from reportgen.catalogue.machine import Machine
from reportgen.cycle import indicated_work, stroke_at
from reportgen.mechanism.forces import (
    Forces,
    Load,
    inertia_loads,
    mean_over,
    solve_forces,
    virtual_work_torque,
    weights,
)
from reportgen.mechanism.motion import Motion, solve_motion

FULL_TURN = 2 * np.pi


@dataclass(frozen=True)
class Gas:
    """The gas in one cylinder over positions [N]: cycle angle, s/H, stroke number 0…3, gauge pressure (Pa)."""

    piston: Piston
    angle: np.ndarray
    fraction: np.ndarray
    stroke: np.ndarray
    pressure: np.ndarray


@dataclass(frozen=True)
class Analysis:
    """Everything computed of a machine at its cycle angles [N] (0 at position 1, growing with the rotation)."""

    machine: Machine
    cycle_angle: np.ndarray
    motion: Motion
    gas: Mapping[str, Gas]
    weights: tuple[Load, ...]
    inertia: tuple[Load, ...]
    applied: tuple[Load, ...]
    forces: Forces
    torque: np.ndarray
    """Balancing torque by equilibrium of the driver (N·m, anticlockwise positive)."""
    torque_by_work: np.ndarray
    """The same by virtual work; shares no code with `torque`."""

    @property
    def loads(self) -> tuple[Load, ...]:
        return (*self.inertia, *self.applied, *self.weights)

    @cached_property
    def summary(self) -> Summary:
        return summarise(self.machine)


@dataclass(frozen=True)
class Summary:
    """The cycle as a whole, from continuous quadrature: mean torque (N·m), power (W), indicated work (J).

    `extremes` are (cycle angle, torque) of the least and the greatest torque, to a thousandth of a degree.
    """

    mean_torque: float
    power: float
    work: float
    energy_error: float
    """|sgn(ω1)·mean(M_cb) + W/(2π·turns)| over the greatest torque of the cycle."""
    extremes: tuple[tuple[float, float], tuple[float, float]]


def gas_in(piston: Piston, motion: Motion, cycle_angle: np.ndarray) -> Gas:
    """The gas in a cylinder: s/H from the pin's place, pressure from the indicator diagram."""
    angle = piston.phase + cycle_angle
    return Gas(
        piston,
        angle,
        piston.fraction(motion),
        stroke_at(angle, piston.dead_centres),
        piston.law.reading(cycle_angle, motion),
    )


def analyse(machine: Machine, cycle_angle: np.ndarray | None = None) -> Analysis:
    """Solve motion, gas, forces and both torques at the machine's positions, or at other cycle angles."""
    angles = machine.cycle_angles if cycle_angle is None else np.asarray(cycle_angle, dtype=float)
    linkage = machine.linkage
    motion = motion_at(machine, angles)
    gas = {piston.name: gas_in(piston, motion, angles) for piston in machine.pistons}
    applied = (
        *(_load(force, angles, motion) for force in machine.applied),
        *(_couple(torque, angles, motion) for torque in machine.torques),
    )
    heavy, inert = weights(linkage, motion), inertia_loads(linkage, motion)
    loads = (*heavy, *inert, *applied)
    forces = solve_forces(linkage, motion, loads)
    return Analysis(
        machine=machine,
        cycle_angle=angles,
        motion=motion,
        gas=gas,
        weights=heavy,
        inertia=inert,
        applied=applied,
        forces=forces,
        torque=forces.torque,
        torque_by_work=virtual_work_torque(linkage, motion, loads),
    )


def motion_at(machine: Machine, cycle_angle: np.ndarray) -> Motion:
    """The motion at cycle angles [N]."""
    return solve_motion(machine.linkage, machine.angles(cycle_angle), machine.turn * machine.speed)


def _load(force: Applied, cycle_angle: np.ndarray, motion: Motion) -> Load:
    size = force.law.value(cycle_angle, motion)
    return Load(
        force.name,
        force.link,
        np.asarray(size * force.direction, dtype=np.complex128),
        motion.points[force.point].p,
        np.zeros_like(cycle_angle),
    )


def _couple(torque: Torque, cycle_angle: np.ndarray, motion: Motion) -> Load:
    still = np.zeros(cycle_angle.shape, dtype=np.complex128)
    size = torque.law.value(cycle_angle, motion)
    return Load(torque.name, torque.link, still, motion.origins[torque.link].p, size)


def breaks(machine: Machine) -> np.ndarray:
    """Cycle angles where the loads have corners: dead centres and nodes of the tables."""
    laws = [*(force.law for force in machine.applied), *(torque.law for torque in machine.torques)]
    found = [corner for law in laws for corner in law.breaks(partial(motion_at, machine))]
    whole = machine.turns * FULL_TURN
    return np.unique(np.mod(found, whole).round(13)) if found else np.array([])


def _work(machine: Machine) -> float:
    """The work of the loads over the cycle (J): of gas exact from its table, else ∫ F·v dt and ∫ M ω dt."""
    whole = machine.turns * FULL_TURN
    pistons = {piston.name: piston for piston in machine.pistons}
    total = 0.0
    for force in machine.applied:
        if force.name in pistons:
            total += _indicated(machine, pistons[force.name])
            continue

        def power(angle: np.ndarray, force: Applied = force) -> np.ndarray:
            motion = motion_at(machine, angle)
            along = np.real(np.conj(force.direction) * motion.points[force.point].v)
            return np.asarray(force.law.value(angle, motion) * along)

        corners = force.law.breaks(partial(motion_at, machine))
        total += mean_over(power, np.mod(list(corners), whole), 0.0, whole) * machine.way / machine.speed
    for torque in machine.torques:

        def turning(angle: np.ndarray, torque: Torque = torque) -> np.ndarray:
            motion = motion_at(machine, angle)
            return np.asarray(torque.law.value(angle, motion) * motion.links[torque.link].omega)

        corners = torque.law.breaks(partial(motion_at, machine))
        total += mean_over(turning, np.mod(list(corners), whole), 0.0, whole) * machine.way / machine.speed
    return total


def _indicated(machine: Machine, piston: Piston) -> float:
    def rate(angle: np.ndarray) -> np.ndarray:
        return piston.fraction_rate(motion_at(machine, angle - piston.phase))

    return indicated_work(piston.indicator, piston.area, piston.stroke, rate)


def _energy_gained(machine: Machine) -> float:
    """What the links gain in energy of motion and height over the way of a sliding driver (J); 0 over a turn."""
    if not machine.span:
        return 0.0
    linkage, motion = machine.linkage, motion_at(machine, np.array([0.0, FULL_TURN]))
    total = np.zeros(2)
    for body in linkage.inertias:
        centre = motion.points[body.centre]
        height = np.real(np.conj(linkage.gravity) * centre.p)
        total += body.mass * (np.abs(centre.v) ** 2 / 2 - height)
        total += body.moment * motion.links[body.link].omega ** 2 / 2
    return float(total[1] - total[0])


def summarise(machine: Machine) -> Summary:
    """Mean, extremes and energy balance over the cycle: sgn(ω1)·mean(M_cb) = −W/(2π·turns)."""
    whole = machine.turns * FULL_TURN
    mean = mean_over(lambda angle: analyse(machine, angle).torque_by_work, breaks(machine), 0.0, whole)
    work, gained = _work(machine), _energy_gained(machine)
    fine = np.linspace(0.0, whole, 360 * machine.turns, endpoint=False)
    torque = analyse(machine, fine).torque
    return Summary(
        float(mean),
        abs(float(mean)) * machine.speed,
        float(work),
        abs(machine.turn * mean + (work - gained) / machine.way) / max(float(np.nanmax(np.abs(torque))), 1e-300),
        (_extreme(machine, fine, torque, -1), _extreme(machine, fine, torque, 1)),
    )


def _extreme(machine: Machine, angles: np.ndarray, torque: np.ndarray, sense: int) -> tuple[float, float]:
    """The greatest (`sense` +1) or least (−1) torque and its cycle angle: the best of a grid, looked at closer."""
    for _ in range(2):
        best, step = int(np.nanargmax(sense * torque)), float(angles[1] - angles[0])
        angles = np.linspace(angles[best] - step, angles[best] + step, 81)
        if machine.span:  # a slide ends where its way ends
            angles = np.unique(np.clip(angles, 0.0, FULL_TURN))
        torque = analyse(machine, angles).torque
    best = int(np.nanargmax(sense * torque))
    # A turn closes at its end; a slide has come to it.
    return float(angles[best] if machine.span else angles[best] % (machine.turns * FULL_TURN)), float(torque[best])
