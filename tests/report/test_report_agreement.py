"""Both writers print the same: prose word by word, every number, every character."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator
from itertools import chain

import pytest

from reportgen.document import Document, Emph, Inlines, LineBreak, Paragraph, Reference, Strong, Text
from tests.report import built, pages
from tests.report.built import Report
from tests.report.pages import Glyph
from tests.report.test_report_files import contents, without_contents

pytest.importorskip("pymupdf")

EXEMPT = {
    "•": "–",  # the mark of a list's item is the typesetter's
    "⃗": "",  # an accent without width, which the PDF library drops or keeps as it comes
}
"""What the writers may print differently, and what it is compared as; all else must be equal.

Not compared: cover (large type, broken differently), contents (its page numbers are checked by
themselves), header and footer (as many as there are pages), heads of tables repeated on a next page,
names of the rows below a vector equation (repeated where it takes two lines; the only italics of 9.5 pt).
"""
ROW_NAMES = 9.5
NEAR = 3
"""A table goes on after so many pages at most: figures that float may take whole pages between its parts."""


def compared(report: Report) -> list[Glyph]:
    skipped = {id(glyph) for found in (report.bodies[0], *contents(report).values()) for glyph in found}
    return [
        glyph
        for number, page in enumerate(report.pages)
        for glyph in pages.without_repeated_head(page, list(chain(*report.bodies[max(0, number - NEAR) : number])))
        if id(glyph) not in skipped and not (glyph.italic and abs(glyph.size - ROW_NAMES) < 0.1)
    ]


def numbers(glyphs: list[Glyph]) -> Counter[str]:
    """How often each number is printed; a raised figure beside a number is one of its own."""
    lines: list[list[Glyph]] = []
    for glyph in glyphs:
        last = lines[-1][-1] if lines else None
        if last is None or last.word != glyph.word or apart(last, glyph):
            lines.append([])
        lines[-1].append(glyph)
    return Counter(number for line in lines for number in re.findall(r"\d+(?:[.,]\d+)*", pages.text(line)))


def apart(one: Glyph, other: Glyph) -> bool:
    """Whether two glyphs differ in size or base line, on a turned page too, by more than the PDF library rounds."""
    way = complex(*other.origin) - complex(*one.origin)
    return abs(one.size - other.size) > 0.5 or abs((way * one.along.conjugate()).imag) > 0.5


def test_every_number_is_printed_by_both(pair: tuple[Report, Report]) -> None:
    typst, latex = (numbers(compared(report)) for report in pair)
    assert sum(typst.values()) > 500
    assert typst == latex


def test_every_character_is_printed_by_both(pair: tuple[Report, Report]) -> None:
    typst, latex = (
        Counter("".join(EXEMPT.get(char, char) for char in pages.text(compared(report)))) for report in pair
    )
    assert typst == latex


def runs(inlines: Inlines) -> Iterator[str]:
    """The words of inlines between formulas and numbers."""
    words = ""
    for inline in inlines:
        match inline:
            case Text(text) | Reference(text=text):
                words += text
            case Emph(of) | Strong(of):
                words += "".join(runs(of))
            case LineBreak():
                words += " "
            case _:
                yield words
                words = ""
    yield words


def prose(document: Document) -> Iterator[str]:
    for block in built.walk(document.blocks):
        if isinstance(block, Paragraph):
            yield from filter(None, map(pages.squash_prose, runs(block.inlines)))


def test_prose_is_printed_word_by_word_in_order(report: Report) -> None:
    printed = pages.text(
        glyph
        for found in without_contents(report)
        for glyph in found
        if pages.PROSE[0] < glyph.size < pages.PROSE[1] and glyph.char not in "₀₁₂₃₄₅₆₇₈₉"
    )
    at = 0
    for words in prose(report.document):
        found = printed.find(words, at)
        # At once or after the formulas before it: a page holds about 2500 characters, never pages later.
        assert 0 <= found - at < 2500, (words, printed[at : at + 80])
        at = found + len(words)
