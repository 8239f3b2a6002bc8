"""Closed vector loops of Assur groups: positions, velocities and accelerations of a linkage by formulas, group by
group.

x and y are the axes of the drawing; angles and rotations are anticlockwise from +x. The loop of a group expresses
one of its points in two ways. Its derivatives are two linear equations u q̇₁ + w q̇₂ = b, u q̈₁ + w q̈₂ = b′ for
the two unknown rates, which Cramer's rule solves. The unit vectors are e along a link or a guide and n = ie; each
formula contains only the nonzero terms of the determinants.

==== ====================================================================== =====================
kind loop                                                                   unknown rates
==== ====================================================================== =====================
RRR  r_P + l_i e_i = r_T + l_j e_j                                          ω_i, ω_j
RRP  r_P + l_i e_i = r_G + s e_j                                            ω_i, v = ṡ
RPR  r_T + s e_j + e n_j = r_P                                              ω_j, v = ṡ
PRP  r_G + s e_i = r_H + t e_j                                              v = ṡ, w = ṫ
RPP  r_G + s e_j + t e_k = r_P, e_k the slide's direction on link j         v = ṡ, w = ṫ
==== ====================================================================== =====================
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace

from reportgen.catalogue.given_data import natural_sizes
from reportgen.catalogue.vector_components import (
    STILL,
    VectorComponents,
    across,
    add,
    along,
    degrees,
    less,
    on,
    scaled,
    turned,
    typed,
)
from reportgen.formula import (
    MINUS_ONE,
    NOTHING,
    Chain,
    Expression,
    Matrix,
    Number,
    Ref,
    Symbol,
    acos,
    as_expression,
    asin,
    atan2,
    between,
    column,
    cos,
    cosine,
    ids,
    is_zero,
    minus,
    over,
    plus,
    signed,
    sin,
    sine,
    sqrt,
    square,
    times,
    vocabulary,
)
from reportgen.formula.calculation import Calculation
from reportgen.machine import DRIVER, GROUND, Crank, Dyad, DyadKind, Guide, Linkage, LinkPoint, owners, under

TWO = Number(2.0)
STRAIGHT = Number(180.0, unit="°")


# --- what moves -----------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class Moving:
    """A point: its coordinates, its velocity and its acceleration by components."""

    p: VectorComponents
    v: VectorComponents = STILL
    a: VectorComponents = STILL


@dataclass(frozen=True, slots=True)
class LoopBody:
    """A link: the origin of its frame by name and motion, the frame's angle, ω and ε."""

    start: str
    origin: Moving
    angle: Expression
    omega: Expression = NOTHING
    eps: Expression = NOTHING

    def place(self, local: complex) -> VectorComponents:
        """Return the place of a point by its typed distances (m) along the link and across it."""
        e, (u, w) = along(self.angle), typed(local)
        return add(self.origin.p, scaled(u, e), scaled(w, turned(e)))

    def carried(self, at: VectorComponents) -> Moving:
        """Return the link's point at a place, with v = v_O + ω ir, a = a_O + ε ir − ω² r."""
        r = less(at, self.origin.p)
        v = add(self.origin.v, scaled(self.omega, turned(r)))
        inward = scaled(minus(square(self.omega)), r)
        return Moving(at, v, add(self.origin.a, scaled(self.eps, turned(r)), inward))


FRAME = LoopBody("", Moving(STILL), Number(0.0, unit="°"))


@dataclass(frozen=True, slots=True)
class LoopRail:
    """A guide: a point of its line, its angle, the link that has it."""

    at: VectorComponents
    angle: Expression
    carrier: LoopBody
    link: int


@dataclass(frozen=True, slots=True)
class LoopLine:
    """A quantity with its formula, and the name of the part of the equations to which it belongs."""

    id: str
    formula: Expression
    symbol: Symbol | str
    kind: str
    part: str


Sides = tuple[Expression, Expression, VectorComponents]
"""Both unknown rates and the right-hand side of their equations."""
RATES = {"v": "velocity", "a": "acceleration"}


# --- the loops ------------------------------------------------------------------------------------


