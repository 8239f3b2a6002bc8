"""XLSX → pages of located cells, read part by part so that nothing is kept but what is counted."""

from __future__ import annotations

import datetime
import math
import posixpath
import re
import unicodedata
from collections.abc import Mapping
from dataclasses import dataclass, field

from reportgen.errors import CellMark
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
from reportgen.workbook.package import Attributes, Package

MOST_SHEETS = 100
MOST_ELEMENTS = 20 * MOST_CELLS
"""Rows and cells with nothing but a style, which programs write freely."""
_REFERENCE = re.compile(r"([A-Z]{1,3})([1-9][0-9]{0,6})")
_ESCAPE = re.compile(r"_x([0-9A-Fa-f]{4})_")
_DATES = frozenset({*range(14, 23), *range(27, 37), *range(45, 48), *range(50, 59)})
"""Number formats every program knows as dates and times."""
_NO_DATE = re.compile(r'"[^"]*"|\[[^\]]*\]|\\.|_.|\*.')
_EPOCHS = {False: datetime.datetime(1899, 12, 30), True: datetime.datetime(1904, 1, 1)}


def read_xlsx(data: bytes, file: str) -> tuple[Page, ...]:
    """The sheets of a workbook in their order; raises `RefusedError`."""
    package = Package(data, file)
    root = next((r.target for r in package.relations("_rels/.rels").values() if r.kind == "officeDocument"), "")
    workbook = root.lstrip("/")
    if workbook not in package:
        raise package.refused("sheet-no-zip")
    folder, name = posixpath.split(workbook)
    relations = package.relations(posixpath.join(folder, "_rels", f"{name}.rels"))
    places = {
        id: one.target.lstrip("/") if one.target.startswith("/") else posixpath.normpath(f"{folder}/{one.target}")
        for id, one in relations.items()
    }
    kinds = {one.kind: places[id] for id, one in relations.items()}
    elements = package.elements(workbook)
    epoch = any(tag == "workbookPr" and a.get("date1904") in ("1", "true") for tag, a in elements)
    context = _Context(
        package,
        _shared(package, kinds.get("sharedStrings", "")),
        _date_styles(package, kinds.get("styles", "")),
        _EPOCHS[epoch],
    )
    sheets = [attributes for tag, attributes in elements if tag == "sheet"]
    if len(sheets) > MOST_SHEETS:
        raise package.refused("table-too-large", **_limits())
    pages = []
    for number, sheet in enumerate(sheets, start=1):
        place, title = places.get(sheet.get("id", ""), ""), sheet.get("name", "")
        if place not in package:
            raise package.refused("sheet-damaged", text=title)
        hidden = sheet.get("state", "visible") != "visible"
        pages.append(Page(title, _Sheet(context, title, number).rows(place), hidden))
    return tuple(pages)


def _limits() -> dict[str, str]:
    return {"rows": str(MOST_ROWS), "columns": str(MOST_COLUMNS), "cells": str(MOST_CELLS)}


@dataclass(frozen=True, slots=True)
class _Context:
    """What the sheets of a workbook share."""

    package: Package
    strings: tuple[str, ...]
    dates: frozenset[int]
    epoch: datetime.datetime


def _shared(package: Package, name: str) -> tuple[str, ...]:
    """The table of strings; the phonetic readings beside them are left out."""
    if name not in package:
        return ()
    strings: list[str] = []
    parts: list[str] = []
    open_tags: list[str] = []

    def start(tag: str, _: Attributes) -> None:
        open_tags.append(tag)
        if tag == "si":
            parts.clear()

    def end(tag: str) -> None:
        open_tags.pop()
        if tag == "si":
            strings.append(_text("".join(parts)))

    def text(data: str) -> None:
        if open_tags[-1] == "t" and "rPh" not in open_tags:
            parts.append(data)

    package.walk(name, start, end, text)
    return tuple(strings)


def _date_styles(package: Package, name: str) -> frozenset[int]:
    """The cell styles that show a number as a date or a time."""
    if name not in package:
        return frozenset()
    formats: dict[str, str] = {}
    dates: set[int] = set()
    count = 0
    inside = False

    def start(tag: str, attributes: Attributes) -> None:
        nonlocal count, inside
        if tag == "numFmt":
            formats[attributes.get("numFmtId", "")] = attributes.get("formatCode", "")
        elif tag == "cellXfs":
            inside = True
        elif tag == "xf" and inside:
            if _is_date(attributes.get("numFmtId", "0"), formats):
                dates.add(count)
            count += 1

    def end(tag: str) -> None:
        nonlocal inside
        inside = inside and tag != "cellXfs"

    package.walk(name, start, end)
    return frozenset(dates)


def _is_date(id: str, formats: Mapping[str, str]) -> bool:
    if id in formats:
        code = _NO_DATE.sub("", formats[id]).lower()
        return code != "general" and any(letter in code for letter in "dmyhs")
    return id.isdigit() and len(id) < 4 and int(id) in _DATES


def _text(raw: str) -> str:
    """A string as typed: composed, its _xHHHH_ escapes undone."""
    return unicodedata.normalize("NFC", _ESCAPE.sub(lambda match: chr(int(match[1], 16)), raw))


