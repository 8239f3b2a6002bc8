"""A spec: an assignment file in which some values are replaced by finite choices.

In addition to the keys of an assignment file it may have

- lists in place of one value: `n: [1800 rpm, 2000 rpm, 2200 rpm]`;

- stepped ranges: `H: {from: 80 mm, to: 120 mm, step: 5 mm}`, ends included, units as typed in `from`;

- `variants: table.csv` (or .xlsx, beside the spec, below it or below a shared folder): one variant per row, columns
named like the parameters (`H`, or `H (mm)` for bare numbers; `positions.start` for other sections), and optionally a
column `variant` with its name;

- `parts`, each its own spec beside this one or below it; a student's draw of a part is written to its own file, beside
that of the machine;

- `salt: text`, which changes all draws; without it they depend on the key `variant` of the spec.

Choices may be at any depth of `parameters`, `positions`, `drawing` and `indicator`. A list that the kind's own model
expects remains a list. Every combination of the choices is a variant.
"""

from __future__ import annotations

import hashlib
import math
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from decimal import Decimal
from pathlib import Path

from reportgen import catalogue
from reportgen.assignment import parts
from reportgen.assignment.common import PARTS, Kind
from reportgen.assignment.reading import misread
from reportgen.assignment.schema import allowed_forms, known_keys
from reportgen.base.errors import Fault, Location, Where
from reportgen.base.files import contents, leads_out
from reportgen.base.kinds import kinds
from reportgen.base.records import Record, field
from reportgen.base.units import NUMBER, Language, QuantityFault, read_number, read_quantity, read_unit
from reportgen.base.words import as_error, close_or_known, language_of
from reportgen.base.yaml_source import MappingNode, Node, Scalar, SequenceNode, Source, read_source
from reportgen.base.yaml_values import at, path_text, put, without
from reportgen.classes.roster import RosterColumn, columns, records
from reportgen.workbook import read

DRAWN_SECTIONS = ("parameters", "positions", "drawing", "indicator")
RANGE_KEYS = ("from", "to", "step")
MOST_CHOICES = 10_000
_LEADING_NUMBER = re.compile(rf"{NUMBER}\s*")
_DUST = Decimal("1e-9")
"""Share of a step within which an end counts as reached, to allow for rounding in a change of units."""

Settings = Mapping[Where, Scalar]
"""Values by their places in the assignment."""


class Choice(Record):
    """One of the values of an axis, or one row of the table of variants."""

    text: str
    settings: Settings


class DrawnParameter(Record):
    """An axis that is drawn independently: its path ("parameters.H", or "variants") and its choices."""

    name: str
    choices: tuple[Choice, ...]


