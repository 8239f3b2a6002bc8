"""Whether a printed line recomputes: a reader's calculator lands within one last digit.

With x̂ᵢ the numbers as printed, a line ŷ = f(x̂) passes if |f(x̂) − ŷ| is at most one unit of ŷ's last digit,
units included.  A quantity in whole numbers of up to four figures or more keeps its units, and may be off by what half
a unit of each x̂ᵢ's last digit does as well.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from decimal import Decimal

import numpy as np

from reportgen.formula import Chain, Expression, Number, Symbol, children, rebuild, walk
from reportgen.formula.evaluation import evaluate
from reportgen.formula.ledger import Ledger
from reportgen.formula.vocabulary import KINDS

EXACT = 1e-9
"""Share of a line's own value that a computer's arithmetic, and π to as many digits, may be off."""
MANY = 1000
"""From here on a whole number has all the figures that one aims at."""
SCALES = {kind.unit: kind.scale for kind in KINDS.values()}


def excess(chain: Chain, scales: tuple[float, ...] = (), result: float = 1.0, *, whole: bool = False) -> float:
    """By how much a line's result misses what its numbers give, in units of what is allowed (1 passes).

    `scales` are SI units per printed unit of the line's numbers, in printed order, and `result` that of its
    result; lines that only state a value pass with 0.  `whole` is said of quantities in whole numbers of four figures.
    """
    if len(chain.parts) < 3:
        return 0.0
    shown, outcome = chain.parts[-2], chain.parts[-1]
    assert isinstance(outcome, Number)
    if any(isinstance(part, Symbol) and part.value is None for part in walk(shown)):
        return 0.0  # the number that was put in is the result itself
    numbers = [part for part in walk(shown) if isinstance(part, Number)]
    scales = scales or (1.0,) * len(numbers)
    assert len(numbers) == len(scales)

    def value(changes: dict[int, float]) -> float:
        """The line's formula with some numbers moved, in the result's unit."""
        count = iter(range(len(numbers)))

        def put(node: Expression) -> Expression:
            if isinstance(node, Number):
                index = next(count)
                moved = node.shown + changes.get(index, 0.0)
                return Number(math.radians(moved) if node.unit == "°" else moved * scales[index])
            return rebuild(node, put)

        return float(evaluate(put(shown))) / result

    central = value({})
    allowed = 2 * (outcome.half_unit if outcome.decimals is not None else _last_digit(outcome.value))
    if whole:
        steps = ((index, number.half_unit) for index, number in enumerate(numbers))
        allowed += sum(abs(value({index: step}) - central) for index, step in steps)
    missed = abs(central - outcome.shown)
    if math.isnan(missed):
        return math.inf
    if missed == 0:
        return 0.0
    return missed / (allowed + EXACT * max(abs(central), abs(outcome.shown)))


def _last_digit(value: float) -> float:
    """Half a unit of the last digit of a result printed as it is, e.g. 0.171."""
    return 0.5 * 10.0 ** min(int(Decimal(f"{value:.12g}").normalize().as_tuple().exponent), 0)


def worst_lines(ledger: Ledger) -> Iterator[tuple[float, str, int]]:
    """Every printed line of a ledger at every position: its excess, id and position.

    Lines without a value (a position where a quantity does not exist) are passed over.
    """
    for id, family in ledger.families.items():
        if family.line is None or family.constructed or family.is_plane or family.hidden:
            continue
        whole = ledger.decimals[id] == 0 and float(np.nanmax(np.abs(family.values))) >= MANY * family.how.scale
        for position in range(1, (ledger.positions if len(family.values) > 1 else 1) + 1):
            chain = ledger.chain(id, position)
            outcome = chain.parts[-1]
            if len(chain.parts) >= 3 and isinstance(outcome, Number) and math.isfinite(outcome.value):
                scales = _scales(ledger, chain, id, position)
                yield excess(chain, scales, family.how.scale, whole=whole), id, position


def _scales(ledger: Ledger, chain: Chain, id: str, position: int) -> tuple[float, ...]:
    """SI units per printed unit of the numbers of a line, told from the symbols of its formula."""
    by_symbol = {family.symbol: family.how.scale for family in ledger.families.values()}
    formula, numbers = chain.parts[1], chain.parts[-2]
    leaves = [part for part in walk(formula) if not children(part)]
    put = [part for part in walk(numbers) if not children(part)]
    assert len(leaves) == len(put), (id, position)
    return tuple(
        by_symbol[leaf] if isinstance(leaf, Symbol) else 1.0
        for leaf, part in zip(leaves, put, strict=True)
        if isinstance(part, Number)
    )
