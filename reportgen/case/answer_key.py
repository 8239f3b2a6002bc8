"""The answer key of an assignment as data: `Key` with its `KeyRow`s.

Its rows come from the ledger, so that key, report and marking agree.
"""

from __future__ import annotations

from collections.abc import Mapping
from enum import StrEnum
from functools import cache, cached_property
from typing import TYPE_CHECKING

import numpy as np

from reportgen.base.records import Record, replace
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
    """Return the chapters that a key may have: those with a heading in `words.yaml`."""
    headings = common_words(REFERENCE)["parts"]
    return tuple(chapter for chapter in KeyChapter if chapter in headings)


class Role(StrEnum):
    """Role of a row for the student: printed on the task, to be computed, or a scale of his or her choice."""

    given = "given"
    asked = "asked"
    scale = "scale"


class KeyRow(Record):
    """One quantity over the positions, in its printed unit.

    `values` [N] are unrounded, with the sign that is printed, and `printed` [N] are the report's rounded values; both
    are NaN where the quantity does not exist (the direction of a zero vector).  A `single` quantity has one value for
    all positions (N = 1).  `drawn` and `computed` [N] are the half widths of the tolerance bands for graphical and
    calculated answers.  `positions` are the numbers (from 1) at which the answer sheet asks for the quantity, (0,) for
    a single quantity, () if it does not ask.  `sense` [N] are phrases for the direction, "" for a value without one.
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
    """The formula in symbols of a quantity that only its formula defines, such as w of w = s′ − e."""

    @property
    def single(self) -> bool:
        """True if one value holds for all positions."""
        return len(self.values) == 1

    @property
    def named(self) -> str:
        """Name of the quantity and its positive sense."""
        return capitalised("; ".join(filter(None, (self.what, self.positive))))

    @property
    def described(self) -> Inlines:
        """The same as `named`, with the formula as printed beside the row, if there is one."""
        if self.formula is None:
            return (Text(self.named),)
        formula = InlineMath(Chain((self.symbol, self.formula)), slashed=True)
        sense = (Text(f"; {self.positive}"),) if self.positive else ()
        return (Text(f"{capitalised(self.what)}; "), formula, *sense)

    def has(self, position: int) -> bool:
        """Return True if the quantity has a value at a position: from 1, or 0 for a single value."""
        return self.single == (position == 0)

    def at(self, position: int) -> int:
        """Return the index in `values` of a position (from 1, or 0 for a single value)."""
        return 0 if self.single else position - 1


class Key(Record, dict=True):
    """The answer key of an assignment: all its rows.

    `labels` [N] are the names of the positions, `student` the fields of its student.  If there are very many positions,
    the document contains only those in `printed`.
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
        """Return the key of the part to which a quantity belongs; the key itself if it has no parts."""
        return next((part.key for part in self.parts if part.name == self.owner(id)), self)

    def owner(self, id: str) -> str:
        """Return the name of the part to which a quantity belongs: the first one, unless the id begins with another's
        name.
        """
        first, *others = self.parts or (None,)
        named = (part.name for part in others if part is not None and id.startswith(f"{part.name}."))
        return next(named, first.name if first else "")

    def title_of(self, name: str) -> str:
        """Return the title of a part; "" for an unknown name."""
        return next((part.title for part in self.parts if part.name == name), "")

    @property
    def pages(self) -> tuple[tuple[str, Key], ...]:
        """Return the parts by their titles, each with its rows of this key; a key without parts is one part without a
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
        """Return the row of a quantity, or of the signed rotation with this size; None if there is none."""
        return self._by_id.get(id)

    def row(self, id: str) -> KeyRow:
        """Return the row of a quantity.  Raises `KeyError` if there is none."""
        return self._by_id[id]

    @cached_property
    def _by_id(self) -> Mapping[str, KeyRow]:
        return {row.size: row for row in self.rows if row.size} | {row.id: row for row in self.rows}

    @property
    def asked(self) -> tuple[KeyRow, ...]:
        """The rows of the answer sheet, in order."""
        return tuple(row for row in self.rows if row.positions)


class PartOfKey(Record):
    """A part of a coursework: its `name` replaces the `head` at the beginning of its ids."""

    name: str
    key: Key
    title: str
    head: str = ""

    def own(self, id: str) -> str:
        """Return the id of a quantity within the part."""
        return self.head + id.removeprefix(self.name) if self.head and id else id

    def full(self, id: str) -> str:
        """Return the id in the coursework of a quantity of the part."""
        return self.name + id.removeprefix(self.head) if self.head and id else id


class Span(Record):
    """Positions of a key: labels of those of the cycle, `count` in a turn.

    Positions in `worked` are calculated in full.  If there are very many positions, the document contains only those in
    `printed`.
    """

    labels: tuple[str, ...]
    count: int
    worked: tuple[int, ...]
    printed: tuple[int, ...] = ()


INSTANT = Span(("1",), 1, (1,))
"""The single position of an exercise."""


def capitalised(text: str) -> str:
    """Return a phrase with a capital first letter."""
    return text[:1].upper() + text[1:]
