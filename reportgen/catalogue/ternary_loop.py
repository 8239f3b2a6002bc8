"""Closed vector loops of a group of class III (3RRR): a ternary link on three legs.

With the first leg 1 from P to D, the ternary link 3 with origin D, and leg j from Q_j to the joint T_j at the place
(u, w) of the ternary link, the two loops are

    r_P + l₁ e₁ + u e₃ + w n₃ = r_Qj + l_j e_j,   j = second and third leg.

Their positions have no closed form: they lead to an equation of the sixth degree. φ₁ and φ₃ are found by Newton's
iteration. The demand that T_j is at the distance l_j from Q_j, differentiated, is linear in the rates:

    k_j1 ω₁ + k_j3 ω₃ = e_j·(v_Q − v_P),   k_j1 = l₁ sin(φ_j − φ₁),   k_j3 = u sin(φ_j − φ₃) − w cos(φ_j − φ₃),

and k are also the derivatives that the iteration needs. Its determinant is zero at a dead point.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from reportgen.base.arrays import Flags, Floats
from reportgen.base.records import Record
from reportgen.catalogue import ternary_ids
from reportgen.catalogue.loop_bodies import LoopBody, Moving
from reportgen.catalogue.loop_builder import LoopBuilder
from reportgen.catalogue.vector_components import VectorComponents, across, add, along, less, on, scaled, turned, typed
from reportgen.formula import (
    PI,
    Chain,
    Expression,
    Matrix,
    Number,
    Ref,
    Symbol,
    atan2,
    column,
    cos,
    ids,
    minus,
    over,
    plus,
    sin,
    sqrt,
    square,
    times,
)
from reportgen.formula.calculation import Calculation
from reportgen.formula.constructions import cross
from reportgen.machine import Triad, TriadLeg

HALF_TURN = Number(180.0, unit="°")
CONVERGED = 1e-9
"""A correction (rad) after which the iteration ends: the error then is about its square."""
FEWEST, MOST = 2, 8
"""Numbers of steps of the iteration; only beside a dead point it takes more than 4."""
READINGS = (0, 1, 2, 3, 12)
"""Decimals of a degree to which the first angles are read: the fewest that lead to the assembly of the drawing.

Beside a dead point two assemblies are less than a degree apart. The last reading is the angle itself.
"""


class LegLoop(Record):
    """The loop over the first leg, the ternary link and another `leg`, for any angles of these links.

    `u` and `w` are the coordinates of the leg's joint on the ternary link.
    """

    leg: TriadLeg
    u: Expression
    w: Expression
    outer: Moving
    base: Moving
    first_length: Ref

    @property
    def length(self) -> Ref:
        """The length of the leg."""
        return Ref(ids.length(self.leg.outer, self.leg.inner))

    def inner(self, first: Expression, plate: Expression) -> VectorComponents:
        """Return the place of the leg's inner joint, reached over the first leg and the ternary link."""
        e = along(plate)
        tip = add(self.base.p, scaled(self.first_length, along(first)))
        return add(tip, scaled(self.u, e), scaled(self.w, turned(e)))

    def arms_across(self, own: Expression, first: Expression, plate: Expression) -> VectorComponents:
        """Return k of the first leg and k of the ternary link: velocity along this leg for ω = 1."""
        apart = own - plate
        of_plate = plus(times(self.u, sin(apart)), minus(times(self.w, cos(apart))))
        return self.first_length * sin(own - first), of_plate

    def arms_along(self, own: Expression, first: Expression, plate: Expression) -> VectorComponents:
        """Return h of the first leg and h of the ternary link: velocity across this leg for ω = 1."""
        apart = own - plate
        of_plate = plus(times(self.u, cos(apart)), times(self.w, sin(apart)))
        return self.first_length * cos(own - first), of_plate


def cramer(rows: Sequence[VectorComponents], right: VectorComponents) -> VectorComponents:
    """Return both unknowns of two linear equations by Cramer's rule."""
    (a, b), (c, d) = rows
    p, q = right
    determinant = plus(times(a, d), minus(times(b, c)))
    first, second = plus(times(p, d), minus(times(b, q))), plus(times(a, q), minus(times(p, c)))
    return over(first, determinant), over(second, determinant)


