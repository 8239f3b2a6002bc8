"""Set entries of a table aside as comments, and restore them.

An entry in block form becomes a comment in its place, line by line. An entry in braces moves to a comment line below.
An optional mark (`# F: 500 N  # by: constant`) names the choice that the entry belongs to.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any

from reportgen.base.errors import Where
from reportgen.base.yaml_comments import (
    CommentedEntry,
    comments_below,
    marked,
    outermost_brackets,
    remarks,
    uncommented,
)
from reportgen.base.yaml_edit import EditError, with_value, without
from reportgen.base.yaml_places import (
    column,
    column_of,
    content_end,
    is_flow,
    line_end,
    line_start,
    lines_from,
    newline,
    read_nodes,
    without_in_braces,
)
from reportgen.base.yaml_source import MappingNode, Node, SequenceNode, plain
from reportgen.base.yaml_values import at, flow, path_text, quoted


def set_aside(text: str, where: Where, mark: str = "") -> str:
    """Return the text with the entry at a path as a comment; raises `EditError` if there is none."""
    top = read_nodes(text).top
    table = at(top, where[:-1])
    entry = table.find(where[-1]) if isinstance(table, MappingNode) else None
    if entry is None or not isinstance(table, MappingNode):
        raise EditError("nothing", place=path_text(where))
    key, node = entry
    line = f"{quoted(key.text)}: {flow(node)}".rstrip()
    if is_flow(text, table):
        changed = _below_braces(text, top, where, table, line + marked(mark))
    elif len(table.entries) == 1:
        raise EditError("otherwise")
    else:
        changed = _in_place(text, table, where[-1], mark)
        kept = remarks(changed, where[:-1])
        if not any((one.key, one.mark) == (key.text, mark) and plain(one.value) == plain(node) for one in kept):
            # A text over several lines, which no reader of comments can tell from what follows it.
            start, end = key.span[0], content_end(text, max(node.span[1], key.span[1]))
            joined = text[:start] + line + text[end:]
            table = at(read_nodes(joined).top, where[:-1])
            assert isinstance(table, MappingNode), "a value in one line changes no table"
            changed = _in_place(joined, table, where[-1], mark)
    return _less(text, changed, where)


def restored(text: str, where: Where, remark: CommentedEntry, mark: str = "") -> str:
    """Return the text with a comment of the table at a path as an entry again, without `mark`; raises `EditError`."""
    if remark.in_place:
        return _more(text, uncommented(text, remark, mark), (*where, remark.key), remark.value)
    start, end = remark.span
    return with_value(text[:start] + text[end:], (*where, remark.key), remark.value)


def removed(text: str, where: Where) -> str:
    """Return the text without a key or an item, and without what is set aside inside it; raises `EditError`.

    A key and value in one line become a comment, which keeps what is set aside below it.
    """
    top = read_nodes(text).top
    above, gone = at(top, where[:-1]), where[-1]
    if isinstance(gone, int):
        return renumbered(without(text, where), where[:-1], lambda at: None if at == gone else at - (at > gone))
    if above is not None and is_flow(text, above):
        for name, (start, end) in reversed([*comments_below(text, top, where[:-1])]):
            if re.compile(rf"[ ]*#[ \t]?{re.escape(f'{name}{gone}.')}").match(text, start, end):
                text = text[:start] + text[end:]
    return without(text, where)


def renumbered(text: str, where: Where, number: Callable[[int], int | None]) -> str:
    """Return the text in which what is set aside from the items of a list in brackets follows them.

    `number` returns the new number of an item; None deletes what is set aside from it.
    """
    top = read_nodes(text).top
    listed = at(top, where)
    if not isinstance(listed, SequenceNode) or not is_flow(text, listed):
        return text
    for name, (start, end) in reversed([*comments_below(text, top, where)]):
        place = re.compile(rf"[ ]*#[ \t]?{re.escape(name)}(\d+)(?=\.)").match(text, start, end)
        if place is None:
            continue
        new = number(int(place[1]))
        text = text[:start] + text[end:] if new is None else f"{text[: place.start(1)]}{new}{text[place.end(1) :]}"
    return text


# --- entries to comments ----------------------------------------------------------------------------------


def _in_place(text: str, table: MappingNode, step: str | int, mark: str) -> str:
    """Return the text with the lines of an entry in block form as comments."""
    index = [key.text for key, _ in table.entries].index(str(step))
    key, node = table.entries[index]
    start = key.span[0]
    depth = column_of(text, start)
    end = line_end(text, content_end(text, max(node.span[1], key.span[1])))
    first, *others = text[start:end].splitlines(keepends=True)
    bare = first.rstrip("\r\n")
    lines = [f"# {bare}{marked(mark)}{first[len(bare) :]}"]
    for line in others:
        indent = len(line) - len(line.lstrip(" "))
        cut = min(depth, indent)
        lines.append(f"{line[:cut]}# {line[cut:]}" if line.strip() else line)
    if text[line_start(text, start) : start].strip() and index + 1 < len(table.entries):
        # After a dash comes an entry: the next one, and the comment below it.
        after, value = table.entries[index + 1]
        until = line_end(text, content_end(text, max(value.span[1], after.span[1])))
        head = text[after.span[0] : until]
        head = head if head.endswith("\n") else head + newline(text)
        between = text[end : line_start(text, after.span[0])]
        return text[:start] + head + " " * depth + "".join(lines) + between + text[until:]
    return text[:start] + "".join(lines) + text[end:]


def _below_braces(text: str, top: Node | None, where: Where, table: MappingNode, line: str) -> str:
    """Return the text without an entry in braces, with the comment below the line on which the outermost ones end."""
    outer, depth = outermost_brackets(text, top, where)
    name = "".join(f"{step}." for step in where[len(outer) : -1])
    changed = without_in_braces(text, table, where[-1])
    node = at(read_nodes(changed).top, outer)
    if node is None:
        raise EditError("otherwise")
    end = line_end(changed, content_end(changed, node.span[1]))
    for begin, until in lines_from(changed, end):
        if column(changed, begin, until) != depth or not changed[begin:until].strip().startswith("#"):
            break
        end = until
    head = changed[:end] if changed[:end].endswith("\n") else changed[:end] + newline(text)
    return f"{head}{' ' * depth}# {name}{line}{newline(text)}{changed[end:]}"


# --- checking the result ----------------------------------------------------------------------------------


def _less(before: str, after: str, where: Where) -> str:
    wanted = _content(before)
    del _table(wanted, where)[where[-1]]
    return _agreeing(after, wanted)


def _more(before: str, after: str, where: Where, value: Node) -> str:
    wanted = _content(before)
    _table(wanted, where)[where[-1]] = plain(value)
    return _agreeing(after, wanted)


def _agreeing(text: str, wanted: Any) -> str:
    if _content(text) != wanted:
        raise EditError("otherwise")
    return text


def _content(text: str) -> Any:
    top = read_nodes(text).top
    return None if top is None else plain(top)


def _table(content: Any, where: Where) -> dict[str | int, Any]:
    for step in where[:-1]:
        content = content[step]
    assert isinstance(content, dict), "an entry is in a table"
    return content
