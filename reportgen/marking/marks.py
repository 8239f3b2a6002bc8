"""What marking reads and what it finds: the policy, a submission, and a verdict on each of its cells."""

from __future__ import annotations

import math
from collections.abc import Container, Iterable, Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from fnmatch import fnmatchcase
from functools import cached_property
from pathlib import Path
from typing import Annotated

import numpy as np
from pydantic import Field

from reportgen.assignment.common import Part
from reportgen.assignment.fields import Decimal, Flag, Interval, TypedText, Whole, quantity
from reportgen.assignment.reading import read_model
from reportgen.base.errors import Mark, Problem
from reportgen.base.units import Given, Language
from reportgen.formula import Product, Ref, vocabulary
from reportgen.formula.ledger import Ledger, standing_on
from reportgen.marking.bands import DIGITS, PAPER_ERROR, computed_bands, drawn_bands, is_chosen_length, is_direction
from reportgen.marking.key import Ask, key_of
from reportgen.report.case import Case, Misconceptions
from reportgen.report.key import Key, KeyRow, Role

Place = tuple[str, int]
"""A quantity's id and a position from 1; 0 for a quantity that is the same at all positions."""


@dataclass(frozen=True, slots=True)
class Answer:
    """A student's value of one cell in the row's printed unit, and where it stands."""

    value: float
    text: str
    mark: Mark


@dataclass(frozen=True)
class Submission:
    """A filled answer sheet: its values by place; cells that could not be read are `problems`.

    `notes` say what was found beside: rows and positions that the assignment does not ask for, values of
    formulas, numbers that could be read in two ways.  `rows` are the ids of all its rows, filled in or not.
    """

    assignment: str
    file: str
    values: Mapping[Place, Answer]
    problems: Mapping[Place, Problem]
    notes: tuple[Problem, ...] = ()
    rows: frozenset[str] = frozenset()


class Verdict(StrEnum):
    right = "right"
    follows = "follows"
    """Wrong, but what the student's own earlier values give."""
    wrong = "wrong"
    blank = "blank"
    unreadable = "unreadable"
    implausible = "implausible"
    """It follows, or is right by chance, but its marks were taken for a reason that the marking lists."""


@dataclass(frozen=True, slots=True)
class Marked:
    """The verdict on one cell, in printed units.

    `expected` is the key's value, `own` what the student's earlier values give, `band` the tolerance.
    `first` says that it is wrong and stands on no wrong value.  `mistake` names what went wrong (a key of
    `mistakes` in `words.yaml`), `where` the id of the quantity in which it was made.  `points` of `worth`
    are earned.  `classmates` are ids of assignments whose sheet or key has this value in a run of such values.
    `elsewhere` says that it is right, but is not what the student's own values beside it give.
    """

    id: str
    position: int
    verdict: Verdict
    given: float | None
    expected: float
    own: float
    band: float
    points: float
    worth: float
    first: bool = False
    mistake: str = ""
    where: str = ""
    classmates: tuple[str, ...] = ()
    elsewhere: bool = False

    def equals(self, value: float, band: float) -> bool:
        """Whether a value was given that lies within a band of another."""
        return self.given is not None and abs(self.given - value) <= band


Cells = Mapping[Place, Marked]


def points_of(cells: Iterable[Marked]) -> tuple[float, float]:
    """The points that cells earned, and those that they are worth."""
    found = [(cell.points, cell.worth) for cell in cells]
    return sum(points for points, _ in found), sum(worth for _, worth in found)


@dataclass(frozen=True, slots=True)
class Notice:
    """Something that the lecturer should look at: a `kind` (a key of `warnings` in words) and the places that show it.

    `spoiled` are places whose marks the policy may take for it, `taken` those where it did.  `other` is the assignment
    that the values are of, `chance` that an honest sheet would show as much; `count` the values that were compared.
    """

    kind: str
    places: tuple[Place, ...]
    spoiled: tuple[Place, ...] = ()
    other: str = ""
    chance: float = 0.0
    count: int = 0
    taken: tuple[Place, ...] = ()


TAKEN = "taken"
"""The warning beside the others where marks were taken."""


