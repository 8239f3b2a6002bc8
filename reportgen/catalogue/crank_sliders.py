"""Crank and slider: geometry, linkage and closed formulas, with the guide through the crank centre or beside it.

ω₂, ε₂ are positive anticlockwise in all formulas: with a `turn` of ±1, the crank's rotation, φ̇ = ω₁ is turned so.

Centred, φ the crank's angle from the slider's outer dead centre in the direction of rotation, β the rod's angle to the
axis, λ = R/L; x, v, a count from the dead centre towards the crank; β grows as the rod turns against the crank.

With an offset e: A crank centre, B pin, C slider; x runs from A along the guide away from the crank, y is x turned by
90° in the direction of rotation, so that ω₁ > 0; φ is the crank's angle from x, β the rod's, r = l_AB, l = l_BC.

The second rod of a V engine hangs on a joint at (x, y), y along the main cylinder's axis away from the crank and x to
the side to which the crank turns from its top; h is the joint's distance from the second axis, at δ from the first.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterable, Sequence
from functools import partial

import numpy as np

from reportgen.base.arrays import Floats
from reportgen.base.records import Record
from reportgen.catalogue.given_data import accelerated, accelerating, driver_acceleration
from reportgen.formula import (
    Chain,
    Expression,
    Number,
    Ref,
    Symbol,
    asin,
    atan,
    atan2,
    cos,
    ids,
    minus,
    plus,
    signed,
    sin,
    sqrt,
    tan,
    times,
)
from reportgen.formula.calculation import BELOW_A_TURN, Calculation
from reportgen.machine import Crank, Dyad, Guide, Inertia, Linkage, LinkPoint
from reportgen.machine.load_laws import FULL_TURN, Stroke, halved

HALVINGS = 60
"""π halved so often is below the spacing of floats there."""


def compared(plans: Iterable[str]) -> tuple[tuple[str, str], ...]:
    """Return plan quantities and the closed formulas that must give the same sizes."""
    return tuple((plan, ids.formula(plan)) for plan in plans)


# --- centred --------------------------------------------------------------------------------------


def centred_slider(
    q: Calculation,
    turn: int,
    rod: int,
    slider: int,
    joint: str,
    angle: Floats,
    along: str = "",
    centre: str = "",
    axes: str = "xy",
) -> None:
    """Enter the closed formulas at φ = `angle` [N] of a slider whose pin is `joint`; uses R, L, lambda, omega.1.

    Enters `phi.3`, `beta.2`, `x.3`, `f.v.B`, `f.a.B`, `f.omega.2`, `f.eps.2`, and of a point `centre` on the rod,
    at the length of id `along` from the crank pin, the components along the `axes`, `f.v.S2`, `f.a.S2`.
    """
    R, L, λ, ω1 = q["R"], q["L"], q["lambda"], q["omega.1"]
    line = partial(q.define, scale=1.0)
    φ = q.angle(ids.angle(slider), angle)
    β = line(ids.inclination(rod), asin(λ * sin(φ)))
    distance = R * (1 - cos(φ)) + L * (1 - cos(β))
    s_B = q.define(ids.slider_way(slider), distance, Symbol("s", joint), "length", scale=0.01)
    v = line(ids.formula_velocity(joint), ω1 * R * sin(φ + β) / cos(β))
    ω2 = line(ids.formula_angular_velocity(rod), signed(-turn, ω1 * λ * cos(φ) / cos(β)))
    evenly = ω1**2 * R * (cos(φ + β) / cos(β) + λ * cos(φ) ** 2 / cos(β) ** 3)
    a = line(ids.formula_acceleration(joint), accelerated(q, turn, evenly, v))
    evenly = signed(turn, ω1**2 * λ * (1 - λ**2) * sin(φ) / cos(β) ** 3)
    ε2 = line(ids.formula_angular_acceleration(rod), accelerated(q, turn, evenly, ω2))
    velocity, acceleration = f"velocity_{slider}", f"acceleration_{slider}"
    q.set_out(velocity, β, s_B, v, ω2)
    q.set_out(acceleration, a, ε2)
    if centre:
        s = q[along]
        v_y = -(ω1 * R * sin(φ) + signed(-turn, s * ω2 * sin(β)))
        q.set_out(velocity, *components(q, "v", centre, (1 - s / L) * ω1 * R * cos(φ), v_y, axes=axes))
        # ε₂ has its own share of ε₁ already, the pin's is ε₁R square to the crank.
        ε1 = driver_acceleration(q, turn)
        a_y = plus(
            -(ω1**2 * R * cos(φ) + s * (ω2**2 * cos(β) + signed(-turn, ε2 * sin(β)))), minus(times(ε1, R, sin(φ)))
        )
        a_x = plus(-((1 - s / L) * ω1**2 * R * sin(φ)), times(ε1, 1 - s / L, R, cos(φ)))
        q.set_out(acceleration, *components(q, "a", centre, a_x, a_y, axes=axes))


def components(
    q: Calculation, what: str, point: str, x: Expression, y: Expression, *, axes: str = "xy"
) -> tuple[Ref, Ref, Ref]:
    """Return the velocity or acceleration of a point by its components along axes of these letters, and its size."""
    kind = {"v": "velocity", "a": "acceleration"}[what]
    along = q.define(ids.formula_component("x", point, what), x, Symbol(what, point + axes[0]), kind, scale=1.0)
    across = q.define(ids.formula_component("y", point, what), y, Symbol(what, point + axes[1]), kind, scale=1.0)
    return along, across, q.define(ids.formula(ids.POINT_RATE[what](point)), sqrt(along**2 + across**2))


def arm_of(q: Calculation, start: str, name: str, φ: Expression, turn: int) -> tuple[Expression, Expression]:
    """Return the distance (m) of a rod's point from its joint `start`, and the angle of the line to it.

    φ is the angle of the rod in the direction of rotation `turn`.  A point beside the rod adds its angle χ, which is
    set out as `slopes`; a point on the rod's line behind the joint has a negative distance.
    """
    x, y = q.find(ids.along_link(name)), q.find(ids.across_link(name))
    reach: Expression = q[ids.length(start, name)]
    if x is None or y is None:
        return reach, φ
    if not q.si(y):
        return -reach if q.si(x) < 0 else reach, φ
    slope = atan(y / x) if q.si(x) > 0 else atan2(y, x)
    χ = q.define(ids.slope(name), slope if turn > 0 else -slope, Symbol("χ", name), "angle", scale=1.0)
    q.set_out("slopes", χ)
    return reach, φ + χ


# --- the second cylinder of a V engine --------------------------------------------------------------


def second_cylinder(q: Calculation, turn: int, joint: str) -> None:
    """Enter the closed formulas of piston E, whose rod 4 hangs on D on the main rod, at l_BD from the crank pin, or
    on B.

    sin γ = h/l₄;  v_E = v⊥ tan γ − v∥;  a_E = a⊥ tan γ + v⊥²/(l₄ cos³γ) − a∥, towards the crank. Uses `delta` and
    the entries of `centred_slider`; enters `beta.4`, `f.v.E`, `f.omega.4`, `f.a.E`, `f.eps.4`.
    """
    δ, l4 = q["delta"], q[ids.length(joint, "E")]
    line = partial(q.define, scale=1.0)
    _joint_of_second_rod(q, turn, joint)
    ξ, η = (ids.formula_coordinate(axis, joint) for axis in "xy")
    v_ξ, v_η = (ids.formula_component(axis, joint, "v") for axis in "xy")
    a_ξ, a_η = (ids.formula_component(axis, joint, "a") for axis in "xy")

    # Across and along the second cylinder, which is at the angle δ from the first.
    def across(ξ: str, η: str) -> Expression:
        return q[ξ] * cos(δ) - q[η] * sin(δ)

    def along(ξ: str, η: str) -> Expression:
        return q[η] * cos(δ) + q[ξ] * sin(δ)

    h = line("f.h", across(ξ, η), "h", "length")
    γ = line("beta.4", asin(h / l4), "γ")
    v1 = line("f.across.v", across(v_ξ, v_η), Symbol("v", "⊥"), "velocity")
    v2 = line("f.along.v", along(v_ξ, v_η), Symbol("v", "∥"), "velocity")
    v = line("f.v.E", v1 * tan(γ) - v2)
    ω4 = line("f.omega.4", signed(-turn, v1 / (l4 * cos(γ))))
    a1 = line("f.across.a", across(a_ξ, a_η), Symbol("a", "⊥"), "acceleration")
    a2 = line("f.along.a", along(a_ξ, a_η), Symbol("a", "∥"), "acceleration")
    a = line("f.a.E", a1 * tan(γ) + v1**2 / (l4 * cos(γ) ** 3) - a2)
    ε4 = line("f.eps.4", signed(-turn, (a1 + l4 * ω4**2 * sin(γ)) / (l4 * cos(γ))))

    v_joint, a_joint = ids.formula(ids.velocity(joint)), ids.formula(ids.acceleration(joint))
    q.set_out("velocity_main", q["phi.3"], "beta.2", "f.v.C", "f.omega.2", v_ξ, v_η, v_joint)
    q.set_out("velocity_second", ξ, η, h, γ, v1, v2, v, ω4)
    q.set_out("acceleration_main", "f.a.C", "f.eps.2", a_ξ, a_η, a_joint)
    q.set_out("acceleration_second", a1, a2, a, ε4)


def _joint_of_second_rod(q: Calculation, turn: int, joint: str) -> None:
    """Enter ξ and η of the joint of the second rod: of crank pin B with its rates, or of D, whose rates exist
    already.
    """
    R, ω1, φ = q["R"], q["omega.1"], q["phi.3"]
    line = partial(q.define, scale=1.0)
    ξ: Expression = R * sin(φ)
    η: Expression = R * cos(φ)
    if joint == "B":
        line("f.x.B.v", ω1 * R * cos(φ), Symbol("v", "Bξ"))
        line("f.y.B.v", -(ω1 * R * sin(φ)), Symbol("v", "Bη"))
        ε1 = driver_acceleration(q, turn)
        line("f.x.B.a", plus(-(ω1**2 * R * sin(φ)), times(ε1, R, cos(φ))), Symbol("a", "Bξ"))
        line("f.y.B.a", plus(-(ω1**2 * R * cos(φ)), minus(times(ε1, R, sin(φ)))), Symbol("a", "Bη"))
    else:
        s = q[ids.length("B", joint)]
        ξ, η = R * (1 - s / q["L"]) * sin(φ), η + s * cos(q["beta.2"])
    line(ids.formula_coordinate("x", joint), ξ, Symbol("ξ", joint))
    line(ids.formula_coordinate("y", joint), η, Symbol("η", joint))


# --- with an offset ---------------------------------------------------------------------------------


class OffsetSlider(Record):
    """Crank r and rod l (m), offset e (m, along y), the guide's direction `axis` (rad) and the rotation `turn` = ±1."""

    r: float
    l: float  # noqa: E741 - the length's own letter
    e: float
    axis: float
    turn: int

    @property
    def stretched(self) -> float:
        """φ (rad) at the outer dead centre, crank and rod in line: sin φ = e/(l + r)."""
        return math.asin(self.e / (self.l + self.r))

    @property
    def folded(self) -> float:
        """φ (rad) at the inner dead centre, the rod over the crank: φ = π + arcsin(e/(l − r))."""
        return math.pi + math.asin(self.e / (self.l - self.r))

    def slider(self, reach: float) -> complex:
        """Return the place of C at the distance `reach` (m) from A."""
        return self._placed(complex(math.sqrt(reach**2 - self.e**2), self.e))

    def crank_angle(self, phi: float) -> float:
        """Return the crank's angle (rad) from +x of the drawing."""
        return self.axis + self.turn * phi

    def phi(self, crank_angle: float) -> float:
        """Return φ (rad) of a crank's angle (rad) from +x of the drawing."""
        return self.turn * (crank_angle - self.axis)

    def _placed(self, own: complex) -> complex:
        return complex(own.real, self.turn * own.imag) * cmath.exp(1j * self.axis)

    def acceleration(self, phi: Floats) -> Floats:
        """Return a_C/ω₁² (m) [N]."""
        beta = np.arcsin((self.e - self.r * np.sin(phi)) / self.l)
        omega = -self.r * np.cos(phi) / (self.l * np.cos(beta))
        return -(self.r * np.cos(phi - beta) + omega**2 * self.l) / np.cos(beta)

    def fastest(self) -> tuple[float, float]:
        """Return φ (rad) of the slider's greatest speeds, inward and outward: a_C = 0, once in each stroke."""
        low = np.array([self.stretched, self.folded])
        high = np.array([self.folded, self.stretched + FULL_TURN])
        before = self.acceleration(low)[:, None]
        low, _ = halved(low, high, lambda phi: before * self.acceleration(phi) > 0, HALVINGS)
        return float(low[0]), float(low[1])

    def course(self, start: float, turns: int) -> Stroke:
        """Return the stroke of slider 3 in a machine that starts at φ = `start` (rad) and has a cycle of
        `turns` turns.
        """
        return Stroke(
            link=3,
            rod=2,
            pin="C",
            crank_pin="B",
            top=self.slider(self.l + self.r),
            bottom=self.slider(self.l - self.r),
            top_angle=0.0,
            bottom_angle=self.folded - self.stretched,
            phase=(start - self.stretched + BELOW_A_TURN) % (turns * FULL_TURN) - BELOW_A_TURN,
        )

    @property
    def line(self) -> complex:
        """The point (m) of the guide's line that is nearest to A."""
        return self._placed(1j * self.e)

    def linkage(self, inertias: Sequence[Inertia], gravity: float, centre: complex | None = None) -> Linkage:
        """Return the mechanism (gravity in m/s²), with S2 at the point `centre` (m) of the rod if that is given."""
        return Linkage(
            ground={"A": 0j},
            driver=Crank("A", "B", self.r),
            groups=(Dyad("RRP", (2, 3), "B", "C", Guide(self.line, self.axis), (self.l, 0.0)),),
            points=() if centre is None else (LinkPoint("S2", 2, complex(centre)),),
            inertias=tuple(inertias),
            gravity=-1j * gravity,
        )


