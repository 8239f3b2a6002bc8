"""The slotted lever: a crank's pin carries a block that slides along a lever and turns it.

Ground 0, crank 1 (AB), block 2 (at B), lever 3 (CD).  A and C are fixed; D is on the lever, beyond the block.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

from reportgen.assignment.checks import of_parameters
from reportgen.assignment.common import Assignment
from reportgen.assignment.fields import Angle, Length
from reportgen.base.errors import Finding
from reportgen.base.units import Given
from reportgen.catalogue import slotted
from reportgen.catalogue.driven_machine import driven
from reportgen.catalogue.given_data import GivenData, cycle_angles
from reportgen.catalogue.given_loads import LinkTorque, torque_on
from reportgen.catalogue.parameters import Driven
from reportgen.catalogue.slotted import SlottedCrank
from reportgen.formula import Symbol
from reportgen.formula.calculation import Calculation
from reportgen.formula.vocabulary import drawn_length
from reportgen.machine import Linkage, LinkPoint
from reportgen.machine.analysis import Machine

TURNS = 1


class Parameters(Driven, masses=(2, 3), moments=(3,), shares=(3,), loads=("torque",)):
    """Lengths of crank AB, of AC between the fixed points and of the lever CD; the direction of CA; the speed.

    Masses of block and lever and the torque on the lever only if they are given.
    """

    AB: Length
    AC: Length
    CD: Length
    axis: Angle = Given(math.pi / 2, 90.0, "deg", "90 deg")
    torque: LinkTorque | None = None


@of_parameters
def _check_block(given: Parameters) -> Iterator[Finding]:
    """Yield faults unless the block stays on the lever, and clear of the lever's own pivot."""
    geometry = SlottedCrank(given.AB.si, given.AC.si, given.axis.si, 1)
    if given.AB.si == given.AC.si:
        near = math.degrees(geometry.crank_angle(-math.pi / 2)) % 360
        yield Finding("block-on-pivot", ("parameters", "AB"), _place(near))
    reach = given.AB.si + given.AC.si
    if given.CD.si <= reach:
        far = math.degrees(geometry.crank_angle(math.pi / 2)) % 360
        sizes = {"reach": f"{reach * 1e3:.6g}", "length": f"{given.CD.si * 1e3:.6g}"}
        yield Finding("leaves-slot", ("parameters", "CD"), _place(far) | sizes)


def _place(angle: float) -> dict[str, str]:
    """Return values for a message about the block: its group and the crank's angle in degrees."""
    return {"block": "2", "link": "3", "group": "(2, 3)", "pivot": "C", "angle": f"{angle:.6g}"}


CHECKS = (_check_block,)


def machine(assignment: Assignment) -> Machine:
    """Return the slotted lever of an assignment: linkage, torque, closed formulas."""
    given: Parameters = assignment.parameters
    positions, crank = assignment.positions, assignment.drawing.crank
    q = GivenData(given)
    r, d, l = q.datum("l.AB", given.AB), q.datum("l.AC", given.AC), q.datum("l.CD", given.CD)  # noqa: E741
    if given.axis.value != 90.0:
        q.datum("axis.CA", given.axis, "α", "angle")
    q.speed()
    height = max(q.si(l), q.si(d) + q.si(r)) + max(q.si(r) - q.si(d), 0.0)
    q.drawn("A", "B", crank, slotted.drawn_crank(q.si(r), height))
    q.gravity("SsGmJ")
    q.mass(2)
    q.bar(3, "C", "D", rod=False)
    if given.torque is not None:
        q.datum("M.given", given.torque.M, Symbol("M", "3"))
    q.set_out("lengths", r, d, l, "l.CS3")
    q.set_out("swing")
    q.set_out("loads", "M3")

    geometry = SlottedCrank(q.si(r), q.si(d), given.axis.si, positions.sign)
    q.fix("p.C", geometry.ground["C"], d)
    start = math.pi / 2 if positions.first is None else geometry.phi(positions.first.si)
    linkage = Linkage(
        ground=geometry.ground,
        driver=geometry.driver,
        groups=(geometry.group,),
        points=(LinkPoint("D", 3, complex(q.si(l))), *q.centre_points({3: "C"})),
        inertias=q.inertias({2: "B", 3: "S3"}),
        gravity=-1j * given.gravity,
    )

    def formulas(q: Calculation) -> None:
        q.define("drawn.AC", d / q["mu.l"], drawn_length("A", "C"))
        if geometry.swings:
            slotted.swing(q, r / d)
        slotted.lever_end(q, positions.sign, start + cycle_angles(positions))

    return driven(
        assignment,
        q,
        linkage,
        geometry.crank_angle(start),
        formulas=formulas,
        torques=torque_on(given.torque, 3, linkage, positions, geometry.crank_angle(start)),
        paths=("D",),
        compared=slotted.LEVER_COMPARED,
        facts={"form": "swings" if geometry.swings else "turns", "axis": "given" if "axis.CA" in q else "vertical"},
        equations=slotted.lever_equations(positions.sign, Symbol("l", "AB"), Symbol("l", "AC"), given.acceleration),
    )
