"""A table file by its path: a CSV or XLSX file becomes pages of located cells, any other file is refused."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterator
from pathlib import Path

from reportgen.assignment.faults import as_error
from reportgen.assignment.source import mark_in
from reportgen.errors import Mark
from reportgen.notation.numbers import Language
from reportgen.workbook.cells import (
    LONGEST_CELL,
    Cell,
    Page,
    RefusedError,
    exceeds,
    too_large,
    too_long,
    unguarded,
)
from reportgen.workbook.spreadsheet import read_xlsx

LARGEST = 10_000_000
"""Bytes of a file."""
BOOKS = frozenset({".xlsx", ".xlsm", ".xltx", ".xltm", ".xls", ".xlsb", ".ods"})
_BINARY = (b"PK\x03\x04", b"\xd0\xcf\x11\xe0")

SEPARATORS = ",;\t"
_STATED = re.compile(r"sep=(.)\r?\n")
_LINE_END = re.compile(r"\r\n|\r|\n")
_WIDE = (b"\xff\xfe", b"\xfe\xff")


def read(path: Path, language: Language | None = None) -> tuple[Page, ...]:
    """The pages of a CSV or XLSX file; raises `AssignmentError` with the fault that stops it, in `language`."""
    try:
        return _read(path)
    except RefusedError as refused:
        raise as_error([refused.fault], language) from None


def _read(path: Path) -> tuple[Page, ...]:
    file = str(path)
    try:
        with path.open("rb") as stream:
            data = stream.read(LARGEST + 1)
    except OSError as fault:
        raise RefusedError("unreadable", Mark(file), reason=type(fault).__name__) from None
    if len(data) > LARGEST:
        raise RefusedError("too-large", Mark(file), largest=str(LARGEST // 1000))
    if not data.strip():
        raise RefusedError("empty", Mark(file))
    if path.suffix.lower() in BOOKS or data.startswith(_BINARY):
        return read_xlsx(data, file)
    return (_read_csv(data, file, path.stem),)


# --- CSV ------------------------------------------------------------------------------------------


def _read_csv(data: bytes, file: str, name: str) -> Page:
    """The page of a CSV file in UTF-8, refused at the place of what cannot be read."""
    if data.startswith(_WIDE):
        raise RefusedError("encoding", Mark(file))
    if b"\0" in data:
        raise RefusedError("binary", mark_in(data, data.index(b"\0"), file))
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as fault:
        raise RefusedError("encoding", mark_in(data, fault.start, file)) from None
    rows: list[tuple[Cell, ...]] = []
    cells = 0
    for row in _rows(text, file):
        rows.append(row)
        cells += len(row)
        if exceeds(len(rows), len(row), cells):
            raise too_large(row[-1].mark if row else Mark(file))
    return Page(name, tuple(rows))


def _rows(text: str, file: str) -> Iterator[tuple[Cell, ...]]:
    """The cells of each line; a quoted cell may hold separators and line ends."""
    stated = _STATED.match(text)
    separator = stated[1] if stated else _separator(text)
    plain = rf"([^{re.escape(separator)}\r\n]*+)"
    # What follows a closed quotation mark belongs to the cell, as every reader of CSV has it.
    cell = re.compile(rf'"([^"]*+(?:""[^"]*+)*+)("?){plain}|{plain}')
    line, start = (2, stated.end()) if stated else (1, 0)
    at = start
    row: list[Cell] = []
    while at < len(text) or row:
        mark = Mark(file, line, at - start + 1)
        match = cell.match(text, at)
        assert match is not None, "any text begins with a cell, which may be empty"
        quoted, closed, behind, unquoted = match.groups()
        if closed == "":
            raise RefusedError("quote-open", mark)
        content = unquoted if quoted is None else quoted.replace('""', '"') + behind
        if len(content) > LONGEST_CELL:
            raise too_long(mark)
        shown = unguarded(unicodedata.normalize("NFC", content))
        row.append(Cell(shown, mark, "text") if shown.strip() else Cell(None, mark, "empty"))
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
    """The separator that stands most often in the first line with something in it, outside quotation marks."""
    header = next((line for line in _LINE_END.split(text) if line.strip()), "")
    outside = re.sub(r'"[^"]*"?', "", header)
    return max(SEPARATORS, key=outside.count)
