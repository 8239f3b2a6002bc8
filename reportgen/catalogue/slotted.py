"""A crank whose pin drives a lever through a block in the lever's slot, and the ram that the lever may drive.

A crank centre, B pin, C pivot. Own axes: y runs from C to A, x is y turned by 90° against the rotation, so that ω₁
> 0 turns x towards y. φ₁ is the crank's angle from x, r = l_AB, d = l_AC, S = CB; a is square to the slot, r along
it. D is the end of the lever, E the ram, b the height of the ram's line over C. The ram works against the own x,
and S cos φ₃ = l₁ cos φ₁, S sin φ₃ = a + l₁ sin φ₁, l₃ sin φ₃ + l₄ sin φ₄ = b. On the page, x points to the right as
in all its tables: x_E = ±(l₃ cos φ₃ + l₄ cos φ₄), with a minus if the crank turns clockwise.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence

from reportgen.base.arrays import Floats
from reportgen.base.records import Record
from reportgen.catalogue.given_data import accelerated, accelerating, driver_acceleration, natural_lines
from reportgen.formula import (
    NOTHING,
    PI,
    Chain,
    Expression,
    Number,
    Ref,
    Symbol,
    acos,
    asin,
    call,
    cos,
    ids,
    minus,
    over,
    plus,
    signed,
    sin,
    sqrt,
    square,
    tan,
    times,
)
from reportgen.formula.calculation import BELOW_A_TURN, Calculation
from reportgen.machine import Crank, Dyad, Guide, Inertia, Linkage, LinkPoint
from reportgen.machine.load_laws import FULL_TURN, Stroke

DRAWN_CRANKS = (0.05, 0.04, 0.03, 0.025, 0.02, 0.015)
"""Drawn lengths of a crank (m on paper), the best first."""
HIGHEST = 0.165
"""A mechanism is drawn no higher than this (m on paper), so that its plans stay on the page."""
STRAIGHT, TURN = Number(180.0, unit="°"), Number(360.0, unit="°")


class SlottedCrank(Record):
    """Crank r about A, lever about C at the distance d below A (m); `axis` is the direction from C to A (rad)."""

    r: float
    d: float
    axis: float
    turn: int

    @property
    def swings(self) -> bool:
        """True if the lever swings (r < d), False if it makes whole turns (r > d)."""
        return self.r < self.d

    @property
    def half_swing(self) -> float:
        """θ = arcsin(r/d), the lever's greatest angle from CA (rad), where the crank is perpendicular to it."""
        return math.asin(self.r / self.d)

    def place(self, own: complex) -> complex:
        """Return a point of the own axes, seen from A, on the drawing (m)."""
        up = cmath.exp(1j * self.axis)
        return -1j * self.turn * up * own.real + up * own.imag

    def crank_angle(self, phi: float) -> float:
        """Return the crank's angle (rad) from +x of the drawing."""
        return self.axis + self.turn * (phi - math.pi / 2)

    def phi(self, crank_angle: float) -> float:
        """Return φ (rad) of a crank's angle (rad) from +x of the drawing."""
        return math.pi / 2 + self.turn * (crank_angle - self.axis)

    @property
    def ground(self) -> dict[str, complex]:
        """The fixed points (m) by name."""
        return {"A": 0j, "C": self.place(-1j * self.d)}

    @property
    def driver(self) -> Crank:
        return Crank("A", "B", self.r)

    @property
    def group(self) -> Dyad:
        """Block 2 on the pin B, lever 3 on C; B3 is the lever's point under the pin."""
        return Dyad("RPR", (2, 3), "B", "B3", "C")


def drawn_crank(crank: float, height: float) -> float:
    """Return the drawn length of a crank (m on paper) with which a mechanism `height` (m) high fits the page."""
    return next((drawn for drawn in DRAWN_CRANKS if drawn * height / crank <= HIGHEST), DRAWN_CRANKS[-1])


