"""Evaluate expressions, with the functions that a `Call` may name, including constructions of plane geometry.

`evaluate` takes an expression and the SI values of its `Ref`s. The functions work element by element on scalars or
arrays [..., N] over the N positions, which broadcast together, unless their docstrings say otherwise. Values are SI,
angles in rad; points and vectors are complex.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from functools import reduce

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
    plate_pose,
)
from reportgen.formula.constructions import Value

NOTHING = 1e-9
"""A value below this share of the greatest is negligible."""
UNPHYSICAL = 1e10
"""Values (SI) of this size are not compared with others. With a student's own numbers, a machine may not close at some
positions, and its rates there divide by rounding errors."""
BEHIND = 1e-12
"""Directions that differ by less (rad) count as equal."""


def circle_line(centre: Value, radius: Value, p: Value, u: Value, sign: Value) -> Value:
    """Return the intersection of a circle and the line through p along u, a vector of any length and unit.

    Points and radius have one unit, which is also the result's; the shape is the broadcast one. The `sign` +1 selects
    the intersection farther along u. A missed circle counts as touching the line.
    """
    return constructions.circle_line(centre, radius, p, u / abs(u), sign)


def nothing(value: Value) -> Value:
    """Return True where a value is negligible beside the largest of all positions: its sign would be noise.

    `value` [..., N] has any unit; the mask has the same shape. The largest size is that along the last axis, without
    nan and sizes of `UNPHYSICAL` or more. A scalar is negligible only if it is 0.
    """
    sizes = np.abs(value)
    if sizes.ndim == 0:
        return sizes == 0
    return sizes <= NOTHING * np.max(sizes, axis=-1, keepdims=True, initial=0.0, where=sizes < UNPHYSICAL)


def quotient(a: Value, b: Value) -> Value:
    """Return a / b, and 0 where b is negligible over its positions, for example the arm of a force that is zero.

    `a` and `b` broadcast to the shape of the result; its unit is the ratio of their units.
    """
    b = np.asarray(b)
    none = nothing(b)
    return np.where(none, 0.0, a / np.where(none, 1.0, b))


def sign(value: Value) -> Value:
    """Return +1 or −1 (dimensionless, same shape), and 0 for a negligible value."""
    return np.where(nothing(value), 0.0, np.sign(value))


def arg(vector: Value) -> Value:
    """Return a vector's direction from +x in (−π, π] (rad, same shape).

    A direction just above −π becomes π; a negligible vector has direction 0.
    """
    angle = np.where(nothing(vector), 0.0, np.angle(vector))
    return np.where(angle <= BEHIND - np.pi, np.pi, angle)


def single(moment: Value, force: Value) -> Value:
    """Return the distance M/F (m) at which a single force (N) has a moment (N·m).

    It is 0 where both are zero, and nan for a couple: a moment without a force. The shape is the broadcast one.
    """
    moment, force = np.asarray(moment), np.asarray(force)
    return np.where((force == 0) & (moment != 0), np.nan, quotient(moment, force))


def if_zero(a: Value, b: Value) -> Value:
    """Return b where a is exactly zero, 0 elsewhere: the couple (N·m) that remains when its force (N) vanishes.

    The result has the unit of b and the broadcast shape.
    """
    return np.where(np.asarray(a) == 0, b, 0.0)


def within(value: Value, least: Value, most: Value) -> Value:
    """Return the value where least ≤ value ≤ most, nan elsewhere.

    All three have one unit; the result has it, too, with the broadcast shape.
    """
    value = np.asarray(value)
    return np.where((value >= least) & (value <= most), value, np.nan)


def branch(number: Value, *branches: Value) -> Value:
    """Return the branch with the given number (from 0) at each position, nan for a number without a branch.

    The numbers are [N]; the branches are [N], or [..., N] with further axes in front. The result has their unit and the
    broadcast shape.
    """
    number, *shaped = np.broadcast_arrays(number, *branches)
    return np.select([number == index for index in range(len(shaped))], shaped, np.nan)


EDGE = 1e-9
"""An angle (rad) or a share that is closer than this below the end of an interval belongs to the next one."""

NEWTON_STEPS = 40
LONGEST_STEP = 0.05
"""Longest step of Newton's method on an angle (rad), so that it stays at the zero that it began at."""


def around(angle: Value) -> Value:
    """Return the angle (rad, same shape) within one turn, from 0; an angle just below a full turn counts as 0."""
    return np.mod(angle + EDGE, 2 * np.pi) - EDGE


