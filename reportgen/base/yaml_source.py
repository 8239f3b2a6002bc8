"""Parse a YAML file into nodes that know their places.

No values are constructed: a scalar stays the text that was typed, so `2011-03-24`, `1/3.6` and `no` reach their
readers unchanged. Anything beyond mappings, lists and scalars (tags, anchors, aliases) is a fault here. Memory and
time are bounded even for hostile text: tokens, keys and faults are counted while reading.
"""

from __future__ import annotations

import codecs
import re
import unicodedata
from collections.abc import Callable, Iterator
from itertools import islice
from operator import attrgetter
from pathlib import Path
from typing import Any, NoReturn

import yaml

from reportgen.base import chinese, cyrillic
from reportgen.base.errors import Fault, Location
from reportgen.base.files import cause, contents
from reportgen.base.records import Record, replace, uncompared
from reportgen.base.typing_mistakes import misplaced, open_quote, slips_above

ENCODINGS = {codecs.BOM_UTF8: "utf-8", codecs.BOM_UTF16_LE: "utf-16-le", codecs.BOM_UTF16_BE: "utf-16-be"}
"""Byte-order marks and the encodings that they indicate."""
FILE_STARTS = {
    b"PK\x03\x04": "ZIP",
    b"%PDF": "PDF",
    b"\x89PNG": "PNG",
    b"\xff\xd8\xff": "JPEG",
    b"GIF8": "GIF",
    b"\xd0\xcf\x11\xe0": "Word/Excel 97",
}
"""First bytes of files that are often given in place of an assignment, and the names of their formats."""
PACKAGES = {b"word/": "Word (.docx)", b"xl/": "Excel (.xlsx)", b"content.xml": "OpenDocument"}
"""Names inside a zip package by which its format is recognised."""
LARGEST = 400_000
"""Largest size of a file (bytes)."""
MOST_TOKENS = 30_000
"""Largest number of values, keys and signs in a file; a table of 5 rows of 2000 values has two thirds of it."""
DEEPEST = 12
MOST_KEYS = 200
MOST_FAULTS = 100
"""Largest number of syntax faults; after that the file is read no further."""
_MAY_BE_MORE = re.compile(r"(?m)(?:^|[\s\[{,])[&*!]\S")
"""Pattern that matches anchors, aliases and tags, and a few other texts."""
STRANGE = re.compile(r"[\x00-\x1f\x7f-\x9f\u2028\u2029\ud800-\uf8ff\ufdd0-\ufdef\ufffe\uffff\U000f0000-\U0010ffff]")
"""Characters not allowed in a line of text: control and private characters, line ends, unassigned code points."""
_NULL = {"", "~", "null", "Null", "NULL"}
_OPENED = frozenset({"syntax-bracket", "syntax-quote"})
"""Hints about signs that open something, which are reported where it opens."""
_SYNTAX = (
    ("mapping values are not allowed", "syntax-colon"),
    ("expected ',' or", "syntax-bracket"),
    ("expected the node content", "syntax-bracket"),
    ("unexpected end of stream", "syntax-quote"),
    ("could not find expected ':'", "syntax-key"),
    ("expected <block end>", "syntax-indent"),
    ("single document", "syntax-document"),
)


Span = tuple[int, int]
"""Begin and end of a node in the text of its source: number of characters before it, and before the text that follows.
"""
NOWHERE: Span = (-1, -1)


@uncompared("span")
class Scalar(Record):
    """A piece of text; `null` if nothing was written, `quoted` if it is in quotation marks.

    Like that of every node, `span` gives the characters of the source between which it was written.
    """

    text: str
    location: Location
    null: bool = False
    quoted: bool = False
    span: Span = NOWHERE


class Quoted(str):
    """A text in quotation marks: it is not a number, even if it looks like one."""

    __slots__ = ()


@uncompared("span")
class SequenceNode(Record):
    items: tuple[Node, ...]
    location: Location
    span: Span = NOWHERE


@uncompared("span")
class MappingNode(Record):
    """A mapping: its entries in the order of the file, each key once."""

    entries: tuple[tuple[Scalar, Node], ...]
    location: Location
    span: Span = NOWHERE

    def find(self, key: object) -> tuple[Scalar, Node] | None:
        return next((entry for entry in self.entries if entry[0].text == key), None)


Node = Scalar | SequenceNode | MappingNode


class Source(Record):
    """A file as read: its top node (None if it could not be read) and the faults found while reading."""

    file: str
    text: str = ""
    top: Node | None = None
    faults: tuple[Fault, ...] = ()


def in_a_line(text: str) -> str:
    """Return a text that was typed in several lines as one line."""
    return " ".join(text.rstrip("\n").split("\n")) if "\n" in text else text


def scalars(node: Node | None) -> Iterator[Scalar]:
    """Yield all scalars of a table."""
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
    """Return the nodes of a file; every fault of its bytes and syntax is in `faults`, and none is raised."""
    text = text_in(path)
    return Source(str(path), faults=(text,)) if isinstance(text, Fault) else read_text(text, str(path))


