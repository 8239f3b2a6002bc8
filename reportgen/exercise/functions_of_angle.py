"""Equations of motion of a body whose position is a function of its angle alone, and their derivatives.

Such a body rolls on a fixed line, or has two points on fixed lines that meet; each of its points has P(φ) = fixed +
linear·φ + forward e^{iφ} + backward e^{−iφ} (m).  All other bodies follow from the loops of the system (`by_loops`).
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from itertools import combinations

import numpy as np

from reportgen.base.records import Record
from reportgen.catalogue.vector_components import VectorComponents
from reportgen.exercise import file
from reportgen.exercise.chain_derivatives import ACCELERATION, RATES, VELOCITY, derivative
from reportgen.exercise.derivation import Derivation, Step, size_of
from reportgen.exercise.instant_centres import SAME_PLACE, Layout
from reportgen.exercise.motion_equations import EquationsOfMotion, VectorSum
from reportgen.exercise.point_positions import name_of, parallel, unit
from reportgen.exercise.position_chains import (
    CoordinateRate,
    Linked,
    LoopVector,
    SlideTravel,
    Turn,
    given_direction,
    legs_of,
)
from reportgen.exercise.rate_conditions import GROUND
from reportgen.exercise.rate_solution import NEGLIGIBLE, unknowns_of
from reportgen.formula import (
    NOTHING,
    ONE,
    Expression,
    Number,
    Ref,
    Symbol,
    cos,
    cosine,
    ids,
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
from reportgen.formula.constructions import cross, dot, meet
from reportgen.formula.evaluation import evaluate

STRAIGHT = Number(180.0, unit="°")


class MotionLaw(Record):
    """Position of a point (m) as a function of its body's angle φ: four complex coefficients."""

    fixed: complex
    linear: complex
    forward: complex
    backward: complex

    def derivative(self) -> MotionLaw:
        """Return the law of the derivative by the angle."""
        return MotionLaw(self.linear, 0j, 1j * self.forward, -1j * self.backward)

    def components(self, φ: Ref, constant: Callable[[float], Expression]) -> VectorComponents:
        """Return c₀ + c₁φ + c₂ cos φ + c₃ sin φ along x and y (m); `constant` turns a number (m) into a
        printed letter.
        """
        both, apart = self.forward + self.backward, 1j * (self.forward - self.backward)
        terms: tuple[tuple[complex, Expression], ...]
        terms = (self.fixed, ONE), (self.linear, φ), (both, cos(φ)), (apart, sin(φ))
        x = plus(*(times(constant(of.real), function) for of, function in terms))
        return x, plus(*(times(constant(of.imag), function) for of, function in terms))


def motion_laws(layout: Layout, body: int) -> tuple[float, dict[str, MotionLaw]] | None:
    """Return the angle (rad) of a body at the instant and the laws of its points; None if joints with the ground do not
    fix both.
    """
    points, names = layout.points, layout.own(body)
    centre, disc = layout.centres.get(body), layout.given.disc(body)
    if centre is not None and centre.by_joint:
        # Bodies that turn about a fixed point or do not rotate are solved before any method.
        return None
    if centre is not None and centre.rule == "contact" and disc is not None and disc.centre in layout.slots:
        middle = points[disc.centre]
        track, own = 1j * (middle - centre.at), dict.fromkeys((disc.centre, *names))
        return 0.0, {name: MotionLaw(middle, track, points[name] - middle, 0j) for name in own}
    for base, tip in combinations([name for name in names if name in layout.slots], 2):
        e, f, rod = layout.slots[base], layout.slots[tip], points[tip] - points[base]
        if not parallel(e, f) and abs(rod) > SAME_PLACE:
            at, φ = meet(points[base], e, points[tip], f), cmath.phase(rod)
            # The first point is at s e from where the lines meet, s = −l (e^{iφ} × f)/(e × f).
            share = abs(rod) * e / (2j * cross(e, f))
            arms = {name: (points[name] - points[base]) * cmath.exp(-1j * φ) for name in names}
            ahead, back = share * f.conjugate(), -share * f
            return φ, {name: MotionLaw(at, 0j, ahead + arm, back) for name, arm in arms.items()}
    return None


def by_equations(derivation: Derivation) -> bool:
    """Enter the rates of one more body from the equations of motion of its points; when none is left, use the loops."""
    if coordinates(derivation.layout) != 1:
        return False
    for body in derivation.layout.members:
        if not derivation.knows(ids.formula_angle(body)):
            laws = motion_laws(derivation.layout, body)
            if laws is not None and not derivation.closed and _enter(derivation, body, *laws):
                return True
    return by_loops(derivation)


def as_number(value: float) -> Expression:
    """Return a constant (m) as a number, exactly 0 below the smallest length."""
    return NOTHING if abs(value) < SAME_PLACE else Number(float(f"{value:.10g}"))


