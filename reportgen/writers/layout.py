"""Decisions that all writers share: how formulas are put together, and what breaks must not separate."""

from __future__ import annotations

import re
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace
from itertools import groupby
from typing import ClassVar

from reportgen.document.tree import Block, Equation, List, PageBreak, Paragraph, Plate, Table, plain
from reportgen.errors import TypesetterError
from reportgen.figures.metrics import box
from reportgen.figures.scene import Scene
from reportgen.notation.expressions import (
    Call,
    Chain,
    Expression,
    Fraction,
    Matrix,
    Negative,
    Number,
    Power,
    Product,
    Ref,
    Root,
    Sum,
    Symbol,
    Term,
    VectorEquation,
)
from reportgen.notation.numbers import Language
from reportgen.notation.vocabulary import numbered, runs

TEXT_WIDTH = 160.0
"""Of the A4 text block, mm."""
SCENE_GAP = 4.0
"""Between scenes side by side, mm."""
ABREAST = 8.0
"""Between two short rows of an equation side by side, mm."""
TEXT_SIZE = 12.0
"""Of running text and formulas, points."""
WHOLE_TABLE = 12
"""A table with no more rows than this is kept on one page."""
TOGETHER = 3
"""A longer table has at least this many rows on each of its pages."""
UNIT = re.compile(r"\b([A-Za-zµ]{1,3}[²³]?/\(?[A-Za-zµ·²³]{1,8}\)?)")
"""A unit with a slash inside a text."""

TITLE = 5.0
"""What the titles of a row of scenes take below it (mm)."""
LONG_FIGURE = 110.0
"""A figure of several rows that is higher than this (mm) may break between them; its caption then comes first."""
Column = tuple[str, str, tuple[Expression | str | None, ...]]
"""Of a vector equation: the sign before a term, the term itself, what is known of it."""

# --- formulas -------------------------------------------------------------------------------------

RELATION, SUM, PRODUCT, QUOTIENT, MARKED, ATOM = range(6)
"""Levels of binding, the loosest first; MARKED is an atom that already carries a unit or superscript."""

PRIMES = ("′", "″")
NAMED = frozenset({"sin", "cos", "tan", "arcsin", "arccos", "arctan", "min", "max", "arg"})
"""Functions that typesetters know by name; any other prints its own name upright."""
UNSPACED = ("", "°", "%")
"""Units that follow their number without a space."""


