"""The text of a YAML file as nodes that know where they stand.

Nothing is constructed: a scalar stays the text that was typed, so `2011-03-24`, `1/3.6` and `no` reach
their readers unharmed.  What the language offers beyond mappings, lists and scalars (tags, anchors,
aliases) is a fault here.  No text, however hostile, takes more than its size in memory or a second or two: tokens,
keys and faults are counted as they come.
"""

from __future__ import annotations

import codecs
import re
import unicodedata
from collections.abc import Callable, Collection, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import islice
from operator import attrgetter
from pathlib import Path
from typing import Any, NoReturn

import yaml

from reportgen.base.errors import Fault, Mark, Where
from reportgen.base.files import cause, contents

ENCODINGS = {codecs.BOM_UTF8: "utf-8", codecs.BOM_UTF16_LE: "utf-16-le", codecs.BOM_UTF16_BE: "utf-16-be"}
"""What the first bytes of a text say of the others."""
LARGEST = 400_000
"""Bytes of a file."""
MOST_TOKENS = 30_000
"""Values, keys and signs of a file; a table of 5 rows of 2000 values has two thirds of them."""
DEEPEST = 12
MOST_KEYS = 200
MOST_FAULTS = 100
"""After so many faults of its syntax a file is read no further."""
_MAY_BE_MORE = re.compile(r"(?m)(?:^|[\s\[{,])[&*!]\S")
"""What anchors, aliases and tags look like, and some other texts."""
_NULL = {"", "~", "null", "Null", "NULL"}
_SYNTAX = (
    ("mapping values are not allowed", "syntax-colon"),
    ("expected ',' or", "syntax-bracket"),
    ("expected the node content", "syntax-bracket"),
    ("unexpected end of stream", "syntax-quote"),
    ("could not find expected ':'", "syntax-key"),
    ("expected <block end>", "syntax-indent"),
    ("single document", "syntax-document"),
)


@dataclass(frozen=True, slots=True)
class Scalar:
    """A piece of text; `null` when nothing was written, `quoted` when it stands in quotation marks."""

    text: str
    mark: Mark
    null: bool = False
    quoted: bool = False


class Quoted(str):
    """A text that stands in quotation marks: what looks like a number is none."""

    __slots__ = ()


@dataclass(frozen=True, slots=True)
class SequenceNode:
    items: tuple[Node, ...]
    mark: Mark


@dataclass(frozen=True, slots=True)
class MappingNode:
    """A mapping: its entries in the order of the file, each key once."""

    entries: tuple[tuple[Scalar, Node], ...]
    mark: Mark

    def find(self, key: object) -> tuple[Scalar, Node] | None:
        return next((entry for entry in self.entries if entry[0].text == key), None)


Node = Scalar | SequenceNode | MappingNode


@dataclass(frozen=True, slots=True)
class Source:
    """A file as read: its top node (None if it could not be read) and the faults met on the way."""

    file: str
    text: str = ""
    top: Node | None = None
    faults: tuple[Fault, ...] = ()


def scalars(node: Node | None) -> Iterator[Scalar]:
    """All texts of a table."""
    match node:
        case Scalar():
            yield node
        case SequenceNode(items):
            for item in items:
                yield from scalars(item)
        case MappingNode(entries):
            for _, value in entries:
                yield from scalars(value)


def read_source(path: Path) -> Source:
    """The nodes of a file; every fault of its bytes and syntax is in `faults`, none is raised."""
    text = text_in(path)
    return Source(str(path), faults=(text,)) if isinstance(text, Fault) else read_text(text, str(path))


