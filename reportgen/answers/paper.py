"""Papers beside the report: what they all have in common, and the task with its empty answer sheet."""

from __future__ import annotations

from collections import Counter
from collections.abc import Container, Iterable, Iterator, Mapping, Sequence
from itertools import groupby
from typing import Any

from reportgen.answers.key import Key, Role, Row, shown_number, words_of
from reportgen.answers.sheet import asked_positions, info_rows, open_cells
from reportgen.case import Case
from reportgen.document.numbering import number
from reportgen.document.outline import open_report
from reportgen.document.report import PLATES_UP_TO
from reportgen.document.tree import (
    TEXT_WIDTH,
    BlankLine,
    Block,
    Cell,
    Column,
    Document,
    InlineMath,
    Inlines,
    LineBreak,
    Paragraph,
    Strong,
    Table,
    Text,
    Value,
    Words,
)
from reportgen.figures.metrics import box
from reportgen.notation.expressions import Number, Symbol
from reportgen.notation.numbers import Language
from reportgen.notation.vocabulary import Chapter

MOST_POSITIONS = 8
"""Columns of positions beside one another."""
KNOWN_DIGITS = 5
"""Figures of what is given at each position."""
SYMBOL, UNIT, VALUE = 16.0, 22.0, 15.3
"""Widths (mm) of the columns of the answer sheet."""
TABLE_SIZE, PADDING = 10.0, 4.0
"""Font size (points) of a table, and what its cells keep clear of their edges (mm)."""


def paper(
    language: Language,
    words: Mapping[str, Any],
    title: str,
    blocks: Iterable[Block],
    owner: str = "",
    variant: str = "",
) -> Document:
    """A numbered document without a cover; title left and variant right in its header, `owner` its author."""
    note = words["variant"].format(variant=variant) if variant else ""
    footer = ("", words["document"]["page"])
    return number(Document(language, title, owner, (title, note), footer, Words(**words["document"]), tuple(blocks)))


def fields(pairs: Iterable[tuple[str, str]]) -> Iterable[Block]:
    """Labelled texts, a line each, as typed; without a text a dotted line to fill in."""
    lines: list[Text | Strong | LineBreak] = []
    empty: list[Block] = []
    for label, text in pairs:
        if not text:
            empty.append(BlankLine(f"{label}:"))
            continue
        lines += [*([LineBreak()] if lines else []), Text(f"{label}: "), Strong((Text(text),))]
    return (*((Paragraph(tuple(lines)),) if lines else ()), *empty)


def student_rows(key: Key) -> tuple[tuple[str, str], ...]:
    """Whose paper it is: label and text of assignment, variant (if any), student."""
    assignment, _, variant, *student = info_rows(key)
    return (assignment, *((variant,) if key.variant else ()), *student)


# --- cells of tables ------------------------------------------------------------------------------


def plain_inlines(text: str) -> Inlines:
    """A text as it stands; an empty one gives no inline."""
    return (Text(text),) if text else ()


def text_cells(texts: Iterable[str]) -> tuple[Cell, ...]:
    """A row of texts."""
    return tuple(Cell(plain_inlines(text)) for text in texts)


def value_inlines(row: Row, value: float) -> Inlines:
    """A number as the report prints it, a dash for what does not exist."""
    return (Value(shown_number(row, value)),) if value == value else (Text("–"),)


def symbol_inlines(row: Row, with_id: bool) -> Inlines:
    """A quantity's symbol, perhaps with its id below."""
    return (InlineMath(row.symbol), *((LineBreak(), Text(row.id)) if with_id else ()))


def symbol_width(rows: Iterable[Row], shared: Container[Symbol], least: float) -> float:
    """The width (mm) of a column of symbols, those that are `shared` with their ids below."""
    ids = (row.id for row in rows if row.symbol in shared)
    return max((least, *(box(id, TABLE_SIZE).width + PADDING for id in ids)))


def shared_symbols(rows: Iterable[Row]) -> frozenset[Symbol]:
    """Symbols that several of the rows have."""
    return frozenset(symbol for symbol, count in Counter(row.symbol for row in rows).items() if count > 1)


# --- the task -------------------------------------------------------------------------------------