class Formulas(ABC):
    """Expressions as the mathematics of one typesetter, in one language.

    What operations look like stands in the constants of a subclass, operands in the places of "%s".
    """

    PLUS: ClassVar[str]
    MINUS: ClassVar[str]
    NEGATIVE: ClassVar[str]
    """The sign of a single negative; `MINUS` stands between two terms and may carry a line break."""
    TIMES: ClassVar[str]
    DOT: ClassVar[str]
    CROSS: ClassVar[str]
    FRACTION: ClassVar[str]
    SLASH: ClassVar[str]
    RAISED: ClassVar[str]
    ROOT: ClassVar[str]
    ABSOLUTE: ClassVar[str]

    def __init__(self, language: Language, slashed: bool = False) -> None:
        self.language: Language = language
        self.slashed = slashed
        """Whether fractions are written in the line, a/b."""

    def content(self, content: Expression | str) -> str:
        """A formula in dollar signs, or a plain text."""
        return self.text(content) if isinstance(content, str) else f"${self.math(content)}$"

    def math(self, node: Expression) -> str:
        """The formula of an expression, without dollar signs.

        Raises `TypesetterError` for a reference that nobody has substituted, or a character without a glyph.
        """
        match node:
            case Symbol():
                return self.symbol(node)
            case Number():
                return self.number(node)
            case Ref(id):
                raise TypesetterError(f"quantity {id!r} came to the page without its symbol or value")
            case Sum() | Product():
                return " ".join(self.pieces(node))
            case Negative(of):
                return self.NEGATIVE + self.tight(of, PRODUCT)
            case Fraction(top, bottom) if self.slashed:
                return f"{self.tight(top, PRODUCT)}{self.SLASH}{self.tight(bottom, ATOM)}"
            case Fraction(top, bottom):
                return self.FRACTION % (self.math(top), self.math(bottom))
            case Power(Call(name) as base, exponent) if name in NAMED:
                return self.call(base, self.RAISED % self.math(exponent))
            case Power(base, exponent):
                return self.tight(base, ATOM) + self.RAISED % self.math(exponent)
            case Root(of):
                return self.ROOT % self.math(of)
            case Call():
                return self.call(node)
            case Matrix(rows):
                return self.matrix([[self.math(entry) for entry in row] for row in rows])
            case Chain():
                return self.chain(node)
            case VectorEquation():
                return " ".join(f"{sign} {self.symbol(term.symbol)}" for sign, term in self.signed(node))

    def pieces(self, node: Expression) -> list[str]:
        """A formula's pieces, between which a displayed line may break: terms of a sum, factors of a product."""
        match node:
            case Sum(terms):
                return [self.math(term) if index == 0 else self._term(term) for index, term in enumerate(terms)]
            case Product(factors):
                first, *others = (self.tight(factor, PRODUCT) for factor in factors)
                return [first, *(f"{self.TIMES} {factor}" for factor in others)]
            case Negative(Product() as of):
                first, *others = self.pieces(of)
                return [self.NEGATIVE + first, *others]
            case _:
                return [self.math(node)]

    def _term(self, term: Expression) -> str:
        if isinstance(term, Negative):
            return f"{self.MINUS} {self.tight(term.of, PRODUCT)}"
        return f"{self.PLUS} {self.tight(term, PRODUCT)}"

    def tight(self, node: Expression, least: int) -> str:
        """The node, in parentheses if it binds less tightly than `least`."""
        return self.math(node) if level(node) >= least else self.parentheses(node)

    def call(self, node: Call, exponent: str = "") -> str:
        match node.name, node.arguments:
            case (("abs" | "size"), (argument,)):
                return self.ABSOLUTE % self.math(argument)
            case ("cross" | "dot") as product, (left, right):
                sign = self.CROSS if product == "cross" else self.DOT
                return f"{self.tight(left, QUOTIENT)} {sign} {self.tight(right, QUOTIENT)}"
            case name, (argument,) if name in NAMED and level(argument) >= MARKED:
                return f"{self.function(name)}{exponent} {self.math(argument)}"
            case name, arguments:
                return f"{self.function(name)}{exponent}{self.arguments(arguments)}"

    def columns(self, equation: VectorEquation) -> list[Column]:
        """The columns of a vector equation: what is printed before a term, the term, what is known of it.

        A last "= 0", of which nothing is known, stands with the term before it: no row is broken between them.
        """
        found: list[Column] = []
        for sign, term in self.signed(equation):
            if found and sign.startswith("=") and not any(entry != "" for entry in term.known):
                before, shown, known = found[-1]
                found[-1] = before, f"{shown} {sign} {self.symbol(term.symbol)}", known
            else:
                found.append((sign, self.symbol(term.symbol), term.known))
        return found

    def known(self, entry: Expression | str | None) -> str:
        """What is known of a vector, in the row below its term: "?" for nothing; a fraction keeps to the line."""
        return type(self)(self.language, slashed=True).content("?" if entry is None else entry)

    def signed(self, equation: VectorEquation) -> Iterator[tuple[str, Term]]:
        """Each term with what is printed before it: "=" at the head of a later side, then its sign."""
        for side, terms in enumerate(equation.sides):
            for index, term in enumerate(terms):
                sign = self.NEGATIVE if term.sign < 0 else "+" if index else ""
                yield ("=" + sign if side and not index else sign), term

    def lettered(self, text: str) -> str:
        """A symbol's letters in italics, those of points with their digits below: O₁A."""
        return self._pieces(runs(text), self.italic)

    def index(self, text: str) -> str:
        """A symbol's index upright, the digits of the points it names set lower again: O1A of l, Pqt5 of h."""
        return self._pieces(numbered(text), self.upright)

    def _pieces(self, pieces: Iterable[tuple[str, str]], set_letters: Callable[[str], str]) -> str:
        return "".join(set_letters(part) + (self.lowered(number) if number else "") for part, number in pieces)

    @abstractmethod
    def text(self, text: str) -> str: ...

    @abstractmethod
    def symbol(self, node: Symbol) -> str: ...

    @abstractmethod
    def italic(self, text: str) -> str: ...

    @abstractmethod
    def upright(self, text: str) -> str: ...

    @abstractmethod
    def lowered(self, text: str) -> str:
        """Upright letters below the line, no smaller than an index."""

    @abstractmethod
    def number(self, node: Number) -> str: ...

    @abstractmethod
    def parentheses(self, node: Expression) -> str: ...

    @abstractmethod
    def function(self, name: str) -> str: ...

    @abstractmethod
    def arguments(self, nodes: Sequence[Expression]) -> str: ...

    @abstractmethod
    def matrix(self, rows: Sequence[Sequence[str]]) -> str: ...

    @abstractmethod
    def chain(self, node: Chain) -> str: ...


