"""The steps of a worked exercise, as data for whoever writes them out."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from reportgen.ledger.instant.vectors import Vector
from reportgen.notation.expressions import Chain


@dataclass(frozen=True, slots=True)
class Equation:
    """Σ left = Σ right, vectors; `unknown` are the ids of the two whose sizes are not known yet."""

    left: tuple[Vector, ...]
    right: tuple[Vector, ...]
    unknown: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Axis:
    """An axis that vectors are projected on, through a point, towards `way`.

    ξ lies along the line that the words of the step name, away from the base point, and η perpendicular to it; x and y
    are those of the coordinates.
    """

    letter: Literal["ξ", "η", "x", "y"]
    way: complex
    point: str

    @property
    def along(self) -> complex:
        """The direction of ξ, of which η is the other axis."""
        return self.way if self.letter == "ξ" else self.way / 1j


COORDINATES: tuple[tuple[complex, Literal["x", "y"]], ...] = ((1 + 0j, "x"), (1j, "y"))
"""The axes of the coordinates, each by its direction and its letter."""


@dataclass(frozen=True, slots=True)
class Step:
    """What is done of which body and points, and the ids of the lines that are worked out in it.

    `kind` is the name of its words.
    """

    kind: str
    ids: tuple[str, ...]
    body: int = 0
    point: str = ""
    base: str = ""
    equation: Equation | None = None
    axes: tuple[Axis, ...] = ()
    """What the equation is projected on, in the order of the lines."""
    frame: int = 0
    """The moving body that the motion is seen from."""
    system: tuple[Chain, ...] = ()
    """Equations that are solved together, with their numbers."""
    results: tuple[Chain, ...] = ()
    """What they come to, with signs."""

    @property
    def of_accelerations(self) -> bool:
        return self.kind.startswith(("acceleration", "system-eps", "train-eps", "block-eps"))
