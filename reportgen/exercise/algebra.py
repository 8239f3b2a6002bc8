"""Symbolic algebra with sympy, for exercises whose file contains symbols; sympy is imported only then.

A `Plane` is a vector of the plane and does with symbols what a complex number does with floats, so positions, lines and
joint conditions are written once for both.  `solve` solves linear equations, `expression` converts a result for
printing.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import cache
from typing import Any

from reportgen.base.records import Record
from reportgen.formula import (
    Call,
    Expression,
    Fraction,
    Negative,
    Number,
    Power,
    Product,
    Ref,
    Root,
    Sum,
    children,
    total,
)
from reportgen.formula.evaluation import evaluate

Algebraic = Any
"""An expression of sympy."""


@cache
def _sympy() -> Any:
    import sympy

    return sympy


def symbol(name: str) -> Algebraic:
    """Return a symbol for a positive quantity."""
    return _sympy().Symbol(name, positive=True)


def exact(value: float) -> Algebraic:
    """Return a number as the fraction that was typed."""
    sp = _sympy()
    return sp.Rational(repr(value)).limit_denominator(10**12) if isinstance(value, float) else sp.sympify(value)


def exact_unit(degrees: float) -> Plane:
    """Return the unit vector at an angle (degrees); cosines and sines without a simple root stay unevaluated."""
    sp = _sympy()
    degrees = round(degrees, 9)
    if degrees % 30 == 0 or degrees % 45 == 0:
        angle = sp.pi * exact(degrees) / 180
        return Plane(sp.cos(angle), sp.sin(angle))
    radians = math.radians(degrees)
    acute = round(math.degrees(math.asin(abs(math.sin(radians)))), 9)
    cosine, sine = (symbol(f"{name} {acute:g}") for name in _NAMES)
    return Plane(cosine if math.cos(radians) > 0 else -cosine, sine if math.sin(radians) > 0 else -sine)


_NAMES = ("cos", "sin")
"""Functions of an acute angle in the names of symbols; the degrees follow."""


def _of_angle(name: str) -> Call | None:
    """Return the cosine or the sine that a symbol represents."""
    what, _, degrees = name.partition(" ")
    return Call(what, (Number(float(degrees), None, "°"),)) if what in _NAMES and degrees else None


def _pythagorean(of: Algebraic) -> Algebraic:
    """Replace sin² of every angle by 1 − cos², except under a root."""
    sp = _sympy()
    for sine in [one for one in of.free_symbols if one.name.startswith("sin ")]:
        unity = sine**2 + symbol(f"cos {sine.name[4:]}") ** 2 - 1
        parts = [sp.expand(part) for part in sp.fraction(sp.together(of))]
        if all(part.is_polynomial(sine) for part in parts):
            of = sp.rem(parts[0], unity, sine) / sp.rem(parts[1], unity, sine)
    return of


def root(of: Algebraic) -> Algebraic:
    return _sympy().sqrt(of)


class Plane(Record):
    """A vector of the plane, by its components; it multiplies as a complex number."""

    real: Algebraic
    imag: Algebraic

    @staticmethod
    def of(value: Any) -> Plane:
        if isinstance(value, Plane):
            return value
        if isinstance(value, complex):
            return Plane(exact(value.real), exact(value.imag))
        return Plane(exact(value), exact(0))

    def __add__(self, other: Any) -> Plane:
        more = Plane.of(other)
        return Plane(self.real + more.real, self.imag + more.imag)

    __radd__ = __add__

    def __neg__(self) -> Plane:
        return Plane(-self.real, -self.imag)

    def __sub__(self, other: Any) -> Plane:
        return self + -Plane.of(other)

    def __mul__(self, other: Any) -> Plane:
        by = Plane.of(other)
        return Plane(self.real * by.real - self.imag * by.imag, self.real * by.imag + self.imag * by.real)

    __rmul__ = __mul__

    def __truediv__(self, other: Algebraic) -> Plane:
        return Plane(self.real / other, self.imag / other)

    def __abs__(self) -> Algebraic:
        return root(_sympy().factor(self.real**2 + self.imag**2))

    def conjugate(self) -> Plane:
        return Plane(self.real, -self.imag)


def solve(rows: Sequence[Sequence[Algebraic]], values: Sequence[Algebraic]) -> list[Algebraic]:
    """Return the solution of linear equations, one row of factors for each; an undetermined unknown is 0.

    Raises `ValueError` if the equations contradict each other for some values of the symbols.
    """
    sp = _sympy()
    from sympy.polys.matrices import DomainMatrix

    width = len(rows[0])
    whole = [[sp.nsimplify(one) for one in (*row, value)] for row, value in zip(rows, values, strict=True)]
    field = _field([one for row in whole for one in row])
    matrix = DomainMatrix([[field.from_sympy(one) for one in row] for row in whole], (len(whole), width + 1), field)
    reduced, pivots = matrix.rref()
    if width in pivots:
        raise ValueError("the equations contradict each other")
    solution = [sp.Integer(0)] * width
    for index, pivot in enumerate(pivots):
        solution[pivot] = field.to_sympy(reduced[index, width].element)
    return solution


def _field(entries: Sequence[Algebraic]) -> Any:
    """Return the field of fractions in the symbols over the rationals and the square roots in the entries."""
    sp = _sympy()
    symbols = sorted({symbol for entry in entries for symbol in entry.free_symbols}, key=str)
    powers = {one for entry in entries for one in entry.atoms(sp.Pow) if one.exp.is_Rational and not one.exp.is_Integer}
    if any(not power.base.is_Integer or abs(power.exp) != sp.Rational(1, 2) for power in powers):
        return sp.EX
    primes = sorted({prime for power in powers for prime in sp.primefactors(power.base)})
    numbers = sp.QQ.algebraic_field(*(sp.sqrt(prime) for prime in primes)) if primes else sp.QQ
    return numbers.frac_field(*symbols) if symbols else numbers


def size(of: Algebraic, at: Mapping[str, float]) -> Algebraic:
    """Return the magnitude (SI) of a number or vector, simplified; `at` are values (SI) of the symbols, which decide
    signs.
    """
    sp = _sympy()
    if isinstance(of, Plane):
        parts = [simplified(part) for part in (of.real, of.imag)]
        nonzero = [part for part in parts if part != 0]
        of = (
            nonzero[0]
            if len(nonzero) == 1
            else sp.sqrtdenest(sp.sqrt(simplified(_pythagorean(sum(part**2 for part in parts)))))
        )
    whole = simplified(of)
    whole = whole.replace(sp.Abs, lambda inner: inner if value(inner, at) >= 0 else -inner)
    return simplified(-whole) if value(whole, at) < 0 else whole


def operations(of: Algebraic | Plane) -> int:
    """Return the number of operations in an expression, or in both components of a vector."""
    parts = (of.real, of.imag) if isinstance(of, Plane) else (of,)
    return sum(int(_sympy().count_ops(part)) for part in parts)


def simplified(of: Algebraic) -> Algebraic:
    sp = _sympy()
    whole = sp.radsimp(sp.factor(sp.radsimp(sp.together(sp.expand(of)))))
    return min((whole, sp.factor(whole), sp.factor_terms(whole)), key=sp.count_ops)


def value(of: Algebraic, at: Mapping[str, float]) -> float:
    """Return the value (SI) of an expression at values (SI) of its symbols.

    It uses floats only: sympy would examine every root, which may take minutes.
    """
    return _value(of, at).real


def _value(of: Algebraic, at: Mapping[str, float]) -> complex:
    if of.is_Symbol:
        call = _of_angle(of.name)
        return complex(at[of.name] if call is None else evaluate(call))
    if of.is_number:
        return complex(of)
    parts = [_value(one, at) for one in of.args]
    if of.is_Add:
        return sum(parts)
    if of.is_Mul:
        return math.prod(parts)
    if of.is_Pow:
        return parts[0] ** parts[1]
    return complex(of.func(*parts))


# --- to and from the expressions of the page ------------------------------------------------------


def algebraic(node: Expression, of: Callable[[str], Algebraic | None]) -> Algebraic | None:
    """Convert a printed expression, with each quantity replaced by `of` its id; None if `of` returns None for one of
    them.
    """
    sp = _sympy()
    match node:
        case Number(unit="°"):
            return sp.pi * exact(node.printed) / 180
        case Number():
            return exact(node.printed)
        case Ref(id):
            return of(id)
        case Call("cos", (Number(unit="°") as angle,)):
            return exact_unit(angle.printed).real

    parts: list[Any] = [algebraic(child, of) for child in children(node)]
    if any(part is None for part in parts):
        return None
    match node:
        case Sum():
            return sp.Add(*parts)
        case Product():
            return sp.Mul(*parts)
        case Negative():
            return -parts[0]
        case Fraction():
            return parts[0] / parts[1]
        case Power():
            return parts[0] ** parts[1]
        case Root():
            return sp.sqrt(parts[0])
        case Call("cos"):
            return sp.cos(parts[0])
    return None


def expression(of: Algebraic, at: Mapping[str, float]) -> Expression:
    """Convert to a printed expression over the names of symbols, with factors in the order of `at`.

    Differences are written so that they are positive at the values (SI) in `at`.
    """
    if of == 0:
        return Number(0.0)
    top, bottom = of.as_numer_denom()
    if bottom != 1:
        inner, below = expression(top, at), expression(bottom, at)
        negative = isinstance(inner, Negative) != isinstance(below, Negative)
        quotient = Fraction(*(one.of if isinstance(one, Negative) else one for one in (inner, below)))
        return Negative(quotient) if negative else quotient
    if of.is_Add:
        terms = [expression(one, at) for one in (of if value(of, at) >= 0 else -of).as_ordered_terms()]
        ordered = total(sorted(terms, key=lambda one: isinstance(one, Negative)))
        return ordered if value(of, at) >= 0 else Negative(ordered)
    sign, factors, order = 1, [], list(at)
    for factor in of.as_ordered_factors():
        if (factor.is_Number or factor.is_Add) and value(factor, at) < 0:
            sign, factor = -sign, -factor
        if factor != 1:
            factors.append(factor)
    factors.sort(key=lambda one: _rank(one, order))
    nodes = [*_factors(factors, at)] or [Number(1.0)]
    whole = nodes[0] if len(nodes) == 1 else Product(tuple(nodes))
    return Negative(whole) if sign < 0 else whole


NUMBER, ROOT_OF_NUMBER, SINGLE_SYMBOL, LONGER = range(4)
"""The factors of a product in the order in which they are written."""


def _rank(factor: Algebraic, order: Sequence[str]) -> tuple[int, int]:
    """Return the sort key of a factor: numbers, their roots, symbols in the order of the file, then longer
    expressions.
    """
    names = sorted(order.index(one.name) if one.name in order else len(order) for one in factor.free_symbols)
    if factor.is_Number:
        return NUMBER, 0
    if not names:
        return ROOT_OF_NUMBER, 0
    plain = factor.is_Symbol or (factor.is_Pow and factor.base.is_Symbol)
    return SINGLE_SYMBOL if plain else LONGER, names[0]


def _factors(factors: Sequence[Algebraic], at: Mapping[str, float]) -> Iterator[Expression]:
    for factor in factors:
        if factor.is_Symbol:
            yield _of_angle(factor.name) or Ref(factor.name)
        elif factor.is_Number:
            yield Number(float(factor))
        elif factor.is_Pow and factor.exp == _sympy().Rational(1, 2):
            yield Root(expression(factor.base, at))
        elif factor.is_Pow and factor.exp.is_Rational and factor.exp.q == 2:
            yield Root(Power(expression(factor.base, at), Number(float(factor.exp.p))))
        elif factor.is_Pow and factor.exp.is_Number:
            yield Power(expression(factor.base, at), Number(float(factor.exp)))
        elif factor.is_Add:
            yield expression(factor, at)
        else:
            raise ValueError(f"no way to print {factor}")
