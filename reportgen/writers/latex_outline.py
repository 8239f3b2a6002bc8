"""What contents, outline and links know of a document: its headings, its keys, their plain words."""

from __future__ import annotations

import unicodedata
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from reportgen.document.tree import (
    Block,
    Emph,
    Equation,
    Figure,
    InlineMath,
    Inlines,
    List,
    Plate,
    Reference,
    Section,
    Strong,
    Table,
    Text,
)

CONTENTS_LEVEL = 3
"""The deepest level of heading that the contents and the outline list."""


@dataclass(frozen=True, slots=True)
class Entry:
    """A heading as contents and outline need it; `below` counts the headings directly under it."""

    section: Section
    place: str
    below: int


def entries_of(blocks: Sequence[Block]) -> Iterator[Entry]:
    """The headings that contents and outline list, in order."""
    sections = [block for block in blocks if isinstance(block, Section) and block.level <= CONTENTS_LEVEL]
    for index, section in enumerate(sections):
        below = 0
        for later in sections[index + 1 :]:
            if later.level <= section.level:
                break
            below += later.level == section.level + 1
        yield Entry(section, f"s{index}", below)


def keys_of(blocks: Sequence[Block]) -> Iterator[str]:
    """What blocks, and those inside lists, are called by references."""
    for block in blocks:
        match block:
            case List(items):
                for item in items:
                    yield from keys_of(item)
            case Section() | Equation() | Table() | Figure() | Plate():
                if block.key:
                    yield block.key


def plain(inlines: Inlines) -> str:
    """The words of a title for the outline, which knows no formulas."""
    words = []
    for inline in inlines:
        match inline:
            case Text(text) | Reference(text=text):
                words.append(text)
            case Emph(of) | Strong(of):
                words.append(plain(of))
            case InlineMath(expression):
                base, sub = getattr(expression, "base", ""), getattr(expression, "sub", "")
                words.append(f"{base}{sub}")
            case _:
                words.append(" ")
    return "".join(words)


def hexadecimal(text: str) -> str:
    """A text as a PDF string's content in UTF-16, in hexadecimal digits."""
    return "FEFF" + unicodedata.normalize("NFC", text).encode("utf-16-be").hex().upper()
