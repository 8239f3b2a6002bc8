"""The table of Newton's iteration for the angles of a group of class III."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import count

from reportgen.base.records import replace
from reportgen.catalogue import ternary_ids
from reportgen.document import Table, Text
from reportgen.document.tables import list_table
from reportgen.formula import ids
from reportgen.report.context import ReportContext
from reportgen.report.quantity_tables import bare

WIDTHS = (24.0, 14.0)
WIDEST, ALL_STEPS = 28.0, 120.0
"""Largest width (mm) of the column of a step, and of those of all steps."""


def iteration(report: ReportContext, key: str, caption: str, head: Sequence[str], group: str, position: int) -> Table:
    """Return all values of the iteration of a group at a position: a row for each quantity, a column for each step.

    The last column has only the angles that the iteration seeks.
    """
    ledger = report.ledger
    triad = next(one for one in report.machine.linkage.triads if ids.members(one.links) == group)
    last = next(number for number in count() if ternary_ids.trial_step(number, triad.plate) not in ledger)
    steps = range(last + 1)

    def rows() -> Iterator[Sequence[object]]:
        legs = [leg.link for leg in triad.legs[1:]]
        for names in zip(*(_names(triad.legs[0].link, triad.plate, legs, number) for number in steps), strict=True):
            first = ledger[names[0]]
            unit = ledger.printed_unit(first.how.unit)
            values = [bare(report, id, position) if id in ledger else (Text(""),) for id in names]
            yield replace(first.symbol, sup=""), unit, *values

    width = min(WIDEST, ALL_STEPS / len(steps))
    widths = (*WIDTHS, *(width,) * len(steps))
    return list_table(report.prose, key, caption, (*head, *map(str, steps)), rows(), widths)


def _names(first: int, plate: int, legs: Sequence[int], number: int) -> Iterator[str]:
    """Yield the ids of a step in the order of the calculation."""
    turning = first, plate
    yield from (ternary_ids.trial_angle(number, link) for link in turning)
    for leg in legs:
        yield from (
            name(number, leg)
            for name in (ternary_ids.trial_x, ternary_ids.trial_y, ternary_ids.trial_angle, ternary_ids.trial_gap)
        )
        yield from (ternary_ids.trial_arm(number, ids.joint(leg, link)) for link in turning)
    yield from (ternary_ids.trial_step(number, link) for link in turning)
