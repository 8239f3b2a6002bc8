"""The rows of a table under their headings: a roster or a table of variants."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from typing import get_args

from reportgen.assignment.faults import Fault, messages
from reportgen.assignment.source import Scalar
from reportgen.errors import Mark
from reportgen.notation.numbers import Language
from reportgen.units import NUMBER, UNIT
from reportgen.workbook import Cell, Page

FIRST_ROWS = 20
"""How far down the headings are looked for, below a title."""
_WITH_UNIT = re.compile(rf"(.*?)\s*[(\[]\s*({UNIT})\s*[)\]]")
_NUMBER = re.compile(NUMBER)


@dataclass(frozen=True, slots=True)
class Column:
    """A heading: `name` is one of the known columns or what was typed, `unit` what stood in brackets after it."""

    index: int
    name: str
    unit: str
    mark: Mark


@dataclass(frozen=True, slots=True)
class Record:
    """A row: what stands under each heading, empty cells left out; `mark` is its first cell.

    `cells` are the places of all its cells, `refused` the columns where a cell shows no value.
    """

    values: Mapping[str, Scalar]
    mark: Mark
    cells: Mapping[str, Mark]
    refused: frozenset[str] = frozenset()


@cache
def _known_columns() -> Mapping[str, str]:
    """The name of a column by any heading it may have, in every language, folded."""
    return {
        folded(heading): name
        for language in get_args(Language)
        for name, headings in messages(language)["columns"].items()
        for heading in (name, *headings)
    }


def folded(text: str) -> str:
    """A heading without what does not tell two headings apart: case, blanks, composition, marks at its end."""
    return " ".join(unicodedata.normalize("NFC", text).casefold().split()).rstrip(" .:*")


def columns(row: Sequence[Cell]) -> list[Column]:
    """The headings of a row; empty ones are left out."""
    found = []
    for index, cell in enumerate(row):
        title = unicodedata.normalize("NFC", cell.text).strip()
        known = _known_columns().get(folded(title))
        match = None if known else _WITH_UNIT.fullmatch(title)
        name, unit = (match[1], match[2]) if match else (title, "")
        if title:
            found.append(Column(index, known or _known_columns().get(folded(name)) or name, unit, cell.mark))
    return found


def heading_row(page: Page, wanted: str) -> int | None:
    """The index of the first row near the top that has a column `wanted`."""
    rows = enumerate(page.rows[:FIRST_ROWS])
    return next((k for k, row in rows if any(column.name == wanted for column in columns(row))), None)


def records(page: Page, headings: Sequence[Column], start: int, faults: list[Fault]) -> Iterator[Record]:
    """The rows from index `start` on that hold something.

    Faults are headings that stand for a column there is already, and cells that show no value.
    """
    seen: set[str] = set()
    for column in headings:
        if column.name in seen:
            faults.append(Fault("column-twice", column.mark, {"key": column.name}))
        seen.add(column.name)
    for row in page.rows[start:]:
        values: dict[str, Scalar] = {}
        refused: set[str] = set()
        present = [(column, row[column.index]) for column in headings if column.index < len(row)]
        for column, cell in present:
            text = cell.text.strip()
            if not (text or cell.kind == "formula"):
                continue
            if cell.kind in ("error", "formula") and (cell.value is None or str(cell.value).startswith("#")):
                faults.append(Fault("no-cell-value", cell.mark, {"text": cell.formula or cell.text}))
                refused.add(column.name)
                continue
            # A bare number has the unit of its heading.
            bare = column.unit and _NUMBER.fullmatch(text)
            values[column.name] = Scalar(f"{text} {column.unit}" if bare else text, cell.mark)
        first = next((cell for cell in row if not cell.blank), None)
        if first is not None:
            cells = {column.name: cell.mark for column, cell in present}
            yield Record(values, first.mark, cells, frozenset(refused))