def _constant(derivation: Derivation, value: float) -> Expression:
    """Return a constant (m) as a letter if it is a length of the derivation, otherwise as a number."""
    q = derivation.q
    lengths = (id for id in q.families if id in ids.length)
    same = next((id for id in lengths if abs(q.si(id) - abs(value)) < SAME_PLACE), None)
    return signed(value, q[same]) if same and abs(value) > SAME_PLACE else as_number(value)


# --- a body by itself -----------------------------------------------------------------------------


def _enter(derivation: Derivation, body: int, angle: float, laws: Mapping[str, MotionLaw]) -> bool:
    """Enter positions, velocities and, if the data give one of the body, accelerations; return True if a rate is known
    now.
    """
    q, motion = derivation.q, derivation.motion
    known = [name for name in laws if derivation.knows_velocity(name) and q.si(ids.velocity(name))]
    if not (known or derivation.knows_omega(body)):
        return False
    lines: list[str] = []

    def line(id: str, formula: Expression, symbol: Symbol | str = "") -> Ref:
        lines.append(id)
        return q.define(id, formula, symbol)

    constant = partial(_constant, derivation)
    φ = q.give(ids.formula_angle(body), angle, Symbol("φ", str(body)), exact=False)
    for base, tip in combinations(laws, 2):
        derivation.length(base, tip)
    for name, law in laws.items():
        for axis, place in zip("xy", law.components(φ, constant), strict=True):
            if not isinstance(place, Number):
                line(ids.formula_coordinate(axis, name), place)
    first = {name: law.derivative() for name, law in laws.items()}
    rates = {name: law.components(φ, constant) for name, law in first.items()}
    if not derivation.knows_omega(body):
        whole = _size(derivation, rates[known[0]])
        line(ids.angular_velocity(body), over(q[ids.velocity(known[0])], whole))
    ω = q[ids.angular_velocity(body)]
    turning = ω if motion.omega(body) >= 0 else minus(ω)
    for name, (x, y) in rates.items():
        _vector(derivation, line, "v", name, (times(turning, x), times(turning, y)))
    second = {name: law.derivative().components(φ, constant) for name, law in first.items()}
    ε = _acceleration(derivation, line, body, ω, rates, second)
    if ε is not None:
        for name in laws:
            x, y = (
                plus(times(ε, x_or_y), times(square(ω), two))
                for x_or_y, two in zip(rates[name], second[name], strict=True)
            )
            _vector(derivation, line, "a", name, (x, y))
    derivation.steps.append(Step("equations", (φ.id, *lines), body))
    return True


def _vector(derivation: Derivation, line: Callable[..., Ref], what: str, name: str, parts: VectorComponents) -> None:
    """Enter a velocity or acceleration by its components, and its magnitude if that is not known."""
    sides = [
        line(ids.COMPONENT[what](name, axis), part, Symbol(what, f"{name}{axis}"))
        for axis, part in zip("xy", parts, strict=True)
        if part != NOTHING and not derivation.knows(ids.COMPONENT[what](name, axis))
    ]
    if sides and not derivation.knows(ids.POINT_RATE[what](name)):
        line(ids.POINT_RATE[what](name), size_of(derivation.q, sides))


def _acceleration(
    derivation: Derivation,
    line: Callable[..., Ref],
    body: int,
    ω: Ref,
    rates: Mapping[str, VectorComponents],
    second: Mapping[str, VectorComponents],
) -> Expression | None:
    """Return ε with its sign, as given or from the given acceleration of a point, a = ε P′ + ω² P″; None without
    either.
    """
    sense = derivation.motion.epsilon(body) if derivation.motion.knows_epsilon(body) else 0.0
    id = ids.angular_acceleration(body)
    for rate in derivation.layout.given.given:
        match rate:
            case file.EpsilonOf(body=of, value=value) if of == body:
                return signed(sense or 1.0, derivation.given(id, value.si)) if value.si else NOTHING
            case file.AccelerationOf(point=point, size=size, direction=direction) if (
                size is not None and point in rates
            ):
                values = [abs(_value(derivation, part)) for part in rates[point]]
                index = int(values[1] > values[0])
                heading = math.degrees(direction.si) + (180.0 if size.si < 0 else 0.0)
                degrees = Number(float(f"{heading:.10g}"), unit="°")
                given = times(derivation.given(ids.acceleration(point), size.si), (cosine, sine)[index](degrees))
                top = plus(given, minus(times(square(ω), second[point][index])))
                return signed(sense or 1.0, line(id, signed(sense or 1.0, over(top, rates[point][index]))))
    return None


def _value(derivation: Derivation, part: Expression) -> float:
    evaluated = evaluate(part, {id: one.values for id, one in derivation.q.families.items()})
    return float(np.real(np.atleast_1d(evaluated)[0]))


