"""XLSX → pages of located cells, read by openpyxl from a copy that holds the judged parts it needs and no others."""

from __future__ import annotations

import datetime
import io
import math
import posixpath
import re
import unicodedata
import warnings
import zipfile
from collections.abc import Iterator
from contextlib import closing, contextmanager, redirect_stdout
from dataclasses import dataclass, field
from itertools import tee
from typing import TYPE_CHECKING, Any

from reportgen.errors import CellMark, Mark
from reportgen.workbook.cells import (
    LONGEST_CELL,
    MOST_CELLS,
    MOST_COLUMNS,
    MOST_ROWS,
    Cell,
    CellKind,
    Page,
    RefusedError,
)
from reportgen.workbook.extent import MOST_GROUPS, measure
from reportgen.workbook.package import CONTENT_TYPES, Package

if TYPE_CHECKING:
    from openpyxl import Workbook

MOST_SHEETS = 100
_ESCAPE = re.compile(r"_x([0-9A-Fa-f]{4})_")


def read_xlsx(data: bytes, file: str) -> tuple[Page, ...]:
    """The sheets of a workbook in their order; raises `RefusedError`."""
    parts = _parts(Package(data, file))
    copy = parts.copy()
    with warnings.catch_warnings(), redirect_stdout(io.StringIO()), _damage(Mark(file)):
        # openpyxl warns of, and even prints, what it leaves out: looks and rules, but no value of a cell.
        warnings.simplefilter("ignore")
        with closing(_load(copy, stored=True)) as values:
            if len(values.worksheets) != len(parts.cells):
                raise RefusedError("sheet-damaged", Mark(file))
            if not parts.formulas:
                return _pages(values, None, parts, file)
            with closing(_load(copy, stored=False)) as formulas:
                return _pages(values, formulas, parts, file)


def _load(copy: bytes, *, stored: bool) -> Workbook:
    """The workbook with the stored results of its formulas, or with their texts."""
    from openpyxl import load_workbook

    return load_workbook(io.BytesIO(copy), read_only=True, data_only=stored, keep_links=False)


@contextmanager
def _damage(mark: Mark) -> Iterator[None]:
    """Whatever goes wrong inside is damage of the workbook: openpyxl has no exception of its own for that."""
    try:
        yield
    except RefusedError:
        raise
    except Exception:
        raise RefusedError("sheet-damaged", mark) from None


@dataclass(frozen=True, slots=True)
class _Parts:
    """The parts openpyxl is to read; for each sheet of cells, how many it has."""

    package: Package
    names: tuple[str, ...]
    strings: str
    cells: tuple[int, ...]
    formulas: bool

    def copy(self) -> bytes:
        stream = io.BytesIO()
        with zipfile.ZipFile(stream, "w") as made:
            for name in self.names:
                content = self.package.content(name)
                if name == self.strings:
                    # openpyxl drops these letters, which tell seven characters written _x005F_x000D_ from the
                    # carriage return written _x000D_: so they are given in a way that leaves them there.
                    content = content.replace(b"x005F_", b"x005Fx005F__")
                made.writestr(name, content)
        return stream.getvalue()


def _parts(package: Package) -> _Parts:
    """Raises `RefusedError` where a sheet cannot be found or a part has too much in it."""
    root = next((r.target for r in package.relations("_rels/.rels").values() if r.kind == "officeDocument"), "")
    workbook = root.lstrip("/")
    if workbook not in package:
        raise package.refused("sheet-no-zip")
    folder, name = posixpath.split(workbook)
    beside = posixpath.join(folder, "_rels", f"{name}.rels")
    relations = package.relations(beside)
    places = {
        id: one.target.lstrip("/") if one.target.startswith("/") else posixpath.normpath(f"{folder}/{one.target}")
        for id, one in relations.items()
    }
    listed = [attributes.get("id", "") for tag, attributes in package.elements(workbook) if tag == "sheet"]
    if len(listed) > MOST_SHEETS:
        raise package.refused("table-too-large", **_limits())
    found = {places[id] for id in listed if places.get(id, "") in package}
    if len(found) < len(listed):
        raise package.refused("sheet-damaged")
    sheets = [places[id] for id in listed if relations[id].kind == "worksheet"]
    if not sheets:
        raise package.refused("sheet-no-zip")
    tables = {one.kind: places[id] for id, one in relations.items() if one.kind in ("styles", "sharedStrings")}
    others = [CONTENT_TYPES, workbook, beside, *(place for place in tables.values() if place in package)]
    for place in others:
        measure(package, place)
    extents = [measure(package, place) for place in sheets]
    return _Parts(
        package,
        tuple(dict.fromkeys([*others, *sheets])),
        tables.get("sharedStrings", ""),
        tuple(extent.cells for extent in extents),
        any(extent.formulas for extent in extents),
    )


