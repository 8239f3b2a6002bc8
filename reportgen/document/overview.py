"""The page of results at the front of a report, and its list of symbols."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from itertools import islice

from reportgen.document.comments import Peak, each_peak, reaction_ids, slider_rates, turning_rates
from reportgen.document.report import Report
from reportgen.document.tree import Cell, Column, Inline, InlineMath, Inlines, Table, Text, Value, listed
from reportgen.notation import ids, vocabulary
from reportgen.notation.expressions import Number, Symbol
from reportgen.notation.vocabulary import on_plan

BESIDE = 2
"""Sets of columns side by side."""
SET = (24.0, 34.0, 22.0)
"""Columns of one set (mm): the quantity, its greatest value, the positions."""
EXAMPLES = 3
"""Symbols of one kind that stand for all of it."""
MOST_PLACES = 12
"""Letters that a list of positions may have in its column."""

# --- the page of results


def extremes(report: Report, key: str, caption: str, head: Sequence[str]) -> Table:
    """The greatest sizes of velocities, accelerations and reactions with their positions, in sets side by side."""
    found = list(_extremes(report))
    height = -(-len(found) // BESIDE)
    cells = [tuple(Cell(part) for part in _row(one)) for one in found]
    cells += [(Cell(),) * len(SET)] * (BESIDE * height - len(cells))
    body = (tuple(cell for line in cells[start::height] for cell in line) for start in range(height))
    titles = tuple(Cell((Text(title),)) for title in head) * BESIDE
    return Table(tuple(map(Column, SET)) * BESIDE, (titles,), tuple(body), report.prose.inlines(caption), key)


def _extremes(report: Report) -> Iterator[Peak]:
    """Of points in translation, else of all that a plan seeks; then of links, then of joints."""
    for what, rotation in (("v", "omega"), ("a", "eps")):
        points = slider_rates(report, what) or report.known(ids.POINT_RATE[what](group.M) for group in report.groups)
        yield from each_peak(report, [*points, *turning_rates(report, rotation)], report.positions)
    yield from each_peak(report, reaction_ids(report), report.all_positions)


def _row(one: Peak) -> tuple[Inlines, Inlines, Inlines]:
    places = one.at if len(one.at) <= MOST_PLACES else f"{one.at.split(',')[0]}, …"
    return one.symbols, (one.value,), (Text(places),)


def main_figures(report: Report) -> Iterator[Sequence[object]]:
    """The scales, how far the balancing torque goes, its mean and power, the flywheel: words, symbol, value, place."""
    ledger = report.ledger
    for one, name in report.words["main_figures"].items():
        id = of_kind(report, one)
        if id:
            yield name, ledger.symbol(id), Value(ledger.number(id)), extreme_place(report, id)


def of_kind(report: Report, name: str) -> str:
    """The id of a quantity that is named so, or with its kind as in `M.eq:torque`; "" for one that is not there."""
    return next((id for id, one in report.ledger.families.items() if name in (id, f"{id}:{one.kind}")), "")


def extreme_place(report: Report, id: str) -> Inlines:
    """Where over the cycle `M.least` or `M.greatest` is: the crank's turn from position 1, a sliding driver's way."""
    if id not in ("M.least", "M.greatest"):
        return ()
    (low, _), (high, _) = report.analysis.summary.extremes
    angle, span = low if id == "M.least" else high, report.machine.span
    if span:
        return InlineMath(Symbol("s")), Text(" = "), Value(Number(angle / (2 * math.pi) * span * 1e3, 1, "mm"))
    return InlineMath(Symbol("φ")), Text(" = "), Value(Number(math.degrees(angle), 1, "°"))


# --- the list of symbols


def symbols(report: Report) -> Iterator[Sequence[object]]:
    """The kinds of quantities that this report has: some of their symbols, the meaning, the unit."""
    for name, alike in symbol_kinds(report).items():
        shown = tuple(dict.fromkeys(report.ledger.symbol(id) for id in alike))
        units = dict.fromkeys(_unit(report, id) for id in alike)
        yield _some(shown), name, ", ".join(unit or "–" for unit in units)


def _unit(report: Report, id: str) -> str:
    unit = report.ledger[id].how.unit
    return report.ledger.units.get(unit, unit)


def _some(shown: Sequence[Symbol]) -> Inlines:
    first: list[Inline] = [InlineMath(one) for one in shown[:EXAMPLES]]
    return listed([*first, Text("…")] if len(shown) > EXAMPLES else first)


def symbol_kinds(report: Report) -> Mapping[str, list[str]]:
    """The ids of the report's quantities under the meaning that `words.yaml` gives to their kind.

    A quantity that no kind fits is explained where it stands.
    """
    meanings: Mapping[str, str] = report.words["meanings"]
    kinds: dict[str, list[str]] = {name: [] for name in meanings.values()}
    for id, family in report.ledger.families.items():
        if not (family.hidden or family.is_plane):
            for name in islice(vocabulary.words_of(meanings, id, family.kind, family.symbol), 1):
                kinds[name].append(id)
    return {name: alike for name, alike in kinds.items() if alike}


def images(report: Report) -> Inlines:
    """The images of the crank pin on the plans, for the conventions: a and a′."""
    pin = report.driver.pin
    return listed([InlineMath(on_plan(pin)), InlineMath(on_plan(pin, prime=True))])
