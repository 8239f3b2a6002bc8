"""Plane vectors in formulas, by their components along x and y.

e is the unit vector at an angle, n = ie the one square to it, 90° anticlockwise.
"""

from __future__ import annotations

import math

from reportgen.formula import NOTHING, Expression, Number, cosine, minus, plus, sine, times

VectorComponents = tuple[Expression, Expression]
"""A vector by its components."""
STILL: VectorComponents = (NOTHING, NOTHING)


def add(*vectors: VectorComponents) -> VectorComponents:
    return plus(*(x for x, _ in vectors)), plus(*(y for _, y in vectors))


def less(p: VectorComponents, q: VectorComponents) -> VectorComponents:
    return add(p, (minus(q[0]), minus(q[1])))


def scaled(factor: Expression, vector: VectorComponents) -> VectorComponents:
    return times(factor, vector[0]), times(factor, vector[1])


def turned(vector: VectorComponents) -> VectorComponents:
    """Return the vector turned by 90° anticlockwise."""
    return minus(vector[1]), vector[0]


# --- directions -----------------------------------------------------------------------------------


def degrees(angle: float) -> Number:
    """Return a typed angle (rad) as a number in degrees for a formula."""
    return Number(as_typed(math.degrees(angle)), unit="°")


def as_typed(value: float) -> float:
    """Return a number without the rounding error of its conversion to SI."""
    return float(f"{value:.13g}") + 0.0


def along(angle: Expression) -> VectorComponents:
    """Return the unit vector e at an angle."""
    return cosine(angle), sine(angle)


def on(vector: VectorComponents, angle: Expression) -> Expression:
    """Return the projection on e at an angle."""
    e = along(angle)
    return plus(times(vector[0], e[0]), times(vector[1], e[1]))


def across(vector: VectorComponents, angle: Expression) -> Expression:
    """Return the projection on n, square to e at an angle."""
    e = along(angle)
    return plus(times(vector[1], e[0]), minus(times(vector[0], e[1])))


def typed(place: complex) -> VectorComponents:
    """Return a typed place (m) as components for formulas."""
    return Number(as_typed(place.real)), Number(as_typed(place.imag))
