"""What comes back: the student's own sheet with colours, comments and points, the page in words, the class."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from openpyxl import load_workbook

from reportgen.base.errors import CellLocation, Problem
from reportgen.base.records import replace
from reportgen.base.template_folders import languages, search_path
from reportgen.base.units import Language
from reportgen.base.words import load_words
from reportgen.document import Figure, Table, plain, text_of
from reportgen.drawing import Label
from reportgen.marking.class_marks import grade_rows
from reportgen.marking.class_page import class_document
from reportgen.marking.feedback import FIRST, STYLES, feedback_book, feedback_document, mistake_inlines, points_text
from reportgen.marking.marking_data import Answer, Marked, Marking, Notice, Submission, Unmarked, Verdict
from reportgen.marking.marking_policy import Policy
from reportgen.marking.mistakes import CONVENTIONS, WRONG_DATUM
from reportgen.marking.summary_comment import comment
from reportgen.workbook import write_csv, write_xlsx
from reportgen.workbook.table_writing import FILLS
from tests.marking.keys import small_key
from tests.marking.students import NAMES, OF_BALANCING, OF_FURTHER_KEYS, OF_TRIADS, OF_TRUE_MOTION

FILE = "/somewhere/of/the/instructor/work.xlsx"
LANGUAGES: tuple[Language, ...] = languages()
OF_PLANS = {f"{kind}-{how}" for kind in ("force", "part") for how in ("left-out", "reversed")} | {
    "load-forgotten",
    "load-reversed",
}
SLIPS = {"too-few-figures", "rows-swapped", "wrong-column", "other-scale", *(name for name, _, _ in CONVENTIONS)} | {
    "positions-exchanged"
}


def at(row: int, column: int) -> CellLocation:
    return CellLocation(FILE, row, column, sheet="Answers")


def cell(id: str, position: int, verdict: Verdict, given: float | None, expected: float, **more: Any) -> Marked:
    points = float(verdict in (Verdict.right, Verdict.follows))
    return Marked(id, position, verdict, given, expected, expected, 0.05, points, 1.0, written=given, **more)


def marking(language: Language = "en", student: str = "Nguyễn Văn A") -> Marking:
    """One of each verdict: ω₁ wrong first, as rpm; v_B follows, is right, wrong, unreadable."""
    key = small_key(language, student=student)
    cells = (
        cell("mu.l", 0, Verdict.right, 0.003, 0.003),
        cell("omega.1", 0, Verdict.wrong, 300.0, 31.4159, first=True, mistake="rpm-for-radians", where="omega.1"),
        cell("v.B", 1, Verdict.follows, 45.0, 4.71),
        cell("v.B", 2, Verdict.right, 2.36, 2.36),
        cell("v.B", 3, Verdict.wrong, 7.77, -1.2, classmates=("classmate-99",)),
        cell("v.B", 4, Verdict.unreadable, None, 0.0),
        cell("dir.v.B", 1, Verdict.blank, None, 90.0),
        cell("dir.v.B", 2, Verdict.implausible, 180.0, 180.0),
        cell("dir.v.B", 3, Verdict.right, 270.0, 270.0),
        cell("M.eq", 2, Verdict.wrong, 1e300, -1234.5, first=True),
    )
    values = {(one.id, one.position): Answer(one.given, "", at(1, 1)) for one in cells if one.given is not None}
    problems = {("v.B", 4): Problem("not-a-number", "“see page 3” is not a number", at(11, 8))}
    return Marking(
        key,
        Submission(key.id, FILE, values, problems),
        cells,
        (Notice("classmate", (("v.B", 3),), classmate="classmate-99"),),
    )


def sheet(book: bytes, tmp_path: Path) -> dict[tuple[str, str], Any]:
    """Cells of the first page by id and head."""
    path = tmp_path / "back.xlsx"
    path.write_bytes(book)
    page = load_workbook(path).worksheets[0]
    heads = [str(one.value) for one in page[3]]
    return {
        (str(line[0].value or line[1].value or ""), head): one
        for line in page.iter_rows(min_row=4)
        for head, one in zip(heads, line, strict=True)
    }


def test_every_verdict_has_its_colour_and_what_is_not_right_a_comment(tmp_path: Path) -> None:
    found = marking()
    cells = sheet(write_xlsx(feedback_book(found)), tmp_path)
    for one in found.cells:
        back = cells[one.id, f"Position {one.position}" if one.position else "Value"]
        style = FIRST if one.first else STYLES[one.verdict]
        assert back.fill.start_color.rgb == f"00{FILLS[style]}"
        assert back.value == one.given
        assert (back.comment is None) == (one.verdict is Verdict.right)
    first = cells["omega.1", "Value"].comment.text
    assert "revolutions per minute was used at ω_1" in first
    assert "Expected: 31.42 ± 0.050 rad/s." in first
    assert "“see page 3” is not a number" in cells["v.B", "Position 4"].comment.text
    assert cells["l.AB", "Value"].value == 0.15


def test_points_stand_behind_each_row_and_their_sum_below(tmp_path: Path) -> None:
    cells = sheet(write_xlsx(feedback_book(marking())), tmp_path)
    earned = {id: one.value for (id, head), one in cells.items() if head == "Points" and one.value is not None}
    worth = {id: one.value for (id, head), one in cells.items() if head == "Out of" and one.value is not None}
    assert earned == {"mu.l": 1, "omega.1": 0, "v.B": 2, "dir.v.B": 1, "M.eq": 0, "Total": 4}
    assert worth == {"mu.l": 1, "omega.1": 1, "v.B": 4, "dir.v.B": 3, "M.eq": 1, "Total": 10}


@pytest.mark.parametrize("language", LANGUAGES)
def test_answers_are_told_only_if_they_may_be(language: Language, tmp_path: Path) -> None:
    found = marking(language)
    wanted = {"31.42", "31,42", "-1234.5", "−1234,50", "−1234.50", "4.71", "4,71", "−1.20", "−1,20"}
    for shown in (True, False):
        cells = sheet(write_xlsx(feedback_book(found, shown)), tmp_path)
        texts = [one.comment.text for one in cells.values() if one.comment]
        texts.append(text_of(feedback_document(found, "Crank", Policy(show_answers=shown))))
        assert any(value in text for text in texts for value in wanted) == shown


@pytest.mark.parametrize("language", LANGUAGES)
def test_feedback_holds_nothing_of_others_nor_of_the_instructors_disk(language: Language, tmp_path: Path) -> None:
    found = marking(language)
    book = feedback_book(found)
    values = [str(one) for page in book.sheets for row in page.rows for one in row]
    for text in (*values, text_of(feedback_document(found, "Crank")), str(feedback_document(found, "Crank"))):
        assert "classmate-99" not in text
        assert "somewhere" not in text
    assert any("= classmate-99 (1: v_B (3)" in str(one) for one in grade_rows([found], language)[1])


def test_the_page_tells_errors_by_name_what_followed_and_points_by_part() -> None:
    text = text_of(feedback_document(marking(), "Crank"))
    assert "Result: 4 of 10 points." in text
    assert "1. ω_1: your value is 300 rad/s, expected is 31.42 rad/s. The speed in revolutions per minute" in text
    assert "2. M_cb at position 2: your value is 1·10³⁰⁰ N·m" in text
    assert "earned their points: v_B (1)." in text
    assert "Answers!H11: “see page 3” is not a number." in text
    assert "Velocities | 2 | 1 | 2 | 1 | 1 | 1 | 3 | 8" in text
    assert "Total | 3 | 1 | 3 | 1 | 1 | 1 | 4 | 10" in text


def test_a_perfect_sheet_hears_of_no_error() -> None:
    whole = marking()
    perfect = replace(whole, cells=tuple(one for one in whole.cells if one.verdict is Verdict.right), flags=())
    text = text_of(feedback_document(perfect, "Crank"))
    assert "No wrong value was found." in text
    assert "Result: 3 of 3 points." in text
    assert "What followed" not in text


@pytest.mark.parametrize("language", LANGUAGES)
def test_an_empty_sheet_is_not_called_right_and_its_blanks_are_named(language: Language) -> None:
    found = marking(language)
    blank = [replace(one, verdict=Verdict.blank, given=None, points=0.0, first=False) for one in found.cells]
    words = load_words(search_path(language))
    empty = replace(found, cells=tuple(blank), flags=())
    page = text_of(feedback_document(empty, "Crank"))
    short = "\n".join(comment(empty, Policy()))
    for text, said in ((page, words["feedback"]), (short, words["comment"])):
        assert said["no_firsts"] not in text
        assert said["nothing_given"] in text
    for symbol in ("ω_1", "v_B", "α_vB"):
        assert f"– {symbol}" in short
    assert page.count(words["feedback"]["left_blank"]) == 1


def test_a_row_that_is_empty_in_part_is_named_with_its_positions() -> None:
    """The direction of v_B is blank at position 1 of three; an optional cell that earns nothing is not missed."""
    found = marking()
    assert "– α_vB (1)" in "\n".join(comment(found, Policy()))
    optional = replace(found, cells=tuple(replace(one, worth=0.0) for one in found.cells))
    assert "α_vB" not in "\n".join(comment(optional, Policy()))


@pytest.mark.parametrize("language", LANGUAGES)
def test_there_are_words_for_every_mistake_verdict_and_warning(language: Language) -> None:
    words = load_words(search_path(language))
    key = small_key(language)
    for name in words["mistakes"]:
        one = cell("v.B", 1, Verdict.wrong, 1.0, 2.0, first=True, mistake=name, where="omega.1")
        assert any("ω" in str(inline) for inline in mistake_inlines(one, key, words))
        assert words["mistake_names"][name]
    assert set(words["mistakes"]) == {
        *NAMES,
        *OF_FURTHER_KEYS,
        *OF_TRUE_MOTION,
        *OF_BALANCING,
        *OF_TRIADS,
        *SLIPS,
        *OF_PLANS,
        WRONG_DATUM,
    }
    assert set(words["mistake_names"]) == {*words["mistakes"], "none"}
    assert {*words["verdicts"]} == {*Verdict, "first"} == {*words["verdict_notes"]}
    assert {*words["warnings"]} == {*words["warning_names"]}


def test_grades_have_a_row_for_everyone_and_no_live_formula() -> None:
    found = [marking(student="=cmd|'/c calc'!A1"), marking(student="B")]
    head, one, two, none = grade_rows(found, "en", [Unmarked(small_key(student="C"))])
    named = dict(zip(head, one, strict=True))
    assert named["points"] == 4
    assert named["out of"] == 10
    assert named["Velocities"] == 3
    assert (named["per cent"], named["mark"]) == (40, 4)
    assert named["first errors"] == "ω_1: rpm for rad/s; M_cb (2): not recognised"
    assert named["warnings"] == "a run of values of another sheet"
    assert two[1] == "B"
    assert none[1] == "C"
    assert none[3] is None
    assert b"'=cmd" in write_csv([one])


def test_the_class_page_has_marks_and_counts() -> None:
    found = [marking(student=f"Student {n}") for n in range(12)]
    tree = class_document(found, "crank", "en", [Unmarked(small_key(student="Absent"))])
    table, absent, unread, sections, questions = (block for block in tree.blocks if isinstance(block, Table))
    assert len(table.rows) == 13
    assert len(unread.rows) == 12
    for one in (table, absent, unread, sections, questions):
        assert sum(column.width for column in one.columns) <= 160
    # Of a question's cells those that are right or follow, of all; what all had right is only counted.
    shares = [[plain(cell.inlines, "en") for cell in row] for row in (*sections.rows, *questions.rows)]
    assert [(row[0], row[-2]) for row in shares] == [
        ("Balance of the driving link", "0"),
        ("Velocities", "38"),
        ("Dimensions and drawn lengths", "100"),
        ("ω_1", "0"),
        ("M_cb", "0"),
        ("α_vB", "33"),
        ("v_B", "50"),
    ]
    assert "Questions that all had right: 1." in text_of(tree)
    figures = [block for block in tree.blocks if isinstance(block, Figure)]
    assert len(figures) == 3
    assert all(scene.width < 160 for figure in figures for scene in figure.scenes)
    text = text_of(tree)
    assert "Sheets: 12; mean 40 %, median 40 %." in text
    assert "Not handed in: 1." in text


def test_quantities_beyond_the_room_of_a_chart_are_counted_together() -> None:
    whole = marking()
    rows = tuple(replace(whole.key.row("v.B"), id=f"v.B{n}") for n in range(30))
    cells = tuple(cell(row.id, 1, Verdict.wrong, 1.0, 2.0, first=True) for row in rows)
    tree = class_document([replace(whole, key=replace(whole.key, rows=rows), cells=cells)], "crank", "en")
    figure = [block for block in tree.blocks if isinstance(block, Figure)][1]
    labels = [item.content for scene in figure.scenes for item in scene.items if isinstance(item, Label)]
    assert "others (6)" in labels
    assert labels.count(rows[0].symbol) == 24


def test_a_class_without_sheets_has_a_page_too() -> None:
    text = text_of(class_document([], "crank", "vi", [Unmarked(small_key(student="Absent"))]))
    assert "Absent" in text


@pytest.mark.parametrize(("points", "text"), [(4.0, "4"), (2.5, "2,5"), (1 / 3, "0,33"), (math.pi, "3,14")])
def test_points_are_told_to_two_decimals_at_most(points: float, text: str) -> None:
    assert points_text(points, "vi") == text


@pytest.mark.parametrize(
    ("decimals", "expected", "band", "shown"),
    [
        (None, 7.37956877849, 0.082, "7.380 ± 0.082"),
        (4, 7.37956877849, 0.082, "7.380 ± 0.082"),
        (None, 1234.56789, 61.0, "1235 ± 61"),
        (2, 1234.5678, 0.0123, "1234.57 ± 0.012"),
        (0, 36.0, 0.0, "36 ± 0"),
    ],
)
def test_what_is_expected_has_the_figures_of_its_tolerance(
    decimals: int | None, expected: float, band: float, shown: str
) -> None:
    """In the comment on the cell and on the page; what the report prints shorter stays so."""
    key = small_key("en")
    rows = tuple(
        replace(row, decimals=decimals, values=np.array([expected])) if row.id == "omega.1" else row for row in key.rows
    )
    wrong = replace(cell("omega.1", 0, Verdict.wrong, 5.0, expected, first=True), band=band)
    values = {("omega.1", 0): Answer(5.0, "5", at(1, 1))}
    found = Marking(replace(key, rows=rows), Submission(key.id, FILE, values, {}), (wrong,))
    comments = [entry.comment for page in feedback_book(found).sheets for row in page.rows for entry in row]
    assert any(f"Expected: {shown} rad/s." in comment for comment in comments if comment)
    assert f"expected is {shown.partition(' ')[0]} rad/s" in text_of(feedback_document(found, "Crank"))
