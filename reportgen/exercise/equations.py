"""Equations of motion of a system with one coordinate: its loops, their first and their second derivatives.

A leg of length l along e at an angle φ has the derivatives l ω n and l ε n − l ω² e with n = i e; a way s along it has
ṡ e + s ω n and s̈ e + 2 ṡ ω n + s ε n − s ω² e.  So each loop is a linear equation for the unknown rates, of order 1
for velocities and of order 2 for accelerations, with the same factors in both.  One with two unknown rates is solved
by Cramer's rule, a larger system of them with its numbers.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import combinations

import numpy as np

from reportgen.exercise import file
from reportgen.exercise.board import Board, Step, size_of
from reportgen.exercise.centres import Layout
from reportgen.exercise.closures import (
    Closure,
    Coordinate,
    Direction,
    Leg,
    Linked,
    Place,
    Slide,
    Turn,
    given_direction,
    legs_of,
)
from reportgen.exercise.conditions import GROUND
from reportgen.exercise.places import name_of, parallel, unit
from reportgen.exercise.solving import NEGLIGIBLE, unknowns_of
from reportgen.formula import (
    MINUS_ONE,
    NOTHING,
    ONE,
    Call,
    Chain,
    Expression,
    Fraction,
    Number,
    Ref,
    Symbol,
    call,
    cosine,
    ids,
    minus,
    over,
    plus,
    refs,
    signed,
    sine,
    square,
    substitute,
    times,
    vocabulary,
)
from reportgen.formula.constructions import cross, dot
from reportgen.formula.vocabulary import KINDS

VELOCITY, ACCELERATION = 1, 2
RATES = {VELOCITY: "v", ACCELERATION: "a"}
READ = (ids.formula_angle, ids.inner_angle, ids.slide_way, ids.loop_distance)
"""What is read off the figure."""
TWO = Number(2.0)
FIGURES = 4
"""Significant figures of the numbers in a system."""


@dataclass(frozen=True, slots=True)
class Rate:
    """The derivative of a coordinate; of a point's speed that is no coordinate, the point."""

    of: Coordinate | str
    order: int


@dataclass(frozen=True, slots=True)
class Spoke:
    """A vector of a derivative: factor × rates along a direction turned by right angles; `size` is the factor's."""

    factor: Expression
    size: float
    direction: Direction
    quarters: int = 0
    rates: tuple[Rate, ...] = ()


def derivative(leg: Leg, leader: int, order: int) -> Iterator[Spoke]:
    """What a leg adds to the derivative of a chain."""
    length, turn = Spoke(leg.length, leg.value, leg.direction, leg.quarters), Turn(leader)
    ahead = replace(length, quarters=leg.quarters + 1)
    if leader != GROUND:
        yield replace(ahead, rates=(Rate(turn, order),))
        if order == ACCELERATION:
            ω = Rate(turn, VELOCITY)
            yield replace(length, factor=minus(leg.length), size=-leg.value, rates=(ω, ω))
    if leg.way is not None:
        # The length of a way has its sign in its value; its rate has it in the reversed leg's sign.
        sense = 1.0 if isinstance(leg.length, Ref) else -1.0
        along = replace(length, factor=ONE if sense > 0 else MINUS_ONE, size=sense)
        yield replace(along, rates=(Rate(leg.way, order),))
        if order == ACCELERATION and leader != GROUND:
            ω = Rate(turn, VELOCITY)
            twice = TWO if sense > 0 else minus(TWO)
            coriolis = replace(along, factor=twice, size=2 * sense, quarters=leg.quarters + 1)
            yield replace(coriolis, rates=(Rate(leg.way, VELOCITY), ω))


@dataclass(frozen=True)
class VectorSum:
    """Σ spokes = 0, from a loop through a point or from a point whose rate is given."""

    point: str
    spokes: tuple[Spoke, ...]
    closure: tuple[Chain, ...] = ()
    kind: str = "loop"


