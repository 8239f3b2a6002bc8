"""Faults as values: their place, their code, and a hint for fixing them.

A reader of input collects `Problem`s instead of stopping at the first one; `ReportgenError` carries all of them to
the caller. This module contains no words: `message` is already in the requested language.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal

from reportgen.base.records import Record, field, replace, uncompared


class Location(Record):
    """A place in a file; `line` and `column` count from 1."""

    file: str
    line: int = 1
    column: int = 1

    def __str__(self) -> str:
        return f"{self.file}:{self.line}:{self.column}"

    def __lt__(self, other: Location) -> bool:
        return self.place < other.place

    @property
    def place(self) -> tuple[str, int, int, int]:
        """Sort key of the place: file, sheet (0 in a text), line, column."""
        return (self.file, 0, self.line, self.column)


class CellLocation(Location):
    """A cell of a spreadsheet file: `line` is its row; `number` orders the sheets, from 1."""

    sheet: str = ""
    number: int = 1

    def __str__(self) -> str:
        return f"{self.file}:{self.sheet}!{column_letters(self.column)}{self.line}"

    @property
    def place(self) -> tuple[str, int, int, int]:
        return (self.file, self.number, self.line, self.column)


def column_letters(column: int) -> str:
    """Return the spreadsheet letters of a column counted from 1: A … Z, AA, AB, …."""
    letters = ""
    while column > 0:
        column, digit = divmod(column - 1, 26)
        letters = chr(ord("A") + digit) + letters
    return letters


Level = Literal["error", "warning", "note"]

Where = tuple[str | int, ...]
"""A place in the content of a file: keys and list indices from the top."""


@uncompared("where")
class Fault(Record):
    """A fault at a location of a text; `arguments` fill the message named by `code`.

    An argument `hint` names a hint that replaces the code's own.
    """

    code: str
    location: Location
    arguments: Mapping[str, str] = field(default_factory=dict)
    where: Where = ()
    """The path in the content of its file, if there is one."""

    @property
    def remedies(self) -> tuple[str, ...]:
        """Replacements for the faulty text, as they would be typed."""
        if self.code == "missing-unit":
            return (f"{self.arguments['text'].strip()} {self.arguments['unit']}",)
        return tuple(dict.fromkeys(self.arguments[name] for name in ("fixed", "other") if name in self.arguments))

    @property
    def missing(self) -> tuple[Where, ...]:
        """Places of the keys, each of which would remedy a missing key; () for any other fault."""
        if self.code == "needs-besides":
            return ((*self.where[:-1], self.arguments["other"]),)
        if self.code != "missing-key":
            return ()
        keys = self.arguments["key"].split(" | ")
        table = self.where[:-1] if self.where and self.where[-1] in keys else self.where
        return tuple((*table, key) for key in keys)

    @property
    def wordless(self) -> str:
        """Text used if the messages themselves cannot be read."""
        return f"{self.code} {self.arguments.get('reason', '')}".rstrip()


class Finding(Record):
    """A fault of the content at a path of the file, before its location is known; `at` its value or its key."""

    code: str
    where: Where
    arguments: Mapping[str, str] = field(default_factory=dict)
    at: Literal["value", "key"] = "value"


@uncompared("where", "remedies", "missing")
class Problem(Record):
    """One fault of an input file: `FILE:LINE:COLUMN: error[code]: message` and an optional hint.

    A valid file may have warnings, and notes on how it was understood. `advice` is the label of a hint; `where`,
    `remedies` and `missing` are those of its fault.
    """

    code: str
    message: str
    location: Location
    hint: str | None = None
    level: Level = "error"
    advice: str = "hint"
    where: Where = ()
    remedies: tuple[str, ...] = ()
    missing: tuple[Where, ...] = ()

    def in_file(self, file: str) -> Problem:
        """Return the same problem, its file named as `file`."""
        return replace(self, location=replace(self.location, file=file))

    def __str__(self) -> str:
        line = f"{self.location}: {self.level}[{self.code}]: {self.message}"
        return f"{line}\n    {self.advice}: {self.hint}" if self.hint else line


class ReportgenError(Exception):
    """Base of all exceptions that this package raises on purpose; `exit_code` is that of the command line."""

    exit_code = 1


class AssignmentError(ReportgenError):
    """An input file is at fault; `problems` are all its faults, in the order of the file."""

    def __init__(self, problems: list[Problem]) -> None:
        self.problems = tuple(sorted(problems, key=lambda problem: problem.location))
        super().__init__("\n".join(str(problem) for problem in self.problems))

    def __reduce__(self) -> tuple[type[AssignmentError], tuple[list[Problem]]]:
        # Unpickling builds it from its problems, not from their text.
        return type(self), (list(self.problems),)


class TemplateError(ReportgenError):
    """A template has a fault; the message names its file and line."""

    exit_code = 1


class DocumentError(ReportgenError):
    """A finished tree is inconsistent; `faults` lists all problems."""

    def __init__(self, faults: list[str]) -> None:
        self.faults = tuple(faults)
        super().__init__("\n".join(faults))

    def __reduce__(self) -> tuple[type[DocumentError], tuple[list[str]]]:
        return type(self), (list(self.faults),)


class SheetError(ReportgenError):
    """A plate does not fit drawing sheets of the requested size."""

    exit_code = 1


class NotOfferedError(ReportgenError):
    """The requested product cannot be made from an assignment of this kind."""

    exit_code = 1


class UnknownNameError(ReportgenError):
    """The requested name does not exist: no such figure, quantity, position or parameter."""

    exit_code = 2


class TypesetterError(ReportgenError):
    """The typesetter is missing or failed; a change of the assignment cannot help."""

    exit_code = 3


class OutputError(ReportgenError):
    """The result could not be written."""

    exit_code = 3


class OutputWarning(UserWarning):
    """A file was made, but not exactly as requested; the message is in the user's language."""
