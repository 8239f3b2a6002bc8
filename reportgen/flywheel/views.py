"""The flywheel in a report: the values that templates of its chapter name, its table and its figures.

`HOOKS`, at the end of the module, registers them.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from reportgen.base.records import Record, replace
from reportgen.base.template_access import view
from reportgen.catalogue.topic_sections import sections_of
from reportgen.document import Paragraph, Table, Value
from reportgen.document.figure_placement import FigureScenes
from reportgen.drawing import Content, Scene, charts
from reportgen.drawing.chart_data import Diagram, Inclination, PlottedCurve
from reportgen.flywheel.regulation import regulated_in
from reportgen.formula import Symbol, ids
from reportgen.machine.regulated_cycle import RegulatedCycle
from reportgen.machine.shared_results import REGULATED_CYCLE
from reportgen.report.context import ReportContext
from reportgen.report.cycle_curves import axis_of, driver_axis
from reportgen.report.quantity_tables import tables
from reportgen.report.table_remarks import labels, printed_values
from reportgen.report.topic_views import ViewHooks, always

THINNED = 4
"""Curves of the flywheel use every fourth sample."""


ARCS = 16.0, 26.0
"""Radii (mm) of the arcs of ψ_max and ψ_min."""


def needs_flywheel(report: ReportContext) -> bool:
    """Return True if the links alone are too light to keep the speed even enough."""
    return "omega.of" in report.ledger


def _wheel(report: ReportContext) -> RegulatedCycle:
    return regulated_in(report.analysis)


def _over_cycle(
    report: ReportContext,
    values: np.ndarray,
    title: Content,
    levels: tuple[tuple[float, Symbol], ...] = (),
    half: bool = False,
) -> Scene:
    last = values.size - 1
    kept = np.append(np.arange(0, last, THINNED), last)
    curve = PlottedCurve("", np.degrees(_wheel(report).angle[kept]), values[kept])
    return charts.chart(Diagram((curve,), driver_axis(report), title, levels=levels), half=half, area=report.area)


def flywheel_torque(report: ReportContext) -> FigureScenes:
    """Draw M_r and the torque that balances its mean."""
    wheel = _wheel(report)
    level = (-wheel.constant, Symbol("−M", "c"))
    return FigureScenes((_over_cycle(report, wheel.torque, axis_of(report, "M.r"), (level,)),))


def flywheel_work(report: ReportContext) -> FigureScenes:
    """Draw J_r, if moving links have mass, and A over the cycle."""
    wheel = _wheel(report)
    drawings = [(wheel.inertia, "J.r")] if report.has_reduced_inertia else []
    drawings.append((wheel.work, "A.excess"))
    half = len(drawings) > 1
    return FigureScenes(tuple(_over_cycle(report, values, axis_of(report, id), half=half) for values, id in drawings))


def wittenbauer(report: ReportContext) -> FigureScenes:
    """Draw A over J_r from the axis J = 0, with the tangents of the two bounds of the speed, which meet the axis at a
    and b.
    """
    wheel, ledger = _wheel(report), report.ledger
    ends = np.array([0.0, wheel.inertia.max()])
    bounds = (("max", "A.upper", wheel.upper, wheel.fastest), ("min", "A.lower", wheel.lower, wheel.slowest))
    lines, angles = [], []
    for radius, (name, height, at, speed) in zip(ARCS, bounds, strict=True):
        name_of_bound, slope = ledger.symbol(ids.bound_of_speed(name)), speed**2 / 2
        lines.append(PlottedCurve(name_of_bound, ends, at + slope * ends, (0,), (ledger.symbol(height),)))
        angles.append(Inclination(ledger.symbol(ids.tangent(name)), 0.0, at, slope, radius))
    curve = PlottedCurve(Symbol("A"), wheel.inertia, wheel.work, (wheel.high, wheel.low))
    across, up = axis_of(report, "J.r"), axis_of(report, "A.excess")
    scales = ledger.number("mu.J").value, ledger.number("mu.A").value
    area = replace(report.area or charts.Area(mm=ledger.printed_unit("mm")), scales=scales)
    diagram = Diagram((curve, *lines), across, up, turn=False, inclinations=tuple(angles))
    return FigureScenes((charts.chart(diagram, area=area),))


def flywheel_speed(report: ReportContext) -> FigureScenes:
    """Draw the deviation of the speed from its mean (%), with the flywheel."""
    wheel = _wheel(report)
    mean = (wheel.fastest + wheel.slowest) / 2
    return FigureScenes(
        (_over_cycle(report, (wheel.speed / mean - 1) * 100, report.words["figure"]["speed_deviation"]),)
    )


def energy_bounds(report: ReportContext) -> list[str]:
    """Return the ids of the points where the tangents of Wittenbauer's diagram meet its axis."""
    return ["A.upper", "A.lower"]


