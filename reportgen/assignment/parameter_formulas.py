"""Formulas of a machine's parameters, such as `a/2` or `L*sin(beta) + 20 mm`: parsed without being executed.

A formula has numbers, quantities with a simple unit, names of parameters, `+ - * / ^`, parentheses and the functions of
`FUNCTIONS`. Its value has a dimension, which must be that of the place where the formula is written.
"""

from __future__ import annotations

import ast
import math
import re
import warnings
from collections.abc import Callable, Mapping
from functools import lru_cache

from reportgen.base.records import Record
from reportgen.base.units import NUMBER, Dimension, Given, scale

LONGEST_FORMULA = 120
"""Largest number of characters of a formula."""
LARGEST_POWER = 4
UNITS = ("mm", "cm", "m", "deg", "rad", "N", "kN", "kg", "rpm", "s")
"""Units that a number of a formula may have; no parameter has such a name."""
_QUANTITY = re.compile(rf"(?<![\w.])({NUMBER.removeprefix('[+-]?')})\s*({'|'.join(UNITS)})(?![\w(]|\s*(?:\^|\*\*))")
"""A quantity; a power of one, such as `2 mm^2`, would be read in two ways, and needs parentheses."""
_LETTERS = re.compile(r"[A-Za-z0-9.+*/^()\s·×⋅\N{MINUS SIGN}-]*")
_SIGNS = {"·": "*", "×": "*", "⋅": "*", "\N{MINUS SIGN}": "-", "^": "**"}

PLAIN: Dimension = ()
"""The dimension of a pure number."""
ANGLE = scale("rad")[1]


class Amount(Record):
    """A value in SI units with its dimension."""

    si: float
    dimension: Dimension = PLAIN

    @classmethod
    def of(cls, given: Given) -> Amount:
        """Return a quantity as typed; one without a unit is a pure number."""
        return cls(given.si, scale(given.unit)[1] if given.unit else PLAIN)


ROUNDING = 1e-14
"""Relative rounding error of a sum or a sine. A smaller result, in proportion to its operands, counts as 0."""


def _sine(angle: float) -> float:
    return _cancelled(math.sin(angle), max(1.0, abs(angle)))


def _cosine(angle: float) -> float:
    return _cancelled(math.cos(angle), max(1.0, abs(angle)))


def _cancelled(value: float, size: float) -> float:
    """Return 0 for a value that is the rounding of operands of some size, so that cos(90 deg) is 0."""
    return 0.0 if abs(value) <= ROUNDING * size else value


def _within_one(value: float) -> float:
    """Return a sine or a cosine that rounding has led beyond 1 as 1."""
    return math.copysign(1.0, value) if 1.0 < abs(value) <= 1.0 + ROUNDING else value


OF_ANGLES, TO_ANGLES = ("sin", "cos", "tan"), ("asin", "acos", "atan")
FUNCTIONS: Mapping[str, Callable[[float], float]] = {
    "sin": _sine,
    "cos": _cosine,
    "tan": lambda angle: _sine(angle) / _cosine(angle),
    "asin": lambda sine: math.asin(_within_one(sine)),
    "acos": lambda cosine: math.acos(_within_one(cosine)),
    "atan": math.atan,
    "sqrt": math.sqrt,
    "abs": abs,
}
"""Functions of a formula; those of angles take a value in deg or rad."""
_POWERS = {"sqrt": 0.5, "abs": 1.0}
"""Functions of values with any unit, and the power of the unit that they return."""


class FormulaError(ValueError):
    """A text that is not a formula, or has no value; `code` and `arguments` name a message."""

    def __init__(self, code: str, **arguments: str) -> None:
        super().__init__(code)
        self.code = code
        self.arguments = arguments


