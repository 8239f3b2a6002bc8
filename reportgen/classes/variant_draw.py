"""Draw each student's variant, from SHA-256 alone, so that the result is the same on any machine and in any version.

The value of one parameter is choice number d mod n of its n choices in the order of the spec. d is the SHA-256, read as
one big-endian number, of the UTF-8 text

reportgen-draw/1 ␀ ASSIGNMENT ␀ SALT ␀ STUDENT ␀ PARAMETER ␀ ATTEMPT

in which ␀ is one NUL character without spaces around it. ASSIGNMENT is the stem of the spec's file, SALT its `salt` (or
else its `variant`), STUDENT the id (NFC), and PARAMETER the path ("parameters.H"; "variants" for the row of a table;
"scan" see below). ATTEMPT is a decimal number from 0.

A combination that fails, or that another student has, is drawn again with the next attempt. Students draw in the order
of the roster, so a clash changes only the later one, and a student added at the end changes nobody. After `ATTEMPTS`
attempts the combinations are tried in order from number d mod (their number), with PARAMETER "scan" and ATTEMPT 0. The
first unused one is taken, else the first of those used least. So nobody shares a variant before all usable combinations
are taken (with more than `MOST_TRIED`, before that many have been tried). Then all are shared evenly.
"""

from __future__ import annotations

import hashlib
import unicodedata
from collections import Counter
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from itertools import chain

from reportgen import catalogue
from reportgen.assignment.common import PARTS
from reportgen.base.errors import Fault
from reportgen.base.records import Record
from reportgen.base.yaml_values import path_text
from reportgen.cases import opened
from reportgen.classes.roster import Roster, RosterEntry, comparable
from reportgen.classes.variant_spec import DRAWN_SECTIONS, Settings, Spec, place

ATTEMPTS = 64
MOST_TRIED = 4096
MOST_REASONS = 3
FORMAT = "reportgen-draw/1"

FindFaults = Callable[[Settings], tuple[Fault, ...]]
"""Returns the faults of an assignment with some values; () if it is usable."""
Combination = tuple[int, ...]
Key = frozenset[tuple[str, str]]


class DrawnVariant(Record):
    """A student's values: those of the drawn combination, overridden by those of the roster."""

    student: RosterEntry
    combination: Combination
    settings: Settings


def pick(assignment: str, salt: str, student: str, parameter: str, attempt: int, count: int) -> int:
    """Return the index, 0…`count` − 1, that a student draws."""
    text = "\0".join((FORMAT, assignment, salt, unicodedata.normalize("NFC", student), parameter, str(attempt)))
    return int.from_bytes(hashlib.sha256(text.encode()).digest(), "big") % count


