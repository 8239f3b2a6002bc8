"""Model of the file of a rotor: masses, correction planes, known data of the corrections, bearings."""

from __future__ import annotations

import math
from typing import Annotated, Any

from pydantic import Field

from reportgen.assignment.common import Part
from reportgen.assignment.fields import Angle, Coordinate, Length, Quantity, Reader, RotationalSpeed, quantity
from reportgen.base.template_access import template_members
from reportgen.base.units import Given

MOST_MASSES = 24
AT_ORIGIN = Given(0.0, 0.0, "mm", "0 mm")
LEFT, RIGHT = "A", "B"
"""The correction planes; a single plane is the first."""
BEARINGS = ("C", "D")

FIND = "find"


class SoughtQuantity(Reader):
    """A quantity, or `find` for one that balance determines, whose value is nan."""

    given: Quantity

    def read(self, value: object) -> Given:
        return Given(math.nan, math.nan, self.given.unit, FIND) if value == FIND else self.given.read(value)

    def schema(self) -> dict[str, Any]:
        return {"anyOf": [{"const": FIND}, self.given.schema()]}


PositiveMass = Annotated[Given, quantity("kg", least=1e-6, most=1e6)]
VibrationGrade = Annotated[Given, quantity("mm/s", least=0.01, most=1e5)]


SoughtMass = Annotated[Given, SoughtQuantity(quantity("kg", least=1e-6, most=1e6))]
SoughtPlace = Annotated[Given, SoughtQuantity(quantity("mm", above=-1e5, below=1e5, tiny=1e-4))]


class Planes(Part):
    """Places of the correction planes on the axis; without `B` there is one plane."""

    A: Coordinate
    B: SoughtPlace | None = None


class RotorMass(Part):
    """An unbalanced mass, or one that is sought, with its radius, angle and place on the axis."""

    m: SoughtMass
    r: Length
    angle: Angle
    z: Coordinate = AT_ORIGIN

    @property
    def is_sought(self) -> bool:
        return self.m.text == FIND


class KnownMass(Part):
    """The radius of a correction mass, or its mass."""

    r: Length | None = None
    m: PositiveMass | None = None


class KnownNearMass(KnownMass):
    """Known data of the correction mass in plane A; its angle only if the place of plane B is sought."""

    angle: Angle | None = None


class KnownCorrection(KnownMass):
    """Known data of the correction masses: the same in every plane, or separate for each."""

    A: KnownNearMass | None = None
    B: KnownMass | None = None


@template_members("correction", "bearings", "grade", "n")
class Parameters(Part):
    """A rotor that is to be balanced."""

    masses: Annotated[tuple[RotorMass, ...], Field(min_length=1, max_length=MOST_MASSES)]
    planes: Planes
    correction: KnownCorrection | None = None
    bearings: Annotated[tuple[Coordinate, ...], Field(min_length=2, max_length=2)] | None = None
    n: RotationalSpeed | None = None
    grade: VibrationGrade | None = None
    mass: PositiveMass | None = None

    @property
    def finds_plane(self) -> bool:
        """True if the place of plane B is sought."""
        return self.planes.B is not None and self.planes.B.text == FIND

    @property
    def sought_masses(self) -> dict[str, RotorMass]:
        """The masses that are sought, by their places."""
        return {str(number): one for number, one in enumerate(self.masses, 1) if one.is_sought}

    @property
    def planes_by_name(self) -> dict[str, Given]:
        """Places of the correction planes, from left to right."""
        far = {} if self.planes.B is None else {RIGHT: self.planes.B}
        return {LEFT: self.planes.A, **far}

    @property
    def known_masses(self) -> dict[str, KnownMass]:
        """Known data of the correction mass in each plane; empty if no correction masses are requested."""
        if self.correction is None:
            return {}
        own = {LEFT: self.correction.A, RIGHT: self.correction.B}
        return {plane: own[plane] or self.correction for plane in self.planes_by_name}

    @property
    def known_angle(self) -> Given | None:
        """The angle of the correction in plane A, if it is given."""
        return None if self.correction is None or self.correction.A is None else self.correction.A.angle

    @property
    def sought(self) -> frozenset[str]:
        """Unknowns of the correction masses: their mass `m`, their radius `r`, or both if the planes differ."""
        return frozenset("r" if known.r is None else "m" for known in self.known_masses.values())

    @property
    def has_couple(self) -> bool:
        """True if a mass or a correction lies outside plane A."""
        return self.planes.B is not None or any(one.z.si != self.planes.A.si for one in self.masses)
