"""The roster: headings in two languages, ids that are there once, faults at their cells; ids as file names."""

from __future__ import annotations

import io
import re
import unicodedata
from collections.abc import Callable
from pathlib import Path

import openpyxl
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from reportgen.base.errors import AssignmentError
from reportgen.base.words import messages
from reportgen.classes.roster import HANDED_IN, NAME_PARTS, PERSONAL, folded, folder_name, read_roster
from reportgen.workbook import Book, WorksheetData, write_xlsx

Put = Callable[..., Path]


@pytest.fixture
def put(tmp_path: Path) -> Put:
    def write(content: str | bytes, name: str = "roster.csv") -> Path:
        path = tmp_path / name
        path.write_bytes(content.encode() if isinstance(content, str) else content)
        return path

    return write


def faults_of(path: Path) -> list[str]:
    """Each fault as place and code."""
    with pytest.raises(AssignmentError) as caught:
        read_roster(path, "en")
    lines = [str(problem).splitlines()[0].replace(str(path), "FILE") for problem in caught.value.problems]
    return [re.sub(r": error\[(.*?)\].*", r" \1", line) for line in lines]


# --- names ------------------------------------------------------------------------------------------

RESERVED = {"CON", "PRN", "AUX", "NUL", *(f"{port}{k}" for port in ("COM", "LPT") for k in range(10))}


@pytest.mark.parametrize("id", ["K195520103001", "DTK1051010023", "20173456", "K58-01_2"])
def test_an_ordinary_id_is_its_own_name(id: str) -> None:
    assert folder_name(id) == id


@given(st.text(max_size=320))
@example("../../x")
@example("CON")
@example("con")
@example("NUL.txt")
@example("a/b\\c")
@example("x" * 300)
@example("trailing...")
@example("")
@example("~root")
@example("-rf")
@example("a\0b\n")
@example("\ud800")
def test_any_id_is_one_harmless_component(id: str) -> None:
    name = folder_name(id)
    assert re.fullmatch(r"[A-Za-z0-9][A-Za-z0-9_-]{0,63}", name)
    assert name.upper() not in RESERVED


@given(st.text(max_size=40), st.text(max_size=40))
@example("abc", "ABC")
@example("Đ1", "D1")
@example("a/b", "a_b")
def test_two_ids_never_share_a_name(one: str, other: str) -> None:
    """Not even where capitals and small letters are one; composed and decomposed are the same id."""
    same = unicodedata.normalize("NFC", one) == unicodedata.normalize("NFC", other)
    assert (folder_name(one).casefold() == folder_name(other).casefold()) == same


def test_an_id_made_to_look_hashed_is_hashed_again() -> None:
    forged = folder_name("../x").upper()
    assert folder_name(forged) != forged


def test_composed_and_decomposed_ids_are_one() -> None:
    assert folder_name(unicodedata.normalize("NFD", "Sinh viên Ế")) == folder_name("Sinh viên Ế")


# --- tables -----------------------------------------------------------------------------------------


def test_vietnamese_headings_composed_or_not(put: Put) -> None:
    header = "STT;Mã sinh viên;HỌ VÀ TÊN ;Lớp;Nhóm;Thư điện tử;Ghi chú"
    for form in ("NFC", "NFD"):
        text = unicodedata.normalize(form, f"{header}\n1;K1;Đỗ Hữu Ước;K58;2;u@x.vn;lớp trưởng\n")
        (student,) = read_roster(put(b"\xef\xbb\xbf" + text.encode())).students
        card = {"name": "Đỗ Hữu Ước", "id": "K1", "class": "K58", "section": "2", "email": "u@x.vn"}
        assert (student.card, student.overrides) == (card, {})


def test_names_in_two_columns_and_two_kinds_of_class(put: Put) -> None:
    path = put("Mã SV,Họ đệm,Tên,Lớp,Lớp hành chính,Lớp học phần\nK1,Nguyễn Thị,Ánh,K58,K5,NLM\nK2,,Nam,,K5,\n")
    assert [student.card for student in read_roster(path).students] == [
        {"name": "Nguyễn Thị Ánh", "id": "K1", "class": "K58", "section": "NLM"},
        {"name": "Nam", "id": "K2"},
    ]


def test_every_language_has_headings_for_the_same_columns() -> None:
    tables = {language: messages(language)["columns"] for language in ("vi", "en")}
    assert (
        set(tables["vi"])
        == set(tables["en"])
        == {
            *(*PERSONAL, *NAME_PARTS, HANDED_IN, "variant"),
            *("quantity", "position", "judgement", "value", "reason", "judged_by", "judged_on"),
        }
    )
    for table in tables.values():
        headings = [folded(heading) for names in table.values() for heading in names]
        assert len(set(headings)) == len(headings)