class Ram(Record):
    """The lever's crank, and the lengths (m) of the lever and of the link, and the height of the ram's line over C."""

    crank: SlottedCrank
    lever: float
    link: float
    height: float

    @property
    def beginning(self) -> float:
        """φ₁ (rad) at which the working stroke begins: −θ, where the crank is perpendicular to the lever."""
        return -self.crank.half_swing

    def end(self, side: int) -> complex:
        """Return the place of E (m, from A on the drawing) at the beginning (+1) or the end (−1) of the working
        stroke.
        """
        theta = self.crank.half_swing
        rise = (self.height - self.lever * math.cos(theta)) / self.link
        along = side * self.lever * math.sin(theta) - self.link * math.sqrt(1 - rise**2)
        return self.crank.place(complex(along, self.height - self.crank.d))

    def course(self, start: float) -> Stroke:
        """Return the ram's stroke, from the beginning of its working stroke, for a machine that starts at φ₁ = `start`
        (rad).
        """
        return Stroke(
            link=5,
            rod=4,
            pin="E",
            crank_pin="D",
            top=self.end(1),
            bottom=self.end(-1),
            top_angle=0.0,
            bottom_angle=math.pi + 2 * self.crank.half_swing,
            phase=(start - self.beginning + BELOW_A_TURN) % FULL_TURN - BELOW_A_TURN,
        )

    @property
    def line(self) -> complex:
        """The point (m) of the ram's line that is nearest to A."""
        return self.crank.place(1j * (self.height - self.crank.d))

    def linkage(self, points: Sequence[LinkPoint], inertias: Sequence[Inertia], gravity: float) -> Linkage:
        """Return the mechanism (gravity in m/s²); the ram's guide points against its working stroke."""
        towards = self.crank.place(1 + 0j)
        guide = Guide(self.line, math.atan2(towards.imag, towards.real))
        return Linkage(
            ground=self.crank.ground,
            driver=self.crank.driver,
            groups=(self.crank.group, Dyad("RRP", (4, 5), "D", "E", guide, lengths=(self.link, 0.0), sign=-1)),
            points=(LinkPoint("D", 3, complex(self.lever)), *points),
            inertias=tuple(inertias),
            gravity=-1j * gravity,
        )


# --- closed formulas --------------------------------------------------------------------------------


def lever_formulas(q: Calculation, turn: int, angle: Floats, crank: str, centres: str) -> None:
    """Enter `phi.A`, `f.S`, `f.omega.3`, `f.v.r`, `f.eps.3` at φ₁ = `angle` [N] by the lengths r, d of these ids:

    S² = d² + r² + 2dr sin φ;  ω₃ = ω₁r(r + d sin φ)/S²;  v_r = ω₁dr cos φ/S;  ε₃ = ω₁²dr(d² − r²) cos φ/S⁴;
    ω₃ and ε₃ anticlockwise, so with a minus for the `turn` −1.
    """
    line = natural_lines(q, crank)
    φ = q.angle("phi.A", angle, Symbol("φ", "1"))
    r, d, ω1 = q[crank], q[centres], q["omega.1"]
    square = d**2 + r**2 + 2 * d * r * sin(φ)
    S = line("f.S", sqrt(square), "S", "length")
    ω3 = line("f.omega.3", signed(turn, ω1 * r * (r + d * sin(φ)) / square))
    line("f.v.r", ω1 * d * r * cos(φ) / S)
    evenly = signed(turn, ω1**2 * d * r * (d**2 - r**2) * cos(φ) / square**2)
    line("f.eps.3", accelerated(q, turn, evenly, ω3))


def lever_end(q: Calculation, turn: int, angle: Floats) -> None:
    """Enter the closed formulas of the lever CD at φ = `angle` [N]: a_r = ω₃²S − ω₁²r(r + d sin φ)/S;  aᵏ = 2ω₃v_r.

    Uses `l.AB`, `l.AC`, `l.CD`, `omega.1`.  Ids: those of `lever_formulas`, `f.v.D`, `f.a.k`, `f.a.r`,
    `f.a.D.n`, `f.a.D.t`, `f.a.D`.
    """
    lever_formulas(q, turn, angle, "l.AB", "l.AC")
    line = natural_lines(q, "l.AB")
    r, d, l, ω1, φ = q["l.AB"], q["l.AC"], q["l.CD"], q["omega.1"], q["phi.A"]  # noqa: E741
    ω3, S = q["f.omega.3"], q["f.S"]
    v_D = line("f.v.D", ω3 * l)
    a_k = line("f.a.k", 2 * ω3 * q["f.v.r"], Symbol("a", "k"))
    evenly = ω3**2 * S - ω1**2 * (r * (r + d * sin(φ))) / S
    a_r = line("f.a.r", accelerated(q, turn, evenly, q["f.v.r"]), Symbol("a", "r"))
    normal = line("f.a.D.n", ω3**2 * l)
    tangential = line("f.a.D.t", q["f.eps.3"] * l)
    a_D = line("f.a.D", sqrt(normal**2 + tangential**2))
    q.set_out("velocity", S, ω3, q["f.v.r"], v_D)
    q.set_out("acceleration", q["f.eps.3"], a_k, a_r, normal, tangential, a_D)


