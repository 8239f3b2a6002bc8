"""What marking reads and what it finds: a submission, and a verdict on each of its cells."""

from __future__ import annotations

from collections.abc import Container, Iterable, Mapping
from dataclasses import dataclass, field
from enum import StrEnum

from reportgen.base.errors import Mark, Problem
from reportgen.case.key import Key
from reportgen.document import Inlines

Place = tuple[str, int]
"""A quantity's id and a position from 1; 0 for a quantity that is the same at all positions."""


@dataclass(frozen=True, slots=True)
class Answer:
    """A student's value of one cell in the row's printed unit, and where it stands."""

    value: float
    text: str
    mark: Mark


@dataclass(frozen=True, slots=True)
class ReadOff:
    """How a length or a direction was read off a drawing: `times` as large as the report draws it.

    A length is given as the report draws it; `error` is how far it may be off, `own` what the plan has that was found,
    which may be that of the student's own values; both in the printed unit.
    """

    times: float
    error: float
    own: float


@dataclass(frozen=True)
class Submission:
    """A filled answer sheet: its values by place; cells that could not be read are `problems`.

    `notes` say what was found beside: rows and positions that the assignment does not ask for, values of
    formulas, numbers that could be read in two ways.  `rows` are the ids of all its rows, filled in or not.

    Of the student's `own_files`, a report or a drawing in place of a sheet, `unread` is what stands there and was not
    read beyond doubt: it is not wrong, and earns nothing until somebody settles it.  Of a drawing, `measured` says how
    what it shows was read, and `drawn` are the places of which it has to show something.
    """

    assignment: str
    file: str
    values: Mapping[Place, Answer]
    problems: Mapping[Place, Problem]
    notes: tuple[Problem, ...] = ()
    rows: frozenset[str] = frozenset()
    unread: Mapping[Place, Problem] = field(default_factory=dict)
    own_files: bool = False
    measured: Mapping[Place, ReadOff] = field(default_factory=dict)
    drawn: frozenset[Place] = frozenset()
    unseen: frozenset[Place] = frozenset()
    """The places of which a report says something in text that nobody sees: it is not read."""
    fingerprint: str = ""
    """Of a sheet that was filled with what was read of such files: what it held when it was written."""

    @property
    def share_read(self) -> float:
        """The share of what stands in the student's own files that was read, 0 where nothing was recognised.

        Of a sheet it is 1.
        """
        if not self.own_files:
            return 1.0
        count = len(self.values) + len(self.unread)
        return len(self.values) / count if count else 0.0

    def problem(self, place: Place) -> Problem:
        """Why the value of a place was not read; raises `KeyError` where it was."""
        return self.problems[place] if place in self.problems else self.unread[place]

    @property
    def is_unrecognised(self) -> bool:
        """Whether nothing in the student's own files was recognised as a value."""
        return self.own_files and not self.values and not self.unread


class Verdict(StrEnum):
    right = "right"
    follows = "follows"
    """Wrong, but what the student's own earlier values give."""
    wrong = "wrong"
    blank = "blank"
    unreadable = "unreadable"
    implausible = "implausible"
    """It follows, or is right by chance, but its marks were taken for a reason that the marking lists."""
    unread = "unread"
    """It stands in the student's own file, but was not read beyond doubt: it earns nothing until it is settled."""


OPEN = frozenset({Verdict.unreadable, Verdict.unread})
"""Something stands there, and nobody knows yet whether it is right."""


@dataclass(frozen=True, slots=True)
class OnSheet:
    """What concerns one cell in the units of the sheet, lengths as they are drawn at the student's own scale."""

    given: float | None
    expected: float
    own: float
    band: float

    def equals(self, value: float, band: float) -> bool:
        """Whether a value was given that lies within a band of another."""
        return self.given is not None and abs(self.given - value) <= band


@dataclass(frozen=True, slots=True)
class Marked:
    """The verdict on one cell; values in SI, lengths on paper at the report's scale.

    `given` is the student's value, `expected` the key's, `own` what the student's earlier values give, `band` the
    tolerance.
    `first` says that it is wrong and stands on no wrong value.  `mistake` names what went wrong (a key of
    `mistakes` in `words.yaml`), `where` the id of the quantity in which it was made.  `points` of `worth`
    are earned.  `classmates` are ids of assignments whose sheet or key has this value in a run of such values.
    `elsewhere` says that it is right, but is not what the student's own values beside it give.  `corrected` is the
    reason of an instructor who judged it otherwise.  `exchanged` is the position with which its own was
    exchanged, where that is the mistake.
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
    corrected: str = ""
    exchanged: int = 0
    unit: float = 1.0
    """What one unit of the sheet stands for."""
    written: float | None = None
    """The number in the cell, in that unit."""

    @property
    def on_sheet(self) -> OnSheet:
        """The values as a sheet has them: for those who read it, and for what is found on it without working out."""
        return OnSheet(self.written, self.expected / self.unit, self.own / self.unit, self.band / self.unit)

    def exchanged_labels(self, key: Key) -> dict[str, str]:
        """What the two exchanged positions are called, in order."""
        first, second = sorted((self.position, self.exchanged))
        return {"first": key.label(first, self.id), "second": key.label(second, self.id)}


Cells = Mapping[Place, Marked]


def points_of(cells: Iterable[Marked]) -> tuple[float, float]:
    """The points that cells earned, and those that they are worth: also while nobody has settled what stands there."""
    earned = [(cell.points, cell.worth) for cell in cells]
    return sum(points for points, _ in earned), sum(worth for _, worth in earned)


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


@dataclass(frozen=True, slots=True)
class Amendment:
    """An instructor's word on some cells: what they are together, their places, and the reason."""

    what: Inlines
    places: frozenset[Place]
    reason: str


TAKEN = "taken"
"""The warning beside the others where marks were taken."""


@dataclass(frozen=True)
class Marking:
    """All verdicts on a submission, in the order of the key's rows, and what the lecturer should look at.

    `days_late` are the days begun since it was due.  `unwritten` says of which files nothing could be given back.
    """

    key: Key
    submission: Submission
    cells: tuple[Marked, ...]
    flags: tuple[Notice, ...] = ()
    amendments: tuple[Amendment, ...] = ()
    days_late: int = 0
    unwritten: tuple[str, ...] = ()

    def points_at(self, places: Container[Place]) -> tuple[float, float]:
        """The points that the cells of some places earned, and those that they are worth."""
        return points_of(cell for cell in self.cells if (cell.id, cell.position) in places)

    @property
    def open(self) -> tuple[Marked, ...]:
        """The values that were not read, and earn nothing until somebody settles them."""
        return tuple(cell for cell in self.cells if cell.verdict in OPEN and not cell.corrected)

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


@dataclass(frozen=True, slots=True)
class Unmarked:
    """A student without marks: the reasons why what was handed in is not marked, none where nothing was.

    Of `unsettled` work less was read than the policy asks for.
    """

    key: Key
    reasons: tuple[str, ...] = ()
    unsettled: Submission | None = None
