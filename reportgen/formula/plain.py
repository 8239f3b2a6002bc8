"""A formula as plain text: v_BA = ω_2·l_AB."""

from __future__ import annotations

from reportgen.base.units import Language
from reportgen.formula import Expression, Number, Symbol, VectorEquation
from reportgen.formula.setting import Sign, TextSetter, Written, known_of, written


class Plain(TextSetter):
    """Formulas as letters in a line, indices and exponents behind their marks."""

    linear = True

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
    """An expression in one line, parentheses wherever it would be misread; below a vector equation what is known.

    Raises `TypesetterError` for a reference that nobody has substituted.
    """
    plain = Plain(language)
    if not isinstance(node, VectorEquation):
        return plain.math(node)
    known = [[plain.known(entry) for entry in known_of(term, node)] for side in node.sides for term in side]
    rows = (f"{row}: {' | '.join(cells)}" for row, cells in zip(node.rows, zip(*known, strict=True), strict=True))
    return "\n".join((plain.math(node), *rows))


def quantity(number: Number, language: Language) -> str:
    """A number as printed, with its unit."""
    return written(number, language).text(" ")