@dataclass(frozen=True)
class Marking:
    """All verdicts on a submission, in the order of the key's rows, and what the lecturer should look at."""

    key: Key
    submission: Submission
    cells: tuple[Marked, ...]
    flags: tuple[Notice, ...] = ()

    @property
    def elsewhere(self) -> list[Marked]:
        """The right values that are not from the student's own."""
        return [cell for cell in self.cells if cell.elsewhere]

    @property
    def warnings(self) -> tuple[str, ...]:
        """Keys of `warnings` in words: each kind of flag once, and whether marks were taken."""
        kinds = [flag.kind for flag in self.flags]
        return tuple(dict.fromkeys([*kinds, *([TAKEN] if any(flag.taken for flag in self.flags) else [])]))

    @property
    def points(self) -> float:
        return points_of(self.cells)[0]

    @property
    def out_of(self) -> float:
        return points_of(self.cells)[1]

    @property
    def share(self) -> float:
        """The share of the points that was earned, 0 where there are none."""
        return self.points / self.out_of if self.out_of else 0.0

    @property
    def first_errors(self) -> tuple[Marked, ...]:
        """The first wrong value of each chain."""
        return tuple(cell for cell in self.cells if cell.first)


# --- the policy -----------------------------------------------------------------------------------

TAKES = frozenset({"stock", "columns", "other-data", "classmate-sheet"})
"""Kinds of flags that cost marks unless the policy says otherwise: what is beyond doubt."""
FLAGS_ONLY = frozenset({"constant", "classmate"})
"""Kinds that are told and cost nothing unless the policy says so."""


@dataclass(frozen=True, slots=True)
class Scale:
    """How the mark of a sheet is told: the highest one, and the step to which marks are rounded."""

    highest: float = 10.0
    step: float = 0.1

    def mark(self, share: float) -> float:
        """The mark for a share of the points; half a step is rounded up."""
        # 1e-9: a share such as 0.85 is a little off as a float.
        return round(math.floor(share * self.highest / self.step + 0.5 + 1e-9) * self.step, 6)


@dataclass(frozen=True, slots=True)
class Policy:
    """What the sheet asks for, tolerances (`paper` in m), points and the mark; `weights` by patterns of ids.

    `take` says which kinds of flags cost marks, `overrule` gives the reason why a sheet keeps its marks in any case.
    """

    paper: float = PAPER_ERROR
    digits: int = DIGITS
    share: float = 0.005
    right: float = 1.0
    follows: float = 1.0
    weights: Mapping[str, float] = field(default_factory=dict)
    guard: bool = True
    show_answers: bool = True
    take: Mapping[str, bool] = field(default_factory=dict)
    overrule: Mapping[str, str] = field(default_factory=dict)
    ask: Ask = field(default_factory=Ask)
    scale: Scale = field(default_factory=Scale)
    parts: Mapping[str, float] = field(default_factory=dict)
    """The shares of the parts of a coursework, by name; without them each value counts alike."""
    file: Path | None = None

    def takes(self, kind: str, assignment: str) -> bool:
        """Whether a kind of flag costs marks on the sheet of an assignment."""
        return assignment not in self.overrule and self.take.get(kind, kind in TAKES)

    def worth(self, id: str) -> float:
        """The points that a quantity is worth at one position."""
        return next((weight for pattern, weight in self.weights.items() if fnmatchcase(id, pattern)), 1.0)


class _Tolerance(Part):
    paper: Annotated[Given | None, quantity("mm", least=0, most=5)] = None
    digits: Annotated[int, Whole(2, 6)] = DIGITS
    share: Annotated[float, Decimal(Interval(least=0, most=0.2))] = 0.005


class _Points(Part):
    right: Annotated[float, Decimal(Interval(least=0, most=100))] = 1.0
    follows: Annotated[float, Decimal(Interval(least=0, most=100))] = 1.0


class _Mark(Part):
    highest: Annotated[float, Decimal(Interval(above=0, most=1000))] = Scale().highest
    step: Annotated[float, Decimal(Interval(above=0, most=100))] = Scale().step


class _PolicyFile(Part):
    ask: Annotated[tuple[Annotated[str, TypedText()], ...], Field(min_length=1)] = Ask().patterns
    by_section: Annotated[bool, Flag()] = False
    tolerance: _Tolerance = _Tolerance()
    points: _Points = _Points()
    weights: dict[str, Annotated[float, Decimal(Interval(least=0, most=1000))]] = {}  # noqa: RUF012
    mark: _Mark = _Mark()
    guard: Annotated[bool, Flag()] = True
    take: dict[str, Annotated[bool, Flag()]] = {}  # noqa: RUF012
    overrule: dict[str, Annotated[str, TypedText()]] = {}  # noqa: RUF012
    show_answers: Annotated[bool, Flag()] = True
    parts: dict[str, Annotated[float, Decimal(Interval(least=0, most=1000))]] = {}  # noqa: RUF012


