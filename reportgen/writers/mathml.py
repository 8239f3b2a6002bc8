"""Formulas as MathML Core: the part of MathML that every browser sets by itself.

Attributes hold no style, since the page's security policy lets none in; what it looks like is in the frame's CSS.
"""

from __future__ import annotations

from collections.abc import Mapping
from html import escape as escaped

from reportgen.notation.expressions import Expression, Sum, Symbol, VectorEquation
from reportgen.notation.setting import (
    EQUALS,
    NARROW,
    NEGATIVE,
    PRIMES,
    Fence,
    Role,
    Row,
    Sign,
    Source,
    Written,
    columns,
    displayed,
    is_tall,
    laid,
    parted,
    pieces,
    sides,
)
from reportgen.notation.vocabulary import numbered, runs

WHITE: Mapping[Role, tuple[str, str]] = {"sum": (" ", " "), "product": (" ", " "), "bound": ("", " ")}
"""Before and behind a sign; no page shows it, but text that is copied has it."""


def escape(text: str) -> str:
    """A text that reads back as typed, in an element or in an attribute in double quotes."""
    return escaped(text, quote=True)


def row(*parts: str) -> str:
    """Several elements as one."""
    return f"<mrow>{''.join(parts)}</mrow>"


class MathmlFormulas(Source):
    """Expressions as MathML, in one language."""

    BELOW = "<msub><mrow>%s</mrow>%s</msub>"
    RAISED = "<msup><mrow>%s</mrow><mrow>%s</mrow></msup>"
    POWER = "<msup>%s<mrow>%s</mrow></msup>"
    QUOTIENT, RADICAL = "<mfrac><mrow>%s</mrow><mrow>%s</mrow></mfrac>", "<msqrt>%s</msqrt>"
    ENTRY, LINE = "</mtd><mtd>", "</mtd></mtr><mtr><mtd>"
    CALL = "%s<mo>&#x2061;</mo>%s"
    APPLIED = '%s<mo>&#x2061;</mo><mrow><mspace width="0.17em"/>%s</mrow>'
    NOTE = '<mspace width="1em"/><mtext>%s</mtext>'

    def text(self, text: str) -> str:
        return escape(text)

    def upright(self, letters: str) -> str:
        return f"<mtext>{escape(letters)}</mtext>"

    def inline(self, mathematics: str) -> str:
        return f"<math>{mathematics}</math>"

    def displayed(self, mathematics: str) -> str:
        """A piece of a displayed formula, its fractions in full size."""
        return f'<math displaystyle="true">{mathematics}</math>'

    def number(self, number: Written) -> str:
        digits = f"<mn>{escape(number.digits)}</mn>"
        gap = NARROW if number.spaced else ""
        return row(digits, f"<mtext>{gap}{escape(number.unit)}</mtext>") if number.unit else digits

    def sign(self, sign: Sign) -> str:
        match sign.role:
            case "slash":
                return f"<mo>{sign.of}</mo>"
            case "separator":
                return f'<mo separator="true">{sign.of}</mo>'
            case "prefix":
                return f'<mo form="prefix">{sign.of}</mo>'
        before, behind = WHITE.get(sign.role, ("", ""))
        return f'{before}<mo form="infix">{sign.of}</mo>{behind}'

    def function(self, name: str) -> str:
        return f'<mi mathvariant="normal">{escape(name)}</mi>'

    def fence(self, fence: Fence) -> str:
        """What stands in parentheses, which are as high as it is."""
        inner = self.part(fence.of)
        match fence.left:
            case "":
                return row(inner)
            case "[":
                inner = f"<mtable><mtr><mtd>{inner}</mtd></mtr></mtable>"
        # Browsers set white beside parentheses that may be stretched, even where they need not be.
        still = ' stretchy="false"' if fence.left == "(" and not is_tall(fence.of) else ""
        opening, closing = (
            f'<mo form="prefix"{still}>{fence.left}</mo>',
            f'<mo form="postfix"{still}>{fence.right}</mo>',
        )
        enclosed = row(opening, inner, closing)
        return row(enclosed) if fence.left == "(" else enclosed

    def symbol(self, node: Symbol) -> str:
        letters, above = parted(node)
        base = self.lowered(runs(letters), _italic)
        if node.over == "vector":
            base = f'<mover accent="true">{row(base)}<mo stretchy="true">→</mo></mover>'
        marked = _scripted(base, self.lowered(numbered(node.sub), self.upright), self.above(above))
        return f'<mrow class="bar">{marked}</mrow>' if node.over == "segment" else marked

    def above(self, text: str) -> str:
        letters = text.lstrip(PRIMES)
        primes = text[: len(text) - len(letters)]
        return (f"<mo>{primes}</mo>" if primes else "") + (self.upright(letters) if letters else "")

    # --- lines

    def broken(self, node: Expression) -> list[str]:
        """A formula in a line in the parts between which it may break: before "=", between the terms of a sum."""
        if isinstance(node, Sum):
            return [self.part(piece).lstrip() for piece in pieces(laid(node, self.language))]
        first, *others = sides(node, self.language)
        return [self.part(first), *(self.part(Row((EQUALS, side))) for side in others)]

    def row(self, node: Expression) -> tuple[str, list[str]]:
        """A displayed row: what stands left of its first "=", and the pieces between which the rest may break.

        A row without a relation has nothing on its left.
        """
        first, *others = ([self.part(piece).lstrip() for piece in side] for side in displayed(node, self.language))
        equals = self.part(EQUALS)
        rest = [equals * (index == 0) + piece for side in others for index, piece in enumerate(side)]
        return ("".join(first), rest) if rest else ("", first)

    def columns(self, equation: VectorEquation) -> list[tuple[str, list[str]]]:
        """Each column of a vector equation: its term, and below it what is known of it in the equation's rows."""
        return [
            (self.leading(one.signs) + self.part(one.term), list(map(self.known, one.known)))
            for one in columns(equation)
        ]

    def leading(self, signs: tuple[Sign, ...]) -> str:
        """What stands before a term in its column: a minus alone is that of the term."""
        form = "prefix" if [sign.of for sign in signs] == [NEGATIVE.of] else "infix"
        return "".join(f'<mo form="{form}">{sign.of}</mo>' for sign in signs)


def _scripted(base: str, below: str, above: str) -> str:
    if below and above:
        return f"<msubsup>{row(base)}{row(below)}{row(above)}</msubsup>"
    if below:
        return f"<msub>{row(base)}{row(below)}</msub>"
    return f"<msup>{row(base)}{row(above)}</msup>" if above else base


def _italic(text: str) -> str:
    return "".join(f"<mi>{escape(char)}</mi>" if char.isalpha() else f"<mtext>{escape(char)}</mtext>" for char in text)
