"""What a value is worth and how near it must be: the marking policy, from a YAML file or as it stands here.

    tolerance:
      paper: 0.5 mm          # how far off each end of a measured length may lie
      digits: 3              # figures that values are computed with
      share: 0.005           # of the quantity's maximum over the turn
    points: {right: 1, follows: 1}
    weights:                 # by id of the quantity, the first pattern that fits; 0: not marked
      "seg.*": 0.5
      "M.eq": 5
    guard: true              # stock answers earn nothing
    show_answers: true       # the feedback tells the right values
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Annotated

from reportgen.answers.bands import DIGITS, PAPER_ERROR
from reportgen.assignment.common import Part
from reportgen.assignment.fields import Decimal, Flag, Interval, Whole, quantity
from reportgen.assignment.reading import read_model
from reportgen.notation.numbers import Language
from reportgen.units import Given


@dataclass(frozen=True, slots=True)
class Policy:
    """Tolerances (`paper` in m) and points; `weights` by patterns of ids."""

    paper: float = PAPER_ERROR
    digits: int = DIGITS
    share: float = 0.005
    right: float = 1.0
    follows: float = 1.0
    weights: Mapping[str, float] = field(default_factory=dict)
    guard: bool = True
    show_answers: bool = True

    def worth(self, id: str) -> float:
        """The points that a quantity is worth at one position."""
        return next((weight for pattern, weight in self.weights.items() if fnmatchcase(id, pattern)), 1.0)


class Tolerance(Part):
    paper: Annotated[Given | None, quantity("mm", least=0, most=5)] = None
    digits: Annotated[int, Whole(2, 6)] = DIGITS
    share: Annotated[float, Decimal(Interval(least=0, most=0.2))] = 0.005


class Points(Part):
    right: Annotated[float, Decimal(Interval(least=0, most=100))] = 1.0
    follows: Annotated[float, Decimal(Interval(least=0, most=100))] = 1.0


class PolicyFile(Part):
    tolerance: Tolerance = Tolerance()
    points: Points = Points()
    weights: dict[str, Annotated[float, Decimal(Interval(least=0, most=1000))]] = {}  # noqa: RUF012
    guard: Annotated[bool, Flag()] = True
    show_answers: Annotated[bool, Flag()] = True


def read_policy(path: Path, language: Language | None = None) -> Policy:
    """The policy of a file; raises `AssignmentError` with all its faults, located."""
    content = read_model(path, PolicyFile, language)
    tolerance, points = content.tolerance, content.points
    return Policy(
        PAPER_ERROR if tolerance.paper is None else tolerance.paper.si,
        tolerance.digits,
        tolerance.share,
        points.right,
        points.follows,
        content.weights,
        content.guard,
        content.show_answers,
    )
