"""Exercises of plane motion: one instant of a system of rigid bodies, as the file declares it.

There is no machine in it: no driver that goes round, no positions, no forces.  So its case is one of its own.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from reportgen.catalogue.plane_motion_checks import check
from reportgen.catalogue.plane_motion_file import Asked, Parameters
from reportgen.catalogue.plane_motion_places import system
from reportgen.plane_motion.motion import Motion

if TYPE_CHECKING:
    from reportgen.assignment import Assignment
    from reportgen.exercise_case import ExerciseCase

TURNS = 1
HAS_POSITIONS = False
CHECKS = (check,)


@dataclass(frozen=True)
class Exercise:
    """A system in motion at one instant, and what is to be found of it."""

    given: Parameters
    motion: Motion

    @property
    def asked(self) -> tuple[Asked, ...]:
        return self.given.find


def exercise(assignment: Assignment) -> Exercise:
    """The exercise of an assignment that is in order."""
    given: Parameters = assignment.parameters
    return Exercise(given, Motion(system(given)))


def case(assignment: Assignment) -> ExerciseCase:
    """The case of an assignment."""
    from reportgen.exercise_case import ExerciseCase

    return ExerciseCase(assignment)
