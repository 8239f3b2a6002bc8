"""The kind `planetary-train`: its file, which trains cannot be, and what of one is hardly meant."""

from __future__ import annotations

import math
from collections.abc import Iterator
from fractions import Fraction
from typing import TYPE_CHECKING, Annotated, Literal

from pydantic import Field

from reportgen.assignment.common import Part, of_parameters, one_of
from reportgen.assignment.fields import Decimal, Interval, Quantity, Ratio, RotationalSpeed, Share, Whole
from reportgen.base.errors import Finding
from reportgen.base.units import Given
from reportgen.gears.train import (
    CONDITIONS,
    DUST,
    LEAST_OUTER,
    MOST_SATELLITES,
    SCHEMES,
    Choice,
    Demand,
    Train,
    choice,
    mended,
)

if TYPE_CHECKING:
    from reportgen.assignment import Assignment
    from reportgen.gears.train_case import TrainCase

TURNS = 1
HAS_POSITIONS = False
TOP = ("parameters",)
MOST_TEETH = 300

Teeth = Annotated[int, Whole(LEAST_OUTER, MOST_TEETH)]
Module = Annotated[Given, Quantity("mm", Interval(least=0.1, most=100))]
OfMesh = Annotated[float, Decimal(Interval(above=0.5, most=1))]
RowPair = Annotated[tuple[Teeth, ...], Field(min_length=2, max_length=2)]
Rows = Annotated[tuple[RowPair, ...], Field(max_length=4)]


class TeethLimits(Part):
    """The least and the greatest number of teeth of any wheel."""

    from_: Annotated[int, Whole(8, MOST_TEETH)] = Field(default=LEAST_OUTER, alias="from")
    to: Annotated[int, Whole(8, MOST_TEETH)] = 120


class MeshEfficiency(Part):
    """The efficiency of a mesh of two outer wheels, and of one with an inner wheel."""

    outer: OfMesh = 0.97
    inner: OfMesh = 0.98


class Parameters(Part):
    """A planetary train that is sought, with rows of ordinary wheels before and behind it."""

    scheme: Literal["single", "double", "double-outer", "double-inner"]
    u: Annotated[Given, Ratio(Interval(least=-2000, most=2000))] | None = None
    n_out: RotationalSpeed | None = None
    tolerance: Share = Given(0.0, 0.0, "", "0")
    k: Annotated[int, Whole(2, MOST_SATELLITES)]
    z: TeethLimits = TeethLimits()
    m: Module
    m2: Module | None = None
    n_in: RotationalSpeed
    drives: Literal["wheel", "carrier"] = "wheel"
    before: Rows = ()
    behind: Rows = ()
    efficiency: MeshEfficiency | None = None

    @property
    def by_carrier(self) -> bool:
        return self.drives == "carrier"

    @property
    def second_module(self) -> Given:
        return self.m if self.m2 is None else self.m2

    @property
    def row_ratio(self) -> float:
        """By how much the rows of ordinary wheels slow down, by its size."""
        return math.prod(driven / driver for driver, driven in (*self.before, *self.behind))

    @property
    def wanted(self) -> float:
        """The ratio of the planetary train from its driving to its driven shaft."""
        if self.u is not None:
            return self.u.si
        assert self.n_out is not None, "a check asks for one of them"
        return self.n_in.si / self.n_out.si / self.row_ratio

    def of_input(self, ratio: float) -> float:
        """u₁H as the ratio from the driving to the driven shaft, and the other way round."""
        return 1 / ratio if self.by_carrier else ratio

    @property
    def demand(self) -> Demand:
        modules = Fraction(self.m.si / self.second_module.si).limit_denominator(10_000)
        limits = (self.z.from_, self.z.to)
        return Demand(self.scheme, self.of_input(self.wanted), self.tolerance.si, self.k, *limits, modules)

    @property
    def choice(self) -> Choice:
        return choice(self.demand)


def case(assignment: Assignment) -> TrainCase:
    """The case of an assignment."""
    from reportgen.gears.train_case import TrainCase

    return TrainCase(assignment)


# --- what cannot be -------------------------------------------------------------------------------


def told(train: Train) -> str:
    """Tooth numbers as a message names them."""
    z = train.teeth
    return f"{z.one}/{z.two}/{z.three}" if SCHEMES[train.scheme].single else "/".join(map(str, z))


def check(given: Parameters) -> Iterator[Finding]:
    """Keys and limits first; then whether any tooth numbers fulfil what is asked for, else which condition fails."""
    if (given.u is None) == (given.n_out is None):
        return  # another check says so
    if SCHEMES[given.scheme].single and given.m2 is not None:
        yield Finding("train-one-module", (*TOP, "m2"), at="key")
        return
    if given.z.from_ > given.z.to:
        yield Finding("train-limits", (*TOP, "z", "to"), {"least": str(given.z.from_), "most": str(given.z.to)})
        return
    if given.u is not None and given.u.si in (0, 1):
        yield Finding("train-no-ratio", (*TOP, "u"), {"u": given.u.text})
        return
    found = given.choice
    if len(found.sets):
        return
    failed = next(name for name in CONDITIONS if not found.left[name])
    wanted, limits = given.wanted, {"least": str(given.z.from_), "most": str(given.z.to)}
    about = {"u": f"{wanted:.6g}", "k": str(given.k), **limits}
    if failed in ("ratio", "interference"):
        key = ("u",) if given.u is not None else ("n_out",)
        if found.nearest is None:
            yield Finding("train-interference", (*TOP, "z"), about)
            return
        nearest = given.of_input(float(found.nearest.ratio)) if found.nearest.ratio else math.inf
        off = abs(found.demand.ratio - float(found.nearest.ratio)) / abs(found.demand.ratio)
        about |= {"nearest": f"{nearest:.6g}", "teeth": told(found.nearest), "tolerance": given.tolerance.text}
        if off < 1:
            about |= {"enough": f"{math.ceil(off * 1e5) / 1e5:g}"}
        yield Finding("train-ratio", (*TOP, *key), about)
        return
    others = mended(found.demand)
    mend = {"others": ", ".join(map(str, others))} if others else {}
    yield Finding(f"train-{failed}", (*TOP, "k"), about | mend)


CHECKS = (one_of("parameters", "u", "n_out"), of_parameters(check))


# --- what is hardly meant -------------------------------------------------------------------------


def physics(assignment: Assignment) -> Iterator[Finding]:
    """A ratio that is not met exactly, inner wheels that mesh only with profile shift."""
    given: Parameters = assignment.parameters
    found = given.choice
    reached = float(found.chosen.ratio)
    if abs(reached - found.demand.ratio) > DUST * abs(reached):
        key = "u" if given.u is not None else "n_out"
        met = {"u": f"{given.wanted:.6g}", "reached": f"{given.of_input(reached):.6g}"}
        yield Finding("train-off", (*TOP, key), met)
    if not found.free[found.first]:
        yield Finding("train-shift", (*TOP, "z"), {"teeth": told(found.chosen)})


WARNINGS = (physics,)
