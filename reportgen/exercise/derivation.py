"""The derivation of an exercise: quantities with their numbers, vectors, steps, and equations solved by projection.

Every step module enters its results in a `Derivation`; `Projected` solves a vector equation on an axis.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import Literal

from reportgen.base.records import Record, replace
from reportgen.exercise.instant_centres import Layout
from reportgen.exercise.point_positions import SAME_DIRECTION, direction_of, parallel
from reportgen.exercise.rate_solution import InstantMotion
from reportgen.formula import Chain, Expression, Negative, Number, Product, Ref, Symbol, cos, ids, sqrt, total
from reportgen.formula.calculation import Calculation, Family, is_short

# --- steps, as data for the page ----------------------------------------------------------------------


class Vector(Record):
    """A vector: the id of its magnitude, which is positive, and its unit direction."""

    id: str
    direction: complex


class DerivationEquation(Record):
    """Σ left = Σ right, as vectors; `unknown` are the ids of the two vectors whose magnitudes are not known yet."""

    left: tuple[Vector, ...]
    right: tuple[Vector, ...]
    unknown: tuple[str, ...] = ()


Letter = Literal["ξ", "η", "x", "y"]


class Axis(Record):
    """An axis through a point, on which vectors are projected; `direction` is its unit vector.

    ξ lies along the line that the text of the step names, away from the base point, and η perpendicular to it; x and y
    are the axes of the coordinates.
    """

    letter: Letter
    direction: complex
    point: str

    @property
    def along(self) -> complex:
        """Return the unit direction of ξ, also if this axis is the η that belongs to it."""
        return self.direction if self.letter == "ξ" else self.direction / 1j


COORDINATES: tuple[tuple[complex, Letter], ...] = ((1 + 0j, "x"), (1j, "y"))
"""The coordinate axes, each by its direction and its letter."""


class Step(Record):
    """A step for a body and points, with the ids of the lines that it computes; `kind` is the key of its text."""

    kind: str
    ids: tuple[str, ...]
    body: int = 0
    point: str = ""
    base: str = ""
    equation: DerivationEquation | None = None
    axes: tuple[Axis, ...] = ()
    """Axes of the equation's projections, in the order of the lines."""
    frame: int = 0
    """The moving body that is the frame of reference."""
    system: tuple[Chain, ...] = ()
    """Equations that are solved together, with their numbers."""
    results: tuple[Chain, ...] = ()
    """Results of the equations, with signs."""
    second_base: str = ""
    """A second base point."""
    read: tuple[str, ...] = ()
    """Ids that are read off the figure; they are printed before the lines unless an earlier step has printed them."""

    @property
    def of_accelerations(self) -> bool:
        return self.kind.startswith(("acceleration", "system-eps", "train-eps", "block-eps"))


# --- the derivation ------------------------------------------------------------------------------------


class Quantities(Calculation):
    """A calculation in which a rate that is negligible beside the other rates of the system is 0: rounding errors
    vanish.
    """

    def __init__(self, positions: int, motion: InstantMotion) -> None:
        super().__init__(positions)
        # A rate below a hundred thousandth of the others still keeps its digits.
        fast, steep = motion.fastest * 1e-5, motion.steepest * 1e-5
        self.scales = {
            "velocity": fast,
            "angular velocity": fast / motion.size,
            "acceleration": steep,
            "angular acceleration": steep / motion.size,
        }

    def enter(self, family: Family) -> Ref:
        return super().enter(replace(family, scale=family.scale or self.scales.get(family.kind, 0.0)))

    def si(self, quantity: str | Ref) -> float:
        """Return a quantity's value (SI)."""
        return float(self.families[quantity if isinstance(quantity, str) else quantity.id].at(None))


@dataclass
class Derivation:
    """The derivation so far: the calculation with its numbers, and the steps that led to them."""

    q: Calculation
    layout: Layout
    steps: list[Step] = field(default_factory=list)
    closed: bool = False
    """True if the loops of the system are already solved."""

    @property
    def motion(self) -> InstantMotion:
        return self.layout.motion

    def length(self, start_name: str, end_name: str, one_at: complex | None = None) -> Ref:
        """Return the distance of two points (m), named l.OA; it is entered on first use."""
        id = ids.length(start_name, end_name)
        if known := self.q.find(id) or self.q.find(ids.length(end_name, start_name)):
            return known
        start = self.layout.points[start_name] if one_at is None else one_at
        value = abs(self.layout.points[end_name] - start)
        return self.q.give(id, value, exact=is_short(value))

    def given(self, id: str, value: float) -> Ref:
        """Return a magnitude (SI) that the file gives; it is entered once."""
        return self.q.find(id) or self.q.give(id, abs(value), exact=is_short(abs(value)))

    def knows(self, id: str) -> bool:
        return id in self.q

    def knows_omega(self, body: int) -> bool:
        return ids.angular_velocity(body) in self.q

    def knows_epsilon(self, body: int) -> bool:
        return ids.angular_acceleration(body) in self.q

    def knows_velocity(self, point: str) -> bool:
        return ids.velocity(point) in self.q

    def nonzero(self, *vectors: Vector) -> tuple[Vector, ...]:
        """Return the vectors that are in the derivation and are not zero."""
        return tuple(vector for vector in vectors if self.knows(vector.id) and self.q.si(vector.id))

    def velocity(self, point: str) -> Vector:
        """Return the velocity of a point that is in the derivation."""
        return Vector(ids.velocity(point), direction_of(self.at(point)))

    def at(self, point: str, body: int | None = None) -> complex:
        """Return the velocity of a point (m/s) as it moves with its own body or with `body`, for a point of contact."""
        own = self.home(point) if body is None else body
        motion = self.motion
        v = motion.velocities.at(own, self.layout.points[point])
        return 0j if abs(v) < 1e-9 * motion.fastest else complex(v)

    def home(self, point: str) -> int:
        """Return the body with which a point moves."""
        system = self.motion.system
        if point in system.points and system.body_of(point):
            return int(system.body_of(point))
        return next((body for body, names in self.layout.members.items() if point in names), 0)


