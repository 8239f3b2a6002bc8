"""A crank whose pin drives a lever through a block in the lever's slot.  A crank centre, B pin, C pivot.

Own axes: y runs from C to A, x is y turned by 90° against the rotation, so that ω₁ > 0 turns x towards y.
φ is the crank's angle from x, r = l_AB, d = l_AC, S = CB; a is square to the slot, r along it:
S² = d² + r² + 2dr sin φ;  ω₃ = ω₁r(r + d sin φ)/S²;  v_r = ω₁dr cos φ/S;
ε₃ = ω₁²dr(d² − r²) cos φ/S⁴;  a_r = ω₃²S − ω₁²r(r + d sin φ)/S;  aᵏ = 2ω₃v_r.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from reportgen.catalogue.machine import Item
from reportgen.mechanism.structure import Crank, Dyad
from reportgen.notation.expressions import (
    Chain,
    Expression,
    Number,
    Root,
    Symbol,
    add,
    call,
    divide,
    multiply,
    negative,
    power,
    subtract,
)

Floats = NDArray[np.float64]
FULL_TURN = 2 * math.pi
ROUND = 1e-12

DRAWN_CRANKS = (0.05, 0.04, 0.03, 0.025, 0.02, 0.015)
"""Drawn lengths of a crank (m on paper), the best first."""
HIGHEST = 0.165
"""A mechanism is drawn no higher than this (m on paper), so that its plans stay on the page."""


@dataclass(frozen=True, slots=True)
class SlottedCrank:
    """Crank r about A, lever about C at the distance d below A (m); `axis` is the direction from C to A (rad)."""

    r: float
    d: float
    axis: float
    turn: int

    @property
    def swings(self) -> bool:
        """Whether the lever swings to and fro, r < d; with r > d it turns right round."""
        return self.r < self.d

    @property
    def half_swing(self) -> float:
        """θ = arcsin(r/d), the lever's greatest angle from CA (rad); there the crank is square to it."""
        return math.asin(self.r / self.d)

    def place(self, own: complex) -> complex:
        """A point of the own axes, seen from A, on the drawing."""
        up = cmath.exp(1j * self.axis)
        return -1j * self.turn * up * own.real + up * own.imag

    def crank_angle(self, phi: float) -> float:
        """The crank's angle from +x of the drawing."""
        return self.axis + self.turn * (phi - math.pi / 2)

    def phi(self, crank_angle: float) -> float:
        """φ of a crank's angle from +x of the drawing."""
        return math.pi / 2 + self.turn * (crank_angle - self.axis)

    @property
    def ground(self) -> dict[str, complex]:
        return {"A": 0j, "C": self.place(-1j * self.d)}

    @property
    def driver(self) -> Crank:
        return Crank("A", "B", self.r)

    @property
    def group(self) -> Dyad:
        """Block 2 on the pin B, lever 3 on C; B3 is the lever's point under the pin."""
        return Dyad("RPR", (2, 3), "B", "B3", "C")


def whole_degrees(angle: Floats) -> bool:
    """Whether all angles are whole hundredths of a degree, to be printed as they are."""
    hundredths = np.degrees(angle) * 100
    return bool(np.allclose(hundredths, np.round(hundredths), rtol=0, atol=1e-7))


def angle_item(angle: Floats) -> Item:
    """`phi.A`, the crank's angle φ₁ within one turn [N]."""
    turned = np.mod(angle + ROUND, FULL_TURN) - ROUND
    return Item(
        "phi.A", Symbol("φ", "1"), "angle", turned, traits={"exact": whole_degrees(turned), "scale": 1.0}
    )


def drawn_crank(crank: float, height: float) -> float:
    """The drawn length of a crank (m on paper) with which what is `height` (m) high stays on the page."""
    return next((drawn for drawn in DRAWN_CRANKS if drawn * height / crank <= HIGHEST), DRAWN_CRANKS[-1])


def lever(crank: str, centres: str) -> tuple[Item, ...]:
    """`f.S`, `f.omega.3`, `f.v.r`, `f.eps.3`; uses the lengths r, d of these ids, `phi.A` and `omega.1`."""
    r, d, w1, reach = crank, centres, "omega.1", "f.S"
    sin, cos = call("sin", "phi.A"), call("cos", "phi.A")
    square = add(power(d, 2), power(r, 2), multiply(2, d, r, sin))
    arm = multiply(w1, r, add(r, multiply(d, sin)))
    turned = multiply(power(w1, 2), d, r, subtract(power(d, 2), power(r, 2)), cos)
    return (
        formula(reach, Symbol("S"), "length", Root(square)),
        formula("f.omega.3", Symbol("ω", "3"), "angular velocity", divide(arm, square)),
        formula("f.v.r", Symbol("v", "r"), "velocity", divide(multiply(w1, d, r, cos), reach)),
        formula("f.eps.3", Symbol("ε", "3"), "angular acceleration", divide(turned, power(square, 2))),
    )


