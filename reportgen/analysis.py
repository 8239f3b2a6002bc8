"""The one place that joins machine, mechanism and cycle: Machine → Analysis (arrays over positions)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property, partial

import numpy as np

from reportgen.catalogue.machine import Machine, Piston
from reportgen.cycle.indicator import indicated_work, stroke_at
from reportgen.mechanism.forces import Forces, solve_forces
from reportgen.mechanism.loads import Load, inertia_loads, weights
from reportgen.mechanism.motion import Motion, solve_motion
from reportgen.mechanism.power import mean_over, virtual_work_torque

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

    `extremes` are (cycle angle, torque) of the least and the greatest torque on a fine grid.
    """

    mean_torque: float
    power: float
    work: float
    energy_error: float
    """|sgn(ω1)·mean(M_cb) + W/(2π·turns)| over the larger of both."""
    extremes: tuple[tuple[float, float], tuple[float, float]]


def cycle_angles(machine: Machine) -> np.ndarray:
    """Cycle angles of the numbered positions [count·turns]."""
    return np.arange(machine.positions) * (FULL_TURN / machine.count)


def dead_centres(piston: Piston) -> np.ndarray:
    """Cycle angles of a piston at which its four strokes begin [4]; the first is 0, its top."""
    outward = (piston.bottom_angle - piston.top_angle) % FULL_TURN or np.pi
    return np.array([0.0, outward, FULL_TURN, FULL_TURN + outward])


def fraction(piston: Piston, motion: Motion) -> np.ndarray:
    """s/H [N]: the pin's way from its top dead centre over the stroke."""
    along = (piston.bottom - piston.top) / piston.stroke**2
    place = motion.points[piston.pin].p - piston.top
    return np.asarray(np.clip(np.real(np.conj(along) * place), 0.0, 1.0))


def gas_in(piston: Piston, motion: Motion, cycle_angle: np.ndarray) -> Gas:
    """The gas in a cylinder: s/H from the pin's place, pressure from the indicator diagram."""
    angle, share, starts = piston.phase + cycle_angle, fraction(piston, motion), dead_centres(piston)
    return Gas(
        piston,
        angle,
        share,
        stroke_at(angle, starts),
        piston.indicator.pressure(angle, share, starts),
    )


def analyse(machine: Machine, cycle_angle: np.ndarray | None = None) -> Analysis:
    """Solve motion, gas, forces and both torques at the machine's positions, or at other cycle angles."""
    angles = cycle_angles(machine) if cycle_angle is None else np.asarray(cycle_angle, dtype=float)
    linkage = machine.linkage
    motion = solve_motion(linkage, machine.angles(angles), machine.turn * machine.speed)
    gas = {piston.name: gas_in(piston, motion, angles) for piston in machine.pistons}
    applied = tuple(
        Load(
            name,
            state.piston.link,
            np.asarray(state.pressure * state.piston.area * state.piston.inward, dtype=np.complex128),
            motion.points[state.piston.pin].p,
            np.zeros_like(angles),
        )
        for name, state in gas.items()
    )
    heavy, inert = weights(linkage, motion), inertia_loads(linkage, motion)
    loads = (*heavy, *inert, *applied)
    forces = solve_forces(linkage, motion, loads)
    return Analysis(
        machine,
        angles,
        motion,
        gas,
        heavy,
        inert,
        applied,
        forces,
        forces.torque,
        virtual_work_torque(linkage, motion, loads),
    )


def _own_motion(machine: Machine, piston: Piston, angle: np.ndarray) -> Motion:
    """The motion at cycle angles of one piston."""
    return solve_motion(machine.linkage, machine.angles(angle - piston.phase), machine.turn * machine.speed)


def _breaks(machine: Machine) -> np.ndarray:
    """Cycle angles where the loads have corners: dead centres and nodes of the indicator tables."""
    found: list[float] = []
    for piston in machine.pistons:

        def share(angle: np.ndarray, piston: Piston = piston) -> np.ndarray:
            order = np.argsort(angle)
            result = np.empty_like(angle)
            result[order] = fraction(piston, _own_motion(machine, piston, angle[order]))
            return result

        corners = (*piston.indicator.breaks(share, dead_centres(piston)), *dead_centres(piston))
        found += [corner - piston.phase for corner in corners]
    whole = machine.turns * FULL_TURN
    return np.unique(np.mod(found, whole).round(13)) if found else np.array([])


def _fraction_rate(machine: Machine, piston: Piston, angle: np.ndarray) -> np.ndarray:
    """d(s/H)/dφ [N] at cycle angles of one piston."""
    along = (piston.bottom - piston.top) / piston.stroke**2
    velocity = _own_motion(machine, piston, angle).points[piston.pin].v
    return np.asarray(np.real(np.conj(along) * velocity)) / machine.speed


def summarise(machine: Machine) -> Summary:
    """Mean, extremes and energy balance over the cycle: sgn(ω1)·mean(M_cb) = −W/(2π·turns)."""
    whole = machine.turns * FULL_TURN
    mean = mean_over(lambda angle: analyse(machine, angle).torque_by_work, _breaks(machine), 0.0, whole)
    work = sum(
        indicated_work(piston.indicator, piston.area, piston.stroke, partial(_fraction_rate, machine, piston))
        for piston in machine.pistons
    )
    fine = np.linspace(0.0, whole, 361 * machine.turns, endpoint=False)
    torque = analyse(machine, fine).torque
    low, high = int(np.nanargmin(torque)), int(np.nanargmax(torque))
    expected = -work / whole
    return Summary(
        float(mean),
        abs(float(mean)) * machine.speed,
        float(work),
        abs(machine.turn * mean - expected) / max(abs(mean), abs(expected), 1e-300),
        ((float(fine[low]), float(torque[low])), (float(fine[high]), float(torque[high]))),
    )
