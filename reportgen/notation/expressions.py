"""Expressions that both render and evaluate.

One small algebra serves three readers.  The *ledger* defines every quantity by an expression over
other quantities (`Ref`); the *document* shows it with symbols, then with the printed numbers; a
*checker* evaluates either.  Passes (`substitute`, `refs`, `evaluate`) are plain functions over the
frozen nodes, so a new writer needs no new node and a new node needs no new writer method.

Geometric calls (`meet`, `circle_line`, `circle_circle`) stand for what a plan solves by drawing; they
take and give points of the plane as complex numbers.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np

from reportgen.notation.numbers import printed

Value = Any
"""A float, a complex number, or an array of either: every pass is indifferent to the shape."""


@dataclass(frozen=True, slots=True)
class Symbol:
    """A printed symbol: base letter(s) with upright subscript and superscript.

    `over` is "vector" for an arrow above, "segment" for a bar above a length measured on a drawing.
    A constant such as π carries its `value`; any other symbol evaluates only by name.
    """

    base: str
    sub: str = ""
    sup: str = ""
    over: Literal["", "vector", "segment"] = ""
    value: float | None = None


@dataclass(frozen=True, slots=True)
class Number:
    """A number as printed: `value` is in `unit`, shown with `decimals` (None: exact, shown as it is)."""

    value: float
    decimals: int | None = None
    unit: str = ""

    @property
    def shown(self) -> float:
        """The value a reader of the page sees."""
        return self.value if self.decimals is None else printed(self.value, self.decimals)

    @property
    def half_unit(self) -> float:
        """Half a unit of the last printed digit; 0 for exact numbers."""
        return 0.0 if self.decimals is None else 0.5 * 10.0**-self.decimals


@dataclass(frozen=True, slots=True)
class Ref:
    """Another quantity of the ledger, by its id."""

    id: str


@dataclass(frozen=True, slots=True)
class Sum:
    terms: tuple[Expression, ...]


@dataclass(frozen=True, slots=True)
class Product:
    factors: tuple[Expression, ...]


@dataclass(frozen=True, slots=True)
class Negative:
    of: Expression


@dataclass(frozen=True, slots=True)
class Fraction:
    top: Expression
    bottom: Expression


@dataclass(frozen=True, slots=True)
class Power:
    base: Expression
    exponent: Expression


@dataclass(frozen=True, slots=True)
class Root:
    of: Expression


@dataclass(frozen=True, slots=True)
class Call:
    """A named function of `FUNCTIONS`: sin, cos, …, or a geometric construction."""

    name: str
    arguments: tuple[Expression, ...]


@dataclass(frozen=True, slots=True)
class Matrix:
    """A matrix, or with rows of one entry a column, of a displayed equation; it has no single value."""

    rows: tuple[tuple[Expression, ...], ...]


@dataclass(frozen=True, slots=True)
class Chain:
    """formula = substitution = result, as one printed line.

    `parts` are shown joined by "="; the last is the result.  `note` is a word of reason after the
    result ("since ω1 is constant"); it is never evaluated.
    """

    parts: tuple[Expression, ...]
    note: str = ""


@dataclass(frozen=True, slots=True)
class Term:
    """One vector of a vector equation and what is known of it.

    `known` gives, in the order of the equation's `rows` (direction, sense, size), the text or
    expression printed below the symbol; None prints as the mark of an unknown, "?".
    """

    symbol: Symbol
    known: tuple[Expression | str | None, ...] = ()
    sign: int = 1


@dataclass(frozen=True, slots=True)
class VectorEquation:
    """Sides of a vector equation joined by "="; under each term its line of `rows` says what is known."""

    sides: tuple[tuple[Term, ...], ...]
    rows: tuple[str, ...] = ()


Expression = (
    Symbol
    | Number
    | Ref
    | Sum
    | Product
    | Negative
    | Fraction
    | Power
    | Root
    | Call
    | Matrix
    | Chain
    | VectorEquation
)

PI = Symbol("π", value=math.pi)


# --- building -------------------------------------------------------------------------------------


def as_expression(value: Expression | float | int | str) -> Expression:
    """A node as it is; a number as an exact `Number`; a string as a `Ref`."""
    if isinstance(value, str):
        return Ref(value)
    if isinstance(value, (int, float)):
        return Number(float(value))
    return value


def add(*terms: Expression | float | str) -> Expression:
    return Sum(tuple(as_expression(term) for term in terms))


def subtract(first: Expression | float | str, *others: Expression | float | str) -> Expression:
    return Sum((as_expression(first), *(Negative(as_expression(other)) for other in others)))


def multiply(*factors: Expression | float | str) -> Expression:
    return Product(tuple(as_expression(factor) for factor in factors))


def divide(top: Expression | float | str, bottom: Expression | float | str) -> Expression:
    return Fraction(as_expression(top), as_expression(bottom))


def power(base: Expression | float | str, exponent: Expression | float) -> Expression:
    return Power(as_expression(base), as_expression(exponent))


def negative(of: Expression | float | str) -> Expression:
    return Negative(as_expression(of))


def column(*entries: Expression | float | str) -> Matrix:
    return Matrix(tuple((as_expression(entry),) for entry in entries))


def call(name: str, *arguments: Expression | float | str) -> Expression:
    return Call(name, tuple(as_expression(argument) for argument in arguments))


# --- geometry of the plane ------------------------------------------------------------------------


def cross(a: Value, b: Value) -> Value:
    """z-component of a × b for plane vectors as complex numbers."""
    return np.imag(np.conj(a) * b)


def dot(a: Value, b: Value) -> Value:
    """Scalar product of plane vectors as complex numbers."""
    return np.real(np.conj(a) * b)


def meet(p: Value, u: Value, q: Value, w: Value) -> Value:
    """Where the line through p along u meets the line through q along w."""
    return p + u * cross(q - p, w) / cross(u, w)


def circle_line(centre: Value, radius: Value, p: Value, u: Value, sign: Value) -> Value:
    """Where the circle meets the line through p along u; sign +1 takes the farther end along u."""
    u = u / np.abs(u)
    foot = p + u * dot(centre - p, u)
    return foot + sign * u * np.sqrt(radius**2 - np.abs(centre - foot) ** 2 + 0j).real


def circle_circle(c1: Value, r1: Value, c2: Value, r2: Value, sign: Value) -> Value:
    """Where two circles meet; sign +1 takes the point to the left of the way from c1 to c2."""
    span = np.abs(c2 - c1)
    along = (r1**2 - r2**2 + span**2) / (2 * span)
    across = np.sqrt(r1**2 - along**2 + 0j).real
    return c1 + (c2 - c1) / span * (along + 1j * sign * across)


def quotient(a: Value, b: Value) -> Value:
    """a / b, and 0 where b is nothing: the arm of a force that is not there."""
    b = np.asarray(b)
    return np.where(b == 0, 0.0, a / np.where(b == 0, 1.0, b))


def if_zero(a: Value, b: Value) -> Value:
    """b where a is nothing, 0 elsewhere: the couple that remains when its force vanishes."""
    return np.where(np.asarray(a) == 0, b, 0.0)


def within(value: Value, least: Value, most: Value) -> Value:
    """The value itself, nan where it is less than `least` or more than `most`."""
    value = np.asarray(value)
    return np.where((value >= least) & (value <= most), value, np.nan)


def mean(values: Value) -> Value:
    """The mean over positions, the last axis; it keeps that axis, so that it stands for all of them."""
    return np.mean(np.atleast_1d(values), axis=-1, keepdims=True)


def heading(vector: Value) -> Value:
    """A vector's direction from +x, in [0, 2π); rounding just below a full turn counts as 0."""
    return np.mod(np.angle(vector) + 1e-12, 2 * np.pi) - 1e-12


