"""An expression as a listener draws it, who hears signs, beginnings and ends: see `spoken_reader`."""

from __future__ import annotations

import unicodedata

from reportgen.base.languages import Language, unit_names
from reportgen.base.units import by_power_of_ten, write
from reportgen.formula import (
    Call,
    Chain,
    Expression,
    Fraction,
    Matrix,
    Negative,
    Number,
    Power,
    Product,
    Root,
    Sum,
    Symbol,
    VectorEquation,
)
from tests.formula.spoken_reader import Heard, product

DIGITS = str.maketrans("₀₁₂₃₄₅₆₇₈₉", "0123456789")


def drawn(node: Expression, slashed: bool = False) -> Heard:
    """The formula of an expression; with `slashed` fractions a · b/c is (a · b)/c as well."""

    def of(node: Expression) -> Heard:
        match node:
            case Call("beyond" | "where_positive", (value, *_)):
                return of(value)
            case Symbol():
                return _symbol(node)
            case Number(value, decimals, unit) if parts := by_power_of_ten(value, decimals):
                factor = of(Number(abs(parts.factor), parts.decimals))
                ten = ("^", ("n", 10.0, ""), of(Number(float(parts.exponent))))
                large = ("*", factor, ten, *([("unit", unit)] if unit else []))
                return ("neg", large) if parts.factor < 0 else large
            case Number(value, decimals, unit):
                shown = float(write(abs(value), decimals, "en"))
                return ("neg", ("n", shown, unit)) if node.printed < 0 else ("n", shown, unit)
            case Sum(terms):
                first, *others = terms
                start = of(first)
                later = [("minus", of(term.of)) if isinstance(term, Negative) else of(term) for term in others]
                return ("+", *(start[1:] if start[0] == "+" else (start,)), *later)
            case Product(factors) if slashed:
                drawn_so_far: list[Heard] = []
                for factor in factors:
                    if isinstance(factor, Fraction):
                        drawn_so_far = [("/", product([*drawn_so_far, of(factor.top)]), of(factor.bottom))]
                    else:
                        drawn_so_far.append(of(factor))
                return product(drawn_so_far)
            case Product(factors):
                return product([of(factor) for factor in factors])
            case Negative(inner):
                return ("neg", of(inner))
            case Fraction(top, bottom):
                return ("/", of(top), of(bottom))
            case Power(base, exponent):
                return ("^", of(base), of(exponent))
            case Root(inner):
                return ("root", of(inner))
            case Call("abs" | "size", (inner,)):
                return ("abs", of(inner))
            case Call("cross" | "dot", (left, right)):
                return product([of(left), of(right)])
            case Call(name, arguments):
                return ("call", name, *map(of, arguments))
            case Matrix(rows):
                return ("matrix", *(tuple(map(of, row)) for row in rows))
            case Chain(parts):
                return ("=", *map(of, parts)) if len(parts) > 1 else of(parts[0])
            case VectorEquation(sides):
                lines = [_line([(term.sign, of(term.symbol)) for term in side]) for side in sides]
                return ("=", *lines) if len(lines) > 1 else lines[0]
        raise TypeError(type(node).__name__)

    return of(node)


def _line(terms: list[tuple[int, Heard]]) -> Heard:
    """A side of a vector equation, of terms with their signs."""
    (sign, first), *others = terms
    later = [("minus", term) if sign < 0 else term for sign, term in others]
    start = ("neg", first) if sign < 0 else first
    return ("+", start, *later) if later else start


def _symbol(node: Symbol) -> Heard:
    """Its letters with those below and primes, then what else stands above."""
    base = node.base.replace("′′", "″")
    letters = base.rstrip("′″")
    above = (base[len(letters) :] + node.sup).replace("′′", "″")
    marks = above.lstrip("′″")
    flat = letters + node.sub + above.removesuffix(marks) if marks else letters + node.sub + above
    heard = unicodedata.normalize("NFD", flat.translate(DIGITS))
    if " " in heard:
        name, _, argument = heard.rpartition(" ")
        return ("call", name, ("s", node.over, argument, marks))
    if heard.isdigit() and not node.over:
        return ("n", float(heard), "")
    return ("neg", ("s", node.over, heard[1:], marks)) if heard[0] == "−" else ("s", node.over, heard, marks)


def in_units(formula: Heard, language: Language) -> Heard:
    """A formula with its units as a language writes them, м/с for m/s."""
    if not isinstance(formula, tuple):
        return formula
    *parts, last = formula
    if parts and parts[0] in ("n", "unit"):
        return (*parts, unit_names(language).get(last))
    return tuple(in_units(part, language) for part in formula)


def opened(formula: Heard) -> Heard:
    """A formula in which 1/c · (a + …), as a fraction too wide for its line is set, is (a + …)/c again."""
    if not isinstance(formula, tuple):
        return formula
    parts = tuple(map(opened, formula))
    if parts[0] != "*":
        return parts
    factors: list[Heard] = []
    for part in parts[1:]:
        last = factors[-1] if factors else ("",)
        if part[0] == "+" and last[0] == "/" and last[1] == ("n", 1.0, ""):
            factors[-1] = ("/", part, last[2])
        else:
            factors.append(part)
    return product(factors)
