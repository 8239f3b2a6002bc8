"""The parallel twin-cylinder four-stroke engine: two pistons on one line of cylinders, pins on one crank.

Ground 0, crank 1, rods 2 (AB) and 4 (CD), pistons 3 (at B) and 5 (at D).
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator
from typing import Annotated

from pydantic import Field

from reportgen.assignment.common import Assignment, Draft, Positions
from reportgen.assignment.fields import Angle, Length, RodRatio, Share
from reportgen.base.errors import Finding
from reportgen.base.units import Given
from reportgen.catalogue import given_loads
from reportgen.catalogue.crank_sliders import centred_slider, compared
from reportgen.catalogue.driven_machine import KindSections, driven
from reportgen.catalogue.given_data import GivenData, cycle_angles
from reportgen.catalogue.parameters import Driven
from reportgen.formula import PI, ids
from reportgen.formula.calculation import Calculation
from reportgen.machine import Crank, Dyad, Guide, Linkage, LinkPoint
from reportgen.machine.analysis import Machine
from reportgen.machine.gas_pressure import STROKES, Stroke, stroke_at
from reportgen.machine.loads import Piston, gas_forces

TURNS = 2

UP = math.pi / 2
"""The direction of the cylinders; the crank's angle at which piston 3 is at its top dead centre."""
CRANK_DRAWN = 0.05
"""Default of the drawn length of the crank (m on paper)."""


class Parameters(Driven, masses=(2, 3, 4, 5), required=(2, 3), moments=(2, 4)):
    """The stroke, the ratio λ = R/L, the cylinder, the speed, and masses; link 4 equals 2, and 5 equals 3, unless
    given.
    """

    H: Length
    lambda_: RodRatio = Field(alias="lambda")
    D: Length
    s: Share
    crank_angle: Angle = Given(math.pi, 180.0, "deg", "180 deg")


Firing = Annotated[tuple[Stroke, ...], Field(min_length=2, max_length=2)] | None


class IndicatorByStroke(given_loads.ByStroke):
    """Rows over s/H of each piston."""

    firing: Firing = None


class IndicatorByCrankAngle(given_loads.ByCrankAngle):
    """Pressures over the cycle angle of piston 3, from the top dead centre at the start of intake."""

    firing: Firing = None


class IndicatorByOrdinates(given_loads.ByOrdinates):
    """Heights of a drawn diagram over the cycle angle of piston 3."""

    firing: Firing = None


Indicator = Annotated[IndicatorByStroke | IndicatorByCrankAngle | IndicatorByOrdinates, Field(discriminator="by")]


def possible_phases(crank_angle: float, positions: Positions) -> dict[tuple[Stroke, ...], tuple[float, float]]:
    """Return the strokes that pistons 3 and 5 may begin in position 1, the default first, with their cycle angles
    (rad).

    Each piston may be a whole turn further on in its cycle than the crank shows.
    """
    start = positions.sign * (positions.start_or(UP) - UP) % (2 * math.pi)
    possible: dict[tuple[Stroke, ...], tuple[float, float]] = {}
    for first in (start, start + 2 * math.pi):
        for second in (first + crank_angle, first + crank_angle + 2 * math.pi):
            pair = STROKES[int(stroke_at(first))], STROKES[int(stroke_at(second))]
            possible[pair] = first, second % (4 * math.pi)
    return possible


def _check_firing(draft: Draft) -> Iterator[Finding]:
    """Yield faults unless the firing pair is one that the crank allows."""
    parameters, indicator, positions = map(draft.sections.get, ("parameters", "indicator", "positions"))
    if parameters is None or positions is None or indicator is None or indicator.firing is None:
        return
    possible = possible_phases(parameters.crank_angle.si, positions)
    if indicator.firing not in possible:
        allowed = "; ".join(f"[{first}, {second}]" for first, second in possible)
        yield Finding("firing", ("indicator", "firing"), {"allowed": allowed})


