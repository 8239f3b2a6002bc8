"""A synthesis through three points with its ledger: pairs of angles, Freudenstein's factors, links, errors."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from reportgen.case import Misconceptions
from reportgen.case.design_case import DesignCase
from reportgen.formula import (
    Chain,
    Expression,
    Number,
    Ref,
    Symbol,
    acos,
    atan2,
    call,
    cos,
    exp,
    ln,
    sin,
    size,
    sqrt,
    tan,
)
from reportgen.formula.calculation import Calculation
from reportgen.formula.ledger import MistakenValues
from reportgen.structure import synthesis_ids
from reportgen.structure import three_point_names as names
from reportgen.structure.synthesis_file import Parameters
from reportgen.structure.three_pairs import ThreePairs

THREE = (1, 2, 3)
SPACING = Number(30.0, unit="°")
STRAIGHT = Number(180.0, None, "°")
TURN = 360.0
POLE = 1e-9


def value_of(given: Parameters, x: float) -> float:
    """Return the function of a file at x (rad for an angle); nan where it is not defined."""
    try:
        match given.function:
            case "ln":
                return math.log(x)
            case "exp":
                return math.exp(x)
            case "sin":
                return math.sin(x)
            case "tan":
                # Near a pole the value has no figures left.
                return math.tan(x) if abs(math.cos(x)) > POLE else math.nan
            case _:
                assert given.exponent is not None
                value = x**given.exponent
                return math.nan if isinstance(value, complex) else value
    except (ValueError, ZeroDivisionError, OverflowError):
        return math.nan


def chebyshev_points(first: float, last: float) -> tuple[float, ...]:
    """Return the three points of a range at which an approximation is exact so that its error is smallest.

    They are the projections of the corners of a regular hexagon about the range.
    """
    middle, half = (first + last) / 2, (last - first) / 2
    return middle - half * math.cos(math.pi / 6), middle, middle + half * math.cos(math.pi / 6)


def pairs_of(given: Parameters) -> ThreePairs:
    """Return the three pairs of angles that a file asks for; its required keys are there."""
    assert given.d is not None
    if given.pairs is not None:
        driver, follower = zip(*([angle.si for angle in pair] for pair in given.pairs), strict=True)
        return ThreePairs(driver, follower, given.d.si)
    assert given.x is not None
    assert given.driver is not None
    assert given.follower is not None
    (φ0, φn), (ψ0, ψn) = ([angle.si for angle in ends] for ends in (given.driver, given.follower))
    x0, xn = (end.si for end in given.x)
    points = chebyshev_points(x0, xn)
    y0, yn = value_of(given, x0), value_of(given, xn)
    return ThreePairs(
        tuple(φ0 + (φn - φ0) * (x - x0) / (xn - x0) for x in points),
        tuple(ψ0 + (ψn - ψ0) * (value_of(given, x) - y0) / (yn - y0) for x in points),
        given.d.si,
    )


@dataclass(frozen=True)
class SolvedThreePoints(DesignCase):
    """An assignment of a synthesis through three points with its linkage and its ledger."""

    @property
    def given(self) -> Parameters:
        parameters: Parameters = self.assignment.parameters
        return parameters

    @cached_property
    def pairs(self) -> ThreePairs:
        return pairs_of(self.given)

    @property
    def side(self) -> int:
        """The branch of the linkage, 1 or −1."""
        side = self.pairs.side
        assert side is not None, "the file has been checked"
        return side

    @property
    def ends(self) -> tuple[float, float]:
        """The crank angles (rad) between which the linkage moves."""
        given = self.given
        if given.driver is not None:
            return given.driver[0].si, given.driver[1].si
        return min(self.pairs.driver), max(self.pairs.driver)

    @property
    def follows_function(self) -> bool:
        return self.given.function is not None

    @property
    def is_poor(self) -> bool:
        """True if the least transmission angle is less than permitted."""
        return float(self.ledger[names.LEAST].values[0]) < self.given.gamma.si

    @property
    def lengths(self) -> dict[str, str]:
        """The ids of the lengths, by their letters."""
        return {"a": names.CRANK, "b": names.COUPLER, "c": names.FOLLOWER, "d": synthesis_ids.FRAME}

    # --- ledger

    @cached_property
    def calculation(self) -> Calculation:
        q, given = Calculation(), self.given
        assert given.d is not None
        q.give(synthesis_ids.FRAME, given.d.si)
        q.give(synthesis_ids.PERMITTED, given.gamma.si)
        if self.follows_function:
            self._enter_points(q)
        else:
            for k, φ, ψ in zip(THREE, self.pairs.driver, self.pairs.follower, strict=True):
                q.give(names.driver(k), φ)
                q.give(names.follower(k), ψ)
        self._enter_factors(q)
        self._enter_links(q)
        self._enter_transmission(q)
        if self.follows_function:
            self._enter_errors(q)
        return q

    def _function(self, x: Expression) -> Expression:
        match self.given.function:
            case "ln":
                return ln(x)
            case "exp":
                return exp(x)
            case "sin":
                return sin(x)
            case "tan":
                return tan(x)
            case _:
                assert self.given.exponent is not None
                return x**self.given.exponent

    @property
    def function_equation(self) -> Expression:
        """The function as it is written, such as y = ln x."""
        return Chain((Symbol("y"), self._function(Symbol("x"))))

    def _enter_points(self, q: Calculation) -> None:
        """Enter the three points of the function, and the angles that go with them."""
        given = self.given
        assert given.x is not None
        assert given.driver is not None
        assert given.follower is not None
        first, last = given.x
        kind, fine = ("angle", "fine angle") if first.unit else ("", "")
        x0, xn = q.give(names.FIRST_X, first.si, kind=kind), q.give(names.LAST_X, last.si, kind=kind)
        φ0, φn = q.give(names.FIRST_DRIVER, given.driver[0].si), q.give(names.LAST_DRIVER, given.driver[1].si)
        ψ0, ψn = q.give(names.FIRST_FOLLOWER, given.follower[0].si), q.give(names.LAST_FOLLOWER, given.follower[1].si)
        half = (xn - x0) / 2 * cos(SPACING)
        middle = (x0 + xn) / 2
        x = [
            q.define(names.argument(k), at, kind=fine)
            for k, at in zip(THREE, (middle - half, middle, middle + half), strict=True)
        ]
        y0, yn = q.define(names.FIRST_Y, self._function(x0)), q.define(names.LAST_Y, self._function(xn))
        y = [q.define(names.result(k), self._function(x[k - 1])) for k in THREE]
        φ = [q.define(names.driver(k), φ0 + (φn - φ0) * (x[k - 1] - x0) / (xn - x0)) for k in THREE]
        ψ = [q.define(names.follower(k), ψ0 + (ψn - ψ0) * (y[k - 1] - y0) / (yn - y0)) for k in THREE]
        q.set_out("arguments", *x)
        q.set_out("results", y0, yn, *y)
        q.set_out("angles", *φ, *ψ)

    def _enter_factors(self, q: Calculation) -> None:
        """Enter Freudenstein's factors: the differences of the equations of two pairs are linear in K₁ and K₂."""
        φ1, ψ1 = q[names.driver(1)], q[names.follower(1)]
        p, s, t = {}, {}, {}
        for k in (2, 3):
            φ, ψ = q[names.driver(k)], q[names.follower(k)]
            p[k] = q.define(names.driver_difference(k), cos(φ1) - cos(φ))
            s[k] = q.define(names.follower_difference(k), cos(ψ1) - cos(ψ))
            t[k] = q.define(names.right_side(k), cos(φ1 - ψ1) - cos(φ - ψ))
            q.set_out("differences", p[k], s[k], t[k])
        determinant = p[3] * s[2] - p[2] * s[3]
        K1 = q.define(names.factor(1), (p[3] * t[2] - p[2] * t[3]) / determinant)
        K2 = q.define(names.factor(2), (s[3] * t[2] - s[2] * t[3]) / determinant)
        K3 = q.define(names.factor(3), cos(φ1 - ψ1) - K1 * cos(ψ1) + K2 * cos(φ1))
        q.set_out("factors", K1, K2, K3)

    def _enter_links(self, q: Calculation) -> None:
        d, K1, K2, K3 = q[synthesis_ids.FRAME], *(q[names.factor(k)] for k in THREE)
        a, c = q.define(names.CRANK, d / K1), q.define(names.FOLLOWER, d / K2)
        b = q.define(names.COUPLER, sqrt(a**2 + c**2 + d**2 - 2 * a * c * K3))
        q.set_out("links", a, c, b)

    def _enter_transmission(self, q: Calculation) -> None:
        """Enter the angle between coupler and follower at both ends of the range, and on the frame line between."""
        a, b, c, d = (q[id] for id in (names.CRANK, names.COUPLER, names.FOLLOWER, synthesis_ids.FRAME))
        ends = sorted(self.ends)
        of_function = self.follows_function
        first, last = (q[id] for id in (names.FIRST_DRIVER, names.LAST_DRIVER)) if of_function else self._outer(q)
        angles: list[tuple[int, Expression | float]] = [(1, first), (2, last)]
        # Beside a multiple of 180° the distance of B from D is extreme.
        inside = [turn for turn in range(-2, 3) if ends[0] < turn * math.pi < ends[1]]
        angles += [(3 + number, math.cos(turn * math.pi)) for number, turn in enumerate(inside)]
        acute = []
        for number, φ in angles:
            diagonal = 2 * a * d * (cos(φ) if isinstance(φ, Expression) else Number(φ))
            μ = q.define(names.end_angle(number), acos((b**2 + c**2 - a**2 - d**2 + diagonal) / (2 * b * c)))
            acute.append(μ if q.si(μ) <= math.pi / 2 else STRAIGHT - μ)
            q.set_out("transmission", μ)
        q.set_out("transmission", q.define(names.LEAST, call("min", *acute)))

    def _outer(self, q: Calculation) -> tuple[Ref, Ref]:
        """Return the least and the largest of the given crank angles."""
        order = sorted(THREE, key=lambda k: q.si(names.driver(k)))
        return q[names.driver(order[0])], q[names.driver(order[-1])]

    def _enter_errors(self, q: Calculation) -> None:
        """Enter the structural error at both ends of the range and in the middle between the points."""
        places: list[tuple[Expression, Expression]] = [(q[names.FIRST_DRIVER], q[names.FIRST_FOLLOWER])]
        y0, yn = q[names.FIRST_Y], q[names.LAST_Y]
        ψ0, ψn = q[names.FIRST_FOLLOWER], q[names.LAST_FOLLOWER]
        for number in (1, 2):
            φ = q.define(names.middle_driver(number), (q[names.driver(number)] + q[names.driver(number + 1)]) / 2)
            middle = (q[names.argument(number)] + q[names.argument(number + 1)]) / 2
            y = q.define(names.middle_result(number), self._function(middle))
            ψ = q.define(names.middle_follower(number), ψ0 + (ψn - ψ0) * (y - y0) / (yn - y0))
            q.set_out("between", φ, y, ψ)
            places.append((φ, ψ))
        places.append((q[names.LAST_DRIVER], ψn))
        K1, K2, K3 = (q[names.factor(k)] for k in THREE)
        sizes = []
        for number, (at, wanted) in enumerate(places, start=1):
            across, along = -sin(at), K1 - cos(at)
            δ = q.define(names.direction(number), atan2(across, along))
            ε = q.define(names.opening(number), acos((K2 * cos(at) - K3) / sqrt(along**2 + sin(at) ** 2)))
            closing = δ + ε if self.side > 0 else δ - ε
            turns = round((self._si(q, wanted) - q.si(δ) - self.side * q.si(ε)) / math.tau)
            angle = q.define(names.actual(number), closing + Number(TURN * turns, unit="°") if turns else closing)
            error = q.define(names.error(number), angle - wanted)
            q.set_out(f"error{number}", δ, ε, angle, error)
            sizes.append(size(error))
        q.set_out("largest", q.define(names.LARGEST, call("max", *sizes)))

    @staticmethod
    def _si(q: Calculation, of: Expression) -> float:
        assert isinstance(of, Ref)
        return q.si(of)

    def error_at(self, φ: np.ndarray) -> np.ndarray:
        """Return the structural error (rad) at crank angles (rad): the follower's angle less the wanted one."""
        given = self.given
        assert given.x is not None
        assert given.follower is not None
        (x0, xn), (φ0, φn) = (end.si for end in given.x), self.ends
        y0, yn = value_of(given, x0), value_of(given, xn)
        ψ0, ψn = (angle.si for angle in given.follower)
        x = x0 + (xn - x0) * (φ - φ0) / (φn - φ0)
        wanted = ψ0 + (ψn - ψ0) * (np.array([value_of(given, float(one)) for one in x]) - y0) / (yn - y0)
        return np.remainder(self.pairs.angle(φ, self.side) - wanted + math.pi, math.tau) - math.pi

    # --- what is often taken for something else

    @cached_property
    def misconceptions(self) -> Misconceptions:
        """Common mistakes: the whole range, ψ proportional to x, φ + ψ, lengths exchanged, the sign of K₃."""
        changed: dict[str, list[tuple[str, Expression]]] = {}
        for id, name, formula in self._mistaken():
            if id in self.ledger:
                changed.setdefault(id, []).append((name, formula))
        return Misconceptions(changed=changed)

    def _mistaken(self) -> MistakenValues:
        if self.follows_function:
            yield from self._of_points()
        φ1, ψ1 = Ref(names.driver(1)), Ref(names.follower(1))
        for k in (2, 3):
            φ, ψ = Ref(names.driver(k)), Ref(names.follower(k))
            yield names.right_side(k), "synthesis-sum-of-angles", cos(φ1 + ψ1) - cos(φ + ψ)
        d, a, c = Ref(synthesis_ids.FRAME), Ref(names.CRANK), Ref(names.FOLLOWER)
        K1, K2, K3 = (Ref(names.factor(k)) for k in THREE)
        yield names.CRANK, "synthesis-factors-exchanged", d / K2
        yield names.FOLLOWER, "synthesis-factors-exchanged", d / K1
        yield names.COUPLER, "synthesis-sign-of-product", sqrt(a**2 + c**2 + d**2 + 2 * a * c * K3)

    def _of_points(self) -> Iterator[tuple[str, str, Expression]]:
        x0, xn = Ref(names.FIRST_X), Ref(names.LAST_X)
        ψ0, ψn = Ref(names.FIRST_FOLLOWER), Ref(names.LAST_FOLLOWER)
        middle, whole = (x0 + xn) / 2, (xn - x0) * cos(SPACING)
        yield names.argument(1), "synthesis-whole-range", middle - whole
        yield names.argument(3), "synthesis-whole-range", middle + whole
        for k in THREE:
            x = Ref(names.argument(k))
            yield names.follower(k), "synthesis-without-function", ψ0 + (ψn - ψ0) * (x - x0) / (xn - x0)
