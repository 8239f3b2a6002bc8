"""The input and the results of marking: a submission (`Submission`), and the verdicts on its cells (`Marking`)."""

from __future__ import annotations

from collections.abc import Container, Iterable, Mapping
from enum import StrEnum

from reportgen.base.errors import Location, Problem
from reportgen.base.records import Record, field
from reportgen.case.answer_key import Key
from reportgen.document import Inlines

Place = tuple[str, int]
"""A quantity's id and a position from 1; 0 for a quantity that is the same at all positions."""


class Answer(Record):
    """A student's value of one cell in the row's printed unit, with its location."""

    value: float
    text: str
    location: Location


class ReadOff(Record):
    """The reading of a length or a direction from a drawing that is `times` as large as the report's.

    A length is given as the report draws it. `error` is its largest error. `own` is the value of the plan that was
    found, which may be drawn from the student's own values. Both are in the printed unit.
    """

    times: float
    error: float
    own: float


class Submission(Record):
    """A filled answer sheet: its values by place; cells that could not be read are `problems`.

    `notes` are other findings: rows and positions that the assignment does not ask for, values of formulas, numbers
    with two possible readings. `rows` are the ids of all its rows, filled in or not.

    If the student submitted `own_files` (a report or a drawing in place of a sheet), `unread` are the entries that
    could not be read with certainty. They are not wrong, and earn no points until somebody settles them. For a drawing,
    `measured` says how each value was read, and `drawn` are the places that the drawing must show.
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
    """Places that a report mentions only in hidden text, which is not read."""
    of_parts: Mapping[str, float] = field(default_factory=dict)
    """For the machine of a coursework: the student's own lengths (SI) from other parts, by the ids of these lengths."""
    fingerprint: str = ""
    """For a sheet prefilled from such files: the fingerprint of its content when it was written."""

    @property
    def share_read(self) -> float:
        """Share of the entries of the student's own files that was read; 0 if nothing was recognised.

        For a sheet it is 1.
        """
        if not self.own_files:
            return 1.0
        count = len(self.values) + len(self.unread)
        return len(self.values) / count if count else 0.0

    def problem(self, place: Place) -> Problem:
        """Return the reason why the value of a place was not read; raise `KeyError` if it was read."""
        return self.problems[place] if place in self.problems else self.unread[place]

    @property
    def is_unrecognised(self) -> bool:
        """True if no value was recognised in the student's own files."""
        return self.own_files and not self.values and not self.unread


class Verdict(StrEnum):
    """The judgement of one cell."""

    right = "right"
    follows = "follows"
    """The value is wrong, but follows from the student's own earlier values."""
    wrong = "wrong"
    blank = "blank"
    unreadable = "unreadable"
    implausible = "implausible"
    """The value follows, or is right by chance, but its points were deducted for a reason that the marking lists."""
    unread = "unread"
    """The own file has an entry that could not be read with certainty; it earns no points until it is settled."""


OPEN = frozenset({Verdict.unreadable, Verdict.unread})
"""Verdicts on entries that may be right or wrong, because they could not be read."""


class SheetValues(Record):
    """The values of one cell in the units of the sheet; lengths are as drawn at the student's own scale."""

    given: float | None
    expected: float
    own: float
    band: float

    def equals(self, value: float, band: float) -> bool:
        """Return True if the given value is within a band of another one."""
        return self.given is not None and abs(self.given - value) <= band


