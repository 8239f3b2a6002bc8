"""Sheets and own files read as they were handed in, each in a process of its own time and memory.

A file may be made so that reading it takes hours or all memory; that is the fault of whoever handed it in, and must
not keep the others from their marks.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path

from reportgen.base.errors import AssignmentError, Fault, Mark, Problem
from reportgen.base.limits import Limits
from reportgen.base.units import Language
from reportgen.base.words import as_problem
from reportgen.classes.platforms import Handed
from reportgen.classes.pool import each_within
from reportgen.handin import FileReading, files
from reportgen.report.key import Key
from reportgen.workbook import Page, read

LIMITS = Limits(seconds=60.0, megabytes=1000)
"""For one sheet: the largest that is not refused anyhow takes about an eighth of them."""

Pages = tuple[Page, ...]


def read_sheets(handed: Iterable[Handed], language: Language | None) -> Iterator[tuple[Handed, Pages | list[Problem]]]:
    """Each file with its pages, in their order, or with the faults for which it cannot be read."""
    calls = ((one, language) for one in handed)
    for (sheet, _), pages in each_within(LIMITS, _read, calls, __name__):
        yield sheet, [_beyond(sheet.path, language)] if pages is None else pages


def read_own(
    handed: Iterable[tuple[Handed, Key]], language: Language | None
) -> Iterator[tuple[Handed, FileReading | list[Problem]]]:
    """Each student's own file, read for a key, or with the faults for which it cannot be read."""
    calls = ((one, key, language) for one, key in handed)
    for (file, _, _), reading in each_within(LIMITS, _read_own, calls, __name__):
        yield file, [_beyond(file.path, language)] if reading is None else reading


def names_in(
    handed: Iterable[Handed], names: frozenset[str], language: Language | None
) -> Iterator[tuple[Handed, frozenset[str] | list[Problem]]]:
    """Each student's own file with those of some names that stand in it."""
    calls = ((one, names, language) for one in handed)
    for (file, _, _), standing in each_within(LIMITS, _names_in, calls, __name__):
        yield file, [_beyond(file.path, language)] if standing is None else standing


def _read_own(call: tuple[Handed, Key, Language | None]) -> FileReading | list[Problem]:
    file, key, language = call
    try:
        return files.read_file(file.path, files.content(file.path, file.data, language), key, language)
    except AssignmentError as error:
        return list(error.problems)


def _names_in(call: tuple[Handed, frozenset[str], Language | None]) -> frozenset[str] | list[Problem]:
    file, names, language = call
    try:
        data = files.content(file.path, file.data, language)
        return frozenset(files.names_in(file.path, data, names, language))
    except AssignmentError as error:
        return list(error.problems)


def _read(call: tuple[Handed, Language | None]) -> Pages | list[Problem]:
    """The pages of a file, in the process that reads it."""
    sheet, language = call
    if sheet.fault:
        return [as_problem(sheet.fault, language)]
    try:
        return read(sheet.path, language, sheet.data)
    except AssignmentError as error:
        return list(error.problems)


def _beyond(path: Path, language: Language | None) -> Problem:
    limits = {"seconds": f"{LIMITS.seconds:g}", "largest": str(LIMITS.megabytes)}
    return as_problem(Fault("sheet-beyond-limits", Mark(str(path)), limits), language)