CHECKS = (*given_loads.DIAGRAM_CHECKS, _check_firing)


def machine(assignment: Assignment) -> Machine:
    """Return the engine of an assignment: synthesis R = H/2, L = R/λ, linkage, gas, closed formulas."""
    given: Parameters = assignment.parameters
    positions, turn = assignment.positions, assignment.positions.sign
    q = GivenData(given)
    H, λ = q.datum("H", given.H), q.datum("lambda", given.lambda_)
    D, s = q.datum("D", given.D), q.datum("s", given.s)
    if given.gravity:
        q.datum("g", given.g)
    q.datum("crank.angle", given.crank_angle, "δ", "angle")
    q.speed()
    R = q.define("R", H / 2)
    L = q.define("L", R / λ)
    for id, length in {"O1A": R, "O1C": R, "AB": L, "CD": L, "AS2": s * L, "CS4": s * L}.items():
        q.define(ids.length(id), length)
    q.set_out("synthesis", R, *q.worked(λ), L, q["l.AS2"], q["l.CS4"])
    q.drawn("O1", "A", assignment.drawing.crank, CRANK_DRAWN)
    q.define("F", PI * D**2 / 4)
    for link in (2, 3, 4, 5):
        q.mass(link, like=link - 2)
    q.moment(2, q["m.2"] * L**2 / 12)
    q.moment(4, q["J.2"] if q.of_link("J", 2) else q["m.4"] * L**2 / 12)

    radius, rod, centre, guide = q.si(R), q.si(L), complex(q.si("l.AS2")), Guide(0j, UP)
    second_pin = radius * cmath.exp(1j * turn * given.crank_angle.si)
    linkage = Linkage(
        ground={"O1": 0j},
        driver=Crank("O1", "A", radius),
        groups=(Dyad("RRP", (2, 3), "A", "B", guide, (rod, 0.0)), Dyad("RRP", (4, 5), "C", "D", guide, (rod, 0.0))),
        points=(LinkPoint("C", 1, second_pin), LinkPoint("S2", 2, centre), LinkPoint("S4", 4, centre)),
        inertias=q.inertias({2: "S2", 3: "B", 4: "S4", 5: "D"}),
        gravity=-1j * given.gravity,
    )
    indicator, possible = assignment.indicator, possible_phases(given.crank_angle.si, positions)
    phases = next(iter(possible.values())) if indicator.firing is None else possible[indicator.firing]
    top, bottom = 1j * (rod + radius), 1j * (rod - radius)
    pistons = tuple(
        Piston(
            link=link,
            rod=link - 1,
            pin=pin,
            crank_pin=crank_pin,
            top=top,
            bottom=bottom,
            top_angle=0.0,
            bottom_angle=math.pi,
            phase=phase,
            bore=given.D.si,
            indicator=indicator.table,
        )
        for link, pin, crank_pin, phase in zip((3, 5), "BD", "AC", phases, strict=True)
    )
    steps = cycle_angles(positions, TURNS)

    def formulas(q: Calculation) -> None:
        centred_slider(q, turn, 2, 3, "B", angle=phases[0] + steps, along="l.AS2", centre="S2")
        centred_slider(q, turn, 4, 5, "D", angle=phases[1] + steps, along="l.CS4", centre="S4")

    plans = ("v.B", "omega.2", "v.S2", "a.B", "eps.2", "a.S2", "v.D", "omega.4", "v.S4", "a.D", "eps.4", "a.S4")
    return driven(
        assignment,
        q,
        linkage,
        positions.start_or(UP),
        KindSections(sizes="synthesis", load="cycle"),
        formulas=formulas,
        applied=gas_forces(pistons),
        sliders=pistons,
        positive={piston.pin: -1j for piston in pistons},
        essential=("foreword", "velocity-senses", "acceleration-senses"),
        paths=("S2", "S4"),
        compared=compared(plans),
    )