class Spec(Record):
    """A valid spec: every choice can be parsed as its type; not every combination need turn.

    `digest` is the SHA-256 of its text and its table.
    """

    path: Path
    text: str
    whole: MappingNode
    """The file as written."""
    top: MappingNode
    """The same without the keys that only a spec has."""
    kind: Kind
    axes: tuple[DrawnParameter, ...]
    salt: str
    digest: str
    language: Language
    parts: Mapping[int, Source] = field(default_factory=dict)
    """The specs of the parts that have their own files, by number."""

    @property
    def name(self) -> str:
        return self.path.stem

    @property
    def files(self) -> tuple[Path, ...]:
        """The files that it was read from: its own file, those of the parts and the table of variants."""
        table = at(self.whole, ("variants",))
        own = (self.path, *(Path(part.file) for part in self.parts.values()))
        return (*own, self.path.parent / table.text) if isinstance(table, Scalar) else own

    @property
    def frozen(self) -> Mapping[int, str]:
        """The names of the parts that have their own files, by number."""
        names = parts.named(self.top, catalogue.kind)
        return {index: names[index] for index in self.parts}

    @property
    def location(self) -> Location:
        """The location of faults of whole combinations: the parameters."""
        section = self.top.find("parameters")
        return section[0].location if section else self.top.location

    @property
    def size(self) -> int:
        """The number of combinations."""
        return math.prod(len(axis.choices) for axis in self.axes)

    def combination(self, number: int) -> tuple[int, ...]:
        """Return the indices of a combination numbered from 0; the last axis varies fastest."""
        indices = []
        for axis in reversed(self.axes):
            number, index = divmod(number, len(axis.choices))
            indices.append(index)
        return tuple(reversed(indices))

    def number(self, indices: Sequence[int]) -> int:
        """Return the number of a combination, from 0."""
        number = 0
        for axis, index in zip(self.axes, indices, strict=True):
            number = number * len(axis.choices) + index
        return number

    def label(self, indices: Sequence[int]) -> str:
        """Return the name of a variant: that of its row if nothing else is drawn, else its number, from 1.

        If nothing is drawn at all, it is the spec's own `variant`.
        """
        own = at(self.top, ("variant",))
        if not self.axes:
            return own.text if isinstance(own, Scalar) else ""
        rows = [axis.choices[k].text for axis, k in zip(self.axes, indices, strict=True) if axis.name == "variants"]
        number = str(self.number(indices) + 1)
        return rows[0] if rows and len(self.axes) == 1 else "-".join([*rows, number])

    def settings(self, indices: Sequence[int]) -> Settings:
        """Return the values of a combination."""
        merged: dict[Where, Scalar] = {}
        for axis, index in zip(self.axes, indices, strict=True):
            merged.update(axis.choices[index].settings)
        return merged

    def source(self, settings: Settings) -> Source:
        """Return the assignment file with `settings` in place of the choices."""
        return Source(str(self.path), self.text, assembled(self.top, settings))

    def column_faults(self, overriding: Iterable[RosterColumn]) -> list[Fault]:
        """Return faults of a roster's headings that set values which this kind of machine does not have."""
        return [fault for column in overriding for fault in _no_place(self.kind, self.top, column)]


def read_spec(path: Path, language: Language | None = None, shared: Sequence[Path] = ()) -> Spec:
    """Return the spec of a file, whose table is below its folder or a `shared` one.

    Raises `AssignmentError` with all faults that its choices show independently.
    """
    source = read_source(path)
    language = language or language_of(source)
    top = source.top
    name = at(top, ("kind",))
    named = isinstance(name, Scalar) and name.text in kinds()
    if source.faults or not isinstance(top, MappingNode) or not isinstance(name, Scalar) or not named:
        raise as_error(catalogue.assess(source, path)[1], language)
    kind = catalogue.kind(name.text)
    faults: list[Fault] = []
    base = without(top, catalogue.SPEC_KEYS)
    axes = list(_axes(base, (), kind, faults))
    base, of_parts, unread = parts.in_place(base, path)
    faults += unread
    axes += _axes_of_parts(base, faults)
    table = _own_text(top, "variants", faults)
    salt = _own_text(top, "salt", faults) or _own_text(top, "variant", [])
    digest = hashlib.sha256(source.text.encode())
    for part in of_parts.values():
        digest.update(part.text.encode())
    if table is not None:
        file = path.parent / table.text
        if leads_out(file, path.parent, *shared):
            # The file is not read, so that no message reveals its content.
            outside = Fault("path-outside", table.location, {"text": table.text, "hint": "path-shared"})
            raise as_error([*faults, outside], language)
        rows = _rows(file, kind, base, faults, language)
        faults += _given_twice(base, axes, rows)
        axes.append(DrawnParameter("variants", rows))
        if not faults:
            digest.update(contents(file))
    salted = salt.text if salt else ""
    spec = Spec(
        path=path,
        text=source.text,
        whole=top,
        top=base,
        kind=kind,
        axes=tuple(axes),
        salt=salted,
        digest=digest.hexdigest(),
        language=language,
        parts=of_parts,
    )
    faults += _unreadable(spec)
    if faults:
        raise as_error(faults, language)
    return spec


def assembled(top: MappingNode, settings: Settings) -> MappingNode:
    """Return the file with some values set."""
    node: Node = top
    for where, value in settings.items():
        node = put(node, where, value)
    assert isinstance(node, MappingNode), "no place is the top of the file"
    return node


def place(kind: Kind, name: str) -> Where:
    """Return the place that a heading names; a bare name is a parameter."""
    steps = name.split(".")
    where: Where = () if steps[0] in DRAWN_SECTIONS or steps[0] == "report" else ("parameters",)
    for step in steps:
        where = (*where, int(step) if step.isdecimal() and "list" in allowed_forms(kind, where) else step)
    return where


