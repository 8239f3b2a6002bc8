"""Drawings through the marking of a class: alone, beside a sheet, and by the sheet that was completed of them."""

from __future__ import annotations

from pathlib import Path

import pytest

from reportgen.cases import open_case
from reportgen.classes.class_marking import grade
from reportgen.classes.class_outputs import files_of
from reportgen.marking.answer_sheet import answer_book
from reportgen.marking.marking_data import Verdict
from reportgen.marking.marking_policy import Policy
from reportgen.marking.toleranced_key import key_of
from reportgen.workbook import write_xlsx
from tests.handin.drawings import Manner, draw, true_plans
from tests.lanes import proof

NAME = "slider-crank-01"


@pytest.fixture
def handed(tmp_path: Path) -> tuple[Path, Path]:
    """The folder of assignments, and that of a student's drawing, a quarter of whose plans have a wrong vector."""
    assignments, folder = tmp_path / "assignments", tmp_path / "handed" / NAME
    assignments.mkdir()
    folder.mkdir(parents=True)
    text = (Path("assignments") / f"{NAME}.yaml").read_text(encoding="utf-8")
    (assignments / f"{NAME}.yaml").write_text(text, encoding="utf-8")
    case = open_case(assignments / f"{NAME}.yaml")
    (folder / "plans.dxf").write_bytes(draw(true_plans(case), Manner(letters=True), 1)[0])
    return assignments, folder


@proof
def test_a_drawing_earns_what_it_shows(handed: tuple[Path, Path]) -> None:
    """Lengths and directions are asked for where the drawing has them, and nowhere else."""
    assignments, folder = handed
    graded = grade([folder], assignments, Policy(), "en")
    (marking,) = graded.markings
    judged = [cell for cell in marking.cells if (cell.id, cell.position) in marking.submission.measured]
    assert len(judged) > 15
    assert all(cell.verdict is Verdict.right and cell.points == 1 for cell in judged)
    lengths = [cell for cell in marking.cells if cell.id.startswith("seg.")]
    assert {(cell.id, cell.position) for cell in lengths} <= marking.submission.drawn
    names = {path.name: content for path, content in files_of(graded, Policy(), "typst", "en")}
    assert {"marked-sheet-1.dxf", "reading.xlsx", "feedback.xlsx"} <= names.keys()
    # What was read, as a sheet: marked again, it earns the same.
    folder.joinpath("plans.dxf").unlink()
    (folder / "reading.xlsx").write_bytes(names["reading.xlsx"])
    (again,) = grade([folder], assignments, Policy(), "en").markings
    assert again.points == marking.points


@proof
def test_beside_a_sheet_the_sheet_counts(handed: tuple[Path, Path]) -> None:
    assignments, folder = handed
    key = key_of(open_case(assignments / f"{NAME}.yaml"))
    (folder / "answers.xlsx").write_bytes(write_xlsx(answer_book(Policy().ask.of(key))))
    graded = grade([folder], assignments, Policy(), "en")
    (marking,) = graded.markings
    assert not marking.submission.measured
    assert {problem.code for problem in graded.problems} == {"own-beside-sheet"}


def test_a_dwg_is_to_be_saved_as_dxf(handed: tuple[Path, Path]) -> None:
    assignments, folder = handed
    drawing = folder.parent / f"{NAME}.dwg"
    drawing.write_bytes(b"AC1032")
    graded = grade([drawing], assignments, Policy(), "en")
    assert [problem.code for problem in graded.problems] == ["drawing-dwg"]
    assert not graded.markings
