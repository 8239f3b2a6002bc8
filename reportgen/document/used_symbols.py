"""Find the symbols that occur in a document, for its list of symbols."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from reportgen.base.records import replace
from reportgen.document import (
    Block,
    Emph,
    Equation,
    Figure,
    Inline,
    InlineMath,
    List,
    Paragraph,
    Plate,
    Strong,
    Table,
    Text,
)
from reportgen.drawing import Label, Scene
from reportgen.formula import Chain, Expression, Number, Symbol, VectorEquation, children

LEAST_WORD = 4
"""Smallest number of letters of a text that is neither a unit nor a verdict."""


def used_symbols(blocks: Iterable[Block]) -> frozenset[Symbol]:
    """Return the symbols of texts, equations, tables and figures; a vector counts as the symbol of its magnitude."""
    rest = list(_expressions(blocks))
    # Most symbols occur many times as one object, so comparing identities is faster than comparing contents.
    symbols: dict[int, Symbol] = {}
    while rest:
        node = rest.pop()
        if isinstance(node, Symbol):
            symbols[id(node)] = node
        elif not isinstance(node, Number):
            rest += children(node)
        if isinstance(node, VectorEquation):
            known = (entry for side in node.sides for term in side for entry in term.known)
            rest += (entry for entry in known if entry is not None and not isinstance(entry, str))
    return frozenset(replace(one, over="") if one.over == "vector" else one for one in set(symbols.values()))


def explained(blocks: Iterable[Block]) -> frozenset[Symbol]:
    """Return the symbols that are named where they are used: in a sentence, or in a row of a table that has words.

    A symbol named for both wheels, without their numbers, explains both.
    """
    return frozenset(_named(blocks))


def is_explained(symbol: Symbol, known: frozenset[Symbol]) -> bool:
    """Return True if the symbol is explained, itself or without the number of its wheel."""
    return symbol in known or replace(symbol, sub=symbol.sub.rstrip("0123456789")) in known


def _named(blocks: Iterable[Block]) -> Iterator[Symbol]:
    for block in blocks:
        match block:
            case Paragraph(inlines=inlines):
                yield from filter(None, map(_symbol, _of(inlines)))
            case Table(rows=rows):
                for row in rows:
                    texts = [one.text for cell in row for one in cell.inlines if isinstance(one, Text)]
                    if any(map(_is_word, texts)):
                        for cell in row:
                            if len(cell.inlines) == 1:
                                yield from filter(None, map(_symbol, _of(cell.inlines)))
            case List(items=items):
                for item in items:
                    yield from _named(item)


def _symbol(expression: Expression) -> Symbol | None:
    """Return the subject of an expression: a symbol, or the symbol whose value it gives."""
    first = expression.parts[0] if isinstance(expression, Chain) else expression
    return first if isinstance(first, Symbol) else None


def _is_word(text: str) -> bool:
    return sum(letter.isalpha() for letter in text) >= LEAST_WORD


def _expressions(blocks: Iterable[Block]) -> Iterator[Expression]:
    for block in blocks:
        match block:
            case Equation(rows=rows):
                yield from rows
            case Paragraph(inlines=inlines):
                yield from _of(inlines)
            case Figure(scenes, inlines):
                yield from _of(inlines)
                yield from (label for scene in scenes for label in _labels(scene))
            case Plate(scene, caption=inlines):
                yield from _of(inlines)
                yield from _labels(scene)
            case Table():
                yield from _of(block.caption)
                for row in (*block.head, *block.rows):
                    for cell in row:
                        yield from _of(cell.inlines)
            case List(items=items):
                for item in items:
                    yield from _expressions(item)


def _labels(scene: Scene) -> Iterator[Expression]:
    return (one.content for one in scene.items if isinstance(one, Label) and not isinstance(one.content, str))


def _of(inlines: Iterable[Inline]) -> Iterator[Expression]:
    for inline in inlines:
        if isinstance(inline, InlineMath):
            yield inline.expression
        elif isinstance(inline, (Emph, Strong)):
            yield from _of(inline.of)