@dataclass
class ClosedLoops:
    """The loops of a linkage during their construction, group by group in the order of assembly.

    `equations` are by name and group `closure-23`, `velocity-23`, `acceleration-23`; `place-1`, … are those of the
    driver.  `compared` are plan quantities and the formulas that must give their sizes.  `fixed` are the coordinates of
    the fixed points, `guides` those of a point of each fixed guide, by its slider.  `accelerates` is > 0 if the driver
    accelerates in the sense of its speed, < 0 against it, 0 if it does not. A linkage with a group of class III has no
    formulas but those of the driver: the position of such a group has no closed form.
    """

    linkage: Linkage
    turn: int
    fixed: Mapping[str, VectorComponents]
    guides: Mapping[int, VectorComponents] = field(default_factory=dict)
    accelerates: float = 0.0
    lines: list[LoopLine] = field(default_factory=list)
    equations: dict[str, tuple[Chain, ...]] = field(default_factory=dict)
    compared: list[tuple[str, str]] = field(default_factory=list)
    points: dict[str, Moving] = field(default_factory=dict)
    links: dict[int, LoopBody] = field(default_factory=lambda: {GROUND: FRAME})
    group: str = str(DRIVER)

    def __post_init__(self) -> None:
        self.owner = owners(self.linkage)
        self.points |= {name: Moving(self.fixed[name]) for name in self.linkage.ground}
        self._drive()
        if self.linkage.triads:
            return
        for dyad in self.linkage.dyads:
            self.group = ids.joint(*dyad.links)
            KINDS[dyad.kind](self, dyad)

    def write(self, q: Calculation) -> None:
        """Enter everything in a calculation that has the given data and the plans."""
        driver = self.linkage.driver
        if isinstance(driver, Crank):
            q.angle(ids.formula_angle(DRIVER), q.value(ids.angle(DRIVER)))
            sizes = natural_sizes(driver.length, q.si("omega.1"))
        else:
            sizes = natural_sizes(1.0, q.si(ids.velocity(driver.pin)))
        for group in (str(DRIVER), *(ids.joint(*dyad.links) for dyad in self.linkage.dyads)):
            for part in ("place", *RATES.values()):
                q.set_out(f"{part}-{group}")
        for line in self.lines:
            scale = sizes.get(line.kind or vocabulary.row(line.id).kind, 1.0)
            q.set_out(line.part, q.define(line.id, line.formula, line.symbol, line.kind, scale=scale))

    # --- lines

    def line(self, part: str, id: str, formula: Expression, symbol: Symbol | str = "", kind: str = "") -> Ref:
        """Add a quantity to the places, velocities or accelerations of the group."""
        self.lines.append(LoopLine(id, formula, symbol, kind, f"{part}-{self.group}"))
        return Ref(id)

    def point(self, name: str, moving: Moving, plan: bool = True) -> Moving:
        """Add a point: coordinates, velocity and acceleration, with their sizes if a `plan` has them."""
        at = self.coordinates(name, moving.p)
        v, a = (self.components(what, name, of, plan) for what, of in (("v", moving.v), ("a", moving.a)))
        self.points[name] = Moving(at, v, a)
        return self.points[name]

    def coordinates(self, name: str, at: VectorComponents) -> VectorComponents:
        x, y = (
            part if isinstance(part, Ref | Number) else self.line("place", ids.formula_coordinate(axis, name), part)
            for axis, part in zip("xy", at, strict=True)
        )
        return x, y

    def components(self, what: str, name: str, of: VectorComponents, plan: bool) -> VectorComponents:
        kind = RATES[what]
        x, y = (
            part
            if isinstance(part, Ref | Number)
            else self.line(kind, ids.formula_component(axis, name, what), part, Symbol(what, f"{name}{axis}"), kind)
            for axis, part in zip("xy", of, strict=True)
        )
        if plan and (x, y) != STILL:
            whole = sqrt(plus(square(x), square(y))) if NOTHING not in (x, y) else plus(x, y)
            self.known(kind, ids.POINT_RATE[what](name), whole)
        return x, y

    def known(self, part: str, plan: str, formula: Expression) -> Ref:
        """Enter a formula of a quantity that a plan also gives, and list it for comparison."""
        written = self.line(part, ids.formula(plan), formula)
        self.compared.append((plan, written.id))
        return written

    def omega(self, link: int, formula: Expression) -> Ref:
        return self.known("velocity", ids.angular_velocity(link), formula)

    def eps(self, link: int, formula: Expression) -> Ref:
        return self.known("acceleration", ids.angular_acceleration(link), formula)

    def enter_matrix_form(self, u: VectorComponents, w: VectorComponents, velocity: Sides, acceleration: Sides) -> None:
        """Enter the equations in matrix form: both unknowns and the right-hand side of each."""
        A = Matrix(((u[0], w[0]), (u[1], w[1])))
        for what, sides in {"velocity": velocity, "acceleration": acceleration}.items():
            first, second, right = sides
            self.equations[f"{what}-{self.group}"] = (Chain((A * column(first, second), column(*right))),)

    def closure(self, outward: VectorComponents, back: VectorComponents) -> None:
        self.equations[f"closure-{self.group}"] = tuple(Chain(sides) for sides in zip(outward, back, strict=True))

    # --- ends of a group

    def rail(self, slider: int, end: str | Guide) -> LoopRail:
        """Return a guide with its motion."""
        assert isinstance(end, Guide)
        body = self.links[end.link]
        if end.link == GROUND:
            return LoopRail(self.guides.get(slider) or typed(end.at), degrees(end.angle), body, GROUND)
        angle = plus(body.angle, *((degrees(end.angle),) if end.angle else ()))
        turned_angle = angle if isinstance(angle, Ref) else self.line("place", ids.formula_angle(slider), angle)
        return LoopRail(body.place(end.at), turned_angle, body, end.link)

    def beneath(self, name: str, rail: LoopRail, at: VectorComponents, plan: bool = True) -> Moving:
        """Return the point of a guide's link that lies under a point."""
        if rail.link == GROUND:
            return Moving(at)
        point_beneath = under(name, rail.link, self.owner)
        return self.points.get(point_beneath) or self.point(point_beneath, rail.carrier.carried(at), plan)

    def put(self, link: int, body: LoopBody) -> None:
        """Place a link and its points."""
        self.links[link] = body
        for point in self.linkage.points:
            if point.link == link:
                self.point(point.name, body.carried(self.coordinates(point.name, self._place_of(point, body))))

    def _place_of(self, point: LinkPoint, body: LoopBody) -> VectorComponents:
        """Return the place of a point: by its length on the line of its link, elsewhere by its two typed distances."""
        if point.local.imag or not point.local:
            return body.place(point.local)
        length = Ref(ids.length(body.start, point.name))
        return add(body.origin.p, scaled(length if point.local.real > 0 else minus(length), along(body.angle)))

    # --- the driver

    def _drive(self) -> None:
        driver = self.linkage.driver
        if isinstance(driver, Crank):
            centre, ω1 = self.points[driver.centre], signed(self.turn, Ref("omega.1"))
            ε1 = signed(self.turn * self.accelerates, Ref("eps.1")) if self.accelerates else NOTHING
            body = LoopBody(driver.centre, centre, Ref(ids.formula_angle(DRIVER)), ω1, ε1)
            reach = scaled(Ref(ids.length(driver.centre, driver.pin)), along(body.angle))
            self.point(driver.pin, body.carried(self.coordinates(driver.pin, add(body.origin.p, reach))))
        else:
            direction = along(degrees(driver.guide.angle))
            at = self.coordinates(driver.pin, add(typed(driver.guide.at), scaled(Ref("s.1"), direction)))
            speed = scaled(signed(self.turn, Ref(ids.velocity(driver.pin))), direction)
            moving = Moving(at, self.components("v", driver.pin, speed, plan=False))
            if self.accelerates:
                rate2 = signed(self.turn * self.accelerates, Ref(ids.acceleration(driver.pin)))
                moving = replace(moving, a=self.components("a", driver.pin, scaled(rate2, direction), plan=False))
            self.points[driver.pin] = moving
            body = LoopBody(driver.pin, self.points[driver.pin], degrees(driver.guide.angle))
        self.put(DRIVER, body)


