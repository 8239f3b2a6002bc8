"""Verdicts and mistakes in words: as plain text for comments in cells, as inlines for pages."""

from __future__ import annotations

from collections.abc import Mapping
from string import Formatter
from typing import Any

from reportgen.answers.key import Key, Row
from reportgen.answers.key_tables import band, band_decimals
from reportgen.answers.sheet import shown_number
from reportgen.document.plain import plain
from reportgen.document.tree import Inline, InlineMath, Inlines, Text, Value
from reportgen.errors import Mark
from reportgen.grading.marks import Marked, Verdict
from reportgen.notation.expressions import Number, Symbol
from reportgen.notation.numbers import MINUS, Language, printed, write

LEAST, MOST = 1e-6, 1e9
"""A student's value between these is written out, any other with a power of ten."""


def sentence(words: str, /, **parts: Inline | str) -> Inlines:
    """Words with texts and inlines put in where they are named."""
    result: list[Inline] = []
    for text, name, _, _ in Formatter().parse(words):
        result += [Text(text)] if text else []
        if name:
            part = parts[name]
            result.append(Text(part) if isinstance(part, str) else part)
    return tuple(result)


def points_text(points: float, language: Language) -> str:
    """Points to at most two decimals."""
    value = printed(points, 2)
    return write(value, None, language)


def given_value(row: Row, value: float) -> Inline:
    """A student's value with its unit, to six figures; one of any size takes little room."""
    if value and not LEAST < abs(value) < MOST:
        return Text(f"{value:.4g} {row.unit}".replace("-", MINUS).strip())
    return Value(Number(float(f"{value:.6g}"), None, row.unit))


def expected_value(row: Row, cell: Marked) -> Value:
    """The key's value with its unit."""
    number = shown_number(row, cell.expected)
    return Value(Number(number.value, number.decimals, row.unit))


def mistake_inlines(cell: Marked, key: Key, words: Mapping[str, Any]) -> Inlines:
    """What went wrong, in a sentence; a general one where no mistake was recognised."""
    if not cell.mistake:
        return (Text(words["feedback"]["unnamed"]),)
    return sentence(words["mistakes"][cell.mistake], symbol=InlineMath(symbol_of(cell, key)))


def symbol_of(cell: Marked, key: Key) -> Symbol:
    """The symbol of the quantity in which the mistake was made; of the cell's own where the key has no row of it."""
    row = key.find(cell.where) or key.find(f"turn.{cell.where}") or key.row(cell.id)
    return row.symbol


def note(cell: Marked, key: Key, words: Mapping[str, Any], message: str, show_answers: bool) -> str:
    """The comment on a cell that is not right; `message` says why it could not be read."""
    notes = words["verdict_notes"]
    if cell.verdict is Verdict.right:
        return ""
    if cell.verdict is Verdict.unreadable:
        return str(notes["unreadable"]).format(message=message)
    lines = [str(notes["first" if cell.first and cell.verdict is Verdict.wrong else cell.verdict])]
    if cell.first and cell.mistake:
        lines.append(plain(mistake_inlines(cell, key, words), key.language))
    if show_answers:
        lines.append(_expected(cell, key, words))
    return "\n".join(lines)


def _expected(cell: Marked, key: Key, words: Mapping[str, Any]) -> str:
    row = key.row(cell.id)
    number = shown_number(row, cell.expected)
    width = band(row, cell.band) or 0.0
    return str(words["feedback"]["expected_note"]).format(
        value=write(number.value, number.decimals, key.language),
        band=write(width, band_decimals(width), key.language),
        unit=row.unit,
    ).replace(" .", ".")


def place_text(mark: Mark) -> str:
    """A place within a file, without the file: SHEET!CELL or LINE:COLUMN."""
    return str(mark).removeprefix(f"{mark.file}:")
