"""CSV text → a page of located cells: quoted separators and line ends, separators , ; and tab."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterator
from dataclasses import dataclass, field

from reportgen.assignment.source import mark_in
from reportgen.errors import Mark
from reportgen.workbook.cells import (
    LONGEST_CELL,
    MOST_CELLS,
    MOST_COLUMNS,
    MOST_ROWS,
    Cell,
    Page,
    RefusedError,
    unguarded,
)

SEPARATORS = ",;\t"
_STATED = re.compile(r"sep=(.)\r?\n")
_WIDE = (b"\xff\xfe", b"\xfe\xff")


def read_csv(data: bytes, file: str, name: str) -> Page:
    """The page of a CSV file in UTF-8; raises `RefusedError` at the place of what cannot be read."""
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
    for row in _Scanner(text, file).rows():
        rows.append(row)
        cells += len(row)
        if len(rows) > MOST_ROWS or cells > MOST_CELLS or len(row) > MOST_COLUMNS:
            limits = {"rows": str(MOST_ROWS), "columns": str(MOST_COLUMNS), "cells": str(MOST_CELLS)}
            raise RefusedError("table-too-large", row[-1].mark if row else Mark(file), limits)
    return Page(name, tuple(rows))


def separator(text: str) -> str:
    """The separator that stands most often in the first line with something in it, outside quotation marks."""
    header = next((line for line in re.split(r"\r\n|\r|\n", text) if line.strip()), "")
    outside = re.sub(r'"[^"]*"?', "", header)
    return max(SEPARATORS, key=outside.count)


@dataclass
class _Scanner:
    """Walks through the text once; `line` and `column` are the place of the next character, from 1."""

    text: str
    file: str
    at: int = 0
    line: int = 1
    column: int = 1
    separator: str = field(init=False)

    def __post_init__(self) -> None:
        stated = _STATED.match(self.text)
        if stated:
            self.at, self.line = stated.end(), 2
        self.separator = stated[1] if stated else separator(self.text)

    def rows(self) -> Iterator[tuple[Cell, ...]]:
        while self.at < len(self.text):
            row = list(self._row())
            while row and row[-1].blank:
                row.pop()
            yield tuple(row)

    def _row(self) -> Iterator[Cell]:
        while True:
            mark = Mark(self.file, self.line, self.column)
            quoted = self._next() == '"'
            text = self._quoted(mark) if quoted else self._plain()
            if len(text) > LONGEST_CELL:
                raise RefusedError("text-too-long", mark, {"largest": str(LONGEST_CELL)})
            shown = unguarded(unicodedata.normalize("NFC", text))
            yield Cell(shown, mark, "text") if shown.strip() else Cell(None, mark, "empty")
            if self._next() != self.separator:
                self._end_of_line()
                return
            self._step()

    def _plain(self) -> str:
        start = self.at
        while self._next() not in (self.separator, "\r", "\n", ""):
            self._step()
        return self.text[start : self.at]

    def _quoted(self, mark: Mark) -> str:
        parts: list[str] = []
        self._step()
        while True:
            start = self.at
            while self._next() not in ('"', ""):
                self._step()
            parts.append(self.text[start : self.at])
            if not self._next():
                raise RefusedError("quote-open", mark)
            self._step()
            if self._next() != '"':
                # What follows a closed quotation mark belongs to the cell, as every reader of CSV has it.
                return "".join(parts) + self._plain()
            parts.append('"')
            self._step()

    def _next(self) -> str:
        return self.text[self.at : self.at + 1]

    def _step(self) -> None:
        one = self._next()
        ends = one == "\n" or (one == "\r" and self.text[self.at + 1 : self.at + 2] != "\n")
        self.at += 1
        self.line, self.column = (self.line + 1, 1) if ends else (self.line, self.column + 1)

    def _end_of_line(self) -> None:
        if self._next() == "\r" and self.text[self.at + 1 : self.at + 2] == "\n":
            self._step()
        if self._next():
            self._step()