@dataclass
class EquationsOfMotion:
    """The equations of a system while they are solved on its board."""

    board: Board
    linked: Linked
    order: int = VELOCITY
    known: set[Rate] = field(default_factory=set)
    read: set[str] = field(default_factory=set)
    """The angles and lengths that are told already."""

    # --- rates

    def value(self, rate: Rate) -> float:
        """A rate as the whole system gives it."""
        motion, points = self.board.motion, self.board.layout.points
        of = motion.v if rate.order == VELOCITY else motion.a
        match rate.of:
            case Turn(body) if body in self.linked.rods:
                one, other = self.linked.rods[body]
                reach = points[other] - points[one]
                return float(cross(reach, of(other) - of(one)) / abs(reach) ** 2)
            case Turn(body):
                return motion.omega(body) if rate.order == VELOCITY else motion.epsilon(body)
            case Slide(number):
                line = self.linked.lines[number]
                base = of(line.point, line.on) if line.on != GROUND else 0j
                return float(dot(line.along, of(line.point) - base))
        return abs(of(rate.of))

    def id(self, rate: Rate) -> str:
        """The id of the size of a rate."""
        first = rate.order == VELOCITY
        match rate.of:
            case Turn(body):
                return ids.angular_velocity(body) if first else ids.angular_acceleration(body)
            case Slide(number):
                line = self.linked.lines[number]
                if self.linked.turning[line.on] == GROUND and line.on == GROUND:
                    return ids.POINT_RATE[RATES[rate.order]](line.point)
                joint = f"{line.body},{number}"
                return ids.slide_velocity(joint) if first else ids.slide_acceleration(joint)
        return ids.POINT_RATE[RATES[rate.order]](rate.of)

    def symbol(self, rate: Rate) -> Symbol:
        match rate.of:
            case Turn(body):
                return Symbol("ω" if rate.order == VELOCITY else "ε", self.linked.letter(body))
            case Slide(number):
                line = self.linked.lines[number]
                return Symbol(RATES[rate.order], line.point, "r" if line.on != GROUND else "")
        return Symbol(RATES[rate.order], rate.of)

    def expression(self, rate: Rate) -> Expression:
        """A known rate with its sense; nothing for one that is nothing."""
        value, id = self.value(rate), self.id(rate)
        if id not in self.board.q or self.board.q.si(id) == 0:
            return NOTHING
        return signed(value, self.board.q[id])

    def product(self, rates: Sequence[Rate], by_symbol: bool = False) -> Expression:
        if len(rates) == 2 and rates[0] == rates[1]:
            return square(self.symbol(rates[0]) if by_symbol else self.expression(rates[0]))
        return times(*(self.symbol(one) if by_symbol else self.expression(one) for one in rates)) if rates else ONE

    def amount(self, spoke: Spoke) -> float:
        return float(np.prod([spoke.size, *(self.value(one) for one in spoke.rates)]))

    def vector(self, spoke: Spoke) -> complex:
        """A spoke without its rates."""
        return spoke.size * cmath.exp(1j * self.linked.heading(spoke.direction)) * 1j**spoke.quarters

    # --- products of vectors, as they are written

    def cross(self, one: Sequence[Spoke], other: Sequence[Spoke]) -> Expression:
        """Σ a × b."""
        return plus(*(self._product(a, b, b.quarters - a.quarters) for a in one for b in other))

    def _product(self, a: Spoke, b: Spoke, quarters: int) -> Expression:
        between = self.linked.between(a.direction, b.direction)
        return times(*self._factors(a), *self._factors(b), self._trigonometric(between, quarters))

    def _factors(self, spoke: Spoke) -> tuple[Expression, ...]:
        return self._ordered(self.product(spoke.rates), spoke.factor)

    @staticmethod
    def _ordered(rates: Expression, factor: Expression) -> tuple[Expression, Expression]:
        """A number stands before the rates, a length behind them."""
        return (factor, rates) if isinstance(factor, Number) else (rates, factor)

    @staticmethod
    def _trigonometric(angle: Expression, quarters: int) -> Expression:
        """sin(angle + quarters · 90°)."""
        value = (sine, cosine)[quarters % 2](angle)
        return value if quarters % 4 < 2 else minus(value)

    def component(self, spokes: Iterable[Spoke], axis: str, by_symbol: bool = False) -> Expression:
        """Σ along x or y."""
        terms = []
        for one in spokes:
            turned = self._trigonometric(self.linked.angle(one.direction), one.quarters + (axis == "x"))
            terms.append(times(*self._ordered(self.product(one.rates, by_symbol), one.factor), turned))
        return plus(*terms)

    # --- what is to be solved

    def unknown(self, spokes: Iterable[Spoke]) -> list[Rate]:
        rates = (one for spoke in spokes for one in spoke.rates if one.order == self.order)
        return [one for one in dict.fromkeys(rates) if one not in self.known]

    def part(self, spokes: Iterable[Spoke], rate: Rate) -> list[Spoke]:
        """The factors of an unknown rate, which is taken out."""
        return [replace(one, rates=()) for one in spokes if one.rates == (rate,)]

    def resolved(self, spokes: Sequence[Spoke]) -> list[Spoke]:
        """Spokes with the unknown rates put in that relations give by others."""
        found = list(spokes)
        for rate, by in self._eliminated().items():
            if rate in self.unknown(found):
                rest = [one for one in found if one.rates != (rate,)]
                for spoke in (one for one in found if one.rates == (rate,)):
                    for other, (factor, value) in by.items():
                        whole = times(spoke.factor, factor)
                        rest.append(replace(spoke, factor=whole, size=spoke.size * value, rates=(other,)))
                found = rest
        return found

    def _eliminated(self) -> dict[Rate, dict[Rate, tuple[Expression, float]]]:
        """Of each relation with several unknown rates one of them, by the others: a way, else the last angle."""
        found: dict[Rate, dict[Rate, tuple[Expression, float]]] = {}
        for relation in self.linked.relations:
            rates = {Rate(of, self.order): told for of, told in relation.items()}
            unknown = [one for one in rates if one not in self.known]
            if len(unknown) < 2:
                continue
            free = [one for one in unknown if one not in found]
            chosen = next((one for one in free if isinstance(one.of, Slide)), free[-1] if free else None)
            if chosen is None:
                continue
            factor, value = rates.pop(chosen)
            found[chosen] = {one: (minus(over(by, factor)), -size / value) for one, (by, size) in rates.items()}
        return found

    def solve(self, sums: list[VectorSum]) -> None:
        """All rates that follow, each sum or relation as soon as it has few enough unknown ones."""
        waiting = list(sums)
        while self._by_relation() or self._by_sum(waiting) or self._together(waiting):
            pass

    def _by_relation(self) -> bool:
        for relation in self.linked.relations:
            rates = {Rate(of, self.order): told for of, told in relation.items()}
            unknown = [one for one in rates if one not in self.known]
            if len(unknown) == 1:
                factor, _ = rates.pop(unknown[0])
                rest = plus(*(times(self.expression(one), by) for one, (by, _) in rates.items()))
                self._step("relation", self._define({unknown[0]: over(minus(rest), factor)}))
                return True
        return False

    def _by_sum(self, waiting: list[VectorSum]) -> bool:
        for one in waiting:
            spokes = self.resolved(one.spokes)
            unknown = self.unknown(spokes)
            found: Mapping[Rate, Expression] | None = None
            if not unknown:
                found = {}
            elif len(unknown) == 1:
                found = self._single(spokes, unknown[0])
            elif len(unknown) == 2:
                found = self._cramer(spokes, *unknown)
            if found is not None:
                waiting.remove(one)
                if found:
                    system = (*one.closure, *self.rows(spokes))
                    self._step(one.kind, (*self._read(one.spokes), *self._define(found)), system, point=one.point)
                return True
        return False

    def _single(self, spokes: Sequence[Spoke], rate: Rate) -> dict[Rate, Expression] | None:
        """u x + k = 0: along u, or on the axis along which u is longer."""
        u, k = self.part(spokes, rate), self._rest(spokes, [rate])
        whole = sum(map(self.vector, u))
        if abs(whole) < NEGLIGIBLE * sum(abs(self.vector(one)) for one in u):
            return None
        if len(u) == 1:
            # cos = sin with a right angle more
            along = plus(*(self._product(self._bare(u[0]), one, one.quarters - u[0].quarters + 1) for one in k))
            return {rate: over(minus(along), u[0].factor)}
        axis = "x" if abs(whole.real) > abs(whole.imag) else "y"
        return {rate: over(minus(self.component(k, axis)), self.component(u, axis))}

    def _cramer(self, spokes: Sequence[Spoke], one: Rate, other: Rate) -> dict[Rate, Expression] | None:
        """u x + w y + k = 0: x = −(k × w)/(u × w), y = −(u × k)/(u × w)."""
        u, w, k = self.part(spokes, one), self.part(spokes, other), self._rest(spokes, [one, other])
        first, second = sum(map(self.vector, u)), sum(map(self.vector, w))
        if abs(cross(first, second)) < NEGLIGIBLE * abs(first) * abs(second) or not (first and second):
            return None
        to_u, to_w = ([self._bare(side[0])] if len(side) == 1 else side for side in (u, w))
        return {
            one: over(minus(self.cross(k, to_w)), self.cross(u, to_w)),
            other: over(minus(self.cross(to_u, k)), self.cross(to_u, w)),
        }

    @staticmethod
    def _bare(spoke: Spoke) -> Spoke:
        """Its direction alone."""
        return replace(spoke, factor=ONE, size=1.0)

    def _rest(self, spokes: Sequence[Spoke], unknown: Sequence[Rate]) -> list[Spoke]:
        kept = (one for one in spokes if not (len(one.rates) == 1 and one.rates[0] in unknown))
        return [one for one in kept if self.product(one.rates) != NOTHING]

    def _together(self, waiting: list[VectorSum]) -> bool:
        """The fewest sums that have as many unknown rates as equations, as one system with numbers."""
        for count in range(2, len(waiting) + 1):
            for some in combinations(waiting, count):
                resolved = [self.resolved(one.spokes) for one in some]
                unknown = list(dict.fromkeys(rate for spokes in resolved for rate in self.unknown(spokes)))
                rows = self._numbers(resolved, unknown)
                left = np.array([[row.get((rate,), 0.0) for rate in unknown] for row in rows])
                if not unknown or len(unknown) > len(rows) or np.linalg.matrix_rank(left, NEGLIGIBLE) < len(unknown):
                    continue
                known = list(
                    dict.fromkeys(rates for row in rows for rates in row if rates not in {(u,) for u in unknown})
                )
                right = np.array([[-row.get(rates, 0.0) for rates in known] for row in rows])
                shares = np.linalg.lstsq(left, right, rcond=None)[0]
                found = {rate: self._by_shares(known, row) for rate, row in zip(unknown, shares, strict=True)}
                closures = tuple(row for one in some for row in one.closure)
                system = (*closures, *(row for spokes in resolved for row in self.rows(spokes)))
                results = tuple(self._result(rate) for rate in unknown)
                for one in some:
                    waiting.remove(one)
                read = tuple(id for one in some for id in self._read(one.spokes))
                self._step("system", (*read, *self._define(found)), system, results)
                return True
        return False

    def _numbers(self, sums: Sequence[Sequence[Spoke]], unknown: Sequence[Rate]) -> list[dict[tuple[Rate, ...], float]]:
        """Of each sum the factors of its products of rates, along x and along y."""
        rows = []
        for spokes in sums:
            whole: dict[tuple[Rate, ...], complex] = {}
            for one in spokes:
                if set(one.rates) & {*unknown} or self.product(one.rates) != NOTHING:
                    whole[one.rates] = whole.get(one.rates, 0j) + self.vector(one)
            rows += [{rates: of.real for rates, of in whole.items()}, {rates: of.imag for rates, of in whole.items()}]
        return rows

    def _by_shares(self, known: Sequence[tuple[Rate, ...]], shares: Sequence[float]) -> Expression:
        """As a construction it has no line of its own: the system is set out, and its solution told."""
        terms = (
            times(Number(float(share)), self.product(rates))
            for rates, share in zip(known, shares, strict=True)
            if share
        )
        return call("re", plus(*terms))

    # --- what is put on the board

    def _define(self, found: Mapping[Rate, Expression]) -> tuple[str, ...]:
        """Enters sizes of rates; the ids of those that were not on the board."""
        lines = []
        for rate, formula in found.items():
            id, sense = self.id(rate), 1.0 if self.value(rate) >= 0 else -1.0
            if id not in self.board.q:
                whole = formula if isinstance(formula, Ref) or sense > 0 else self._opposite(formula)
                lines.append(self.board.q.define(id, whole, self.symbol(rate)).id)
            self.known.add(rate)
        return tuple(lines)

    @staticmethod
    def _opposite(formula: Expression) -> Expression:
        match formula:
            case Fraction(top, bottom):
                return over(minus(top), bottom)
            case Call("re", (inner,)):
                return call("re", minus(inner))
        return minus(formula)

    def _read(self, spokes: Iterable[Spoke]) -> tuple[str, ...]:
        """The angles and lengths of a sum that are read off the figure, each told once."""
        told: dict[str, None] = {}
        for one in spokes:
            for formula in (one.factor, self.linked.angle(one.direction)):
                told |= dict.fromkeys(id for id in refs(formula) if any(id in family for family in READ))
        new = tuple(id for id in told if id not in self.read)
        self.read |= {*new}
        return new

    def rows(self, spokes: Sequence[Spoke]) -> tuple[Chain, ...]:
        """A sum along x and y, the unknown rates to the left."""
        unknown = {*self.unknown(spokes)}
        left = [one for one in spokes if {*one.rates} & unknown]
        right = [replace(one, factor=minus(one.factor)) for one in spokes if one not in left]
        right = [one for one in right if self.product(one.rates) != NOTHING]
        return self.chains(left, right)

    def chains(self, *sides: Sequence[Spoke]) -> tuple[Chain, ...]:
        """Sides of a vector equation along x and y."""
        return tuple(Chain(tuple(self._lettered(self.component(side, axis, True)) for side in sides)) for axis in "xy")

    def _lettered(self, formula: Expression) -> Expression:
        return substitute(formula, lambda ref: self.board.q.families[ref.id].symbol)

    def _result(self, rate: Rate) -> Chain:
        """What a rate comes to, with so many significant figures."""
        value, unit = self.value(rate), KINDS[vocabulary.row(self.id(rate)).kind].unit
        decimals = None if value == 0 else max(0, FIGURES - 1 - math.floor(math.log10(abs(value))))
        return Chain((self.symbol(rate), Number(value, decimals, unit)))

    def closure(self, closure: Closure) -> tuple[Chain, ...]:
        """A loop along x and y."""
        sides = []
        for place in (closure.one, closure.other):
            chain = [Spoke(leg.length, leg.value, leg.direction, leg.quarters) for leg in place.legs]
            sides.append(
                [plus(fixed, self.component(chain, axis)) for axis, fixed in zip("xy", place.fixed, strict=True)]
            )
        return tuple(Chain(tuple(map(self._lettered, pair))) for pair in zip(*sides, strict=True))

    def _step(
        self,
        kind: str,
        lines: tuple[str, ...],
        system: tuple[Chain, ...] = (),
        results: tuple[Chain, ...] = (),
        body: int = 0,
        point: str = "",
    ) -> None:
        if lines:
            start = "equations" if self.order == VELOCITY else "acceleration-equations"
            self.board.steps.append(Step(f"{start}-{kind}", lines, body, point, system=system, results=results))

    # --- points

    def points(self) -> None:
        """Every point as a function of the coordinates, and its derivatives at the instant."""
        for body, names in self.board.layout.motion.system.bodies.items():
            for name in names:
                place = self.linked.places.get(name)
                if place is not None and place.legs:
                    self._point(body, name, place)

    def _point(self, body: int, name: str, place: Place) -> None:
        what, q = RATES[self.order], self.board.q
        spokes = [one for leg in place.legs for one in derivative(leg, leg.direction.body, self.order)]
        if self.unknown(spokes) or self.board.knows(ids.POINT_RATE[what](name)):
            return
        lines = list(self._read(spokes))
        if self.order == VELOCITY:
            chain = [Spoke(leg.length, leg.value, leg.direction, leg.quarters) for leg in place.legs]
            for axis, fixed in zip("xy", place.fixed, strict=True):
                at = plus(fixed, self.component(chain, axis))
                id = ids.formula_coordinate(axis, name)
                if at != NOTHING and id not in q:
                    lines.append(q.define(id, at).id)
        sides = []
        for axis in "xy":
            id, rate = ids.COMPONENT[what](name, axis), self.component(spokes, axis)
            if rate != NOTHING and id not in q:
                sides.append(q.define(id, rate, Symbol(what, f"{name}{axis}")))
        size = ids.POINT_RATE[what](name)
        whole = q.define(size, size_of(q, sides)) if sides else q.give(size, 0.0)
        lines += [*(one.id for one in sides), whole.id]
        self._step("point", tuple(lines), body=body, point=name)


