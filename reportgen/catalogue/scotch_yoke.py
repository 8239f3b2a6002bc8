"""The Scotch yoke, or sine mechanism: the crank's pin carries a block that slides in the slot of a yoke.

Ground 0, crank 1 (OA), block 2 (at A), yoke 3, which slides along a straight guide through O; B is the yoke's point
on the guide, and the slot is square to it.  φ is the crank's angle from the guide in the direction of rotation.
"""

from __future__ import annotations

import cmath
import math

from reportgen.assignment.common import Assignment
from reportgen.assignment.fields import Angle, Length
from reportgen.base.units import Given
from reportgen.catalogue import given_loads
from reportgen.catalogue.driven_machine import driven
from reportgen.catalogue.given_data import GivenData, accelerated, accelerating, cycle_angles, natural_lines
from reportgen.catalogue.parameters import Driven
from reportgen.formula import Chain, Symbol, cos, minus, plus, sin, times
from reportgen.formula.calculation import BELOW_A_TURN, Calculation
from reportgen.machine import Crank, Dyad, Guide, Linkage
from reportgen.machine.analysis import Machine
from reportgen.machine.load_laws import FULL_TURN, Stroke, TableLaw
from reportgen.machine.loads import Applied, fixed

TURNS = 1
CHECKS = given_loads.FORCE_CHECKS


class Parameters(Driven, masses=(2, 3), loads=("force",)):
    """The crank, the direction of the guide, the speed; block and yoke have mass only if they are given one."""

    r: Length
    guide: Angle = Given(0.0, 0.0, "deg", "0 deg")
    force: given_loads.WorkingForce | None = None


def machine(assignment: Assignment) -> Machine:
    """Return the Scotch yoke of an assignment: linkage, force on the yoke, closed formulas."""
    given: Parameters = assignment.parameters
    positions, turn = assignment.positions, assignment.positions.sign
    q = GivenData(given)
    r = q.datum("l.OA", given.r)
    if given.guide.si:
        q.datum("guide.angle", given.guide, "α", "angle")
    q.speed()
    q.drawn("O", "A", assignment.drawing.crank)
    if isinstance(given.force, given_loads.ConstantForce):
        q.datum("P.given", given.force.F, "P", "force")
    q.gravity()
    for link in (2, 3):
        q.mass(link)
    q.set_out("loads", "s.3", "P3")

    axis, radius = given.guide.si, q.si(r)
    along = cmath.rect(1.0, axis)
    start = 0.0 if positions.first is None else turn * (positions.first.si - axis)
    linkage = Linkage(
        ground={"O": 0j},
        driver=Crank("O", "A", radius),
        groups=(Dyad("RPP", (2, 3), "A", "B", Guide(0j, axis), slide_angle=math.pi / 2),),
        inertias=q.inertias({2: "A", 3: "B"}),
        gravity=-1j * given.gravity,
    )
    phase = (start + BELOW_A_TURN) % FULL_TURN - BELOW_A_TURN
    course = Stroke(
        link=3,
        rod=2,
        pin="B",
        crank_pin="A",
        top=radius * along,
        bottom=-radius * along,
        top_angle=0.0,
        bottom_angle=math.pi,
        phase=phase,
    )
    force = given.force

    def formulas(q: Calculation) -> None:
        line, ω1 = natural_lines(q, "l.OA"), q["omega.1"]
        φ = q.angle("phi.3", start + cycle_angles(positions), "φ")
        s_B = line("f.x.B", r * cos(φ), Symbol("s", "B"))
        v_B, v_r = line("f.v.B", -ω1 * r * sin(φ)), line("f.v.r", ω1 * r * cos(φ))
        a_B = line("f.a.B", accelerated(q, turn, -(ω1**2) * r * cos(φ), v_B))
        a_r = line("f.a.r", accelerated(q, turn, -(ω1**2) * r * sin(φ), v_r), Symbol("a", "r"))
        q.set_out("velocity", s_B, v_B, v_r)
        q.set_out("acceleration", a_B, a_r)

    return driven(
        assignment,
        q,
        linkage,
        axis + turn * start,
        formulas=formulas,
        applied=()
        if force is None
        else (Applied("P3", 3, "B", fixed(along), TableLaw(course, force.table, turns=TURNS)),),
        sliders=(course,),
        compared=(("v.B", "f.v.B"), ("v.A3A", "f.v.r"), ("a.B", "f.a.B"), ("a.A3A.r", "f.a.r")),
        equations=equations(given.acceleration),
        facts={"stroke": given_loads.stroke_of(force)},
    )


def equations(accelerates: float) -> dict[str, tuple[Chain, ...]]:
    """Return the displacements of the yoke and of the block in its slot, and their rates.

    `accelerates` (any unit) is 0 for a crank at constant speed.
    """
    r, φ, ω1, ε1 = Symbol("l", "OA"), Symbol("φ"), Symbol("ω", "1"), accelerating(accelerates)
    return {
        "closure": (Chain((Symbol("s", "B"), r * cos(φ))), Chain((Symbol("s", "A"), r * sin(φ)))),
        "velocity": (Chain((Symbol("v", "B"), -ω1 * r * sin(φ))), Chain((Symbol("v", "r"), ω1 * r * cos(φ)))),
        "acceleration": (
            Chain((Symbol("a", "B"), plus(-(ω1**2) * r * cos(φ), minus(times(ε1, r, sin(φ)))))),
            Chain((Symbol("a", "r"), plus(-(ω1**2) * r * sin(φ), times(ε1, r, cos(φ))))),
        ),
    }
