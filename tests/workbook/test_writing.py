"""Workbooks as they are written, read back by openpyxl and by ourselves."""

from __future__ import annotations

import io
import zipfile
from collections.abc import Callable
from pathlib import Path

import openpyxl

from reportgen.base.errors import CellLocation, Location, column_letters
from reportgen.workbook import Book, SheetCell, WorksheetData, read, write_xlsx
from tests.workbook.tables import BOOK, CYNICAL


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
    assert first.rows[1][1] == SheetCell(-1.25, CellLocation(str(path), 2, 2, "Điểm_ 1_2", 1), "number")
    assert [cell.kind for cell in first.rows[9]] == ["empty", "number"]
    assert [cell.text for cell in first.rows[10]] == ["#DIV/0!", "_x0041_"]
    assert [cell.text for cell in first.rows[11]] == ["a\N{REPLACEMENT CHARACTER}b", "12"]
    assert str(first.rows[1][1].location) == f"{path}:Điểm_ 1_2!B2"


def test_a_sheet_prints_as_wide_as_a_page_with_its_heads_on_each() -> None:
    pages = (
        WorksheetData("narrow", [["head"], ["1"]], (24.0, 44.0), (1, 0)),
        WorksheetData("wide", [["head"], ["1"]], (12.0,) * 20, (1, 1)),
    )
    book = openpyxl.load_workbook(io.BytesIO(write_xlsx(Book(pages))))
    for page, orientation in zip(book.worksheets, ("portrait", "landscape"), strict=True):
        assert page.page_setup.orientation == orientation
        assert page.sheet_properties.pageSetUpPr.fitToPage
        assert (page.page_setup.fitToWidth, page.page_setup.fitToHeight) == (1, 0)
        assert page.print_title_rows == "$1:$1"


def test_marks_of_files_sheets_and_cells_are_ordered() -> None:
    a, c = Location("a", 2, 1), Location("c")
    first, second = CellLocation("b", 9, 1, "z", 1), CellLocation("b", 1, 1, "a", 2)
    assert sorted([c, second, first, a]) == [a, first, second, c]
    assert [column_letters(number) for number in (1, 26, 27, 702, 703)] == ["A", "Z", "AA", "ZZ", "AAA"]
