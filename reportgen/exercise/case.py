"""One instant of a system in plane motion: its assignment with all that is computed of it."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, Never

from reportgen.case import Opened
from reportgen.document.case import Pitfalls
from reportgen.document.key import Key
from reportgen.document.tree import Document
from reportgen.errors import NotOfferedError
from reportgen.notation.sheet import Family
from reportgen.words import word

if TYPE_CHECKING:
    from reportgen.exercise.literal import LiteralBoard
    from reportgen.exercise.plane_motion import Exercise
    from reportgen.exercise.solution import Worked
    from reportgen.figures.sheet import Sheet
    from reportgen.ledger.core import Ledger


@dataclass(frozen=True)
class ExerciseCase(Opened):
    """An exercise, as a `Case`."""

    @cached_property
    def exercise(self) -> Exercise:
        """The system and what is asked of it."""
        from reportgen.exercise.plane_motion import exercise

        return exercise(self.assignment)

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

    # --- as a case

    @property
    def ledger(self) -> Ledger:
        return self.worked.ledger

    @property
    def families(self) -> Mapping[str, Family]:
        return self.ledger.families

    @property
    def positions_of_a_turn(self) -> int:
        return 1

    @property
    def speed(self) -> None:
        """Nothing drives it."""

    @property
    def balance(self) -> None:
        """It has no forces."""

    @property
    def pitfalls(self) -> Pitfalls:
        return Pitfalls()

    def fault(self) -> str:
        # That it moves, and only in one way, is among the checks of its file.
        return ""

    def document(self) -> Document:
        from reportgen.exercise.document import solution

        return solution(self)

    def key(self) -> Key:
        from reportgen.answers.key import make_key

        return make_key(self, self.ledger)

    def task(self, key: Key, by_section: bool = False) -> Document:
        from reportgen.answers.paper import empty_sheet, task_paper
        from reportgen.document.prose import Prose
        from reportgen.exercise.document import task_names

        names = {**task_names(self), "answer_tables": empty_sheet(key, by_section)}
        return task_paper(self, key, (), Prose(self.places).render("exercise-task", names))

    def results(self) -> dict[str, Any]:
        """Its one position has its number alone; null is what is not determined."""
        from reportgen.answers.results import pair, results

        motion = self.exercise.motion
        points = {
            name: {
                "p": pair(place),
                "v": pair(motion.v(name)) if motion.knows_velocity(name) else None,
                "a": pair(motion.a(name)) if motion.knows_acceleration(name) else None,
            }
            for name, place in motion.system.points.items()
            if motion.system.body_of(name)
        }
        links = {
            str(body): {
                "omega": motion.omega(body) if motion.knows_omega(body) else None,
                "epsilon": motion.epsilon(body) if motion.knows_epsilon(body) else None,
                "centre": None if not motion.knows_centre(body) or (at := motion.centre(body)) is None else pair(at),
            }
            for body in motion.system.bodies
        }
        return results(self, [{"number": 1, "points": points, "links": links}])

    def film(self) -> None:
        """Nothing moves at one instant."""

    def sheets(self, size: str = "", sets: Collection[str] = (), block: Path | None = None) -> list[Sheet]:
        """Raises `NotOfferedError`: there is no machine to draw."""
        self._no_machine()

    def _no_machine(self) -> Never:
        raise NotOfferedError(word("no_machine", self.assignment.language, kind=self.assignment.kind))