def ram_formulas(q: Calculation, turn: int, angle: Floats) -> None:
    """Enter the closed formulas of the ram at φ₁ = `angle` [N]; x, v and a of the ram and of D count to the right.

    Uses `l.AB`, `l.CD`, `l.DE`, `a`, `b`, `theta`, `omega.1`.  Ids: those of `lever_formulas`, `phi.3`, `phi.4`,
    `f.x.E`, its value `x.0` at the beginning of the stroke, the way `f.s.E` from there, `f.omega.4`, `f.v.E`,
    `f.eps.4`, `f.a.Dx`, `f.a.E`.
    """
    lever_formulas(q, turn, angle, "l.AB", "a")
    line = natural_lines(q, "l.AB")
    l1, l3, l4, φ1, ω3, ε3 = (q[id] for id in ("l.AB", "l.CD", "l.DE", "phi.A", "f.omega.3", "f.eps.3"))
    φ3 = q.define("phi.3", acos(l1 * cos(φ1) / q["f.S"]))
    φ4 = q.define("phi.4", STRAIGHT - asin((q["b"] - l3 * sin(φ3)) / l4))
    x = line("f.x.E", plus(signed(turn, l3 * cos(φ3)), signed(turn, l4 * cos(φ4))))
    ω4 = line("f.omega.4", -ω3 * l3 * cos(φ3) / (l4 * cos(φ4)))
    v = line("f.v.E", signed(-1, ω3 * l3 * sin(φ3) + ω4 * l4 * sin(φ4)))
    square3 = l3 * (ω3**2 * sin(φ3) + signed(-turn, ε3 * cos(φ3)))
    ε4 = line("f.eps.4", signed(turn, square3 / (l4 * cos(φ4)) + ω4**2 * tan(φ4)))
    a_D = line("f.a.Dx", -l3 * plus(ε3 * sin(φ3), signed(turn, ω3**2 * cos(φ3))))
    far, near = l3 * sin(q["theta"]), sqrt(l4**2 - (q["b"] - l3 * cos(q["theta"])) ** 2)
    at_first = q.define("x.0", far - near if turn > 0 else near - far, Symbol("x", "0"), "length")
    s = line("f.s.E", at_first - x if turn > 0 else x - at_first, Symbol("s", "E"), "length")
    a = line("f.a.E", a_D - l4 * plus(ε4 * sin(φ4), signed(turn, ω4**2 * cos(φ4))))
    q.set_out("velocity", q["f.S"], φ3, φ4, x, ω3, q["f.v.r"], ω4, v)
    q.set_out("acceleration", ε3, ε4, a_D, a)
    q.set_out("course", φ1, x, v, a, ω3, ε3, ω4, ε4)
    q.set_out("functions", q["f.S"], φ3, φ4, x, s, ω3, ω4, v, ε3, ε4, a_D, a)


def cutting(q: Calculation, force: Ref, free: Ref | None) -> Ref:
    """Enter `P.cut`, the force on the ram while φ₁ is in the working stroke, −θ ≤ φ₁ < 180° + θ. If the ends are
    `free` for the shares k of the stroke H, it acts only while kH ≤ s ≤ (1 − k)H; s is the ram's way from the
    beginning.
    """
    φ1, θ, s, H = q["phi.A"], q["theta"], q["f.s.E"], q["H"]
    turned = q.define(ids.angle("cut"), call("around", φ1 + θ), hidden=True)
    P = force * call("amid", turned, 0.0, STRAIGHT + 2 * θ)
    if free is not None:
        P = P * call("amid", s / H, free, 1 - free)
    return q.define("P.cut", P, Symbol("P"), "force", hidden=True)


