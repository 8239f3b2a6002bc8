"""What the instructor judges otherwise: it holds at each run, is shown as such, and told where it fits no more."""

from __future__ import annotations

from pathlib import Path

import pytest

from reportgen.base.errors import AssignmentError, Problem
from reportgen.base.records import replace
from reportgen.classes.corrections import applied, read_corrections
from reportgen.document import text_of
from reportgen.marking.class_marks import grade_rows
from reportgen.marking.class_page import class_document
from reportgen.marking.feedback import feedback_book, feedback_document
from reportgen.marking.marking_data import Answer, Marking, Verdict
from reportgen.marking.marking_policy import Policy
from reportgen.marking.summary_comment import comment
from tests.marking.keys import small_key
from tests.marking.test_feedback import marking

HEAD = "id,quantity,position,judgement,reason,value\n"
ABSENT = small_key("en", "crank-08", "Trần B")


def corrected(rows: str, path: Path, found: Marking | None = None) -> tuple[Marking, list[Problem]]:
    path.write_text(HEAD + rows, encoding="utf-8")
    found = found or marking()
    markings, problems = applied([found], [found.key, ABSENT], read_corrections(path, "en"), "en")
    return markings[0], problems


def points(found: Marking) -> dict[tuple[str, int], float]:
    return {(cell.id, cell.position): cell.points for cell in found.cells}


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "corrections.csv"


def test_a_value_judged_right_earns_its_point_and_nothing_else_changes(path: Path) -> None:
    found, problems = corrected("crank-07,omega.1,,right,shown on the drawing,", path)
    assert problems == []
    assert points(found) == {**points(marking()), ("omega.1", 0): 1.0}
    assert [cell.id for cell in found.first_errors] == ["M.eq"]


@pytest.mark.parametrize(
    ("what", "earned"),
    [
        ("v.B,3,right", {("v.B", 3): 1.0}),
        ("v_B,2,wrong", {("v.B", 2): 0.0}),
        ("v.B,,2", {("v.B", k): 0.5 for k in (1, 2, 3, 4)}),
        ("velocity,,8", dict.fromkeys([("omega.1", 0)] + [("v.B", k) for k in (1, 2, 3, 4)], 1.0)),
        ("Vận tốc,4,sai", {("v.B", 4): 0.0}),
        ('dir.*,1,"0,5"', {("dir.v.B", 1): 0.5}),
        (",,0", dict.fromkeys(points(marking()), 0.0)),
    ],
)
def test_what_is_named_may_be_an_id_a_symbol_a_section_or_the_sheet(
    what: str, earned: dict[tuple[str, int], float], path: Path
) -> None:
    found, problems = corrected(f"Nguyễn Văn A,{what},seen,", path)
    assert not [one for one in problems if one.level == "error"]
    told = points(found)
    if what.startswith("velocity"):
        earned |= {place: 1.0 for place in told if place[0] == "dir.v.B"}
    assert told == {**points(marking()), **earned}


def test_the_later_of_two_rows_holds(path: Path) -> None:
    found, _ = corrected("crank-07,v.B,,right,all seen,\ncrank-07,v.B,2,wrong,not this one,", path)
    assert [points(found)["v.B", k] for k in (1, 2, 3, 4)] == [1, 0, 1, 1]


@pytest.mark.parametrize(
    ("row", "code", "place"),
    [
        ("crank-99,v.B,2,right,seen,", "correction-nobody", "2:1"),
        ("crank-08,v.B,2,right,seen,", "correction-no-sheet", "2:1"),
        ("crank-07,v.C,2,right,seen,", "correction-no-quantity", "2:10"),
        ("crank-07,v.B,9,right,seen,", "correction-no-cell", "2:14"),
        ("crank-07,v.B,2,1.5,seen,", "correction-points", "2:16"),
        ("crank-07,v.B,2,wrong,seen,3.14", "correction-value", "2:27"),
        ("crank-07,v.B,2,right,seen,", "correction-idle", "2:16"),
    ],
)
def test_what_a_row_no_longer_fits_is_told_at_its_place(row: str, code: str, place: str, path: Path) -> None:
    found, problems = corrected(row, path)
    assert [(one.code, str(one.location)) for one in problems] == [(code, f"{path}:{place}")]
    assert points(found) == points(marking())


