"""Tables of motion: coordinates, dead centres, labels of positions, rates with their sense."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from reportgen.document.tabled import Tabled, tidy
from reportgen.document.tree import Cell, Column, Table, Value
from reportgen.document.voice import FIRST_COLUMN, TEXT_WIDTH
from reportgen.notation.expressions import Chain, Number, Symbol

MOST_COORDINATES, MOST_WIDE = 10, 8
"""Columns of coordinates in one table; fewer where one of them is −100 mm or less."""
WIDE = -0.1
"""A coordinate (m) that takes the widest column."""
STILL = 1e-9
"""A rate below this share of its greatest value is nothing."""


class MotionTables(Tabled):
    """How the machine moves, in tables."""

    @property
    def functions(self) -> dict[str, Callable[..., Any]]:
        """What templates may call, by name."""
        return {
            "coordinates_table": self.coordinates_table,
            "dead_centres_table": self.dead_centres_table,
            "labels_table": self.labels_table,
            "rotation_table": self.rotation_table,
            "summary_table": self.summary_table,
        }

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

        wide = any(values[index][:count].min() <= WIDE for index in kept)
        blocks = -(-len(kept) // (MOST_WIDE if wide else MOST_COORDINATES))
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
                rows.append((str(piston.link), words, tidy(turn), tidy(abs(place) * 1e3)))
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
            angle = tidy(math.degrees(machine.cycle_angles[k]))
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


def _coordinate(axis: str, name: str) -> Symbol:
    return Symbol(axis, name)


def _dustless(value: float) -> float:
    return 0.0 if abs(value) < 1e-9 else value
