"""Tables of forces: the strokes of the pistons, moments on Zhukovsky's lever."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from reportgen.document.tabled import Tabled
from reportgen.document.tree import Table, Value
from reportgen.document.voice import TEXT_WIDTH
from reportgen.notation.expressions import Number

NARROWEST = 16.0
"""Columns of words narrower than this (mm) are set as rows instead."""


class ForceTables(Tabled):
    """What acts on the machine, in tables."""

    @property
    def functions(self) -> dict[str, Callable[..., Any]]:
        """What templates may call, by name."""
        return {
            "strokes_table": self.strokes_table,
            "lever_table": self.lever_table,
        }

    def strokes_table(self, key: str, caption: str, first: str, positions: str) -> Table:
        """The stroke of every piston between dead centres of any of them."""
        gas = self.facts.analysis.gas
        machine = self.facts.analysis.machine
        names = self.voice.words["strokes"]
        strokes = np.array([state.stroke for state in gas.values()])
        starts = [0, *(int(i) + 1 for i in np.flatnonzero(np.any(np.diff(strokes, axis=1), axis=0)))]
        ends = [*starts[1:], machine.positions]
        stretches = [
            f"{machine.position(start + 1)}–{machine.position(end % machine.positions + 1)}"
            for start, end in zip(starts, ends, strict=True)
        ]
        told = [[names[int(state.stroke[start])] for start in starts] for state in gas.values()]
        pistons = [f"{first} {state.piston.link}" for state in gas.values()]
        width = (TEXT_WIDTH - 30) / len(starts)
        if width < NARROWEST:
            down = zip(stretches, *told, strict=True)
            return self.voice.list_table(
                key, caption, (positions, *pistons), down, (30.0, *(40.0,) * len(pistons))
            )
        across = [(piston, *row) for piston, row in zip(pistons, told, strict=True)]
        widths = (30.0, *(min(width, 30.0),) * len(starts))
        return self.voice.list_table(key, caption, (positions, *stretches), across, widths)

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
