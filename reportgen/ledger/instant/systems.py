"""Rates that no vector equation gives alone: all loops of the bodies left over, as one system of linear equations.

From points whose rates are known each body leads on to its other points, with its own rotation as an unknown.  Where a
point is reached twice, both ways agree; where a point is guided, nothing goes across its guide.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from reportgen.ledger.instant.board import Board, Step
from reportgen.ledger.instant.parts import Parts
from reportgen.notation.expressions import Chain, Expression, Negative, Number, Product, Symbol, call, total

FIGURES = 4
"""Significant figures of the numbers in a system."""
SMALL = 1e-9

Known = tuple[str, int]
"""A quantity of the board and its power: v.A, or ω² as omega.2 with 2."""


@dataclass(frozen=True)
class Reached:
    """The rate of a point: Σ known quantity × vector + Σ unknown rotation × vector."""

    known: Mapping[Known, complex]
    unknown: Mapping[int, complex]

    def plus(self, other: Reached, factor: float = 1.0) -> Reached:
        known, unknown = dict(self.known), dict(self.unknown)
        for one, way in other.known.items():
            known[one] = known.get(one, 0j) + factor * way
        for body, way in other.unknown.items():
            unknown[body] = unknown.get(body, 0j) + factor * way
        return Reached(known, unknown)


NOTHING = Reached({}, {})


@dataclass
class Loops:
    """The points that were reached, and what was found to be nothing."""

    board: Board
    what: str
    """The rotation that is unknown: omega or eps."""
    points: dict[str, Reached]
    closed: list[Reached] = field(default_factory=list)

    def lead_on(self) -> None:
        """From every body with a point reached to its other points, each body once."""
        waiting = dict(self.bodies())
        while True:
            body = next((one for one, names in waiting.items() if any(name in self.points for name in names)), None)
            if body is None:
                return
            names = waiting.pop(body)
            base = next(name for name in names if name in self.points)
            for name in names:
                if name != base:
                    there = self.points[base].plus(self.turned(body, name, base))
                    if name in self.points:
                        self.closed.append(there.plus(self.points[name], -1.0))
                    else:
                        self.points[name] = there

    def bodies(self) -> Iterator[tuple[int, list[str]]]:
        layout = self.board.layout
        for body in layout.members:
            # Points of contact move alike at the instant; their accelerations differ.
            names = layout.members[body] if self.what == "omega" else layout.own(body)
            centre = layout.centres.get(body)
            pivot = [centre.name] if centre is not None and centre.rule == "pivot" else []
            guided = centre is not None and centre.by_joint and not pivot
            if self.board.knows(f"omega.{body}") if self.what == "eps" else not guided:
                yield body, [*pivot, *(name for name in names if name not in pivot)]

    def across_slots(self) -> Iterator[tuple[Reached, complex]]:
        """What a point on a line of a moving body does across that line, against the body's own point there."""
        members = dict(self.bodies())
        for joint in self.board.layout.given.slots:
            if joint.point in self.points:
                base = next((name for name in members.get(joint.on, ()) if name in self.points), None)
                if base is not None:
                    own = self.points[base].plus(self.turned(joint.on, joint.point, base))
                    yield self.points[joint.point].plus(own, -1.0), 1j * self.board.layout.geometry.direction(joint)

    def turned(self, body: int, name: str, base: str) -> Reached:
        """What the rotation of a body adds from one of its points to another."""
        board, id = self.board, f"{self.what}.{body}"
        arm = board.layout.points[name] - board.layout.points[base]
        known: dict[Known, complex] = {}
        if self.what == "eps":
            known[(f"omega.{body}", 2)] = -arm
        if not board.knows(id):
            return Reached(known, {body: 1j * arm})
        rate = board.motion.omega(body) if self.what == "omega" else board.motion.epsilon(body)
        known[(id, 1)] = 1j * arm * math.copysign(1.0, rate)
        return Reached(known, {})


def solve_velocities_together(board: Board) -> bool:
    """The angular velocities of all bodies that are reached; whether there were any."""
    known = [name for name in board.layout.points if board.knows(f"v.{name}")]
    start = {name: Reached({(f"v.{name}", 1): board.way(board.at(name))}, {}) for name in known}
    start |= {one.name: NOTHING for one in board.layout.centres.values() if one.rule in ("pivot", "contact")}
    loops = Loops(board, "omega", start)
    loops.lead_on()
    ways = {name: way for name, way in board.layout.ways.items() if not board.knows(f"v.{name}")}
    return _solved(loops, ways, [*loops.across_slots()])


