"""An assignment opened once: report, key, task, marking and results are all made of one case."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, get_args

from reportgen import catalogue, kinds
from reportgen.assignment import Assignment
from reportgen.errors import NotOfferedError
from reportgen.notation.numbers import Language
from reportgen.words import load_words, search_path, word

if TYPE_CHECKING:
    import numpy as np

    from reportgen.analysis import Analysis
    from reportgen.exercise.literal import LiteralBoard
    from reportgen.exercise.plane_motion import Exercise
    from reportgen.exercise.solution import Worked
    from reportgen.flywheel import Flywheel
    from reportgen.ledger.core import Ledger
    from reportgen.ledger.forces.polygon import Polygon


@dataclass(frozen=True)
class Opened:
    """An assignment with its words; each part is computed when it is first asked for."""

    assignment: Assignment

    @property
    def directories(self) -> tuple[Path, ...]:
        """Where the words of this language, machine and school are looked for."""
        assignment = self.assignment
        return search_path(assignment.language, assignment.kind, assignment.report.school or "")

    @cached_property
    def words(self) -> Mapping[str, Any]:
        """The short words of `words.yaml`.  Raises `TemplateError`."""
        return load_words(self.directories)

    @property
    def course(self) -> str:
        """The course as the assignment names it; by its standard name, whatever the language, in the case's own."""
        standard: str = self.words["cover"]["course"]
        names = {load_words(search_path(language))["cover"]["course"] for language in get_args(Language)}
        given = self.assignment.report.course
        return given if given and given not in names else standard

    @property
    def title(self) -> str:
        """The machine's name in the assignment's language."""
        return kinds.title(self.assignment.kind, self.assignment.language)

    @property
    def variant_line(self) -> str:
        """The variant as headers name it."""
        variant = self.assignment.variant
        return str(self.words["variant"].format(variant=variant)) if variant else ""


@dataclass(frozen=True)
class Case(Opened):
    """A machine: its assignment with all that is computed of it."""

    @cached_property
    def analysis(self) -> Analysis:
        """Everything computed, as arrays over the positions.

        Raises `NotOfferedError` for an exercise, which has no machine.
        """
        from reportgen.analysis import analyse

        kind, language = self.assignment.kind, self.assignment.language
        if catalogue.makes(kind) != "machine":
            raise NotOfferedError(word("no_machine", language, kind=kind))
        return analyse(catalogue.module(kind).machine(self.assignment))

    @cached_property
    def ledger(self) -> Ledger:
        """Every number by its id, with the symbols and the units of the assignment's language."""
        return self._written(printed=True)

    def _written(self, printed: bool) -> Ledger:
        from reportgen.ledger.report import write_ledger

        written = write_ledger(self.analysis, self.words["units"], self.assignment.worked_positions, printed)
        return written.in_language(self.words["symbols"])

    @cached_property
    def drawn(self) -> Case:
        """The same case for drawings alone: sooner there, as no decimals are chosen for its numbers."""
        if "ledger" in vars(self):
            return self
        case = Case(self.assignment)
        vars(case).update(analysis=self.analysis, words=self.words, ledger=self._written(printed=False))
        return case

    def redrawn(self, scales: Mapping[str, float | np.ndarray]) -> Case:
        """The same case with drawings to other scales (SI, by id), one or [N]."""
        case = Case(self.assignment)
        vars(case).update(vars(self), ledger=self.ledger.redrawn(scales))
        return case

    @property
    def polygons(self) -> tuple[Polygon, ...]:
        """The force plans: one for each group, the driver's last; none without loads."""
        return self.ledger.polygons

    @property
    def flywheel(self) -> Flywheel | None:
        """The flywheel, if the assignment asks for one."""
        return self.ledger.flywheel


@dataclass(frozen=True)
class ExerciseCase(Opened):
    """One instant of a system in plane motion: its assignment with all that is computed of it."""

    @cached_property
    def exercise(self) -> Exercise:
        """The system and what is asked of it."""
        exercise: Exercise = catalogue.module(self.assignment.kind).exercise(self.assignment)
        return exercise

    @cached_property
    def worked(self) -> Worked:
        """The steps of its solution with their numbers.

        Raises `NotOfferedError` if no steps that are known here lead to something that is asked.
        """
        from reportgen.exercise.solution import work_out

        first = next(iter(self.exercise.given.methods), None)
        worked = work_out(self.exercise, self.words["units"], self.words["symbols"], first)
        if worked.missing:
            raise NotOfferedError(word("no_steps", self.assignment.language, asked=", ".join(worked.missing)))
        return self._by_its_method(worked)

    @cached_property
    def further(self) -> tuple[Worked, ...]:
        """The velocities worked out anew by each further method that the file asks for.

        Raises `NotOfferedError` for a method of which no steps are known here.
        """
        from reportgen.exercise.solution import work_out

        rest = self.exercise.given.methods[1:]
        each = (work_out(self.exercise, self.words["units"], self.words["symbols"], one, True) for one in rest)
        return tuple(map(self._by_its_method, each))

    def _by_its_method(self, worked: Worked) -> Worked:
        if not worked.by_method:
            raise NotOfferedError(word("no_method_steps", self.assignment.language, method=worked.method))
        return worked

    @cached_property
    def literal(self) -> LiteralBoard | None:
        """The quantities of the solution by symbols; None where the file has none."""
        if not self.exercise.given.literal:
            return None
        from reportgen.exercise.literal import LiteralBoard

        return LiteralBoard(self.exercise, self.worked)

    @property
    def ledger(self) -> Ledger:
        """Every number of the solution by its id."""
        return self.worked.ledger


def opened(assignment: Assignment) -> Case | ExerciseCase:
    """The case of an assignment, whatever its kind makes of it."""
    return ExerciseCase(assignment) if catalogue.makes(assignment.kind) == "exercise" else Case(assignment)


def open_any(path: Path | str, language: Language | None = None) -> Case | ExerciseCase:
    """The case of an assignment file, whatever its kind makes of it.  Raises `AssignmentError` as `open_case`."""
    return opened(catalogue.load(path, language))


def open_case(path: Path | str, language: Language | None = None) -> Case:
    """The case of an assignment file, in its own language or in `language`.

    Raises `AssignmentError` with all faults of the file, located.
    """
    return Case(catalogue.load(path, language))
