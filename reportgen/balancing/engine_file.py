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


OWN = ("m1", "m2", "m3", "r")
"""Keys that a cylinder may have itself in place of those of all cylinders."""


class CylinderPlace(Part):
    """The angles of a cylinder's crank and bank from the axis x, its place along the crankshaft, and its own masses."""

    crank: Angle
    at: Coordinate = AT_ORIGIN
    bank: Angle = UPRIGHT
    m1: PositiveMass | None = None
    m2: PositiveMass | None = None
    m3: PositiveMass | None = None
    r: Length | None = None


@template_members("m1", "m2", "n")
class Parameters(Part):
    """An engine by its orders."""

    r: Length
    l: Length  # noqa: E741
    n: RotationalSpeed
    m3: PositiveMass
    m2: PositiveMass | None = None
    m1: PositiveMass | None = None
    s: Share | None = None
    cylinders: Annotated[tuple[CylinderPlace, ...], Field(min_length=1, max_length=MOST_CYLINDERS)]

    @property
    def is_inline(self) -> bool:
        """True if all cylinders are in one plane with the crankshaft, on one side of it."""
        return all(one.bank.si == self.cylinders[0].bank.si for one in self.cylinders)

    @property
    def own_data(self) -> tuple[str, ...]:
        """The keys that some cylinder has itself."""
        return tuple(key for key in OWN if any(getattr(one, key) is not None for one in self.cylinders))

    @property
    def rotates(self) -> bool:
        """True if a mass turns with a crank: of the crank itself, or of a rod at the crank pin."""
        everything = (self, *self.cylinders)
        return any(getattr(one, key) is not None for one in everything for key in ("m1", "m2"))

    def of_cylinder(self, place: str, key: str) -> float:
        """Return a mass (kg) or the radius (m) of a cylinder, its own or that of all; 0 for a mass that is missing."""
        own: Given | None = getattr(self.cylinders[int(place) - 1], key) or getattr(self, key)
        return 0.0 if own is None else own.si

    @property
    def radius(self) -> float:
        """The greatest radius of a crank (m)."""
        return max(self.of_cylinder(str(number), "r") for number in range(1, len(self.cylinders) + 1))

    @property
    def has_length(self) -> bool:
        """True if the cylinders are at several places along the crankshaft."""
        return any(one.at.si != self.cylinders[0].at.si for one in self.cylinders)
