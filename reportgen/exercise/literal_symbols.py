"""Symbols in exercise files: r, omega, v1 with their values, and formulas of them, such as 3*r/2.

A quantity stated by a formula is evaluated at the symbols' values; the formula is kept for the literal solution.
`parsed` reads a formula.
"""

from __future__ import annotations

import ast
import math
import re
from collections.abc import Mapping
from functools import singledispatch
from typing import Any

import numpy as np

from reportgen.assignment.fields import Quantity, Reader, fault
from reportgen.base.records import Record
from reportgen.base.units import Given, QuantityFault, read_quantity
from reportgen.formula import Expression, Fraction, Negative, Number, Power, Product, Ref, Root, Sum, Symbol
from reportgen.formula.evaluation import evaluate

MOST_SYMBOLS = 20
LONGEST = 80
"""Largest length of a formula, in characters."""
MOST_NESTED = 3
"""Largest depth of nested parentheses."""
_NAME = re.compile(r"[A-Za-z]{1,10}[0-9]{0,2}")
_GREEK = {"omega": "ω", "eps": "ε", "epsilon": "ε", "rho": "ρ", "lambda": "λ", "mu": "μ"}
_UNITS = {"mm": (1, 0), "m/s": (1, -1), "m/s2": (1, -2), "rad/s": (0, -1), "rad/s2": (0, -2)}
"""The kinds of quantities, each with a unit and its powers of length and time; those of angles are 0."""

Powers = tuple[float, float]
"""Powers of length and time."""


NOTHING = Number(0.0)


class Literal(Given):
    """A quantity stated by symbols."""

    formula: Expression = NOTHING


class Substitution(Record):
    """Value of a symbol; with `put_in` False the answer stays an expression of the symbol."""

    given: Given
    powers: Powers
    put_in: bool = True


Symbols = Mapping[str, Substitution]


class SymbolValue(Reader):
    """A quantity of any kind, or {drawn: 100 mm} for a value that stays a symbol in the answer."""

    def read(self, value: object) -> Substitution:
        if isinstance(value, dict) and set(value) == {"drawn"}:
            substitution = self.read(value["drawn"])
            return Substitution(substitution.given, substitution.powers, put_in=False)
        if not isinstance(value, str):
            raise fault("wrong-type", expected="text")
        problem: QuantityFault | None = None
        for unit, powers in _UNITS.items():
            try:
                given = read_quantity(value, unit)
            except QuantityFault as one:
                problem = one
                continue
            if given.si <= 0:
                raise fault("out-of-range", text=value, range="> 0")
            return Substitution(given, powers)
        assert problem is not None
        raise fault(problem.code, **problem.arguments)

    def schema(self) -> dict[str, Any]:
        text = {"type": "string"}
        drawn = {"type": "object", "properties": {"drawn": text}, "required": ["drawn"], "additionalProperties": False}
        return {"anyOf": [text, drawn]}


class SymbolName(Reader):
    """Name of a symbol: letters, then at most two digits: r, v1, omega."""

    def read(self, value: object) -> str:
        if not isinstance(value, str) or not _NAME.fullmatch(value) or value == "sqrt":
            raise fault("symbol-name", text=str(value))
        return value

    def schema(self) -> dict[str, Any]:
        return {"type": "string", "pattern": f"^{_NAME.pattern}$"}


def _sums(nested: int) -> str:
    """Return the pattern of a formula in a file, with at most `nested` levels of parentheses."""
    number = r"(?:0|[1-9][0-9]{0,5})(?:\.[0-9]*)?|\.[0-9]+"
    name = rf"(?!sqrt\b){_NAME.pattern}(?![A-Za-z0-9])"
    inner = rf"|(?:sqrt *)?\( *{_sums(nested - 1)} *\)" if nested else ""
    factor = rf"(?:[-−] *)?(?:{number}|{name}{inner})(?: *(?:\*\*|\^) *[23](?![0-9.]))?"
    return f"{factor}(?: *[-−+*/] *{factor})*"


_WITH_A_SYMBOL = r"(?=(?:.*[^A-Za-z0-9])?(?!sqrt\b)[A-Za-z])"
FORMULA = rf"^(?=.{{1,{LONGEST}}}$){_WITH_A_SYMBOL} *{_sums(MOST_NESTED)} *$"
"""Pattern of a formula; no text matches both this and a quantity with its unit."""
_FORMULA = re.compile(FORMULA)


class Stated(Record):
    """Text of a file with symbols, before it is parsed."""

    text: str
    symbols: Symbols


