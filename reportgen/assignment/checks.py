"""Checks that look at several values at once, for any kind to put in its list.

They read the plain content, not the models, wherever they can: so they also speak when some other value
of the file is wrong.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise
from statistics import mode
from typing import Any

from reportgen.assignment.common import Added, Check, Draft, none_added
from reportgen.assignment.faults import Finding, Where
from reportgen.units import QuantityFault, read_number, read_quantity


def worked_positions(turns: int, added: Added = none_added) -> Check:
    """Numbers of worked positions lie in the cycle of `turns` turns, with the positions `added` to each."""

    def check(draft: Draft) -> Iterator[Finding]:
        report, positions = draft.sections.get("report"), draft.sections.get("positions")
        if report is None or positions is None or report.worked_positions is None:
            return
        parameters = draft.sections.get("parameters")
        more = 0 if parameters is None else added(parameters, positions)
        last = (positions.count + more) * turns
        for index, number in enumerate(report.worked_positions):
            if number > last:
                place = ("report", "worked_positions", index)
                yield Finding("no-such-position", place, {"text": str(number), "last": str(last)})

    return check


def one_of(section: str, *names: str, required: bool = True) -> Check:
    """Of several keys that say the same thing, one stands in the section (at most one unless `required`)."""

    def check(draft: Draft) -> Iterator[Finding]:
        content = draft.raw.get(section)
        if not isinstance(content, dict):
            return
        given = [name for name, value in content.items() if name in names and value is not None]
        if len(given) > 1:
            first, second = given[:2]
            yield Finding("both-given", (section, second), {"first": first, "second": second}, at="key")
        elif required and not given:
            yield Finding("missing-key", (section, names[0]), {"key": " | ".join(names)})

    return check


def same_length(section: str, key: str, rows: Sequence[str]) -> Check:
    """The rows have as many values as the list `key`: those that differ from most of them are at fault."""

    def check(draft: Draft) -> Iterator[Finding]:
        content = draft.raw.get(section)
        found = {row: _list(content, row) for row in (key, *rows)}
        lengths = {row: len(values) for row, values in found.items() if values is not None}
        if not lengths:
            return
        wanted = mode(lengths.values())
        other = next(row for row, length in lengths.items() if length == wanted)
        for row, length in lengths.items():
            if length != wanted:
                counts = {"key": row, "given": str(length), "other": other, "wanted": str(wanted)}
                yield Finding("row-length", (section, row), counts)

    return check


def increasing(section: str, key: str, first: float, last: float, unit: str = "") -> Check:
    """The list grows strictly from `first` to `last` (in `unit`)."""

    def check(draft: Draft) -> Iterator[Finding]:
        texts = _list(draft.raw.get(section), key)
        values = [_size(text, unit) for text in texts or ()]
        if not values or None in values:
            return
        sizes = [value for value in values if value is not None]
        falls = [index + 1 for index, (one, next_one) in enumerate(pairwise(sizes)) if next_one <= one]
        if falls:
            yield Finding("not-increasing", (section, key, falls[0]), {"key": key})
            return
        for index, value, wanted in ((0, sizes[0], first), (len(sizes) - 1, sizes[-1], last)):
            # Ends are exact but for the rounding of a unit (2 turn for 720 deg).
            if abs(value - wanted) > 1e-10 * (last - first):
                end = f"{wanted:g} {unit}".strip()
                place: Where = (section, key, index)
                yield Finding("table-end", place, {"key": key, "end": end})

    return check


def _list(content: Any, key: str) -> list[Any] | None:
    values = content.get(key) if isinstance(content, dict) else None
    return values if isinstance(values, list) else None


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
