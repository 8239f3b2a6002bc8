"""What is read of a filled sheet: numbers as students write them, and cells found by their words."""

from __future__ import annotations

import datetime
import math
import re
import zipfile
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from openpyxl import load_workbook

from reportgen.base.errors import AssignmentError
from reportgen.base.records import replace
from reportgen.base.units import Language, QuantityFault
from reportgen.case.answer_key import Key
from reportgen.formula.vocabulary import KINDS
from reportgen.marking.answer_sheet import answer_book, read_submission
from reportgen.marking.marking_data import Submission
from reportgen.marking.student_numbers import decimal_mark, is_blank, read_number
from reportgen.workbook import write_csv, write_xlsx
from tests.marking.keys import csv_rows, small_key

HEAD, FIRST = 3, 5
"""The row of the sheet's head; the column of single values.  Rows and columns from 1."""


# --- numbers --------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "unit", "value"),
    [
        ("12,34", "m", 12.34),
        ("12.34", "m", 12.34),
        ("1.234,5", "m", 1234.5),
        ("1,234.5", "m", 1234.5),
        ("1.234.567", "m", 1234567),
        ("12 300", "N", 12300),
        ("12\u00a0300,5", "N", 12300.5),
        ("12'345.6", "N", 12345.6),
        ("\N{MINUS SIGN}3", "m", -3),
        ("– 3,5", "m", -3.5),
        ("+.5", "m", 0.5),
        ("5.", "m", 5),
        ("0,123", "m", 0.123),
        ("1.2e3", "N", 1200),
        ("1,2E-3", "N", 0.0012),
        ("1,2·10^3", "N", 1200),
        ("1.2x10^3", "N", 1200),
        ("1.2 × 10³", "N", 1200),
        ("1,2.10^-3", "N", 0.0012),
        ("-1.5·10⁻³", "m", -0.0015),
        ("10^3", "N", 1000),
        ("≈ 3,2", "m", 3.2),
        ("12.3 mm/s", "m/s", 0.0123),
        ("0,5 m", "mm", 500),
        ("0.5m", "mm", 500),
        ("30 deg", "°", 30),
        ("30°", "°", 30),
        ("30 độ", "°", 30),
        (f"{math.pi / 6} rad", "°", 30),
        ("2 1/s", "rad/s", 2),
        ("2 s^-1", "rad/s", 2),
        ("60 rpm", "rad/s", 2 * math.pi),
        ("300 vg/ph", "rpm", 300),
        ("12 Nm", "N·m", 12),
        ("1.2 kNm", "N·m", 1200),
        ("1.2 kgm2", "kg·m²", 1.2),
        ("4 m/s2", "m/s²", 4),
        ("2 m/(s.mm)", "m/(s·mm)", 2),
        # Signs as Word, a phone or a web page put them: hyphens, a figure dash, small and raised minus.
        *((f"{minus}3,5", "m", -3.5) for minus in "\u2010\u2011\u2012\u2013\u2014\ufe63\uff0d\u207b"),
        ("1.2e\u22123", "N", 0.0012),
        ("1,2e\u20133", "N", 0.0012),
        ("1,2\u221910^-3", "N", 0.0012),
        ("1,2·10^{-3}", "N", 0.0012),
        ("1,2·10^{\u22123}", "N", 0.0012),
        ("1.2 e1", "N", 12),
        ("12\u2009300", "N", 12300),
        ("12\u2007300,5", "N", 12300.5),
        ("\u200b3,5", "m", 3.5),
        ("\ufeff3,5 m", "m", 3.5),
        # Units in Cyrillic and Han, and without the sign of a product.
        ("12 Нм", "N·m", 12),
        ("1,2 кНм", "N·m", 1200),
        ("2 1/с", "rad/s", 2),
        ("5 毫米", "m", 0.005),
        ("3 牛·米", "N·m", 3),
        ("3 米/秒", "m/s", 3),
        # Degrees, minutes and seconds: 12° + 30/60 + 36/3600.
        ("12°30′", "°", 12.5),
        ("-12° 30' 36\"", "°", -12.51),
        ("12°30′", "rad", math.radians(12.5)),
    ],
)
def test_a_number_is_read_as_it_is_meant(text: str, unit: str, value: float) -> None:
    # 1e-12: nothing but the rounding of floats stands between what is written and what is read.
    for mark in (".", ","):
        assert read_number(text, unit, mark)[0] == pytest.approx(value, rel=1e-12)


