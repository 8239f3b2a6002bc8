"""How equal the variants of a class are in effort: how many values to work out, how large, of which signs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from statistics import median
from typing import NamedTuple

import numpy as np

from reportgen import api
from reportgen.assignment import Assignment
from reportgen.assignment.faults import word
from reportgen.ledger.report import keep
from reportgen.notation.numbers import Language

MOST_TIMES = 2.0
"""A count is an outlier if it differs from the median by more than this factor."""
MOST_DEVIATIONS = 3.0
"""A size is an outlier if it is further from the median than so many median absolute deviations …"""
LEAST_SHARE = 0.1
"""… and than this share of the median: in a class of near equals there is no outlier."""


class Effort(NamedTuple):
    """What a variant asks for; the order is that of the columns of `variants.csv`.

    `worked` counts the printed values that are derived, over all positions; `largest` is the greatest balancing
    torque (N·m) or force (N) of the positions, `speed` that of the driver (rad/s or m/s), `positive` the share
    of positions where the balance is positive (`largest` and `positive` are None without loads); `zeros` counts
    the values that are zero beside their scale.
    """

    worked: int
    largest: float | None
    speed: float
    positive: float | None
    zeros: int


@dataclass(frozen=True, slots=True)
class Spread:
    """One figure over the class; `outliers` are the indices of variants out of proportion."""

    name: str
    least: float
    median: float
    greatest: float
    outliers: tuple[int, ...]


def effort(assignment: Assignment) -> Effort:
    """The figures of an assignment, from its ledger."""
    analysis = api.analyse(assignment)
    families = keep(analysis).ledger.families.values()
    derived = [one for one in families if one.definition is not None and not one.hidden and not one.is_plane]
    zeros = sum(
        one.at(position) == 0 for one in derived if one.scale for position in range(1, len(one.values) + 1)
    )
    balance = np.real(analysis.torque) if analysis.loads else None
    return Effort(
        worked=sum(len(one.values) for one in derived),
        largest=None if balance is None else float(np.max(np.abs(balance))),
        speed=analysis.machine.speed,
        positive=None if balance is None else float(np.mean(balance > 0)),
        zeros=int(zeros),
    )


def compare(efforts: Sequence[Effort]) -> list[Spread]:
    """Each figure's spread over the class; figures that no variant has are left out."""
    spreads = []
    for name, values in zip(Effort._fields, zip(*efforts, strict=True), strict=False):
        known = [value for value in values if value is not None]
        if known:
            middle = median(known)
            outliers = _outliers(name, values, middle)
            spreads.append(Spread(name, min(known), middle, max(known), outliers))
    return spreads


def _outliers(name: str, values: Sequence[float | None], middle: float) -> tuple[int, ...]:
    """Indices of what is out of proportion: counts by a factor, sizes by median absolute deviations."""
    known = {k: value for k, value in enumerate(values) if value is not None}
    if name == "worked":
        least, most = middle / MOST_TIMES, middle * MOST_TIMES
        return tuple(k for k, value in known.items() if value and not least <= value <= most)
    deviation = median(abs(value - middle) for value in known.values())
    limit = max(MOST_DEVIATIONS * deviation, LEAST_SHARE * abs(middle))
    return tuple(k for k, value in known.items() if abs(value - middle) > limit)


def table(spreads: Sequence[Spread], language: Language) -> list[str]:
    """The spreads as lines of text: a figure, its least, median and greatest value."""
    rows = [["", *(word(name, language) for name in ("least", "median", "greatest"))]]
    rows += [[word(one.name, language), *map(shown, (one.least, one.median, one.greatest))] for one in spreads]
    first, *others = (max(map(len, cells)) for cells in zip(*rows, strict=True))
    return [
        "  ".join([name.ljust(first), *(cell.rjust(width) for cell, width in zip(cells, others, strict=True))])
        for name, *cells in rows
    ]


def shown(value: float) -> str:
    """A figure with four digits, a count with all."""
    return f"{value:.0f}" if float(value).is_integer() and abs(value) < 1e9 else f"{value:.4g}"
