"""`ExerciseCase`: an exercise of plane motion as a `Case`, the source of all its outputs."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

from reportgen.case import AskedFor
from reportgen.case.quantity_wording import MAGNITUDE
from reportgen.case.result_entries import ResultEntries
from reportgen.document import Block, Document
from reportgen.document.template_rendering import Prose
from reportgen.exercise.figures import FIGURES
from reportgen.exercise.literal_solution import SolvedExercise
from reportgen.exercise.solution_page import solution, task_names

if TYPE_CHECKING:
    from reportgen.drawing.plates import DrawingPlate
    from reportgen.formula.ledger import Ledger


@dataclass(frozen=True)
class ExerciseCase(SolvedExercise):
    """A solved exercise of plane motion, as a `Case`."""

    @property
    def ledger(self) -> Ledger:
        return self.worked.ledger

    @property
    def printed(self) -> Ledger:
        return self.worked.printed

    # The checks of the file already prove that the system moves, and in one way only, so no fault shows in the results.

    def document(self) -> Document:
        return self.bounded(solution)

    def sense(self, id: str) -> str:
        """Return `MAGNITUDE` if the data leave the sense of a requested quantity open, otherwise ""."""
        return MAGNITUDE if id in self._of_open_sense else ""

    @cached_property
    def _of_open_sense(self) -> frozenset[str]:
        return frozenset(one.id for one in self.exercise.asked if not self.exercise.determines_sense(one))

    def question(self, asked: AskedFor) -> tuple[Sequence[Block], Sequence[Block]]:
        """Return the title of the question and its text on the task sheet, each as blocks."""
        sheet = {"answer_tables": asked.answers, "self_check": asked.self_check}
        title, *rest = Prose(self.places).render("exercise-task", {**task_names(self), **sheet})
        return (title,), rest

    @cached_property
    def entries(self) -> ResultEntries:
        """Return the values of the only position by id; None for a value that is not determined."""
        motion = self.exercise.motion
        points = {
            name: {
                "p": complex(place),
                "v": complex(motion.v(name)) if motion.knows_velocity(name) else None,
                "a": complex(motion.a(name)) if motion.knows_acceleration(name) else None,
            }
            for name, place in motion.system.points.items()
            if motion.system.body_of(name)
        }
        links = {
            body: {
                "omega": motion.omega(body) if motion.knows_omega(body) else None,
                "epsilon": motion.epsilon(body) if motion.knows_epsilon(body) else None,
                "centre": motion.centre(body) if motion.knows_centre(body) else None,
            }
            for body in motion.system.bodies
        }
        return ResultEntries([{"number": 1, "points": points, "links": links}])

    def plates(self, sets: Collection[str] = (), every: bool = False) -> Mapping[str, Sequence[DrawingPlate]]:
        """Return the figures; there are no sets to choose from."""
        from reportgen.drawing.drawing_sheet import ENLARGED, lettered
        from reportgen.drawing.plates import DrawingPlate

        words = self.words["instant"]
        drawn = {what: FIGURES[what](self, ENLARGED) for what in ("velocity", "acceleration")}
        plates = [
            DrawingPlate(words[what], (drawn_at[1],) if drawn_at[1] else (), what, (lettered(drawn_at[0]),))
            for what, drawn_at in drawn.items()
            if drawn_at
        ]
        return {"motion": plates}