class Told(Reader):
    """A quantity, as a number with its unit or as a formula of symbols."""

    by_number: Quantity

    def read(self, value: object) -> Given:
        if not isinstance(value, Stated):
            return self.by_number.read(value)
        named = any(name in value.symbols for name in _NAME.findall(value.text))
        if not named and not _FORMULA.fullmatch(value.text):
            return self.by_number.read(value.text)
        formula, powers = parsed(value.text, value.symbols)
        if powers != _UNITS[self.by_number.unit] and powers is not None:
            raise fault("wrong-unit", given=value.text, unit=self.by_number.unit)
        si = _at_values(formula, value)
        scale = read_quantity(f"1 {self.by_number.unit}", self.by_number.unit).si
        self.by_number.interval.require(si / scale, value.text, self.by_number.unit)
        return Literal(si, si / scale, self.by_number.unit, value.text, formula)

    def schema(self) -> dict[str, Any]:
        return {"anyOf": [self.by_number.schema(), {"type": "string", "pattern": FORMULA}]}


def _at_values(formula: Expression, stated_text: Stated) -> float:
    """Return the value of a formula; raise a fault if it divides by 0 or takes the root of a negative number."""
    try:
        with np.errstate(all="ignore"):
            si = float(evaluate(formula, {name: one.given.si for name, one in stated_text.symbols.items()}))
    except (ZeroDivisionError, OverflowError):
        si = math.nan
    if not math.isfinite(si):
        raise fault("not-finite", text=stated_text.text)
    return si


def si_unit(value: Substitution) -> str:
    """Return the SI unit of a symbol's value."""
    unit = next(unit for unit, powers in _UNITS.items() if powers == value.powers)
    return "m" if unit == "mm" else unit


def symbol(name: str) -> Symbol:
    """Return the printed form of a symbol: omega1 → ω with the index 1."""
    letters = name.rstrip("0123456789")
    return Symbol(_GREEK.get(letters, letters), name[len(letters) :])


# --- formulas in files ----------------------------------------------------------------------------

Parsed = tuple[Expression, Powers | None]
"""An expression over the names of symbols with its dimension; None for 0, which may have any dimension."""


def parsed(text: str, symbols: Symbols) -> Parsed:
    """Parse a formula.

    Raises a fault if the text is not a formula, names an unknown symbol, or adds quantities of different kinds.
    """
    if not _FORMULA.fullmatch(text):
        raise fault("no-formula", text=text)
    spelled = text.strip().replace("−", "-").replace("^", "**")
    # A symbol's name may be a Python keyword, such as lambda.
    marked = _NAME.sub(lambda name: name[0] if name[0] == "sqrt" else f"_{name[0]}", spelled)
    return _parsed(ast.parse(marked, mode="eval").body, text, symbols)


@singledispatch
def _parsed(node: ast.AST, text: str, symbols: Symbols) -> Parsed:
    raise fault("no-formula", text=text)


@_parsed.register
def _(node: ast.Constant, text: str, symbols: Symbols) -> Parsed:
    value = node.value
    assert isinstance(value, int | float)
    return Number(float(value)), (0, 0) if value else None


@_parsed.register
def _(node: ast.Name, text: str, symbols: Symbols) -> Parsed:
    name = node.id.removeprefix("_")
    if name not in symbols:
        raise fault("no-such-symbol", text=name, known=", ".join(symbols) or "–")
    return Ref(name), symbols[name].powers


@_parsed.register
def _(node: ast.UnaryOp, text: str, symbols: Symbols) -> Parsed:
    of, powers = _parsed(node.operand, text, symbols)
    return Negative(of), powers


@_parsed.register
def _(node: ast.Call, text: str, symbols: Symbols) -> Parsed:
    of, powers = _parsed(node.args[0], text, symbols)
    return Root(of), None if powers is None else (powers[0] / 2, powers[1] / 2)


@_parsed.register
def _(node: ast.BinOp, text: str, symbols: Symbols) -> Parsed:
    (left, first), (right, second) = (_parsed(one, text, symbols) for one in (node.left, node.right))
    match node.op:
        case ast.Add() | ast.Sub():
            if first is not None and second is not None and first != second:
                raise fault("unlike-terms", text=text)
            added = right if isinstance(node.op, ast.Add) else Negative(right)
            return Sum((left, added)), second if first is None else first
        case ast.Mult():
            whole = None if first is None or second is None else (first[0] + second[0], first[1] + second[1])
            return Product((left, right)), whole
        case ast.Div():
            powers = second or (0.0, 0.0)
            return Fraction(left, right), None if first is None else (first[0] - powers[0], first[1] - powers[1])
        case ast.Pow() if isinstance(right, Number) and right.value in (2, 3):
            size = right.value
            return Power(left, right), None if first is None else (first[0] * size, first[1] * size)
    raise fault("no-formula", text=text)


def stated(content: Any, symbols: Symbols, keys: frozenset[str]) -> Any:
    """Return the content of a file in which the texts at certain keys carry the symbols."""
    if isinstance(content, dict):
        return {
            key: _marked(part, symbols) if key in keys else stated(part, symbols, keys) for key, part in content.items()
        }
    return [stated(one, symbols, keys) for one in content] if isinstance(content, list) else content


def _marked(content: Any, symbols: Symbols) -> Any:
    if isinstance(content, list):
        return [_marked(one, symbols) for one in content]
    return Stated(content, symbols) if isinstance(content, str) else content
