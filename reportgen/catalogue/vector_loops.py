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

`ternary_loop` has the two loops of a group of class III.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from reportgen.catalogue.loop_bodies import LoopBody, Moving
from reportgen.catalogue.loop_builder import LoopBuilder
from reportgen.catalogue.ternary_loop import enter_ternary
from reportgen.catalogue.vector_components import across, add, along, degrees, less, on, scaled, turned
from reportgen.formula import (
    MINUS_ONE,
    Number,
    Ref,
    Symbol,
    acos,
    as_expression,
    asin,
    atan2,
    between,
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
)
from reportgen.machine import GROUND, Dyad, DyadKind, Triad

TWO = Number(2.0)
STRAIGHT = Number(180.0, unit="°")


# --- the kinds ------------------------------------------------------------------------------------


def _rrr(k: LoopBuilder, dyad: Dyad) -> None:
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


def _rrp(k: LoopBuilder, dyad: Dyad) -> None:
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


def _rpr(k: LoopBuilder, dyad: Dyad) -> None:
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


def _prp(k: LoopBuilder, dyad: Dyad) -> None:
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


def _rpp(k: LoopBuilder, dyad: Dyad) -> None:
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


KINDS: Mapping[DyadKind, Callable[[LoopBuilder, Dyad], None]] = {
    "RRR": _rrr,
    "RRP": _rrp,
    "RPR": _rpr,
    "PRP": _prp,
    "RPP": _rpp,
}


@dataclass
class ClosedLoops(LoopBuilder):
    """The loops of a whole linkage."""

    def __post_init__(self) -> None:
        super().__post_init__()
        for group in self.linkage.groups:
            self.group = ids.members(group.links)
            if isinstance(group, Triad):
                enter_ternary(self, group)
            else:
                KINDS[group.kind](self, group)
