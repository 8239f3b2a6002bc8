"""Read sheets and own files and write marked copies, each in its own process with limits of time and memory.

A file may be made so that reading it takes hours or all memory. Only its own student is affected then; the others get
their marks.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from functools import partial
from pathlib import Path
from typing import TypeVar

from reportgen.base.errors import AssignmentError, Fault, Location, Problem
from reportgen.base.process_limits import Limits
from reportgen.base.units import Language
from reportgen.base.words import as_problem
from reportgen.case.answer_key import Key
from reportgen.classes.fault_isolation import isolated
from reportgen.classes.platforms import Handed
from reportgen.classes.worker_pool import each_within
from reportgen.handin import FileReading, file_kinds
from reportgen.handin.drawing_reader import WantedPlans
from reportgen.marking.marking_data import Marking
from reportgen.marking.marking_policy import Policy
from reportgen.workbook import Page, read

LIMITS = Limits(seconds=60.0, megabytes=1000)
"""Limits for one sheet; the largest accepted one takes about an eighth of them."""

Pages = tuple[Page, ...]
Result = TypeVar("Result")
_Work = Callable[[Language | None], Result]
"""Reads or writes one file; its arguments are bound, so that it can be sent to another process."""


def read_sheets(handed: Iterable[Handed], language: Language | None) -> Iterator[tuple[Handed, Pages | list[Problem]]]:
    """Return each file with its pages, in order, or with the problems for which it cannot be read."""
    return _each(((sheet, partial(_read, sheet)) for sheet in handed), language)


def read_own(
    handed: Iterable[tuple[Handed, Key, WantedPlans | None]], language: Language | None
) -> Iterator[tuple[Handed, FileReading | list[Problem]]]:
    """Return each student's own file, read for a key and its plans, or with the problems that prevented it."""
    return _each(((file, partial(_read_own, file, key, plans)) for file, key, plans in handed), language)


def names_in(
    handed: Iterable[Handed], names: frozenset[str], language: Language | None
) -> Iterator[tuple[Handed, frozenset[str] | list[Problem]]]:
    """Return each student's own file with those of the given names that its text contains."""
    return _each(((file, partial(_names_in, file, names)) for file in handed), language)


def marked_copies(
    marked: Iterable[tuple[Handed, FileReading, Marking]], policy: Policy, language: Language | None
) -> Iterator[tuple[Handed, tuple[str, bytes] | list[Problem]]]:
    """Return each own file with the name and content of its marked copy, or the problems for which there is none."""
    works = ((file, partial(_marked_copy, file, reading, marking, policy)) for file, reading, marking in marked)
    return _each(works, language)


def _each(
    works: Iterable[tuple[Handed, _Work[Result]]], language: Language | None
) -> Iterator[tuple[Handed, Result | list[Problem]]]:
    """Yield each file with its result within the limits, or with its problems, in order."""
    calls = ((file, work, language) for file, work in works)
    for (file, _, _), result in each_within(LIMITS, _isolated, calls, __name__):
        yield file, [_beyond(file.path, language)] if result is None else result


def _isolated(call: tuple[Handed, _Work[Result], Language | None]) -> Result | list[Problem]:
    """Return the result for a file, in the process that reads it."""
    file, work, language = call
    return isolated(lambda: work(language), file.path, language)


def _read(sheet: Handed, language: Language | None) -> Pages:
    if sheet.fault:
        raise AssignmentError([as_problem(sheet.fault, language)])
    return read(sheet.path, language, sheet.data)


def _read_own(file: Handed, key: Key, plans: WantedPlans | None, language: Language | None) -> FileReading:
    return file_kinds.read_file(file.path, file_kinds.content(file.path, file.data, language), key, language, plans)


def _names_in(file: Handed, names: frozenset[str], language: Language | None) -> frozenset[str]:
    data = file_kinds.content(file.path, file.data, language)
    return frozenset(file_kinds.names_in(file.path, data, names, language))


def _marked_copy(
    file: Handed, reading: FileReading, marking: Marking, policy: Policy, language: Language | None
) -> tuple[str, bytes]:
    data = file_kinds.content(file.path, file.data, language)
    return file_kinds.marked_copy(file.path, data, reading, marking, policy)


def _beyond(path: Path, language: Language | None) -> Problem:
    limits = {"seconds": f"{LIMITS.seconds:g}", "largest": str(LIMITS.megabytes)}
    return as_problem(Fault("sheet-beyond-limits", Location(str(path)), limits), language)
