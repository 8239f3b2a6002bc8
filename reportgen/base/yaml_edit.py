"""Change one thing in a YAML text: a value, a key, an item. Every other character stays unchanged.

The result is parsed again before it is returned, and must have the intended content. A key that is in its table as
a comment (`# G3: 200 N`) is uncommented; otherwise a new key is added in the style of its table.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from itertools import pairwise
from typing import Any

from reportgen.base.errors import Where
from reportgen.base.yaml_places import (
    behind,
    content_end,
    ends_in_braces,
    entry_start,
    is_flow,
    line_end,
    line_start,
    newline,
    read_nodes,
    unmarked,
    without_in_braces,
)
from reportgen.base.yaml_source import MappingNode, Node, Scalar, SequenceNode, plain, read_text
from reportgen.base.yaml_values import at, entry_text, flow, item_lines, path_text, quoted

_REMARK = re.compile(r"#[ \t]?(?P<entry>(?P<key>[^\s:#][^:#]*):(?:[ \t].*)?)$")

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
        if (uncommented := _from_remark(text, top, above, rest, value)) is not None:
            return uncommented
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
    if isinstance(above, SequenceNode):
        # Comments below an item that are deeper than its dash belong to it.
        ends = behind(text, node.span[1], _dash(text, above))
    head = text[begins:start]
    if isinstance(above, SequenceNode) or text.count("\n", start, node.span[1]) or head.strip():
        if len(above.items if isinstance(above, SequenceNode) else above.entries) == 1:
            # Nothing is left: an empty list says so, an empty table is an empty key.
            empty = " []" if isinstance(above, SequenceNode) else ""
            key_end = text.rindex(":", 0, above.span[0]) + 1
            end = content_end(text, above.span[1])
            if isinstance(above, SequenceNode):
                end = max(end, content_end(text, ends))
            return _agreeing(text[:key_end] + empty + text[end:], wanted)
        if head.strip(" -"):
            raise EditError("same_line", place=path_text(where))
        if head.strip() and isinstance(above, MappingNode):
            # The first key of an item in block form follows its dash.
            following = above.entries[1][0].span[0]
            return _agreeing(text[:start] + text[following:], wanted)
        return _agreeing(text[:begins] + text[ends:], wanted)
    return _agreeing(f"{text[:start]}# {text[start:]}", wanted)


def exchanged(text: str, where: Where, first: int) -> str:
    """Return the text with the item `first` of the list at a path moved after its successor; raises `EditError`."""
    top = _top(text)
    listed = at(top, where)
    if not isinstance(listed, SequenceNode) or not 0 <= first < len(listed.items) - 1:
        raise EditError("nothing", place=path_text((*where, first + 1)))
    (a, b), (c, d) = (item.span for item in listed.items[first : first + 2])
    if not is_flow(text, listed):
        b, d = (content_end(text, behind(text, end, _dash(text, listed))) for end in (b, d))
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


def _replaced(text: str, node: Node, value: Node) -> str:
    start, end = node.span[0], content_end(text, node.span[1])
    in_marks = isinstance(node, Scalar) and node.quoted
    new = quoted(value.text, in_marks or value.quoted) if isinstance(value, Scalar) and not value.null else flow(value)
    # An empty value is right behind its colon.
    gap = " " if start == end and new and not text[start - 1].isspace() else ""
    return text[:start] + gap + new + text[end:]


def _with_item(text: str, listed: SequenceNode, value: Node) -> str:
    if is_flow(text, listed):
        return _with_more(text, listed, flow(value))
    dash = _dash(text, listed)
    end = behind(text, listed.span[1], dash)
    head = text[:end] if text[:end].endswith("\n") else text[:end] + newline(text)
    lines = "".join(f"{line}{newline(text)}" for line in item_lines(value, dash))
    return head + lines + text[end:]


def _dash(text: str, listed: SequenceNode) -> int:
    """Return the column of the dashes of a list in block form."""
    return listed.span[0] - line_start(text, listed.span[0])


def _with_more(text: str, above: MappingNode | SequenceNode, entry: str) -> str:
    """Return the text with one more entry in brackets, directly behind the last one: a comment may follow that."""
    end = ends_in_braces(above)
    return f"{text[:end]}{', ' if end > above.span[0] + 1 else ''}{entry}{text[end:]}"


def _with_entry(text: str, table: MappingNode, key: str, value: Node) -> str:
    """Return the text with one more entry of a table, behind its last one."""
    if is_flow(text, table):
        return _with_more(text, table, f"{quoted(key)}: {flow(value)}")
    depth = table.span[0] - line_start(text, table.span[0])
    end = behind(text, table.span[1], depth)
    lines = entry_text(Scalar(key, value.location), value, depth).replace("\n", newline(text))
    head = text[:end] if text[:end].endswith("\n") else text[:end] + newline(text)
    return head + lines + text[end:]


def _remarks(text: str, top: MappingNode, table: MappingNode) -> Iterator[tuple[int, re.Match[str]]]:
    """Yield the comments between and directly after the entries of a table that look like entries, in the same
    column.
    """
    depth = table.span[0] - line_start(text, table.span[0])
    index = 0 if table is top else line_start(text, table.span[0])
    while index < len(text):
        end = line_end(text, index)
        line = text[index:end].rstrip("\r\n")
        bare = line.lstrip()
        if index >= table.span[1] and bare and not bare.startswith("#"):
            return
        if len(line) - len(bare) == depth and (match := _REMARK.match(bare)):
            yield index + depth, match
        index = end


def _from_remark(text: str, top: MappingNode, table: MappingNode, rest: Where, value: Node) -> str | None:
    """Return the text with a value at a key that its table has as a comment; None if there is no such comment."""
    if is_flow(text, table):
        return None
    for start, match in _remarks(text, top, table):
        # What is set aside for another choice is left to that; the choice is a key of the table.
        if match["key"] != rest[0] or table.find(unmarked(match[0])[1].partition(":")[0]):
            continue
        try:
            entry = with_value(match["entry"], rest, value)
        except EditError:
            continue
        if [key.text for key, _ in _top(entry).entries] != [rest[0]]:
            continue
        changed = text[:start] + entry + text[start + len(match[0]) :]
        source = read_nodes(changed)
        if isinstance(source.top, MappingNode) and _only_more(plain(top), plain(source.top)):
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
