"""The answer key: every quantity of a report at every position, with the bands within which it is right.

Its rows are the ledger's own families, so key, report and marker cannot disagree.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from enum import StrEnum
from functools import cached_property, singledispatch
from typing import Any

import numpy as np

from reportgen.answers.bands import computed_bands, drawn_bands, is_chosen_length, is_round_scale
from reportgen.answers.trapezoid import is_workable, trapezoid_errors
from reportgen.answers.wording import MAGNITUDE, capitalised, is_open, phrase, positive_sense
from reportgen.case import Case, ExerciseCase, Opened
from reportgen.document.outline import open_report
from reportgen.document.tree import formula
from reportgen.ledger.core import Ledger
from reportgen.notation import ids
from reportgen.notation.expressions import Number, Symbol, refs
from reportgen.notation.numbers import Language, significant_decimals
from reportgen.notation.sheet import Family, is_short
from reportgen.notation.vocabulary import MAX_DIGITS, Chapter
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


def words_of(key: Key) -> Mapping[str, Any]:
    """The words of a key's language and machine."""
    return load_words(search_path(key.language, key.kind))


def symbol_text(row: Row, key: Key) -> str:
    """A quantity's symbol in one line of plain text, e.g. v_BA."""
    return formula(row.symbol, key.language)


def shown_number(row: Row, value: float) -> Number:
    """A number of a row as the report prints it: to its decimals, or without the dust of floats."""
    return Number(value if row.decimals is not None else float(f"{value:.12g}"), row.decimals)


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


@singledispatch
def make_key(case: Opened) -> Key:
    """The key of a case, from the ledger that its report prints."""
    raise TypeError(type(case).__name__)


@make_key.register
def of_machine(case: Case) -> Key:
    """The key of a machine, over all positions of its cycle."""
    machine, report = case.analysis.machine, open_report(case)
    labels = tuple(str(machine.position(k)) for k in range(1, machine.positions + 1))
    printed = report.all_positions if report.thinned else ()
    span = Span(labels, machine.count, tuple(case.assignment.worked_positions), printed)
    return _key(case, case.ledger, span, lambda id: positive_sense(id, report))


@make_key.register
def of_exercise(case: ExerciseCase) -> Key:
    """The key of an exercise, whose quantities are all sizes."""
    return _key(case, case.ledger, INSTANT, lambda _: "")


def _key(case: Opened, ledger: Ledger, span: Span, sense_of: Callable[[str], str]) -> Key:
    assignment, words, worked = case.assignment, case.words, span.worked
    by_rule = trapezoid_errors(ledger)
    on_paper, by_rounding = drawn_bands(ledger), computed_bands(ledger)
    complete = set(worked) == set(range(1, len(span.labels) + 1))

    def row(id: str) -> Row:
        family = ledger[id]
        scale = family.how.scale
        values = np.array([family.at(k + 1).real for k in range(len(family.values))])
        sense = sense_of(id)
        if family.is_direction:
            # A vector of no length has none.
            exists = [ledger[family.of].at(k + 1) != 0 for k in range(len(values))]
            values = np.where(exists, np.abs(values), np.nan)
        if family.arm:
            values = np.abs(values)
        role = _role(ledger, family)
        part = Chapter.data if role is Role.given and len(values) == 1 else family.chapter
        # What is read from a diagram can be worked out on paper, an integral over the cycle cannot.
        integral = family.definition is None or ids.rest(id) in ledger
        workable = id != "M.difference" and (len(values) > 1 or not integral)
        workable = workable and (part is not Chapter.cycle or complete) and is_workable(ledger, id, by_rule)
        asked = (role is Role.scale and not is_round_scale(family)) or (role is Role.asked and workable)
        return Row(
            id,
            part,
            role,
            family.symbol,
            family.kind,
            ledger.units.get(family.how.unit, family.how.unit),
            _decimals(ledger.decimals[id], values / scale),
            values / scale,
            on_paper[id] / scale,
            by_rounding[id] / scale,
            _asked_at(values, worked, span.count, family.kind == "force scale") if asked else (),
            tuple(_sense(family, value, words["sense"]) for value in values),
            family.of if family.is_signed_rotation else "",
            phrase(id, ledger, words),
            words["magnitude"] if sense == MAGNITUDE else sense,
            is_open(values, sense),
        )

    parts, families = list(Chapter), ledger.families.values()
    # No rows for points, optional quantities and the sizes of signed rotations.
    shown = (one.id for one in families if not (one.hidden or one.is_plane or one.optional or one.id in ledger.signed))
    rows = sorted([row(id) for id in shown], key=lambda row: parts.index(row.part))
    student = assignment.report.student
    fields = {"name": student.name, "id": student.id, "class": student.class_}
    return Key(
        assignment.id,
        assignment.kind,
        assignment.variant,
        assignment.language,
        {name: text for name, text in fields.items() if text},
        span.labels,
        tuple(rows),
        span.printed,
    )


def _role(ledger: Ledger, family: Family) -> Role:
    if is_chosen_length(ledger, family) or family.kind.endswith("scale"):
        return Role.scale
    typed = family.exact if family.definition is None else not refs(family.definition)
    return Role.given if typed else Role.asked


def _decimals(of_ledger: int | None, values: np.ndarray) -> int | None:
    """The ledger's; data of several positions that are exact but endless, such as 129.128571…°, get 6 figures."""
    if of_ledger is not None or len(values) == 1 or is_short(values):
        return of_ledger
    return significant_decimals(float(np.nanmax(np.abs(values))), MAX_DIGITS)


def _asked_at(values: np.ndarray, worked: tuple[int, ...], count: int, chosen: bool) -> tuple[int, ...]:
    """The worked positions; what repeats from turn to turn (all kinematics) is asked for in the first turn.

    What is `chosen` at each position, as a scale, may be another one though the report has the same.
    """
    if len(values) == 1:
        return (0,)
    turns = np.reshape(values, (-1, count)) if len(values) > count else np.empty((0, count))
    repeats = not chosen and len(turns) > 0 and np.allclose(turns, turns[0], rtol=1e-9, atol=1e-12, equal_nan=True)
    asked = ((k - 1) % count + 1 if repeats else k for k in worked)
    return tuple(dict.fromkeys(k for k in asked if np.isfinite(values[k - 1])))


def _sense(family: Family, value: float, words: Mapping[str, str]) -> str:
    """The sense of a rotation in words; "" for any other quantity."""
    if not family.is_signed_rotation:
        return ""
    return words["none"] if value == 0 else words["anticlockwise"] if value > 0 else words["clockwise"]
