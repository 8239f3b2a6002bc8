"""Mark a whole class (`grade`): a marking for each filled sheet, and the reason for each student without one.

An unreadable sheet never stops the others, and no student's data are written into another's files.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from functools import cached_property, partial
from itertools import chain
from pathlib import Path

from reportgen.base.errors import Fault, Problem, ReportgenError
from reportgen.base.records import Record, field, replace
from reportgen.base.units import Language
from reportgen.base.words import as_problem
from reportgen.case.answer_key import Key
from reportgen.cases import open_case
from reportgen.classes.corrections import Correction, applied
from reportgen.classes.fault_isolation import isolated
from reportgen.classes.gradebooks import Gradebook, Participant, name_words
from reportgen.classes.lateness import Handing, days_late
from reportgen.classes.own_files import (
    OwnWork,
    SearchTargets,
    completed,
    own_works,
    possible_sheets,
    submissions_to_mark,
)
from reportgen.classes.platforms import Handed, Owner, handed_in
from reportgen.classes.reading_sheets import read_sheets
from reportgen.classes.roster import Roster, RosterEntry, assignment_files, comparable, read_roster
from reportgen.classes.submission_matching import Collected, Refused, collect, named_after
from reportgen.handin import FileReading, submission
from reportgen.handin.drawing_file import wanted_plans
from reportgen.handin.drawing_reader import WantedPlans
from reportgen.marking.authenticity import Classmate
from reportgen.marking.class_marks import person
from reportgen.marking.coursework_marking import check_shares
from reportgen.marking.judging import following_values, mark
from reportgen.marking.marking_data import Marking, Submission, Unmarked
from reportgen.marking.marking_policy import Policy
from reportgen.marking.marking_scheme import MarkingScheme, key_asked, marking_scheme
from reportgen.marking.toleranced_key import key_of


class Classroom(Record, dict=True):
    """The assignments of a class by the stem of their files, opened for marking on demand and cached."""

    files: Mapping[str, Path]
    policy: Policy
    language: Language | None
    people: Mapping[str, RosterEntry] = field(default_factory=dict)
    """Roster entries of the students, by the stem of their files."""
    opened: dict[str, MarkingScheme] = field(default_factory=dict)

    def scheme(self, name: str) -> MarkingScheme:
        """Return the marking scheme of an assignment; raise `KeyError` for an unknown name."""
        stem = comparable(name)
        if stem not in self.opened:
            scheme = marking_scheme(open_case(self.files[stem], self.language), self.policy)
            known = self.people[stem].card if stem in self.people else {}
            student = {name: known[name] for name in ("name", "id", "class") if name in known}
            student |= dict(scheme.key.student)
            self.opened[stem] = replace(scheme, key=replace(scheme.key, student=student))
        return self.opened[stem]

    def plans(self, key: Key, readings: Sequence[FileReading]) -> WantedPlans | None:
        """Return the plans of an assignment, including those by the values read from its student's report."""
        scheme, case = self.scheme(key.id), open_case(self.files[comparable(key.id)], None)
        read = submission(readings, self.language) if readings else None
        return wanted_plans(case, scheme.key, following_values(asked_of(scheme, read), read) if read else ())

    @cached_property
    def keys(self) -> tuple[Key, ...]:
        """The keys of all valid assignments."""
        keys = []
        for name in self.files:
            try:
                keys.append(self.scheme(name).key)
            except ReportgenError:
                # No sheet can come from an assignment that cannot be computed.
                continue
        return tuple(keys)

    def handed_out(self, key: Key) -> Key:
        """Return the requested cells with the symbols of the papers, which are in the assignment's own language."""
        own = key if self.language is None else key_of(open_case(self.files[comparable(key.id)], None))
        return self.policy.ask.of(own)

    def participant(self, key: Key, owner: Owner | None = None) -> Participant:
        """Return the identification by which a platform may know the student of a key."""
        email = self.people[stem].card.get("email") if (stem := comparable(key.id)) in self.people else None
        ids = frozenset(id.casefold() for id in (key.student.get("id", key.id), email) if id)
        name = key.student.get("name", "")
        alike = [1 for words in self._names if words == name_words(name)]
        number = owner.number if owner else ""
        return Participant(person(key), ids, number, name if len(alike) == 1 else "")

    @cached_property
    def _names(self) -> tuple[tuple[str, ...], ...]:
        """The full names of all students, for comparisons."""
        return tuple(name_words(key.student.get("name", "")) for key in self.keys)


