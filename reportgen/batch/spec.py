"""A spec: an assignment file with a finite choice of values in place of some of them.

Beside the keys of an assignment file it may have

- lists where one value is wanted: `n: [1800 rpm, 2000 rpm, 2200 rpm]`;
- stepped ranges: `H: {from: 80 mm, to: 120 mm, step: 5 mm}`, ends included, units as typed in `from`;
- `variants: table.csv` (or .xlsx, beside the spec): one row a variant, columns named like the parameters (`H`,
  or `H (mm)` for bare numbers; `positions.start` for other sections), and if wished a column `variant`
  with its name;
- `salt: text`, which changes all draws; without it they stand on the key `variant` of the spec.

Choices may stand at any depth of `parameters`, `positions`, `drawing` and `indicator`.  What the kind's own
model wants as a list stays a list.  Every combination of the choices is a variant.
"""

from __future__ import annotations

import difflib
import hashlib
import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from reportgen import catalogue
from reportgen.assignment import Fault, Kind
from reportgen.assignment.faults import Where
from reportgen.assignment.messages import as_problem
from reportgen.assignment.reading import assess, known_keys, language_of, misread, wants
from reportgen.assignment.source import List, Node, Scalar, Source, Table, read_source
from reportgen.batch import stepped
from reportgen.batch.nodes import at, path_text, put, without
from reportgen.batch.table import Column, Record, columns, records, twice
from reportgen.errors import AssignmentError, Mark
from reportgen.notation.numbers import Language
from reportgen.workbook import read

OWN_KEYS = ("variants", "salt")
DRAWN_SECTIONS = ("parameters", "positions", "drawing", "indicator")
MOST_CHOICES = 10_000

Settings = Mapping[Where, Scalar]
"""Values with the place in the assignment where each stands."""


@dataclass(frozen=True, slots=True)
class Choice:
    """One of the values of an axis, or one row of the table of variants."""

    text: str
    settings: Settings


@dataclass(frozen=True, slots=True)
class Axis:
    """What is drawn by itself: its path ("parameters.H", or "variants") and its choices."""

    name: str
    choices: tuple[Choice, ...]


@dataclass(frozen=True)
class Spec:
    """A spec in order: every choice can be read as what it stands for; not every combination need turn.

    `name` is the file's stem, `digest` the SHA-256 of its text and its table.
    """

    path: Path
    text: str
    whole: Table
    """The file as it stands."""
    top: Table
    """The same without the keys that only a spec has."""
    kind: Kind
    axes: tuple[Axis, ...]
    salt: str
    digest: str
    language: Language

    @property
    def name(self) -> str:
        return self.path.stem

    @cached_property
    def size(self) -> int:
        """The number of combinations."""
        return math.prod(len(axis.choices) for axis in self.axes)

    def combination(self, number: int) -> tuple[int, ...]:
        """The indices of a combination numbered from 0, the last axis counting fastest."""
        indices = []
        for axis in reversed(self.axes):
            number, index = divmod(number, len(axis.choices))
            indices.append(index)
        return tuple(reversed(indices))

    def number(self, indices: Sequence[int]) -> int:
        """The number of a combination, from 0."""
        number = 0
        for axis, index in zip(self.axes, indices, strict=True):
            number = number * len(axis.choices) + index
        return number

    def label(self, indices: Sequence[int]) -> str:
        """What a variant is called: by its row if nothing else is drawn, else by its number, from 1.

        Where nothing is drawn at all, it keeps the spec's own name.
        """
        own = at(self.top, ("variant",))
        if not self.axes:
            return own.text if isinstance(own, Scalar) else ""
        rows = [axis.choices[k].text for axis, k in zip(self.axes, indices, strict=True) if axis.name == "variants"]
        number = str(self.number(indices) + 1)
        return rows[0] if rows and len(self.axes) == 1 else "-".join([*rows, number])

    def settings(self, indices: Sequence[int]) -> Settings:
        """The values of a combination."""
        merged: dict[Where, Scalar] = {}
        for axis, index in zip(self.axes, indices, strict=True):
            merged.update(axis.choices[index].settings)
        return merged

    def source(self, settings: Settings) -> Source:
        """The assignment file with `settings` in place of the choices."""
        return Source(str(self.path), self.text, assembled(self.top, settings))

    def column_faults(self, overriding: Iterable[Column]) -> list[Fault]:
        """Faults of a roster's headings that set what this kind of machine does not have."""
        found = (_no_place(self.kind, self.top, place(self.kind, one.name), one) for one in overriding)
        return [fault for fault in found if fault]


