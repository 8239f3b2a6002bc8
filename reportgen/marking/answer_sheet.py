"""Write the answer sheet as a workbook (`answer_book`) and read a filled one (`read_submission`).

The key and the marked sheet share its layout. A sheet is recognised by its words: a head row, then a row for each
quantity with its id in the first column. There is a column for single values, then one for each requested position.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache
from itertools import groupby, pairwise
from pathlib import Path
from typing import get_args

import numpy as np

from reportgen.base import units
from reportgen.base.errors import Fault, Location, Problem
from reportgen.base.template_folders import languages
from reportgen.base.typed_characters import plain_signs
from reportgen.base.units import Language, QuantityFault
from reportgen.base.words import as_error, as_problem, common_words
from reportgen.case.answer_key import Key, KeyRow, Role
from reportgen.document import plain
from reportgen.formula.vocabulary import KeyChapter
from reportgen.marking.marking_data import Answer, Place, Submission
from reportgen.marking.student_numbers import DecimalMark, decimal_mark, is_blank, read_number
from reportgen.marking.toleranced_key import shown_number, symbol_text, typed_unit, words_of
from reportgen.workbook import Book, Entry, Page, SheetCell, WorksheetData, read

NAMES = 5
"""Number of columns before those of the positions: id, symbol, description, unit, single value."""
HEAD = 3
"""Number of rows down to the head of the columns: title, note, head."""

WHAT = 48.0
"""Width (characters) of the column of descriptions."""

Filling = Callable[[KeyRow, int], Entry | None]
"""Returns the entry of a row at a position (0 for a single value); None if the row has no cell there."""


def asked_positions(key: Key) -> tuple[int, ...]:
    """Return the positions at which the sheet requests any value, in order."""
    return tuple(sorted({k for row in key.asked for k in row.positions if k}))


def sheet_rows(key: Key) -> tuple[KeyRow, ...]:
    """Return the rows of the sheet: given data, requested values and scales.

    Data that only formulas use are left out if no formula is requested.
    """
    formulas = any(row.part is KeyChapter.formulas for row in key.asked)
    given = (row.id for row in key.rows if row.role is Role.given and (formulas or row.part is not KeyChapter.formulas))
    given_ids = frozenset(given)
    return tuple(row for row in key.rows if row.positions or row.id in given_ids)


def number_format(row: KeyRow) -> str:
    """Return a spreadsheet number format with the report's decimals."""
    decimals = row.decimals
    return "General" if decimals is None else f"0.{'0' * decimals}" if decimals > 0 else "0"


def open_cells(key: Key) -> Mapping[str, frozenset[int]]:
    """Return the positions at which each row has a cell to fill in, by id.

    A cell is also open if its quantity does not exist (the direction of a zero velocity) while others of its part are
    asked for, so that the sheet does not reveal it.
    """
    of_part: dict[KeyChapter, set[int]] = {}
    for row in key.asked:
        of_part.setdefault(row.part, set()).update(row.positions)
    return {
        row.id: frozenset(row.positions)
        | {k for k in of_part[row.part] if k and not row.single and np.isnan(row.values[row.at(k)])}
        for row in key.asked
    }


def given_entry(row: KeyRow, position: int) -> Entry | None:
    """Return a given value as the sheet shows it; None if the row has no given value at the position."""
    if row.role is not Role.given or not row.has(position):
        return None
    value = float(row.printed[row.at(position)])
    return Entry(shown_number(row, value).printed, format=number_format(row)) if value == value else None


