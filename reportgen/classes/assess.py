"""A whole class marked: filled sheets in, each student's own sheet and feedback back, grades and the class page.

One sheet that cannot be read never stops the others; nobody's data goes into another's files.
"""

from __future__ import annotations

from collections.abc import Container, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import groupby
from pathlib import Path

from reportgen import api
from reportgen.api import Engine
from reportgen.base.errors import AssignmentError, Fault, Mark, Problem, ReportgenError
from reportgen.base.files import overwritten, put_files, reported, scratch
from reportgen.base.kinds import title
from reportgen.base.units import Language
from reportgen.base.words import as_problem, counted, word
from reportgen.cases import open_case
from reportgen.classes.gradebooks import Gradebook, StudentResult
from reportgen.classes.platforms import Owner, handed_in, zipped
from reportgen.classes.reading_sheets import read_sheets
from reportgen.classes.roster import RosterEntry, assignment_files, comparable, folder_name, read_roster
from reportgen.marking.feedback import feedback_book, feedback_document
from reportgen.marking.grades import class_document, grade_rows, person
from reportgen.marking.guard import Classmate
from reportgen.marking.marking import mark
from reportgen.marking.marks import Marking, Submission
from reportgen.marking.parts import check_shares
from reportgen.marking.policy import Policy
from reportgen.marking.scheme import MarkingScheme, marking_scheme
from reportgen.marking.sheet import read_submission
from reportgen.report.key import Key
from reportgen.workbook import write_csv, write_xlsx


@dataclass(frozen=True)
class Classroom:
    """The assignments of a class by the stem of their files, opened for marking (and kept) when they are needed."""

    files: Mapping[str, Path]
    policy: Policy
    language: Language | None
    people: Mapping[str, RosterEntry] = field(default_factory=dict)
    """What a roster says of the students, by the stem of their files."""
    opened: dict[str, MarkingScheme] = field(default_factory=dict)

    def scheme(self, name: str) -> MarkingScheme:
        """The marking scheme of an assignment.  Raises `KeyError` for a name that no file has."""
        stem = comparable(name)
        if stem not in self.opened:
            scheme = marking_scheme(open_case(self.files[stem], self.language), self.policy)
            known = self.people[stem].card if stem in self.people else {}
            student = {name: known[name] for name in ("name", "id", "class") if name in known}
            student |= dict(scheme.key.student)
            self.opened[stem] = replace(scheme, key=replace(scheme.key, student=student))
        return self.opened[stem]

    @cached_property
    def keys(self) -> tuple[Key, ...]:
        """The keys of all assignments that are in order."""
        keys = []
        for name in self.files:
            try:
                keys.append(self.scheme(name).key)
            except ReportgenError:
                # Nobody's sheet can come from an assignment that cannot be worked out.
                continue
        return tuple(keys)


@dataclass(frozen=True, slots=True)
class Graded:
    """What marking a class gave: markings by assignment, faults of sheets, keys of those who handed nothing in.

    `owners` are those who handed the sheets in, by assignment, where they come from a learning platform; `emails`
    are known from a roster.
    """

    markings: tuple[Marking, ...]
    problems: tuple[Problem, ...]
    missing: tuple[Key, ...]
    owners: Mapping[str, Owner] = field(default_factory=dict)
    emails: Mapping[str, str] = field(default_factory=dict)

    def results(self) -> list[StudentResult]:
        """The share of each student, with what a platform may know him or her by."""
        return [
            StudentResult(
                person(marking.key),
                frozenset(
                    one.casefold()
                    for one in (marking.key.student.get("id", marking.key.id), self.emails.get(marking.key.id))
                    if one
                ),
                self.owners[marking.key.id].number if marking.key.id in self.owners else "",
                marking.share,
            )
            for marking in self.markings
        ]


def grade(
    submissions: Sequence[Path],
    assignments: Path,
    policy: Policy,
    language: Language | None = None,
    roster: Path | None = None,
) -> Graded:
    """Mark the sheets of files, folders and downloads of a platform, with names from a roster if there is one.

    Raises `AssignmentError` if `assignments` or `roster` is at fault, or the policy asks for what there is not.
    """
    files = assignment_files(assignments, language)
    students = read_roster(roster, language).students if roster else ()
    people = {comparable(name): student for student in students for name in (student.folder, student.id)}
    room = Classroom(files, policy, language, people)
    policy.ask.check(room.keys, language)
    check_shares(policy, room.keys, language)
    sheets: dict[str, Submission] = {}
    owners: dict[str, Owner] = {}
    problems: list[Problem] = []
    faults: list[Fault] = []
    for handed, pages in read_sheets(handed_in(submissions, faults), language):
        path, owner = handed.path, handed.owner
        if isinstance(pages, list):
            problems += pages
            continue
        try:
            submission = read_submission(path, lambda name: room.scheme(name).key, language, pages)
            name = room.scheme(submission.assignment).key.student.get("name", "")
            if owner and not owner.may_be(name):
                fault = Fault("sheet-other-hands", Mark(str(path)), {"text": name, "owner": owner.name})
                problems.append(as_problem(fault, language))
                continue
            earlier = sheets.get(submission.assignment)
            if earlier is not None:
                kept, left = _preferred(Path(earlier.file), path, submission.assignment)
                fault = Fault("sheet-twice", Mark(str(left)), {"text": submission.assignment, "first": kept.name})
                problems.append(as_problem(fault, language))
                if kept != path:
                    continue
            named = _named(path, room.files)
            if named not in (None, comparable(submission.assignment)):
                about = {"named": room.files[named].stem, "text": submission.assignment}
                problems.append(as_problem(Fault("sheet-named-otherwise", Mark(str(path)), about), language))
            sheets[submission.assignment] = submission
            owners.pop(submission.assignment, None)
            if owner:
                owners[submission.assignment] = owner
        except AssignmentError as error:
            problems += error.problems
    # Whose values a sheet has, shows beside all the others.
    classmates = [Classmate(key, sheets.get(key.id)) for key in room.keys] if policy.guard else []
    markings = {name: mark(asked_of(room.scheme(name), sheet), sheet, classmates) for name, sheet in sheets.items()}
    missing = tuple(key for key in room.keys if key.id not in markings)
    order = {name: index for index, name in enumerate(room.files)}
    marked = sorted(markings.values(), key=lambda marking: order[comparable(marking.key.id)])
    problems += [as_problem(fault, language) for fault in faults]
    emails = {
        key.id: people[stem].card["email"]
        for key in room.keys
        if (stem := comparable(key.id)) in people and "email" in people[stem].card
    }
    return Graded(tuple(marked), tuple(problems), missing, owners, emails)


