"""The answer key of an assignment as data.

Its rows come from the ledger, so that key, report and marking agree.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from enum import StrEnum
from functools import cache, cached_property
from typing import TYPE_CHECKING

import numpy as np

from reportgen.base.template_folders import REFERENCE
from reportgen.base.units import Language
from reportgen.base.words import common_words
from reportgen.document import InlineMath, Inlines, Text
from reportgen.formula import Chain, Expression, Symbol
from reportgen.formula.vocabulary import KeyChapter

if TYPE_CHECKING:
    import numpy as np


@cache
def headed_chapters() -> tuple[KeyChapter, ...]:
    """Return the chapters that a key may have: those with a heading in the words."""
    headings = common_words(REFERENCE)["parts"]
    return tuple(chapter for chapter in KeyChapter if chapter in headings)


class Role(StrEnum):
    """Role of a row for the student: printed on the task, to be computed, or a scale of his or her choice."""

    given = "given"
    asked = "asked"
    scale = "scale"


@dataclass(frozen=True, slots=True)
class KeyRow:
    """One quantity over the positions, in its printed unit.

    `values` [N] are unrounded, with the sign that is printed, and `printed` [N] what the report prints for them; both
    are NaN where the quantity does not exist (the direction of a vector of no length).  A `single` quantity has one
    value for all positions (N = 1).  `drawn` and `computed` [N] are the half widths of the two bands.  `positions` are
    the numbers (from 1) at which the answer sheet asks for it, empty if it does not; (0,) for a single quantity.
    `sense` [N] says the direction in words where the value has one, else "".
    """

    id: str
    part: KeyChapter
    role: Role
    symbol: Symbol
    kind: str
    unit: str
    decimals: int | None
    values: np.ndarray
    printed: np.ndarray
    drawn: np.ndarray
    computed: np.ndarray
    positions: tuple[int, ...]
    sense: tuple[str, ...]
    size: str = ""
    """The id of the size of a signed rotation."""
    what: str = ""
    """Name of the quantity in words: normal acceleration of B about A."""
    positive: str = ""
    """Positive sense in words; "" if there is none, or if the general rule defines it."""
    open_sense: bool = False
    """True if its sign is not judged, because the papers do not define the positive sense."""
    plans: tuple[str, ...] = ()
    """Ids of the scales of the plans from which its value, or a value that it depends on, is read."""
    by_rule: bool = False
    """True if its bands include the error of the trapezoid rule over the positions, for an integral over the cycle."""
    formula: Expression | None = None
    """The formula in symbols of what is defined by it alone, as the papers say it: w of w = s′ − e."""

    @property
    def single(self) -> bool:
        return len(self.values) == 1

    @property
    def named(self) -> str:
        """Name of the quantity and its positive sense."""
        return capitalised("; ".join(filter(None, (self.what, self.positive))))

    @property
    def described(self) -> Inlines:
        """The same with its formula, if it has one, as printed beside the row."""
        if self.formula is None:
            return (Text(self.named),)
        formula = InlineMath(Chain((self.symbol, self.formula)), slashed=True)
        sense = (Text(f"; {self.positive}"),) if self.positive else ()
        return (Text(f"{capitalised(self.what)}; "), formula, *sense)

    def has(self, position: int) -> bool:
        """Return True if the quantity has a value at a position: from 1, or 0 for a single value."""
        return self.single == (position == 0)

    def at(self, position: int) -> int:
        """The index of a position (from 1, 0 for a single value) in `values`."""
        return 0 if self.single else position - 1


@dataclass(frozen=True)
class Key:
    """All rows of an assignment; `labels` [N] are the names of its positions, `students` fields of its student.

    If there are very many positions, only those in `printed` appear in the document.
    """

    id: str
    kind: str
    variant: str
    language: Language
    student: Mapping[str, str]
    labels: tuple[str, ...]
    rows: tuple[KeyRow, ...]
    printed: tuple[int, ...] = ()
    parts: tuple[PartOfKey, ...] = ()
    """The parts of a coursework in the order of their rows."""

    def label(self, position: int, id: str = "") -> str:
        """Return the label of a position (from 1) of a quantity; "" for 0, the position of single values."""
        labels = self.part(id).labels if id else self.labels
        return labels[position - 1] if position else ""

    def part(self, id: str) -> Key:
        """The key of the part that a quantity belongs to; of a work without parts itself."""
        return next((part.key for part in self.parts if part.name == self.owner(id)), self)

    def owner(self, id: str) -> str:
        """The name of the part that a quantity belongs to; the first has whatever no other has."""
        first, *others = self.parts or (None,)
        named = (part.name for part in others if part is not None and id.startswith(f"{part.name}."))
        return next(named, first.name if first else "")

    def title_of(self, name: str) -> str:
        """The title of a part; "" for what is no part."""
        return next((part.title for part in self.parts if part.name == name), "")

    @property
    def pages(self) -> tuple[tuple[str, Key], ...]:
        """Return the parts by their titles, each with its rows of this key; a key without parts is one without
        title.
        """
        if not self.parts:
            return (("", self),)
        first = 0
        pages = []
        for part in self.parts:
            rows = self.rows[first : first + len(part.key.rows)]
            first += len(rows)
            pages.append((part.title, replace(part.key, rows=rows, student=self.student)))
        return tuple(pages)

    def find(self, id: str) -> KeyRow | None:
        """The row of a quantity, or of the signed rotation whose size it is; None if there is none."""
        return self._by_id.get(id)

    def row(self, id: str) -> KeyRow:
        """The row of a quantity.  Raises `KeyError` if there is none."""
        return self._by_id[id]

    @cached_property
    def _by_id(self) -> Mapping[str, KeyRow]:
        return {row.size: row for row in self.rows if row.size} | {row.id: row for row in self.rows}

    @property
    def asked(self) -> tuple[KeyRow, ...]:
        """The rows of the answer sheet, in order."""
        return tuple(row for row in self.rows if row.positions)


@dataclass(frozen=True, slots=True)
class PartOfKey:
    """A part of a coursework: its name in front of its ids in place of the `head` that they have by themselves."""

    name: str
    key: Key
    title: str
    head: str = ""

    def own(self, id: str) -> str:
        """Return the id of a quantity within the part."""
        return self.head + id.removeprefix(self.name) if self.head and id else id

    def full(self, id: str) -> str:
        """The id in the coursework of a quantity of the part."""
        return self.name + id.removeprefix(self.head) if self.head and id else id


@dataclass(frozen=True, slots=True)
class Span:
    """Positions of a key: those of the cycle by their labels, `count` of them in a turn.

    Those in `worked` are written out in full; if there are very many, only those in `printed` appear in the document.
    """

    labels: tuple[str, ...]
    count: int
    worked: tuple[int, ...]
    printed: tuple[int, ...] = ()


INSTANT = Span(("1",), 1, (1,))
"""The one position of an exercise."""


def capitalised(text: str) -> str:
    """Return a phrase with a capital, as at the head of a row."""
    return text[:1].upper() + text[1:]
