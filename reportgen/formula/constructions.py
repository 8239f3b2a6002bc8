"""Compass-and-ruler constructions of plane geometry: projections and intersections of lines and circles.

Points and vectors are complex numbers, arrays of complex numbers over positions, or symbolic vectors: anything with
`+`, `*`, `real`, `imag` and `conjugate`. So drawing, computing and literal solutions share each formula. All arguments
of a function are of one shape or broadcast together, and the result has the broadcast shape. Points, radii and
distances of one call have the same unit (m for a mechanism, mm on paper), which is also the unit of the result.

A `root` function computes square roots and decides the result for a negative argument, where a circle is missed.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

Value = Any
"""A real size, or a complex point or vector: a scalar, an array of any shape, or a symbolic vector."""

SquareRoot = Callable[[Value], Value]
"""Square root of a real value (same shape), which also decides the result for a negative one."""


def real_root(square: Value) -> Value:
    """Return the square root of real numbers (same shape), 0 for negative ones.

    A circle that just misses a line or circle counts as touching it. The unit is the root of the argument's, for
    example m for m².
    """
    return np.sqrt(np.maximum(square, 0.0))


def dot(a: Value, b: Value) -> Value:
    """Return the scalar product a · b = aₓbₓ + a_y b_y of plane vectors, real.

    a and b broadcast to the shape of the result; its unit is the product of their units.
    """
    return (a.conjugate() * b).real


def cross(a: Value, b: Value) -> Value:
    """Return the component along z of a × b = aₓb_y − a_y bₓ of plane vectors, real.

    a and b broadcast to the shape of the result; its unit is the product of their units.
    """
    return (a.conjugate() * b).imag


def foot(point: Value, p: Value, u: Value) -> Value:
    """Return the foot of the perpendicular from a point on the line through p along u: p + u (u · (point − p)).

    `u` has length 1 and is dimensionless; the result has the unit of the points and the broadcast shape.
    """
    return p + u * dot(u, point - p)


def meet(p: Value, u: Value, q: Value, w: Value) -> Value:
    """Return the intersection of the line through p along u with the line through q along w.

    The equation is p + u ((q − p) × w)/(u × w). The vectors u and w have any length and unit; the result has the unit
    of the points and the broadcast shape. Parallel lines divide by 0.
    """
    return p + u * cross(q - p, w) / cross(u, w)


def along_line(centre: Value, radius: Value, p: Value, u: Value, sign: Value, root: SquareRoot = real_root) -> Value:
    """Return the distance s from p along u at which a circle meets the line: s = d·u ± √(r² − (d×u)²), d = c − p.

    `u` has length 1 and is dimensionless. The `sign` ±1 selects the end; +1 is the one farther along u. The result is
    real, with the unit of the points and the broadcast shape. If the circle misses the line, `root` decides.
    """
    return dot(u, centre - p) + sign * root(radius**2 - cross(u, centre - p) ** 2)


def circle_line(centre: Value, radius: Value, p: Value, u: Value, sign: Value, root: SquareRoot = real_root) -> Value:
    """Return the intersection of a circle and the line through p along u.

    `u` has length 1 and is dimensionless. The `sign` ±1 selects the intersection; +1 is the one farther along u. The
    result has the unit of the points and the broadcast shape. If the circle misses the line, `root` decides.
    """
    middle = foot(centre, p, u)
    return middle + u * (sign * root(radius**2 - abs(centre - middle) ** 2))


def circle_circle(c1: Value, r1: Value, c2: Value, r2: Value, sign: Value, root: SquareRoot = real_root) -> Value:
    """Return the intersection of two circles.

    With d = |c₂ − c₁|, u = (c₂ − c₁)/d and a = (r₁² − r₂² + d²)/(2d), it is c₁ + u (a ± j√(r₁² − a²)). The `sign` ±1
    selects it; +1 is the one to the left of the direction from c₁ to c₂. The result has the unit of the points and the
    broadcast shape. If the circles do not meet, `root` decides; circles with the same centre divide by 0.
    """
    span = abs(c2 - c1)
    u = (c2 - c1) / span
    along = (r1**2 - r2**2 + span**2) / (2 * span)
    return c1 + u * (along + 1j * (sign * root(r1**2 - along**2)))