class Graded(Record):
    """The result of marking a class: markings by assignment, all problems, and the students without marks.

    `owners` are those who submitted the sheets, by assignment, if these come from a learning platform. `known` is what
    the platform's table may know each student by.
    """

    markings: tuple[Marking, ...]
    problems: tuple[Problem, ...]
    unmarked: tuple[Unmarked, ...]
    owners: Mapping[str, Owner] = field(default_factory=dict)
    known: Mapping[str, Participant] = field(default_factory=dict)
    own: Mapping[str, OwnWork] = field(default_factory=dict)
    """The students' own files that were read, by assignment."""
    kept: Mapping[str, tuple[Submission, Handed]] = field(default_factory=dict)
    """Prefilled sheets from an earlier run that nobody has changed."""

    @property
    def missing(self) -> tuple[Key, ...]:
        """The keys of students who submitted nothing."""
        return tuple(one.key for one in self.unmarked if not one.reasons and one.unsettled is None)

    @property
    def refused(self) -> tuple[Key, ...]:
        """The keys of students none of whose files could be marked."""
        return tuple(one.key for one in self.unmarked if one.reasons and one.unsettled is None)

    @property
    def unsettled(self) -> tuple[Unmarked, ...]:
        """Students whose own files were read too incompletely for a mark."""
        return tuple(one for one in self.unmarked if one.unsettled is not None)


def grade(
    submissions: Sequence[Path],
    assignments: Path,
    policy: Policy,
    language: Language | None = None,
    roster: Path | None = None,
    corrections: Iterable[Correction] = (),
    gradebook: Gradebook | None = None,
    out: Path | None = None,
) -> Graded:
    """Mark the sheets of files, folders and downloads of a platform, with names from an optional roster.

    For students without a sheet, read their own report and drawings. `corrections` override the results. The
    `gradebook` of the platform gives the submission times. `out` may contain prefilled sheets that were completed by
    hand. Raises `AssignmentError` if `assignments` or `roster` is invalid, or if the policy asks for something that
    does not exist.
    """
    files = assignment_files(assignments, language)
    listed = read_roster(roster, language) if roster else Roster(())
    students = listed.students
    people = {comparable(name): student for student in students for name in (student.folder, student.id)}
    room = Classroom(files, policy, language, people)
    policy.ask.check(room.keys, language)
    check_shares(policy, room.keys, language)
    faults: list[Fault] = []
    own: list[Handed] = []
    names = [key.student.get("name", "") for key in room.keys]
    named = (_without_hidden_name(file, gradebook) for file in handed_in(submissions, faults, names))
    came = chain(named, completed(out, submissions))
    handed = read_sheets(possible_sheets(came, own), language)
    collected = collect(handed, lambda name: room.scheme(name).key, files, policy.twice, language)
    keys = {comparable(key.id): key for key in room.keys} if own else {}
    targets = SearchTargets(room.handed_out, room.plans)
    works = own_works(own, keys, lambda file: _student_of(file, room, gradebook), targets, policy.twice, language)
    collected = submissions_to_mark(collected, works, files, language)
    sheets = {name: sheet for name, (sheet, _) in collected.sheets.items()}
    # Comparing a sheet with all others shows whose values it has.
    classmates = [Classmate(key, sheets.get(key.id)) for key in room.keys] if policy.guard else []
    markings: dict[str, Marking] = {}
    failed: dict[str, Refused] = {}
    unexpected: list[Problem] = []
    for name, (sheet, file) in collected.sheets.items():
        # If the comparison fails, which may be caused by another's sheet, this sheet is marked alone.
        for compared in (classmates, []) if classmates else ([],):
            marking = isolated(partial(_marked, room.scheme(name), sheet, compared), file.path, language)
            if not isinstance(marking, list):
                markings[name] = marking
                break
            unexpected += (problem for problem in marking if problem not in unexpected)
            failed[name] = Refused(file, tuple(marking))
    failed = {name: refused for name, refused in failed.items() if name not in markings}
    order = {name: index for index, name in enumerate(files)}
    marked = sorted(markings.values(), key=lambda marking: order[comparable(marking.key.id)])
    marked, misfits = applied(marked, room.keys, corrections, language)
    owners = collected.owners
    known = {key.id: room.participant(key, owners.get(key.id)) for key in room.keys}
    late: Sequence[Problem] = ()
    if policy.late is not None:
        days, late = days_late(policy.late, _handings(collected, known, people), gradebook, language)
        marked = [replace(marking, days_late=days.get(marking.key.id, 0)) for marking in marked]
    reasons = _reasons(collected.refused, room, gradebook)
    for name, refused in failed.items():
        reasons[name] = (*reasons.get(name, ()), *refused.reasons)
    too_little = {
        marking.key.id: marking.submission
        for marking in marked
        if marking.submission.share_read < policy.least_read or marking.submission.is_unrecognised
    }
    marked = [marking for marking in marked if marking.key.id not in too_little]
    unmarked = [
        Unmarked(key, reasons.get(key.id, ()), too_little.get(key.id))
        for key in room.keys
        if key.id not in markings or key.id in too_little
    ]
    archives = (as_problem(fault, language) for fault in faults)
    notes = [note for work in works.works.values() for note in work.notes(language)]
    problems = (*listed.notes, *collected.problems, *unexpected, *archives, *notes, *misfits, *late)
    return Graded(tuple(marked), problems, tuple(unmarked), owners, known, own=works.works, kept=collected.readings)


