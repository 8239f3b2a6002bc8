"""Decisions that all writers share: how formulas are put together, and what breaks must not separate."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace
from itertools import groupby

from reportgen.document.tree import Block, Equation, List, PageBreak, Paragraph, Plate, Table, plain
from reportgen.figures.metrics import box
from reportgen.figures.scene import Scene
from reportgen.notation.expressions import Expression, VectorEquation
from reportgen.notation.numbers import Language

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

# --- equations --------------------------------------------------------------------------------------


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
        for short, run in groupby(group, lambda row: _is_short(row, room)):
            members = tuple(run)
            if not short or len(members) == 1:
                aligned += members
                continue
            found += [tuple(aligned)] if aligned else []
            found.append(members)
            aligned = []
        found += [tuple(aligned)] if aligned else []
    return found


def lines(rows: Sequence[Expression], room: float) -> int:
    """How many lines the rows of an equation take, short ones two abreast."""
    groups = in_groups(rows, room)
    return sum(-(-len(one) // 2) if all(_is_short(row, room) for row in one) else len(one) for one in groups)


def _is_short(row: Expression, room: float) -> bool:
    return 2 * _width(row) + ABREAST <= room


def _width(row: Expression) -> float:
    """About what a displayed row takes across (mm)."""
    return box(row, TEXT_SIZE, displayed=True).width


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
