"""The symbols that occur in a report, for the list of those that it uses."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace

from reportgen.drawing import Label, Scene
from reportgen.formula import Expression, Number, Symbol, VectorEquation, children
from reportgen.report import Block, Emph, Equation, Figure, Inline, InlineMath, List, Paragraph, Plate, Strong, Table


def occurring(blocks: Iterable[Block]) -> frozenset[Symbol]:
    """The symbols of texts, equations, tables and figures, a vector as the symbol of its magnitude."""
    rest = list(_expressions(blocks))
    # Most symbols are met many times as one object: these are told apart without a look inside.
    found: dict[int, Symbol] = {}
    while rest:
        node = rest.pop()
        if isinstance(node, Symbol):
            found[id(node)] = node
        elif not isinstance(node, Number):
            rest += children(node)
        if isinstance(node, VectorEquation):
            known = (entry for side in node.sides for term in side for entry in term.known)
            rest += (entry for entry in known if entry is not None and not isinstance(entry, str))
    return frozenset(replace(one, over="") if one.over == "vector" else one for one in set(found.values()))


def _expressions(blocks: Iterable[Block]) -> Iterator[Expression]:
    for block in blocks:
        match block:
            case Equation(rows=rows):
                yield from rows
            case Paragraph(inlines=inlines):
                yield from _of(inlines)
            case Figure(scenes, inlines):
                yield from _of(inlines)
                yield from (one for scene in scenes for one in _labels(scene))
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