@dataclass(slots=True)
class Draw:
    """A draw in progress: the uses and the faults of each variant, and the faults that make the draw impossible."""

    spec: Spec
    judge: FindFaults
    taken: Counter[Key] = field(default_factory=Counter)
    judged: dict[Key, tuple[Fault, ...]] = field(default_factory=dict)
    keys: dict[Combination, Key] = field(default_factory=dict)
    faults: list[Fault] = field(default_factory=list)

    def each(
        self, roster: Roster, redrawn: Mapping[str, int] | None = None, anew: Collection[str] = ()
    ) -> Iterator[DrawnVariant]:
        """Yield the students' variants in the order of the roster; none counts if there are `faults` in the end.

        `redrawn` gives the numbers, from 1, of variants that were redrawn before, by `comparable` id. Students in
        `anew` get a variant that they have not had. The first variants stay taken, so that the others keep theirs.
        """
        stated = {comparable(student.id): student for student in roster.students}
        kept: dict[str, Combination] = {}
        for id, number in (redrawn or {}).items():
            if id in stated and 0 < number <= self.spec.size:
                combination = self.spec.combination(number - 1)
                if not self._faults(stated[id], combination):
                    kept[id] = combination
                    self.taken[self._key(stated[id], combination)] += 1
        if not kept and not anew:
            yield from self._first(roster)
            return
        for variant in list(self._first(roster)):
            id = comparable(variant.student.id)
            if id in anew:
                yield from self._anew(variant, kept.get(id, variant.combination))
            else:
                yield self._drawn(variant.student, kept[id]) if id in kept else variant

    def _anew(self, first: DrawnVariant, current: Combination) -> Iterator[DrawnVariant]:
        """Yield another variant of a student than the first and the current one, used by as few others as possible."""
        student, spec = first.student, self.spec
        had = {self._key(student, first.combination), self._key(student, current)}
        further = (
            tuple(
                pick(spec.name, spec.salt, student.id, axis.name, ATTEMPTS + k, len(axis.choices)) for axis in spec.axes
            )
            for k in range(ATTEMPTS)
        )
        chosen: Combination | None = None
        fewest = 0
        for combination in chain(further, self._in_order(student)):
            key = self._key(student, combination)
            if key in had or self._faults(student, combination):
                continue
            if chosen is None or self.taken[key] < fewest:
                chosen, fewest = combination, self.taken[key]
            if not fewest:
                break
        if chosen is None:
            self.faults.append(Fault("no-other-variant", student.location, {"text": student.id}))
            return
        self.taken[self._key(student, chosen)] += 1
        yield self._drawn(student, chosen)

    def _first(self, roster: Roster) -> Iterator[DrawnVariant]:
        """Yield the first draw of each student, in the order of the roster."""
        for student in roster.students:
            variant = self._draw_for(student)
            if variant is not None:
                self.taken[self._key(student, variant.combination)] += 1
                yield variant
            elif student.overrides:
                self.faults += self._faults_of_roster(student)
            else:
                # No combination is usable, so no other student could get one either.
                tried = {"count": str(min(self.spec.size, MOST_TRIED)), "size": str(self.spec.size)}
                self.faults = [Fault("no-variant", self.spec.location, tried), *self._reasons(student)]
                return

    @property
    def usable(self) -> int | None:
        """The number of usable variants if all of them are taken and some are shared, else None."""
        return len(self.taken) if any(count > 1 for count in self.taken.values()) else None

    def _draw_for(self, student: RosterEntry) -> DrawnVariant | None:
        for combination in self._attempts(student):
            if not self.taken[self._key(student, combination)] and not self._faults(student, combination):
                return self._drawn(student, combination)
        chosen: Combination | None = None
        fewest = 0
        for combination in self._in_order(student):
            if self._faults(student, combination):
                continue
            count = self.taken[self._key(student, combination)]
            if chosen is None or count < fewest:
                chosen, fewest = combination, count
            if not count:
                break
        return None if chosen is None else self._drawn(student, chosen)

    def _drawn(self, student: RosterEntry, combination: Combination) -> DrawnVariant:
        return DrawnVariant(student, combination, self._settings(student, combination))

    def _attempts(self, student: RosterEntry) -> Iterator[Combination]:
        spec = self.spec
        for attempt in range(ATTEMPTS):
            yield tuple(
                pick(spec.name, spec.salt, student.id, axis.name, attempt, len(axis.choices)) for axis in spec.axes
            )

    def _in_order(self, student: RosterEntry) -> Iterator[Combination]:
        spec, size = self.spec, self.spec.size
        start = pick(spec.name, spec.salt, student.id, "scan", 0, size)
        for step in range(min(size, MOST_TRIED)):
            yield spec.combination((start + step) % size)

    def _settings(self, student: RosterEntry, combination: Combination) -> Settings:
        overridden = {place(self.spec.kind, name): value for name, value in student.overrides.items()}
        return {**self.spec.settings(combination), **overridden}

    def _key(self, student: RosterEntry, combination: Combination) -> Key:
        """Return the key of a variant; for a student without overrides it is computed once per combination."""
        if student.overrides:
            return _key(self._settings(student, combination))
        if combination not in self.keys:
            self.keys[combination] = _key(self._settings(student, combination))
        return self.keys[combination]

    def _faults(self, student: RosterEntry, combination: Combination) -> tuple[Fault, ...]:
        key = self._key(student, combination)
        if key not in self.judged:
            self.judged[key] = self.judge(self._settings(student, combination))
        return self.judged[key]

    def _reasons(self, student: RosterEntry) -> list[Fault]:
        """Return the reasons why the first combinations fail."""
        reasons: dict[tuple[str, str], Fault] = {}
        for combination in self._attempts(student):
            for fault in self._faults(student, combination):
                reasons.setdefault((fault.code, str(fault.location)), fault)
            if len(reasons) >= MOST_REASONS:
                break
        return list(reasons.values())[:MOST_REASONS]

    def _faults_of_roster(self, student: RosterEntry) -> list[Fault]:
        """Return the reasons located at the student's own values, or else the first reason at the first of them."""
        cells = [value.location for value in student.overrides.values()]
        reasons = self._reasons(student)
        own = [fault for fault in reasons if fault.location in cells]
        return own or [Fault(fault.code, cells[0], fault.arguments) for fault in reasons[:1]]


def _key(settings: Settings) -> Key:
    """Return the identity of a variant: equal texts at equal places, ignoring the data of the cover."""
    drawn = ((where, value) for where, value in settings.items() if where[0] in (*DRAWN_SECTIONS, PARTS))
    return frozenset((path_text(where), value.text.strip()) for where, value in drawn)


def shared(drawn: Iterable[DrawnVariant]) -> list[tuple[DrawnVariant, ...]]:
    """Return groups of students with the same variant."""
    groups: dict[Key, list[DrawnVariant]] = {}
    for variant in drawn:
        groups.setdefault(_key(variant.settings), []).append(variant)
    return [tuple(group) for group in groups.values() if len(group) > 1]


def fault_finder(spec: Spec) -> FindFaults:
    """Return a function that checks variants of a spec: each must pass `check`, turn fully and have finite results."""

    def judge(settings: Settings) -> tuple[Fault, ...]:
        assignment, faults = catalogue.assess(spec.source(settings), spec.path)
        if assignment is None:
            return tuple(faults)
        code = opened(assignment).fault()
        return (Fault(code, spec.location),) if code else ()

    return judge
