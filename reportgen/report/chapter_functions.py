"""Functions for the templates of single chapters: the ids of the worked lines to print, and the keys of the matching
phrases.

Each takes the `ReportContext`; `template_names` registers it under its name.
"""

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
    """Return the phrase for the variant in a sentence, also for a variant without a number."""
    numbered, assigned = report.words["variant_words"]
    return str(numbered).format(variant=report.variant) if report.variant else str(assigned)


def attached(report: ReportContext) -> str:
    """Return a sentence on the drawing sheets that are handed in with the report, or "" if there are none."""
    size = report.assignment.report.sheets
    return f" {report.words['attached'].format(size=size)}" if size else ""


def signature(report: ReportContext) -> tuple[Block, ...]:
    """Return place, date and name below the foreword; without a name, the label is above a line to sign."""
    student = f"{report.words['cover']['student']}: {report.assignment.report.student.name or '…' * 20}"
    return tuple(Paragraph((Text(line),), "right") for line in (report.place_and_date, student))


def started(report: ReportContext) -> str:
    """Return the key of the phrase for position 1: "natural" for the kind's usual place, "given" for a given angle of
    the crank.
    """
    return "natural" if report.assignment.positions.start is None else "given"


def begins_at(report: ReportContext) -> str:
    """Return the first position's place: "dead_centre" (of the first slider) or "given"."""
    return "dead_centre" if report.machine.sliders and report.machine.sliders[0].phase == 0 else "given"


def has_chosen_scale(report: ReportContext) -> bool:
    """Return True if the length scale is chosen, False if it follows from a drawn length."""
    return "scale" in report.ledger


def tabled_forces(report: ReportContext) -> tuple[Applied, ...]:
    """Return the kind's working forces that a table gives; none if the force is constant."""
    forces = (force for force in report.machine.applied if force.name not in report.further)
    return () if "P.given" in report.ledger else tuple(forces)


def diagram_words(report: ReportContext) -> str:
    """Return the key of the phrases for the indicator diagram: "ordinates" if measured heights give it, else
    "indicator".
    """
    return "ordinates" if isinstance(report.assignment.indicator, ByOrdinates) else "indicator"


def gas_forces(report: ReportContext) -> list[str]:
    """Return the ids of the pressure on each piston and of the gas force."""
    return report.known(id for piston in report.pistons for id in (ids.pressure(piston.link), piston.name))


def without_mass(report: ReportContext) -> list[str]:
    """Return the numbers of the links without a given mass."""
    links = sorted({1, *(link for group in report.groups for link in group.links)})
    return [str(link) for link in links if ids.mass(link) not in report.mass_lines]


def further_loads(report: ReportContext) -> list[str]:
    """Return the ids of the loads that the file declares in addition to those of the kind."""
    return report.known(row.id for row in report.own["declared"])


def topic_loads(report: ReportContext) -> list[str]:
    """Return the ids of the loads that topics add."""
    return report.known(report.machine.beside)


def uniform_rods(report: ReportContext) -> list[str]:
    """Return the links whose moment of inertia is not given and so is that of a uniform rod, J = m l²/12."""
    moments = {
        link: report.ledger[id].definition for link in report.bodies if (id := ids.inertia(link)) in report.ledger
    }
    return [link for link, formula in moments.items() if formula is not None and UNIFORM in walk(formula)]


def driver_joints(report: ReportContext) -> list[str]:
    """Return the digits of the reactions read from the driver's force plan; a sliding driver adds its balancing force
    "cb".
    """
    return ["01", "cb"] if report.machine.span else ["01"]


def driver_reactions(report: ReportContext) -> list[str]:
    """Return the ids of the reactions read from the driver's force plan."""
    return [ids.reaction(digits) for digits in driver_joints(report)]


def mean_lines(report: ReportContext) -> list[str]:
    """Return the ids of the balancing torque's mean and extremes over the cycle, and of the power."""
    return ["M.mean", "M.least", "M.greatest", "power"]


def work_lines(report: ReportContext) -> list[str]:
    """Return the ids of the loads' work over the cycle and of the mean torque that does the same work."""
    return ["W", "M.energy"]


def crank_lines(report: ReportContext) -> list[str]:
    """Return the ids of the arms about the crank's centre and of the balancing torque."""
    return [*report.crank_arms, "M.eq"]


def mechanism_class(report: ReportContext) -> str:
    """Return the class of the mechanism, the highest one of its groups, as the language writes it."""
    second, third = report.words["mechanism_class"]
    return str(third if report.triads else second)


def shares_pins(report: ReportContext) -> bool:
    """Return True if several groups are joined to the same pin of the crank."""
    return len(report.joined) > len(report.crank_pins)


def lever_couples(report: ReportContext) -> list[str]:
    """Return the ids of the moments of torques, which have no arm, in the balance by virtual work."""
    return report.known(ids.lever_moment(torque.name) for torque in report.machine.torques)


def inertia_parts(report: ReportContext) -> list[str]:
    """Return the ids of the links' shares in the reduced moment of inertia, and of their sum."""
    return report.known([*(ids.reduced_inertia(link) for link in report.machine.linkage.links), "J.r"])


def images(report: ReportContext) -> Inlines:
    """Return the images of the crank pin on the two plans, a and a′, for the conventions."""
    pin = report.driver.pin
    return listed([InlineMath(on_plan(pin)), InlineMath(on_plan(pin, prime=True))])


def theory_of(report: ReportContext, what: str) -> list[str]:
    """Return the theory sections that this report's plans of velocities ("v") or accelerations ("a") use."""
    points = [place for place in report.machine.linkage.points if place.link != DRIVER]
    if what == "v":
        return report.parts("theory-two-equations") if any(abs(place.local.imag) > 0 for place in points) else []
    inclined = ["theory-inclination"] if report.has_turning_links else []
    similar = ["theory-similarity"] if any(group.similar("a") for group in report.groups) else []
    return report.parts(*inclined, *similar)
