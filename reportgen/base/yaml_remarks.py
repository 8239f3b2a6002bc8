"""Set entries of a table aside as comments, and restore them.

An entry in block form becomes a comment in its place, line by line. An entry in braces moves to a comment line below.
An optional mark (`# F: 500 N  # by: constant`) names the choice that the entry belongs to.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

from reportgen.base.errors import Where
from reportgen.base.yaml_edit import EditError, with_value
from reportgen.base.yaml_places import (
    content_end,
    is_flow,
    line_end,
    line_start,
    newline,
    read_nodes,
    unmarked,
    without_in_braces,
)
from reportgen.base.yaml_source import MappingNode, Node, SequenceNode, Span, plain
from reportgen.base.yaml_values import at, flow, path_text, quoted

LONGEST = 3000
"""Largest number of lines of an entry that is looked for among comments."""
_BEGINS = re.compile(r"#[ \t]?(?P<entry>[^\s#].*)")
_BODY = re.compile(r"[|>][-+0-9]*")


@dataclass(frozen=True)
class CommentedEntry:
    """An entry that is a comment: its key and value, its mark ("" for none), and its text without comment signs."""

    key: str
    value: Node
    mark: str
    span: Span
    text: str
    in_place: bool
    """False for the comment of an entry in braces, which moves back into them."""


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
        changed = _below_braces(text, top, where, table, line + _said(mark))
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


def remarks(text: str, where: Where) -> list[CommentedEntry]:
    """Return the entries of the table at a path that are comments, in the order of the text."""
    top = read_nodes(text).top
    table = at(top, where)
    if not isinstance(table, MappingNode):
        return []
    return list(_below(text, top, where) if is_flow(text, table) else _among(text, top, where, table))


def restored(text: str, where: Where, remark: CommentedEntry, mark: str = "") -> str:
    """Return the text with a comment of the table at a path as an entry again, without `mark`; raises `EditError`."""
    start, end = remark.span
    if remark.in_place:
        first, *others = remark.text.split("\n", 1)
        bare = first.rstrip("\r")
        said = _said(remark.mark if remark.mark != mark else "")
        changed = "\n".join([f"{bare}{said}{first[len(bare) :]}", *others])
        return _more(text, text[:start] + changed + text[end:], (*where, remark.key), remark.value)
    return with_value(text[:start] + text[end:], (*where, remark.key), remark.value)


def renumbered(text: str, where: Where, number: Callable[[int], int | None]) -> str:
    """Return the text in which what is set aside from the items of a list in brackets follows them.

    `number` returns the new number of an item; None deletes what is set aside from it.
    """
    top = read_nodes(text).top
    listed = at(top, where)
    if not isinstance(listed, SequenceNode) or not is_flow(text, listed):
        return text
    for name, (start, end) in reversed([*_comments(text, top, where)]):
        place = re.compile(rf"[ ]*#[ \t]?{re.escape(name)}(\d+)(?=\.)").match(text, start, end)
        if place is None:
            continue
        new = number(int(place[1]))
        text = text[:start] + text[end:] if new is None else f"{text[: place.start(1)]}{new}{text[place.end(1) :]}"
    return text


# --- entries to comments ----------------------------------------------------------------------------------


def _said(mark: str) -> str:
    return f"  # {mark}" if mark else ""


def _in_place(text: str, table: MappingNode, step: str | int, mark: str) -> str:
    """Return the text with the lines of an entry in block form as comments."""
    index = [key.text for key, _ in table.entries].index(str(step))
    key, node = table.entries[index]
    start = key.span[0]
    depth = start - line_start(text, start)
    end = line_end(text, content_end(text, max(node.span[1], key.span[1])))
    first, *others = text[start:end].splitlines(keepends=True)
    bare = first.rstrip("\r\n")
    lines = [f"# {bare}{_said(mark)}{first[len(bare) :]}"]
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
    outer, depth = _outermost(text, top, where)
    name = "".join(f"{step}." for step in where[len(outer) : -1])
    changed = without_in_braces(text, table, where[-1])
    node = at(read_nodes(changed).top, outer)
    if node is None:
        raise EditError("otherwise")
    end = line_end(changed, content_end(changed, node.span[1]))
    for begin, until in _lines(changed, end):
        if _column(changed, begin, until) != depth or not changed[begin:until].strip().startswith("#"):
            break
        end = until
    head = changed[:end] if changed[:end].endswith("\n") else changed[:end] + newline(text)
    return f"{head}{' ' * depth}# {name}{line}{newline(text)}{changed[end:]}"


def _outermost(text: str, top: Node | None, where: Where) -> tuple[Where, int]:
    """Return the path of the outermost node in brackets on the way to a place, and the column of comments below it."""
    for count in range(len(where) + 1):
        node = at(top, where[:count])
        if node is None or not is_flow(text, node):
            continue
        if not count:
            return (), 0
        above = at(top, where[: count - 1])
        entry = above.find(where[count - 1]) if isinstance(above, MappingNode) else None
        begin = entry[0].span[0] if entry else text.rfind("-", 0, node.span[0])
        return where[:count], begin - line_start(text, begin) + 2
    raise EditError("otherwise")


# --- comments to entries ----------------------------------------------------------------------------------


def _among(text: str, top: Node | None, where: Where, table: MappingNode) -> Iterator[CommentedEntry]:
    """Yield the comments in the column of the entries of a table in block form, among them and directly below."""
    depth = table.span[0] - line_start(text, table.span[0])
    lines = list(_lines(text, _begin(text, top, where, table)))
    taken = 0
    for number, (start, end) in enumerate(lines):
        bare = text[start:end].strip()
        if start >= table.span[1] and bare and not bare.startswith("#"):
            return
        if number < taken or _column(text, start, end) != depth or not bare.startswith("#"):
            continue
        for count in range(_together(text, lines, number, depth), 0, -1):
            if (remark := _entry(text, lines[number : number + count], depth)) is not None:
                yield remark
                taken = number + count
                break


def _begin(text: str, top: Node | None, where: Where, table: MappingNode) -> int:
    """Return where the comments of a table may begin: on the line after its key or its dash."""
    if not where:
        return 0
    above = at(top, where[:-1])
    entry = above.find(where[-1]) if isinstance(above, MappingNode) else None
    return line_end(text, entry[0].span[1]) if entry else line_end(text, table.span[0])


def _lines(text: str, start: int) -> Iterator[Span]:
    while start < len(text):
        end = line_end(text, start)
        yield start, end
        start = end


def _column(text: str, start: int, end: int) -> int:
    return end - start - len(text[start:end].lstrip(" "))


def _together(text: str, lines: list[Span], first: int, depth: int) -> int:
    """Return how many lines from the first one may be one entry: further ones are deeper, lists or closing brackets."""
    count = 1
    for index, (start, end) in enumerate(lines[first + 1 : first + LONGEST], 2):
        bare = text[start:end].strip()
        if not bare:
            continue
        inner = bare.removeprefix("#").removeprefix(" ")
        if not bare.startswith("#") or _column(text, start, end) > depth or inner[:1] not in (" ", "-", "]", "}", "#"):
            break
        count = index
    return count


def _entry(text: str, lines: list[Span], depth: int) -> CommentedEntry | None:
    """Return the entry of some lines of comments; None if they are something else."""
    start, end = lines[0][0] + depth, content_end(text, lines[-1][1])
    match = _BEGINS.match(text[start : content_end(text, lines[0][1])])
    if match is None:
        return None
    first, mark = unmarked(match["entry"])
    others = []
    for begin, until in lines[1:]:
        line = text[begin:until]
        cut = line.find("#")
        others.append(line[:cut] + line[cut + 1 :].removeprefix(" ") if cut >= 0 else line)
    rest = text[content_end(text, lines[0][1]) : lines[0][1]] + "".join(others) if others else ""
    whole = (first + rest)[: len(first + rest) - len(text[end : lines[-1][1]])] if others else first
    table = read_nodes(" " * depth + whole).top
    if not isinstance(table, MappingNode) or len(table.entries) != 1:
        return None
    key, value = table.entries[0]
    if others and not _goes_on(first, depth):
        return None
    return CommentedEntry(key.text, value, mark, (start, end), whole, True)


def _goes_on(first: str, depth: int) -> bool:
    """Return True if the first line of an entry alone is not a whole entry: a list or a table follows, or a bracket is
    open.
    """
    top = read_nodes(" " * depth + first).top
    if not isinstance(top, MappingNode) or len(top.entries) != 1:
        return True
    value = top.entries[0][1]
    said = first[top.entries[0][0].span[1] - depth :].lstrip(": ")
    return flow(value) == "" or _BODY.match(said) is not None


def _below(text: str, top: Node | None, where: Where) -> Iterator[CommentedEntry]:
    """Yield the comments of a table in braces."""
    for name, (start, end) in _comments(text, top, where):
        match = _BEGINS.fullmatch(text[start:end].strip())
        assert match is not None, "it is a comment"
        line, mark = unmarked(match["entry"])
        if not line.startswith(name):
            continue
        table = read_nodes(line.removeprefix(name)).top
        if isinstance(table, MappingNode) and len(table.entries) == 1:
            key, value = table.entries[0]
            yield CommentedEntry(key.text, value, mark, (start, end), line, False)


def _comments(text: str, top: Node | None, where: Where) -> Iterator[tuple[str, Span]]:
    """Yield the comments below the line on which the outermost braces around a place end, and how those of it begin."""
    outer, depth = _outermost(text, top, (*where, ""))
    node = at(top, outer)
    assert node is not None, "its braces have been found"
    name = "".join(f"{step}." for step in where[len(outer) :])
    for start, end in _lines(text, line_end(text, content_end(text, node.span[1]))):
        if _BEGINS.fullmatch(text[start:end].strip()) is None or _column(text, start, end) != depth:
            return
        yield name, (start, end)


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
