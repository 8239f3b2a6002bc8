"""Equations of motion of a system with one coordinate: its loops and their first and second derivatives.

Each loop is a linear equation for the unknown rates, of order 1 for velocities and 2 for accelerations, with the same
factors in both.  An equation with two unknown rates is solved by Cramer's rule, larger systems numerically.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import combinations

import numpy as np

from reportgen.base.records import Record, replace
from reportgen.exercise.chain_derivatives import RATES, VELOCITY, RateFormulas, derivative
from reportgen.exercise.closed_form import X_AXIS, closed_form
from reportgen.exercise.derivation import Step, size_of
from reportgen.exercise.position_chains import (
    Closure,
    CoordinateRate,
    GeneralizedCoordinate,
    LoopVector,
    Place,
    SlideTravel,
    Turn,
    legs_of,
)
from reportgen.exercise.rate_solution import NEGLIGIBLE
from reportgen.formula import (
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
    ids,
    minus,
    over,
    plus,
    refs,
    times,
    vocabulary,
)
from reportgen.formula.constructions import cross
from reportgen.formula.vocabulary import KINDS

READ = (ids.formula_angle, ids.inner_angle, ids.slide_way, ids.loop_distance)
"""Quantities read off the figure."""
Formulas = Mapping[CoordinateRate, Expression]
"""Formulas of unknown rates in terms of known quantities."""
RateFactors = dict[tuple[CoordinateRate, ...], float]
"""The factors of products of rates."""
MOST_TERMS = 4
"""Largest number of terms of a numerator; right sides with more terms are computed first."""
FIGURES = 4
"""Significant digits of the numbers in a system."""


class VectorSum(Record):
    """Σ vectors = 0, from a loop through a point or from a point whose rate is given."""

    point: str
    vectors: tuple[LoopVector, ...]
    loop: Closure | None = None
    kind: str = "loop"


@dataclass
class EquationsOfMotion(RateFormulas):
    """The equations of a system while they are solved on its derivation."""

    order: int = VELOCITY
    known: set[CoordinateRate] = field(default_factory=set)

    # --- the unknowns

    def unknown(self, vectors: Iterable[LoopVector]) -> list[CoordinateRate]:
        rates = (rate for vector in vectors for rate in vector.rates if rate.order == self.order)
        return [one for one in dict.fromkeys(rates) if one not in self.known]

    def part(self, vectors: Iterable[LoopVector], rate: CoordinateRate) -> list[LoopVector]:
        """Remove an unknown rate from vectors and return its factors."""
        return [replace(vector, rates=()) for vector in vectors if vector.rates == (rate,)]

    def resolved(self, vectors: Sequence[LoopVector]) -> list[LoopVector]:
        """Return vectors in which relations replace unknown rates by others."""
        resolved = list(vectors)
        for rate, by in self._eliminated().items():
            if rate in self.unknown(resolved):
                rest = [one for one in resolved if one.rates != (rate,)]
                for vector in (one for one in resolved if one.rates == (rate,)):
                    for given_by, (factor, value) in by.items():
                        whole = times(vector.length, factor)
                        rest.append(replace(vector, length=whole, value=vector.value * value, rates=(given_by,)))
                resolved = rest
        return resolved

    def _eliminated(self) -> dict[CoordinateRate, dict[CoordinateRate, tuple[Expression, float]]]:
        """Return one rate of each relation with several unknowns in terms of the others: a travel, otherwise the last
        angle.
        """
        eliminated: dict[CoordinateRate, dict[CoordinateRate, tuple[Expression, float]]] = {}
        for relation in self.linked.relations:
            rates = {CoordinateRate(of, self.order): factor for of, factor in relation.items()}
            unknown = [rate for rate in rates if rate not in self.known]
            if len(unknown) < 2:
                continue
            free = [one for one in unknown if one not in eliminated]
            chosen = next((one for one in free if isinstance(one.of, SlideTravel)), free[-1] if free else None)
            if chosen is None:
                continue
            factor, value = rates.pop(chosen)
            eliminated[chosen] = {one: (minus(over(by, factor)), -size / value) for one, (by, size) in rates.items()}
        return eliminated

    def solve(self, sums: list[VectorSum]) -> None:
        """Solve for all rates that follow, each sum or relation as soon as it has few enough unknowns."""
        waiting = list(sums)
        while self._by_relation() or self._by_sum(waiting) or self._together(waiting):
            pass

    def _by_relation(self) -> bool:
        for relation in self.linked.relations:
            rates = {CoordinateRate(of, self.order): factor for of, factor in relation.items()}
            unknown = [rate for rate in rates if rate not in self.known]
            if len(unknown) == 1:
                factor, _ = rates.pop(unknown[0])
                rest = plus(*(times(self.expression(one), by) for one, (by, _) in rates.items()))
                self._step("relation", self._define({unknown[0]: over(minus(rest), factor)}))
                return True
        return False

    def _by_sum(self, waiting: list[VectorSum]) -> bool:
        for whole in waiting:
            vectors = self.resolved(whole.vectors)
            unknown = self.unknown(vectors)
            if len(unknown) > 2:
                continue
            placed, rows = self._place(whole, unknown), self.rows(vectors)
            formulas: Formulas | None = {}
            if len(unknown) == 1:
                formulas = self._single(vectors, unknown[0])
            elif unknown:
                vectors = self._gathered(whole.point, vectors, unknown)
                formulas = self._cramer(vectors, *unknown)
            if formulas is not None:
                waiting.remove(whole)
                if formulas:
                    system = (*self._loop(whole), *rows)
                    read = self._read(whole.vectors, whole.loop)
                    right = tuple(id for part in vectors for id in refs(part.length) if id in ids.right_side)
                    lines = (*placed, *dict.fromkeys(right), *self._define(formulas))
                    self._step(whole.kind, lines, system, read=read, point=whole.point)
                return True
        return False

    def _gathered(self, point: str, vectors: list[LoopVector], unknown: Sequence[CoordinateRate]) -> list[LoopVector]:
        """Replace many known vectors by the components b of their opposite, the right sides of the equations."""
        rest = self._rest(vectors, unknown)
        if len(rest) * max(len(self.part(vectors, rate)) for rate in unknown) <= MOST_TERMS:
            return vectors
        named = {axis: ids.right_side(RATES[self.order], f"{point}{axis}") for axis in "xy"}
        if any(id in self.derivation.q for id in named.values()):
            return vectors
        gathered = [vector for vector in vectors if vector not in rest]
        for number, (axis, id) in enumerate(named.items()):
            right = minus(self.component(rest, axis))
            if right != NOTHING:
                kind = vocabulary.row(ids.POINT_RATE[RATES[self.order]](point)).kind
                b = self.derivation.q.define(id, right, Symbol("b", f"{point}{axis}"), kind)
                gathered.append(LoopVector(minus(b), 0.0, X_AXIS, number))
        return gathered

    def _place(self, whole: VectorSum, unknown: Sequence[CoordinateRate]) -> tuple[str, ...]:
        """Enter the coordinates of a loop in closed form if there is one; read the remaining ones off the figure."""
        lines: tuple[str, ...] = ()
        of: list[GeneralizedCoordinate] = [rate.of for rate in unknown if not isinstance(rate.of, str)]
        if whole.loop is not None and self.order == VELOCITY and len(of) == 2 and all(map(self._is_open, of)):
            legs = [leg for leg in legs_of(whole.loop) if {Turn(leg.direction.body), leg.slide} & {*of}]
            lines = closed_form(self, whole.loop, legs, of)
        return lines

    def _is_open(self, of: GeneralizedCoordinate) -> bool:
        """Return True if a coordinate is not in the derivation yet."""
        id = ids.formula_angle(of.body) if isinstance(of, Turn) else self.linked.travel_id(of)
        return id not in self.derivation.q

    def _loop(self, whole: VectorSum) -> tuple[Chain, ...]:
        """Return the loop itself, which is printed with its first derivative."""
        return () if whole.loop is None or self.order != VELOCITY else self.closure(whole.loop)

    def _single(self, vectors: Sequence[LoopVector], rate: CoordinateRate) -> Formulas | None:
        """Solve u x + k = 0, along u or on the axis along which u is longer."""
        u, k = self.part(vectors, rate), self._rest(vectors, [rate])
        whole = sum(map(self.vector, u))
        if abs(whole) < NEGLIGIBLE * sum(abs(self.vector(one)) for one in u):
            return None
        if len(u) == 1:
            along = self.dot([self._bare(u[0])], k)
            return {rate: over(minus(along), u[0].length)}
        axis = "x" if abs(whole.real) > abs(whole.imag) else "y"
        return {rate: over(minus(self.component(k, axis)), self.component(u, axis))}

    def _cramer(self, vectors: Sequence[LoopVector], x_rate: CoordinateRate, y_rate: CoordinateRate) -> Formulas | None:
        """Solve u x + w y + k = 0: x = −(k × w)/(u × w), y = −(u × k)/(u × w)."""
        u, w, k = self.part(vectors, x_rate), self.part(vectors, y_rate), self._rest(vectors, [x_rate, y_rate])
        first, second = sum(map(self.vector, u)), sum(map(self.vector, w))
        if abs(cross(first, second)) < NEGLIGIBLE * abs(first) * abs(second) or not (first and second):
            return None
        to_u, to_w = ([self._bare(side[0])] if len(side) == 1 else side for side in (u, w))
        return {
            x_rate: over(minus(self.cross(k, to_w)), self.cross(u, to_w)),
            y_rate: over(minus(self.cross(to_u, k)), self.cross(to_u, w)),
        }

    @staticmethod
    def _bare(vector: LoopVector) -> LoopVector:
        """Return the direction of a vector alone, without its rates."""
        return replace(vector, length=ONE, value=1.0)

    def _rest(self, vectors: Sequence[LoopVector], unknown: Sequence[CoordinateRate]) -> list[LoopVector]:
        kept = (vector for vector in vectors if not (len(vector.rates) == 1 and vector.rates[0] in unknown))
        return [one for one in kept if self.product(one.rates) != NOTHING]

    def _together(self, waiting: list[VectorSum]) -> bool:
        """Solve the fewest sums that have as many unknown rates as equations, as one numeric system; return False
        without one.
        """
        for count in range(2, len(waiting) + 1):
            for some in combinations(waiting, count):
                resolved = [self.resolved(one.vectors) for one in some]
                unknown = list(dict.fromkeys(rate for vectors in resolved for rate in self.unknown(vectors)))
                rows = self._numbers(resolved, unknown)
                left = np.array([[row.get((rate,), 0.0) for rate in unknown] for row in rows])
                if not unknown or len(unknown) > len(rows) or np.linalg.matrix_rank(left, NEGLIGIBLE) < len(unknown):
                    continue
                known = list(
                    dict.fromkeys(rates for row in rows for rates in row if rates not in {(u,) for u in unknown})
                )
                right = np.array([[-row.get(rates, 0.0) for rates in known] for row in rows])
                shares = np.linalg.lstsq(left, right, rcond=None)[0]
                formulas = {rate: self._by_shares(known, row) for rate, row in zip(unknown, shares, strict=True)}
                loops = tuple(row for one in some for row in self._loop(one))
                system = (*loops, *(row for vectors in resolved for row in self.rows(vectors)))
                results = tuple(self._result(rate) for rate in unknown)
                for whole_sum in some:
                    waiting.remove(whole_sum)
                read = tuple(dict.fromkeys(id for one in some for id in self._read(one.vectors, one.loop)))
                self._step("system", self._define(formulas), system, results, read)
                return True
        return False

    def _numbers(self, sums: Sequence[Sequence[LoopVector]], unknown: Sequence[CoordinateRate]) -> list[RateFactors]:
        """Return the factors of the products of rates in each sum, along x and along y."""
        rows = []
        for vectors in sums:
            whole: dict[tuple[CoordinateRate, ...], complex] = {}
            for vector in vectors:
                if set(vector.rates) & {*unknown} or self.product(vector.rates) != NOTHING:
                    whole[vector.rates] = whole.get(vector.rates, 0j) + self.vector(vector)
            rows += [{rates: of.real for rates, of in whole.items()}, {rates: of.imag for rates, of in whole.items()}]
        return rows

    def _by_shares(self, known: Sequence[tuple[CoordinateRate, ...]], shares: Sequence[float]) -> Expression:
        """Return the solution of a numeric system as a construction: the page prints the system and its solution
        instead of a line.
        """
        terms = (
            times(Number(float(share)), self.product(rates))
            for rates, share in zip(known, shares, strict=True)
            if share
        )
        return call("re", plus(*terms))

    # --- entries in the derivation

    def _define(self, formulas: Mapping[CoordinateRate, Expression]) -> tuple[str, ...]:
        """Enter magnitudes of rates; return the ids of those that were not in the derivation."""
        lines = []
        for rate, formula in formulas.items():
            id, sense = self.id(rate), 1.0 if self.value(rate) >= 0 else -1.0
            if id not in self.derivation.q:
                whole = formula if isinstance(formula, Ref) or sense > 0 else self._opposite(formula)
                lines.append(self.derivation.q.define(id, whole, self.symbol(rate)).id)
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

    def _read(self, vectors: Iterable[LoopVector], loop: Closure | None = None) -> tuple[str, ...]:
        """Enter the angles and lengths of a sum that are read off the figure; return their ids."""
        read_off: dict[str, None] = {}
        legs = [] if loop is None else [leg for place in (loop.outward, loop.back) for leg in place.legs]
        for vector in (*vectors, *legs):
            for formula in (self.linked.with_travels(vector.length), self.linked.angle(vector.direction)):
                read_off |= dict.fromkeys(id for id in refs(formula) if any(id in family for family in READ))
        return tuple(read_off)

    def rows(self, vectors: Sequence[LoopVector]) -> tuple[Chain, ...]:
        """Return a sum along x and y, with the unknown rates on the left."""
        unknown = {*self.unknown(vectors)}
        left = [vector for vector in vectors if {*vector.rates} & unknown]
        right = [replace(vector, length=minus(vector.length)) for vector in vectors if vector not in left]
        right = [one for one in right if self.product(one.rates) != NOTHING]
        return self.chains(left, right)

    def _result(self, rate: CoordinateRate) -> Chain:
        """Return a rate with its value, to a number of significant figures."""
        value, unit = self.value(rate), KINDS[vocabulary.row(self.id(rate)).kind].unit
        decimals = None if value == 0 else max(0, FIGURES - 1 - math.floor(math.log10(abs(value))))
        return Chain((self.symbol(rate), Number(value, decimals, unit)))

    def _step(
        self,
        kind: str,
        lines: tuple[str, ...],
        system: tuple[Chain, ...] = (),
        results: tuple[Chain, ...] = (),
        read: tuple[str, ...] = (),
        body: int = 0,
        point: str = "",
    ) -> None:
        if lines:
            start = "equations" if self.order == VELOCITY else "acceleration-equations"
            step = Step(f"{start}-{kind}", lines, body, point, system=system, results=results, read=read)
            self.derivation.steps.append(step)

    # --- points

    def points(self) -> None:
        """Enter every point as a function of the coordinates, and its derivatives at the instant."""
        for body, names in self.derivation.layout.motion.system.bodies.items():
            for name in names:
                place = self.linked.places.get(name)
                if place is not None and place.legs:
                    self._point(body, name, place)

    def _point(self, body: int, name: str, place: Place) -> None:
        what, q = RATES[self.order], self.derivation.q
        vectors = [one for leg in place.legs for one in derivative(leg, leg.direction.body, self.order)]
        if self.unknown(vectors) or self.derivation.knows(ids.POINT_RATE[what](name)):
            return
        lines = list[str]()
        if self.order == VELOCITY:
            for axis, fixed in zip("xy", place.fixed, strict=True):
                at = plus(fixed, self.component(place.legs, axis))
                id = ids.formula_coordinate(axis, name)
                if at != NOTHING and id not in q:
                    lines.append(q.define(id, at, scale=self.derivation.motion.size).id)
        sides = []
        for axis in "xy":
            id, rate = ids.COMPONENT[what](name, axis), self.component(vectors, axis)
            if rate != NOTHING and id not in q:
                sides.append(q.define(id, rate, Symbol(what, f"{name}{axis}")))
        size = ids.POINT_RATE[what](name)
        whole = q.define(size, size_of(q, sides)) if sides else q.give(size, 0.0)
        lines += [*(side.id for side in sides), whole.id]
        self._step("point", tuple(lines), read=self._read(vectors), body=body, point=name)
