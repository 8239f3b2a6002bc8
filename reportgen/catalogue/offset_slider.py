"""The crank and slider with an offset: geometry, linkage, closed formulas.  A crank centre, B pin, C slider.

x runs from A along the guide away from the crank, y is x turned by 90° in the direction of rotation, so
that ω₁ > 0; φ is the crank's angle from x, β the rod's, e the guide's y, r = l_AB, l = l_BC:
sin β = (e − r sin φ)/l;  x_C = r cos φ + l cos β;  ω₂ = −ω₁ r cos φ/(l cos β);
v_C = −ω₁ r sin(φ − β)/cos β;  ε₂ = (ω₁² r sin φ + ω₂² l sin β)/(l cos β);
a_C = −(ω₁² r cos(φ − β) + ω₂² l)/cos β.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from reportgen.catalogue.course import FULL_TURN, Course, Floats
from reportgen.catalogue.machine import Item
from reportgen.mechanism.structure import Crank, Dyad, Guide, Inertia, Linkage, LinkPoint
from reportgen.notation.expressions import (
    Chain,
    Expression,
    Number,
    Ref,
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

HALVINGS = 60
"""π halved so often is below the spacing of floats there."""
ROUND = 1e-12


@dataclass(frozen=True, slots=True)
class OffsetSlider:
    """Crank r and rod l (m), offset e (m, along y), the guide's direction `axis` (rad) and the rotation ±1."""

    r: float
    l: float  # noqa: E741 - the length's own letter
    e: float
    axis: float
    turn: int

    @property
    def stretched(self) -> float:
        """φ at the outer dead centre, crank and rod in line: sin φ = e/(l + r)."""
        return math.asin(self.e / (self.l + self.r))

    @property
    def folded(self) -> float:
        """φ at the inner dead centre, the rod over the crank: φ = π + arcsin(e/(l − r))."""
        return math.pi + math.asin(self.e / (self.l - self.r))

    def slider(self, reach: float) -> complex:
        """Where C stands at the distance `reach` (m) from A."""
        return self._placed(complex(math.sqrt(reach**2 - self.e**2), self.e))

    def crank_angle(self, phi: float) -> float:
        """The crank's angle from +x of the drawing."""
        return self.axis + self.turn * phi

    def phi(self, crank_angle: float) -> float:
        """φ of a crank's angle from +x of the drawing."""
        return self.turn * (crank_angle - self.axis)

    def _placed(self, own: complex) -> complex:
        return complex(own.real, self.turn * own.imag) * cmath.exp(1j * self.axis)

    def acceleration(self, phi: Floats) -> Floats:
        """a_C/ω₁² (m) [N]."""
        beta = np.arcsin((self.e - self.r * np.sin(phi)) / self.l)
        omega = -self.r * np.cos(phi) / (self.l * np.cos(beta))
        return -(self.r * np.cos(phi - beta) + omega**2 * self.l) / np.cos(beta)

    def fastest(self) -> tuple[float, float]:
        """φ of the slider's greatest speeds, inward and outward: a_C = 0, once in each stroke."""
        low = np.array([self.stretched, self.folded])
        high = np.array([self.folded, self.stretched + FULL_TURN])
        before = self.acceleration(low)
        for _ in range(HALVINGS):
            middle = (low + high) / 2
            same = before * self.acceleration(middle) > 0
            low, high = np.where(same, middle, low), np.where(same, high, middle)
        return float(low[0]), float(low[1])

    def course(self, start: float, turns: int) -> Course:
        """The way of slider 3 in a machine that starts at φ = `start` and has a cycle of `turns` turns."""
        return Course(
            link=3,
            rod=2,
            pin="C",
            crank_pin="B",
            top=self.slider(self.l + self.r),
            bottom=self.slider(self.l - self.r),
            top_angle=0.0,
            bottom_angle=self.folded - self.stretched,
            phase=(start - self.stretched + ROUND) % (turns * FULL_TURN) - ROUND,
        )

    def linkage(self, inertias: Sequence[Inertia], gravity: float, centre: float | None = None) -> Linkage:
        """The mechanism; S2 on the rod at `centre` (m) from B, if it is wanted."""
        return Linkage(
            ground={"A": 0j},
            driver=Crank("A", "B", self.r),
            dyads=(
                Dyad("RRP", (2, 3), "B", "C", Guide(self._placed(1j * self.e), self.axis), (self.l, 0.0)),
            ),
            points=() if centre is None else (LinkPoint("S2", 2, complex(centre)),),
            inertias=tuple(inertias),
            gravity=-1j * gravity,
        )


def offset_term(geometry: OffsetSlider, typed: float) -> Expression | None:
    """e in the formulas: as typed, with its sign turned, or None where there is no offset."""
    if geometry.e == 0:
        return None
    return Ref("e") if geometry.e * typed > 0 else negative("e")


