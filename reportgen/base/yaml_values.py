"""Insert values into assignment files and write them as text again."""

from __future__ import annotations

import re
from collections.abc import Collection, Sequence

from reportgen.base.errors import Where
from reportgen.base.records import replace
from reportgen.base.yaml_source import MappingNode, Node, Scalar, SequenceNode, plain, read_own

WIDTH = 100
_PLAIN = re.compile(r"[^\W\d_][\w/^²³⁴·.@-]*( [\w/^²³⁴·.@-]+)*|[+-]?[0-9.][\w./^²³⁴·+-]*( [\w./^²³⁴·*+-]+)*")
_RESERVED = re.compile(r"(~|null|true|false|yes|no|on|off|)", re.IGNORECASE)
_ESCAPES = {'"': '\\"', "\\": "\\\\", "\n": "\\n", "\t": "\\t", "\r": "\\r"}


def at(node: Node | None, where: Where) -> Node | None:
    """Return the node at a place; None if there is none."""
    for step in where:
        if isinstance(node, MappingNode):
            entry = node.find(step)
            node = entry[1] if entry else None
        elif isinstance(node, SequenceNode) and isinstance(step, int) and step < len(node.items):
            node = node.items[step]
        else:
            return None
    return node


def put(node: Node, where: Where, value: Node) -> Node:
    """Return the node with `value` at a path; missing tables on the way are created, lists are not extended."""
    if not where:
        return value
    step, rest = where[0], where[1:]
    if isinstance(node, SequenceNode):
        items = tuple(put(item, rest, value) if k == step else item for k, item in enumerate(node.items))
        return replace(node, items=items)
    entries = node.entries if isinstance(node, MappingNode) else ()
    if step not in [key.text for key, _ in entries]:
        entries = (*entries, (Scalar(str(step), value.location), MappingNode((), value.location)))
    changed = tuple((key, put(old, rest, value) if key.text == step else old) for key, old in entries)
    return MappingNode(changed, node.location)


def without(table: MappingNode, keys: Collection[str]) -> MappingNode:
    """Return the table without some of its keys."""
    return replace(table, entries=tuple(entry for entry in table.entries if entry[0].text not in keys))


def path_text(where: Where) -> str:
    """Return a path as users write it: parameters.H, parameters.groups.0.length."""
    return ".".join(map(str, where))


def text_of(table: MappingNode, source: str, original: MappingNode) -> str:
    """Return the file of a table whose unchanged parts are those of `original`, which was read from `source`."""
    kept = _block(table, original, source.splitlines(), 0)
    read = read_own(kept)
    agrees = not read.faults and read.top is not None and plain(read.top) == plain(table)
    return kept if agrees else _lines(table, 0)


def quoted(text: str, always: bool = False) -> str:
    """Return a YAML scalar that is read as exactly this text."""
    if not always and _PLAIN.fullmatch(text) and not _RESERVED.fullmatch(text):
        return text
    return f'"{"".join(map(_escaped, text))}"'


def _escaped(letter: str) -> str:
    if letter in _ESCAPES:
        return _ESCAPES[letter]
    if letter.isprintable():
        return letter
    return f"\\u{ord(letter):04x}" if ord(letter) < 0x10000 else f"\\U{ord(letter):08x}"


def _block(table: MappingNode, original: MappingNode, lines: Sequence[str], depth: int) -> str:
    """Return a table in block form: unchanged entries of the source by their lines, others written new."""
    spans = _spans(original, lines)
    text = ""
    for key, value in table.entries:
        entry = original.find(key.text)
        span = spans.get(key.text)
        if entry is None or span is None:
            # Before the blank lines that separate this table from the next one.
            full = text.rstrip("\n") + "\n" if text.strip() else text
            text = full + entry_text(key, value, depth) + text[len(full) :]
        elif value is entry[1]:
            text += _joined(span)
        elif isinstance(value, MappingNode) and isinstance(entry[1], MappingNode) and _is_block(entry[0], entry[1]):
            start = entry[0].location.line - 1
            text += _joined(lines[start : entry[1].location.line - 1])
            text += _block(value, entry[1], lines[: start + len(span)], entry[1].location.column - 1)
        else:
            text += _with_comment(entry_text(key, value, depth), span, value)
    return text


def _joined(lines: Sequence[str]) -> str:
    return "".join(f"{line}\n" for line in lines)


def _is_block(key: Scalar, table: MappingNode) -> bool:
    return (
        bool(table.entries)
        and table.location.line > key.location.line
        and table.location == table.entries[0][0].location
    )


def _spans(table: MappingNode, lines: Sequence[str]) -> dict[str, Sequence[str]]:
    """Return the lines of each entry, up to the next; empty for entries that share lines."""
    keys = [key for key, _ in table.entries]
    starts = [key.location.line for key in keys]
    shared = any(lines[key.location.line - 1][: key.location.column - 1].strip() for key in keys)
    if not keys or shared or len(set(starts)) < len(starts):
        return {}
    ends = [*(line - 1 for line in starts[1:]), len(lines)]
    return {key.text: lines[start - 1 : end] for key, start, end in zip(keys, starts, ends, strict=True)}


def _with_comment(entry: str, span: Sequence[str], value: Node) -> str:
    """Return a new text of an entry, with the comment of its old line and the comment lines after it."""
    after = []
    for line in reversed(span[1:]):
        if line.strip() and not line.lstrip().startswith("#"):
            break
        after.append(line)
    comment = re.search(r"\s+#[^'\"]*$", span[0]) if isinstance(value, Scalar) else None
    return _joined([entry.rstrip("\n") + (comment[0] if comment else ""), *reversed(after)])


def entry_text(key: Scalar, value: Node, depth: int) -> str:
    """Return a key and its value at an indentation, in one line if that is short or the value is empty."""
    name, space = quoted(key.text), " " * depth
    line = flow(value)
    if isinstance(value, Scalar) or line in ("[]", "{}") or len(space) + len(name) + len(line) + 2 <= WIDTH:
        return f"{space}{name}: {line}".rstrip() + "\n"
    if isinstance(value, MappingNode):
        return f"{space}{name}:\n{_lines(value, depth + 2)}"
    return _joined([f"{space}{name}:", *(line for item in value.items for line in item_lines(item, depth + 2))])


def item_lines(item: Node, depth: int) -> list[str]:
    """Return an item of a list at an indentation, in one line; a long table with inner tables by its entries."""
    line = flow(item)
    nested = isinstance(item, MappingNode) and any(isinstance(value, MappingNode) for _, value in item.entries)
    if depth + 2 + len(line) <= WIDTH or not isinstance(item, MappingNode) or not nested:
        return [f"{' ' * depth}- {line}"]
    first, *others = _lines(item, depth + 2).splitlines()
    return [f"{' ' * depth}- {first.lstrip()}", *others]


def _lines(table: MappingNode, depth: int) -> str:
    return "".join(entry_text(key, value, depth) for key, value in table.entries)


def flow(node: Node) -> str:
    """Return a node in one line."""
    match node:
        case Scalar(text, null=null, quoted=in_marks):
            return "" if null else quoted(text, in_marks)
        case SequenceNode(items):
            return f"[{', '.join(flow(item) for item in items)}]"
        case MappingNode(entries):
            return "{" + ", ".join(f"{quoted(key.text)}: {flow(value)}".rstrip() for key, value in entries) + "}"
