"""One damaged hand-in never ends the marking of a class: the others' marks and files are written all the same."""

from __future__ import annotations

import csv
from collections.abc import Sequence
from pathlib import Path

import pytest

from reportgen.base.errors import Problem
from reportgen.case import MachineAnalysis
from reportgen.cases import open_case
from reportgen.classes import class_marking, class_outputs
from reportgen.marking.answer_sheet import answer_book
from reportgen.marking.authenticity import Classmate
from reportgen.marking.marking_data import Marking, Submission
from reportgen.marking.marking_policy import Policy
from reportgen.marking.marking_scheme import MarkingScheme
from reportgen.marking.toleranced_key import Ask, key_of
from reportgen.workbook import write_xlsx
from tests.handin import wml
from tests.handin.drawings import Manner, draw, true_plans
from tests.handin.test_grading import report

ASSIGNMENT = Path("assignments/slider-crank-01.yaml")
GOOD, SETTINGS, CUT, UNITS = "K01", "K02", "K03", "K04"
SETTINGS_RELATION = f'<Relationship Id="rId2" Type="{wml.R}/settings" Target="settings.xml"/>'


@pytest.fixture(scope="module")
def handed(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    """The assignments of a class, and what it hands in: one right report, and three files damaged in their own way."""
    assignments, folder = tmp_path_factory.mktemp("assignments"), tmp_path_factory.mktemp("handed")
    text = ASSIGNMENT.read_text(encoding="utf-8").replace("count: 8", "count: 4")
    for id in (GOOD, SETTINGS, CUT, UNITS):
        (assignments / f"{id}.yaml").write_text(text, encoding="utf-8")
    case = open_case(assignments / f"{GOOD}.yaml")
    assert isinstance(case, MachineAnalysis)
    key = Ask().of(key_of(case))
    (folder / f"{GOOD}.docx").write_bytes(report(key))
    # The settings are read only when comments are written.
    parts, relations = {"word/settings.xml": f'<w:settings xmlns:w="{wml.W}"><w:zoom></w:settings>'}, SETTINGS_RELATION
    (folder / f"{SETTINGS}.docx").write_bytes(report(key, parts=parts, relations=relations))
    drawing = draw(true_plans(case), Manner(release="R2010", clutter=0), 1)[0]
    # Cut off within the section of entities, so that nothing says where a new layer's lines go.
    entities = drawing.index(b"ENTITIES")
    (folder / f"{CUT}.dxf").write_bytes(drawing[: drawing.index(b"ENDSEC", entities)].rsplit(b"\n", 2)[0] + b"\n")
    unit = drawing.index(b"$INSUNITS")
    damaged = drawing[:unit] + drawing[unit:].replace(b" 70", b"  2", 1).replace(b"\n4", b"\nENTITIES", 1)
    damaged = damaged.replace(b"ANSI_1252", b"HEX", 1)
    (folder / f"{UNITS}.dxf").write_bytes(damaged)
    return assignments, folder


def test_damaged_files_leave_the_marks_of_the_class(handed: tuple[Path, Path], tmp_path: Path) -> None:
    assignments, folder = handed
    graded = class_marking.grade([folder], assignments, Policy(guard=False, least_read=0), "en")
    told: list[Problem] = []
    written = {
        path.relative_to(tmp_path).as_posix()
        for path in class_outputs.put(graded, Policy(guard=False), tmp_path, "typst", "en", problems=told)
    }
    assert {"grades.csv", "class.pdf", f"{GOOD}/marked.docx", f"{UNITS}/marked-sheet-1.dxf"} <= written
    rows = {row["id"]: row for row in csv.DictReader((tmp_path / "grades.csv").read_text("utf-8-sig").splitlines())}
    assert {id for id, row in rows.items() if row["mark"]} >= {GOOD, SETTINGS, CUT, UNITS}
    assert rows[GOOD]["per cent"] == rows[SETTINGS]["per cent"] == "100"
    # What could not be given back is reported in the row of its student, and nowhere else.
    assert rows[SETTINGS]["not given back"].startswith(f"{SETTINGS}.docx: it was marked, but the comments")
    assert rows[CUT]["not given back"].startswith(f"{CUT}.dxf: it was marked, but the comments")
    assert not rows[GOOD]["not given back"]
    assert not rows[UNITS]["not given back"]
    assert {(Path(one.location.file).stem, one.level) for one in told} == {(SETTINGS, "warning"), (CUT, "warning")}


def test_an_exception_nobody_expected_concerns_one_student(
    handed: tuple[Path, Path], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The student whose marking fails is listed with the reason; the others have marks.

    What fails in the comparison with others, which may be another's fault, costs nobody the mark.  Nor does a sheet
    that only claims to be of another student's assignment displace that student's report.
    """
    assignments, folder = handed
    stray = tmp_path / f"{CUT}.xlsx"
    stray.write_bytes(write_xlsx(answer_book(Ask().of(key_of(open_case(assignments / f"{GOOD}.yaml"))))))
    marked = class_marking.mark

    def mark(scheme: MarkingScheme, submission: Submission, classmates: Sequence[Classmate]) -> Marking:
        if submission.assignment == SETTINGS:
            raise ZeroDivisionError("division by zero")
        if classmates:
            raise OverflowError("of somebody else's sheet")
        return marked(scheme, submission, classmates)

    monkeypatch.setattr(class_marking, "mark", mark)
    reports = [folder / f"{id}.docx" for id in (GOOD, SETTINGS)]
    graded = class_marking.grade([*reports, stray], assignments, Policy(), "en")
    assert [(marking.key.id, marking.share) for marking in graded.markings] == [(GOOD, 1)]
    (refused,) = (one for one in graded.unmarked if one.reasons)
    assert refused.key.id == SETTINGS
    assert refused.reasons[0].endswith("ZeroDivisionError: division by zero")
    assert sorted(problem.code for problem in graded.problems) == ["own-failed", "own-failed", "sheet-named-otherwise"]
