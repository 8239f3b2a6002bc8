"""The derivation: quantities with their numbers, vectors, steps, and equations solved by projection."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from typing import Literal

from reportgen.exercise.instant_centres import Layout
from reportgen.exercise.point_positions import SAME_DIRECTION, direction_of, parallel
from reportgen.exercise.rate_solution import InstantMotion
from reportgen.formula import Chain, Expression, Negative, Number, Product, Ref, Symbol, cos, ids, sqrt, total
from reportgen.formula.calculation import Calculation, Family, is_short

# --- steps, as data for whoever writes them out ---------------------------------------------------


@dataclass(frozen=True, slots=True)
class Vector:
    """A vector by the id of its size, which is positive, and its direction (of length 1)."""

    id: str
    direction: complex


@dataclass(frozen=True, slots=True)
class DerivationEquation:
    """Σ left = Σ right, vectors; `unknown` are the ids of the two whose sizes are not known yet."""

    left: tuple[Vector, ...]
    right: tuple[Vector, ...]
    unknown: tuple[str, ...] = ()


Letter = Literal["ξ", "η", "x", "y"]


@dataclass(frozen=True, slots=True)
class Axis:
    """An axis that vectors are projected on, through a point, towards `direction`.

    ξ lies along the line that the words of the step name, away from the base point, and η perpendicular to it; x and y
    are those of the coordinates.
    """

    letter: Letter
    direction: complex
    point: str

    @property
    def along(self) -> complex:
        """The direction of ξ, of length 1, of which η is the other axis."""
        return self.direction if self.letter == "ξ" else self.direction / 1j


COORDINATES: tuple[tuple[complex, Letter], ...] = ((1 + 0j, "x"), (1j, "y"))
"""The axes of the coordinates, each by its direction and its letter."""


@dataclass(frozen=True, slots=True)
class Step:
    """Step for a body and points, with the ids of the lines computed in it.

    `kind` is the name of its words.
    """

    kind: str
    ids: tuple[str, ...]
    body: int = 0
    point: str = ""
    base: str = ""
    equation: DerivationEquation | None = None
    axes: tuple[Axis, ...] = ()
    """Axes of the equation's projections, in the order of the lines."""
    frame: int = 0
    """The moving body that the motion is seen from."""
    system: tuple[Chain, ...] = ()
    """Equations that are solved together, with their numbers."""
    results: tuple[Chain, ...] = ()
    """Results of the equations, with signs."""
    other: str = ""
    """A second base point."""
    read: tuple[str, ...] = ()
    """Ids read off the figure for its lines, and shown before them unless an earlier step has shown them."""

    @property
    def of_accelerations(self) -> bool:
        return self.kind.startswith(("acceleration", "system-eps", "train-eps", "block-eps"))


# --- the derivation ------------------------------------------------------------------------------------


class Quantities(Calculation):
    """A sheet on which a rate is nothing that is so beside the rates of the whole system: what floats leave of 0."""

    def __init__(self, positions: int, motion: InstantMotion) -> None:
        super().__init__(positions)
        # A hundred thousandth: what is small beside the other rates keeps its figures.
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
        """A quantity's value (SI)."""
        return float(self.families[quantity if isinstance(quantity, str) else quantity.id].at(None))


@dataclass
class Derivation:
    """Derivation so far: the sheet with its numbers, and the steps that led to them."""

    q: Calculation
    layout: Layout
    steps: list[Step] = field(default_factory=list)
    closed: bool = False
    """True if the loops of the system are already solved."""

    @property
    def motion(self) -> InstantMotion:
        return self.layout.motion

    def length(self, start_name: str, end_name: str, one_at: complex | None = None) -> Ref:
        """The distance of two points (m), by the name l.OA."""
        id = ids.length(start_name, end_name)
        if known := self.q.find(id) or self.q.find(ids.length(end_name, start_name)):
            return known
        start = self.layout.points[start_name] if one_at is None else one_at
        value = abs(self.layout.points[end_name] - start)
        return self.q.give(id, value, exact=is_short(value))

    def given(self, id: str, value: float) -> Ref:
        """A size (SI) that the file gives, entered once."""
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
        """The velocity of a point that is in the derivation."""
        return Vector(ids.velocity(point), direction_of(self.at(point)))

    def at(self, point: str, body: int | None = None) -> complex:
        """The velocity of a point (m/s), one of contact among them, as it moves with its own body or with another."""
        own = self.home(point) if body is None else body
        motion = self.motion
        v = motion.velocities.at(own, self.layout.points[point])
        return 0j if abs(v) < 1e-9 * motion.fastest else complex(v)

    def home(self, point: str) -> int:
        """The body that a point's motion is that of."""
        system = self.motion.system
        if point in system.points and system.body_of(point):
            return int(system.body_of(point))
        return next((body for body, names in self.layout.members.items() if point in names), 0)


