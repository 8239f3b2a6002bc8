"""What marking reads and what it finds: the policy, a submission, and a verdict on each of its cells."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Annotated

from pydantic import Field

from reportgen.answers.asking import Ask
from reportgen.answers.bands import DIGITS, PAPER_ERROR
from reportgen.assignment.common import Part
from reportgen.assignment.fields import Decimal, Interval, Text, Whole, quantity
from reportgen.assignment.fields import Flag as TrueOrFalse
from reportgen.assignment.reading import read_model
from reportgen.document.key import Key
from reportgen.errors import Mark, Problem
from reportgen.notation.numbers import Language
from reportgen.units import Given

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
class Flag:
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
    flags: tuple[Flag, ...] = ()

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
    ask: Annotated[tuple[Annotated[str, Text()], ...], Field(min_length=1)] = Ask().patterns
    by_section: Annotated[bool, TrueOrFalse()] = False
    tolerance: _Tolerance = _Tolerance()
    points: _Points = _Points()
    weights: dict[str, Annotated[float, Decimal(Interval(least=0, most=1000))]] = {}  # noqa: RUF012
    mark: _Mark = _Mark()
    guard: Annotated[bool, TrueOrFalse()] = True
    take: dict[str, Annotated[bool, TrueOrFalse()]] = {}  # noqa: RUF012
    overrule: dict[str, Annotated[str, Text()]] = {}  # noqa: RUF012
    show_answers: Annotated[bool, TrueOrFalse()] = True


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
    )