@pytest.mark.parametrize(
    ("text", "unit", "code"),
    [
        ("about 3", "m", "not-a-number"),
        ("1 2", "m", "not-a-number"),
        ("1.23.4", "m", "not-a-number"),
        ("1,2,3.4", "m", "not-a-number"),
        ("nan", "m", "not-a-number"),
        ("3" * 70, "m", "not-a-number"),
        ("1e999", "m", "not-finite"),
        ("12 N", "m", "wrong-unit"),
        ("12 Nm/s", "N·m", "wrong-unit"),
        ("12 m", "°", "wrong-unit"),
        ("5 xyz", "m", "unknown-unit"),
        ("5 m; rm -rf", "m", "unknown-unit"),
        ("3 mm", "", "unexpected-unit"),
        # Worked out, these would take for ever.
        ("1 m^9^9^9", "m", "unknown-unit"),
        ("1 m^(9**9**9)", "m", "unknown-unit"),
        ("1 (m^9)^9", "m", "unknown-unit"),
        ("1 m9^9^9^9", "m", "unknown-unit"),
        ("1 m^9⁴⁴⁴⁴⁴⁴⁴⁴", "m", "unknown-unit"),
        ("1 m⁴⁴⁴⁴⁴⁴⁴^4", "m", "unknown-unit"),
        ("1 m* *9* *9* *9", "m", "unknown-unit"),
    ],
)
def test_what_is_no_number_of_the_kind_says_why(text: str, unit: str, code: str) -> None:
    with pytest.raises(QuantityFault) as caught:
        read_number(text, unit, ".")
    assert caught.value.code == code


def test_one_mark_before_three_digits_is_read_by_the_sheets_other_numbers() -> None:
    assert read_number("1.234", "m", ".") == (1.234, True)
    assert read_number("1.234", "m", ",") == (1234, True)
    assert read_number("1,234", "m", ",") == (1.234, True)
    assert read_number("1.234", "m", ".", agreed=True) == (1.234, False)
    assert decimal_mark(["1.234", "0.5", "12.3"], "vi") == (".", True)
    assert decimal_mark(["1.234", "2,345"], "vi") == (",", False)
    assert decimal_mark(["0.5", "0,5"], "en") == (".", False)
    assert decimal_mark(["0,123", "word", "1.234,5"], "en") == (",", True)


@given(
    st.text(alphabet="0123456789.,eE+-−–·×xX*^()/ °%'²³⁻¹mNskgradvgphdộ\u00a0\n=≈", max_size=70) | st.text(max_size=20)
)
def test_any_text_is_a_finite_number_or_a_fault(text: str) -> None:
    codes = set()
    for unit in ("m/s", ""):
        try:
            value = read_number(text, unit, ",")[0]
        except QuantityFault as fault:
            codes.add(fault.code)
        else:
            assert math.isfinite(value)
    assert codes <= {"not-a-number", "not-finite", "wrong-unit", "unknown-unit", "unexpected-unit"}
    assert decimal_mark([text], "vi")[0] in (".", ",")


@pytest.mark.parametrize("kind", KINDS)
def test_the_unit_of_every_kind_of_quantity_is_understood_as_the_sheet_prints_it(kind: str) -> None:
    unit = KINDS[kind].unit
    assert read_number(f"2 {unit}", unit, ".") == (2, False)