# --- positions ------------------------------------------------------------------------------------


class AngleIteration(Record):
    """Newton's iteration for the angles of the first leg and of the ternary link.

    It starts from both angles as they are read from the drawing: to a degree, more finely at positions beside a dead
    point.
    """

    triad: Triad
    loops: tuple[LegLoop, LegLoop]
    part: str

    def enter(self, q: Calculation) -> tuple[Ref, Ref]:
        """Enter all steps in a calculation that has the plans; return the angles of the first leg and the plate.

        There are as many steps as the slowest position needs.
        """
        first, *_ = self.triad.legs
        links = first.link, self.triad.plate
        angles = [
            q.give(ternary_ids.trial_angle(0, link), read, Symbol("φ", str(link), "(0)"), trial=True)
            for link, read in zip(links, self._read(q), strict=True)
        ]
        for number in range(MOST):
            step = _Step(q, number)
            corrections = self._corrections(step, *angles)
            following = _Step(q, number + 1)
            angles = [
                following.define(ternary_ids.trial_angle, "φ", link, angle + correction, scale=1.0)
                for link, angle, correction in zip(links, angles, corrections, strict=True)
            ]
            size = max(float(np.nanmax(np.abs(q.value(one)), initial=0.0)) for one in corrections)
            if number + 1 >= FEWEST and size < CONVERGED:
                break
        φ, φ_plate = (
            q.define(ids.formula_angle(link), angle, scale=1.0) for link, angle in zip(links, angles, strict=True)
        )
        return φ, φ_plate

    def _read(self, q: Calculation) -> tuple[Floats, Floats]:
        """Return both angles (rad) [N] as they are read from the drawing, each position as finely as it needs."""
        first = self.triad.legs[0]
        rod = q.value(ids.place(first.inner)) - q.value(ids.place(first.outer))
        turn = q.value(ids.link_axis(self.triad.plate))
        drawn = np.degrees(np.angle(np.broadcast_arrays(rod, turn)))
        read = np.round(drawn, READINGS[0])
        for decimals in READINGS[1:]:
            strays = ~self._leads_to(q, np.radians(drawn), np.radians(read))
            read = np.where(strays, np.round(drawn, decimals), read)
        return np.radians(read[0]), np.radians(read[1])

    def _leads_to(self, q: Calculation, drawn: Floats, read: Floats) -> Flags:
        """Return True where the iteration converges from the angles `read` [2, N] to those `drawn`."""
        first, *others = self.triad.legs
        start, length = q.value(ids.place(first.outer)), q.value(ids.length(first.outer, first.inner))
        angles = read
        with np.errstate(divide="ignore", invalid="ignore"):
            for _ in range(MOST):
                rod, turn = np.exp(1j * angles)
                rows: list[tuple[Floats, Floats]] = []
                gaps: list[Floats] = []
                for leg, local in zip(others, self.triad.at, strict=True):
                    reach = start + length * rod + local * turn - q.value(ids.place(leg.outer))
                    e = reach / np.abs(reach)
                    rows.append((cross(length * rod, e), cross(local * turn, e)))
                    gaps.append(leg.length - np.abs(reach))
                (a, b), (c, d) = rows
                determinant = a * d - b * c
                corrections = np.array([gaps[0] * d - b * gaps[1], a * gaps[1] - gaps[0] * c]) / determinant
                angles = angles + corrections
        apart = np.abs(np.exp(1j * angles) - np.exp(1j * drawn)).max(axis=0)
        return np.asarray((np.abs(corrections).max(axis=0) < CONVERGED) & (apart < CONVERGED))

    def _corrections(self, step: _Step, first: Ref, plate: Ref) -> list[Ref]:
        """Enter the gap and the direction of each leg, the arms, and the corrections of both angles."""
        turning = self.triad.legs[0].link, self.triad.plate
        rows: list[VectorComponents] = []
        gaps: list[Expression] = []
        for loop in self.loops:
            link = loop.leg.link
            reach = less(loop.inner(first, plate), loop.outer.p)
            x, y = (
                step.define(ternary_ids.trial_x, "x", link, reach[0]),
                step.define(ternary_ids.trial_y, "y", link, reach[1]),
            )
            own = step.define(ternary_ids.trial_angle, "φ", link, atan2(y, x), scale=1.0)
            gap = step.define(ternary_ids.trial_gap, "Δl", link, sqrt(x**2 + y**2) - loop.length, scale=1.0)
            gaps.append(minus(gap))
            of_first, of_plate = (
                step.define(ternary_ids.trial_arm, "k", ids.joint(link, turned_link), arm)
                for turned_link, arm in zip(turning, loop.arms_across(own, first, plate), strict=True)
            )
            rows.append((of_first, of_plate))
        return [
            step.define(ternary_ids.trial_step, "Δφ", link, HALF_TURN / PI * radians, scale=1.0)
            for link, radians in zip(turning, cramer(rows, (gaps[0], gaps[1])), strict=True)
        ]


