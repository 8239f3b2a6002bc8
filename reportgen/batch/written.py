"""Nodes → the text of an assignment file.

What was not changed stays as it stands in the source, comments and all, wherever a key has lines of its own;
the rest is written anew.  `text_of` reads its own text again: a form it could not keep is written anew as a whole.
"""

from __future__ import annotations

import re
from collections.abc import Sequence

from reportgen.assignment.source import List, Node, Scalar, Table, plain, read_text

WIDTH = 100
_PLAIN = re.compile(r"[^\W\d_][\w/^²³⁴·.@-]*( [\w/^²³⁴·.@-]+)*|[+-]?[0-9.][\w./^²³⁴·+-]*( [\w./^²³⁴·*+-]+)*")
_RESERVED = re.compile(r"(~|null|true|false|yes|no|on|off|)", re.IGNORECASE)
_ESCAPES = {'"': '\\"', "\\": "\\\\", "\n": "\\n", "\t": "\\t", "\r": "\\r"}


def text_of(table: Table, source: str, original: Table) -> str:
    """The file of a table whose unchanged parts are those of `original`, which was read from `source`."""
    kept = _block(table, original, source.splitlines(), 0)
    return kept if _says(kept, table) else _lines(table, 0)


def quoted(text: str) -> str:
    """A scalar of YAML that is read as exactly this text."""
    if _PLAIN.fullmatch(text) and not _RESERVED.fullmatch(text):
        return text
    return f'"{"".join(map(_escaped, text))}"'


def _escaped(letter: str) -> str:
    if letter in _ESCAPES:
        return _ESCAPES[letter]
    if letter.isprintable():
        return letter
    return f"\\u{ord(letter):04x}" if ord(letter) < 0x10000 else f"\\U{ord(letter):08x}"


def _says(text: str, table: Table) -> bool:
    read = read_text(text)
    return not read.faults and read.top is not None and plain(read.top) == plain(table)


def _block(table: Table, original: Table, lines: Sequence[str], depth: int) -> str:
    """A table in block form: entries that are the very ones of the source by their lines, others anew."""
    spans = _spans(original, lines)
    parts: list[str] = []
    for key, value in table.entries:
        entry = original.find(key.text)
        span = spans.get(key.text)
        if entry is None or span is None:
            # Before the blank lines that part this table from what follows it.
            blank = _blank_end(parts)
            parts += [_entry(key, value, depth), blank]
        elif value is entry[1]:
            parts.append("".join(f"{line}\n" for line in span))
        elif isinstance(value, Table) and isinstance(entry[1], Table) and _is_block(entry[0], entry[1]):
            head = lines[entry[0].mark.line - 1 : entry[1].mark.line - 1]
            parts.append("".join(f"{line}\n" for line in head))
            indent = entry[1].mark.column - 1
            parts.append(_block(value, entry[1], lines[: entry[0].mark.line - 1 + len(span)], indent))
        else:
            parts.append(_with_comment(_entry(key, value, depth), span, value))
    return "".join(parts)


def _blank_end(parts: list[str]) -> str:
    """Takes the blank lines off the end of what is written so far."""
    text = "".join(parts)
    full = text.rstrip("\n") + "\n" if text.strip() else text
    parts[:] = [full]
    return text[len(full) :]


def _is_block(key: Scalar, table: Table) -> bool:
    return bool(table.entries) and table.mark.line > key.mark.line and table.mark == table.entries[0][0].mark


def _spans(table: Table, lines: Sequence[str]) -> dict[str, Sequence[str]]:
    """The lines of each entry, up to the next; none for entries that share lines."""
    starts = [key.mark.line for key, _ in table.entries]
    if not starts or len(set(starts)) < len(starts) or any(
        lines[line - 1][: key.mark.column - 1].strip() for line, (key, _) in zip(starts, table.entries, strict=True)
    ):
        return {}
    ends = [*(line - 1 for line in starts[1:]), len(lines)]
    return {
        key.text: lines[line - 1 : end] for line, end, (key, _) in zip(starts, ends, table.entries, strict=True)
    }


def _with_comment(entry: str, span: Sequence[str], value: Node) -> str:
    """An entry written anew, with the comment of its old line and the lines of comment after it."""
    after = []
    for line in reversed(span[1:]):
        if line.strip() and not line.lstrip().startswith("#"):
            break
        after.append(line)
    comment = re.search(r"\s+#[^'\"]*$", span[0]) if isinstance(value, Scalar) else None
    first = entry.rstrip("\n") + (comment[0] if comment else "")
    return "".join(f"{line}\n" for line in (first, *reversed(after)))


def _entry(key: Scalar, value: Node, depth: int) -> str:
    """A key and its value, in one line if that is short."""
    name, space = quoted(key.text), " " * depth
    flow = _flow(value)
    if isinstance(value, Scalar) or len(space) + len(name) + len(flow) + 2 <= WIDTH:
        return f"{space}{name}: {flow}".rstrip() + "\n"
    if isinstance(value, Table):
        return f"{space}{name}:\n{_lines(value, depth + 2)}"
    items = "".join(f"{space}  - {_flow(item)}\n" for item in value.items)
    return f"{space}{name}:\n{items}"


def _lines(table: Table, depth: int) -> str:
    return "".join(_entry(key, value, depth) for key, value in table.entries)


def _flow(node: Node) -> str:
    match node:
        case Scalar(text, null=null):
            return "" if null else quoted(text)
        case List(items):
            return f"[{', '.join(_flow(item) for item in items)}]"
        case Table(entries):
            return "{" + ", ".join(f"{quoted(key.text)}: {_flow(value)}".rstrip() for key, value in entries) + "}"
