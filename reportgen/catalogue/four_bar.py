"""The four-bar linkage: crank AB, coupler BC with points E and F, link CD; A and D fixed.

Ground 0, crank 1 (AB), coupler 2 (BC), rocker or second crank 3 (CD, its frame from D to C).
"""

from __future__ import annotations

import cmath
from collections.abc import Iterator
from dataclasses import replace
from typing import Annotated, Literal

from reportgen.assignment import checks
from reportgen.assignment.common import Assignment, Draft, Part
from reportgen.assignment.faults import Finding
from reportgen.assignment.fields import (
    Angle,
    Length,
    Mass,
    MomentOfInertia,
    Share,
    Weight,
    quantity,
)
from reportgen.catalogue import bars, four_bar_formulas, link_torque, reach, regulation
from reportgen.catalogue.driven import Driven, mass_keys, outline, rate_items
from reportgen.catalogue.four_bar_formulas import Couplings, Sides
from reportgen.catalogue.machine import Applied, Item, Machine
from reportgen.catalogue.resistance import Constant
from reportgen.mechanism.structure import Crank, Dyad, Linkage, LinkPoint
from reportgen.notation.expressions import Symbol
from reportgen.units import Given

KIND = "four-bar"
TITLES = {"vi": "Cơ cấu bốn khâu bản lề", "en": "Four-bar linkage"}
TURNS = 1

CRANK_DRAWN = 0.04
"""Drawn length of the crank (m on paper) when none is asked for."""
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


class Parameters(Driven):
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
    s1: Share | None = None
    s2: Share | None = None
    s3: Share | None = None
    G1: Weight | None = None
    G2: Weight | None = None
    G3: Weight | None = None
    m1: Mass | None = None
    m2: Mass | None = None
    m3: Mass | None = None
    J1: MomentOfInertia | None = None
    J2: MomentOfInertia | None = None
    J3: MomentOfInertia | None = None
    torque: link_torque.LinkTorque | None = None
    force: LinkForce | None = None

    @property
    def sign(self) -> int:
        """+1 where C lies to the left of the way from B to D."""
        return 1 if self.branch == "open" else -1

    @property
    def bars(self) -> tuple[bars.Bar, ...]:
        """The moving links with their masses."""
        return (
            bars.bar(self, 1, "A", "B", self.AB.si),
            bars.bar(self, 2, "B", "C", self.BC.si),
            bars.bar(self, 3, "D", "C", self.CD.si),
        )

    @property
    def coupler(self) -> tuple[LinkPoint, ...]:
        """E and F, as far as they are given."""
        e = self.E
        first = () if e is None else (LinkPoint("E", 2, complex(e.along.si, e.across.si)),)
        return first if self.BF is None else (*first, LinkPoint("F", 2, complex(self.BF.si)))

    @property
    def linkage(self) -> Linkage:
        """The mechanism with A in the origin."""
        g = self.g.si
        return Linkage(
            ground={"A": 0j, "D": cmath.rect(self.AD.si, self.frame.si)},
            driver=Crank("A", "B", self.AB.si),
            dyads=(Dyad("RRR", (2, 3), "B", "C", "D", (self.BC.si, self.CD.si), self.sign),),
            points=(*self.coupler, *(point for bar in self.bars for point in bar.point())),
            inertias=tuple(inertia for bar in self.bars for inertia in bar.inertia(g)),
            gravity=-1j * g,
        )


def _check_turning(draft: Draft) -> Iterator[Finding]:
    """The crank turns fully, without dead points, and link 3 does what the file says of it."""
    given = draft.sections.get("parameters")
    if given is None:
        return
    member = reach.Member("BC, CD", ("parameters", "BC"))
    found = list(reach.findings(given.linkage, {(2, 3): member}))
    yield from found
    if not found and given.link3 is not None:
        fully = reach.turns_fully(given.linkage, 3)
        if fully != (given.link3 == "crank"):
            code = "not-a-rocker" if fully else "not-a-crank"
            yield Finding(code, ("parameters", "link3"), {"link": "3", "rods": "CD"})


CHECKS = (
    checks.one_of("parameters", "n", "omega1"),
    *bars.one_mass((1, 2, 3)),
    regulation.needs_loads((*mass_keys((1, 2, 3)), "torque", "force")),
    _check_turning,
)


# --- the machine ----------------------------------------------------------------------------------


def machine(assignment: Assignment) -> Machine:
    """The four-bar linkage of an assignment: linkage, loads, analytic method, the report's outline."""
    given: Parameters = assignment.parameters
    positions, linkage = assignment.positions, given.linkage
    frame, turn = given.frame.si, positions.sign
    start = frame if positions.start is None else positions.start.si
    applied, torques = _force(given), link_torque.acting(given.torque, 3, linkage, positions, start)
    sides = Sides(given.AB.si, given.BC.si, given.CD.si, given.AD.si)
    coupler = tuple(point for point in linkage.points if point.link == 2)
    built = Machine(
        kind=KIND,
        linkage=linkage,
        start=start,
        turn=turn,
        speed=given.speed,
        count=positions.count,
        turns=TURNS,
        given=(*_items(given, assignment.drawing.crank), *four_bar_formulas.proportions(sides)),
        formulas=(),
        outline=outline(bool(linkage.inertias), bool(applied or torques), given.flywheel),
        unevenness=given.unevenness,
        applied=applied,
        torques=torques,
        paths=tuple(point.name for point in coupler),
        compared=four_bar_formulas.compared(coupler),
        equations=four_bar_formulas.equations(),
        facts={"left": turn * given.sign > 0},
    )
    phi = turn * (built.angles(built.cycle_angles) - frame)
    couplings = Couplings(coupler, turn, turn * given.sign)
    return replace(built, formulas=four_bar_formulas.formulas(sides, phi, couplings))


def _force(given: Parameters) -> tuple[Applied, ...]:
    if given.force is None:
        return ()
    return (Applied("P3", 3, "C", cmath.rect(1.0, given.force.angle.si), Constant(given.force.P.si)),)


def _items(given: Parameters, crank: Given | None) -> tuple[Item, ...]:
    """Given data, coupler points, mass centres, masses and moments of inertia."""
    items = [
        Item("l.AB", Symbol("l", "AB"), "length", given.AB.si),
        Item("l.BC", Symbol("l", "BC"), "length", given.BC.si),
        Item("l.DC", Symbol("l", "CD"), "length", given.CD.si),
        Item("l.AD", Symbol("l", "AD"), "length", given.AD.si),
        *((Item("frame", Symbol("α"), "angle", given.frame.si),) if given.frame.si else ()),
        *rate_items(given),
        Item("drawn.AB", Symbol("AB", over="segment"), "segment", crank.si if crank else CRANK_DRAWN),
    ]
    if given.E is not None:
        items += [
            Item("E.along", Symbol("x", "E"), "length", given.E.along.si),
            Item("E.across", Symbol("y", "E"), "length", given.E.across.si),
            *four_bar_formulas.triangle("E", off_line=given.E.across.si != 0),
        ]
    if given.BF is not None:
        items.append(Item("l.BF", Symbol("l", "BF"), "length", given.BF.si))
    if given.linkage.inertias:
        items.append(Item("g", Symbol("g"), "gravity", given.g.si))
    for bar in given.bars:
        items += bar.items()
    if given.torque is not None:
        items.append(Item("M.given", Symbol("M", "3"), "torque", given.torque.M.si))
    if given.force is not None:
        items += [
            Item("P.given", Symbol("P", "3"), "force", given.force.P.si),
            Item("P.angle", Symbol("α", "P"), "angle", given.force.angle.si),
        ]
    return tuple(items)
