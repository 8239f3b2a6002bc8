"""Collect the entries of a file by place: values, and faults for entries that are not certain."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from reportgen.base.errors import Fault, Location
from reportgen.base.records import replace
from reportgen.base.units import QuantityFault
from reportgen.case.answer_key import Key, KeyRow
from reportgen.handin import FileReading, agree, figures
from reportgen.handin.symbol_matching import Symbols, bare
from reportgen.handin.text_numbers import NUMBER, Marks, read_value
from reportgen.handin.text_statements import ANTICLOCKWISE, CLOCKWISE
from reportgen.handin.word_text import TextLine, WordLocation
from reportgen.marking.marking_data import Answer, Place

SHOWN = 60
"""Largest number of characters of a quoted text."""


@dataclass(slots=True)
class Gathering:
    """The values and the doubts of one file for a key; values are in the printed units of their rows."""

    key: Key
    file: str
    marks: Marks
    symbols: Symbols
    values: dict[Place, Answer] = field(default_factory=dict)
    doubts: dict[Place, Fault] = field(default_factory=dict)
    """The first doubt of each place; it counts only if the place has no value."""
    clashes: dict[Place, Fault] = field(default_factory=dict)
    """Places with two different values, which count as unread."""
    positions: dict[str, Mapping[str, int]] = field(default_factory=dict)
    fixed: frozenset[Place] = frozenset()
    """Places filled by the blanks of a blank report."""
    notes: list[Fault] = field(default_factory=list)

    def rows_of(self, symbol: str) -> tuple[KeyRow, ...]:
        """Return the rows that a symbol may refer to."""
        return self.symbols.rows_of(symbol)

    def position(self, row: KeyRow, label: str | None) -> int | None:
        """Return the position (from 1) of a row by its label; 0 for a row with a single value; None if unknown."""
        if row.single:
            return 0
        owner = self.key.owner(row.id)
        if owner not in self.positions:
            labels = self.key.part(row.id).labels
            self.positions[owner] = {bare(label).casefold(): k for k, label in enumerate(labels, start=1)}
        position = None if label is None else self.positions[owner].get(bare(label).casefold())
        return position if position is None else _in_first_turn(row, position)

    def is_label(self, text: str) -> bool:
        """Return True if any part has a position with that label."""
        keys = [part.key for part in self.key.parts] or [self.key]
        return any(bare(text).casefold() == bare(label).casefold() for key in keys for label in key.labels)

    def doubt(
        self, row: KeyRow, position: int | None, code: str, location: WordLocation, text: str, **more: str
    ) -> None:
        """Record an unread entry for a row, at a position or, if None, at all its positions."""
        for k in row.positions:
            if position is None or k == position:
                quoted = _tidy(text)
                self.doubts.setdefault((row.id, k), Fault(code, location, {"text": quoted, **more}))

    def give(self, row: KeyRow, position: int, value: float, location: WordLocation, text: str) -> None:
        """Record a value, in the printed unit of its row, at a position (0 for a row with a single value).

        If the place already has a value that does not agree, it becomes unread. Values at positions that the row does
        not ask for, and at places filled by blanks, are ignored.
        """
        place, answer = (row.id, position), Answer(value, _tidy(text), location)
        if position not in row.positions or place in self.clashes or place in self.fixed:
            return
        first = self.values.get(place)
        if first is None:
            self.values[place] = answer
        elif agree(first, answer):
            if figures(answer.text) > figures(first.text):
                self.values[place] = answer
        elif _has_unit(answer) != _has_unit(first):
            # A number without a unit may belong to another quantity with the same letter.
            self.values[place] = answer if _has_unit(answer) else first
        elif not is_signed(row) and agree(replace(first, value=abs(first.value)), replace(answer, value=abs(value))):
            # One is the size of a vector, the other its coordinate on an axis in the opposite direction.
            self.values[place] = max(first, answer, key=lambda one: one.value)
        else:
            del self.values[place]
            self.clashes[place] = Fault("unread-two-values", location, {"text": answer.text, "first": first.text})

    def number(
        self,
        row: KeyRow,
        position: int,
        number: str,
        unit: str,
        location: WordLocation,
        words: str,
        barred: bool = False,
    ) -> None:
        """Read a number with its unit for a place, with the sense given by the words beside it.

        The value is converted to the printed unit of the row; a number that cannot be read is recorded as a doubt.
        """
        text = f"{number.strip()} {unit}".strip()
        try:
            value = read_value(number, unit, row, self.marks)
        except QuantityFault as fault:
            code = "unread-product" if fault.code == "product" else "unread-unit" if unit else "unread-number"
            self.doubt(row, position, code, location, text, unit=row.unit)
            return
        signed = self._signed(row, position, value, words, barred)
        if signed is None:
            self.doubt(row, position, "unread-sense", location, text)
        else:
            self.give(row, position, signed, location, text)

    def _signed(self, row: KeyRow, position: int, value: float, words: str, barred: bool) -> float | None:
        """Return a value with its sign, or None if two senses are given or if a signed quantity is given as a size.

        A rotation has the sense given beside it; without one, only its size counts.
        """
        # “Anti-clockwise” contains “clockwise”.
        turns = bool(CLOCKWISE.search(ANTICLOCKWISE.sub(" ", words))), bool(ANTICLOCKWISE.search(words))
        if row.size:
            if value < 0:
                return None if turns == (False, True) else value
            if any(turns):
                return None if all(turns) else -value if turns[0] else value
            known = row.values[row.at(position)] if position in row.positions else np.nan
            return -value if known < 0 else value
        return None if barred and is_signed(row) else value

    def note(self, code: str, location: Location, **arguments: str) -> None:
        """Record a fault of the file as a whole."""
        self.notes.append(Fault(code, location, arguments))

    def reading(self) -> FileReading:
        """Return everything collected; values take precedence over doubts."""
        unread = {place: fault for place, fault in self.doubts.items() if place not in self.values}
        return FileReading(self.key.id, self.file, self.values, {**unread, **self.clashes}, tuple(self.notes))

    def location(self, line: TextLine, index: int) -> WordLocation:
        """Return the location of a letter of a line."""
        node = line.nodes[min(max(index, 0), len(line.nodes) - 1)]
        return WordLocation(self.file, line.number, index + 1, element=node.number)


def _in_first_turn(row: KeyRow, position: int) -> int:
    """Return the position of the first turn that corresponds to one of the second.

    This applies to a quantity that repeats and is asked for in one turn only; any other position is returned unchanged.
    """
    turn = len(row.values) // 2
    if position in row.positions or position - turn not in row.positions or len(row.values) % 2:
        return position
    repeats = np.allclose(row.values[:turn], row.values[turn:], rtol=1e-9, atol=1e-12, equal_nan=True)
    return position - turn if repeats else position


def is_signed(row: KeyRow) -> bool:
    """Return True if the sign of a quantity is significant: it has both signs, and the papers say which is which."""
    return not row.open_sense and bool(np.nanmin(row.values, initial=0.0) < 0)


def _has_unit(answer: Answer) -> bool:
    """Return True if a value is written with a unit."""
    return bool(re.sub(NUMBER, "", answer.text, count=1).strip())


def _tidy(text: str) -> str:
    """Return a text for quoting: in one line, without braces, shortened."""
    plain = re.sub(r"\s+", " ", text.replace("{", "").replace("}", "")).strip()
    return plain if len(plain) <= SHOWN else f"{plain[: SHOWN - 1]}…"
