"""A working force on a slider as an assignment gives it: constant, by the stroke, or by the crank angle."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Annotated, Literal

from pydantic import Field

from reportgen.assignment import checks
from reportgen.assignment.common import Check, Draft, Part
from reportgen.assignment.faults import Finding
from reportgen.assignment.fields import Decimal, Fraction, Interval, UnitOf, quantity
from reportgen.catalogue.laws import by_angle, by_stroke
from reportgen.cycle.applied import Indicator
from reportgen.units import Given

MOST_NODES = 2000
Force = Annotated[Given, quantity("N", least=-1e9, most=1e9)]
ForceUnit = Annotated[Given, UnitOf("N")]
ForceValue = Annotated[float, Decimal(Interval(least=-1e9, most=1e9))]
Row = Annotated[tuple[ForceValue, ...], Field(min_length=2, max_length=MOST_NODES)]
Fractions = Annotated[tuple[Fraction, ...], Field(min_length=2, max_length=MOST_NODES)]
TurnAngle = Annotated[Given, quantity("deg", least=0, most=360)]
TurnAngles = Annotated[tuple[TurnAngle, ...], Field(min_length=2, max_length=MOST_NODES)]


class Constant(Part):
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
    inward: Row
    outward: Row

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
    F: Row

    @property
    def table(self) -> Indicator:
        """Forces (N) over the turn."""
        return by_angle(tuple(angle.si for angle in self.angle), tuple(f * self.unit.si for f in self.F))


WorkingForce = Annotated[Constant | OverStroke | OverAngle, Field(discriminator="by")]


def _inside(check: Check) -> Check:
    """The check of a section, for the section `force` of the parameters."""

    def nested(draft: Draft) -> Iterator[Finding]:
        parameters = draft.raw.get("parameters")
        content = parameters.get("force") if isinstance(parameters, dict) else None
        for finding in check(Draft({"force": content}, {})):
            yield replace(finding, where=("parameters", *finding.where))

    return nested


CHECKS = tuple(
    map(
        _inside,
        (
            checks.same_length("force", "s", ("inward", "outward")),
            checks.same_length("force", "angle", ("F",)),
            checks.increasing("force", "s", 0, 1),
            checks.increasing("force", "angle", 0, 360, "deg"),
        ),
    )
)
