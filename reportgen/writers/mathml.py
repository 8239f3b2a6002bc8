"""Formulas as MathML Core: the part of MathML that every browser sets by itself.

Attributes hold no style, since the page's security policy lets none in; what it looks like is in the frame's CSS.
"""

from __future__ import annotations

from collections.abc import Sequence
from html import escape as escaped

from reportgen.notation.expressions import Call, Chain, Expression, Number, Power, Symbol, VectorEquation
from reportgen.notation.numbers import write as written
from reportgen.notation.vocabulary import numbered, runs
from reportgen.writers.layout import ATOM, NAMED, PRIMES, UNSPACED, Formulas, short_end

EQUALS = '<mo form="infix">=</mo>'
NARROW = "\N{NARROW NO-BREAK SPACE}"
TALL = ("<mfrac", "<mtable", "<msqrt")
"""Elements that are higher than a line."""


def escape(text: str) -> str:
    """A text that reads back as typed, in an element or in an attribute in double quotes."""
    return escaped(text, quote=True)


def row(*parts: str) -> str:
    """Several elements as one."""
    return f"<mrow>{''.join(parts)}</mrow>"


class MathmlFormulas(Formulas):
    """Expressions as MathML, in one language."""

    PLUS, MINUS, NEGATIVE = '<mo form="infix">+</mo>', '<mo form="infix">−</mo>', '<mo form="prefix">−</mo>'
    TIMES, DOT, CROSS = '<mo form="infix">·</mo>', '<mo form="infix">·</mo>', '<mo form="infix">×</mo>'
    SLASH = "<mo>/</mo>"
    FRACTION = "<mfrac><mrow>%s</mrow><mrow>%s</mrow></mfrac>"
    RAISED = "%s"
    ROOT = "<msqrt>%s</msqrt>"
    ABSOLUTE = '<mrow><mo form="prefix">|</mo>%s<mo form="postfix">|</mo></mrow>'

    def content(self, content: Expression | str) -> str:
        """A formula in a line, or a plain text."""
        return self.text(content) if isinstance(content, str) else self.inline(self.math(content))

    def inline(self, mathematics: str) -> str:
        return f"<math>{mathematics}</math>"

    def displayed(self, mathematics: str) -> str:
        """A piece of a displayed formula, its fractions in full size."""
        return f'<math displaystyle="true">{mathematics}</math>'

    def math(self, node: Expression) -> str:
        match node:
            case Power(Call(name) as base, exponent) if name in NAMED:
                return self.call(base, self.math(exponent))
            case Power(base, exponent):
                return f"<msup>{row(self.tight(base, ATOM))}{row(self.math(exponent))}</msup>"
            case VectorEquation():
                return "".join(self.sign(sign) + self.symbol(term.symbol) for sign, term in self.signed(node))
            case _:
                return super().math(node)

    def tight(self, node: Expression, least: int) -> str:
        # What is written tightly is one operand, whatever it is made of.
        return row(super().tight(node, least))

    def call(self, node: Call, exponent: str = "") -> str:
        if node.name in ("abs", "size", "cross", "dot") and len(node.arguments) <= 2:
            return super().call(node)
        name = self.function(node.name)
        if exponent:
            name = f"<msup>{name}{row(exponent)}</msup>"
        return f"{name}<mo>&#x2061;</mo>{self.applied(node)}"

    def applied(self, node: Call) -> str:
        """What a function is applied to: in parentheses or, if it is one piece, behind a thin space."""
        plain = super().call(node).removeprefix(self.function(node.name))
        return row(f'<mspace width="0.17em"/>{plain.lstrip()}' if plain.startswith(" ") else plain)

    # --- symbols

    def text(self, text: str) -> str:
        return escape(text)

    def symbol(self, node: Symbol) -> str:
        letters = node.base.rstrip("".join(PRIMES))
        above = node.base[len(letters) :] + node.sup
        base = self.lettered(letters)
        if node.over == "vector":
            base = f'<mover accent="true">{row(base)}<mo stretchy="true">→</mo></mover>'
        below = self.index(node.sub) if node.sub else ""
        marked = _scripted(base, below, self._above(above))
        return f'<mrow class="bar">{marked}</mrow>' if node.over == "segment" else marked

    def _above(self, text: str) -> str:
        letters = text.lstrip("".join(PRIMES))
        primes = text[: len(text) - len(letters)]
        return (f"<mo>{primes}</mo>" if primes else "") + (self.upright(letters) if letters else "")

    def lettered(self, text: str) -> str:
        return _pieces([(self.italic(part), number) for part, number in runs(text)])

    def index(self, text: str) -> str:
        return _pieces([(self.upright(part), number) for part, number in numbered(text)])

    def italic(self, text: str) -> str:
        return "".join(
            f"<mi>{escape(char)}</mi>" if char.isalpha() else f"<mtext>{escape(char)}</mtext>" for char in text
        )

    def upright(self, text: str) -> str:
        return f"<mtext>{escape(text)}</mtext>"

    def lowered(self, text: str) -> str:
        return self.upright(text)

    # --- operands

    def number(self, node: Number) -> str:
        digits = f"<mn>{escape(written(node.value, node.decimals, self.language))}</mn>"
        if not node.unit:
            return digits
        gap = "" if node.unit in UNSPACED else NARROW
        return row(digits, f"<mtext>{gap}{escape(node.unit)}</mtext>")

    def quantity(self, number: Number) -> str:
        """The plain text of a number and its unit."""
        gap = "" if number.unit in UNSPACED else NARROW
        return escape(written(number.value, number.decimals, self.language) + gap + number.unit)

    def parentheses(self, node: Expression) -> str:
        return self.enclosed(self.math(node))

    def enclosed(self, inner: str, opening: str = "(", closing: str = ")") -> str:
        """What stands in parentheses, which are as high as it is."""
        # Browsers set white beside parentheses that may be stretched, even where they need not be.
        still = "" if any(tall in inner for tall in TALL) else ' stretchy="false"'
        return row(f'<mo form="prefix"{still}>{opening}</mo>', inner, f'<mo form="postfix"{still}>{closing}</mo>')

    def function(self, name: str) -> str:
        return f'<mi mathvariant="normal">{escape(name)}</mi>'

    def arguments(self, nodes: Sequence[Expression]) -> str:
        # A comma is the decimal mark in Vietnamese.
        mark = f'<mo separator="true">{";" if self.language == "vi" else ","}</mo>'
        inner = mark.join(map(self.math, nodes))
        return self.enclosed(inner)

    def matrix(self, rows: Sequence[Sequence[str]]) -> str:
        body = "".join(f"<mtr>{''.join(f'<mtd>{entry}</mtd>' for entry in entries)}</mtr>" for entries in rows)
        return self.enclosed(f"<mtable>{body}</mtable>", "[", "]")

    # --- lines

    def chain(self, node: Chain) -> str:
        return EQUALS.join(map(self.math, node.parts)) + self.note(node)

    def note(self, node: Expression) -> str:
        """The reason printed in parentheses after a chain's result."""
        if not (isinstance(node, Chain) and node.note):
            return ""
        return f'<mspace width="1em"/><mtext>({escape(node.note)})</mtext>'

    def broken(self, node: Expression) -> list[str]:
        """A formula in a line in the parts between which it may break: before "=", between the terms of a sum."""
        parts = node.parts if isinstance(node, Chain) else (node,)
        shown = [self.math(part) for part in parts]
        shown = [EQUALS * bool(index) + part for index, part in enumerate(shown)]
        shown[-1] += self.note(node)
        return shown

    def row(self, node: Expression) -> tuple[str, list[str]]:
        """A displayed row: what stands left of its first "=", and the pieces between which the rest may break.

        A row without a relation has nothing on its left.
        """
        parts = list(node.parts) if isinstance(node, Chain) else [node]
        pieces = [self.pieces(part) for part in parts]
        if short_end(node) and (len(pieces) > 2 or (len(pieces) == 2 and len(pieces[0]) > 1)):
            end = pieces.pop()
            pieces[-1][-1] += EQUALS + "".join(end)
        pieces[-1][-1] += self.note(node)
        first, *others = pieces
        rest = [EQUALS * (index == 0) + piece for part in others for index, piece in enumerate(part)]
        return ("".join(first), rest) if rest else ("", first)

    def columns_of(self, equation: VectorEquation) -> list[tuple[str, list[str]]]:
        """Each column of a vector equation: its term, and below it what is known of it in the equation's rows."""
        found = []
        for sign, shown, known in self.columns(equation):
            # Of a last "= 0" the sign stands as a plain letter between two terms.
            term = self.sign(sign) + shown.replace("> =", f">{EQUALS}")
            entries = [*known, *("",) * (len(equation.rows) - len(known))][: len(equation.rows)]
            found.append((term, [self.known(entry) for entry in entries]))
        return found

    def sign(self, sign: str) -> str:
        """What stands before a term of a vector equation: "", +, −, = or =−."""
        if sign == self.NEGATIVE:
            return sign
        return "".join(f'<mo form="infix">{char}</mo>' for char in sign.replace(self.NEGATIVE, "−"))


def _scripted(base: str, below: str, above: str) -> str:
    if below and above:
        return f"<msubsup>{row(base)}{row(below)}{row(above)}</msubsup>"
    if below:
        return f"<msub>{row(base)}{row(below)}</msub>"
    return f"<msup>{row(base)}{row(above)}</msup>" if above else base


def _pieces(parts: Sequence[tuple[str, str]]) -> str:
    """Letters with the digits that stand below the last of them."""
    return "".join(
        f"<msub>{row(letters)}<mtext>{escape(number)}</mtext></msub>" if number else letters
        for letters, number in parts
    )
