"""Read the blanks of a filled-in blank report, by their tags or else by the bookmarks around them."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence

from reportgen.handin.entry_collection import Gathering
from reportgen.handin.text_numbers import NUMBER, UNIT
from reportgen.handin.word_nodes import XmlNode
from reportgen.handin.word_text import TextLine, put
from reportgen.marking.blank_report import blanks
from reportgen.marking.marking_data import Place

_EMPTY = re.compile(r"[\s.…_]*")
_FILLED = re.compile(rf"\s*({NUMBER})\s*(?:[(\[]\s*({UNIT})\s*[)\]]|({UNIT}))?\s*[.,;]?\s*([^\d=]*)")


def read_blanks(tree: XmlNode, lines: Sequence[TextLine], gathering: Gathering) -> None:
    """Read the blanks of a report before its text; a place filled by one is not searched for elsewhere."""
    paragraphs = {node.number: line.number for line in lines for node in line.nodes}
    read: set[Place] = set()
    names = blanks(gathering.key)
    for place, content in (*_controls(tree, names), *_bookmarks(tree, names)):
        text = content.text
        if place in read or not content.nodes or _EMPTY.fullmatch(text):
            continue
        read.add(place)
        content.number = paragraphs.get(content.nodes[0].number, 0)
        row, (_, position) = gathering.key.row(place[0]), place
        match = _FILLED.fullmatch(text)
        location = gathering.location(content, match.start(1) if match else 0)
        if match is None:
            gathering.doubt(row, position, "unread-number", location, text)
        else:
            unit = match[2] or match[3] or ""
            gathering.number(row, position, match[1], unit, location, words=match[4] or "")
    gathering.fixed = frozenset(read)


def _controls(tree: XmlNode, names: Mapping[str, Place]) -> Iterator[tuple[Place, TextLine]]:
    """Yield the content of the content controls whose tag is one of the names."""
    for node in tree.walk():
        if node.tag != "w:sdt":
            continue
        tag, content = node.at("w:sdtPr", "w:tag"), node.child("w:sdtContent")
        place = names.get(tag.get("w:val")) if tag is not None else None
        if place is not None and content is not None and node.at("w:sdtPr", "w:showingPlcHdr") is None:
            yield place, _text(content.children)


def _bookmarks(tree: XmlNode, names: Mapping[str, Place]) -> Iterator[tuple[Place, TextLine]]:
    """Yield the content between the start and the end of the bookmarks with one of the names."""
    for node in tree.walk():
        if node.tag != "w:bookmarkStart" or node.parent is None or (place := names.get(node.get("w:name"))) is None:
            continue
        within: list[XmlNode] = []
        for sibling in node.parent.children[node.parent.children.index(node) + 1 :]:
            if sibling.tag == "w:bookmarkEnd" and sibling.get("w:id") == node.get("w:id"):
                yield place, _text(within)
                break
            within.append(sibling)


def _text(nodes: Sequence[XmlNode]) -> TextLine:
    line = TextLine(0)
    put(nodes, line)
    return line
