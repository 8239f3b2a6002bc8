"""Reduction of a machine to its crank: moment of inertia, its derivative, and the torque of weights and loads.

The crank with J_r(φ) under M_r(φ) has the kinetic energy and the power of the whole machine:
J_r = Σ m v_S² + J ω²,  J_r′ = dJ_r/dφ = 2 Σ (m v_S·a_S + J ω ε),  M_r = Σ (F·v + M ω),  all at ω₁ = 1, ε₁ = 0.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from reportgen.base.arrays import Floats
from reportgen.machine.analysis import Machine
from reportgen.machine.force_analysis import Load, virtual_work_torque, weights
from reportgen.machine.kinematics import Motion, solve_motion
from reportgen.machine.rigid_motion import dot


def reduced_inertia(machine: Machine, motion: Motion) -> Floats:
    """Return J_r = Σ m (v_S/ω₁)² + J (ω/ω₁)² [N] (kg·m²)."""
    total = np.zeros_like(motion.driver)
    for body in machine.linkage.inertias:
        total += body.mass * np.abs(motion.points[body.centre].v) ** 2
        total += body.moment * motion.links[body.link].omega ** 2
    return np.asarray(total / motion.rate**2)


def inertia_slope(machine: Machine, motion: Motion) -> Floats:
    """Return J_r′ = dJ_r/dφ = 2 Σ (m v_S·a_S + J ω ε)/|ω₁|³ [N] (kg·m²), φ in the sense of rotation.

    The `motion` must be that at ε₁ = 0.
    """
    total = np.zeros_like(motion.driver)
    for body in machine.linkage.inertias:
        centre, link = motion.points[body.centre], motion.links[body.link]
        total += body.mass * dot(centre.v, centre.a) + body.moment * link.omega * link.epsilon
    return np.asarray(2 * total / np.abs(motion.rate) ** 3)


def reduced_torque(machine: Machine, motion: Motion, loads: Sequence[Load]) -> Floats:
    """Return M_r [N] (N·m) of weights and applied loads, positive in the direction of rotation."""
    return np.asarray(-machine.turn * virtual_work_torque(machine.linkage, motion, loads))


def at_unit_speed(machine: Machine, angle: Floats) -> Motion:
    """Return the motion at cycle angles [N] (rad) with ω₁ = 1 in the sense of rotation and ε₁ = 0."""
    return solve_motion(machine.linkage, machine.angles(angle), float(machine.turn))


def reduced(machine: Machine, angle: Floats) -> tuple[Floats, Floats, Floats]:
    """Return J_r, J_r′ (kg·m²) and M_r (N·m), each [N], at cycle angles [N] (rad)."""
    motion = at_unit_speed(machine, angle)
    loads = (*weights(machine.linkage, motion), *(load.load(angle, motion) for load in machine.loads))
    torque = reduced_torque(machine, motion, loads)
    return reduced_inertia(machine, motion), inertia_slope(machine, motion), torque