@pytest.mark.parametrize("text", ["", " ", "-", "–", "−", "…"])
def test_a_dash_is_no_answer(text: str) -> None:
    assert is_blank(text)
    assert not is_blank(text + "1")


# --- sheets ---------------------------------------------------------------------------------------


def filled(tmp_path: Path, key: Key, values: dict[tuple[str, int], object], name: str = "work") -> Path:
    """The key's sheet with some cells filled in, as a spreadsheet program would leave it."""
    path = tmp_path / f"{name}.xlsx"
    path.write_bytes(write_xlsx(answer_book(key)))
    book = load_workbook(path)
    page = book.worksheets[0]
    rows = {str(page.cell(n, 1).value): n for n in range(HEAD + 1, page.max_row + 1)}
    for (id, position), value in values.items():
        page.cell(rows[id], FIRST + position, value)
    book.save(path)
    return path


def numbers(submission: Submission) -> dict[tuple[str, int], float]:
    return {place: one.value for place, one in submission.values.items()}


def test_values_are_found_by_id_and_position(tmp_path: Path) -> None:
    values = {("omega.1", 0): 31.4, ("v.B", 1): "4,71", ("v.B", 3): "−120 cm/s", ("M.eq", 2): -1234.5}
    submission = read_submission(filled(tmp_path, small_key(), values), small_key())
    assert numbers(submission) == pytest.approx(
        {("omega.1", 0): 31.4, ("v.B", 1): 4.71, ("v.B", 3): -1.2, ("M.eq", 2): -1234.5}
    )
    assert not submission.problems
    assert not submission.notes
    assert submission.assignment == "crank-07"


def test_the_key_is_found_by_the_name_on_the_sheet_then_by_the_files_stem(tmp_path: Path) -> None:
    keys = {key.id: key for key in (small_key(), small_key("en", "other"))}
    path = filled(tmp_path, small_key(), {("omega.1", 0): 31.4}, name="other")
    assert read_submission(path, keys.__getitem__).assignment == "crank-07"
    plain = tmp_path / "other.csv"
    plain.write_text("id,Value,1\nomega.1,31.4,\n", encoding="utf-8")
    assert read_submission(plain, keys.__getitem__).assignment == "other"
    plain = plain.rename(tmp_path / "nobody.csv")
    with pytest.raises(AssignmentError) as caught:
        read_submission(plain, keys.__getitem__, "en")
    assert [problem.code for problem in caught.value.problems] == ["sheet-unknown"]


def test_a_page_saved_as_csv_is_known_by_its_title(tmp_path: Path) -> None:
    """Spreadsheet programs save the page in view alone, under any name: its title is all that names it."""
    keys = {key.id: key for key in (small_key(), small_key("en", "other"))}
    for language, title in (("en", "Answer sheet – other"), ("vi", "Phiếu trả lời – other")):
        path = tmp_path / f"answers-{language}.csv"
        path.write_text(f"{title};;;\n\nid;Value;1\nomega.1;31,4;\n", encoding="utf-8")
        assert read_submission(path, keys.__getitem__).assignment == "other"
    path.write_text("Notes – other;;;\nid;Value;1\nomega.1;31,4;\n", encoding="utf-8")
    with pytest.raises(AssignmentError):
        read_submission(path, keys.__getitem__)


def test_a_sheet_of_another_assignment_is_refused_where_it_names_it(tmp_path: Path) -> None:
    path = filled(tmp_path, small_key(id="../../etc"), {})
    with pytest.raises(AssignmentError) as caught:
        read_submission(path, small_key())
    (problem,) = caught.value.problems
    assert problem.code == "sheet-of-another"
    assert str(problem.location) == f"{path}:Thông tin!B1"


def test_a_sheet_of_another_machine_is_refused(tmp_path: Path) -> None:
    """Two courseworks of one class have assignments of the same names."""
    path = filled(tmp_path, replace(small_key(), kind="shaper"), {})
    with pytest.raises(AssignmentError) as caught:
        read_submission(path, small_key())
    (problem,) = caught.value.problems
    assert problem.code == "sheet-of-another"
    assert str(problem.location) == f"{path}:Thông tin!B2"
    assert "shaper" in problem.message


