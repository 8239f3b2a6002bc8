"""Workbooks as other programs write them: strings, dates, formulas, damage told where it is."""

from __future__ import annotations

import datetime
import io
from collections.abc import Callable
from pathlib import Path

import openpyxl

from reportgen.workbook import read
from tests.workbook.tables import MAIN, SPREAD, STRINGS, STYLES, TWICE, package, refusal, rels, texts


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
    assert str(page.rows[3][3].location) == f"{path}:S!D4"


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
