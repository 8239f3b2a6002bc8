"""Quantities as typed in their file."""

from __future__ import annotations

from reportgen.base.units import Given
from reportgen.formula import Number

UNITS = {
    "deg": "°",
    "degree": "°",
    "N m": "N·m",
    "kg m2": "kg·m²",
    "m/s2": "m/s²",
    "rad/s2": "rad/s²",
    "N/cm2": "N/cm²",
    "N m/rad": "N·m/rad",
    "N m s": "N·m·s",
}
"""Units as printed, by their typed spelling."""


def as_typed(given: Given) -> Number:
    """Return a quantity as its file has it."""
    return Number(given.value, unit=UNITS.get(given.unit, given.unit))


def size_of(given: Given) -> Given:
    """Return a quantity without its sign."""
    return Given(abs(given.si), abs(given.value), given.unit, given.text.strip().lstrip("-−+"))