def offset_slider(q: Calculation, turn: int, angle: Floats, offset: Expression | None, centre: bool) -> None:
    """Enter the closed formulas at φ = `angle` [N], with `offset` e or none, of S2 too if there is a `centre`.

    Enters `phi.3`, `beta.2`, `x.C`, `f.omega.2`, `f.v.C`, `f.eps.2`, `f.a.C`, and of S2 its components, `f.v.S2`,
    `f.a.S2`.  Uses `l.AB`, `l.BC`, `l.BS2`, `omega.1`.
    """
    r, l, ω1 = q["l.AB"], q["l.BC"], q["omega.1"]  # noqa: E741 - the length's own letter
    line = partial(q.define, scale=1.0)
    φ = q.angle("phi.3", angle, "φ")
    β: Expression = line("beta.2", asin(-r * sin(φ) / l if offset is None else (offset - r * sin(φ)) / l), "β")
    s_C = line("x.C", r * cos(φ) + l * cos(β), Symbol("s", "C"), "length")
    ω2 = line("f.omega.2", signed(-turn, ω1 * r * cos(φ) / (l * cos(β))))
    v_C = line("f.v.C", -ω1 * r * sin(φ - β) / cos(β))
    evenly = signed(turn, (ω1**2 * (r * sin(φ)) + ω2**2 * l * sin(β)) / (l * cos(β)))
    ε2 = line("f.eps.2", accelerated(q, turn, evenly, ω2))
    a_C = line("f.a.C", accelerated(q, turn, -((ω1**2 * r * cos(φ - β) + ω2**2 * l) / cos(β)), v_C))
    q.set_out("velocity", "beta.2", s_C, ω2, v_C)
    q.set_out("acceleration", ε2, a_C)
    if centre:
        v, a = signed(turn, ω2), signed(turn, ε2)
        s, β = arm_of(q, "B", "S2", β, turn)
        v_x, v_y = -(ω1 * r * sin(φ) + v * s * sin(β)), ω1 * r * cos(φ) + v * s * cos(β)
        q.set_out("velocity", *q.lines.get("slopes", ()), *components(q, "v", "S2", v_x, v_y))
        ε1 = driver_acceleration(q, turn)
        a_x = plus(-(ω1**2 * r * cos(φ) + s * (a * sin(β) + ω2**2 * cos(β))), minus(times(ε1, r, sin(φ))))
        a_y = plus(s * (a * cos(β) - ω2**2 * sin(β)) - ω1**2 * r * sin(φ), times(ε1, r, cos(φ)))
        q.set_out("acceleration", *components(q, "a", "S2", a_x, a_y))


