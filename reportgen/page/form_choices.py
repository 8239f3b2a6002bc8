"""Choose another form of a table, or another key for the same quantity.

The keys of the old choice that the new one does not have become comments, and those of the new choice that are comments
become keys again.
"""

from __future__ import annotations

from collections.abc import Sequence

from reportgen import catalogue
from reportgen.assignment.checks import OneOf
from reportgen.assignment.common import PARTS, Kind
from reportgen.assignment.fields import UNIT_KEY
from reportgen.assignment.schema import Schema, alternatives, file_schema, places, tables_at
from reportgen.base.errors import Location, Where
from reportgen.base.records import Record
from reportgen.base.yaml_comments import CommentedEntry, remarks
from reportgen.base.yaml_edit import EditError, with_value
from reportgen.base.yaml_places import content_end, is_flow, line_end, line_start, newline, read_nodes
from reportgen.base.yaml_remarks import restored, set_aside
from reportgen.base.yaml_source import MappingNode, Node, Scalar, SequenceNode
from reportgen.base.yaml_values import at, entry_text, path_text
from reportgen.page.form_fields import tag_of
from reportgen.page.typed_values import converted

HERE = Location("")
SHAPES = {"object": MappingNode, "array": SequenceNode}


class Forms(Record):
    """The forms that a table may have; the value at the key `tag` says which."""

    root: Schema
    tag: str
    tables: Sequence[Schema]

    def form(self, value: str) -> Schema | None:
        """Return the form of a value of the tag; None if there is none."""
        return next((table for table in self.tables if table["properties"][self.tag].get("const") == value), None)

    def suits(self, form: Schema | None, key: str, node: Node) -> bool:
        """Return True if a form has a key, with a value of this shape: a table, a list, or a text."""
        about = form["properties"].get(key) if form else None
        if about is None:
            return False
        types = [one.get("type", "string") for one in alternatives(about, self.root)]
        shapes = {
            SHAPES.get(name, Scalar) for type_ in types for name in (type_ if isinstance(type_, list) else [type_])
        }
        return type(node) in shapes or (isinstance(node, Scalar) and node.null)

    def mark_of(self, key: str, chosen: str) -> str:
        """Return the mark of a key that is set aside: the chosen form, or else the first one that has the key."""
        value = chosen
        if key not in (self.form(chosen) or self.tables[0])["properties"]:
            having = (table["properties"][self.tag]["const"] for table in self.tables if key in table["properties"])
            value = next(having, chosen)
        return f"{self.tag}: {value}"


def with_choice(text: str, where: Where, value: str) -> str | None:
    """Return the text with another form of the table that has the key `where`; None if that key is no such choice."""
    top = read_nodes(text).top
    table, (kind, inner) = at(top, where[:-1]), _kind_at(top, where)
    forms = None if kind is None else _forms_at(kind, inner)
    if not isinstance(table, MappingNode) or forms is None or forms.form(value) is None:
        return None
    entry = table.find(where[-1])
    chosen = entry[1].text if entry and isinstance(entry[1], Scalar) else ""
    text = with_value(text, where, Scalar(value, HERE))
    known = {key for form in forms.tables for key in form["properties"]} - {forms.tag}
    for key, node in table.entries:
        if key.text in known and not forms.suits(forms.form(value), key.text, node):
            text = set_aside(text, (*where[:-1], key.text), forms.mark_of(key.text, chosen))
    return _with_returning(text, where[:-1], forms, value)


def _with_returning(text: str, where: Where, forms: Forms, value: str) -> str:
    """Return the text with the keys of a form that are comments as keys: marked ones, and those that it requires."""
    form, mark = forms.form(value), f"{forms.tag}: {value}"
    assert form is not None, "the value is one of the choices"
    while True:
        table = at(read_nodes(text).top, where)
        assert isinstance(table, MappingNode), "the key that chooses has been put into it"
        open_keys = form["properties"].keys() - {key.text for key, _ in table.entries}
        noted = [note for note in remarks(text, where) if note.key in open_keys]
        fitting = [note for note in noted if forms.suits(form, note.key, note.value)]
        marked = [note for note in fitting if note.mark == mark]
        unmarked = [note for note in fitting if note.key in form.get("required", ()) and _is_unmarked(note, forms)]
        if not (marked or unmarked):
            return text
        text = restored(text, where, (marked or unmarked)[0], mark)


def _is_unmarked(remark: CommentedEntry, forms: Forms) -> bool:
    return not any(remark.mark == f"{forms.tag}: {table['properties'][forms.tag]['const']}" for table in forms.tables)


