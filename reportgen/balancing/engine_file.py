"""Model of the file of an engine without a mechanism: crank, rod, moving masses, arrangement of the cylinders."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from reportgen.assignment.common import Part
from reportgen.assignment.fields import Angle, Coordinate, Length, RotationalSpeed, Share
from reportgen.balancing.rotor_file import AT_ORIGIN, PositiveMass
from reportgen.base.template_access import template_members
from reportgen.base.units import Given

MOST_CYLINDERS = 12
UPRIGHT = Given(0.0, 0.0, "deg", "0 deg")


class CylinderPlace(Part):
    """The angles of a cylinder's crank and bank from the axis x, and its place along the crankshaft."""

    crank: Angle
    at: Coordinate = AT_ORIGIN
    bank: Angle = UPRIGHT


@template_members("m2", "n")
class Parameters(Part):
    """An engine by its orders."""

    r: Length
    l: Length  # noqa: E741
    n: RotationalSpeed
    m3: PositiveMass
    m2: PositiveMass | None = None
    s: Share | None = None
    cylinders: Annotated[tuple[CylinderPlace, ...], Field(min_length=1, max_length=MOST_CYLINDERS)]

    @property
    def is_inline(self) -> bool:
        """True if all cylinders are in one plane with the crankshaft, on one side of it."""
        return all(one.bank.si == self.cylinders[0].bank.si for one in self.cylinders)

    @property
    def has_length(self) -> bool:
        """True if the cylinders are at several places along the crankshaft."""
        return any(one.at.si != self.cylinders[0].at.si for one in self.cylinders)
