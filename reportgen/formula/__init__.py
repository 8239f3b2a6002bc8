"""Expression trees that can be printed as mathematics and evaluated.

One algebra serves three readers. The *ledger* defines every quantity by an expression over other quantities
(`Ref`). The *document* prints it with symbols, then with the printed numbers. A *checker* evaluates either
(`formula.evaluation`). Passes are plain functions over the frozen nodes, so a new writer needs no new node and a
new node needs no new writer method.

    v = ω1 * R * sin(φ + β) / cos(β)
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator
from functools import partial, reduce
from operator import mul
from typing import Any, Literal, cast

from reportgen.base.records import Record, replace
from reportgen.base.units import rounded


class _Algebra(Record):
    """The arithmetic operators.

    A sum or product merges only the terms of its left operand, so that parentheses are printed where they are written.
    A minus before a product or a fraction applies to the whole of it.
    """

    __array_ufunc__ = None  # A NumPy number then leaves the operation to the expression.

    def __add__(self, other: Operand) -> Sum:
        return Sum((*_terms(self), as_expression(other)))

    def __radd__(self, other: float) -> Sum:
        return Sum((as_expression(other), _node(self)))

    def __sub__(self, other: Operand) -> Sum:
        return Sum((*_terms(self), Negative(as_expression(other))))

    def __rsub__(self, other: float) -> Sum:
        return Sum((as_expression(other), Negative(_node(self))))

    def __mul__(self, other: Operand) -> Expression:
        match self:
            case Negative(of):
                return Negative(of * as_expression(other))
            case Product(factors):
                return Product((*factors, as_expression(other)))
        return Product((_node(self), as_expression(other)))

    def __rmul__(self, other: float) -> Product:
        return Product((as_expression(other), _node(self)))

    def __truediv__(self, other: Operand) -> Expression:
        if isinstance(self, Negative):
            return Negative(Fraction(self.of, as_expression(other)))
        return Fraction(_node(self), as_expression(other))

    def __rtruediv__(self, other: float) -> Fraction:
        return Fraction(as_expression(other), _node(self))

    def __pow__(self, exponent: float) -> Power:
        return Power(_node(self), as_expression(exponent))

    def __neg__(self) -> Negative:
        return Negative(_node(self))

    def __abs__(self) -> Call:
        return Call("abs", (_node(self),))


class Symbol(_Algebra):
    """A printed symbol: base letter(s) with upright subscript and superscript.

    `over` is "vector" for an arrow above, "segment" for a bar above a length measured on a drawing. A constant such as
    π has a `value` (dimensionless); any other symbol has none and cannot be evaluated.
    """

    base: str
    sub: str = ""
    sup: str = ""
    over: Literal["", "vector", "segment"] = ""
    value: float | None = None


class Number(_Algebra):
    """A number as printed: `value` is in the printed `unit`, with `decimals` (None: exact, printed unchanged)."""

    value: float
    decimals: int | None = None
    unit: str = ""

    @property
    def printed(self) -> float:
        """The value as printed, in the number's unit: rounded to its decimals."""
        return self.value if self.decimals is None else rounded(self.value, self.decimals)

    @property
    def half_unit(self) -> float:
        """Half a unit of the last printed digit, in the number's unit; 0 for exact numbers."""
        return 0.0 if self.decimals is None else 0.5 * 10.0**-self.decimals


class Ref(_Algebra):
    """Another quantity of the ledger, by its id."""

    id: str


class Sum(_Algebra):
    """A sum; a `Negative` term is printed with a minus."""

    terms: tuple[Expression, ...]


class Product(_Algebra):
    """A product of factors, in printed order."""

    factors: tuple[Expression, ...]


class Negative(_Algebra):
    """An expression with a minus before it."""

    of: Expression


class Fraction(_Algebra):
    """A quotient of two expressions."""

    top: Expression
    bottom: Expression


class Power(_Algebra):
    """A base raised to an exponent."""

    base: Expression
    exponent: Expression


