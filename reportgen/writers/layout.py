"""Decisions that all writers share: parentheses, signs, and what a page or line break must not separate."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import replace

from reportgen.document.plain import plain
from reportgen.document.tree import Block, Equation, List, PageBreak, Paragraph, Plate, Table
from reportgen.figures.scene import Scene
from reportgen.notation.expressions import (
    Call,
    Chain,
    Expression,
    Fraction,
    Negative,
    Number,
    Power,
    Product,
    Root,
    Sum,
    Symbol,
    Term,
    VectorEquation,
)
from reportgen.notation.numbers import MINUS, Language

TEXT_WIDTH = 160.0
"""Of the A4 text block, mm."""
SCENE_GAP = 4.0
"""Between scenes side by side, mm."""
WHOLE_TABLE = 12
"""A table with no more rows than this is kept on one page."""
TOGETHER = 3
"""A longer table has at least this many rows on each of its pages."""
UNIT = re.compile(r"\b([A-Za-zµ]{1,3}[²³]?/\(?[A-Za-zµ·²³]{1,8}\)?)")
"""A unit with a slash inside a text."""

# --- formulas -------------------------------------------------------------------------------------

RELATION, SUM, PRODUCT, QUOTIENT, MARKED, ATOM = range(6)
"""Levels of binding, the loosest first; MARKED is an atom that already carries a unit or superscript."""

PRIMES = ("′", "″")
NAMED = frozenset({"sin", "cos", "tan", "arcsin", "arccos", "arctan", "min", "max", "arg"})
"""Functions that typesetters know by name; any other prints its own name upright."""
UNSPACED = ("", "°", "%")
"""Units that follow their number without a space."""


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


def signed(equation: VectorEquation) -> Iterator[tuple[str, Term]]:
    """Each term with what is printed before it: "=" at the head of a later side, then its sign."""
    for side, terms in enumerate(equation.sides):
        for index, term in enumerate(terms):
            sign = MINUS if term.sign < 0 else "+" if index else ""
            yield ("=" + sign if side and not index else sign), term


def short_end(row: Expression) -> bool:
    """Whether a row ends in "= 0", which must not stand on a line of its own."""
    return isinstance(row, Chain) and isinstance(row.parts[-1], Number) and row.parts[-1].shown == 0


# --- blocks ---------------------------------------------------------------------------------------


def leads(block: Block, following: Block | None, language: Language) -> bool:
    """Whether a text must stay with the next block: it ends in a colon or its sentence goes on there."""
    if following is None or isinstance(following, (PageBreak, Plate)):
        return False
    match block:
        case List(items=(*_, (*_, Paragraph(inlines)))):
            return isinstance(following, Equation) and plain(inlines, language).endswith(":")
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
