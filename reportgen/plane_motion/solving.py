"""The velocities, then the accelerations of all bodies from their conditions, as two linear systems.

Both have one matrix but for the given quantities.  Conditions are taken in the order of the file.  One that follows
from those before it is a passive one where its value fits, else it *contradicts* those it follows from.  What the
conditions leave open is the null space of the matrix: a quantity that some motion of it changes is *undetermined*.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from reportgen.plane_motion.conditions import GROUND, STILL, Component, Condition, Rates, Velocities

SMALL = 1e-9
"""Below this share of its scale a number is nothing."""

Row = np.ndarray


@dataclass(frozen=True)
class System:
    """Points by name, bodies by number with the points that move with them, and conditions in the order of the file."""

    points: Mapping[str, complex]
    bodies: Mapping[int, tuple[str, ...]]
    conditions: tuple[Condition, ...]

    def body_of(self, point: str) -> int:
        """The body that a point's motion is that of: the first that carries it; the ground where none does."""
        return next((body for body, points in self.bodies.items() if point in points), GROUND)


@dataclass(frozen=True)
class Conflict:
    """A condition that those of the other names rule out, by what the file calls them."""

    name: str
    others: tuple[str, ...]


@dataclass(frozen=True)
class Solved:
    """Rates of all bodies, or why there are none.

    `free` are the motions that the conditions leave open, one a row, over the unknowns of `Unknowns`.
    """

    rates: Mapping[int, Rates]
    conflicts: tuple[Conflict, ...]
    free: np.ndarray
    unknowns: Unknowns

    def determines_turn(self, body: int) -> bool:
        return self._fixed(self.unknowns.row(Condition("", turns=((body, 1.0),))))

    def determines_point(self, body: int, point: complex) -> bool:
        axes = (Condition("", (Component(body, point, axis),)) for axis in (1 + 0j, 1j))
        return all(self._fixed(self.unknowns.row(axis)) for axis in axes)

    def _fixed(self, row: Row) -> bool:
        return bool(np.all(np.abs(self.free @ row) < SMALL * max(float(np.linalg.norm(row)), SMALL)))


@dataclass(frozen=True)
class Unknowns:
    """What is unknown: of each body its turn (times the size of the system) and two components at the middle.

    Lengths are measured from the middle of all points in units of their spread, so that the matrix is of the order 1.
    `squared` are bodies whose ω² is an unknown too.
    """

    bodies: tuple[int, ...]
    middle: complex
    size: float
    squared: tuple[int, ...] = ()

    @property
    def count(self) -> int:
        return 3 * len(self.bodies) + len(self.squared)

    def place(self, point: complex) -> complex:
        return (point - self.middle) / self.size

    def row(self, condition: Condition) -> Row:
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
        """The value of a condition in the units of the unknowns: turns are ω times the size of the system."""
        return value * self.size if condition.turns else value

    def rates(self, values: np.ndarray) -> dict[int, Rates]:
        found: dict[int, Rates] = {}
        for index, body in enumerate(self.bodies):
            turn, x, y = values[3 * index : 3 * index + 3]
            found[body] = Rates(turn / self.size, complex(x, y) - 1j * turn / self.size * self.middle)
        return found

    def squares(self, values: np.ndarray) -> dict[int, float]:
        """ω² of the bodies in `squared`."""
        last = values[3 * len(self.bodies) :]
        return {body: float(value) / self.size for body, value in zip(self.squared, last, strict=True)}


def unknowns_of(system: System) -> Unknowns:
    places = np.array(list(system.points.values()))
    middle = complex(places.mean())
    size = float(np.abs(places - middle).max())
    return Unknowns(tuple(system.bodies), middle, size if size > 0 else 1.0)


def solve_velocities(system: System) -> Solved:
    """The angular velocities and velocities of all bodies, with what stays open and what contradicts itself."""
    unknowns = unknowns_of(system)
    told = [(one, one.velocity) for one in system.conditions if one.velocity is not None]
    return _solve(unknowns, told)[0]


