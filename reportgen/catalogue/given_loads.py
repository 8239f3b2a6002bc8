"""Loads given in an assignment: an indicator diagram, a working force on a slider, a torque on a link."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from reportgen.assignment.checks import increasing, same_length
from reportgen.assignment.common import Part, Positions
from reportgen.assignment.fields import (
    CycleAngles,
    Force,
    ForceUnit,
    Fractions,
    Nodes,
    NodeValues,
    Pressure,
    PressureUnit,
    quantity,
)
from reportgen.base.units import Given
from reportgen.catalogue.declared_loads import against
from reportgen.formula import ids
from reportgen.machine import Linkage
from reportgen.machine.gas_pressure import STROKES, AngleIndicator, IndicatorTable, StrokeIndicator
from reportgen.machine.load_laws import ConstantLaw, Law, by_angle, by_stroke
from reportgen.machine.loads import Torque, crank_motion

# --- the indicator diagram of a four-stroke engine --------------------------------------------------


class _Diagram(Part):
    """Keys common to all forms of an indicator diagram."""

    reference: Literal["gauge", "absolute"] = "gauge"
    ambient: Pressure = Given(101325.0, 10.1325, "N/cm2", "10.1325 N/cm2")

    def gauge(self, row: tuple[float, ...], unit: Given) -> tuple[float, ...]:
        """Return values of the table as gauge pressures (Pa); `unit` is the value of 1."""
        below = self.ambient.si if self.reference == "absolute" else 0.0
        return tuple(value * unit.si - below for value in row)


class ByStroke(_Diagram):
    """A row of pressures for each stroke, over s/H of the piston."""

    unit: PressureUnit
    by: Literal["stroke"]
    s: Fractions
    intake: NodeValues
    compression: NodeValues
    expansion: NodeValues
    exhaust: NodeValues

    @property
    def table(self) -> StrokeIndicator:
        """The diagram in gauge pressures (Pa)."""
        return StrokeIndicator(self.s, *(self.gauge(getattr(self, row), self.unit) for row in STROKES))


class ByCrankAngle(_Diagram):
    """Pressures over the cycle angle, from the top dead centre at the start of intake."""

    unit: PressureUnit
    by: Literal["crank_angle"]
    angle: CycleAngles
    p: NodeValues

    @property
    def table(self) -> AngleIndicator:
        """The diagram in gauge pressures (Pa)."""
        return AngleIndicator(tuple(angle.si for angle in self.angle), self.gauge(self.p, self.unit))


class ByOrdinates(_Diagram):
    """Heights (mm) measured on a drawn diagram over the cycle angle, and the pressure of one millimetre."""

    by: Literal["ordinates"]
    scale: Pressure
    angle: CycleAngles
    height: NodeValues

    @property
    def table(self) -> AngleIndicator:
        """The diagram in gauge pressures (Pa)."""
        return AngleIndicator(tuple(angle.si for angle in self.angle), self.gauge(self.height, self.scale))


Diagram = Annotated[ByStroke | ByCrankAngle | ByOrdinates, Field(discriminator="by")]

DIAGRAM_CHECKS = (
    same_length("indicator", "s", STROKES),
    same_length("indicator", "angle", ("p", "height")),
    increasing("indicator", "s", 0, 1),
    increasing("indicator", "angle", 0, 720, "deg"),
)


# --- a working force on a slider ---------------------------------------------------------------------

TurnAngles = Annotated[tuple[Annotated[Given, quantity("deg", least=0, most=360)], ...], Nodes]


class ConstantForce(Part):
    """One force over the whole turn, or on one stroke only."""

    by: Literal["constant"]
    F: Force
    stroke: Literal["both", "inward", "outward"] = "both"

    @property
    def table(self) -> IndicatorTable:
        """Forces (N) over the stroke."""
        both = (self.F.si, self.F.si)
        inward, outward = ((0.0, 0.0) if self.stroke == other else both for other in ("outward", "inward"))
        return by_stroke((0.0, 1.0), inward, outward)


class ForceOverStroke(Part):
    """A row of forces for the stroke towards the crank and one for the stroke back, over s/H from the outer end."""

    by: Literal["stroke"]
    unit: ForceUnit
    s: Fractions
    inward: NodeValues
    outward: NodeValues

    @property
    def table(self) -> IndicatorTable:
        """Forces (N) over the stroke."""
        inward, outward = (tuple(f * self.unit.si for f in row) for row in (self.inward, self.outward))
        return by_stroke(self.s, inward, outward)


class ForceOverAngle(Part):
    """Forces over the crank's turn from the outer dead centre."""

    by: Literal["crank_angle"]
    unit: ForceUnit
    angle: TurnAngles
    F: NodeValues

    @property
    def table(self) -> IndicatorTable:
        """Forces (N) over the turn."""
        return by_angle(tuple(angle.si for angle in self.angle), tuple(f * self.unit.si for f in self.F))


class PressingForce(Part):
    """Force that resists a slider on its way down, over s/H from its upper end; zero on the way up."""

    unit: ForceUnit
    s: Fractions
    P: NodeValues

    @property
    def table(self) -> IndicatorTable:
        """Forces (N) over the stroke."""
        down = tuple(force * self.unit.si for force in self.P)
        return by_stroke(self.s, down, tuple(0.0 for _ in down))


def stroke_of(force: ConstantForce | ForceOverStroke | ForceOverAngle | None) -> str:
    """Return the stroke on which a working force acts; "both" unless it says otherwise."""
    return force.stroke if isinstance(force, ConstantForce) else "both"


WorkingForce = Annotated[ConstantForce | ForceOverStroke | ForceOverAngle, Field(discriminator="by")]


FORCE_CHECKS = (
    same_length("parameters.force", "s", ("inward", "outward")),
    same_length("parameters.force", "angle", ("F",)),
    increasing("parameters.force", "s", 0, 1),
    increasing("parameters.force", "angle", 0, 360, "deg"),
)
PRESS_CHECKS = (same_length("parameters.press", "s", ("P",)), increasing("parameters.press", "s", 0, 1))


# --- a torque on a link ------------------------------------------------------------------------------

TorqueSize = Annotated[Given, quantity("N m", least=0, most=1e9, tiny=1e-6)]


class LinkTorque(Part):
    """A torque on a link, with a fixed sense or opposed to its motion."""

    M: TorqueSize
    sense: Literal["opposing", "anticlockwise", "clockwise"] = "opposing"


def torque_on(
    given: LinkTorque | None, link: int, linkage: Linkage, positions: Positions, start: float
) -> tuple[Torque, ...]:
    """Return the torque on a link of a linkage whose crank is at the angle `start` (rad) in position 1."""
    if given is None:
        return ()
    size, motion_at = given.M.si, crank_motion(linkage, positions, start)
    if given.sense == "opposing":
        law: Law = against(size, lambda motion: motion.links[link].omega, motion_at, through=not positions.at)
    else:
        law = ConstantLaw(size if given.sense == "anticlockwise" else -size)
    return (Torque(ids.applied_torque(link), link, law),)