def formulas(angle: Floats, offset: Expression | None, centre: bool) -> tuple[Item, ...]:
    """The closed formulas at φ = `angle` [N], of S2 too if there is a `centre`.

    Ids: `phi.3`, `beta.2`, `x.C`, `f.omega.2`, `f.v.C`, `f.eps.2`, `f.a.C`, `f.x.S2.v`, `f.y.S2.v`, `f.v.S2`,
    likewise for a.  Uses `l.AB`, `l.BC`, `l.BS2`, `omega.1`.
    """
    phi, beta, r, l = "phi.3", "beta.2", "l.AB", "l.BC"  # noqa: E741
    w1, w2, e2 = "omega.1", "f.omega.2", "f.eps.2"
    raised = multiply(r, call("sin", phi))
    turned = np.mod(angle + ROUND, FULL_TURN) - ROUND
    items = [
        Item(phi, Symbol("φ"), "angle", turned, traits={"exact": _is_round(turned), "scale": 1.0}),
        _item(
            beta,
            Symbol("β"),
            "angle",
            call("arcsin", divide(negative(raised) if offset is None else subtract(offset, raised), l)),
        ),
        _item(
            "x.C",
            Symbol("x", "C"),
            "length",
            add(multiply(r, call("cos", phi)), multiply(l, call("cos", beta))),
        ),
        _item(
            w2,
            Symbol("ω", "2"),
            "angular velocity",
            negative(divide(multiply(w1, r, call("cos", phi)), multiply(l, call("cos", beta)))),
        ),
        _item(
            "f.v.C",
            Symbol("v", "C"),
            "velocity",
            negative(divide(multiply(w1, r, call("sin", subtract(phi, beta))), call("cos", beta))),
        ),
        _item(
            e2,
            Symbol("ε", "2"),
            "angular acceleration",
            divide(
                add(multiply(power(w1, 2), raised), multiply(power(w2, 2), l, call("sin", beta))),
                multiply(l, call("cos", beta)),
            ),
        ),
        _item(
            "f.a.C",
            Symbol("a", "C"),
            "acceleration",
            negative(
                divide(
                    add(
                        multiply(power(w1, 2), r, call("cos", subtract(phi, beta))),
                        multiply(power(w2, 2), l),
                    ),
                    call("cos", beta),
                )
            ),
        ),
    ]
    return (*items, *_centre()) if centre else tuple(items)


def _centre() -> tuple[Item, ...]:
    """The mass centre S2 on BC by components."""
    phi, beta, r, s = "phi.3", "beta.2", "l.AB", "l.BS2"
    w1, w2, e2 = "omega.1", "f.omega.2", "f.eps.2"
    cos, sin = call("cos", beta), call("sin", beta)
    pin_cos, pin_sin = multiply(r, call("cos", phi)), multiply(r, call("sin", phi))
    v_x = negative(add(multiply(w1, pin_sin), multiply(w2, s, sin)))
    v_y = add(multiply(w1, pin_cos), multiply(w2, s, cos))
    a_x = negative(
        add(multiply(power(w1, 2), pin_cos), multiply(s, add(multiply(e2, sin), multiply(power(w2, 2), cos))))
    )
    a_y = subtract(
        multiply(s, subtract(multiply(e2, cos), multiply(power(w2, 2), sin))), multiply(power(w1, 2), pin_sin)
    )
    return (*_components("v", "velocity", v_x, v_y), *_components("a", "acceleration", a_x, a_y))


def _components(what: str, kind: str, x: Expression, y: Expression) -> tuple[Item, ...]:
    along, across = f"f.x.S2.{what}", f"f.y.S2.{what}"
    size = Root(add(power(along, 2), power(across, 2)))
    return (
        _item(along, Symbol(what, "S2x"), kind, x),
        _item(across, Symbol(what, "S2y"), kind, y),
        Item(f"f.{what}.S2", Symbol(what, "S2"), kind, definition=size),
    )


def _item(id: str, symbol: Symbol, kind: str, definition: Expression) -> Item:
    return Item(id, symbol, kind, definition=definition, traits={"scale": 1.0})


def equations(offset: bool) -> dict[str, tuple[Chain, ...]]:
    """The closed loop of the links by components, and its first and second derivatives."""
    r, l, e = Symbol("l", "AB"), Symbol("l", "BC"), Symbol("e")  # noqa: E741
    w1, w2, e2 = Symbol("ω", "1"), Symbol("ω", "2"), Symbol("ε", "2")
    sin1, cos1 = call("sin", Symbol("φ")), call("cos", Symbol("φ"))
    sin2, cos2 = call("sin", Symbol("β")), call("cos", Symbol("β"))
    nothing = Number(0.0)
    closure = (
        Chain((add(multiply(r, cos1), multiply(l, cos2)), Symbol("x", "C"))),
        Chain((add(multiply(r, sin1), multiply(l, sin2)), e if offset else nothing)),
    )
    first = (
        Chain((subtract(negative(multiply(w1, r, sin1)), multiply(w2, l, sin2)), Symbol("v", "C"))),
        Chain((add(multiply(w1, r, cos1), multiply(w2, l, cos2)), nothing)),
    )
    square1, square2 = power(w1, 2), power(w2, 2)
    second = (
        Chain(
            (
                subtract(
                    negative(multiply(square1, r, cos1)), multiply(e2, l, sin2), multiply(square2, l, cos2)
                ),
                Symbol("a", "C"),
            )
        ),
        Chain(
            (
                add(
                    negative(multiply(square1, r, sin1)),
                    multiply(e2, l, cos2),
                    negative(multiply(square2, l, sin2)),
                ),
                nothing,
            )
        ),
    )
    return {"closure": closure, "velocity": first, "acceleration": second}


def compared(centre: bool) -> tuple[tuple[str, str], ...]:
    """Plan quantities and the closed formulas that must give the same sizes."""
    plans = ("v.C", "omega.2", "a.C", "eps.2", *(("v.S2", "a.S2") if centre else ()))
    return tuple((plan, f"f.{plan}") for plan in plans)


def _is_round(angle: Floats) -> bool:
    """Whether all angles are whole hundredths of a degree, to be printed as they are."""
    hundredths = np.degrees(angle) * 100
    return bool(np.allclose(hundredths, np.round(hundredths), rtol=0, atol=1e-7))
