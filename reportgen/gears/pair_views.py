"""`PairPage`: names for the templates of a gear pair's report and task: tables, worked lines, figures."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from reportgen.case.design_case import DesignPage
from reportgen.case.quantity_wording import phrase
from reportgen.document import Block, Column, InlineMath, Inlines, Table, Text, Value
from reportgen.drawing import Scene
from reportgen.formula import Number, Symbol, vocabulary
from reportgen.gears import gears_ids
from reportgen.gears.pair_drawings import mesh, region, sliding
from reportgen.gears.pair_formulas import WHEELS
from reportgen.gears.pair_ledger import SolvedPair

PAIR = (68.0, 22.0, 35.0, 35.0)
CHECKS = (70.0, 18.0, 28.0, 26.0, 18.0)
SLIDING = (16.0, 28.0, 28.0, 28.0, 28.0, 28.0)
SHARED = ("alpha_w", "a_w", "y", "dy", "h", "p", "p_b", "epsilon", "g", "g_a")
"""Rows of both wheels together in the table of the pair,"""
OWN = ("x", "d", "d_b", "d_w", "d_a", "d_f", "h_a", "s", "s_w", "s_a", "alpha_a", "rho_p", "rho_a")
"""and for each wheel."""


@dataclass(frozen=True)
class PairPage(DesignPage[SolvedPair]):
    """A gear pair as templates read it."""

    NAME, TASK, SUMMARY = "pair", "pair-task", "pair-summary"
    SECTIONS = (
        *("pair-given", "pair-shifts", "pair-mesh", "pair-wheels", "pair-contact", "pair-sliding", "pair-region"),
        *("pair-checks", "pair-drawing", "pair-conclusion"),
    )
    SHORT = frozenset({"pair-region"})

    def names(self) -> dict[str, Any]:
        case, chosen = self.case, self.case.chosen
        return {
            **self.shared_names,
            "full": self.full,
            "rule": chosen.rule,
            "sought": self.sought,
            "follows": chosen.follows,
            "iso": math.isclose(chosen.pair.rack.alpha, math.radians(20))
            and (chosen.pair.rack.ha, chosen.pair.rack.c) == (1.0, 0.25),
            "count": case.count,
            "of": self.of_wheel,
            "sheet": case.printed.lines,
            "data": self.data,
            "pair_table": self.pair_table,
            "sliding_table": self.sliding_table,
            "checks": self.checks,
            "broken": tuple((name, wheel) for name, wheel, _, _ in chosen.broken()),
            "value": self.value,
        }

    @staticmethod
    def of_wheel(quantity: str, wheel: str | int) -> str:
        """Return the id of a quantity of wheel 1 or 2."""
        return gears_ids.of_wheel(quantity, wheel)

    @property
    def sought(self) -> bool:
        """Return True if the shifts are to be chosen."""
        return self.case.chosen.rule != "given"

    # --- symbols and lines

    def lines(self, quantities: Iterable[str], k: int | None = None) -> tuple[Block, ...]:
        """Return the worked lines of quantities that are computed from others, in the order of computation."""
        ledger = self.case.printed
        wanted = set(quantities)
        defined = [id for id, family in ledger.families.items() if id in wanted and family.definition is not None]
        return super().lines(defined, k)

    # --- tables

    def _table(
        self, name: str, widths: tuple[float, ...], heads: Iterable[Inlines], rows: Iterable[tuple[Inlines, ...]]
    ) -> Table:
        columns = (Column(widths[0], "left"), *(Column(width) for width in widths[1:]))
        return self.table(name, columns, (heads,), rows)

    def _described(self, id: str) -> Inlines:
        """Return the name of a quantity in words; both wheels share the name."""
        text = phrase(id, self.case.ledger, self.case.words)
        return (Text(text[:1].upper() + text[1:]),)

    @property
    def data(self) -> Table:
        """Return the table of data with names, symbols and values, without shifts that were found."""
        sought = {gears_ids.of_wheel("x", wheel) for wheel in WHEELS} if self.sought else set()
        return self.data_table(self.given_rows(sought))

    @property
    def pair_table(self) -> Table:
        ledger, words = self.case.printed, self.words
        rows: list[tuple[Inlines, ...]] = []
        for name in OWN:
            symbol = vocabulary.in_language(
                _without_number(ledger.symbol(gears_ids.of_wheel(name, 1))), self.case.words["symbols"]
            )
            both = tuple((Value(ledger.result(gears_ids.of_wheel(name, wheel))),) for wheel in WHEELS)
            rows.append(((Text(words["own"][name]),), (InlineMath(symbol),), *both))
        for name in SHARED:
            id = f"gears.{name}"
            rows.append(
                (self._described(id), (InlineMath(ledger.symbol(id)),), (Value(ledger.result(id)),), (Text("–"),))
            )
        heads = ((Text(text),) for text in words["pair_head"])
        return self._table("pair", PAIR, heads, rows)

    @property
    def sliding_table(self) -> Table:
        ledger = self.case.printed
        columns = ("gears.t", *(gears_ids.of_wheel(one, wheel) for one in ("rho", "lambda") for wheel in WHEELS))
        rows: list[tuple[Inlines, ...]] = [
            ((Text(str(k)),), *((Value(ledger.number(id, k)),) for id in columns))
            for k in range(1, self.case.count + 1)
        ]
        heads: tuple[Inlines, ...] = (
            (Text(self.words["point"]),),
            *((InlineMath(ledger.symbol(id)),) for id in columns),
        )
        return self._table("sliding", SLIDING, heads, rows)

    @property
    def checks(self) -> Table:
        """Return the requirements of each wheel and of the pair, the actual values, and whether they are met."""
        words, ledger, chosen = self.words["checks"], self.case.printed, self.case.chosen
        broken = {(name, wheel) for name, wheel, _, _ in chosen.broken()}
        rows: list[tuple[Inlines, ...]] = []

        def row(name: str, wheel: int, sign: str, limit: Number, actual: str | Number) -> None:
            text = str(words[name]).format(wheel=wheel)
            printed = ledger.result(actual) if isinstance(actual, str) else actual
            holds = words["no"] if (name, wheel) in broken else words["yes"]
            symbol: Inlines = (InlineMath(ledger.symbol(actual)),) if isinstance(actual, str) else (Text("|λ|"),)
            rows.append(((Text(text),), symbol, (Text(sign), Value(limit)), (Value(printed),), (Text(str(holds)),)))

        for wheel in WHEELS:
            row(
                "undercut",
                wheel,
                "≥ ",
                ledger.number(gears_ids.of_wheel("x_min", wheel)),
                gears_ids.of_wheel("x", wheel),
            )
        for wheel in WHEELS:
            row("tip", wheel, "≥ ", ledger.number("gears.limit.tip"), gears_ids.of_wheel("tip", wheel))
        for wheel in WHEELS:
            begun = ledger.number(gears_ids.of_wheel("rho_f", wheel))
            limit = begun if begun.value > 0 else Number(0.0, 0, ledger.printed_unit("mm"))
            row("interference", wheel, "≥ ", limit, gears_ids.of_wheel("rho_p", wheel))
        row("epsilon", 0, "≥ ", ledger.number("gears.limit.epsilon"), "gears.epsilon")
        if chosen.limits.sliding is not None:
            for wheel, end in zip(WHEELS, case_ends(self.case), strict=True):
                number_ = ledger.number(gears_ids.of_wheel("lambda", wheel), end)
                printed = Number(-number_.printed, number_.decimals)
                row("sliding", wheel, "≤ ", ledger.number("gears.limit.sliding"), printed)
        return self._table("checks", CHECKS, ((Text(str(one)),) for one in words["head"]), rows)

    # --- figures

    def scenes(self, name: str) -> Iterable[Scene]:
        drawings: Mapping[str, Callable[[SolvedPair], Scene]] = {
            "mesh": mesh,
            "region": region,
            "sliding": lambda case: sliding(case).scene,
        }
        return (drawings[name](self.case),)


def case_ends(case: SolvedPair) -> tuple[int, int]:
    """Return the points of the path at which the feet of wheel 1 and of wheel 2 are in contact."""
    return case.worked[0], case.worked[-1]


def _without_number(symbol: Symbol) -> Symbol:
    """Return the symbol of a quantity without the number of its wheel."""
    return Symbol(symbol.base, symbol.sub.rstrip("12"), symbol.sup)