def loop_equations(turn: int, offset: bool, accelerates: float = 0.0) -> dict[str, tuple[Chain, ...]]:
    """Return the closed loop of the links by components, and its first and second derivatives.

    `accelerates` (any unit) is > 0 if the crank accelerates in the sense of ω₁ (> 0), < 0 against it, 0 if it does not.
    """
    r, l, e = Symbol("l", "AB"), Symbol("l", "BC"), Symbol("e")  # noqa: E741
    ω1, ω2, ε2 = Symbol("ω", "1"), Symbol("ω", "2"), Symbol("ε", "2")
    φ, β, s, v, a = Symbol("φ"), Symbol("β"), Symbol("s", "C"), Symbol("v", "C"), Symbol("a", "C")
    nothing = Number(0.0)
    ε1 = accelerating(accelerates)
    return {
        "closure": (Chain((r * cos(φ) + l * cos(β), s)), Chain((r * sin(φ) + l * sin(β), e if offset else nothing))),
        "velocity": (
            Chain((-ω1 * r * sin(φ) + signed(-turn, ω2 * l * sin(β)), v)),
            Chain((ω1 * r * cos(φ) + signed(turn, ω2 * l * cos(β)), nothing)),
        ),
        "acceleration": (
            Chain(
                (
                    plus(
                        -(ω1**2) * r * cos(φ) + signed(-turn, ε2 * l * sin(β)) - ω2**2 * l * cos(β),
                        minus(times(ε1, r, sin(φ))),
                    ),
                    a,
                )
            ),
            Chain(
                (
                    plus(
                        -(ω1**2) * r * sin(φ) + signed(turn, ε2 * l * cos(β)) - ω2**2 * l * sin(β), times(ε1, r, cos(φ))
                    ),
                    nothing,
                )
            ),
        ),
    }


OFFSET_PLANS = ("v.C", "omega.2", "a.C", "eps.2")
"""Plan quantities that the closed formulas also give; those of S2 only if it exists."""
CENTRE_PLANS = ("v.S2", "a.S2")
"""Plan quantities that the closed formulas give too, those of S2 where there is one."""
