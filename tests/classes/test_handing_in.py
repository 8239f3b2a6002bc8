"""When and how often sheets were handed in: days late, the last of two, refused ones told from missing ones."""

from __future__ import annotations

import datetime
import os
import shutil
import zipfile
from pathlib import Path

import pytest

from reportgen.base.errors import AssignmentError, Location
from reportgen.base.records import replace
from reportgen.base.yaml_source import Scalar
from reportgen.classes import class_marking
from reportgen.classes.class_marking import Graded
from reportgen.classes.gradebooks import Participant, StudentResult, read_gradebook
from reportgen.classes.lateness import Handing, days_late
from reportgen.classes.variants import make_variants
from reportgen.document import text_of
from reportgen.marking.class_marks import grade_rows
from reportgen.marking.class_page import class_document
from reportgen.marking.feedback import feedback_document
from reportgen.marking.marking_data import Unmarked
from reportgen.marking.marking_policy import Lateness, Policy, read_policy
from reportgen.marking.summary_comment import comment
from tests.marking import demo
from tests.marking.keys import small_key
from tests.marking.test_feedback import marking

ANH, BAO = "K225520103004", "K225520103007"
DUE = datetime.datetime(2026, 11, 20, 23, 59)
RULE = Lateness(DUE, 1, 2.5)
WORKSHEET = (
    "Identifier,Full name,Email address,Status,Grade,Maximum Grade,Grade can be changed,"
    "Last modified (submission),Last modified (grade),Feedback comments\n"
)


