"""Change one thing in a YAML text: a value, a key, an item. Every other character stays unchanged.

The result is parsed again before it is returned, and must have the intended content. A key that is in its table as
a comment (`# G3: 200 N`) is uncommented; otherwise a new key is added in the style of its table.
"""

from __future__ import annotations

from itertools import pairwise
from typing import Any

from reportgen.base.errors import Where
from reportgen.base.yaml_comments import remarks, uncommented
from reportgen.base.yaml_places import (
    behind,
    column_of,
    content_end,
    ends_in_braces,
    entry_start,
    is_flow,
    line_end,
    line_start,
    more_in_brackets,
    newline,
    read_nodes,
    without_in_braces,
)
from reportgen.base.yaml_source import MappingNode, Node, Scalar, SequenceNode, Span, plain, read_text
from reportgen.base.yaml_values import at, entry_text, flow, item_lines, path_text, quoted

SHOWN = 60
"""Largest number of typed characters that a message repeats."""


class EditError(ValueError):
    """A change that is impossible in a text; has the key of the message and its arguments."""

    def __init__(self, key: str, /, **arguments: str) -> None:
        super().__init__(key)
        self.key, self.arguments = key, arguments


def with_value(text: str, where: Where, value: Node) -> str:
    """Return the text with a value at a place, inserted if there is none; a list takes one more item at its end.

    Raises `EditError` for a text that is not a table, and if the changed text would be read differently.
    """
    top = _top(text)
    node = at(top, where)
    if node is not None:
        changed = _replaced(text, node, value)
        return _checked(changed, where, value, top)
    above, rest = _above(top, where)
    inner = _within(rest[1:], value)
    if isinstance(above, SequenceNode) and rest == (len(above.items),):
        return _checked(_with_item(text, above, value), where, value, top)
    if any(isinstance(step, int) for step in rest):
        raise EditError("no_list", place=path_text(where))
    if isinstance(above, MappingNode):
        key = str(rest[0])
        if (returned := _from_remark(text, top, where[: -len(rest)], rest, value)) is not None:
            return returned
        return _checked(_with_entry(text, above, key, inner), where, value, top)
    # An empty value or a single value becomes a table.
    return _checked(_replaced(text, above, _within(rest, value)), where, value, top)


def without(text: str, where: Where) -> str:
    """Return the text without a key or an item.  A key and value in one line become a comment.

    Raises `EditError` if there is nothing at that path.
    """
    top = _top(text)
    above, node = at(top, where[:-1]), at(top, where)
    if node is None or not isinstance(above, MappingNode | SequenceNode):
        raise EditError("nothing", place=path_text(where))
    wanted = _less(plain(top), where)
    start = entry_start(above, where[-1], node)
    if is_flow(text, above):
        return _agreeing(without_in_braces(text, above, where[-1]), wanted)
    begins, ends = line_start(text, start), line_end(text, content_end(text, node.span[1]))
    if isinstance(above, SequenceNode) or text.count("\n", start, node.span[1]):
        # Comments below an item that are deeper than its dash belong to it, and those in a table to that.
        ends = behind(text, node.span[1], column_of(text, above.span[0]))
    head = text[begins:start]
    if isinstance(above, SequenceNode) or text.count("\n", start, node.span[1]) or head.strip():
        if len(above.items if isinstance(above, SequenceNode) else above.entries) == 1:
            return _agreeing(_emptied(text, top, where, (begins, ends)), wanted)
        if head.strip(" -"):
            raise EditError("same_line", place=path_text(where))
        if head.strip() and isinstance(above, MappingNode):
            # The first key of an item in block form follows its dash.
            return _agreeing(text[:start] + _moved_up(text, above, ends), wanted)
        return _agreeing(text[:begins] + text[ends:], wanted)
    return _agreeing(f"{text[:start]}# {text[start:]}", wanted)


