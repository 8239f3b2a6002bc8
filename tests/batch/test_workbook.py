"""Tables in and out: cells know their place, hostile files are refused, no text becomes a formula."""

from __future__ import annotations

import contextlib
import io
import re
import unicodedata
import zipfile
from collections.abc import Callable, Mapping
from pathlib import Path

import openpyxl
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from reportgen.errors import AssignmentError, CellMark, Mark, column_letters
from reportgen.workbook import Book, Cell, Entry, Page, Sheet, read, write_csv, write_xlsx

CYNICAL = ("=cmd|' /C calc'!A0", "+1+1", "-2+3", "@SUM(A1)", "\t=1", "=HYPERLINK(\"http://x\")", "'=1", "＝1")
NAMES = unicodedata.normalize("NFC", "Nguyễn Thị Ngọc Ánh"), unicodedata.normalize("NFD", "Đỗ Hữu Trường")


@pytest.fixture
def put(tmp_path: Path) -> Callable[[bytes, str], Path]:
    def write(content: bytes, name: str = "table.csv") -> Path:
        path = tmp_path / name
        path.write_bytes(content)
        return path

    return write


def texts(page: Page) -> list[list[str]]:
    return [[cell.text for cell in row] for row in page.rows]


def refusal(path: Path) -> str:
    with pytest.raises(AssignmentError) as caught:
        read(path, "en")
    (problem,) = caught.value.problems
    return str(problem).replace(str(path), "FILE").splitlines()[0].rpartition("]")[0] + "]"


# --- CSV --------------------------------------------------------------------------------------------


@pytest.mark.parametrize("mark", [b"", b"\xef\xbb\xbf"])
@pytest.mark.parametrize("separator", [",", ";", "\t"])
def test_separators_and_byte_order_mark(put: Callable[..., Path], mark: bytes, separator: str) -> None:
    lines = [["id", "name", "note"], ["01", f'"Trần{separator} Nam"', "a"], ["2", '"say ""x"""', ""]]
    path = put(mark + "\r\n".join(separator.join(line) for line in lines).encode())
    (page,) = read(path)
    assert texts(page) == [["id", "name", "note"], ["01", f"Trần{separator} Nam", "a"], ["2", 'say "x"']]


def test_the_separator_is_that_of_the_header_alone(put: Callable[..., Path]) -> None:
    (page,) = read(put(b'\r\n"a,b,c";id\n1,5;2,5\n'))
    assert texts(page) == [[], ["a,b,c", "id"], ["1,5", "2,5"]]


def test_cells_of_csv_know_line_and_column(put: Callable[..., Path]) -> None:
    path = put('id,name\n"1","two\r\nlines"\nx,ý,z\n'.encode())
    (page,) = read(path)
    places = {cell.text: str(cell.mark).removeprefix(str(path)) for row in page.rows for cell in row}
    first = {"id": ":1:1", "name": ":1:4", "1": ":2:1", "two\r\nlines": ":2:5"}
    assert places == {**first, "x": ":4:1", "ý": ":4:3", "z": ":4:5"}


def test_csv_is_composed(put: Callable[..., Path]) -> None:
    (page,) = read(put(f"name\n{NAMES[1]}\n".encode()))
    assert page.rows[1][0].value == unicodedata.normalize("NFC", NAMES[1])


@pytest.mark.parametrize(
    ("content", "told"),
    [
        (b"id\nab\xe9\n", "FILE:2:3: error[encoding]"),
        ("id\nÁ\n".encode("utf-16"), "FILE:1:1: error[encoding]"),
        (b"id,name\n1,a\0b\n", "FILE:2:4: error[binary]"),
        (b'id,name\n1,"open\n2,b\n', "FILE:2:3: error[quote-open]"),
        (b"id\n" * 10_001, "FILE:10001:1: error[table-too-large]"),
        (b"," * 600 + b"x", "FILE:1:601: error[table-too-large]"),
        (b"id\n" + b"x" * 40_000, "FILE:2:1: error[text-too-long]"),
        (b" \n", "FILE:1:1: error[empty]"),
        (b"x" * 10_000_001, "FILE:1:1: error[too-large]"),
    ],
)
def test_what_is_no_csv_is_refused_where_it_goes_wrong(put: Callable[..., Path], content: bytes, told: str) -> None:
    assert refusal(put(content)) == told


