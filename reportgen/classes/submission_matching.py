"""Assign the submitted files to students, one sheet each (`collect`), with a reason for each file that is not used."""

from __future__ import annotations

import re
from collections.abc import Callable, Container, Iterable, Mapping, Sequence
from functools import partial
from pathlib import Path

from reportgen.base.errors import AssignmentError, Fault, Location, Problem
from reportgen.base.records import Record, field
from reportgen.base.units import Language
from reportgen.base.words import as_problem
from reportgen.case.answer_key import Key
from reportgen.classes.archives import ARCHIVE
from reportgen.classes.fault_isolation import isolated
from reportgen.classes.platforms import Handed, Owner
from reportgen.classes.reading_sheets import Pages
from reportgen.classes.roster import comparable
from reportgen.handin.reading_book import is_unchanged
from reportgen.marking.answer_sheet import read_submission
from reportgen.marking.marking_data import Submission
from reportgen.marking.marking_policy import Twice


class Refused(Record):
    """A file that is not marked, with the reasons."""

    handed: Handed
    problems: tuple[Problem, ...]

    @property
    def reasons(self) -> tuple[str, ...]:
        """The file's name and the message of each problem, without the file's path."""
        return tuple(f"{self.handed.path.name}: {one.message}" for one in self.problems)


class Collected(Record):
    """The sheets to mark with their files, by assignment; the files that are not marked, and all problems."""

    sheets: Mapping[str, tuple[Submission, Handed]]
    refused: tuple[Refused, ...]
    problems: tuple[Problem, ...]
    readings: Mapping[str, tuple[Submission, Handed]] = field(default_factory=dict)
    """Prefilled sheets with values from a student's own files that nobody has changed since."""

    @property
    def owners(self) -> dict[str, Owner]:
        """The platform's owner of each sheet, by assignment."""
        return {name: handed.owner for name, (_, handed) in self.sheets.items() if handed.owner}


def collect(
    handed: Iterable[tuple[Handed, Pages | list[Problem]]],
    key_of: Callable[[str], Key],
    files: Mapping[str, Path],
    twice: Twice,
    language: Language | None,
) -> Collected:
    """Return the sheets of a class, one for each student; `files` are the assignments by `comparable` stem."""
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
            problems.append(as_problem(Fault("sheet-named-otherwise", Location(str(file.path)), about), language))
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
    """Return the sheet of a file, submitted by its own student; raise `AssignmentError` otherwise."""
    if isinstance(pages, list):
        raise AssignmentError(pages)
    submission = read_submission(file.path, key_of, language, pages)
    name = key_of(submission.assignment).student.get("name", "")
    if file.owner and not file.owner.may_be(name):
        fault = Fault("sheet-other-hands", Location(str(file.path)), {"text": name, "owner": file.owner.name})
        raise AssignmentError([as_problem(fault, language)])
    return submission


def chosen_of(
    several: Sequence[Handed], assignment: str, name: str, known: Container[str], twice: Twice
) -> tuple[Handed, list[Fault]]:
    """Return the file that counts among several of one assignment, and a fault for each of the others."""
    chosen, *others = _in_order(several, assignment, name, known, twice)
    about = ({"text": assignment, "first": _distinct_name(chosen.path, left.path)} for left in others)
    return chosen, [
        Fault("sheet-twice", Location(str(left.path)), text) for left, text in zip(others, about, strict=True)
    ]


def named_after(path: Path, known: Container[str]) -> str | None:
    """Return the `comparable` assignment after which a sheet's file, its folder or its archive is named, or None."""
    archives = (above.stem for above in path.parents if above.suffix.lower() == ARCHIVE)
    return next((name for name in map(comparable, (path.stem, path.parent.name, *archives)) if name in known), None)


def _in_order(
    several: Sequence[Handed], assignment: str, name: str, known: Container[str], twice: Twice
) -> list[Handed]:
    """Return the sheets of one assignment, the one to be marked first.

    A sheet that the platform assigns to its student, or that is named like the assignment, precedes those that only
    claim to belong to it. Then the later one is first, or the earlier one, as `twice` says. Equal times are ordered by
    name with numeric parts: answers-2 before answers-10.
    """

    def is_own(file: Handed) -> bool:
        by_platform = file.owner is not None and bool(file.owner.name and name)
        return by_platform or named_after(file.path, known) == comparable(assignment)

    in_time = sorted(several, key=lambda file: (file.when, _counting(file.path.as_posix())), reverse=twice == "last")
    return sorted(in_time, key=lambda file: not is_own(file))


def _counting(path: str) -> list[tuple[int, str]]:
    """Return a sort key of a path that compares its numbers by value."""
    return [(int(part), "") if part.isdecimal() else (-1, part) for part in re.split(r"(\d+)", path)]


def _distinct_name(chosen: Path, left: Path) -> str:
    """Return the name of a file, with its folder if the other file has the same name."""
    return chosen.name if chosen.name != left.name else f"{chosen.parent.name}/{chosen.name}"