def _emptied(text: str, top: MappingNode, where: Where, lines: Span) -> str:
    """Return the text without the `lines` of an only entry: an empty list says so, an empty table is an empty key."""
    begins, ends = lines
    above, outer = at(top, where[:-1]), at(top, where[:-2])
    if above is top:
        return text[:begins] + text[ends:]
    entry = outer.find(where[-2]) if isinstance(outer, MappingNode) else None
    if entry is None:
        raise EditError("same_line", place=path_text(where))
    colon = text.index(":", entry[0].span[1]) + 1
    empty = " []" if isinstance(above, SequenceNode) else ""
    return text[:colon] + empty + text[colon:begins] + text[ends:]


def _moved_up(text: str, table: MappingNode, ends: int) -> str:
    """Return the text from the second entry of a table on, with what is between it and `ends`, where the first one
    ends, after it.
    """
    key, value = table.entries[1]
    until = line_end(text, content_end(text, max(value.span[1], key.span[1])))
    between = text[ends : line_start(text, key.span[0])]
    if not between.strip():
        return text[key.span[0] :]
    entry = text[key.span[0] : until]
    return entry + ("" if entry.endswith("\n") else newline(text)) + between + text[until:]


def exchanged(text: str, where: Where, first: int) -> str:
    """Return the text with the item `first` of the list at a path moved after its successor; raises `EditError`."""
    top = _top(text)
    listed = at(top, where)
    if not isinstance(listed, SequenceNode) or not 0 <= first < len(listed.items) - 1:
        raise EditError("nothing", place=path_text((*where, first + 1)))
    (a, b), (c, d) = (item.span for item in listed.items[first : first + 2])
    if not is_flow(text, listed):
        b, d = (content_end(text, behind(text, end, column_of(text, listed.span[0]))) for end in (b, d))
    changed = text[:a] + text[c:d] + text[b:c] + text[a:b] + text[d:]
    wanted = plain(top)
    items = _get(wanted, where)
    items[first : first + 2] = items[first : first + 2][::-1]
    return _agreeing(changed, wanted)


def as_list(text: str) -> SequenceNode:
    """Parse text typed for a list, `1, 2` or `[0, 5 mm], [1, 2]`, into a node; raises `EditError`."""
    source = read_text(f"[{text}]")
    if isinstance(source.top, SequenceNode) and not source.faults:
        return source.top
    raise EditError("not_list", text=text if len(text) <= SHOWN else text[:SHOWN] + "…")


# --- places in the text -------------------------------------------------------------------------------


def _top(text: str) -> MappingNode:
    source = read_nodes(text)
    if not isinstance(source.top, MappingNode):
        raise EditError("no_table")
    return source.top


def _above(top: MappingNode, where: Where) -> tuple[Node, Where]:
    """Return the deepest node on the way to a place, and the steps that are left from there."""
    node: Node = top
    for depth, _ in enumerate(where):
        inner = at(top, where[: depth + 1])
        if inner is None:
            return node, where[depth:]
        node = inner
    return node, ()


def _within(keys: Where, value: Node) -> Node:
    """Return a value in as many tables as there are keys."""
    for key in reversed(keys):
        value = MappingNode(((Scalar(str(key), value.location), value),), value.location)
    return value


# --- changes --------------------------------------------------------------------------------------------


def replacement(text: str, node: Node, value: Node) -> tuple[int, int, str]:
    """Return begin and end of the text of a node, and the text of another value in its place."""
    start, end = node.span[0], content_end(text, node.span[1])
    in_marks = isinstance(node, Scalar) and node.quoted
    new = quoted(value.text, in_marks or value.quoted) if isinstance(value, Scalar) and not value.null else flow(value)
    # An empty value is right behind its colon.
    gap = " " if start == end and new and not text[start - 1].isspace() else ""
    return start, end, gap + new


def _replaced(text: str, node: Node, value: Node) -> str:
    start, end, new = replacement(text, node, value)
    return text[:start] + new + text[end:]


