"""Choose profile shifts of a pair of external spur gears (`choose`), by the formulas of its report over arrays of
shifts.

Values of both wheels are an array whose first axis is the wheel; `[::-1]` is the mate.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import cached_property

import numpy as np

from reportgen.base.arrays import Floats
from reportgen.base.records import Record
from reportgen.formula.array_evaluation import model
from reportgen.formula.calculation import Calculation
from reportgen.formula.constructions import Value
from reportgen.gears import gears_ids
from reportgen.gears.involute import Wheel, crossing
from reportgen.gears.pair_formulas import WHEELS, Rack, pair_calculation, sum_of_shifts

HUNDREDTH = 0.01
"""Shifts are chosen in hundredths of the module."""
ROUNDING = 1e-9
"""A condition that is missed by less than this (modules, or 1) counts as kept."""
COMMON = (
    "gears.alpha_w",
    "gears.dy",
    "gears.g",
    *(gears_ids.of_wheel(one, wheel) for one in ("alpha_a", "rho_p") for wheel in WHEELS),
)
"""Quantities on which nearly all others of a pair depend."""
USUAL, LARGEST, STEP = 1.5, 3.0, 0.5
"""The search ends at the usual greatest shifts, and goes on step by step as long as the limits still hold there."""


class NoPairError(Exception):
    """Raised if no shifts make the requested pair; carries the code of the fault."""

    def __init__(self, code: str) -> None:
        super().__init__(code)
        self.code = code


class PairLimits(Record):
    """The least contact ratio, the least tip thickness (modules), and the greatest |λ| or None."""

    epsilon: float = 1.2
    tip: float = 0.25
    sliding: float | None = None


class PairCondition(Record):
    """A condition of a wheel (1, 2), or of the pair (0): `actual` [...] is at least `least` [...].

    Lengths are compared in units of `unit`, the module (m).
    """

    name: str
    wheel: int
    actual: Floats
    least: Floats
    unit: float = 1.0

    @property
    def margin(self) -> Floats:
        """Return the margin [...] in units of `unit`; negative where the condition is broken."""
        return np.asarray((self.actual - self.least) / self.unit)


class GearPair(Record, dict=True):
    """A pair by its rack, its module (m), its numbers of teeth and its shifts [2, ...] (modules)."""

    rack: Rack
    m: float
    teeth: tuple[int, int]
    shifts: Floats

    @cached_property
    def x(self) -> Floats:
        """Return the shifts x (modules) [2, ...]."""
        return np.asarray(self.shifts, float)

    @cached_property
    def _known(self) -> dict[str, Value]:
        """Return the values computed so far, by id; initially those on which nearly all others depend."""
        shifts = {gears_ids.of_wheel("x", wheel): x for wheel, x in zip(WHEELS, self.x, strict=True)}
        return shifts | model(self.calculation, COMMON, **shifts)

    @property
    def calculation(self) -> Calculation:
        """Return the formulas of its report with given shifts."""
        return pair_calculation(self.rack, self.m, self.teeth)

    def __getitem__(self, quantity: str) -> Floats:
        """Return a quantity of the report by its name there (SI): [...] of the pair, [2, ...] of its wheels.

        Raises `KeyError` for a name that the calculation does not contain.
        """
        return self.at(quantity)

    def at(self, quantity: str, **at: float) -> Floats:
        """Return a quantity (SI) [...] or [2, ...], with some values replaced by `at`."""
        sheet, of_pair = self.calculation, f"gears.{quantity}"
        wanted = (
            (of_pair,) if of_pair in sheet.families else tuple(gears_ids.of_wheel(quantity, wheel) for wheel in WHEELS)
        )
        taken = {f"gears.{name}": value for name, value in at.items()}
        values_by_id = model(sheet, wanted, **self._known, **taken)
        if not at:
            self._known.update(values_by_id)
        values = [np.broadcast_to(np.asarray(values_by_id[id], float), self.x.shape[1:]) for id in wanted]
        return np.stack(values) if len(values) > 1 else values[0]

    @cached_property
    def sliding(self) -> Floats:
        """Return the specific sliding λ [2, ...] at the feet of both wheels, where it is worst: below 0.

        Wheel 1 touches with its foot where the active path begins, wheel 2 where it ends.
        """
        return np.stack([self.at("lambda", t=0.0)[0], self.at("lambda", t=1.0)[1]])

    @property
    def to_pitch_point(self) -> Floats:
        """Return the distances (m) [2, ...] of the pitch point from N₁ and N₂ on the line of action, r_b tan α_w."""
        rolled: Floats = self["d_b"] / 2 * np.tan(self["alpha_w"])
        return rolled

    # --- queries

    def conditions(self, limits: PairLimits) -> Iterator[PairCondition]:
        """Yield undercut, thickness of the tip and interference of each wheel, then the contact ratio."""
        begun = np.maximum(self["rho_f"], 0.0)
        for i, wheel in enumerate(WHEELS):
            yield PairCondition("undercut", wheel, self.x[i], self["x_min"][i])
            yield PairCondition("tip", wheel, self["tip"][i], np.asarray(limits.tip))
            yield PairCondition("interference", wheel, self["rho_p"][i], begun[i], self.m)
        yield PairCondition("epsilon", 0, self["epsilon"], np.asarray(limits.epsilon))

    def keeps(self, limits: PairLimits) -> np.ndarray:
        """Return flags [...] of the pairs that keep all conditions."""
        return np.asarray(np.all([condition.margin >= -ROUNDING for condition in self.conditions(limits)], axis=0))

    def wheel(self, number: int) -> Wheel:
        """Return wheel 0 or 1."""
        tip = float(self["d_a"][number]) / 2
        return Wheel(self.rack, self.m, self.teeth[number], float(self.x[number]), tip)


# --- shifts ---------------------------------------------------------------------------------------


def sum_for(rack: Rack, m: float, teeth: tuple[int, int], a_w: float) -> float:
    """Return the sum of the shifts (modules) at a centre distance (m).

    Raises `NoPairError` if the base circles overlap.
    """
    total = sum_of_shifts(rack, m, teeth, a_w)
    if math.isnan(total):
        raise NoPairError("gear-too-near")
    return total


def least_shifts(pair: GearPair) -> Floats:
    """Return x_min [2] (modules), rounded up to hundredths; 0 where no shift is needed."""
    return np.maximum(np.ceil(np.round(pair["x_min"] / HUNDREDTH, 9)) * HUNDREDTH, 0.0).round(2)


def balanced(pair: GearPair, total: float) -> Floats:
    """Return the shifts [2] (modules) with a given sum at which both feet slide equally: λ₁ = λ₂.

    Raises `NoPairError` if there are none.
    """
    first = np.linspace(total / 2 - LARGEST, total / 2 + LARGEST, 601)

    def unlike(x1: Floats) -> Floats:
        shifted = GearPair(pair.rack, pair.m, pair.teeth, np.stack((x1, total - x1)))
        # A foot slides only if both involutes begin outside the base circles.
        λ1, λ2 = np.where(shifted["rho_p"] > 0, shifted.sliding, np.nan)
        return np.asarray(λ1 - λ2)

    differences = unlike(first)
    [crossings] = np.nonzero((differences[:-1] <= 0) & (differences[1:] > 0))
    if not crossings.size:
        raise NoPairError("gear-no-balance")
    k = int(crossings[0])
    x1 = crossing(lambda at: float(unlike(np.array(at))), float(first[k]), float(first[k + 1]))
    return np.array([x1, total - x1])


def least_sliding(pair: GearPair, limits: PairLimits) -> Floats:
    """Return the shifts [2] in hundredths of the module within limits with the least greater |λ|, λ₁ ≈ λ₂.

    Raises `NoPairError` if no shifts keep the limits.
    """
    low = np.maximum(np.ceil(np.round(pair["x_min"] / HUNDREDTH, 9)), -1 / HUNDREDTH)
    best: Floats | None = None
    for most in np.arange(USUAL, LARGEST + STEP / 2, STEP):
        axes = [np.arange(start, most / HUNDREDTH + 0.5) * HUNDREDTH for start in low]
        if not all(axis.size for axis in axes):
            continue
        grid = GearPair(pair.rack, pair.m, pair.teeth, np.stack(np.meshgrid(*axes, indexing="ij")))
        kept = grid.keeps(limits)
        if kept.any():
            worst = np.where(kept, -grid.sliding.min(axis=0), np.inf)
            place = np.unravel_index(int(worst.argmin()), worst.shape)
            best = np.array([axis[at] for axis, at in zip(axes, place, strict=True)]).round(2)
        if best is not None and not (kept[-1].any() or kept[:, -1].any()):
            break
    if best is None:
        raise NoPairError("gear-no-shifts")
    return best


class Chosen(Record):
    """A pair with the choices behind it: limits, rule of its shifts, and the given centre distance."""

    pair: GearPair
    limits: PairLimits
    rule: str
    """`given`, `x_min` or `equal-sliding`."""
    a_w: float | None
    """The given centre distance (m); None if it was not given."""

    @property
    def follows(self) -> bool:
        """Return True if x₂ follows from the centre distance."""
        return self.a_w is not None

    def broken(self) -> Iterator[tuple[str, int, float, float]]:
        """Yield the broken conditions: name, wheel (1, 2, or 0 for both), actual value, limit (ratios, or modules)."""
        pair, most = self.pair, self.limits.sliding
        for wheel in (*WHEELS, 0):
            for condition in pair.conditions(self.limits):
                if condition.wheel == wheel and condition.margin < -ROUNDING:
                    yield condition.name, wheel, float(condition.actual), float(condition.least)
            if wheel and most is not None and -pair.sliding[wheel - 1] > most:
                yield "sliding", wheel, float(-pair.sliding[wheel - 1]), most


def choose(
    blank: GearPair, limits: PairLimits, rule: str, a_w: float | None, given_shifts: tuple[float, float | None] | None
) -> Chosen:
    """Return the shifts of a pair by a rule, in hundredths of the module unless a centre distance (m) decides.

    Raises `NoPairError` if there are none.
    """
    total = None if a_w is None else sum_for(blank.rack, blank.m, blank.teeth, a_w)
    if given_shifts is not None:
        first, second = given_shifts[0], given_shifts[1] or 0.0
    elif rule == "x_min":
        first, second = map(float, least_shifts(blank))
    elif total is None:
        first, second = map(float, least_sliding(blank, limits))
    else:
        first, second = round(float(balanced(blank, total)[0]), 2), 0.0
    shifts = np.array([first, second if total is None else total - first])
    return Chosen(GearPair(blank.rack, blank.m, blank.teeth, shifts), limits, rule, a_w)
