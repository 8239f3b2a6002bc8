"""Expressions for what is drawn and measured: points of the plane, their lengths, directions and crossings.

Each stands for a function of `evaluation.FUNCTIONS`; points and vectors are complex numbers.
"""

from __future__ import annotations

from reportgen.notation.expressions import Call, Operand, call


def meet(p: Operand, u: Operand, q: Operand, w: Operand) -> Call:
    """Where the line through p along u meets the line through q along w."""
    return call("meet", p, u, q, w)


def circle_line(centre: Operand, radius: Operand, p: Operand, u: Operand, sign: float) -> Call:
    """Where a circle meets the line through p along u: the farther end along u for sign +1."""
    return call("circle_line", centre, radius, p, u, sign)


def circle_circle(c1: Operand, r1: Operand, c2: Operand, r2: Operand, sign: float) -> Call:
    """Where two circles meet: to the left of the way from c1 to c2 for sign +1."""
    return call("circle_circle", c1, r1, c2, r2, sign)


def turned(vector: Operand) -> Call:
    """A vector turned by 90° anticlockwise."""
    return call("turned", vector)


def cross(a: Operand, b: Operand) -> Call:
    """The z-component of a × b."""
    return call("cross", a, b)


def dot(a: Operand, b: Operand) -> Call:
    """The scalar product."""
    return call("dot", a, b)


def cis(angle: Operand) -> Call:
    """The unit vector at an angle from +x."""
    return call("cis", angle)


def arg(vector: Operand) -> Call:
    """A vector's direction from +x, in (−π, π]."""
    return call("arg", vector)


def heading(vector: Operand) -> Call:
    """A vector's direction from +x, in [0, 2π)."""
    return call("heading", vector)


def sign(of: Operand) -> Call:
    """+1, 0 or −1."""
    return call("sign", of)


def quotient(a: Operand, b: Operand) -> Call:
    """a / b, and 0 where b is 0: the arm of a force that is not there."""
    return call("quotient", a, b)
