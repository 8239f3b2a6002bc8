"""The slider-crank, with its guide through the crank centre or beside it.

Ground 0, crank 1 (AB), rod 2 (BC, mass centre S2), slider 3 (at C).
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import Annotated

from reportgen.assignment import checks
from reportgen.assignment.common import Assignment, Draft, Positions
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
from reportgen.catalogue import offset_slider, regulation, working
from reportgen.catalogue.course import Course
from reportgen.catalogue.driven import Driven, mass_keys, outline, rate_items
from reportgen.catalogue.laws import TableLaw
from reportgen.catalogue.machine import Applied, Item, Machine, mass_items
from reportgen.catalogue.offset_slider import OffsetSlider
from reportgen.mechanism.structure import Inertia
from reportgen.notation.expressions import Symbol, divide, multiply, power
from reportgen.units import Given

KIND = "slider-crank"
TITLES = {"vi": "Cơ cấu tay quay con trượt", "en": "Slider-crank mechanism"}
TURNS = 1

CRANK_DRAWN = 0.04
"""Drawn length of the crank (m on paper) when none is asked for."""
Offset = Annotated[Given, quantity("mm", above=-1e5, below=1e5)]


class Parameters(Driven):
    """Lengths, the guide, the speed; what moves has mass only if it is given one."""

    r: Length
    l: Length  # noqa: E741 - the length's own letter
    e: Offset = Given(0.0, 0.0, "mm", "0 mm")
    guide: Angle = Given(0.0, 0.0, "deg", "0 deg")
    s: Share | None = None
    G2: Weight | None = None
    G3: Weight | None = None
    m2: Mass | None = None
    m3: Mass | None = None
    J2: MomentOfInertia | None = None
    force: working.WorkingForce | None = None

    @property
    def centre(self) -> float | None:
        """l_BS2 (m): as given, the middle of a rod with mass, None for a rod without."""
        if self.s is not None:
            return self.s.si * self.l.si
        return self.l.si / 2 if self.mass(2) or self.moment else None

    @property
    def moment(self) -> float:
        """J of the rod about S2 (kg·m²): as given, else m l²/12."""
        return self.mass(2) * self.l.si**2 / 12 if self.J2 is None else self.J2.si

    def geometry(self, positions: Positions) -> OffsetSlider:
        """The mechanism in the axes that turn with the rotation."""
        turn = positions.sign
        return OffsetSlider(self.r.si, self.l.si, turn * self.e.si, self.guide.si, turn)


def _check_turning(draft: Draft) -> Iterator[Finding]:
    """The crank turns fully: l > r + |e|."""
    given = draft.sections.get("parameters")
    if given is not None and given.l.si <= given.r.si + abs(given.e.si):
        least = f"> r + |e| = {(given.r.si + abs(given.e.si)) * 1e3:g} mm"
        yield Finding("out-of-range", ("parameters", "l"), {"text": given.l.text, "range": least})


CHECKS = (
    checks.one_of("parameters", "n", "omega1"),
    checks.one_of("parameters", "G2", "m2", required=False),
    checks.one_of("parameters", "G3", "m3", required=False),
    *working.CHECKS,
    regulation.needs_loads((*mass_keys((2, 3)), "force")),
    _check_turning,
)


# --- the machine ----------------------------------------------------------------------------------


def machine(assignment: Assignment) -> Machine:
    """The slider-crank of an assignment: linkage, working force, closed formulas, the report's outline."""
    given: Parameters = assignment.parameters
    positions = assignment.positions
    geometry = given.geometry(positions)
    start = geometry.stretched if positions.start is None else geometry.phi(positions.start.si)
    inertias = _inertias(given)
    linkage = geometry.linkage(inertias, given.g.si, given.centre)
    course = geometry.course(start, TURNS)
    applied = _applied(given, geometry, course)
    built = Machine(
        kind=KIND,
        linkage=linkage,
        start=geometry.crank_angle(start),
        turn=positions.sign,
        speed=given.speed,
        count=positions.count,
        turns=TURNS,
        given=_items(given, assignment.drawing.crank),
        formulas=(),
        outline=outline(bool(inertias), bool(applied), given.flywheel),
        unevenness=given.unevenness,
        applied=applied,
        sliders=(course,),
        paths=() if given.centre is None else ("S2",),
        compared=offset_slider.compared(given.centre is not None),
        equations=offset_slider.equations(geometry.e != 0),
    )
    angle = start + built.cycle_angles
    offset = offset_slider.offset_term(geometry, given.e.si)
    return replace(built, formulas=offset_slider.formulas(angle, offset, given.centre is not None))


def _inertias(given: Parameters) -> tuple[Inertia, ...]:
    rod = (Inertia(2, "S2", given.mass(2), given.moment),) if given.mass(2) or given.moment else ()
    return (*rod, Inertia(3, "C", given.mass(3))) if given.mass(3) else rod


def _applied(given: Parameters, geometry: OffsetSlider, course: Course) -> tuple[Applied, ...]:
    """The working force, positive along the guide away from the crank."""
    if given.force is None:
        return ()
    along = complex(math.cos(geometry.axis), math.sin(geometry.axis))
    return (Applied("P3", 3, "C", along, TableLaw(course, given.force.table, turns=TURNS)),)


def _items(given: Parameters, crank: Given | None) -> tuple[Item, ...]:
    """Given data, the mass centre, masses and moments of inertia."""
    items = [
        Item("l.AB", Symbol("l", "AB"), "length", given.r.si),
        Item("l.BC", Symbol("l", "BC"), "length", given.l.si),
        *((Item("e", Symbol("e"), "length", given.e.si),) if given.e.si else ()),
        *((Item("guide.angle", Symbol("α"), "angle", given.guide.si),) if given.guide.si else ()),
        *rate_items(given),
        Item("drawn.AB", Symbol("AB", over="segment"), "segment", crank.si if crank else CRANK_DRAWN),
    ]
    if given.centre is not None:
        ratio = 0.5 if given.s is None else given.s.si
        items += [
            Item("s", Symbol("s"), "ratio", ratio),
            Item("l.BS2", Symbol("l", "BS2"), "length", definition=multiply("s", "l.BC")),
        ]
    if isinstance(given.force, working.Constant):
        items.append(Item("P.given", Symbol("P"), "force", given.force.F.si))
    if given.mass(2) or given.mass(3):
        items.append(Item("g", Symbol("g"), "gravity", given.g.si))
    items += mass_items(2, given.G2, given.m2)
    if given.J2 is not None:
        items.append(Item("J.2", Symbol("J", "S2"), "moment of inertia", given.J2.si))
    elif given.mass(2):
        by_length = divide(multiply("m.2", power("l.BC", 2)), 12)
        items.append(Item("J.2", Symbol("J", "S2"), "moment of inertia", definition=by_length))
    return (*items, *mass_items(3, given.G3, given.m3))
