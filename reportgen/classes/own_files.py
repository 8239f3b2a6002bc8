"""Assign reports and drawings without a sheet to their students, and read them: `own_works`.

Such a file does not name its assignment. Its student is found by its name or folder, by the platform, or by the id of
exactly one student of the class in its text.
"""

from __future__ import annotations

from collections.abc import Callable, Container, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path

from reportgen.base.errors import Fault, Location, Problem
from reportgen.base.records import Record, replace
from reportgen.base.units import Language
from reportgen.base.words import as_problem
from reportgen.case.answer_key import Key
from reportgen.classes.fault_isolation import isolated
from reportgen.classes.platforms import Handed, modification_time
from reportgen.classes.reading_sheets import names_in, read_own
from reportgen.classes.roster import comparable
from reportgen.classes.submission_matching import Collected, Refused, chosen_of, named_after
from reportgen.handin import FileReading, submission
from reportgen.handin.drawing_reader import WantedPlans
from reportgen.handin.file_kinds import DRAWING, kinds
from reportgen.handin.reading_book import NAME
from reportgen.marking.marking_data import Submission
from reportgen.marking.marking_policy import Twice


class OwnWork(Record):
    """A student's own files, each with what was read from it."""

    files: tuple[tuple[Handed, FileReading], ...]

    def submission(self, language: Language | None) -> Submission:
        """Return the submission that is marked if there is no sheet."""
        return submission([reading for _, reading in self.files], language)

    def notes(self, language: Language | None) -> list[Problem]:
        """Return the notes about each file as a whole."""
        return [as_problem(note, language, "note") for _, reading in self.files for note in reading.notes]


@dataclass
class OwnWorks:
    """The own files of a class by assignment; the files that are not read, and all problems."""

    works: dict[str, OwnWork] = field(default_factory=dict)
    refused: list[Refused] = field(default_factory=list)
    problems: list[Problem] = field(default_factory=list)

    def refuse(self, file: Handed, problems: Sequence[Problem]) -> None:
        self.refused.append(Refused(file, tuple(problems)))
        self.problems += problems


class SearchTargets(Record):
    """Functions that return what to search for in a student's files, by the key.

    `asked` gives the requested cells, with the symbols of the papers. `plans` gives the plans of a drawing, including
    those by the values of files that were read before.
    """

    asked: Callable[[Key], Key]
    plans: Callable[[Key, Sequence[FileReading]], WantedPlans | None]


def own_works(
    handed: Sequence[Handed],
    keys: Mapping[str, Key],
    student_of: Callable[[Handed], Key | None],
    targets: SearchTargets,
    twice: Twice,
    language: Language | None,
) -> OwnWorks:
    """Return the own files of a class, assigned to its students and read.

    `keys` are those of the assignments by comparable stem; `student_of` returns a file's student by its name or its
    platform.
    """
    gathered = OwnWorks()
    of_assignment: dict[str, list[Handed]] = {}
    unknown: list[Handed] = []
    for file in handed:
        key = student_of(file)
        if key is not None:
            of_assignment.setdefault(key.id, []).append(file)
        else:
            unknown.append(file)
    for file, key in _by_text(unknown, keys, gathered, language):
        of_assignment.setdefault(key.id, []).append(file)
    chosen = list(_chosen(of_assignment, keys, gathered, twice, language))
    known = {key.id: key for key in keys.values()}
    read: dict[str, list[tuple[Handed, FileReading]]] = {}

    def before(assignment: str) -> list[FileReading]:
        """Return the earlier readings of the same student."""
        return [reading for _, reading in read.get(assignment, ())]

    drawings = [file for file in chosen if file[1].path.suffix.lower() == DRAWING]
    # Reports are read first, because their values help to find the plans in drawings.
    for several in ([file for file in chosen if file not in drawings], drawings):
        calls: list[tuple[Handed, Key, WantedPlans | None]] = []
        assignments: list[str] = []
        for assignment, file in several:
            plans = None
            if several is drawings:
                finding = partial(targets.plans, known[assignment], before(assignment))
                plans = isolated(finding, file.path, language)
            if isinstance(plans, list):
                gathered.refuse(file, plans)
                continue
            calls.append((file, targets.asked(known[assignment]), plans))
            assignments.append(assignment)
        for assignment, (file, reading) in zip(assignments, read_own(calls, language), strict=True):
            if isinstance(reading, list):
                gathered.refuse(file, reading)
            else:
                read.setdefault(assignment, []).append((file, reading))
    gathered.works |= {assignment: OwnWork(tuple(files)) for assignment, files in read.items()}
    return gathered