FUNCTIONS: Mapping[str, Callable[..., Value]] = {
    "sin": np.sin,
    "cos": np.cos,
    "tan": np.tan,
    "arcsin": np.arcsin,
    "arccos": np.arccos,
    "arctan": np.arctan,
    "arctan2": np.arctan2,
    "abs": np.abs,
    "sign": np.sign,
    "re": np.real,
    "im": np.imag,
    "arg": np.angle,
    "heading": heading,
    "cis": lambda angle: np.exp(1j * np.asarray(angle)),
    "cross": cross,
    "dot": dot,
    "meet": meet,
    "circle_line": circle_line,
    "circle_circle": circle_circle,
    "turned": lambda vector: 1j * vector,
    "min": np.minimum,
    "max": np.maximum,
    "mean": mean,
    "quotient": quotient,
    "if_zero": if_zero,
    "within": within,
}
"""What a `Call` may name.  sin, cos and tan take radians; a `Number` in degrees converts itself."""

TRIGONOMETRIC = frozenset({"sin", "cos", "tan"})


# --- passes ---------------------------------------------------------------------------------------


def children(node: Expression) -> tuple[Expression, ...]:
    """The direct sub-expressions of a node, in printed order."""
    match node:
        case Sum(terms):
            return terms
        case Product(factors):
            return factors
        case Negative(of) | Root(of):
            return (of,)
        case Fraction(top, bottom):
            return (top, bottom)
        case Power(base, exponent):
            return (base, exponent)
        case Call(_, arguments):
            return arguments
        case Matrix(rows):
            return tuple(entry for row in rows for entry in row)
        case Chain(parts):
            return parts
        case VectorEquation(sides):
            return tuple(term.symbol for side in sides for term in side)
        case _:
            return ()