def text_in(path: Path) -> str | Fault:
    """The text of a file, or what keeps it from being read."""
    file = str(path)
    try:
        data = contents(path, LARGEST + 1)
        if len(data) > LARGEST:
            return Fault("too-large", Mark(file), {"largest": str(LARGEST // 1000)})
    except IsADirectoryError as error:
        about = {"reason": cause(error), "known": str(path.resolve()), "hint": "folder"}
        return Fault("unreadable", Mark(file), about)
    except OSError as error:
        return Fault("unreadable", Mark(file), {"reason": cause(error)})
    return decoded(data, file)


def encoding_of(data: bytes) -> tuple[bytes, str]:
    """The mark at the beginning of a text and the encoding that it tells; UTF-8 without one."""
    return next(((mark, codec) for mark, codec in ENCODINGS.items() if data.startswith(mark)), (b"", "utf-8"))


def decoded(data: bytes, file: str) -> str | Fault:
    """The text of bytes, or where they are none: UTF-8, or UTF-16 with its mark, as Notepad and PowerShell write it."""
    mark, codec = encoding_of(data)
    content, broken = data.removeprefix(mark), False
    try:
        text = content.decode(codec)
    except UnicodeDecodeError as error:
        text, broken = content[: error.start].decode(codec), True
    sound, nul, _ = text.partition("\0")
    if nul:
        return Fault("binary", mark_after(sound, file))
    return Fault("encoding", mark_after(text, file)) if broken else text


def read_text(text: str, file: str = "") -> Source:
    """As `read_source`, for text already at hand."""
    tabs = tuple(islice(_tabs(text, file), MOST_FAULTS))
    if tabs:
        return Source(file, text, faults=tabs)
    try:
        loader = _Loader(text, file)
    except yaml.reader.ReaderError as fault:
        return Source(file, text, faults=(Fault("control-character", mark_after(text[: fault.position], file)),))
    try:
        root = loader.get_single_node()
    except _StoppedError:
        return Source(file, text, faults=tuple(loader.faults))
    except yaml.MarkedYAMLError as fault:
        return Source(file, text, faults=(*loader.faults, _syntax(fault, file)))
    except ValueError:
        # A number in an escape or a directive that Python refuses to read.
        here = Mark(file, loader.line + 1, loader.column + 1)
        return Source(file, text, faults=(*loader.faults, Fault("syntax", here)))
    finally:
        loader.dispose()
    if root is None:
        return Source(file, text, faults=(*loader.faults, Fault("empty", Mark(file))))
    faults = [*loader.faults]
    top = _node(root, file, faults)
    if isinstance(top, Scalar) and top.null:
        faults.append(Fault("empty", Mark(file)))
    return Source(file, text, top, tuple(faults))


def read_words(path: Path) -> Source:
    """As `read_source`, for a file of the templates, which is trusted and long: libyaml reads it ten times faster.

    What libyaml refuses, and what is more than plain nodes, is read again with care, to say where the fault is.
    """
    text = text_in(path)
    return Source(str(path), faults=(text,)) if isinstance(text, Fault) else read_own(text, str(path))


def read_own(text: str, file: str = "") -> Source:
    """As `read_text`, for text of the program's own."""
    faults: list[Fault] = []
    try:
        if _MAY_BE_MORE.search(text) and _is_more(text):
            return read_text(text, file)
        root = yaml.compose(text, Loader=yaml.CSafeLoader)
    except (AttributeError, yaml.YAMLError):  # a PyYAML without libyaml has no such loader
        return read_text(text, file)
    top = root and _node(root, file, faults)
    return Source(file, text, top) if top and not faults else read_text(text, file)


def _is_more(text: str) -> bool:
    """Whether a text has an anchor, an alias or a tag."""
    events = yaml.parse(text, Loader=yaml.CSafeLoader)
    return any(isinstance(event, yaml.NodeEvent) and (event.anchor or getattr(event, "tag", None)) for event in events)


def plain(node: Node, said: Callable[[Scalar], str] = attrgetter("text")) -> Any:
    """Nodes as dict, list and str, or what else is `said` by a text; what was left empty is None."""
    match node:
        case Scalar(null=null, quoted=in_marks):
            text = None if null else said(node)
            return Quoted(text) if in_marks and type(text) is str else text
        case SequenceNode(items):
            return [plain(item, said) for item in items]
        case MappingNode(entries):
            return {key.text: plain(value, said) for key, value in entries}


class _StoppedError(Exception):
    """A file that is read no further; why is among the loader's faults."""


class _Loader(yaml.SafeLoader):
    """The safe loader, composing only, with tags, anchors, aliases, endless nesting and endless length refused."""

    def __init__(self, text: str, file: str) -> None:
        super().__init__(text)
        self.file = file
        self.faults: list[Fault] = []
        self.depth = 0

    def fetch_more_tokens(self) -> None:
        if self.tokens_taken > MOST_TOKENS:
            here = Mark(self.file, self.line + 1, self.column + 1)
            self.stop(Fault("too-long", here, {"most": str(MOST_TOKENS)}))
        scanner: Any = super()  # whose methods the stubs leave without types
        scanner.fetch_more_tokens()

    def compose_node(self, parent: yaml.Node | None, index: Any) -> yaml.Node | None:
        parser: Any = self
        event = parser.peek_event()
        ends = event.start_mark, event.end_mark
        mark = _mark(event.start_mark, self.file)
        if isinstance(parent, yaml.MappingNode) and index is None and len(parent.value) == MOST_KEYS:
            self.stop(Fault("too-many", mark, {"most": str(MOST_KEYS)}))
        if isinstance(event, yaml.AliasEvent):
            parser.get_event()
            self.add(Fault("alias", mark))
            return yaml.ScalarNode("tag:yaml.org,2002:null", "", *ends)
        if getattr(event, "anchor", None):
            self.add(Fault("alias", mark))
            self.anchors.pop(event.anchor, None)
        if getattr(event, "tag", None):
            self.add(Fault("tag", mark, {"tag": str(event.tag)}))
        self.depth += 1
        if self.depth > DEEPEST:
            self.stop(Fault("too-deep", mark, {"deepest": str(DEEPEST)}))
        node = super().compose_node(parent, index)
        self.depth -= 1
        return node

    def add(self, fault: Fault) -> None:
        self.faults.append(fault)
        if len(self.faults) >= MOST_FAULTS:
            raise _StoppedError

    def stop(self, fault: Fault) -> NoReturn:
        self.faults.append(fault)
        raise _StoppedError


def _mark(place: yaml.Mark, file: str) -> Mark:
    return Mark(file, place.line + 1, place.column + 1)


def _node(node: yaml.Node, file: str, faults: list[Fault]) -> Node:
    mark = _mark(node.start_mark, file)
    if isinstance(node, yaml.SequenceNode):
        return SequenceNode(tuple(_node(item, file, faults) for item in node.value), mark)
    if isinstance(node, yaml.MappingNode):
        return MappingNode(tuple(_entries(node, file, faults)), mark)
    style = getattr(node, "style", None) or None  # libyaml calls that of a plain scalar ""
    if style is None and "\t" in node.value:
        faults.append(Fault("tab", mark))
    return Scalar(node.value, mark, null=style is None and node.value in _NULL, quoted=style in ("'", '"'))


def _entries(node: yaml.MappingNode, file: str, faults: list[Fault]) -> Iterator[tuple[Scalar, Node]]:
    """The entries of a mapping; a key met again is a fault and is left out."""
    seen: dict[str, Mark] = {}
    for key_node, value_node in _rejoined(node):
        key, value = _node(key_node, file, faults), _node(value_node, file, faults)
        if not isinstance(key, Scalar):
            faults.append(Fault("wrong-type", key.mark, {"expected": "text"}))
            continue
        name = unicodedata.normalize("NFC", key.text)
        if name in seen:
            faults.append(Fault("duplicate-key", key.mark, {"key": key.text, "line": str(seen[name].line)}))
            continue
        seen[name] = key.mark
        yield Scalar(name, key.mark), value


def _rejoined(node: yaml.MappingNode) -> list[tuple[yaml.Node, yaml.Node]]:
    """The entries of a mapping, a number with a comma as one text again: {F: 1,600 N} has no key “600 N”."""
    entries: list[tuple[yaml.Node, yaml.Node]] = []
    for key, value in node.value:
        if node.flow_style and entries and _is_parted(entries[-1][1], key, value):
            named, before = entries[-1]
            text = f"{before.value},{key.value}"
            entries[-1] = named, yaml.ScalarNode(before.tag, text, before.start_mark, key.end_mark)
        else:
            entries.append((key, value))
    return entries


def _is_parted(before: yaml.Node, key: yaml.Node, value: yaml.Node) -> bool:
    """Whether a value and the key without a value after it are what stands before and behind a comma in a number."""
    ends = before.end_mark.index, key.start_mark.index, key.end_mark.index, value.end_mark.index
    numbers = all(isinstance(one, yaml.ScalarNode) and not one.style for one in (before, key))
    return (
        numbers
        and ends[1] == ends[0] + 1
        and ends[2] == ends[3]
        and re.fullmatch(r"[+-]?[0-9]+(?:,[0-9]+)*", before.value) is not None
        and key.value[:1].isdigit()
    )


def _tabs(text: str, file: str) -> Iterator[Fault]:
    """Tabs that stand where YAML wants blanks: in front of a line or right after a key."""
    for number, line in enumerate(re.split(r"\r\n|\r|\n", text), start=1):
        if match := re.match(r" *(?:[\w.-]+:)?(\t)", line):
            yield Fault("tab", Mark(file, number, match.start(1) + 1))


def _syntax(fault: yaml.MarkedYAMLError, file: str) -> Fault:
    place = fault.problem_mark or fault.context_mark
    mark = _mark(place, file) if place else Mark(file)
    problem = f"{fault.context or ''} {fault.problem or ''}"
    if "'\\t'" in problem:
        return Fault("tab", mark)
    hint = next((key for words, key in _SYNTAX if words in problem), "syntax")
    return Fault("syntax", mark, {"hint": hint})


def mark_after(before: str, file: str) -> Mark:
    """The place right after a piece of text from the beginning of a file."""
    return Mark(file, before.count("\n") + 1, len(before) - before.rfind("\n"))


# --- assignment files with values put into them ---------------------------------------------------
# First as nodes, then as text.
# What was not changed stays as it stands in the source, comments included, wherever a key has lines of its own; the
# rest is written anew. `text_of` reads its own text again: a form it could not keep is written anew as a whole.

WIDTH = 100
_PLAIN = re.compile(r"[^\W\d_][\w/^²³⁴·.@-]*( [\w/^²³⁴·.@-]+)*|[+-]?[0-9.][\w./^²³⁴·+-]*( [\w./^²³⁴·*+-]+)*")
_RESERVED = re.compile(r"(~|null|true|false|yes|no|on|off|)", re.IGNORECASE)
_ESCAPES = {'"': '\\"', "\\": "\\\\", "\n": "\\n", "\t": "\\t", "\r": "\\r"}


def at(node: Node | None, where: Where) -> Node | None:
    """The node at a place; None if there is none."""
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
    """The node with `value` at a place; missing tables on the way are made, lists are not made longer."""
    if not where:
        return value
    step, rest = where[0], where[1:]
    if isinstance(node, SequenceNode):
        items = tuple(put(item, rest, value) if k == step else item for k, item in enumerate(node.items))
        return replace(node, items=items)
    entries = node.entries if isinstance(node, MappingNode) else ()
    if step not in [key.text for key, _ in entries]:
        entries = (*entries, (Scalar(str(step), value.mark), MappingNode((), value.mark)))
    changed = tuple((key, put(old, rest, value) if key.text == step else old) for key, old in entries)
    return MappingNode(changed, node.mark)


def without(table: MappingNode, keys: Collection[str]) -> MappingNode:
    """The table without some of its keys."""
    return replace(table, entries=tuple(entry for entry in table.entries if entry[0].text not in keys))


def path_text(where: Where) -> str:
    """A place as users write it: parameters.H, parameters.groups.0.length."""
    return ".".join(map(str, where))


def text_of(table: MappingNode, source: str, original: MappingNode) -> str:
    """The file of a table whose unchanged parts are those of `original`, which was read from `source`."""
    kept = _block(table, original, source.splitlines(), 0)
    read = read_own(kept)
    agrees = not read.faults and read.top is not None and plain(read.top) == plain(table)
    return kept if agrees else _lines(table, 0)


def quoted(text: str, always: bool = False) -> str:
    """A scalar of YAML that is read as exactly this text."""
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
    """A table in block form: entries that are the very ones of the source by their lines, others anew."""
    spans = _spans(original, lines)
    text = ""
    for key, value in table.entries:
        entry = original.find(key.text)
        span = spans.get(key.text)
        if entry is None or span is None:
            # Before the blank lines that separate this table from what follows it.
            full = text.rstrip("\n") + "\n" if text.strip() else text
            text = full + _entry(key, value, depth) + text[len(full) :]
        elif value is entry[1]:
            text += _joined(span)
        elif isinstance(value, MappingNode) and isinstance(entry[1], MappingNode) and _is_block(entry[0], entry[1]):
            start = entry[0].mark.line - 1
            text += _joined(lines[start : entry[1].mark.line - 1])
            text += _block(value, entry[1], lines[: start + len(span)], entry[1].mark.column - 1)
        else:
            text += _with_comment(_entry(key, value, depth), span, value)
    return text


def _joined(lines: Sequence[str]) -> str:
    return "".join(f"{line}\n" for line in lines)


def _is_block(key: Scalar, table: MappingNode) -> bool:
    return bool(table.entries) and table.mark.line > key.mark.line and table.mark == table.entries[0][0].mark


def _spans(table: MappingNode, lines: Sequence[str]) -> dict[str, Sequence[str]]:
    """The lines of each entry, up to the next; none for entries that share lines."""
    keys = [key for key, _ in table.entries]
    starts = [key.mark.line for key in keys]
    shared = any(lines[key.mark.line - 1][: key.mark.column - 1].strip() for key in keys)
    if not keys or shared or len(set(starts)) < len(starts):
        return {}
    ends = [*(line - 1 for line in starts[1:]), len(lines)]
    return {key.text: lines[start - 1 : end] for key, start, end in zip(keys, starts, ends, strict=True)}


def _with_comment(entry: str, span: Sequence[str], value: Node) -> str:
    """An entry written anew, with the comment of its old line and the lines of comment after it."""
    after = []
    for line in reversed(span[1:]):
        if line.strip() and not line.lstrip().startswith("#"):
            break
        after.append(line)
    comment = re.search(r"\s+#[^'\"]*$", span[0]) if isinstance(value, Scalar) else None
    return _joined([entry.rstrip("\n") + (comment[0] if comment else ""), *reversed(after)])


def _entry(key: Scalar, value: Node, depth: int) -> str:
    """A key and its value, in one line if that is short or there is nothing in it."""
    name, space = quoted(key.text), " " * depth
    flow = _flow(value)
    if isinstance(value, Scalar) or flow in ("[]", "{}") or len(space) + len(name) + len(flow) + 2 <= WIDTH:
        return f"{space}{name}: {flow}".rstrip() + "\n"
    if isinstance(value, MappingNode):
        return f"{space}{name}:\n{_lines(value, depth + 2)}"
    return _joined([f"{space}{name}:", *(line for item in value.items for line in _item(item, depth + 2))])


def _item(item: Node, depth: int) -> list[str]:
    """An item of a list in one line; a long table with tables in it by its entries."""
    flow = _flow(item)
    nested = isinstance(item, MappingNode) and any(isinstance(value, MappingNode) for _, value in item.entries)
    if depth + 2 + len(flow) <= WIDTH or not isinstance(item, MappingNode) or not nested:
        return [f"{' ' * depth}- {flow}"]
    first, *others = _lines(item, depth + 2).splitlines()
    return [f"{' ' * depth}- {first.lstrip()}", *others]


def _lines(table: MappingNode, depth: int) -> str:
    return "".join(_entry(key, value, depth) for key, value in table.entries)


def _flow(node: Node) -> str:
    match node:
        case Scalar(text, null=null, quoted=in_marks):
            return "" if null else quoted(text, in_marks)
        case SequenceNode(items):
            return f"[{', '.join(_flow(item) for item in items)}]"
        case MappingNode(entries):
            return "{" + ", ".join(f"{quoted(key.text)}: {_flow(value)}".rstrip() for key, value in entries) + "}"
