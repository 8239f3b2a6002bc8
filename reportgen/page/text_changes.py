"""Apply a change that a form asks for to the text of a file: `changed_text`."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from typing import Any

from reportgen import catalogue
from reportgen.base.errors import Location, Where
from reportgen.base.kinds import program_kinds
from reportgen.base.records import replace
from reportgen.base.template_folders import REFERENCE
from reportgen.base.yaml_edit import exchanged, with_value
from reportgen.base.yaml_lists import with_items
from reportgen.base.yaml_names import renamed
from reportgen.base.yaml_remarks import removed, renumbered
from reportgen.base.yaml_source import MappingNode, Node, Scalar, SequenceNode, read_own, read_text
from reportgen.base.yaml_values import at
from reportgen.page.form_choices import with_choice, with_instead
from reportgen.page.typed_values import value_node

HERE = Location("")
PART_KEYS = "kind", "parameters"
"""Keys with which a new part begins."""


def changed_text(text: str, operation: str, where: Where, asked: Mapping[str, Any]) -> str:
    """Return the text with a change; raise `EditError`, `KeyError` or `ValueError`."""
    match operation:
        case "set":
            value, as_items = str(asked["value"]), bool(asked.get("list"))
            chosen = None if as_items else with_choice(text, where, value)
            if chosen is not None:
                return chosen
            new = value_node(text, where, value, as_items)
            return with_items(text, where, new) if isinstance(new, SequenceNode) else with_value(text, where, new)
        case "remove":
            return removed(text, where)
        case "rename":
            return renamed(text, where, str(asked["name"]).strip())
        case "instead":
            return with_instead(text, where, str(asked["key"]), str(asked.get("value", "")))
        case "add" if "name" in asked:
            return with_value(text, (*where, str(asked["name"])), _named(bool(asked.get("table"))))
        case "add":
            listed = at(read_text(text).top, where)
            count = len(listed.items) if isinstance(listed, SequenceNode) else 0
            if listed is None or (isinstance(listed, Scalar) and listed.null):
                # What was set aside from the items of an earlier list belongs to none of this one.
                return renumbered(with_value(text, where, SequenceNode((_item(asked),), HERE)), where, lambda _: None)
            return with_value(text, (*where, count), _item(asked))
        case "move":
            first = int(asked["first"])
            numbers = {first: first + 1, first + 1: first}
            return renumbered(exchanged(text, where, first), where, lambda number: numbers.get(number, number))
    raise ValueError(operation)


def _item(asked: Mapping[str, Any]) -> Node:
    """Return a new item of a list: a part with the first data of its kind, else an empty table."""
    if "kind" not in asked:
        return MappingNode((), HERE)
    kind = str(asked["kind"])
    if kind not in part_kinds():
        raise ValueError(kind)
    top = read_own(catalogue.starter(kind, REFERENCE)).top
    assert isinstance(top, MappingNode), "a file to begin with is in order"
    return replace(top, entries=tuple(entry for entry in top.entries if entry[0].text in PART_KEYS))


def _named(table: bool) -> Node:
    """Return the value with which an entry of a table of names begins."""
    return MappingNode((), HERE) if table else Scalar("", HERE, null=True)


@cache
def part_kinds() -> tuple[str, ...]:
    """Return the kinds that can be a part of a coursework."""
    return tuple(kind for kind in program_kinds() if catalogue.kind(kind).part)
