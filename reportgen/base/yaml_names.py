"""Rename an entry of a table whose keys are names that the user chooses; its value and its comments stay."""

from __future__ import annotations

from reportgen.base.errors import Where
from reportgen.base.yaml_edit import EditError
from reportgen.base.yaml_places import read_nodes
from reportgen.base.yaml_source import MappingNode, plain
from reportgen.base.yaml_values import at, path_text, quoted


def renamed(text: str, where: Where, name: str) -> str:
    """Return the text in which the entry at a place has another name.

    Raises `EditError` if there is no such entry, if the name is empty or in its table already, or if the changed text
    would be read differently.
    """
    above = at(read_nodes(text).top, where[:-1])
    entry = above.find(where[-1]) if isinstance(above, MappingNode) else None
    if entry is None or not isinstance(above, MappingNode):
        raise EditError("nothing", place=path_text(where))
    if not name:
        raise EditError("name_empty")
    if name != where[-1] and above.find(name) is not None:
        raise EditError("name_taken", name=name)
    start, end = entry[0].span
    changed = text[:start] + quoted(name) + text[end:]
    table = at(read_nodes(changed).top, where[:-1])
    wanted = [(name if key.text == where[-1] else key.text, plain(value)) for key, value in above.entries]
    if not isinstance(table, MappingNode) or [(key.text, plain(value)) for key, value in table.entries] != wanted:
        raise EditError("otherwise")
    return changed
