"""The twin engine by hand: closed formulas over all positions at once, the yardstick of the solver's speed.

Nothing here comes from the package: one slider-crank under a vertical cylinder, twice.  θ is the angle
of its crank pin from +x and α that of its rod:  L cos α = −R cos θ,  α′ = −λ sin θ/sin α,
α″ = (−λ cos θ − α′² cos α)/sin α,  both from L cos α + R cos θ = 0 differentiated.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from reportgen.base.arrays import Complexes, Floats


@dataclass(frozen=True, slots=True)
class Cylinder:
    """One rod with its piston; `offset` is its pin's angle on the crank, `phase` its cycle angle at φ = 0."""

    offset: float
    phase: float
    rod_mass: float
    rod_moment: float
    piston_mass: float


@dataclass(frozen=True, slots=True)
class Engine:
    """Lengths (m), `start` angle and signed speed `omega` of the crank, and the gas: rows of Pa over s/H."""

    radius: float
    rod: float
    share: float
    """AS2/AB."""
    area: float
    gravity: float
    start: float
    omega: float
    fractions: tuple[float, ...]
    rows: tuple[tuple[float, ...], ...]
    cylinders: tuple[Cylinder, ...]


@dataclass(frozen=True, slots=True)
class Side:
    """What one cylinder does over positions [N]: motion, gas force, reactions on rod and piston."""

    pin: tuple[Complexes, Complexes, Complexes]
    centre: tuple[Complexes, Complexes, Complexes]
    piston: tuple[Floats, Floats, Floats]
    angle: Floats
    omega: Floats
    epsilon: Floats
    gas: Floats
    crank_on_rod: Complexes
    piston_on_rod: Complexes
    wall_on_piston: Floats


@dataclass(frozen=True, slots=True)
class Solved:
    """Both cylinders, the bearing's force on the crank, and the balancing torque two ways [N]."""

    sides: tuple[Side, ...]
    bearing: Complexes
    torque: Floats
    torque_by_work: Floats


def solve(engine: Engine, cycle_angle: Floats) -> Solved:
    """Motion and forces at cycle angles [N] that grow with the rotation."""
    sides = tuple(_side(engine, cylinder, cycle_angle) for cylinder in engine.cylinders)
    torque = sum(_cross(side.pin[0], side.crank_on_rod) for side in sides)
    power = sum(_power(engine, cylinder, side) for cylinder, side in zip(engine.cylinders, sides, strict=True))
    bearing = sum(side.crank_on_rod for side in sides)
    return Solved(sides, np.asarray(bearing), np.asarray(torque), np.asarray(-power / engine.omega))


def _side(engine: Engine, cylinder: Cylinder, cycle_angle: Floats) -> Side:
    radius, rod, share, omega = engine.radius, engine.rod, engine.share, engine.omega
    theta = engine.start + np.sign(omega) * (cycle_angle + cylinder.offset)
    cos, sin, ratio = np.cos(theta), np.sin(theta), radius / rod
    cos_rod = -ratio * cos
    sin_rod = np.sqrt(1 - cos_rod**2)
    first = -ratio * sin / sin_rod
    second = (-ratio * cos - first**2 * cos_rod) / sin_rod
    turning, rising = omega * first, omega**2 * second

    pin = radius * (cos + 1j * sin)
    pin_v, pin_a = 1j * omega * pin, -(omega**2) * pin
    arm = rod * (cos_rod + 1j * sin_rod)
    arm_v, arm_a = 1j * turning * arm, (1j * rising - turning**2) * arm
    centre = (pin + share * arm, pin_v + share * arm_v, pin_a + share * arm_a)
    piston = (pin.imag + arm.imag, pin_v.imag + arm_v.imag, pin_a.imag + arm_a.imag)

    gas = engine.area * _pressure(engine, cylinder, cycle_angle, piston[0])
    down = -gas - cylinder.piston_mass * (engine.gravity + piston[2])
    load = -cylinder.rod_mass * (1j * engine.gravity + centre[2])
    couple = -cylinder.rod_moment * rising
    wall = (cos_rod * down + (share * _cross(arm, load) + couple) / rod) / sin_rod
    from_piston = wall + 1j * down
    return Side(
        (pin, pin_v, pin_a),
        centre,
        piston,
        np.arccos(cos_rod),
        turning,
        rising,
        gas,
        -load - from_piston,
        from_piston,
        wall,
    )


def _pressure(engine: Engine, cylinder: Cylinder, cycle_angle: Floats, height: Floats) -> Floats:
    """Gauge pressure (Pa) [N]; rounding just below a dead centre counts as the stroke that begins there."""
    fraction = (engine.radius + engine.rod - height) / (2 * engine.radius)
    stroke = np.floor((cycle_angle + cylinder.phase) / np.pi + 1e-9).astype(int) % 4
    rows = [np.interp(fraction, engine.fractions, row) for row in engine.rows]
    return np.choose(stroke, rows)


def _power(engine: Engine, cylinder: Cylinder, side: Side) -> Floats:
    """Power of weights, inertia and gas of one cylinder (W) [N]."""
    load = cylinder.rod_mass * (1j * engine.gravity + side.centre[2])
    down = side.gas + cylinder.piston_mass * (engine.gravity + side.piston[2])
    rod = np.real(np.conj(load) * side.centre[1]) + cylinder.rod_moment * side.epsilon * side.omega
    return -(rod + down * side.piston[1])


def _cross(a: Complexes, b: Complexes) -> Floats:
    return a.real * b.imag - a.imag * b.real
