"""Springs in a report: the values that templates of their chapter name, their table and their figure."""

from __future__ import annotations

import numpy as np

from reportgen.base.units import significant_decimals
from reportgen.document import Inlines, Value, listed
from reportgen.document.figure_placement import FigureScenes
from reportgen.formula import Number
from reportgen.machine.analysis import motion_at
from reportgen.machine.load_laws import FULL_TURN
from reportgen.report.context import ReportContext
from reportgen.report.cycle_curves import ShownCurve, axis, over_the_cycle
from reportgen.report.quantity_tables import QuantityTable
from reportgen.report.topic_views import ViewHooks, always
from reportgen.springs.spring_laws import SpringLaw, TorsionLaw
from reportgen.springs.topic import SpringRow

FIGURES = 5
"""Significant figures of the work of a spring."""


def rows_of(report: ReportContext) -> tuple[SpringRow, ...]:
    """Return the springs of a machine as rows for templates."""
    return report.machine.topic("springs", tuple) or ()


def spring_lines(report: ReportContext) -> list[str]:
    """Return the ids of the lengths of springs, or of their angles of twist, and of their loads."""
    return report.known(id for row in rows_of(report) for id in (*row.lines, *row.loads))


def spring_works(report: ReportContext) -> Inlines:
    """Return the work of each spring (J) over the travel of a sliding driver, in the order of their numbers; () for a
    crank.
    """
    machine = report.machine
    if not machine.span:
        return ()
    ends = motion_at(machine, np.array([0.0, FULL_TURN]))
    laws = {load.law.number: load.law for load in machine.loads if isinstance(load.law, SpringLaw | TorsionLaw)}
    unit = report.ledger.printed_unit("J")
    falls = (float(-np.diff(law.energy(ends))[0]) for _, law in sorted(laws.items()))
    return listed(
        Value(Number(float(f"{work:.{FIGURES}g}") + 0.0, max(significant_decimals(work, FIGURES), 0), unit))
        for work in falls
    )


def linear_springs(report: ReportContext) -> list[str]:
    """Return the ids of the loads of springs between two points."""
    return report.known(id for row in rows_of(report) if not row.twists for id in row.loads)


def torsion_springs(report: ReportContext) -> list[str]:
    """Return the ids of the loads of torsion springs."""
    return report.known(id for row in rows_of(report) if row.twists for id in row.loads)


def spring_loads(report: ReportContext) -> list[str]:
    """Return the ids of the loads of all springs."""
    return report.known(id for row in rows_of(report) for id in row.loads)


def loads_over_cycle(report: ReportContext) -> FigureScenes:
    """Draw the forces of springs over the cycle; torsion springs have a separate diagram."""
    by_kind: dict[str, list[ShownCurve]] = {}
    analysed = {load.name: load.law for load in report.loads}
    cycle = report.dense_cycle
    for row in rows_of(report):
        # Both ends of a spring have one force.
        name = row.loads[0]
        values = analysed[name].value(cycle.cycle_angle, cycle.motion)
        by_kind.setdefault(report.ledger[name].kind, []).append((report.ledger.symbol(name), values))
    drawn = (over_the_cycle(report, shown, axis(report, shown[0][0], kind)).scene for kind, shown in by_kind.items())
    return FigureScenes(tuple(drawn))


HOOKS = ViewHooks(
    values={
        "linear_springs": linear_springs,
        "spring_lines": spring_lines,
        "spring_rows": rows_of,
        "spring_works": spring_works,
        "torsion_springs": torsion_springs,
    },
    figures={"springs": ("fig.springs", loads_over_cycle)},
    tables={
        "springs": QuantityTable(
            spring_lines, "load_positions", groups={"lengths": ("spring.l.",), "turns": ("spring.turn.",)}
        )
    },
    passages={"given": always("springs-given"), "task": always("springs-task")},
)
