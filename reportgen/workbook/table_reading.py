"""Read a table file: a CSV or XLSX file becomes pages of located cells, any other file is refused.

openpyxl reads XLSX from a copy that contains only the checked parts that it needs.
"""

from __future__ import annotations

import datetime
import io
import math
import posixpath
import re
import unicodedata
import warnings
import zipfile
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import closing, redirect_stdout
from functools import partial
from itertools import tee
from pathlib import Path
from typing import TYPE_CHECKING, Any

from reportgen.base.errors import CellLocation, Fault, Location
from reportgen.base.files import contents
from reportgen.base.units import Language
from reportgen.base.words import as_error
from reportgen.base.yaml_source import decoded
from reportgen.workbook.number_format import displayed
from reportgen.workbook.zip_package import (
    CONTENT_TYPES,
    LONGEST_CELL,
    MOST_GROUPS,
    CellKind,
    Package,
    Page,
    RefusedError,
    SheetCell,
    exceeds,
    measure,
    too_large,
    too_long,
    unguarded,
)

if TYPE_CHECKING:
    from openpyxl import Workbook


MOST_SHEETS = 100
GENERAL = "General"
"""Number format of cells without an explicit one."""
_ESCAPE = re.compile(r"_x([0-9A-Fa-f]{4})_")

CellRow = tuple[Any, ...]
"""The cells of a row as openpyxl returns them."""
LocationAt = Callable[[int, int], CellLocation]
"""Returns the location of a cell of one sheet by its row and column."""


def read_xlsx(data: bytes, file: str) -> tuple[Page, ...]:
    """Return the sheets of a workbook in their order; raise `RefusedError` for a file that is refused."""
    copy, counts, formulas = _judged(Package(data, file))
    with warnings.catch_warnings(), redirect_stdout(io.StringIO()):
        # openpyxl warns of, and even prints, the parts that it ignores: looks and rules, but never the value of a cell.
        warnings.simplefilter("ignore")
        try:
            with closing(_load(copy, stored=True)) as values:
                if not formulas:
                    return _pages(values, None, counts, file)
                with closing(_load(copy, stored=False)) as texts:
                    return _pages(values, texts, counts, file)
        except RefusedError:
            raise
        except Exception:
            # openpyxl has no exception class for a damaged workbook.
            raise RefusedError("sheet-damaged", Location(file)) from None


def _judged(package: Package) -> tuple[bytes, list[int], bool]:
    """Return a copy with the parts that openpyxl reads, the number of cells of each sheet, and True for any formula.

    Raise `RefusedError` if a sheet cannot be found or a part is too large.
    """
    root = next((r.target for r in package.relations("_rels/.rels").values() if r.kind == "officeDocument"), "")
    workbook = root.lstrip("/")
    if workbook not in package:
        raise package.refused("sheet-no-zip")
    folder, name = posixpath.split(workbook)
    beside = posixpath.join(folder, "_rels", f"{name}.rels")
    relations = package.relations(beside)
    places = {
        id: relation.target.lstrip("/")
        if relation.target.startswith("/")
        else posixpath.normpath(f"{folder}/{relation.target}")
        for id, relation in relations.items()
    }
    listed = [attributes.get("id", "") for tag, attributes in package.elements(workbook) if tag == "sheet"]
    if len(listed) > MOST_SHEETS:
        raise too_large(package.location)
    present = {places[id] for id in listed if places.get(id, "") in package}
    if len(present) < len(listed):
        raise package.refused("sheet-damaged")
    sheets = [places[id] for id in listed if relations[id].kind == "worksheet"]
    if not sheets:
        raise package.refused("sheet-no-zip")
    tables = {
        relation.kind: places[id] for id, relation in relations.items() if relation.kind in ("styles", "sharedStrings")
    }
    others = [CONTENT_TYPES, workbook, beside, *(place for place in tables.values() if place in package)]
    for sheet in set(sheets):
        package.without_empty_cells(sheet)
    measured = {place: measure(package, place) for place in (*others, *sheets)}
    copy = _copy(package, measured, tables.get("sharedStrings", ""))
    return copy, [measured[sheet][0] for sheet in sheets], any(measured[sheet][1] for sheet in sheets)


def _copy(package: Package, names: Iterable[str], strings: str) -> bytes:
    """Return a package of these parts; `strings` is the one of the shared strings."""
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as made:
        for name in names:
            content = package.content(name)
            if name == strings:
                # openpyxl drops these letters, which distinguish the seven characters written _x005F_x000D_ from the
                # carriage return written _x000D_: so they are given in a way that leaves them there.
                content = content.replace(b"x005F_", b"x005Fx005F__")
            made.writestr(name, content)
    return stream.getvalue()


