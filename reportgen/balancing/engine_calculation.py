"""The calculation of an engine by orders: factors of the piston's acceleration, stars of cranks, forces, couples.

The piston of a cylinder with its crank at θ and its bank at ψ pulls on the frame, in order n, with

    m r ω² Aₙ cos n(φ + θ − ψ) e^{iψ} = ½ m r ω² Aₙ (e^{i(nφ + γ)} + e^{−i(nφ + γ′)})

γ = nθ − (n − 1)ψ, γ′ = nθ − (n + 1)ψ: two vectors that turn with the crank and against it. The vectors of all cylinders
add up to the stars f and g, and with their arms along the shaft to p and q. Source: Euler's identity.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from reportgen.balancing import orders_ids as names
from reportgen.balancing.engine_file import Parameters
from reportgen.balancing.piston_orders import acceleration_factor, short_series
from reportgen.base.units import MM, nice_up
from reportgen.drawing.geometry import corners_of
from reportgen.formula import PI, Expression, Number, Ref, cis, cos, heading, refs, sin, size, sqrt, total
from reportgen.formula.calculation import Calculation
from reportgen.formula.evaluation import evaluate
from reportgen.formula.vocabulary import KeyChapter

ORDERS = (1, 2, 4)
"""Orders in the report; higher ones are negligible."""
FACTORS = (2, 4, 6)
"""Further orders of the piston's acceleration besides the first; odd ones are zero."""
FORCES, COUPLES = "fg", "pq"
"""Letters of the stars; the first of each pair turns with the crank."""
STAR = 46.0
"""Largest width or height of the largest star of a kind on a page (mm)."""