# --- vectors along an axis ------------------------------------------------------------------------


def along(q: Calculation, vector: Vector, axis: complex) -> Expression | None:
    """Return the component of a vector along an axis as printed: v cos 30° with its sign; None where it is zero."""
    cosine = (axis.conjugate() * vector.direction).real
    if abs(cosine) < SAME_DIRECTION or q.si(vector.id) == 0:
        return None
    size: Expression = q[vector.id]
    if abs(cosine) < 1 - SAME_DIRECTION**2 / 2 and not parallel(vector.direction, axis):
        size = Product((size, cos(angle(q, math.acos(min(abs(cosine), 1.0))))))
    return size if cosine > 0 else Negative(size)


def components(q: Calculation, vectors: Iterable[Vector], axis: complex) -> list[Expression]:
    """Return the nonzero components (SI) of vectors along a unit axis."""
    projected = (along(q, vector, axis) for vector in vectors)
    return [one for one in projected if one is not None]


def solved_for(
    q: Calculation, unknown: complex, axis: complex, known: Sequence[Vector], opposite: Sequence[Vector]
) -> Expression:
    """Return the magnitude (SI) of a vector of direction `unknown` from Σ opposite + unknown = Σ known, projected on an
    axis.

    The axis points so that the component of the unknown is positive.
    """
    axis = towards(axis, unknown)
    cosine = (axis.conjugate() * unknown).real
    terms = components(q, known, axis)
    terms += [one.of if isinstance(one, Negative) else Negative(one) for one in components(q, opposite, axis)]
    sum_of = total(_positive_first(terms)) if terms else Number(0.0)
    if parallel(unknown, axis):
        return sum_of
    return sum_of / cos(angle(q, math.acos(min(cosine, 1.0))))


def size_of(q: Calculation, sides: Sequence[Ref]) -> Expression:
    """Return the magnitude of a vector from its components along perpendicular axes; one component alone loses its
    sign.
    """
    if len(sides) == 1:
        return sides[0] if q.si(sides[0]) >= 0 else Negative(sides[0])
    return sqrt(total([side**2 for side in sides]))


def towards(axis: complex, direction: complex) -> complex:
    """Return the axis or its opposite, so that a vector of `direction` has a positive component; both have length 1."""
    return axis if (axis.conjugate() * direction).real > 0 else -axis


def _positive_first(terms: list[Expression]) -> list[Expression]:
    """Return the terms, those with a plus sign first."""
    return sorted(terms, key=lambda term: isinstance(term, Negative))


def angle(q: Calculation, value: float) -> Expression:
    """Return an angle (rad) for a formula: a round one in degrees, any other as a symbol α with an index."""
    degrees = math.degrees(value)
    if abs(degrees - round(degrees, 2)) < 1e-9:
        return Number(round(degrees, 2), None, "°")
    others = [id for id in q.families if id in ids.inner_angle]
    same = next((id for id in others if abs(q.si(id) - value) < SAME_DIRECTION), None)
    return q.give(ids.inner_angle(len(others) + 1), value, exact=False) if same is None else q[same]


# --- equations ------------------------------------------------------------------------------------


class Projected:
    """The equation Σ left = Σ right, with the lines worked out from it and the axes on which it is projected.

    A vector is unknown if the derivation does not contain it when the equation is made.
    """

    def __init__(
        self, derivation: Derivation, left: tuple[Vector, ...], right: tuple[Vector, ...], lines: tuple[str, ...] = ()
    ) -> None:
        unknown = tuple(one.id for one in (*left, *right) if not derivation.knows(one.id))
        self.derivation, self.equation = derivation, DerivationEquation(left, right, unknown)
        self.lines, self.axes = lines, tuple[Axis, ...]()

    def find(self, vector: Vector, axis: complex, letter: Letter, point: str, symbol: Symbol | str = "") -> Ref:
        """Enter the magnitude (SI) of a vector by projection on an axis through a point that is normal to any other
        unknown.

        ξ is drawn as given, η towards the vector.
        """
        left, right = self.equation.left, self.equation.right
        here, there = (left, right) if vector in left else (right, left)
        others = [one for one in here if one != vector]
        size = solved_for(self.derivation.q, vector.direction, axis, there, others)
        self.axes += (Axis(letter, axis if letter == "ξ" else towards(axis, vector.direction), point),)
        return self.then(self.derivation.q.define(vector.id, size, symbol))

    def find_sum(self, what: str, point: str) -> None:
        """Enter the magnitude of the sum of the right side, `what` (v or a) of a point, from its components along x and
        y.
        """
        q, component, sides = self.derivation.q, ids.COMPONENT[what], []
        for axis, letter in COORDINATES:
            if terms := components(q, self.equation.right, axis):
                side = q.define(component(point, letter), total(terms), Symbol(what, f"{point}{letter}"))
                sides.append(self.then(side))
                self.axes += (Axis(letter, axis, point),)
        self.then(q.define(ids.POINT_RATE[what](point), size_of(q, sides)))

    def then(self, line: Ref) -> Ref:
        """Append a line to the lines of the equation."""
        self.lines += (line.id,)
        return line

    def step(self, kind: str, body: int, point: str, base: str = "") -> None:
        """Append the step that this equation makes to the derivation."""
        step = Step(kind, self.lines, body, point, base, equation=self.equation, axes=self.axes)
        self.derivation.steps.append(step)