def task(case: Case, key: Key) -> Document:
    """What a student is handed, from the given data to the empty answer sheet; no answer is in it.

    Raises `TemplateError`.
    """
    report = open_report(case)
    prose, names, words, machine = report.prose, report.names(), case.words, case.analysis.machine
    every = range(1, machine.positions + 1)
    asked = asked_positions(key)
    (heading, *given) = prose.render("given.md", names)
    names |= {
        "sheet": tuple(answer_tables(key)),
        "asked": tuple(map(key.label, asked)),
        "known_tables": tuple(_known_tables(key, every if machine.count <= PLATES_UP_TO else asked)),
    }
    about = case.assignment.report
    blocks: list[Block] = [
        heading,
        Paragraph((Strong((Text(case.title),)),), "center"),
        *fields(student_rows(key)),
        *given,
        *prose.render("task.md", names),
    ]
    course = about.course or words["cover"]["course"]
    return paper(case.assignment.language, words, course, blocks, about.student.name or "", case.assignment.variant)


def answer_tables(key: Key) -> Iterator[Table]:
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
                if asked:
                    yield _answer_table(_heads(key, words, some), asked, some, shared, cells, caption)


def _known_tables(key: Key, positions: Sequence[int]) -> Iterator[Table]:
    """What is given at each position (the crank's angle, a load that follows the motion), in the sheet's columns."""
    words = words_of(key)
    caption = (Text(str(words["answer_sheet"]["known"])),)
    rows = [row for row in key.rows if row.role is Role.given and not row.single and row.part is not Chapter.formulas]
    for some in _split(positions) if rows else ():
        head = (words["table"]["symbol"], words["table"]["unit"], *map(key.label, some))
        body = tuple(
            (
                Cell(symbol_inlines(row, with_id=False)),
                Cell(plain_inlines(row.unit)),
                *(Cell(_known_inlines(float(row.values[row.at(k)]))) for k in some),
            )
            for row in rows
        )
        columns = (Column(SYMBOL), Column(UNIT), *(Column(VALUE),) * len(some))
        yield Table(columns, (text_cells(head),), body, caption)


def _known_inlines(value: float) -> Inlines:
    """A given number short enough for a column: an angle may be one that follows from lengths."""
    return (Value(Number(float(f"{value:.{KNOWN_DIGITS}g}"), None)),) if value == value else (Text("–"),)


def _split(positions: Sequence[int]) -> Iterator[Sequence[int]]:
    """Positions in as few sets of nearly one size as fit a page."""
    count = -(-len(positions) // MOST_POSITIONS)
    for start in range(count):
        yield positions[start * len(positions) // count : (start + 1) * len(positions) // count]


def _heads(key: Key, words: Mapping[str, Any], positions: Sequence[int]) -> tuple[str, ...]:
    """The words over the columns of a table."""
    table, sheet = words["table"], words["answer_sheet"]
    labels = [key.label(k) for k in positions if k]
    if len(labels) == 1:
        labels = [sheet["at"].format(label=labels[0])]
    return (table["symbol"], table["unit"], *(labels or [table["value"]]))


def _answer_table(
    heads: Sequence[str],
    rows: Sequence[Row],
    positions: Sequence[int],
    shared: Container[Symbol],
    cells: Mapping[str, Container[int]],
    caption: Inlines,
) -> Table:
    """Quantities below one another, in as many sets side by side as the page has room for.

    `cells` are the positions at which each row has a cell to fill in, by id.
    """
    symbol = symbol_width(rows, shared, SYMBOL)
    beside = max(int(TEXT_WIDTH // (symbol + UNIT + VALUE * len(positions))), 1)
    beside = min(beside, len(rows))
    value = min((TEXT_WIDTH / beside - symbol - UNIT) / len(positions), 1.5 * VALUE)
    columns = (Column(symbol), Column(UNIT), *(Column(value),) * len(positions))
    height = -(-len(rows) // beside)
    filled = [
        (
            Cell(symbol_inlines(row, row.symbol in shared)),
            Cell(plain_inlines(row.unit)),
            *(Cell() if k in cells[row.id] else Cell((Text("–"),)) for k in positions),
        )
        for row in rows
    ]
    filled += [(Cell(),) * len(columns)] * (beside * height - len(rows))
    body = (tuple(cell for line in filled[start::height] for cell in line) for start in range(height))
    return Table(columns * beside, (text_cells(heads) * beside,), tuple(body), caption)
