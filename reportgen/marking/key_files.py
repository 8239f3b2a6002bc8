"""Write the key as files: `key_book`, `key_rows` (CSV), `key_json`, and `key_document` to print."""

from __future__ import annotations

import json
from collections.abc import Callable, Container, Iterator, Mapping, Sequence
from itertools import groupby
from typing import Any

import numpy as np

from reportgen import document as tree
from reportgen.base.stable_digits import significant
from reportgen.base.units import significant_decimals
from reportgen.case.answer_key import Key, KeyRow, PartOfKey
from reportgen.document import Cell, Column, Document, InlineMath, Inlines, Paragraph, Table, Text, plain
from reportgen.formula import Number
from reportgen.formula.calculation import ZERO
from reportgen.formula.plain_text import formula
from reportgen.marking.answer_sheet import Filling, grid, info_page, number_format, page
from reportgen.marking.task_paper import (
    DASH,
    cells,
    fields,
    heading,
    paper,
    paragraph,
    student_rows,
    symbol_inlines,
    symbol_width,
    unnamed_rows,
)
from reportgen.marking.toleranced_key import shown_number, symbol_text, words_of
from reportgen.workbook import Book, Entry, WorksheetData

FORMAT = "reportgen-key/1"
"""Format name in the JSON."""
BAND_DIGITS = 2
"""Number of significant figures of a band."""
EXACT = 6
"""Number of reliable figures of a band, which is computed from small changes; it is first rounded to these."""
VALUE_DIGITS = 7
"""Number of significant figures of the values in the JSON; further figures would depend on the processor."""
VALUE, BAND, SENSE = 15.6, 16.2, 23.0
"""Widths (mm) of the columns of a quantity at each position."""
SYMBOL, UNIT = 16.0, 22.0
SINGLE, SINGLE_BAND = 24.0, 17.0
"""Widths (mm) of the columns of single values; the descriptions take the remaining width."""
FINER, FINEST = 3, 7
"""Additional decimals of a band beyond those of its row, and the decimals of a band whose row is exact."""


def band(row: KeyRow, width: float, figures: int = BAND_DIGITS) -> float | None:
    """Return a band's half width `width`, in the row's printed unit, to `figures` significant figures.

    It is 0 if it is negligible, None for NaN.
    """
    if width != width:
        return None
    # For the few values of a row, numpy's own `nanmax` takes ten times as long.
    greatest = max((abs(value) for value in row.values.tolist() if value == value), default=0.0)
    return 0.0 if width < ZERO * greatest else significant(significant(width, EXACT), figures)


def band_decimals(width: float) -> int:
    """Return the number of decimals that shows two significant figures of a band, in the row's unit."""
    return max(significant_decimals(width, BAND_DIGITS), 0)


# --- tables and data ------------------------------------------------------------------------------


def key_book(key: Key) -> Book:
    """Return the key as a workbook with a page each for printed values, both bands, and directions in words.

    The page of values has the layout of a filled answer sheet.
    """
    sheets = [sheet for number, (title, part) in enumerate(key.pages) for sheet in _book_pages(part, number, title)]
    return Book((*sheets, info_page(key)), f"{words_of(key)['key']['title']} {key.id}")


def _book_pages(key: Key, number: int, title: str) -> Iterator[WorksheetData]:
    """Yield the pages of a key or of one of its parts; pages of later parts include the part's title."""
    words = words_of(key)["key"]
    positions = range(1, len(key.labels) + 1)
    turning = [row for row in key.rows if any(row.sense)]

    def filling(entry: Callable[[KeyRow, int], Entry]) -> Filling:
        return lambda row, position: entry(row, row.at(position)) if row.has(position) else None

    pages: list[tuple[str, Callable[[KeyRow, int], Entry], Sequence[KeyRow]]] = [
        (words["answers"], _value_entry, key.rows),
        (words["drawn"], lambda row, index: Entry(band(row, float(row.drawn[index]))), key.rows),
        (words["computed"], lambda row, index: Entry(band(row, float(row.computed[index]))), key.rows),
        *([(words["senses"], lambda row, index: Entry(row.sense[index]), turning)] if turning else []),
    ]
    for name, entry, rows in pages:
        called = f"{name} – {title}" if number else name
        yield page(called, grid(key, called, "", filling(entry), rows, positions))


def _value_entry(row: KeyRow, index: int) -> Entry:
    """Return a number as the report prints it, or an empty cell if it does not exist."""
    value = float(row.printed[index])
    return Entry(shown_number(row, value).printed, format=number_format(row)) if value == value else Entry()