class _Step(Record):
    """A step of the iteration: the `number` of steps before it, which its symbols have, e.g. φ₂⁽¹⁾."""

    q: Calculation
    number: int

    def define(
        self, name: Callable[..., str], letter: str, index: int | str, formula: Expression, scale: float = 0.0
    ) -> Ref:
        id, symbol = name(self.number, index), Symbol(letter, str(index), f"({self.number})")
        return self.q.define(id, formula, symbol, scale=scale, trial=True)


# --- the group ------------------------------------------------------------------------------------


def enter_ternary(k: LoopBuilder, triad: Triad) -> None:
    """Add the loops of a group of class III: angles, points, and the linear equations of both rates."""
    first, *others = triad.legs
    base, length = k.points[first.outer], Ref(ids.length(first.outer, first.inner))
    loops = [
        LegLoop(leg, *_coordinates(triad, leg, local), k.points[leg.outer], base, length)
        for leg, local in zip(others, triad.at, strict=True)
    ]
    φ, φ_plate = Ref(ids.formula_angle(first.link)), Ref(ids.formula_angle(triad.plate))
    k.lines.append(AngleIteration(triad, (loops[0], loops[1]), f"place-{k.group}"))
    tip = k.coordinates(first.inner, add(base.p, scaled(length, along(φ))))
    places = [k.coordinates(loop.leg.inner, _from_tip(loop, tip, φ_plate)) for loop in loops]
    own = [
        k.line("place", ids.formula_angle(loop.leg.link), atan2(*reversed(less(place, loop.outer.p))))
        for loop, place in zip(loops, places, strict=True)
    ]
    _print_equations(k, triad, loops)

    turning = first.link, triad.plate
    rows: list[tuple[Ref, Ref]] = []
    sides: list[tuple[Ref, Ref]] = []
    for loop, angle in zip(loops, own, strict=True):
        joints = [ids.joint(loop.leg.link, link) for link in turning]
        pairs = [
            (id, loop_arms)
            for id, loop_arms in (
                (ternary_ids.across, loop.arms_across(angle, φ, φ_plate)),
                (ternary_ids.along, loop.arms_along(angle, φ, φ_plate)),
            )
        ]
        (k1, k3), (h1, h3) = (
            [k.line("velocity", name(joint), arm) for joint, arm in zip(joints, arms, strict=True)]
            for name, arms in pairs
        )
        rows.append((k1, k3))
        sides.append((h1, h3))
    right = tuple(
        _side(k, "v", loop, on(less(loop.outer.v, base.v), angle)) for loop, angle in zip(loops, own, strict=True)
    )
    ω, ω_plate = map(k.omega, turning, cramer(rows, (right[0], right[1])))
    rates = [
        k.omega(loop.leg.link, over(plus(across(less(base.v, loop.outer.v), angle), h1 * ω, h3 * ω_plate), loop.length))
        for loop, angle, (h1, h3) in zip(loops, own, sides, strict=True)
    ]
    inward = tuple(
        _side(
            k,
            "a",
            loop,
            plus(on(less(loop.outer.a, base.a), angle), ω**2 * h1, ω_plate**2 * h3, minus(rate**2 * loop.length)),
        )
        for loop, angle, (h1, h3), rate in zip(loops, own, sides, rates, strict=True)
    )
    ε, ε_plate = map(k.eps, turning, cramer(rows, (inward[0], inward[1])))
    accelerations = [
        k.eps(
            loop.leg.link,
            over(
                plus(across(less(base.a, loop.outer.a), angle), *(h1 * ε, h3 * ε_plate, ω**2 * k1, ω_plate**2 * k3)),
                loop.length,
            ),
        )
        for loop, angle, (h1, h3), (k1, k3) in zip(loops, own, sides, rows, strict=True)
    ]

    matrix = Matrix(tuple(rows))
    for what, unknowns, known in (("velocity", (ω, ω_plate), right), ("acceleration", (ε, ε_plate), inward)):
        k.equations[f"{what}-{k.group}"] = (Chain((matrix * column(*unknowns), column(*known))),)
    leg = LoopBody(first.outer, base, φ, ω, ε)
    joint = k.point(first.inner, leg.carried(tip))
    plate = LoopBody(first.inner, joint, φ_plate, ω_plate, ε_plate)
    for loop, place in zip(loops, places, strict=True):
        k.point(loop.leg.inner, plate.carried(place))
    k.put(first.link, leg)
    k.put(triad.plate, plate)
    for loop, angle, rate, rate2 in zip(loops, own, rates, accelerations, strict=True):
        k.put(loop.leg.link, LoopBody(loop.leg.outer, loop.outer, angle, rate, rate2))


