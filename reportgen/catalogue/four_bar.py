"""The four-bar linkage: crank AB, coupler BC with points E and F, link CD; A and D fixed.

Ground 0, crank 1 (AB), coupler 2 (BC), rocker or second crank 3 (CD, its frame from D to C).
"""

from __future__ import annotations

import cmath
from collections.abc import Iterator
from typing import Annotated, Literal

from reportgen.assignment.common import Assignment, Draft, Part
from reportgen.assignment.faults import Finding
from reportgen.assignment.fields import Angle, Length, quantity
from reportgen.catalogue import reach
from reportgen.catalogue.driven import Driven, GivenSheet, driven, even_angles
from reportgen.catalogue.four_bar_formulas import FourBar, analytic_method, equations, proportions, triangle
from reportgen.catalogue.given_loads import LinkTorque, torque_on
from reportgen.catalogue.loads import Applied, Constant
from reportgen.catalogue.machine import Machine
from reportgen.catalogue.sliders import compared
from reportgen.mechanism.structure import Crank, Dyad, Linkage, LinkPoint
from reportgen.notation.expressions import Symbol
from reportgen.units import Given

TURNS = 1
LINKS = {1: ("A", "B"), 2: ("B", "C"), 3: ("D", "C")}
"""The bars by the pins at their ends."""
Offset = Annotated[Given, quantity("mm", above=-1e5, below=1e5)]
Size = Annotated[Given, quantity("N", least=0, most=1e9)]


class CouplerPoint(Part):
    """A point of the coupler: its distances from B along BC, and across it to the left."""

    along: Offset
    across: Offset = Given(0.0, 0.0, "mm", "0 mm")


class LinkForce(Part):
    """A force on link 3 at C, in a direction fixed in the plane."""

    P: Size
    angle: Angle


class Parameters(
    Driven, masses=(1, 2, 3), moments=(1, 2, 3), shares=(1, 2, 3), loads=("torque", "force")
):
    """Lengths, the branch, the speed; coupler points, masses and loads only if they are given."""

    AB: Length
    BC: Length
    CD: Length
    AD: Length
    frame: Angle = Given(0.0, 0.0, "deg", "0 deg")
    branch: Literal["open", "crossed"] = "open"
    link3: Literal["rocker", "crank"] | None = None
    E: CouplerPoint | None = None
    BF: Length | None = None
    torque: LinkTorque | None = None
    force: LinkForce | None = None

    @property
    def side(self) -> int:
        """+1 where C lies to the left of the way from B to D."""
        return 1 if self.branch == "open" else -1


def _sheet(given: Parameters, crank: Given | None = None) -> GivenSheet:
    """Given data, coupler points, mass centres, masses and moments of inertia, Grashof's sums."""
    q = GivenSheet(given)
    for id, length in {"AB": given.AB, "BC": given.BC, "DC": given.CD, "AD": given.AD}.items():
        q.datum(f"l.{id}", length, Symbol("l", "CD" if id == "DC" else id))
    if given.frame.si:
        q.datum("frame", given.frame, "α", "angle")
    q.speed()
    q.drawn("A", "B", crank)
    if given.E is not None:
        q.datum("E.along", given.E.along, Symbol("x", "E"), "length")
        q.datum("E.across", given.E.across, Symbol("y", "E"), "length")
        triangle(q, "E")
    if given.BF is not None:
        q.datum("l.BF", given.BF)
    q.gravity("GmJ")
    for link, (start, end) in LINKS.items():
        q.bar(link, start, end)
    if given.torque is not None:
        q.datum("M.given", given.torque.M, Symbol("M", "3"))
    if given.force is not None:
        q.datum("P.given", given.force.P, Symbol("P", "3"), "force")
        q.datum("P.angle", given.force.angle, Symbol("α", "P"), "angle")
    proportions(q)
    return q


def _linkage(given: Parameters, q: GivenSheet) -> Linkage:
    """The mechanism with A in the origin."""
    e = () if given.E is None else (LinkPoint("E", 2, complex(given.E.along.si, given.E.across.si)),)
    f = () if given.BF is None else (LinkPoint("F", 2, complex(given.BF.si)),)
    lengths = q.si("l.BC"), q.si("l.DC")
    return Linkage(
        ground={"A": 0j, "D": cmath.rect(q.si("l.AD"), given.frame.si)},
        driver=Crank("A", "B", q.si("l.AB")),
        dyads=(Dyad("RRR", (2, 3), "B", "C", "D", lengths, given.side),),
        points=(*e, *f, *q.centre_points({link: start for link, (start, _) in LINKS.items()})),
        inertias=q.inertias({link: f"S{link}" for link in LINKS}),
        gravity=-1j * given.g.si,
    )


def _check_turning(draft: Draft) -> Iterator[Finding]:
    """The crank turns fully, without dead points, and link 3 does what the file says of it."""
    given: Parameters | None = draft.sections.get("parameters")
    if given is None:
        return
    linkage = _linkage(given, _sheet(given))
    found = list(reach.findings(linkage, {(2, 3): reach.Member("BC, CD", ("parameters", "BC"))}))
    yield from found
    if not found and given.link3 is not None:
        fully = reach.turns_fully(linkage, 3)
        if fully != (given.link3 == "crank"):
            code = "not-a-rocker" if fully else "not-a-crank"
            yield Finding(code, ("parameters", "link3"), {"link": "3", "rods": "CD"})


CHECKS = (_check_turning,)


def machine(assignment: Assignment) -> Machine:
    """The four-bar linkage of an assignment: linkage, loads, analytic method."""
    given: Parameters = assignment.parameters
    positions, turn = assignment.positions, assignment.positions.sign
    q = _sheet(given, assignment.drawing.crank)
    linkage, frame, force = _linkage(given, q), given.frame.si, given.force
    start = frame if positions.start is None else positions.start.si
    points = tuple(point for point in linkage.points if point.link == 2)
    names = [point.name for point in points]
    φ1 = turn * (start + turn * even_angles(positions) - frame)
    plans = ("omega.2", "omega.3", *(f"v.{name}" for name in names), "eps.2", "eps.3", *(f"a.{name}" for name in names))
    return driven(
        assignment,
        q,
        linkage,
        start,
        formulas=lambda q: analytic_method(q, FourBar(φ1, points, turn, turn * given.side)),
        applied=() if force is None else (
            Applied("P3", 3, "C", cmath.rect(1.0, force.angle.si), Constant(force.P.si)),
        ),
        torques=torque_on(given.torque, 3, linkage, positions, start),
        paths=tuple(names),
        compared=compared(plans),
        equations=equations(),
        facts={"left": turn * given.side > 0},
    )