def read_policy(path: Path, language: Language | None = None) -> Policy:
    """The policy of a YAML file; raises `AssignmentError` with all its faults, located.

    ask: ["*", "-seg.*"]     # sections and ids of the answer sheet; "-" leaves out, the last that fits decides
    by_section: false        # each section of the printed sheet on pages of its own
    tolerance:
      paper: 0.5 mm          # how far off each end of a measured length may lie
      digits: 3              # figures that values are computed with
      share: 0.005           # of the quantity's maximum within a quarter turn
    points: {right: 1, follows: 1}
    weights:                 # by id of the quantity, the first pattern that fits; 0: not marked
      "seg.*": 0.5
      "M.eq": 5
    mark: {highest: 10, step: 0.1}
    guard: true              # sheets that are not the student's own work are told
    take:                    # by kind of what is told: whether it costs marks
      other-data: false
    overrule:                # sheets that keep their marks, and why
      K225520103023: has shown the drawings
    show_answers: true       # the feedback tells the right values
    parts:                   # what each part of a coursework counts; else as many points as values are asked for
      machine: 6
      cam: 4
    """
    content = read_model(path, _PolicyFile, language)
    tolerance, points = content.tolerance, content.points
    return Policy(
        paper=PAPER_ERROR if tolerance.paper is None else tolerance.paper.si,
        digits=tolerance.digits,
        share=tolerance.share,
        right=points.right,
        follows=points.follows,
        weights=content.weights,
        guard=content.guard,
        show_answers=content.show_answers,
        take=content.take,
        overrule=content.overrule,
        ask=Ask(content.ask, content.by_section, path if "ask" in content.model_fields_set else None),
        scale=Scale(content.mark.highest, content.mark.step),
        parts=content.parts,
        file=path,
    )


# --- one assignment opened for marking ------------------------------------------------------------
# What is asked, how far off it may be, what stands on what.

Values = Mapping[str, np.ndarray]
"""Values (SI) by id, [N] or [1]."""

ALMOST = 1e-12
"""Room for rounding in a comparison with a band."""


