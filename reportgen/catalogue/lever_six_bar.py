"""The six-link lever mechanism: crank AB about B, coupler AC, rocker CD about D, rod EF from E on AC, slider F.

Ground 0, crank 1 (BA), coupler 2 (AC), rocker 3 (DC), rod 4 (EF), slider 5 (at F) on a horizontal guide.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated, Literal

from reportgen.assignment import checks
from reportgen.assignment.common import Assignment, Draft, Part, Positions
from reportgen.assignment.faults import Finding
from reportgen.assignment.fields import (
    Length,
    Mass,
    MomentOfInertia,
    Share,
    Weight,
    quantity,
)
from reportgen.catalogue import bars, reach, regulation
from reportgen.catalogue.course import Floats
from reportgen.catalogue.driven import Driven, mass_keys, outline, rate_items
from reportgen.catalogue.laws import Law
from reportgen.catalogue.machine import Applied, Item, Machine, mass_items
from reportgen.catalogue.resistance import Constant, opposing
from reportgen.mechanism.motion import solve_motion
from reportgen.mechanism.structure import Crank, Dyad, Guide, Inertia, Linkage, LinkPoint
from reportgen.notation.expressions import Symbol, subtract
from reportgen.units import Given

KIND = "lever-six-bar"
TITLES = {"vi": "Cơ cấu đòn sáu khâu", "en": "Six-link lever mechanism"}
TURNS = 1

CRANK_DRAWN = 0.04
"""Drawn length of the crank (m on paper) when none is asked for."""
Coordinate = Annotated[Given, quantity("mm", above=-1e5, below=1e5)]
Size = Annotated[Given, quantity("N", least=0, most=1e9)]


class Place(Part):
    """A fixed point by its coordinates from B, x to the right and y upwards."""

    x: Coordinate
    y: Coordinate


class SliderForce(Part):
    """A force on the slider along its guide, of one sense or against its motion."""

    P: Size
    sense: Literal["opposing", "right", "left"] = "opposing"


class Parameters(Driven):
    """Lengths, fixed points, the way the groups are assembled, the speed; masses and the load if given."""

    AB: Length
    AC: Length
    CD: Length
    CE: Length
    EF: Length
    D: Place
    guide: Coordinate
    C: Literal["left", "right"] = "left"
    F: Literal["left", "right"] = "left"
    s1: Share | None = None
    s2: Share | None = None
    s3: Share | None = None
    s4: Share | None = None
    G1: Weight | None = None
    G2: Weight | None = None
    G3: Weight | None = None
    G4: Weight | None = None
    G5: Weight | None = None
    m1: Mass | None = None
    m2: Mass | None = None
    m3: Mass | None = None
    m4: Mass | None = None
    m5: Mass | None = None
    J1: MomentOfInertia | None = None
    J2: MomentOfInertia | None = None
    J3: MomentOfInertia | None = None
    J4: MomentOfInertia | None = None
    force: SliderForce | None = None

    @property
    def bars(self) -> tuple[bars.Bar, ...]:
        """The bars with their mass centres S1…S4."""
        return (
            bars.bar(self, 1, "B", "A", self.AB.si, seen=True),
            bars.bar(self, 2, "A", "C", self.AC.si, seen=True),
            bars.bar(self, 3, "D", "C", self.CD.si, seen=True),
            bars.bar(self, 4, "E", "F", self.EF.si, seen=True),
        )

    @property
    def inertias(self) -> tuple[Inertia, ...]:
        own = (Inertia(5, "F", self.mass(5)),) if self.mass(5) else ()
        return (*(inertia for bar in self.bars for inertia in bar.inertia(self.g.si)), *own)

    @property
    def linkage(self) -> Linkage:
        """The mechanism with B in the origin."""
        rod = (self.EF.si, 0.0)
        guide = Guide(1j * self.guide.si, 0.0)
        return Linkage(
            ground={"B": 0j, "D": complex(self.D.x.si, self.D.y.si)},
            driver=Crank("B", "A", self.AB.si),
            dyads=(
                Dyad("RRR", (2, 3), "A", "C", "D", (self.AC.si, self.CD.si), 1 if self.C == "left" else -1),
                Dyad("RRP", (4, 5), "E", "F", guide, rod, 1 if self.F == "right" else -1),
            ),
            points=(
                LinkPoint("E", 2, complex(self.AC.si - self.CE.si)),
                *(point for bar in self.bars for point in bar.point()),
            ),
            inertias=self.inertias,
            gravity=-1j * self.g.si,
        )


def _check_turning(draft: Draft) -> Iterator[Finding]:
    """The crank turns fully, without dead points, and CD is a rocker."""
    given = draft.sections.get("parameters")
    if given is None:
        return
    if given.CE.si > given.AC.si:
        upper = f"≤ AC = {given.AC.text}"
        yield Finding("out-of-range", ("parameters", "CE"), {"text": given.CE.text, "range": upper})
        return
    members = {
        (2, 3): reach.Member("AC, CD", ("parameters", "CD")),
        (4, 5): reach.Member("EF", ("parameters", "EF")),
    }
    found = list(reach.findings(given.linkage, members))
    yield from found
    if not found and reach.turns_fully(given.linkage, 3):
        yield Finding("not-a-rocker", ("parameters", "CD"), {"link": "3", "rods": "CD"})


CHECKS = (
    checks.one_of("parameters", "n", "omega1"),
    *bars.one_mass((1, 2, 3, 4, 5)),
    regulation.needs_loads((*mass_keys((1, 2, 3, 4, 5)), "force")),
    _check_turning,
)


# --- the machine ----------------------------------------------------------------------------------

SUMMARY = (
    ("v.A", "v.S1", "omega.1"),
    ("v.C", "v.S2", "omega.2"),
    ("v.E", "v.S3", "omega.3"),
    ("v.F", "v.S4", "omega.4"),
)
"""The table of velocities: a joint, a mass centre and an angular velocity in each row."""


def machine(assignment: Assignment) -> Machine:
    """The six-link lever mechanism of an assignment: linkage, load, quantities of its own, outline."""
    given: Parameters = assignment.parameters
    positions, linkage = assignment.positions, given.linkage
    start = 0.0 if positions.start is None else positions.start.si
    applied = _applied(given, positions, start)
    return Machine(
        kind=KIND,
        linkage=linkage,
        start=start,
        turn=positions.sign,
        speed=given.speed,
        count=positions.count,
        turns=TURNS,
        given=_items(given, assignment.drawing.crank),
        formulas=(),
        outline=outline(bool(linkage.inertias), bool(applied), given.flywheel, summary=("summary",)),
        unevenness=given.unevenness,
        applied=applied,
        paths=("S2", "E", "S4"),
        facts={"summary": SUMMARY},
    )


def _applied(given: Parameters, positions: Positions, start: float) -> tuple[Applied, ...]:
    """The force on the slider, positive to the right."""
    if given.force is None:
        return ()
    size, sense = given.force.P.si, given.force.sense
    turn, linkage = positions.sign, given.linkage

    def course(angle: Floats) -> Floats:
        return solve_motion(linkage, start + turn * angle, turn * given.speed).points["F"].v.real

    law: Law = opposing(size, course) if sense == "opposing" else Constant(size if sense == "right" else -size)
    return (Applied("P5", 5, "F", 1 + 0j, law),)


def _items(given: Parameters, crank: Given | None) -> tuple[Item, ...]:
    """Given data, the place of E, mass centres, masses and moments of inertia."""
    items = [
        Item("l.BA", Symbol("l", "AB"), "length", given.AB.si),
        Item("l.AC", Symbol("l", "AC"), "length", given.AC.si),
        Item("l.DC", Symbol("l", "CD"), "length", given.CD.si),
        Item("l.CE", Symbol("l", "CE"), "length", given.CE.si),
        Item("l.EF", Symbol("l", "EF"), "length", given.EF.si),
        Item("D.x", Symbol("x", "D"), "length", given.D.x.si),
        Item("D.y", Symbol("y", "D"), "length", given.D.y.si),
        Item("F.y", Symbol("y", "F"), "length", given.guide.si),
        *rate_items(given),
        Item("drawn.BA", Symbol("AB", over="segment"), "segment", crank.si if crank else CRANK_DRAWN),
        Item("l.AE", Symbol("l", "AE"), "length", definition=subtract("l.AC", "l.CE")),
    ]
    if given.inertias:
        items.append(Item("g", Symbol("g"), "gravity", given.g.si))
    for bar in given.bars:
        items += bar.items()
    items += mass_items(5, given.G5, given.m5)
    if given.force is not None:
        items.append(Item("P.given", Symbol("P", "5"), "force", given.force.P.si))
    return tuple(items)
