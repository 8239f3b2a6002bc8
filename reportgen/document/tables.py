"""Tables that are more than columns of quantities: given data, joints, strokes, lengths, checks."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from reportgen.assignment import Assignment
from reportgen.catalogue.gas import ByOrdinates
from reportgen.catalogue.laws import AngleLaw, TableLaw
from reportgen.catalogue.machine import Applied, Torque
from reportgen.cycle.indicator import StrokeIndicator
from reportgen.document.facts import Facts
from reportgen.document.tree import Cell, Column, InlineMath, Table, Text, Value
from reportgen.document.voice import FIRST_COLUMN, TEXT_WIDTH, Voice
from reportgen.mechanism.mobility import mobility
from reportgen.notation import symbols
from reportgen.notation.expressions import (
    Chain,
    Fraction,
    Number,
    Power,
    Product,
    Sum,
    Symbol,
    multiply,
    refs,
    subtract,
)

MOST_COLUMNS = 9
MOST_COORDINATES = 10
MOST_LENGTHS = 7
"""Columns of lengths that stand beside one another."""
STILL = 1e-9
"""A rate below this share of its greatest value is nothing."""


def lowered(text: str) -> str:
    """Digits of point names as lowered digits: O1A → O₁A."""
    return text.translate(str.maketrans("0123456789", "₀₁₂₃₄₅₆₇₈₉"))


@dataclass(frozen=True)
class Tables:
    """The special tables of one report; public methods are called by templates."""

    assignment: Assignment
    facts: Facts
    voice: Voice

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
        """The load `name` as given (N, N·m): a row for each of the `strokes`, or against the driver's turn."""
        machine = self.facts.analysis.machine
        loads: tuple[Applied | Torque, ...] = (*machine.applied, *machine.torques)
        law = next(load.law for load in loads if load.name == name)
        symbol = self.voice.symbol(name)
        if isinstance(law, AngleLaw):
            columns: list[tuple[str | Symbol, Sequence[float]]] = [
                ("φ", [math.degrees(angle) for angle in law.angles]),
                (symbol, law.values),
            ]
            return self._beside(key, caption, columns)
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

    def coordinates_table(self, key: str, caption: str) -> tuple[Table, ...]:
        """x and y of every moving point at every position of one turn, in mm; several tables where they are many."""
        analysis = self.facts.analysis
        linkage = analysis.machine.linkage
        # The point of a lever under a block's pin lies where the pin is.
        under = {dyad.middle for dyad in linkage.dyads if dyad.kind == "RPR"}
        names = [name for name in analysis.motion.points if name not in {*linkage.ground, *under}]
        count = analysis.machine.count
        heads = [symbol for name in names for symbol in (_coordinate("x", name), _coordinate("y", name))]
        values = [
            part
            for name in names
            for part in (analysis.motion.points[name].p.real, analysis.motion.points[name].p.imag)
        ]
        kept = [index for index, value in enumerate(values) if np.abs(value[:count]).max() > 1e-12]

        def table(number: int, part: Sequence[int], of: int) -> Table:
            width = min((TEXT_WIDTH - FIRST_COLUMN) / len(part), 22.0)
            head = (
                self.voice.cell(self.voice.words["table"]["position"]),
                *(self.voice.cell(heads[i]) for i in part),
            )
            rows = tuple(
                (
                    self.voice.cell(str(analysis.machine.position(k + 1))),
                    *(Cell((Value(Number(_dustless(values[i][k] * 1e3), 2)),)) for i in part),
                )
                for k in range(count)
            )
            columns = (Column(FIRST_COLUMN), *(Column(width),) * len(part))
            told = caption if of == 1 else f"{caption} ({number}/{of})"
            return Table(
                columns, (head,), rows, self.voice.prose.inlines(told), key if number == 1 else f"{key}.{number}"
            )

        blocks = -(-len(kept) // MOST_COORDINATES)
        size = 2 * -(-len(kept) // (2 * blocks))
        parts = [kept[start : start + size] for start in range(0, len(kept), size)]
        return tuple(table(number, part, len(parts)) for number, part in enumerate(parts, start=1))

    def dead_centres_table(self, key: str, caption: str, head: Sequence[str], top: str, bottom: str) -> Table:
        """Where each slider turns back: crank's turn from position 1, the pin's distance from the crank centre."""
        rows = []
        for piston in self.facts.analysis.machine.sliders:
            for words, angle, place in (
                (top, piston.top_angle, piston.top),
                (bottom, piston.bottom_angle, piston.bottom),
            ):
                turn = math.degrees((angle - piston.phase) % (2 * math.pi))
                turn = 0.0 if abs(turn - 360) < 1e-9 else turn
                rows.append((str(piston.link), words, _tidy(turn), _tidy(abs(place) * 1e3)))
        return self.voice.list_table(key, caption, head, rows, (20.0, 46.0, 44.0, 46.0))

    def labels_table(
        self, key: str, caption: str, head: Sequence[str], names: Mapping[str, str]
    ) -> Table:
        """The positions of one turn by their labels: the crank's turn, and what the first slider does there.

        `names` says it in words for "top" and "bottom", where it turns back, and "fastest", where a = 0.
        """
        analysis = self.facts.analysis
        machine, course = analysis.machine, analysis.machine.sliders[0]
        pin, way = analysis.motion.points[course.pin], course.fraction(analysis.motion)
        still, steady = (np.abs(rate) < STILL * np.abs(rate).max() for rate in (pin.v, pin.a))
        rows = []
        for k in range(machine.count):
            end = ("top" if way[k] < 0.5 else "bottom") if still[k] else "fastest" if steady[k] else ""
            angle = _tidy(math.degrees(machine.cycle_angles[k]))
            rows.append((str(machine.position(k + 1)), angle, names.get(end, "")))
        return self.voice.list_table(key, caption, head, rows, (24.0, 50.0, 50.0))

    def rotation_table(
        self, key: str, caption: str, head: Sequence[str], ids: Sequence[str], k: int
    ) -> Table:
        """Angular velocities or accelerations with their sense in words."""
        turn = self.facts.analysis.machine.turn
        senses = self.voice.words["sense"]
        rows = (
            (
                self.voice.symbol(id),
                tuple(self._size(id, k)),
                (senses["anticlockwise"] if turn > 0 else senses["clockwise"])
                if id == "omega.1"
                else self.voice.direction(id, k),
            )
            for id in ids
        )
        return self.voice.list_table(key, caption, head, rows, (34.0, 40.0, 60.0))

    def _size(self, id: str, k: int) -> tuple[Value, ...]:
        number = self.facts.ledger.number(id, k, size=True)
        return (Value(Number(number.value, number.decimals)),)

    def summary_table(
        self, key: str, caption: str, head: Sequence[str], ids: Sequence[Sequence[str]], k: int
    ) -> Table:
        """Quantities at one position as "symbol = value", in rows of as many as there are heads."""
        ledger = self.facts.ledger
        rows = [[Chain((ledger.symbol(id), ledger.number(id, k))) for id in row] for row in ids]
        return self.voice.list_table(key, caption, head, rows, (46.0,) * len(head))

    def strokes_table(self, key: str, caption: str, first: str, positions: str) -> Table:
        """The stroke of every piston between dead centres of any of them."""
        gas = self.facts.analysis.gas
        machine = self.facts.analysis.machine
        names = self.voice.words["strokes"]
        strokes = np.array([state.stroke for state in gas.values()])
        starts = [0, *(int(i) + 1 for i in np.flatnonzero(np.any(np.diff(strokes, axis=1), axis=0)))]
        ends = [*starts[1:], machine.positions]
        head = (
            positions,
            *(
                f"{machine.position(start + 1)}–{machine.position(end % machine.positions + 1)}"
                for start, end in zip(starts, ends, strict=True)
            ),
        )
        rows = [
            (f"{first} {state.piston.link}", *(names[int(state.stroke[start])] for start in starts))
            for state in gas.values()
        ]
        width = min((TEXT_WIDTH - 30) / len(starts), 30.0)
        return self.voice.list_table(key, caption, head, rows, (30.0, *(width,) * len(starts)))

    def lever_table(self, key: str, caption: str, head: Sequence[str], k: int) -> Table:
        """Loads on the turned velocity plan: size, arm, moment about the pole by μ_l, anticlockwise positive."""
        ledger = self.facts.ledger
        rows = []
        for id in ledger.families:
            if not (id.startswith("h.") and id.endswith(".p")):
                continue
            load = id.split(".")[1]
            numbers = (ledger.number(load, k), ledger.number(id, k, size=True), ledger.number(f"M.{load}.p", k))
            cells = ((Value(Number(number.value, number.decimals)),) for number in numbers)
            rows.append((ledger.symbol(load), *cells))
        return self.voice.list_table(key, caption, head, rows, (30.0, 36.0, 44.0, 44.0))

    def checks_table(self, key: str, caption: str, head: Sequence[str], names: Mapping[str, str]) -> Table:
        """Residuals of the independent checks, as powers of ten."""
        residuals = self.residuals()
        rows = [
            (name, _scientific(residuals[id][0]), residuals[id][1])
            for id, name in names.items()
            if id in residuals
        ]
        return self.voice.list_table(key, caption, head, rows, (95.0, 35.0, 20.0))

    def residuals(self) -> dict[str, tuple[float, str]]:
        """The largest residual of each check and its unit: closure, formulas, reactions, torques, energy."""
        analysis, values = self.facts.analysis, self.facts.ledger.families
        found = {"closure": (self._closure(), "m")}
        for name, prefix, unit in (("formulas", ("v.", "omega."), ""), ("formulas_a", ("a.", "eps."), "")):
            differences = [
                float(np.max(np.abs(np.abs(values[one].values) - np.abs(values[other].values))))
                / float(np.max(np.abs(values[one].values)))
                for one, other in analysis.machine.compared
                if one.startswith(prefix)
            ]
            if differences:
                found[name] = (max(differences), unit)
        if analysis.loads:
            found["ledger"] = (
                max(
                    float(np.nanmax(np.abs(reaction.force - values[f"F.{name}"].values)))
                    for name, reaction in analysis.forces.reactions.items()
                    if f"F.{name}" in values
                ),
                "N",
            )
            found["torque"] = (float(np.nanmax(np.abs(analysis.torque - analysis.torque_by_work))), "N·m")
            found["energy"] = (analysis.summary.energy_error, "")
        return found

    def _closure(self) -> float:
        """How far a distance of two points of one link is from its length at any position (m)."""
        motion, families = self.facts.analysis.motion, self.facts.ledger.families
        pairs = [(group.P, group.Q) for group in self.facts.groups]
        pairs += [(group.T, group.Q) for group in self.facts.groups if group.kind == "RRR"]
        lengths = [(p, q, families[f"l.{p}{q}"].values) for p, q in pairs if f"l.{p}{q}" in families]
        differences = [np.abs(motion.points[p].p - motion.points[q].p) - length for p, q, length in lengths]
        differences += [
            np.abs(motion.points[point.name].p - motion.origins[point.link].p) - abs(point.local)
            for point in self.facts.analysis.machine.linkage.points
        ]
        return max(float(np.nanmax(np.abs(difference))) for difference in differences)

    def mobility_line(self) -> Any:
        """W = 3n − (2t + c) + r − s with the numbers put in."""
        counted = mobility(self.facts.analysis.machine.linkage)
        n, t, c, r, s = (Symbol(letter) for letter in "ntcrs")
        formula = Sum((*subtract_all(multiply(3, n), Sum((multiply(2, t), c))), r, *_minus(s)))
        numbers = Sum(
            (
                *subtract_all(
                    Product((Number(3), Number(counted.n))),
                    Sum((Product((Number(2), Number(counted.lower_pairs))), Number(counted.higher_pairs))),
                ),
                Number(counted.passive),
                *_minus(Number(counted.redundant)),
            )
        )
        return self.voice.equal(Chain((Symbol("W"), formula, numbers, Number(counted.W))))

    def tables(
        self, key: str, caption: str, ids: Sequence[str], positions: Iterable[int]
    ) -> tuple[Table, ...]:
        """One table, or several below one another where the columns are too many; the key names the first."""
        wide = MOST_COLUMNS - 1
        count = max(-(-len(ids) // wide), 1)
        size = -(-len(ids) // count)
        parts = [ids[start : start + size] for start in range(0, len(ids), size)]
        rows = list(positions)
        return tuple(
            self.voice.table(
                key if index == 0 else f"{key}.{index + 1}",
                caption if count == 1 else f"{caption} ({index + 1}/{count})",
                part,
                rows,
            )
            for index, part in enumerate(parts)
        )


def subtract_all(first: Any, second: Any) -> tuple[Any, ...]:
    """The terms of first − second."""
    difference = subtract(first, second)
    assert isinstance(difference, Sum)
    return difference.terms


def _minus(node: Any) -> tuple[Any, ...]:
    return subtract_all(Number(0), node)[1:]


def _coordinate(axis: str, name: str) -> Symbol:
    return Symbol(axis, name)


def _dustless(value: float) -> float:
    return 0.0 if abs(value) < 1e-9 else value


def _tidy(value: float) -> tuple[Value, ...]:
    """A number to two decimals, or as it is when it has no more than two."""
    return (
        Value(
            Number(float(f"{value:.10g}"))
            if abs(value * 100 - round(value * 100)) < 1e-7
            else Number(value, 2)
        ),
    )


def _scientific(value: float) -> tuple[Any, ...]:
    """A residual as a power of ten: < 10⁻¹² m."""
    if value == 0:
        return (Value(Number(0.0)),)
    exponent = math.ceil(math.log10(value))
    return (Text("< "), InlineMath(Power(Number(10), Number(exponent))))