def tangent_lines(report: ReportContext) -> list[str]:
    """Return the ids of the scales of the energy–mass diagram and of the inclinations of its tangents."""
    return report.known(["mu.J", "mu.A", ids.tangent("max"), ids.tangent("min")])


def constant_links(report: ReportContext) -> list[str]:
    """Return the id of the moment of inertia of the links in the flywheel's group of Mertsalov's method."""
    return report.known(["J.0"])


def constant_group(report: ReportContext) -> list[str]:
    """Return the ids of the results of Mertsalov's method; an empty list if it is not used."""
    return report.known(["T.range", "J.I", "J.rest"])


def stores(report: ReportContext) -> str:
    """Return the bodies that store the excess work: the "links" with the flywheel, or the flywheel "alone"."""
    return "links" if report.has_reduced_inertia else "alone"


def speed_limits(report: ReportContext) -> list[str]:
    """Return the ids of the bounds of the speed, and of the unevenness if it is computed."""
    uneven = ["unevenness"] if "unevenness" in report.computed else []
    return [*uneven, "omega.max", "omega.min"]


def cycle_table(report: ReportContext, key: str, caption: str, head: Sequence[str]) -> tuple[Table | Paragraph, ...]:
    """Return a table of reduced torque and excess work; also reduced inertia if links have mass, and speed if
    there is a flywheel.

    The caption is completed with words for the last two. `head` is ignored: the symbols of the quantities are the
    column heads.
    """
    words = report.words["tables"]["flywheel"]
    inertia = words["inertia"] if report.has_reduced_inertia else ""
    speed = words["speed"] if needs_flywheel(report) else ""
    columns = report.known(("M.r", "A.excess", "J.r", "omega.of"))
    return tables(report, key, f"{caption}{inertia}{speed}", columns, report.all_positions)


@view()
class Range(Record):
    """The least and the greatest value of a quantity over the cycle, with their positions."""

    least: Value
    low: str
    most: Value
    high: str


def work_range(report: ReportContext) -> Range:
    """Return the range of the excess work."""
    positions, values = report.all_positions, printed_values(report, "A.excess", report.all_positions)

    def end(value: float) -> tuple[Value, str]:
        there = [k for k, one in zip(positions, values, strict=True) if one == value]
        return Value(report.ledger.number("A.excess", there[0])), labels(report, there)

    return Range(*end(values.min()), *end(values.max()))


def _verdict_here(report: ReportContext) -> bool:
    """Return True unless another topic uses the regulated cycle and gives the verdict on it."""
    return not any(REGULATED_CYCLE in section.uses for section in sections_of(report.machine.topics))


def _overview(report: ReportContext) -> Sequence[str]:
    if not _verdict_here(report):
        return ()
    return () if needs_flywheel(report) else ("flywheel-overview",)


def _conclusion(report: ReportContext) -> Sequence[str]:
    return ("flywheel-conclusion",) if needs_flywheel(report) else ("flywheel-conclusion-none",)


HOOKS = ViewHooks(
    values={
        "constant_group": constant_group,
        "constant_links": constant_links,
        "energy_bounds": energy_bounds,
        "needs_flywheel": needs_flywheel,
        "speed_limits": speed_limits,
        "stores": stores,
        "tangent_lines": tangent_lines,
    },
    functions={"work_range": work_range},
    figures={
        "flywheel-torque": ("fig.Mr", flywheel_torque),
        "flywheel-work": ("fig.Jr", flywheel_work),
        "flywheel-speed": ("fig.speed", flywheel_speed),
        "wittenbauer": ("fig.wittenbauer", wittenbauer),
    },
    tables={"flywheel": cycle_table},
    passages={"overview": _overview, "conclusion": _conclusion, "task": always("flywheel-task")},
)
