"""The answer key: every quantity of a report at every position, with the bands within which it is right.

Its rows are the ledger's own families, so key, report and marker cannot disagree.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum
from functools import cached_property, partial
from typing import Any

import numpy as np

from reportgen.answers import bands
from reportgen.case import Case
from reportgen.document.plain import formula
from reportgen.ledger.core import Ledger
from reportgen.notation.expressions import Number, Symbol, refs
from reportgen.notation.numbers import Language
from reportgen.notation.sheet import Family
from reportgen.notation.vocabulary import Chapter
from reportgen.words import load_words, search_path


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

    @property
    def single(self) -> bool:
        return len(self.values) == 1

    def has(self, position: int) -> bool:
        """Whether the quantity has a value at a position: from 1, or 0 for a single value."""
        return self.single == (position == 0)

    def at(self, position: int) -> int:
        """The index of a position (from 1, 0 for a single value) in `values`."""
        return 0 if self.single else position - 1


@dataclass(frozen=True)
class Key:
    """All rows of an assignment; `labels` [N] are what its positions are called, `students` fields of its student."""

    id: str
    kind: str
    variant: str
    language: Language
    student: Mapping[str, str]
    labels: tuple[str, ...]
    rows: tuple[Row, ...]

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


def words_of(key: Key) -> Mapping[str, Any]:
    """The words of a key's language and machine."""
    return load_words(search_path(key.language, key.kind))


def symbol_text(row: Row, key: Key) -> str:
    """A quantity's symbol in one line of plain text, e.g. v_BA."""
    return formula(row.symbol, key.language)


def shown_number(row: Row, value: float) -> Number:
    """A number of a row as the report prints it: to its decimals, or without the dust of floats."""
    return Number(value if row.decimals is not None else float(f"{value:.12g}"), row.decimals)


def make_key(case: Case) -> Key:
    """The key of a case, from the ledger that its report prints."""
    assignment, machine, ledger, words = case.assignment, case.analysis.machine, case.ledger, case.words
    on_paper, by_rounding = bands.drawn(ledger), bands.computed(ledger)
    worked = tuple(assignment.worked_positions)
    complete = set(worked) == set(range(1, machine.positions + 1))

    def row(id: str) -> Row:
        family = ledger[id]
        scale = family.how.scale
        values = np.array([family.at(k + 1).real for k in range(len(family.values))])
        if family.is_direction:
            # A vector of no length has none.
            exists = [ledger[family.of].at(k + 1) != 0 for k in range(len(values))]
            values = np.where(exists, np.abs(values), np.nan)
        if family.arm:
            values = np.abs(values)
        role = _role(ledger, family)
        part = Chapter.data if role is Role.given and len(values) == 1 else family.chapter
        # What is read from a diagram can be worked out on paper, an integral over the cycle cannot.
        workable = id != "M.difference" and (family.definition is not None or len(values) > 1)
        workable = workable and (part is not Chapter.cycle or complete)
        asked = (role is Role.scale and not bands.is_round_scale(family)) or (role is Role.asked and workable)
        return Row(
            id,
            part,
            role,
            family.symbol,
            family.kind,
            ledger.units.get(family.how.unit, family.how.unit),
            ledger.decimals[id],
            values / scale,
            on_paper[id] / scale,
            by_rounding[id] / scale,
            _asked_at(values, worked, machine.count) if asked else (),
            tuple(_sense(family, value, words["sense"]) for value in values),
            family.of if family.is_signed_rotation else "",
        )

    parts = list(Chapter)
    rows = sorted(map(row, filter(partial(_is_shown, ledger), ledger.families)), key=lambda row: parts.index(row.part))
    student = assignment.report.student
    fields = {"name": student.name, "id": student.id, "class": student.class_}
    return Key(
        assignment.id,
        assignment.kind,
        assignment.variant,
        assignment.language,
        {name: text for name, text in fields.items() if text},
        tuple(str(machine.position(k)) for k in range(1, machine.positions + 1)),
        tuple(rows),
    )


def _is_shown(ledger: Ledger, id: str) -> bool:
    """Whether a key has a row for it: not for points, optional quantities and the sizes of signed rotations."""
    family = ledger[id]
    return not (family.hidden or family.is_plane or family.optional or id in ledger.signed)


def _role(ledger: Ledger, family: Family) -> Role:
    if bands.is_chosen_length(ledger, family) or family.kind.endswith("scale"):
        return Role.scale
    typed = family.exact if family.definition is None else not refs(family.definition)
    return Role.given if typed else Role.asked


def _asked_at(values: np.ndarray, worked: tuple[int, ...], count: int) -> tuple[int, ...]:
    """The worked positions; what repeats from turn to turn (all kinematics) is asked for in the first turn."""
    if len(values) == 1:
        return (0,)
    turns = np.reshape(values, (-1, count)) if len(values) > count else np.empty((0, count))
    repeats = len(turns) > 0 and np.allclose(turns, turns[0], rtol=1e-9, atol=1e-12, equal_nan=True)
    asked = ((k - 1) % count + 1 if repeats else k for k in worked)
    return tuple(dict.fromkeys(k for k in asked if np.isfinite(values[k - 1])))


def _sense(family: Family, value: float, words: Mapping[str, str]) -> str:
    """The sense of a rotation in words; "" for any other quantity."""
    if not family.is_signed_rotation:
        return ""
    return words["none"] if value == 0 else words["anticlockwise"] if value > 0 else words["clockwise"]