def test_rows_and_columns_may_be_moved(tmp_path: Path) -> None:
    path = tmp_path / "sorted.csv"
    path.write_text(
        "Position 3;Value;unit;id;Pos. 1;note\n-1,2;;m/s;v.B;4,71;mine\n;31,4;rad/s;omega.1;;\n", encoding="utf-8"
    )
    assert numbers(read_submission(path, small_key())) == {("v.B", 3): -1.2, ("v.B", 1): 4.71, ("omega.1", 0): 31.4}


def test_the_csv_of_the_sheet_is_read_whatever_the_separator(tmp_path: Path) -> None:
    rows = csv_rows(small_key("en"))
    for row in rows:
        if row and row[0] == "v.B":
            row[5:7] = ["4.71", "2.36"]
    path = tmp_path / "any.csv"
    path.write_bytes(write_csv(rows))
    for separator in (",", ";", "\t"):
        text = write_csv(rows).decode("utf-8-sig").replace(",", separator)
        path.write_text(text, encoding="utf-8")
        assert numbers(read_submission(path, small_key())) == {("v.B", 1): 4.71, ("v.B", 2): 2.36}


def test_a_cell_that_holds_no_number_is_a_problem_of_its_own(tmp_path: Path) -> None:
    values = {
        ("v.B", 1): "see page 3",
        ("v.B", 2): datetime.datetime(2024, 2, 1),
        ("v.B", 3): "#DIV/0!",
        ("v.B", 4): True,
        ("dir.v.B", 1): "=1/0",
        ("dir.v.B", 2): "12 N",
        ("omega.1", 0): 31.4,
    }
    path = filled(tmp_path, small_key(), values)
    submission = read_submission(path, small_key(), "en")
    assert {place: problem.code for place, problem in submission.problems.items()} == {
        ("v.B", 1): "not-a-number",
        ("v.B", 2): "cell-date",
        ("v.B", 3): "cell-error",
        ("v.B", 4): "cell-boolean",
        ("dir.v.B", 1): "cell-formula",
        ("dir.v.B", 2): "wrong-unit",
    }
    assert numbers(submission) == {("omega.1", 0): 31.4}
    problem = submission.problems["v.B", 1]
    assert str(problem) == f"{path}:Bài làm!F11: error[not-a-number]: “see page 3” is not a number"


def test_a_formulas_stored_result_is_taken_and_noted(tmp_path: Path) -> None:
    path = filled(tmp_path, small_key(), {("omega.1", 0): "=10*PI()"})
    with zipfile.ZipFile(path) as old:
        parts = {name: old.read(name) for name in old.namelist()}
    name = "xl/worksheets/sheet1.xml"
    parts[name], count = re.subn(
        rb"(<f>10\*PI\(\)</f>)(?:<v\s*/>|<v></v>)", rb"\1<v>31.41592653589793</v>", parts[name]
    )
    assert count == 1
    with zipfile.ZipFile(path, "w") as new:
        for part, data in parts.items():
            new.writestr(part, data)
    submission = read_submission(path, small_key())
    assert numbers(submission) == {("omega.1", 0): pytest.approx(10 * math.pi)}
    assert [note.code for note in submission.notes] == ["cell-formula-used"]


def test_what_the_assignment_does_not_ask_for_is_noted(tmp_path: Path) -> None:
    path = tmp_path / "extra.csv"
    path.write_text(
        "id,Value,1,2,9\nv.B,,4.71,,3\nv.Z,,1,,\n,,5,,\nM.eq,,12.5,-3,\nl.AB,0.2,,,\n,Sum,,,\n", encoding="utf-8"
    )
    submission = read_submission(path, small_key())
    # M.eq is asked at position 2 alone; given data are the assignment's, whatever the sheet says.
    assert numbers(submission) == {("v.B", 1): 4.71, ("M.eq", 2): -3.0}
    assert [note.code for note in submission.notes] == [
        "cell-no-position",
        "cell-unknown-row",
        "cell-no-row",
        "cell-no-row",
    ]


