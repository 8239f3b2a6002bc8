"""Solve the conditions for the velocities, then the accelerations of all bodies, as two linear systems.

Both systems share one matrix except for the given quantities.  Conditions are taken in file order; one that follows
from earlier ones is redundant if its value fits, otherwise it *contradicts* them.  The null space of the matrix is the
motion left open: a quantity that changes in it is *undetermined*.  `InstantMotion` gives the rates of bodies and
points, conflicts, and instant centres.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from functools import cached_property

import numpy as np

from reportgen.base.records import Record, replace
from reportgen.exercise.rate_conditions import GROUND, STILL, Component, Condition, Rates, Velocities

NEGLIGIBLE = 1e-9
"""A number below this share of its scale counts as 0."""

EquationRow = np.ndarray


class System(Record):
    """Points (m) by name, bodies by number with the points that move with them, and conditions in file order."""

    points: Mapping[str, complex]
    bodies: Mapping[int, tuple[str, ...]]
    conditions: tuple[Condition, ...]

    def body_of(self, point: str) -> int:
        """Return the first body that carries a point; the ground if none does."""
        return next((body for body, points in self.bodies.items() if point in points), GROUND)


class Conflict(Record):
    """A condition that contradicts the conditions named in `others`, all by their names in the file."""

    name: str
    others: tuple[str, ...]


class Solved(Record):
    """Rates of all bodies, or the conflicts that exclude them.

    `free` [number of free motions, number of unknowns] are the motions that the conditions leave open, over the
    unknowns of `Unknowns`.
    """

    rates: Mapping[int, Rates]
    conflicts: tuple[Conflict, ...]
    free: np.ndarray
    unknowns: Unknowns

    def determines_turn(self, body: int) -> bool:
        return self._fixed(self.unknowns.row(Condition("", turns=((body, 1.0),))))

    def determines_point(self, body: int, point: complex) -> bool:
        """Return True if the velocity of a body's point (m) is determined."""
        axes = (Condition("", (Component(body, point, axis),)) for axis in (1 + 0j, 1j))
        return all(self._fixed(self.unknowns.row(axis)) for axis in axes)

    def _fixed(self, row: EquationRow) -> bool:
        return bool(np.all(np.abs(self.free @ row) < NEGLIGIBLE * max(float(np.linalg.norm(row)), NEGLIGIBLE)))


class Unknowns(Record):
    """The unknowns: for each body its turn (times the size of the system) and two components at the middle.

    Lengths are measured from the middle of all points in units of their spread, so matrix entries are of order 1.
    `squared` are bodies whose ω² is an unknown, too.
    """

    bodies: tuple[int, ...]
    middle: complex
    size: float
    squared: tuple[int, ...] = ()

    @property
    def count(self) -> int:
        return 3 * len(self.bodies) + len(self.squared)

    def place(self, point: complex) -> complex:
        """Return the vector from the middle of the system to a point (m), in units of the system's size."""
        return (point - self.middle) / self.size

    def row(self, condition: Condition) -> EquationRow:
        row = np.zeros(self.count)
        for part in condition.components:
            if part.body == GROUND:
                continue
            at, place = 3 * self.bodies.index(part.body), self.place(part.point)
            unit = part.direction.conjugate()
            row[at] += (unit * 1j * place).real
            row[at + 1] += part.direction.real
            row[at + 2] += part.direction.imag
            if part.body in self.squared:
                row[3 * len(self.bodies) + self.squared.index(part.body)] -= (unit * place).real
        for body, factor in condition.turns:
            if body != GROUND:
                row[3 * self.bodies.index(body)] += factor
        return row

    def scaled(self, condition: Condition, value: float) -> float:
        """Return a condition's value in the units of the unknowns: turns are ω times the size of the system."""
        return value * self.size if condition.turns else value

    def rates(self, values: np.ndarray) -> dict[int, Rates]:
        """Return the rates (rad/s, m/s) of the bodies from the unknowns [3 × bodies + squared]."""
        rates_of: dict[int, Rates] = {}
        for index, body in enumerate(self.bodies):
            turn, x, y = values[3 * index : 3 * index + 3]
            rates_of[body] = Rates(turn / self.size, complex(x, y) - 1j * turn / self.size * self.middle)
        return rates_of

    def squares(self, values: np.ndarray) -> dict[int, float]:
        """Return ω² (rad²/s²) of the bodies in `squared` from the unknowns [3 × bodies + squared]."""
        last = values[3 * len(self.bodies) :]
        return {body: float(value) / self.size for body, value in zip(self.squared, last, strict=True)}


def unknowns_of(system: System) -> Unknowns:
    places = np.array(list(system.points.values()))
    middle = complex(places.mean())
    size = float(np.abs(places - middle).max())
    return Unknowns(tuple(system.bodies), middle, size if size > 0 else 1.0)


