"""A gear pair as a ledger: every number by its id, worked out from those above it, as the report prints it.

The points of the active path of contact at which sliding is worked out are rows.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from reportgen.formula import PI, Expression, Operand, Ref, acos, arcinv, cos, refs, sin, tan
from reportgen.formula.sheet import Sheet
from reportgen.formula.vocabulary import Chapter, row
from reportgen.gears import gears_ids
from reportgen.gears.gears_ids import LENGTH
from reportgen.gears.pair import Chosen, GearPair
from reportgen.report.case import Misconceptions, with_another
from reportgen.report.design import DesignCase

POINTS = 9
"""Sliding is worked out at so many points, evenly from one end of the active path to the other."""
WHEELS = (1, 2)
MESH = ("u", "a", "inv", "inv_w", "alpha_w", "x_sum", "x.2", "a_w", "y", "dy", "h", "p", "p_b")
"""What the report sets out of the pair in mesh,"""
DIMENSIONS = ("d", "d_b", "d_w", "h_a", "d_a", "d_f", "s", "s_w", "alpha_a", "inv_a", "s_a", "tip")
"""of each wheel,"""
OF_BOTH = {"undercut": ("x_min",), "contact": ("rho_a", "rho_p"), "fillets": ("rho_f",), "sliding": ("rho", "lambda")}
"""and of both wheels together."""
ALIKE = ("x_min", *DIMENSIONS, "rho_a", "rho_p", "rho_f", "lambda")
"""What both wheels have with as many decimals; ρ₂ = g − ρ₁ goes on from that of the other one."""


@dataclass(frozen=True)
class SolvedPair(DesignCase):
    """An assignment of a gear pair with its ledger; each part is computed when it is first asked for."""

    SAME = tuple(tuple(gears_ids.of_wheel(one, wheel) for wheel in WHEELS) for one in ALIKE)

    @cached_property
    def chosen(self) -> Chosen:
        found: Chosen = self.assignment.parameters.chosen
        return found

    @property
    def gears(self) -> GearPair:
        return self.chosen.pair

    @cached_property
    def sheet(self) -> Sheet:
        return PairSheet(self.chosen).q

    @property
    def worked(self) -> tuple[int, ...]:
        """The points written out in full: the ends of the path, where wheels slide most."""
        return (1, POINTS)

    @cached_property
    def misconceptions(self) -> Misconceptions:
        return Misconceptions(changed=_changed(self.sheet), ways=_ways(self.chosen.follows))


class PairSheet:
    """The sheet of a pair while it is written."""

    def __init__(self, chosen: Chosen) -> None:
        self.chosen, self.pair = chosen, chosen.pair
        self.q = Sheet(POINTS)
        with self.q.within(Chapter.data):
            self.enter_given()
        with self.q.within(Chapter.geometry):
            self.enter_mesh()
            for wheel in WHEELS:
                self.enter_wheel(wheel)
        with self.q.within(Chapter.velocity):
            self.enter_contact()
        with self.q.within(Chapter.acceleration):
            self.enter_sliding()
        self.set_out()

    def __getitem__(self, quantity: str) -> Ref:
        return self.q[f"gears.{quantity}"]

    def of(self, quantity: str, wheel: int) -> Ref:
        return self.q[gears_ids.of_wheel(quantity, wheel)]

    def both(self, quantity: str) -> tuple[Ref, Ref]:
        return self.of(quantity, 1), self.of(quantity, 2)

    def give(self, quantity: str, value: object, wheel: int = 0) -> Ref:
        return self.q.give(named(quantity, wheel), value)

    def define(self, quantity: str, definition: Operand, wheel: int = 0) -> Ref:
        """Enter a quantity; below 1e-9 of a module, or of 1, it is nothing."""
        id = named(quantity, wheel)
        return self.q.define(id, definition, scale=self.pair.m if row(id).kind == LENGTH else 1.0)

    def enter_given(self) -> None:
        pair, limits = self.pair, self.chosen.limits
        self.give("m", pair.m)
        for wheel, z in zip(WHEELS, pair.teeth, strict=True):
            self.give("z", float(z), wheel)
        self.give("alpha", pair.rack.alpha)
        self.give("ha", pair.rack.ha)
        self.give("c", pair.rack.c)
        self.give("limit.epsilon", limits.epsilon)
        self.give("limit.tip", limits.tip)
        if limits.sliding is not None:
            self.give("limit.sliding", limits.sliding)
        for wheel in WHEELS[: 1 if self.chosen.follows else 2]:
            self.give("x", float(pair.x[wheel - 1]), wheel)
        if self.chosen.a_w is not None:
            self.give("a_w", self.chosen.a_w)

    def enter_mesh(self) -> None:
        """The working pressure angle from the shifts, or the shifts from the centre distance."""
        m, α = self["m"], self["alpha"]
        z1, z2 = self.both("z")
        self.define("u", z2 / z1)
        a = self.define("a", m * (z1 + z2) / 2)
        inv_α = self.define("inv", tan(α) - α)
        if self.chosen.follows:
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
            # Of a centre distance in four figures too little would be left after subtracting a.
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
        """Contact ratio, line of action, and how much of each flank is in use."""
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

    def enter_sliding(self) -> None:
        t, u = self.give("t", np.arange(POINTS) / (POINTS - 1)), self["u"]
        start, end = self.of("rho_p", 1), self.of("rho_a", 1)
        ρ1 = self.define("rho", start + t * (end - start), 1)
        ρ2 = self.define("rho", self["g"] - ρ1, 2)
        self.define("lambda", 1 - ρ2 / (u * ρ1), 1)
        self.define("lambda", 1 - u * ρ1 / ρ2, 2)

    def set_out(self) -> None:
        self.q.set_out("mesh", *(f"gears.{one}" for one in MESH))
        for name, wheel in zip(("pinion", "wheel"), WHEELS, strict=True):
            self.q.set_out(name, *(gears_ids.of_wheel(one, wheel) for one in DIMENSIONS))
        self.q.set_out("contact", "gears.epsilon", "gears.g", "gears.g_a")
        for name, among in OF_BOTH.items():
            self.q.set_out(name, *(gears_ids.of_wheel(one, wheel) for one in among for wheel in WHEELS))


def named(quantity: str, wheel: int) -> str:
    """The id of a quantity of the pair (0) or of a wheel."""
    return gears_ids.of_wheel(quantity, wheel) if wheel else f"gears.{quantity}"


# --- what is often done in place of it --------------------------------------------------------------


def _changed(sheet: Sheet) -> Mapping[str, list[tuple[str, Expression]]]:
    """Definitions that are often used in place of the right ones."""
    found: dict[str, list[tuple[str, Expression]]] = {}
    angles = {named("inv", 0): named("alpha", 0), **{named("inv_a", one): named("alpha_a", one) for one in WHEELS}}
    if "gears.alpha_w" in refs(sheet.families["gears.inv_w"].definition or Ref("")):
        angles["gears.inv_w"] = "gears.alpha_w"
    for id, angle in angles.items():
        found[id] = [("gear-degrees", tan(Ref(angle)) - 180 * Ref(angle) / PI)]
    taken: list[tuple[str, str, Operand]] = [
        ("gear-standard-angle", "gears.alpha_w", Ref("gears.alpha")),
        ("gear-ratio", "gears.u", 1 / Ref("gears.u")),
    ]
    for wheel in WHEELS:
        x, d, d_b = (gears_ids.of_wheel(one, wheel) for one in ("x", "d", "d_b"))
        taken += [("gear-shift-sign", x, -Ref(x)), ("gear-base-circle", d_b, Ref(d))]
    taken.append(("gear-truncation", "gears.dy", 0.0))
    for name, id, other in taken:
        for where, definition in with_another(sheet.families, {id: other}):
            found.setdefault(where, []).append((name, definition))
    return found


def _ways(follows: bool) -> Mapping[str, list[Expression]]:
    """Other ways to what a student may as well have from the centre distance and the radii of curvature."""
    a, a_w, m, g, p_b = (Ref(f"gears.{one}") for one in ("a", "a_w", "m", "g", "p_b"))
    z1, z2 = (Ref(gears_ids.of_wheel("z", wheel)) for wheel in WHEELS)
    path = Ref(gears_ids.of_wheel("rho_a", 1)) + Ref(gears_ids.of_wheel("rho_a", 2)) - g
    found: dict[str, list[Expression]] = {"gears.epsilon": [path / p_b], "gears.g_a": [path]}
    if not follows:
        found["gears.y"] = [(a_w - a) / m]
    for wheel, z in zip(WHEELS, (z1, z2), strict=True):
        found[gears_ids.of_wheel("d_w", wheel)] = [2 * a_w * z / (z1 + z2)]
    return found