# --- the kinds ------------------------------------------------------------------------------------


def _rrr(k: ClosedLoops, dyad: Dyad) -> None:
    i, j = dyad.links
    P, T, Q = k.points[str(dyad.start)], k.points[str(dyad.end)], dyad.middle
    l_i, l_j = Ref(ids.length(str(dyad.start), Q)), Ref(ids.length(str(dyad.end), Q))
    x, y = less(T.p, P.p)
    d = k.line("place", ids.loop_distance(k.group), sqrt(plus(square(x), square(y))))
    corner = acos((l_i**2 + d**2 - l_j**2) / (2 * l_i * d))
    φ_i = k.line("place", ids.formula_angle(i), atan2(y, x) + signed(dyad.sign, corner))
    tip = add(P.p, scaled(l_i, along(φ_i)))
    at = k.coordinates(Q, tip)
    x, y = less(at, T.p)
    φ_j = k.line("place", ids.formula_angle(j), atan2(y, x))
    apart = φ_j - φ_i

    v, a = less(T.v, P.v), less(T.a, P.a)
    ω_i, ω_j = k.omega(i, over(on(v, φ_j), l_i * sin(apart))), k.omega(j, over(on(v, φ_i), l_j * sin(apart)))
    n_i, n_j = ω_i**2 * l_i, ω_j**2 * l_j
    ε_i = k.eps(i, over(plus(on(a, φ_j), n_i * cos(apart), -n_j), l_i * sin(apart)))
    ε_j = k.eps(j, over(plus(on(a, φ_i), n_i, -(n_j * cos(apart))), l_j * sin(apart)))

    k.closure(tip, add(T.p, scaled(l_j, along(φ_j))))
    inward = add(a, scaled(n_i, along(φ_i)), scaled(minus(n_j), along(φ_j)))
    u, w = scaled(l_i, turned(along(φ_i))), scaled(minus(l_j), turned(along(φ_j)))
    k.enter_matrix_form(u, w, (ω_i, ω_j, v), (ε_i, ε_j, inward))
    first = LoopBody(str(dyad.start), P, φ_i, ω_i, ε_i)
    k.point(Q, first.carried(at))
    k.put(i, first)
    k.put(j, LoopBody(str(dyad.end), T, φ_j, ω_j, ε_j))