def _load(copy: bytes, *, stored: bool) -> Workbook:
    """Return the workbook with the stored results of its formulas, or with their texts."""
    from openpyxl import load_workbook

    return load_workbook(io.BytesIO(copy), read_only=True, data_only=stored, keep_links=False)


def _pages(values: Workbook, formulas: Workbook | None, counts: Sequence[int], file: str) -> tuple[Page, ...]:
    if len(values.worksheets) != len(counts):
        raise RefusedError("sheet-damaged", Location(file))
    pages = []
    for number, (sheet, count) in enumerate(zip(values.worksheets, counts, strict=True), start=1):
        sheet.reset_dimensions()
        if formulas is None:
            typed, stored = tee(sheet.rows)
        else:
            same = formulas.worksheets[number - 1]
            same.reset_dimensions()
            typed, stored = same.rows, sheet.rows
        location_at = partial(CellLocation, file, sheet=sheet.title, number=number)
        rows = _rows(zip(typed, stored, strict=True), count, location_at)
        pages.append(Page(sheet.title, rows, sheet.sheet_state != "visible"))
    return tuple(pages)


def _rows(
    read: Iterator[tuple[CellRow, CellRow]], count: int, location_at: LocationAt
) -> tuple[tuple[SheetCell, ...], ...]:
    """Return all rows of a sheet from the first on, each up to its last cell with content.

    `read` gives each row twice, with formulas as typed and with stored values; `count` cells must be among them.
    """
    from openpyxl.cell.read_only import ReadOnlyCell

    cells: dict[int, dict[int, SheetCell]] = {}
    rows_read = 0
    for number, pair in enumerate(_whole(read, location_at), start=1):
        if number > MOST_GROUPS:
            raise RefusedError("sheet-damaged", location_at(number, 1))
        for typed, stored in zip(*pair, strict=True):
            if not isinstance(typed, ReadOnlyCell):
                continue
            rows_read += 1
            row, column = typed.row, typed.column
            cell = _cell(typed, stored, location_at(row, column))
            if cell.blank:
                continue
            if exceeds(row, column):
                raise too_large(cell.location)
            if isinstance(cell.value, str) and len(cell.value) > LONGEST_CELL:
                raise too_long(cell.location)
            cells.setdefault(row, {})[column] = cell
    if rows_read != count:
        # openpyxl leaves out rows and cells that are not in order.
        raise RefusedError("sheet-damaged", location_at(1, 1))
    lengths = {row: max(columns) for row, columns in cells.items()}
    last = max(cells, default=0)
    if exceeds(0, 0, sum(lengths.values())):
        raise too_large(location_at(last, 1))
    return tuple(
        tuple(
            cells[row].get(column) or SheetCell(None, location_at(row, column), "empty")
            for column in range(1, lengths.get(row, 0) + 1)
        )
        for row in range(1, last + 1)
    )


def _whole(read: Iterator[tuple[CellRow, CellRow]], location_at: LocationAt) -> Iterator[tuple[CellRow, CellRow]]:
    """Yield the rows up to one that openpyxl cannot read, which is refused as the row after the last whole one."""
    last = 0
    try:
        for pair in read:
            yield pair
            last += 1
    except Exception:
        raise RefusedError("sheet-damaged", location_at(last + 1, 1)) from None


def _cell(typed: Any, stored: Any, location: CellLocation) -> SheetCell:
    value, kind = _value(stored.value, stored.data_type, location)
    code = displayed(value, _format(stored)) if isinstance(value, float) else ""
    if typed.data_type != "f":
        return SheetCell(value, location, kind, code=code)
    # The formula of an array is an object with its text, that of a data table one without.
    text = typed.value if isinstance(typed.value, str) else getattr(typed.value, "text", "=")
    return SheetCell(value, location, "formula", text, code)


def _format(cell: Any) -> str:
    """Return the number format of a cell, or `GENERAL` if the workbook names a format that it does not have."""
    try:
        return str(cell.number_format or GENERAL)
    except (IndexError, KeyError):
        return GENERAL


def _value(value: object, type: str, location: CellLocation) -> tuple[str | float | None, CellKind]:
    match value:
        case None:
            return None, "empty"
        case bool():
            return ("TRUE" if value else "FALSE"), "boolean"
        case int() | float():
            try:
                number = float(value)
            except OverflowError:
                number = math.inf
            if not math.isfinite(number):
                raise RefusedError("sheet-damaged", location)
            return number, "number"
        case str() if type == "e":
            return value, "error"
        case str():
            text = unicodedata.normalize("NFC", _ESCAPE.sub(lambda match: chr(int(match[1], 16)), value))
            return (text, "text") if text.strip() else (None, "empty")
        case _:
            return _date(value), "date"


