"""A print at 100 % is true to scale: vectors of plans have the lengths that their figure says."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from reportgen import document as tree
from reportgen.base.units import Language
from reportgen.document import Plate
from reportgen.drawing import Arrow, Scene
from reportgen.drawing.style import arrow_head
from tests.lanes import proof
from tests.page.browser import Browser
from tests.page.made import made
from tests.report import built

MM = 72 / 25.4
ALLOWED = 0.2
"""Of a segment (mm)."""
MEASURED = 20.0
"""Shorter ones (mm) are not measured."""
FOUR_BAR = built.ROOT / "assignments" / "four-bar-01.yaml"
CASES = [pytest.param(path, "vi", id=f"{path.stem}-vi", marks=proof) for path in (built.SAMPLE, FOUR_BAR)]


def shafts(scene: Scene) -> list[complex]:
    """The solid shafts of a scene's named arrows (mm), from start into the head; dashed ones print in pieces."""
    arrows = [item for item in scene.items if isinstance(item, Arrow) and item.name and not item.stroke.dash]
    ways = [arrow_head(arrow.start, arrow.end, arrow.head)[0] - arrow.start for arrow in arrows]
    return [way for way in ways if abs(way) > MEASURED]


@pytest.mark.parametrize(("path", "language"), CASES)
def test_segments_are_printed_in_their_length(path: Path, language: Language, browser: Browser) -> None:
    pymupdf = pytest.importorskip("pymupdf")
    browser.show(made(path, language).file)
    with pymupdf.open(stream=browser.printed(), filetype="pdf") as printed:
        lines = [
            complex(item[2].x - item[1].x, item[1].y - item[2].y) / MM
            for sheet in printed
            for drawing in sheet.get_drawings()
            for item in drawing["items"]
            if item[0] == "l"
        ]
        sizes = {(round(sheet.rect.width / MM), round(sheet.rect.height / MM)) for sheet in printed}
        text = "".join(sheet.get_text() for sheet in printed)
    document = built.written(path, language).document
    measured = [
        way for key, scene in built.scenes(document) if key.startswith(("fig.v.", "fig.a.")) for way in shafts(scene)
    ]
    assert len(measured) > 3
    for way in measured:
        nearest = min(lines, key=lambda line: abs(line - way))
        assert abs(nearest - way) < ALLOWED, (way, nearest)
    papers = {block.paper for block in built.walk(document.blocks) if isinstance(block, Plate)}
    assert sizes == {(210, 297), *(tuple(map(round, paper)) for paper in papers)}
    # Of the page's own buttons nothing is printed; ink is dark whatever the screen shows.
    assert made(path, language).case.words["page"]["theme"] not in text


@proof
def test_paper_has_what_the_pdf_has(browser: Browser) -> None:
    """Its running lines and page numbers but on the cover, all its headings in their order, nothing of the panel."""
    pymupdf = pytest.importorskip("pymupdf")
    one = made(built.SAMPLE, "vi")
    document, words = built.written(built.SAMPLE, "vi").document, one.case.words["page"]
    browser.show(one.file)
    with pymupdf.open(stream=browser.printed(), filetype="pdf") as printed:
        cover, *sheets = (" ".join(sheet.get_text().split()) for sheet in printed)
    (left, right), (_, word) = document.header, document.footer
    for number, sheet in enumerate(sheets, 2):
        assert left in sheet, number
        assert right in sheet, number
        assert f"{word} {number}" in sheet
    assert left not in cover
    text = "".join(" ".join(sheets).split())
    titles = [block.title for block in document.blocks if isinstance(block, tree.Section)]
    behind = text.index("".join(tree.plain(titles[-1], "vi").split())) + 1
    for title in titles:
        behind = text.index("".join(tree.plain(title, "vi").split()), behind) + 1
    for key in ("moving", "moment", "keep", "show", "skip"):
        assert words[key] not in cover + " ".join(sheets)


@proof
def test_a_dark_screen_prints_dark_on_light(browser: Browser) -> None:
    pymupdf = pytest.importorskip("pymupdf")
    browser.show(made(built.SAMPLE, "vi").file, dark=True)
    background = "return getComputedStyle(document.querySelector('main')).backgroundColor"
    assert sum(map(int, browser.run(background)[4:-1].split(","))) < 150
    with pymupdf.open(stream=browser.printed(), filetype="pdf") as printed:
        page = printed[2].get_pixmap(dpi=30, colorspace="gray")
    assert math.fsum(page.samples) / len(page.samples) > 200
