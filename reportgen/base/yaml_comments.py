"""Read the entries of a table that are comments: `remarks`.

In block form they are in the column of the table's entries, among them or directly below. Those of a table in braces
are on the lines below its outermost braces, with the path of the table (`# loads.0.F: 500 N`).
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from reportgen.base.errors import Where
from reportgen.base.records import Record
from reportgen.base.yaml_places import (
    column,
    column_of,
    content_end,
    is_flow,
    line_end,
    lines_from,
    read_nodes,
    unmarked,
)
from reportgen.base.yaml_source import MappingNode, Node, Span
from reportgen.base.yaml_values import at, flow

LONGEST, TRIES = 3000, 40
"""Largest number of lines of an entry that is looked for among comments, and of ends that are tried for it."""
_BEGINS = re.compile(r"#[ \t]?(?P<entry>[^\s#].*)")
_KEY = re.compile(r"(?![-?]\s).*:(?:\s|$)")
_BODY = re.compile(r"[|>][-+0-9]*")


class CommentedEntry(Record):
    """An entry that is a comment: its key and value, its mark ("" for none), and its text without comment signs."""

    key: str
    value: Node
    mark: str
    span: Span
    text: str
    in_place: bool
    """False for the comment of an entry in braces, which moves back into them."""


def remarks(text: str, where: Where) -> list[CommentedEntry]:
    """Return the entries of the table at a path that are comments, in the order of the text."""
    top = read_nodes(text).top
    table = at(top, where)
    if not isinstance(table, MappingNode):
        return []
    return list(_below(text, top, where) if is_flow(text, table) else _among(text, top, where, table))


def uncommented(text: str, remark: CommentedEntry, mark: str = "") -> str:
    """Return the text with a comment in block form as an entry, without a mark that is `mark`."""
    start, end = remark.span
    first, *others = remark.text.split("\n", 1)
    bare = first.rstrip("\r")
    said = marked(remark.mark if remark.mark != mark else "")
    return text[:start] + "\n".join([f"{bare}{said}{first[len(bare) :]}", *others]) + text[end:]


def marked(mark: str) -> str:
    """Return a mark as it follows an entry."""
    return f"  # {mark}" if mark else ""


def _among(text: str, top: Node | None, where: Where, table: MappingNode) -> Iterator[CommentedEntry]:
    """Yield the comments in the column of the entries of a table in block form, among them and directly below."""
    depth = column_of(text, table.span[0])
    lines = list(lines_from(text, _begin(text, top, where, table)))
    taken = 0
    for number, (start, end) in enumerate(lines):
        bare = text[start:end].strip()
        if start >= table.span[1] and bare and not bare.startswith("#"):
            return
        begins = _BEGINS.match(bare) if number >= taken and column(text, start, end) == depth else None
        if begins is None or not _KEY.match(begins["entry"]):
            continue
        first, mark = unmarked(begins["entry"])
        most = _together(text, lines, number, depth) if _goes_on(first, depth) else 1
        for count in range(most, max(most - TRIES, 0), -1):
            if (remark := _entry(text, lines[number : number + count], first, mark)) is not None:
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


def _together(text: str, lines: list[Span], first: int, depth: int) -> int:
    """Return how many lines from the first one may be one entry: further ones are deeper, lists or closing brackets."""
    count = 1
    for index, (start, end) in enumerate(lines[first + 1 : first + LONGEST], 2):
        bare = text[start:end].strip()
        if not bare:
            continue
        inner = bare.removeprefix("#").removeprefix(" ")
        if not bare.startswith("#") or column(text, start, end) > depth or inner[:1] not in (" ", "-", "]", "}", "#"):
            break
        count = index
    return count


def _entry(text: str, lines: list[Span], first: str, mark: str) -> CommentedEntry | None:
    """Return the entry of some lines of comments, the first one without its sign; None if they are something else."""
    depth = column(text, *lines[0])
    start, end = lines[0][0] + depth, content_end(text, lines[-1][1])
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
    for name, (start, end) in comments_below(text, top, where):
        match = _BEGINS.fullmatch(text[start:end].strip())
        assert match is not None, "it is a comment"
        line, mark = unmarked(match["entry"])
        if not line.startswith(name):
            continue
        table = read_nodes(line.removeprefix(name)).top
        if isinstance(table, MappingNode) and len(table.entries) == 1:
            key, value = table.entries[0]
            yield CommentedEntry(key.text, value, mark, (start, end), line, False)


def comments_below(text: str, top: Node | None, where: Where) -> Iterator[tuple[str, Span]]:
    """Yield the comments below the line on which the outermost braces around a place end, and how those of it begin."""
    outer, depth = outermost_brackets(text, top, (*where, ""))
    node = at(top, outer)
    assert node is not None, "its braces have been found"
    name = "".join(f"{step}." for step in where[len(outer) :])
    for start, end in lines_from(text, line_end(text, content_end(text, node.span[1]))):
        if _BEGINS.fullmatch(text[start:end].strip()) is None or column(text, start, end) != depth:
            return
        yield name, (start, end)


def outermost_brackets(text: str, top: Node | None, where: Where) -> tuple[Where, int]:
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
        return where[:count], column_of(text, begin) + 2
    raise ValueError("the place is not in brackets")