@pytest.fixture(scope="module")
def few(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The assignments of two classmates, where more would show nothing more."""
    folder = tmp_path_factory.mktemp("few")
    make_variants(demo.DEMO / "spec.yaml", demo.DEMO / "roster.csv", folder, False, None)
    for file in folder.glob("*.yaml"):
        if file.stem not in (ANH, BAO):
            file.unlink()
    return folder


# --- late -------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("handed_in", "days"),
    [
        ("2026-11-20 23:59", 0),
        ("2026-11-21 00:00", 1),
        ("2026-11-21 23:59", 1),
        ("2026-11-22 00:00", 2),
        ("2026-12-20 23:59", 30),
    ],
)
def test_a_day_that_is_begun_counts(handed_in: str, days: int) -> None:
    assert RULE.days(datetime.datetime.fromisoformat(handed_in)) == days


def test_what_is_taken_off_has_a_limit_and_leaves_no_mark_below_0() -> None:
    policy = Policy(late=RULE)
    assert [policy.mark(0.8, days) for days in (0, 1, 2, 3, 30)] == [8, 7, 6, 5.5, 5.5]
    assert [policy.mark(0.1, days) for days in (0, 1, 2)] == [1, 0, 0]
    assert Policy().mark(0.8, 30) == 8


def test_the_policy_says_when_it_is_due(tmp_path: Path) -> None:
    path = tmp_path / "policy.yaml"
    path.write_text("late: {due: 20/11/2026, per_day: 0.5}\ntwice: first\n", encoding="utf-8")
    policy = read_policy(path)
    assert policy.late == Lateness(datetime.datetime(2026, 11, 20, 23, 59, 59), 0.5)
    assert policy.twice == "first"
    path.write_text("late: {due: soon, per_day: 1}\ntwice: both\n", encoding="utf-8")
    with pytest.raises(AssignmentError) as found:
        read_policy(path, "en")
    assert [(one.code, one.location.line) for one in found.value.problems] == [("moment", 1), ("choice", 2)]


def test_the_roster_goes_before_the_worksheet_and_who_has_no_date_is_told(tmp_path: Path) -> None:
    path = tmp_path / "worksheet.csv"
    rows = [
        'Participant 1,A,a@x,Submitted,,10.00,Yes,"Sunday, 22 November 2026, 10:05 AM",-,',
        'Participant 2,B,b@x,Submitted,,10.00,Yes,"Sunday, 22 November 2026, 10:05 AM",-,',
        "Participant 3,C,c@x,No submission,,10.00,Yes,-,-,",
        "Participant 4,D,d@x,Submitted,,10.00,Yes,yesterday,-,",
    ]
    path.write_text(WORKSHEET + "\n".join(rows), encoding="utf-8")
    who = {name: Participant(name, frozenset(), number) for name, number in zip("ABCDE", "12345", strict=True)}
    said = {"B": Scalar("20/11/2026 12:00", Location("roster.csv", 3, 4))}
    handings = {name: Handing(one, f"{name}.xlsx", said.get(name), name == "E") for name, one in who.items()}
    days, problems = days_late(RULE, handings, read_gradebook(path), "en")
    assert days == {"A": 2, "B": 0}
    assert [(one.code, one.level, one.location.file) for one in problems] == [
        ("moment", "error", str(path)),
        ("late-undated", "error", "E.xlsx"),
        ("late-unknown", "warning", "C.xlsx"),
    ]
    assert "C" in problems[2].message


def test_lateness_is_told_to_the_student_and_in_the_class() -> None:
    late, policy = replace(marking(), days_late=2), Policy(late=RULE)
    line = "Days late: 2. That takes 2 off the mark, which is 2 of 10."
    assert line in text_of(feedback_document(late, "Crank", policy))
    assert line in list(comment(late, policy))
    head, row = grade_rows([late], "en", (), policy)
    named = dict(zip(head, row, strict=True))
    assert (named["per cent"], named["mark"], named["days late"], named["off the mark"]) == (40, 2, 2, 2)
    assert "2 days, 2 off, 2 left" in text_of(class_document([late], "Crank", "en", (), policy))


# --- twice ------------------------------------------------------------------------------------------


def twice(folder: Path, few: Path, policy: Policy, *, packed: bool = False) -> Graded:
    """Two sheets of Bảo, the earlier one later in the alphabet."""
    own = folder / "d" / "Lê Văn Bảo_4713_assignsubmission_file"
    own.mkdir(parents=True)
    for name, day in (("z.xlsx", 1), ("a.xlsx", 2)):
        shutil.copy(demo.SHEETS / f"{BAO}.xlsx", own / name)
        moment = datetime.datetime(2026, 11, day).timestamp()
        os.utime(own / name, (moment, moment))
    download = folder / "d"
    if packed:
        with zipfile.ZipFile(folder / "d.zip", "w") as made:
            for file in own.iterdir():
                made.write(file, f"{own.name}/{file.name}")
        download = folder / "d.zip"
    return class_marking.grade([download], few, policy, "en")


@pytest.mark.parametrize(("packed", "policy", "marked"), [(False, Policy(), "a"), (True, Policy(twice="first"), "z")])
def test_of_two_sheets_the_last_one_is_marked_unless_the_policy_says_the_first(
    packed: bool, policy: Policy, marked: str, few: Path, tmp_path: Path
) -> None:
    found = twice(tmp_path, few, policy, packed=packed)
    assert [Path(one.submission.file).stem for one in found.markings] == [marked]
    (problem,) = found.problems
    assert problem.code == "sheet-twice"
    assert Path(problem.location.file).stem == {"a": "z", "z": "a"}[marked]
    assert f"{marked}.xlsx" in problem.message


# --- refused, and not handed in ---------------------------------------------------------------------


@pytest.mark.parametrize(
    "file", [f"{ANH}.xlsx", f"{ANH}/answers.ods", "Trần Thị Ngọc Ánh_4712_assignsubmission_file/bai.docx"]
)
def test_whose_file_is_refused_did_hand_in(file: str, few: Path, tmp_path: Path) -> None:
    path = tmp_path / "handed" / file
    path.parent.mkdir(parents=True)
    path.write_bytes(b"PK\x03\x04 no workbook")
    found = class_marking.grade([tmp_path / "handed"], few, Policy(), "en")
    assert [key.id for key in found.missing] == [BAO]
    assert [key.id for key in found.refused] == [ANH]
    (reason,) = next(one.reasons for one in found.unmarked if one.reasons)
    assert reason == f"{path.name}: {found.problems[0].message}"


def test_both_are_told_apart_in_grades_and_class() -> None:
    absent = [Unmarked(small_key("en", student="A")), Unmarked(small_key("en", student="B"), ("b.ods: old form",))]
    head, _, first, second = grade_rows([marking()], "en", absent)
    states = [dict(zip(head, row, strict=True))["state"] for row in (first, second)]
    assert states == ["nothing handed in", "handed in, but not marked: b.ods: old form"]
    text = text_of(class_document([marking()], "Crank", "en", absent))
    for told in (*states, "Not handed in: 1.", "Handed in, but not marked: 1."):
        assert told in text


# --- comments where students read them --------------------------------------------------------------


def test_the_worksheet_takes_the_comment_and_keeps_what_somebody_wrote(tmp_path: Path) -> None:
    path = tmp_path / "worksheet.csv"
    path.write_text(
        WORKSHEET
        + 'Participant 1,A,a@x,Submitted,,10.00,Yes,-,-,\nParticipant 2,B,b@x,Submitted,,10.00,Yes,-,-,"See ""me"""\n',
        encoding="utf-8",
    )
    results = [StudentResult(Participant(n, frozenset(), n), 0.5, ("a < b", "“3,5”")) for n in "12"]
    filled, _ = read_gradebook(path).filled(results)
    block = '<p class=""reportgen"">a &lt; b<br>“3,5”</p>"'
    lines = filled.decode().splitlines()
    assert lines[1].endswith(f'5.00,10.00,Yes,-,-,"{block}')
    assert lines[2].endswith(f'"See ""me""{block}')
    # Where the table comes back, the old comment makes room for the new one.
    path.write_bytes(filled)
    again = [replace(one, comment=("new",)) for one in results]
    assert (
        read_gradebook(path)
        .filled(again)[0]
        .decode()
        .splitlines()[2]
        .endswith('"See ""me""<p class=""reportgen"">new</p>"')
    )


def test_the_columns_of_the_worksheet_are_found_by_their_place_in_any_language(tmp_path: Path) -> None:
    path = tmp_path / "w.csv"
    path.write_text(
        "Mã nhận dạng;Họ và tên;Email;Trạng thái;Điểm;Điểm tối đa;Có thể sửa điểm;Sửa bài;Sửa điểm;Nhận xét\n"
        "Người tham gia 7;B;b@x.vn;Nộp;;10,00;Có;Thứ Bảy, 21 tháng 11 2026, 8:00 SA;-;\n",
        encoding="utf-8",
    )
    table, who = read_gradebook(path), Participant("B", frozenset({"b@x.vn"}), "")
    assert table.handed_in(who) == "Thứ Bảy, 21 tháng 11 2026, 8:00 SA"
    assert (
        table.filled([StudentResult(who, 1.0, ("tốt",))])[0].decode().endswith('-;"<p class=""reportgen"">tốt</p>"\n')
    )


def test_the_comment_names_first_mistakes_and_the_points_of_each_chapter() -> None:
    lines = list(comment(marking("vi"), Policy()))
    assert lines[0] == "Điểm số: 4/10 (đạt 4/10 điểm của phiếu)."
    assert any(line.startswith("– ω_1: Đã dùng số vòng quay trong một phút thay cho vận tốc góc") for line in lines)
    assert lines[-1].startswith("Điểm từng phần: ")
    assert "Vận tốc 3/8" in lines[-1]
