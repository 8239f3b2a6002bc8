"""What a page or line break must not part, for any writer."""

from __future__ import annotations

import re
from dataclasses import replace

from reportgen.document.plain import plain
from reportgen.document.tree import (
    Block,
    Equation,
    List,
    PageBreak,
    Paragraph,
    Plate,
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


def short_end(chain: Expression) -> bool:
    """Whether a line ends in "= 0", which says nothing on a row of its own."""
    return isinstance(chain, Chain) and isinstance(chain.parts[-1], Number) and chain.parts[-1].shown == 0