def solve_velocities(system: System) -> Solved:
    """Return the angular velocities and velocities of all bodies, with free motions and conflicts."""
    unknowns = unknowns_of(system)
    driven = [(condition, condition.velocity) for condition in system.conditions if condition.velocity is not None]
    return _solve(unknowns, driven)[0]


class Accelerations(Record):
    """Solved accelerations; `velocities` includes the angular velocities that only accelerations determine.

    Bodies in `parting` would need a negative ω²: the given accelerations move their points away from each other.
    """

    solved: Solved
    velocities: Solved
    parting: tuple[int, ...] = ()


def solve_accelerations(system: System, velocities: Solved) -> Accelerations:
    """Return the angular accelerations and accelerations of all bodies, after their velocities.

    A body without joints and with unknown angular velocity may have given accelerations: then ω² is an unknown like ε,
    and ω is its positive root, since accelerations do not determine the sense of rotation.
    """
    squared = tuple(body for body in system.bodies if _turns_unknown(system, velocities, body))
    unknowns = replace(velocities.unknowns, squared=squared)
    known = {body: STILL if body in squared else rates for body, rates in velocities.rates.items()}
    motion = Velocities(known)
    driven: list[tuple[Condition, float]] = []
    for condition in system.conditions:
        if condition.drift is not None:
            inward = (motion.omega(part.body) ** 2 * _along(part, unknowns.middle) for part in condition.components)
            driven.append((condition, condition.drift(motion) + sum(inward)))
    solved, squares_of = _solve(unknowns, driven)
    squares = unknowns.squares(squares_of)
    turned = {
        body: replace(rates, turn=float(np.sqrt(max(squares[body], 0.0)))) if body in squares else rates
        for body, rates in velocities.rates.items()
    }
    # From the middle to the origin: a(0) = a(m) − iε m + ω² m.
    at_origin = {
        body: replace(rates, origin=rates.origin + squares.get(body, motion.omega(body) ** 2) * unknowns.middle)
        for body, rates in solved.rates.items()
    }
    least = -NEGLIGIBLE * float(np.abs(squares_of).max(initial=0.0)) / unknowns.size
    parting = () if solved.free.size else tuple(body for body, square in squares.items() if square < least)
    return Accelerations(replace(solved, rates=at_origin), replace(velocities, rates=turned), parting)


def _along(part: Component, middle: complex) -> float:
    """Return the component (m) of the vector from the middle to a point."""
    return (part.direction.conjugate() * (part.point - middle)).real


def _turns_unknown(system: System, velocities: Solved, body: int) -> bool:
    """Return True if a body has no joint and its rotation is not determined."""
    joined = any(one.velocity is not None and one.drift is not None and _names(one, body) for one in system.conditions)
    return not joined and not velocities.determines_turn(body)


def _names(condition: Condition, body: int) -> bool:
    return any(part.body == body for part in condition.components) or any(turn[0] == body for turn in condition.turns)


def _solve(unknowns: Unknowns, driven: Sequence[tuple[Condition, float]]) -> tuple[Solved, np.ndarray]:
    matrix = np.array([unknowns.row(one) for one, _ in driven]).reshape(len(driven), unknowns.count)
    values = np.array([unknowns.scaled(one, value) for one, value in driven])
    least_squares = np.linalg.lstsq(matrix, values, rcond=NEGLIGIBLE)[0] if len(driven) else np.zeros(unknowns.count)
    _, sizes, motions = np.linalg.svd(matrix) if len(driven) else (None, np.zeros(0), np.eye(unknowns.count))
    rank = int((sizes > NEGLIGIBLE * max(sizes, default=0.0)).sum())
    conflicts = tuple(_conflicts([one.name for one, _ in driven], matrix, values))
    return Solved(unknowns.rates(least_squares), conflicts, motions[rank:], unknowns), least_squares


def _conflicts(names: Sequence[str], matrix: np.ndarray, values: np.ndarray) -> Iterable[Conflict]:
    """Return the conditions whose left side follows from earlier ones while their value does not."""
    kept: list[int] = []
    largest = float(np.abs(values).max(initial=0.0))
    for index, row in enumerate(matrix):
        above = matrix[kept]
        shares = np.linalg.lstsq(above.T, row, rcond=NEGLIGIBLE)[0] if kept else np.zeros(0)
        if float(np.linalg.norm(row - shares @ above if kept else row)) > NEGLIGIBLE:
            kept.append(index)
        elif abs(values[index] - shares @ values[kept]) > NEGLIGIBLE * max(largest, NEGLIGIBLE):
            others = (names[one] for one, share in zip(kept, shares, strict=True) if abs(share) > NEGLIGIBLE)
            yield Conflict(names[index], tuple(name for name in dict.fromkeys(others) if name != names[index]))


# --- the motion -----------------------------------------------------------------------------------


