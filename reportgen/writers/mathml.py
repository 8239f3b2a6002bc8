"""Formulas as MathML Core: the part of MathML that every browser sets by itself.

Attributes hold no style, since the page's security policy lets none in; what it looks like is in the frame's CSS.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from html import escape as escaped

from reportgen.notation.expressions import Expression, Sum, Symbol, VectorEquation
from reportgen.notation.setting import (
    EQUALS,
    NARROW,
    NEGATIVE,
    PRIMES,
    Applied,
    Fence,
    Grid,
    Note,
    Part,
    Quotient,
    Radical,
    Raised,
    Role,
    Row,
    Setter,
    Sign,
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


class MathmlFormulas(Setter[str]):
    """Expressions as MathML, in one language."""

    def text(self, text: str) -> str:
        return escape(text)

    def inline(self, mathematics: str) -> str:
        return f"<math>{mathematics}</math>"

    def displayed(self, mathematics: str) -> str:
        """A piece of a displayed formula, its fractions in full size."""
        return f'<math displaystyle="true">{mathematics}</math>'

    def part(self, part: Part) -> str:
        of = self.part
        match part:
            case Symbol():
                return self.symbol(part)
            case Written(digits, unit):
                gap = NARROW if part.spaced else ""
                number = f"<mn>{escape(digits)}</mn>"
                return row(number, f"<mtext>{gap}{escape(unit)}</mtext>") if unit else number
            case Sign(sign, "slash"):
                return f"<mo>{sign}</mo>"
            case Sign(sign, "separator"):
                return f'<mo separator="true">{sign}</mo>'
            case Sign(sign, "prefix"):
                return f'<mo form="prefix">{sign}</mo>'
            case Sign(sign, role):
                before, behind = WHITE.get(role, ("", ""))
                return f'{before}<mo form="infix">{sign}</mo>{behind}'
            case Row(parts):
                return "".join(map(of, parts))
            case Raised(base, exponent):
                return f"<msup>{row(of(base))}{row(of(exponent))}</msup>"
            case Quotient(top, bottom):
                return f"<mfrac>{row(of(top))}{row(of(bottom))}</mfrac>"
            case Radical(inner):
                return f"<msqrt>{of(inner)}</msqrt>"
            case Fence("", inner):
                return row(of(inner))
            case Fence("|", inner):
                return row('<mo form="prefix">|</mo>', of(inner), '<mo form="postfix">|</mo>')
            case Fence("(", inner):
                return row(self.enclosed(part))
            case Fence():
                return self.enclosed(part)
            case Applied(name, exponent, to):
                function = f'<mi mathvariant="normal">{escape(name)}</mi>'
                if exponent:
                    function = f"<msup>{function}{row(of(exponent))}</msup>"
                argument = of(to) if isinstance(to, Fence) else row('<mspace width="0.17em"/>', of(to))
                return f"{function}<mo>&#x2061;</mo>{argument}"
            case Grid(rows):
                entries = ("".join(f"<mtd>{of(entry)}</mtd>" for entry in entries) for entries in rows)
                return f"<mtable>{''.join(f'<mtr>{row}</mtr>' for row in entries)}</mtable>"
            case Note(text):
                return f'<mspace width="1em"/><mtext>({escape(text)})</mtext>'

    def enclosed(self, fence: Fence) -> str:
        """What stands in parentheses, which are as high as it is."""
        # Browsers set white beside parentheses that may be stretched, even where they need not be.
        still = "" if is_tall(fence.of) else ' stretchy="false"'
        opening, closing = (
            f'<mo form="prefix"{still}>{fence.left}</mo>',
            f'<mo form="postfix"{still}>{fence.right}</mo>',
        )
        return row(opening, self.part(fence.of), closing)

    def symbol(self, node: Symbol) -> str:
        letters, above = parted(node)
        base = _lowered(runs(letters), _italic)
        if node.over == "vector":
            base = f'<mover accent="true">{row(base)}<mo stretchy="true">→</mo></mover>'
        marked = _scripted(base, _lowered(numbered(node.sub), _upright), _above(above))
        return f'<mrow class="bar">{marked}</mrow>' if node.over == "segment" else marked

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


def _lowered(pieces: Iterable[tuple[str, str]], shown: Callable[[str], str]) -> str:
    """Letters with the digits that stand below the last of them."""
    return "".join(
        f"<msub>{row(shown(letters))}{_upright(number)}</msub>" if number else shown(letters)
        for letters, number in pieces
    )


def _above(text: str) -> str:
    letters = text.lstrip(PRIMES)
    primes = text[: len(text) - len(letters)]
    return (f"<mo>{primes}</mo>" if primes else "") + (_upright(letters) if letters else "")


def _italic(text: str) -> str:
    return "".join(f"<mi>{escape(char)}</mi>" if char.isalpha() else f"<mtext>{escape(char)}</mtext>" for char in text)


def _upright(text: str) -> str:
    return f"<mtext>{escape(text)}</mtext>"
