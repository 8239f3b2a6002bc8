"""A gear pair as a ledger: every number by its id, worked out from those above it, as the report prints it.

The points of the active path of contact at which sliding is worked out are rows.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from reportgen.formula import (
    PI,
    Expression,
    Operand,
    Ref,
    Symbol,
    acos,
    arcinv,
    as_expression,
    cos,
    ids,
    refs,
    sin,
    substitute,
    tan,
)
from reportgen.formula.ledger import Ledger
from reportgen.formula.rounding import printed
from reportgen.formula.sheet import Sheet
from reportgen.formula.vocabulary import Chapter
from reportgen.gears.pair import Chosen, Pair
from reportgen.report.case import Opened, Pitfalls

POINTS = 9
"""Sliding is worked out at so many points, evenly from one end of the active path to the other."""
WHEELS = (1, 2)


@dataclass(frozen=True)
class SolvedPair(Opened):
    """An assignment of a gear pair with its ledger; each part is computed when it is first asked for."""

    @cached_property
    def chosen(self) -> Chosen:
        found: Chosen = self.assignment.parameters.chosen
        return found

    @property
    def gears(self) -> Pair:
        return self.chosen.pair

    @cached_property
    def sheet(self) -> Sheet:
        return PairSheet(self.chosen).q

    @cached_property
    def ledger(self) -> Ledger:
        sheet = self.sheet
        made = Ledger(sheet.families, sheet.positions, units=self.words["units"], lines=sheet.lines)
        return made.in_language(self.words["symbols"])

    @cached_property
    def printed(self) -> Ledger:
        return printed(self.ledger)

    @property
    def count(self) -> int:
        """The points of the path."""
        return POINTS

    @property
    def worked(self) -> tuple[int, ...]:
        """The points written out in full: the ends of the path, where wheels slide most."""
        return (1, POINTS)

    @cached_property
    def pitfalls(self) -> Pitfalls:
        return Pitfalls(changed=_changed(self.sheet))


class PairSheet:
    """The sheet of a pair while it is written."""

    def __init__(self, chosen: Chosen) -> None:
        self.chosen, self.pair = chosen, chosen.pair
        self.q = Sheet(POINTS)
        self.enter_given()
        self.enter_mesh()
        for wheel in WHEELS:
            self.enter_wheel(wheel)
        self.enter_contact()
        self.enter_sliding()

    def both(self, quantity: str) -> tuple[Ref, Ref]:
        first, second = (self.q[ids.gear(quantity, wheel)] for wheel in WHEELS)
        return first, second

    def enter_given(self) -> None:
        q, pair, limits = self.q, self.pair, self.chosen.limits
        with q.within(Chapter.data):
            self.m = q.give("gears.m", pair.m)
            for wheel, z in zip(WHEELS, pair.teeth, strict=True):
                q.give(ids.gear("z", wheel), float(z))
            self.α = q.give("gears.alpha", pair.rack.alpha)
            self.ha, self.c = (
                q.give(id, value, Symbol(letter, below, "*"))
                for id, value, letter, below in (
                    ("gears.ha", pair.rack.ha, "h", "a"),
                    ("gears.c", pair.rack.c, "c", ""),
                )
            )
            q.give("gears.limit.epsilon", limits.epsilon)
            q.give("gears.limit.tip", limits.tip)
            if limits.sliding is not None:
                q.give("gears.limit.sliding", limits.sliding)
            for wheel in WHEELS[: 1 if self.chosen.follows else 2]:
                q.give(ids.gear("x", wheel), float(pair.x[wheel - 1]))
            if self.chosen.a_w is not None:
                q.give("gears.a_w", self.chosen.a_w)

    def enter_mesh(self) -> None:
        """The working pressure angle from the shifts, or the shifts from the centre distance."""
        q, m, α = self.q, self.m, self.α
        z1, z2 = self.both("z")
        q.define("gears.u", z2 / z1)
        a = q.define("gears.a", m * (z1 + z2) / 2)
        inv_α = q.define("gears.inv", tan(α) - α)
        if self.chosen.follows:
            α_w = q.define("gears.alpha_w", acos(a * cos(α) / q["gears.a_w"]))
            inv_w = q.define("gears.inv_w", tan(α_w) - α_w)
            total = q.define("gears.x_sum", (inv_w - inv_α) * (z1 + z2) / (2 * tan(α)), scale=1.0)
            q.define(ids.gear("x", 2), total - q[ids.gear("x", 1)], scale=1.0)
        else:
            x1, x2 = self.both("x")
            total = q.define("gears.x_sum", x1 + x2, scale=1.0)
            inv_w = q.define("gears.inv_w", inv_α + 2 * total * tan(α) / (z1 + z2))
            α_w = q.define("gears.alpha_w", arcinv(inv_w))
            q.define("gears.a_w", a * cos(α) / cos(α_w))
        y = q.define("gears.y", (q["gears.a_w"] - a) / m, scale=1.0)
        q.define("gears.dy", total - y, scale=1.0)
        q.define("gears.h", m * (2 * self.ha + self.c - q["gears.dy"]))
        p = q.define("gears.p", PI * m)
        q.define("gears.p_b", p * cos(α))

    def enter_wheel(self, wheel: int) -> None:
        q, m, α, ha = self.q, self.m, self.α, self.ha
        z, x = q[ids.gear("z", wheel)], q[ids.gear("x", wheel)]

        def define(quantity: str, definition: Operand, **traits: float) -> Ref:
            return q.define(ids.gear(quantity, wheel), definition, **traits)

        define("x_min", ha - z * sin(α) ** 2 / 2, scale=1.0)
        d = define("d", m * z)
        d_b = define("d_b", d * cos(α))
        d_w = define("d_w", d_b / cos(q["gears.alpha_w"]))
        h_a = define("h_a", m * (ha + x - q["gears.dy"]), scale=self.pair.m)
        d_a = define("d_a", d + 2 * h_a)
        define("d_f", d - 2 * m * (ha + self.c - x))
        s = define("s", m * (PI / 2 + 2 * x * tan(α)))
        define("s_w", d_w * (s / d + q["gears.inv"] - q["gears.inv_w"]))
        α_a = define("alpha_a", acos(d_b / d_a))
        define("inv_a", tan(α_a) - α_a)
        s_a = define("s_a", d_a * (s / d + q["gears.inv"] - q[ids.gear("inv_a", wheel)]), scale=self.pair.m)
        q.define(ids.gear("tip", wheel), s_a / m, Symbol("s", f"a{wheel}", "*"), scale=1.0)

    def enter_contact(self) -> None:
        """Contact ratio, line of action, and how much of each flank is in use."""
        q, α, m = self.q, self.α, self.m
        (z1, z2), α_w = self.both("z"), q["gears.alpha_w"]
        over = [tan(one) - tan(α_w) for one in self.both("alpha_a")]
        ε = q.define("gears.epsilon", (z1 * over[0] + z2 * over[1]) / (2 * PI))
        g = q.define("gears.g", q["gears.a_w"] * sin(α_w))
        q.define("gears.g_a", ε * q["gears.p_b"])
        d_b, α_a, x, d = (self.both(one) for one in ("d_b", "alpha_a", "x", "d"))
        tips = [q.define(ids.gear("rho_a", i + 1), d_b[i] * tan(α_a[i]) / 2, scale=self.pair.m) for i in (0, 1)]
        for i in (0, 1):
            q.define(ids.gear("rho_p", i + 1), g - tips[1 - i], scale=self.pair.m)
            grind = d[i] * sin(α) / 2 - (self.ha - x[i]) * m / sin(α)
            q.define(ids.gear("rho_f", i + 1), grind, scale=self.pair.m)

    def enter_sliding(self) -> None:
        q = self.q
        share = q.give("gears.t", np.arange(POINTS) / (POINTS - 1))
        start, end = q[ids.gear("rho_p", 1)], q[ids.gear("rho_a", 1)]
        ρ1 = q.define(ids.gear("rho", 1), start + share * (end - start))
        ρ2 = q.define(ids.gear("rho", 2), q["gears.g"] - ρ1)
        u = q["gears.u"]
        q.define(ids.gear("lambda", 1), 1 - ρ2 / (u * ρ1), scale=1.0)
        q.define(ids.gear("lambda", 2), 1 - u * ρ1 / ρ2, scale=1.0)


# --- what is often done in place of it --------------------------------------------------------------


def _changed(sheet: Sheet) -> Mapping[str, list[tuple[str, Expression]]]:
    """Definitions that are often used in place of the right ones."""
    found: dict[str, list[tuple[str, Expression]]] = {}

    def also(name: str, id: str, other: Expression) -> None:
        if other != sheet.families[id].definition:
            found.setdefault(id, []).append((name, other))

    def exchanged(name: str, change: Mapping[str, Operand], *among: str) -> None:
        for id in among:
            definition = sheet.families[id].definition
            if definition is not None:
                also(name, id, substitute(definition, lambda ref: as_expression(change.get(ref.id, ref))))

    angles = {"gears.inv": "gears.alpha", **{ids.gear("inv_a", wheel): ids.gear("alpha_a", wheel) for wheel in WHEELS}}
    if "gears.alpha_w" in refs(sheet.families["gears.inv_w"].definition or Ref("")):
        angles["gears.inv_w"] = "gears.alpha_w"
    for id, angle in angles.items():
        also("gear-degrees", id, tan(Ref(angle)) - 180 * Ref(angle) / PI)
    exchanged("gear-standard-angle", {"gears.alpha_w": Ref("gears.alpha")}, "gears.epsilon", "gears.g")
    exchanged("gear-ratio", {"gears.u": 1 / Ref("gears.u")}, *(ids.gear("lambda", wheel) for wheel in WHEELS))
    for wheel in WHEELS:
        x, d, d_b = (ids.gear(one, wheel) for one in ("x", "d", "d_b"))
        named = {one: ids.gear(one, wheel) for one in ("h_a", "d_f", "s", "alpha_a", "rho_a", "d_w", "rho_f")}
        exchanged("gear-shift-sign", {x: -Ref(x)}, named["h_a"], named["d_f"], named["s"], named["rho_f"])
        exchanged("gear-base-circle", {d_b: Ref(d)}, named["alpha_a"], named["rho_a"], named["d_w"])
        exchanged("gear-truncation", {"gears.dy": 0.0}, named["h_a"])
    exchanged("gear-truncation", {"gears.dy": 0.0}, "gears.h")
    return found
