"""Loads as an assignment gives them: an indicator diagram, a working force on a slider, a torque on a link."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Iterator
from dataclasses import replace
from typing import Annotated, Literal

from pydantic import Field

from reportgen.assignment.common import Check, Draft, Part, Positions, increasing, same_length
from reportgen.assignment.fields import (
    CycleAngle,
    Decimal,
    Fraction,
    Interval,
    Pressure,
    PressureUnit,
    PressureValue,
    UnitOf,
    quantity,
)
from reportgen.catalogue.loads import Constant, Law, Torque, by_angle, by_stroke, crank_motion, opposing
from reportgen.cycle import STROKES, AngleIndicator, Indicator, StrokeIndicator
from reportgen.errors import Finding
from reportgen.mechanism.structure import Linkage
from reportgen.units import Given

MOST_NODES = 2000
Fractions = Annotated[tuple[Fraction, ...], Field(min_length=2, max_length=MOST_NODES)]

# --- the indicator diagram of a four-stroke engine --------------------------------------------------

Pressures = Annotated[tuple[PressureValue, ...], Field(min_length=2, max_length=MOST_NODES)]
CycleAngles = Annotated[tuple[CycleAngle, ...], Field(min_length=2, max_length=MOST_NODES)]


class _Diagram(Part):
    """What every form says."""

    reference: Literal["gauge", "absolute"] = "gauge"
    ambient: Pressure = Given(101325.0, 10.1325, "N/cm2", "10.1325 N/cm2")

    @property
    @abstractmethod
    def one(self) -> float:
        """What 1 in the table stands for (Pa)."""

    def gauge(self, row: tuple[float, ...]) -> tuple[float, ...]:
        """Values of the table as gauge pressures (Pa)."""
        below = self.ambient.si if self.reference == "absolute" else 0.0
        return tuple(value * self.one - below for value in row)


class _InUnit(_Diagram):
    """A table of pressures in one unit."""

    unit: PressureUnit

    @property
    def one(self) -> float:
        return self.unit.si


class ByStroke(_InUnit):
    """A row of pressures for each stroke, over s/H of the piston."""

    by: Literal["stroke"]
    s: Fractions
    intake: Pressures
    compression: Pressures
    expansion: Pressures
    exhaust: Pressures

    @property
    def table(self) -> StrokeIndicator:
        """The diagram in gauge pressures (Pa)."""
        return StrokeIndicator(self.s, *(self.gauge(getattr(self, row)) for row in STROKES))


class ByCrankAngle(_InUnit):
    """Pressures over the cycle angle, from the top dead centre at the start of intake."""

    by: Literal["crank_angle"]
    angle: CycleAngles
    p: Pressures

    @property
    def table(self) -> AngleIndicator:
        """The diagram in gauge pressures (Pa)."""
        return AngleIndicator(tuple(angle.si for angle in self.angle), self.gauge(self.p))


class ByOrdinates(_Diagram):
    """Heights (mm) measured on a drawn diagram over the cycle angle, and the pressure of one millimetre."""

    by: Literal["ordinates"]
    scale: Pressure
    angle: CycleAngles
    height: Pressures

    @property
    def one(self) -> float:
        return self.scale.si

    @property
    def table(self) -> AngleIndicator:
        """The diagram in gauge pressures (Pa)."""
        return AngleIndicator(tuple(angle.si for angle in self.angle), self.gauge(self.height))


Diagram = Annotated[ByStroke | ByCrankAngle | ByOrdinates, Field(discriminator="by")]

DIAGRAM_CHECKS = (
    same_length("indicator", "s", STROKES),
    same_length("indicator", "angle", ("p", "height")),
    increasing("indicator", "s", 0, 1),
    increasing("indicator", "angle", 0, 720, "deg"),
)


# --- a working force on a slider ---------------------------------------------------------------------

Force = Annotated[Given, quantity("N", least=-1e9, most=1e9, tiny=1e-6)]
ForceUnit = Annotated[Given, UnitOf("N")]
ForceValue = Annotated[float, Decimal(Interval(least=-1e9, most=1e9, tiny=1e-6))]
Forces = Annotated[tuple[ForceValue, ...], Field(min_length=2, max_length=MOST_NODES)]
TurnAngle = Annotated[Given, quantity("deg", least=0, most=360)]
TurnAngles = Annotated[tuple[TurnAngle, ...], Field(min_length=2, max_length=MOST_NODES)]


class ConstantForce(Part):
    """One force over the whole turn, or on one stroke only."""

    by: Literal["constant"]
    F: Force
    stroke: Literal["both", "inward", "outward"] = "both"

    @property
    def table(self) -> Indicator:
        """Forces (N) over the stroke."""
        both = (self.F.si, self.F.si)
        inward, outward = ((0.0, 0.0) if self.stroke == other else both for other in ("outward", "inward"))
        return by_stroke((0.0, 1.0), inward, outward)


class OverStroke(Part):
    """A row of forces for the way towards the crank and one for the way back, over s/H from the outer end."""

    by: Literal["stroke"]
    unit: ForceUnit
    s: Fractions
    inward: Forces
    outward: Forces

    @property
    def table(self) -> Indicator:
        """Forces (N) over the stroke."""
        inward, outward = (tuple(f * self.unit.si for f in row) for row in (self.inward, self.outward))
        return by_stroke(self.s, inward, outward)


class OverAngle(Part):
    """Forces over the crank's turn from the outer dead centre."""

    by: Literal["crank_angle"]
    unit: ForceUnit
    angle: TurnAngles
    F: Forces

    @property
    def table(self) -> Indicator:
        """Forces (N) over the turn."""
        return by_angle(tuple(angle.si for angle in self.angle), tuple(f * self.unit.si for f in self.F))


