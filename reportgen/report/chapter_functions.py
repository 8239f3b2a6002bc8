"""Functions that single chapters of a report name: their worked lines, and the keys of the matching words."""

from __future__ import annotations

from reportgen.catalogue.given_loads import ByOrdinates
from reportgen.document import Block, InlineMath, Inlines, Paragraph, Text, listed
from reportgen.formula import Number, ids, walk
from reportgen.formula.vocabulary import on_plan
from reportgen.machine import DRIVER
from reportgen.machine.loads import Applied
from reportgen.report.context import ReportContext

UNIFORM = Number(12.0)
"""Divisor of m l² in the moment of inertia of a uniform rod."""


def variant_words(report: ReportContext) -> str:
    """The variant in a sentence, with words for one that is not numbered."""
    numbered, assigned = report.words["variant_words"]
    return str(numbered).format(variant=report.variant) if report.variant else str(assigned)


def attached(report: ReportContext) -> str:
    """A further sentence on the drawing sheets that are handed in with the report, if there are any."""
    size = report.assignment.report.sheets
    return f" {report.words['attached'].format(size=size)}" if size else ""


def signature(report: ReportContext) -> tuple[Block, ...]:
    """Return place, date and name below the foreword; without a name, the label is above a line to sign."""
    student = f"{report.words['cover']['student']}: {report.assignment.report.student.name or '…' * 20}"
    return tuple(Paragraph((Text(line),), "right") for line in (report.place_and_date, student))


def started(report: ReportContext) -> str:
    """The key of the words for where position 1 is: the kind's own place, or a given angle of the crank."""
    return "natural" if report.assignment.positions.start is None else "given"


def begins_at(report: ReportContext) -> str:
    """Return where the first position is: "dead_centre" (of the first slider) or "given"."""
    return "dead_centre" if report.machine.sliders and report.machine.sliders[0].phase == 0 else "given"


def has_chosen_scale(report: ReportContext) -> bool:
    """Return True if the length scale is chosen, rather than a drawn length."""
    return "scale" in report.ledger


def tabled_forces(report: ReportContext) -> tuple[Applied, ...]:
    """The working forces that are given by a table."""
    forces = (force for force in report.machine.applied if force.name not in report.further)
    return () if "P.given" in report.ledger else tuple(forces)


def diagram_words(report: ReportContext) -> str:
    """The key of the words for the indicator diagram, which may be given by measured heights."""
    return "ordinates" if isinstance(report.assignment.indicator, ByOrdinates) else "indicator"


def gas_forces(report: ReportContext) -> list[str]:
    """The pressure on each piston and the force of the gas."""
    return report.known(id for piston in report.pistons for id in (ids.pressure(piston.link), piston.name))


def without_mass(report: ReportContext) -> list[str]:
    """The links whose mass is not given."""
    links = sorted({1, *(link for group in report.groups for link in (group.i, group.j))})
    return [str(link) for link in links if ids.mass(link) not in report.mass_lines]


def further_loads(report: ReportContext) -> list[str]:
    """The loads that are declared beside those of the kind."""
    return report.known(row.id for row in report.own["declared"])


def topic_loads(report: ReportContext) -> list[str]:
    """Return the loads that topics bring."""
    return report.known(report.machine.beside)


def uniform_rods(report: ReportContext) -> list[str]:
    """The links whose moment of inertia is that of a uniform rod, J = m l²/12, for want of a given one."""
    moments = {
        link: report.ledger[id].definition for link in report.bodies if (id := ids.inertia(link)) in report.ledger
    }
    return [link for link, formula in moments.items() if formula is not None and UNIFORM in walk(formula)]


def driver_joints(report: ReportContext) -> list[str]:
    """The digits of what is read from the driver's force plan: a reaction, of a sliding one its balance too."""
    return ["01", "cb"] if report.machine.span else ["01"]


def driver_reactions(report: ReportContext) -> list[str]:
    return [ids.reaction(digits) for digits in driver_joints(report)]


def mean_lines(report: ReportContext) -> list[str]:
    """The balance over the cycle: its mean, its ends, the power."""
    return ["M.mean", "M.least", "M.greatest", "power"]


def work_lines(report: ReportContext) -> list[str]:
    """The work of the loads over the cycle, and the mean that gives it back."""
    return ["W", "M.energy"]


def crank_lines(report: ReportContext) -> list[str]:
    return [*report.crank_arms, "M.eq"]


def shares_pins(report: ReportContext) -> bool:
    """Return True if several groups are joined to the same pin of the crank."""
    return len(report.joined) > len(report.crank_pins)


def lever_couples(report: ReportContext) -> list[str]:
    """Return the ids of the moments of torques, which have no arm, in the balance by virtual work."""
    return report.known(ids.lever_moment(torque.name) for torque in report.machine.torques)


def inertia_parts(report: ReportContext) -> list[str]:
    """The shares of the links in the reduced moment of inertia, and their sum."""
    return report.known([*(ids.reduced_inertia(link) for link in report.machine.linkage.links), "J.r"])


def images(report: ReportContext) -> Inlines:
    """The images of the crank pin on the plans, for the conventions: a and a′."""
    pin = report.driver.pin
    return listed([InlineMath(on_plan(pin)), InlineMath(on_plan(pin, prime=True))])


def theory_of(report: ReportContext, what: str) -> list[str]:
    """Return the parts of the theory that this report's plans of velocities ("v") or accelerations ("a") use."""
    points = [place for place in report.machine.linkage.points if place.link != DRIVER]
    if what == "v":
        return report.parts("theory-two-equations") if any(abs(place.local.imag) > 0 for place in points) else []
    inclined = ["theory-inclination"] if report.has_turning_links else []
    similar = ["theory-similarity"] if any(group.similar("a") for group in report.groups) else []
    return report.parts(*inclined, *similar)