def _rrp(k: ClosedLoops, dyad: Dyad) -> None:
    i, j = dyad.links
    P, Q, rail = k.points[str(dyad.start)], dyad.middle, k.rail(j, dyad.end)
    l, α, joint = Ref(ids.length(str(dyad.start), Q)), rail.angle, ids.joint(rail.link, j)  # noqa: E741
    d = k.line("place", ids.loop_distance(k.group), across(less(P.p, rail.at), α))
    dip = asin(d / l)
    from_guide = -dip if dyad.sign > 0 else STRAIGHT + dip
    φ = k.line("place", ids.formula_angle(i), from_guide if is_zero(α) else plus(α, from_guide))
    tip = add(P.p, scaled(l, along(φ)))
    at = k.coordinates(Q, (tip[0], rail.at[1]) if is_zero(α) else tip)
    base, apart = k.beneath(Q, rail, at), between(φ, α)

    v, a, n = less(base.v, P.v), less(base.a, P.a), Ref(ids.formula(ids.angular_velocity(i))) ** 2 * l
    ω = k.omega(i, over(across(v, α), times(l, cosine(apart))))
    sliding = over(minus(on(v, φ)), cosine(apart))
    fixed = rail.link == GROUND
    rate = (
        k.known("velocity", ids.velocity(Q), sliding)
        if fixed
        else k.line("velocity", ids.slide_velocity(joint), sliding)
    )
    twice = times(TWO, rail.carrier.omega, rate)
    ε = k.eps(i, over(plus(across(a, α), twice, times(n, sine(apart))), times(l, cosine(apart))))
    sliding = over(minus(plus(on(a, φ), n, times(twice, sine(apart)))), cosine(apart))
    rate2 = (
        k.known("acceleration", ids.acceleration(Q), sliding)
        if fixed
        else k.line("acceleration", ids.slide_acceleration(joint), sliding)
    )

    k.closure(tip, add(rail.at, scaled(Symbol("s", joint), along(α))))
    e, square_to_e = along(α), turned(along(α))
    right = add(a, scaled(twice, square_to_e), scaled(n, along(φ)))
    k.enter_matrix_form(scaled(l, turned(along(φ))), scaled(MINUS_ONE, e), (ω, rate, v), (ε, rate2, right))
    if fixed:
        k.points[Q] = Moving(at, scaled(rate, e), scaled(rate2, e))
    else:
        k.point(Q, Moving(at, add(base.v, scaled(rate, e)), add(base.a, scaled(twice, square_to_e), scaled(rate2, e))))
    k.put(i, LoopBody(str(dyad.start), P, φ, ω, ε))
    k.put(j, LoopBody(Q, k.points[Q], α, rail.carrier.omega, rail.carrier.eps))


