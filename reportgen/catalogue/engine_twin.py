"""The parallel twin-cylinder four-stroke engine: two pistons on one line of cylinders, pins on one crank.

Ground 0, crank 1, rods 2 (AB) and 4 (CD), pistons 3 (at B) and 5 (at D).
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator
from typing import Annotated

import numpy as np
from pydantic import Field

from reportgen.assignment import checks
from reportgen.assignment.common import Assignment, Draft, Positions
from reportgen.assignment.faults import Finding
from reportgen.assignment.fields import (
    Angle,
    Length,
    Mass,
    MomentOfInertia,
    RodRatio,
    Share,
    Weight,
)
from reportgen.catalogue import crank_slider, gas
from reportgen.catalogue.driven import Driven, outline, rate_items
from reportgen.catalogue.machine import Item, Machine, Piston, gas_forces, ratio_item
from reportgen.cycle.applied import STROKES, Stroke, stroke_at
from reportgen.mechanism.structure import Crank, Dyad, Guide, Inertia, Linkage, LinkPoint
from reportgen.notation.expressions import PI, Ref, Symbol, divide, multiply, power
from reportgen.units import Given

KIND = "engine-twin"
TITLES = {
    "vi": "Động cơ đốt trong song hành",
    "en": "Parallel twin-cylinder combustion engine",
}
TURNS = 2

TOP_OF_PISTON_3 = math.pi / 2
"""Crank angle (from +x) at which piston 3, above the crank, is at its top dead centre."""


class Parameters(Driven):
    """What the machine is given by: the stroke, the ratio λ = R/L, its speed, and what moves."""

    H: Length
    lambda_: RodRatio = Field(alias="lambda")
    D: Length
    s: Share
    G2: Weight | None = None
    G3: Weight | None = None
    G4: Weight | None = None
    G5: Weight | None = None
    m2: Mass | None = None
    m3: Mass | None = None
    m4: Mass | None = None
    m5: Mass | None = None
    J2: MomentOfInertia | None = None
    J4: MomentOfInertia | None = None
    crank_angle: Angle = Given(math.pi, 180.0, "deg", "180 deg")

    @property
    def rod_length(self) -> float:
        """L = R/λ = H/(2λ) (m)."""
        return self.H.si / (2 * self.lambda_.si)

    def mass(self, link: int) -> float:
        """m = G/g (kg) of link 2…5; rod 4 and piston 5 default to rod 2 and piston 3."""
        weight: Given | None = getattr(self, f"G{link}")
        mass: Given | None = getattr(self, f"m{link}")
        if weight is not None:
            return weight.si / self.g.si
        return mass.si if mass is not None else self.mass(link - 2)

    def moment(self, rod: int) -> float:
        """J about the mass centre (kg·m²) of rod 2 or 4: as given, that of rod 2, else m L²/12."""
        given = (self.J2,) if rod == 2 else (self.J4, self.J2)
        typed = next((moment.si for moment in given if moment is not None), None)
        return self.mass(rod) * self.rod_length**2 / 12 if typed is None else typed


Firing = Annotated[tuple[Stroke, ...], Field(min_length=2, max_length=2)] | None


class IndicatorByStroke(gas.ByStroke):
    """Rows over s/H of each piston."""

    firing: Firing = None


class IndicatorByCrankAngle(gas.ByCrankAngle):
    """Pressures over the cycle angle of piston 3, from the top dead centre at the start of intake."""

    firing: Firing = None


class IndicatorByOrdinates(gas.ByOrdinates):
    """Heights of a drawn diagram over the cycle angle of piston 3."""

    firing: Firing = None


Indicator = Annotated[
    IndicatorByStroke | IndicatorByCrankAngle | IndicatorByOrdinates, Field(discriminator="by")
]


def phases(parameters: Parameters, indicator: Indicator, positions: Positions) -> tuple[float, float]:
    """Cycle angles (rad) of pistons 3 and 5 at position 1; `KeyError` for an impossible firing pair."""
    possible = _possible_phases(parameters.crank_angle.si, positions)
    return next(iter(possible.values())) if indicator.firing is None else possible[indicator.firing]


def _possible_phases(
    crank_angle: float, positions: Positions
) -> dict[tuple[Stroke, ...], tuple[float, float]]:
    """Strokes in which pistons 3 and 5 may leave position 1, the default first, and their cycle angles there.

    Each piston may be a whole turn further on in its cycle than the crank shows.
    """
    start = 0.0
    if positions.start is not None:
        start = positions.sign * (positions.start.si - TOP_OF_PISTON_3) % (2 * math.pi)
    possible: dict[tuple[Stroke, ...], tuple[float, float]] = {}
    for first in (start, start + 2 * math.pi):
        for second in (first + crank_angle, first + crank_angle + 2 * math.pi):
            pair = STROKES[int(stroke_at(first))], STROKES[int(stroke_at(second))]
            possible[pair] = first, second % (4 * math.pi)
    return possible


def _check_firing(draft: Draft) -> Iterator[Finding]:
    """The firing pair is one that the crank allows."""
    parameters, indicator, positions = (
        draft.sections.get(name) for name in ("parameters", "indicator", "positions")
    )
    if parameters is None or positions is None or indicator is None or indicator.firing is None:
        return
    possible = _possible_phases(parameters.crank_angle.si, positions)
    if indicator.firing not in possible:
        allowed = "; ".join(f"[{first}, {second}]" for first, second in possible)
        yield Finding("firing", ("indicator", "firing"), {"allowed": allowed})


CHECKS = (
    checks.one_of("parameters", "n", "omega1"),
    checks.one_of("parameters", "G2", "m2"),
    checks.one_of("parameters", "G3", "m3"),
    checks.one_of("parameters", "G4", "m4", required=False),
    checks.one_of("parameters", "G5", "m5", required=False),
    *gas.CHECKS,
    _check_firing,
)


# --- the machine ----------------------------------------------------------------------------------

CRANK_DRAWN = 0.05
"""Drawn length of the crank (m on paper) when none is asked for."""


def machine(assignment: Assignment) -> Machine:
    """The engine of an assignment: linkage, gas, quantities of its own and the report's outline."""
    given: Parameters = assignment.parameters
    positions = assignment.positions
    radius, rod, turn = given.H.si / 2, given.rod_length, positions.sign
    along = given.s.si * rod
    up = TOP_OF_PISTON_3
    second_pin = radius * cmath.exp(1j * turn * given.crank_angle.si)
    linkage = Linkage(
        ground={"O1": 0j},
        driver=Crank("O1", "A", radius),
        dyads=(
            Dyad("RRP", (2, 3), "A", "B", Guide(0j, up), (rod, 0.0)),
            Dyad("RRP", (4, 5), "C", "D", Guide(0j, up), (rod, 0.0)),
        ),
        points=(
            LinkPoint("C", 1, second_pin),
            LinkPoint("S2", 2, along + 0j),
            LinkPoint("S4", 4, along + 0j),
        ),
        inertias=(
            Inertia(2, "S2", given.mass(2), given.moment(2)),
            Inertia(3, "B", given.mass(3)),
            Inertia(4, "S4", given.mass(4), given.moment(4)),
            Inertia(5, "D", given.mass(5)),
        ),
        gravity=-1j * given.g.si,
    )
    table = assignment.indicator.table
    both = phases(given, assignment.indicator, positions)
    pistons = tuple(
        Piston(
            link,
            link - 1,
            pin,
            crank_pin,
            top=1j * (rod + radius),
            bottom=1j * (rod - radius),
            top_angle=0.0,
            bottom_angle=math.pi,
            phase=phase,
            bore=given.D.si,
            indicator=table,
        )
        for link, pin, crank_pin, phase in zip((3, 5), "BD", "AC", both, strict=True)
    )
    steps = np.arange(positions.count * TURNS) * (2 * math.pi / positions.count)
    formulas = tuple(
        item
        for piston in pistons
        for item in crank_slider.formulas(
            piston.rod,
            piston.link,
            piston.crank_pin,
            piston.pin,
            f"S{piston.rod}",
            np.mod(piston.phase + steps + 1e-12, 2 * math.pi) - 1e-12,
        )
    )
    return Machine(
        kind=KIND,
        linkage=linkage,
        start=up if positions.start is None else positions.start.si,
        turn=turn,
        speed=given.speed,
        count=positions.count,
        turns=TURNS,
        given=_items(given, assignment.drawing.crank),
        formulas=formulas,
        outline=outline(True, True, given.flywheel, sizes="synthesis", load="cycle"),
        unevenness=given.unevenness,
        pistons=pistons,
        applied=gas_forces(pistons),
        sliders=pistons,
        paths=("S2", "S4"),
        compared=crank_slider.compared(pistons),
    )


