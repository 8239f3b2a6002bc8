"""The pages of a report: full, their figures behind what speaks of them, their tables continued by name."""

from __future__ import annotations

import re
from collections.abc import Iterator
from itertools import pairwise

import pytest
import typst

from reportgen import api
from reportgen.document import Block, Emph, Figure, List, Paragraph, Plate, Reference, Section, Strong, Table
from reportgen.document.figure_placement import across, close, in_text
from tests.report import built, pages
from tests.report.built import Report, Written
from tests.report.pages import Page
from tests.report.test_report_figures import captions
from tests.report.test_report_files import contents
from tests.report.thin_pages import thin

pytest.importorskip("pymupdf")

LEAST = 6.0
"""Points: the smallest letter that is read without effort from paper."""
ROUNDED = 0.03
"""Points by which a size from a PDF may be off: sizes are products of rounded factors."""
SHARE, FEW = 0.04, 3
"""Of the pages, or so many of a short report, may be thin, cover, contents and last page apart: a page ends early
before a figure of half a page and more, which stands below its heading and in no more than two parts (three times in
the longest report), and where a section has no more text to let run on; the page before a sheet of larger
paper, with which a section ends, is not counted."""
LATE = 4
"""Pages from the first mention: plans of several groups are named together and follow the tables of their sentence; of
three groups, each plan at least 25 mm large, they fill four pages."""


def references(block: Block) -> Iterator[str]:
    """The keys that a block of text refers to."""
    match block:
        case Paragraph(inlines):
            rest = list(inlines)
            while rest:
                match rest.pop():
                    case Reference(key):
                        yield key
                    case Emph(of) | Strong(of):
                        rest += of
        case List(items):
            for item in items:
                for inner in item:
                    yield from references(inner)


def test_a_figure_stands_behind_its_first_mention(written: Written) -> None:
    mentioned: set[str] = set()
    early = []
    for block in written.document.blocks:
        mentioned.update(references(block))
        if isinstance(block, (Figure, Plate)) and block.key and block.key not in mentioned:
            early.append(block.key)
    assert early == []


def test_a_force_plan_is_called_where_it_is_named(written: Written) -> None:
    """Before the steps of its construction, so that these may fill the page before it."""
    for before, block in pairwise(written.document.blocks):
        if isinstance(block, Figure) and re.fullmatch(r"fig\.R\.\d+\.\d+", block.key):
            assert block.key in references(before)


def test_few_pages_are_thin(report: Report) -> None:
    plates = {page.number - 1 for page in report.pages if page.is_plate}
    own = {0, *contents(report), len(report.pages) - 1, *plates}
    found = [index for index in thin(report.pages) if index not in own]
    assert len(found) <= max(SHARE * len(report.pages), FEW), [index + 1 for index in found]


def test_no_letter_is_too_small_to_read(report: Report) -> None:
    small = {
        (page.number + 1, glyph.char, round(glyph.size, 2))
        for page in report.pages
        for glyph in page.glyphs
        if glyph.size < LEAST - ROUNDED
    }
    assert small == set()


def test_a_table_that_goes_on_says_so(report: Report) -> None:
    """No page begins with the rules of a table's head; the label on a continued table names one of the pages before."""
    tables = {block.number for block in report.document.blocks if isinstance(block, Table)}
    for page in report.pages:
        if page.is_plate:
            continue
        top = min((glyph.box[1] for glyph in page.body), default=0.0)
        rules = [path["rect"] for path in page.drawings if path["rect"].width > 60 * pages.MM]
        heads = [rule for rule in rules if rule.height < 1.5 and pages.BODY < rule.y0 < top]
        assert heads == [], page.number + 1
        if label := pages.continued(page.body):
            match = pages.CONTINUED.fullmatch(pages.text(label))
            assert match
            assert match[1] in tables


def test_a_figure_follows_its_mention_closely(report: Report) -> None:
    """Plates, which stand at the end of their part, are not counted."""
    word = report.document.words.figure
    a4 = [page.number for page in report.pages if not page.is_plate]
    place: dict[str, int] = {}
    for page in report.pages:
        for number in () if page.is_plate else captions(page, word):
            place.setdefault(number, page.number)
    prose: dict[str, int] = {}
    for page in report.pages:
        for link in page.sheet.get_links():
            left, top, right, bottom = link["from"]
            inside = (
                glyph
                for glyph in page.body
                if left < sum(glyph.box[::2]) / 2 < right and top < glyph.origin[1] < bottom
            )
            text = "".join(glyph.char for glyph in inside).strip(" .,;()")
            if text in place and link.get("page", -1) in (place[text], place[text] - 1, place[text] + 1):
                prose.setdefault(text, page.number)
    late = {
        number: (prose[number] + 1, at + 1)
        for number, at in place.items()
        if number in prose and sum(prose[number] < page <= at for page in a4) > LATE
    }
    assert len(prose) > 0.8 * len(place)
    assert late == {}


def test_figures_stand_in_their_order_within_their_section(report: Report) -> None:
    """No figure comes before one with a smaller number, nor on a page before its section or behind the next one."""
    blocks, word = report.document.blocks, report.document.words.figure
    places: dict[str, int] = {}
    for page in report.pages:
        for number in captions(page, word):
            places.setdefault(number, page.number)
    assert list(places) == [one.number for one in blocks if isinstance(one, (Figure, Plate)) and one.number in places]
    started = {number: page.number for page in report.pages for number in headings(page)}
    # A short report, which is set close, has sections of a page; there a figure may run on into the next one.
    keeping = 1 if report.document.close else 2
    section, found = "", {}
    for block in blocks:
        if isinstance(block, Section) and block.level <= keeping:
            section = block.number
        elif isinstance(block, Figure):
            found[block.number] = section
    order = [one.number for one in blocks if isinstance(one, Section) and one.level <= keeping]
    for number, own in found.items():
        if own in started and number in places:
            after = [started[one] for one in order[order.index(own) + 1 :] if one in started]
            assert started[own] <= places[number] <= min(after, default=len(report.pages)), number


def headings(page: Page) -> Iterator[str]:
    """The numbers of the sections of the first two levels that begin on a page."""
    lines: dict[int, str] = {}
    for glyph in page.body:
        if glyph.size > 13:
            lines[round(glyph.origin[1])] = lines.get(round(glyph.origin[1]), "") + glyph.char
    for text in lines.values():
        if found := re.match(r"\s*(\d+(?:\.\d+)?)(?=\s|[^\d.])", text):
            yield found[1]


def test_no_larger_paper_is_taken_for_what_fits(written: Written) -> None:
    """A plate fits the text block of an A4 page neither upright nor turned."""
    for block in built.walk(written.document.blocks):
        if isinstance(block, Plate):
            assert not in_text(close(block.scene)), block.key
            assert not across(close(block.scene)), block.key


def test_the_typesetter_runs_once(monkeypatch: pytest.MonkeyPatch) -> None:
    runs: list[object] = []
    once = typst.compile
    monkeypatch.setattr(typst, "compile", lambda *args, **more: (runs.append(args), once(*args, **more))[1])
    api.typeset(built.written(built.SAMPLE, "vi").document, "typst")
    assert len(runs) == 1