def _rpr(k: ClosedLoops, dyad: Dyad) -> None:
    i, j = dyad.links
    P, T, joint = k.points[str(dyad.start)], k.points[str(dyad.end)], ids.joint(j, i)
    relative, e = f"{dyad.middle}{dyad.start}", as_expression(0.0)
    if offset := dyad.lengths[1]:
        e = signed(offset, Ref(ids.length(str(dyad.end), f"H{j}")))
    x, y = r = less(P.p, T.p)
    s = k.line("place", ids.slide_way(joint), signed(dyad.sign, sqrt(plus(square(x), square(y), minus(square(e))))))
    towards = atan2(y, x) if dyad.sign > 0 or offset else atan2(y, x) + STRAIGHT
    φ = k.line("place", ids.formula_angle(j), towards - atan2(e, s) if offset else towards)

    v, a = less(P.v, T.v), less(P.a, T.a)
    ω = k.omega(j, over(across(v, φ), s))
    rate = k.line("velocity", ids.slide_velocity(joint), plus(on(v, φ), times(ω, e)))
    ε = k.eps(j, over(plus(across(a, φ), times(ω**2, e), -(2 * ω * rate)), s))
    rate2 = k.line("acceleration", ids.slide_acceleration(joint), plus(on(a, φ), times(ε, e), ω**2 * s))
    k.compared += [(ids.velocity(relative), rate.id), (ids.acceleration(relative, "r"), rate2.id)]
    k.omega(i, ω)
    k.eps(i, ε)

    slot, square_to_slot = along(φ), turned(along(φ))
    k.closure(add(T.p, scaled(s, slot), scaled(e, square_to_slot)), P.p)
    right = add(a, scaled(ω**2, r), scaled(minus(2 * ω * rate), square_to_slot))
    k.enter_matrix_form(add(scaled(s, square_to_slot), scaled(minus(e), slot)), slot, (ω, rate, v), (ε, rate2, right))
    lever = LoopBody(str(dyad.end), T, φ, ω, ε)
    k.point(dyad.middle, lever.carried(P.p))
    k.put(i, LoopBody(str(dyad.start), P, φ, ω, ε))
    k.put(j, lever)


