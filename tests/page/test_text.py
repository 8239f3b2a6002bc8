"""The page says what the PDF says: every character as often, the prose word by word in its order."""

from __future__ import annotations

import re
from collections import Counter
from pathlib import Path

import pytest

from reportgen.base.units import Language
from reportgen.page import html
from tests.lanes import matrix, proof
from tests.page.text import Text
from tests.report import built, pages
from tests.report.test_report_agreement import EXEMPT, compared, prose

pytest.importorskip("pymupdf")

PART = re.compile(r"(?:Figure|Hình)[\d.]+\((?:continued|tiếptheo|part\d|phần\d)\)")
PRINTED = matrix(
    [pytest.param((path, language), id=f"{path.stem}-{language}") for path, language in built.PRINTED],
    telling=built.BY_BOTH,
)


@pytest.fixture(params=PRINTED)
def both(request: pytest.FixtureRequest) -> tuple[built.Report, str]:
    """A report on paper, and the text of its page."""
    path, language = request.param
    report = built.report(path, "typst", language)
    return report, Text(html.report(report.document).body).text


@proof
def test_every_character_is_on_both(both: tuple[built.Report, str]) -> None:
    report, page = both
    printed = pages.squash("".join(EXEMPT.get(char, char) for char in pages.text(compared(report))))
    # On paper a figure of many rows stands in parts, each with its number.
    printed, shown = PART.sub("", printed), PART.sub("", pages.squash(page))
    assert len(printed) > 15000
    assert Counter(shown) == Counter(printed)


def test_prose_stands_word_by_word_in_order(both: tuple[built.Report, str]) -> None:
    report, page = both
    shown, at = pages.squash_prose(page), 0
    for words in prose(report.document):
        found = shown.find(words, at)
        assert 0 <= found - at < 4000, (words, shown[at : at + 80])
        at = found + len(words)


@pytest.mark.parametrize(
    ("path", "language"), matrix(built.PRINTED, built.BY_BOTH), ids=lambda one: getattr(one, "stem", one)
)
def test_every_reference_leads_somewhere(path: Path, language: Language) -> None:
    body = html.report(built.written(path, language).document).body
    places = re.findall(r' id="([^"]+)"', body)
    links = set(re.findall(r' href="#([^"]+)"', body))
    assert len(places) == len(set(places))
    # The report of the slotted lever, the smallest, has 49.
    assert len(links) > 40
    assert links <= set(places)
