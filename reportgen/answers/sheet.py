"""The answer sheet: what a student fills in, as a workbook, as CSV and as tables on paper.

All sheets of an assignment share one layout, which is found again by its words: a head row, then a row for
each quantity, its id in the first column; a column for single values, then one for each position asked.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from itertools import groupby
from typing import Any

import numpy as np

from reportgen.answers.key import Key, Part, Role, Row
from reportgen.document.plain import formula
from reportgen.document.tree import (
    TEXT_WIDTH,
    Cell,
    Column,
    InlineMath,
    Inlines,
    LineBreak,
    Table,
    Text,
    Value,
)
from reportgen.figures.metrics import box
from reportgen.notation.expressions import Number, Symbol
from reportgen.words import load_words, search_path
from reportgen.workbook import Book, Entry, Sheet

NAMES = 4
"""Columns before those of the positions: id, symbol, unit, single value."""
HEAD = 3
"""Rows down to the head of the columns: title, note, head."""
MOST_POSITIONS = 8
"""Columns of positions beside one another on paper."""
KNOWN_DIGITS = 5
"""Figures of what is given at each position."""
SYMBOL, UNIT, VALUE = 16.0, 22.0, 15.3
"""Widths (mm) of the columns on paper."""

TABLE_SIZE, PADDING = 10.0, 4.0
"""Font size (points) of a table, and what its cells keep clear of their edges (mm)."""

Filling = Callable[[Row, int], Entry | None]
"""What stands in the cell of a row at a position (0 for a single value); None where it has no cell."""
Tail = Callable[[Row], Sequence[Entry]]
_Line = tuple[Row, bool, frozenset[int]]


def words_of(key: Key) -> Mapping[str, Any]:
    """The words of a key's language and machine."""
    return load_words(search_path(key.language, key.kind))


def symbol_text(row: Row, key: Key) -> str:
    """A quantity's symbol in one line of plain text, e.g. v_BA."""
    return formula(row.symbol, key.language)


def asked_positions(key: Key) -> tuple[int, ...]:
    """The positions that any row of the sheet is asked at, in their order."""
    return tuple(sorted({k for row in key.asked for k in row.positions if k}))


def rows_shown(key: Key) -> tuple[Row, ...]:
    """The rows of the sheet: what is given, what is asked, scales."""
    return tuple(row for row in key.rows if row.positions or row.role is Role.given)


def shown_number(row: Row, value: float) -> Number:
    """A number of a row as the report prints it: to its decimals, or without the dust of floats."""
    return Number(value if row.decimals is not None else float(f"{value:.12g}"), row.decimals)


def number_format(row: Row) -> str:
    """A spreadsheet's format with the report's decimals."""
    decimals = row.decimals
    return "General" if decimals is None else f"0.{'0' * decimals}" if decimals > 0 else "0"


def number_entry(row: Row, value: float, style: Any = "", comment: str = "") -> Entry:
    """A number in a row's unit that shows the report's decimals; an empty cell for one that does not exist."""
    return Entry(value, style, comment, number_format(row)) if value == value else Entry(None, style, comment)


def open_cells(key: Key) -> Mapping[str, frozenset[int]]:
    """The positions at which each row has a cell to fill in, by id.

    A cell is open also where the quantity does not exist (the direction of a velocity that is zero) but
    others of its part are asked for, so that the sheet does not tell.
    """
    of_part: dict[Part, set[int]] = {}
    for row in key.asked:
        of_part.setdefault(row.part, set()).update(row.positions)
    return {
        row.id: frozenset(row.positions)
        | {k for k in of_part[row.part] if k and not row.single and np.isnan(row.values[row.at(k)])}
        for row in key.asked
    }