def _with_item(text: str, listed: SequenceNode, value: Node) -> str:
    if is_flow(text, listed):
        return _with_more(text, listed, flow(value))
    dash = column_of(text, listed.span[0])
    end = behind(text, listed.span[1], dash)
    head = text[:end] if text[:end].endswith("\n") else text[:end] + newline(text)
    lines = "".join(f"{line}{newline(text)}" for line in item_lines(value, dash))
    return head + lines + text[end:]


def _with_more(text: str, above: MappingNode | SequenceNode, entry: str) -> str:
    """Return the text with one more entry in brackets, behind the last one and the comment in its line."""
    end, closing = ends_in_braces(above), above.span[1] - 1
    if end == above.span[0] + 1:
        return text[:end] + entry + text[end:]
    last = above.items[-1] if isinstance(above, SequenceNode) else above.entries[-1][0]
    before, after = more_in_brackets(text, last.span[0], text[end:closing])
    return text[:end] + before + entry + after + text[closing:]


def _with_entry(text: str, table: MappingNode, key: str, value: Node) -> str:
    """Return the text with one more entry of a table, behind its last one."""
    if is_flow(text, table):
        return _with_more(text, table, f"{quoted(key)}: {flow(value)}")
    depth = column_of(text, table.span[0])
    end = behind(text, table.span[1], depth)
    lines = entry_text(Scalar(key, value.location), value, depth).replace("\n", newline(text))
    head = text[:end] if text[:end].endswith("\n") else text[:end] + newline(text)
    return head + lines + text[end:]


def _from_remark(text: str, top: MappingNode, above: Where, rest: Where, value: Node) -> str | None:
    """Return the text with a value at a key that the table `above` has as a comment; None if it has no such comment."""
    table = at(top, above)
    if not isinstance(table, MappingNode) or is_flow(text, table):
        return None
    for remark in remarks(text, above):
        # What is set aside for another choice is left to that; the choice is a key of the table.
        if remark.key != rest[0] or table.find(remark.mark.partition(":")[0]):
            continue
        try:
            changed = with_value(uncommented(text, remark), (*above, *rest), value)
        except EditError:
            continue
        if _only_more(plain(top), plain(_top(changed))):
            return changed
    return None


def _only_more(old: Any, new: Any) -> bool:
    """Return True if a content has everything that another one has, and perhaps more keys."""
    if isinstance(old, dict) and isinstance(new, dict):
        return all(key in new and _only_more(value, new[key]) for key, value in old.items())
    return bool(old == new)


# --- checking the result ----------------------------------------------------------------------------------


def _get(content: Any, where: Where) -> Any:
    for step in where:
        content = content[step]
    return content


def _less(content: Any, where: Where) -> Any:
    """Return a content without the value at a place; a table that becomes empty becomes None."""
    above = _get(content, where[:-1])
    del above[where[-1]]
    if not above and isinstance(above, dict) and where[:-1]:
        _get(content, where[:-2])[where[-2]] = None
    return content


def _agreeing(text: str, wanted: Any) -> str:
    if _bare(plain(_top(text))) != _bare(wanted):
        raise EditError("otherwise")
    return text


def _bare(content: Any) -> Any:
    """Return a content in which empty tables are None."""
    if isinstance(content, dict):
        return {key: _bare(value) for key, value in content.items()} or None
    return [_bare(item) for item in content] if isinstance(content, list) else content


def _checked(text: str, where: Where, value: Node, top: MappingNode) -> str:
    """Return the changed text, if it has the value at its place and all else as before."""
    source = read_nodes(text)
    wanted = plain(top)
    _put(wanted, where, plain(value))
    if source.top is None or plain(source.top) != wanted:
        raise EditError("otherwise")
    return text


def _put(content: Any, where: Where, value: Any) -> None:
    for step, following in pairwise(where):
        inner = content[step] if isinstance(step, int) or step in content else None
        if not isinstance(inner, dict | list):
            content[step] = inner = {}
        content = inner
        assert isinstance(content, list) == isinstance(following, int), "lists have items, tables keys"
    if isinstance(content, list) and where[-1] == len(content):
        content.append(value)
    else:
        content[where[-1]] = value
