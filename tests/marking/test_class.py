"""A class marked from its sheets: every slip is told, one sheet never stops the others, nobody sees another's data."""

from __future__ import annotations

import shutil
import zipfile
from pathlib import Path

import pymupdf
import pytest

from reportgen.cases import open_case
from reportgen.classes import class_marking, class_outputs
from reportgen.classes.class_marking import Graded
from reportgen.classes.variants import make_variants
from reportgen.marking.judging import compare
from reportgen.marking.marking_policy import Policy, read_policy
from reportgen.marking.mistakes import WRONG_DATUM
from reportgen.marking.toleranced_key import EVERYTHING, Ask, key_of
from reportgen.workbook import read, write_csv
from tests.lanes import proof
from tests.marking import demo
from tests.marking.keys import csv_rows

POLICY = read_policy(demo.DEMO / "policy.yaml")
WHOLE = Policy(ask=Ask(EVERYTHING))
"""The sheets of the class were filled in from first to last row."""


@pytest.fixture(scope="module")
def assignments(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("assignments")
    make_variants(demo.DEMO / "spec.yaml", demo.DEMO / "roster.csv", folder, False, None)
    return folder


@pytest.fixture(scope="module")
def few(assignments: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The assignments of two classmates, where more would show nothing more: all that are there are computed."""
    folder = tmp_path_factory.mktemp("few")
    for id in ("K225520103004", "K225520103007"):
        shutil.copy(assignments / f"{id}.yaml", folder)
    return folder


@pytest.fixture(scope="module")
def graded(assignments: Path) -> Graded:
    return class_marking.grade([demo.SHEETS], assignments, WHOLE)


def test_each_students_slip_is_told(graded: Graded) -> None:
    told = {marking.key.id: [(cell.id, cell.mistake) for cell in marking.first_errors] for marking in graded.markings}
    for id, (where, mistake, story) in demo.SLIPS.items():
        if story is not demo.nothing_but_zeros:
            assert told[id] == ([(where, mistake)] if mistake else []), id
    assert [key.id for key in graded.missing] == ["K225520103044"]
    assert graded.problems == ()


def test_points_of_the_class(graded: Graded) -> None:
    """A slip costs one mark, what is left blank or cannot be read its own, stock and copied sheets everything."""
    by_id = {marking.key.id: marking for marking in graded.markings}
    lost = {id: marking.out_of - marking.points for id, marking in by_id.items()}
    for id, (_, mistake, story) in demo.SLIPS.items():
        if story in (demo.as_told, demo.with_units):
            assert lost[id] == (1 if mistake else 0), id
    assert lost["K225520103040"] == len(by_id["K225520103040"].submission.problems) == 2
    assert by_id["K225520103036"].points == by_id["K225520103023"].points == 0
    assert "K225520103001" in {name for cell in by_id["K225520103023"].cells for name in cell.classmates}


def test_unreadable_cells_are_located(graded: Graded) -> None:
    marking = next(one for one in graded.markings if one.key.id == "K225520103040")
    marks = [str(problem.location) for problem in marking.submission.problems.values()]
    assert all(mark.split("!")[1][0] in "EF" and "K225520103040.xlsx:" in mark for mark in marks)


def test_what_is_no_sheet_that_can_be_read_is_told(few: Path, tmp_path: Path) -> None:
    """Whoever saved as .xls or .ods handed something in, which a folder does not pass over in silence."""
    for name in ("K225520103001.xls", "K225520103004.ods", "K225520103007.xlsm"):
        (tmp_path / name).write_bytes(b"\xd0\xcf\x11\xe0" if name.endswith(".xls") else b"PK\x03\x04")
    result = class_marking.grade([tmp_path], few, Policy())
    assert [Path(problem.location.file).suffix for problem in result.problems] == [".xls", ".ods", ".xlsm"]


def test_nobody_displaces_a_sheet_by_claiming_its_name(few: Path, tmp_path: Path) -> None:
    own = tmp_path / "K225520103004.csv"
    own.write_bytes((demo.SHEETS / "K225520103004.csv").read_bytes())
    for name in ("A.csv", "Z.csv"):
        (tmp_path / name).write_bytes(own.read_bytes())
    result = class_marking.grade([tmp_path], few, Policy())
    assert [Path(marking.submission.file) for marking in result.markings] == [own]
    assert {Path(problem.location.file).name for problem in result.problems} == {"A.csv", "Z.csv"}
    assert all("K225520103004.csv" in problem.message for problem in result.problems)


@proof
@pytest.mark.parametrize("place", ["K225520103007.csv", "k225520103007.CSV", "K225520103007/answers.csv"])
def test_a_sheet_named_after_a_classmate_is_told(few: Path, tmp_path: Path, place: str) -> None:
    """It is marked as what it says inside, but not without a word; a name that is nobody's needs none."""
    sheet = tmp_path / place
    sheet.parent.mkdir(exist_ok=True)
    sheet.write_bytes((demo.SHEETS / "K225520103004.csv").read_bytes())
    result = class_marking.grade([tmp_path], few, Policy(), "en")
    assert [marking.key.id for marking in result.markings] == ["K225520103004"]
    assert [(problem.code, problem.location.file) for problem in result.problems] == [
        ("sheet-named-otherwise", str(sheet))
    ]
    for name in ("“K225520103007”", "“K225520103004”"):
        assert name in result.problems[0].message
    sheet.rename(tmp_path / "homework.csv")
    assert class_marking.grade([tmp_path / "homework.csv"], few, Policy()).problems == ()


@proof
def test_one_sheet_never_stops_the_others(assignments: Path, tmp_path: Path) -> None:
    folder = tmp_path / "sheets"
    shutil.copytree(demo.SHEETS, folder)
    (folder / "broken.xlsx").write_bytes(b"PK\x03\x04 no workbook")
    (folder / "stranger.csv").write_text("mã,Ký hiệu,Đơn vị,Giá trị\nR,R,m,1\n", encoding="utf-8")
    (folder / "again.csv").write_bytes((folder / "K225520103004.csv").read_bytes())
    (folder / "~$K225520103001.xlsx").write_bytes(b"lock")
    result = class_marking.grade([folder, tmp_path / "nowhere"], assignments, Policy())
    assert len(result.markings) == len(list(demo.SHEETS.iterdir()))
    assert {Path(problem.location.file).name for problem in result.problems} == {
        "broken.xlsx",
        "stranger.csv",
        "again.csv",
        "nowhere",
    }


def test_names_in_a_sheet_are_no_paths(few: Path, tmp_path: Path) -> None:
    """Whoever writes another path for the assignment's name reaches no file outside the folder."""
    secret = tmp_path / "secret.yaml"
    secret.write_bytes((few / "K225520103004.yaml").read_bytes())
    text = (demo.SHEETS / "K225520103004.csv").read_text(encoding="utf-8-sig")
    sheet = tmp_path / "sheet.csv"
    sheet.write_text(text.replace("K225520103004", str(secret.with_suffix("")), 1), encoding="utf-8")
    result = class_marking.grade([sheet], few, Policy())
    assert result.markings == ()
    assert [problem.code for problem in result.problems] == ["sheet-unknown"]


@proof
def test_files_of_a_student_hold_nothing_of_others(graded: Graded, tmp_path: Path) -> None:
    """Neither names nor numbers of classmates stand in the marked sheet or on the page of feedback."""
    files = list(class_outputs.put(graded, Policy(), tmp_path, "typst", None))
    assert {path.relative_to(tmp_path).as_posix() for path in files} >= {"grades.csv", "class.pdf"}
    people = {marking.key.student["id"]: marking.key.student["name"] for marking in graded.markings}
    for id, name in people.items():
        texts = "\n".join((_pdf(tmp_path / id / "feedback.pdf"), _workbook(tmp_path / id / "feedback.xlsx")))
        assert id in texts
        assert name in " ".join(texts.split())
        assert not [other for other in people if other != id and (other in texts or people[other] in texts)]


@proof
def test_marking_again_gives_the_same_bytes(graded: Graded, assignments: Path) -> None:
    once = dict(class_outputs.files_of(graded, Policy(), "typst", None))
    again = dict(
        class_outputs.files_of(class_marking.grade([demo.SHEETS], assignments, WHOLE), Policy(), "typst", None)
    )
    assert once == again


def test_answers_are_kept_back_if_the_policy_says_so(graded: Graded, tmp_path: Path) -> None:
    """Neither file of a student with a slip then tells the right value."""
    marking = next(one for one in graded.markings if one.key.id == "K225520103004")
    slip = next(cell for cell in marking.cells if cell.id == "omega.1")
    # To the figures of its tolerance, half a per cent: 0.16 rad/s.
    shown = f"{slip.expected:.2f}".replace(".", ",")
    texts = {}
    for show in (True, False):
        one = Graded((marking,), (), ())
        files = list(class_outputs.put(one, Policy(show_answers=show), tmp_path / str(show), "typst", None))
        texts[show] = "\n".join(_pdf(path) if path.suffix == ".pdf" else "" for path in files)
    assert shown in texts[True]
    assert shown not in texts[False]


def test_comparing_names_the_first_divergence_without_marks_or_answers(assignments: Path) -> None:
    lines, agrees = compare(open_case(assignments / "K225520103007.yaml", "en"), demo.SHEETS / "K225520103007.xlsx")
    assert not agrees
    assert "v_CB at position 2" in lines[0]
    assert ".xlsx:Answers!F" in lines[0] or ".xlsx:Bài làm!F" in lines[0]
    scheme = class_marking.marking_scheme(open_case(assignments / "K225520103007.yaml"))
    right = scheme.key.row("v.CB").values[1]
    hinted, _ = compare(
        open_case(assignments / "K225520103007.yaml", "en"), demo.SHEETS / "K225520103007.xlsx", hint=True
    )
    assert "scale was forgotten" in "\n".join(hinted)
    for line in (*lines, *hinted):
        assert f"{right:.2f}" not in line
        assert "point" not in line


def test_comparing_an_empty_or_right_sheet(assignments: Path, tmp_path: Path) -> None:
    file = assignments / "K225520103001.yaml"
    lines, agrees = compare(open_case(file, "en"), demo.SHEETS / "K225520103001.xlsx")
    assert (agrees, len(lines)) == (True, 1)
    empty = tmp_path / "empty.csv"
    empty.write_bytes(write_csv(csv_rows(key_of(open_case(file)))))
    lines, agrees = compare(open_case(file, "en"), empty)
    assert agrees
    assert "still missing" in lines[0]


@proof
def test_policy_of_the_demo(graded: Graded, assignments: Path) -> None:
    weighed = class_marking.grade([demo.SHEETS], assignments, POLICY)
    by_id = {marking.key.id: marking for marking in weighed.markings}
    lost = by_id["K225520103028"].out_of - by_id["K225520103028"].points
    assert lost == 5
    assert WRONG_DATUM not in {cell.mistake for cell in by_id["K225520103028"].cells}


def _pdf(path: Path) -> str:
    with pymupdf.open(path) as document:
        return "\n".join(page.get_text() for page in document)


def _workbook(path: Path) -> str:
    """All text of a workbook, comments and properties too."""
    cells = "\n".join(cell.text for page in read(path) for row in page.rows for cell in row)
    with zipfile.ZipFile(path) as package:
        return cells + "\n".join(package.read(name).decode("utf-8", "replace") for name in package.namelist())
