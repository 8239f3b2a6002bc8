"""A formula as plain text: v_BA = ω_2·l_AB."""

from __future__ import annotations

from typing import ClassVar

from reportgen.notation.expressions import Expression, Number, Symbol, VectorEquation
from reportgen.notation.numbers import Language
from reportgen.notation.setting import (
    Applied,
    Fence,
    Grid,
    Note,
    Part,
    Quotient,
    Radical,
    Raised,
    Row,
    Setter,
    Sign,
    Written,
    known_of,
    written,
)


class Plain(Setter[str]):
    """Formulas as letters in a line, indices and exponents behind their marks."""

    linear = True
    gap: ClassVar[str] = " "
    """Between a line and its note."""

    def text(self, text: str) -> str:
        return text

    def part(self, part: Part) -> str:
        of = self.part
        match part:
            case Symbol():
                return self.symbol(part)
            case Written():
                return self.text(part.text(" "))
            case Sign():
                return part.text
            case Row(parts):
                return "".join(map(of, parts))
            case Raised(base, exponent):
                return of(base) + self.above(of(exponent))
            case Quotient(top, bottom):
                return f"({of(top)})/({of(bottom)})"
            case Radical(inner):
                return f"√{of(inner)}"
            case Fence(left, inner, right):
                return f"{left}{of(inner)}{right}"
            case Applied(name, exponent, to):
                return name + (self.above(of(exponent)) if exponent else "") + of(to)
            case Grid(rows):
                return " | ".join("; ".join(map(of, row)) for row in rows)
            case Note(text):
                return f"{self.gap}({self.text(text)})"

    def symbol(self, node: Symbol) -> str:
        return node.base + (f"_{node.sub}" if node.sub else "") + (f"^{node.sup}" if node.sup else "")

    def above(self, exponent: str) -> str:
        return f"^{exponent}"


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
