"""The kind `gear-pair`: the parameters of its file, faults of impossible pairs, and warnings about unusual ones."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from functools import lru_cache
from typing import TYPE_CHECKING, Annotated, Any, Literal

import numpy as np
from pydantic import Field

from reportgen.assignment.checks import of_parameters
from reportgen.assignment.common import Part
from reportgen.assignment.fields import Decimal, Interval, Sought, Whole, quantity
from reportgen.base.errors import Finding
from reportgen.base.units import MM, Given
from reportgen.gears.pair_formulas import Rack
from reportgen.gears.pair_shifts import Chosen, GearPair, NoPairError, PairLimits, choose

if TYPE_CHECKING:
    from reportgen.assignment import Assignment
    from reportgen.gears.pair_case import PairCase

TURNS = 1
PART = "gears"
"""Prefix of its ids, also in a coursework."""
HAS_POSITIONS = False
TOP = ("parameters",)


def case(assignment: Assignment) -> PairCase:
    """Return the case of an assignment."""
    from reportgen.gears.pair_case import PairCase

    return PairCase(assignment)


def table_rows(position: Mapping[str, Any]) -> dict[str, dict[str, float]]:
    """Return the row that `solve` prints for a position of the results: radii of curvature in mm."""
    scales = {"rho.1": MM, "rho.2": MM}
    return {"contact": {name: value * scales.get(name, 1.0) for name, value in position["contact"].items()}}


# --- the file -------------------------------------------------------------------------------------


Shift = Annotated[float, Decimal(Interval(least=-3, most=3))]
PairTeeth = Annotated[int, Whole(5, 300)]


class Shifts(Part):
    """Both profile shifts (modules); the second follows if the centre distance is given."""

    x1: Shift
    x2: Shift | None = None


class LimitsOfPair(Part):
    """Limits that a pair must keep: least contact ratio, least tip thickness (modules), largest |λ| or None."""

    epsilon: Annotated[float, Decimal(Interval(least=1, most=2))] = 1.2
    tip: Annotated[float, Decimal(Interval(least=0, most=1))] = 0.25
    sliding: Annotated[float, Decimal(Interval(least=0.1, most=20))] | None = None


class Parameters(Part):
    """Pair of external spur gears; `find` requests shifts or a centre distance."""

    m: Annotated[Given, quantity("mm", least=0.1, most=100)]
    z1: PairTeeth
    z2: PairTeeth
    shifts: Literal["find"] | Shifts = "find"
    by: Literal["x_min", "equal-sliding"] = "equal-sliding"
    a_w: Annotated[Given | None, Sought(quantity("mm", least=1, below=1e5))] = None
    alpha: Annotated[Given, quantity("deg", least=10, most=35)] = Given(math.radians(20), 20.0, "deg", "20 deg")
    ha: Annotated[float, Decimal(Interval(least=0.3, most=1.5))] = 1.0
    c: Annotated[float, Decimal(Interval(least=0.05, most=0.5))] = 0.25
    limits: LimitsOfPair = Field(default_factory=LimitsOfPair)

    @property
    def rack(self) -> Rack:
        return Rack(self.alpha.si, self.ha, self.c)

    @property
    def unshifted(self) -> GearPair:
        """The pair without profile shifts."""
        return GearPair(self.rack, self.m.si, (self.z1, self.z2), np.zeros(2))

    @property
    def base(self) -> float:
        """Return the sum of the base radii (m), which the centre distance must exceed."""
        return float(self.unshifted["d_b"].sum()) / 2

    @property
    def chosen(self) -> Chosen:
        """Return the pair with its shifts found.

        Raises `NoPairError` if there are no such shifts.
        """
        return _chosen(self)


@lru_cache(maxsize=64)
def _chosen(given: Parameters) -> Chosen:
    shifts = given.shifts if isinstance(given.shifts, Shifts) else None
    limits = PairLimits(given.limits.epsilon, given.limits.tip, given.limits.sliding)
    rule = "given" if shifts else given.by
    a_w = None if given.a_w is None else given.a_w.si
    return choose(given.unshifted, limits, rule, a_w, None if shifts is None else (shifts.x1, shifts.x2))


# --- faults -------------------------------------------------------------------------------------


def _keys(given: Parameters) -> Iterator[Finding]:
    """Yield findings if both shifts and the centre distance are given, or a rule for shifts that are not to be
    found.
    """
    if isinstance(given.shifts, Shifts):
        if given.a_w is None and given.shifts.x2 is None:
            yield Finding("missing-key", (*TOP, "shifts", "x2"), {"key": "x2"})
        if given.a_w is not None and given.shifts.x2 is not None:
            yield Finding("gear-twice", (*TOP, "shifts", "x2"), at="key")
        if "by" in given.model_fields_set:
            yield Finding("gear-idle-by", (*TOP, "by"), at="key")
    rack = given.rack
    if rack.land < 0:
        # The rounding error may be as large as the remaining thickness of the tip.
        room = math.pi / 4 - given.ha * math.tan(rack.alpha)
        most = room * (1 - math.sin(rack.alpha)) / math.cos(rack.alpha)
        clearances = {"c": f"{given.c:g}", "most": f"{math.floor(most * 1000) / 1000:g}"}
        yield Finding("gear-rack" if most >= 0.05 else "gear-rack-pointed", (*TOP, "c"), clearances)


def _mesh(given: Parameters) -> Iterator[Finding]:
    """Yield findings for a pair that cannot be drawn: overlapping base circles, pointed teeth, contact outside N₁N₂."""
    key = "shifts" if isinstance(given.shifts, Shifts) else "by" if given.a_w is None else "a_w"
    where = (*TOP, key) if key in given.model_fields_set else TOP
    try:
        pair = given.chosen.pair
    except NoPairError as error:
        at = (*TOP, "a_w") if given.a_w is not None else where
        base = f"{given.base * MM:.3f}"
        yield Finding(
            error.code, at, {"base": base, "epsilon": f"{given.limits.epsilon:g}", "tip": f"{given.limits.tip:g}"}
        )
        return
    if not np.isfinite(pair["alpha_w"]) or pair["alpha_w"] <= 0:
        yield Finding("gear-no-mesh", where, {"sum": f"{pair.x.sum():g}"})
        return
    for i in (0, 1):
        wheel_shift = {"wheel": str(i + 1), "x": f"{pair.x[i]:.4g}"}
        if pair["d_f"][i] <= 0 or pair["d_a"][i] <= pair["d_f"][i]:
            yield Finding("gear-no-teeth", where, wheel_shift)
        elif not pair["tip"][i] >= 0:
            yield Finding("gear-beyond-point", where, wheel_shift)
        elif pair["rho_p"][i] <= 0:
            least = float(pair["x_min"][i])
            yield Finding("gear-beyond-line", where, wheel_shift | {"mate": str(2 - i), "x_min": f"{least:.3f}"})


def check(given: Parameters) -> Iterator[Finding]:
    """Yield the faults of the keys; if there are none, those of the resulting pair."""
    faults = list(_keys(given))
    yield from faults or _mesh(given)


CHECKS = (of_parameters(check),)


# --- warnings -----------------------------------------------------------------------------------


def physics(assignment: Assignment) -> Iterator[Finding]:
    """Yield warnings about undercut, thin tips, interference, contact ratio and sliding, with the amount and a
    remedy.
    """
    given: Parameters = assignment.parameters
    shifts = (*TOP, "shifts") if "shifts" in given.model_fields_set else TOP
    for name, wheel, actual, limit in given.chosen.broken():
        # Radii of curvature are lengths (m).
        scale = MM if name == "interference" else 1.0
        figures = {
            "wheel": str(wheel),
            "mate": str(3 - wheel),
            "is": f"{actual * scale:.3f}",
            "limit": f"{limit * scale:.3f}",
        }
        at = {1: ("x1",), 2: ("x2",)}.get(wheel, ()) if isinstance(given.shifts, Shifts) and name == "undercut" else ()
        at = at if at and getattr(given.shifts, at[0]) is not None else ()
        yield Finding(f"gear-{name}", (*shifts, *at), figures)


WARNINGS = (physics,)