def text_in(path: Path) -> str | Fault:
    """Return the text of a file, or the fault that prevents reading it."""
    file = str(path)
    try:
        data = contents(path, LARGEST + 1)
        if len(data) > LARGEST:
            return Fault("too-large", Location(file), {"largest": str(LARGEST // 1000)})
    except IsADirectoryError as error:
        about = {"reason": cause(error), "known": str(path.resolve()), "hint": "folder"}
        return Fault("unreadable", Location(file), about)
    except OSError as error:
        return Fault("unreadable", Location(file), {"reason": cause(error)})
    if kind := next((name for start, name in FILE_STARTS.items() if data.startswith(start)), ""):
        named = next((name for part, name in PACKAGES.items() if part in data), kind) if kind == "ZIP" else kind
        return Fault("not-yaml", Location(file), {"text": named})
    return decoded(data, file)


def encoding_of(data: bytes) -> tuple[bytes, str]:
    """Return the byte-order mark of a text and the encoding that it indicates; without one UTF-8, GBK or cp1251."""
    marked = ((mark, codec) for mark, codec in ENCODINGS.items() if data.startswith(mark))
    if known := next(marked, None):
        return known
    try:
        data.decode()
    except UnicodeDecodeError:
        if chinese.is_gbk(data):
            return b"", chinese.CODEC
        return b"", cyrillic.CODEC if cyrillic.is_cp1251(data) else "utf-8"
    return b"", "utf-8"


def decoded(data: bytes, file: str) -> str | Fault:
    """Return the text of bytes, or a fault at the place where they cannot be decoded.

    They are UTF-8, or UTF-16 with its mark, as Notepad and PowerShell write it, Chinese in GBK, or Russian in
    cp1251.
    """
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
    """Parse a text that is already in memory, like `read_source`."""
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
        lines = _lines(text)
        error = _syntax(fault, file, lines)
        if error.arguments.get("hint") == "syntax-indent":
            error = replace(error, location=misplaced(lines, error.location))
        return Source(file, text, faults=(*loader.faults, *(slips_above(lines, error.location.line, file) or [error])))
    except ValueError:
        # A number in an escape or a directive that Python refuses to read.
        here = Location(file, loader.line + 1, loader.column + 1)
        return Source(file, text, faults=(*loader.faults, Fault("syntax", here)))
    finally:
        loader.dispose()
    if root is None:
        return Source(file, text, faults=(*loader.faults, Fault("empty", Location(file))))
    faults = [*loader.faults]
    top = _node(root, file, faults)
    if isinstance(top, Scalar) and top.null:
        faults.append(Fault("empty", Location(file)))
    return Source(file, text, top, tuple(faults))


def read_words(path: Path) -> Source:
    """Read a template file like `read_source`; it is trusted and long, and libyaml reads it ten times faster.

    A file that libyaml refuses, or that has more than plain nodes, is read again with care, to locate the fault.
    """
    text = text_in(path)
    return Source(str(path), faults=(text,)) if isinstance(text, Fault) else read_own(text, str(path))


def read_own(text: str, file: str = "") -> Source:
    """Parse text of the program's own templates like `read_text`."""
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
    """Return True if a text has an anchor, an alias or a tag."""
    events = yaml.parse(text, Loader=yaml.CSafeLoader)
    return any(isinstance(event, yaml.NodeEvent) and (event.anchor or getattr(event, "tag", None)) for event in events)


def plain(node: Node, said: Callable[[Scalar], str] = attrgetter("text")) -> Any:
    """Return nodes as dict, list and str, or the result of `said` for a text; an empty value is None."""
    match node:
        case Scalar(null=null, quoted=in_marks):
            text = None if null else said(node)
            return Quoted(text) if in_marks and type(text) is str else text
        case SequenceNode(items):
            return [plain(item, said) for item in items]
        case MappingNode(entries):
            return {key.text: plain(value, said) for key, value in entries}


class _StoppedError(Exception):
    """Reading of the file stops; the reason is among the loader's faults."""


class _Loader(yaml.SafeLoader):
    """The safe loader, composing only, with tags, anchors, aliases, endless nesting and endless length refused."""

    def __init__(self, text: str, file: str) -> None:
        super().__init__(text)
        self.file = file
        self.faults: list[Fault] = []
        self.depth = 0

    def fetch_more_tokens(self) -> None:
        if self.tokens_taken > MOST_TOKENS:
            here = Location(self.file, self.line + 1, self.column + 1)
            self.stop(Fault("too-long", here, {"most": str(MOST_TOKENS)}))
        scanner: Any = super()  # whose methods the stubs leave without types
        scanner.fetch_more_tokens()

    def compose_node(self, parent: yaml.Node | None, index: Any) -> yaml.Node | None:
        parser: Any = self
        event = parser.peek_event()
        ends = event.start_mark, event.end_mark
        location = _location(event.start_mark, self.file)
        if isinstance(parent, yaml.MappingNode) and index is None and len(parent.value) == MOST_KEYS:
            self.stop(Fault("too-many", location, {"most": str(MOST_KEYS)}))
        if isinstance(event, yaml.AliasEvent):
            parser.get_event()
            self.add(Fault("alias", location))
            return yaml.ScalarNode("tag:yaml.org,2002:null", "", *ends)
        if getattr(event, "anchor", None):
            self.add(Fault("alias", location))
            self.anchors.pop(event.anchor, None)
        if getattr(event, "tag", None):
            self.add(Fault("tag", location, {"tag": str(event.tag)}))
        self.depth += 1
        if self.depth > DEEPEST:
            self.stop(Fault("too-deep", location, {"deepest": str(DEEPEST)}))
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


def _location(place: yaml.Mark, file: str) -> Location:
    return Location(file, place.line + 1, place.column + 1)


def _node(node: yaml.Node, file: str, faults: list[Fault]) -> Node:
    location = _location(node.start_mark, file)
    start, end = node.start_mark.index, node.end_mark.index
    if isinstance(node, yaml.SequenceNode):
        items = tuple(_node(item, file, faults) for item in node.value)
        # A list in block form ends with its last item, not where the next thing begins.
        return SequenceNode(items, location, (start, end if node.flow_style or not items else items[-1].span[1]))
    if isinstance(node, yaml.MappingNode):
        entries = tuple(_entries(node, file, faults))
        return MappingNode(
            entries, location, (start, end if node.flow_style or not entries else entries[-1][1].span[1])
        )
    style = getattr(node, "style", None) or None  # libyaml gives a plain scalar the style ""
    if style is None and "\t" in node.value:
        faults.append(Fault("tab", location))
    null, in_marks = style is None and node.value in _NULL, style in ("'", '"')
    return Scalar(node.value, location, null=null, quoted=in_marks, span=(start, end))


def _entries(node: yaml.MappingNode, file: str, faults: list[Fault]) -> Iterator[tuple[Scalar, Node]]:
    """Yield the entries of a mapping; a key met again is a fault and is left out."""
    seen: dict[str, Location] = {}
    for key_node, value_node in _rejoined(node):
        key, value = _node(key_node, file, faults), _node(value_node, file, faults)
        if not isinstance(key, Scalar):
            faults.append(Fault("wrong-type", key.location, {"expected": "text"}))
            continue
        name = unicodedata.normalize("NFC", key.text)
        if name in seen:
            faults.append(Fault("duplicate-key", key.location, {"key": key.text, "line": str(seen[name].line)}))
            continue
        seen[name] = key.location
        yield Scalar(name, key.location, span=key.span), value


def _rejoined(node: yaml.MappingNode) -> list[tuple[yaml.Node, yaml.Node]]:
    """Return the entries of a mapping, a number with a comma as one text again: {F: 1,600 N} has no key “600 N”."""
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
    """Return True if a value and the next key, which has no value, are the parts of a number before and after a
    comma.
    """
    ends = before.end_mark.index, key.start_mark.index, key.end_mark.index, value.end_mark.index
    numbers = all(isinstance(one, yaml.ScalarNode) and not one.style for one in (before, key))
    return (
        numbers
        and ends[1] == ends[0] + 1
        and ends[2] == ends[3]
        and re.fullmatch(r"[+\-\N{MINUS SIGN}]?[0-9]+(?:[.,][0-9]+)*", before.value) is not None
        and key.value[:1].isdigit()
    )


def _tabs(text: str, file: str) -> Iterator[Fault]:
    """Yield tabs in places where YAML requires blanks: at the beginning of a line or right after a key."""
    for number, line in enumerate(_lines(text), start=1):
        if match := re.match(r" *(?:[\w.-]+:)?(\t)", line):
            yield Fault("tab", Location(file, number, match.start(1) + 1))


def _lines(text: str) -> list[str]:
    return re.split(r"\r\n|\r|\n", text)


def _syntax(fault: yaml.MarkedYAMLError, file: str, lines: list[str]) -> Fault:
    """Return the fault of a text that is not YAML, where a quote or bracket opens if that is left open."""
    place = fault.problem_mark or fault.context_mark
    location = _location(place, file) if place else Location(file)
    problem = f"{fault.context or ''} {fault.problem or ''}"
    if "'\\t'" in problem:
        return Fault("tab", location)
    hint = next((key for words, key in _SYNTAX if words in problem), "syntax")
    if (quote := open_quote(lines[: location.line], file)) is not None:
        return Fault("syntax", quote, {"hint": "syntax-quote"})
    if hint in _OPENED and fault.context_mark is not None:
        location = _location(fault.context_mark, file)
    return Fault("syntax", location, {"hint": hint})


def mark_after(before: str, file: str) -> Location:
    """Return the location directly after a piece of text from the beginning of a file."""
    return Location(file, before.count("\n") + 1, len(before) - before.rfind("\n"))
