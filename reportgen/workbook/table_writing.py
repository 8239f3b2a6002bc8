"""Write tables as CSV or XLSX bytes; the same description gives the same bytes.

Text stays text: text that a spreadsheet would read as a formula is written as a string in XLSX and behind an
apostrophe in CSV.
"""

from __future__ import annotations

import csv
import datetime
import io
import re
import unicodedata
import zipfile
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any, Literal

from reportgen.base.records import Record
from reportgen.workbook.zip_package import LONGEST_CELL, guarded, number_text

if TYPE_CHECKING:
    from openpyxl.worksheet.worksheet import Worksheet

CellStyle = Literal["", "title", "head", "bold", "note", "input", "unasked", "good", "linked", "warn", "bad", "doubt"]

MOMENT = (2000, 1, 1, 0, 0, 0)
"""Date of creation in every file, fixed so that its bytes depend on its content alone."""
FILLS = {
    "head": "D9E2EC",
    "input": "FFF9DB",
    "unasked": "E7E7E7",
    "good": "D3F0D7",
    "linked": "D3E4F8",
    "warn": "FFE0B0",
    "bad": "F9CFCB",
    "doubt": "E7DAF3",
}
LONGEST_NAME = 31
UPRIGHT = 110.0
"""Largest number of characters of a line that is legible on A4 in portrait."""
CHARACTER, MARGIN = 1.86, 1.33
"""Width (mm) of a character of a column, and of a column without characters."""
PRINTED = {True: 174.0, False: 261.0}
"""Printable width (mm) on A4, portrait and landscape, between a spreadsheet's usual margins."""
_FORBIDDEN = re.compile(r"[\x00-\x08\x0b\x0c\x0e-\x1f\ud800-\udfff\ufffe\uffff]")
_ESCAPED = re.compile(r"_(?=x[0-9A-Fa-f]{4}_)")
_NAME = re.compile(r"[\[\]:*?/\\\x00-\x1f]")


class Entry(Record):
    """A cell to be written: its value, how it looks, a comment, a number format such as "0.00".

    `unlocked` lets it be filled in where the sheet is protected.
    """

    value: str | float | None = None
    style: CellStyle = ""
    comment: str = ""
    format: str = ""
    unlocked: bool = False


NOTHING = Entry()
"""A cell that is left as it is."""


class WorksheetData(Record):
    """A page of a workbook: rows of entries or of bare values.

    `widths` are those of the columns, in characters; `frozen` are the rows and columns that stay in view.
    A `protected` sheet can be changed in its unlocked cells only (without a password: it guards against slips).
    `breaks` are the rows after which a new page is printed.
    """

    name: str
    rows: Sequence[Sequence[Entry | str | float | None]]
    widths: Sequence[float] = ()
    frozen: tuple[int, int] = (0, 0)
    protected: bool = False
    hidden: bool = False
    breaks: Sequence[int] = ()


class Book(Record):
    """A workbook of one or more sheets; their names are made valid and distinct."""

    sheets: Sequence[WorksheetData]
    title: str = ""


def write_csv(rows: Iterable[Sequence[str | float | None]]) -> bytes:
    """Return rows as UTF-8 CSV with a byte order mark, from which spreadsheets recognise the encoding."""
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\r\n")
    for row in rows:
        writer.writerow([_csv_text(value) for value in row])
    return b"\xef\xbb\xbf" + stream.getvalue().encode("utf-8", "replace")


def _csv_text(value: str | float | None) -> str:
    if value is None:
        return ""
    if isinstance(value, str):
        return guarded(unicodedata.normalize("NFC", value).replace("\0", "\N{REPLACEMENT CHARACTER}"))
    return number_text(float(value))


def write_xlsx(book: Book) -> bytes:
    """Return a workbook as XLSX."""
    from openpyxl import Workbook

    made = Workbook()
    made.remove(made.worksheets[0])
    made.properties.creator, made.properties.title = "reportgen", _clean(book.title) or None
    made.properties.created = datetime.datetime(*MOMENT)
    taken: set[str] = set()
    for sheet in book.sheets:
        _fill(made.create_sheet(_sheet_name(sheet.name, taken)), sheet)
    stream = io.BytesIO()
    made.save(stream)
    return _timeless(stream.getvalue())


