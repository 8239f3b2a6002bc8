"""Pages with tables of values at several places: masses, cylinders, bearings."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence

from reportgen.base.records import replace
from reportgen.case.design_case import Designed, DesignPage
from reportgen.document import Column, InlineMath, Inlines, Table, Text, Value
from reportgen.formula import Number, Symbol

FIRST_WIDTH, PAGE_WIDTH, WIDEST = 18.0, 165.0, 30.0
"""Width of the first column, of a table on a page, and of the widest column (mm)."""


class PlacesPage(DesignPage[Designed]):
    """A design with values of one kind at several places."""

    def by_place(self, name: str, families: Sequence[Callable[[str], str]], places: Sequence[str]) -> Table:
        """Return a row of values for each place."""
        printed, first = self.case.printed, places[0]
        symbols = (printed.symbol(family(first)) for family in families)
        heads = [
            (replace(symbol, sub=symbol.sub.removesuffix(first).removesuffix(",")), printed.number(family(first)).unit)
            for symbol, family in zip(symbols, families, strict=True)
        ]
        rows = [((Text(place),), *(bare(printed.number(family(place))) for family in families)) for place in places]
        return self.headed(name, self.words["heads"]["place"], heads, rows)

    def headed(
        self, name: str, first: str, heads: Sequence[tuple[Symbol, str]], rows: Iterable[tuple[Inlines, ...]]
    ) -> Table:
        """Return a table whose head has symbols, and their units below them."""
        symbols: list[Inlines] = [(Text(first),), *((InlineMath(symbol),) for symbol, _ in heads)]
        units: list[Inlines] = [(Text(""),), *((Text(unit),) for _, unit in heads)]
        width = min(WIDEST, (PAGE_WIDTH - FIRST_WIDTH) / len(heads))
        return self.table(name, (Column(FIRST_WIDTH), *(Column(width) for _ in heads)), (symbols, units), rows)


def bare(number: Number) -> Inlines:
    """Return a number without its unit, which is in the head of its column."""
    return (Value(replace(number, unit="")),)
