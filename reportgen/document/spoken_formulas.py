"""Speech for the formulas of a document.

It collects all symbols before it says one, so that no two symbols sound alike.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from reportgen.document import (
    Block,
    Document,
    Emph,
    Equation,
    Figure,
    Inline,
    InlineMath,
    List,
    Paragraph,
    Plate,
    Section,
    Strong,
    Table,
)
from reportgen.formula import Expression, Symbol, VectorEquation, children
from reportgen.formula.formula_speech import Speech


def speech(document: Document) -> Speech:
    """Return the speech for the formulas of a document."""
    return Speech(document.language, document.words.speech, symbols(document.blocks))


def symbols(blocks: Iterable[Block]) -> Iterator[Symbol]:
    """Yield the symbols of all formulas as often as they are printed, without those in labels of drawings."""
    rest = list(_formulas(blocks))
    while rest:
        node = rest.pop()
        if isinstance(node, Symbol):
            yield node
            continue
        rest += children(node)
        if isinstance(node, VectorEquation):
            rest += (
                entry
                for side in node.sides
                for term in side
                for entry in term.known
                if entry and not isinstance(entry, str)
            )


def _formulas(blocks: Iterable[Block]) -> Iterator[Expression]:
    for block in blocks:
        match block:
            case Equation(rows):
                yield from rows
            case Section(title=inlines) | Paragraph(inlines) | Figure(caption=inlines) | Plate(caption=inlines):
                yield from _in_line(inlines)
            case List(items):
                for item in items:
                    yield from _formulas(item)
            case Table(head=head, rows=rows, caption=caption):
                yield from _in_line(caption)
                for row in (*head, *rows):
                    for cell in row:
                        yield from _in_line(cell.inlines)


def _in_line(inlines: Iterable[Inline]) -> Iterator[Expression]:
    for inline in inlines:
        match inline:
            case InlineMath(expression):
                yield expression
            case Emph(of) | Strong(of):
                yield from _in_line(of)
