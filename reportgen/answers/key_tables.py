"""The key as tables: a workbook whose pages have the answer sheet's layout, and CSV with a row for each value."""

from __future__ import annotations

import numpy as np

from reportgen.answers.key import Key, Row
from reportgen.answers.sheet import (
    grid,
    info_page,
    number_entry,
    page,
    shown_number,
    symbol_text,
    words_of,
)
from reportgen.notation.numbers import significant_decimals
from reportgen.notation.sheet import ZERO
from reportgen.workbook import Book, Entry

BAND_DIGITS = 2
"""Significant figures of a band; it is rounded up or down alike."""


def key_book(key: Key) -> Book:
    """The key as a workbook: values, both bands, directions in words, each a page; values are unrounded.

    The page of values is laid out as a filled answer sheet.
    """
    words = words_of(key)["key"]
    positions = range(1, len(key.labels) + 1)

    def value(row: Row, position: int) -> Entry | None:
        return number_entry(row, float(row.values[row.at(position)])) if _has(row, position) else None

    def drawn(row: Row, position: int) -> Entry | None:
        return Entry(band(row, float(row.drawn[row.at(position)]))) if _has(row, position) else None

    def computed(row: Row, position: int) -> Entry | None:
        return Entry(band(row, float(row.computed[row.at(position)]))) if _has(row, position) else None

    def sense(row: Row, position: int) -> Entry | None:
        return Entry(row.sense[row.at(position)]) if _has(row, position) else None

    turning = [row for row in key.rows if any(row.sense)]
    pages = (
        (words["answers"], value, key.rows),
        (words["drawn"], drawn, key.rows),
        (words["computed"], computed, key.rows),
        *(((words["senses"], sense, turning),) if turning else ()),
    )
    sheets = (page(name, grid(key, name, "", filling, rows, positions)) for name, filling, rows in pages)
    return Book((*sheets, info_page(key)), f"{words['title']} {key.id}")


def key_rows(key: Key) -> tuple[tuple[str | float | None, ...], ...]:
    """The key as rows of CSV: id, part, symbol, unit, position, value as printed, direction, both bands."""
    words = words_of(key)
    sheet, names = words["answer_sheet"], words["key"]
    head = (
        sheet["id"],
        names["part"],
        sheet["symbol"],
        sheet["unit"],
        words["table"]["position"],
        sheet["value"],
        names["sense"],
        names["drawn"],
        names["computed"],
    )
    body = (
        (
            row.id,
            words["parts"][row.part],
            symbol_text(row, key),
            row.unit,
            "" if row.single else key.labels[index],
            _printed(row, float(row.values[index])),
            row.sense[index],
            band(row, float(row.drawn[index])),
            band(row, float(row.computed[index])),
        )
        for row in key.rows
        for index in range(len(row.values))
    )
    return (head, *body)


def _has(row: Row, position: int) -> bool:
    return row.single == (position == 0)


def _printed(row: Row, value: float) -> float | None:
    return shown_number(row, value).shown if value == value else None


def band(row: Row, width: float) -> float | None:
    """A band's half width to two significant figures; what is nothing beside the row is 0."""
    if width != width:
        return None
    return 0.0 if width < ZERO * np.nanmax(np.abs(row.values), initial=0.0) else float(f"{width:.{BAND_DIGITS}g}")


def band_decimals(width: float) -> int:
    """Decimals that show two significant figures of a band."""
    return max(significant_decimals(width, BAND_DIGITS), 0)
