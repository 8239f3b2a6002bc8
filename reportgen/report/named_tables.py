"""Registry of the tables of reports by their names in templates; `table(report, name, …)` makes one."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from operator import attrgetter
from typing import Any

from reportgen.document import Paragraph, Table
from reportgen.machine.analysis import Position
from reportgen.report import iteration_table, overview, quantity_tables, result_tables, topic_views
from reportgen.report.context import ReportContext
from reportgen.report.quantity_tables import QuantityTable, RowTable

TABLES: Mapping[str, Callable[..., Any]] = {
    # results at the front, symbols
    "extremes": overview.extremes,
    "main.figures": RowTable(overview.main_figures, (74.0, 22.0, 36.0, 28.0)),
    "symbols": RowTable(overview.symbols, (40.0, 92.0, 28.0)),
    # given data
    "given": quantity_tables.given_data,
    "indicator": quantity_tables.indicator,
    "force": quantity_tables.working_force,
    "gas.law": quantity_tables.gas_law,
    "law": quantity_tables.load_law,
    # the machine
    "joints": RowTable(quantity_tables.joints, (20.0, 30.0, 40.0, 50.0)),
    "lengths": quantity_tables.lengths,
    "positions": result_tables.coordinates,
    "dead": RowTable(result_tables.dead_centres, (20.0, 46.0, 44.0, 46.0)),
    "labels": RowTable(result_tables.labels, (24.0, 50.0, 50.0)),
    # a declared linkage
    "frame": RowTable(quantity_tables.frame, (30.0, 50.0, 50.0)),
    "groups": RowTable(quantity_tables.groups, (20.0, 20.0, 30.0, 85.0)),
    "guides": RowTable(quantity_tables.guides, (20.0, 40.0, 32.0, 32.0, 30.0)),
    "points": RowTable(quantity_tables.further_points, (18.0, 18.0, 28.0, 32.0, 32.0, 32.0)),
    # motion
    "omega": RowTable(result_tables.angular_velocities, (34.0, 40.0, 60.0)),
    "eps": RowTable(result_tables.angular_accelerations, (34.0, 40.0, 60.0)),
    "iteration": iteration_table.iteration,
    "summary": RowTable(result_tables.summary, (46.0, 46.0, 46.0)),
    "v.segments": QuantityTable(result_tables.velocity_segments),
    "v": QuantityTable(result_tables.velocities, groups={"turning": ("turn.omega.",)}),
    "a.segments": QuantityTable(result_tables.acceleration_segments),
    "a": QuantityTable(result_tables.accelerations, groups={"turning": ("turn.eps.",)}),
    # forces
    "strokes": result_tables.strokes,
    "gas": QuantityTable(result_tables.gas, "load_positions"),
    "inertia": QuantityTable(result_tables.inertia, "all_positions", groups={"couples": ("M.Pqt",)}),
    "R": QuantityTable(result_tables.reactions, "all_positions"),
    "R.angles": QuantityTable(result_tables.reaction_angles, "all_positions"),
    "lever": RowTable(result_tables.lever, (30.0, 36.0, 44.0, 44.0)),
    "M": QuantityTable(result_tables.balance, "all_positions"),
    "checks": RowTable(result_tables.checks, (110.0, 40.0)),
}
"""Function that makes each table.  Its key is `tab.` and its name; caption and head are in `words.yaml` under
`tables`.
"""


def table(report: ReportContext, name: str, *arguments: Any, words: str = "") -> Any:
    """Return a table by its name, with its caption and head in `words.yaml` or with those under `words`.

    A name that is not in `TABLES` belongs to a table of the quantities whose ids are given.  A table of a position k
    has k in its key and caption.
    """
    texts = report.words["tables"][words or name]
    position = next((k for k in arguments if isinstance(k, Position)), None)
    caption = texts["caption"] if position is None else texts["caption"].format(k=position)
    key = ".".join(["tab", name, *(str(one) for one in arguments if isinstance(one, (Position, str)))])
    make = TABLES.get(name) or topic_views.merged(report, attrgetter("tables")).get(name, _of_ids)
    return make(report, key, caption, texts.get("head", ()), *arguments)


def _of_ids(
    report: ReportContext,
    key: str,
    caption: str,
    head: Sequence[str],
    ids: Sequence[str],
    positions: Iterable[int] | None = None,
) -> tuple[Table | Paragraph, ...]:
    return quantity_tables.tables(report, key, caption, ids, positions or report.load_positions)
