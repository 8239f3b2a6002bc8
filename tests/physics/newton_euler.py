"""Dynamics of a planar multibody system by constraint Jacobian and multipliers: an independent witness.

It knows bodies with three coordinates each (x, y of the frame's origin and the angle θ) and joints as
constraints Φ(q, t) = 0, all in one linear system per position:

    Φ_q q̇ = −Φ_t,   Φ_q q̈ = γ,   Newton and Euler for each body with Φ_qᵀ λ as the forces of the joints.

Nothing of the package under test is imported; everything is handed over as plain numbers.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Pin:
    """Point `local_a` of body a is point `local_b` of body b."""

    a: int
    local_a: complex
    b: int
    local_b: complex


@dataclass(frozen=True)
class Slot:
    """Point `local_b` of body b stays on body a's line through `local_a` at `angle`; θ_b − θ_a = `turn`."""

    a: int
    local_a: complex
    angle: float
    b: int
    local_b: complex
    turn: float


@dataclass(frozen=True)
class Body:
    mass: float
    moment: float
    centre: complex


@dataclass(frozen=True)
class Answer:
    """Rates (ȯ, ω) and (ö, ε) per body, a wrench on b (force, couple) per joint, the driver's effort."""

    residual: float
    velocity: dict[int, tuple[complex, float]]
    acceleration: dict[int, tuple[complex, float]]
    wrenches: list[tuple[complex, float]]
    effort: float


def cross(a: complex, b: complex) -> float:
    return (np.conj(a) * b).imag


def solve(
    bodies: dict[int, Body],
    joints: list[Pin | Slot],
    turning: bool,
    rate: float,
    pose: dict[int, tuple[complex, float]],
    loads: list[tuple[int, complex, complex, float]],
    worst: float,
    acceleration: float = 0.0,
) -> Answer | None:
    """One position; None where the Jacobian's condition number is beyond `worst`.

    `loads` are (body, force, point, couple), without inertia.  The driver is body 1: its angle if
    `turning`, else the way of the first joint (a `Slot` on ground); `rate` and `acceleration` are its derivatives.
    """
    pose = {0: (0j, 0.0), **pose}
    column = {body: 3 * k for k, body in enumerate(sorted(bodies))}
    size = 3 * len(bodies)
    jacobian, phi = np.zeros((size, size)), np.zeros(size)

    def arm(body: int, local: complex) -> complex:
        return local * np.exp(1j * pose[body][1])

    def enter(row: int, body: int, direction: complex, at: complex, couple: float = 0.0) -> None:
        """d/dt of `direction`·(point of body at `at` off its origin) + couple·θ."""
        if body:
            k = column[body]
            jacobian[row, k : k + 3] += direction.real, direction.imag, cross(at, direction) + couple

    for k, joint in enumerate(joints):
        ra, rb = arm(joint.a, joint.local_a), arm(joint.b, joint.local_b)
        gap = pose[joint.b][0] + rb - pose[joint.a][0] - ra
        if isinstance(joint, Pin):
            phi[2 * k : 2 * k + 2] = gap.real, gap.imag
            for row, direction in ((2 * k, 1 + 0j), (2 * k + 1, 1j)):
                enter(row, joint.b, direction, rb)
                enter(row, joint.a, -direction, ra)
        else:
            d = arm(joint.a, np.exp(1j * joint.angle))
            phi[2 * k] = cross(d, gap)
            phi[2 * k + 1] = np.angle(np.exp(1j * (pose[joint.b][1] - pose[joint.a][1] - joint.turn)))
            enter(2 * k, joint.b, 1j * d, rb)
            enter(2 * k, joint.a, -1j * d, ra + gap)  # the point of a that lies under b's
            enter(2 * k + 1, joint.b, 0j, 0j, 1.0)
            enter(2 * k + 1, joint.a, 0j, 0j, -1.0)
    along = 0j if turning else np.exp(1j * joints[0].angle)
    enter(size - 1, 1, along, 0j, 1.0 if turning else 0.0)

    if not np.linalg.cond(jacobian) < worst:
        return None
    drive = np.zeros(size)
    drive[-1] = rate
    qd = np.linalg.solve(jacobian, drive)
    velocity = {0: (0j, 0.0)} | {b: (complex(qd[k], qd[k + 1]), float(qd[k + 2])) for b, k in column.items()}

    gamma = np.zeros(size)
    gamma[-1] = acceleration
    for k, joint in enumerate(joints):
        ra, rb = arm(joint.a, joint.local_a), arm(joint.b, joint.local_b)
        (va, wa), (vb, wb) = velocity[joint.a], velocity[joint.b]
        centripetal = -(wb**2) * rb + wa**2 * ra
        if isinstance(joint, Pin):
            gamma[2 * k : 2 * k + 2] = -centripetal.real, -centripetal.imag
        else:
            d = arm(joint.a, np.exp(1j * joint.angle))
            gap = pose[joint.b][0] + rb - pose[joint.a][0] - ra
            speed = vb + 1j * wb * rb - va - 1j * wa * ra
            gamma[2 * k] = -cross(d, centripetal) - 2 * cross(1j * wa * d, speed) + wa**2 * cross(d, gap)
    qdd = np.linalg.solve(jacobian, gamma)
    acceleration = {b: (complex(qdd[k], qdd[k + 1]), float(qdd[k + 2])) for b, k in column.items()}

    needed = np.zeros(size)
    for number, body in bodies.items():
        c = arm(number, body.centre)
        a, epsilon = acceleration[number]
        force = body.mass * (a + 1j * epsilon * c - velocity[number][1] ** 2 * c)
        k = column[number]
        needed[k : k + 3] += force.real, force.imag, cross(c, force) + body.moment * epsilon
    for number, force, point, couple in loads:
        k = column[number]
        needed[k : k + 3] -= force.real, force.imag, cross(point - pose[number][0], force) + couple
    multipliers = np.linalg.solve(jacobian.T, needed)
    wrenches = []
    for k, joint in enumerate(joints):
        first, second = multipliers[2 * k : 2 * k + 2]
        if isinstance(joint, Pin):
            wrenches.append((complex(first, second), 0.0))
        else:
            d = arm(joint.a, np.exp(1j * joint.angle))
            wrenches.append((1j * d * first, float(second)))
    return Answer(
        residual=float(np.abs(phi).max()),
        velocity=velocity,
        acceleration=acceleration,
        wrenches=wrenches,
        effort=float(multipliers[-1]),
    )
