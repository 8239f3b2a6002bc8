"""What a file asks for is in a report of any extent, and its conclusion and summary name what came out."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest

from reportgen import api
from reportgen.assignment.common import Extent
from reportgen.base.units import write
from reportgen.case import Case
from reportgen.cases import opened
from reportgen.document import Document, Table, text_of
from tests.lanes import matrix, proof
from tests.report import built

SHAPER = """
kind: shaper
report: {language: vi, worked_positions: [4]}
positions: {count: 12, direction: clockwise}
parameters:
  a: 300 mm
  b: 580 mm
  l3: 620 mm
  l4: 130 mm
  H: 360 mm
  n: 55 rpm
  cutting: {F: 1400 N, free: 0.05}
  J1: 3 kg m2
  G2: 20 N
  G3: 240 N
  G4: 40 N
  G5: 650 N
  friction:
    pins: {A: {f: 0.06, r: 25 mm}, B: {f: 0.06, r: 18 mm}, C: {f: 0.06, r: 22 mm}}
    sliders: {2: 0.08, 5: 0.1}
  flywheel: {delta: 1/25}
  motion:
    drive:
      kloss: {Mk: 60 N m, sk: 0.2, n0: 1000 rpm}
      ratio: 1/17
      J: 0.03 kg m2
      motors:
        - {name: "4A-0,75", power: 0.75 kW, n: 935 rpm, start: 15 N m, breakdown: 17 N m}
        - {name: "4A-1,1", power: 1.1 kW, n: 940 rpm, start: 22 N m, breakdown: 25 N m}
    start: {from: 0 deg}
    stop: {brake: 200 N m, from: 0 deg}
    flywheel: true
    forces: true
"""
LANGUAGES = ("vi", "en", "ru", "zh")
CONCLUDED = (
    *("friction.mean", "friction.eta.cycle", "J.d", "run.delta", "run.delta.wheel", "run.t.start", "run.t.stop"),
)
"""What is the same over the cycle."""


@cache
def _made(language: str, extent: Extent) -> tuple[Case, Document]:
    with TemporaryDirectory() as folder:
        path = Path(folder) / "shaper.yaml"
        path.write_text(SHAPER, encoding="utf-8")
        case = opened(api.load(path, language).with_extent(extent))
        return case, case.document()


def _section(document: Document, title: str) -> str:
    """The text from a title to the next unnumbered one."""
    lines = text_of(document).splitlines()
    start = max(place for place, line in enumerate(lines) if line.strip() == title)
    return "\n".join(lines[start : start + 30])


def _shown(case: Case, id: str, position: int | None = None) -> str:
    number = case.printed.number(id, position)
    return write(number.value, number.decimals, case.assignment.language)


TITLES = {"vi": "Kết luận", "en": "Conclusion", "ru": "Заключение", "zh": "结论"}
SUMMARIES = {"vi": "Tóm tắt kết quả", "en": "Summary of results", "ru": "Сводка результатов", "zh": "结果摘要"}


@pytest.mark.parametrize("language", matrix(LANGUAGES, ["en"]))
def test_the_conclusion_names_what_came_out(language: str) -> None:
    case, document = _made(language, "short")
    text = _section(document, TITLES[language])
    for id in CONCLUDED:
        assert _shown(case, id) in text, id
    for id in ("friction.M", "friction.eta"):
        assert _shown(case, id, 4) in text, id
    assert "4A-" in text


@proof
@pytest.mark.parametrize("language", ["vi", "en"])
def test_the_summary_names_it_too(language: str) -> None:
    case, document = _made(language, "full")
    text = _section(document, SUMMARIES[language])
    for id in CONCLUDED:
        assert _shown(case, id) in text, id
    assert "4A-" in text
    assert write(1 / 25, None, language) in text or "1/25" in text


def test_a_short_report_has_what_its_file_asks_for() -> None:
    _, document = _made("en", "short")
    keys = {block.key for block in document.blocks if isinstance(block, Table)}
    assert {"tab.run.start", "tab.run.stop", "tab.run.forces.4"} <= keys
    text = text_of(document)
    assert "Equation of motion" in text
    assert "Choice of a motor" in text


def test_what_is_not_asked_for_is_not_there(tmp_path: Path) -> None:
    path = tmp_path / "shaper.yaml"
    lines = (line for line in SHAPER.splitlines() if not line.strip().startswith(("start:", "stop:", "forces: true")))
    path.write_text("\n".join(lines), encoding="utf-8")
    document = opened(api.load(path, "en").with_extent("short")).document()
    keys = {block.key for block in document.blocks if isinstance(block, Table)}
    assert not {"tab.run.start", "tab.run.stop", "tab.run.forces.4"} & keys
    assert "The start from rest takes" not in text_of(document)


@pytest.mark.parametrize("extent", matrix(["short", "full"], ["short"]))
def test_the_work_in_mertsalovs_check_is_given(extent: Extent) -> None:
    """T_I = A − J_r ω₁²/2: A at the position is stated before, or stands in the table of the flywheel."""
    path = built.ROOT / "assignments" / "toggle-press-02.yaml"
    case = opened(api.load(path, "en").with_extent(extent))
    document = case.document()
    has_table = any(isinstance(block, Table) and block.key == "tab.flywheel" for block in document.blocks)
    worked = case.span.worked[0]
    stated = f"A = {_shown(case, 'A.excess', worked)} J"
    assert has_table == (extent == "full")
    assert (stated in text_of(document)) == (extent == "short")
