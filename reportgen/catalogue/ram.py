"""The shaper's ram, driven by a slotted lever through a link: geometry, closed formulas, its stroke.

A crank centre, B pin, C pivot of the lever, D its end, E ram.  x runs against the way the ram works, y from C
to A, φ are angles from x, a = l_AC, b the height of the ram's line over C, S = CB.  From the two closed loops
S cos φ₃ = l₁ cos φ₁, S sin φ₃ = a + l₁ sin φ₁, l₃ sin φ₃ + l₄ sin φ₄ = b, x_E = l₃ cos φ₃ + l₄ cos φ₄:
ω₃, v_r = Ṡ and ε₃ as in `slotted`;  ω₄ = −ω₃l₃ cos φ₃/(l₄ cos φ₄);
v_E = −(ω₃l₃ sin φ₃ + ω₄l₄ sin φ₄);
ε₄ = l₃(ω₃² sin φ₃ − ε₃ cos φ₃)/(l₄ cos φ₄) + ω₄² tan φ₄;
a_Dx = −l₃(ε₃ sin φ₃ + ω₃² cos φ₃);  a_E = a_Dx − l₄(ε₄ sin φ₄ + ω₄² cos φ₄).
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from reportgen.catalogue import slotted
from reportgen.catalogue.course import Course
from reportgen.catalogue.laws import MotionAt
from reportgen.catalogue.machine import Item
from reportgen.catalogue.slotted import FULL_TURN, ROUND, Floats, SlottedCrank, angle_item, formula, scaled
from reportgen.cycle.applied import Cutting
from reportgen.mechanism.motion import Motion
from reportgen.mechanism.structure import Dyad, Guide, Inertia, Linkage, LinkPoint
from reportgen.notation.expressions import (
    Chain,
    Expression,
    Number,
    Symbol,
    add,
    call,
    divide,
    multiply,
    negative,
    power,
    subtract,
)


@dataclass(frozen=True, slots=True)
class Ram:
    """The lever's crank, and of lengths (m) the lever's, the link's and the height of the ram's line over C."""

    crank: SlottedCrank
    lever: float
    link: float
    height: float

    @property
    def beginning(self) -> float:
        """φ₁ at which the working stroke begins: −θ, the crank square to the lever."""
        return -self.crank.half_swing

    def end(self, side: int) -> complex:
        """Where E stands at the beginning (+1) or the end (−1) of the working stroke, from A on the drawing."""
        theta = self.crank.half_swing
        rise = (self.height - self.lever * math.cos(theta)) / self.link
        along = side * self.lever * math.sin(theta) - self.link * math.sqrt(1 - rise**2)
        return self.crank.place(complex(along, self.height - self.crank.d))

    def course(self, start: float) -> Course:
        """The ram's way from the beginning of its working stroke, for a machine that starts at φ₁ = `start`."""
        return Course(
            link=5,
            rod=4,
            pin="E",
            crank_pin="D",
            top=self.end(1),
            bottom=self.end(-1),
            top_angle=0.0,
            bottom_angle=math.pi + 2 * self.crank.half_swing,
            phase=(start - self.beginning + ROUND) % FULL_TURN - ROUND,
        )

    def linkage(self, points: Sequence[LinkPoint], inertias: Sequence[Inertia], gravity: float) -> Linkage:
        """The mechanism; the ram's guide points against its working way, E lies on the working side of D."""
        towards = self.crank.place(1 + 0j)
        guide = Guide(
            self.crank.place(1j * (self.height - self.crank.d)), math.atan2(towards.imag, towards.real)
        )
        return Linkage(
            ground=self.crank.ground,
            driver=self.crank.driver,
            dyads=(self.crank.group, Dyad("RRP", (4, 5), "D", "E", guide, (self.link, 0.0), -1)),
            points=(LinkPoint("D", 3, complex(self.lever)), *points),
            inertias=tuple(inertias),
            gravity=-1j * gravity,
        )


@dataclass(frozen=True)
class CuttingLaw:
    """The cutting force on the ram over the machine's cycle angles."""

    course: Course
    cutting: Cutting

    def value(self, angle: Floats, motion: Motion) -> Floats:
        return self.cutting.at(self.course.phase + angle, self.course.fraction(motion))

    def breaks(self, motion_at: MotionAt) -> Iterable[float]:
        course = self.course

        def share(angle: Floats) -> Floats:
            order = np.argsort(angle)
            result = np.empty_like(angle)
            result[order] = course.fraction(motion_at(angle[order] - course.phase))
            return result

        return (corner - course.phase for corner in self.cutting.breaks(share))


# --- closed formulas ------------------------------------------------------------------------------

L1, L3, L4 = "l.AB", "l.CD", "l.DE"