class Formula(Record):
    """A parsed formula: its text, its tree, its quantities as typed, and the names of its parameters."""

    text: str
    tree: ast.expr
    constants: Mapping[str, Given]
    names: tuple[str, ...]

    @property
    def bare(self) -> str:
        """The parameter whose value this is, unchanged; "" if something is calculated."""
        return self.tree.id if isinstance(self.tree, ast.Name) and self.tree.id in self.names else ""

    def value(self, parameters: Mapping[str, Amount]) -> Amount:
        """Return the value for some parameters; raises `FormulaError` for units that do not fit and for no value."""
        try:
            value = self._value(self.tree, parameters)
        except (ArithmeticError, ValueError) as error:
            if isinstance(error, FormulaError):
                raise
            raise FormulaError("formula-value", text=self.text) from None
        if not math.isfinite(value.si):
            raise FormulaError("formula-value", text=self.text)
        return value

    def _value(self, node: ast.expr, parameters: Mapping[str, Amount]) -> Amount:
        match node:
            case ast.Constant(value=int(number) | float(number)):
                return Amount(float(number))
            case ast.Name(id=name):
                return Amount.of(self.constants[name]) if name in self.constants else parameters[name]
            case ast.UnaryOp(op=op, operand=inner):
                value = self._value(inner, parameters)
                return Amount(-value.si, value.dimension) if isinstance(op, ast.USub) else value
            case ast.Call(func=ast.Name(id=name), args=[argument]):
                return self._called(name, self._value(argument, parameters))
            case ast.BinOp(left=base, op=ast.Pow(), right=ast.Constant(value=int(power))):
                value = self._value(base, parameters)
                return Amount(value.si**power, _power(value.dimension, power))
            case ast.BinOp(left=left, op=op, right=right):
                return self._combined(op, self._value(left, parameters), self._value(right, parameters))
        raise AssertionError("a formula is checked when it is parsed")

    def _called(self, name: str, value: Amount) -> Amount:
        result = FUNCTIONS[name](value.si)
        if name in _POWERS:
            return Amount(result, _power(value.dimension, _POWERS[name]))
        if value.dimension != (ANGLE if name in OF_ANGLES else PLAIN):
            raise FormulaError("formula-units", text=self.text)
        return Amount(result, PLAIN if name in OF_ANGLES else ANGLE)

    def _combined(self, op: ast.operator, left: Amount, right: Amount) -> Amount:
        if isinstance(op, ast.Mult):
            return Amount(left.si * right.si, _product(left.dimension, right.dimension))
        if isinstance(op, ast.Div):
            return Amount(left.si / right.si, _product(left.dimension, _power(right.dimension, -1)))
        if left.dimension != right.dimension:
            raise FormulaError("formula-units", text=self.text)
        value = left.si + (right.si if isinstance(op, ast.Add) else -right.si)
        return Amount(_cancelled(value, abs(left.si) + abs(right.si)), left.dimension)


@lru_cache(maxsize=2000)
def formula(text: str, known: frozenset[str]) -> Formula:
    """Return the formula of a text whose parameters are among the `known` names.  Raises `FormulaError`."""
    if len(text) > LONGEST_FORMULA or not _LETTERS.fullmatch(text):
        raise FormulaError("formula-syntax", text=text)
    plain = "".join(_SIGNS.get(letter, letter) for letter in text.strip())
    constants: dict[str, Given] = {}

    def named(match: re.Match[str]) -> str:
        value, name = float(match[1]), f"_{len(constants)}"
        constants[name] = Given(value * scale(match[2])[0], value, match[2], match[0])
        return name

    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            tree = ast.parse(_QUANTITY.sub(named, plain), mode="eval").body
    except (SyntaxError, ValueError, MemoryError, RecursionError):
        raise FormulaError("formula-syntax", text=text, **_with_products(text, known)) from None
    names: list[str] = []
    _check(tree, text, known | constants.keys(), names)
    return Formula(text, tree, constants, tuple(dict.fromkeys(name for name in names if name not in constants)))


def _with_products(text: str, known: frozenset[str]) -> dict[str, str]:
    """Return the text with a `*` between each number and the parameter after it; {} if it still is not a formula."""

    def product(match: re.Match[str]) -> str:
        return f"{match[1]}*{match[2]}" if match[2] in known else match[0]

    meant = re.sub(r"(?<![\w.])(\d+(?:\.\d+)?)\s*([A-Za-z][A-Za-z0-9]*)", product, text)
    if meant == text:
        return {}
    try:
        formula(meant, known)
    except FormulaError:
        return {}
    return {"close": meant}


def _check(node: ast.expr, text: str, known: frozenset[str], names: list[str]) -> None:
    """Raise `FormulaError` for anything that no formula has; collect the names in it."""
    match node:
        case ast.Constant(value=bool()):
            pass
        case ast.Constant(value=int() | float()):
            return None
        case ast.Name(id=name):
            if name not in known:
                listed = ", ".join(sorted(one for one in known if not one.startswith("_")))
                raise FormulaError("formula-name", text=name, known=listed or "–")
            names.append(name)
            return None
        case ast.UnaryOp(op=ast.USub() | ast.UAdd(), operand=inner):
            return _check(inner, text, known, names)
        case ast.Call(func=ast.Name(id=name), args=[argument], keywords=[]) if name in FUNCTIONS:
            return _check(argument, text, known, names)
        case ast.BinOp(left=base, op=ast.Pow(), right=ast.Constant(value=int(power))) if 0 < power <= LARGEST_POWER:
            return _check(base, text, known, names)
        case ast.BinOp(left=left, op=ast.Add() | ast.Sub() | ast.Mult() | ast.Div(), right=right):
            _check(left, text, known, names)
            return _check(right, text, known, names)
    raise FormulaError("formula-syntax", text=text)


def _power(dimension: Dimension, power: float) -> Dimension:
    return tuple((unit, exponent * power) for unit, exponent in dimension)


def _product(left: Dimension, right: Dimension) -> Dimension:
    powers = dict(left)
    for unit, power in right:
        powers[unit] = powers.get(unit, 0.0) + power
    return tuple(sorted((unit, power) for unit, power in powers.items() if power))
