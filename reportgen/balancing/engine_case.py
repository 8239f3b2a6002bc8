"""An engine by its orders as a case: report and task with their tables, key, results, drawing sheet."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from reportgen.balancing import engine_drawings, engine_motion, orders_ids
from reportgen.balancing.engine_calculation import FACTORS, ORDERS
from reportgen.balancing.engine_solution import SolvedEngine
from reportgen.balancing.places_page import PlacesPage, bare
from reportgen.case.result_entries import ResultEntries
from reportgen.case.shafts import Shaft
from reportgen.document import Inlines, Table, Text
from reportgen.drawing import Scene
from reportgen.drawing.animation import Animation
from reportgen.drawing.figure_scale import IN_REPORT
from reportgen.drawing.plates import DrawingPlate
from reportgen.formula import Symbol
from reportgen.sheets.plates import drawn

WORKED = 6
"""Largest number of differing cylinders whose values are written out; with more, tables alone show them."""


@dataclass(frozen=True)
class EnginePage(PlacesPage[SolvedEngine]):
    """An engine for its templates."""

    NAME, TASK, SUMMARY = "orders", "orders-task", "orders-summary"
    SECTIONS = (
        *("orders-given", "orders-scheme", "orders-piston", "orders-stars", "orders-forces", "orders-couples"),
        *("orders-counterweight", "orders-conclusion"),
    )
    SHORT = frozenset({"orders-scheme"})

    def has(self, section: str) -> bool:
        return "couples" in self.case.stars if section == "orders-couples" else True

    def names(self) -> dict[str, Any]:
        case, written = self.case, self.case.printed
        lines = {name: written.known(quantities) for name, quantities in written.lines.items()}
        for name in ("lengths", "products"):
            if len(case.cylinders) > WORKED:
                lines[name] = []
        return {
            **self.shared_names,
            "given": case.given,
            "several": len(case.cylinders) > 1,
            "inline": case.given.is_inline,
            "has_couples": "couples" in case.stars,
            "rotates": case.given.rotates,
            "alike": not case.given.own_data,
            "own_radii": "r" in case.given.own_data,
            "lengths_table": self.lengths_table if case.given.own_data else "",
            "products_table": self.products_table if case.given.own_data else "",
            "data": self.data,
            "layout": self.layout,
            "factors": self.factors,
            "angles": self.angles,
            "result": self.result,
            "first_is_free": written[orders_ids.force(1)].at(1) == 0,
            "star_is_closed": self.is_nothing("orders.U"),
            "couples_are_closed": self.is_nothing("orders.U.M"),
            "nothing_turns_against": self.is_nothing(orders_ids.resultant("q", 1)),
            "sheet": lines,
        }

    def is_nothing(self, id: str) -> bool:
        """Return True if a quantity exists and is zero."""
        return id in self.case.printed and self.case.printed[id].at(1) == 0

    # --- tables

    @property
    def layout(self) -> Table:
        """The table of the arrangement of the cylinders."""
        columns = [orders_ids.crank, orders_ids.bank]
        columns += [orders_ids.station] if self.case.given.has_length else []
        masses = [orders_ids.own_mass.only(link=key[1:]) for key in self.case.given.own_data if key != "r"]
        columns += [*masses, *([orders_ids.own_radius] if "r" in self.case.given.own_data else [])]
        return self.by_place("layout", columns, self.case.cylinders)

    @property
    def lengths_table(self) -> Table:
        """The table of the masses of cylinders that differ, and of the lengths of their vectors."""
        weights = (orders_ids.weight.only(order=str(order)) for order in ORDERS)
        columns = [orders_ids.reciprocating, orders_ids.rotating, *weights]
        return self._entered("lengths", columns)

    @property
    def products_table(self) -> Table:
        """The table of the products that turn with the crank, of cylinders that differ."""
        return self._entered("products", [orders_ids.product.only(of=of) for of in ("rot", "U")])

    def _entered(self, name: str, columns: Sequence[Any]) -> Table:
        """Return a table of the quantities that are entered for the first cylinder, and so for all."""
        entered = [family for family in columns if family(self.case.cylinders[0]) in self.case.printed]
        return self.by_place(name, entered, self.case.cylinders)

    @property
    def factors(self) -> Table:
        """The table of the factors of the piston's acceleration, exact and by the first terms of their series."""
        printed, heads = self.case.printed, self.words["factors"]
        columns = orders_ids.factor, orders_ids.series, orders_ids.off
        rows = [
            ((Text(str(order)),), *(bare(printed.number(family(order))) for family in columns)) for order in FACTORS
        ]
        units = (printed.number(family(FACTORS[0])).unit for family in columns)
        return self.headed("factors", heads[0], [*zip(map(Symbol, ("A", "A*", "δ")), units, strict=True)], rows)

    @property
    def angles(self) -> Table:
        """The table of the angles of the vectors in all stars."""
        case = self.case
        columns = [(letter, order) for letter in case.stars["forces"] for order in ORDERS]
        heads = [(Symbol("γ", f"{letter}{order}"), "°") for letter, order in columns]
        arms = [orders_ids.arm] if case.given.has_length else []
        if arms:
            number = case.printed.number(orders_ids.arm(case.cylinders[0]))
            heads.append((Symbol("c"), number.unit))
        rows = [
            (
                (Text(place),),
                *(bare(case.printed.number(orders_ids.angle(*column, place))) for column in columns),
                *(bare(case.printed.number(family(place))) for family in arms),
            )
            for place in case.cylinders
        ]
        return self.headed("angles", self.words["heads"]["place"], heads, rows)

    @property
    def result(self) -> Table:
        """The table of the stars' resultants, and of forces and couples by orders."""
        case, printed = self.case, self.case.printed
        families: list[Any] = []
        for what, letters in case.stars.items():
            families += [orders_ids.resultant.only(star=letter) for letter in letters]
            families.append(orders_ids.force if what == "forces" else orders_ids.couple)
            if not case.given.is_inline:
                families.append(orders_ids.least_force if what == "forces" else orders_ids.least_couple)
        symbols = [(printed.symbol(of(1)), printed.number(of(1)).unit) for of in families]
        heads = [(Symbol(symbol.base, symbol.sub.partition(",")[2]), unit) for symbol, unit in symbols]
        rows: list[tuple[Inlines, ...]] = [
            ((Text(str(order)),), *(bare(printed.number(family(order))) for family in families)) for order in ORDERS
        ]
        return self.headed("result", self.words["factors"][0], heads, rows)

    # --- figures

    def scenes(self, name: str) -> Iterable[Scene]:
        _, draw = engine_drawings.FIGURES[name]
        return draw(self.case, IN_REPORT)