def amid(value: Value, least: Value, most: Value) -> Value:
    """Return 1 where least ≤ value < most, 0 elsewhere (dimensionless, broadcast shape).

    All three are angles (rad) or shares; a value less than `EDGE` below a limit counts as above it.
    """
    return np.where((value >= least - EDGE) & (value < most - EDGE), 1.0, 0.0)


def beyond(value: Value, place: Value, least: Value, most: Value) -> Value:
    """Return the value where the place is not between `least` and `most`, nan where it is.

    A place of nan, as of a couple, is not between them. The place and its limits have one unit (m); the result has the
    unit of the value and the broadcast shape.
    """
    return np.where((place >= least) & (place <= most), np.nan, value)


def where_positive(value: Value, place: Value) -> Value:
    """Return the value where `place` is above 0, nan elsewhere (unit of the value, broadcast shape)."""
    return np.where(np.asarray(place) > 0, value, np.nan)


def mean(values: Value, weights: Value = 1.0) -> Value:
    """Return the weighted mean over positions: values and weights [..., N] give [..., 1], in the unit of the values.

    The weights are relative, in any unit.
    """
    values, weights = np.broadcast_arrays(np.atleast_1d(values), weights)
    return np.sum(values * weights, axis=-1, keepdims=True) / np.sum(weights, axis=-1, keepdims=True)


def level(value: Value, steps: Value) -> Value:
    """Return the mean over a cycle by the trapezoid rule: Σ ½(yₖ + yₖ₊₁) Δₖ / Σ Δₖ.

    The values are [..., N] and give [..., 1] in their unit; `steps` [N] are the distances (rad) from each position to
    the next. The first position follows the last.
    """
    mean_of_step = (np.asarray(value) + np.roll(value, -1, axis=-1)) / 2
    return np.sum(mean_of_step * steps, axis=-1, keepdims=True) / np.sum(steps)


def excess(value: Value, steps: Value) -> Value:
    """Return the integral of the value's excess over its mean, from the first position to each, by the trapezoid rule.

    The values are [..., N], the result too, with 0 at the first position; `steps` [N] are the distances (rad) from each
    position to the next. The unit is the product of both: J for a torque in N·m.
    """
    above = np.asarray(value) - level(value, steps)
    parts = (above + np.roll(above, -1, axis=-1)) / 2 * steps
    return np.roll(np.cumsum(parts, axis=-1), 1, axis=-1) - np.sum(parts, axis=-1, keepdims=True)


def along(a: Value, v: Value) -> Value:
    """Return the component a · v/|v| of a along v, 0 where v is negligible beside the largest of all positions.

    Both are vectors [..., N] of any units; the result has the unit of a and the broadcast shape.
    """
    size = np.abs(v)
    moves = size > EDGE * np.max(size, axis=-1, keepdims=True)
    return np.where(moves, constructions.dot(a, v) / np.where(moves, size, 1.0), 0.0)


def summed(value: Value, steps: Value) -> Value:
    """Return the integral from the first position to each by the trapezoid rule.

    The values are [..., N], the result too, with 0 at the first position; `steps` [N] are the distances (rad) from each
    position to the next. The unit is the product of both: s for 1/ω in s/rad.
    """
    parts = (np.asarray(value) + np.roll(value, -1, axis=-1)) / 2 * steps
    return np.roll(np.cumsum(parts, axis=-1), 1, axis=-1) * (np.arange(parts.shape[-1]) > 0)


def stepped(speed: Value, torque: Value, inertia: Value, steps: Value) -> Value:
    """Return the speed (rad/s) of a crank at each position, computed step by step from that at the first position.

    All arguments broadcast to the shape [..., N] of the result: speed (rad/s), of which only the first position is
    used, torque (N·m), reduced moment of inertia (kg·m²), and the steps (rad) from each position to the next.

    ω′ = M Δφ/(J ω) + (3J − J′)ω/(2J), from the energy equation M Δφ = Δ(J ω²)/2, to first order in the changes.
    """
    speed, torque, inertia, steps = np.broadcast_arrays(speed, torque, inertia, steps)
    at = [np.asarray(speed)[..., 0]]
    for k in range(speed.shape[-1] - 1):
        J, ω = inertia[..., k], at[-1]
        at.append(torque[..., k] * steps[..., k] / (J * ω) + (3 * J - inertia[..., k + 1]) * ω / (2 * J))
    return np.stack(at, axis=-1)


