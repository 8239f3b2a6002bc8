"""The contents: a few lines too many come onto the page, not onto one of their own; short ones have room on a page."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from reportgen.base.records import replace
from reportgen.document import Contents, Section, Text
from reportgen.document.layout import contents
from tests.lanes import proof
from tests.writers.pages import body_of, by_latex, by_typst, needs_tex

WRITERS = [pytest.param(by_typst, id="typst"), pytest.param(by_latex, id="latex", marks=needs_tex)]
LENGTHS = range(49, 57)
"""Numbers of entries about what a page of lines at their usual distance holds."""


def entries(write: Callable[..., Any], count: int) -> list[int]:
    """How many entries each page of the contents has."""
    sections = [Section(2, (Text(f"Heading {k} of the report"),)) for k in range(count)]
    found = (page.get_text(clip=body_of(page)) for page in write(Contents("Contents"), *sections))
    # Only the contents have dots that lead to the page.
    return [text.count("Heading") for text in found if ". . ." in text or "...." in text]


@proof
@pytest.mark.parametrize("write", WRITERS)
def test_no_page_of_contents_has_a_few_lines_only(write: Callable[..., Any]) -> None:
    found = {count: entries(write, count) for count in LENGTHS}
    assert all(sum(on_pages) == count for count, on_pages in found.items())
    assert {len(on_pages) for on_pages in found.values()} == {1, 2}
    # Four lines find room where the others come closer; five and more are worth a page.
    assert min(on_pages[-1] for on_pages in found.values()) >= 4, found


WIDE = "Heading of a section about as wide as a line of the"


@pytest.mark.parametrize("every", [1, 5, 50])
def test_short_contents_have_room_on_a_page(every: int) -> None:
    """Each title fills its line; all, a fifth or one of them are chapters, which have white above them."""
    levels = [1 if k % every == 0 else 3 for k in range(60)]
    sections = [Section(level, (Text(WIDE),), number="10.10.10") for level in levels]
    count = max(n for n in range(60) if contents("Contents", sections[:n], False, "en").short)
    assert count > 30
    pages = by_typst(contents("Contents", sections[:count], False, "en"), *sections[:count])
    assert ". . ." in pages[0].get_text(clip=body_of(pages[0]))
    assert ". . ." not in pages[1].get_text(clip=body_of(pages[1]))
    assert pages[0].get_text(clip=body_of(pages[0])).count("Heading") == count
    # Titles of two lines count twice.
    assert not contents("Contents", [Section(1, (Text(f"{WIDE} {WIDE}"),))] * 30, False, "en").short


def test_contents_that_are_short_look_the_same() -> None:
    """They are set without being measured."""
    sections = [Section(1, (Text(f"Heading {k} of the report"),)) for k in range(30)]
    short = contents("Contents", sections, False, "en")
    assert short.short
    pages = [by_typst(each, *sections)[0].get_text() for each in (short, replace(short, short=False))]
    assert pages[0] == pages[1]