class Root(_Algebra):
    """A square root."""

    of: Expression


class Call(_Algebra):
    """A function of `evaluation.FUNCTIONS`, by its name: sin, cos, …, or a construction of plane geometry."""

    name: str
    arguments: tuple[Expression, ...]


class Matrix(_Algebra):
    """A matrix or column (rows of one entry) of a displayed equation; it has no single value."""

    rows: tuple[tuple[Expression, ...], ...]


class Chain(_Algebra):
    """A worked line: formula = substitution = result.

    `parts` are printed with "=" between them; the last is the result. `note` is a reason printed after the result
    ("since ω1 is constant"); it is never evaluated.
    """

    parts: tuple[Expression, ...]
    note: str = ""


class Term(Record):
    """A vector of a vector equation and the known facts about it.

    `known` gives, in the order of the equation's `rows` (direction, sense, size), the text or expression printed below
    the symbol; None prints "?" for an unknown. `sign` is +1 or −1.
    """

    symbol: Symbol
    known: tuple[Expression | str | None, ...] = ()
    sign: int = 1


class VectorEquation(_Algebra):
    """Sides of a vector equation joined by "="; `rows` below each term show the known facts about it."""

    sides: tuple[tuple[Term, ...], ...]
    rows: tuple[str, ...] = ()


Expression = (
    Symbol | Number | Ref | Sum | Product | Negative | Fraction | Power | Root | Call | Matrix | Chain | VectorEquation
)

Operand = Expression | float

PI = Symbol("π", value=math.pi)
E = Symbol("e", value=math.e)


# --- building -------------------------------------------------------------------------------------


def as_expression(value: Operand) -> Expression:
    """Return a node unchanged, a number as an exact `Number` without unit."""
    return Number(float(value)) if isinstance(value, (int, float)) else value


def _node(value: Any) -> Expression:
    """Return the node, cast to `Expression` for the type checker."""
    return cast(Expression, value)


def _terms(node: Any) -> tuple[Expression, ...]:
    return node.terms if isinstance(node, Sum) else (node,)


def total(terms: Iterable[Expression]) -> Expression:
    """Return the sum of terms, without merging nested sums; a single term is returned unchanged."""
    every = tuple(terms)
    return every[0] if len(every) == 1 else Sum(every)


def call(name: str, *arguments: Operand) -> Call:
    """Return a call of a function of `evaluation.FUNCTIONS`, by its name."""
    return Call(name, tuple(map(as_expression, arguments)))


def column(*entries: Operand) -> Matrix:
    """Return a column of entries."""
    return Matrix(tuple((as_expression(entry),) for entry in entries))


def sqrt(of: Operand) -> Root:
    """Return the square root of an operand."""
    return Root(as_expression(of))


def exp(of: Operand) -> Power:
    """Return e raised to a power."""
    return Power(E, as_expression(of))


OfOne = Callable[[Operand], Call]
OfTwo = Callable[[Operand, Operand], Call]

sin: OfOne = partial(call, "sin")
cos: OfOne = partial(call, "cos")
tan: OfOne = partial(call, "tan")
asin: OfOne = partial(call, "arcsin")
acos: OfOne = partial(call, "arccos")
atan: OfOne = partial(call, "arctan")
ln: OfOne = partial(call, "ln")
inv: OfOne = partial(call, "inv")
arcinv: OfOne = partial(call, "arcinv")


def signed(sense: float, of: Expression) -> Expression:
    """Return an expression unchanged if `sense` is above 0, else with the other sign.

    Only the sign of `sense` counts, in any unit.
    """
    if sense > 0:
        return of
    return of.of if isinstance(of, Negative) else Negative(of)


def size(of: Operand) -> Call:
    """Return |of| as a printed formula; the function `abs` instead denotes a length measured on a drawing."""
    return call("size", of)


