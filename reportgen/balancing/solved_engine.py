"""An engine by its orders with its ledger, and what its quantities are often taken for."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from reportgen.balancing import orders_ids
from reportgen.balancing.engine_file import Parameters
from reportgen.balancing.engine_sheet import COUPLES, ORDERS, EngineSheet
from reportgen.formula import PI, Expression, Ref, cis, total
from reportgen.formula.piston_orders import first_term
from reportgen.formula.sheet import Sheet
from reportgen.report.case import Misconceptions
from reportgen.report.design import DesignCase

FIRST_TERM = "orders-first-term"
"""The name of a factor that was taken as the first term of its series: A₂ = λ."""

Changed = Iterator[tuple[str, str, Expression]]
"""Ids of quantities, the name of a mistake, what the quantity becomes by it."""


@dataclass(frozen=True)
class SolvedEngine(DesignCase):
    """An assignment of an engine with its ledger."""

    @property
    def given(self) -> Parameters:
        parameters: Parameters = self.assignment.parameters
        return parameters

    @cached_property
    def entered(self) -> EngineSheet:
        """The sheet with what it was written by."""
        sheet = EngineSheet(self.given)
        sheet.written()
        return sheet

    @property
    def sheet(self) -> Sheet:
        return self.entered.q

    @property
    def cylinders(self) -> tuple[str, ...]:
        return self.entered.cylinders

    @property
    def stars(self) -> Mapping[str, str]:
        """The letters of the stars of forces, and of couples if there are any."""
        return self.entered.stars

    @property
    def speed(self) -> float:
        """Of the crankshaft (rad/s)."""
        return self.given.n.si

    def forces(self, φ: ArrayLike) -> dict[int, NDArray[np.complex128]]:
        """The force on the frame (N) of each order with the crank at φ, x + iy: Σ K Aₙ cos n(φ + θ − ψ) e^{iψ}."""
        K = self.ledger["orders.K"].values[0]
        cylinders = [(one.crank.si, one.bank.si) for one in self.given.cylinders]
        by_order = {}
        for order in ORDERS:
            A = 1.0 if order == 1 else self.ledger[orders_ids.factor(order)].values[0]
            parts = [np.cos(order * (np.asarray(φ) + θ - ψ)) * np.exp(1j * ψ) for θ, ψ in cylinders]
            by_order[order] = np.asarray(K * A * sum(parts))
        return by_order

    # --- what is often taken for something else

    @cached_property
    def misconceptions(self) -> Misconceptions:
        """φ for 2φ, λ upside down, ω for ω², the share taken of the rotating part, degrees for radians."""
        changed: dict[str, list[tuple[str, Expression]]] = {}
        for id, name, formula in (*self._of_stars(), *self._of_one_cylinder(), *self._of_counterweight()):
            changed.setdefault(id, []).append((name, formula))
        λ = Ref("orders.lambda")
        first_terms = {orders_ids.factor(order): [(FIRST_TERM, first_term(order, λ))] for order in ORDERS[1:]}
        return Misconceptions(changed=changed, approximations=first_terms)

    def _of_stars(self) -> Changed:
        for star in "".join(self.stars.values()):
            for order in ORDERS:
                id = orders_ids.resultant(star, order)
                own = {place: Ref(orders_ids.angle(star, order, place)) for place in self.cylinders}
                if order != 1:
                    single = {place: Ref(orders_ids.angle(star, 1, place)) for place in self.cylinders}
                    yield id, "orders-single-angle", self._star(star, single)
                yield id, "degrees-for-radians", self._star(star, {place: at * 180 / PI for place, at in own.items()})

    def _star(self, star: str, angles: Mapping[str, Expression]) -> Expression:
        """The resultant of a star whose vectors have these angles."""
        if star in COUPLES:
            return abs(total([Ref(orders_ids.arm(place)) * cis(angles[place]) for place in self.cylinders]))
        return abs(total([cis(angles[place]) for place in self.cylinders]))

    def _of_one_cylinder(self) -> Changed:
        m, r, ω = Ref("orders.m"), Ref("orders.r"), Ref("orders.omega")
        yield orders_ids.factor(2), "orders-inverse-lambda", Ref("orders.l") / r
        yield "orders.K", "orders-speed-once", m * r * ω

    def _of_counterweight(self) -> Changed:
        r, f, m = Ref("orders.r"), Ref(orders_ids.resultant("f", 1)), Ref("orders.m")
        if self.given.m2 is not None:
            m_A = Ref("orders.mA")
            yield "orders.rotating", "orders-speed-once", m_A * r * Ref("orders.omega") * f
            yield "orders.U", "orders-share-of-rotating", (m_A + m) / 2 * r * f
