"""Evaluate expressions: the functions that a `Call` may name, including constructions of plane geometry."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping

import numpy as np

from reportgen.formula import (
    Call,
    Chain,
    Expression,
    Fraction,
    Negative,
    Number,
    Power,
    Product,
    Ref,
    Root,
    Sum,
    Symbol,
    constructions,
)
from reportgen.formula.constructions import Value

NOTHING = 1e-9
"""A value below this share of the greatest is negligible."""
UNPHYSICAL = 1e10
"""No machine has such values (SI): a machine with a student's own numbers may not go together at some positions, where
its rates divide by rounding errors.  They are no measure of the others."""
BEHIND = 1e-12
"""Directions that differ by less (rad) are one."""


def circle_line(centre: Value, radius: Value, p: Value, u: Value, sign: Value) -> Value:
    """Return the intersection of a circle and the line through p along u, a vector of any length."""
    return constructions.circle_line(centre, radius, p, u / abs(u), sign)


def nothing(value: Value) -> Value:
    """Return True where a value is negligible beside the greatest of all positions (last axis): its sign would be
    noise.
    """
    sizes = np.abs(value)
    if sizes.ndim == 0:
        return sizes == 0
    return sizes <= NOTHING * np.max(sizes, axis=-1, keepdims=True, initial=0.0, where=sizes < UNPHYSICAL)


def quotient(a: Value, b: Value) -> Value:
    """Return a / b, and 0 where b is negligible: the arm of a force that is zero."""
    b = np.asarray(b)
    none = nothing(b)
    return np.where(none, 0.0, a / np.where(none, 1.0, b))


def sign(value: Value) -> Value:
    """Return +1 or −1, and 0 for a negligible value."""
    return np.where(nothing(value), 0.0, np.sign(value))


def arg(vector: Value) -> Value:
    """Return a vector's direction from +x, in (−π, π], one just above −π counted as π; 0 for a negligible vector."""
    angle = np.where(nothing(vector), 0.0, np.angle(vector))
    return np.where(angle <= BEHIND - np.pi, np.pi, angle)


def single(moment: Value, force: Value) -> Value:
    """Return the distance M/F of the one force that has this moment: 0 where both are zero, nan for a couple."""
    moment, force = np.asarray(moment), np.asarray(force)
    return np.where((force == 0) & (moment != 0), np.nan, quotient(moment, force))


def if_zero(a: Value, b: Value) -> Value:
    """Return b where a is zero, 0 elsewhere: the couple that remains when its force vanishes."""
    return np.where(np.asarray(a) == 0, b, 0.0)


def within(value: Value, least: Value, most: Value) -> Value:
    """Return the value itself, nan where it is less than `least` or more than `most`."""
    value = np.asarray(value)
    return np.where((value >= least) & (value <= most), value, np.nan)


def branch(number: Value, *branches: Value) -> Value:
    """Return the branch with the given number (from 0) at each position; numbers [N], branches with any axes in
    front of theirs.
    """
    number, *shaped = np.broadcast_arrays(number, *branches)
    return np.select([number == index for index in range(len(shaped))], shaped, np.nan)


EDGE = 1e-9
"""An angle (rad) or a share closer than this below an edge belongs to the next interval."""


def around(angle: Value) -> Value:
    """Return the angle within one turn from 0; one just below a whole turn is 0."""
    return np.mod(angle + EDGE, 2 * np.pi) - EDGE


def amid(value: Value, least: Value, most: Value) -> Value:
    """Return 1 from `least` up to `most`, 0 elsewhere."""
    return np.where((value >= least - EDGE) & (value < most - EDGE), 1.0, 0.0)


def beyond(value: Value, place: Value, least: Value, most: Value) -> Value:
    """Return the value where the place, which a couple lacks, does not lie between `least` and `most`; nan
    elsewhere.
    """
    return np.where((place >= least) & (place <= most), np.nan, value)


def where_positive(value: Value, place: Value) -> Value:
    """Return the value where another one is above 0, nan elsewhere."""
    return np.where(np.asarray(place) > 0, value, np.nan)


def mean(values: Value, weights: Value = 1.0) -> Value:
    """Return the mean over positions (last axis); the axis is kept with length 1."""
    values, weights = np.broadcast_arrays(np.atleast_1d(values), weights)
    return np.sum(values * weights, axis=-1, keepdims=True) / np.sum(weights, axis=-1, keepdims=True)


def level(value: Value, steps: Value) -> Value:
    """Return the mean over a cycle by the trapezoid rule, `steps` being the ways from each position to the next."""
    mean_of_step = (np.asarray(value) + np.roll(value, -1, axis=-1)) / 2
    return np.sum(mean_of_step * steps, axis=-1, keepdims=True) / np.sum(steps)


def excess(value: Value, steps: Value) -> Value:
    """Return the integral of the excess over the mean, from the first position to each, by the trapezoid rule."""
    above = np.asarray(value) - level(value, steps)
    parts = (above + np.roll(above, -1, axis=-1)) / 2 * steps
    return np.roll(np.cumsum(parts, axis=-1), 1, axis=-1) - np.sum(parts, axis=-1, keepdims=True)


def along(a: Value, v: Value) -> Value:
    """Return the component of a along v; 0 where v is negligible beside the greatest of all positions."""
    size = np.abs(v)
    moves = size > EDGE * np.max(size, axis=-1, keepdims=True)
    return np.where(moves, constructions.dot(a, v) / np.where(moves, size, 1.0), 0.0)


