"""`SolvedPair`: a gear pair as a ledger, with every number under its id as the report prints it.

The points of the active path of contact at which sliding is computed are its positions.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from reportgen.case import Misconceptions, with_another
from reportgen.case.design_case import DesignCase
from reportgen.formula import PI, Expression, Operand, Ref, refs, tan
from reportgen.formula.calculation import Calculation
from reportgen.formula.vocabulary import KeyChapter
from reportgen.gears import gears_ids
from reportgen.gears.pair_formulas import WHEELS, PairFormulas, named
from reportgen.gears.pair_shifts import Chosen, GearPair, PairLimits

POINTS = 9
"""Number of points at which sliding is computed, equally spaced from end to end of the active path."""
MESH = ("u", "a", "inv", "inv_w", "alpha_w", "x_sum", "x.2", "a_w", "y", "dy", "h", "p", "p_b")
"""Quantities that the report prints for the pair in mesh,"""
DIMENSIONS = ("d", "d_b", "d_w", "h_a", "d_a", "d_f", "s", "s_w", "alpha_a", "inv_a", "s_a", "tip")
"""for each wheel,"""
OF_BOTH = {"undercut": ("x_min",), "contact": ("rho_a", "rho_p"), "fillets": ("rho_f",), "sliding": ("rho", "lambda")}
"""and for both wheels together."""
ALIKE = ("x_min", *DIMENSIONS, "rho_a", "rho_p", "rho_f", "lambda")
"""Quantities of both wheels that share their decimals; ρ₂ = g − ρ₁ continues from the other wheel's."""


@dataclass(frozen=True)
class SolvedPair(DesignCase):
    """An assignment of a gear pair with its ledger; each value is computed on first use."""

    SAME = tuple(tuple(gears_ids.of_wheel(one, wheel) for wheel in WHEELS) for one in ALIKE)

    @cached_property
    def chosen(self) -> Chosen:
        chosen: Chosen = self.assignment.parameters.chosen
        return chosen

    @property
    def gears(self) -> GearPair:
        return self.chosen.pair

    @cached_property
    def calculation(self) -> Calculation:
        return PairCalculation(self.chosen).q

    @property
    def worked(self) -> tuple[int, ...]:
        """Return the points worked out in full: the ends of the path, where the wheels slide most."""
        return (1, POINTS)

    @cached_property
    def misconceptions(self) -> Misconceptions:
        return Misconceptions(
            changed=_changed(self.calculation), alternatives=_alternative_definitions(self.chosen.follows)
        )


class PairCalculation(PairFormulas):
    """The calculation of a pair while it is filled."""

    def __init__(self, chosen: Chosen) -> None:
        pair, limits = chosen.pair, chosen.limits
        super().__init__(Calculation(POINTS), pair.m, chosen.follows)
        with self.q.within(KeyChapter.data):
            self.enter_data(pair.rack, pair.teeth)
            self.enter_limits(limits)
            self.enter_shifts((float(pair.x[0]), float(pair.x[1])), chosen.a_w)
        with self.q.within(KeyChapter.geometry):
            self.enter_pair()
        with self.q.within(KeyChapter.velocity):
            self.enter_contact()
        with self.q.within(KeyChapter.acceleration):
            self.enter_sliding(np.arange(POINTS) / (POINTS - 1))
        self.set_out()

    def enter_limits(self, limits: PairLimits) -> None:
        self.give("limit.epsilon", limits.epsilon)
        self.give("limit.tip", limits.tip)
        if limits.sliding is not None:
            self.give("limit.sliding", limits.sliding)

    def set_out(self) -> None:
        self.q.set_out("mesh", *(f"gears.{one}" for one in MESH))
        for name, wheel in zip(("pinion", "wheel"), WHEELS, strict=True):
            self.q.set_out(name, *(gears_ids.of_wheel(one, wheel) for one in DIMENSIONS))
        self.q.set_out("contact", "gears.epsilon", "gears.g", "gears.g_a")
        for name, among in OF_BOTH.items():
            self.q.set_out(name, *(gears_ids.of_wheel(one, wheel) for one in among for wheel in WHEELS))


# --- common mistakes ------------------------------------------------------------------------


def _changed(sheet: Calculation) -> Mapping[str, list[tuple[str, Expression]]]:
    """Return the mistaken definitions that students often use, by id."""
    definitions: dict[str, list[tuple[str, Expression]]] = {}
    angles = {named("inv", 0): named("alpha", 0), **{named("inv_a", one): named("alpha_a", one) for one in WHEELS}}
    if "gears.alpha_w" in refs(sheet.families["gears.inv_w"].definition or Ref("")):
        angles["gears.inv_w"] = "gears.alpha_w"
    for id, angle in angles.items():
        definitions[id] = [("gear-degrees", tan(Ref(angle)) - 180 * Ref(angle) / PI)]
    taken: list[tuple[str, str, Operand]] = [
        ("gear-standard-angle", "gears.alpha_w", Ref("gears.alpha")),
        ("gear-ratio", "gears.u", 1 / Ref("gears.u")),
    ]
    for wheel in WHEELS:
        x, d, d_b = (gears_ids.of_wheel(one, wheel) for one in ("x", "d", "d_b"))
        taken += [("gear-shift-sign", x, -Ref(x)), ("gear-base-circle", d_b, Ref(d))]
    taken.append(("gear-truncation", "gears.dy", 0.0))
    for name, id, replacement in taken:
        for where, definition in with_another(sheet.families, {id: replacement}):
            definitions.setdefault(where, []).append((name, definition))
    return definitions


def _alternative_definitions(follows: bool) -> Mapping[str, list[Expression]]:
    """Return alternative definitions that are equally right, from the centre distance and the radii of curvature, by
    id.
    """
    a, a_w, m, g, p_b = (Ref(f"gears.{one}") for one in ("a", "a_w", "m", "g", "p_b"))
    z1, z2 = (Ref(gears_ids.of_wheel("z", wheel)) for wheel in WHEELS)
    path = Ref(gears_ids.of_wheel("rho_a", 1)) + Ref(gears_ids.of_wheel("rho_a", 2)) - g
    alternatives: dict[str, list[Expression]] = {"gears.epsilon": [path / p_b], "gears.g_a": [path]}
    if not follows:
        alternatives["gears.y"] = [(a_w - a) / m]
    for wheel, z in zip(WHEELS, (z1, z2), strict=True):
        alternatives[gears_ids.of_wheel("d_w", wheel)] = [2 * a_w * z / (z1 + z2)]
    return alternatives