def key_rows(key: Key) -> tuple[tuple[str | float | None, ...], ...]:
    """Return the key as rows of CSV: id, part, symbol, unit, position, printed value, direction, both bands.

    Values, and half widths of the bands, are in the row's printed unit.
    """
    words = words_of(key)
    sheet, names = words["answer_sheet"], words["key"]
    sections = {part.name: words_of(part.key)["parts"] for part in key.parts} or {"": words["parts"]}
    quantity = (sheet["id"], names["part"], sheet["symbol"], sheet["what"], sheet["unit"])
    head = (*quantity, words["table"]["position"], sheet["value"], names["sense"], names["drawn"], names["computed"])
    body = (
        (
            row.id,
            sections[key.owner(row.id)][row.part],
            symbol_text(row, key),
            plain(row.described, key.language),
            row.unit,
            "" if row.single else key.label(index + 1, row.id),
            shown_number(row, float(value)).printed if value == value else None,
            row.sense[index],
            band(row, float(row.drawn[index])),
            band(row, float(row.computed[index])),
        )
        for row in key.rows
        for index, value in enumerate(row.printed)
    )
    return (head, *body)


def key_data(key: Key) -> dict[str, Any]:
    """Return the key as a JSON object: values in the units of the report, null for values that do not exist.

    `values` (to seven figures), `printed`, `drawn`, `computed` (half widths of the bands) and `sense` have an entry for
    each of `positions`, or a single one. `asked` are the labels of the positions on the answer sheet, [""] for a single
    value.
    """
    return {
        "format": FORMAT,
        "id": key.id,
        "kind": key.kind,
        "variant": key.variant,
        "language": key.language,
        "student": dict(key.student),
        "positions": list(key.labels),
        **({"parts": {part.name: _part_data(part) for part in key.parts}} if key.parts else {}),
        "rows": [
            {
                "id": row.id,
                "part": row.part.value,
                "role": row.role.value,
                "symbol": symbol_text(row, key),
                "what": row.what,
                "positive": row.positive,
                **({"formula": formula(row.formula, key.language)} if row.formula else {}),
                "kind": row.kind,
                "unit": row.unit,
                "decimals": row.decimals,
                "asked": [key.label(k, row.id) for k in row.positions],
                "values": _numbers(row.values),
                "printed": _numbers(row.printed),
                "drawn": _bands(row, row.drawn),
                "computed": _bands(row, row.computed),
                "sense": list(row.sense),
            }
            for row in key.rows
        ],
    }


def _part_data(part: PartOfKey) -> dict[str, Any]:
    return {"kind": part.key.kind, "title": part.title, "positions": list(part.key.labels)}


def key_json(key: Key) -> str:
    """Return the text of `key_data`."""
    return json.dumps(key_data(key), ensure_ascii=False, allow_nan=False, indent=1) + "\n"


def _numbers(values: np.ndarray) -> list[float | None]:
    """Return values rounded for JSON: 0 if negligible beside the largest one, None for NaN."""
    least = ZERO * float(np.max(np.abs(values), initial=0.0, where=np.isfinite(values)))
    written = (0.0 if abs(value) < least else significant(float(value), VALUE_DIGITS) for value in values)
    return [value if value == value else None for value in written]


def _bands(row: KeyRow, widths: np.ndarray) -> list[float | None]:
    """Return the half widths of bands with one more figure than the key prints; negligible ones are 0."""
    printed = (band(row, float(width), BAND_DIGITS + 1) for width in np.where(np.isnan(row.values), np.nan, widths))
    return list(printed)


# --- the document ---------------------------------------------------------------------------------


def key_document(key: Key, title: str) -> Document:
    """Return the key as a numbered document; `title` is the machine's name."""
    words = words_of(key)
    blocks: list[tree.Block] = [
        heading(words["key"]["title"]),
        *fields(((words["answer_sheet"]["kind"], title), *student_rows(key))),
        paragraph(words["key"]["note"]),
        *([paragraph(words["key"]["thinned"].format(count=len(key.printed)))] if key.printed else []),
    ]
    for title_of_part, page_of in key.pages:
        blocks += [heading(title_of_part, 2)] if title_of_part else []
        blocks += _why_wide(page_of, words["key"]["by_rule"])
        for part, rows in groupby(page_of.rows, lambda row: row.part):
            blocks += _tables(page_of, words, str(words_of(page_of)["parts"][part]), list(rows))
    return paper(key.language, words, f"{words['key']['title']} – {key.id}", blocks, variant=key.variant)


