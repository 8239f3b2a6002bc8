"""Expressions → Typst mathematics, without the dollar signs.

Names and numbers travel as string literals, so nothing in them can become markup, and every operator
stands between spaces, because identifiers of Typst may hold a hyphen.
"""

from __future__ import annotations

from collections.abc import Sequence

from reportgen.notation.expressions import Chain, Expression, Number, Symbol
from reportgen.notation.numbers import write
from reportgen.writers.layout import NAMED, PRIMES, UNSPACED, Formulas


def literal(text: str) -> str:
    """A string literal of Typst that reads back as `text`."""
    escaped = text.replace("\\", "\\\\").replace('"', '\\"')
    return '"' + escaped.replace("\n", "\\n").replace("\r", "\\r").replace("\t", "\\t") + '"'


class TypstFormulas(Formulas):
    PLUS, MINUS, NEGATIVE = "+", "−", "−"
    TIMES, DOT, CROSS = "dot.c", "dot.c", "times"
    FRACTION, RAISED, ROOT, ABSOLUTE = "frac(%s, %s)", "^(%s)", "sqrt(%s)", "abs(%s)"

    def text(self, text: str) -> str:
        return literal(text)

    def number(self, node: Number) -> str:
        digits = write(node.value, node.decimals, self.language)
        if node.unit in UNSPACED:
            return literal(digits + node.unit)
        return f"{literal(digits)} thin {literal(node.unit)}"

    def quantity(self, number: Number) -> str:
        """The plain text of a number and its unit, with a narrow unbreakable space between."""
        gap = "" if number.unit in UNSPACED else "\N{NARROW NO-BREAK SPACE}"
        return write(number.value, number.decimals, self.language) + gap + number.unit

    def symbol(self, node: Symbol) -> str:
        """A symbol with its marks: base in italics, sub- and superscript upright."""
        letters = node.base.rstrip("".join(PRIMES))
        base = letters if len(letters) == 1 and letters.isalpha() else f"italic({literal(letters)})"
        if node.over:
            base = f"{'arrow' if node.over == 'vector' else 'overline'}({base})"
        below = f"_{literal(node.sub)}" if node.sub else ""
        above = node.base[len(letters) :] + node.sup
        return base + below + (self.RAISED % _superscript(above) if above else "")

    def parentheses(self, node: Expression) -> str:
        return f"({self.math(node)})"

    def function(self, name: str) -> str:
        return name if name in NAMED else f"op({literal(name)})"

    def arguments(self, nodes: Sequence[Expression]) -> str:
        # A comma is the decimal mark in Vietnamese.
        mark = f' class("punctuation", "{";" if self.language == "vi" else ","}") '
        return f" ({mark.join(map(self.math, nodes))})"

    def matrix(self, rows: Sequence[Sequence[str]]) -> str:
        return f'mat(delim: "[", {"; ".join(map(", ".join, rows))})'

    def chain(self, node: Chain) -> str:
        return " = ".join(map(self.math, node.parts)) + self.note(node)

    def note(self, node: Expression) -> str:
        """The reason printed in parentheses after a chain's result."""
        return f" quad {literal(f'({node.note})')}" if isinstance(node, Chain) and node.note else ""


def _superscript(text: str) -> str:
    """Primes as Typst's own symbol, which has the right size, everything else upright."""
    letters = text.lstrip("".join(PRIMES))
    primes = {"′": "prime", "″": "prime.double"}
    names = [primes[char] for char in text[: len(text) - len(letters)]]
    return " ".join([*names, literal(letters)] if letters else names)
