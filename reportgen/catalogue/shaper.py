"""The shaper: a crank swings a slotted lever, a link carries the swing on to the ram with the tool.

Ground 0, crank 1 (AB), block 2 (at B), rocker 3 (CD, mass centre S3), link 4 (DE, S4), ram 5 (at E).
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import Annotated

from reportgen.assignment import checks
from reportgen.assignment.common import Assignment, Draft, Part
from reportgen.assignment.faults import Finding
from reportgen.assignment.fields import (
    Interval,
    Length,
    Mass,
    MomentOfInertia,
    Ratio,
    Share,
    Weight,
    quantity,
)
from reportgen.catalogue import ram, reach, regulation, slotted
from reportgen.catalogue.course import Course
from reportgen.catalogue.driven import Driven, mass_keys, outline, rate_items
from reportgen.catalogue.machine import Applied, Item, Machine, mass_items
from reportgen.catalogue.ram import CuttingLaw, Ram
from reportgen.catalogue.reach import Member
from reportgen.catalogue.slotted import HIGHEST, SlottedCrank
from reportgen.cycle.applied import Cutting
from reportgen.mechanism.structure import Inertia, LinkPoint
from reportgen.notation.expressions import PI, Symbol, add, divide, multiply, power, subtract
from reportgen.notation.numbers import nice_up
from reportgen.units import Given

KIND = "shaper"
TITLES = {"vi": "Máy bào ngang", "en": "Shaper"}
TURNS = 1
LINKS = {2: "B", 3: "S3", 4: "S4", 5: "E"}
"""Mass centres of the links that may have mass."""
ROCKER, LINK = 3, 4

Force = Annotated[Given, quantity("N", above=0, most=1e7)]
FreeShare = Annotated[Given, Ratio(Interval(least=0, below=0.5))]


class CuttingForce(Part):
    """The force F against the tool while it cuts, and the share of the stroke at each end where it does not."""

    F: Force
    free: FreeShare = Given(0.0, 0.0, "", "0")


class Parameters(Driven):
    """Lengths, the stroke, the speed; what moves has mass only if it is given one."""

    a: Length
    b: Length
    l3: Length
    l4: Length
    H: Length
    cutting: CuttingForce | None = None
    s3: Share = Given(0.5, 0.5, "", "0.5")
    s4: Share = Given(0.5, 0.5, "", "0.5")
    G2: Weight | None = None
    G3: Weight | None = None
    G4: Weight | None = None
    G5: Weight | None = None
    m2: Mass | None = None
    m3: Mass | None = None
    m4: Mass | None = None
    m5: Mass | None = None
    J3: MomentOfInertia | None = None
    J4: MomentOfInertia | None = None

    @property
    def crank(self) -> float:
        """l₁ = aH/(2 l₃) (m)."""
        return self.a.si * self.H.si / (2 * self.l3.si)

    def length(self, link: int) -> float:
        """Length of rocker 3 or link 4 (m)."""
        return self.l3.si if link == ROCKER else self.l4.si

    def share(self, link: int) -> float:
        """CS3/CD or DS4/DE."""
        return self.s3.si if link == ROCKER else self.s4.si

    def moment(self, link: int) -> float:
        """J about the mass centre (kg·m²) of rocker 3 or link 4: as given, else m l²/12."""
        given: Given | None = getattr(self, f"J{link}")
        return self.mass(link) * self.length(link) ** 2 / 12 if given is None else given.si

    def geometry(self, turn: int) -> Ram:
        """The mechanism in the axes that turn with the rotation."""
        crank = SlottedCrank(self.crank, self.a.si, math.pi / 2, turn)
        return Ram(crank, self.l3.si, self.l4.si, self.b.si)


def _check_assembly(draft: Draft) -> Iterator[Finding]:
    """The rocker swings, the block stays in it, and link 4 reaches from D to the ram's line all through the turn."""
    given: Parameters | None = draft.sections.get("parameters")
    if given is None:
        return
    told = {"block": "2", "link": "3", "group": "(2, 3)", "pivot": "C"}
    if given.crank >= given.a.si:
        sizes = {"crank": f"{given.crank * 1e3:.6g}", "centres": "AC", "distance": f"{given.a.si * 1e3:.6g}"}
        most = f"{2e3 * given.l3.si:.6g} mm"
        yield Finding("rocker-turns", ("parameters", "H"), told | sizes | {"angle": "270", "most": most})
        return
    farthest = given.a.si + given.crank
    if given.l3.si <= farthest:
        sizes = {"reach": f"{farthest * 1e3:.6g}", "length": f"{given.l3.si * 1e3:.6g}", "angle": "90"}
        yield Finding("leaves-slot", ("parameters", "l3"), told | sizes)
    members = {(2, 3): Member("CD", ("parameters", "H")), (4, 5): Member("DE", ("parameters", "l4"))}
    yield from reach.findings(given.geometry(1).linkage((), (), 0.0), members)


CHECKS = (
    checks.one_of("parameters", "n", "omega1"),
    *(checks.one_of("parameters", f"G{link}", f"m{link}", required=False) for link in LINKS),
    regulation.needs_loads((*mass_keys(LINKS), "cutting")),
    _check_assembly,
)


# --- the machine ----------------------------------------------------------------------------------


