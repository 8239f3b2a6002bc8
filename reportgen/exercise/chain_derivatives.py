"""Derivatives of chains of vectors: the contribution of each leg to the velocity and acceleration of the chain's end.

A leg of length l along e at an angle φ has the derivatives l ω n and l ε n − l ω² e with n = i e; a travel s along it
has ṡ e + s ω n and s̈ e + 2 ṡ ω n + s ε n − s ω² e.  `RateFormulas` writes the results as printed formulas.
"""

from __future__ import annotations

import cmath
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

from reportgen.base.records import replace
from reportgen.exercise.derivation import Derivation
from reportgen.exercise.position_chains import Closure, CoordinateRate, Linked, LoopVector, SlideTravel, Turn
from reportgen.exercise.rate_conditions import GROUND
from reportgen.formula import (
    MINUS_ONE,
    NOTHING,
    ONE,
    Chain,
    Expression,
    Negative,
    Number,
    Ref,
    Symbol,
    cosine,
    ids,
    minus,
    plus,
    signed,
    sine,
    square,
    substitute,
    times,
)
from reportgen.formula.constructions import cross, dot

VELOCITY, ACCELERATION = 1, 2
"""The order of a derivative."""
RATES = {VELOCITY: "v", ACCELERATION: "a"}
TWO = Number(2.0)


def derivative(leg: LoopVector, leader: int, order: int) -> Iterator[LoopVector]:
    """Yield the contributions of a leg to the first or second derivative of a chain (`order` 1 or 2).

    `leader` is the number of the body that the leg turns with. A leg with the leader `GROUND` keeps its direction; it
    contributes only the rate of its travel.
    """
    still, turn = replace(leg, slide=None), Turn(leader)
    ahead = replace(still, quarters=leg.quarters + 1)
    if leader != GROUND:
        yield replace(ahead, rates=(CoordinateRate(turn, order),))
        if order == ACCELERATION:
            ω = CoordinateRate(turn, VELOCITY)
            yield replace(still, length=minus(leg.length), value=-leg.value, rates=(ω, ω))
    if leg.slide is not None:
        # A negative travel has its sign in its value; the sign of its rate is in the direction of the reversed leg.
        sense = 1.0 if isinstance(leg.length, Ref) else -1.0
        along = replace(still, length=ONE if sense > 0 else MINUS_ONE, value=sense)
        yield replace(along, rates=(CoordinateRate(leg.slide, order),))
        if order == ACCELERATION and leader != GROUND:
            ω = CoordinateRate(turn, VELOCITY)
            twice = TWO if sense > 0 else minus(TWO)
            coriolis = replace(along, length=twice, value=2 * sense, quarters=leg.quarters + 1)
            yield replace(coriolis, rates=(CoordinateRate(leg.slide, VELOCITY), ω))


