"""Small documents set by either writer, and what their pages say."""

from __future__ import annotations

import shutil
import unicodedata
from typing import Any

import pymupdf
import pytest

from reportgen.base.records import replace
from reportgen.document import Block, Document
from reportgen.writers import latex, pdflatex, typst, typst_compiler
from tests.writers import sample

MM = 72 / 25.4
"""PDF points in a millimetre."""

needs_tex = pytest.mark.skipif(
    shutil.which("pdflatex") is None, reason="pdflatex is not installed; install it with " + pdflatex.INSTALL
)


def document(*blocks: Block) -> Document:
    return replace(sample.sample(), blocks=blocks)


def opened(pdf: bytes) -> Any:
    return pymupdf.open(stream=pdf, filetype="pdf")


def by_typst(*blocks: Block) -> Any:
    """The open PDF of a document of these blocks."""
    return opened(typst_compiler.compile(typst.write(document(*blocks))))


def by_latex(*blocks: Block) -> Any:
    return opened(pdflatex.compile(latex.write(document(*blocks))).pdf)


def plain(text: str) -> str:
    """Text as a reader sees it: mathematical italics and presentation forms folded, spaces equal."""
    return " ".join(unicodedata.normalize("NFKC", text).replace("\N{WORD JOINER}", "").split())


def body_of(page: Any) -> Any:
    """The page without its header and footer."""
    return pymupdf.Rect(0, 21 * MM, page.rect.width, page.rect.height - 17 * MM)


def text_of(*blocks: Block) -> str:
    """The text of the pages that Typst makes of these blocks, without header and footer."""
    return plain("\n".join(page.get_text(clip=body_of(page)) for page in by_typst(*blocks)))


def sides(pages: pymupdf.Document) -> list[float]:
    """Where upright lines stand that reach from the top of what is ruled to its foot (mm from the left), one each."""
    lines: dict[float, list[tuple[float, float]]] = {}
    level: list[float] = []
    for drawing in (drawing for page in pages for drawing in page.get_drawings()):
        rect = drawing["rect"]
        if rect.y0 < 20 * MM:
            continue  # the rule of the header
        if rect.width < 1 < rect.height:
            lines.setdefault(round(rect.x0 / MM, 1), []).append((rect.y0, rect.y1))
        elif rect.height < 1 < rect.width:
            level.append(rect.y0)
    top, foot = min(level), max(level)
    whole = []
    for x, pieces in lines.items():
        pieces.sort()
        ends = [top, *(end for _, end in pieces)]
        # A rule may stand between two pieces.
        if all(start - end < 1 for (start, _), end in zip(pieces, ends, strict=False)) and foot - ends[-1] < 1:
            whole.append(x)
    return sorted(whole)
