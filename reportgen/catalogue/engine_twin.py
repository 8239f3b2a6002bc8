"""The parallel twin-cylinder four-stroke engine: two pistons on one line of cylinders, pins on one crank.

Ground 0, crank 1, rods 2 (AB) and 4 (CD), pistons 3 (at B) and 5 (at D).
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Annotated, Literal

from pydantic import Field

from reportgen.assignment import checks
from reportgen.assignment.common import Draft, Part, Positions
from reportgen.assignment.faults import Finding
from reportgen.assignment.fields import (
    Acceleration,
    Angle,
    AngularVelocity,
    CycleAngle,
    Fraction,
    Length,
    Mass,
    MomentOfInertia,
    Pressure,
    PressureUnit,
    PressureValue,
    RodRatio,
    RotationalSpeed,
    Share,
    Weight,
)
from reportgen.cycle.indicator import STROKES, Stroke, stroke_at
from reportgen.units import Given

KIND = "engine-twin"
TITLES = {
    "vi": "Động cơ đốt trong song hành: hai xi lanh thẳng hàng, bốn kỳ",
    "en": "Parallel twin-cylinder internal combustion engine, four strokes",
}
TURNS = 2

MOST_NODES = 2000
TOP_OF_PISTON_3 = math.pi / 2
"""Crank angle (from +x) at which piston 3, above the crank, is at its top dead centre."""

_Row = Annotated[tuple[PressureValue, ...], Field(min_length=2, max_length=MOST_NODES)]


class Parameters(Part):
    """What the machine is given by: the stroke, the ratio λ = R/L, its speed, and what moves."""

    H: Length
    lambda_: RodRatio = Field(alias="lambda")
    n: RotationalSpeed | None = None
    omega1: AngularVelocity | None = None
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
    g: Acceleration = Given(9.81, 9.81, "m/s2", "9.81 m/s2")

    @property
    def speed(self) -> float:
        """|ω1| (rad/s)."""
        given = self.n or self.omega1
        assert given is not None, "a file without speed is refused by `CHECKS`"
        return given.si

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


class _Indicator(Part):
    """What both forms of the indicator diagram say."""

    unit: PressureUnit
    reference: Literal["gauge", "absolute"] = "gauge"
    ambient: Pressure = Given(101325.0, 10.1325, "N/cm2", "10.1325 N/cm2")
    firing: tuple[Stroke, Stroke] | None = None

    def gauge(self, row: tuple[float, ...]) -> tuple[float, ...]:
        """Pressures of the table as gauge pressures (Pa)."""
        below = self.ambient.si if self.reference == "absolute" else 0.0
        return tuple(value * self.unit.si - below for value in row)


class IndicatorByStroke(_Indicator):
    """A row of pressures for each stroke, over s/H of the piston."""

    by: Literal["stroke"]
    s: Annotated[tuple[Fraction, ...], Field(min_length=2, max_length=MOST_NODES)]
    intake: _Row
    compression: _Row
    expansion: _Row
    exhaust: _Row


class IndicatorByCrankAngle(_Indicator):
    """Pressures over the cycle angle, from the top dead centre at the start of intake."""

    by: Literal["crank_angle"]
    angle: Annotated[tuple[CycleAngle, ...], Field(min_length=2, max_length=MOST_NODES)]
    p: _Row


Indicator = Annotated[IndicatorByStroke | IndicatorByCrankAngle, Field(discriminator="by")]


def phases(
    parameters: Parameters, indicator: IndicatorByStroke | IndicatorByCrankAngle, positions: Positions
) -> tuple[float, float]:
    """Cycle angles (rad) of pistons 3 and 5 at position 1; `KeyError` for an impossible firing pair."""
    possible = _possible_phases(parameters.crank_angle.si, positions)
    return next(iter(possible.values())) if indicator.firing is None else possible[indicator.firing]


def _possible_phases(
    crank_angle: float, positions: Positions
) -> dict[tuple[Stroke, Stroke], tuple[float, float]]:
    """Strokes in which pistons 3 and 5 may leave position 1, the default first, and their cycle angles there.

    Each piston may be a whole turn further on in its cycle than the crank shows.
    """
    start = 0.0
    if positions.start is not None:
        start = positions.sign * (positions.start.si - TOP_OF_PISTON_3) % (2 * math.pi)
    possible: dict[tuple[Stroke, Stroke], tuple[float, float]] = {}
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
    checks.same_length("indicator", "s", STROKES),
    checks.same_length("indicator", "angle", ("p",)),
    checks.increasing("indicator", "s", 0, 1),
    checks.increasing("indicator", "angle", 0, 720, "deg"),
    _check_firing,
)
