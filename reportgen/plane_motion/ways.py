"""Directions of the plane, as complex numbers of length 1, beside each other."""

from __future__ import annotations

SAME = 1e-9
"""Directions nearer than this (radians) are one."""


def perpendicular(one: complex, other: complex) -> bool:
    """Whether two directions are at a right angle."""
    return abs((one.conjugate() * other).real) < SAME


def parallel(one: complex, other: complex) -> bool:
    """Whether two directions are one or opposite."""
    return abs((one.conjugate() * other).imag) < SAME
