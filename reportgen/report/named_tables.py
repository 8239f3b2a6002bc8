"""The tables of reports by their names in templates."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from reportgen.document import Paragraph, Table
from reportgen.machine.analysis import Position
from reportgen.report import balancing, chapters, joint_friction, result_tables, running, tables, wide_sliders
from reportgen.report.report import Report


@dataclass(frozen=True, slots=True)
class QuantityTable:
    """A table of the quantities whose ids a function gives, `at` the positions of that name in the report.

    The words of a `group` of quantities, by the beginnings of their ids, follow the caption where it has a column.
    """

    ids: Callable[[Report], Sequence[str]]
    at: str = "positions"
    groups: Mapping[str, Collection[str]] = field(default_factory=dict)

    def __call__(
        self, report: Report, key: str, caption: str, head: Sequence[str], ids: Sequence[str] | None = None
    ) -> tuple[Table | Paragraph, ...]:
        quantities, positions = self.ids(report) if ids is None else ids, getattr(report, self.at)
        shown = [id for id in quantities if not all(report.is_zero(id, k) for k in positions)]
        words = report.words["tables"][key.removeprefix("tab.")]
        further = [words[name] for name, of in self.groups.items() if any(id.startswith(tuple(of)) for id in shown)]
        return tables.tables(report, key, "".join((caption, *further)), quantities, positions)


@dataclass(frozen=True, slots=True)
class RowTable:
    """A table of the rows that a function gives, in columns of these widths (mm)."""

    rows: Callable[..., Iterable[Sequence[object]]]
    widths: tuple[float, ...]

    def __call__(self, report: Report, key: str, caption: str, head: Sequence[str], *shown: Any) -> Table:
        return tables.list_table(report, key, caption, head, self.rows(report, *shown), self.widths)


TABLES: Mapping[str, Callable[..., Any]] = {
    # results at the front, symbols
    "extremes": chapters.extremes,
    "main.figures": RowTable(chapters.main_figures, (74.0, 22.0, 36.0, 28.0)),
    "symbols": RowTable(chapters.symbols, (40.0, 92.0, 28.0)),
    # given data
    "given": tables.given_data,
    "indicator": tables.indicator,
    "force": tables.working_force,
    "gas.law": tables.gas_law,
    "law": tables.load_law,
    # the machine
    "joints": RowTable(tables.joints, (20.0, 30.0, 40.0, 50.0)),
    "lengths": tables.lengths,
    "positions": result_tables.coordinates,
    "dead": RowTable(result_tables.dead_centres, (20.0, 46.0, 44.0, 46.0)),
    "labels": RowTable(result_tables.labels, (24.0, 50.0, 50.0)),
    # a declared linkage
    "frame": RowTable(tables.frame, (30.0, 50.0, 50.0)),
    "groups": RowTable(tables.groups, (20.0, 20.0, 30.0, 85.0)),
    "guides": RowTable(tables.guides, (20.0, 40.0, 32.0, 32.0, 30.0)),
    "points": RowTable(tables.further_points, (18.0, 18.0, 28.0, 32.0, 32.0, 32.0)),
    # motion
    "omega": RowTable(result_tables.angular_velocities, (34.0, 40.0, 60.0)),
    "eps": RowTable(result_tables.angular_accelerations, (34.0, 40.0, 60.0)),
    "summary": RowTable(result_tables.summary, (46.0, 46.0, 46.0)),
    "v.segments": QuantityTable(result_tables.velocity_segments),
    "v": QuantityTable(result_tables.velocities, groups={"turning": ("turn.omega.",)}),
    "a.segments": QuantityTable(result_tables.acceleration_segments),
    "a": QuantityTable(result_tables.accelerations, groups={"turning": ("turn.eps.",)}),
    # forces
    "springs": QuantityTable(
        chapters.spring_lines, "load_positions", groups={"lengths": ("spring.l.",), "turns": ("spring.turn.",)}
    ),
    "strokes": result_tables.strokes,
    "gas": QuantityTable(result_tables.gas, "load_positions"),
    "inertia": QuantityTable(result_tables.inertia, "all_positions", groups={"couples": ("M.Pqt",)}),
    "R": QuantityTable(result_tables.reactions, "all_positions"),
    "faces": RowTable(wide_sliders.rows, (16.0, 26.0, 26.0, 36.0, 28.0, 28.0)),
    "R.angles": QuantityTable(result_tables.reaction_angles, "all_positions"),
    "lever": RowTable(result_tables.lever, (30.0, 36.0, 44.0, 44.0)),
    "M": QuantityTable(result_tables.balance, "all_positions"),
    "flywheel": result_tables.flywheel,
    # balancing
    "shaking": QuantityTable(balancing.shaking_lines, "all_positions"),
    "rules": RowTable(balancing.rules_table, (58.0, 26.0, 22.0, 26.0, 26.0)),
    "factors": RowTable(balancing.factors_table, (20.0, 36.0, 36.0, 30.0)),
    "balanced": QuantityTable(balancing.balanced_table, "all_positions"),
    "costs": RowTable(balancing.cost_table, (78.0, 28.0, 28.0, 22.0)),
    "friction": QuantityTable(joint_friction.results, "all_positions"),
    "friction.rounds": joint_friction.rounds,
    "friction.dead": RowTable(joint_friction.dead_rows, (24.0, 48.0, 44.0, 44.0)),
    **running.TABLES,
    "checks": RowTable(result_tables.checks, (110.0, 40.0)),
}
"""Who makes a table; its key is `tab.` and its name, its caption and head stand in `words.yaml` under `tables`."""


def table(report: Report, name: str, *arguments: Any, words: str = "") -> Any:
    """A table with its words, or with others of `words.yaml`; one of a position k has k in its key and its caption.

    A name that is not in `TABLES` is a table of the loads whose ids are given, or of other quantities at positions.
    """
    texts = report.words["tables"][words or name]
    position = next((k for k in arguments if isinstance(k, Position)), None)
    caption = texts["caption"] if position is None else texts["caption"].format(k=position)
    key = ".".join(["tab", name, *(str(one) for one in arguments if isinstance(one, (Position, str)))])
    return TABLES.get(name, _of_ids)(report, key, caption, texts.get("head", ()), *arguments)


def _of_ids(
    report: Report,
    key: str,
    caption: str,
    head: Sequence[str],
    ids: Sequence[str],
    positions: Iterable[int] | None = None,
) -> tuple[Table | Paragraph, ...]:
    return tables.tables(report, key, caption, ids, positions or report.load_positions)
