"""Students and their assignment files: which belongs to whom, who has none, which belong to nobody."""

from __future__ import annotations

import unicodedata
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from reportgen.assignment.faults import Fault
from reportgen.assignment.messages import as_problem
from reportgen.batch.roster import Student
from reportgen.errors import AssignmentError, Mark, Problem
from reportgen.notation.numbers import Language

SUFFIXES = frozenset({".yaml", ".yml"})


@dataclass(frozen=True, slots=True)
class Assigned:
    """A student with the file of his assignment, or with the reason why there is none."""

    student: Student
    file: Path | None
    problem: Problem | None = None


def matched(
    students: Sequence[Student], folder: Path, language: Language
) -> tuple[tuple[Assigned, ...], tuple[Path, ...]]:
    """Each student with the file in `folder` or below whose stem is the id, and the files that nobody has.

    A stem is an id as `folder_name` spells it or as the roster does, whatever its case.  Raises
    `AssignmentError` for two files of one stem and for a folder that is none.
    """
    files = assignment_files(folder, language)
    found = tuple(_assigned(student, files, language) for student in students)
    taken = {assigned.file for assigned in found}
    return found, tuple(path for path in files.values() if path not in taken)


def assignment_files(folder: Path, language: Language) -> dict[str, Path]:
    """The assignment files in a folder or below by their stems, in one spelling (NFC, case folded).

    Raises `AssignmentError` for two files of one stem and for a folder that is none.
    """
    if not folder.is_dir():
        raise AssignmentError([as_problem(Fault("no-folder", Mark(str(folder))), language)])
    files: dict[str, Path] = {}
    faults: list[Fault] = []
    for path in sorted(path for path in folder.rglob("*") if _is_assignment(path, folder)):
        stem = spelt(path.stem)
        if stem in files:
            faults.append(Fault("same-stem", Mark(str(path)), {"text": path.stem, "first": str(files[stem])}))
        files.setdefault(stem, path)
    if faults:
        raise AssignmentError([as_problem(fault, language) for fault in faults])
    return files


def _assigned(student: Student, files: dict[str, Path], language: Language) -> Assigned:
    for stem in (student.folder, student.id):
        if spelt(stem) in files:
            return Assigned(student, files[spelt(stem)])
    fault = Fault("no-assignment", student.mark, {"text": student.id})
    return Assigned(student, None, as_problem(fault, language))


def _is_assignment(path: Path, folder: Path) -> bool:
    hidden = any(part.startswith(".") for part in path.relative_to(folder).parts)
    return path.suffix.lower() in SUFFIXES and not hidden and path.is_file()


def spelt(stem: str) -> str:
    return unicodedata.normalize("NFC", unicodedata.normalize("NFC", stem).casefold())
