"""A student's file → `Submission`: the sheet found by its words, its values by quantity and position.

Rows and columns may have been moved, sorted or left out: a value's place is told by the id at the head
of its row and the label at the head of its column, in either language.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache
from itertools import pairwise
from pathlib import Path
from typing import Any, get_args

from reportgen.answers.key import Key, Row
from reportgen.assignment.faults import Fault, as_problem
from reportgen.errors import AssignmentError, Mark, Problem
from reportgen.grading.marks import Given, Place, Submission
from reportgen.grading.written import DecimalMark, decimal_mark, is_blank, read_written
from reportgen.notation.numbers import Language
from reportgen.notation.symbols import KINDS
from reportgen.units import QuantityFault
from reportgen.words import load_words, search_path
from reportgen.workbook import Cell, Page, read

HEAD_WITHIN = 60
"""Rows among which the head of a sheet is looked for."""
_UNREADABLE = {"date": "cell-date", "error": "cell-error", "boolean": "cell-boolean"}


def read_submission(
    path: Path, key_of: Callable[[str], Key] | Key, language: Language = "vi"
) -> Submission:
    """The answer sheet of a file, by the key of the assignment it names, on its page of information or in its
    title, or else of the file's stem.

    `key_of` finds a key by the name that the sheet gives, which may be any text, and raises `KeyError` if
    there is none.  Raises `AssignmentError`, worded in `language`, if the file cannot be read, is no
    answer sheet or belongs to another assignment or machine.
    """
    pages = read(path, language)
    found = _sheet(pages)
    if found is None:
        raise _refused(Fault("sheet-no-head", Mark(str(path))), language)
    named = _beside(pages, "assignment") or _titled(found[0].rows[: found[1]])
    name, mark = named or (path.stem, Mark(str(path)))
    if isinstance(key_of, Key):
        key = key_of
        if named and name != key.id:
            raise _refused(Fault("sheet-of-another", mark, {"text": name, "wanted": key.id}), language)
    else:
        try:
            key = key_of(name)
        except KeyError:
            raise _refused(Fault("sheet-unknown", mark, {"text": name}), language) from None
    kind = _beside(pages, "kind")
    if kind and kind[0] != key.kind:
        about = {"text": f"{name} ({kind[0]})", "wanted": f"{key.id} ({key.kind})"}
        raise _refused(Fault("sheet-of-another", kind[1], about), language)
    reading = _Reading(key, language, str(path))
    reading.sheet(*found)
    return Submission(key.id, str(path), reading.values, reading.problems, tuple(reading.notes))


def _refused(fault: Fault, language: Language) -> AssignmentError:
    return AssignmentError([as_problem(fault, language)])


# --- finding the sheet ----------------------------------------------------------------------------


@cache
def _words(name: str) -> frozenset[str]:
    """A word of the answer sheet in every language."""
    languages: tuple[Language, ...] = get_args(Language)
    return frozenset(str(_sheet_words(language)[name]).casefold() for language in languages)


@cache
def _sheet_words(language: Language) -> Mapping[str, Any]:
    words: Mapping[str, Any] = load_words(search_path(language))["answer_sheet"]
    return words


def _says(cell: Cell, name: str) -> bool:
    return cell.text.strip().rstrip(":").casefold() in _words(name)


def _sheet(pages: Sequence[Page]) -> tuple[Page, int] | None:
    """The page of the answers and the index of its head row: the page so called, else the first that has a head."""
    called = [page for page in pages if page.name.strip().casefold() in _words("answers")]
    for page in (*called, *pages):
        for number, row in enumerate(page.rows[:HEAD_WITHIN]):
            # The head names more than the id: a lone cell could be anything.
            if any(_says(cell, "id") for cell in row) and any(_says(cell, "value") for cell in row):
                return page, number
    return None


def _beside(pages: Sequence[Page], label: str) -> tuple[str, Mark] | None:
    """What stands beside a label such as that of the assignment, if anything does."""
    for page in pages:
        for row in page.rows:
            for one, cell in pairwise(row):
                if _says(one, label) and cell.text.strip():
                    return cell.text.strip(), cell.mark
    return None


def _titled(rows: Sequence[Sequence[Cell]]) -> tuple[str, Mark] | None:
    """The assignment that the title of the sheet ends with; it is all that is left of a page saved as CSV."""
    for cell in (cell for row in rows for cell in row):
        title, dash, name = cell.text.partition("–")
        if dash and title.strip().casefold() in _words("title") and name.strip():
            return name.strip(), cell.mark
    return None


# --- reading it -----------------------------------------------------------------------------------


@dataclass
class _Reading:
    """What is found in one sheet."""

    key: Key
    language: Language
    file: str
    values: dict[Place, Given] = field(default_factory=dict)
    problems: dict[Place, Problem] = field(default_factory=dict)
    notes: list[Problem] = field(default_factory=list)

    def sheet(self, page: Page, head: int) -> None:
        """Read all rows below the head."""
        columns = self.columns(page.rows[head])
        at = next(number for number, cell in enumerate(page.rows[head]) if _says(cell, "id"))
        found: dict[Place, Cell] = {}
        for place, cell in self.cells(page.rows[head + 1 :], at, columns):
            if place not in found:
                found[place] = cell
            elif found[place].text.strip() != cell.text.strip():
                first = str(found[place].mark).removeprefix(f"{self.file}:")
                self.problem(place, Fault("cell-repeated", cell.mark, {"first": first}))
        texts = (cell.text for cell in found.values() if isinstance(cell.value, str))
        mark, agreed = decimal_mark(texts, self.key.language)
        for place, cell in found.items():
            if place not in self.problems:
                self.value(place, cell, mark, agreed)

    def columns(self, head: Sequence[Cell]) -> dict[int, int]:
        """Positions (0 for single values) by the indices of their columns."""
        labels = {label.casefold(): k for k, label in enumerate(self.key.labels, start=1)}
        columns: dict[int, int] = {}
        for number, cell in enumerate(head):
            if _says(cell, "value"):
                columns[number] = 0
            elif (label := _label(cell.text)) is not None:
                if label in labels:
                    columns[number] = labels[label]
                else:
                    self.note(Fault("cell-no-position", cell.mark, {"text": cell.text}))
        return columns

    def cells(
        self, rows: Sequence[Sequence[Cell]], at: int, columns: Mapping[int, int]
    ) -> Iterator[tuple[Place, Cell]]:
        """The cells with an answer, each with its place; what is not asked for is left out."""
        asked = {row.id: row for row in self.key.asked}
        known = {row.id for row in self.key.rows}
        for cells in rows:
            id = cells[at].text.strip() if at < len(cells) else ""
            answers = [(columns[n], cell) for n, cell in enumerate(cells) if n in columns and not _is_empty(cell)]
            if id in asked:
                yield from (((id, k), cell) for k, cell in answers if k in asked[id].positions)
            elif answers and id not in known:
                mark = cells[at].mark if id else answers[0][1].mark
                self.note(Fault("cell-unknown-row" if id else "cell-no-row", mark, {"text": id}))

    def value(self, place: Place, cell: Cell, mark: DecimalMark, agreed: bool) -> None:
        """Read one cell: a number, or a problem at its place."""
        row = self.key.row(place[0])
        if cell.kind in _UNREADABLE:
            return self.problem(place, Fault(_UNREADABLE[cell.kind], cell.mark, {"text": cell.text}))
        if cell.value is None:
            return self.problem(place, Fault("cell-formula", cell.mark, {"text": cell.formula}))
        if cell.kind == "formula":
            self.note(Fault("cell-formula-used", cell.mark, {"text": cell.text}))
        if isinstance(cell.value, float):
            self.values[place] = Given(cell.value, cell.text, cell.mark)
            return None
        try:
            written = read_written(cell.value, KINDS[row.kind].unit, mark, agreed)
        except QuantityFault as fault:
            return self.problem(place, Fault(fault.code, cell.mark, _shown(fault, row)))
        if written.doubtful:
            self.note(Fault("cell-thousands", cell.mark, {"text": cell.text, "read": f"{written.value:g}"}))
        self.values[place] = Given(written.value, cell.text, cell.mark)
        return None

    def problem(self, place: Place, fault: Fault) -> None:
        self.problems[place] = as_problem(fault, self.language)

    def note(self, fault: Fault) -> None:
        self.notes.append(as_problem(fault, self.language))


def _shown(fault: QuantityFault, row: Row) -> dict[str, str]:
    """The arguments of a fault, with the unit as the sheet prints it."""
    return fault.arguments | ({"unit": row.unit} if "unit" in fault.arguments else {})


def _is_empty(cell: Cell) -> bool:
    return cell.kind == "empty" or (isinstance(cell.value, str) and is_blank(cell.value))


def _label(text: str) -> str | None:
    """The label of a position in the head of a column, with the word for it or bare; None for another column."""
    plain = text.strip().casefold()
    for word in _words("position") | _words("at"):
        match = re.fullmatch(re.escape(word).replace(r"\{label\}", "(.+)"), plain)
        if match:
            return match[1].strip()
    return plain if re.fullmatch(r"[0-9]+[a-z′']*|[a-z]′?", plain) else None
