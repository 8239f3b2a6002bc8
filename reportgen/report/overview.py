"""Tables of the page of results at the front of a report, and of the list of symbols."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from itertools import islice

from reportgen.document import Cell, Column, Inline, InlineMath, Inlines, Table, Text, Value, listed
from reportgen.formula import Expression, Number, Symbol, ids, size, vocabulary
from reportgen.report.context import ReportContext
from reportgen.report.guide_couples import guide_couples
from reportgen.report.phrases import sign
from reportgen.report.table_remarks import Peak, each_peak, reaction_ids, slider_rates, turning_rates

BESIDE = 2
"""Sets of columns side by side."""
SET = (24.0, 34.0, 22.0)
"""Widths of the columns of one set (mm): the quantity, its greatest value, the positions."""
EXAMPLES = 3
"""Largest number of symbols shown as examples of one kind."""
MOST_PLACES = 12
"""Largest number of letters that fit a column of positions."""

# --- the page of results


def extremes(report: ReportContext, key: str, caption: str, head: Sequence[str]) -> Table:
    """Return a table of the greatest velocities, accelerations and reactions with their positions, in sets of columns
    side by side.
    """
    peaks = list(_extremes(report))
    height = -(-len(peaks) // BESIDE)
    cells = [tuple(Cell(part) for part in _row(peak)) for peak in peaks]
    cells += [(Cell(),) * len(SET)] * (BESIDE * height - len(cells))
    body = (tuple(cell for line in cells[start::height] for cell in line) for start in range(height))
    titles = tuple(Cell((Text(title),)) for title in head) * BESIDE
    return Table(tuple(map(Column, SET)) * BESIDE, (titles,), tuple(body), report.prose.inlines(caption), key)


def _extremes(report: ReportContext) -> Iterator[Peak]:
    """Yield the peaks of sliding points, or else of all that a plan gives; then those of links, then of joints."""
    for what, rotation in (("v", "omega"), ("a", "eps")):
        points = slider_rates(report, what) or report.known(
            ids.POINT_RATE[what](name) for group in report.groups for name in group.found_joints
        )
        yield from each_peak(report, [*points, *turning_rates(report, rotation)], report.positions)
    couples = [slide.moment for slide in guide_couples(report)]
    yield from each_peak(report, [*reaction_ids(report), *couples], report.all_positions)


def _row(top: Peak) -> tuple[Inlines, Inlines, Inlines]:
    places = top.at if len(top.at) <= MOST_PLACES else f"{top.at.split(',')[0]}, …"
    return top.symbols, (top.value,), (Text(places),)


def main_figures(report: ReportContext) -> Iterator[Sequence[object]]:
    """Yield rows of words, symbol, value and place: the scales, the extremes of the balancing torque, its mean and
    power, the flywheel.
    """
    for figure, name in report.words["main_figures"].items():
        if id := of_kind(report, figure):
            yield *_figure(report, id, name), extreme_place(report, id)


def _figure(report: ReportContext, id: str, name: str | Mapping[str, str]) -> tuple[str, Expression, Value]:
    """Return words, symbol and value of a main figure; an extreme of the balance is named by its sense and printed as a
    size.
    """
    symbol, sense = report.ledger.symbol(id), sign(report, id)
    if isinstance(name, str):
        return name, symbol, Value(report.ledger.number(id))
    return name[sense], size(symbol) if sense == "negative" else symbol, Value(report.ledger.number(id, size=True))


def of_kind(report: ReportContext, name: str) -> str:
    """Return the id of the quantity with this name, which may have its kind as in `M.eq:torque`; "" if the report has
    none.
    """
    return next((id for id, one in report.ledger.families.items() if name in (id, f"{id}:{one.kind}")), "")


def extreme_place(report: ReportContext, id: str) -> Inlines:
    """Return the place of `M.least` or `M.greatest`: the crank angle from position 1, or the travel of a sliding
    driver.
    """
    if id not in ("M.least", "M.greatest"):
        return ()
    (low, _), (high, _) = report.analysis.summary.extremes
    angle, span = low if id == "M.least" else high, report.machine.span
    if span:
        return InlineMath(Symbol("s")), Text(" = "), Value(Number(angle / (2 * math.pi) * span * 1e3, 1, "mm"))
    return InlineMath(Symbol("φ")), Text(" = "), Value(Number(math.degrees(angle), 1, "°"))


# --- the list of symbols


def symbols(report: ReportContext) -> Iterator[Sequence[object]]:
    """Yield a row for each kind of quantity in this report: some of its symbols, its meaning, its unit."""
    for name, alike in symbol_kinds(report).items():
        listed_symbols = tuple(dict.fromkeys(report.ledger.symbol(id) for id in alike))
        units = dict.fromkeys(_unit(report, id) for id in alike)
        yield _some(listed_symbols), name, ", ".join(unit or "–" for unit in units)


def _unit(report: ReportContext, id: str) -> str:
    unit = report.ledger[id].how.unit
    return report.ledger.units.get(unit, unit)


def _some(symbols: Sequence[Symbol]) -> Inlines:
    first: list[Inline] = [InlineMath(one) for one in symbols[:EXAMPLES]]
    return listed([*first, Text("…")] if len(symbols) > EXAMPLES else first)


def symbol_kinds(report: ReportContext) -> Mapping[str, list[str]]:
    """Return the ids of the report's quantities by the meaning that `words.yaml` gives to their kind.

    Quantities of no listed kind are left out: the report explains them where it uses them.
    """
    meanings: Mapping[str, str] = report.words["meanings"]
    kinds: dict[str, list[str]] = {name: [] for name in meanings.values()}
    used = report.used_symbols
    for id, family in report.ledger.families.items():
        if not (family.hidden or family.is_plane) and (used is None or family.symbol in used):
            for name in islice(vocabulary.words_of(meanings, id, family.kind, family.symbol), 1):
                kinds[name].append(id)
    return {name: alike for name, alike in kinds.items() if alike}