def _by_text(
    unknown: Sequence[Handed], keys: Mapping[str, Key], gathered: OwnWorks, language: Language | None
) -> Iterator[tuple[Handed, Key]]:
    """Yield files whose text has the id of one student, or the name of one assignment."""
    if not unknown:
        return
    owners: dict[str, Key] = {}
    for key in keys.values():
        owners |= dict.fromkeys((name.casefold() for name in (key.id, key.student.get("id", "")) if name), key)
    for file, standing in names_in(unknown, frozenset(owners), language):
        if isinstance(standing, list):
            gathered.refuse(file, standing)
            continue
        named = {owners[name].id: owners[name] for name in standing}
        if file.owner is not None:
            named = {id: key for id, key in named.items() if file.owner.may_be(key.student.get("name", ""))}
        if len(named) == 1:
            yield file, next(iter(named.values()))
        else:
            gathered.refuse(file, [as_problem(Fault("own-whose", Location(str(file.path))), language)])


def _chosen(
    of_assignment: Mapping[str, list[Handed]],
    keys: Mapping[str, Key],
    gathered: OwnWorks,
    twice: Twice,
    language: Language | None,
) -> Iterator[tuple[str, Handed]]:
    """Yield the report that counts if a student has several; all drawings belong to one work."""
    for assignment, several in of_assignment.items():
        name = keys[comparable(assignment)].student.get("name", "")
        for ending, kind in kinds().items():
            files = [file for file in several if file.path.suffix.lower() == ending]
            if files and not kind.several:
                first, left = chosen_of(files, assignment, name, keys, twice)
                gathered.problems += [as_problem(fault, language) for fault in left]
                files = [first]
            yield from ((assignment, file) for file in files)


def possible_sheets(handed: Iterable[Handed], own: list[Handed]) -> Iterator[Handed]:
    """Yield the files that may be sheets; append the others to `own`."""
    for file in handed:
        if file.is_own:
            own.append(file)
        else:
            yield file


def submissions_to_mark(
    collected: Collected, own: OwnWorks, known: Container[str], language: Language | None
) -> Collected:
    """Return the submissions to mark: the sheets, and the own files of students without one.

    An unchanged prefilled sheet counts only if the files that it was read from are missing. A sheet named after another
    one of the `known` assignments does not replace its student's own files.
    """
    sheets = dict(collected.sheets)
    notes: list[Problem] = []
    for assignment, work in own.works.items():
        first = work.files[0][0]
        stray = assignment in sheets and named_after(sheets[assignment][1].path, known) not in (
            None,
            comparable(assignment),
        )
        if assignment not in sheets or stray:
            submission = isolated(partial(work.submission, language), first.path, language)
            if isinstance(submission, list):
                own.refuse(first, submission)
            else:
                sheets[assignment] = submission, first
        elif not sheets[assignment][0].fingerprint:
            about = {"text": assignment, "sheet": sheets[assignment][1].path.name}
            notes.append(as_problem(Fault("own-beside-sheet", Location(str(first.path)), about), language, "note"))
    sheets |= {assignment: sheet for assignment, sheet in collected.readings.items() if assignment not in sheets}
    refused = (*collected.refused, *own.refused)
    return replace(collected, sheets=sheets, refused=refused, problems=(*collected.problems, *own.problems, *notes))


def completed(out: Path | None, given: Sequence[Path]) -> Iterator[Handed]:
    """Yield the prefilled sheets that an earlier run left below `out`, unless they are among the given files."""
    among = {path.resolve() for path in given}
    for path in sorted(out.glob(f"*/{NAME}")) if out is not None else ():
        resolved = path.resolve()
        if resolved not in among and not among & {*resolved.parents}:
            yield Handed(path, when=modification_time(path))


def renewable(readings: Mapping[str, tuple[Submission, Handed]], target: Path) -> bool:
    """Return True if a prefilled sheet may be written to a path: it does not exist, or nobody has changed it."""
    return not target.exists() or any(file.path.resolve() == target.resolve() for _, file in readings.values())
