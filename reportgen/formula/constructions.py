"""Compass-and-ruler constructions of plane geometry.

Points and vectors are complex numbers, arrays of complex numbers over positions, or symbolic vectors: anything with
`+`, `*`, `real`, `imag` and `conjugate`. So drawing, computing and literal solutions share each formula. A `root`
function computes square roots and decides what a root that does not exist becomes.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

Value = Any
"""A size, a point or a vector; functions are indifferent to the shape."""

SquareRoot = Callable[[Value], Value]


def real_root(square: Value) -> Value:
    """Return √ of a number, 0 if it is negative: a circle that is just missed counts as touched."""
    return np.sqrt(np.maximum(square, 0.0))


def dot(a: Value, b: Value) -> Value:
    """Return a · b = aₓbₓ + a_y b_y."""
    return (a.conjugate() * b).real


def cross(a: Value, b: Value) -> Value:
    """Return a × b = aₓb_y − a_y bₓ, the component along z."""
    return (a.conjugate() * b).imag


def foot(point: Value, p: Value, u: Value) -> Value:
    """Return the foot of the perpendicular from a point on the line through p along u, of length 1."""
    return p + u * dot(u, point - p)


def meet(p: Value, u: Value, q: Value, w: Value) -> Value:
    """Return the intersection of the line through p along u with the line through q along w."""
    return p + u * cross(q - p, w) / cross(u, w)


def along_line(centre: Value, radius: Value, p: Value, u: Value, sign: Value, root: SquareRoot = real_root) -> Value:
    """Return the distance s from p along u (length 1) at which a circle meets the line: s = d·u ± √(r² − (d×u)²),
    d = c − p.

    The sign +1 takes the farther end along u.
    """
    return dot(u, centre - p) + sign * root(radius**2 - cross(u, centre - p) ** 2)


def circle_line(centre: Value, radius: Value, p: Value, u: Value, sign: Value, root: SquareRoot = real_root) -> Value:
    """Return the intersection of a circle and the line through p along u, of length 1; sign +1 is the farther one
    along u.
    """
    middle = foot(centre, p, u)
    return middle + u * (sign * root(radius**2 - abs(centre - middle) ** 2))


def circle_circle(c1: Value, r1: Value, c2: Value, r2: Value, sign: Value, root: SquareRoot = real_root) -> Value:
    """Return the intersection of two circles; sign +1 is the one to the left of the way from c1 to c2."""
    span = abs(c2 - c1)
    u = (c2 - c1) / span
    along = (r1**2 - r2**2 + span**2) / (2 * span)
    return c1 + u * (along + 1j * (sign * root(r1**2 - along**2)))
