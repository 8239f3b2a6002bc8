"""A synthesis through three points as a case: report and task with their tables, key, results, drawing sheet."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar

from reportgen.case.design_case import DesignPage
from reportgen.case.result_entries import ResultEntries
from reportgen.document import Column, InlineMath, Inlines, Table, Text
from reportgen.drawing import Scene
from reportgen.drawing.plates import DrawingPlate
from reportgen.formula import Symbol
from reportgen.sheets.plates import drawn
from reportgen.structure import synthesis_ids, three_point_drawings
from reportgen.structure import three_point_names as ids
from reportgen.structure.three_point_solution import THREE, SolvedThreePoints

NARROW, WIDE = 22.0, 30.0
"""Widths (mm) of the columns of tables."""
LINKS = {"crank": ids.CRANK, "coupler": ids.COUPLER, "follower": ids.FOLLOWER, "frame": synthesis_ids.FRAME}
PLACES = (1, 2, 3, 4)
"""The places at which the structural error is calculated."""


def solve_rows(position: Mapping[str, Any]) -> dict[str, dict[str, float]]:
    """Return the rows of results that `solve` prints: links (m), pairs of angles (°), structural errors (°)."""
    symbols = dict(zip(LINKS, "abcd", strict=True))
    rows = {"links": {symbols[name]: length for name, length in position["lengths"].items()}}
    rows["links"]["γ_min"] = math.degrees(position["transmission"])
    for number, pair in position["pairs"].items():
        rows[f"pair{number}"] = {"φ": math.degrees(pair["driver"]), "ψ": math.degrees(pair["follower"])}
    if "errors" in position:
        rows["errors"] = {f"Δψ_{number}": math.degrees(error) for number, error in position["errors"].items()}
    return rows


@dataclass(frozen=True)
class ThreePointPage(DesignPage[SolvedThreePoints]):
    """A synthesis through three points for its templates."""

    NAME, TASK, SUMMARY = "three_points", "three-points-task", "three-points-summary"
    SECTIONS = (
        *("three-points-given", "three-points-accuracy", "three-points-factors", "three-points-checks"),
        *("three-points-error", "three-points-conclusion"),
    )
    SHORT: ClassVar[frozenset[str]] = frozenset()
    SWITCHES: ClassVar[Mapping[str, tuple[str, ...]]] = {
        "three-points-accuracy": ("function",),
        "three-points-error": ("function",),
    }

    def names(self) -> dict[str, Any]:
        case = self.case
        written = case.printed
        groups = ("arguments", "results", "angles", "differences", "factors", "links", "transmission", "between")
        lines: dict[str, list[str]] = {name: [] for name in (*groups, "largest")}
        lines |= {name: list(written.known(quantities)) for name, quantities in written.lines.items()}
        errors = [lines.get(f"error{number}", []) for number in PLACES]
        return {
            **self.shared_names,
            "data": self.data,
            "of_function": case.follows_function,
            "function": self.function,
            "reversed_crank": float(written[ids.CRANK].values[0]) < 0,
            "reversed_follower": float(written[ids.FOLLOWER].values[0]) < 0,
            "single": not self.full,
            "worked_errors": errors if self.full else errors[:1],
            "error_table": self.error_table if case.follows_function else "",
            "link_table": self.link_table,
            "crank": ids.CRANK,
            "coupler": ids.COUPLER,
            "follower": ids.FOLLOWER,
            "frame": synthesis_ids.FRAME,
            "least": ids.LEAST,
            "largest": ids.LARGEST,
            "permitted": synthesis_ids.PERMITTED,
            "poor": case.is_poor,
            "sheet": lines,
        }

    @property
    def function(self) -> Inlines:
        """The function as it is written, such as y = ln x; () without one."""
        if not self.case.follows_function:
            return ()
        return (InlineMath(self.case.function_equation),)

    @property
    def link_table(self) -> Table:
        """The table of the lengths of the links."""
        heads: tuple[Inlines, ...] = tuple((InlineMath(self.case.printed.symbol(id)),) for id in LINKS.values())
        row: tuple[Inlines, ...] = tuple((self.value(id),) for id in LINKS.values())
        return self.table("links", [Column(WIDE) for _ in LINKS], (heads,), [row])

    @property
    def error_table(self) -> Table:
        """The table of the structural error at both ends of the range and between the points."""
        wanted = (
            (ids.FIRST_DRIVER, ids.FIRST_FOLLOWER),
            *((ids.middle_driver(k), ids.middle_follower(k)) for k in (1, 2)),
            (ids.LAST_DRIVER, ids.LAST_FOLLOWER),
        )
        first = (ids.driver(1), ids.follower(1), ids.actual(1), ids.error(1))
        symbols = [self.case.printed.symbol(id) for id in first]
        heads: tuple[Inlines, ...] = ((Text(""),), *((InlineMath(Symbol(one.base, "", one.sup)),) for one in symbols))
        rows: list[tuple[Inlines, ...]] = []
        for number, (φ, ψ) in zip(PLACES, wanted, strict=True):
            values = (φ, ψ, ids.actual(number), ids.error(number))
            rows.append(((Text(str(number)),), *((self.value(id),) for id in values)))
        columns = (Column(NARROW), *(Column(WIDE) for _ in symbols))
        return self.table("errors", columns, (heads,), rows)

    def scenes(self, name: str) -> Iterable[Scene]:
        if name == "positions":
            return (three_point_drawings.positions(self.case),)
        if name == "error":
            return (three_point_drawings.errors(self.case),)
        raise KeyError(name)


@dataclass(frozen=True)
class ThreePointCase(SolvedThreePoints):
    """A synthesis through three points, as a `Case`."""

    PAGE = ThreePointPage

    @cached_property
    def entries(self) -> ResultEntries:
        """The links (m), the pairs of angles and the least transmission angle (rad), structural errors (rad)."""

        def value(id: str) -> float:
            return float(self.ledger[id].values[0])

        position: dict[str, Any] = {
            "number": 1,
            "lengths": {name: value(id) for name, id in LINKS.items()},
            "pairs": {str(k): {"driver": value(ids.driver(k)), "follower": value(ids.follower(k))} for k in THREE},
            "transmission": value(ids.LEAST),
        }
        if self.follows_function:
            position["errors"] = {str(number): value(ids.error(number)) for number in PLACES}
        return ResultEntries([position])

    def plates(self, sets: Collection[str] = (), every: bool = False) -> Mapping[str, Sequence[DrawingPlate]]:
        """Return the linkage, the structural error and the lengths; `sets` is ignored, since there is one."""
        return {"synthesis": [*three_point_drawings.plates(self), *self._tables()]}

    def _tables(self) -> Iterator[DrawingPlate]:
        page, captions = ThreePointPage(self), self.words["three_points"]["captions"]
        tables = [(captions["links"], page.link_table)]
        if self.follows_function:
            tables.append((captions["errors"], page.error_table))
        for caption, table in tables:
            yield DrawingPlate(caption, (), "tables", (drawn(table, self.assignment.language),), spare=True)
