"""What the templates of an exercise see of a given quantity, of a step and of a further solution."""

from __future__ import annotations

from dataclasses import dataclass

from reportgen.catalogue.plane_motion_symbols import symbol
from reportgen.document.prose import PointName
from reportgen.document.tree import Equation, Inlines
from reportgen.notation.expressions import Chain, Expression, Symbol, substitute


@dataclass(frozen=True)
class GivenItem:
    """A given quantity: the key of its words, and what they name."""

    form: str
    point: PointName
    body: int
    value: Chain | Symbol
    way: Inlines = ()


@dataclass(frozen=True)
class StepView:
    """A step as templates name it."""

    kind: str
    body: int
    point: PointName
    base: PointName
    centre: PointName
    one: PointName
    other: PointName
    """The points whose normals meet in the centre."""
    lines: tuple[Equation, ...]
    equation: tuple[Equation, ...]
    angles: tuple[Inlines, ...]
    sense: str
    way: str
    place: Inlines
    """The coordinates of the instant centre."""
    system: tuple[Equation, ...]
    results: tuple[Equation, ...]
    contact: PointName | str
    """The point that the body rolls on the ground with, if it is one of the two that the step is about."""


@dataclass(frozen=True)
class WayView:
    """A further solution as templates name it."""

    name: str
    steps: tuple[StepView, ...]


def lettered(formula: Expression) -> Expression:
    """A formula over the names of symbols with the letters that are printed for them."""
    return substitute(formula, lambda ref: symbol(ref.id))


def pretty(typed: str) -> str:
    """A unit as typed, with its powers raised: mm/s2 → mm/s²."""
    return typed.replace("s2", "s²").replace("^", "")
