"""An exercise with all that is computed of it; each part when it is first asked for."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

from reportgen.case import Opened
from reportgen.errors import NotOfferedError
from reportgen.exercise.literal import LiteralBoard
from reportgen.exercise.places import Exercise, exercise_of
from reportgen.exercise.solution import Worked, work_out
from reportgen.words import word


@dataclass(frozen=True)
class SolvedExercise(Opened):
    """One instant of a system in plane motion, solved by steps."""

    @cached_property
    def exercise(self) -> Exercise:
        """The system and what is asked of it."""
        return exercise_of(self.assignment)

    @cached_property
    def worked(self) -> Worked:
        """The steps of its solution with their numbers.

        Raises `NotOfferedError` if no steps that are known here lead to something that is asked.
        """
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
        return LiteralBoard(self.exercise, self.worked) if self.exercise.given.literal else None