def test_a_missing_file_is_a_fault(tmp_path: Path) -> None:
    assert refusal(tmp_path / "none.csv") == "FILE:1:1: error[unreadable]"


CELL = st.text(st.characters(exclude_categories=("Cs",), exclude_characters="\0"), max_size=12)


@given(st.lists(st.lists(CELL, min_size=1, max_size=4), min_size=1, max_size=5))
@example([list(CYNICAL)])
@example([["-5", "'-5", "''=1", "'", "sep=;"]])
def test_csv_comes_back_as_it_was_written(tmp_path_factory: pytest.TempPathFactory, rows: list[list[str]]) -> None:
    """A header of five words says which separator it is; what is blank comes back as nothing."""
    path = tmp_path_factory.mktemp("csv") / "t.csv"
    path.write_bytes(write_csv([["a", "b", "c", "d", "e"], *rows]))
    (page,) = read(path)
    want = [[unicodedata.normalize("NFC", text) if text.strip() else "" for text in row] for row in rows]
    for row in want:
        while row and not row[-1]:
            row.pop()
    got = texts(page)[1:]
    assert got == want[: len(got)]
    assert not any(want[len(got) :])


@pytest.mark.parametrize("text", CYNICAL)
def test_csv_never_begins_a_formula(text: str) -> None:
    cell = write_csv([[text]]).decode("utf-8-sig").strip('"\r\n')
    assert cell[0] == "'"


def test_negative_numbers_stay_numbers_in_csv() -> None:
    assert write_csv([[-1.5, "-2.5e3", 4.0, None]]) == b"\xef\xbb\xbf-1.5,-2.5e3,4,\r\n"


# --- XLSX: what is written, read back by openpyxl and by ourselves ------------------------------------

BOOK = Book(
    (
        Sheet(
            "Điểm: 1/2",
            (
                (Entry("Họ tên", "head"), Entry("n", "head", comment="rpm")),
                *((Entry(text), -1.25) for text in CYNICAL),
                (Entry(None, "input", unlocked=True), Entry(0.5, "good", format="0.00")),
                ("#DIV/0!", "_x0041_"),
                ("a\x01b", 12),
            ),
            widths=(30, 8),
            frozen=(1, 1),
            protected=True,
        ),
        Sheet("điểm_ 1_2", (("x",),), hidden=True),
    ),
    title="=1",
)


def test_a_workbook_depends_on_its_content_alone() -> None:
    first = write_xlsx(BOOK)
    with zipfile.ZipFile(io.BytesIO(first)) as package:
        assert {info.date_time for info in package.infolist()} == {(2000, 1, 1, 0, 0, 0)}
        assert package.read("docProps/core.xml").count(b"2000-01-01T00:00:00Z") == 2
    assert write_xlsx(BOOK) == first


def test_text_is_never_a_formula_in_a_workbook() -> None:
    book = openpyxl.load_workbook(io.BytesIO(write_xlsx(BOOK)))
    page = book.worksheets[0]
    for row, text in enumerate(CYNICAL, start=2):
        cell = page.cell(row, 1)
        assert (cell.value, cell.data_type, cell.quotePrefix) == (text, "s", True)
    assert page["A11"].data_type == "s"
    assert [sheet.title for sheet in book.worksheets] == ["Điểm_ 1_2", "điểm_ 1_2 (2)"]
    assert page.protection.sheet
    assert page["A1"].protection.locked
    assert not page["A10"].protection.locked
    assert page.freeze_panes == "B2"
    assert page["B1"].comment is not None
    assert page["B1"].comment.text == "rpm"
    assert page["B10"].number_format == "0.00"
    assert page["B10"].fill.start_color.rgb.endswith("D3F0D7")