def test_blank_lines_quoted_commas_and_a_title_above(put: Put) -> None:
    path = put('Danh sách lớp\n\n,\nid,name,\n\n01,"Nam, Trần"\n  , \n02,Lan\n')
    roster = read_roster(path)
    assert [(one.id, one.card["name"]) for one in roster.students] == [("01", "Nam, Trần"), ("02", "Lan")]
    assert str(roster.students[1].location) == f"{path}:8:1"


def test_a_workbook_of_numbers_with_sheets_before_it(put: Put) -> None:
    book = Book(
        (
            WorksheetData("Cũ", (("MSSV",), ("K0",)), hidden=True),
            WorksheetData("Ghi chú", (("read me",),)),
            WorksheetData(
                "Lớp", (("MSSV", "Họ tên", "parameters.H (mm)"), (195520103001, "An", 95), ("007", "=1+1", None))
            ),
        )
    )
    path = put(write_xlsx(book), "roster.xlsx")
    roster = read_roster(path)
    assert [(one.id, one.card["name"]) for one in roster.students] == [("195520103001", "An"), ("007", "=1+1")]
    first = roster.students[0].overrides["parameters.H"]
    assert (first.text, str(first.location)) == ("95 mm", f"{path}:Lớp!C2")
    assert roster.students[1].overrides == {}


def test_all_faults_are_told_at_once_with_their_cells(put: Put) -> None:
    path = put(
        "id,name,Paramters.H,id\n"
        "K1,An\n"
        "k1,Other\n"
        ",Nobody\n"
        f"K2,{'x' * 301}\n"
        "K3,a\x07b\n"
        "Ế,composed\n"
        f"{unicodedata.normalize('NFD', 'ế')},decomposed\n"
    )
    assert faults_of(path) == [
        "FILE:1:9 unknown-column",
        "FILE:1:21 column-twice",
        "FILE:3:1 duplicate-id",
        "FILE:4:1 missing-id",
        "FILE:5:4 text-too-long",
        "FILE:6:4 control-character",
        "FILE:8:1 duplicate-id",
    ]


def test_a_duplicate_names_the_first(put: Put) -> None:
    with pytest.raises(AssignmentError) as caught:
        read_roster(put("id\nK1\nK2\nK1\n"), "en")
    assert "the id “K1” was already given at 2:1" in str(caught.value)


@pytest.mark.parametrize(
    ("content", "fault"),
    [("name,class\nAn,1\n", "FILE:1:1 no-id-column"), ("id,name\n", "FILE:1:1 empty-roster"), ("", "FILE:1:1 empty")],
)
def test_a_table_without_ids_or_students(put: Put, content: str, fault: str) -> None:
    assert faults_of(put(content)) == [fault]


def test_cells_without_a_value_are_faults(put: Put) -> None:
    book = openpyxl.Workbook()
    page = book.worksheets[0]
    page.append(["id", "name"])
    page.append(["K1", "=B9"])
    page.append(["#N/A", "x"])
    stream = io.BytesIO()
    book.save(stream)
    assert faults_of(put(stream.getvalue(), "r.xlsx")) == ["FILE:Sheet!B2 no-cell-value", "FILE:Sheet!A3 no-cell-value"]


@pytest.mark.parametrize(
    ("value", "number_format", "id"),
    [
        (125040, "00000000", "00125040"),
        (20125040, "00000000", "20125040"),
        (120125040, "00000000", "120125040"),
        (225520103001, '"K"000000000000', "K225520103001"),
        (123456, "000-000", "123-456"),
        (1234, r"00\.00", "12.34"),
        (42, "0000;-0000", "0042"),
        (125040, "General", "125040"),
        (125040, "0", "125040"),
        (125040, "#,##0", "125040"),
        (125040, "0.00", "125040"),
    ],
)
def test_an_id_is_read_as_its_cell_displays_it(put: Put, value: int, number_format: str, id: str) -> None:
    """Number formats by ECMA-376, 18.8.31: 0 is a digit with leading zeros, other signs stand where they are."""
    book = openpyxl.Workbook()
    page = book.worksheets[0]
    page.append(["id", "name", "parameters.H"])
    page.append([value, "An", 0.354])
    page["A2"].number_format, page["C2"].number_format = number_format, '00.0" mm"'
    stream = io.BytesIO()
    book.save(stream)
    (student,) = read_roster(put(stream.getvalue(), "r.xlsx")).students
    # A quantity keeps all its decimals, whatever its format shows.
    assert (student.id, student.overrides["parameters.H"].text) == (id, "0.354")


