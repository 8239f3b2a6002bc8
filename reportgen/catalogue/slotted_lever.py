"""The slotted lever: a crank's pin carries a block that slides along a lever and turns it.

Ground 0, crank 1 (AB), block 2 (at B), lever 3 (CD).  A and C are fixed; D is on the lever, beyond the block.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

from reportgen.assignment import checks
from reportgen.assignment.common import Assignment, Draft
from reportgen.assignment.faults import Finding
from reportgen.assignment.fields import Angle, Length, Mass, MomentOfInertia, Share, Weight
from reportgen.catalogue import bars, link_torque, regulation, slotted
from reportgen.catalogue.driven import Driven, mass_keys, outline, rate_items
from reportgen.catalogue.machine import Item, Machine, mass_items
from reportgen.catalogue.slotted import SlottedCrank
from reportgen.mechanism.structure import Inertia, Linkage, LinkPoint
from reportgen.notation.expressions import Symbol, divide
from reportgen.units import Given

KIND = "slotted-lever"
TITLES = {"vi": "Cơ cấu culít", "en": "Crank and slotted lever"}
TURNS = 1


class Parameters(Driven):
    """Lengths of crank AB, of AC between the fixed points and of the lever CD; the direction of CA; the speed.

    Masses of block and lever and the torque on the lever only if they are given.
    """

    AB: Length
    AC: Length
    CD: Length
    axis: Angle = Given(math.pi / 2, 90.0, "deg", "90 deg")
    s3: Share | None = None
    G2: Weight | None = None
    G3: Weight | None = None
    m2: Mass | None = None
    m3: Mass | None = None
    J3: MomentOfInertia | None = None
    torque: link_torque.LinkTorque | None = None

    def geometry(self, turn: int) -> SlottedCrank:
        """The mechanism in the axes that turn with the rotation."""
        return SlottedCrank(self.AB.si, self.AC.si, self.axis.si, turn)

    @property
    def lever(self) -> bars.Bar:
        """Lever 3 with its mass."""
        return bars.bar(self, 3, "C", "D", self.CD.si)

    def linkage(self, turn: int) -> Linkage:
        """The mechanism with A in the origin; the block's mass centre is the pin."""
        geometry = self.geometry(turn)
        block = (Inertia(2, "B", self.mass(2)),) if self.mass(2) else ()
        return Linkage(
            ground=geometry.ground,
            driver=geometry.driver,
            dyads=(geometry.group,),
            points=(LinkPoint("D", 3, complex(self.CD.si)), *self.lever.point()),
            inertias=(*block, *self.lever.inertia(self.g.si)),
            gravity=-1j * self.g.si,
        )


def _check_block(draft: Draft) -> Iterator[Finding]:
    """The block stays on the lever, and clear of the lever's own pivot."""
    given: Parameters | None = draft.sections.get("parameters")
    if given is None:
        return
    geometry = given.geometry(1)
    if given.AB.si == given.AC.si:
        near = math.degrees(geometry.crank_angle(-math.pi / 2)) % 360
        yield Finding("block-on-pivot", ("parameters", "AB"), _told(near))
    reach = given.AB.si + given.AC.si
    if given.CD.si <= reach:
        far = math.degrees(geometry.crank_angle(math.pi / 2)) % 360
        sizes = {"reach": f"{reach * 1e3:.6g}", "length": f"{given.CD.si * 1e3:.6g}"}
        yield Finding("leaves-slot", ("parameters", "CD"), _told(far) | sizes)


def _told(angle: float) -> dict[str, str]:
    return {"block": "2", "link": "3", "group": "(2, 3)", "pivot": "C", "angle": f"{angle:.6g}"}


CHECKS = (
    checks.one_of("parameters", "n", "omega1"),
    *bars.one_mass((2, 3)),
    regulation.needs_loads((*mass_keys((2, 3)), "torque")),
    _check_block,
)


def machine(assignment: Assignment) -> Machine:
    """The slotted lever of an assignment: linkage, closed formulas, the report's outline."""
    given: Parameters = assignment.parameters
    positions, crank = assignment.positions, assignment.drawing.crank
    geometry = given.geometry(positions.sign)
    linkage = given.linkage(positions.sign)
    start = math.pi / 2 if positions.start is None else geometry.phi(positions.start.si)
    height = max(given.CD.si, given.AC.si + given.AB.si) + max(given.AB.si - given.AC.si, 0.0)
    drawn = crank.si if crank else slotted.drawn_crank(given.AB.si, height)
    torques = link_torque.acting(given.torque, 3, linkage, positions, geometry.crank_angle(start))
    built = Machine(
        kind=KIND,
        linkage=linkage,
        start=geometry.crank_angle(start),
        turn=positions.sign,
        speed=given.speed,
        count=positions.count,
        turns=TURNS,
        given=_items(given, drawn),
        formulas=(),
        outline=outline(bool(linkage.inertias), bool(torques), given.flywheel),
        unevenness=given.unevenness,
        torques=torques,
        paths=("D",),
        compared=slotted.COMPARED,
        equations=slotted.equations(Symbol("l", "AB"), Symbol("l", "AC")),
    )
    angle = start + built.cycle_angles
    return replace(built, formulas=(*_extremes(geometry), *slotted.formulas(angle, given.speed, given.AB.si)))


def _items(given: Parameters, drawn: float) -> tuple[Item, ...]:
    """Given data, the mass centre of the lever, masses and the moment of inertia."""
    masses = (*mass_items(2, given.G2, given.m2), *given.lever.items())
    return (
        Item("l.AB", Symbol("l", "AB"), "length", given.AB.si),
        Item("l.AC", Symbol("l", "AC"), "length", given.AC.si),
        Item("l.CD", Symbol("l", "CD"), "length", given.CD.si),
        *((Item("axis.CA", Symbol("α"), "angle", given.axis.si),) if given.axis.value != 90.0 else ()),
        *rate_items(given),
        Item("drawn.AB", Symbol("AB", over="segment"), "segment", drawn),
        *((Item("g", Symbol("g"), "gravity", given.g.si),) if masses else ()),
        *masses,
        *((Item("M.given", Symbol("M", "3"), "torque", given.torque.M.si),) if given.torque else ()),
    )


def _extremes(geometry: SlottedCrank) -> tuple[Item, ...]:
    """The drawn distance AC; of a swinging lever its greatest angle from CA."""
    drawn = Item("drawn.AC", Symbol("AC", over="segment"), "segment", definition=divide("l.AC", "mu.l"))
    if not geometry.swings:
        return (drawn,)
    return (drawn, *slotted.swing_items(divide("l.AB", "l.AC")))