def grid(
    key: Key,
    title: str,
    note: str,
    filling: Filling,
    rows: Sequence[KeyRow],
    positions: Sequence[int],
    tail_head: Sequence[str] = (),
    tail: Callable[[KeyRow], Sequence[Entry]] | None = None,
) -> tuple[tuple[Entry, ...], ...]:
    """Return the rows of a page in the sheet's layout.

    `filling` gives the entries of the cells, `tail` further cells after each row, below `tail_head`.
    """
    words = words_of(key)
    sheet, parts = words["answer_sheet"], words["parts"]
    heads = (
        *(sheet[name] for name in ("id", "symbol", "what", "unit", "value")),
        *(sheet["position"].format(label=key.label(k)) for k in positions),
        *tail_head,
    )
    lines: list[tuple[Entry, ...]] = [
        (Entry(f"{title} – {key.id}", "title"),),
        (Entry(note, "note"),),
        tuple(Entry(head, "head") for head in heads),
    ]
    for part, members in groupby(rows, lambda row: row.part):
        lines.append((Entry(), Entry(str(parts[part]), "bold")))
        for row in members:
            cells = (filling(row, k) or Entry(None, "unasked") for k in (0, *positions))
            what = Entry(plain(row.described, key.language))
            names = (Entry(row.id, "note"), Entry(symbol_text(row, key)), what, Entry(row.unit))
            lines.append((*names, *cells, *(tail(row) if tail else ())))
    return tuple(lines)


def page(name: str, rows: Sequence[Sequence[Entry]], by_section: bool = False) -> WorksheetData:
    """Return a protected page in the sheet's layout; `by_section` prints each section on separate pages."""
    columns = len(rows[HEAD - 1])
    longest = max((len(str(row[0].value or "")) for row in rows[HEAD:]), default=0)
    widths = (max(longest + 1.0, 11.0), 11.0, WHAT, 13.0, *(12.0,) * (columns - NAMES + 1))
    # A section begins with its name in bold, after an empty id.
    begins = [number for number, row in enumerate(rows[HEAD:], start=HEAD) if len(row) == 2 and row[1].style == "bold"]
    return WorksheetData(name, rows, widths, (HEAD, NAMES - 1), protected=True, breaks=begins[1:] if by_section else ())


def info_rows(key: Key) -> tuple[tuple[str, str], ...]:
    """Return the identification of a sheet: label and text of assignment, machine, variant and student."""
    labels = words_of(key)["answer_sheet"]
    student = key.student
    return (
        (labels["assignment"], key.id),
        (labels["kind"], key.kind),
        (labels["variant"], key.variant),
        (labels["name"], student.get("name", "")),
        (labels["number"], student.get("id", "")),
        (labels["class"], student.get("class", "")),
    )


def info_page(key: Key) -> WorksheetData:
    """Return the page that names assignment and student."""
    rows = tuple((Entry(label, "bold"), Entry(text)) for label, text in info_rows(key))
    return WorksheetData(words_of(key)["answer_sheet"]["info"], rows, (24.0, 44.0), protected=True)


def named_pages(key: Key, name: str) -> Iterator[tuple[str, Key]]:
    """Yield the pages of a workbook's sheet called `name`; a coursework has one for each part, with its title."""
    for number, (title, part) in enumerate(key.pages):
        yield (title if number else name), part


def answer_book(key: Key, by_section: bool = False, self_check: bool = True) -> Book:
    """Return the empty sheet as a workbook: given values filled in, cells to fill in unlocked, the rest protected.

    With `self_check`, its note explains how to check it.
    """
    sheet = words_of(key)["answer_sheet"]
    note = " ".join((sheet["note"], *((sheet["self_check"],) if self_check else ())))
    pages = [_answer_page(part, name, note, by_section) for name, part in named_pages(key, sheet["answers"])]
    return Book((*pages, info_page(key)), f"{sheet['title']} {key.id}")


def _answer_page(key: Key, name: str, note: str, by_section: bool) -> WorksheetData:
    sheet, cells = words_of(key)["answer_sheet"], open_cells(key)

    def filling(row: KeyRow, position: int) -> Entry | None:
        if position in cells.get(row.id, ()):
            return Entry(None, "input", unlocked=True)
        return given_entry(row, position)

    rows = grid(key, sheet["title"], note, filling, sheet_rows(key), asked_positions(key))
    return page(name, rows, by_section)


# --- a student's file → `Submission`: the sheet found by its words --------------------------------
# Its values are read by quantity and position.
# Rows and columns may have been moved, sorted or removed: a value's place is given by the id at the head of its row
# and the label at the head of its column, in either language. Numbers may have a decimal comma or point, separated
# thousands, powers of ten, or a unit.


