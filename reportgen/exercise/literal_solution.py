"""The literal solution: every quantity of the derivation as an expression of the symbols in the file.

The conditions that give the numbers are solved again with symbols; magnitudes, senses and the choice between two
possible positions are those at the symbols' values.  `LiteralBoard` looks up an expression by id.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, cast

from reportgen.base.errors import NotOfferedError
from reportgen.base.units import Given
from reportgen.base.words import word
from reportgen.case import LoadedAssignment
from reportgen.exercise import algebra, file
from reportgen.exercise.algebra import Algebraic, Plane
from reportgen.exercise.ledger import Worked, work_out
from reportgen.exercise.literal_symbols import Literal
from reportgen.exercise.point_positions import Exercise, Geometry, carried, conditions, exercise_of
from reportgen.exercise.rate_conditions import GROUND, Condition, Rates, Velocities
from reportgen.exercise.rate_solution import System
from reportgen.formula import Expression, ids
from reportgen.formula.constructions import dot

ZERO = Plane(0, 0)
LONGEST = 40
"""Expressions with more operations are not printed: they fill more than a line and say little."""
WITHIN_WORDS = 20
"""Coordinates with more operations are not printed: they are set within a sentence or a table."""
MOST = 100
"""Expressions with more operations are not simplified, which may take minutes; published examples have at most 73."""


def symbolic(given: Given) -> Algebraic:
    """Return a quantity of the file by its formula, or the number that was typed."""
    if isinstance(given, Literal):
        return algebra.algebraic(given.formula, algebra.symbol)
    return algebra.exact(float(f"{given.si:.15g}"))


class LiteralGeometry(Geometry):
    """The points and lines of a file by symbols."""

    def __init__(self, exercise: Exercise) -> None:
        points: dict[str, Plane] = {}
        super().__init__(exercise.given, points)
        self.numbers = Geometry(exercise.given, exercise.motion.system.points)
        for name, point in exercise.given.points.items():
            points[name] = self.place(point)

    def size(self, given: Given) -> Algebraic:
        return symbolic(given)

    def unit(self, angle: Given) -> Plane:
        return algebra.exact_unit(math.degrees(angle.si))

    def point(self, x: Algebraic, y: Algebraic) -> Plane:
        return Plane(x, y)

    def root(self, of: Algebraic) -> Plane:
        """Return a vector along x, so that it can be turned like a number."""
        return Plane.of(algebra.root(of))

    def is_inner(self, joint: file.RollingOnCircle | file.Gears) -> bool:
        return self.numbers.is_inner(joint)


class LiteralMotion:
    """The velocities and accelerations of an exercise by symbols."""

    def __init__(self, exercise: Exercise) -> None:
        self.geometry = LiteralGeometry(exercise)
        self.bare = System(self.geometry.points, carried(exercise.given), ())
        self.bodies = tuple(self.bare.bodies)
        self.conditions = tuple(conditions(self.geometry, self.bare))

    @cached_property
    def velocities(self) -> Velocities:
        return Velocities(self._solve([(one, one.velocity) for one in self.conditions if one.velocity is not None]))

    @cached_property
    def accelerations(self) -> Mapping[int, Rates]:
        motion, equations = self.velocities, []
        for condition in self.conditions:
            if condition.drift is not None:
                inward = (
                    motion.omega(part.body) ** 2 * dot(Plane.of(part.direction), part.point)
                    for part in condition.components
                )
                equations.append((condition, condition.drift(motion) + sum(inward)))
        return self._solve(equations)

    def v(self, point: str) -> Plane:
        return self.at(point, self.bare.body_of(point))

    def at(self, point: str, body: int) -> Plane:
        return Plane.of(self.velocities.at(body, self.geometry.points[point]))

    def a(self, point: str) -> Plane:
        body, place = self.bare.body_of(point), self.geometry.points[point]
        rates, omega = self.accelerations[body], self.velocities.omega(body)
        return Plane.of(rates.origin + rates.turn * (1j * place) - omega**2 * place)

    def _solve(self, equations: list[tuple[Condition, Any]]) -> dict[int, Rates]:
        unknowns = algebra.solve([self._row(one) for one, _ in equations], [value for _, value in equations])
        rates = {}
        for index, body in enumerate(self.bodies):
            turn, x, y = unknowns[3 * index : 3 * index + 3]
            # Addition and multiplication of `Plane` are those of complex numbers.
            rates[body] = Rates(cast("float", turn), cast("complex", Plane(x, y)))
        return rates

    def _row(self, condition: Condition) -> list[Algebraic]:
        row: list[Algebraic] = [0] * (3 * len(self.bodies))
        for part in condition.components:
            if part.body != GROUND:
                at, direction = 3 * self.bodies.index(part.body), Plane.of(part.direction)
                row[at] += dot(direction, 1j * part.point)
                row[at + 1] += direction.real
                row[at + 2] += direction.imag
        for body, factor in condition.turns:
            if body != GROUND:
                row[3 * self.bodies.index(body)] += algebra.exact(factor)
        return row


def _short(of: Any, simplify: Callable[[Any], Algebraic], most: int = LONGEST) -> Algebraic | None:
    """Return the simplified expression; None if it is too long."""
    if algebra.operations(of) > MOST:
        return None
    simplified = simplify(of)
    return None if algebra.operations(simplified) > most else simplified


class LiteralBoard:
    """Quantities of a derivation by symbols, each computed on request."""

    def __init__(self, exercise: Exercise, worked: Worked) -> None:
        self.exercise, self.worked = exercise, worked
        self.motion = LiteralMotion(exercise)
        self.at = {name: one.given.si for name, one in exercise.given.symbols.items()}
        self._values: dict[str, Algebraic | None] = {}

    def __getitem__(self, id: str) -> Expression | None:
        """Return a quantity as an expression over the names of symbols; None if there is none or it is too long."""
        known = self.algebraic(id)
        return None if known is None else algebra.expression(known, self.at)

    def place(self, point: str) -> tuple[Expression, Expression] | None:
        """Return the coordinates (m) of a point or instant centre; None if they would be too long."""
        at = {**self._centres, **self.motion.geometry.points}[point]
        x, y = (_short(part, algebra.simplified, WITHIN_WORDS) for part in (at.real, at.imag))
        return None if x is None or y is None else (algebra.expression(x, self.at), algebra.expression(y, self.at))

    def algebraic(self, id: str) -> Algebraic | None:
        if id not in self._values:
            whole = self._of(id)
            self._values[id] = None if whole is None else _short(whole, lambda of: algebra.size(of, self.at))
        return self._values[id]

    def _of(self, id: str) -> Any:
        """Return the number or vector whose magnitude the quantity is: from the motion, otherwise by the formula of its
        line.
        """
        points = self.motion.geometry.points
        if names := ids.angular_velocity.read(id):
            return self.motion.velocities.omega(int(names["link"]))
        if names := ids.angular_acceleration.read(id):
            return self.motion.accelerations[int(names["link"])].turn
        if (names := ids.velocity.read(id)) and names["point"] in points:
            return self.motion.v(names["point"])
        if (names := ids.acceleration.read(id)) and names["point"] in points and not names["part"]:
            return self.motion.a(names["point"])
        if names := ids.length.read(id):
            return self._between(*ids.points(names["line"]))
        definition = self.worked.ledger[id].definition
        return None if definition is None else algebra.algebraic(definition, self.algebraic)

    def _between(self, tip: str, base: str) -> Plane | None:
        """Return the vector from `base` to `tip`; None if one of the positions is not known by symbols, as the end of a
        belt.
        """
        places = {**self.motion.geometry.points, **self._centres}
        return places[tip] - places[base] if tip in places and base in places else None

    @cached_property
    def _centres(self) -> dict[str, Plane]:
        """Return the instant centres, where a body's velocity is zero, and the points in which discs touch, by name."""
        places, geometry, layout = {}, self.motion.geometry, self.worked.layout
        for index, joint in enumerate(self.exercise.given.joints):
            match joint:
                case file.RollingOnLine():
                    places[layout.contacts[index]] = geometry.contact_on_line(joint)
                case file.RollingOnCircle() | file.Gears():
                    places[layout.contacts[index]] = geometry.contact_of_discs(joint)
        for body, centre in self.worked.layout.centres.items():
            if centre.rule in ("normals", "rate", "contact") and self.motion.velocities.omega(body) != 0:
                rates = self.motion.velocities.of(body)
                places[centre.name] = Plane.of((1j * rates.origin) / rates.turn)
        return places