def read_spec(path: Path, language: Language | None = None) -> Spec:
    """The spec of a file; raises `AssignmentError` with all faults that its choices show by themselves."""
    source = read_source(path)
    spoken = language or language_of(source)
    top = source.top
    kind = _kind(top)
    if source.faults or not isinstance(top, Table) or kind is None:
        faults = assess(source, path, catalogue.known())[1]
        raise AssignmentError([as_problem(fault, spoken) for fault in faults])
    faults = []
    base = without(top, OWN_KEYS)
    axes = list(_axes(base, (), kind, faults))
    table = _own_text(top, "variants", faults)
    salt = _own_text(top, "salt", faults) or _own_text(top, "variant", [])
    digest = hashlib.sha256(source.text.encode())
    if table is not None:
        file = path.parent / table.text
        rows = _rows(file, kind, base, faults, spoken)
        faults += _given_twice(base, axes, rows)
        axes.append(Axis("variants", rows))
        if not faults:
            digest.update(file.read_bytes())
    salted = salt.text if salt else ""
    spec = Spec(path, source.text, top, base, kind, tuple(axes), salted, digest.hexdigest(), spoken)
    faults += _unreadable(spec)
    if faults:
        raise AssignmentError(list(dict.fromkeys(as_problem(fault, spoken) for fault in faults)))
    return spec


def assembled(top: Table, settings: Settings) -> Table:
    """The file with some values set."""
    node: Node = top
    for where, value in settings.items():
        node = put(node, where, value)
    assert isinstance(node, Table), "no place is the top of the file"
    return node


def place(kind: Kind, name: str) -> Where:
    """The place that a heading speaks of; a bare name is one of the parameters."""
    steps = name.split(".")
    where: Where = () if steps[0] in DRAWN_SECTIONS or steps[0] == "report" else ("parameters",)
    for step in steps:
        where = (*where, int(step) if step.isdecimal() and "list" in wants(kind, where) else step)
    return where


def _kind(top: Node | None) -> Kind | None:
    name = at(top, ("kind",))
    return catalogue.kind(name.text) if isinstance(name, Scalar) and name.text in catalogue.kinds() else None


def _own_text(top: Table, key: str, faults: list[Fault]) -> Scalar | None:
    entry = top.find(key)
    if entry is None or (isinstance(entry[1], Scalar) and entry[1].null):
        return None
    if isinstance(entry[1], Scalar):
        return entry[1]
    faults.append(Fault("wrong-type", entry[1].mark, {"expected": "text"}))
    return None


def _axes(node: Node, where: Where, kind: Kind, faults: list[Fault]) -> Iterator[Axis]:
    """Lists and ranges that stand where the model wants one value."""
    sorts = wants(kind, where)
    one_value = "scalar" in sorts and bool(where) and where[0] in DRAWN_SECTIONS
    if isinstance(node, List):
        if one_value and "list" not in sorts:
            yield _axis(where, _listed(node, faults))
        else:
            for index, item in enumerate(node.items):
                yield from _axes(item, (*where, index), kind, faults)
    elif isinstance(node, Table):
        if one_value and "table" not in sorts:
            yield _axis(where, stepped.values(node, faults))
        else:
            for key, value in node.entries:
                yield from _axes(value, (*where, key.text), kind, faults)


def _axis(where: Where, values: Sequence[Scalar]) -> Axis:
    return Axis(path_text(where), tuple(Choice(value.text, {where: value}) for value in values))


