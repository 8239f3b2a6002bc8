"""An engine by its orders with its ledger, and common mistakes in its quantities.

`SolvedEngine` also computes forces and couples at any crank angle.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from reportgen.balancing import orders_ids
from reportgen.balancing.engine_calculation import ORDERS, EngineCalculation, times_direction
from reportgen.balancing.engine_file import Parameters
from reportgen.balancing.piston_orders import first_term
from reportgen.case import Misconceptions
from reportgen.case.design_case import DesignCase
from reportgen.formula import PI, Expression, Ref, refs, total
from reportgen.formula.calculation import Calculation
from reportgen.formula.evaluation import evaluate
from reportgen.formula.ledger import MistakenValues

FIRST_TERM = "orders-first-term"
"""Name of the approximation of a factor by the first term of its series: A₂ = λ."""


@dataclass(frozen=True)
class SolvedEngine(DesignCase):
    """An assignment of an engine with its ledger."""

    @property
    def given(self) -> Parameters:
        parameters: Parameters = self.assignment.parameters
        return parameters

    @cached_property
    def entered(self) -> EngineCalculation:
        """The object that made the calculation."""
        sheet = EngineCalculation(self.given)
        sheet.written()
        return sheet

    @property
    def calculation(self) -> Calculation:
        return self.entered.q

    @property
    def cylinders(self) -> tuple[str, ...]:
        return self.entered.cylinders

    @property
    def stars(self) -> Mapping[str, str]:
        """The letters of the stars: under "forces", and under "couples" if the cylinders are at several places."""
        return self.entered.stars

    @property
    def speed(self) -> float:
        """Angular velocity of the crankshaft (rad/s)."""
        return self.given.n.si

    def forces(self, φ: ArrayLike) -> dict[int, NDArray[np.complex128]]:
        """Return, by order, the force (N, x + iy) on the frame at crank angles φ (rad), in the shape of φ: Σ K Aₙ cos
        n(φ + θ − ψ) e^{iψ}.
        """
        return self._by_order(φ, [1.0] * len(self.cylinders))

    def couples(self, φ: ArrayLike) -> dict[int, NDArray[np.complex128]]:
        """Return, by order, the couple (N·m) on the frame at crank angles φ (rad), in the shape of φ: each force times
        its arm c.
        """
        return self._by_order(φ, self._arms)

    def rotating(self, φ: ArrayLike) -> NDArray[np.complex128]:
        """Return the force of the rotating masses (N) at crank angles φ (rad), in the shape of φ: Σ m_A r ω² e^{i(φ +
        θ)}.
        """
        return self._rotating(φ, [1.0] * len(self.cylinders))

    def rotating_couple(self, φ: ArrayLike) -> NDArray[np.complex128]:
        """Return the couple of the rotating masses (N·m) at crank angles φ (rad), in the shape of φ."""
        return self._rotating(φ, self._arms)

    @property
    def _arms(self) -> list[float]:
        """Arm c of each cylinder (m); the ledger has none if all cylinders are at one place."""
        return [float(self.ledger[orders_ids.arm(place)].values[0]) for place in self.cylinders]

    def _by_order(self, φ: ArrayLike, weights: Sequence[float]) -> dict[int, NDArray[np.complex128]]:
        K = self.ledger["orders.K"].values[0]
        cylinders = [(one.crank.si, one.bank.si) for one in self.given.cylinders]
        by_order = {}
        for order in ORDERS:
            A = 1.0 if order == 1 else self.ledger[orders_ids.factor(order)].values[0]
            parts = [
                c * self._weight(order, place) * np.cos(order * (np.asarray(φ) + θ - ψ)) * np.exp(1j * ψ)
                for c, place, (θ, ψ) in zip(weights, self.cylinders, cylinders, strict=True)
            ]
            by_order[order] = np.asarray(K * A * sum(parts))
        return by_order

    def _rotating(self, φ: ArrayLike, weights: Sequence[float]) -> NDArray[np.complex128]:
        turned = np.exp(1j * np.asarray(φ))
        given, ω = self.given, float(self.ledger["orders.omega"].values[0])
        share = 0.0 if given.s is None else 1 - given.s.si
        whole = 0j
        for c, place, cylinder in zip(weights, self.cylinders, given.cylinders, strict=True):
            m_A = given.of_cylinder(place, "m1") + share * given.of_cylinder(place, "m2")
            whole += c * m_A * given.of_cylinder(place, "r") * np.exp(1j * cylinder.crank.si)
        return np.asarray(ω**2 * turned * whole)

    def _weight(self, order: int, place: str) -> float:
        """Return the force of a cylinder in an order, as a share of that by the data of all cylinders."""
        own = [id for id in (orders_ids.weight(order, place), orders_ids.weight(1, place)) if id in self.ledger]
        return float(self.ledger[own[0]].values[0]) if own else 1.0

    def length_of(self, star: str, order: int, place: str) -> float:
        """Return the printed length of a vector in a star: a number, or in a star of couples metres."""
        weight = self.entered.weights(star, order)[place]
        return float(np.ravel(evaluate(weight, {id: self.printed[id].values for id in refs(weight)}))[0])

    # --- what is often taken for something else

    @cached_property
    def misconceptions(self) -> Misconceptions:
        """Common mistakes: φ for 2φ, λ upside down, ω for ω², the share taken of the rotating part, degrees for
        radians.
        """
        changed: dict[str, list[tuple[str, Expression]]] = {}
        for id, name, formula in (*self._of_stars(), *self._of_one_cylinder(), *self._of_counterweight()):
            changed.setdefault(id, []).append((name, formula))
        λ = Ref("orders.lambda")
        first_terms = {orders_ids.factor(order): [(FIRST_TERM, first_term(order, λ))] for order in ORDERS[1:]}
        return Misconceptions(changed=changed, approximations=first_terms)

    def _of_stars(self) -> MistakenValues:
        for star in "".join(self.stars.values()):
            for order in ORDERS:
                id = orders_ids.resultant(star, order)
                own = {place: Ref(orders_ids.angle(star, order, place)) for place in self.cylinders}
                if order != 1:
                    single = {place: Ref(orders_ids.angle(star, 1, place)) for place in self.cylinders}
                    yield id, "orders-single-angle", self._star(star, order, single)
                in_degrees = {place: at * 180 / PI for place, at in own.items()}
                yield id, "degrees-for-radians", self._star(star, order, in_degrees)

    def _star(self, star: str, order: int, angles: Mapping[str, Expression]) -> Expression:
        """Return the resultant of a star whose vectors have these angles."""
        weights = self.entered.weights(star, order)
        return abs(total([times_direction(weights[place], angles[place]) for place in self.cylinders]))

    def _of_one_cylinder(self) -> MistakenValues:
        m, r, ω = Ref("orders.m"), Ref("orders.r"), Ref("orders.omega")
        yield orders_ids.factor(2), "orders-inverse-lambda", Ref("orders.l") / r
        yield "orders.K", "orders-speed-once", m * r * ω

    def _of_counterweight(self) -> MistakenValues:
        r, m, m_A, ω = (Ref(f"orders.{name}") for name in ("r", "m", "mA", "omega"))
        if self.given.own_data:
            for after in ("", ".M"):
                if f"orders.rotating{after}" in self.ledger:
                    yield f"orders.rotating{after}", "orders-speed-once", Ref(f"orders.rotating{after}") / ω
            return
        if not self.given.rotates:
            return
        f = Ref(orders_ids.resultant("f", 1))
        yield "orders.rotating", "orders-speed-once", m_A * r * ω * f
        yield "orders.U", "orders-share-of-rotating", (m_A + m) / 2 * r * f
        if "couples" in self.stars:
            p = Ref(orders_ids.resultant("p", 1))
            yield "orders.rotating.M", "orders-speed-once", m_A * r * ω * p
            yield "orders.U.M", "orders-share-of-rotating", (m_A + m) / 2 * r * p
