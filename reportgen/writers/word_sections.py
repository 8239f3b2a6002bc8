"""Divide a document for a Word file: runs of blocks on the same paper, and the targets of references."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from reportgen import document as tree
from reportgen.base.records import Record
from reportgen.writers.word_elements import PageSetup

COVER = PageSetup(left=36, right=26, top=30, bottom=26, running=False, framed=True)
LANDSCAPE = PageSetup(297, 210, left=20, right=20, top=20, bottom=18, above=10, below=8)
CONTENTS_LEVEL = 3
"""Deepest level of heading in the contents."""


class Bookmark(Record):
    """The target of a reference: a bookmark, and the switch that shows something other than the marked text."""

    bookmark: str
    switch: str = ""


def paged(blocks: Sequence[tree.Block], usual: PageSetup) -> Iterator[tuple[tuple[PageSetup, int], tree.Block]]:
    """Yield each block with its page, and a unique number if it has its own page."""
    for index, block in enumerate(blocks, start=1):
        page = _page(block, usual)
        yield (page, index if isinstance(block, (tree.Plate, tree.Figure)) and page != usual else 0), block


def _page(block: tree.Block, usual: PageSetup) -> PageSetup:
    """Return the paper of a block; one wider than the text is on a landscape page."""
    match block:
        case tree.Cover():
            return COVER
        case tree.Plate(scene, (width, height)):
            upright = max(14.0, min(20.0, (height - scene.height - 14) / 2))
            return PageSetup(width, height, left=15, right=15, top=upright, bottom=upright, above=7, below=6)
        case tree.Figure(turned=True):
            return LANDSCAPE
        case tree.Table(columns) if round(sum(column.width for column in columns), 3) > tree.TEXT_WIDTH:
            return LANDSCAPE
    return usual


def broken(blocks: Sequence[tree.Block]) -> Sequence[tree.Block]:
    """Return the blocks of a section, with page breaks around contents that have their own pages.

    A section begins and ends with its page, so breaks at its ends and duplicate breaks are removed.
    """
    separated: list[tree.Block] = [tree.PageBreak()]
    for block in blocks:
        alone = isinstance(block, tree.Contents) and block.alone
        for part in (tree.PageBreak(), block, tree.PageBreak()) if alone else (block,):
            if not (isinstance(part, tree.PageBreak) and isinstance(separated[-1], tree.PageBreak)):
                separated.append(part)
    return separated[1:-1] if isinstance(separated[-1], tree.PageBreak) else separated[1:]


def places(blocks: Sequence[tree.Block]) -> Iterator[tuple[str, Bookmark]]:
    """Yield the target of the references to each key; a numbered heading shows its number, others the marked text."""
    for index, block in enumerate(_walk(blocks), start=1):
        if key := getattr(block, "key", ""):
            numbered = isinstance(block, tree.Section) and block.number and block.level <= CONTENTS_LEVEL
            yield key, Bookmark(f"_Ref{index}", " \\w" if numbered else "")


def _walk(blocks: Sequence[tree.Block]) -> Iterator[tree.Block]:
    for block in blocks:
        yield block
        if isinstance(block, tree.List):
            for item in block.items:
                yield from _walk(item)


def sequence(name: str) -> str:
    """Return the counter of captions with a word, by the name that Word uses for it."""
    return name.replace(" ", "_")