def _listed(node: List, faults: list[Fault]) -> tuple[Scalar, ...]:
    """The choices of a list."""
    if not node.items:
        faults.append(Fault("too-few", node.mark, {"least": "1"}))
    if len(node.items) > MOST_CHOICES:
        faults.append(Fault("too-many", node.mark, {"most": str(MOST_CHOICES)}))
        return ()
    seen: set[str] = set()
    values = []
    for item in node.items:
        if not isinstance(item, Scalar) or item.null:
            faults.append(Fault("wrong-type", item.mark, {"expected": "text"}))
        elif item.text in seen:
            faults.append(Fault("choice-repeated", item.mark, {"text": item.text}))
        else:
            seen.add(item.text)
            values.append(item)
    return tuple(values)


def _rows(file: Path, kind: Kind, base: Table, faults: list[Fault], language: Language) -> tuple[Choice, ...]:
    """The rows of a table of variants; raises `AssignmentError` if it cannot be read at all."""
    pages = read(file, language)
    page = next((page for page in pages if any(page.rows)), pages[0])
    start = next(index for index, row in enumerate(page.rows) if row)
    headings = columns(page.rows[start])
    faults += twice(headings)
    places = {one.name: place(kind, one.name) for one in headings if one.name != "variant"}
    found = [_no_place(kind, base, places[one.name], one) for one in headings if one.name in places]
    faults += [fault for fault in found if fault]
    rows: list[Choice] = []
    names: set[str] = set()
    for one in records(page, headings, start + 1):
        if isinstance(one, Fault):
            faults.append(one)
            continue
        name = _row_name(one, len(rows) + 1)
        if name in names:
            faults.append(Fault("choice-repeated", one.mark, {"text": name}))
        names.add(name)
        rows.append(Choice(name, {places[key]: value for key, value in one.values.items() if key in places}))
    if not rows:
        faults.append(Fault("empty-roster", headings[0].mark))
    return tuple(rows)


def _row_name(row: Record, number: int) -> str:
    return row.values["variant"].text if "variant" in row.values else str(number)


def _no_place(kind: Kind, base: Table, where: Where, column: Column) -> Fault | None:
    """The fault of a heading that stands for nothing that a single cell can say, or for an item no list has."""
    items = [where[: k + 1] for k, step in enumerate(where) if isinstance(step, int)]
    if "scalar" in wants(kind, where) and all(at(base, item) is not None for item in items):
        return None
    known = known_keys(kind, where[:-1])
    close = difflib.get_close_matches(str(where[-1]), known, n=1, cutoff=0.6) or [
        name for name in known if name.casefold() == str(where[-1]).casefold()
    ]
    hint = {"close": close[0]} if close else {"known": ", ".join(known)} if known else {}
    return Fault("unknown-column", column.mark, {"key": column.name, **hint})


def _given_twice(base: Table, axes: Iterable[Axis], rows: Iterable[Choice]) -> Iterator[Fault]:
    """Values of the spec that a column of the table sets too."""
    drawn = {axis.name for axis in axes}
    for where in dict.fromkeys(where for row in rows for where in row.settings):
        node = at(base, where)
        if node is not None and (path_text(where) in drawn or not (isinstance(node, Scalar) and node.null)):
            yield Fault("not-in-table", node.mark, {"key": path_text(where)})


def _unreadable(spec: Spec) -> list[Fault]:
    """Faults of single values: of the first combination, and of every other choice put into it."""
    if not spec.axes or any(not axis.choices for axis in spec.axes):
        return [] if spec.axes else misread(spec.top, spec.kind)
    first = assembled(spec.top, spec.settings([0] * len(spec.axes)))
    told: dict[tuple[str, Mark], Fault] = {}
    for axis in spec.axes:
        for choice in axis.choices:
            for fault in misread(assembled(first, choice.settings), spec.kind):
                told.setdefault((fault.code, fault.mark), fault)
    return list(told.values())
