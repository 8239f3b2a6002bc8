"""The orders of an engine in the chapter on balancing: lines, tables and the stars of the cranks."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

from reportgen.balancing import balance_ids
from reportgen.balancing.orders import Engine, engine
from reportgen.balancing.orders_ledger import EXACT, OF_ALL, ORDERS, SENSES
from reportgen.balancing.shaking_force import balanced_in
from reportgen.balancing.stars import star
from reportgen.document import Value
from reportgen.document.figure_placement import FigureScenes
from reportgen.formula import Number, vocabulary
from reportgen.report.context import ReportContext
from reportgen.report.quantity_tables import bare


def _engine(report: ReportContext) -> Engine | None:
    return engine(report.machine.linkage)


def orders_state(report: ReportContext) -> str:
    """Return the state of the orders: "none", of a "single" cylinder, of several in a "line" or a "vee", or "whole" for
    the whole force alone.
    """
    if balance_ids.order_force(1) not in report.ledger:
        return "none"
    layout = _engine(report)
    if layout is None:
        return "whole"
    if len(layout.cylinders) == 1:
        return "single"
    return "line" if layout.in_line else "vee"


def factor_lines(report: ReportContext) -> list[str]:
    """Return the ids of λ, of the orders of a piston's acceleration by the series, and of the reciprocating mass."""
    series = (balance_ids.series(order) for order in EXACT)
    masses = [id for id in report.ledger.families if id in balance_ids.point_mass]
    first = masses if masses and not _rules_print_rod_masses(report) else []
    return report.known([balance_ids.RATIO, *series, *first[:2], balance_ids.TO_AND_FRO])


def _rules_print_rod_masses(report: ReportContext) -> bool:
    """Return True if a rule prints the masses of the rods."""
    return bool({"rotating", "share"} & balanced_in(report.analysis).products.keys())


def star_lines(report: ReportContext) -> list[str]:
    """Return the ids of the sums of the cylinders' vectors, order by order, and of the couples."""
    lines: list[str] = []
    for order in ORDERS:
        for sense in SENSES:
            lines += [balance_ids.star(order, sense, axis) for axis in "xy"]
            lines.append(balance_ids.star_size(order, sense))
        lines.append(balance_ids.couple(order))
    return report.known(lines)


def order_lines(report: ReportContext) -> list[str]:
    """Return the ids of the greatest force of each order."""
    return report.known(balance_ids.order_force(order) for order in OF_ALL)


def factors_table(report: ReportContext) -> Iterator[Sequence[object]]:
    """Yield rows of A_n: exactly, by the series, and the error of the series."""
    yield "1", (Value(Number(1.0)),), (Value(Number(1.0)),), (Value(Number(0.0)),)
    for order in EXACT:
        ids = balance_ids.factor(order), balance_ids.series(order), balance_ids.series_error(order)
        yield str(order), *(bare(report, id, None) for id in ids)


def stars(report: ReportContext) -> FigureScenes:
    """Draw the star of each order that turns forward and, for cylinders at an angle, the star that turns backward."""
    layout = _engine(report)
    assert layout is not None
    senses = ("forward",) if layout.in_line else tuple(SENSES)
    first = layout.cylinders[0]
    scenes = []
    for sense in senses:
        for order in ORDERS:
            own = first.vector(order, SENSES[sense])
            vectors = [cylinder.vector(order, SENSES[sense]) / own for cylinder in layout.cylinders]
            total = report.ledger.symbol(balance_ids.star_size(order, sense))
            title = report.words["balancing"]["stars"][sense].format(order=order)
            names = [str(cylinder.slider) for cylinder in layout.cylinders]
            scenes.append(star(vectors, names, vocabulary.vector(total), title))
    return FigureScenes(tuple(scenes))


VALUES: Mapping[str, Callable[[ReportContext], Any]] = {
    "factor_lines": factor_lines,
    "order_lines": order_lines,
    "orders_state": orders_state,
    "star_lines": star_lines,
}
FIGURES: Mapping[str, tuple[str, Callable[..., FigureScenes]]] = {"stars": ("fig.stars", stars)}
