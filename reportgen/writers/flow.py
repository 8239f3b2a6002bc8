"""What a page or line break must not part, for any writer."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from reportgen.document.plain import plain
from reportgen.document.tree import (
    Block,
    Contents,
    Cover,
    Equation,
    Figure,
    List,
    PageBreak,
    Paragraph,
    Plate,
    Section,
    Table,
)
from reportgen.notation.expressions import Chain, Expression, Number
from reportgen.notation.numbers import Language

WHOLE_TABLE = 12
"""A table of at most so many rows is kept on one page."""
TOGETHER = 3
"""So many rows, at least, a longer table has on each of its pages."""
UNIT = re.compile(r"\b([A-Za-zµ]{1,3}[²³]?/\(?[A-Za-zµ·²³]{1,8}\)?)")
"""A unit with a slash inside a text."""

LINE, LETTERS = 6.0, 95
"""Millimetres from a line of text to the next, and the letters in one, at most."""

_HEADING = 3
"""The last level of headings that have a line of their own."""


def leads(block: Block, following: Block | None, language: Language) -> bool:
    """Whether words, perhaps the last of a list, go on in the block after them or announce it by a colon."""
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
    """A list as its last item and, if there are any, the ones before."""
    last = replace(block, items=block.items[-1:], start=block.start + len(block.items) - 1)
    return (replace(block, items=block.items[:-1]), last) if block.items[:-1] else (last,)


def height(blocks: Sequence[Block], language: Language) -> float:
    """Millimetres that blocks take at least, about."""
    return sum(_height(block, language) for block in blocks)


def _height(block: Block, language: Language) -> float:
    match block:
        case Paragraph(inlines):
            return LINE * (1 + len(plain(inlines, language)) // LETTERS)
        case List(items):
            return sum(height(item, language) for item in items)
        case Equation(rows):
            return LINE * len(rows)
        case Table():
            return LINE * (len(block.head) + len(block.rows))
        case Figure(scenes):
            return max(scene.height for scene in scenes)
        case _:
            return LINE


def short_end(chain: Expression) -> bool:
    """Whether a line ends in "= 0", which says nothing on a row of its own."""
    return isinstance(chain, Chain) and isinstance(chain.parts[-1], Number) and chain.parts[-1].shown == 0


@dataclass(frozen=True, slots=True)
class Stretch:
    """A heading and what stands under it; `apart` if it begins a page."""

    head: tuple[Block, ...]
    body: tuple[Block, ...]
    apart: bool


def stretches(blocks: Sequence[Block]) -> Iterator[Stretch]:
    """The blocks cut before each heading, and around what has pages of its own."""
    head: tuple[Block, ...] = ()
    body: list[Block] = []
    apart = True
    for block in blocks:
        own_page = isinstance(block, (Plate, PageBreak, Cover, Contents))
        heading = isinstance(block, Section) and block.level <= _HEADING
        if not (own_page or heading):
            body.append(block)
            continue
        if head or body:
            yield Stretch(head, tuple(body), apart)
        body = []
        if own_page:
            yield Stretch((), (block,), apart=True)
            head, apart = (), True
        else:
            head, apart = (block,), isinstance(block, Section) and block.level == 1
    if head or body:
        yield Stretch(head, tuple(body), apart)