def _limits() -> dict[str, str]:
    return {"rows": str(MOST_ROWS), "columns": str(MOST_COLUMNS), "cells": str(MOST_CELLS)}


def _pages(values: Workbook, formulas: Workbook | None, parts: _Parts, file: str) -> tuple[Page, ...]:
    pages = []
    for number, (sheet, count) in enumerate(zip(values.worksheets, parts.cells, strict=True), start=1):
        sheet.reset_dimensions()
        if formulas is None:
            written, shown = tee(sheet.rows)
        else:
            same = formulas.worksheets[number - 1]
            same.reset_dimensions()
            written, shown = same.rows, sheet.rows
        rows = _Sheet(file, sheet.title, number).rows(zip(written, shown, strict=True), count)
        pages.append(Page(sheet.title, rows, sheet.sheet_state != "visible"))
    return tuple(pages)


Row = tuple[Any, ...]


@dataclass
class _Sheet:
    """Collects the cells of one sheet by row and column."""

    file: str
    name: str
    number: int
    cells: dict[int, dict[int, Cell]] = field(default_factory=dict)

    def rows(self, read: Iterator[tuple[Row, Row]], count: int) -> tuple[tuple[Cell, ...], ...]:
        """All rows from the first on, as long as their last cell that holds something.

        `read` gives each row with its formulas and with its values; `count` cells must be among them.
        """
        found = self._collect(read)
        last = max(self.cells, default=0)
        if found != count:
            # openpyxl leaves out rows and cells that are not in order.
            raise RefusedError("sheet-damaged", self._mark(1, 1))
        if sum(max(row) for row in self.cells.values()) > MOST_CELLS:
            raise RefusedError("table-too-large", self._mark(last, 1), _limits())
        return tuple(self._filled(row) for row in range(1, last + 1))

    def _collect(self, read: Iterator[tuple[Row, Row]]) -> int:
        """Keep what is not empty; the number of all cells met."""
        from openpyxl.cell.read_only import ReadOnlyCell

        found = 0
        for number, pair in enumerate(self._whole(read), start=1):
            if number > MOST_GROUPS:
                raise RefusedError("sheet-damaged", self._mark(number, 1))
            for written, shown in zip(*pair, strict=True):
                if isinstance(written, ReadOnlyCell):
                    found += 1
                    cell = _cell(written, shown, self._mark(written.row, written.column))
                    if not cell.blank:
                        self._keep(cell)
        return found

    def _whole(self, read: Iterator[tuple[Row, Row]]) -> Iterator[tuple[Row, Row]]:
        """The rows up to one that openpyxl cannot read; what is told is the row after the last that was whole."""
        last = 0
        try:
            for pair in read:
                yield pair
                last += 1
        except Exception:
            raise RefusedError("sheet-damaged", self._mark(last + 1, 1)) from None

    def _filled(self, row: int) -> tuple[Cell, ...]:
        cells = self.cells.get(row, {})
        return tuple(
            cells.get(column) or Cell(None, self._mark(row, column), "empty")
            for column in range(1, max(cells, default=0) + 1)
        )

    def _mark(self, row: int, column: int) -> CellMark:
        return CellMark(self.file, row, column, self.name, self.number)

    def _keep(self, cell: Cell) -> None:
        row, column = cell.mark.line, cell.mark.column
        if row > MOST_ROWS or column > MOST_COLUMNS or len(self.cells) >= MOST_CELLS:
            raise RefusedError("table-too-large", cell.mark, _limits())
        if isinstance(cell.value, str) and len(cell.value) > LONGEST_CELL:
            raise RefusedError("text-too-long", cell.mark, {"largest": str(LONGEST_CELL)})
        self.cells.setdefault(row, {})[column] = cell


def _cell(written: Any, shown: Any, mark: CellMark) -> Cell:
    value, kind = _value(shown.value, shown.data_type, mark)
    if written.data_type != "f":
        return Cell(value, mark, kind)
    # The formula of an array is an object with its text, that of a table of data one without.
    text = written.value if isinstance(written.value, str) else getattr(written.value, "text", "=")
    return Cell(value, mark, "formula", text)


def _value(value: object, type: str, mark: CellMark) -> tuple[str | float | None, CellKind]:
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
                raise RefusedError("sheet-damaged", mark)
            return number, "number"
        case str() if type == "e":
            return value, "error"
        case str():
            text = unicodedata.normalize("NFC", _ESCAPE.sub(lambda match: chr(int(match[1], 16)), value))
            return (text, "text") if text.strip() else (None, "empty")
        case _:
            return _date(value), "date"


def _date(value: object) -> str:
    """A day as 2011-03-24, a moment as 2011-03-24T08:30:00, a time of day as 08:30:00, hours passed as 36:00:00."""
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