def solve_accelerations_together(parts: Parts) -> bool:
    """The angular accelerations of all bodies that are reached; whether there were any."""
    board = parts.board
    start = {
        name: Reached({(one.id, 1): one.way for one in vectors}, {})
        for name, vectors in parts.of.items()
        if all(board.knows(one.id) for one in vectors)
    }
    loops = Loops(board, "eps", dict(start))
    loops.lead_on()
    return _solved(loops, {name: way for name, way in board.layout.slots.items() if name not in parts.of})


def _solved(loops: Loops, ways: Mapping[str, complex], more: Sequence[tuple[Reached, complex]] = ()) -> bool:
    equations = [*more, *((one, axis) for one in loops.closed for axis in (1 + 0j, 1j))]
    equations += [(loops.points[name], 1j * way) for name, way in ways.items() if name in loops.points]
    bodies = sorted({body for one, _ in equations for body in one.unknown})
    quantities = list(dict.fromkeys(known for one, _ in equations for known in one.known))
    if not bodies:
        return False
    left = np.array([[_along(one.unknown.get(body, 0j), axis) for body in bodies] for one, axis in equations])
    right = np.array([[-_along(one.known.get(known, 0j), axis) for known in quantities] for one, axis in equations])
    chosen = _independent(left)
    if len(chosen) < len(bodies):
        return False
    shares = np.linalg.solve(left[chosen], right[chosen])
    board, ids = loops.board, []
    values = np.array([board.q.si(id) ** power for id, power in quantities])
    for body, row in zip(bodies, shares, strict=True):
        ids.append(_enter(loops, body, dict(zip(quantities, row, strict=True))))
    rows = tuple(_row(loops.what, bodies, left[index], float(right[index] @ values)) for index in chosen)
    results = tuple(
        Chain((_symbol(loops.what, body), _number(float(row @ values), "rad/s" if loops.what == "omega" else "rad/s²")))
        for body, row in zip(bodies, shares, strict=True)
    )
    board.steps.append(Step(f"system-{loops.what}", tuple(ids), system=rows, results=results))
    return True


def _independent(left: np.ndarray) -> list[int]:
    """The first equations that do not follow from those before them, as many as there are unknowns."""
    kept: list[int] = []
    largest = np.abs(left).max(initial=0.0)
    for index in range(len(left)):
        trial = left[[*kept, index]]
        if np.linalg.matrix_rank(trial, tol=SMALL * max(largest, SMALL)) == len(trial):
            kept.append(index)
        if len(kept) == left.shape[1]:
            break
    return kept


def _enter(loops: Loops, body: int, shares: Mapping[Known, float]) -> str:
    """The size of a rotation from what is known, with factors that the places alone tell."""
    q, motion, id = loops.board.q, loops.board.motion, f"{loops.what}.{body}"
    rate = motion.omega(body) if loops.what == "omega" else motion.epsilon(body)
    terms: list[Expression] = []
    for (of, power), share in shares.items():
        if abs(share) > SMALL:
            factor = q.give(f"share.{id}.{of}", math.copysign(1.0, rate) * share, Symbol("c"), "ratio", hidden=True)
            terms.append(Product((factor, q[of] if power == 1 else q[of] ** power)))
    # As a construction it has no line of its own: the system is set out, and its solution told.
    q.define(id, call("re", total(terms) if terms else Number(0.0)))
    return id


def _along(vector: complex, axis: complex) -> float:
    return float((axis.conjugate() * vector).real)


def _row(what: str, bodies: list[int], factors: np.ndarray, value: float) -> Chain:
    """An equation of the system with its numbers."""
    largest = float(np.abs(factors).max())
    terms: list[Expression] = []
    for body, factor in zip(bodies, factors, strict=True):
        if abs(factor) > SMALL * largest:
            term = Product((_number(abs(float(factor))), _symbol(what, body)))
            terms.append(term if factor > 0 else Negative(term))
    return Chain((total(sorted(terms, key=lambda one: isinstance(one, Negative))), _number(value)))


def _symbol(what: str, body: int) -> Symbol:
    return Symbol("ω" if what == "omega" else "ε", str(body))


def _number(value: float, unit: str = "") -> Number:
    """A number with so many significant figures."""
    if abs(value) < 1e-12:
        return Number(0.0, None, unit)
    return Number(value, max(0, FIGURES - 1 - math.floor(math.log10(abs(value)))), unit)
