"""What marking reads and what it finds: a submission, and a verdict on each of its cells."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum

from reportgen.answers.key import Key
from reportgen.errors import Mark, Problem

Place = tuple[str, int]
"""A quantity's id and a position from 1; 0 for a quantity that is the same at all positions."""


@dataclass(frozen=True, slots=True)
class Given:
    """A student's value of one cell in the row's printed unit, and where it stands."""

    value: float
    text: str
    mark: Mark


@dataclass(frozen=True)
class Submission:
    """A filled answer sheet: its values by place; cells that could not be read are `problems`.

    `notes` say what was found beside: rows and positions that the assignment does not ask for, values of
    formulas, numbers that could be read in two ways.
    """

    assignment: str
    file: str
    values: Mapping[Place, Given]
    problems: Mapping[Place, Problem]
    notes: tuple[Problem, ...] = ()


class Verdict(StrEnum):
    right = "right"
    follows = "follows"
    """Wrong, but what the student's own earlier values give."""
    wrong = "wrong"
    blank = "blank"
    unreadable = "unreadable"
    implausible = "implausible"
    """It follows, or is right by chance, in a sheet that is no work of the student's own."""


@dataclass(frozen=True, slots=True)
class Marked:
    """The verdict on one cell, in printed units.

    `expected` is the key's value, `own` what the student's earlier values give, `band` the tolerance.
    `first` says that nothing wrong stands before it.  `mistake` names what went wrong (a key of
    `mistakes` in `words.yaml`), `where` the id of the quantity in which it was made.  `points` of `worth`
    are earned.  `classmates` are ids of assignments whose key this value equals.
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


@dataclass(frozen=True)
class Marking:
    """All verdicts on a submission, in the order of the key's rows; `warnings` are keys of `warnings` in words."""

    key: Key
    submission: Submission
    cells: tuple[Marked, ...]
    warnings: tuple[str, ...] = ()

    @property
    def points(self) -> float:
        return sum(cell.points for cell in self.cells)

    @property
    def out_of(self) -> float:
        return sum(cell.worth for cell in self.cells)

    @property
    def firsts(self) -> tuple[Marked, ...]:
        """The first wrong value of each chain."""
        return tuple(cell for cell in self.cells if cell.first)
