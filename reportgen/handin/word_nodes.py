"""Parse a part of a Word file into a tree of nodes with byte offsets, so that a copy changes only what is inserted."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import lru_cache
from typing import Any
from xml.parsers import expat

from reportgen.workbook.zip_package import Package

MOST_ELEMENTS = 300_000
"""Largest number of elements of a part; a report of a hundred pages with all its formulas has some 60 000."""
DEEPEST = 200
"""Deepest nesting of elements."""

_OPEN = "http://schemas.openxmlformats.org"
_STRICT = "http://purl.oclc.org/ooxml"
_NAMES = {
    f"{_OPEN}/wordprocessingml/2006/main": "w",
    f"{_STRICT}/wordprocessingml/main": "w",
    f"{_OPEN}/officeDocument/2006/math": "m",
    f"{_STRICT}/officeDocument/math": "m",
    f"{_OPEN}/officeDocument/2006/relationships": "r",
    f"{_STRICT}/officeDocument/relationships": "r",
    f"{_OPEN}/markup-compatibility/2006": "mc",
    "urn:schemas-microsoft-com:office:office": "o",
    "http://www.w3.org/XML/1998/namespace": "xml",
}
"""Prefixes by namespace; elements of other namespaces get "?"."""


@dataclass(slots=True, eq=False)
class XmlNode:
    """An element: its tag (`w:p`), attributes, content, and its bytes from `start` to `end`.

    `number` counts the elements of the part in order, from 0.
    """

    tag: str
    attributes: dict[str, str]
    number: int
    start: int
    parent: XmlNode | None = None
    end: int = 0
    children: list[XmlNode] = field(default_factory=list)
    pieces: list[str] = field(default_factory=list)
    unseen: bool = False
    """True for a run of invisible text."""

    @property
    def text(self) -> str:
        """The text directly in it."""
        return "".join(self.pieces)

    def get(self, name: str, otherwise: str = "") -> str:
        """Return an attribute."""
        return self.attributes.get(name, otherwise)

    def child(self, tag: str) -> XmlNode | None:
        """Return the first child with a tag."""
        return next((child for child in self.children if child.tag == tag), None)

    def at(self, *tags: str) -> XmlNode | None:
        """Return the descendant reached by the first child of each tag in turn, or None."""
        node: XmlNode | None = self
        for tag in tags:
            node = node.child(tag) if node else None
        return node

    def walk(self) -> Iterator[XmlNode]:
        """Yield the node and all its descendants in order."""
        pending = [self]
        while pending:
            node = pending.pop()
            yield node
            pending += reversed(node.children)

    @property
    def above(self) -> Iterator[XmlNode]:
        """The ancestors, the nearest first."""
        node = self.parent
        while node is not None:
            yield node
            node = node.parent


@lru_cache(maxsize=4096)
def _named(name: str) -> str:
    space, _, local = name.rpartition(" ")
    return f"{_NAMES.get(space, '?')}:{local}" if space else local


def parse(package: Package, name: str, content: bytes) -> XmlNode:
    """Return the tree of an XML part in UTF-8; raise `RefusedError` if damaged, too large or with a document type."""
    parser: Any = expat.ParserCreate("utf-8", namespace_separator=" ")
    parser.buffer_text = False
    count = 0
    top: XmlNode | None = None
    open_nodes: list[XmlNode] = []
    closed: list[XmlNode] = []
    """The single node whose end tag has been read; it ends where the next piece begins."""

    def settle() -> None:
        while closed:
            closed.pop().end = parser.CurrentByteIndex

    def start(tag: str, attributes: dict[str, str]) -> None:
        nonlocal count, top
        settle()
        if count >= MOST_ELEMENTS or len(open_nodes) >= DEEPEST:
            raise package.refused("sheet-beyond-elements", text=name, largest=str(MOST_ELEMENTS))
        parent = open_nodes[-1] if open_nodes else None
        named = {_named(key): value for key, value in attributes.items()}
        node = XmlNode(_named(tag), named, count, parser.CurrentByteIndex, parent)
        count += 1
        if parent is not None:
            parent.children.append(node)
        else:
            top = node
        open_nodes.append(node)

    def end(_: str) -> None:
        settle()
        closed.append(open_nodes.pop())

    def text(data: str) -> None:
        settle()
        if open_nodes:
            open_nodes[-1].pieces.append(data)

    def refuse(*_: object) -> None:
        raise package.refused("sheet-entities", text=name)

    parser.StartElementHandler, parser.EndElementHandler = start, end
    parser.CharacterDataHandler = text
    # Any other event ends a node, too.
    parser.CommentHandler = parser.ProcessingInstructionHandler = lambda *_: settle()
    parser.StartCdataSectionHandler = settle
    parser.StartDoctypeDeclHandler = parser.EntityDeclHandler = refuse
    try:
        parser.Parse(content, True)
    except (expat.ExpatError, UnicodeError):
        raise package.refused("sheet-damaged", text=name) from None
    if top is None:
        raise package.refused("sheet-damaged", text=name)
    for node in closed:
        node.end = len(content)
    return top
