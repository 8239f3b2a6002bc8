"""Model of the file of a turning-moment exercise: torques over a cycle or the areas between them, the flywheel."""

from __future__ import annotations

from functools import cached_property
from typing import Annotated, Literal

from pydantic import Field

from reportgen.assignment.common import Part
from reportgen.assignment.fields import (
    CycleAngle,
    CycleAngles,
    Decimal,
    Interval,
    Length,
    NodeValues,
    Ratio,
    RotationalSpeed,
    UnitOf,
    quantity,
)
from reportgen.base.template_access import template_members
from reportgen.base.units import Given

MOST_TERMS, MOST_AREAS = 12, 40
MOST_NODES = 145
"""Largest number of rows of a table: every 5° of two turns."""

CurveTorque = Annotated[Given, quantity("N m", least=-1e9, most=1e9, tiny=1e-6)]
MeanTorque = Annotated[Given, quantity("N m", least=1e-6, most=1e9)]
TorqueUnit = Annotated[Given, UnitOf("N m")]
WorkUnit = Annotated[Given, UnitOf("J")]
DegreesOnPaper = Annotated[Given, quantity("deg", least=1e-3, most=90)]
Order = Annotated[float, Decimal(Interval(least=0.5, most=24))]
AreaOnPaper = Annotated[float, Decimal(Interval(least=-1e6, most=1e6))]
PositiveInertia = Annotated[Given, quantity("kg m2", least=1e-9, most=1e7)]
WheelMass = Annotated[Given, quantity("kg", least=1e-6, most=1e6)]
Fluctuation = Annotated[Given, Ratio(Interval(least=1e-4, most=0.5))]
NO_TORQUE = Given(0.0, 0.0, "N m", "0 N m")


class TorqueTerm(Part):
    """A harmonic of a torque: its order, and the factors of the sine and the cosine of that many crank angles."""

    order: Order
    sin: CurveTorque = NO_TORQUE
    cos: CurveTorque = NO_TORQUE


class Torques(Part):
    """A torque over the cycle: its mean with harmonics, or a table over the crank angle."""

    mean: MeanTorque | None = None
    terms: Annotated[tuple[TorqueTerm, ...], Field(min_length=1, max_length=MOST_TERMS)] | None = None
    phi: CycleAngles | None = None
    M: NodeValues | None = None
    unit: TorqueUnit | None = None

    @cached_property
    def nodes(self) -> tuple[tuple[float, float], ...]:
        """The rows of the table: crank angle (rad) and torque (N·m); () without a table."""
        if self.phi is None or self.M is None or self.unit is None:
            return ()
        return tuple((angle.si, value * self.unit.si) for angle, value in zip(self.phi, self.M, strict=True))

    @property
    def harmonics(self) -> tuple[TorqueTerm, ...]:
        return self.terms or ()


class ResistingTorques(Torques):
    """The torque of the driven machine, which may also be proportional to the speed."""

    law: Literal["constant", "speed"] | None = None

    @property
    def varies(self) -> bool:
        """True if it has a diagram of its own."""
        return bool(self.terms or self.phi)


class Areas(Part):
    """The areas between the diagram and its mean line in order: as works, or in mm² with both scales."""

    values: Annotated[tuple[AreaOnPaper, ...], Field(min_length=2, max_length=MOST_AREAS)]
    unit: WorkUnit | None = None
    torque: MeanTorque | None = None
    angle: DegreesOnPaper | None = None


@template_members("delta", "k", "m", "at", "driving", "resisting", "areas")
class Parameters(Part):
    """A machine whose flywheel is wanted, or whose flywheel is given."""

    driving: Torques | None = None
    resisting: ResistingTorques | None = None
    areas: Areas | None = None
    n: RotationalSpeed
    delta: Fluctuation | None = None
    J: PositiveInertia | None = None
    m: WheelMass | None = None
    k: Length | None = None
    at: CycleAngle | None = None

    @property
    def follows_speed(self) -> bool:
        """True if the resisting torque is proportional to the speed."""
        return self.resisting is not None and self.resisting.law == "speed"
