"""Which sheet is whose: what was handed in, read and laid to the students, one sheet each; the rest with its reason."""

from __future__ import annotations

import re
from collections.abc import Callable, Container, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path

from reportgen.base.errors import AssignmentError, Fault, Mark, Problem
from reportgen.base.units import Language
from reportgen.base.words import as_problem
from reportgen.case.key import Key
from reportgen.classes.archives import ARCHIVE
from reportgen.classes.isolation import isolated
from reportgen.classes.platforms import Handed, Owner
from reportgen.classes.reading_sheets import Pages
from reportgen.classes.roster import comparable
from reportgen.handin.reading_book import is_unchanged
from reportgen.marking.marks import Submission
from reportgen.marking.policy import Twice
from reportgen.marking.sheet import read_submission


@dataclass(frozen=True, slots=True)
class Refused:
    """A file that is not marked, and why."""

    handed: Handed
    problems: tuple[Problem, ...]

    @property
    def reasons(self) -> tuple[str, ...]:
        """The file's name and what is said of it, without the way to it."""
        return tuple(f"{self.handed.path.name}: {one.message}" for one in self.problems)


@dataclass(frozen=True, slots=True)
class Collected:
    """The sheets to be marked and who handed them in, by assignment; the files that are not, and all that is told."""

    sheets: Mapping[str, tuple[Submission, Handed]]
    refused: tuple[Refused, ...]
    problems: tuple[Problem, ...]
    readings: Mapping[str, tuple[Submission, Handed]] = field(default_factory=dict)
    """Sheets that only say what was read of a student's own files before, and that nobody has changed since."""

    @property
    def owners(self) -> dict[str, Owner]:
        """Who handed in, as a platform says it."""
        return {name: handed.owner for name, (_, handed) in self.sheets.items() if handed.owner}


def collect(
    handed: Iterable[tuple[Handed, Pages | list[Problem]]],
    key_of: Callable[[str], Key],
    files: Mapping[str, Path],
    twice: Twice,
    language: Language | None,
) -> Collected:
    """The sheets of a class, file for each student; `files` are the assignments by `comparable` stem."""
    of_assignment: dict[str, list[tuple[Submission, Handed]]] = {}
    refused: list[Refused] = []
    problems: list[Problem] = []
    readings: dict[str, tuple[Submission, Handed]] = {}
    for file, pages in handed:
        submission = isolated(partial(_submission, file, pages, key_of, language), file.path, language)
        if isinstance(submission, list):
            refused.append(Refused(file, tuple(submission)))
            problems += submission
            continue
        if is_unchanged(submission):
            readings[submission.assignment] = submission, file
            continue
        named = named_after(file.path, files)
        if named not in (None, comparable(submission.assignment)):
            about = {"named": files[named].stem, "text": submission.assignment}
            problems.append(as_problem(Fault("sheet-named-otherwise", Mark(str(file.path)), about), language))
        of_assignment.setdefault(submission.assignment, []).append((submission, file))
    sheets: dict[str, tuple[Submission, Handed]] = {}
    for assignment, several in of_assignment.items():
        name = key_of(assignment).student.get("name", "")
        chosen, left = chosen_of([file for _, file in several], assignment, name, files, twice)
        sheets[assignment] = next(pair for pair in several if pair[1] is chosen)
        problems += [as_problem(fault, language) for fault in left]
    return Collected(sheets, tuple(refused), tuple(problems), readings)


def _submission(
    file: Handed, pages: Pages | list[Problem], key_of: Callable[[str], Key], language: Language | None
) -> Submission:
    """The sheet of a file, handed in by whoever it belongs to; raises `AssignmentError`."""
    if isinstance(pages, list):
        raise AssignmentError(pages)
    submission = read_submission(file.path, key_of, language, pages)
    name = key_of(submission.assignment).student.get("name", "")
    if file.owner and not file.owner.may_be(name):
        fault = Fault("sheet-other-hands", Mark(str(file.path)), {"text": name, "owner": file.owner.name})
        raise AssignmentError([as_problem(fault, language)])
    return submission


def chosen_of(
    several: Sequence[Handed], assignment: str, name: str, known: Container[str], twice: Twice
) -> tuple[Handed, list[Fault]]:
    """Which of several files of one assignment counts, and what is told of the others."""
    chosen, *others = _in_order(several, assignment, name, known, twice)
    about = ({"text": assignment, "first": _told_apart(chosen.path, left.path)} for left in others)
    return chosen, [Fault("sheet-twice", Mark(str(left.path)), text) for left, text in zip(others, about, strict=True)]


def named_after(path: Path, known: Container[str]) -> str | None:
    """The assignment that a sheet's file, its folder or the archive that it lies in is named after, `comparable`."""
    archives = (above.stem for above in path.parents if above.suffix.lower() == ARCHIVE)
    return next((name for name in map(comparable, (path.stem, path.parent.name, *archives)) if name in known), None)


def _in_order(
    several: Sequence[Handed], assignment: str, name: str, known: Container[str], twice: Twice
) -> list[Handed]:
    """Sheets of one assignment, the file to be marked first.

    A sheet that its student handed in by the platform's word, or that is named like the assignment, goes before those
    that only claim to be of it; then the later one goes first, or the earlier one.  Of one moment the order of names is
    that of counting: answers-2 before answers-10.
    """

    def is_own(file: Handed) -> bool:
        by_platform = file.owner is not None and bool(file.owner.name and name)
        return by_platform or named_after(file.path, known) == comparable(assignment)

    in_time = sorted(several, key=lambda file: (file.when, _counting(file.path.as_posix())), reverse=twice == "last")
    return sorted(in_time, key=lambda file: not is_own(file))


def _counting(path: str) -> list[tuple[int, str]]:
    """A path such that sorting counts its numbers."""
    return [(int(part), "") if part.isdecimal() else (-1, part) for part in re.split(r"(\d+)", path)]


def _told_apart(chosen: Path, left: Path) -> str:
    """The name of a file, with its folder where another one has the same."""
    return chosen.name if chosen.name != left.name else f"{chosen.parent.name}/{chosen.name}"