UNSETTLED = "?"
"""Text of a cell in a prefilled sheet: the student's file has an entry for it that nobody has settled yet."""
HEAD_WITHIN = 60
"""Number of rows among which the head of a sheet is searched for."""
_UNREADABLE = {"date": "cell-date", "error": "cell-error", "boolean": "cell-boolean"}


def read_submission(
    path: Path,
    key_of: Callable[[str], Key] | Key,
    language: Language | None = None,
    pages: Sequence[Page] | None = None,
    by_data: bool = False,
) -> Submission:
    """Return the answer sheet of a file, or of its `pages` if already read, using the key of its assignment.

    The assignment is named by its information page, or its title, or else the file's stem. `key_of` finds a key by that
    name, which may be any text, and raises `KeyError` if there is none. Raises `AssignmentError`, worded in `language`,
    if the file cannot be read, is not an answer sheet or belongs to another assignment or machine. With `by_data`, it
    also raises if the given data of the sheet are not those of the assignment.
    """
    pages = read(path, language) if pages is None else pages
    sheets = _sheets(pages)
    first_sheet = sheets[0] if sheets else None
    if first_sheet is None:
        raise as_error([Fault("sheet-no-head", Location(str(path)))], language)
    named = _beside(pages, "assignment") or _titled(first_sheet[0].rows[: first_sheet[1]])
    name, location = named or (path.stem, Location(str(path)))
    if isinstance(key_of, Key):
        key = key_of
        if named and name != key.id:
            raise as_error([Fault("sheet-of-another", location, {"text": name, "wanted": key.id})], language)
    else:
        try:
            key = key_of(name)
        except KeyError:
            raise as_error([Fault("sheet-unknown", location, {"text": name})], language) from None
    kind = _beside(pages, "kind")
    if kind and kind[0] != key.kind:
        about = {"text": f"{name} ({kind[0]})", "wanted": f"{key.id} ({key.kind})"}
        raise as_error([Fault("sheet-of-another", kind[1], about)], language)
    fingerprint = _beside(pages, "fingerprint")
    reading = _Reading(key, language, settled=fingerprint is None)
    answered = sheets if key.parts else sheets[:1]
    if by_data:
        data_faults = [fault for answers in answered for fault in _data_faults(key, *answers)]
        unsaid = not data_faults and named is not None and name != key.id
        about = {"text": name, "wanted": key.id}
        if (
            faults := [Fault("sheet-of-another", location, about)]
            if unsaid
            else [one for one in data_faults if one is not None]
        ):
            raise as_error(faults, language)
    for answers in answered:
        reading.sheet(*answers)
    return Submission(
        key.id,
        str(path),
        reading.values,
        reading.problems,
        tuple(reading.notes),
        frozenset(reading.rows),
        unread=reading.unread,
        own_files=fingerprint is not None,
        fingerprint=fingerprint[0] if fingerprint else "",
    )


# --- finding the sheet ----------------------------------------------------------------------------


@cache
def _words(name: str) -> frozenset[str]:
    """Return a word of the answer sheet in every language."""
    sheets = (common_words(language)["answer_sheet"] for language in languages())
    return frozenset(str(words[name]).casefold() for words in sheets)


def _says(cell: SheetCell, name: str) -> bool:
    return plain_signs(cell.text).strip().rstrip(":").casefold() in _words(name)


def _sheets(pages: Sequence[Page]) -> list[tuple[Page, int]]:
    """Return the answer pages with the indices of their head rows: the so-named page first, then all with a head."""
    answers: dict[int, tuple[Page, int]] = {}
    called = [page for page in pages if page.name.strip().casefold() in _words("answers")]
    for page in (*called, *pages):
        for number, row in enumerate(page.rows[:HEAD_WITHIN]):
            # The head has more than the id, because a lone cell could be anything.
            if any(_says(cell, "id") for cell in row) and any(_says(cell, "value") for cell in row):
                answers.setdefault(id(page), (page, number))
                break
    return list(answers.values())


def _beside(pages: Sequence[Page], label: str) -> tuple[str, Location] | None:
    """Return the text in the cell after a label, with its location, or None.

    `label` is a key of the sheet's words, such as `assignment`.
    """
    for page in pages:
        for row in page.rows:
            for label_cell, cell in pairwise(row):
                if _says(label_cell, label) and cell.text.strip():
                    return cell.label.strip(), cell.location
    return None