def ram_torque(q: Calculation, turn: int) -> None:
    """Enter the balancing torque `f.M` as a function of φ₁: its power and that of all forces and inertia forces is
    zero.

    Uses the entries of `ram_formulas`, `P.cut`, and masses and moments of inertia if they are entered; y points up, so
    that a weight has the power −G v_y, an inertia force −m(a·v), and a couple −J ε ω.
    """
    line = natural_lines(q, "l.AB")
    ω1, φ1, φ3, φ4 = (q[id] for id in ("omega.1", "phi.A", "phi.3", "phi.4"))
    ω3, ε3, ω4, ε4 = (signed(turn, q[f]) for f in map(ids.formula, ("omega.3", "eps.3", "omega.4", "eps.4")))
    powers: list[Expression] = []
    if P := q.find("P.cut"):
        powers.append(signed(turn, P * q["f.v.E"]))
    for link, ω, ε in (("3", ω3, ε3), ("4", ω4, ε4)):
        if J := q.find(ids.inertia(link)):
            powers.append(minus(times(J, ω, ε)))
    if G2 := q.find(ids.weight(2)):
        powers.append(-(G2 * ω1 * q["l.AB"] * cos(φ1)))
    if (G3 := q.find(ids.weight(3))) and (m3 := q.find(ids.mass(3))):
        s3 = q["l.CS3"]
        powers += [minus(times(G3, ω3, s3, cos(φ3))), minus(times(m3, s3**2, ω3, ε3))]
    if (G4 := q.find(ids.weight(4))) and (m4 := q.find(ids.mass(4))):
        l3, s4 = q["l.CD"], q["l.DS4"]
        arms = (l3, ω3, ε3, φ3), (s4, ω4, ε4, φ4)
        # Along x the signs of ω and ε cancel that of the axis: a product of both needs neither sign.
        plain = (l3, q["f.omega.3"], q["f.eps.3"], φ3), (s4, q["f.omega.4"], q["f.eps.4"], φ4)
        v_x = minus(plus(*(times(r, ω, sin(φ)) for r, ω, _, φ in plain)))
        v_y = plus(*(times(r, ω, cos(φ)) for r, ω, _, φ in arms))
        a_x = minus(plus(*(r * plus(times(ε, sin(φ)), signed(turn, square(ω) * cos(φ))) for r, ω, ε, φ in plain)))
        a_y = plus(*(r * plus(times(ε, cos(φ)), -(square(ω) * sin(φ))) for r, ω, ε, φ in arms))
        kinds = {"v": "velocity", "a": "acceleration"}
        (v_x, v_y), (a_x, a_y) = (
            [
                line(ids.formula_component(axis, "S4", what), part, Symbol(what, f"S4{axis}"), kinds[what])
                for axis, part in zip("xy", parts, strict=True)
            ]
            for what, parts in (("v", (v_x, v_y)), ("a", (a_x, a_y)))
        )
        q.set_out("functions", v_x, v_y, a_x, a_y)
        powers += [-(G4 * v_y), -(m4 * (a_x * v_x + a_y * v_y))]
    s1, ε1 = q.find("l.AS1"), signed(turn, driver_acceleration(q, turn))
    if (G1 := q.find(ids.weight(1))) and s1:
        x1, y1 = (q.find(id("S1")) for id in (ids.along_link, ids.across_link))
        lever = plus(x1 * cos(φ1), signed(-turn, y1 * sin(φ1))) if x1 and y1 else s1 * cos(φ1)
        powers.append(-(G1 * ω1 * lever))
    if (J1 := q.find(ids.inertia(1))) and ε1 is not NOTHING:
        powers.append(minus(times(J1, signed(turn, ω1), ε1)))
    if (m1 := q.find(ids.mass(1))) and s1 and ε1 is not NOTHING:
        powers.append(minus(times(m1, s1**2, signed(turn, ω1), ε1)))
    if m5 := q.find(ids.mass(5)):
        powers.append(-(m5 * q["f.a.E"] * q["f.v.E"]))
    if powers:
        q.define("f.M", over(minus(signed(turn, plus(*powers))), ω1), "M", "torque", scale=1.0)


def swing(q: Calculation, sine: Expression) -> None:
    """Enter the lever's greatest angle θ from CA by its sine, and the ratio K = (180° + 2θ)/(180° − 2θ) of the
    crank's turns for the lever's two ways."""
    θ = q.define("theta", asin(sine))
    q.set_out("swing", θ, q.define("K", (STRAIGHT + 2 * θ) / (STRAIGHT - 2 * θ)))


