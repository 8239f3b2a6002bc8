"""Base class of typesetters: a subclass for each format renders the parts of a laid-out formula."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Mapping
from typing import ClassVar, Generic, TypeVar

from reportgen.base.units import Language
from reportgen.formula import Expression, Symbol
from reportgen.formula.formula_layout import (
    Fence,
    Function,
    Grid,
    MathRow,
    Note,
    Parenthesis,
    Part,
    Quotient,
    Radical,
    Raised,
    Sign,
    Written,
    laid,
)

Look = TypeVar("Look")


class Setter(ABC, Generic[Look]):
    """Renderer of the parts of formulas in one language, as a typesetter's text, runs of a label, or a box.

    A subclass renders each `Part`; the layout is decided before, in `formula_layout`.
    """

    linear: ClassVar[bool] = False
    """True if the format allows letters in a line only: fractions with a slash, roots without a bar."""

    def __init__(self, language: Language) -> None:
        self.language: Language = language

    def math(self, node: Expression, slashed: bool = False) -> Look:
        """Return the formula of an expression.

        Raises `TypesetterError` for a `Ref` that was not substituted, or a character without a glyph.
        """
        return self.part(laid(node, self.language, slashed, self.linear))

    def content(self, content: Expression | str, slashed: bool = False) -> Look:
        """Return a formula in a line, or a plain text."""
        return self.text(content) if isinstance(content, str) else self.inline(self.math(content, slashed))

    def known(self, entry: Expression | str | None) -> Look:
        """Return an entry below a term of a vector equation: "?" if it is unknown; a fraction is set with a slash."""
        return self.content("?" if entry is None else entry, slashed=True)

    def inline(self, mathematics: Look) -> Look:
        """Return mathematics as it appears within a sentence."""
        return mathematics

    @abstractmethod
    def text(self, text: str) -> Look: ...

    @abstractmethod
    def part(self, part: Part) -> Look: ...


class TextSetter(Setter[str]):
    """Renderer to text; the patterns have "%s" for each operand."""

    BELOW: ClassVar[str] = "%s%s"
    RAISED: ClassVar[str] = "%s^%s"
    POWER: ClassVar[str] = "%s^%s"
    """Pattern for the power of a function."""
    QUOTIENT: ClassVar[str] = "(%s)/(%s)"
    RADICAL: ClassVar[str] = "√%s"
    FENCES: ClassVar[Mapping[str, str]] = {"": "%s", "(": "(%s)", "|": "|%s|", "[": "[%s]"}
    ENTRY: ClassVar[str] = "; "
    LINE: ClassVar[str] = " | "
    """Between the entries and the rows of a matrix."""
    APPLIED: ClassVar[str] = "%s%s"
    """Pattern for a function and its argument without parentheses."""
    CALL: ClassVar[str] = "%s%s"
    NOTE: ClassVar[str] = " %s"

    def part(self, part: Part) -> str:
        of = self.part
        match part:
            case Symbol():
                return self.symbol(part)
            case Written():
                return self.number(part)
            case Sign():
                return self.sign(part)
            case MathRow(parts):
                return "".join(map(of, parts))
            case Raised(base, exponent):
                return self.RAISED % (of(base), of(exponent))
            case Quotient(top, bottom):
                return self.QUOTIENT % (of(top), of(bottom))
            case Radical(inner):
                return self.RADICAL % of(inner)
            case Fence():
                return self.fence(part)
            case Function(name, exponent, to):
                function = self.function(name)
                function = self.POWER % (function, of(exponent)) if exponent else function
                return (self.CALL if isinstance(to, Fence) else self.APPLIED) % (function, of(to))
            case Grid(rows):
                return self.LINE.join(self.ENTRY.join(map(of, row)) for row in rows)
            case Note(text):
                return self.NOTE % self.text(f"({text})")
            case Parenthesis():
                return self.mark(part)

    def lowered(self, pieces: Iterable[tuple[str, str]], as_letters: Callable[[str], str]) -> str:
        """Return a symbol's letters with the digits of points as indices, no smaller than an index."""
        return "".join(
            self.BELOW % (as_letters(letters), self.upright(digits)) if digits else as_letters(letters)
            for letters, digits in pieces
        )

    def upright(self, letters: str) -> str:
        """Return letters in upright type; by default as plain text."""
        return self.text(letters)

    def fence(self, fence: Fence) -> str:
        """Return a group between its delimiters."""
        return self.FENCES[fence.left] % self.part(fence.of)

    def mark(self, mark: Parenthesis) -> str:
        """Return a parenthesis of a sum that continues over several lines."""
        return self.text(mark.of)

    @abstractmethod
    def symbol(self, node: Symbol) -> str: ...

    @abstractmethod
    def number(self, number: Written) -> str: ...

    @abstractmethod
    def sign(self, sign: Sign) -> str: ...

    @abstractmethod
    def function(self, name: str) -> str: ...
