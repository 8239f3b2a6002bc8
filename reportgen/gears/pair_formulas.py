"""Formulas of a pair of external spur gears (ISO 21771), each written once.

The report of a pair prints a `Calculation` of them (`PairFormulas`). To choose shifts, draw their region and place
teeth, `pair_calculation` returns such a calculation, and `model` (`formula.array_evaluation`) evaluates it over arrays.
"""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np

from reportgen.base.records import Record
from reportgen.formula import PI, Operand, Ref, acos, arcinv, cos, sin, tan
from reportgen.formula.calculation import Calculation
from reportgen.formula.vocabulary import row
from reportgen.gears import gears_ids

WHEELS = (1, 2)


class Rack(Record):
    """The basic rack: profile angle (rad), addendum and bottom clearance as multiples of the module."""

    alpha: float
    ha: float = 1.0
    c: float = 0.25

    @property
    def rounding(self) -> float:
        """Return the radius of the tip's rounding ρ_f* = c*/(1 − sin α) (modules), which ends where the
        addendum does.
        """
        return self.c / (1 - math.sin(self.alpha))

    @property
    def land(self) -> float:
        """Return half the flat of the rack's tip (modules); negative if there is no room for the rounding."""
        return math.pi / 4 - self.ha * math.tan(self.alpha) - self.rounding * math.cos(self.alpha)


