"""Results as files: a row per position and a column per number, named as in the JSON.

A number's column is the path to it in a position of `reportgen-results/1`: `points.B.v.x`, `links.2.omega`.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from typing import Any

from reportgen.workbook import Book, WorksheetData, write_csv, write_xlsx

Cell = str | float | None
AXES = ("x", "y")
WIDTH = 16.0
"""Width of a column, in characters."""


def text(results: Mapping[str, Any]) -> bytes:
    """Return results as the text of a JSON file."""
    return (json.dumps(results, ensure_ascii=False, allow_nan=False, indent=1) + "\n").encode()


def table(results: Mapping[str, Any]) -> bytes:
    """Return results as CSV, which has one table: the parts of a coursework are left out."""
    return write_csv(result_rows(results))


def workbook(results: Mapping[str, Any]) -> bytes:
    """Return results as a workbook with a page for each part of a coursework."""
    name = f"{results['kind']} {results['variant']}".strip()
    pages = [_result_page(called, one) for called, one in {name: results, **results.get("parts", {})}.items()]
    return write_xlsx(Book(pages, name))


def _result_page(name: str, results: Mapping[str, Any]) -> WorksheetData:
    rows = result_rows(results)
    return WorksheetData(name, rows, (WIDTH,) * len(rows[0]), (1, 1))


def result_rows(results: Mapping[str, Any]) -> list[list[Cell]]:
    """Return the heads, then a row per position; an unreachable one has only its number."""
    rows = [
        {"number": float(index)} if position is None else dict(_leaves(position))
        for index, position in enumerate(results["positions"], start=1)
    ]
    heads = list(dict.fromkeys(head for row in rows for head, value in row.items() if value is not None))
    return [list(heads), *([row.get(head) for head in heads] for row in rows)]


def _leaves(value: Any, path: str = "") -> Iterator[tuple[str, Cell]]:
    """Yield the numbers and texts of an entry with their paths.

    A pair of numbers is a plane vector; entries of any other list are numbered from 1.
    """
    match value:
        case Mapping():
            for name, inner in value.items():
                yield from _leaves(inner, f"{path}.{name}" if path else str(name))
        case list():
            is_vector = len(value) == len(AXES) and not any(isinstance(part, (Mapping, list)) for part in value)
            for name, part in zip(AXES if is_vector else range(1, len(value) + 1), value, strict=True):
                yield from _leaves(part, f"{path}.{name}")
        case _:
            yield path, value
