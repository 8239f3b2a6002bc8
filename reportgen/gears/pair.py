"""A pair of external spur gears by formulas of ISO 21771, vectorised over profile shifts, and how shifts are chosen.

What both wheels have is an array whose first axis is the wheel; `[::-1]` is the mate.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from reportgen.formula.evaluation import arcinv, inv
from reportgen.gears.involute import Floats, Rack, Wheel, crossing

HUNDREDTH = 0.01
"""Shifts are chosen in hundredths of the module."""
LARGEST = 1.5
"""The greatest shift that is chosen."""


class NoPairError(Exception):
    """No shifts make such a pair: the code of the fault."""

    def __init__(self, code: str) -> None:
        super().__init__(code)
        self.code = code


@dataclass(frozen=True)
class PairLimits:
    """The least contact ratio, the least thickness at the tip (modules), and the greatest |λ| if there is one."""

    epsilon: float = 1.2
    tip: float = 0.25
    sliding: float | None = None


@dataclass(frozen=True)
class GearPair:
    """A pair by its rack, its module (m), its numbers of teeth and its shifts [2, ...]; lengths [2, ...] in metres."""

    rack: Rack
    m: float
    teeth: tuple[int, int]
    shifts: Floats

    @cached_property
    def x(self) -> Floats:
        return np.asarray(self.shifts, float)

    @cached_property
    def z(self) -> Floats:
        return np.reshape(np.array(self.teeth, float), (2,) + (1,) * (self.x.ndim - 1))

    # --- the pair in mesh

    @cached_property
    def alpha_w(self) -> Floats:
        """The working pressure angle: inv α_w = inv α + 2 (x₁ + x₂) tan α/(z₁ + z₂)."""
        α = self.rack.alpha
        return np.asarray(arcinv(inv(α) + 2 * self.x.sum(axis=0) * math.tan(α) / sum(self.teeth)))

    @property
    def a(self) -> float:
        return self.m * sum(self.teeth) / 2

    @property
    def a_w(self) -> Floats:
        return np.asarray(self.a * math.cos(self.rack.alpha) / np.cos(self.alpha_w))

    @property
    def y(self) -> Floats:
        return np.asarray((self.a_w - self.a) / self.m)

    @property
    def dy(self) -> Floats:
        """What tips are shortened by for the clearance c* m (modules)."""
        return np.asarray(self.x.sum(axis=0) - self.y)

    # --- the wheels

    @property
    def d(self) -> Floats:
        return np.asarray(self.m * self.z)

    @property
    def d_b(self) -> Floats:
        return np.asarray(self.d * math.cos(self.rack.alpha))

    @property
    def d_w(self) -> Floats:
        return np.asarray(self.d_b / np.cos(self.alpha_w))

    @property
    def d_a(self) -> Floats:
        return np.asarray(self.d + 2 * self.m * (self.rack.ha + self.x - self.dy))

    @property
    def d_f(self) -> Floats:
        return np.asarray(self.d - 2 * self.m * (self.rack.ha + self.rack.c - self.x))

    @property
    def s(self) -> Floats:
        return np.asarray(self.m * (math.pi / 2 + 2 * self.x * math.tan(self.rack.alpha)))

    @property
    def alpha_a(self) -> Floats:
        """The pressure angle at the tips."""
        with np.errstate(invalid="ignore"):
            return np.asarray(np.arccos(self.d_b / self.d_a))

    @property
    def s_a(self) -> Floats:
        """The thickness at the tips; negative beyond a pointed tooth."""
        return np.asarray(self.d_a * (self.s / self.d + inv(self.rack.alpha) - inv(self.alpha_a)))

    @property
    def x_min(self) -> Floats:
        """The least shifts without undercut."""
        return np.asarray(self.rack.ha - self.z * math.sin(self.rack.alpha) ** 2 / 2)

    # --- contact

    @property
    def epsilon(self) -> Floats:
        return np.asarray((self.z * (np.tan(self.alpha_a) - np.tan(self.alpha_w))).sum(axis=0) / (2 * math.pi))

    @property
    def p_b(self) -> float:
        return math.pi * self.m * math.cos(self.rack.alpha)

    @property
    def path(self) -> Floats:
        """N₁N₂, the line of action between the base circles."""
        return np.asarray(self.a_w * np.sin(self.alpha_w))

    @property
    def rho_a(self) -> Floats:
        """The radii of curvature of the flanks at the tips."""
        return np.asarray(self.d_b / 2 * np.tan(self.alpha_a))

    @property
    def rho_p(self) -> Floats:
        """The radii of curvature where each flank's active part begins: there the mate's tip touches."""
        return np.asarray(self.path - self.rho_a[::-1])

    @property
    def rho_f(self) -> Floats:
        """The radii of curvature where each involute begins; negative on undercut teeth."""
        α = self.rack.alpha
        return np.asarray(self.d / 2 * math.sin(α) - (self.rack.ha - self.x) * self.m / math.sin(α))

    @property
    def sliding(self) -> Floats:
        """The specific sliding λ at the feet of both wheels, where it is worst: below 0."""
        return np.asarray(1 - self.z / self.z[::-1] * self.rho_a[::-1] / self.rho_p)

    # --- what is asked of it

    def margins(self, limits: PairLimits) -> Iterator[Floats]:
        """Not negative where the pair keeps its limits: undercut, pointing, interference, contact ratio."""
        yield from self.x - self.x_min
        yield from self.s_a / self.m - limits.tip
        yield from (self.rho_p - np.maximum(self.rho_f, 0.0)) / self.m
        yield self.epsilon - limits.epsilon

    def wheel(self, number: int) -> Wheel:
        """The wheel 0 or 1."""
        tip = float(self.d_a[number]) / 2
        return Wheel(self.rack, self.m, self.teeth[number], float(self.x[number]), tip)


# --- shifts ---------------------------------------------------------------------------------------


def sum_for(rack: Rack, m: float, teeth: tuple[int, int], a_w: float) -> float:
    """The sum of the shifts at a centre distance (m): cos α_w = a cos α/a_w.

    Raises `NoPairError` for one at which the base circles overlap.
    """
    cosine = m * sum(teeth) / 2 * math.cos(rack.alpha) / a_w
    if cosine >= 1:
        raise NoPairError("gear-too-near")
    return float(inv(math.acos(cosine)) - inv(rack.alpha)) * sum(teeth) / (2 * math.tan(rack.alpha))


def least_shifts(pair: GearPair) -> Floats:
    """x_min in hundredths upwards, and no shift where none is needed."""
    return np.maximum(np.ceil(np.round(pair.x_min / HUNDREDTH, 9)) * HUNDREDTH, 0.0).round(2)


def balanced(pair: GearPair, total: float) -> Floats:
    """The shifts of a sum at which both feet slide alike: λ₁ = λ₂.  Raises `NoPairError` where none are."""
    first = np.linspace(total / 2 - LARGEST, total / 2 + LARGEST, 601)

    def unlike(x1: Floats) -> Floats:
        shifted = GearPair(pair.rack, pair.m, pair.teeth, np.stack((x1, total - x1)))
        # Only where both involutes begin outside the base circles is there a foot that slides.
        λ1, λ2 = np.where(shifted.rho_p > 0, shifted.sliding, np.nan)
        return np.asarray(λ1 - λ2)

    differences = unlike(first)
    [crossings] = np.nonzero((differences[:-1] <= 0) & (differences[1:] > 0))
    if not crossings.size:
        raise NoPairError("gear-no-balance")
    k = int(crossings[0])
    x1 = crossing(lambda at: float(unlike(np.array(at))), float(first[k]), float(first[k + 1]))
    return np.array([x1, total - x1])


def least_sliding(pair: GearPair, limits: PairLimits) -> Floats:
    """Of all shifts in hundredths within the limits those with the least greater |λ|: there the two are nearly equal.

    Raises `NoPairError` where none keep the limits.
    """
    low = np.maximum(np.ceil(np.round(pair.x_min / HUNDREDTH, 9)), -1 / HUNDREDTH)
    axes = [np.arange(start, LARGEST / HUNDREDTH + 0.5) * HUNDREDTH for start in low]
    if not all(axis.size for axis in axes):
        raise NoPairError("gear-no-shifts")
    grid = GearPair(pair.rack, pair.m, pair.teeth, np.stack(np.meshgrid(*axes, indexing="ij")))
    with np.errstate(invalid="ignore", divide="ignore"):
        kept = np.all([margin >= -1e-12 for margin in grid.margins(limits)], axis=0)
        worst = np.where(kept, -grid.sliding.min(axis=0), np.inf)
    if not kept.any():
        raise NoPairError("gear-no-shifts")
    place = np.unravel_index(int(worst.argmin()), worst.shape)
    return np.array([axis[at] for axis, at in zip(axes, place, strict=True)]).round(2)


@dataclass(frozen=True)
class Chosen:
    """A pair with what it was chosen by: its limits, the rule of its shifts, whether the centre distance was given."""

    pair: GearPair
    limits: PairLimits
    rule: str
    """`given`, `x_min` or `equal-sliding`."""
    a_w: float | None
    """The given centre distance (m)."""

    @property
    def follows(self) -> bool:
        """Whether x₂ follows from the centre distance."""
        return self.a_w is not None

    def broken(self) -> Iterator[tuple[str, int, float, float]]:
        """What does not hold: its name, the wheel (1, 2, or 0 for both), what it is, and its limit."""
        pair, limits = self.pair, self.limits
        for i in (0, 1):
            checks = (
                ("undercut", pair.x, pair.x_min),
                ("tip", pair.s_a / pair.m, np.full(2, limits.tip)),
                ("interference", pair.rho_p, np.maximum(pair.rho_f, 0.0)),
            )
            for name, actual, least in checks:
                if actual[i] < least[i] - 1e-9 * pair.m:
                    yield name, i + 1, float(actual[i]), float(least[i])
            if limits.sliding is not None and -pair.sliding[i] > limits.sliding:
                yield "sliding", i + 1, float(-pair.sliding[i]), limits.sliding
        if pair.epsilon < limits.epsilon - 1e-12:
            yield "epsilon", 0, float(pair.epsilon), limits.epsilon


def choose(
    blank: GearPair, limits: PairLimits, rule: str, a_w: float | None, given_shifts: tuple[float, float | None] | None
) -> Chosen:
    """The shifts of a pair by a rule, in hundredths unless a centre distance (m) decides.

    Raises `NoPairError` where there are none.
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