def _why_wide(key: Key, text: str) -> Iterator[Paragraph]:
    """Yield a paragraph that explains the wide bands of integrals: on paper there are only the positions."""
    rows = [row for row in key.rows if row.by_rule]
    unnamed = unnamed_rows(rows)
    if rows:
        before, behind = text.split("{symbols}")
        symbols = [(Text(", "), *symbol_inlines(row, row.id in unnamed)) for row in rows]
        yield Paragraph((Text(before), *[one for symbol in symbols for one in symbol][1:], Text(behind)))


def _tables(key: Key, words: Mapping[str, Any], name: str, rows: Sequence[KeyRow]) -> Iterator[Table]:
    """Yield the tables of a part: a list of single values, then quantities side by side with a row per position."""
    singles = [row for row in rows if row.single]
    if singles:
        yield _list(words, name, singles)
    turning = [row for row in rows if not row.single and any(row.sense)]
    others = [row for row in rows if not row.single and not any(row.sense)]
    unnamed = unnamed_rows((*others, *turning))
    for group in (others, turning):
        width = VALUE + 2 * BAND + (SENSE if group is turning else 0.0)
        most = int((tree.TEXT_WIDTH - tree.FIRST_COLUMN) // width)
        for start in range(0, len(group), most):
            yield _by_position(key, words, name, group[start : start + most], unnamed)


def _list(words: Mapping[str, Any], name: str, rows: Sequence[KeyRow]) -> Table:
    """Return a table of single values, one quantity per row."""
    heads, unnamed = words["table"], unnamed_rows(rows)
    senses = any(any(row.sense) for row in rows)
    symbol = symbol_width(unnamed, SYMBOL)
    widths = [UNIT, SINGLE, SINGLE_BAND, SINGLE_BAND, *([SENSE] if senses else [])]
    columns = (Column(symbol), Column(tree.TEXT_WIDTH - symbol - sum(widths), "left"), *map(Column, widths))
    titles = [heads["symbol"], words["answer_sheet"]["what"], heads["unit"], heads["value"]]
    titles += [words["key"][name] for name in ("drawn", "computed", *(["sense"] if senses else []))]
    body = (
        cells((symbol_inlines(row, row.id in unnamed), row.described, row.unit, *_values(row, 0, senses)))
        for row in rows
    )
    return Table(columns, (cells(titles),), tuple(body), (Text(name),))


def _by_position(
    key: Key, words: Mapping[str, Any], name: str, rows: Sequence[KeyRow], unnamed: Container[str]
) -> Table:
    """Return a table with quantities side by side and one position per row."""
    heads, senses = words["key"], any(any(row.sense) for row in rows)
    widths = (VALUE, BAND, BAND, *((SENSE,) if senses else ()))
    under = ("", heads["drawn"], heads["computed"], *((heads["sense"],) if senses else ()))
    titles = (Cell(_title(row, row.id in unnamed), len(widths)) for row in rows)
    head = ((*cells((words["table"]["position"],)), *titles), (Cell(), *cells(under) * len(rows)))
    body = (
        cells((label, *(value for row in rows for value in _values(row, index, senses))))
        for index, label in enumerate(key.labels)
        if not key.printed or index + 1 in key.printed
    )
    columns = tuple(map(Column, (tree.FIRST_COLUMN, *widths * len(rows))))
    return Table(columns, head, tuple(body), (Text(name),))


def _title(row: KeyRow, with_id: bool) -> Inlines:
    """Return symbol, unit and optional id of a quantity, with its description (without formula) below."""
    text = (f", {row.unit}" if row.unit else "") + (f" ({row.id})" if with_id else "")
    return (InlineMath(row.symbol), *((Text(text),) if text else ()), tree.LineBreak(), Text(row.named))


def _values(row: KeyRow, index: int, senses: bool) -> tuple[Number | str, ...]:
    """Return a value, its two bands, and optionally its direction in words."""
    value = float(row.printed[index])
    widths = (float(row.drawn[index]), float(row.computed[index]))
    bands = (_band_number(row, width) if value == value else DASH for width in widths)
    return (shown_number(row, value), *bands, *((row.sense[index],) if senses else ()))


def _band_number(row: KeyRow, width: float) -> Number | str:
    """Return a band as a number; one far below the last figure of its row is 0."""
    printed = band(row, width)
    if printed is None:
        return DASH
    decimals = min(band_decimals(printed), FINEST if row.decimals is None else row.decimals + FINER)
    number = Number(printed, decimals)
    return number if number.printed else Number(0.0)