def strokes(q: Calculation, H: Ref) -> None:
    """Enter the times of a turn and of the ram's two strokes, and its mean speeds over the stroke H."""
    K = q["K"]
    ω1 = q["omega.1"]
    T = q.define("t.turn", 2 * PI / ω1, "T", "time")
    work = q.define("t.work", T * K / (1 + K), Symbol("t", "1"), "time")
    back = q.define("t.back", T - work, Symbol("t", "2"), "time")
    there, home = q.define("v.work", H / work, Symbol("v", "m1")), q.define("v.back", H / back, Symbol("v", "m2"))
    q.set_out("strokes", *q.worked(ω1), T, work, back, there, home)


LEVER_COMPARED = (
    *((plan, ids.formula(plan)) for plan in ("omega.3", "v.D", "eps.3", "a.D")),
    ("v.B3B", "f.v.r"),
    ("a.B3B.k", "f.a.k"),
    ("a.B3B.r", "f.a.r"),
)
RAM_COMPARED = (
    *((plan, ids.formula(plan)) for plan in ("omega.3", "omega.4", "v.E", "eps.3", "eps.4", "a.E")),
    ("v.B3B", "f.v.r"),
)
"""Plan quantities and the closed formulas that must give the same sizes."""


# --- the equations in symbols -----------------------------------------------------------------------


def lever_equations(turn: int, r: Symbol, d: Symbol, accelerates: float) -> dict[str, tuple[Chain, ...]]:
    """Return the triangle ABC along x and y, along and across the lever, and its derivatives, which give the lever's
    motion.

    `accelerates` (any unit) is 0 for a crank at constant speed.
    """
    S, φ1, φ3, ω1, ω3 = Symbol("S"), Symbol("φ", "1"), Symbol("φ", "3"), Symbol("ω", "1"), Symbol("ω", "3")
    v_r, ε3 = Symbol("v", "r"), Symbol("ε", "3")
    ε1 = accelerating(accelerates)
    across = NOTHING if ε1 is NOTHING else signed(turn, ε1 * r * cos(φ1 - φ3))
    return {
        "closure": (Chain((S * cos(φ3), r * cos(φ1))), Chain((S * sin(φ3), d + r * sin(φ1)))),
        "between": (Chain((S * cos(φ1 - φ3), r + d * sin(φ1))), Chain((S * sin(φ1 - φ3), -d * cos(φ1)))),
        "velocity": (Chain((S * ω3, signed(turn, ω1 * r * cos(φ1 - φ3)))), Chain((v_r, -ω1 * r * sin(φ1 - φ3)))),
        "acceleration": (Chain((S * ε3 + 2 * v_r * ω3, plus(signed(-turn, ω1**2 * r * sin(φ1 - φ3)), across))),),
    }


def ram_equations(turn: int, accelerates: float) -> dict[str, tuple[Chain, ...]]:
    """Return both closed loops by components, and their first and second derivatives.

    `accelerates` (any unit) is 0 for a crank at constant speed.
    """
    l1, l3, l4 = (Symbol("l", link) for link in "134")
    φ3, φ4, ω3, ω4, ε3, ε4 = (Symbol(letter, link) for letter in "φωε" for link in "34")
    nothing = Number(0.0)
    triangle = lever_equations(turn, l1, Symbol("a"), accelerates)
    ε3_x, ε3_y = ε3 * l3 * sin(φ3), signed(turn, ε3 * l3 * cos(φ3))
    ε4_x, ε4_y = ε4 * l4 * sin(φ4), signed(turn, ε4 * l4 * cos(φ4))
    x3, x4 = signed(turn, l3 * cos(φ3)), signed(turn, l4 * cos(φ4))
    along = plus(ε3_x, signed(turn, ω3**2 * l3 * cos(φ3)), ε4_x, signed(turn, ω4**2 * l4 * cos(φ4)))
    across = ε3_y - ω3**2 * l3 * sin(φ3) + ε4_y - ω4**2 * l4 * sin(φ4)
    return {
        "closure": (
            *triangle["closure"],
            Chain((Symbol("x", "E"), plus(x3, x4))),
            Chain((l3 * sin(φ3) + l4 * sin(φ4), Symbol("b"))),
        ),
        "between": triangle["between"],
        "velocity": (
            *triangle["velocity"],
            Chain((Symbol("v", "E"), signed(-1, ω3 * l3 * sin(φ3) + ω4 * l4 * sin(φ4)))),
            Chain((ω3 * l3 * cos(φ3) + ω4 * l4 * cos(φ4), nothing)),
        ),
        "acceleration": (*triangle["acceleration"], Chain((Symbol("a", "E"), -along)), Chain((across, nothing))),
    }
