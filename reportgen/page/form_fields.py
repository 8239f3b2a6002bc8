"""Derive the form fields of a file, in order, from the schema at each place and the file's value there.

No field is defined by hand. Unit, bounds, choices and defaults come from the readers of the keys, rules of several keys
from the checks, names and remarks from the words.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from reportgen.assignment import parts
from reportgen.assignment.checks import OneOf
from reportgen.assignment.common import PARTS, Kind
from reportgen.assignment.fields import RANGE_KEY, UNIT_KEY, UNIT_NAME_KEY
from reportgen.assignment.schema import Schema, alternatives, alternatives_to, choices_of, file_schema, places
from reportgen.base.errors import Where
from reportgen.base.field_words import FieldWords, choice_words, field_words, group_titles
from reportgen.base.kinds import titles
from reportgen.base.records import Record, replace
from reportgen.base.units import Language
from reportgen.base.yaml_source import MappingNode, Node, Scalar, SequenceNode, Source
from reportgen.base.yaml_values import at, flow, path_text

SCALARS = {"string", "number", "integer", "boolean", "null"}
NEVER = ("kind",)
"""Keys without a field: another kind would make it another file."""


class FieldLine(Record):
    """A field at one place, on one line; `look` is `text`, `quantity`, `number`, `choice`, `list` or `date`."""

    where: Where
    words: FieldWords
    look: str
    text: str
    there: bool
    required: bool
    choices: tuple[tuple[str, str], ...] = ()
    unit: str = ""
    low: float | None = None
    high: float | None = None
    default: str = ""
    instead: tuple[tuple[str, str], ...] = ()
    """Other keys that can give the same quantity, with their names."""
    most: int | None = None
    """Largest number of items of a list, or None."""
    taken: bool = False
    """True if the text is not in the file: a part takes it from the machine."""
    named: bool = False
    """True if the user chose the key, and may choose another one."""

    @property
    def key(self) -> str:
        return str(self.where[-1])

    @property
    def id(self) -> str:
        return f"f:{path_text(self.where)}"


class FieldGroup(Record):
    """Fields below one title: a section of the file, a group of keys, an item of a list, a part."""

    where: Where
    title: str
    remark: str = ""
    entries: tuple[FieldLine | FieldGroup, ...] = ()
    there: bool = True
    of_list: bool = False
    can_grow: bool = False
    names: str = ""
    """Form of the values in a table whose keys are names that the user chooses: "table" or "value"."""
    required: bool = False
    file: str = ""
    """Separate file of a part."""
    named: bool = False
    """True if the user chose its key, and may choose another one."""

    @property
    def id(self) -> str:
        return f"g:{path_text(self.where)}:{self.title}" if not self.of_list else f"g:{path_text(self.where)}"

    @property
    def present(self) -> tuple[FieldLine | FieldGroup, ...]:
        """Return the entries shown at once: those in the file, and required ones."""
        return tuple(inner for inner in self.entries if inner.there or self._asks_for(inner))

    @property
    def absent(self) -> tuple[FieldLine | FieldGroup, ...]:
        """Return the entries that may be added."""
        return tuple(inner for inner in self.entries if not (inner.there or self._asks_for(inner)))

    def _asks_for(self, inner: FieldLine | FieldGroup) -> bool:
        # A group of keys below a title is in the same table, and is never required as a whole.
        return inner.required and inner.where != self.where


@dataclass(frozen=True)
class Form:
    """Form of a file of one kind in a language."""

    kind: Kind
    language: Language
    top: MappingNode
    own: Node | None = None
    """Nodes of a part's file, without those it takes from the machine."""
    root: Schema = field(init=False)
    words: Mapping[str, FieldWords] = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "root", file_schema(self.kind))
        object.__setattr__(self, "words", field_words(self.kind.name, self.language))

    @property
    def has_parts(self) -> bool:
        """True for a kind that can be the machine of a coursework."""
        return PARTS in self.root["properties"]

    @property
    def groups(self) -> list[FieldGroup]:
        """The sections of the file, the kind's own data first."""
        sections = {key: about for key, about in self.root["properties"].items() if key not in NEVER}
        order = sorted(sections, key=lambda key: (key not in ("parameters", "indicator"), key == PARTS))
        single, groups = [], []
        for key in order:
            made = self._at((key,), key, sections[key], self._node(self.top, key), key in self.root["required"])
            if isinstance(made, FieldGroup):
                groups.append(made)
            elif made is not None:
                single.append(made)
        heads = [group for group in groups if group.where[0] in ("parameters", "indicator")]
        rest = [group for group in groups if group not in heads]
        first = [FieldGroup((), self._words("kind").label, entries=tuple(single))] if single else []
        return [*heads, *first, *rest]

    # --- places

    def _node(self, table: Node | None, key: str) -> Node | None:
        entry = table.find(key) if isinstance(table, MappingNode) else None
        return entry[1] if entry else None

    def _words(self, path: str) -> FieldWords:
        return self.words.get(path, FieldWords(path.rpartition(".")[2]))

    def _at(
        self, where: Where, path: str, about: Schema, node: Node | None, required: bool
    ) -> FieldLine | FieldGroup | None:
        """Return the field or group at a place, from the alternatives of its schema and the node there."""
        allowed = list(alternatives(about, self.root))
        tables = [schema for schema in allowed if "properties" in schema]
        names = [inner for schema in allowed for inner in _by_name(schema)]
        lists = [schema["items"] for schema in allowed if isinstance(schema.get("items"), dict)]
        single = [schema for schema in allowed if _is_single(schema)]
        if where == (PARTS,):
            return self._parts(node)
        if isinstance(node, MappingNode) and tables:
            return replace(self._table(where, path, tables, node), required=required)
        if isinstance(node, MappingNode) and names:
            return replace(self._named(where, path, names, node), required=required)
        if lists and not (single and not isinstance(node, SequenceNode)):
            items = [schema for items in lists for schema in alternatives(items, self.root)]
            if any("properties" in schema for schema in items):
                return replace(self._items(where, path, lists, node), required=required)
            return self._entry(where, path, "list", about, node, required)
        if single:
            return self._entry(where, path, "", about, node, required)
        if tables:
            return self._table(where, path, tables, node)
        if names:
            return replace(self._named(where, path, names, node), required=required)
        return None

    def _table(self, where: Where, path: str, tables: Sequence[Schema], node: Node | None) -> FieldGroup:
        """Return a table in the form that its own keys select; for a missing one, the field that selects its form."""
        tag = tag_of(tables)
        chosen = node.find(tag) if isinstance(node, MappingNode) and tag else None
        value = chosen[1].text if chosen and isinstance(chosen[1], Scalar) else ""
        form = next((schema for schema in tables if schema["properties"].get(tag, {}).get("const") == value), tables[0])
        properties, required = form["properties"], form.get("required", ())
        if tag:
            every = [choice for schema in tables for choice in choices_of(schema["properties"].get(tag, {}))]
            properties = {**properties, tag: {"enum": every}}
            if chosen is None:
                properties = {tag: properties[tag]}
        made = []
        for key in sorted(properties, key=lambda key: self._order(f"{path}.{key}")):
            entry = self._at(
                (*where, key),
                f"{path}.{key}",
                properties[key],
                self._node(node, key),
                key in required and node is not None,
            )
            if entry is not None:
                made.append(entry)
        words = self._words(path)
        there = isinstance(node, MappingNode)
        inner = self._grouped(where, self._one_of(where, made))
        return FieldGroup(where, words.label, words.remark, tuple(inner), there=there)

    def _order(self, path: str) -> int:
        known = list(self.words)
        return known.index(path) if path in self.words else len(known)

    def _one_of(self, where: Where, entries: Sequence[FieldLine | FieldGroup]) -> list[FieldLine | FieldGroup]:
        """Return the entries with only the given one of several equivalent keys.

        It can be switched to the others.
        """
        by_key = {entry.where[-1]: entry for entry in entries}
        values = {entry.key: entry.text for entry in entries if isinstance(entry, FieldLine)}
        kept: list[FieldLine | FieldGroup] = []
        for entry in entries:
            others = [by_key[key] for key in self._alternatives(where, entry, values) if key in by_key]
            if not isinstance(entry, FieldLine) or not others:
                kept.append(entry)
                continue
            standing = [alike for alike in (entry, *others) if alike.there]
            if entry is (standing or [min((entry, *others), key=entries.index)])[0] or entry.there:
                switch = tuple((alike.where[-1], _label(alike)) for alike in others if isinstance(alike, FieldLine))
                kept.append(
                    _with_switch(entry, tuple((str(key), label) for key, label in switch), self._must(where, entry))
                )
        return kept

    def _alternatives(self, where: Where, entry: FieldLine | FieldGroup, values: Mapping[str, str]) -> list[str]:
        """Return the other keys with the same meaning, in the form that the `values` of the table choose."""
        path = tuple(str(step) for step in where if not isinstance(step, int))
        return alternatives_to(self.kind, (*path, str(entry.where[-1])), values)

    def _must(self, where: Where, entry: FieldLine) -> bool:
        """Return True if one of several equivalent keys is required there."""
        checks = (check for check in self.kind.all_checks if isinstance(check, OneOf) and check.where == where)
        return any(entry.key in check.names and check.required for check in checks)

    def _grouped(self, where: Where, entries: Sequence[FieldLine | FieldGroup]) -> Iterator[FieldLine | FieldGroup]:
        """Yield the entries of a table below the titles of their groups, if the words define any."""
        present = {self._title(entry) for entry in entries}
        titles = [title for title in ("", *group_titles(self.language)) if title in present]
        if len(where) > 1 or len(titles) < 2:
            yield from entries
            return
        for title in titles:
            inner = tuple(entry for entry in entries if self._title(entry) == title)
            there = any(entry.there or (entry.required and isinstance(entry, FieldLine)) for entry in inner)
            if title:
                yield FieldGroup(where, title, entries=inner, there=there, required=True)
            else:
                yield from inner

    def _title(self, entry: FieldLine | FieldGroup) -> str:
        path = ".".join(str(step) for step in entry.where if not isinstance(step, int))
        return self._words(path).group

    def _named(self, where: Where, path: str, names: Sequence[Schema], node: Node | None) -> FieldGroup:
        """Return a table whose keys are names that the user chooses."""
        words = self._words(path)
        made: list[FieldLine | FieldGroup] = []
        for key, value in node.entries if isinstance(node, MappingNode) else ():
            entry = self._at((*where, key.text), path, {"anyOf": list(names)}, value, True)
            if isinstance(entry, FieldGroup):
                made.append(FieldGroup(entry.where, key.text, entries=entry.entries, of_list=True, named=True))
            elif isinstance(entry, FieldLine):
                made.append(_called(entry, key.text))
        form = (
            "table" if any("properties" in one for name in names for one in alternatives(name, self.root)) else "value"
        )
        there = isinstance(node, MappingNode)
        return FieldGroup(where, words.label, words.remark, tuple(made), there=there, names=form)

    def _items(self, where: Where, path: str, lists: Sequence[Schema], node: Node | None) -> FieldGroup:
        words = self._words(path)
        made = []
        for index, item in enumerate(node.items if isinstance(node, SequenceNode) else ()):
            entry = self._at((*where, index), path, {"anyOf": list(lists)}, item, True)
            if isinstance(entry, FieldGroup):
                made.append(FieldGroup(entry.where, str(index + 1), entries=entry.entries, of_list=True))
        return FieldGroup(
            where, words.label, words.remark, tuple(made), there=isinstance(node, SequenceNode), can_grow=True
        )

    def _parts(self, node: Node | None) -> FieldGroup:
        """Return the parts of a coursework: each as the form of its own kind, one in a separate file by its name."""
        from reportgen import catalogue

        words, made = self._words(PARTS), []
        for index, item in enumerate(node.items if isinstance(node, SequenceNode) else ()):
            where: Where = (PARTS, index)
            if not isinstance(item, MappingNode):
                continue
            file, kind = (self._node(item, key) for key in ("file", "kind"))
            if isinstance(file, Scalar) and not file.null:
                title = self._node(item, "title")
                called = title.text if isinstance(title, Scalar) and not title.null else file.text
                entries = tuple(self._about(where, item))
                made.append(FieldGroup(where, called, entries=entries, file=file.text, of_list=True))
            elif isinstance(kind, Scalar) and catalogue.is_sound(kind.text):
                given = parts.taking(Source("", top=item), self.top, index, catalogue.kind).top
                assert isinstance(given, MappingNode), "entries that are taken from the machine are put into the table"
                inner = Form(catalogue.kind(kind.text), self.language, given, item)
                data = (group for group in inner.groups if group.where[:1] == ("parameters",))
                entries = (
                    *self._about(where, item),
                    *(_below(entry, where) for group in data for entry in group.entries),
                )
                called = f"{index + 1}. {titles(self.language)[kind.text]}"
                made.append(FieldGroup(where, called, entries=entries, of_list=True))
        return FieldGroup((PARTS,), words.label, words.remark, tuple(made), there=bool(made), can_grow=True)

    def _about(self, where: Where, item: MappingNode) -> Iterator[FieldLine | FieldGroup]:
        """Yield the title of a part, and what it takes from the machine or gives it."""
        (table,) = (schema for schema in places(self.root, self.root, where) if "properties" in schema)
        for key in ("title", "from", "gives"):
            path, node = f"{PARTS}.{key}", self._node(item, key)
            entry = self._at((*where, key), path, table["properties"][key], node, False)
            if isinstance(entry, FieldLine) or (entry is not None and entry.there):
                yield entry

    # --- one line

    def _entry(self, where: Where, path: str, look: str, about: Schema, node: Node | None, required: bool) -> FieldLine:
        allowed = list(alternatives(about, self.root))
        facts = _facts(allowed)
        choices = list(dict.fromkeys(choice for schema in allowed for choice in choices_of(schema)))
        words = choice_words(self.language) if choices else {}
        free = any(_is_single(schema) and not choices_of(schema) and schema.get("type") != "null" for schema in allowed)
        if not look:
            look = "quantity" if facts.get("unit") else "choice" if choices and not free else facts.get("look", "text")
        default = about.get("default")
        return FieldLine(
            where=where,
            words=self._words(path),
            look=look,
            text=written_at(node),
            there=node is not None,
            required=required,
            choices=tuple((choice, words.get(choice, choice)) for choice in choices),
            unit=facts.get("unit", ""),
            low=facts.get("low"),
            high=facts.get("high"),
            default="" if default is None or isinstance(default, list | dict) else _spelled(default),
            most=next((schema["maxItems"] for schema in allowed if "maxItems" in schema), None),
            taken=self.own is not None and node is not None and at(self.own, where) is None,
        )


