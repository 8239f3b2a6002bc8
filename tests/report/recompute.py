"""Whether a printed line holds for a reader with a calculator.

With x̂ᵢ the numbers as printed, a line f(x̂) = ŷ passes if |f(x̂) − ŷ| is at most one unit of ŷ's last digit.  A whole
number keeps its units, so it may be off by Σ|∂f/∂xᵢ| uᵢ as well, with uᵢ half a unit of the x̂ᵢ's last digits; and so
may the few lines that the ledger lists, whose inputs have too few figures.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

from reportgen.base.units import write
from reportgen.drawing import Label
from reportgen.formula import Chain, Expression, Number, Symbol, Term, VectorEquation, rebuild, walk
from reportgen.formula.evaluation import evaluate
from reportgen.formula.plain import formula
from reportgen.report import (
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
from tests.report import built
from tests.report.built import Written

ROUNDING = 1e-9
"""Relative error allowed for arithmetic in floating point itself."""


@dataclass(frozen=True, slots=True)
class Printed:
    """A number on paper and how far the true one may be from it."""

    value: float
    half_unit: float


def misfit(
    function: Callable[[Sequence[float]], float], inputs: Sequence[Printed], result: Printed, loose: bool
) -> float:
    """How many times the allowed error a line is off: up to 1 passes; `loose` counts the inputs' half-units as well."""
    values = [number.value for number in inputs]
    allowed = 2 * result.half_unit + ROUNDING * abs(result.value)
    for index, number in enumerate(inputs):
        if loose and number.half_unit:
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


def as_result(number: Number) -> Printed:
    """A `Number` as the result of a line: one printed as it is (0.171 m) is read to its own last digit as well."""
    if number.decimals is not None:
        return as_printed(number)
    return as_printed(replace(number, decimals=len(write(number.value, None, "en").partition(".")[2])))


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

    shown = as_result(result)
    return misfit(function, [as_printed(number) for number in numbers], shown, loose=result.decimals == 0)


def off(written: Written) -> list[str]:
    """The lines of a report that a reader's calculator does not come to, each with how far it is off."""
    return [
        f"{misfit:.2f}: {formula(chain, written.language)}"
        for chain in chains(written.document)
        for left, result in steps(chain)
        if not (misfit := step_misfit(left, result)) <= 1
    ]


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