class PairFormulas:
    """A calculation that the formulas of a pair are entered in; lengths in metres.

    If x₂ `follows`, it is computed from a given centre distance; otherwise both shifts are given.
    """

    def __init__(self, q: Calculation, m: float, follows: bool) -> None:
        self.q, self.m, self.follows = q, m, follows

    def __getitem__(self, quantity: str) -> Ref:
        return self.q[f"gears.{quantity}"]

    def of(self, quantity: str, wheel: int) -> Ref:
        return self.q[gears_ids.of_wheel(quantity, wheel)]

    def both(self, quantity: str) -> tuple[Ref, Ref]:
        return self.of(quantity, 1), self.of(quantity, 2)

    def give(self, quantity: str, value: object, wheel: int = 0) -> Ref:
        return self.q.give(named(quantity, wheel), value)

    def define(self, quantity: str, definition: Operand, wheel: int = 0) -> Ref:
        """Enter a quantity of the pair (wheel 0) or of a wheel; values below 1e-9 of a module, or of 1, become 0."""
        id = named(quantity, wheel)
        return self.q.define(id, definition, scale=self.m if row(id).kind == gears_ids.LENGTH else 1.0)

    def enter_data(self, rack: Rack, teeth: tuple[int, int]) -> None:
        """Enter module, numbers of teeth and basic rack."""
        self.give("m", self.m)
        for wheel, z in zip(WHEELS, teeth, strict=True):
            self.give("z", float(z), wheel)
        self.give("alpha", rack.alpha)
        self.give("ha", rack.ha)
        self.give("c", rack.c)

    def enter_shifts(self, shifts: tuple[float, float], a_w: float | None = None) -> None:
        """Enter both shifts (modules), or the first of them and the centre distance (m)."""
        for wheel, x in zip(WHEELS[: 1 if self.follows else 2], shifts, strict=False):
            self.give("x", x, wheel)
        if a_w is not None:
            self.give("a_w", a_w)

    def enter_pair(self) -> None:
        """Enter the pair in mesh and both wheels."""
        self.enter_mesh()
        for wheel in WHEELS:
            self.enter_wheel(wheel)

    def enter_mesh(self) -> None:
        """Enter the working pressure angle from the shifts, or the shifts from the centre distance."""
        m, α = self["m"], self["alpha"]
        z1, z2 = self.both("z")
        self.define("u", z2 / z1)
        a = self.define("a", m * (z1 + z2) / 2)
        inv_α = self.define("inv", tan(α) - α)
        if self.follows:
            α_w = self.define("alpha_w", acos(a * cos(α) / self["a_w"]))
            inv_w = self.define("inv_w", tan(α_w) - α_w)
            total = self.define("x_sum", (inv_w - inv_α) * (z1 + z2) / (2 * tan(α)))
            self.define("x", total - self.of("x", 1), 2)
            y = self.define("y", (self["a_w"] - a) / m)
        else:
            x1, x2 = self.both("x")
            total = self.define("x_sum", x1 + x2)
            inv_w = self.define("inv_w", inv_α + 2 * total * tan(α) / (z1 + z2))
            α_w = self.define("alpha_w", arcinv(inv_w))
            self.define("a_w", a * cos(α) / cos(α_w))
            # With four digits of the centre distance, too few would remain after subtracting a.
            y = self.define("y", (z1 + z2) / 2 * (cos(α) / cos(α_w) - 1))
        self.define("dy", total - y)
        self.define("h", m * (2 * self["ha"] + self["c"] - self["dy"]))
        p = self.define("p", PI * m)
        self.define("p_b", p * cos(α))

    def enter_wheel(self, wheel: int) -> None:
        m, α, ha = self["m"], self["alpha"], self["ha"]
        z, x = self.of("z", wheel), self.of("x", wheel)
        self.define("x_min", ha - z * sin(α) ** 2 / 2, wheel)
        d = self.define("d", m * z, wheel)
        d_b = self.define("d_b", d * cos(α), wheel)
        d_w = self.define("d_w", d_b / cos(self["alpha_w"]), wheel)
        h_a = self.define("h_a", m * (ha + x - self["dy"]), wheel)
        d_a = self.define("d_a", d + 2 * h_a, wheel)
        self.define("d_f", d - 2 * m * (ha + self["c"] - x), wheel)
        s = self.define("s", m * (PI / 2 + 2 * x * tan(α)), wheel)
        self.define("s_w", d_w * (s / d + self["inv"] - self["inv_w"]), wheel)
        α_a = self.define("alpha_a", acos(d_b / d_a), wheel)
        inv_a = self.define("inv_a", tan(α_a) - α_a, wheel)
        s_a = self.define("s_a", d_a * (s / d + self["inv"] - inv_a), wheel)
        self.define("tip", s_a / m, wheel)

    def enter_contact(self) -> None:
        """Enter contact ratio, line of action, and the working part of each flank."""
        α, m, α_w = self["alpha"], self["m"], self["alpha_w"]
        z1, z2 = self.both("z")
        over = [tan(one) - tan(α_w) for one in self.both("alpha_a")]
        ε = self.define("epsilon", (z1 * over[0] + z2 * over[1]) / (2 * PI))
        g = self.define("g", self["a_w"] * sin(α_w))
        self.define("g_a", ε * self["p_b"])
        for wheel in WHEELS:
            self.define("rho_a", self.of("d_b", wheel) * tan(self.of("alpha_a", wheel)) / 2, wheel)
        for wheel in WHEELS:
            self.define("rho_p", g - self.of("rho_a", 3 - wheel), wheel)
            begun = self.of("d", wheel) * sin(α) / 2 - (self["ha"] - self.of("x", wheel)) * m / sin(α)
            self.define("rho_f", begun, wheel)

    def enter_sliding(self, points: np.ndarray | float) -> None:
        """Enter the specific sliding at points t [N] of the active path, from 0 at its beginning to 1 at its end."""
        t, u = self.give("t", points), self["u"]
        start, end = self.of("rho_p", 1), self.of("rho_a", 1)
        ρ1 = self.define("rho", start + t * (end - start), 1)
        ρ2 = self.define("rho", self["g"] - ρ1, 2)
        self.define("lambda", 1 - ρ2 / (u * ρ1), 1)
        self.define("lambda", 1 - u * ρ1 / ρ2, 2)


@lru_cache(maxsize=32)
def pair_calculation(rack: Rack, m: float, teeth: tuple[int, int]) -> Calculation:
    """Return a calculation of a pair of module m (in metres), for `model(sheet, …)` to evaluate with any shifts."""
    made = PairFormulas(Calculation(), m, follows=False)
    made.enter_data(rack, teeth)
    made.enter_shifts((0.0, 0.0))
    made.enter_pair()
    made.enter_contact()
    made.enter_sliding(0.0)
    return made.q


def sum_of_shifts(rack: Rack, m: float, teeth: tuple[int, int], a_w: float) -> float:
    """Return the sum of the shifts (modules) at a centre distance (m); NaN if the base circles overlap or touch."""
    made = PairFormulas(Calculation(), m, follows=True)
    made.enter_data(rack, teeth)
    made.enter_shifts((0.0, 0.0), a_w)
    made.enter_mesh()
    return made.q.si("gears.x_sum") if made.q.si("gears.alpha_w") > 0 else math.nan


def named(quantity: str, wheel: int) -> str:
    """Return the id of a quantity of the pair (wheel 0) or of a wheel."""
    return gears_ids.of_wheel(quantity, wheel) if wheel else f"gears.{quantity}"
