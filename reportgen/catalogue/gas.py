"""The indicator diagram of a four-stroke engine as an assignment gives it, in any of its forms."""

from __future__ import annotations

from abc import abstractmethod
from typing import Annotated, Literal

from pydantic import Field

from reportgen.assignment import checks
from reportgen.assignment.common import Part
from reportgen.assignment.fields import CycleAngle, Fraction, Pressure, PressureUnit, PressureValue
from reportgen.cycle.applied import STROKES, AngleIndicator, StrokeIndicator
from reportgen.units import Given

MOST_NODES = 2000
Row = Annotated[tuple[PressureValue, ...], Field(min_length=2, max_length=MOST_NODES)]
Fractions = Annotated[tuple[Fraction, ...], Field(min_length=2, max_length=MOST_NODES)]
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
    intake: Row
    compression: Row
    expansion: Row
    exhaust: Row

    @property
    def table(self) -> StrokeIndicator:
        """The diagram in gauge pressures (Pa)."""
        return StrokeIndicator(self.s, *(self.gauge(getattr(self, row)) for row in STROKES))


class ByCrankAngle(_InUnit):
    """Pressures over the cycle angle, from the top dead centre at the start of intake."""

    by: Literal["crank_angle"]
    angle: CycleAngles
    p: Row

    @property
    def table(self) -> AngleIndicator:
        """The diagram in gauge pressures (Pa)."""
        return AngleIndicator(tuple(angle.si for angle in self.angle), self.gauge(self.p))


class ByOrdinates(_Diagram):
    """Heights (mm) measured on a drawn diagram over the cycle angle, and the pressure of one millimetre."""

    by: Literal["ordinates"]
    scale: Pressure
    angle: CycleAngles
    height: Row

    @property
    def one(self) -> float:
        return self.scale.si

    @property
    def table(self) -> AngleIndicator:
        """The diagram in gauge pressures (Pa)."""
        return AngleIndicator(tuple(angle.si for angle in self.angle), self.gauge(self.height))


Diagram = Annotated[ByStroke | ByCrankAngle | ByOrdinates, Field(discriminator="by")]

CHECKS = (
    checks.same_length("indicator", "s", STROKES),
    checks.same_length("indicator", "angle", ("p", "height")),
    checks.increasing("indicator", "s", 0, 1),
    checks.increasing("indicator", "angle", 0, 720, "deg"),
)