@dataclass
class RateFormulas:
    """Formulas of the rates and vectors of a system, as its steps print them.

    `linked` has the positions of the system's points as functions of its coordinates. A rate is printed as its ledger
    quantity with its sense, or by its bare symbol (`by_symbol`) in a general equation.
    """

    derivation: Derivation
    linked: Linked

    # --- rates

    def value(self, rate: CoordinateRate) -> float:
        """Return a rate as the solution of the whole system gives it: rad/s or m/s; of accelerations rad/s² or m/s²."""
        motion, points = self.derivation.motion, self.derivation.layout.points
        of = motion.v if rate.order == VELOCITY else motion.a
        match rate.of:
            case Turn(body) if body in self.linked.rods:
                start, tip = self.linked.rods[body]
                reach = points[tip] - points[start]
                return float(cross(reach, of(tip) - of(start)) / abs(reach) ** 2)
            case Turn(body):
                return motion.omega(body) if rate.order == VELOCITY else motion.epsilon(body)
            case SlideTravel(number):
                line = self.linked.lines[number]
                base = of(line.point, line.on) if line.on != GROUND else 0j
                return float(dot(line.along, of(line.point) - base))
        return abs(of(rate.of))

    def id(self, rate: CoordinateRate) -> str:
        """Return the id of the magnitude of a rate."""
        first = rate.order == VELOCITY
        match rate.of:
            case Turn(body):
                return ids.angular_velocity(body) if first else ids.angular_acceleration(body)
            case SlideTravel(number):
                line = self.linked.lines[number]
                if self.linked.turning[line.on] == GROUND and line.on == GROUND:
                    return ids.POINT_RATE[RATES[rate.order]](line.point)
                joint = f"{line.body},{number}"
                return ids.slide_velocity(joint) if first else ids.slide_acceleration(joint)
        return ids.POINT_RATE[RATES[rate.order]](rate.of)

    def symbol(self, rate: CoordinateRate) -> Symbol:
        """Return the symbol of a rate, whether it is known or not: ω or ε of a body, v or a of a travel or a point."""
        match rate.of:
            case Turn(body):
                return Symbol("ω" if rate.order == VELOCITY else "ε", self.linked.letter(body))
            case SlideTravel(number):
                line = self.linked.lines[number]
                return Symbol(RATES[rate.order], line.point, "r" if line.on != GROUND else "")
        return Symbol(RATES[rate.order], rate.of)

    def expression(self, rate: CoordinateRate) -> Expression:
        """Return a known rate with its sense; the zero expression for a zero rate."""
        value, id = self.value(rate), self.id(rate)
        if id not in self.derivation.q or self.derivation.q.si(id) == 0:
            return NOTHING
        return signed(value, self.derivation.q[id])

    def product(self, rates: Sequence[CoordinateRate], by_symbol: bool = False) -> Expression:
        """Return the product of rates, two equal ones as a square; 1 for no rates."""
        if len(rates) == 2 and rates[0] == rates[1]:
            return square(self.symbol(rates[0]) if by_symbol else self.expression(rates[0]))
        return times(*(self.symbol(rate) if by_symbol else self.expression(rate) for rate in rates)) if rates else ONE

    def vector(self, vector: LoopVector) -> complex:
        """Return a vector (m) without its rates."""
        return vector.value * cmath.exp(1j * self.linked.heading(vector.direction)) * 1j**vector.quarters

    # --- products of vectors, as they are written

    def cross(self, a_terms: Sequence[LoopVector], b_terms: Sequence[LoopVector]) -> Expression:
        """Return Σ a × b as an expression."""
        return plus(*(self._product(a, b, b.quarters - a.quarters) for a in a_terms for b in b_terms))

    def dot(self, a_terms: Sequence[LoopVector], b_terms: Sequence[LoopVector]) -> Expression:
        """Return Σ a · b as an expression; a cosine is written as the sine of an angle larger by 90°."""
        return plus(*(self._product(a, b, b.quarters - a.quarters + 1) for a in a_terms for b in b_terms))

    def _product(self, a: LoopVector, b: LoopVector, quarters: int) -> Expression:
        between = self.linked.between(a.direction, b.direction)
        return times(*self._factors(a), *self._factors(b), self._trigonometric(between, quarters))

    def _factors(self, vector: LoopVector) -> tuple[Expression, ...]:
        return self._ordered(self.product(vector.rates), self.linked.with_travels(vector.length))

    @staticmethod
    def _ordered(rates: Expression, factor: Expression) -> tuple[Expression, Expression]:
        """Return a product in printing order: a number precedes the rates, a length follows them."""
        return (factor, rates) if isinstance(factor, Number) else (rates, factor)

    @staticmethod
    def _trigonometric(angle: Expression, quarters: int) -> Expression:
        """Return sin(angle + quarters · 90°)."""
        if isinstance(angle, Negative):
            # sin(−φ) = −sin φ, cos(−φ) = cos φ
            angle, quarters = angle.of, quarters + (0 if quarters % 2 else 2)
        value = (sine, cosine)[quarters % 2](angle)
        return value if quarters % 4 < 2 else minus(value)

    def component(self, vectors: Iterable[LoopVector], axis: str, by_symbol: bool = False) -> Expression:
        """Return the sum of vectors along `axis`, x or y."""
        terms = []
        for vector in vectors:
            turned = self._trigonometric(self.linked.angle(vector.direction), vector.quarters + (axis == "x"))
            factors = self._ordered(self.product(vector.rates, by_symbol), self.linked.with_travels(vector.length))
            terms.append(times(*factors, turned))
        return plus(*terms)

    def chains(self, *sides: Sequence[LoopVector]) -> tuple[Chain, ...]:
        """Return the sides of a vector equation along x and along y."""
        return tuple(Chain(tuple(self._lettered(self.component(side, axis, True)) for side in sides)) for axis in "xy")

    def _lettered(self, formula: Expression) -> Expression:
        return substitute(formula, lambda ref: self.derivation.q.families[ref.id].symbol)

    def closure(self, closure: Closure) -> tuple[Chain, ...]:
        """Return the equations of a loop along x and along y."""
        sides = []
        for place in (closure.outward, closure.back):
            sides.append(
                [plus(fixed, self.component(place.legs, axis)) for axis, fixed in zip("xy", place.fixed, strict=True)]
            )
        return tuple(Chain(tuple(map(self._lettered, pair))) for pair in zip(*sides, strict=True))
