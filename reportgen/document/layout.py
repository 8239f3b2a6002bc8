"""Layout decisions that all writers share: rows on one line, blocks kept together, figures divided over pages."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from itertools import groupby

from reportgen.base.records import Record, replace
from reportgen.base.units import Language
from reportgen.document import (
    TEXT_WIDTH,
    Block,
    Contents,
    Equation,
    Figure,
    List,
    PageBreak,
    Paragraph,
    Plate,
    Section,
    Table,
    plain,
)
from reportgen.drawing import Scene
from reportgen.drawing.label_size import POINT, Boxes, box
from reportgen.formula import Expression, VectorEquation
from reportgen.formula.formula_layout import MathRow, Part

SCENE_GAP = 4.0
"""Distance (mm) between scenes side by side."""
ABREAST = 8.0
"""Distance (mm) between two short rows of an equation side by side."""
TEXT_SIZE = 12.0
"""Font size (points) of running text and formulas."""
CLOSE_SIZE = 11.0
"""Font size (points) of the same in a document that is set close."""
CERTAIN = 0.96
"""Share of the room up to which an estimated row certainly fits; one that is too wide would part all others."""


class Letter(Record):
    """The font of running text ("" for the typesetter's own) and its size in points.

    Formulas and labels of figures keep their own font, by which they are measured.
    """

    font: str = ""
    size: float = TEXT_SIZE


OWN_LETTER = Letter()
WHOLE_TABLE = 12
"""Largest number of rows of a table that is kept on one page."""
TOGETHER = 3
"""Smallest number of rows of a longer table on its first page, and below a heading in it."""
UNIT = re.compile(r"\b([A-Za-zµ]{1,3}[²³]?/\(?[A-Za-zµ·²³]{1,8}\)?)")
"""A unit with a slash inside a text."""
FILE = re.compile(r"\b(\w+\.(?:yaml|xlsx))\b")
"""The name of a file inside a text: a hyphen at the end of its line would seem to be typed."""
UNBROKEN = re.compile(f"{UNIT.pattern}|{FILE.pattern}")
"""A unit or a file name inside a text, in which no line may break."""

TITLE = 5.0
"""Height (mm) of the titles below a row of scenes."""
FIGURE_HEIGHT = 241.0
"""Height (mm) of an A4 page that a figure may fill above its caption."""
TOGETHER_HEIGHT = 155.0
"""Height (mm) above which the rows of a figure are split in two parts, the later one as continuation."""
NEARLY_A_PAGE = 200.0
"""Height (mm) from which rows fill their own page; two halves would leave two pages half empty."""

# --- equations --------------------------------------------------------------------------------------


CERTAIN_ROOM = TEXT_WIDTH - 16.0
"""Width (mm) in which parts of a row certainly fit in a line: beside a number, or in a list."""


def fits(parts: Sequence[Part]) -> bool:
    """Return True if parts of a displayed row certainly fit beside each other in a line."""
    return Boxes(TEXT_SIZE * POINT, displayed=True).part(MathRow(tuple(parts))).width <= CERTAIN_ROOM


def room_for(room: float, close: bool) -> float:
    """Return the room (mm) for rows measured in the usual type: the smaller type of close documents has more."""
    return room * TEXT_SIZE / CLOSE_SIZE * CERTAIN if close else room


def in_groups(rows: Sequence[Expression], room: float) -> list[tuple[Expression, ...]]:
    """Return the rows of an equation in groups of the same layout: single vector equations, short rows, others.

    Two short rows share `room` (mm) side by side; a single short one stays with the rows beside it.
    """
    groups = [list(run) for _, run in groupby(rows, lambda row: isinstance(row, VectorEquation))]
    alike: list[tuple[Expression, ...]] = []
    for group in groups:
        if isinstance(group[0], VectorEquation):
            alike += ((row,) for row in group)
            continue
        aligned: list[Expression] = []
        for short, run in groupby(group, lambda row: _is_short(row, room)):
            members = tuple(run)
            if not short or len(members) == 1:
                aligned += members
                continue
            alike += [tuple(aligned)] if aligned else []
            alike.append(members)
            aligned = []
        alike += [tuple(aligned)] if aligned else []
    return alike


def lines(rows: Sequence[Expression], room: float) -> int:
    """Return the number of lines that the rows of an equation take in a room (mm), short ones two abreast."""
    groups = in_groups(rows, room)
    return sum(-(-len(one) // 2) if all(_is_short(row, room) for row in one) else len(one) for one in groups)


def _is_short(row: Expression, room: float) -> bool:
    return 2 * _width(row) + ABREAST <= room


def _width(row: Expression) -> float:
    """Return the approximate width (mm) of a displayed row."""
    return box(row, TEXT_SIZE, displayed=True).width


# --- contents ----------------------------------------------------------------------------------------

PAGE_ENTRIES, MANY_ENTRIES = 50, 30
"""Number of lines of a full page of contents, and the smallest number that does not look half empty."""
SHORT = 45
"""Number of lines of contents that certainly fit on a page."""
ABOVE_CHAPTER = 1 / 3
"""White above a chapter in the contents, in lines."""
BOLD = 1.2
"""Largest width of bold letters over that of others."""
ENTRY_WIDTH = 120.0
"""Width (mm) of a title in the contents, beside its number and page, that certainly is one line."""


def contents(title: str, blocks: Iterable[Block], brief: bool, language: Language) -> Contents:
    """Return the table of contents of some blocks, without its own page if its last page would be half empty."""
    listed = [block for block in blocks if isinstance(block, Section) and block.level <= (2 if brief else 3)]
    widths = (BOLD * box(plain(section.title, language), TEXT_SIZE).width for section in listed)
    lines = sum(math.ceil(width / ENTRY_WIDTH) for width in widths)
    chapters = sum(section.level == 1 for section in listed)
    return Contents(
        title,
        brief,
        alone=not brief and (len(listed) - 1) % PAGE_ENTRIES >= MANY_ENTRIES,
        short=lines + ABOVE_CHAPTER * chapters <= SHORT,
    )


# --- blocks ---------------------------------------------------------------------------------------


def leads(block: Block, following: Block | None, language: Language) -> bool:
    """Return True if a block must stay with the next one.

    That is a text that ends in a colon, or whose sentence continues in the next block. A vector equation stays with the
    text that says how it is solved, and any equation with a table that sums it up.
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


def held(table: Table) -> tuple[int, ...]:
    """Return the number of rows of each group that stays on one page.

    A group is a short table, or a heading with the rows below it.
    """
    count = len(table.rows)
    if count <= max(WHOLE_TABLE, TOGETHER + table.last):
        return (count,)
    groups: list[int] = []
    begun = 0
    while True:
        size = TOGETHER if begun == 0 or len(table.rows[begun]) == 1 < len(table.columns) else 1
        if begun + size > count - table.last:
            return (*groups, count - begun)
        groups.append(size)
        begun += size


def stays(table: Table) -> list[bool]:
    """Return for each row of a table whether it stays on one page with the next one."""
    return [row < size - 1 for size in held(table) for row in range(size)]


def parted(block: List) -> tuple[List, ...]:
    """Return a list as two lists: all items but the last (if there are any), and the last item."""
    last = replace(block, items=block.items[-1:], start=block.start + len(block.items) - 1)
    return (replace(block, items=block.items[:-1]), last) if block.items[:-1] else (last,)


def height(rows: Sequence[Sequence[Scene]]) -> float:
    """Return the height of a figure's rows with their titles and the white between them (mm)."""
    titles = sum(TITLE for row in rows if any(scene.title for scene in row))
    return sum(max(scene.height for scene in row) for row in rows) + titles + SCENE_GAP * (len(rows) - 1)


def in_parts(figure: Figure) -> list[list[list[Scene]]]:
    """Return the rows of a figure in parts that fit a page each.

    A figure is one part if it is low, or fills a page; otherwise two parts, because a high one leaves white space; more
    if two do not fit.
    """
    rows = in_rows(figure.scenes)
    whole = height(rows)
    if whole <= TOGETHER_HEIGHT or NEARLY_A_PAGE < whole <= FIGURE_HEIGHT or len(rows) == 1:
        return [rows]
    halves = ([rows[:at], rows[at:]] for at in range(1, len(rows)))
    least = min(halves, key=lambda parts: max(map(height, parts)))
    if max(map(height, least)) <= FIGURE_HEIGHT:
        return least
    parts: list[list[list[Scene]]] = [[]]
    for row in rows:
        if parts[-1] and height([*parts[-1], row]) > FIGURE_HEIGHT:
            parts.append([])
        parts[-1].append(row)
    return parts


def in_rows(scenes: Sequence[Scene]) -> list[list[Scene]]:
    """Return scenes in rows, in order, each row as full as the text block allows."""
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


def plates_last(blocks: Iterable[Block], said: Callable[[Plate], Paragraph]) -> Iterator[Block]:
    """Yield the blocks with the plates of each chapter at its end.

    `said` makes the reference at a plate's original place. A page of text ends early before a plate, at most once in a
    chapter.
    """
    plates: list[Plate] = []
    for block in blocks:
        if isinstance(block, Plate):
            plates.append(block)
            if not block.continues:
                yield said(block)
            continue
        if isinstance(block, Section) and block.level == 1:
            yield from plates
            plates.clear()
        yield block
    yield from plates