def _coordinates(triad: Triad, leg: TriadLeg, local: complex) -> VectorComponents:
    """Return the coordinates of a leg's joint on the ternary link; on the link's axis, its distance by symbol."""
    if local.imag or local.real < 0:
        return typed(local)
    return Ref(ids.length(triad.legs[0].inner, leg.inner)), typed(local)[1]


def _from_tip(loop: LegLoop, tip: VectorComponents, plate: Expression) -> VectorComponents:
    e = along(plate)
    return add(tip, scaled(loop.u, e), scaled(loop.w, turned(e)))


def _side(k: LoopBuilder, what: str, loop: LegLoop, formula: Expression) -> Expression:
    """Enter the right-hand side of a leg's equation, unless it is zero."""
    part = {"v": "velocity", "a": "acceleration"}[what]
    return formula if isinstance(formula, Number) else k.line(part, ternary_ids.side(what, loop.leg.link), formula)


def _print_equations(k: LoopBuilder, triad: Triad, loops: Sequence[LegLoop]) -> None:
    """Enter the closed loops and the formulas of a step of the iteration, as the report prints them."""
    first, plate = triad.legs[0].link, triad.plate
    angles = φ, φ_plate = Ref(ids.formula_angle(first)), Ref(ids.formula_angle(plate))
    closures: list[Chain] = []
    step: list[Chain] = []
    for loop in loops:
        link = str(loop.leg.link)
        own = Ref(ids.formula_angle(loop.leg.link))
        back = add(loop.outer.p, scaled(loop.length, along(own)))
        closures += [Chain(sides) for sides in zip(loop.inner(φ, φ_plate), back, strict=True)]
        x, y = Symbol("x", link), Symbol("y", link)
        reach = less(loop.inner(φ, φ_plate), loop.outer.p)
        step += [Chain((x, reach[0])), Chain((y, reach[1]))]
        step += [Chain((own, atan2(y, x))), Chain((Symbol("Δl", link), sqrt(square(x) + square(y)) - loop.length))]
        step += [
            Chain((Ref(ternary_ids.across(ids.joint(loop.leg.link, turning))), arm))
            for turning, arm in zip((first, plate), loop.arms_across(own, *angles), strict=True)
        ]
    k.equations[f"closure-{k.group}"] = tuple(closures)
    rows = [[Ref(ternary_ids.across(ids.joint(loop.leg.link, link))) for link in (first, plate)] for loop in loops]
    unknowns = column(*(Symbol("Δφ", str(link)) for link in (first, plate)))
    gaps = column(*(minus(Symbol("Δl", str(loop.leg.link))) for loop in loops))
    k.equations[f"step-{k.group}"] = tuple(step)
    k.equations[f"correction-{k.group}"] = (Chain((Matrix(tuple(map(tuple, rows))) * unknowns, gaps)),)