@pytest.mark.parametrize(
    "footer",
    [
        ",,Người lập danh sách\n",
        '\n,,"Thái Nguyên, ngày 5 tháng 9"\n,Người lập danh sách,\n,Lê Thị Hoa,\n',
        "\n,Tổng số: 2 sinh viên,\n",
    ],
)
def test_rows_below_the_students_are_left_out_with_a_note(put: Put, footer: str) -> None:
    roster = read_roster(put("MSSV,Họ tên,Lớp\nK1,An,56A\nK2,Bình,56A\n" + footer), "en")
    assert [student.id for student in roster.students] == ["K1", "K2"]
    assert {(note.code, note.level) for note in roster.notes} == {("roster-row-left", "note")}
    assert len(roster.notes) == footer.strip().count("\n") + 1


def test_a_student_without_an_id_within_the_table_is_a_fault(put: Put) -> None:
    """So is the last row of the table, unless an empty row parts it from the others."""
    assert faults_of(put("id,name\nK1,An\n,Bình\n\nK3,Chi\n,Dung\n")) == ["FILE:3:1 missing-id", "FILE:6:1 missing-id"]


def test_without_ids_students_are_known_by_their_e_mails(put: Put) -> None:
    """A list of Moodle without ID numbers; a local part that two students have says nothing."""
    table = "First name,Last name,Email address\nAn,Nguyễn,an.nguyen@x.vn\nBảo,Lê,lb@x.vn\nBình,Lê,LB@y.vn\n"
    roster = read_roster(put(table), "en")
    assert [one.id for one in roster.students] == ["an.nguyen", "lb@x.vn", "LB@y.vn"]
    assert [one.card["email"] for one in roster.students] == ["an.nguyen@x.vn", "lb@x.vn", "LB@y.vn"]
    assert [(note.code, note.level) for note in roster.notes] == [("roster-ids-mail", "note")]
    assert faults_of(put("name,email\nAn,an@x.vn\nBảo,\nChi,chi@x.vn\n")) == ["FILE:3:1 missing-id"]


# --- classes of China -------------------------------------------------------------------------------

CHINESE = (
    "机械2101班成绩表\n学 号,姓　名,班级,电子邮箱,parameters.H（mm）\n"
    "0210234,王　明,机械2101,w@x.cn,420\n2021010235,欧阳小燕,机械2101,,400\n"
)


@pytest.mark.parametrize("codec", ["utf-8", "utf-8-sig", "gbk", "utf-16"])
def test_a_chinese_roster_is_read_as_it_comes(put: Put, codec: str) -> None:
    """A title above, headings and names made even by blanks, no blank within names, zeros at the head of a number."""
    roster = read_roster(put(CHINESE.encode(codec)), "zh")
    first, second = roster.students
    assert first.card == {"name": "王明", "id": "0210234", "class": "机械2101", "email": "w@x.cn"}
    assert second.card["name"] == "欧阳小燕"
    assert second.overrides["parameters.H"].text == "400 mm"


@pytest.mark.parametrize(
    "table",
    [
        "学号,姓,名\n1,王,小明\n",
        "学号,姓名\n1,王小明\n",
        'Student,ID,SIS User ID,SIS Login ID,Section\n"王, 小明",77,1,wxm,机械\n',
    ],
)
def test_a_chinese_name_begins_with_that_of_the_family(put: Put, table: str) -> None:
    (student,) = read_roster(put(table), "zh").students
    assert student.card["name"] == "王小明"


# --- classes of Russia ------------------------------------------------------------------------------

RUSSIAN = "Номер зачётной книжки;Фамилия;Имя;Группа\n20210235;Ёлкина;Анна;МТ-21\n20210236;Щукин;Пётр;МТ-21\n"


@pytest.mark.parametrize("codec", ["utf-8", "cp1251"])
def test_a_russian_roster_is_read_as_excel_saves_it(put: Put, codec: str) -> None:
    roster = read_roster(put(RUSSIAN.encode(codec)), "ru")
    assert [(one.id, one.card["name"], one.card["class"]) for one in roster.students] == [
        ("20210235", "Ёлкина Анна", "МТ-21"),
        ("20210236", "Щукин Пётр", "МТ-21"),
    ]


@pytest.mark.parametrize(
    "data",
    [
        RUSSIAN.encode("koi8-r"),
        RUSSIAN.encode("cp866"),
        "id,name\nK1,José Müller\n".encode("cp1252"),
        "id,name\nK1,Nguyên Vàn\n".encode("cp1258"),
        b"id,name\nK1,\xff\xfe\x98\n",
    ],
)
def test_other_code_pages_are_refused_rather_than_misread(put: Put, data: bytes) -> None:
    (fault,) = faults_of(put(data))
    assert fault.endswith(" encoding")
