"""The six-link lever mechanism: crank AB about B, coupler AC, rocker CD about D, rod EF from E on AC, slider F.

Ground 0, crank 1 (BA), coupler 2 (AC), rocker 3 (DC), rod 4 (EF), slider 5 (at F) on a horizontal guide.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Literal

from reportgen.assignment.common import Assignment, Part, Positions, of_parameters
from reportgen.assignment.fields import Coordinate, ForceSize, Length
from reportgen.base.errors import Finding
from reportgen.base.units import Given
from reportgen.catalogue import reach
from reportgen.catalogue.driven import CRANK_DRAWN, Driven, FixedPoint, GivenSheet, driven
from reportgen.catalogue.loops import ClosedLoops
from reportgen.formula import Symbol, ids, turned
from reportgen.formula.vocabulary import drawn_length
from reportgen.machine import Crank, Dyad, Guide, Linkage, LinkPoint
from reportgen.machine.analysis import Machine
from reportgen.machine.loads import Applied, ConstantLaw, Law, crank_motion, opposing

TURNS = 1
BARS = {1: ("B", "A"), 2: ("A", "C"), 3: ("D", "C"), 4: ("E", "F")}
"""The bars by the pins at their ends."""


class SliderForce(Part):
    """A force on the slider along its guide, of one sense or against its motion."""

    P: ForceSize
    sense: Literal["opposing", "right", "left"] = "opposing"


class Parameters(Driven, masses=(1, 2, 3, 4, 5), moments=(1, 2, 3, 4), shares=(1, 2, 3, 4), loads=("force",)):
    """Lengths, fixed points, the way the groups are assembled, the speed; masses and the load if given."""

    AB: Length
    AC: Length
    CD: Length
    CE: Length
    EF: Length
    D: FixedPoint
    guide: Coordinate
    C: Literal["left", "right"] = "left"
    F: Literal["left", "right"] = "left"
    force: SliderForce | None = None


def _sheet(given: Parameters, crank: Given | None = None) -> GivenSheet:
    """Given data, the place of E, mass centres, masses and moments of inertia."""
    q = GivenSheet(given)
    q.datum("l.BA", given.AB, Symbol("l", "AB"))
    q.datum("l.AC", given.AC)
    q.datum("l.DC", given.CD, Symbol("l", "CD"))
    q.datum("l.CE", given.CE)
    q.datum("l.EF", given.EF)
    q.point("D", given.D)
    q.datum("F.y", given.guide, Symbol("y", "F"), "length")
    q.speed()
    q.give("drawn.BA", crank.si if crank else CRANK_DRAWN, drawn_length("A", "B"))
    q.set_out("places", q.define("l.AE", q["l.AC"] - q["l.CE"]))
    q.bodies(BARS, 5, always=True)
    q.set_out(
        "lengths",
        "l.BA",
        "l.AC",
        "l.DC",
        "l.AE",
        "l.EF",
        *(ids.length(start, f"S{link}") for link, (start, _) in BARS.items()),
    )
    q.set_out("loads", "P5")
    if given.force is not None:
        q.datum("P.given", given.force.P, Symbol("P", "5"), "force")
    return q


def _linkage(given: Parameters, q: GivenSheet) -> Linkage:
    """The mechanism with B in the origin."""
    left, right = (1 if side else -1 for side in (given.C == "left", given.F == "right"))
    return Linkage(
        ground={"B": 0j, "D": complex(q.si("D.x"), q.si("D.y"))},
        driver=Crank("B", "A", q.si("l.BA")),
        dyads=(
            Dyad("RRR", (2, 3), "A", "C", "D", lengths=(q.si("l.AC"), q.si("l.DC")), sign=left),
            Dyad("RRP", (4, 5), "E", "F", Guide(1j * q.si("F.y"), 0.0), lengths=(q.si("l.EF"), 0.0), sign=right),
        ),
        points=(
            LinkPoint("E", 2, complex(q.si("l.AE"))),
            *q.centre_points({link: start for link, (start, _) in BARS.items()}),
        ),
        inertias=q.inertias({**{link: f"S{link}" for link in BARS}, 5: "F"}),
        gravity=-1j * given.g.si,
    )


@of_parameters
def _check_turning(given: Parameters) -> Iterator[Finding]:
    """The crank turns fully, without dead points, and CD is a rocker."""
    if given.CE.si > given.AC.si:
        upper = f"≤ AC = {given.AC.text}"
        yield Finding("out-of-range", ("parameters", "CE"), {"text": given.CE.text, "range": upper})
        return
    linkage = _linkage(given, _sheet(given))
    members = {(2, 3): reach.Member("AC, CD", ("parameters", "CD")), (4, 5): reach.Member("EF", ("parameters", "EF"))}
    found = list(reach.findings(linkage, members))
    yield from found
    if not found and reach.turns_fully(linkage, 3):
        yield Finding("not-a-rocker", ("parameters", "CD"), {"link": "3", "rods": "CD"})


CHECKS = (_check_turning,)


# --- the machine ----------------------------------------------------------------------------------

SUMMARY = (
    ("v.A", "v.S1", "omega.1"),
    ("v.C", "v.S2", "omega.2"),
    ("v.E", "v.S3", "omega.3"),
    ("v.F", "v.S4", "omega.4"),
)
"""The table of velocities: a joint, a mass centre and an angular velocity in each row."""


def machine(assignment: Assignment) -> Machine:
    """The six-link lever mechanism of an assignment: linkage, load, a summary of its velocities."""
    given: Parameters = assignment.parameters
    positions = assignment.positions
    q = _sheet(given, assignment.drawing.crank)
    linkage, start = _linkage(given, q), positions.start_or()
    q.construct("guide.5.at", turned(q["F.y"]))
    fixed = {name: q.coordinates(name) for name in linkage.ground}
    loops = ClosedLoops(linkage, positions.sign, fixed, guides={5: q.coordinates("F")})
    return driven(
        assignment,
        q,
        linkage,
        start,
        {"summary": ("summary",)},
        formulas=loops.write,
        compared=tuple(loops.compared),
        equations=loops.equations,
        applied=_applied(given, linkage, positions, start),
        paths=("S2", "E", "S4"),
        facts={"summary": SUMMARY, "C": given.C, "F": given.F},
    )


def _applied(given: Parameters, linkage: Linkage, positions: Positions, start: float) -> tuple[Applied, ...]:
    """The force on the slider, positive to the right."""
    if given.force is None:
        return ()
    size, sense = given.force.P.si, given.force.sense
    motion_at = crank_motion(linkage, positions, start, given.speed)
    if sense == "opposing":
        law: Law = opposing(size, lambda angle: motion_at(angle).points["F"].v.real)
    else:
        law = ConstantLaw(size if sense == "right" else -size)
    return (Applied("P5", 5, "F", 1 + 0j, law),)
