"""What is printed in a document, found in its tree: expressions, chains, numbers."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import pairwise

from reportgen.base.units import Language
from reportgen.document import (
    Block,
    Cell,
    Document,
    Emph,
    Equation,
    Figure,
    InlineMath,
    Inlines,
    Paragraph,
    Plate,
    Section,
    Strong,
    Table,
    Value,
)
from reportgen.drawing import Label
from reportgen.formula import Chain, Expression, Number, Symbol, Term, VectorEquation, walk
from reportgen.formula.ledger import Ledger
from reportgen.writers.typst_math import TypstFormulas
from tests.report import built
from tests.report.calculator import Line
from tests.report.source_lines import typst_formula, worked_lines


def steps(chain: Chain) -> Iterator[tuple[Expression, Number]]:
    """(numbers put in, result) of a chain; its symbolic parts and bare results are no steps."""
    for left, right in pairwise(chain.parts):
        if isinstance(right, Number) and not any(
            isinstance(node, Symbol) and node.value is None for node in walk(left)
        ):
            yield left, right


def lines(chains: Iterable[Chain], language: Language) -> list[Line]:
    """The worked lines of chains as a source has them, without a document around."""
    formulas = TypstFormulas(language)
    return worked_lines(typst_formula(formulas.math(chain)) for chain in chains)


def every_chain(ledger: Ledger) -> Iterator[Chain]:
    """The lines of a printed ledger at every position."""
    for id, family in ledger.families.items():
        if not (family.hidden or family.is_plane):
            yield from (ledger.chain(id, position) for position in range(1, len(family.values) + 1))


def expressions(document: Document) -> Iterator[Expression]:
    """Every expression printed in a document: rows, formulas in lines and tables, labels of drawings."""
    for block in built.walk(document.blocks):
        yield from _of_block(block)
    for _, scene in built.scenes(document):
        for item in scene.items:
            if isinstance(item, Label) and not isinstance(item.content, str):
                yield item.content


def _of_block(block: Block) -> Iterator[Expression]:
    match block:
        case Equation(rows):
            for row in rows:
                yield row
                if isinstance(row, VectorEquation):
                    yield from _known(term for side in row.sides for term in side)
        case Section(_, inlines) | Paragraph(inlines):
            yield from _of_inlines(inlines)
        case Table(_, head, rows, caption):
            yield from _of_inlines(caption)
            for cells in (*head, *rows):
                yield from _of_cells(cells)
        case Figure(caption=caption) | Plate(caption=caption):
            yield from _of_inlines(caption)


def _known(terms: Iterator[Term]) -> Iterator[Expression]:
    for term in terms:
        yield from (entry for entry in term.known if entry is not None and not isinstance(entry, str))


def _of_cells(cells: tuple[Cell, ...]) -> Iterator[Expression]:
    for cell in cells:
        yield from _of_inlines(cell.inlines)


def _of_inlines(inlines: Inlines) -> Iterator[Expression]:
    for inline in inlines:
        match inline:
            case InlineMath(expression):
                yield expression
            case Value(number):
                yield number
            case Emph(of) | Strong(of):
                yield from _of_inlines(of)


def chains(document: Document) -> Iterator[Chain]:
    for expression in expressions(document):
        yield from (node for node in walk(expression) if isinstance(node, Chain))


def numbers(document: Document) -> Iterator[Number]:
    for expression in expressions(document):
        yield from (node for node in walk(expression) if isinstance(node, Number))
