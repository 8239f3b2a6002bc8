"""The toggle press: a crank and a rod bend and stretch two links of one length, whose lower end presses.

Ground 0, crank 1 (OA), rod 2 (AB), links 3 (DB) and 4 (BC), slider 5 (at C) on the vertical through D, below it.  Axes
from O: x to the right, y upwards; φ are angles from x in the direction of rotation, s = DA, δ the angle at D between DA
and DB.  As BD = BC = l, B lies half way along DC: y_C = y_D ± 2l sin φ₃ (− clockwise), ω₄ = −ω₃, ε₄ = −ε₃.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Literal

from reportgen.assignment.checks import of_parameters
from reportgen.assignment.common import Assignment, Positions
from reportgen.assignment.fields import Length
from reportgen.base.errors import Finding
from reportgen.base.units import Given
from reportgen.catalogue import assembly_checks, given_loads
from reportgen.catalogue.driven_machine import driven
from reportgen.catalogue.given_data import GivenData, accelerated, cycle_angles, natural_lines
from reportgen.catalogue.parameters import Driven, FixedPoint
from reportgen.formula import Symbol, acos, atan2, cos, ids, signed, sin, sqrt
from reportgen.formula.calculation import Calculation
from reportgen.machine import Crank, Dyad, Guide, Linkage
from reportgen.machine.analysis import Machine
from reportgen.machine.load_laws import Stroke, TableLaw
from reportgen.machine.loads import Applied, course, crank_motion, fixed

TURNS = 1
BARS = {2: ("A", "B"), 3: ("D", "B"), 4: ("B", "C")}


class Parameters(Driven, masses=(2, 3, 4, 5), moments=(2, 3, 4), shares=(2, 3, 4), loads=("press",)):
    """Lengths, the fixed pivot D, the side of AD on which B lies, the speed; masses and the force if given."""

    OA: Length
    AB: Length
    BD: Length
    D: FixedPoint
    B: Literal["left", "right"] = "left"
    press: given_loads.PressingForce | None = None


def _calculation(given: Parameters, crank: Given | None = None) -> GivenData:
    """Return the given data, mass centres, masses and moments of inertia."""
    q = GivenData(given)
    for id, length in {"OA": given.OA, "AB": given.AB, "DB": given.BD, "BC": given.BD}.items():
        q.datum(ids.length(id), length, Symbol("l", "BD" if id == "DB" else id))
    q.point("D", given.D)
    q.speed()
    q.drawn("O", "A", crank)
    q.bodies(BARS, 5)
    q.set_out("loads", "s.5", "P5")
    return q


def _linkage(given: Parameters, q: GivenData) -> Linkage:
    pivot, link = complex(q.si("D.x"), q.si("D.y")), q.si("l.BC")
    return Linkage(
        ground={"O": 0j, "D": pivot},
        driver=Crank("O", "A", q.si("l.OA")),
        groups=(
            Dyad("RRR", (2, 3), "A", "B", "D", lengths=(q.si("l.AB"), link), sign=1 if given.B == "left" else -1),
            Dyad("RRP", (4, 5), "B", "C", Guide(pivot, math.pi / 2), lengths=(link, 0.0), sign=-1),
        ),
        points=q.centre_points({link: start for link, (start, _) in BARS.items()}),
        inertias=q.inertias({2: "S2", 3: "S3", 4: "S4", 5: "C"}),
        gravity=-1j * given.gravity,
    )


@of_parameters
def _check_turning(given: Parameters) -> Iterator[Finding]:
    """Yield faults unless the crank turns fully, without dead points, B stays below D, and the slider moves down and up
    once.
    """
    linkage = _linkage(given, _calculation(given))
    members = {
        (2, 3): assembly_checks.Member("AB, BD", ("parameters", "AB")),
        (4, 5): assembly_checks.Member("BC", ("parameters", "BD")),
    }
    motion_at = crank_motion(linkage, Positions(), 0.0)
    if obstacles := list(assembly_checks.findings(linkage, members)):
        yield from obstacles
    elif motion_at(cycle_angles(Positions())).points["B"].p.imag.max() > given.D.y.si:
        yield Finding("out-of-range", ("parameters", "D", "y"), {"text": given.D.y.text, "range": "y_D > y_B"})
    elif given.press is not None:
        yield from assembly_checks.to_and_fro(linkage, 5, motion_at, ("parameters", "press"))


CHECKS = (*given_loads.PRESS_CHECKS, _check_turning)


def machine(assignment: Assignment) -> Machine:
    """Return the toggle press of an assignment: linkage, pressing force, closed formulas."""
    given: Parameters = assignment.parameters
    positions, turn, press = assignment.positions, assignment.positions.sign, given.press
    q = _calculation(given, assignment.drawing.crank)
    linkage, start = _linkage(given, q), positions.start_or()
    q.construct("guide.5.at", q["p.D"])
    minus = (given.B == "left") == (turn > 0)
    sliders: tuple[Stroke, ...] = ()
    pressing: tuple[Applied, ...] = ()
    if press is not None:
        stroke = course(linkage, 5, crank_motion(linkage, positions, start))
        sliders, pressing = (stroke,), (Applied("P5", 5, "C", fixed(1j), TableLaw(stroke, press.table, turns=1)),)

    def formulas(q: Calculation) -> None:
        line, ω1 = natural_lines(q, "l.OA"), q["omega.1"]
        r, b, l, x_D, y_D = (q[id] for id in ("l.OA", "l.AB", "l.DB", "D.x", "D.y"))  # noqa: E741 - the length's own letter
        φ1 = q.angle("f.phi.1", turn * start + cycle_angles(positions))
        x = line("f.x.DA", r * cos(φ1) - x_D)
        y = line("f.y.DA", signed(turn, r * sin(φ1)) - y_D)
        turned = signed(turn, y)
        s = line("f.s", sqrt(x**2 + y**2), "s", "length")
        δ = acos((s**2 + l**2 - b**2) / (2 * s * l))
        φ3 = line("f.phi.3", atan2(turned, x) - δ if minus else atan2(turned, x) + δ)
        φ2 = line("f.phi.2", atan2(l * sin(φ3) - turned, l * cos(φ3) - x))
        line("f.y.C", y_D + signed(turn, 2 * l * sin(φ3)))
        ω2 = line("f.omega.2", signed(turn, ω1 * r * sin(φ1 - φ3) / (b * sin(φ3 - φ2))))
        ω3 = line("f.omega.3", signed(turn, ω1 * r * sin(φ1 - φ2) / (l * sin(φ3 - φ2))))
        v_C = line("f.v.C", 2 * l * ω3 * cos(φ3))
        top = ω1**2 * r * cos(φ1 - φ2) + ω2**2 * b - ω3**2 * l * cos(φ3 - φ2)
        numerator = line("f.q", top, "q", "acceleration")
        ε3 = line("f.eps.3", accelerated(q, turn, signed(turn, numerator / (l * sin(φ3 - φ2))), ω3))
        a_C = line("f.a.C", 2 * l * (ε3 * cos(φ3) + signed(-turn, ω3**2 * sin(φ3))))
        q.set_out("position", x, y, s, φ3, φ2)
        q.set_out("velocity", ω2, ω3, v_C)
        q.set_out("acceleration", numerator, ε3, a_C)

    return driven(
        assignment,
        q,
        linkage,
        start,
        formulas=formulas,
        applied=pressing,
        sliders=sliders,
        paths=("B",),
        facts={"form": "less" if minus else "plus", "B": given.B},
        compared=tuple((plan, ids.formula(plan)) for plan in ("omega.2", "omega.3", "v.C", "eps.3", "a.C")),
    )
