"""What a document is parted into in a Word file: runs of blocks on the same paper, and what references lead to."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from reportgen import document as tree
from reportgen.writers.word_elements import PageSetup

COVER = PageSetup(left=36, right=26, top=30, bottom=26, running=False, framed=True)
LANDSCAPE = PageSetup(297, 210, left=20, right=20, top=20, bottom=18, above=10, below=8)
CONTENTS_LEVEL = 3
"""The deepest level of heading that the contents list."""


@dataclass(frozen=True, slots=True)
class Bookmark:
    """What a reference leads to: a bookmark, and what of it is shown instead of the text that it marks."""

    bookmark: str
    shown: str = ""


def paged(blocks: Sequence[tree.Block], usual: PageSetup) -> Iterator[tuple[tuple[PageSetup, int], tree.Block]]:
    """Each block with the page that it stands on, and a number of its own where that is a page for itself."""
    for index, block in enumerate(blocks, start=1):
        page = _page(block, usual)
        yield (page, index if isinstance(block, (tree.Plate, tree.Figure)) and page != usual else 0), block


def _page(block: tree.Block, usual: PageSetup) -> PageSetup:
    """The paper of a block: what is wider than the text stands on a turned page."""
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
    """The blocks of a section with a break before and behind contents on pages of their own.

    A section begins and ends with its page, so that breaks at its ends say nothing, nor does a second one.
    """
    separated: list[tree.Block] = [tree.PageBreak()]
    for block in blocks:
        alone = isinstance(block, tree.Contents) and block.alone
        for part in (tree.PageBreak(), block, tree.PageBreak()) if alone else (block,):
            if not (isinstance(part, tree.PageBreak) and isinstance(separated[-1], tree.PageBreak)):
                separated.append(part)
    return separated[1:-1] if isinstance(separated[-1], tree.PageBreak) else separated[1:]


def places(blocks: Sequence[tree.Block]) -> Iterator[tuple[str, Bookmark]]:
    """Where the references to each key lead; a numbered heading is named by its number, all else by what is marked."""
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
    """The counter of captions with a word, by the name that Word gives it."""
    return name.replace(" ", "_")