def _own_text(top: MappingNode, key: str, faults: list[Fault]) -> Scalar | None:
    entry = top.find(key)
    if entry is None or (isinstance(entry[1], Scalar) and entry[1].null):
        return None
    if isinstance(entry[1], Scalar):
        return entry[1]
    faults.append(Fault("wrong-type", entry[1].location, {"expected": "text"}))
    return None


# --- parts ------------------------------------------------------------------------------------------


def _axes_of_parts(base: MappingNode, faults: list[Fault]) -> Iterator[DrawnParameter]:
    """Yield the axes of the parts, named by the part and the path in it."""
    for index, called in parts.named(base, catalogue.kind).items():
        item, name = at(base, (PARTS, index)), at(base, (PARTS, index, "kind"))
        assert isinstance(item, MappingNode), "a part is a table"
        assert isinstance(name, Scalar), "a part that has a name has a kind"
        for axis in _axes(without(item, parts.ABOUT), (), catalogue.kind(name.text), faults):
            choices = (
                Choice(choice.text, {(PARTS, index, *where): value for where, value in choice.settings.items()})
                for choice in axis.choices
            )
            yield DrawnParameter(f"{called}.{axis.name}", tuple(choices))


# --- lists and ranges -------------------------------------------------------------------------------


def _axes(node: Node, where: Where, kind: Kind, faults: list[Fault]) -> Iterator[DrawnParameter]:
    """Yield the lists and ranges at places where the model expects one value."""
    forms = allowed_forms(kind, where)
    one_value = "scalar" in forms and bool(where) and where[0] in DRAWN_SECTIONS
    match node:
        case SequenceNode() if one_value and "list" not in forms:
            yield _axis(where, _listed(node, faults))
        case SequenceNode(items):
            for index, item in enumerate(items):
                yield from _axes(item, (*where, index), kind, faults)
        case MappingNode() if one_value and "table" not in forms:
            yield _axis(where, _stepped(node, faults))
        case MappingNode(entries):
            for key, value in entries:
                yield from _axes(value, (*where, key.text), kind, faults)


def _axis(where: Where, values: Sequence[Scalar]) -> DrawnParameter:
    return DrawnParameter(path_text(where), tuple(Choice(value.text, {where: value}) for value in values))


def _listed(node: SequenceNode, faults: list[Fault]) -> tuple[Scalar, ...]:
    """Return the choices of a list."""
    if not node.items:
        faults.append(Fault("too-few", node.location, {"least": "1"}))
    if len(node.items) > MOST_CHOICES:
        faults.append(Fault("too-many", node.location, {"most": str(MOST_CHOICES)}))
        return ()
    values: dict[str, Scalar] = {}
    for item in node.items:
        if not isinstance(item, Scalar) or item.null:
            faults.append(Fault("wrong-type", item.location, {"expected": "text"}))
        elif item.text in values:
            faults.append(Fault("choice-repeated", item.location, {"text": item.text}))
        else:
            values[item.text] = item
    return tuple(values.values())


def _stepped(node: MappingNode, faults: list[Fault]) -> tuple[Scalar, ...]:
    """Return the choices of a range: from, from + step, …, up to `to` inclusive, in the unit of `from`.

    Steps are added as decimal numbers, so that steps of 0.1 give 0.3. Return () if there is a fault.
    """
    ends = list(_ends(node, faults))
    if len(ends) < len(RANGE_KEYS):
        return ()
    first, last, _ = ends
    unit = _LEADING_NUMBER.sub("", first.text.strip().replace("\N{MINUS SIGN}", "-"), count=1)
    numbers = []
    for end in ends:
        try:
            numbers.append(_number(end.text, unit))
        except QuantityFault as fault:
            faults.append(Fault(fault.code, end.location, fault.arguments))
            return ()
    start, stop, step = numbers
    if step <= 0:
        faults.append(Fault("range-step", ends[2].location))
    elif start > stop:
        faults.append(Fault("range-order", first.location, {"last": last.text}))
    elif (stop - start) / step + _DUST >= MOST_CHOICES:
        faults.append(Fault("too-many", node.location, {"most": str(MOST_CHOICES)}))
    else:
        count = int((stop - start) / step + _DUST) + 1
        return tuple(Scalar(f"{_typed(start + k * step)} {unit}".strip(), first.location) for k in range(count))
    return ()


