"""Whether a printed line holds for a reader with a calculator.

With x̂ᵢ the numbers as printed and uᵢ half a unit of their last digits (0 for exact ones), a line
f(x̂) = ŷ passes if |f(x̂) − ŷ| ≤ u_y + Σ|∂f/∂xᵢ| uᵢ.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

from reportgen.document.tree import (
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
from reportgen.figures.scene import Label
from reportgen.notation.evaluation import evaluate
from reportgen.notation.expressions import Chain, Expression, Number, Symbol, Term, VectorEquation, rebuild, walk
from tests.reports import built

ROUNDING = 1e-9
"""Relative error allowed for arithmetic in floating point itself."""


@dataclass(frozen=True, slots=True)
class Printed:
    """A number on paper and how far the true one may be from it."""

    value: float
    half_unit: float


def misfit(function: Callable[[Sequence[float]], float], inputs: Sequence[Printed], result: Printed) -> float:
    """How many times the allowed error a line is off: up to 1 passes."""
    values = [number.value for number in inputs]
    allowed = result.half_unit + ROUNDING * abs(result.value)
    for index, number in enumerate(inputs):
        if number.half_unit:
            # The half-unit itself as the step: what a reader's error does, curvature included.
            ends = [
                function([*values[:index], number.value + step, *values[index + 1 :]])
                for step in (-number.half_unit, number.half_unit)
            ]
            allowed += abs(ends[1] - ends[0]) / 2
    off = abs(function(values) - result.value)
    return off / allowed if allowed else math.inf if off else 0.0


# --- of a tree ------------------------------------------------------------------------------------


def as_printed(number: Number) -> Printed:
    """A `Number` in the unit it evaluates in: degrees are radians."""
    factor = math.radians(1) if number.unit == "°" else 1.0
    return Printed(number.shown * factor, number.half_unit * factor)


def steps(chain: Chain) -> Iterator[tuple[Expression, Number]]:
    """(numbers put in, result) of a chain; its symbolic parts and bare results are no steps."""
    for left, right in pairwise(chain.parts):
        if isinstance(right, Number) and not any(
            isinstance(node, Symbol) and node.value is None for node in walk(left)
        ):
            yield left, right


def step_misfit(left: Expression, result: Number) -> float:
    numbers = [node for node in walk(left) if isinstance(node, Number)]

    def function(values: Sequence[float]) -> float:
        remaining = iter(values)

        def put_in(node: Expression) -> Expression:
            if isinstance(node, Number):
                return Number(next(remaining))
            return rebuild(node, put_in)

        return float(evaluate(put_in(left)))

    return misfit(function, [as_printed(number) for number in numbers], as_printed(result))


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
