"""Which variant each student gets: from SHA-256 alone, the same on any machine and in any version.

The value of one parameter is choice number d mod n of its n choices in the order of the spec, where d is the
SHA-256, read as one big-endian number, of the UTF-8 text

    reportgen-draw/1 ␀ ASSIGNMENT ␀ SALT ␀ STUDENT ␀ PARAMETER ␀ ATTEMPT

in which ␀ is one NUL character and nothing stands around it; ASSIGNMENT is the stem of the spec's file, SALT its
`salt` (without one its `variant`), STUDENT the id (NFC), PARAMETER the path ("parameters.H"; "variants" for the
row of a table; "scan" see below) and ATTEMPT a decimal number from 0.

A combination that fails, or that another student has, is drawn again with the next attempt.  Students draw in the
order of the roster, so a clash moves only the later of two, and whoever is added at the end moves nobody.  After
`ATTEMPTS` the combinations are walked through from number d mod (their number) on, PARAMETER "scan" and ATTEMPT 0:
the first that nobody has, else of those that fewest have the first.  So nobody shares before all usable
combinations are out (of more than `MOST_WALKED`, before as many have been looked at), and then all are shared alike.
"""

from __future__ import annotations

import hashlib
import unicodedata
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field

from reportgen.assignment import Fault
from reportgen.assignment.faults import Where
from reportgen.assignment.source import Scalar
from reportgen.batch.nodes import path_text
from reportgen.batch.roster import Roster, Student
from reportgen.batch.spec import DRAWN_SECTIONS, Settings, Spec, place

ATTEMPTS = 64
MOST_WALKED = 4096
MOST_REASONS = 3
FORMAT = "reportgen-draw/1"

Trial = Callable[[Settings], tuple[Fault, ...]]
"""What is wrong with the assignment of some values; nothing if it is usable."""
Combination = tuple[int, ...]
Key = frozenset[tuple[str, str]]


@dataclass(frozen=True, slots=True)
class Drawn:
    """A student's values: of the combination drawn, and over them those of the roster.

    `overridden` are the places that the roster sets.
    """

    student: Student
    combination: Combination
    settings: Settings
    overridden: Settings


@dataclass(frozen=True, slots=True)
class Draw:
    """The class's variants in the order of the roster, or what made it impossible.

    `usable` is the number of usable variants where all of them are out and some are shared, else None.
    """

    drawn: tuple[Drawn, ...]
    faults: tuple[Fault, ...] = ()
    usable: int | None = None


def pick(assignment: str, salt: str, student: str, parameter: str, attempt: int, count: int) -> int:
    """The index, 0…`count` − 1, that a student draws."""
    text = "\0".join((FORMAT, assignment, salt, unicodedata.normalize("NFC", student), parameter, str(attempt)))
    return int.from_bytes(hashlib.sha256(text.encode()).digest(), "big") % count


def draw(spec: Spec, roster: Roster, trial: Trial) -> Draw:
    """Draw for the whole class; `trial` judges an assignment with given values."""
    return _Hat(spec, trial).draw(roster)


@dataclass
class _Hat:
    """Where variants are drawn from: what is out already, and how each was judged."""

    spec: Spec
    trial: Trial
    out: Counter[Key] = field(default_factory=Counter)
    judged: dict[Key, tuple[Fault, ...]] = field(default_factory=dict)

    def draw(self, roster: Roster) -> Draw:
        drawn: list[Drawn] = []
        faults: list[Fault] = []
        for student in roster.students:
            one = self._for(student)
            if one is not None:
                drawn.append(one)
                self.out[_key(one.settings)] += 1
            elif student.overrides:
                faults += self._blamed(student)
            else:
                # What one student cannot get nobody can.
                return Draw((), tuple(self._hopeless(student)))
        shared = any(count > 1 for count in self.out.values())
        return Draw(tuple(drawn), tuple(faults), len(self.out) if shared else None)

    def _for(self, student: Student) -> Drawn | None:
        overridden = self._overridden(student)
        for combination in self._attempts(student):
            settings = {**self.spec.settings(combination), **overridden}
            if not self.out[_key(settings)] and not self._judge(settings):
                return Drawn(student, combination, settings, overridden)
        found: Drawn | None = None
        fewest = 0
        for combination in self._walk(student):
            settings = {**self.spec.settings(combination), **overridden}
            if self._judge(settings):
                continue
            count = self.out[_key(settings)]
            if found is None or count < fewest:
                found, fewest = Drawn(student, combination, settings, overridden), count
            if not count:
                break
        return found

    def _attempts(self, student: Student) -> Iterator[Combination]:
        spec = self.spec
        for attempt in range(ATTEMPTS):
            yield tuple(
                pick(spec.name, spec.salt, student.id, axis.name, attempt, len(axis.choices)) for axis in spec.axes
            )

    def _walk(self, student: Student) -> Iterator[Combination]:
        spec = self.spec
        start = pick(spec.name, spec.salt, student.id, "scan", 0, spec.size)
        for step in range(min(spec.size, MOST_WALKED)):
            yield spec.combination((start + step) % spec.size)

    def _overridden(self, student: Student) -> dict[Where, Scalar]:
        return {place(self.spec.kind, name): value for name, value in student.overrides.items()}

    def _judge(self, settings: Settings) -> tuple[Fault, ...]:
        key = _key(settings)
        if key not in self.judged:
            self.judged[key] = self.trial(settings)
        return self.judged[key]

    def _reasons(self, student: Student) -> list[Fault]:
        """Why the first combinations fail."""
        overridden = self._overridden(student)
        told: dict[tuple[str, str], Fault] = {}
        for combination in self._attempts(student):
            for fault in self._judge({**self.spec.settings(combination), **overridden}):
                told.setdefault((fault.code, str(fault.mark)), fault)
            if len(told) >= MOST_REASONS:
                break
        return list(told.values())[:MOST_REASONS]

    def _blamed(self, student: Student) -> list[Fault]:
        """The reasons, at the cells of the student's own values: one in the spec becomes one of the first cell."""
        cells = [value.mark for value in student.overrides.values()]
        reasons = self._reasons(student)
        own = [fault for fault in reasons if fault.mark in cells]
        return own or [Fault(fault.code, cells[0], fault.arguments) for fault in reasons[:1]]

    def _hopeless(self, student: Student) -> list[Fault]:
        entry = self.spec.top.find("parameters")
        mark = entry[0].mark if entry else self.spec.top.mark
        tried = str(min(self.spec.size, MOST_WALKED))
        return [Fault("no-variant", mark, {"count": tried, "size": str(self.spec.size)}), *self._reasons(student)]


def _key(settings: Settings) -> Key:
    """What makes two variants the same: equal texts at equal places, but for what the cover says."""
    drawn = ((where, value) for where, value in settings.items() if where[0] in DRAWN_SECTIONS)
    return frozenset((path_text(where), value.text.strip()) for where, value in drawn)


def shared(drawn: Iterable[Drawn]) -> list[tuple[Drawn, ...]]:
    """Students with the same variant, together."""
    groups: dict[Key, list[Drawn]] = {}
    for one in drawn:
        groups.setdefault(_key(one.settings), []).append(one)
    return [tuple(group) for group in groups.values() if len(group) > 1]