def rebuild(node: Expression, change: Callable[[Expression], Expression]) -> Expression:
    """The node with `change` applied to each direct sub-expression."""
    match node:
        case Sum(terms):
            return Sum(tuple(map(change, terms)))
        case Product(factors):
            return Product(tuple(map(change, factors)))
        case Negative(of):
            return Negative(change(of))
        case Root(of):
            return Root(change(of))
        case Fraction(top, bottom):
            return Fraction(change(top), change(bottom))
        case Power(base, exponent):
            return Power(change(base), change(exponent))
        case Call(name, arguments):
            return Call(name, tuple(map(change, arguments)))
        case Matrix(rows):
            return Matrix(tuple(tuple(map(change, row)) for row in rows))
        case Chain(parts):
            return replace(node, parts=tuple(map(change, parts)))
        case _:
            return node


def walk(node: Expression) -> Iterator[Expression]:
    """The node and everything below it, in printed order."""
    yield node
    for child in children(node):
        yield from walk(child)


def refs(node: Expression) -> tuple[str, ...]:
    """Ids of the quantities an expression stands on, each once, in order of first appearance."""
    return tuple(dict.fromkeys(part.id for part in walk(node) if isinstance(part, Ref)))


def substitute(node: Expression, change: Callable[[Ref], Expression]) -> Expression:
    """The expression with every `Ref` replaced by what `change` gives for it."""
    if isinstance(node, Ref):
        return change(node)
    return rebuild(node, lambda child: substitute(child, change))


def evaluate(node: Expression, values: Mapping[str, Value] | None = None) -> Value:
    """The value of an expression; `values` gives that of every `Ref` by id.

    Printed numbers evaluate as shown, degrees as radians.  Raises `KeyError` for an unknown id and
    `ValueError` for a symbol without a value.
    """
    match node:
        case Number():
            return math.radians(node.shown) if node.unit == "°" else node.shown
        case Ref(id):
            if values is None:
                raise KeyError(id)
            return values[id]
        case Symbol(value=value):
            if value is None:
                raise ValueError(f"symbol {node.base} has no value")
            return value
        case Sum(terms):
            return sum(evaluate(term, values) for term in terms)
        case Product(factors):
            result: Value = 1.0
            for factor in factors:
                result = result * evaluate(factor, values)
            return result
        case Negative(of):
            return -evaluate(of, values)
        case Fraction(top, bottom):
            return evaluate(top, values) / evaluate(bottom, values)
        case Power(base, exponent):
            return evaluate(base, values) ** evaluate(exponent, values)
        case Root(of):
            return np.sqrt(evaluate(of, values))
        case Call(name, arguments):
            return FUNCTIONS[name](*(evaluate(argument, values) for argument in arguments))
        case Chain(parts):
            return evaluate(parts[-1], values)
        case _:
            raise ValueError(f"a {type(node).__name__} has no single value")