def _ends(node: MappingNode, faults: list[Fault]) -> Iterator[Scalar]:
    """Yield the scalars of from, to and step that exist; add faults for the others."""
    for key, _ in node.entries:
        if key.text not in RANGE_KEYS:
            faults.append(Fault("unknown-key", key.location, {"key": key.text, "known": ", ".join(RANGE_KEYS)}))
    for name in RANGE_KEYS:
        entry = node.find(name)
        if entry is None:
            faults.append(Fault("missing-key", node.location, {"key": name}))
        elif isinstance(entry[1], Scalar) and not entry[1].null:
            yield entry[1]
        else:
            faults.append(Fault("wrong-type", entry[1].location, {"expected": "number"}))


def _number(text: str, unit: str) -> Decimal:
    """Return the number of an end in `unit`; raise `QuantityFault`."""
    number = read_quantity(text, unit).si / read_unit(unit, unit) if unit else read_number(text)
    # Nobody types more than 12 digits, and rounding does not reach them.
    return Decimal(f"{number:.12g}")


def _typed(number: Decimal) -> str:
    """Return a decimal number without exponent and trailing zeros."""
    text = format(number.normalize(), "f")
    return "0" if text in ("-0", "0") else text


# --- the table of variants --------------------------------------------------------------------------


def _rows(file: Path, kind: Kind, base: MappingNode, faults: list[Fault], language: Language) -> tuple[Choice, ...]:
    """Return the rows of a table of variants; raise `AssignmentError` if it cannot be read at all."""
    pages = read(file, language)
    page = next((page for page in pages if any(page.rows)), pages[0])
    start = next(index for index, row in enumerate(page.rows) if row)
    headings = columns(page.rows[start])
    values = [column for column in headings if column.name != "variant"]
    faults += [fault for column in values for fault in _no_place(kind, base, column)]
    places = {column.name: place(kind, column.name) for column in values}
    rows: list[Choice] = []
    names: set[str] = set()
    for row in records(page, headings, start + 1, faults):
        name = row.values["variant"].text if "variant" in row.values else str(len(rows) + 1)
        if name in names:
            faults.append(Fault("choice-repeated", row.location, {"text": name}))
        names.add(name)
        rows.append(Choice(name, {places[key]: value for key, value in row.values.items() if key in places}))
    if not rows:
        faults.append(Fault("empty-roster", headings[0].location))
    return tuple(rows)


def _no_place(kind: Kind, base: MappingNode, column: RosterColumn) -> Iterator[Fault]:
    """Yield the fault of a heading that names no place for a single value, or an item that no list has."""
    where = place(kind, column.name)
    items = [where[: k + 1] for k, step in enumerate(where) if isinstance(step, int)]
    if "scalar" not in allowed_forms(kind, where) or any(at(base, item) is None for item in items):
        known = known_keys(kind, where[:-1])
        hint = close_or_known(str(where[-1]), known) if known else {}
        yield Fault("unknown-column", column.location, {"key": column.name, **hint})


def _given_twice(base: MappingNode, axes: Iterable[DrawnParameter], rows: Iterable[Choice]) -> Iterator[Fault]:
    """Yield faults of values of the spec that a column of the table sets too."""
    drawn = {axis.name for axis in axes}
    for where in dict.fromkeys(where for row in rows for where in row.settings):
        node = at(base, where)
        if node is not None and (path_text(where) in drawn or not (isinstance(node, Scalar) and node.null)):
            yield Fault("not-in-table", node.location, {"key": path_text(where)})


def _unreadable(spec: Spec) -> list[Fault]:
    """Return faults of single values: of the first combination, and of every other choice put into it."""
    if not spec.axes:
        return misread(spec.top, spec.kind)
    if any(not axis.choices for axis in spec.axes):
        return []
    first = assembled(spec.top, spec.settings([0] * len(spec.axes)))
    faults: dict[tuple[str, Location], Fault] = {}
    for axis in spec.axes:
        for choice in axis.choices:
            for fault in misread(assembled(first, choice.settings), spec.kind):
                faults.setdefault((fault.code, fault.location), fault)
    return list(faults.values())