@dataclass
class _Sheet:
    """Collects the cells of one sheet; `row` and `column` are the place of the current cell."""

    context: _Context
    name: str
    number: int
    cells: dict[int, dict[int, Cell]] = field(default_factory=dict)
    row: int = 0
    column: int = 0
    elements: int = 0
    attributes: Attributes = field(default_factory=dict)
    open_tags: list[str] = field(default_factory=list)
    parts: dict[str, list[str]] = field(default_factory=dict)

    def rows(self, part: str) -> tuple[tuple[Cell, ...], ...]:
        """All rows from the first on, as long as their last cell that holds something."""
        self.context.package.walk(part, self._start, self._end, self._data)
        last = max(self.cells, default=0)
        if sum(max(row) for row in self.cells.values()) > MOST_CELLS:
            raise RefusedError("table-too-large", self._mark(), _limits())
        return tuple(self._filled(row) for row in range(1, last + 1))

    def _filled(self, row: int) -> tuple[Cell, ...]:
        cells = self.cells.get(row, {})
        return tuple(
            cells.get(column) or Cell(None, self._mark(row, column), "empty")
            for column in range(1, max(cells, default=0) + 1)
        )

    def _mark(self, row: int = 0, column: int = 0) -> CellMark:
        file = self.context.package.mark.file
        return CellMark(file, row or max(self.row, 1), column or max(self.column, 1), self.name, self.number)

    def _start(self, tag: str, attributes: Attributes) -> None:
        self.open_tags.append(tag)
        if tag == "row":
            self._count()
            given = attributes.get("r", "")
            self.row = int(given) if given.isdigit() and len(given) < 8 else self.row + 1
            self.column = 0
        elif tag == "c":
            self._count()
            self._place(attributes.get("r"))
            self.attributes, self.parts = attributes, {}

    def _count(self) -> None:
        self.elements += 1
        if self.elements > MOST_ELEMENTS:
            raise RefusedError("table-too-large", self._mark(), _limits())

    def _place(self, reference: str | None) -> None:
        if reference is None:
            self.column += 1
            return
        match = _REFERENCE.fullmatch(reference)
        if match is None:
            raise RefusedError("sheet-damaged", self._mark(), {"text": reference})
        self.row, self.column = int(match[2]), 0
        for letter in match[1]:
            self.column = self.column * 26 + ord(letter) - ord("A") + 1

    def _data(self, data: str) -> None:
        tag = self.open_tags[-1]
        if tag in ("v", "f", "t") and "rPh" not in self.open_tags and "c" in self.open_tags:
            self.parts.setdefault(tag, []).append(data)

    def _end(self, tag: str) -> None:
        self.open_tags.pop()
        if tag == "f":
            self.parts.setdefault("f", [])
        if tag == "c":
            cell = self._cell()
            if not cell.blank:
                self._keep(cell)

    def _keep(self, cell: Cell) -> None:
        inside = self.row <= MOST_ROWS and self.column <= MOST_COLUMNS
        if not inside or len(self.cells) >= MOST_CELLS:
            raise RefusedError("table-too-large", cell.mark, _limits())
        if isinstance(cell.value, str) and len(cell.value) > LONGEST_CELL:
            raise RefusedError("text-too-long", cell.mark, {"largest": str(LONGEST_CELL)})
        self.cells.setdefault(self.row, {})[self.column] = cell

    def _cell(self) -> Cell:
        mark = self._mark()
        value, kind = self._value(mark)
        if "f" in self.parts:
            return Cell(value, mark, "formula", f"={''.join(self.parts['f'])}")
        return Cell(value, mark, kind)

    def _value(self, mark: CellMark) -> tuple[str | float | None, CellKind]:
        raw = "".join(self.parts.get("v", ()))
        match self.attributes.get("t", "n"):
            case "inlineStr":
                return _written(_text("".join(self.parts.get("t", ()))))
            case "s":
                strings = self.context.strings
                if not raw.strip():
                    return None, "empty"
                if not re.fullmatch(r"\s*[0-9]{1,9}\s*", raw) or int(raw) >= len(strings):
                    raise RefusedError("sheet-damaged", mark, {"text": raw})
                return _written(strings[int(raw)])
            case "str":
                return _written(_text(raw))
            case "e":
                return raw, "error"
            case "b":
                return ("TRUE" if raw.strip() in ("1", "true") else "FALSE"), "boolean"
            case "d":
                return raw.strip(), "date"
            case _:
                return self._number(raw, mark)

    def _number(self, raw: str, mark: CellMark) -> tuple[str | float | None, CellKind]:
        if not raw.strip():
            return None, "empty"
        try:
            number = float(raw)
        except ValueError:
            number = math.nan
        if not math.isfinite(number):
            raise RefusedError("sheet-damaged", mark, {"text": raw})
        style = self.attributes.get("s", "0")
        if style.isdigit() and len(style) < 7 and int(style) in self.context.dates:
            return self._date(number), "date"
        return number, "number"

    def _date(self, days: float) -> str:
        """A day as 2011-03-24, a moment as 2011-03-24T08:30:00, a time of day as 08:30:00."""
        try:
            moment = self.context.epoch + datetime.timedelta(seconds=round(days * 86400))
        except OverflowError:
            return repr(days)
        if 0 <= days < 1:
            return moment.time().isoformat()
        return moment.date().isoformat() if float(days).is_integer() else moment.isoformat()


def _written(text: str) -> tuple[str | None, CellKind]:
    return (text, "text") if text.strip() else (None, "empty")
