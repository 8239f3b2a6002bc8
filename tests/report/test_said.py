"""Sentences that a lecturer would strike out do not come back: what is said of numbers fits them, in both languages."""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from reportgen.base.template_folders import templates
from reportgen.document import Section, Table, plain, text_of
from reportgen.report.context import ReportContext
from reportgen.report.table_remarks import top_reactions
from tests.lanes import matrix
from tests.report import built

ROOT = Path(__file__).parents[2]
FILES = sorted(path.stem for path in (ROOT / "assignments").glob("*.yaml"))
TELLING = ("engine-single-I", "shaper-01", "four-bar-02")
"""With a flywheel and a balance in both senses; with several reactions that are greatest alike; a clockwise crank."""


@cache
def page(name: str, language: Any) -> tuple[ReportContext, str]:
    made = built.written(ROOT / "assignments" / f"{name}.yaml", language)
    return ReportContext(made.case), text_of(made.document)


@pytest.mark.parametrize("language", ["vi", "en"])
@pytest.mark.parametrize("name", matrix(FILES, TELLING))
def test_formulas_and_data_are_written_as_one_writes_them(name: str, language: Any) -> None:
    """No added negative number, no factor 1; δ as it was typed; how lengths were measured stands once."""
    report, text = page(name, language)
    assert re.search(r"\+ \(−1\)|[^\d]1·δ", text) is None
    if "unevenness" in report.ledger and report.has_forces:
        typed = report.machine.calculation.families["unevenness"].definition
        assert typed is None or re.search(r"(vượt quá|within|cho phép,|fluctuation,) 1/\d+", text)
    assert text.count("(CAD)") == 1


@pytest.mark.parametrize(
    ("language", "one_way", "other_way"),
    [
        ("vi", "lớn nhất theo chiều kim đồng hồ", "lớn nhất ngược chiều kim đồng hồ"),
        ("en", "Maximum clockwise", "Maximum anticlockwise"),
    ],
)
@pytest.mark.parametrize("name", matrix(FILES, TELLING))
def test_an_extreme_of_the_balance_is_named_by_its_sense(
    name: str, language: Any, one_way: str, other_way: str
) -> None:
    report, text = page(name, language)
    if not report.has_forces or not report.driver.centre or report.instants:
        return
    torque = report.analysis.torque
    (_, least), (_, greatest) = report.analysis.summary.extremes
    large = float(np.abs(torque).max())
    for phrase, there in ((one_way, least < -1e-6 * large), (other_way, greatest > 1e-6 * large)):
        rows = [line for line in text.splitlines() if phrase in line and "|" in line]
        assert len(rows) == there
        # A size, whose sense the words have.
        assert all("−" not in line for line in rows)


@pytest.mark.parametrize("name", matrix(FILES, TELLING))
def test_several_reactions_take_a_value_and_one_takes_it(name: str) -> None:
    report, text = page(name, "en")
    if report.has_forces and not report.instants:
        verbs = {len(top.ids) > 1 for top in top_reactions(report)}
        assert (" take this value" in text) == (True in verbs)
        assert (" takes this value" in text) == (False in verbs)


@pytest.mark.parametrize("name", matrix(FILES, TELLING))
def test_a_reaction_points_somewhere_at_an_angle(name: str) -> None:
    """In Vietnamese: “hướng lên trên, sang trái, lập với trục x góc 110,2°”, up or down first."""
    _, text = page(name, "vi")
    pointing = re.findall(r"hướng (sang|lên|xuống)[^;.]*?, lập với trục x góc [\d,]+°", text)
    assert pointing or "Chiều của các phản lực" not in text
    assert re.search(r"sang (trái|phải), (lên|xuống)", text) is None


WORDS = {
    # A thing has one name, and English none that is a translation.
    "vi": ("ệ số năng suất", "ơ cấu đòn", "vectơ", "Coriolis", "ở phía sao cho", "dù trọng tâm", "tích xác nhận"),
    "en": ("unevenness of", "analytic method", "touching line", "Least ", "Greatest "),
}


@pytest.mark.parametrize("language", sorted(WORDS))
def test_words_that_were_struck_out_stay_out(language: str) -> None:
    for path in (templates() / language).rglob("*.*"):
        text = path.read_text(encoding="utf-8")
        assert [word for word in WORDS[language] if word in text] == []


@pytest.mark.parametrize("language", ["vi", "en"])
def test_a_report_of_motion_alone_has_no_caption_of_forces(language: Any) -> None:
    report, _ = page("four-bar-02", language)
    captions = [plain(block.caption, language) for block in report.case.document().blocks if isinstance(block, Table)]
    assert not report.has_forces
    assert [one for one in captions if re.search(r"\b(lực|forces?)\b", one)] == []


@pytest.mark.parametrize("language", ["vi", "en"])
def test_a_heading_within_a_line_ends_as_a_sentence(language: Any) -> None:
    """“Measured results. The plan …”: what follows on the line begins anew, as behind bold words of a paragraph."""
    report, _ = page("four-bar-02", language)
    blocks = report.case.document().blocks
    titles = [plain(block.title, language) for block in blocks if isinstance(block, Section) and block.level > 3]
    assert titles
    assert [one for one in titles if not one.endswith(".")] == []