# --- the case --------------------------------------------------------------------------------------


@dataclass(frozen=True)
class EngineCase(SolvedEngine):
    """An engine by its orders, as a `Case`."""

    PAGE = EnginePage

    @property
    def shafts(self) -> Sequence[Shaft]:
        return (Shaft(self.words["orders"]["shaft"], self.speed, 1, datum="n"),)

    @cached_property
    def entries(self) -> ResultEntries:
        """Forces and couples by orders, the counterweight and the remaining values."""
        ledger = self.ledger
        orders: dict[str, Any] = {}
        for order in ORDERS:
            entry = {"force": ledger[orders_ids.force(order)].at(1)}
            if "couples" in self.stars:
                entry["couple"] = ledger[orders_ids.couple(order)].at(1)
            least = {"least_force": orders_ids.least_force(order), "least_couple": orders_ids.least_couple(order)}
            entry |= {name: ledger[id].at(1) for name, id in least.items() if id in ledger}
            orders[str(order)] = entry
        counterweight = {"unbalance": ledger["orders.U"].at(1), "left": ledger["orders.left"].at(1)}
        if "couples" in self.stars:
            counterweight |= {"couple": ledger["orders.U.M"].at(1), "couple_left": ledger["orders.left.M"].at(1)}
            if "orders.rotating.M" in ledger:
                counterweight["rotating_couple"] = ledger["orders.rotating.M"].at(1)
        return ResultEntries([{"number": 1, "orders": orders, "counterweight": counterweight}])

    def animations(self) -> tuple[Animation, ...]:
        return (engine_motion.animation(self),)

    def plates(self, sets: Collection[str] = (), every: bool = False) -> Mapping[str, Sequence[DrawingPlate]]:
        """Return its scheme, its stars and its results; `sets` is ignored, since there is only one."""
        table = drawn(EnginePage(self).result, self.assignment.language)
        title = self.words["orders"]["captions"]["result"]
        return {"orders": [*engine_drawings.plates(self), DrawingPlate(title, (), "tables", (table,), spare=True)]}