def _size(derivation: Derivation, parts: VectorComponents) -> Expression:
    """Return the magnitude of a vector from its components, as printed."""
    kept = [part for part in parts if part != NOTHING]
    if len(kept) == 1:
        return signed(_value(derivation, kept[0]), kept[0])
    return sqrt(plus(*(square(part) for part in kept)))


# --- all bodies together ----------------------------------------------------------------------------


def coordinates(layout: Layout) -> int:
    """Return the number of coordinates of the bodies with determined motion: their joints leave so many
    motions open.
    """
    motion = layout.motion
    unknowns = unknowns_of(motion.system)
    sized = {
        name_of(index, "given", *rate.called)
        for index, rate in enumerate(layout.given.given)
        if not isinstance(rate, file.VelocityOf) or rate.size is not None
    }
    held = [one for one in motion.system.conditions if one.velocity is not None and one.name not in sized]
    matrix = np.array([unknowns.row(one) for one in held]).reshape(len(held), unknowns.count)
    _, sizes, motions = np.linalg.svd(matrix)
    rank = int((sizes > NEGLIGIBLE * max(sizes, default=0.0)).sum())
    known = [body for body in unknowns.bodies if motion.knows_omega(body) and motion.knows_centre(body)]
    known = known or [*unknowns.bodies]
    columns = [3 * unknowns.bodies.index(body) + part for body in known for part in range(3)]
    free = motions[rank:, columns]
    return int(np.linalg.matrix_rank(free, NEGLIGIBLE)) if free.size else 0


def by_loops(derivation: Derivation) -> bool:
    """Enter all rates of a system with one coordinate from its loops; return False if that was tried before."""
    if derivation.closed:
        return False
    derivation.closed = True
    linked = Linked(derivation)
    equations = EquationsOfMotion(derivation, linked)
    given = derivation.layout.given.given
    _solve(equations, [one for one in given if isinstance(one, file.VelocityOf | file.FromRest)])
    accelerations = [one for one in given if isinstance(one, file.AccelerationOf | file.FromRest)]
    turns = [one for one in given if isinstance(one, file.EpsilonOf)]
    for turning in turns:
        derivation.given(ids.angular_acceleration(turning.body), turning.value.si)
    if turns or accelerations:
        equations.order = ACCELERATION
        _solve(equations, accelerations)
    return True


def _solve(equations: EquationsOfMotion, given: Sequence[file.GivenRate]) -> None:
    """Solve the equations for all velocities, or all accelerations, from the given ones."""
    derivation, linked, order = equations.derivation, equations.linked, equations.order
    for body in linked.turning:
        rate = CoordinateRate(Turn(linked.turning[body]), order)
        knows = derivation.knows_omega if order == VELOCITY else derivation.knows_epsilon
        if body in derivation.layout.members and knows(body):
            equations.known.add(rate)
    sums = []
    for closure in linked.closures:
        legs = [*legs_of(closure)]
        vectors = tuple(one for leg in legs for one in derivative(leg, leg.direction.body, order))
        sums.append(VectorSum(closure.point, vectors, closure))
    sums += [one for rate in given if (one := _of_point(equations, rate)) is not None]
    equations.solve([one for one in sums if one.vectors])
    equations.points()


def _of_point(equations: EquationsOfMotion, rate: file.GivenRate) -> VectorSum | None:
    """Return the equation of a point's given rate; None if it is the rate of its travel along a line of the ground."""
    derivation, order = equations.derivation, equations.order
    assert isinstance(rate, file.VelocityOf | file.AccelerationOf | file.FromRest)
    if isinstance(rate, file.FromRest):
        size: float | None = rate.acceleration.si
    else:
        size = None if rate.size is None else rate.size.si
    id = ids.POINT_RATE[RATES[order]](rate.point)
    if size is not None and order == ACCELERATION:
        derivation.given(id, size)
    for number, line in enumerate(equations.linked.lines):
        along = line.on == GROUND and line.point == rate.point and parallel(line.along, unit(rate.direction.si))
        if along and size is not None:
            equations.known.add(CoordinateRate(SlideTravel(number), order))
            return None
    place = equations.linked.places.get(rate.point)
    if place is None:
        return None
    moving = [one for leg in place.legs for one in derivative(leg, leg.direction.body, order)]
    own = CoordinateRate(rate.point, order)
    if size is not None:
        equations.known.add(own)
    of = equations.derivation.motion.v if order == VELOCITY else equations.derivation.motion.a
    sense = dot(unit(rate.direction.si), of(rate.point))
    direction = given_direction(rate.direction.si, sense if size is None else size)
    if size == 0:
        return VectorSum(rate.point, tuple(moving), kind="given")
    whole = (*moving, LoopVector(minus(ONE), -1.0, direction, rates=(own,)))
    return VectorSum(rate.point, whole, kind="given")