def _date(value: object) -> str:
    """Return a day as 2011-03-24, a moment as 2011-03-24T08:30:00, a time of day as 08:30:00.

    A duration is written in hours: 36:00:00.
    """
    match value:
        case datetime.datetime() if value.time() == datetime.time():
            return value.date().isoformat()
        case datetime.datetime() | datetime.time():
            return value.isoformat(timespec="seconds")
        case datetime.timedelta():
            minutes, seconds = divmod(abs(round(value.total_seconds())), 60)
            sign = "-" if value < datetime.timedelta() else ""
            return f"{sign}{minutes // 60:02}:{minutes % 60:02}:{seconds:02}"
        case _:
            return str(value)


LARGEST = 10_000_000
"""Largest size of a file in bytes."""
BOOKS = frozenset({".xlsx", ".xlsm", ".xltx", ".xltm", ".xls", ".xlsb", ".ods"})
_BINARY = (b"PK\x03\x04", b"\xd0\xcf\x11\xe0")

SEPARATORS = ",;\t"
_STATED = re.compile(r"sep=(.)\r?\n")
_LINE_END = re.compile(r"\r\n|\r|\n")


def read(path: Path, language: Language | None = None, data: bytes | None = None) -> tuple[Page, ...]:
    """Return the pages of a CSV or XLSX file; raise `AssignmentError` with the fault that stops it, in `language`.

    `data` is the content of a file that is not on disk; `path` then only names it.
    """
    try:
        return _read(path, data)
    except RefusedError as refused:
        raise as_error([refused.fault], language) from None


def _read(path: Path, data: bytes | None) -> tuple[Page, ...]:
    file = str(path)
    if data is None:
        try:
            data = contents(path, LARGEST + 1)
        except OSError as fault:
            raise RefusedError("unreadable", Location(file), reason=type(fault).__name__) from None
    if len(data) > LARGEST:
        raise RefusedError("too-large", Location(file), largest=str(LARGEST // 1000))
    if not data.strip():
        raise RefusedError("empty", Location(file))
    if path.suffix.lower() in BOOKS or data.startswith(_BINARY):
        return read_xlsx(data, file)
    return (_read_csv(data, file, path.stem),)


# --- CSV ------------------------------------------------------------------------------------------


def _read_csv(data: bytes, file: str, name: str) -> Page:
    """Return the page of a CSV file; refuse it at the place that cannot be read."""
    text = decoded(data, file)
    if isinstance(text, Fault):
        raise RefusedError(text.code, text.location)
    rows: list[tuple[SheetCell, ...]] = []
    cells = 0
    for row in _csv_rows(text, file):
        rows.append(row)
        cells += len(row)
        if exceeds(len(rows), len(row), cells):
            raise too_large(row[-1].location if row else Location(file))
    return Page(name, tuple(rows))


def _csv_rows(text: str, file: str) -> Iterator[tuple[SheetCell, ...]]:
    """Yield the cells of each line; a quoted cell may contain separators and line ends."""
    stated = _STATED.match(text)
    separator = stated[1] if stated else _separator(text)
    plain = rf"([^{re.escape(separator)}\r\n]*+)"
    # Text behind a closed quotation mark belongs to the cell, as in every CSV reader.
    cell = re.compile(rf'"([^"]*+(?:""[^"]*+)*+)("?){plain}|{plain}')
    line, start = (2, stated.end()) if stated else (1, 0)
    at = start
    row: list[SheetCell] = []
    while at < len(text) or row:
        location = Location(file, line, at - start + 1)
        match = cell.match(text, at)
        assert match is not None, "any text begins with a cell, which may be empty"
        quoted, closed, behind, unquoted = match.groups()
        if closed == "":
            raise RefusedError("quote-open", location)
        content = unquoted if quoted is None else quoted.replace('""', '"') + behind
        if len(content) > LONGEST_CELL:
            raise too_long(location)
        clean = unguarded(unicodedata.normalize("NFC", content))
        row.append(SheetCell(clean, location, "text") if clean.strip() else SheetCell(None, location, "empty"))
        for inner in _LINE_END.finditer(text, at, match.end()):
            line, start = line + 1, inner.end()
        at = match.end()
        if text.startswith(separator, at):
            at += 1
            continue
        while row and row[-1].blank:
            row.pop()
        yield tuple(row)
        row.clear()
        if end := _LINE_END.match(text, at):
            line, start = line + 1, end.end()
            at = start


def _separator(text: str) -> str:
    """Return the most frequent separator in the first line that is not blank, outside quotation marks."""
    header = next((line for line in _LINE_END.split(text) if line.strip()), "")
    outside = re.sub(r'"[^"]*"?', "", header)
    return max(SEPARATORS, key=outside.count)
