"""The steps of a worked exercise, as data for whoever writes them out."""

from __future__ import annotations

from dataclasses import dataclass

from reportgen.ledger.instant.vectors import Vector
from reportgen.notation.expressions import Chain


@dataclass(frozen=True, slots=True)
class Equation:
    """Σ left = Σ right, vectors; `unknown` are the ids of the two whose sizes are not known yet."""

    left: tuple[Vector, ...]
    right: tuple[Vector, ...]
    unknown: tuple[str, ...] = ()


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
    system: tuple[Chain, ...] = ()
    """Equations that are solved together, with their numbers."""
    results: tuple[Chain, ...] = ()
    """What they come to, with signs."""