def _forms_at(kind: Kind, where: Where) -> Forms | None:
    """Return the forms of the table whose key `where` selects one; None if it does not."""
    root = file_schema(kind)
    tables = tables_at(root, root, where[:-1])
    return Forms(root, str(where[-1]), tables) if tag_of(tables) == where[-1] else None


def _kind_at(top: Node | None, where: Where) -> tuple[Kind | None, Where]:
    """Return the kind to whose file a place belongs, and the place in that: a part has a kind of its own."""
    if where[:1] == (PARTS,) and len(where) > 3:
        top, where = at(top, where[:2]), where[2:]
    name = at(top, ("kind",))
    known = isinstance(name, Scalar) and catalogue.is_sound(name.text)
    return (catalogue.kind(name.text) if known and isinstance(name, Scalar) else None), where


# --- keys with the same meaning ---------------------------------------------------------------------------


def with_instead(text: str, where: Where, key: str, value: str = "") -> str:
    """Return the text with another key for the same quantity, and every key that excludes it as a comment.

    Without a `value`, the new key has the old one in its own unit; if that is impossible, the value of its comment, or
    none. Keys that the old one has excluded come back.
    """
    top = read_nodes(text).top
    table, (kind, inner) = at(top, where[:-1]), _kind_at(top, where)
    entry = table.find(where[-1]) if isinstance(table, MappingNode) else None
    checks = (
        [] if kind is None else [one for one in kind.all_checks if isinstance(one, OneOf) and one.where == inner[:-1]]
    )
    if entry is None or not isinstance(table, MappingNode) or table.find(key) or not _excluded(checks, key, where[-1]):
        raise EditError("not_instead", place=path_text(where), key=key)
    assert kind is not None, "a file without a kind has no checks"
    same = value or _in_unit(kind, (*inner[:-1], key), entry[1])
    noted = [one for one in remarks(text, where[:-1]) if one.key == key]
    kept = next((one for one in noted if value == "" and _is_same(one.value, same)), None)
    above = where[:-1]
    text = restored(text, above, kept) if kept is not None else _beside(text, where, key, same)
    for excluded in [name.text for name, _ in table.entries if _excluded(checks, key, name.text)]:
        text = set_aside(text, (*above, excluded))
    return _with_required(text, above, checks)


def _excluded(checks: Sequence[OneOf], key: str, second: object) -> bool:
    """Return True if a table may not have both keys."""
    return second != key and any(key in check.names and second in check.names for check in checks)


def _in_unit(kind: Kind, where: Where, node: Node) -> str:
    root = file_schema(kind)
    units = [schema[UNIT_KEY] for schema in places(root, root, where) if UNIT_KEY in schema]
    text = node.text if isinstance(node, Scalar) else ""
    return next(filter(None, (converted(text, unit) for unit in units)), "")


def _is_same(node: Node, wanted: str) -> bool:
    """Return True if a value is the wanted one to three figures; any value is, if none is wanted."""
    unit = wanted.partition(" ")[2]
    return not wanted or (isinstance(node, Scalar) and converted(node.text, unit) == wanted)


def _beside(text: str, where: Where, key: str, value: str) -> str:
    """Return the text with another key on the line below an entry, or where its table has it as a comment."""
    node, above = Scalar(value, HERE, null=not value), where[:-1]
    table = at(read_nodes(text).top, above)
    assert isinstance(table, MappingNode), "it has the entry"
    entry = table.find(where[-1])
    if entry is None or is_flow(text, table) or any(one.key == key for one in remarks(text, above)):
        return with_value(text, (*above, key), node)
    begin = entry[0].span[0]
    end = line_end(text, content_end(text, max(entry[1].span[1], entry[0].span[1])))
    head = text[:end] if text[:end].endswith("\n") else text[:end] + newline(text)
    line = entry_text(Scalar(key, HERE), node, begin - line_start(text, begin)).replace("\n", newline(text))
    return head + line + text[end:]


def _with_required(text: str, where: Where, checks: Sequence[OneOf]) -> str:
    """Return the text with a comment as a key again for every rule that asks for one of several keys and has none."""
    for check in checks:
        table = at(read_nodes(text).top, where)
        assert isinstance(table, MappingNode), "a key has just been put into it"
        if not check.required or any(table.find(name) for name in check.names):
            continue
        for remark in [one for one in remarks(text, where) if one.key in check.names][:1]:
            text = restored(text, where, remark)
    return text