class EngineCalculation:
    """The calculation of an engine during its construction; `written()` returns it."""

    def __init__(self, given: Parameters) -> None:
        self.given, self.q = given, Calculation()
        self.cylinders = tuple(str(number) for number in range(1, len(given.cylinders) + 1))
        self.stars = {"forces": FORCES[:1] if given.is_inline else FORCES}
        if given.has_length:
            self.stars["couples"] = COUPLES[:1] if given.is_inline else COUPLES

    def written(self) -> Calculation:
        with self.q.within(KeyChapter.data):
            self._enter_given()
        with self.q.within(KeyChapter.geometry):
            self._enter_factors()
            self._enter_weights()
            self._enter_arms()
        with self.q.within(KeyChapter.forces):
            for stars in self.stars.values():
                self._enter_stars(stars)
            self._enter_forces()
        with self.q.within(KeyChapter.torque):
            if self.given.own_data:
                self._enter_own_counterweight()
            else:
                self._enter_counterweight()
        return self.q

    def _enter_given(self) -> None:
        q, given = self.q, self.given
        q.give("orders.r", given.r.si)
        q.give("orders.l", given.l.si)
        q.give("orders.n", given.n.si * 30 / math.pi)
        for id, datum in (
            *(("orders.m1", given.m1), ("orders.m2", given.m2), ("orders.s", given.s), ("orders.m3", given.m3)),
        ):
            if datum is not None:
                q.give(id, datum.si)
        for place, cylinder in zip(self.cylinders, given.cylinders, strict=True):
            q.give(names.crank(place), cylinder.crank.si)
            q.give(names.bank(place), cylinder.bank.si)
            if given.has_length:
                q.give(names.station(place), cylinder.at.si)
            for key in given.own_data:
                id = names.own_radius(place) if key == "r" else names.own_mass(key[1:], place)
                q.give(id, given.of_cylinder(place, key))

    # --- one cylinder

    def _enter_factors(self) -> None:
        q = self.q
        ω = q.define("orders.omega", 2 * PI * q["orders.n"] / 60)
        λ = q.define("orders.lambda", q["orders.r"] / q["orders.l"])
        m: Expression = q["orders.m3"]
        turning: list[Expression] = [] if self.given.m1 is None else [q["orders.m1"]]
        if self.given.m2 is not None:
            m2, s = q["orders.m2"], q["orders.s"]
            turning.append(m2 * (1 - s))
        if turning:
            q.set_out("masses", q.define("orders.mA", total(turning)))
        if self.given.m2 is not None:
            m_B = q.define("orders.mB", m2 * s)
            q.set_out("masses", m_B)
            m = m + m_B
        m_rec = q.define("orders.m", m)
        q.set_out("masses", m_rec)
        q.set_out("crank", ω, λ)
        for order in FACTORS:
            inner = q.define(names.exact(order), acceleration_factor(order, λ, q.si(λ)), hidden=True)
            A = q.define(names.factor(order), inner, optional=order not in ORDERS)
            first_terms = q.define(names.series(order), short_series(order, λ), optional=True)
            error = q.define(names.off(order), (first_terms - A) / A, optional=True, residue=True)
            q.set_out("factors", A)
            q.set_out("series", first_terms, error)
        q.set_out("amplitude", q.define("orders.K", m_rec * q["orders.r"] * ω**2))

    def _enter_arms(self) -> None:
        """Enter the arms of the cylinders, from the middle between the first and the last cylinder."""
        q, given = self.q, self.given
        if not given.has_length:
            return
        along = sorted(self.cylinders, key=lambda place: q.si(names.station(place)))
        first, last = (q[names.station(place)] for place in (along[0], along[-1]))
        z0 = q.define("orders.z0", (first + last) / 2, optional=True)
        q.set_out("middle", z0)
        for place in self.cylinders:
            q.define(names.arm(place), q[names.station(place)] - z0, optional=True)

    # --- cylinders that differ

    def _enter_weights(self) -> None:
        """Enter, for cylinders with masses or cranks of their own, the vectors of the stars: m_j r_j A_nj/(m r A_n)."""
        own = self.given.own_data
        if not own:
            return
        q = self.q
        for place in self.cylinders:
            m1, m2, m3 = (self._datum(key, place) for key in ("m1", "m2", "m3"))
            parts = [] if m2 is None else [m2 * q["orders.s"]]
            m = q.define(names.reciprocating(place), total([m3, *parts]))
            q.set_out("lengths", m)
            parts = [] if m2 is None else [m2 * (1 - q["orders.s"])]
            if turning := [part for part in (m1, *parts) if part is not None]:
                q.set_out("lengths", q.define(names.rotating(place), total(turning)))
            r = self._datum("r", place)
            w = q.define(names.weight(1, place), m * r / (q["orders.m"] * q["orders.r"]))
            q.set_out("lengths", w)
            if "r" not in own:
                continue
            λ = q.define(names.own_ratio(place), r / q["orders.l"], optional=True)
            for order in ORDERS[1:]:
                inner = q.define(names.own_exact(order, place), acceleration_factor(order, λ, q.si(λ)), hidden=True)
                A = q.define(names.own_factor(order, place), inner, optional=True)
                q.define(names.weight(order, place), w * A / q[names.factor(order)], optional=True)

    def _datum(self, key: str, place: str) -> Any:
        """Return a given quantity of a cylinder, its own or that of all; None for a mass that is missing."""
        own = names.own_radius(place) if key == "r" else names.own_mass(key[1:], place)
        return self.q.find(own) or self.q.find(f"orders.{key}")

    def weights(self, star: str, order: int) -> dict[str, Expression]:
        """Return the length of each vector in a star: its weight, 1 if all are alike, for couples times its arm."""
        q, weights = self.q, {}
        for place in self.cylinders:
            w = q.find(names.weight(order, place)) or q.find(names.weight(1, place))
            c = q[names.arm(place)] if star in COUPLES else None
            weights[place] = c if w is None else (w if c is None else w * c)
        return {place: Number(1.0) if weight is None else weight for place, weight in weights.items()}

    # --- stars

    def _enter_stars(self, stars: str) -> None:
        """Enter the stars of forces, or of couples, at one common scale."""
        q = self.q
        weights = {order: self.weights(stars[0], order) for order in ORDERS}
        angles = {(star, order): self._enter_angles(star, order) for star in stars for order in ORDERS}
        sizes = [self._extent(weights[order], of) for (_, order), of in angles.items()]
        per_mm = nice_up(max(sizes) / STAR)
        for (star, order), directions in angles.items():
            id = names.scale(star)
            μ = q.find(id) or q.give(id, per_mm * MM, optional=True)
            vectors = [times_direction(weights[order][place], directions[place]) for place in self.cylinders]
            plan = q.construct(names.drawn(star, order), total(vectors) / μ)
            every = sum(abs(self._weight(of)) for of in weights[order].values())
            s = q.define(names.measured(star, order), abs(plan), optional=True, scale=every / q.si(μ))
            result = q.define(names.resultant(star, order), μ * s, scale=every)
            q.set_out(f"star_{star}", result)

    def _enter_angles(self, star: str, order: int) -> Mapping[str, Ref]:
        """Return γ = nθ − (n − 1)ψ for a star that turns with the crank, nθ − (n + 1)ψ for one that turns
        against it.
        """
        q, with_crank = self.q, star in (FORCES[0], COUPLES[0])
        times = order - 1 if with_crank else order + 1
        angles = {}
        for place in self.cylinders:
            angle: Expression = q[names.crank(place)] if order == 1 else order * q[names.crank(place)]
            if times and not self.given.is_inline:
                ψ = q[names.bank(place)]
                angle = angle - (ψ if times == 1 else times * ψ)
            angles[place] = q.define(names.angle(star, order, place), angle, optional=True)
        return angles

    def _weight(self, of: Expression) -> float:
        """Return the length of a vector in its star."""
        return float(np.ravel(evaluate(of, {id: self.q.value(id) for id in refs(of)}))[0])

    def _extent(self, weights: Mapping[str, Expression], directions: Mapping[str, Ref]) -> float:
        """Return the larger of width and height of a star, as its vectors are drawn one after another."""
        steps = [self._weight(weights[place]) * np.exp(1j * self.q.si(directions[place])) for place in self.cylinders]
        low, high = corners_of(np.cumsum([0.0, *steps]))
        return max((high - low).real, (high - low).imag)

    # --- forces and couples

    def _enter_forces(self) -> None:
        """Enter F = K A f, or K A (f + g)/2 if the cylinders are in several banks, whose least force is K A |f − g|/2.

        In line, the force of an order passes through zero.
        """
        q = self.q
        for what, stars in self.stars.items():
            family, least = names.force, names.least_force
            if what == "couples":
                family, least = names.couple, names.least_couple
            for order in ORDERS:
                parts = [q[names.resultant(star, order)] for star in stars]
                mean = parts[0] if len(parts) == 1 else (parts[0] + parts[1]) / 2
                K = q["orders.K"]
                amplitude = K if order == 1 else K * q[names.factor(order)]
                A = 1.0 if order == 1 else abs(q.si(names.factor(order)))
                of_all = q.si(K) * A * sum(q.families[part.id].scale for part in parts) / len(parts)
                # A₄ is negative, but the report needs the size.
                q.set_out(what, q.define(family(order), abs_of(order, amplitude * mean), scale=of_all))
                if len(parts) > 1:
                    difference = amplitude * (parts[0] - parts[1]) / 2
                    q.set_out(f"least_{what}", q.define(least(order), size(difference), scale=of_all))

    def _enter_counterweight(self) -> None:
        """Enter the counterweight (m_A + ½ m_rec) r f₁ opposite to the star f₁, which balances all force that turns
        with the crank.
        """
        q = self.q
        f = q[names.resultant("f", 1)]
        r, m, ω = q["orders.r"], q["orders.m"], q["orders.omega"]
        turning: Expression = m / 2
        every = q.families[f.id].scale
        if self.given.rotates:
            m_A = q["orders.mA"]
            rotating = q.define("orders.rotating", m_A * r * ω**2 * f, scale=q.si(m_A) * q.si(r) * q.si(ω) ** 2 * every)
            q.set_out("counterweight", rotating)
            turning = m_A + turning
        U = q.define("orders.U", turning * r * f, scale=q.si(m) * q.si(r) * every)
        g = f if self.given.is_inline else q[names.resultant("g", 1)]
        left = q.define("orders.left", q["orders.K"] * g / 2, scale=q.si("orders.K") * every)
        q.set_out("counterweight", U, left)
        if self.given.has_length:
            self._enter_couple_of_counterweights(turning)

    def _enter_couple_of_counterweights(self, turning: Expression) -> None:
        """Enter the couple m_A r ω² p₁ of the rotating masses, and the effect of counterweights with a couple opposite
        to p₁.

        (m_A + ½ m_rec) r p₁ balances everything that turns with the crank: all of the first order if the star q₁ is
        closed.
        """
        q = self.q
        p = q[names.resultant("p", 1)]
        r, m, ω = q["orders.r"], q["orders.m"], q["orders.omega"]
        every = q.families[p.id].scale
        if self.given.rotates:
            m_A = q["orders.mA"]
            scale = q.si(m_A) * q.si(r) * q.si(ω) ** 2 * every
            q.set_out("couples_balanced", q.define("orders.rotating.M", m_A * r * ω**2 * p, scale=scale))
        U = q.define("orders.U.M", turning * r * p, scale=q.si(m) * q.si(r) * every)
        against = p if self.given.is_inline else q[names.resultant("q", 1)]
        left = q.define("orders.left.M", q["orders.K"] * against / 2, scale=q.si("orders.K") * every)
        q.set_out("couples_balanced", U, left)

    def _enter_own_counterweight(self) -> None:
        """Enter counterweights against the sums of (m_A + ½ m_rec) r e^{iθ} of cylinders that differ, and their couple.

        The second star of the first order is left over, as if all cylinders were alike.
        """
        q, given, ω = self.q, self.given, self.q["orders.omega"]
        for place in self.cylinders:
            m_A, m, r = q.find(names.rotating(place)), q[names.reciprocating(place)], self._datum("r", place)
            if m_A is not None:
                q.set_out("products", q.define(names.product("rot", place), m_A * r, optional=True))
            turning = m / 2 if m_A is None else m_A + m / 2
            q.set_out("products", q.define(names.product("U", place), turning * r, optional=True))
        rotates = names.product("rot", self.cylinders[0]) in q
        for of, line in (("", "counterweight"), ("M", "couples_balanced")):
            if of and not given.has_length:
                continue
            after = f".{of}" if of else ""
            if rotates:
                h, every = self._enter_turning("rot", of, line)
                id = f"orders.rotating{after}"
                q.set_out(line, q.define(id, h * ω**2, scale=every * q.si(ω) ** 2))
            size_of_all, every = self._enter_turning("U", of, line)
            U = q.define(f"orders.U{after}", size_of_all, scale=every)
            x, y = (Ref(names.turning(f"U{of}", axis)) for axis in "xy")
            α = q.define(f"orders.U{after}.dir", heading(-(x + y * cis(PI / 2))), of=U.id)
            against = q[names.resultant(self.stars["couples" if of else "forces"][-1], 1)]
            scale = q.si("orders.K") * q.families[against.id].scale
            left = q.define(f"orders.left{after}", q["orders.K"] * against / 2, scale=scale)
            q.set_out(line, U, *([α] if q.families[U.id].at(1) else []), left)

    def _enter_turning(self, of: str, arms: str, line: str) -> tuple[Expression, float]:
        """Return the size of the sum of products that turn, with their arms if there are `arms`, and that of all in one
        direction (SI).
        """
        q = self.q
        sizes: dict[str, Expression] = {place: q[names.product(of, place)] for place in self.cylinders}
        if arms:
            sizes = {place: size * q[names.arm(place)] for place, size in sizes.items()}
        every = sum(abs(self._weight(size)) for size in sizes.values())
        x, y = (
            q.define(
                names.turning(of + arms, axis),
                total([size * function(q[names.crank(place)]) for place, size in sizes.items()]),
                optional=True,
                scale=every,
            )
            for axis, function in (("x", cos), ("y", sin))
        )
        q.set_out(line, x, y)
        return sqrt(x**2 + y**2), every


def times_direction(weight: Expression, direction: Expression) -> Expression:
    """Return a vector of this weight in a direction."""
    return cis(direction) if isinstance(weight, Number) else weight * cis(direction)


def abs_of(order: int, of: Expression) -> Expression:
    """Return the size of a force of an order; the factor of the fourth order is negative."""
    return size(of) if order == ORDERS[-1] else of