def summed(value: Value, steps: Value) -> Value:
    """Return the integral from the first position to each, by the trapezoid rule."""
    parts = (np.asarray(value) + np.roll(value, -1, axis=-1)) / 2 * steps
    return np.roll(np.cumsum(parts, axis=-1), 1, axis=-1) * (np.arange(parts.shape[-1]) > 0)


def stepped(speed: Value, torque: Value, inertia: Value, steps: Value) -> Value:
    """Return the speed of a crank from position to position, from that at the first, with torque and inertia at each.

    ω′ = M Δφ/(J ω) + (3J − J′)ω/(2J): the equation of energy, ΔT = M Δφ, with Δ(J ω²)/2 to the first order.
    """
    speed, torque, inertia, steps = np.broadcast_arrays(speed, torque, inertia, steps)
    at = [np.asarray(speed)[..., 0]]
    for k in range(speed.shape[-1] - 1):
        J, ω = inertia[..., k], at[-1]
        at.append(torque[..., k] * steps[..., k] / (J * ω) + (3 * J - inertia[..., k + 1]) * ω / (2 * J))
    return np.stack(at, axis=-1)


def heading(vector: Value) -> Value:
    """Return a vector's direction from +x, in [0, 2π), one just below a full turn counted as 0; 0 for a
    negligible one.
    """
    return np.mod(np.where(nothing(vector), 0.0, np.angle(vector)) + BEHIND, 2 * np.pi) - BEHIND


def inv(angle: Value) -> Value:
    """Return the involute of an angle (rad): inv α = tan α − α."""
    return np.tan(angle) - angle


def arcinv(value: Value) -> Value:
    """Return the angle α (rad) of which inv α is the value, `nan` below 0.

    inv is convex and both α³/3 and tan α − π/2 lie below it, so Newton's way from the lesser of their angles goes down.
    """
    value = np.asarray(value, float)
    with np.errstate(invalid="ignore", divide="ignore"):
        value = np.where(value < 0, np.nan, value)
        angle = np.minimum(np.cbrt(3 * value), np.arctan(value + np.pi / 2))
        for _ in range(8):
            angle = np.where(angle > 0, angle - (inv(angle) - value) / np.tan(angle) ** 2, angle)
    return angle


FUNCTIONS: Mapping[str, Callable[..., Value]] = {
    "sin": np.sin,
    "cos": np.cos,
    "tan": np.tan,
    "arcsin": np.arcsin,
    "arccos": np.arccos,
    "arctan": np.arctan,
    "arctan2": np.arctan2,
    "abs": np.abs,
    "size": np.abs,
    "sign": sign,
    "re": np.real,
    "im": np.imag,
    "arg": arg,
    "heading": heading,
    "cis": lambda angle: np.exp(1j * np.asarray(angle)),
    "cross": constructions.cross,
    "dot": constructions.dot,
    "meet": constructions.meet,
    "circle_line": circle_line,
    "circle_circle": constructions.circle_circle,
    "turned": lambda vector: 1j * vector,
    "min": np.minimum,
    "max": np.maximum,
    "mean": mean,
    "level": level,
    "excess": excess,
    "along": along,
    "summed": summed,
    "stepped": stepped,
    "highest": lambda value: np.max(value, axis=-1, keepdims=True),
    "lowest": lambda value: np.min(value, axis=-1, keepdims=True),
    "quotient": quotient,
    "single": single,
    "if_zero": if_zero,
    "within": within,
    "beyond": beyond,
    "where_positive": where_positive,
    "branch": branch,
    "around": around,
    "amid": amid,
    "inv": inv,
    "arcinv": arcinv,
}
"""Functions that a `Call` may name. sin, cos and tan take radians; a `Number` in degrees converts itself."""

TRIGONOMETRIC = frozenset({"sin", "cos", "tan"})


def evaluate(node: Expression, values: Mapping[str, Value] | None = None) -> Value:
    """Return the value of an expression; `values` gives that of every `Ref` by id.

    Printed numbers evaluate as shown, degrees as radians.  Raises `KeyError` for an unknown id and
    `ValueError` for a symbol without a value.
    """
    # Searches run this a hundred thousand times, and a list is ready sooner than a generator.
    match node:
        case Number():
            return math.radians(node.printed) if node.unit == "°" else node.printed
        case Ref(id):
            if values is None:
                raise KeyError(id)
            return values[id]
        case Symbol(value=value):
            if value is None:
                raise ValueError(f"symbol {node.base} has no value")
            return value
        case Sum(terms):
            return sum([evaluate(term, values) for term in terms])
        case Product(factors):
            return math.prod([evaluate(factor, values) for factor in factors], start=1.0)
        case Negative(of):
            return -evaluate(of, values)
        case Fraction(top, bottom):
            return evaluate(top, values) / evaluate(bottom, values)
        case Power(base, exponent):
            return evaluate(base, values) ** evaluate(exponent, values)
        case Root(of):
            return np.sqrt(evaluate(of, values))
        case Call(name, arguments):
            return FUNCTIONS[name](*[evaluate(argument, values) for argument in arguments])
        case Chain(parts):
            return evaluate(parts[-1], values)
        case _:
            raise ValueError(f"a {type(node).__name__} has no single value")
