"""Edge cases of the engine: each makes a report whose every line holds."""

from __future__ import annotations

import math
import re
from functools import cache
from pathlib import Path

import pytest

from reportgen import api
from reportgen.base.units import write
from reportgen.document import text_of
from reportgen.document.numbering import unreferenced
from tests.lanes import matrix, proof
from tests.report import built, pages, trees, variants
from tests.report.built import Written
from tests.report.calculator import misses
from tests.report.test_report_arrows import measured

pytest.importorskip("pymupdf")


@cache
def variant(name: str, folder: Path) -> Written:
    file = folder / f"{name.replace(' ', '-')}.yaml"
    file.write_text(variants.content(name), encoding="utf-8")
    return built.compose(api.load(file))


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("variants")


@pytest.mark.parametrize("name", matrix(variants.CHANGES, variants.TELLING))
def test_every_line_of_a_variant_holds(name: str, folder: Path) -> None:
    written = variant(name, folder)
    assert misses(trees.lines(trees.chains(written.document), written.language)) == []
    for number in trees.numbers(written.document):
        assert math.isfinite(number.value)
        text = write(number.value, number.decimals, written.language)
        digits = re.sub(r"\D", "", text).lstrip("0")
        assert digits or not text.startswith("−")
        assert number.decimals is None or len(digits) <= 6, text
    text = text_of(written.document)
    assert not re.search(r"(?i)\b(nan|inf|none|undefined)\b", text)
    assert [key for key in unreferenced(written.document) if not re.search(r"\.[2-9]\d*$", key)] == []


@proof
@pytest.mark.parametrize("engine", matrix(built.ENGINE_CASES, ["typst"]))
@pytest.mark.parametrize("name", matrix(variants.ON_PAPER, ["clockwise"]))
def test_a_variant_on_paper(name: str, engine: api.Engine, folder: Path) -> None:
    report = built.typeset(variant(name, folder), engine)
    assert report.overfull == ()
    faults = [
        fault
        for page in report.pages[1:]
        for fault in (*pages.outside(page, pages.BEARING), *pages.overlaps(page, pages.INK))
    ]
    assert faults == []
    assert len(measured(report)) > 100