class PressingForce(Part):
    """What resists a slider on its way down, over s/H from its upper end; nothing on the way up."""

    unit: ForceUnit
    s: Fractions
    P: Forces

    @property
    def table(self) -> Indicator:
        """Forces (N) over the stroke."""
        down = tuple(force * self.unit.si for force in self.P)
        return by_stroke(self.s, down, tuple(0.0 for _ in down))


WorkingForce = Annotated[ConstantForce | OverStroke | OverAngle, Field(discriminator="by")]


def _inside(check: Check, section: str) -> Check:
    """The check of a section, for a section of the parameters."""

    def nested(draft: Draft) -> Iterator[Finding]:
        parameters = draft.raw.get("parameters")
        content = parameters.get(section) if isinstance(parameters, dict) else None
        for finding in check(Draft({section: content}, {})):
            yield replace(finding, where=("parameters", *finding.where))

    return nested


FORCE_CHECKS = tuple(
    _inside(check, "force")
    for check in (
        same_length("force", "s", ("inward", "outward")),
        same_length("force", "angle", ("F",)),
        increasing("force", "s", 0, 1),
        increasing("force", "angle", 0, 360, "deg"),
    )
)
PRESS_CHECKS = tuple(
    _inside(check, "press") for check in (same_length("press", "s", ("P",)), increasing("press", "s", 0, 1))
)


# --- a torque on a link ------------------------------------------------------------------------------

TorqueSize = Annotated[Given, quantity("N m", least=0, most=1e9, tiny=1e-6)]


class LinkTorque(Part):
    """A torque on a link, of one sense or against its motion."""

    M: TorqueSize
    sense: Literal["opposing", "anticlockwise", "clockwise"] = "opposing"


def torque_on(
    given: LinkTorque | None, link: int, linkage: Linkage, positions: Positions, start: float
) -> tuple[Torque, ...]:
    """The torque on a link of a crank's linkage whose crank stands at the angle `start` in position 1."""
    if given is None:
        return ()
    size, motion_at = given.M.si, crank_motion(linkage, positions, start)
    if given.sense == "opposing":
        law: Law = opposing(size, lambda angle: motion_at(angle).links[link].omega)
    else:
        law = Constant(size if given.sense == "anticlockwise" else -size)
    return (Torque(f"M{link}", link, law),)
