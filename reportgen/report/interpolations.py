"""Worked lines that start from given data: loads interpolated in a table, and lengths from coordinates of points."""

from __future__ import annotations

from reportgen.base.records import Record
from reportgen.base.template_access import template_members
from reportgen.formula import ids
from reportgen.machine.loads import Applied, Torque
from reportgen.report.context import ReportContext


@template_members("id", "stroke", "line", "ways")
class ReadLoad(Record):
    """A load at a position: its id, the id of the stroke whose fractions its table uses ("" without one), and `line`.

    `line` is True if an interpolation is printed.  It is False at a point of the table, and where both neighbouring
    points have the same value.
    """

    id: str
    stroke: str
    line: bool
    ways: tuple[str, ...]
    """The id of the displacement over which the load is tabled, if any."""


def loads_read(report: ReportContext, k: int) -> list[ReadLoad]:
    """Return the loads that position `k` reads from tables."""
    machine, ledger = report.machine, report.ledger
    loads: tuple[Applied | Torque, ...] = (*machine.applied, *machine.torques)
    return [
        ReadLoad(load.name, _stroke(report, load), _interpolated(report, load, k), _displacement_ids(report, load))
        for load in loads
        if load.name in ledger and ledger[load.name].definition is None and ledger[load.name].written is not None
    ]


def _stroke(report: ReportContext, load: Applied | Torque) -> str:
    """Return the id of the stroke over whose fractions a load is tabled, if the report computes it; else ""."""
    course = load.law.read_along
    id = "" if course is None else ids.stroke(course.link)
    return id if id in report.ledger else ""


def _displacement_ids(report: ReportContext, load: Applied | Torque) -> tuple[str, ...]:
    course = load.law.read_along
    return () if course is None else tuple(report.ledger.known([ids.displacement(course.link)]))


def _interpolated(report: ReportContext, load: Applied | Torque, k: int) -> bool:
    among = load.law.bracket(report.analysis.cycle_angle, report.analysis.motion)
    return among is not None and bool(among.between[k - 1])


def coordinate_lengths(report: ReportContext) -> list[str]:
    """Return the ids of the lengths that follow from coordinates of points of a link."""
    lengths = (id for id, family in report.case.ledger.families.items() if id in ids.length and family.written)
    return [id for id in lengths if report.ledger[id].definition is None]