def given_entry(row: Row, position: int) -> Entry | None:
    """A given value as the sheet shows it filled in; None where there is none."""
    if row.role is not Role.given or row.single != (position == 0):
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
    tail: Tail | None = None,
) -> tuple[tuple[Entry, ...], ...]:
    """The rows of a page in the sheet's layout; `tail` are further cells behind each row, under `tail_head`."""
    words = words_of(key)
    sheet, parts = words["answer_sheet"], words["parts"]
    heads = (
        *(sheet[name] for name in ("id", "symbol", "unit", "value")),
        *(sheet["position"].format(label=key.labels[k - 1]) for k in positions),
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
            names = (Entry(row.id, "note"), Entry(symbol_text(row, key)), Entry(row.unit))
            lines.append((*names, *cells, *(tail(row) if tail else ())))
    return tuple(lines)


def page(name: str, rows: Sequence[Sequence[Entry]]) -> Sheet:
    """A protected page in the sheet's layout."""
    columns = len(rows[HEAD - 1])
    longest = max((len(str(row[0].value or "")) for row in rows[HEAD:]), default=0)
    widths = (max(longest + 1.0, 11.0), 13.0, 13.0, *(12.0,) * (columns - NAMES + 1))
    return Sheet(name, rows, widths, (HEAD, NAMES - 1), protected=True)


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


def student_rows(key: Key) -> tuple[tuple[str, str], ...]:
    """What a paper says of whose it is: label and text of assignment, variant (if any), student."""
    assignment, _, variant, *student = info_rows(key)
    return (assignment, *((variant,) if key.variant else ()), *student)


def info_page(key: Key) -> Sheet:
    """The page that names assignment and student."""
    rows = tuple((Entry(label, "bold"), Entry(text)) for label, text in info_rows(key))
    return Sheet(words_of(key)["answer_sheet"]["info"], rows, (24.0, 44.0), protected=True)


def answer_book(key: Key) -> Book:
    """The empty sheet as a workbook: given values filled in, cells to fill in unlocked, the rest protected."""
    sheet = words_of(key)["answer_sheet"]
    return Book((page(sheet["answers"], _empty_grid(key)), info_page(key)), f"{sheet['title']} {key.id}")


def answer_rows(key: Key) -> tuple[tuple[str | float | None, ...], ...]:
    """The empty sheet as rows of CSV: what names it, a blank line, then the layout of the workbook's page."""
    rows = _empty_grid(key)[HEAD - 1 :]
    return (*info_rows(key), (), *(tuple(entry.value for entry in row) for row in rows))


def _empty_grid(key: Key) -> tuple[tuple[Entry, ...], ...]:
    sheet, cells = words_of(key)["answer_sheet"], open_cells(key)

    def filling(row: Row, position: int) -> Entry | None:
        if position in cells.get(row.id, ()):
            return Entry(None, "input", unlocked=True)
        return given_entry(row, position)

    return grid(key, sheet["title"], sheet["note"], filling, rows_shown(key), asked_positions(key))


# --- on paper -------------------------------------------------------------------------------------


def answer_blocks(key: Key) -> Iterator[Table]:
    """The empty sheet as tables to fill in by hand, a table or more for each part with something to fill in."""
    words, cells = words_of(key), open_cells(key)
    for part, members in groupby(key.rows, lambda row: row.part):
        caption = (Text(str(words["parts"][part])),)
        rows = [row for row in members if row.positions]
        shared = shared_symbols(rows)
        singles = [row for row in rows if row.single]
        many = [row for row in rows if not row.single]
        for group, positions in ((singles, [0]), (many, sorted({k for row in many for k in row.positions}))):
            for some in _split(positions):
                asked = [row for row in group if set(row.positions) & set(some)]
                lines = [(row, row.symbol in shared, cells[row.id]) for row in asked]
                if asked:
                    yield _table(_heads(key, words, some), lines, some, caption)


def known_blocks(key: Key, positions: Sequence[int]) -> Iterator[Table]:
    """What is given at each position (the crank's angle, a load that follows the motion), in the sheet's columns."""
    words = words_of(key)
    caption = (Text(str(words["answer_sheet"]["known"])),)
    rows = [row for row in key.rows if row.role is Role.given and not row.single and row.part is not Part.formulas]
    for some in _split(positions) if rows else ():
        head = (words["table"]["symbol"], words["table"]["unit"], *(key.labels[k - 1] for k in some))
        body = tuple(
            (
                Cell(symbol_inlines(row, False)),
                Cell(plain_inlines(row.unit)),
                *(Cell(_known_inlines(row, float(row.values[row.at(k)]))) for k in some),
            )
            for row in rows
        )
        columns = (Column(SYMBOL), Column(UNIT), *(Column(VALUE),) * len(some))
        yield Table(columns, (tuple(Cell((Text(text),)) for text in head),), body, caption)


def _known_inlines(row: Row, value: float) -> Inlines:
    """A given number short enough for a column: an angle may be one that follows from lengths."""
    return (Value(Number(float(f"{value:.{KNOWN_DIGITS}g}"), None)),) if value == value else (Text("–"),)


def _split(positions: Sequence[int]) -> Iterator[tuple[int, ...]]:
    """Positions in as few sets of nearly one size as fit a page."""
    count = -(-len(positions) // MOST_POSITIONS)
    for start in range(count):
        yield tuple(positions[start * len(positions) // count : (start + 1) * len(positions) // count])


def _heads(key: Key, words: Mapping[str, Any], positions: Sequence[int]) -> tuple[str, ...]:
    """The words over the columns of a table."""
    table, sheet = words["table"], words["answer_sheet"]
    labels = [key.labels[k - 1] for k in positions if k]
    if len(labels) == 1:
        labels = [sheet["at"].format(label=labels[0])]
    return (table["symbol"], table["unit"], *(labels or [table["value"]]))


def _table(
    heads: Sequence[str], rows: Sequence[_Line], positions: Sequence[int], caption: Inlines
) -> Table:
    """Quantities below one another, in as many sets side by side as the page has room for.

    With each row stand whether its id is told, because another one has its symbol, and its open positions.
    """
    symbol = symbol_width((row.id for row, told, _ in rows if told), SYMBOL)
    beside = max(int(TEXT_WIDTH // (symbol + UNIT + VALUE * len(positions))), 1)
    beside = min(beside, len(rows))
    value = min((TEXT_WIDTH / beside - symbol - UNIT) / len(positions), 1.5 * VALUE)
    columns = (Column(symbol), Column(UNIT), *(Column(value),) * len(positions))
    height = -(-len(rows) // beside)
    filled = [_cells(line, positions) for line in rows]
    filled += [(Cell(),) * len(columns)] * (beside * height - len(rows))
    body = (tuple(cell for cells in filled[line::height] for cell in cells) for line in range(height))
    head = tuple(Cell((Text(text),)) for text in heads)
    return Table(columns * beside, (head * beside,), tuple(body), caption)


def _cells(line: _Line, positions: Sequence[int]) -> tuple[Cell, ...]:
    row, told, open_at = line
    places = (Cell() if k in open_at else Cell((Text("–"),)) for k in positions)
    return (Cell(symbol_inlines(row, told)), Cell(plain_inlines(row.unit)), *places)


def symbol_inlines(row: Row, told: bool) -> Inlines:
    """A quantity's symbol; with `told` its id stands below."""
    return (InlineMath(row.symbol), *((LineBreak(), Text(row.id)) if told else ()))


def symbol_width(ids: Iterable[str], least: float) -> float:
    """The width (mm) of a column of symbols with these ids below them."""
    return max((least, *(box(id, TABLE_SIZE).width + PADDING for id in ids)))


def shared_symbols(rows: Iterable[Row]) -> frozenset[Symbol]:
    """Symbols that several of the rows have."""
    return frozenset(symbol for symbol, count in Counter(row.symbol for row in rows).items() if count > 1)


def plain_inlines(text: str) -> Inlines:
    """A text as it stands, nothing for none."""
    return (Text(text),) if text else ()


def value_inlines(row: Row, value: float) -> Inlines:
    """A number as the report prints it, a dash for what does not exist."""
    return (Value(shown_number(row, value)),) if value == value else (Text("–"),)