def test_a_workbook_comes_back_as_it_was_written(put: Callable[..., Path]) -> None:
    path = put(write_xlsx(BOOK), "b.xlsx")
    first, second = read(path)
    assert (first.name, first.hidden, second.name, second.hidden) == ("Điểm_ 1_2", False, "điểm_ 1_2 (2)", True)
    assert [row[0].value for row in first.rows[1:9]] == list(CYNICAL)
    assert first.rows[1][1] == Cell(-1.25, CellMark(str(path), 2, 2, "Điểm_ 1_2", 1), "number")
    assert [cell.kind for cell in first.rows[9]] == ["empty", "number"]
    assert [cell.text for cell in first.rows[10]] == ["#DIV/0!", "_x0041_"]
    assert [cell.text for cell in first.rows[11]] == ["a\N{REPLACEMENT CHARACTER}b", "12"]
    assert str(first.rows[1][1].mark) == f"{path}:Điểm_ 1_2!B2"


def test_marks_of_files_sheets_and_cells_are_ordered() -> None:
    a, c = Mark("a", 2, 1), Mark("c")
    first, second = CellMark("b", 9, 1, "z", 1), CellMark("b", 1, 1, "a", 2)
    assert sorted([c, second, first, a]) == [a, first, second, c]
    assert [column_letters(number) for number in (1, 26, 27, 702, 703)] == ["A", "Z", "AA", "ZZ", "AAA"]


# --- XLSX: packages put together by hand ----------------------------------------------------------------

TYPES = "http://schemas.openxmlformats.org/package/2006/content-types"
REL = "http://schemas.openxmlformats.org/package/2006/relationships"
OFFICE = "http://schemas.openxmlformats.org/officeDocument/2006/relationships"
MAIN = "http://schemas.openxmlformats.org/spreadsheetml/2006/main"
BOOK_TYPE = "application/vnd.openxmlformats-officedocument.spreadsheetml"
ROWS = '<row r="1"><c r="A1" t="inlineStr"><is><t>id</t></is></c></row>'


def relation(kind: str, target: str, id: str = "r1", mode: str = "") -> str:
    outside = f' TargetMode="{mode}"' if mode else ""
    return f'<Relationship Id="{id}" Type="{OFFICE}/{kind}" Target="{target}"{outside}/>'


def package(rows: str = ROWS, more: Mapping[str, str | bytes] | None = None, prologue: str = "") -> bytes:
    """The least workbook: one sheet "S" with the given rows."""
    with_strings = "xl/strings.xml" in (more or {})
    parts: dict[str, str | bytes] = {
        "[Content_Types].xml": f'<Types xmlns="{TYPES}">'
        f'<Override PartName="/xl/workbook.xml" ContentType="{BOOK_TYPE}.sheet.main+xml"/>'
        + f'<Override PartName="/xl/strings.xml" ContentType="{BOOK_TYPE}.sharedStrings+xml"/>' * with_strings
        + "</Types>",
        "_rels/.rels": f'<Relationships xmlns="{REL}">{relation("officeDocument", "xl/workbook.xml")}</Relationships>',
        "xl/workbook.xml": f'<workbook xmlns="{MAIN}" xmlns:r="{OFFICE}"><sheets>'
        '<sheet name="S" sheetId="1" r:id="r1"/></sheets></workbook>',
        "xl/_rels/workbook.xml.rels": f'<Relationships xmlns="{REL}">{relation("worksheet", "worksheets/s.xml")}'
        f'{relation("styles", "styles.xml", "r2")}{relation("sharedStrings", "strings.xml", "r3")}</Relationships>',
        "xl/worksheets/s.xml": f'{prologue}<worksheet xmlns="{MAIN}"><dimension ref="A1:A1"/>'
        f"<sheetData>{rows}</sheetData></worksheet>",
        **(more or {}),
    }
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as made:
        for name, content in parts.items():
            made.writestr(name, content)
    return stream.getvalue()


def rels(kind: str, target: str, mode: str = "External") -> str:
    return f'<Relationships xmlns="{REL}">{relation(kind, target, mode=mode)}</Relationships>'


