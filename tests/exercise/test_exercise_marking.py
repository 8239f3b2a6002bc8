"""A class of twelve with drawn variants of exercises of plane motion: task, key, comparing and marking."""

from __future__ import annotations

import re
from pathlib import Path

import pymupdf
import pytest

from reportgen import api
from reportgen.base.units import write
from reportgen.cases import open_case
from reportgen.classes import class_marking
from reportgen.classes.class_marking import Graded
from reportgen.classes.variants import make_variants
from reportgen.document import text_of
from reportgen.marking.judging import compare, mark
from reportgen.marking.marking_policy import Policy
from reportgen.marking.marking_scheme import marking_scheme
from reportgen.marking.mistakes import Mistake
from reportgen.marking.toleranced_key import key_of
from tests.marking import demo, students

FOLDER = Path(__file__).parents[2] / "assignments" / "plane-motion"
STUDENTS = 12
CHOICES = {
    "10": {"omega: 6 rad/s": "omega: [4 rad/s, 5 rad/s, 6 rad/s, 8 rad/s]", "r: 100 mm": "r: [80 mm, 100 mm, 120 mm]"},
    "17": {
        "value: 1 rad/s": "value: [1 rad/s, 1.5 rad/s, 2 rad/s, 2.5 rad/s]",
        "B: {at: [0 mm, 100 mm]}": "B: {from: A, distance: {from: 80 mm, to: 120 mm, step: 5 mm}, angle: 90 deg}",
    },
    "18": {
        "value: 10 rad/s": "value: [6 rad/s, 8 rad/s, 10 rad/s, 12 rad/s]",
        "distance: 0.2 m": "distance: {from: 0.15 m, to: 0.3 m, step: 0.01 m}",
    },
}
"""What is drawn in place of a value, by the exercise."""
SLIP = {"10": "v.B", "17": "v.C", "18": "a.BA.n"}
"""Where the first student slips: everything after it stands on it."""


@pytest.fixture(scope="module", params=sorted(CHOICES))
def drawn(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> tuple[str, Path]:
    """An exercise and the folder of its twelve variants."""
    name, folder = request.param, tmp_path_factory.mktemp(f"class-{request.param}")
    text = (FOLDER / f"{name}.yaml").read_text(encoding="utf-8")
    for old, new in CHOICES[name].items():
        assert text.count(old) == 1
        text = text.replace(old, new)
    (folder / "spec.yaml").write_text(text, encoding="utf-8")
    roster = "id,name,class\n" + "".join(f"S{number:02d},Student {number},K1\n" for number in range(1, STUDENTS + 1))
    (folder / "roster.csv").write_text(roster, encoding="utf-8")
    made = make_variants(folder / "spec.yaml", folder / "roster.csv", folder / "variants", False, "en")
    assert len(made.files) == STUDENTS
    return name, folder


@pytest.fixture(scope="module")
def graded(drawn: tuple[str, Path]) -> Graded:
    """The sheets of the class, written with three figures; the first student doubles one value and goes on from it."""
    name, folder = drawn
    (folder / "sheets").mkdir()
    for path in sorted((folder / "variants").glob("S*.yaml")):
        scheme = marking_scheme(open_case(path))
        where = SLIP[name]
        slip = Mistake("doubled", where, {where: lambda value, _: value * 2}) if path.stem == "S01" else None
        sheet = students.written(scheme, students.worked_out(scheme, slip))
        (folder / "sheets" / f"{path.stem}.xlsx").write_bytes(demo.workbook(scheme.key, sheet))
    return class_marking.grade([folder / "sheets"], folder / "variants", Policy())


def test_variants_differ_and_can_be_worked_out(drawn: tuple[str, Path]) -> None:
    paths = sorted((drawn[1] / "variants").glob("S*.yaml"))
    answers = {tuple(round(float(row.values[0]), 9) for row in key_of(open_case(path)).asked) for path in paths}
    assert len(answers) > STUDENTS / 2


def test_right_sheets_get_all_marks(graded: Graded) -> None:
    assert graded.problems == ()
    full = {marking.key.id for marking in graded.markings if marking.points == marking.out_of}
    assert full == {f"S{number:02d}" for number in range(2, STUDENTS + 1)}


def test_a_slip_costs_one_mark_and_is_followed_through(drawn: tuple[str, Path], graded: Graded) -> None:
    marking = next(one for one in graded.markings if one.key.id == "S01")
    assert [cell.id for cell in marking.first_errors] == [SLIP[drawn[0]]]
    assert marking.out_of - marking.points == 1


def test_comparing_names_the_slip_and_no_answer(drawn: tuple[str, Path], graded: Graded) -> None:
    folder = drawn[1]
    file = folder / "variants" / "S01.yaml"
    lines, agrees = compare(open_case(file, "en"), folder / "sheets" / "S01.xlsx", hint=True)
    assert not agrees
    right = key_of(open_case(file, "en")).row(SLIP[drawn[0]])
    assert f"{float(right.values[0]):.3g}" not in "\n".join(lines)


def test_the_task_holds_no_answer(drawn: tuple[str, Path]) -> None:
    """None of the numbers asked for that have four figures stands in it; in the key each of them does."""
    file = drawn[1] / "variants" / "S02.yaml"
    task, key = api.task_files(file, "typst", "en")["task.pdf"], api.key_files(file, "typst", "en", ("pdf",))["key.pdf"]
    texts = ["".join(page.get_text() for page in pymupdf.open(stream=pdf)) for pdf in (task, key)]
    rows = key_of(open_case(file, "en")).asked
    shown = [write(abs(float(row.printed[0])), row.decimals, "en") for row in rows if row.decimals is not None]
    telling = [text for text in shown if len(text.replace(".", "").strip("0")) >= 4]
    assert telling
    assert [text for text in telling if text in texts[0]] == []
    assert [text for text in telling if text not in texts[1]] == []


def test_an_open_sense_is_said_and_any_sign_is_right() -> None:
    """Accelerations tell ω² alone (exercise 19): text, answers, key and marks have the size of ω, and ε its sign."""
    case = open_case(FOLDER / "19.yaml", "en")
    key = key_of(case)
    assert key.find("turn.omega.1") is None
    row = key.row("omega.1")
    assert row.open_sense
    assert row.positive == "magnitude"
    assert row.sense == ("",)
    assert key.row("turn.eps.1").sense == ("anticlockwise",)
    page = text_of(case.document())
    assert "its sense cannot be determined" in page
    assert re.search(r"\|ω_1\|[^\n]*1\.4142\d* rad/s[^\n]*not determined by the data", page)
    scheme = marking_scheme(case)
    for other in ("", "omega.1"):
        turned = students.sheet(scheme, lambda row, _, value, other=other: -value if row.id == other else value)
        marking = mark(scheme, turned)
        assert marking.points == marking.out_of