class Marked(Record):
    """The verdict on one cell; values are in SI, lengths on paper at the report's scale.

    `given` is the student's value, `expected` the key's, `own` the value that the student's earlier values give, `band`
    the tolerance.

    `first` is True if the value is wrong and depends on no wrong value. `mistake` names the mistake (a key of
    `mistakes` in `words.yaml`), `where` is the id of the quantity in which it was made. The cell earned `points` of
    `worth`. `classmates` are ids of assignments whose sheet or key has this value in a run of such values. `elsewhere`
    is True if the value is right but differs from what the student's own other values give. `corrected` is the reason
    of an instructor's correction. `exchanged` is the position that was exchanged with its own, if that is the mistake.
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
    """Value (SI) of one unit of the sheet."""
    written: float | None = None
    """The number in the cell, in that unit."""

    @property
    def on_sheet(self) -> SheetValues:
        """The values in the units of the sheet, for readers and for searches that work on the sheet alone."""
        return SheetValues(self.written, self.expected / self.unit, self.own / self.unit, self.band / self.unit)

    def exchanged_labels(self, key: Key) -> dict[str, str]:
        """Return the labels of the two exchanged positions, in order."""
        first, second = sorted((self.position, self.exchanged))
        return {"first": key.label(first, self.id), "second": key.label(second, self.id)}


Cells = Mapping[Place, Marked]


def points_of(cells: Iterable[Marked]) -> tuple[float, float]:
    """Return the points that cells earned and the points that they are worth, also for cells that are not settled."""
    earned = [(cell.points, cell.worth) for cell in cells]
    return sum(points for points, _ in earned), sum(worth for _, worth in earned)


class Notice(Record):
    """A finding for the instructor: a `kind` (a key of `warnings` in words) and the places that show it.

    `spoiled` are places whose marks the policy may deduct for it, `taken` those whose marks it did deduct. `classmate`
    is the assignment that the values come from, `chance` the probability that an honest sheet shows as much, `count`
    the number of values compared.
    """

    kind: str
    places: tuple[Place, ...]
    spoiled: tuple[Place, ...] = ()
    classmate: str = ""
    chance: float = 0.0
    count: int = 0
    taken: tuple[Place, ...] = ()


class Amendment(Record):
    """An instructor's correction of some cells: their description, their places, and the reason."""

    what: Inlines
    places: frozenset[Place]
    reason: str


TAKEN = "taken"
"""Additional warning if marks were deducted."""


class Marking(Record):
    """All verdicts on a submission, in the order of the key's rows, and the findings for the instructor.

    `days_late` counts the days begun since it was due. `unwritten` lists the files for which no feedback could be
    written.
    """

    key: Key
    submission: Submission
    cells: tuple[Marked, ...]
    flags: tuple[Notice, ...] = ()
    amendments: tuple[Amendment, ...] = ()
    days_late: int = 0
    unwritten: tuple[str, ...] = ()

    def points_at(self, places: Container[Place]) -> tuple[float, float]:
        """Return the points that the cells of some places earned, and the points that they are worth."""
        return points_of(cell for cell in self.cells if (cell.id, cell.position) in places)

    @property
    def open(self) -> tuple[Marked, ...]:
        """The values that were not read; they earn no points until somebody settles them."""
        return tuple(cell for cell in self.cells if cell.verdict in OPEN and not cell.corrected)

    @property
    def elsewhere(self) -> list[Marked]:
        """The right values that do not follow from the student's own values."""
        return [cell for cell in self.cells if cell.elsewhere]

    @property
    def warnings(self) -> tuple[str, ...]:
        """Keys of `warnings` in words: each kind of flag once, and `TAKEN` if marks were deducted."""
        kinds = [flag.kind for flag in self.flags]
        return tuple(dict.fromkeys([*kinds, *([TAKEN] if any(flag.taken for flag in self.flags) else [])]))

    @property
    def points(self) -> float:
        """Points earned on the whole sheet."""
        return points_of(self.cells)[0]

    @property
    def out_of(self) -> float:
        """Points that the whole sheet is worth."""
        return points_of(self.cells)[1]

    @property
    def share(self) -> float:
        """The share of the points that was earned; 0 if there are none."""
        return self.points / self.out_of if self.out_of else 0.0

    @property
    def first_errors(self) -> tuple[Marked, ...]:
        """The first wrong value of each chain."""
        return tuple(cell for cell in self.cells if cell.first)


class Unmarked(Record):
    """A student without marks, with the reasons; these are empty if nothing was submitted.

    `unsettled` is a submission of which a smaller share was read than the policy requires.
    """

    key: Key
    reasons: tuple[str, ...] = ()
    unsettled: Submission | None = None