@dataclass(frozen=True)
class Accelerations:
    """What the accelerations come to; `velocities` with the angular velocities that only they determine.

    Bodies that are `parting` could have them only with a negative ω²: their points would move away from each other.
    """

    solved: Solved
    velocities: Solved
    parting: tuple[int, ...] = ()


def solve_accelerations(system: System, velocities: Solved) -> Accelerations:
    """The angular accelerations and accelerations of all bodies, after their velocities.

    A body without joints whose angular velocity is not known may have its accelerations given: then ω² is an unknown
    as ε is, and ω is its positive root, since accelerations do not tell the sense of rotation.
    """
    squared = tuple(body for body in system.bodies if _turns_unknown(system, velocities, body))
    unknowns = replace(velocities.unknowns, squared=squared)
    known = {body: STILL if body in squared else rates for body, rates in velocities.rates.items()}
    motion = Velocities(known)
    told: list[tuple[Condition, float]] = []
    for one in system.conditions:
        if one.drift is not None:
            inward = (motion.omega(part.body) ** 2 * _along(part, unknowns.middle) for part in one.components)
            told.append((one, one.drift(motion) + sum(inward)))
    solved, found = _solve(unknowns, told)
    squares = unknowns.squares(found)
    turned = {
        body: replace(rates, turn=float(np.sqrt(max(squares[body], 0.0)))) if body in squares else rates
        for body, rates in velocities.rates.items()
    }
    # From the middle to the origin: a(0) = a(m) − iε m + ω² m.
    at_origin = {
        body: replace(rates, origin=rates.origin + squares.get(body, motion.omega(body) ** 2) * unknowns.middle)
        for body, rates in solved.rates.items()
    }
    least = -SMALL * float(np.abs(found).max(initial=0.0)) / unknowns.size
    parting = () if solved.free.size else tuple(body for body, square in squares.items() if square < least)
    return Accelerations(replace(solved, rates=at_origin), replace(velocities, rates=turned), parting)


def _along(part: Component, middle: complex) -> float:
    """The component of the way from the middle to a point."""
    return (part.direction.conjugate() * (part.point - middle)).real


def _turns_unknown(system: System, velocities: Solved, body: int) -> bool:
    """Whether a body hangs on no joint and nothing tells how it turns."""
    joined = any(one.velocity is not None and one.drift is not None and _names(one, body) for one in system.conditions)
    return not joined and not velocities.determines_turn(body)


def _names(condition: Condition, body: int) -> bool:
    return any(part.body == body for part in condition.components) or any(turn[0] == body for turn in condition.turns)


def _solve(unknowns: Unknowns, told: Sequence[tuple[Condition, float]]) -> tuple[Solved, np.ndarray]:
    matrix = np.array([unknowns.row(one) for one, _ in told]).reshape(len(told), unknowns.count)
    values = np.array([unknowns.scaled(one, value) for one, value in told])
    found = np.linalg.lstsq(matrix, values, rcond=SMALL)[0] if len(told) else np.zeros(unknowns.count)
    _, sizes, ways = np.linalg.svd(matrix) if len(told) else (None, np.zeros(0), np.eye(unknowns.count))
    rank = int((sizes > SMALL * max(sizes, default=0.0)).sum())
    conflicts = tuple(_conflicts([one.name for one, _ in told], matrix, values))
    return Solved(unknowns.rates(found), conflicts, ways[rank:], unknowns), found


def _conflicts(names: Sequence[str], matrix: np.ndarray, values: np.ndarray) -> Iterable[Conflict]:
    """Conditions whose left side follows from those before them, while their value does not."""
    kept: list[int] = []
    largest = float(np.abs(values).max(initial=0.0))
    for index, row in enumerate(matrix):
        above = matrix[kept]
        shares = np.linalg.lstsq(above.T, row, rcond=SMALL)[0] if kept else np.zeros(0)
        if float(np.linalg.norm(row - shares @ above if kept else row)) > SMALL:
            kept.append(index)
        elif abs(values[index] - shares @ values[kept]) > SMALL * max(largest, SMALL):
            others = (names[one] for one, share in zip(kept, shares, strict=True) if abs(share) > SMALL)
            yield Conflict(names[index], tuple(name for name in dict.fromkeys(others) if name != names[index]))
