"""Nodes of an assignment file put together anew: what came from where keeps its place."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace

from reportgen.assignment.faults import Where
from reportgen.assignment.source import List, Node, Scalar, Table


def at(node: Node | None, where: Where) -> Node | None:
    """The node at a place; None if there is none."""
    for step in where:
        if isinstance(node, Table):
            entry = node.find(step)
            node = entry[1] if entry else None
        elif isinstance(node, List) and isinstance(step, int) and step < len(node.items):
            node = node.items[step]
        else:
            return None
    return node


def put(node: Node, where: Where, value: Node) -> Node:
    """The node with `value` at a place; tables on the way there are made, lists are not made longer."""
    if not where:
        return value
    step, rest = where[0], where[1:]
    if isinstance(node, List):
        items = tuple(put(item, rest, value) if k == step else item for k, item in enumerate(node.items))
        return replace(node, items=items)
    entries = node.entries if isinstance(node, Table) else ()
    names = [key.text for key, _ in entries]
    if step not in names:
        entries = (*entries, (Scalar(str(step), value.mark), Table((), value.mark)))
    changed = tuple((key, put(old, rest, value) if key.text == step else old) for key, old in entries)
    return Table(changed, node.mark)


def without(table: Table, keys: Collection[str]) -> Table:
    """The table without some of its keys."""
    return replace(table, entries=tuple(entry for entry in table.entries if entry[0].text not in keys))


def path_text(where: Where) -> str:
    """A place as it is written: parameters.H, parameters.groups.0.length."""
    return ".".join(map(str, where))
