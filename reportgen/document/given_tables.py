"""Tables of what is given: quantities, working forces, the indicator diagram, joints, lengths."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any

from reportgen.catalogue.given_loads import ByOrdinates
from reportgen.catalogue.loads import AngleLaw, Applied, TableLaw, Torque, WayLaw
from reportgen.cycle.applied import StrokeIndicator
from reportgen.document.tabled import Tabled, lowered
from reportgen.document.tree import Cell, Column, Table, Text, Value
from reportgen.document.voice import FIRST_COLUMN, TEXT_WIDTH
from reportgen.mechanism.mobility import mobility
from reportgen.notation import symbols
from reportgen.notation.expressions import Fraction, Number, Symbol, refs

MM = 1e3
MOST_LENGTHS = 7
"""Columns of lengths that stand beside one another."""


class GivenTables(Tabled):
    """The assignment in tables."""

    @property
    def functions(self) -> dict[str, Callable[..., Any]]:
        """What templates may call, by name."""
        return {
            "given_table": self.given_table,
            "indicator_table": self.indicator_table,
            "force_table": self.force_table,
            "load_table": self.load_table,
            "joints_table": self.joints_table,
            "lengths_table": self.lengths_table,
        }

    def given_table(self, key: str, caption: str, names: Mapping[str, str]) -> Table:
        """All given quantities of the machine that `names` describes; what is derived is left out."""
        ledger = self.facts.ledger
        ids = [id for id in names if id in ledger and self._is_given(id)]
        table = self.voice.quantity_table(key, caption, ids, names)
        return replace(
            table, rows=tuple(self._as_typed(id, row) for id, row in zip(ids, table.rows, strict=True))
        )

    def _is_given(self, id: str) -> bool:
        definition = self.facts.ledger[id].definition
        return definition is None or not refs(definition)

    def _as_typed(self, id: str, row: tuple[Cell, ...]) -> tuple[Cell, ...]:
        """A ratio written 1/3.6 stays one."""
        definition = self.facts.ledger[id].definition
        if not isinstance(definition, Fraction):
            return row
        ends = [part for part in (definition.top, definition.bottom) if isinstance(part, Number)]
        return (*row[:-1], Cell((Value(ends[0]), Text("/"), Value(ends[1])))) if len(ends) == 2 else row

    def indicator_table(self, key: str, caption: str) -> Table:
        """The indicator diagram as given, in gauge pressure: by stroke, or against the cycle angle."""
        diagram = self.assignment.indicator
        heights = diagram.height if isinstance(diagram, ByOrdinates) else ()
        law = self.facts.analysis.machine.pistons[0].law
        return self._law_table(law, key, caption, self.voice.words["strokes"], Symbol("p"), 1e4, heights)

    def force_table(self, key: str, caption: str, names: Sequence[str]) -> Table:
        """A working force as given (N): a row for each of the strokes `names`, or against the crank angle."""
        law = self.facts.analysis.machine.applied[0].law
        assert isinstance(law, TableLaw)
        return self._law_table(law, key, caption, names, Symbol("P"), 1.0)

    def load_table(self, key: str, caption: str, name: str, strokes: Sequence[str]) -> Table:
        """The load `name` as given (N, N·m): a row for each of the `strokes`, or against the driver's turn or way."""
        machine = self.facts.analysis.machine
        loads: tuple[Applied | Torque, ...] = (*machine.applied, *machine.torques)
        law = next(load.law for load in loads if load.name == name)
        symbol = self.voice.symbol(name)
        if isinstance(law, AngleLaw | WayLaw):
            letter, nodes = (
                ("φ", [math.degrees(angle) for angle in law.angles])
                if isinstance(law, AngleLaw)
                else ("s", [way * MM for way in law.ways])
            )
            return self._beside(key, caption, [(letter, nodes), (symbol, law.values)])
        assert isinstance(law, TableLaw)
        return self._law_table(law, key, caption, strokes, symbol, 1.0)

    def _law_table(
        self,
        law: TableLaw,
        key: str,
        caption: str,
        names: Sequence[str],
        symbol: Symbol,
        unit: float,
        heights: Sequence[float] = (),
    ) -> Table:
        """The nodes of a law; `heights` (mm) are those it was read from, if it was read from a drawing."""
        table = law.table
        if isinstance(table, StrokeIndicator):
            first = FIRST_COLUMN + 8
            rows = [
                (self.voice.cell(name), *(self._exact(value / unit) for value in row))
                for name, row in zip(names, table.rows, strict=False)
            ]
            head = (self.voice.cell(Fraction(Symbol("s"), Symbol("H"))), *map(self._exact, table.nodes))
            return self._blocks(key, caption, head, rows, first)
        last = law.turns * 2 * math.pi * (1 + 1e-15)
        columns: list[tuple[str | Symbol, Sequence[float]]] = [
            ("φ", [math.degrees(angle) for angle in table.angles if angle <= last]),
            *((("y", list(heights)),) if heights else ()),
            (symbol, [value / unit for value in table.pressures]),
        ]
        return self._beside(key, caption, columns)

    def _beside(
        self, key: str, caption: str, columns: Sequence[tuple[str | Symbol, Sequence[float]]]
    ) -> Table:
        """Long columns, folded into sets side by side."""
        head = tuple(self.voice.cell(Symbol(one) if isinstance(one, str) else one) for one, _ in columns)
        sets = [
            tuple(map(self._exact, row)) for row in zip(*(values for _, values in columns), strict=False)
        ]
        beside = 3 if len(columns) > 2 else 4
        rows_count = -(-len(sets) // beside)
        filled = sets + [(Cell(),) * len(columns)] * (rows_count * beside - len(sets))
        body = tuple(
            tuple(cell for block in range(beside) for cell in filled[block * rows_count + row])
            for row in range(rows_count)
        )
        width = Column(TEXT_WIDTH / beside / len(columns) - 2.0)
        return Table(
            (width,) * (beside * len(columns)), (head * beside,), body, self.voice.prose.inlines(caption), key
        )

    def _exact(self, value: float) -> Cell:
        return Cell((Value(Number(float(f"{value:.10g}"))),))

    def _blocks(
        self, key: str, caption: str, head: tuple[Cell, ...], rows: Sequence[tuple[Cell, ...]], first: float
    ) -> Table:
        """A wide table; more than 13 columns are set below one another in blocks of at most 12 values."""
        most = 12
        width = min((TEXT_WIDTH - first) / min(len(head) - 1, most), 14.0)
        body: list[tuple[Cell, ...]] = []
        for start in range(1, len(head), most):
            stop = min(start + most, len(head))
            pad = (Cell(),) * (most - (stop - start)) if len(head) - 1 > most else ()
            if start > 1:
                body.append((head[0], *head[start:stop], *pad))
            body += [(row[0], *row[start:stop], *pad) for row in rows]
        count = min(len(head) - 1, most)
        columns = (Column(first, "left"), *(Column(width),) * count)
        return Table(
            columns, ((head[0], *head[1 : count + 1]),), tuple(body), self.voice.prose.inlines(caption), key
        )

    def joints_table(self, key: str, caption: str, head: Sequence[str]) -> Table:
        """All joints: number, place, links, type."""
        joints = mobility(self.facts.analysis.machine.linkage).joints
        kinds = self.voice.words["joints"]
        rows = (
            (
                str(number),
                symbols.point(joint.point),
                f"{joint.links[0]} – {joint.links[1]}",
                kinds[joint.kind],
            )
            for number, joint in enumerate(joints, start=1)
        )
        return self.voice.list_table(key, caption, head, rows, (20.0, 30.0, 40.0, 50.0))

    def lengths_table(self, key: str, caption: str, head: Sequence[str], arms: Sequence[str]) -> tuple[Table, ...]:
        """Real and drawn lengths, one column a length; many lengths in several tables below one another."""
        ledger = self.facts.ledger
        known = [arm for arm in arms if f"l.{arm}" in ledger]
        sets = -(-len(known) // MOST_LENGTHS) or 1
        size = -(-len(known) // sets)
        return tuple(
            self._lengths(
                f"{key}.{index + 1}" if index else key,
                caption if sets == 1 else f"{caption} ({index + 1}/{sets})",
                head,
                known[index * size : (index + 1) * size],
            )
            for index in range(sets)
        )

    def _lengths(self, key: str, caption: str, head: Sequence[str], known: Sequence[str]) -> Table:
        columns = (Column(46.0, "left"), *(Column(min((TEXT_WIDTH - 46) / len(known), 22.0)),) * len(known))
        rows = tuple(
            (self.voice.cell(title), *(Cell(self.voice.bare(f"{prefix}.{arm}", None)) for arm in known))
            for title, prefix in zip(head[1:], ("l", "drawn"), strict=True)
        )
        heads = (self.voice.cell(head[0]), *(self.voice.cell(lowered(arm)) for arm in known))
        return Table(columns, (heads,), rows, self.voice.prose.inlines(caption), key)
