"""The contents: a few lines too many come onto the page, not onto one of their own."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from reportgen.document import Contents, Section, Text
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