def level(node: Expression) -> int:
    """How tightly a node binds; a parent that needs a higher level puts it in parentheses."""
    match node:
        case Chain() | VectorEquation():
            return RELATION
        case Sum() | Negative():
            return SUM
        case Number():
            return SUM if node.shown < 0 else MARKED if node.unit else ATOM
        case Product():
            return PRODUCT
        case Fraction() | Call() | Power() | Root():
            return QUOTIENT
        case Symbol():
            return MARKED if node.sup or node.base.endswith(PRIMES) else ATOM
        case _:
            return ATOM


def short_end(row: Expression) -> bool:
    """Whether a row ends in "= 0", which must not stand on a line of its own."""
    return isinstance(row, Chain) and isinstance(row.parts[-1], Number) and row.parts[-1].shown == 0


def in_groups(rows: Sequence[Expression], room: float) -> list[tuple[Expression, ...]]:
    """The rows of an equation in groups that are set alike: vector equations alone, runs of short rows, others.

    Of short rows two have `room` (mm) side by side; one alone stays with the rows beside it.
    """
    groups = [list(run) for _, run in groupby(rows, lambda row: isinstance(row, VectorEquation))]
    found: list[tuple[Expression, ...]] = []
    for group in groups:
        if isinstance(group[0], VectorEquation):
            found += ((row,) for row in group)
            continue
        aligned: list[Expression] = []
        for short, run in groupby(group, lambda row: 2 * _width(row) + ABREAST <= room):
            members = tuple(run)
            if not short or len(members) == 1:
                aligned += members
                continue
            found += [tuple(aligned)] if aligned else []
            found.append(members)
            aligned = []
        found += [tuple(aligned)] if aligned else []
    return found


def _width(row: Expression) -> float:
    """About what a displayed row takes across (mm)."""
    return box(_flat(row), TEXT_SIZE).width


def _flat(node: Expression) -> Expression:
    """An expression with the wider part of each fraction in its place: displayed, it is set in full size."""
    match node:
        case Fraction(top, bottom):
            return max(_flat(top), _flat(bottom), key=lambda part: box(part, TEXT_SIZE).width)
        case Chain(parts, note):
            return Chain(tuple(map(_flat, parts)), note)
        case Product(factors):
            return Product(tuple(map(_flat, factors)))
        case Sum(terms):
            return Sum(tuple(map(_flat, terms)))
        case _:
            return node


# --- blocks ---------------------------------------------------------------------------------------


def leads(block: Block, following: Block | None, language: Language) -> bool:
    """Whether a block must stay with the next one: a text that ends in a colon or whose sentence goes on there.

    A vector equation stays with the text that says how it is solved, and any equation with a table that sums it up.
    """
    if following is None or isinstance(following, (PageBreak, Plate)):
        return False
    match block:
        case List(items=(*_, (*_, Paragraph(inlines)))):
            return isinstance(following, Equation) and plain(inlines, language).endswith(":")
        case Equation(rows=(VectorEquation(), *_)) if isinstance(following, Paragraph):
            return leads(following, block, language)
        case Equation():
            return isinstance(following, Table)
        case Paragraph(inlines):
            text = plain(inlines, language).rstrip()
            goes_on = isinstance(following, (Equation, List, Table))
            return text.endswith(":") or (goes_on and not text.endswith((".", "!", "?", "…")))
        case _:
            return False


def parted(block: List) -> tuple[List, ...]:
    """A list as two lists: the items before the last, if there are any, and the last item."""
    last = replace(block, items=block.items[-1:], start=block.start + len(block.items) - 1)
    return (replace(block, items=block.items[:-1]), last) if block.items[:-1] else (last,)


def height(rows: Sequence[Sequence[Scene]]) -> float:
    """Of a figure's rows with their titles and the white between them (mm)."""
    titles = sum(TITLE for row in rows if any(scene.title for scene in row))
    return sum(max(scene.height for scene in row) for row in rows) + titles + SCENE_GAP * (len(rows) - 1)


def breaks(rows: Sequence[Sequence[Scene]]) -> bool:
    """Whether a figure's rows may stand on more than one page."""
    return len(rows) > 1 and height(rows) > LONG_FIGURE


def in_rows(scenes: Sequence[Scene]) -> list[list[Scene]]:
    """Scenes in rows, in order, each row as full as the text block allows."""
    rows: list[list[Scene]] = []
    used = 0.0
    for scene in scenes:
        if rows and used + SCENE_GAP + scene.width <= TEXT_WIDTH:
            rows[-1].append(scene)
            used += SCENE_GAP + scene.width
        else:
            rows.append([scene])
            used = scene.width
    return rows
