"""A whole class marked: filled sheets in, each student's own sheet and feedback back, grades and the class page.

One sheet that cannot be read never stops the others; nobody's data goes into another's files.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path

from reportgen import api, catalogue
from reportgen.answers.key import Key
from reportgen.api import Engine
from reportgen.batch.roster import assignment_files, comparable, folder_name
from reportgen.errors import AssignmentError, Fault, Mark, Problem, ReportgenError
from reportgen.grading.feedback import feedback_book, feedback_document
from reportgen.grading.grades import class_document, grade_rows, person
from reportgen.grading.marking import mark
from reportgen.grading.marks import Marking, Policy, Submission
from reportgen.grading.submission import read_submission
from reportgen.grading.working import Guide, open_guide
from reportgen.notation.numbers import Language
from reportgen.words import as_problem, counted, word
from reportgen.workbook import write_csv, write_xlsx
from reportgen.workbook.reading import BOOKS

SUBMISSIONS = BOOKS | {".csv"}
"""Endings of files that may be meant as sheets; a fault is reported for those that cannot be read."""


@dataclass(frozen=True)
class Classroom:
    """The assignments of a class by the stem of their files, opened for marking (and kept) when they are needed."""

    files: Mapping[str, Path]
    policy: Policy
    language: Language | None
    opened: dict[str, Guide] = field(default_factory=dict)

    def guide(self, name: str) -> Guide:
        """The marking guide of an assignment.  Raises `KeyError` for a name that no file has."""
        stem = comparable(name)
        if stem not in self.opened:
            self.opened[stem] = open_guide(api.load(self.files[stem], self.language), self.policy)
        return self.opened[stem]

    @cached_property
    def keys(self) -> tuple[Key, ...]:
        """The keys of all assignments that are in order."""
        found = []
        for name in self.files:
            try:
                found.append(self.guide(name).key)
            except ReportgenError:
                # Nobody's sheet can come from an assignment that cannot be worked out.
                continue
        return tuple(found)


@dataclass(frozen=True, slots=True)
class Graded:
    """What marking a class gave: markings by assignment, faults of sheets, keys of those who handed nothing in."""

    markings: tuple[Marking, ...]
    problems: tuple[Problem, ...]
    missing: tuple[Key, ...]


def grade(submissions: Sequence[Path], assignments: Path, policy: Policy, language: Language | None = None) -> Graded:
    """Mark the sheets of files and folders; raises `AssignmentError` if `assignments` is at fault."""
    room = Classroom(assignment_files(assignments, language), policy, language)
    markings: dict[str, Marking] = {}
    problems: list[Problem] = []
    for path in _sheets(submissions):
        try:
            submission = read_submission(path, lambda name: room.guide(name).key, language)
            earlier = markings.get(submission.assignment)
            if earlier is not None:
                kept, left = _preferred(Path(earlier.submission.file), path, submission.assignment)
                fault = Fault("sheet-twice", Mark(str(left)), {"text": submission.assignment, "first": kept.name})
                problems.append(as_problem(fault, language))
                if kept != path:
                    continue
            guide = _asked(room.guide(submission.assignment), submission)
            classmates = room.keys if policy.guard else ()
            markings[submission.assignment] = mark(guide, submission, classmates)
        except AssignmentError as error:
            problems += error.problems
    missing = tuple(key for key in room.keys if key.id not in markings)
    order = {name: index for index, name in enumerate(room.files)}
    marked = sorted(markings.values(), key=lambda marking: order[comparable(marking.key.id)])
    return Graded(tuple(marked), tuple(problems), missing)


def _asked(guide: Guide, submission: Submission) -> Guide:
    """The guide with the cells that the policy asks for; what else is filled in is judged but earns no marks."""
    policy = guide.policy
    filled = {id for id, _ in (*submission.values, *submission.problems)}
    key = policy.ask.of(guide.key, filled)
    beyond = {row.id: 0.0 for row in key.asked if not policy.ask.wants(row)}
    return replace(guide, key=key, policy=replace(policy, weights={**beyond, **policy.weights}))


def _sheets(paths: Sequence[Path]) -> Iterator[Path]:
    """The answer sheets among files and in folders, without what a spreadsheet keeps beside an open file."""
    for path in paths:
        if path.is_dir():
            inside = sorted(file for file in path.rglob("*") if file.suffix.lower() in SUBMISSIONS and file.is_file())
            yield from (file for file in inside if not file.name.startswith((".", "~$")))
        else:
            yield path


def _preferred(first: Path, second: Path, assignment: str) -> tuple[Path, Path]:
    """Of two sheets of one assignment the one to mark and the other; a file named like the assignment wins."""
    own = [comparable(path.stem) == comparable(assignment) for path in (first, second)]
    return (second, first) if own == [False, True] else (first, second)


def files_of(graded: Graded, policy: Policy, engine: Engine, language: Language | None) -> Iterator[tuple[Path, bytes]]:
    """Every file of a graded class with its content: two for each student, two for the instructor."""
    for marking in graded.markings:
        key = marking.key
        # As the batch names it, or the assignment's own stem.
        folder = Path(folder_name(key.student["id"]) if "id" in key.student else key.id)
        yield folder / "feedback.xlsx", write_xlsx(feedback_book(marking, policy.show_answers))
        tree = feedback_document(marking, catalogue.title(key.kind, key.language), policy.show_answers)
        yield folder / "feedback.pdf", api.typeset(tree, engine)[1]
    if graded.markings:
        key = graded.markings[0].key
        spoken = language or key.language
        yield Path("grades.csv"), write_csv(grade_rows(graded.markings, spoken, graded.missing, policy.scale))
        page = class_document(graded.markings, catalogue.title(key.kind, spoken), spoken, graded.missing, policy.scale)
        yield Path("class.pdf"), api.typeset(page, engine)[1]


def put(graded: Graded, policy: Policy, out: Path, engine: Engine, language: Language | None) -> Iterator[Path]:
    """Write every file of a graded class below `out`, each in one step; raises `OutputError`."""
    for name, content in files_of(graded, policy, engine, language):
        yield from api.put(out / name.parent, {name.name: content})


def summary(graded: Graded, language: Language | None) -> Iterator[str]:
    """A line for each student marked, and how many handed nothing in."""
    for marking in graded.markings:
        points, out_of = f"{marking.points:g}", f"{marking.out_of:g}"
        who, firsts = person(marking.key), len(marking.first_errors)
        yield word("graded", language, id=who, points=points, out_of=out_of, firsts=firsts)
    if graded.missing:
        yield counted("graded_missing", language, len(graded.missing))
