"""A table file by its path: CSV or XLSX by what it holds, refused with a located fault if it is neither."""

from __future__ import annotations

from pathlib import Path

from reportgen.assignment.faults import as_problem
from reportgen.errors import AssignmentError, Mark
from reportgen.notation.numbers import Language
from reportgen.workbook.cells import Page, RefusedError
from reportgen.workbook.delimited import read_csv
from reportgen.workbook.spreadsheet import read_xlsx

LARGEST = 10_000_000
BOOKS = frozenset({".xlsx", ".xlsm", ".xltx", ".xltm", ".xls", ".xlsb", ".ods"})
_BINARY = (b"PK\x03\x04", b"\xd0\xcf\x11\xe0")


def read(path: Path, language: Language = "vi") -> tuple[Page, ...]:
    """The pages of a CSV or XLSX file; raises `AssignmentError` with the fault that stops it, in `language`."""
    try:
        return _read(path)
    except RefusedError as refused:
        raise AssignmentError([as_problem(refused.fault, language)]) from None


def _read(path: Path) -> tuple[Page, ...]:
    file = str(path)
    try:
        with path.open("rb") as stream:
            data = stream.read(LARGEST + 1)
    except OSError as fault:
        raise RefusedError("unreadable", Mark(file), {"reason": type(fault).__name__}) from None
    if len(data) > LARGEST:
        raise RefusedError("too-large", Mark(file), {"largest": str(LARGEST // 1000)})
    if not data.strip():
        raise RefusedError("empty", Mark(file))
    if path.suffix.lower() in BOOKS or data.startswith(_BINARY):
        return read_xlsx(data, file)
    return (read_csv(data, file, path.stem),)
