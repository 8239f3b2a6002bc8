"""An exercise of plane motion as a case: what every output of it is made of."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Never

from reportgen.document.case import Pitfalls
from reportgen.document.key import Key
from reportgen.document.tree import Document
from reportgen.errors import NotOfferedError
from reportgen.exercise.solved import SolvedExercise
from reportgen.notation.sheet import Family
from reportgen.words import word

if TYPE_CHECKING:
    from reportgen.figures.sheet import Sheet
    from reportgen.ledger.core import Ledger


@dataclass(frozen=True)
class ExerciseCase(SolvedExercise):
    """An exercise, as a `Case`."""

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
