"""The key as a document: every quantity by position with its unit, its direction in words and both bands."""

from __future__ import annotations

from collections.abc import Container, Iterator, Mapping, Sequence
from itertools import groupby
from typing import Any

from reportgen.answers.key import Key, Row
from reportgen.answers.key_tables import band, band_decimals
from reportgen.answers.paper import fields, paper
from reportgen.answers.sheet import (
    plain_inlines,
    shared_symbols,
    student_rows,
    symbol_inlines,
    symbol_width,
    value_inlines,
    words_of,
)
from reportgen.document.tree import (
    FIRST_COLUMN,
    TEXT_WIDTH,
    Block,
    Cell,
    Column,
    Document,
    InlineMath,
    Inlines,
    Paragraph,
    Section,
    Table,
    Text,
    Value,
)
from reportgen.notation.expressions import Number, Symbol

VALUE, BAND, SENSE = 15.6, 16.2, 23.0
"""Widths (mm) of the columns of a quantity."""
SYMBOL, UNIT = 24.0, 24.0
FINER, FINEST = 3, 7
"""Decimals of a band beyond those of its row; those of one whose row is exact."""


def key_document(key: Key, title: str) -> Document:
    """The key as a numbered document; `title` is the machine's name."""
    words = words_of(key)
    blocks: list[Block] = [
        Section(1, (Text(words["key"]["title"]),), numbered=False),
        *fields(((words["answer_sheet"]["kind"], title), *student_rows(key))),
        Paragraph((Text(words["key"]["note"]),)),
    ]
    for part, rows in groupby(key.rows, lambda row: row.part):
        name = str(words["parts"][part])
        blocks += _tables(key, words, name, list(rows))
    note = words["variant"].format(variant=key.variant) if key.variant else ""
    return paper(key.language, words, f"{words['key']['title']} – {key.id}", "", note, blocks)


def _tables(key: Key, words: Mapping[str, Any], name: str, rows: Sequence[Row]) -> Iterator[Table]:
    """The tables of a part: single values in a list, then quantities beside one another by position."""
    singles = [row for row in rows if row.single]
    if singles:
        yield _list(words, name, singles)
    turning = [row for row in rows if not row.single and any(row.sense)]
    shared = shared_symbols(row for row in rows if not row.single)
    others = [row for row in rows if not row.single and not any(row.sense)]
    for group in (others, turning):
        width = VALUE + 2 * BAND + (SENSE if group is turning else 0.0)
        most = int((TEXT_WIDTH - FIRST_COLUMN) // width)
        for start in range(0, len(group), most):
            yield _by_position(key, words, name, group[start : start + most], shared)


def _list(words: Mapping[str, Any], name: str, rows: Sequence[Row]) -> Table:
    """Single values, a quantity a row."""
    heads = words["table"]
    senses = any(any(row.sense) for row in rows)
    shared = shared_symbols(rows)
    symbol = symbol_width((row.id for row in rows if row.symbol in shared), SYMBOL)
    columns = (Column(symbol), Column(UNIT), Column(30.0), Column(24.0), Column(24.0))
    titles = (heads["symbol"], heads["unit"], heads["value"], words["key"]["drawn"], words["key"]["computed"])
    body = (
        (
            Cell(symbol_inlines(row, row.symbol in shared)),
            Cell(plain_inlines(row.unit)),
            *_numbers(row, 0),
            *((Cell(plain_inlines(row.sense[0])),) if senses else ()),
        )
        for row in rows
    )
    return Table(
        (*columns, *((Column(SENSE),) if senses else ())),
        (tuple(Cell((Text(text),)) for text in (*titles, *((words["key"]["sense"],) if senses else ()))),),
        tuple(body),
        (Text(name),),
    )


def _by_position(
    key: Key, words: Mapping[str, Any], name: str, rows: Sequence[Row], shared: Container[Symbol]
) -> Table:
    """Quantities beside one another, positions below one another."""
    senses = any(any(row.sense) for row in rows)
    heads = words["key"]
    of_row = (Column(VALUE), Column(BAND), Column(BAND), *((Column(SENSE),) if senses else ()))
    span = len(of_row)
    under = (heads["drawn"], heads["computed"], *((heads["sense"],) if senses else ()))
    head = (
        (
            Cell((Text(words["table"]["position"]),)),
            *(Cell(_named(row, row.symbol in shared), span) for row in rows),
        ),
        (Cell(), *(Cell(plain_inlines(text)) for _ in rows for text in ("", *under))),
    )
    body = (
        (
            Cell((Text(label),)),
            *(
                cell
                for row in rows
                for cell in (*_numbers(row, index), *((Cell(plain_inlines(row.sense[index])),) if senses else ()))
            ),
        )
        for index, label in enumerate(key.labels)
    )
    return Table((Column(FIRST_COLUMN), *of_row * len(rows)), head, tuple(body), (Text(name),))


def _named(row: Row, told: bool) -> Inlines:
    """Symbol and unit, with the id where the symbol is not the only one."""
    unit = f", {row.unit}" if row.unit else ""
    return (InlineMath(row.symbol), *plain_inlines(f"{unit} ({row.id})" if told else unit))


def _numbers(row: Row, index: int) -> tuple[Cell, Cell, Cell]:
    """A value and its two bands."""
    value = float(row.values[index])
    drawn, computed = (
        Cell(_band(row, float(widths[index])) if value == value else (Text("–"),))
        for widths in (row.drawn, row.computed)
    )
    return Cell(value_inlines(row, value)), drawn, computed


def _band(row: Row, width: float) -> Inlines:
    """A band; far below the last figure of its row it is 0."""
    shown = band(row, width)
    if shown is None:
        return (Text("–"),)
    decimals = min(band_decimals(shown), FINEST if row.decimals is None else row.decimals + FINER)
    number = Number(shown, decimals)
    return (Value(number if number.shown else Number(0.0)),)