class InstantMotion(Record, dict=True):
    """A system with its velocities and accelerations, each solved on first use."""

    system: System

    @cached_property
    def _first(self) -> Solved:
        return solve_velocities(self.system)

    @cached_property
    def _second(self) -> Accelerations:
        return solve_accelerations(self.system, self._first)

    @cached_property
    def velocities(self) -> Velocities:
        return Velocities(self._second.velocities.rates)

    # --- determined quantities

    @property
    def velocity_conflicts(self) -> tuple[Conflict, ...]:
        return self._first.conflicts

    @property
    def acceleration_conflicts(self) -> tuple[Conflict, ...]:
        """Return the conditions that contradict each other in the accelerations, if the velocities are consistent."""
        return () if self._first.conflicts else self._second.solved.conflicts

    @property
    def parting(self) -> tuple[int, ...]:
        """Return the bodies whose points would have accelerations away from each other, impossible for a rigid body."""
        return () if self._first.conflicts else self._second.parting

    def knows_omega(self, body: int) -> bool:
        return body == GROUND or self._first.determines_turn(body) or self._knows_square(body)

    def knows_velocity(self, point: str) -> bool:
        body = self.system.body_of(point)
        return body == GROUND or self._first.determines_point(body, self.system.points[point])

    def knows_epsilon(self, body: int) -> bool:
        return body == GROUND or (self.knows_omega(body) and self._second.solved.determines_turn(body))

    def knows_acceleration(self, point: str) -> bool:
        body = self.system.body_of(point)
        at = self.system.points[point]
        return body == GROUND or (self.knows_omega(body) and self._second.solved.determines_point(body, at))

    def knows_sense(self, rate: str, body: int) -> bool:
        """Return True if the sense of ω or ε is known, too; it is unknown for ω if accelerations give only ω²."""
        return rate != "omega" or not self._knows_square(body) or not self.omega(body)

    def knows_centre(self, body: int) -> bool:
        """Return True if the whole velocity of a body is known."""
        places = {self.system.points[point] for point in self.system.bodies.get(body, ())}
        return body != GROUND and all(self._first.determines_point(body, place) for place in places)

    def _knows_square(self, body: int) -> bool:
        """Return True if the accelerations determine ω² of a body, and with it all of its motion except the sense."""
        solved = self._second.solved
        return body in solved.unknowns.squared and not solved.free.size

    # --- rates: values negligible beside the others become 0

    def omega(self, body: int) -> float:
        """Return ω of a body (rad/s)."""
        return _without_dust(self.velocities.omega(body), self.fastest / self.size).real

    def epsilon(self, body: int) -> float:
        """Return ε of a body (rad/s²)."""
        return _without_dust(self._acceleration_of(body).turn, self.steepest / self.size).real

    def turn(self, rate: str, body: int) -> float:
        """Return ω (rad/s) or ε (rad/s²) of a body, by the name omega or eps."""
        return self.omega(body) if rate == "omega" else self.epsilon(body)

    def v(self, point: str, body: int | None = None) -> complex:
        """Return the velocity of a point (m/s), as it moves with its own body or with `body`."""
        own = self.system.body_of(point) if body is None else body
        return _without_dust(self.velocities.at(own, self.system.points[point]), self.fastest)

    def a(self, point: str, body: int | None = None) -> complex:
        """Return the acceleration of a point (m/s²), as it moves with its own body or with `body`."""
        own = self.system.body_of(point) if body is None else body
        return _without_dust(self._acceleration_at(own, self.system.points[point]), self.steepest)

    @property
    def size(self) -> float:
        """Return the spread of the points from their middle (m)."""
        return self._first.unknowns.size

    @cached_property
    def fastest(self) -> float:
        """Return the scale of the velocities (m/s)."""
        middle = self._first.unknowns.middle
        each = ((abs(self.velocities.at(body, middle)), self.velocities.omega(body)) for body in self.system.bodies)
        return max((speed + abs(turn) * self.size for speed, turn in each), default=0.0)

    @cached_property
    def steepest(self) -> float:
        """Return the scale of the accelerations (m/s²)."""
        middle, bodies = self._first.unknowns.middle, self.system.bodies
        each = (
            abs(self._acceleration_at(body, middle)) + abs(self._acceleration_of(body).turn) * self.size
            for body in bodies
        )
        return max(each, default=0.0)

    def _acceleration_at(self, body: int, at: complex) -> complex:
        rates = self._acceleration_of(body)
        return rates.origin + 1j * rates.turn * at - self.velocities.omega(body) ** 2 * at

    def _acceleration_of(self, body: int) -> Rates:
        return STILL if body == GROUND else self._second.solved.rates[body]

    def centre(self, body: int) -> complex | None:
        """Return the instant centre of a body (m); None in translation, where it is infinitely far."""
        rates = self.velocities.of(body)
        if self.omega(body) == 0:
            return None
        return _without_dust(1j * rates.origin / rates.turn, self.size)


def _without_dust(value: complex, scale: float) -> complex:
    """Return a vector with components set to 0 that are negligible beside the scale."""
    least = NEGLIGIBLE * scale
    value = complex(value)
    return complex(value.real if abs(value.real) > least else 0.0, value.imag if abs(value.imag) > least else 0.0)
