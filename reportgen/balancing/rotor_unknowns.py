"""Rotors with other unknowns than two whole corrections: the place of plane B, or two masses at given angles.

Complete balance gives four equations: Σ U = 0 and Σ U (z − z_A) = 0, with U = m r e^{iα}. Checks and scales of plans
need the solution before the ledger has it.
"""

from __future__ import annotations

import cmath

from reportgen.balancing.rotor_file import Parameters, RotorMass
from reportgen.base.records import Record

PARALLEL = 1e-9
"""Two directions with a smaller sine of the angle between them have no intersection."""


def cross(a: complex, b: complex) -> float:
    return (a.conjugate() * b).imag


def unbalance(mass: RotorMass) -> complex:
    """Return m r e^{iα} (kg·m)."""
    return mass.m.si * cmath.rect(mass.r.si, mass.angle.si)


class UnknownPlane(Record):
    """The corrections (kg·m) in plane A at a given angle and in plane B, and the place of B from A (m, signed)."""

    near: float
    far: complex
    distance: float


def unknown_plane(given: Parameters) -> UnknownPlane | None:
    """Return the corrections with the place of plane B; None if no plane balances the rotor.

    `near` is 0 if the correction in B balances it alone.

    With the sum F of all m r and the sum M of their moments about A: F + U_A e + U_B = 0, M + U_B L = 0.
    """
    known = given.known_angle
    if known is None:
        return None
    e = cmath.rect(1, known.si)
    masses = [(unbalance(mass), mass.z.si - given.planes.A.si) for mass in given.masses]
    F, M = sum(U for U, _ in masses), sum(U * z for U, z in masses)
    every = sum(abs(U) for U, _ in masses)
    if abs(cross(e, M)) <= PARALLEL * sum(abs(U * z) for U, z in masses):
        return None
    near = -cross(F, M) / cross(e, M)
    far = -(F + near * e)
    if abs(far) <= PARALLEL * every:
        return None
    near = 0.0 if abs(near) <= PARALLEL * every else near
    return UnknownPlane(near, far, -(M.conjugate() * far).real / abs(far) ** 2)


def unknown_masses(given: Parameters) -> dict[str, float] | None:
    """Return m r (kg·m, signed) of both unknown masses, by their places; None if their moments have one direction."""
    (first, near), (second, far) = given.sought_masses.items()
    M = sum(
        (unbalance(mass) * (mass.z.si - given.planes.A.si) for mass in given.masses if not mass.is_sought), start=0j
    )
    arms = [mass.z.si - given.planes.A.si for mass in (near, far)]
    e, w = (cmath.rect(1, mass.angle.si) for mass in (near, far))
    if abs(cross(e, w)) <= PARALLEL or not all(arms):
        return None
    parts = cross(M, w), cross(e, M)
    if min(map(abs, parts)) <= PARALLEL * abs(M):
        return {first: 0.0, second: 0.0}
    return {first: -parts[0] / cross(e, w) / arms[0], second: -parts[1] / cross(e, w) / arms[1]}