def _titled(rows: Sequence[Sequence[SheetCell]]) -> tuple[str, Location] | None:
    """Return the assignment at the end of the sheet's title; a page saved as CSV names it nowhere else."""
    for cell in (cell for row in rows for cell in row):
        title, dash, name = cell.text.partition("–")
        if dash and title.strip().casefold() in _words("title") and name.strip():
            return name.strip(), cell.location
    return None


def _data_faults(key: Key, page: Page, head: int) -> Iterator[Fault | None]:
    """Yield, for each given value of a sheet, a fault at its cell if it is not the assignment's, else None."""
    heads = page.rows[head]
    at, column = (next(n for n, cell in enumerate(heads) if _says(cell, name)) for name in ("id", "value"))
    given = {row.id: row for row in key.rows if row.role is Role.given and row.single}
    for cells in page.rows[head + 1 :]:
        row = given.get(plain_signs(cells[at].text).strip()) if max(at, column) < len(cells) else None
        entry = given_entry(row, 0) if row else None
        if row is None or entry is None or cells[column].blank:
            continue
        own = plain_signs(cells[column].text).strip().replace(",", ".")
        # The shown data are compared to the figures that the sheet was written with.
        if re.fullmatch(units.NUMBER, own):
            about = {"symbol": symbol_text(row, key), "text": own, "wanted": f"{entry.value} {row.unit}".strip()}
            same = math.isclose(float(own), float(str(entry.value)), rel_tol=1e-9)
            yield None if same else Fault("sheet-other-data", cells[column].location, about)


# --- reading it -----------------------------------------------------------------------------------