def formulas(angle: Floats, speed: float, crank: float) -> tuple[Item, ...]:
    """The closed formulas at φ = `angle` [N] for a crank (m) at a speed (rad/s).

    Uses `l.AB`, `l.AC`, `l.CD`, `omega.1`.  Ids: `phi.A`, those of `lever`, `f.v.D`, `f.a.k`, `f.a.r`,
    `f.a.D.n`, `f.a.D.t`, `f.a.D`.
    """
    r, d, w1, w3, reach = "l.AB", "l.AC", "omega.1", "f.omega.3", "f.S"
    arm = multiply(r, add(r, multiply(d, call("sin", "phi.A"))))
    sliding = subtract(multiply(power(w3, 2), reach), divide(multiply(power(w1, 2), arm), reach))
    items = (
        *lever(r, d),
        formula("f.v.D", Symbol("v", "D"), "velocity", multiply(w3, "l.CD")),
        formula("f.a.k", Symbol("a", "k"), "acceleration", multiply(2, w3, "f.v.r")),
        formula("f.a.r", Symbol("a", "r"), "acceleration", sliding),
        formula("f.a.D.n", Symbol("a", "D", "n"), "acceleration", multiply(power(w3, 2), "l.CD")),
        formula("f.a.D.t", Symbol("a", "D", "τ"), "acceleration", multiply("f.eps.3", "l.CD")),
        formula(
            "f.a.D", Symbol("a", "D"), "acceleration", Root(add(power("f.a.D.n", 2), power("f.a.D.t", 2)))
        ),
    )
    return (angle_item(angle), *scaled(items, speed, crank))


def swing_items(sine: Expression) -> tuple[Item, ...]:
    """The lever's greatest angle θ from CA by its sine, and the ratio K = (180° + 2θ)/(180° − 2θ) of the
    crank's turns for the lever's two ways."""
    half = Number(180.0, unit="°")
    twice = multiply(2, "theta")
    return (
        Item("theta", Symbol("θ"), "angle", definition=call("arcsin", sine)),
        Item("K", Symbol("K"), "ratio", definition=divide(add(half, twice), subtract(half, twice))),
    )


COMPARED = (
    *((plan, f"f.{plan}") for plan in ("omega.3", "v.D", "eps.3", "a.D")),
    ("v.B3B", "f.v.r"),
    ("a.B3B.k", "f.a.k"),
    ("a.B3B.r", "f.a.r"),
)
"""Plan quantities and the closed formulas that must give the same sizes."""


def formula(id: str, symbol: Symbol, kind: str, definition: Expression) -> Item:
    """A quantity by its closed formula."""
    return Item(id, symbol, kind, definition=definition)


def scaled(items: Iterable[Item], speed: float, crank: float) -> tuple[Item, ...]:
    """The items with what is natural to a crank (m) at a speed (rad/s): a billionth of it prints as 0."""
    natural = {
        "length": crank,
        "velocity": speed * crank,
        "acceleration": speed**2 * crank,
        "angular velocity": speed,
        "angular acceleration": speed**2,
    }
    return tuple(
        replace(one, traits={"scale": natural[one.kind]}) if one.kind in natural else one for one in items
    )


def equations(r: Symbol, d: Symbol) -> dict[str, tuple[Chain, ...]]:
    """The triangle ABC on x and y, along and across the lever, and what its derivatives say of the lever."""
    reach, first, third = Symbol("S"), Symbol("φ", "1"), Symbol("φ", "3")
    w1, w3, slide, between = Symbol("ω", "1"), Symbol("ω", "3"), Symbol("v", "r"), subtract(first, third)
    turned = add(multiply(reach, Symbol("ε", "3")), multiply(2, slide, w3))
    return {
        "closure": (
            Chain((multiply(reach, call("cos", third)), multiply(r, call("cos", first)))),
            Chain((multiply(reach, call("sin", third)), add(d, multiply(r, call("sin", first))))),
        ),
        "between": (
            Chain((multiply(reach, call("cos", between)), add(r, multiply(d, call("sin", first))))),
            Chain((multiply(reach, call("sin", between)), negative(multiply(d, call("cos", first))))),
        ),
        "velocity": (
            Chain((multiply(reach, w3), multiply(w1, r, call("cos", between)))),
            Chain((slide, negative(multiply(w1, r, call("sin", between))))),
        ),
        "acceleration": (Chain((turned, negative(multiply(power(w1, 2), r, call("sin", between))))),),
    }