def asked_of(scheme: MarkingScheme, submission: Submission) -> MarkingScheme:
    """The guide with the cells that the policy asks for; what else is filled in is judged but earns no marks."""
    policy = scheme.policy
    filled = {id for id, _ in (*submission.values, *submission.problems)}
    key = policy.ask.of(scheme.key, filled)
    beyond = {row.id: 0.0 for row in key.asked if not policy.ask.wants(row)}
    return replace(scheme, key=key, policy=replace(policy, weights={**beyond, **policy.weights}))


def _named(path: Path, known: Container[str]) -> str | None:
    """The assignment that a sheet's file, or else its folder, is named after, as a `comparable` stem."""
    return next((name for name in map(comparable, (path.stem, path.parent.name)) if name in known), None)


def _preferred(first: Path, second: Path, assignment: str) -> tuple[Path, Path]:
    """Of two sheets of one assignment the one to mark and the other; a file named like the assignment wins."""
    own = [comparable(path.stem) == comparable(assignment) for path in (first, second)]
    return (second, first) if own == [False, True] else (first, second)


def files_of(graded: Graded, policy: Policy, engine: Engine, language: Language | None) -> Iterator[tuple[Path, bytes]]:
    """Every file of a graded class with its content: two for each student, two for the instructor.

    What goes back to a learning platform is also put into `feedback.zip`, under the names by which it knows its
    students.
    """
    returned: dict[str, bytes] = {}
    for marking in graded.markings:
        key = marking.key
        # As the batch names it, or the assignment's own stem.
        folder = Path(folder_name(key.student["id"]) if "id" in key.student else key.id)
        sheet = write_xlsx(feedback_book(marking, policy.show_answers))
        yield folder / "feedback.xlsx", sheet
        tree = feedback_document(marking, title(key.kind, key.language), policy.show_answers)
        page = api.typeset(tree, engine)[1]
        yield folder / "feedback.pdf", page
        if owner := graded.owners.get(key.id):
            returned |= {f"{owner.prefix}feedback.xlsx": sheet, f"{owner.prefix}feedback.pdf": page}
    if returned:
        yield Path("feedback.zip"), zipped(returned)
    if graded.markings:
        key = graded.markings[0].key
        spoken = language or key.language
        yield Path("grades.csv"), write_csv(grade_rows(graded.markings, spoken, graded.missing, policy.scale))
        named = title(key.kind, spoken)
        overview = class_document(graded.markings, named, spoken, graded.missing, policy.scale)
        yield Path("class.pdf"), api.typeset(overview, engine)[1]


def put(graded: Graded, policy: Policy, out: Path, engine: Engine, language: Language | None) -> Iterator[Path]:
    """Write every file of a graded class below `out`, those of a folder together; raises `OutputError`."""
    with reported(out), scratch(out):
        made = files_of(graded, policy, engine, language)
        for folder, files in groupby(made, key=lambda file: file[0].parent):
            yield from put_files(out / folder, {path.name: content for path, content in files})


def filled_gradebook(path: Path, out: Path) -> Path:
    """Where a platform's table goes when it is filled in: the file that was downloaded stays as it is."""
    taken = path.name == "grades.csv" or any(overwritten([out / path.name], [path]))
    return out / (f"filled-{path.name}" if taken else path.name)


def put_gradebook(
    graded: Graded, gradebook: Gradebook, policy: Policy, out: Path, language: Language | None
) -> tuple[Path, list[Problem]]:
    """Write a platform's table with the marks below `out`, under its own name, and tell whom it has no row for.

    Raises `OutputError`.
    """
    content, faults = gradebook.filled(graded.results(), policy.scale)
    (written,) = put_files(out, {filled_gradebook(gradebook.path, out).name: content})
    return written, [as_problem(fault, language) for fault in faults]


def summary(graded: Graded, language: Language | None) -> Iterator[str]:
    """A line for each student marked, and how many handed nothing in."""
    for marking in graded.markings:
        points, out_of = f"{marking.points:g}", f"{marking.out_of:g}"
        who, firsts = person(marking.key), len(marking.first_errors)
        yield word("graded", language, id=who, points=points, out_of=out_of, firsts=firsts)
    if graded.missing:
        yield counted("graded_missing", language, len(graded.missing))
