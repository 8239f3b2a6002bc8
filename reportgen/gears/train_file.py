"""The `parameters` of a planetary train, and the tooth numbers that they request."""

from __future__ import annotations

import math
from fractions import Fraction
from typing import Annotated, Literal

from pydantic import Field

from reportgen.assignment.common import Part
from reportgen.assignment.fields import Decimal, Interval, Quantity, Ratio, RotationalSpeed, Whole
from reportgen.base.template_access import template_members
from reportgen.base.units import Given
from reportgen.gears.tooth_numbers import LEAST_OUTER, MOST_SATELLITES, Demand, Train, TrainChoice, choice

MOST_TEETH = 300
FIRST_ROW_WHEEL = 4
"""First number of the wheels of ordinary rows."""

Tolerance = Annotated[Given, Ratio(Interval(least=0, most=0.2, tiny=1e-6))]
FEWEST_TEETH = 8
TrainTeeth = Annotated[int, Whole(FEWEST_TEETH, MOST_TEETH)]
TorqueOfShaft = Annotated[Given, Quantity("N m", Interval(above=0, most=1e9, tiny=1e-6))]
Module = Annotated[Given, Quantity("mm", Interval(least=0.1, most=100))]
OfMesh = Annotated[float, Decimal(Interval(above=0.5, most=1))]
RowTeeth = Annotated[int, Whole(-MOST_TEETH, MOST_TEETH)]
RowPair = Annotated[tuple[RowTeeth, ...], Field(min_length=2, max_length=2)]
"""Teeth of the driving and the driven wheel of a row; an inner wheel has a negative number, as in DIN 3960."""
Rows = Annotated[tuple[RowPair, ...], Field(max_length=4)]


@template_members("from_", "to")
class TeethLimits(Part):
    """The least and the greatest number of teeth of any wheel."""

    from_: TrainTeeth | None = Field(default=None, alias="from")
    to: TrainTeeth = 120


class MeshEfficiency(Part):
    """The efficiency of a mesh of two outer wheels, and of a mesh with an inner wheel."""

    outer: OfMesh = 0.97
    inner: OfMesh = 0.98


class KnownTorque(Part):
    """The size of the torque on one shaft of the drive: the first, the last, or fixed wheel 3."""

    M: TorqueOfShaft
    of: Literal["driving", "driven", "fixed"] = "driving"


@template_members(
    *("u", "tolerance", "z", "least", "least_teeth", "before", "behind", "efficiency", "torque", "by_carrier")
)
class Parameters(Part):
    """A planetary train to be found, with rows of ordinary wheels before and behind it."""

    scheme: Literal["single", "double", "double-outer", "double-inner"]
    u: Annotated[Given, Ratio(Interval(least=-2000, most=2000))] | None = None
    n_out: RotationalSpeed | None = None
    tolerance: Tolerance = Given(0.0, 0.0, "", "0")
    k: Annotated[int, Whole(2, MOST_SATELLITES)]
    z: TeethLimits = TeethLimits()
    least_teeth: Annotated[int, Whole(FEWEST_TEETH, LEAST_OUTER)] = LEAST_OUTER
    m: Module
    m2: Module | None = None
    n_in: RotationalSpeed
    drives: Literal["wheel", "carrier"] = "wheel"
    before: Rows = ()
    behind: Rows = ()
    efficiency: MeshEfficiency | None = None
    torque: KnownTorque | None = None

    @property
    def least(self) -> int:
        """Return the least number of teeth of any wheel of the train."""
        return self.least_teeth if self.z.from_ is None else self.z.from_

    @property
    def by_carrier(self) -> bool:
        return self.drives == "carrier"

    @property
    def second_module(self) -> Given:
        return self.m if self.m2 is None else self.m2

    @property
    def row_ratio(self) -> float:
        """Return the factor by which the rows of ordinary wheels slow down, as a magnitude."""
        return math.prod(abs(driven / driver) for driver, driven in (*self.before, *self.behind))

    @property
    def wanted(self) -> float:
        """Return the ratio of the planetary train from its driving to its driven shaft."""
        if self.u is not None:
            return self.u.si
        assert self.n_out is not None, "a check asks for one of them"
        return self.n_in.si / self.n_out.si / self.row_ratio

    def of_input(self, ratio: float) -> float:
        """Convert u₁H to the ratio from the driving to the driven shaft, or back."""
        return 1 / ratio if self.by_carrier else ratio

    @property
    def demand(self) -> Demand:
        modules = Fraction(self.m.si / self.second_module.si).limit_denominator(10_000)
        ratio, share = self.of_input(self.wanted), self.tolerance.si
        return Demand(
            self.scheme,
            ratio,
            share,
            satellites=self.k,
            least=self.least,
            most=self.z.to,
            modules=modules,
            by_carrier=self.by_carrier,
            outer=self.least_teeth,
        )

    @property
    def choice(self) -> TrainChoice:
        return choice(self.demand)


def undercut_wheels(given: Parameters, train: Train) -> dict[str, int]:
    """Return the outer wheels of the whole drive that are undercut without profile shift, with their teeth."""
    in_rows = [teeth for row in (*given.before, *given.behind) for teeth in row]
    every = {**train.undercut, **{str(FIRST_ROW_WHEEL + i): teeth for i, teeth in enumerate(in_rows)}}
    return {wheel: teeth for wheel, teeth in every.items() if 0 < teeth < LEAST_OUTER}
