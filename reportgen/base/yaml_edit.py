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
from reportgen.base.yaml_source import MappingNode, Node, Scalar, SequenceNode, Source, plain, read_own, read_text
from reportgen.base.yaml_values import at, entry_text, flow, item_lines, path_text, quoted

_REMARK = re.compile(r"#[ \t]?(?P<entry>(?P<key>[^\s:#][^:#]*):(?:[ \t].*)?)$")

SHOWN = 60
"""Largest number of typed characters that a message repeats."""
BRACKETS = 2000
"""A text with fewer brackets is not set in itself deeper than any reader bears."""


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
    start = _start(above, where[-1], node)
    if _is_flow(text, above):
        return _agreeing(_without_in_flow(text, above, where[-1]), wanted)
    begins, ends = _line_start(text, start), _line_end(text, _content_end(text, node.span[1]))
    head = text[begins:start]
    if isinstance(above, SequenceNode) or text.count("\n", start, node.span[1]) or head.strip():
        if len(above.items if isinstance(above, SequenceNode) else above.entries) == 1:
            # Nothing is left: an empty list says so, an empty table is an empty key.
            empty = " []" if isinstance(above, SequenceNode) else ""
            key_end = text.rindex(":", 0, above.span[0]) + 1
            return _agreeing(text[:key_end] + empty + text[_content_end(text, above.span[1]) :], wanted)
        if head.strip(" -"):
            raise EditError("same_line", place=path_text(where))
        if head.strip() and isinstance(above, MappingNode):
            # The first key of an item in block form follows its dash.
            following = above.entries[1][0].span[0]
            return _agreeing(text[:start] + text[following:], wanted)
        return _agreeing(text[:begins] + text[ends:], wanted)
    return _agreeing(f"{text[:start]}# {text[start:]}", wanted)


def with_key(text: str, where: Where, key: str, value: Scalar) -> str:
    """Return the text with another key and value in place of those at a place; raises `EditError`."""
    top = _top(text)
    table = at(top, where[:-1])
    entry = table.find(where[-1]) if isinstance(table, MappingNode) else None
    if entry is None or not isinstance(table, MappingNode) or table.find(key):
        raise EditError("not_instead", place=path_text(where), key=key)
    old, node = entry
    changed = _replaced(text, node, value)
    changed = changed[: old.span[0]] + quoted(key) + changed[old.span[1] :]
    new = plain(_top(changed))
    here = (*where[:-1], key)
    if _get(new, here) != plain(value) or _less(new, here) != _less(plain(top), where):
        raise EditError("not_instead", place=path_text(where), key=key)
    return changed


def exchanged(text: str, where: Where, first: int) -> str:
    """Return the text with the item `first` of the list at a path moved after its successor; raises `EditError`."""
    top = _top(text)
    listed = at(top, where)
    if not isinstance(listed, SequenceNode) or not 0 <= first < len(listed.items) - 1:
        raise EditError("nothing", place=path_text((*where, first + 1)))
    (a, b), (c, d) = (item.span for item in listed.items[first : first + 2])
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


def _read(text: str) -> Source:
    """Return the nodes of a text, by libyaml, which takes a tenth of the time, unless it may be deeply nested."""
    return read_own(text) if text.count("[") + text.count("{") < BRACKETS else read_text(text)


def _top(text: str) -> MappingNode:
    source = _read(text)
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


def _is_flow(text: str, node: Node) -> bool:
    return text[node.span[0] : node.span[0] + 1] in ("[", "{")


def _start(above: Node, step: str | int, node: Node) -> int:
    """Return the index at which an entry begins: that of its key, or of the item."""
    entry = above.find(step) if isinstance(above, MappingNode) else None
    return entry[0].span[0] if entry else node.span[0]


def _line_start(text: str, index: int) -> int:
    return text.rfind("\n", 0, index) + 1


def _line_end(text: str, index: int) -> int:
    """Return the index at which the next line begins."""
    end = text.find("\n", index)
    return len(text) if end < 0 else end + 1


def _content_end(text: str, index: int) -> int:
    """Return the end of the content before an index, without the line break behind a text in block form."""
    return index - len(text[:index]) + len(text[:index].rstrip("\r\n"))


def _behind(text: str, index: int, depth: int) -> int:
    """Return the start of the line after an entry that ends at an index, after comments indented deeper than the entry.

    Such comments belong to the table in the entry, as `# G3: 200 N` below the last of the `parameters`.
    """
    end = line = _line_end(text, _content_end(text, index))
    while line < len(text):
        following = _line_end(text, line)
        bare = text[line:following].strip()
        if bare and not (bare.startswith("#") and text.index("#", line) - line > depth):
            break
        line = following
        if bare:
            end = line
    return end


