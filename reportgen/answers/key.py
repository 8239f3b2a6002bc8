"""The answer key: every quantity of a report at every position, with the bands within which it is right.

Its rows are the ledger's own families, so key, report and marker cannot disagree.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from reportgen.notation.expressions import Symbol


class Part(StrEnum):
    """The chapters of a key, in their order; `words.yaml` has their headings under `parts`."""

    data = "data"
    geometry = "geometry"
    velocity = "velocity"
    acceleration = "acceleration"
    formulas = "formulas"
    loads = "loads"
    forces = "forces"
    torque = "torque"
    cycle = "cycle"


class Role(StrEnum):
    """What a row is to the student: printed on the task, to be worked out, or a scale of his or her own choice."""

    given = "given"
    asked = "asked"
    scale = "scale"


@dataclass(frozen=True, slots=True)
class Row:
    """One quantity over the positions, in its printed unit.

    `values` [N] have the sign that is printed; NaN where the quantity does not exist (the direction of a
    vector that is nothing).  A `single` quantity has one value for all positions (N = 1).  `drawn` and
    `computed` [N] are the half widths of the two bands.  `positions` are the numbers (from 1) at which
    the answer sheet asks for it, empty if it does not; (0,) for a single quantity.  `sense` [N] says the
    direction in words where the value has one, else "".
    """

    id: str
    part: Part
    role: Role
    symbol: Symbol
    kind: str
    unit: str
    decimals: int | None
    values: np.ndarray
    drawn: np.ndarray
    computed: np.ndarray
    positions: tuple[int, ...]
    sense: tuple[str, ...]

    @property
    def single(self) -> bool:
        return len(self.values) == 1

    def at(self, position: int) -> int:
        """The index of a position (from 1, 0 for a single value) in `values`."""
        return 0 if self.single else position - 1


@dataclass(frozen=True)
class Key:
    """All rows of an assignment; `labels` [N] are what its positions are called, `students` fields of its student."""

    id: str
    kind: str
    variant: str
    language: str
    student: Mapping[str, str]
    labels: tuple[str, ...]
    rows: tuple[Row, ...]

    def row(self, id: str) -> Row:
        """The row of a quantity.  Raises `KeyError` if there is none."""
        for row in self.rows:
            if row.id == id:
                return row
        raise KeyError(id)

    @property
    def asked(self) -> tuple[Row, ...]:
        """The rows of the answer sheet, in order."""
        return tuple(row for row in self.rows if row.positions)