# --- vectors along an axis ------------------------------------------------------------------------


def along(q: Calculation, vector: Vector, axis: complex) -> Expression | None:
    """The component of a vector along an axis, as it is written: v cos 30° with its sign; None where it is nothing."""
    cosine = (axis.conjugate() * vector.direction).real
    if abs(cosine) < SAME_DIRECTION or q.si(vector.id) == 0:
        return None
    size: Expression = q[vector.id]
    if abs(cosine) < 1 - SAME_DIRECTION**2 / 2 and not parallel(vector.direction, axis):
        size = Product((size, cos(angle(q, math.acos(min(abs(cosine), 1.0))))))
    return size if cosine > 0 else Negative(size)


def components(q: Calculation, vectors: Iterable[Vector], axis: complex) -> list[Expression]:
    """The components (SI) along an axis of length 1 of those vectors that have one."""
    projected = (along(q, vector, axis) for vector in vectors)
    return [one for one in projected if one is not None]


def solved_for(
    q: Calculation, unknown: complex, axis: complex, known: Sequence[Vector], opposite: Sequence[Vector]
) -> Expression:
    """The size (SI) of a vector of direction `unknown` from Σ opposite + unknown = Σ known, projected on an axis.

    The axis points so that the unknown's component is positive.
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
    """The size of a vector from its components along axes at right angles; one alone is the size but for its sign."""
    if len(sides) == 1:
        return sides[0] if q.si(sides[0]) >= 0 else Negative(sides[0])
    return sqrt(total([side**2 for side in sides]))


def towards(axis: complex, direction: complex) -> complex:
    """The axis, or its opposite, along which a vector of that direction, both of length 1, is positive."""
    return axis if (axis.conjugate() * direction).real > 0 else -axis


def _positive_first(terms: list[Expression]) -> list[Expression]:
    """The terms with a plus before those with a minus."""
    return sorted(terms, key=lambda term: isinstance(term, Negative))


def angle(q: Calculation, value: float) -> Expression:
    """An angle (radians) as it stands in a formula: a round one as its degrees, any other by a symbol α of its own."""
    degrees = math.degrees(value)
    if abs(degrees - round(degrees, 2)) < 1e-9:
        return Number(round(degrees, 2), None, "°")
    others = [id for id in q.families if id in ids.inner_angle]
    same = next((id for id in others if abs(q.si(id) - value) < SAME_DIRECTION), None)
    return q.give(ids.inner_angle(len(others) + 1), value, exact=False) if same is None else q[same]


# --- equations ------------------------------------------------------------------------------------


class Projected:
    """Σ left = Σ right, with the lines that are worked out of it and the axes that it is projected on.

    What the derivation does not know at the beginning is unknown in it.
    """

    def __init__(
        self, derivation: Derivation, left: tuple[Vector, ...], right: tuple[Vector, ...], lines: tuple[str, ...] = ()
    ) -> None:
        unknown = tuple(one.id for one in (*left, *right) if not derivation.knows(one.id))
        self.derivation, self.equation = derivation, DerivationEquation(left, right, unknown)
        self.lines, self.axes = lines, tuple[Axis, ...]()

    def find(self, vector: Vector, axis: complex, letter: Letter, point: str, symbol: Symbol | str = "") -> Ref:
        """Enters a vector's size (SI) by projection on an axis through a point, to which any other unknown is normal.

        ξ is drawn as it is given, η towards what is found.
        """
        left, right = self.equation.left, self.equation.right
        here, there = (left, right) if vector in left else (right, left)
        others = [one for one in here if one != vector]
        size = solved_for(self.derivation.q, vector.direction, axis, there, others)
        self.axes += (Axis(letter, axis if letter == "ξ" else towards(axis, vector.direction), point),)
        return self.then(self.derivation.q.define(vector.id, size, symbol))

    def find_sum(self, what: str, point: str) -> None:
        """Enters the size of what the right side adds up to, v or a of a point, from its components along x and y."""
        q, component, sides = self.derivation.q, ids.COMPONENT[what], []
        for axis, letter in COORDINATES:
            if terms := components(q, self.equation.right, axis):
                side = q.define(component(point, letter), total(terms), Symbol(what, f"{point}{letter}"))
                sides.append(self.then(side))
                self.axes += (Axis(letter, axis, point),)
        self.then(q.define(ids.POINT_RATE[what](point), size_of(q, sides)))

    def then(self, line: Ref) -> Ref:
        """Puts a line that follows behind those before it."""
        self.lines += (line.id,)
        return line

    def step(self, kind: str, body: int, point: str, base: str = "") -> None:
        """Puts the step in the derivation that all this was."""
        step = Step(kind, self.lines, body, point, base, equation=self.equation, axes=self.axes)
        self.derivation.steps.append(step)