def test_one_value_in_two_cells_must_be_one_number(tmp_path: Path) -> None:
    path = tmp_path / "twice.csv"
    path.write_text("id,Value,1,2\nv.B,,4.71,1\nv.B,,4.71,2\n", encoding="utf-8")
    submission = read_submission(path, small_key())
    assert numbers(submission) == {("v.B", 1): 4.71}
    assert submission.problems["v.B", 2].code == "cell-repeated"
    assert str(submission.problems["v.B", 2].location) == f"{path}:3:11"


def test_a_number_that_reads_two_ways_is_noted_unless_the_sheet_decides(tmp_path: Path) -> None:
    path = tmp_path / "marks.csv"
    path.write_text("id;Value;1;2\nv.B;;4.710;\n", encoding="utf-8")
    alone = read_submission(path, small_key("vi"), "en")
    # v_B is 4.71 there: neither reading of a lone number costs its mark, and both are told.
    assert numbers(alone) == {("v.B", 1): 4.71}
    (note,) = alone.notes
    assert note.code == "cell-thousands"
    assert "4.71 or 4710" in note.message
    path.write_text("id;Value;1;2\nv.B;;4.710;2.4\n", encoding="utf-8")
    decided = read_submission(path, small_key("vi"))
    assert numbers(decided) == {("v.B", 1): 4.71, ("v.B", 2): 2.4}
    assert not decided.notes


@pytest.mark.parametrize("language", ["vi", "en"])
@pytest.mark.parametrize(("right", "read"), [(1.42, 1.42), (1420.0, 1420.0), (-1.3, 1.42), (900, 1420.0), (0, None)])
@pytest.mark.parametrize("text", ["1.420", "1,420"])
def test_a_lone_number_is_read_in_the_way_that_fits(
    tmp_path: Path, text: str, right: float, read: float | None, language: Language
) -> None:
    """Where nothing fits, a force that is nothing, it is read as the language of the sheet has it."""
    key = small_key(language)
    changed = [replace(row, values=np.full(4, right)) if row.id == "v.B" else row for row in key.rows]
    path = tmp_path / "lone.csv"
    path.write_text(f"id;Value;1;2\nv.B;;{text};\n", encoding="utf-8")
    submission = read_submission(path, replace(key, rows=tuple(changed)))
    decimal = (text[1] == ",") == (language == "vi")
    assert numbers(submission) == {("v.B", 1): (1.42 if decimal else 1420.0) if read is None else read}
    assert [note.code for note in submission.notes] == ["cell-thousands"]


@pytest.mark.parametrize("text", ["a,b\n1,2\n", "id\nv.B\n", "Value\n3\n"])
def test_a_table_that_is_no_answer_sheet_is_refused(tmp_path: Path, text: str) -> None:
    path = tmp_path / "x.csv"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(AssignmentError) as caught:
        read_submission(path, small_key())
    assert [problem.code for problem in caught.value.problems] == ["sheet-no-head"]


def test_a_file_that_is_not_there_is_a_fault(tmp_path: Path) -> None:
    with pytest.raises(AssignmentError):
        read_submission(tmp_path / "none.xlsx", small_key())


def test_the_answers_are_read_from_their_page_though_another_has_a_head(tmp_path: Path) -> None:
    path = filled(tmp_path, small_key(), {("omega.1", 0): 31.4})
    book = load_workbook(path)
    other = book.create_sheet("scratch", 0)
    other.append(["id", "Value"])
    other.append(["omega.1", 99])
    book.save(path)
    assert numbers(read_submission(path, small_key())) == {("omega.1", 0): 31.4}
