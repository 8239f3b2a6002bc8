"""Checks of several values together, for any kind; rules that a schema can express are also kept as data.

They read the plain content rather than the models where possible, so that they also work if another value is wrong.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from itertools import pairwise
from pathlib import Path
from statistics import mode
from typing import Any

from reportgen.assignment.common import Check, Draft, Labels, labels_of, named_worked, number_of
from reportgen.base.errors import Finding, Where
from reportgen.base.records import Record
from reportgen.base.template_folders import is_school, school_strays
from reportgen.base.units import QuantityFault, read_number, read_quantity


def of_parameters(look: Callable[[Any], Iterator[Finding]]) -> Check:
    """Return a check of the parameters alone, which runs if each of them is valid by itself."""

    def check(draft: Draft) -> Iterator[Finding]:
        if "parameters" in draft.sections:
            yield from look(draft.sections["parameters"])

    return check


def of_turning(look: Callable[[Any], Iterator[Finding]]) -> Check:
    """Return a check like `of_parameters` that is skipped for single instants, which do not need a whole turn."""
    every = of_parameters(look)

    def check(draft: Draft) -> Iterator[Finding]:
        if draft.at("positions", "at") is None:
            yield from every(draft)

    return check


def instants(draft: Draft) -> Iterator[Finding]:
    """Yield faults if an instant is repeated, or combined with the number or start of evenly spaced positions."""
    positions = draft.at("positions")
    if not isinstance(positions, dict) or positions.get("at") is None:
        return
    for key in ("count", "start"):
        if positions.get(key) is not None:
            yield Finding("both-given", ("positions", key), {"first": "at", "second": key}, at="key")
    at = positions["at"]
    for index, text in enumerate(at if isinstance(at, list) else ()):
        if text in at[:index]:
            yield Finding("repeated", ("positions", "at", index), {"text": str(text)})


class OneOf(Record):
    """Check that the section has one of several keys with the same meaning (at most one unless `required`).

    A nested section is named by its path, as "parameters.driver". With `form`, the check applies only if the
    section has this value at this key.
    """

    section: str
    names: tuple[str, ...]
    required: bool = True
    form: tuple[str, str] | None = None

    @property
    def where(self) -> Where:
        return tuple(self.section.split("."))

    def __call__(self, draft: Draft) -> Iterator[Finding]:
        content = draft.at(*self.section.split("."))
        if not isinstance(content, dict) or (self.form and content.get(self.form[0]) != self.form[1]):
            return
        given = [name for name, value in content.items() if name in self.names and value is not None]
        if len(given) > 1:
            first, second = given[:2]
            yield Finding("both-given", (*self.where, second), {"first": first, "second": second}, at="key")
        elif self.required and not given:
            # A key without a value is where the user meant to write it.
            key = next((name for name in content if name in self.names), self.names[0])
            yield Finding("missing-key", (*self.where, key), {"key": " | ".join(self.names)})


def one_of(section: str, *names: str, required: bool = True, form: tuple[str, str] | None = None) -> OneOf:
    """Return a `OneOf` check for these names."""
    return OneOf(section, names, required, form)


class SameLength(Record):
    """Check that rows have as many values as the list `key`; those that differ from most of them are at fault."""

    section: str
    key: str
    rows: tuple[str, ...]

    def __call__(self, draft: Draft) -> Iterator[Finding]:
        where = tuple(self.section.split("."))
        columns = {row: draft.at(*where, row) for row in (self.key, *self.rows)}
        lengths = {row: len(values) for row, values in columns.items() if isinstance(values, list)}
        if not lengths:
            return
        wanted = mode(lengths.values())
        agreeing = next(row for row, length in lengths.items() if length == wanted)
        for row, length in lengths.items():
            if length != wanted:
                counts = {"key": row, "given": str(length), "other": agreeing, "wanted": str(wanted)}
                yield Finding("row-length", (*where, row), counts)


def same_length(section: str, key: str, rows: Sequence[str]) -> SameLength:
    """Return a `SameLength` check."""
    return SameLength(section, key, tuple(rows))


class Increasing(Record):
    """Check that a list increases strictly from `first` to `last` (in `unit`)."""

    section: str
    key: str
    first: float
    last: float
    unit: str = ""

    def __call__(self, draft: Draft) -> Iterator[Finding]:
        where = (*self.section.split("."), self.key)
        texts = draft.at(*where)
        values = [_size(text, self.unit) for text in texts] if isinstance(texts, list) else []
        sizes = [value for value in values if value is not None]
        if not sizes or len(sizes) < len(values):
            return
        falls = [index + 1 for index, (one, next_one) in enumerate(pairwise(sizes)) if next_one <= one]
        if falls:
            yield Finding("not-increasing", (*where, falls[0]), {"key": self.key})
            return
        for index, value, wanted in ((0, sizes[0], self.first), (len(sizes) - 1, sizes[-1], self.last)):
            # Ends are exact up to the rounding of a unit (2 turn for 720 deg).
            if abs(value - wanted) > 1e-10 * (self.last - self.first):
                end = f"{wanted:g} {self.unit}".strip()
                yield Finding("table-end", (*where, index), {"key": self.key, "end": end})


def increasing(section: str, key: str, first: float, last: float, unit: str = "") -> Increasing:
    """Return an `Increasing` check from `first` to `last` (in `unit`)."""
    return Increasing(section, key, first, last, unit)


def _size(text: Any, unit: str) -> float | None:
    """Return the value of an item in `unit`; None if it cannot be read, which its own reader reports."""
    if not isinstance(text, str):
        return None
    try:
        if not unit:
            return read_number(text)
        return read_quantity(text, unit).si / read_quantity(f"1 {unit}", unit).si
    except QuantityFault:
        return None


def worked_positions(turns: int, names: Labels | None = None) -> Check:
    """Return a check that worked positions lie in the cycle of `turns` turns and are not repeated."""

    def check(draft: Draft) -> Iterator[Finding]:
        report, positions = draft.sections.get("report"), draft.sections.get("positions")
        if report is None or positions is None or (worked := named_worked(report, positions)) is None:
            return
        labels = labels_of(names, draft.sections.get("parameters"), positions, turns)
        met: set[int] = set()
        for index, named in enumerate(worked):
            place, number = ("report", "worked_positions", index), number_of(named, labels)
            if number in met:
                yield Finding("repeated", place, {"text": str(named)})
            elif number:
                met.add(number)
            elif isinstance(named, str):
                yield Finding("no-such-label", place, {"text": named, "known": ", ".join(labels)})
            else:
                yield Finding("no-such-position", place, {"text": str(named), "last": str(len(labels))})

    return check


def school_of(path: Path) -> Check:
    """Return a check that the school's folder of the file at `path` exists beside or below the file and
    contains words.
    """

    def check(draft: Draft) -> Iterator[Finding]:
        named, where = draft.at("report", "templates"), ("report", "templates")
        if not isinstance(named, str):
            return
        folder = path.parent / named
        if school_strays(folder, path.parent):
            yield Finding("path-outside", where, {"text": named})
        elif not is_school(folder):
            yield Finding("no-templates", where, {"place": str(folder.absolute())})
        else:
            yield from one_of("report", "school", "templates", required=False)(draft)

    return check
