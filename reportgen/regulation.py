"""A machine's flywheel: reduced torque and inertia from its loads and motion, then `cycle.flywheel`."""

from __future__ import annotations

from functools import partial

import numpy as np

from reportgen.analysis import FULL_TURN, Analysis, analyse, breaks
from reportgen.catalogue.machine import Machine
from reportgen.cycle.flywheel import Flywheel, accumulated, regulate
from reportgen.mechanism.forces import virtual_work_torque
from reportgen.mechanism.motion import Motion

SAMPLES = 1440
"""Angles of a turn at which the extremes of energy are looked for: a quarter degree misses less than 1e-5."""
SAME = 1e-9
"""Angles nearer than this (rad) are one; a torque below this share of what the loads could do is none."""


def reduced_inertia(machine: Machine, motion: Motion) -> np.ndarray:
    """J_r = Σ m (v_S/ω₁)² + J (ω/ω₁)² [N] (kg·m²)."""
    total = np.zeros_like(motion.driver)
    for body in machine.linkage.inertias:
        total += body.mass * np.abs(motion.points[body.centre].v) ** 2
        total += body.moment * motion.links[body.link].omega ** 2
    return np.asarray(total / motion.rate**2)


def reduced_torque(analysis: Analysis) -> np.ndarray:
    """M_r [N] (N·m) of weights and applied loads, positive in the direction of rotation."""
    static = (*analysis.weights, *analysis.applied)
    return np.asarray(
        -analysis.machine.turn * virtual_work_torque(analysis.machine.linkage, analysis.motion, static)
    )


def _possible(analysis: Analysis) -> float:
    """The torque (N·m) of weights and loads if all acted on the fastest point and link, along their motion."""
    motion, static = analysis.motion, (*analysis.weights, *analysis.applied)
    fastest = max(float(np.abs(point.v).max()) for point in motion.points.values())
    turning = max(float(np.abs(link.omega).max()) for link in motion.links.values())
    force = sum(float(np.abs(load.force).max()) for load in static)
    couple = sum(float(np.abs(load.couple).max()) for load in static)
    return (force * fastest + couple * turning) / abs(motion.rate)


def _torque_at(machine: Machine, angle: np.ndarray) -> np.ndarray:
    return reduced_torque(analyse(machine, angle))


def flywheel(machine: Machine, unevenness: float) -> Flywheel:
    """The flywheel for the unevenness δ, over angles among which are all positions and corners of the loads."""
    whole = machine.turns * FULL_TURN
    own = np.concatenate((machine.cycle_angles, breaks(machine), [0.0, whole]))
    grid = np.linspace(0.0, whole, machine.turns * SAMPLES + 1)
    every = np.sort(np.concatenate((grid, own)))
    angle = every[np.concatenate(([True], np.diff(every) > SAME))]
    analysis = analyse(machine, angle)
    torque, least = reduced_torque(analysis), SAME * _possible(analysis)
    idle = np.abs(torque).max() <= least
    return regulate(
        angle,
        np.zeros_like(torque) if idle else torque,
        np.zeros_like(torque) if idle else accumulated(partial(_torque_at, machine), angle),
        reduced_inertia(machine, analysis.motion),
        machine.speed,
        unevenness,
    )
