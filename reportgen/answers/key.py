"""The answer key: every quantity of a report at every position, with the bands within which it is right.

Its rows are the ledger's own families, so key, report and marker cannot disagree.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum
from functools import cached_property, partial
from itertools import dropwhile
from typing import Any

import numpy as np

from reportgen.analysis import Analysis
from reportgen.answers import bands
from reportgen.assignment import Assignment
from reportgen.document.plain import formula
from reportgen.document.prose import search_path
from reportgen.document.words import load_words
from reportgen.ledger.core import Family, Ledger
from reportgen.notation.expressions import Number, Symbol, refs
from reportgen.notation.numbers import Language

SIGNED = "turn."
"""Ids of signed rotations begin so; the size stands before them under the rest of the id."""


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
    vector of no length).  A `single` quantity has one value for all positions (N = 1).  `drawn` and
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
        """The row of a quantity, None if there is none."""
        return self._by_id.get(id)

    def row(self, id: str) -> Row:
        """The row of a quantity.  Raises `KeyError` if there is none."""
        return self._by_id[id]

    @cached_property
    def _by_id(self) -> Mapping[str, Row]:
        return {row.id: row for row in self.rows}

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


def make_key(assignment: Assignment, analysis: Analysis, ledger: Ledger) -> Key:
    """The key of an assignment from its ledger, which is the one its report prints."""
    machine = analysis.machine
    words = load_words(search_path(assignment.language, assignment.kind))
    on_paper, by_rounding = bands.drawn(ledger), bands.computed(ledger)
    formulas = {item.id for item in machine.formulas}
    balanced = {*dropwhile(lambda id: id != "M.vw", ledger.families)}
    worked = tuple(assignment.worked_positions)
    complete = set(worked) == set(range(1, machine.positions + 1))

    def row(id: str) -> Row:
        family = ledger[id]
        scale = family.how.scale
        values = np.array([ledger[id].at(k + 1).real for k in range(len(family.values))])
        if bands.is_direction(id):
            values = np.where(_exists(ledger, id), np.abs(values), np.nan)
        if family.arm:
            values = np.abs(values)
        role, part = _role(ledger, family), _part(id, ledger, formulas, balanced)
        workable = _is_workable(family) and (part is not Part.cycle or complete)
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
            tuple(_sense(id, value, words["sense"]) for value in values),
        )

    parts = list(Part)
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
    return not (family.hidden or family.is_plane or family.optional or f"{SIGNED}{id}" in ledger)


def _role(ledger: Ledger, family: Family) -> Role:
    if bands.is_chosen_length(ledger, family) or family.kind.endswith("scale"):
        return Role.scale
    typed = family.exact if family.definition is None else not refs(family.definition)
    return Role.given if typed else Role.asked


def _is_workable(family: Family) -> bool:
    """Whether it can be worked out on paper: what is read from a diagram can, an integral over the cycle cannot."""
    return family.id != "M.difference" and (family.definition is not None or len(family.values) > 1)


def _asked_at(values: np.ndarray, worked: tuple[int, ...], count: int) -> tuple[int, ...]:
    """The worked positions; what repeats from turn to turn (all kinematics) is asked for in the first turn."""
    if len(values) == 1:
        return (0,)
    turns = np.reshape(values, (-1, count)) if len(values) > count else np.empty((0, count))
    repeats = len(turns) > 0 and np.allclose(turns, turns[0], rtol=1e-9, atol=1e-12, equal_nan=True)
    asked = ((k - 1) % count + 1 if repeats else k for k in worked)
    return tuple(dict.fromkeys(k for k in asked if np.isfinite(values[k - 1])))


def _exists(ledger: Ledger, id: str) -> np.ndarray:
    """At which positions the vector of a direction `dir.v.B`, `dir.R05` has a length."""
    name = id.removeprefix("dir.")
    size = name if name in ledger else f"R.{name.removeprefix('R')}"
    return np.array([ledger[size].at(k + 1) != 0 for k in range(len(ledger[id].values))])


def _sense(id: str, value: float, words: Mapping[str, str]) -> str:
    """The sense of a rotation in words; "" for any other quantity."""
    if not id.startswith(SIGNED):
        return ""
    return words["none"] if value == 0 else words["anticlockwise"] if value > 0 else words["clockwise"]


_PARTS = (
    (r"(seg\.)?v\.|mu\.v$|dir\.v\.|(turn\.)?omega\.|ic\.", Part.velocity),
    (r"(seg\.)?a\.|mu\.a$|dir\.a\.|(turn\.)?eps\.", Part.acceleration),
    (r"(M\.)?Pqt\w*$|e\.Pqt|l\.\w+K\d+$|[sp]\.\d+$|P\w*$|G\d+$", Part.loads),
    (r"[hM]\..*\.p$|M\.(eq|vw)$", Part.torque),
    (r"R\.|M\.\d+$|x\.\d\d+$|h\.|mu\.R|dir\.R|seg\.", Part.forces),
    (r"(l|drawn|m|J)\.|mu\.l$|[RLF]$|lambda$", Part.geometry),
)


def _part(id: str, ledger: Ledger, formulas: set[str], balanced: set[str]) -> Part:
    """The chapter a quantity belongs to: given data, closed formulas, by its id, the cycle after the balance."""
    if _role(ledger, ledger[id]) is Role.given and len(ledger[id].values) == 1:
        return Part.data
    if id in formulas:
        return Part.formulas
    named = next((part for pattern, part in _PARTS if re.match(pattern, id)), None)
    return named or (Part.cycle if id in balanced else Part.geometry)