def _fill(page: Worksheet, sheet: WorksheetData) -> None:
    from openpyxl.comments import Comment
    from openpyxl.utils import get_column_letter

    dressed: dict[tuple[str, str, bool, bool], Any] = {}
    for number, width in enumerate(sheet.widths, start=1):
        page.column_dimensions[get_column_letter(number)].width = width
    for row, entries in enumerate(sheet.rows, start=1):
        for column, content in enumerate(entries, start=1):
            entry = content if isinstance(content, Entry) else Entry(content)
            if entry == NOTHING:
                continue
            cell: Any = page.cell(row, column)
            _put(cell, entry.value)
            # Looking a style up in the workbook's lists takes longest, so each look is looked up only once.
            look = (entry.style, entry.format, entry.unlocked, bool(cell.quotePrefix))
            if look in dressed:
                cell._style = dressed[look]
            else:
                _dress(cell, entry)
                dressed[look] = cell._style
            if entry.comment:
                cell.comment = Comment(_clean(entry.comment), "reportgen", height=110, width=320)
    rows, columns = sheet.frozen
    if rows or columns:
        page.freeze_panes = f"{get_column_letter(columns + 1)}{rows + 1}"
    _set_print(page, sheet.widths, rows, sheet.breaks)
    page.protection.sheet = sheet.protected
    page.sheet_state = "hidden" if sheet.hidden else "visible"


def _set_print(page: Worksheet, widths: Sequence[float], heads: int, breaks: Sequence[int]) -> None:
    """Set the page to A4 and the width of the sheet, portrait if that is legible; the frozen rows head each page."""
    from openpyxl.worksheet.pagebreak import Break

    width = sum(widths)
    page.page_setup.paperSize = page.PAPERSIZE_A4
    upright = width <= UPRIGHT
    page.page_setup.orientation = "portrait" if upright else "landscape"
    if breaks:
        # Programs that fit a sheet to a page ignore its page breaks, so the scale is given explicitly.
        needed = sum(CHARACTER * one + MARGIN for one in widths)
        page.page_setup.scale = max(min(int(100 * PRINTED[upright] / needed), 100), 10)
        for row in breaks:
            page.row_breaks.append(Break(id=row))
    else:
        page.sheet_properties.pageSetUpPr.fitToPage = True
        page.page_setup.fitToWidth, page.page_setup.fitToHeight = 1, 0
    if heads:
        page.print_title_rows = f"1:{heads}"


def _put(cell: Any, value: str | float | None) -> None:
    """Write a value into a cell; any text is a string, never a formula or an error code."""
    if isinstance(value, str):
        text = _ESCAPED.sub("_x005F_", _clean(value))[:LONGEST_CELL]
        cell.value = text
        cell.data_type = "s"
        if guarded(text) != text:
            cell.quotePrefix = True
    else:
        cell.value = value


def _dress(cell: Any, entry: Entry) -> None:
    from openpyxl.styles import Alignment, Border, Font, PatternFill, Protection, Side

    style = entry.style
    if style in ("title", "head", "bold"):
        cell.font = Font(bold=True, size=14 if style == "title" else 11)
    elif style == "note":
        cell.font = Font(italic=True, color="555555")
    if style in FILLS:
        line = Side(style="thin", color="A0A0A0")
        cell.fill = PatternFill("solid", start_color=FILLS[style])
        cell.border = Border(left=line, right=line, top=line, bottom=line)
    if style in ("head", "note"):
        cell.alignment = Alignment(wrap_text=style == "head", vertical="center")
    if entry.format:
        cell.number_format = entry.format
    if entry.unlocked:
        cell.protection = Protection(locked=False)


def _sheet_name(name: str, taken: set[str]) -> str:
    """Return the name as programs allow it: 31 characters, none of []:*?/\\, no apostrophe at an end, each once."""
    plain = _NAME.sub("_", _clean(name)).strip("' ")[:LONGEST_NAME] or "1"
    chosen, number = plain, 2
    while chosen.casefold() in taken:
        ending = f" ({number})"
        chosen, number = f"{plain[: LONGEST_NAME - len(ending)]}{ending}", number + 1
    taken.add(chosen.casefold())
    return chosen


def _clean(text: str) -> str:
    """Return text with only characters that XML allows."""
    return _FORBIDDEN.sub("\N{REPLACEMENT CHARACTER}", unicodedata.normalize("NFC", text))


def _timeless(data: bytes) -> bytes:
    """Return the package with a fixed moment in place of its dates."""
    stream = io.BytesIO()
    with zipfile.ZipFile(io.BytesIO(data)) as old, zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as new:
        for name in old.namelist():
            content = old.read(name)
            if name == "docProps/core.xml":
                stamp = f"{datetime.datetime(*MOMENT).isoformat()}Z".encode()
                content = re.sub(rb"(<dcterms:modified[^>]*>)[^<]*", rb"\g<1>" + stamp, content)
            part = zipfile.ZipInfo(name, MOMENT)
            part.compress_type = zipfile.ZIP_DEFLATED
            part.external_attr = 0o600 << 16
            new.writestr(part, content)
    return stream.getvalue()