def _label(entry: FieldLine) -> str:
    return entry.words.label


def _with_switch(entry: FieldLine, instead: tuple[tuple[str, str], ...], required: bool) -> FieldLine:
    return replace(entry, instead=instead, required=entry.required or required)


def _called(entry: FieldLine, name: str) -> FieldLine:
    return replace(entry, words=FieldWords(name), required=False, named=True)


def _below(inner: Any, where: Where) -> Any:
    """Return a group or an entry moved to a place below another one."""
    if isinstance(inner, FieldGroup):
        entries = tuple(_below(entry, where) for entry in inner.entries)
        return replace(inner, where=(*where, *inner.where), entries=entries)
    return replace(inner, where=(*where, *inner.where))


def _is_single(schema: Schema) -> bool:
    types = schema.get("type", "string" if "const" in schema or "enum" in schema else "")
    return bool(set(types if isinstance(types, list) else [types]) & (SCALARS - {"null"}))


def _by_name(schema: Schema) -> Iterator[Schema]:
    if "properties" not in schema:
        if isinstance(schema.get("additionalProperties"), dict):
            yield schema["additionalProperties"]
        yield from schema.get("patternProperties", {}).values()


def tag_of(tables: Sequence[Schema]) -> str:
    """Return the key whose value distinguishes tables of several forms; "" if there is one form."""
    if len(tables) < 2:
        return ""
    keys = [key for key, about in tables[0]["properties"].items() if "const" in about]
    return keys[0] if keys else ""


def _facts(allowed: Sequence[Schema]) -> dict[str, Any]:
    """Return unit, bounds and look of a line from the alternatives at its place."""
    for schema in allowed:
        if UNIT_KEY in schema:
            return {"unit": schema[UNIT_KEY], **_bounds(schema.get(RANGE_KEY, {}))}
    for schema in allowed:
        if schema.get("type") in ("number", "integer"):
            return {"look": "number", **_bounds(schema)}
        if schema.get("format") == "date":
            return {"look": "date"}
        if UNIT_NAME_KEY in schema:
            return {"look": "text"}
    return {}


def _bounds(schema: Mapping[str, float]) -> dict[str, float | None]:
    low, high = schema.get("minimum"), schema.get("maximum")
    return {
        "low": schema.get("exclusiveMinimum") if low is None else low,
        "high": schema.get("exclusiveMaximum") if high is None else high,
    }


def written_at(node: Node | None) -> str:
    """Return the value at a place as it is typed there."""
    match node:
        case Scalar(text, null=null):
            return "" if null else text
        case SequenceNode():
            return flow(node)[1:-1]
        case MappingNode():
            return flow(node)
        case _:
            return ""


def _spelled(default: object) -> str:
    return str(default).lower() if isinstance(default, bool) else str(default)