def _items(given: Parameters, crank: Given | None) -> tuple[Item, ...]:
    """Given data and the synthesis R = H/2, L = R/λ, mass centres, masses and moments of inertia."""
    items = [
        Item("H", Symbol("H"), "length", given.H.si),
        ratio_item("lambda", Symbol("λ"), given.lambda_),
        Item("D", Symbol("D"), "diameter", given.D.si),
        Item("s", Symbol("s"), "ratio", given.s.si),
        Item("g", Symbol("g"), "gravity", given.g.si),
        Item("crank.angle", Symbol("δ"), "angle", given.crank_angle.si),
        *rate_items(given),
        Item("R", Symbol("R"), "length", definition=divide("H", 2)),
        Item("L", Symbol("L"), "length", definition=divide("R", "lambda")),
        *(Item(f"l.{arm}", Symbol("l", arm), "length", definition=Ref("R")) for arm in ("O1A", "O1C")),
        *(Item(f"l.{rod}", Symbol("l", rod), "length", definition=Ref("L")) for rod in ("AB", "CD")),
        *(
            Item(f"l.{arm}", Symbol("l", arm), "length", definition=multiply("s", "L"))
            for arm in ("AS2", "CS4")
        ),
        Item("drawn.O1A", Symbol("O₁A", over="segment"), "segment", crank.si if crank else CRANK_DRAWN),
        Item("F", Symbol("F"), "area", definition=divide(multiply(PI, power("D", 2)), 4)),
    ]
    for link in (2, 3, 4, 5):
        items += _mass_items(given, link)
    for rod in (2, 4):
        symbol, typed = Symbol("J", f"S{rod}"), getattr(given, f"J{rod}")
        if typed is not None:
            items.append(Item(f"J.{rod}", symbol, "moment of inertia", typed.si))
        elif rod == 4 and given.J2 is not None:
            items.append(Item("J.4", symbol, "moment of inertia", definition=Ref("J.2")))
        else:
            by_length = divide(multiply(f"m.{rod}", power("L", 2)), 12)
            items.append(Item(f"J.{rod}", symbol, "moment of inertia", definition=by_length))
    return tuple(items)


def _mass_items(given: Parameters, link: int) -> tuple[Item, ...]:
    """Weight and mass of a link: one as typed, or as that of the other cylinder, the other from it."""
    weight, mass = getattr(given, f"G{link}"), getattr(given, f"m{link}")
    if weight is None and mass is None:
        twin = link - 2
        by_weight = getattr(given, f"G{twin}") is not None
        first = (
            Item(f"G{link}", Symbol("G", str(link)), "weight", definition=Ref(f"G{twin}"))
            if by_weight
            else Item(f"m.{link}", Symbol("m", str(link)), "mass", definition=Ref(f"m.{twin}"))
        )
    elif weight is not None:
        by_weight, first = True, Item(f"G{link}", Symbol("G", str(link)), "weight", weight.si)
    else:
        by_weight, first = False, Item(f"m.{link}", Symbol("m", str(link)), "mass", mass.si)
    if by_weight:
        return first, Item(f"m.{link}", Symbol("m", str(link)), "mass", definition=divide(f"G{link}", "g"))
    return first, Item(f"G{link}", Symbol("G", str(link)), "weight", definition=multiply(f"m.{link}", "g"))