def line_area(start: Value, stop: Value, *nodes: Value) -> Value:
    """Return the area under straight lines between two places: ∫ y dx from `start` to `stop`.

    The nodes x₀, y₀, x₁, y₁, … have places in ascending order; two nodes at one place are a jump. The unit is the
    product of those of x (rad) and y; the shape is the broadcast one.
    """
    area = np.zeros(np.broadcast_shapes(np.shape(start), np.shape(stop)))
    for x0, y0, x1, y1 in zip(nodes[::2], nodes[1::2], nodes[2::2], nodes[3::2], strict=False):
        low, high = np.clip(start, x0, x1), np.clip(stop, x0, x1)
        middle = (low + high) / 2 - x0
        width = np.where(np.asarray(x1) > x0, np.asarray(x1) - x0, 1.0)
        area = area + (high - low) * (y0 + (y1 - np.asarray(y0)) * middle / width)
    return area


def line_at(place: Value, *nodes: Value) -> Value:
    """Return the height of straight lines at a place, between the nodes x₀, y₀, x₁, y₁, … as in `line_area`.

    At a jump it is the height after it; beyond the last node it is that of the last node.
    """
    height: Value = np.zeros(np.shape(place)) + nodes[-1]
    for x0, y0, x1, y1 in reversed(list(zip(nodes[::2], nodes[1::2], nodes[2::2], nodes[3::2], strict=False))):
        width = np.where(np.asarray(x1) > x0, np.asarray(x1) - x0, 1.0)
        inside = (np.asarray(place) < x1) & (np.asarray(x1) > x0)
        height = np.where(inside, y0 + (y1 - np.asarray(y0)) * (np.asarray(place) - x0) / width, height)
    return height


def crossing(near: Value, level: Value, slope: Value, *waves: Value) -> Value:
    """Return the angle (rad) next to `near` at which level + slope·φ + Σ(a cos nφ + b sin nφ) is zero.

    The waves are n₁, a₁, b₁, n₂, … The level has the unit of a and b, the slope that unit per radian; the shape is the
    broadcast one. Newton's method, with steps of at most `LONGEST_STEP`.
    """
    φ = np.asarray(near, float)
    for _ in range(NEWTON_STEPS):
        value, rate = level + slope * φ, slope + np.zeros_like(φ)
        for n, a, b in zip(waves[::3], waves[1::3], waves[2::3], strict=True):
            value = value + a * np.cos(n * φ) + b * np.sin(n * φ)
            rate = rate + n * (b * np.cos(n * φ) - a * np.sin(n * φ))
        with np.errstate(all="ignore"):
            φ = φ - np.clip(value / rate, -LONGEST_STEP, LONGEST_STEP)
    return φ


def heading(vector: Value) -> Value:
    """Return a vector's direction from +x in [0, 2π) (rad, same shape).

    A direction just below a full turn becomes 0; a negligible vector has direction 0.
    """
    return np.mod(np.where(nothing(vector), 0.0, np.angle(vector)) + BEHIND, 2 * np.pi) - BEHIND


def inv(angle: Value) -> Value:
    """Return the involute function inv α = tan α − α of an angle (rad): dimensionless, same shape."""
    return np.tan(angle) - angle


def arcinv(value: Value) -> Value:
    """Return the angle α (rad, same shape) whose involute function inv α is the value, nan for a value below 0.

    inv is convex, and α³/3 and tan α − π/2 are lower bounds of it. The smaller of the angles at which these bounds
    reach the value is therefore not below the root, and Newton's method decreases from there to the root.
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
    "ln": np.log,
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
    "plate_place": plate_pose.plate_place,
    "plate_turn": plate_pose.plate_turn,
    "turned": lambda vector: 1j * vector,
    "min": lambda *values: reduce(np.minimum, values),
    "max": lambda *values: reduce(np.maximum, values),
    "mean": mean,
    "level": level,
    "excess": excess,
    "along": along,
    "summed": summed,
    "stepped": stepped,
    "line_area": line_area,
    "line_at": line_at,
    "crossing": crossing,
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
"""Functions that a `Call` may name. sin, cos and tan take radians; `evaluate` converts a `Number` in degrees."""

TRIGONOMETRIC = frozenset({"sin", "cos", "tan"})


def evaluate(node: Expression, values: Mapping[str, Value] | None = None) -> Value:
    """Return the value of an expression; `values` gives the SI value of every `Ref` by id.

    Values are scalars or arrays that broadcast together, [N] over the positions or [cases, N]; the result has the
    broadcast shape. A printed `Number` evaluates to its rounded value in its own unit, degrees to radians. So the
    result is SI if all numbers are, and in printed units if a worked line is evaluated. A `Chain` has the value of its
    last part.

    Raises `KeyError` for an unknown id or function, and `ValueError` for a symbol without a value, a matrix or a vector
    equation.
    """
    # Searches call this function some 100,000 times, and a list is faster to build than a generator.
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
