"""The text of a YAML file as nodes that know where they stand.

Nothing is constructed: a scalar stays the text that was typed, so `2011-03-24`, `1/3.6` and `no` reach
their readers unharmed.  What the language offers beyond mappings, lists and scalars (tags, anchors,
aliases) is a fault here.  No text, however hostile, takes more than its size in memory or a second or two: tokens,
keys and faults are counted as they come.
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import islice
from pathlib import Path
from typing import Any, NoReturn

import yaml

from reportgen.errors import Fault, Mark

LARGEST = 400_000
"""Bytes of a file."""
MOST_TOKENS = 30_000
"""Values, keys and signs of a file; a table of 5 rows of 2000 values has two thirds of them."""
DEEPEST = 12
MOST_KEYS = 200
MOST_FAULTS = 100
"""After so many faults of its syntax a file is read no further."""
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
    """A piece of text; `null` when nothing was written."""

    text: str
    mark: Mark
    null: bool = False


@dataclass(frozen=True, slots=True)
class List:
    items: tuple[Node, ...]
    mark: Mark


@dataclass(frozen=True, slots=True)
class Table:
    """A mapping: its entries in the order of the file, each key once."""

    entries: tuple[tuple[Scalar, Node], ...]
    mark: Mark

    def find(self, key: object) -> tuple[Scalar, Node] | None:
        return next((entry for entry in self.entries if entry[0].text == key), None)


Node = Scalar | List | Table


@dataclass(frozen=True, slots=True)
class Source:
    """A file as read: its top node (None if it could not be read) and the faults met on the way."""

    file: str
    text: str = ""
    top: Node | None = None
    faults: tuple[Fault, ...] = ()


def read_source(path: Path) -> Source:
    """The nodes of a file; every fault of its bytes and syntax is in `faults`, none is raised."""
    file = str(path)
    try:
        with path.open("rb") as stream:
            data = stream.read(LARGEST + 1)
        if len(data) > LARGEST:
            fault = Fault("too-large", Mark(file), {"largest": str(LARGEST // 1000)})
        elif b"\0" in data:
            fault = Fault("binary", mark_in(data, data.index(b"\0"), file))
        else:
            return read_text(data.decode("utf-8-sig"), file)
    except OSError as error:
        fault = Fault("unreadable", Mark(file), {"reason": type(error).__name__})
    except UnicodeDecodeError as error:
        fault = Fault("encoding", mark_in(data, error.start, file))
    return Source(file, faults=(fault,))


def read_text(text: str, file: str = "") -> Source:
    """As `read_source`, for text already at hand."""
    tabs = tuple(islice(_tabs(text, file), MOST_FAULTS))
    if tabs:
        return Source(file, text, faults=tabs)
    try:
        loader = _Loader(text, file)
    except yaml.reader.ReaderError as fault:
        before = text[: fault.position].encode()
        return Source(file, text, faults=(Fault("control-character", mark_in(before, len(before), file)),))
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
    try:
        text = path.read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError):
        return read_source(path)
    return read_own(text, str(path))


def read_own(text: str, file: str = "") -> Source:
    """As `read_text`, for text of the program's own."""
    faults: list[Fault] = []
    try:
        events = yaml.parse(text, Loader=yaml.CSafeLoader)
        if any(isinstance(event, yaml.NodeEvent) and (event.anchor or getattr(event, "tag", None)) for event in events):
            return read_text(text, file)
        root = yaml.compose(text, Loader=yaml.CSafeLoader)
    except (AttributeError, yaml.YAMLError):  # a PyYAML without libyaml has no such loader
        return read_text(text, file)
    top = root and _node(root, file, faults)
    return Source(file, text, top) if top and not faults else read_text(text, file)


def plain(node: Node) -> Any:
    """Nodes as dict, list and str; what was left empty is None."""
    match node:
        case Scalar(text, null=null):
            return None if null else text
        case List(items):
            return [plain(item) for item in items]
        case Table(entries):
            return {key.text: plain(value) for key, value in entries}


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
        return List(tuple(_node(item, file, faults) for item in node.value), mark)
    if isinstance(node, yaml.MappingNode):
        return Table(tuple(_entries(node, file, faults)), mark)
    style = getattr(node, "style", None) or None  # libyaml calls that of a plain scalar ""
    if style is None and "\t" in node.value:
        faults.append(Fault("tab", mark))
    return Scalar(node.value, mark, null=style is None and node.value in _NULL)


def _entries(node: yaml.MappingNode, file: str, faults: list[Fault]) -> Iterator[tuple[Scalar, Node]]:
    """The entries of a mapping; a key met again is a fault and is left out."""
    seen: dict[str, Mark] = {}
    for key_node, value_node in node.value:
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


def mark_in(data: bytes, offset: int, file: str) -> Mark:
    """The place of a byte; columns count characters."""
    before = data[:offset]
    start = before.rfind(b"\n") + 1
    return Mark(file, before.count(b"\n") + 1, len(before[start:].decode("utf-8", "replace")) + 1)