@dataclass(frozen=True)
class MarkingScheme:
    """An assignment opened for marking."""

    key: Key
    ledger: Ledger
    misconceptions: Misconceptions
    count: int
    """Positions of one turn."""
    policy: Policy
    parts: tuple[MarkingScheme, ...] = ()
    """Those of the parts of a coursework, each by its own ids."""

    @cached_property
    def bands(self) -> dict[str, np.ndarray]:
        """The tolerances (SI) [N] of every row of the key.

        They are the widest of drawing, rounding and a share of the quantity's maximum within a quarter turn.
        """
        return self.bands_at({})

    @cached_property
    def _computed(self) -> dict[str, np.ndarray]:
        return computed_bands(self.ledger, self.policy.digits)

    def bands_at(self, scales: Values) -> dict[str, np.ndarray]:
        """The tolerances where plans are drawn at multiples of the report's scales."""
        policy = self.policy
        drawn, computed = drawn_bands(self.ledger, policy.paper, scales), self._computed
        return {
            row.id: np.maximum(np.maximum(drawn[row.id], computed[row.id]), policy.share * self._size_near(row.id))
            * (1 + ALMOST)
            for row in self.key.rows
        }

    def size(self, id: str) -> float:
        """The largest value of a quantity over the turn (SI); of an angle, a full turn."""
        if is_direction(id):
            return 2 * np.pi
        values = np.abs(self.ledger[id].values)
        return float(values[np.isfinite(values)].max(initial=0.0))

    def _size_near(self, id: str) -> np.ndarray:
        """The largest value of a quantity within a quarter turn of each position (SI) [N]; of an angle, a full turn.

        So the pressure of combustion makes no room in the intake stroke.
        """
        values = np.nan_to_num(np.abs(self.ledger[id].values))
        if is_direction(id) or len(values) == 1:
            return np.full(len(values), self.size(id))
        reach = min(-(-self.count // 4), len(values) // 2)
        near: np.ndarray = np.max([np.roll(values, shift) for shift in range(-reach, reach + 1)], axis=0)
        return near

    def distance(self, id: str, one: np.ndarray | float, other: np.ndarray | float) -> np.ndarray:
        """How far values (SI) lie apart: directions around the circle; what has no sense of its own by size."""
        if self.is_unsigned(id):
            one, other = np.abs(one), np.abs(other)
        return np.asarray(vocabulary.distance(id, np.asarray(one), np.asarray(other)))

    def is_unsigned(self, id: str) -> bool:
        """Whether the sign of a quantity is not judged: an arm's, or one of which the sheet leaves the sense open."""
        row = self.key.find(id)
        return self.ledger[id].arm or (row is not None and row.open_sense)

    @cached_property
    def rows(self) -> dict[str, KeyRow]:
        """The rows that a sheet may fill in."""
        return {row.id: row for row in self.key.asked}

    @cached_property
    def judged(self) -> tuple[KeyRow, ...]:
        """The rows that earn marks, in the ledger's order; how long the crank is drawn is the student's own choice."""
        order = {id: index for index, id in enumerate(self.ledger.families)}
        kept = (row for row in self.key.asked if row.kind != "segment" or row.role is not Role.scale)
        return tuple(sorted(kept, key=lambda row: order[row.id]))

    @cached_property
    def before(self) -> dict[str, tuple[str, ...]]:
        """Every quantity that a judged one stands on, nearest first."""
        return {row.id: standing_on(self.ledger, row.id) for row in self.judged}

    @cached_property
    def alike(self) -> dict[str, tuple[str, ...]]:
        """Of each judged row those before it that have its values at all positions."""
        found: dict[str, tuple[str, ...]] = {}
        for number, row in enumerate(self.judged):
            one = self.ledger[row.id]
            before = (
                other
                for other in self.judged[:number]
                if other.kind == row.kind and len(other.values) == len(row.values)
            )
            found[row.id] = tuple(
                other.id
                for other in before
                if np.allclose(one.values, self.ledger[other.id].values, rtol=1e-9, atol=0, equal_nan=True)
            )
        return found

    @cached_property
    def makers(self) -> dict[str, tuple[str, str]]:
        """Of each scale of a plan the size and the length that it was made from: v_A and pa of μ_v."""
        found: dict[str, tuple[str, str]] = {}
        for row in self.judged:
            scale = vocabulary.plan(row.id)
            if row.single and scale in self.ledger and scale not in found and makes_scale(self.ledger, row.id, scale):
                value = self.ledger[scale].values[0] * self.ledger[row.id].values[0]
                sizes = (one.id for one in self.judged if one.single and one.kind in ("velocity", "acceleration"))
                size = next((id for id in sizes if np.isclose(self.ledger[id].values[0], value, rtol=1e-9)), "")
                if size:
                    found[scale] = size, row.id
        return found

    @cached_property
    def sizes(self) -> dict[str, set[str]]:
        """The quantities that each length of a plan stands for: μ times it, and the size of the vector laid as it."""
        found: dict[str, set[str]] = {id: set() for id in self.ledger.families if vocabulary.plan(id)}
        for id, family in self.ledger.families.items():
            if isinstance(family.definition, Product) and len(family.definition.factors) == 2:
                used = [one.id for one in family.definition.factors if isinstance(one, Ref)]
                for length in used:
                    if vocabulary.plan(length) in used:
                        found[length].add(id)
            if id in found and family.of in self.ledger:
                found[id].add(self.ledger[family.of].of)
        return found

    def stands_on(self, place: Place, places: Container[Place]) -> bool:
        """Whether a value on the sheet stands on one at any of `places`."""
        id, position = place
        rows = (self.rows[before] for before in self.before[id] if before in self.rows)
        return any((row.id, self.place(row, position)) in places for row in rows)

    @cached_property
    def _repeated(self) -> dict[str, bool]:
        return {
            row.id: not row.single and max(row.positions, default=0) <= self.count < len(row.values)
            for row in self.key.rows
        }

    def repeats(self, row: KeyRow) -> bool:
        """Whether a quantity is asked for in the first turn only, because all turns are the same."""
        return self._repeated[row.id]

    def place(self, row: KeyRow, position: int) -> int:
        """The position at which the sheet asks for a quantity that one at `position` stands on."""
        if row.single:
            return 0
        return (position - 1) % self.count + 1 if self.repeats(row) else position


def marking_scheme(case: Case, policy: Policy | None = None) -> MarkingScheme:
    """The marking scheme of an assignment, computed as its report is."""
    parts = tuple(marking_scheme(one, policy) for one in case.parts.values())
    return MarkingScheme(key_of(case), case.ledger, case.misconceptions, case.span.count, policy or Policy(), parts)


def makes_scale(ledger: Ledger, id: str, scale: str) -> bool:
    """Whether a length on paper is the one that a scale was made from: the drawn crank, pa."""
    if scale == "mu.l":
        return is_chosen_length(ledger, ledger[id])
    definition = ledger[id].definition
    return isinstance(definition, Ref) and ledger[definition.id].definition is None
