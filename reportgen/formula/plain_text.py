"""Formulas as plain text, v_BA = ω_2·l_AB, or as Python code, v_BA = omega_2 * l_AB."""

from __future__ import annotations

from collections.abc import Mapping

from reportgen.base.units import Language
from reportgen.formula import (
    PI,
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
    Symbol,
    VectorEquation,
)
from reportgen.formula.formula_layout import Sign, Written, known_of, written
from reportgen.formula.formula_setter import TextSetter


class Plain(TextSetter):
    """Formulas as letters in a line, with marks before indices and exponents."""

    linear = True
    APPLIED = "%s %s"

    def text(self, text: str) -> str:
        return text

    def symbol(self, node: Symbol) -> str:
        return node.base + (f"_{node.sub}" if node.sub else "") + (f"^{node.sup}" if node.sup else "")

    def number(self, number: Written) -> str:
        return self.text(number.text(" "))

    def sign(self, sign: Sign) -> str:
        return sign.text

    def function(self, name: str) -> str:
        return name


def formula(node: Expression, language: Language) -> str:
    """Return an expression in one line, with parentheses wherever it could be misread; a vector equation adds its rows.

    Raises `TypesetterError` for a `Ref` that was not substituted.
    """
    plain = Plain(language)
    if not isinstance(node, VectorEquation):
        return plain.math(node)
    known = [[plain.known(entry) for entry in known_of(term, node)] for side in node.sides for term in side]
    rows = (f"{row}: {' | '.join(cells)}" for row, cells in zip(node.rows, zip(*known, strict=True), strict=True))
    return "\n".join((plain.math(node), *rows))


def quantity(number: Number, language: Language) -> str:
    """Return a number as printed, with its unit."""
    return written(number, language).text(" ")


# --- Python -----------------------------------------------------------------------------------------

NUMPY: Mapping[str, str] = {
    **{name: f"np.{name}({{}})" for name in ("sin", "cos", "tan", "arcsin", "arccos", "arctan")},
    "ln": "np.log({})",
    "arctan2": "np.arctan2({}, {})",
    "min": "np.minimum({}, {})",
    "max": "np.maximum({}, {})",
    "abs": "np.abs({})",
    "size": "np.abs({})",
    "sign": "np.sign({})",
    "around": "np.mod({} + 1e-9, 2 * np.pi) - 1e-9",
    "amid": "np.where(({0} >= {1} - 1e-9) & ({0} < {2} - 1e-9), 1, 0)",
}
"""Functions of an expression in numpy."""


def python(node: Expression, names: Mapping[str, str]) -> str:
    """Return an expression in Python, with numpy as np and the `names` of quantities by ids.

    Raises `KeyError` for a quantity without a name and for a function that cannot be written as a formula.
    """

    def inside(part: Expression) -> str:
        text = python(part, names)
        return f"({text})" if isinstance(part, Sum | Negative) else text

    match node:
        case Number():
            return f"np.radians({node.printed:g})" if node.unit == "°" else repr(node.printed).removesuffix(".0")
        case Symbol(value=float()):
            return "np.pi" if node == PI else "np.e"
        case Ref(id):
            return names[id]
        case Sum(terms):
            parts = [python(term, names) for term in terms]
            return parts[0] + "".join(f" - {part[1:]}" if part[0] == "-" else f" + {part}" for part in parts[1:])
        case Negative(of):
            return f"-{inside(of)}"
        case Product(factors):
            return " * ".join(inside(factor) for factor in factors)
        case Fraction(top, bottom):
            below = python(bottom, names)
            return f"{inside(top)} / {below if isinstance(bottom, Ref | Number | Call | Root) else f'({below})'}"
        case Power(base, exponent):
            simple = isinstance(base, Ref | Call | Root)
            power = python(exponent, names)
            raised = f"({power})" if isinstance(exponent, Product | Fraction) else inside(exponent)
            return f"{python(base, names) if simple else f'({python(base, names)})'}**{raised}"
        case Root(of):
            return f"np.sqrt({python(of, names)})"
        case Call(name, arguments):
            return NUMPY[name].format(*(python(argument, names) for argument in arguments))
    raise KeyError(type(node).__name__)