def machine(assignment: Assignment) -> Machine:
    """The shaper of an assignment: linkage, cutting force, closed formulas, the report's outline."""
    given: Parameters = assignment.parameters
    positions, crank = assignment.positions, assignment.drawing.crank
    geometry = given.geometry(positions.sign)
    start = 0.0 if positions.start is None else geometry.crank.phi(positions.start.si)
    course = geometry.course(start)
    inertias = _inertias(given)
    points = tuple(
        LinkPoint(LINKS[link], link, complex(given.share(link) * given.length(link)))
        for link in (ROCKER, LINK)
        if any(body.link == link for body in inertias)
    )
    applied = _applied(given, course)
    built = Machine(
        kind=KIND,
        linkage=geometry.linkage(points, inertias, given.g.si),
        start=geometry.crank.crank_angle(start),
        turn=positions.sign,
        speed=given.speed,
        count=positions.count,
        turns=TURNS,
        given=(*_items(given), *_drawn(given, crank)),
        formulas=(),
        outline=outline(bool(inertias), bool(applied), given.flywheel, sizes="synthesis", course=("course",)),
        unevenness=given.unevenness,
        applied=applied,
        sliders=(course,),
        paths=("D",),
        compared=ram.COMPARED,
        equations=ram.equations(),
    )
    return replace(built, formulas=(*_stroke(), *ram.formulas(start + built.cycle_angles, given.speed, given.crank)))


def _inertias(given: Parameters) -> tuple[Inertia, ...]:
    """The links that were given a mass, or a moment of inertia."""
    found = []
    for link, centre in LINKS.items():
        moment = given.moment(link) if link in (ROCKER, LINK) else 0.0
        if given.mass(link) or moment:
            found.append(Inertia(link, centre, given.mass(link), moment))
    return tuple(found)


def _applied(given: Parameters, course: Course) -> tuple[Applied, ...]:
    """The cutting force on the ram, against its working way."""
    if given.cutting is None:
        return ()
    cutting = Cutting(given.cutting.F.si, course.bottom_angle, given.cutting.free.si)
    return (Applied("P5", 5, "E", -course.inward, CuttingLaw(course, cutting)),)


def _items(given: Parameters) -> tuple[Item, ...]:
    """Given data and the synthesis l₁ = aH/(2 l₃); mass centres, masses, moments of inertia."""
    items = [
        Item("a", Symbol("a"), "length", given.a.si),
        Item("b", Symbol("b"), "length", given.b.si),
        Item("l.CD", Symbol("l", "3"), "length", given.l3.si),
        Item("l.DE", Symbol("l", "4"), "length", given.l4.si),
        Item("H", Symbol("H"), "length", given.H.si),
        *rate_items(given),
        Item(
            "l.AB",
            Symbol("l", "1"),
            "length",
            definition=divide(multiply("a", "H"), multiply(2, "l.CD")),
        ),
    ]
    if given.cutting is not None:
        items.append(Item("P.given", Symbol("P"), "force", given.cutting.F.si))
        if given.cutting.free.si:
            items.append(Item("free", Symbol("k"), "ratio", given.cutting.free.si))
    bodies = _inertias(given)
    if any(body.mass for body in bodies):
        items.append(Item("g", Symbol("g"), "gravity", given.g.si))
    for link in LINKS:
        items += mass_items(link, getattr(given, f"G{link}"), getattr(given, f"m{link}"))
    for body in bodies:
        if body.link in (ROCKER, LINK):
            items += _centre_items(given, body.link)
    return tuple(items)


def _drawn(given: Parameters, crank: Given | None) -> tuple[Item, ...]:
    """The crank's drawn length: as asked for, else by the finest round scale at which all stays on the page."""
    symbol = Symbol("AB", over="segment")
    if crank is not None:
        return (Item("drawn.AB", symbol, "segment", crank.si),)
    scale = nice_up(max(given.b.si, given.l3.si) / HIGHEST / 1e3) * 1e3
    return (
        Item("scale", Symbol("μ", "l"), "length scale", scale),
        Item("drawn.AB", symbol, "segment", definition=divide("l.AB", "scale")),
    )


def _centre_items(given: Parameters, link: int) -> tuple[Item, ...]:
    """The place of a mass centre on rocker 3 or link 4, and the moment of inertia about it."""
    number, rod = str(link), {ROCKER: "CD", LINK: "DE"}[link]
    arm, symbol = f"{rod[0]}S{link}", Symbol("J", f"S{link}")
    typed: Given | None = getattr(given, f"J{link}")
    by_length = divide(multiply(f"m.{link}", power(f"l.{rod}", 2)), 12)
    return (
        Item(f"s.{link}", Symbol("s", number), "ratio", given.share(link)),
        Item(f"l.{arm}", Symbol("l", arm), "length", definition=multiply(f"s.{link}", f"l.{rod}")),
        Item(f"J.{link}", symbol, "moment of inertia", definition=by_length)
        if typed is None
        else Item(f"J.{link}", symbol, "moment of inertia", typed.si),
    )


def _stroke() -> tuple[Item, ...]:
    """The drawn distance AC, the swing θ and the ratio K, and the mean speeds of both strokes."""
    turn = "t.turn"
    return (
        Item("drawn.AC", Symbol("AC", over="segment"), "segment", definition=divide("a", "mu.l")),
        *slotted.swing_items(divide("H", multiply(2, "l.CD"))),
        Item(turn, Symbol("T"), "time", definition=divide(multiply(2, PI), "omega.1")),
        Item("t.work", Symbol("t", "1"), "time", definition=divide(multiply(turn, "K"), add(1, "K"))),
        Item("t.back", Symbol("t", "2"), "time", definition=subtract(turn, "t.work")),
        Item("v.work", Symbol("v", "m1"), "velocity", definition=divide("H", "t.work")),
        Item("v.back", Symbol("v", "m2"), "velocity", definition=divide("H", "t.back")),
    )