def _newline(text: str) -> str:
    return "\r\n" if "\r\n" in text else "\n"


# --- changes --------------------------------------------------------------------------------------------


def _replaced(text: str, node: Node, value: Node) -> str:
    start, end = node.span[0], _content_end(text, node.span[1])
    in_marks = isinstance(node, Scalar) and node.quoted
    new = quoted(value.text, in_marks or value.quoted) if isinstance(value, Scalar) and not value.null else flow(value)
    # An empty value is right behind its colon.
    gap = " " if start == end and new and not text[start - 1].isspace() else ""
    return text[:start] + gap + new + text[end:]


def _with_item(text: str, listed: SequenceNode, value: Node) -> str:
    if _is_flow(text, listed):
        closing = listed.span[1] - 1
        before = text[:closing].rstrip()
        return f"{before}{', ' if listed.items else ''}{flow(value)}{text[closing:]}"
    dash = listed.span[0] - _line_start(text, listed.span[0])
    end = _behind(text, listed.span[1], dash)
    head = text[:end] if text[:end].endswith("\n") else text[:end] + _newline(text)
    lines = "".join(f"{line}{_newline(text)}" for line in item_lines(value, dash))
    return head + lines + text[end:]


def _with_entry(text: str, table: MappingNode, key: str, value: Node) -> str:
    """Return the text with one more entry of a table, behind its last one."""
    if _is_flow(text, table):
        closing = table.span[1] - 1
        before = text[:closing].rstrip() if not text[:closing].rstrip().endswith(":") else text[:closing]
        return f"{before}{', ' if table.entries else ''}{quoted(key)}: {flow(value)}{text[closing:]}"
    depth = table.span[0] - _line_start(text, table.span[0])
    end = _behind(text, table.span[1], depth)
    lines = entry_text(Scalar(key, value.location), value, depth).replace("\n", _newline(text))
    head = text[:end] if text[:end].endswith("\n") else text[:end] + _newline(text)
    return head + lines + text[end:]


def _remarks(text: str, top: MappingNode, table: MappingNode) -> Iterator[tuple[int, re.Match[str]]]:
    """Yield the comments between and directly after the entries of a table that look like entries, in the same
    column.
    """
    depth = table.span[0] - _line_start(text, table.span[0])
    index = 0 if table is top else _line_start(text, table.span[0])
    while index < len(text):
        end = _line_end(text, index)
        line = text[index:end].rstrip("\r\n")
        bare = line.lstrip()
        if index >= table.span[1] and bare and not bare.startswith("#"):
            return
        if len(line) - len(bare) == depth and (match := _REMARK.match(bare)):
            yield index + depth, match
        index = end


def _from_remark(text: str, top: MappingNode, table: MappingNode, rest: Where, value: Node) -> str | None:
    """Return the text with a value at a key that its table has as a comment; None if there is no such comment."""
    if _is_flow(text, table):
        return None
    for start, match in _remarks(text, top, table):
        if match["key"] != rest[0]:
            continue
        try:
            entry = with_value(match["entry"], rest, value)
        except EditError:
            continue
        if [key.text for key, _ in _top(entry).entries] != [rest[0]]:
            continue
        changed = text[:start] + entry + text[start + len(match[0]) :]
        source = _read(changed)
        if isinstance(source.top, MappingNode) and _only_more(plain(top), plain(source.top)):
            return changed
    return None


def _only_more(old: Any, new: Any) -> bool:
    """Return True if a content has everything that another one has, and perhaps more keys."""
    if isinstance(old, dict) and isinstance(new, dict):
        return all(key in new and _only_more(value, new[key]) for key, value in old.items())
    return bool(old == new)


def _without_in_flow(text: str, above: MappingNode | SequenceNode, step: str | int) -> str:
    """Return the text without an entry in brackets and without the comma beside it."""
    if isinstance(above, MappingNode):
        spans = [(key.span[0], max(value.span[1], key.span[1])) for key, value in above.entries]
        index = [key.text for key, _ in above.entries].index(str(step))
    else:
        spans, index = [item.span for item in above.items], int(step)
    if index + 1 < len(spans):
        return text[: spans[index][0]] + text[spans[index + 1][0] :]
    if index:
        before = spans[index - 1][1]
        return text[:before] + text[before:].replace(text[before : above.span[1] - 1], "", 1)
    return text[: above.span[0] + 1] + text[above.span[1] - 1 :]


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
    source = _read(text)
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
