"""How alike the variants of a class are in effort: how much to work out, how large, of which signs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from statistics import median

import numpy as np

from reportgen.assignment import Assignment
from reportgen.assignment.messages import word
from reportgen.case import Case
from reportgen.notation.numbers import Language

FIGURES = ("worked", "largest", "speed", "positive", "zeros")
"""What variants are compared by, in the order of the columns."""
MOST_TIMES = 2.0
"""A count that differs from the median by more than this factor stands apart."""
MOST_DEVIATIONS = 3.0
"""So does a size that is further from it than so many median absolute deviations."""
LEAST_SHARE = 0.1
"""… and than this share of the median: in a class of near equals nobody stands apart."""
BALANCE = "M.eq"


@dataclass(frozen=True, slots=True)
class Effort:
    """What a variant asks for.

    `worked` counts the printed values that are derived, over all positions; `largest` is the greatest balancing
    torque (N·m) or force (N) of the positions, `speed` that of the driver (rad/s or m/s), `positive` the share
    of positions where the balance is positive (the three None without loads); `zeros` counts the values that
    are nothing beside their scale.
    """

    worked: int
    largest: float | None
    speed: float
    positive: float | None
    zeros: int

    def figure(self, name: str) -> float | None:
        value: float | None = getattr(self, name)
        return value


@dataclass(frozen=True, slots=True)
class Spread:
    """One figure over the class; `apart` are the indices of variants that stand apart."""

    name: str
    least: float
    median: float
    greatest: float
    apart: tuple[int, ...]


def effort(assignment: Assignment) -> Effort:
    """The figures of an assignment, from its ledger."""
    case = Case(assignment)
    analysis, ledger = case.analysis, case.ledger
    shown = [one for one in ledger.families.values() if not one.hidden and not one.is_plane]
    derived = [one for one in shown if one.definition is not None]
    zeros = sum(
        one.at(position) == 0 for one in derived if one.scale for position in range(1, len(one.values) + 1)
    )
    balance = np.real(analysis.torque) if analysis.loads else None
    return Effort(
        sum(len(one.values) for one in derived),
        None if balance is None else float(np.max(np.abs(balance))),
        analysis.machine.speed,
        None if balance is None else float(np.mean(balance > 0)),
        int(zeros),
    )


def compare(efforts: Sequence[Effort]) -> list[Spread]:
    """Each figure's spread over the class, and who stands apart; figures that nobody has are left out."""
    spreads = []
    for name in FIGURES:
        values = [value for one in efforts if (value := one.figure(name)) is not None]
        if values:
            apart = _apart(name, [one.figure(name) for one in efforts], median(values))
            spreads.append(Spread(name, min(values), median(values), max(values), apart))
    return spreads


def _apart(name: str, values: Sequence[float | None], middle: float) -> tuple[int, ...]:
    """Indices of what is out of proportion: counts by a factor, sizes by median absolute deviations."""
    if name == "worked":
        return tuple(
            k for k, value in enumerate(values) if value and not middle / MOST_TIMES <= value <= middle * MOST_TIMES
        )
    known = [value for value in values if value is not None]
    deviation = median([abs(value - middle) for value in known])
    limit = max(MOST_DEVIATIONS * deviation, LEAST_SHARE * abs(middle))
    return tuple(k for k, value in enumerate(values) if value is not None and abs(value - middle) > limit)


def table(spreads: Sequence[Spread], language: Language) -> list[str]:
    """The spreads as lines of text: a figure, its least, median and greatest value."""
    heads = ["", *(word(name, language) for name in ("least", "median", "greatest"))]
    rows = [heads, *([word(one.name, language), *map(shown, (one.least, one.median, one.greatest))] for one in spreads)]
    widths = [max(len(row[k]) for row in rows) for k in range(len(heads))]
    return [
        "  ".join([row[0].ljust(widths[0]), *(cell.rjust(w) for cell, w in zip(row[1:], widths[1:], strict=True))])
        for row in rows
    ]


def shown(value: float) -> str:
    """A figure with four digits, a count with all."""
    return f"{value:.0f}" if float(value).is_integer() and abs(value) < 1e9 else f"{value:.4g}"