def _prp(k: ClosedLoops, dyad: Dyad) -> None:
    i, j = dyad.links
    Q = dyad.middle
    rail1, rail2 = k.rail(i, dyad.start), k.rail(j, dyad.end)
    first, second = ids.joint(rail1.link, i), ids.joint(rail2.link, j)
    α, β, apart = rail1.angle, rail2.angle, between(rail2.angle, rail1.angle)
    s = k.line("place", ids.slide_way(first), over(minus(across(less(rail2.at, rail1.at), β)), sine(apart)))
    place = add(rail1.at, scaled(s, along(α)))
    at = k.coordinates(Q, place)
    bases = k.beneath(Q, rail1, at), k.beneath(Q, rail2, at)

    v, a = less(bases[1].v, bases[0].v), less(bases[1].a, bases[0].a)
    rate = k.line("velocity", ids.slide_velocity(first), over(minus(across(v, β)), sine(apart)))
    second_rate = k.line("velocity", ids.slide_velocity(second), over(minus(across(v, α)), sine(apart)))
    c, c_other = times(TWO, rail1.carrier.omega, rate), times(TWO, rail2.carrier.omega, second_rate)
    top = plus(minus(across(a, β)), times(c, cosine(apart)), minus(c_other))
    rate2 = k.line("acceleration", ids.slide_acceleration(first), over(top, sine(apart)))
    top = plus(minus(across(a, α)), c, minus(times(c_other, cosine(apart))))
    other2 = k.line("acceleration", ids.slide_acceleration(second), over(top, sine(apart)))

    e, e_other = along(α), along(β)
    k.closure(place, add(rail2.at, scaled(Symbol("s", second), e_other)))
    right = add(a, scaled(c_other, turned(e_other)), scaled(minus(c), turned(e)))
    k.enter_matrix_form(e, scaled(MINUS_ONE, e_other), (rate, second_rate, v), (rate2, other2, right))
    k.point(Q, Moving(at, add(bases[0].v, scaled(rate, e)), add(bases[0].a, scaled(c, turned(e)), scaled(rate2, e))))
    for link, rail in ((i, rail1), (j, rail2)):
        k.put(link, LoopBody(Q, k.points[Q], rail.angle, rail.carrier.omega, rail.carrier.eps))


def _rpp(k: ClosedLoops, dyad: Dyad) -> None:
    i, j = dyad.links
    P, Q, rail = k.points[str(dyad.start)], dyad.middle, k.rail(j, dyad.end)
    on_guide, in_slot = ids.joint(rail.link, j), ids.joint(j, i)
    α, ψ, ω = rail.angle, degrees(dyad.slide_angle), rail.carrier.omega
    β = Number(α.value + ψ.value, unit="°") if isinstance(α, Number) else α + ψ
    s = k.line("place", ids.slide_way(on_guide), over(minus(across(less(P.p, rail.at), β)), sine(ψ)))
    place = add(rail.at, scaled(s, along(α)))
    at = k.coordinates(Q, place)
    base, start = k.beneath(str(dyad.start), rail, P.p, plan=False), k.beneath(Q, rail, at, plan=False)

    v, a = less(P.v, base.v), less(P.a, base.a)
    rate = k.line("velocity", ids.slide_velocity(on_guide), over(minus(across(v, β)), sine(ψ)))
    slot_rate = k.line("velocity", ids.slide_velocity(in_slot), over(across(v, α), sine(ψ)))
    top = plus(minus(across(a, β)), times(TWO, ω, plus(times(rate, cosine(ψ)), slot_rate)))
    rate2 = k.line("acceleration", ids.slide_acceleration(on_guide), over(top, sine(ψ)))
    top = plus(across(a, α), minus(times(TWO, ω, plus(rate, times(slot_rate, cosine(ψ))))))
    other2 = k.line("acceleration", ids.slide_acceleration(in_slot), over(top, sine(ψ)))

    e, slot = along(α), along(β)
    k.closure(add(place, scaled(Symbol("s", in_slot), slot)), P.p)
    right = add(a, scaled(minus(times(TWO, ω)), add(scaled(rate, turned(e)), scaled(slot_rate, turned(slot)))))
    k.enter_matrix_form(e, slot, (rate, slot_rate, v), (rate2, other2, right))
    twice = times(TWO, ω, rate)
    k.point(Q, Moving(at, add(start.v, scaled(rate, e)), add(start.a, scaled(twice, turned(e)), scaled(rate2, e))))
    k.put(i, LoopBody(str(dyad.start), P, α, ω, rail.carrier.eps))
    k.put(j, LoopBody(Q, k.points[Q], α, ω, rail.carrier.eps))


KINDS: Mapping[DyadKind, Callable[[ClosedLoops, Dyad], None]] = {
    "RRR": _rrr,
    "RRP": _rrp,
    "RPR": _rpr,
    "PRP": _prp,
    "RPP": _rpp,
}
