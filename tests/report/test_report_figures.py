"""Where figures stand on their pages: none lies on another."""

from __future__ import annotations

import re
from itertools import pairwise

import pytest

from reportgen.document import Figure
from reportgen.document.layout import in_rows
from tests.lanes import matrix
from tests.report import built
from tests.report.built import Report
from tests.report.pages import MM, Page


def heights(report: Report) -> dict[str, float]:
    """Heights (mm) of the drawings of figures that are one row, by number."""
    return {
        block.number: max(scene.height for scene in block.scenes)
        for block in built.walk(report.document.blocks)
        if isinstance(block, Figure) and len(in_rows(block.scenes)) == 1
    }


def captions(page: Page, word: str) -> dict[str, float]:
    """The upper edges (points) of the captions that begin a line of a page, by number."""
    caption = re.compile(rf"{word}\s+([\d.]*\d)\.(\s|$)")
    return {match[1]: top for text, top in page.lines if (match := caption.match(text))}


def test_no_figure_lies_on_another(report: Report) -> None:
    """A drawing of known height stands above its caption, so its page is taken up to there."""
    known, seen = heights(report), 0
    for page in report.pages:
        below = captions(page, report.document.words.figure)
        spans = sorted((below[number] - known[number] * MM, below[number]) for number in below.keys() & known.keys())
        seen += len(spans)
        assert all(above[1] <= next_[0] for above, next_ in pairwise(spans)), page.number + 1
    assert seen >= 0.8 * len(known)


@pytest.mark.parametrize("name", matrix([path.stem for path in built.FILES], ["toggle-press-01", "shaper-01"]))
def test_the_groups_stand_in_one_row(name: str) -> None:
    """Even the four parts of a linkage of eight links."""
    path = built.ROOT / "assignments" / f"{name}.yaml"
    (figure,) = (
        block
        for block in built.walk(built.written(path, "vi").document.blocks)
        if isinstance(block, Figure) and block.key == "fig.groups"
    )
    assert len(in_rows(figure.scenes)) == 1