def test_a_row_for_a_value_holds_while_the_sheet_has_it(path: Path) -> None:
    found = marking()
    values = {**found.submission.values, ("v.B", 3): replace(found.submission.values["v.B", 3], text="7,77 m/s")}
    found = replace(found, submission=replace(found.submission, values=values))
    for value in ("7.77", '"7,77 m/s"'):
        assert points(corrected(f"crank-07,v.B,3,right,seen,{value}", path, found)[0])["v.B", 3] == 1
    values[("v.B", 3)] = Answer(7.5, "7.5", values["v.B", 3].location)
    later = replace(found, submission=replace(found.submission, values=values))
    left, problems = corrected("crank-07,v.B,3,right,seen,7.77", path, later)
    assert points(left)["v.B", 3] == 0
    assert "the value 7.77" in problems[0].message
    assert "now has 7.5" in problems[0].message


@pytest.mark.parametrize(
    ("text", "codes"),
    [
        ("id,quantity,reason\ncrank-07,v.B,x\n", ["correction-column"]),
        ("id,quantity\ncrank-07,v.B\n", ["correction-column"]),
        (HEAD + "crank-07,v.B,2,right,,\ncrank-07,v.B,2,maybe,x,\n,v.B,2,1,x,\n",
         ["correction-lacks", "correction-judgement", "correction-lacks"]),
    ],
)  # fmt: skip
def test_a_table_that_says_too_little_is_refused_with_all_its_faults(text: str, codes: list[str], path: Path) -> None:
    path.write_text(text, encoding="utf-8")
    with pytest.raises(AssignmentError) as found:
        read_corrections(path, "en")
    assert [one.code for one in found.value.problems] == codes


def test_the_instructors_word_is_shown_to_the_student_and_in_the_class(path: Path) -> None:
    path.write_text(
        "Mã sinh viên;Đại lượng;Vị trí;Điểm;Lý do\ncrank-07;v.B;3;đúng;đo lại trên bản vẽ\n", encoding="utf-8"
    )
    key = small_key("en")
    (found,), _ = applied([marking()], [key], read_corrections(path), "en")
    line = "v_B (3): 1 of 1 points – đo lại trên bản vẽ"
    assert line in text_of(feedback_document(found, "Crank"))
    assert line in text_of(class_document([found], "Crank", "en"))
    assert list(comment(found, Policy()))[-2:] == ["Judged by your lecturer:", f"– {line}"]
    head, row = grade_rows([found], "en")
    assert dict(zip(head, row, strict=True))["judged by the lecturer"] == line
    comments = [str(one) for page in feedback_book(found).sheets for one in page.rows]
    assert any("Judged by your lecturer: đo lại trên bản vẽ" in text for text in comments)
    assert found.cells[4].verdict is Verdict.right


@pytest.mark.parametrize(
    ("text", "signed"),
    [
        (
            "id,quantity,position,judgement,reason,judged by,judged on\ncrank-07,v.B,3,right,seen,Lê Hoa,2026-11-21\n",
            " (Lê Hoa, 2026-11-21)",
        ),
        (
            "Mã sinh viên;Đại lượng;Vị trí;Điểm;Lý do;Ngày chấm\ncrank-07;v.B;3;đúng;seen;21/11/2026 08:00\n",
            " (21/11/2026 08:00)",
        ),
        ("email,quantity,position,judgement,reason,by\nAN@X.vn,v.B,3,right,seen,Lê Hoa\n", " (Lê Hoa)"),
        (HEAD + "crank-07,v.B,3,right,seen,\n", ""),
    ],
)  # fmt: skip
def test_who_judged_so_and_when_stands_with_the_reason(text: str, signed: str, path: Path) -> None:
    """In what the student reads, in the class's page and in the table of grades; a student may be named by e-mail."""
    path.write_text(text, encoding="utf-8")
    found = marking()
    found = replace(found, key=replace(found.key, student={**found.key.student, "email": "an@x.vn"}))
    (made,), problems = applied([found], [found.key], read_corrections(path), "en")
    assert problems == []
    line = f"v_B (3): 1 of 1 points – seen{signed}"
    assert line in text_of(feedback_document(made, "Crank"))
    head, row = grade_rows([made], "en")
    assert dict(zip(head, row, strict=True))["judged by the lecturer"] == line


def test_a_date_that_is_none_is_a_fault_of_its_cell(path: Path) -> None:
    path.write_text("id,judgement,reason,judged on\ncrank-07,right,x,yesterday\n", encoding="utf-8")
    with pytest.raises(AssignmentError, match=r"corrections\.csv:2:18: error\[moment\]"):
        read_corrections(path, "en")