def _without_hidden_name(file: Handed, gradebook: Gradebook | None) -> Handed:
    """Return a file with its owner's name removed if the gradebook uses that name for everybody: "Participant"."""
    if file.owner is None or gradebook is None or file.owner.name.casefold() not in gradebook.hidden_names:
        return file
    return replace(file, owner=replace(file.owner, name=""))


def _handings(
    collected: Collected, known: Mapping[str, Participant], people: Mapping[str, RosterEntry]
) -> dict[str, Handing]:
    """Return the known submission data of each sheet."""
    handings: dict[str, Handing] = {}
    for name, (_, handed) in collected.sheets.items():
        entry = people.get(comparable(name))
        late = handed.owner is not None and handed.owner.late
        handings[name] = Handing(known[name], str(handed.path), entry.handed_in if entry else None, late)
    return handings


def _reasons(refused: Iterable[Refused], room: Classroom, gradebook: Gradebook | None) -> dict[str, tuple[str, ...]]:
    """Return the reasons why files of a student are not marked, by assignment.

    A file that cannot be assigned to one student is left out.
    """
    reasons: dict[str, tuple[str, ...]] = {}
    for file in refused:
        if key := _student_of(file.handed, room, gradebook):
            reasons[key.id] = (*reasons.get(key.id, ()), *file.reasons)
    return reasons


def _student_of(handed: Handed, room: Classroom, gradebook: Gradebook | None) -> Key | None:
    """Return the key of the student of a file that does not say it itself, by the platform's or the file's name."""
    if owner := handed.owner:
        names = gradebook.names(owner.number) if gradebook else frozenset()
        fitting = [key for key in room.keys if room.participant(key).ids & names]
        own = [(key, key.student.get("name", "")) for key in room.keys]
        fitting = fitting or [key for key, name in own if name and owner.name and owner.may_be(name)]
    else:
        stem = named_after(handed.path, room.files)
        fitting = [key for key in room.keys if comparable(key.id) == stem]
    return fitting[0] if len(fitting) == 1 else None


def _marked(scheme: MarkingScheme, sheet: Submission, classmates: Sequence[Classmate]) -> Marking:
    """Return the marking of one student's sheet for the cells that it is asked for."""
    return mark(asked_of(scheme, sheet), sheet, classmates)


def asked_of(scheme: MarkingScheme, submission: Submission) -> MarkingScheme:
    """Return the scheme with the cells that the policy asks for; other filled cells are judged but earn no marks."""
    policy = scheme.policy
    key, asked = key_asked(policy, scheme.key, submission)
    beyond = {row.id: 0.0 for row in key.asked if row.id not in asked}
    return replace(scheme, key=key, policy=replace(policy, weights={**beyond, **policy.weights}))
