"""Convert a document into plain text: one line per paragraph or table row, with cells separated."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from reportgen.base.units import Language
from reportgen.document import (
    Block,
    Cell,
    Document,
    Emph,
    Equation,
    Inline,
    InlineMath,
    List,
    Paragraph,
    Reference,
    Section,
    Strong,
    Table,
    Text,
    Value,
)
from reportgen.formula import plain_text


def told(document: Document) -> str:
    """Return the text of a document without its figures."""
    return "\n".join(_lines(document.blocks, document.language))


def _lines(blocks: Iterable[Block], language: Language) -> Iterator[str]:
    for block in blocks:
        match block:
            case Section(title=inlines) | Paragraph(inlines=inlines):
                yield said(inlines, language)
            case List(items=items):
                for item in items:
                    yield from _lines(item, language)
            case Equation(rows=rows):
                yield from (plain_text.formula(row, language) for row in rows)
            case Table(head=head, rows=rows, caption=caption):
                yield f"[{said(caption, language)}]"
                yield from (" | ".join(_cell(cell, language) for cell in row) for row in (*head, *rows))
                yield ""


def _cell(cell: Cell, language: Language) -> str:
    return said(cell.inlines, language)


def said(inlines: Iterable[Inline], language: Language) -> str:
    """Return the text of inlines, with formulas in one line."""
    parts = []
    for inline in inlines:
        match inline:
            case Text(text=text) | Reference(text=text):
                parts.append(text)
            case Emph(of=of) | Strong(of=of):
                parts.append(said(of, language))
            case Value(number=number):
                parts.append(plain_text.quantity(number, language))
            case InlineMath(expression=expression):
                parts.append(plain_text.formula(expression, language))
            case _:
                parts.append(" ")
    return "".join(parts)