def atan2(across: Operand, along: Operand) -> Call:
    """Return the direction of the vector with the components `along` x and `across` it, in (−π, π] (rad)."""
    return call("arctan2", across, along)


def branch(number: Operand, *branches: Operand) -> Call:
    """Return a call that selects one of `branches` at each position by its number, from 0.

    The printed line has the selected branch only.
    """
    return call("branch", number, *branches)


# --- sums and products without zeros ----------------------------------------------------------------

NOTHING, ONE, MINUS_ONE = map(Number, (0.0, 1.0, -1.0))


def plus(*terms: Expression) -> Expression:
    """Return the sum of terms without zeros."""
    parts = [part for term in terms for part in (term.terms if isinstance(term, Sum) else (term,)) if part != NOTHING]
    return total(parts) if parts else NOTHING


def minus(of: Expression) -> Expression:
    """Return an expression with the other sign; a sum changes the sign of each term."""
    match of:
        case Sum(terms):
            return Sum(tuple(map(minus, terms)))
        case Negative(inner):
            return inner
        case Number(value):
            return replace(of, value=-value if value else 0.0)
    return Negative(of)


def times(*factors: Expression) -> Expression:
    """Return the product of factors, simplified: 0 if one of them is 0, without factors 1; factors −1 give the sign."""
    if NOTHING in factors:
        return NOTHING
    kept = [factor for factor in factors if factor not in (ONE, MINUS_ONE)] or [ONE]
    negative = factors.count(MINUS_ONE) + sum(map(_begins_negative, kept))
    product = reduce(mul, (minus(one) if _begins_negative(one) else one for one in kept))
    return Negative(product) if negative % 2 else product


def _begins_negative(of: Expression) -> bool:
    first = of.terms[0] if isinstance(of, Sum) else of
    return isinstance(first, Negative) or (isinstance(first, Number) and first.value < 0)


def over(top: Expression, bottom: Expression) -> Expression:
    """Return the fraction top / bottom, simplified: 0 if the top is 0, and without a bottom of 1 or −1 or its minus."""
    if top == NOTHING:
        return NOTHING
    if bottom in (ONE, MINUS_ONE):
        return times(top, bottom)
    if isinstance(bottom, Negative):
        return over(minus(top), bottom.of)
    return top / bottom


def square(of: Expression) -> Expression:
    """Return the square of an expression, simplified: 0 for 0, and without a minus."""
    return NOTHING if of == NOTHING else Power(of.of if isinstance(of, Negative) else of, Number(2.0))


def between(minuend: Expression, subtrahend: Expression) -> Expression:
    """Return minuend − subtrahend, simplified; the difference of two typed angles is a number in degrees."""
    if isinstance(minuend, Number) and isinstance(subtrahend, Number):
        return Number(minuend.value - subtrahend.value, unit="°")
    return plus(minuend, NOTHING if is_zero(subtrahend) else minus(subtrahend))


def sine(of: Expression) -> Expression:
    """Return the sine of an angle; a typed multiple of 90° gives 0, 1 or −1."""
    quarters = _quarters(of)
    return sin(of) if quarters is None else Number((0.0, 1.0, 0.0, -1.0)[quarters])


def cosine(of: Expression) -> Expression:
    """Return the cosine of an angle; a typed multiple of 90° gives 0, 1 or −1."""
    quarters = _quarters(of)
    return cos(of) if quarters is None else Number((1.0, 0.0, -1.0, 0.0)[quarters])