# --- an exercise with all computed results ------------------------------------------------------------
# Each result is computed when it is first requested.


@dataclass(frozen=True)
class SolvedExercise(LoadedAssignment):
    """One instant of a system in plane motion, solved by steps."""

    @cached_property
    def exercise(self) -> Exercise:
        """Return the system and the questions about it."""
        return exercise_of(self.assignment)

    @cached_property
    def worked(self) -> Worked:
        """Return the steps of its solution with their numbers.

        Raises `NotOfferedError` if no known steps lead to a requested quantity.
        """
        first = next(iter(self.exercise.given.methods), None)
        worked = work_out(self.exercise, self.unit_names, self.words["symbols"], first)
        if worked.missing:
            raise NotOfferedError(word("no_steps", self.assignment.language, asked=", ".join(worked.missing)))
        return self._by_its_method(worked)

    @cached_property
    def further(self) -> tuple[Worked, ...]:
        """Return the velocities worked out anew by each further method that the file requests.

        Raises `NotOfferedError` for a method without known steps.
        """
        rest = self.exercise.given.methods[1:]
        each = (work_out(self.exercise, self.unit_names, self.words["symbols"], one, True) for one in rest)
        return tuple(map(self._by_its_method, each))

    @cached_property
    def alone(self) -> tuple[Worked, ...]:
        """Return the velocities by each method that the file requests, using only results of that method."""
        if not self.exercise.given.methods:
            return ()
        first = self.exercise.given.methods[0]
        return (work_out(self.exercise, self.unit_names, self.words["symbols"], first, True), *self.further)

    def _by_its_method(self, worked: Worked) -> Worked:
        if not worked.by_method:
            raise NotOfferedError(word("no_method_steps", self.assignment.language, method=worked.method))
        return worked

    @cached_property
    def literal(self) -> LiteralBoard | None:
        """Return the quantities of the solution by symbols; None if the file has no symbols."""
        return LiteralBoard(self.exercise, self.worked) if self.exercise.given.literal else None