def formulas(angle: Floats, speed: float, crank: float) -> tuple[Item, ...]:
    """The closed formulas at φ₁ = `angle` [N] for a crank (m) at a speed (rad/s).

    Uses `l.AB`, `l.CD`, `l.DE`, `a`, `b`, `omega.1`.  Ids: `phi.A`, those of
    `slotted.lever`, `phi.3`, `phi.4`, `f.x.E`, `f.omega.4`, `f.v.E`, `f.eps.4`, `f.a.Dx`, `f.a.E`.
    """
    items = (*slotted.lever(L1, "a"), *_places(), *_velocities(), *_accelerations())
    return (angle_item(angle), *scaled(items, speed, crank))


def _sin(link: int) -> Expression:
    return call("sin", "phi.A" if link == 1 else f"phi.{link}")


def _cos(link: int) -> Expression:
    return call("cos", "phi.A" if link == 1 else f"phi.{link}")


def _places() -> tuple[Item, ...]:
    half = Number(180.0, unit="°")
    rise = divide(subtract("b", multiply(L3, _sin(3))), L4)
    return (
        formula("phi.3", Symbol("φ", "3"), "angle", call("arccos", divide(multiply(L1, _cos(1)), "f.S"))),
        formula("phi.4", Symbol("φ", "4"), "angle", subtract(half, call("arcsin", rise))),
        formula("f.x.E", Symbol("x", "E"), "length", add(multiply(L3, _cos(3)), multiply(L4, _cos(4)))),
    )


def _velocities() -> tuple[Item, ...]:
    w3, w4 = "f.omega.3", "f.omega.4"
    along_x = add(multiply(w3, L3, _sin(3)), multiply(w4, L4, _sin(4)))
    return (
        formula(
            w4,
            Symbol("ω", "4"),
            "angular velocity",
            negative(divide(multiply(w3, L3, _cos(3)), multiply(L4, _cos(4)))),
        ),
        formula("f.v.E", Symbol("v", "E"), "velocity", negative(along_x)),
    )


def _accelerations() -> tuple[Item, ...]:
    """That of D along x first: a_E = a_Dx − l₄(ε₄ sin φ₄ + ω₄² cos φ₄)."""
    w3, w4, e3, e4, x = "f.omega.3", "f.omega.4", "f.eps.3", "f.eps.4", "f.a.Dx"
    square3, square4 = power(w3, 2), power(w4, 2)
    turned = subtract(multiply(square3, _sin(3)), multiply(e3, _cos(3)))
    turning = add(
        divide(multiply(L3, turned), multiply(L4, _cos(4))), multiply(square4, call("tan", "phi.4"))
    )
    carried = negative(multiply(L3, add(multiply(e3, _sin(3)), multiply(square3, _cos(3)))))
    along = subtract(x, multiply(L4, add(multiply(e4, _sin(4)), multiply(square4, _cos(4)))))
    return (
        formula(e4, Symbol("ε", "4"), "angular acceleration", turning),
        formula(x, Symbol("a", "Dx"), "acceleration", carried),
        formula("f.a.E", Symbol("a", "E"), "acceleration", along),
    )


COMPARED = (
    *((plan, f"f.{plan}") for plan in ("omega.3", "omega.4", "v.E", "eps.3", "eps.4", "a.E")),
    ("v.B3B", "f.v.r"),
)
"""Plan quantities and the closed formulas that must give the same sizes."""


# --- the equations they are solved from -------------------------------------------------------------


def equations() -> dict[str, tuple[Chain, ...]]:
    """Both closed loops by components, and their first and second derivatives."""
    third, fourth = Symbol("φ", "3"), Symbol("φ", "4")
    l1, l3, l4 = (Symbol("l", str(link)) for link in (1, 3, 4))
    w3, w4, e3, e4 = Symbol("ω", "3"), Symbol("ω", "4"), Symbol("ε", "3"), Symbol("ε", "4")
    sin3, cos3, sin4, cos4 = call("sin", third), call("cos", third), call("sin", fourth), call("cos", fourth)
    square3, square4, nothing = power(w3, 2), power(w4, 2), Number(0.0)
    along = (
        multiply(e3, l3, sin3),
        multiply(square3, l3, cos3),
        multiply(e4, l4, sin4),
        multiply(square4, l4, cos4),
    )
    across = (
        multiply(e3, l3, cos3),
        negative(multiply(square3, l3, sin3)),
        multiply(e4, l4, cos4),
        negative(multiply(square4, l4, sin4)),
    )
    triangle = slotted.equations(l1, Symbol("a"))
    return {
        "closure": (
            *triangle["closure"],
            Chain((Symbol("x", "E"), add(multiply(l3, cos3), multiply(l4, cos4)))),
            Chain((add(multiply(l3, sin3), multiply(l4, sin4)), Symbol("b"))),
        ),
        "between": triangle["between"],
        "velocity": (
            *triangle["velocity"],
            Chain((Symbol("v", "E"), negative(add(multiply(w3, l3, sin3), multiply(w4, l4, sin4))))),
            Chain((add(multiply(w3, l3, cos3), multiply(w4, l4, cos4)), nothing)),
        ),
        "acceleration": (
            *triangle["acceleration"],
            Chain((Symbol("a", "E"), negative(add(*along)))),
            Chain((add(*across), nothing)),
        ),
    }
