"""Checks of tables: rows of one length, nodes that grow from one end to the other."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise
from statistics import mode
from typing import Any

from reportgen.assignment.common import Check, Draft
from reportgen.base.errors import Finding
from reportgen.base.units import QuantityFault, read_number, read_quantity


def same_length(section: str, key: str, rows: Sequence[str]) -> Check:
    """The rows have as many values as the list `key`: those that differ from most of them are at fault."""
    where = tuple(section.split("."))

    def check(draft: Draft) -> Iterator[Finding]:
        columns = {row: draft.at(*where, row) for row in (key, *rows)}
        lengths = {row: len(values) for row, values in columns.items() if isinstance(values, list)}
        if not lengths:
            return
        wanted = mode(lengths.values())
        agreeing = next(row for row, length in lengths.items() if length == wanted)
        for row, length in lengths.items():
            if length != wanted:
                counts = {"key": row, "given": str(length), "other": agreeing, "wanted": str(wanted)}
                yield Finding("row-length", (*where, row), counts)

    return check


def increasing(section: str, key: str, first: float, last: float, unit: str = "") -> Check:
    """The list grows strictly from `first` to `last` (in `unit`)."""
    where = (*section.split("."), key)

    def check(draft: Draft) -> Iterator[Finding]:
        texts = draft.at(*where)
        values = [_size(text, unit) for text in texts] if isinstance(texts, list) else []
        sizes = [value for value in values if value is not None]
        if not sizes or len(sizes) < len(values):
            return
        falls = [index + 1 for index, (one, next_one) in enumerate(pairwise(sizes)) if next_one <= one]
        if falls:
            yield Finding("not-increasing", (*where, falls[0]), {"key": key})
            return
        for index, value, wanted in ((0, sizes[0], first), (len(sizes) - 1, sizes[-1], last)):
            # Ends are exact but for the rounding of a unit (2 turn for 720 deg).
            if abs(value - wanted) > 1e-10 * (last - first):
                end = f"{wanted:g} {unit}".strip()
                yield Finding("table-end", (*where, index), {"key": key, "end": end})

    return check


def _size(text: Any, unit: str) -> float | None:
    """The value of an item in `unit`; None if it cannot be read, which its own reader reports."""
    if not isinstance(text, str):
        return None
    try:
        if not unit:
            return read_number(text)
        return read_quantity(text, unit).si / read_quantity(f"1 {unit}", unit).si
    except QuantityFault:
        return None