@dataclass
class _Reading:
    """The results of reading one sheet."""

    key: Key
    language: Language | None
    values: dict[Place, Answer] = field(default_factory=dict)
    problems: dict[Place, Problem] = field(default_factory=dict)
    settled: bool = True
    """True if a question mark counts as no answer, as on any sheet except a prefilled one to be completed."""
    unread: dict[Place, Problem] = field(default_factory=dict)
    notes: list[Problem] = field(default_factory=list)
    rows: set[str] = field(default_factory=set)
    labels: dict[str, Mapping[str, int]] = field(default_factory=dict)
    """The positions of each part by their labels."""

    def sheet(self, page: Page, head: int) -> None:
        """Read all rows below the head."""
        at = next(number for number, cell in enumerate(page.rows[head]) if _says(cell, "id"))
        filled: dict[Place, SheetCell] = {}
        rows = [
            (plain_signs(cells[at].text).strip() if at < len(cells) else "", cells) for cells in page.rows[head + 1 :]
        ]
        columns = self.columns(page.rows[head], [id for id, _ in rows if self.key.find(id)])
        for place, cell in self.cells(rows, at, columns):
            if place not in filled:
                filled[place] = cell
            elif filled[place].text.strip() != cell.text.strip():
                first = str(filled[place].location).removeprefix(f"{cell.location.file}:")
                self.problem(place, Fault("cell-repeated", cell.location, {"first": first}))
        texts = (cell.text for cell in filled.values() if isinstance(cell.value, str))
        mark, agreed = decimal_mark(texts, self.key.language)
        for place, cell in filled.items():
            if place not in self.problems:
                self.value(place, cell, mark, agreed)

    def columns(self, head: Sequence[SheetCell], ids: Sequence[str]) -> dict[int, str]:
        """Return the labels of positions ("" for single values) by column index, if a row has such a position.

        `ids` are those of the page's rows. The position of a label depends on the row: parts of a coursework have their
        own positions, more or fewer than the machine.
        """
        known = {label for id in ids or [""] for label in self.positions(id)}
        columns: dict[int, str] = {}
        for number, cell in enumerate(head):
            if _says(cell, "value"):
                columns[number] = ""
            elif (label := _label(cell.text)) is not None:
                if label in known:
                    columns[number] = label
                else:
                    self.note(Fault("cell-no-position", cell.location, {"text": cell.text}))
        return columns

    def positions(self, id: str) -> Mapping[str, int]:
        """Return the positions of a row's part by their labels; "" has 0."""
        owner = self.key.owner(id)
        if owner not in self.labels:
            labels = (label.casefold() for label in self.key.part(id).labels)
            self.labels[owner] = {"": 0, **{label: k for k, label in enumerate(labels, start=1)}}
        return self.labels[owner]

    def cells(
        self, rows: Iterable[tuple[str, Sequence[SheetCell]]], at: int, columns: Mapping[int, str]
    ) -> Iterator[tuple[Place, SheetCell]]:
        """Yield the cells with an answer, each with its place; cells that are not requested are left out."""
        asked = {row.id: row for row in self.key.asked}
        known = {row.id for row in self.key.rows}
        for id, cells in rows:
            answers = [(columns[n], cell) for n, cell in enumerate(cells) if n in columns and not self.is_empty(cell)]
            if id in asked:
                self.rows.add(id)
                places = ((self.positions(id).get(label), cell) for label, cell in answers)
                yield from (((id, k), cell) for k, cell in places if k is not None and k in asked[id].positions)
            elif answers and id not in known:
                location = cells[at].location if id else answers[0][1].location
                self.note(Fault("cell-unknown-row" if id else "cell-no-row", location, {"text": id}))

    def is_empty(self, cell: SheetCell) -> bool:
        """Return True if a cell has no answer, not even one that is to be settled."""
        return _is_empty(cell) and (self.settled or cell.text.strip() != UNSETTLED)

    def value(self, place: Place, cell: SheetCell, mark: DecimalMark, agreed: bool) -> None:
        """Read one cell: store a number, or a problem at its place."""
        row = self.key.row(place[0])
        if cell.text.strip() == UNSETTLED:
            self.unread[place] = as_problem(Fault("cell-unsettled", cell.location), self.language)
            return None
        if cell.kind in _UNREADABLE:
            return self.problem(place, Fault(_UNREADABLE[cell.kind], cell.location, {"text": cell.text}))
        if cell.value is None:
            return self.problem(place, Fault("cell-formula", cell.location, {"text": cell.formula}))
        if cell.kind == "formula":
            self.note(Fault("cell-formula-used", cell.location, {"text": cell.text}))
        if isinstance(cell.value, float):
            self.values[place] = Answer(cell.value, cell.text, cell.location)
            return None
        try:
            number, doubtful = read_number(cell.value, typed_unit(row), mark, agreed)
        except QuantityFault as fault:
            # The unit is named as the sheet prints it.
            arguments = fault.arguments | ({"unit": row.unit} if "unit" in fault.arguments else {})
            return self.problem(place, Fault(fault.code, cell.location, arguments))
        if doubtful:
            both = sorted({read_number(cell.value, typed_unit(row), one)[0] for one in get_args(DecimalMark)}, key=abs)
            number = _nearest(both, float(row.values[row.at(place[1])]), number)
            read, other_reading = (units.write(value, None, self.language or self.key.language) for value in both)
            self.note(Fault("cell-thousands", cell.location, {"text": cell.text, "read": read, "other": other_reading}))
        self.values[place] = Answer(number, cell.text, cell.location)
        return None

    def problem(self, place: Place, fault: Fault) -> None:
        self.problems[place] = as_problem(fault, self.language)

    def note(self, fault: Fault) -> None:
        self.notes.append(as_problem(fault, self.language, "note"))


def _nearest(readings: Sequence[float], right: float, otherwise: float) -> float:
    """Return the reading of a number whose size is closest to the right one, so that the doubt costs no marks."""
    if not right or not math.isfinite(right):
        return otherwise
    return min(readings, key=lambda value: abs(math.log(abs(value / right))) if value else math.inf)


def _is_empty(cell: SheetCell) -> bool:
    return cell.kind == "empty" or (isinstance(cell.value, str) and is_blank(cell.value))


def _label(text: str) -> str | None:
    """Return the label of a position in a column heading, with or without the word for it; None for another column."""
    plain = plain_signs(text).strip().casefold()
    for word in _words("position") | _words("at"):
        match = re.fullmatch(re.escape(word).replace(r"\{label\}", "(.+)"), plain)
        if match:
            return match[1].strip()
    return plain if re.fullmatch(r"[0-9]+[a-z′']*|[a-z]′?", plain) else None