# --- a whole exercise -----------------------------------------------------------------------------


def coordinates(layout: Layout) -> int:
    """How many coordinates the bodies have whose motion is determined: the motions that their joints leave open."""
    motion = layout.motion
    unknowns = unknowns_of(motion.system)
    sized = {
        name_of(index, "given", *one.called)
        for index, one in enumerate(layout.given.given)
        if not isinstance(one, file.VelocityOf) or one.size is not None
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


def by_loops(board: Board) -> bool:
    """All rates of a system with one coordinate from its loops; whether it was not tried before."""
    if board.closed:
        return False
    board.closed = True
    linked = Linked(board)
    equations = EquationsOfMotion(board, linked)
    given = board.layout.given.given
    _solve(equations, [one for one in given if isinstance(one, file.VelocityOf | file.FromRest)])
    accelerations = [one for one in given if isinstance(one, file.AccelerationOf | file.FromRest)]
    turns = [one for one in given if isinstance(one, file.EpsilonOf)]
    for one in turns:
        board.given(ids.angular_acceleration(one.body), one.value.si)
    if turns or accelerations:
        equations.order = ACCELERATION
        _solve(equations, accelerations)
    return True


def _solve(equations: EquationsOfMotion, given: Sequence[file.GivenRate]) -> None:
    """The velocities, or the accelerations, of everything from what is given of them."""
    board, linked, order = equations.board, equations.linked, equations.order
    for body in linked.turning:
        rate = Rate(Turn(linked.turning[body]), order)
        knows = board.knows_omega if order == VELOCITY else board.knows_epsilon
        if body in board.layout.members and knows(body):
            equations.known.add(rate)
    sums = []
    for closure in linked.closures:
        legs = [*legs_of(closure)]
        spokes = tuple(one for leg in legs for one in derivative(leg, leg.direction.body, order))
        sums.append(VectorSum(closure.point, spokes, equations.closure(closure) if order == VELOCITY else ()))
    sums += [one for rate in given if (one := _of_point(equations, rate)) is not None]
    equations.solve([one for one in sums if one.spokes])
    equations.points()


def _of_point(equations: EquationsOfMotion, rate: file.GivenRate) -> VectorSum | None:
    """What a given rate of a point says; None where it is that of its way along a line of the ground."""
    board, order = equations.board, equations.order
    assert isinstance(rate, file.VelocityOf | file.AccelerationOf | file.FromRest)
    if isinstance(rate, file.FromRest):
        size: float | None = rate.acceleration.si
    else:
        size = None if rate.size is None else rate.size.si
    id = ids.POINT_RATE[RATES[order]](rate.point)
    if size is not None and order == ACCELERATION:
        board.given(id, size)
    for number, line in enumerate(equations.linked.lines):
        along = line.on == GROUND and line.point == rate.point and parallel(line.along, unit(rate.direction.si))
        if along and size is not None:
            equations.known.add(Rate(Slide(number), order))
            return None
    place = equations.linked.places.get(rate.point)
    if place is None:
        return None
    moving = [one for leg in place.legs for one in derivative(leg, leg.direction.body, order)]
    own = Rate(rate.point, order)
    if size is not None:
        equations.known.add(own)
    of = equations.board.motion.v if order == VELOCITY else equations.board.motion.a
    sense = dot(unit(rate.direction.si), of(rate.point))
    direction = given_direction(rate.direction.si, sense if size is None else size)
    if size == 0:
        return VectorSum(rate.point, tuple(moving), kind="given")
    whole = (*moving, Spoke(minus(ONE), -1.0, direction, rates=(own,)))
    return VectorSum(rate.point, whole, kind="given")
