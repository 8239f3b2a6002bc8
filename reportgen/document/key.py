"""The answer key of an assignment, as data: its rows are the ledger's own families, so key, report and marker agree."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum
from functools import cached_property

import numpy as np

from reportgen.notation.expressions import Symbol
from reportgen.notation.numbers import Language
from reportgen.notation.vocabulary import Chapter


class Role(StrEnum):
    """What a row is to the student: printed on the task, to be worked out, or a scale of his or her own choice."""

    given = "given"
    asked = "asked"
    scale = "scale"


@dataclass(frozen=True, slots=True)
class Row:
    """One quantity over the positions, in its printed unit.

    `values` [N] have the sign that is printed; NaN where the quantity does not exist (the direction of a
    vector of no length).  A `single` quantity has one value for all positions (N = 1).  `drawn` and
    `computed` [N] are the half widths of the two bands.  `positions` are the numbers (from 1) at which
    the answer sheet asks for it, empty if it does not; (0,) for a single quantity.  `sense` [N] says the
    direction in words where the value has one, else "".
    """

    id: str
    part: Chapter
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
    size: str = ""
    """The id of the size of a signed rotation."""
    what: str = ""
    """What it is in words: normal acceleration of B about A."""
    positive: str = ""
    """Which sense counts as positive, in words; "" where there is none, or where the general rule says it."""
    open_sense: bool = False
    """Whether its sign is not judged, because the papers do not say which sense is positive."""

    @property
    def single(self) -> bool:
        return len(self.values) == 1

    @property
    def described(self) -> str:
        """What it is and which sense of it counts as positive, as it stands beside the row."""
        return capitalised("; ".join(filter(None, (self.what, self.positive))))

    def has(self, position: int) -> bool:
        """Whether the quantity has a value at a position: from 1, or 0 for a single value."""
        return self.single == (position == 0)

    def at(self, position: int) -> int:
        """The index of a position (from 1, 0 for a single value) in `values`."""
        return 0 if self.single else position - 1


@dataclass(frozen=True)
class Key:
    """All rows of an assignment; `labels` [N] are what its positions are called, `students` fields of its student.

    Of very many positions only those in `printed` stand in the document.
    """

    id: str
    kind: str
    variant: str
    language: Language
    student: Mapping[str, str]
    labels: tuple[str, ...]
    rows: tuple[Row, ...]
    printed: tuple[int, ...] = ()

    def label(self, position: int) -> str:
        """What a position (from 1) is called; "" for 0, the one of single values."""
        return self.labels[position - 1] if position else ""

    def find(self, id: str) -> Row | None:
        """The row of a quantity, or of the signed rotation whose size it is; None if there is none."""
        return self._by_id.get(id)

    def row(self, id: str) -> Row:
        """The row of a quantity.  Raises `KeyError` if there is none."""
        return self._by_id[id]

    @cached_property
    def _by_id(self) -> Mapping[str, Row]:
        return {row.size: row for row in self.rows} | {row.id: row for row in self.rows}

    @property
    def asked(self) -> tuple[Row, ...]:
        """The rows of the answer sheet, in order."""
        return tuple(row for row in self.rows if row.positions)


@dataclass(frozen=True, slots=True)
class Span:
    """The positions that a key has: those of the cycle by their labels, `count` of them in a turn.

    Those in `worked` are written out in full; of very many only those in `printed` stand in the document.
    """

    labels: tuple[str, ...]
    count: int
    worked: tuple[int, ...]
    printed: tuple[int, ...] = ()


INSTANT = Span(("1",), 1, (1,))
"""The one position of an exercise."""


def capitalised(text: str) -> str:
    """A phrase as it stands at the head of a row."""
    return text[:1].upper() + text[1:]
