"""The answer sheet as a workbook, and the layout that it shares with the key and with the marked sheet.

The layout is found again by its words: a head row, then a row for each quantity, its id in the first column;
a column for single values, then one for each position asked.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from itertools import groupby

import numpy as np

from reportgen.answers.key import shown_number, symbol_text, words_of
from reportgen.document.key import Key, Role, Row
from reportgen.notation.vocabulary import Chapter
from reportgen.workbook import Book, Entry, Sheet

NAMES = 5
"""Columns before those of the positions: id, symbol, what it is, unit, single value."""
HEAD = 3
"""Rows down to the head of the columns: title, note, head."""

WHAT = 48.0
"""Width (characters) of the column that says what a row is."""

Filling = Callable[[Row, int], Entry | None]
"""What stands in the cell of a row at a position (0 for a single value); None where it has no cell."""


def asked_positions(key: Key) -> tuple[int, ...]:
    """The positions that any row of the sheet is asked at, in their order."""
    return tuple(sorted({k for row in key.asked for k in row.positions if k}))


def rows_shown(key: Key) -> tuple[Row, ...]:
    """The rows of the sheet: what is given, what is asked, scales; formulas show their data if they are asked for."""
    formulas = any(row.part is Chapter.formulas for row in key.asked)
    given = (row.id for row in key.rows if row.role is Role.given and (formulas or row.part is not Chapter.formulas))
    shown = frozenset(given)
    return tuple(row for row in key.rows if row.positions or row.id in shown)


def number_format(row: Row) -> str:
    """A spreadsheet's format with the report's decimals."""
    decimals = row.decimals
    return "General" if decimals is None else f"0.{'0' * decimals}" if decimals > 0 else "0"


def open_cells(key: Key) -> Mapping[str, frozenset[int]]:
    """The positions at which each row has a cell to fill in, by id.

    A cell is open also where the quantity does not exist (the direction of a velocity that is zero) but
    others of its part are asked for, so that the sheet does not give it away.
    """
    of_part: dict[Chapter, set[int]] = {}
    for row in key.asked:
        of_part.setdefault(row.part, set()).update(row.positions)
    return {
        row.id: frozenset(row.positions)
        | {k for k in of_part[row.part] if k and not row.single and np.isnan(row.values[row.at(k)])}
        for row in key.asked
    }


def given_entry(row: Row, position: int) -> Entry | None:
    """A given value as the sheet shows it filled in; None where there is none."""
    if row.role is not Role.given or not row.has(position):
        return None
    value = float(row.values[row.at(position)])
    return Entry(shown_number(row, value).shown, format=number_format(row)) if value == value else None


def grid(
    key: Key,
    title: str,
    note: str,
    filling: Filling,
    rows: Sequence[Row],
    positions: Sequence[int],
    tail_head: Sequence[str] = (),
    tail: Callable[[Row], Sequence[Entry]] | None = None,
) -> tuple[tuple[Entry, ...], ...]:
    """The rows of a page in the sheet's layout; `tail` are further cells behind each row, under `tail_head`."""
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
            what = Entry(row.described)
            names = (Entry(row.id, "note"), Entry(symbol_text(row, key)), what, Entry(row.unit))
            lines.append((*names, *cells, *(tail(row) if tail else ())))
    return tuple(lines)


def page(name: str, rows: Sequence[Sequence[Entry]], by_section: bool = False) -> Sheet:
    """A protected page in the sheet's layout, printed with each section on pages of its own if that is asked for."""
    columns = len(rows[HEAD - 1])
    longest = max((len(str(row[0].value or "")) for row in rows[HEAD:]), default=0)
    widths = (max(longest + 1.0, 11.0), 11.0, WHAT, 13.0, *(12.0,) * (columns - NAMES + 1))
    # A section begins with its name in bold, behind an empty id.
    begins = [number for number, row in enumerate(rows[HEAD:], start=HEAD) if len(row) == 2 and row[1].style == "bold"]
    return Sheet(name, rows, widths, (HEAD, NAMES - 1), protected=True, breaks=begins[1:] if by_section else ())


def info_rows(key: Key) -> tuple[tuple[str, str], ...]:
    """What names a sheet: label and text of assignment, machine, variant, student."""
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


def info_page(key: Key) -> Sheet:
    """The page that names assignment and student."""
    rows = tuple((Entry(label, "bold"), Entry(text)) for label, text in info_rows(key))
    return Sheet(words_of(key)["answer_sheet"]["info"], rows, (24.0, 44.0), protected=True)


def answer_book(key: Key, by_section: bool = False) -> Book:
    """The empty sheet as a workbook: given values filled in, cells to fill in unlocked, the rest protected."""
    sheet, cells = words_of(key)["answer_sheet"], open_cells(key)

    def filling(row: Row, position: int) -> Entry | None:
        if position in cells.get(row.id, ()):
            return Entry(None, "input", unlocked=True)
        return given_entry(row, position)

    rows = grid(key, sheet["title"], sheet["note"], filling, rows_shown(key), asked_positions(key))
    return Book((page(sheet["answers"], rows, by_section), info_page(key)), f"{sheet['title']} {key.id}")