ENTITY = '<!DOCTYPE x [<!ENTITY a "aaaaaaaaaa"><!ENTITY b "&a;&a;&a;&a;">]>'
HALF = "".join(f'<xf s="{k * 7919 % 99991}"/>' for k in range(70_000))
SPREAD = HALF * 2
"""More than is held at once, and less than a hundred times its packed size."""
TWICE = (
    f'<workbook xmlns="{MAIN}" xmlns:r="{OFFICE}"><sheets><sheet name="S" sheetId="1" r:id="r1"/>'
    '<sheet name="T" sheetId="2" r:id="r1"/></sheets></workbook>'
)
HOSTILE = {
    "no zip": (b"PK\x03\x04 nothing", "sheet-no-zip"),
    "text": (b"id,name\n", "sheet-no-zip"),
    "no workbook": (package(more={"_rels/.rels": f'<Relationships xmlns="{REL}"/>'}), "sheet-no-zip"),
    "old": (b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1" + bytes(600), "sheet-old"),
    "encrypted": (b"\xd0\xcf\x11\xe0" + bytes(60) + "EncryptedPackage".encode("utf-16-le"), "sheet-encrypted"),
    "bomb": (package(more={"xl/media/a.xml": b" " * 61_000_000}), "sheet-bomb"),
    "ratio": (package("<row/>" * 500_000), "sheet-bomb"),
    "parts": (package(more={f"xl/a{k}.txt": "" for k in range(2100)}), "sheet-bomb"),
    "macros": (package(more={"xl/vbaProject.bin": b"x"}), "sheet-macros"),
    "old macros": (package(more={"xl/macrosheets/sheet1.xml": "<x/>"}), "sheet-macros"),
    "macro type": (
        package(
            more={
                "[Content_Types].xml": f'<Types xmlns="{TYPES}"><Override PartName="/xl/workbook.xml" '
                'ContentType="application/vnd.ms-excel.sheet.macroEnabled.main+xml"/></Types>'
            }
        ),
        "sheet-macros",
    ),
    "external link": (package(more={"xl/externalLinks/externalLink1.xml": "<x/>"}), "sheet-links"),
    "connection": (package(more={"xl/connections.xml": "<x/>"}), "sheet-links"),
    "template": (package(more={"xl/_rels/a.xml.rels": rels("attachedTemplate", "http://x")}), "sheet-links"),
    "entities": (package("&b;", prologue=ENTITY), "sheet-entities"),
    "entities elsewhere": (package(more={"docProps/core.xml": f"{ENTITY}<x>&b;</x>"}), "sheet-entities"),
    "entities in UTF-16": (package(more={"docProps/core.xml": f"{ENTITY}<x/>".encode("utf-16")}), "sheet-entities"),
    "broken XML": (package("<row>"), "sheet-damaged"),
    "missing string": (package('<row><c t="s"><v>7</v></c></row>'), "sheet-damaged"),
    "no number": (package("<row><c><v>1e999</v></c></row>"), "sheet-damaged"),
    "no reference": (package('<row><c r="XXXX1"><v>1</v></c></row>'), "sheet-damaged"),
    "wide": (package('<row r="1"><c r="XFD1"><v>1</v></c></row>'), "table-too-large"),
    "low": (package('<row r="1048576"><c r="A1048576"><v>1</v></c></row>'), "table-too-large"),
    "sparse": (package("".join(f'<row><c r="SF{k}"><v>1</v></c></row>' for k in range(1, 999))), "table-too-large"),
    "one endless row": (package(f"<row>{SPREAD}</row>"), "sheet-bomb"),
    "endless outside of rows": (package(f"{SPREAD}<row/>"), "sheet-bomb"),
    "endless between rows": (package(f"<row/>{HALF}" * 2), "sheet-bomb"),
    "endless inside rows of another kind": (
        package(f"<x:row xmlns:x='x'>{HALF}</x:row>" * 2),
        "sheet-bomb",
    ),
    "too many rows with a style": (
        package("".join(f'<row r="{k}" s="{k * 7919 % 99991}"/>' for k in range(1, 270_000))),
        "sheet-bomb",
    ),
    "endless styles": (
        package(more={"xl/styles.xml": f'<styleSheet xmlns="{MAIN}"><cellXfs>{SPREAD}</cellXfs></styleSheet>'}),
        "sheet-bomb",
    ),
    "endless list of sheets": (
        package(more={"xl/workbook.xml": f'<workbook xmlns="{MAIN}">{SPREAD}</workbook>'}),
        "sheet-bomb",
    ),
    "a formula told again and again": (
        package(
            f'<row><c r="A1"><f t="shared" si="0">{"1+" * 4000}1</f></c></row>'
            + "".join(f'<row><c r="A{k}"><f t="shared" si="0"/></c></row>' for k in range(2, 3000))
        ),
        "sheet-bomb",
    ),
    "a long shared formula": (
        package(f'<row><c r="A1"><f t="shared" si="0">{"1+" * 20_000}1</f></c></row>'),
        "text-too-long",
    ),
    "rows out of order": (
        package('<row r="2"><c r="A2"><v>1</v></c></row><row r="1"><c r="A1"><v>2</v></c></row>'),
        "sheet-damaged",
    ),
    "cells out of order": (
        package('<row r="1"><c r="B1"><v>1</v></c><c r="A1"><v>2</v></c></row>'),
        "sheet-damaged",
    ),
    "a cell twice": (package('<row r="1"><c r="A1"><v>1</v></c><c r="A1"><v>2</v></c></row>'), "sheet-damaged"),
    "a row beyond all rows": (package('<row r="99999999999999"><c><v>1</v></c></row>'), "sheet-damaged"),
    "no row number": (package('<row r="x"><c><v>1</v></c></row>'), "sheet-damaged"),
    "no sheet part": (
        package(more={"xl/_rels/workbook.xml.rels": rels("worksheet", "none.xml", "Internal")}),
        "sheet-damaged",
    ),
    "charts alone": (
        package(more={"xl/_rels/workbook.xml.rels": rels("chartsheet", "worksheets/s.xml", "Internal")}),
        "sheet-no-zip",
    ),
    "a sheet twice": (package(more={"xl/workbook.xml": TWICE}), "sheet-damaged"),
    "long": (package(f'<row><c t="inlineStr"><is><t>{"x" * 40_000}</t></is></c></row>'), "text-too-long"),
}


@pytest.mark.parametrize("name", HOSTILE)
def test_a_hostile_workbook_is_refused(put: Callable[..., Path], name: str) -> None:
    content, code = HOSTILE[name]
    assert f"error[{code}]" in refusal(put(content, "hostile.xlsx"))


def test_a_million_rows_are_refused_whatever_the_dimension_says(put: Callable[..., Path]) -> None:
    """The sheet says it is A1:A1; the first row too many stops the reading."""
    rows = "".join(f'<row r="{k}"><c r="A{k}"><v>{k * 7919 % 99991}</v></c></row>' for k in range(1, 1_048_577))
    assert refusal(put(package(rows), "m.xlsx")) == "FILE:S!A10001: error[table-too-large]"


def test_a_directory_that_lies_of_a_size_is_found_out(put: Callable[..., Path]) -> None:
    """The announced size of the sheet is cut to 10 bytes: what follows is never unpacked."""
    content = bytearray(package("<row><c><v>1</v></c></row>" * 50))
    at = content.rindex(b"PK\x01\x02")
    with zipfile.ZipFile(io.BytesIO(bytes(content))) as made:
        assert made.infolist()[-1].filename == "xl/worksheets/s.xml"
    content[at + 24 : at + 28] = (10).to_bytes(4, "little")
    assert "error[sheet-damaged]" in refusal(put(bytes(content), "lie.xlsx"))


def test_overlapping_parts_are_refused(put: Callable[..., Path]) -> None:
    """Two entries of the directory share one body, as in bombs that need no nesting."""
    content = package(more={"xl/worksheets/t.xml": bytes(200_000), "xl/u.bin": b"0123456789" * 300})
    entries = content.index(b"PK\x01\x02")
    one = content.rindex(b"PK\x01\x02")
    end = content.index(b"PK\x05\x06")
    extra = b"".join(content[one:end].replace(b"xl/u.bin", f"xl/{k:01x}.bin".encode()) for k in range(16))
    tail = bytearray(content[end:])
    count = 7 + 16
    tail[8:10] = tail[10:12] = count.to_bytes(2, "little")
    tail[12:16] = (end - entries + len(extra)).to_bytes(4, "little")
    assert "error[sheet-bomb]" in refusal(put(content[:end] + extra + bytes(tail), "o.xlsx"))


STYLES = (
    f'<styleSheet xmlns="{MAIN}"><numFmts count="2"><numFmt numFmtId="170" formatCode="dd\\/mm\\/yyyy"/>'
    '<numFmt numFmtId="171" formatCode="&quot;day&quot; 0.0"/></numFmts><cellXfs count="4"><xf numFmtId="0"/>'
    '<xf numFmtId="14"/><xf numFmtId="170"/><xf numFmtId="171"/></cellXfs></styleSheet>'
)
STRINGS = (
    f'<sst xmlns="{MAIN}"><si><t>Anh</t></si><si><r><t>Ngọc </t></r><r><t>Hà</t></r><rPh sb="0" eb="1"><t>no</t></rPh>'
    "</si><si><t>a_x000D_b</t></si></sst>"
)


def test_what_programs_write_is_understood(put: Callable[..., Path]) -> None:
    """Shared and rich strings, dates by style, formulas with and without result, errors, booleans, no references."""
    rows = (
        '<row><c t="s"><v>0</v></c><c t="s"><v>1</v></c><c t="s"><v>2</v></c></row>'
        '<row r="3"><c r="A3" s="1"><v>40626</v></c><c r="B3" s="2"><v>40626.5</v></c><c r="C3" s="3"><v>7</v></c>'
        '<c r="E3"><v>195520103001</v></c></row>'
        '<row r="4"><c r="A4"><f>SUM(E3)</f><v>5.0</v></c><c r="B4"><f>A1</f></c>'
        '<c r="C4" t="str"><f>D1</f><v>x</v></c>'
        '<c r="D4" t="e"><v>#DIV/0!</v></c><c r="E4" t="b"><v>1</v></c></row>'
        '<row r="1048576" s="1"><c r="A1048576" s="1"/></row>'
    )
    more = {
        "xl/styles.xml": STYLES,
        "xl/strings.xml": STRINGS,
        "xl/worksheets/_rels/s.xml.rels": rels("hyperlink", "mailto:a@example.org"),
        "xl/calcChain.xml": "<calcChain/>",
        "xl/theme/theme1.xml": "<a/>",
        "customStorage/customStorage.xml": "<a/>",
        "xl/media/image1.png": b"\x89PNG",
    }
    path = put(package(rows, more), "student.xlsx")
    (page,) = read(path)
    seen = [[(cell.kind, cell.value, cell.formula) for cell in row] for row in page.rows]
    assert seen == [
        [("text", "Anh", ""), ("text", "Ngọc Hà", ""), ("text", "a\rb", "")],
        [],
        [
            ("date", "2011-03-24", ""),
            ("date", "2011-03-24T12:00:00", ""),
            ("number", 7.0, ""),
            ("empty", None, ""),
            ("number", 195520103001.0, ""),
        ],
        [
            ("formula", 5.0, "=SUM(E3)"),
            ("formula", None, "=A1"),
            ("formula", "x", "=D1"),
            ("error", "#DIV/0!", ""),
            ("boolean", "TRUE", ""),
        ],
    ]
    assert page.rows[2][4].text == "195520103001"
    assert str(page.rows[3][3].mark) == f"{path}:S!D4"


def test_what_no_cell_needs_is_not_looked_at(put: Callable[..., Path]) -> None:
    """Properties, themes and the like may be wrong; the sheet's own relations may lead nowhere."""
    more = {
        "docProps/core.xml": "<a>",
        "docProps/custom.xml": "<Properties><property/></Properties>",
        "xl/theme/theme1.xml": b"\0",
        "xl/worksheets/_rels/s.xml.rels": rels("drawing", "none.xml", "Internal"),
        "xl/charts/chart1.xml": SPREAD,
    }
    (page,) = read(put(package(more=more), "s.xlsx"))
    assert texts(page) == [["id"]]


def test_formulas_of_all_kinds_are_told(put: Callable[..., Path]) -> None:
    """A shared formula is that of its own cell; one for an array and a table of data keep their stored values."""
    rows = (
        '<row r="1"><c r="A1"><f t="shared" ref="A1:A2" si="0">B1*$C$1</f><v>1</v></c></row>'
        '<row r="2"><c r="A2"><f t="shared" si="0"/><v>2</v></c></row>'
        '<row r="3"><c r="A3"><f t="array" ref="A3">SUM(B1:B2)</f><v>3</v></c>'
        '<c r="B3"><f t="dataTable" ref="B3" dt2D="1" r1="A1" r2="A2"/><v>4</v></c>'
        '<c r="C3" t="e"><f>1/0</f><v>#DIV/0!</v></c></row>'
    )
    (page,) = read(put(package(rows), "f.xlsx"))
    assert [[(cell.kind, cell.value, cell.formula) for cell in row] for row in page.rows] == [
        [("formula", 1.0, "=B1*$C$1")],
        [("formula", 2.0, "=B2*$C$1")],
        [("formula", 3.0, "=SUM(B1:B2)"), ("formula", 4.0, "="), ("formula", "#DIV/0!", "=1/0")],
    ]


def test_dates_and_times_are_told_as_they_show(put: Callable[..., Path]) -> None:
    """Day 1 is the first of 1900 (or the second of 1904); hours that have passed may be more than a day's."""
    styles = (
        f'<styleSheet xmlns="{MAIN}"><numFmts count="1"><numFmt numFmtId="170" formatCode="[h]:mm"/></numFmts>'
        '<cellXfs count="3"><xf numFmtId="0"/><xf numFmtId="14"/><xf numFmtId="170"/></cellXfs></styleSheet>'
    )
    rows = (
        '<row><c s="1"><v>1</v></c><c s="1"><v>61</v></c><c s="1"><v>0.3541666666666667</v></c>'
        '<c s="2"><v>1.5</v></c><c s="2"><v>-0.25</v></c><c t="d"><v>2011-03-24T00:00:00</v></c>'
        '<c s="1"><v>195520103001</v></c></row>'
    )
    (page,) = read(put(package(rows, {"xl/styles.xml": styles}), "d.xlsx"))
    *days, beyond = page.rows[0]
    assert [cell.value for cell in days] == [
        "1900-01-01",
        "1900-03-01",
        "08:30:00",
        "36:00:00",
        "-06:00:00",
        "2011-03-24",
    ]
    assert {cell.kind for cell in days} == {"date"}
    assert (beyond.kind, beyond.value) == ("error", "#VALUE!")
    since = TWICE.replace("<sheets>", '<workbookPr date1904="1"/><sheets>').partition('<sheet name="T"')[0]
    more = {"xl/styles.xml": styles, "xl/workbook.xml": f"{since}</sheets></workbook>"}
    (page,) = read(put(package('<row><c s="1"><v>1</v></c></row>', more), "m.xlsx"))
    assert page.rows[0][0].value == "1904-01-02"


def test_escapes_in_shared_and_inline_strings(put: Callable[..., Path]) -> None:
    """_x000D_ is a carriage return; with its first underscore escaped it is those seven characters."""
    text = "a_x000D_b _x005F_x000D_ x005F_ _x005f_x0041_"
    rows = f'<row><c t="s"><v>0</v></c><c t="inlineStr"><is><t>{text}</t></is></c></row>'
    more = {"xl/strings.xml": f'<sst xmlns="{MAIN}"><si><t>{text}</t></si></sst>'}
    (page,) = read(put(package(rows, more), "e.xlsx"))
    assert [cell.value for cell in page.rows[0]] == ["a\rb _x000D_ x005F_ _x0041_"] * 2


def test_damage_is_told_by_sheet_and_row(put: Callable[..., Path]) -> None:
    rows = '<row r="1"><c r="A1"><v>1</v></c></row><row r="2"><c r="A2"/><c r="B2"><v>1,5</v></c></row>'
    assert refusal(put(package(rows), "d.xlsx")) == "FILE:S!A2: error[sheet-damaged]"


def test_a_workbook_of_openpyxl_is_read_as_openpyxl_reads_it(put: Callable[..., Path]) -> None:
    import datetime

    book = openpyxl.Workbook()
    page = book.worksheets[0]
    page.append(["id", "ngày", "x"])
    page.append(["007", datetime.date(2011, 3, 24), 0.1])
    page["C3"] = "=C2*2"
    page.column_dimensions["D"].width = 30
    stream = io.BytesIO()
    book.save(stream)
    (got,) = read(put(stream.getvalue(), "o.xlsx"))
    assert [[cell.value for cell in row] for row in got.rows] == [
        ["id", "ngày", "x"],
        ["007", "2011-03-24", 0.1],
        [None, None, None],
    ]
    assert got.rows[2][2].formula == "=C2*2"


SHARED = {"xl/styles.xml": STYLES, "xl/strings.xml": STRINGS}
WHOLE = (write_xlsx(BOOK), package('<row><c t="s"><v>0</v></c></row>', SHARED))
CHANGE = st.tuples(st.floats(0, 1, exclude_max=True), st.binary(max_size=3))


@settings(max_examples=80, deadline=None)
@given(st.sampled_from(WHOLE), st.lists(CHANGE, max_size=4))
def test_a_damaged_workbook_is_read_or_refused(
    tmp_path_factory: pytest.TempPathFactory, content: bytes, changes: list[tuple[float, bytes]]
) -> None:
    """Never another exception, wherever its bytes are changed."""
    for share, new in changes:
        at = int(share * len(content))
        content = content[:at] + new + content[at + len(new) :]
    path = tmp_path_factory.mktemp("damaged") / "d.xlsx"
    path.write_bytes(content)
    with contextlib.suppress(AssignmentError):
        assert all(isinstance(page, Page) for page in read(path))


PARTS = tuple(
    {name: book.read(name) for name in book.namelist()} for book in (zipfile.ZipFile(io.BytesIO(one)) for one in WHOLE)
)
ODD = (b"", b"<", b'"', b"-1", b"99999999999", b"1e999", b"x", b"\xff", b"<row/>", b"<c/>", b'<f t="shared" si="0"/>')
SPOT = st.tuples(st.integers(0, 99), st.floats(0, 1), st.booleans(), st.sampled_from(ODD))


@settings(max_examples=80, deadline=None)
@given(st.sampled_from(PARTS), st.lists(SPOT, min_size=1, max_size=3))
def test_a_workbook_with_damaged_parts_is_read_or_refused(
    tmp_path_factory: pytest.TempPathFactory,
    parts: Mapping[str, bytes],
    spots: list[tuple[int, float, bool, bytes]],
) -> None:
    """Packed again without a fault, so that the damage comes to what reads the XML, inside values or anywhere."""
    damaged = dict(parts)
    for which, share, inside, new in spots:
        name = sorted(damaged)[which % len(damaged)]
        content = damaged[name]
        values = [match.span() for match in re.finditer(rb'(?<=")[^"<>]+(?=")|(?<=>)[^<]+(?=<)', content)]
        at = int(share * len(content))
        start, end = values[int(share * (len(values) - 1))] if inside and values else (at, at + 1)
        damaged[name] = content[:start] + new + content[end:]
    path = tmp_path_factory.mktemp("damaged") / "d.xlsx"
    with zipfile.ZipFile(path, "w") as made:
        for name, content in damaged.items():
            made.writestr(name, content)
    with contextlib.suppress(AssignmentError):
        assert all(isinstance(page, Page) for page in read(path))


def test_a_sheet_prints_as_wide_as_a_page_with_its_heads_on_each() -> None:
    pages = (
        Sheet("narrow", [["head"], ["1"]], (24.0, 44.0), (1, 0)),
        Sheet("wide", [["head"], ["1"]], (12.0,) * 20, (1, 1)),
    )
    book = openpyxl.load_workbook(io.BytesIO(write_xlsx(Book(pages))))
    for page, orientation in zip(book.worksheets, ("portrait", "landscape"), strict=True):
        assert page.page_setup.orientation == orientation
        assert page.sheet_properties.pageSetUpPr.fitToPage
        assert (page.page_setup.fitToWidth, page.page_setup.fitToHeight) == (1, 0)
        assert page.print_title_rows == "$1:$1"