def _quarters(angle: Expression) -> int | None:
    """Return a typed angle as a number of right angles modulo 4; None if it is not a multiple of 90°."""
    square = isinstance(angle, Number) and angle.value % 90 == 0
    return int(angle.value // 90) % 4 if isinstance(angle, Number) and square else None


def is_zero(angle: Expression) -> bool:
    """Return True if an angle is the number 0."""
    return isinstance(angle, Number) and angle.value == 0


# --- constructions: drawing and measuring, with points and vectors as complex numbers ---------------------


def meet(p: Operand, u: Operand, q: Operand, w: Operand) -> Call:
    """Return the intersection of the line through p along u with the line through q along w.

    Points are complex, in one unit, which is also the result's; u and w have any length.
    """
    return call("meet", p, u, q, w)


def circle_line(centre: Operand, radius: Operand, p: Operand, u: Operand, sign: float) -> Call:
    """Return the intersection of a circle and the line through p along u, a vector of any length.

    Points and radius are in one unit, which is also the result's. The `sign` ±1 selects the intersection; +1 is the one
    farther along u.
    """
    return call("circle_line", centre, radius, p, u, sign)


def circle_circle(c1: Operand, r1: Operand, c2: Operand, r2: Operand, sign: float) -> Call:
    """Return the intersection of two circles.

    Points and radii are in one unit, which is also the result's. The `sign` ±1 selects the intersection; +1 is the one
    to the left of the direction from c1 to c2.
    """
    return call("circle_circle", c1, r1, c2, r2, sign)


turned: OfOne = partial(call, "turned")
"""A vector turned by 90° anticlockwise."""
cross: OfTwo = partial(call, "cross")
"""The z-component of a × b."""
dot: OfTwo = partial(call, "dot")
"""The scalar product."""
cis: OfOne = partial(call, "cis")
"""The unit vector (dimensionless) at an angle (rad) from +x."""
arg: OfOne = partial(call, "arg")
"""A vector's direction from +x, in (−π, π] (rad)."""
heading: OfOne = partial(call, "heading")
"""A vector's direction from +x, in [0, 2π) (rad)."""
sign: OfOne = partial(call, "sign")
"""+1, 0 or −1."""
quotient: OfTwo = partial(call, "quotient")
"""a / b, and 0 where b is 0, for example the arm of a force that is zero."""


def unit(vector: Operand) -> Call:
    """Return a vector's direction as a vector of length 1 (dimensionless); 0 for a vector of length 0."""
    return quotient(vector, call("abs", vector))


# --- passes ---------------------------------------------------------------------------------------


def children(node: Expression) -> tuple[Expression, ...]:
    """Return the direct sub-expressions of a node, in printed order."""
    match node:
        case Sum(parts) | Product(parts) | Call(_, parts) | Chain(parts):
            return parts
        case Negative(of) | Root(of):
            return (of,)
        case Fraction(first, second) | Power(first, second):
            return (first, second)
        case Matrix(rows):
            return tuple(entry for row in rows for entry in row)
        case VectorEquation(sides):
            return tuple(term.symbol for side in sides for term in side)
        case _:
            return ()


def rebuild(node: Expression, change: Callable[[Expression], Expression]) -> Expression:
    """Return the node with `change` applied to each direct sub-expression."""
    match node:
        case Sum(parts) | Product(parts):
            return type(node)(tuple(map(change, parts)))
        case Negative(of) | Root(of):
            return type(node)(change(of))
        case Fraction(first, second) | Power(first, second):
            return type(node)(change(first), change(second))
        case Call(name, arguments):
            return Call(name, tuple(map(change, arguments)))
        case Matrix(rows):
            return Matrix(tuple(tuple(map(change, row)) for row in rows))
        case Chain(parts):
            return replace(node, parts=tuple(map(change, parts)))
        case _:
            return node


def walk(node: Expression) -> Iterator[Expression]:
    """Yield the node and everything below it, in printed order."""
    yield node
    for child in children(node):
        yield from walk(child)


def refs(node: Expression) -> tuple[str, ...]:
    """Return the ids of the quantities in an expression, each once, in order of first appearance."""
    return tuple(dict.fromkeys(part.id for part in walk(node) if isinstance(part, Ref)))


def substitute(node: Expression, change: Callable[[Ref], Expression]) -> Expression:
    """Return the expression with every `Ref` replaced by the result of `change`."""
    if isinstance(node, Ref):
        return change(node)
    return rebuild(node, lambda child: substitute(child, change))
