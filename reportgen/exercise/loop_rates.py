"""Rates that no single vector equation gives: all loops of the remaining bodies, solved together.

From points with known rates, each body leads to its other points, with its rotation as an unknown.  If a point is
reached twice, both rates agree; if a point is guided, the component across the guide is zero.  These are linear
equations.

A lever whose two ends are driven from one shaft and whose middle has a known velocity needs no system: the velocities
of both ends are v = k ω of the shaft with k a product of lengths; the known velocity divides them as its point divides
the lever, which gives ω.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import combinations

import numpy as np

from reportgen.base.records import Record
from reportgen.exercise.acceleration_steps import Parts
from reportgen.exercise.derivation import Derivation, Step
from reportgen.exercise.point_positions import direction_of
from reportgen.exercise.rate_solution import NEGLIGIBLE
from reportgen.exercise.velocity_steps import derive, is_across
from reportgen.formula import (
    Chain,
    Expression,
    Fraction,
    Negative,
    Number,
    Product,
    Ref,
    Symbol,
    call,
    ids,
    signed,
    total,
    vocabulary,
)
from reportgen.formula.calculation import Calculation

FIGURES = 4
"""Significant digits of the numbers in a system."""

KnownPower = tuple[str, int]
"""A quantity of the derivation and its power: v.A, or ω² as omega.2 with 2."""


class Reached(Record):
    """The rate of a point: Σ known quantity × vector + Σ unknown rotation × vector."""

    known: Mapping[KnownPower, complex]
    unknown: Mapping[int, complex]

    def plus(self, reached: Reached, factor: float = 1.0) -> Reached:
        """Return the sum of both rates, the second multiplied by a factor."""
        known, unknown = dict(self.known), dict(self.unknown)
        for quantity, vector in reached.known.items():
            known[quantity] = known.get(quantity, 0j) + factor * vector
        for body, vector in reached.unknown.items():
            unknown[body] = unknown.get(body, 0j) + factor * vector
        return Reached(known, unknown)


NOTHING = Reached({}, {})


@dataclass
class Loops:
    """The points that were reached, and the sums that must be zero."""

    derivation: Derivation
    what: str
    """The rotation that is unknown: omega or eps."""
    points: dict[str, Reached]
    closed: list[Reached] = field(default_factory=list)

    def lead_on(self) -> None:
        """Reach the other points of every body with a reached point, each body once."""
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
        layout = self.derivation.layout
        for body in layout.members:
            # Points of contact have the same velocity at the instant but different accelerations.
            names = layout.members[body] if self.what == "omega" else layout.own(body)
            centre = layout.centres.get(body)
            pivot = [centre.name] if centre is not None and centre.rule == "pivot" else []
            guided = centre is not None and centre.by_joint and not pivot
            if self.derivation.knows_omega(body) if self.what == "eps" else not guided:
                yield body, [*pivot, *(name for name in names if name not in pivot)]

    def across_slots(self) -> Iterator[tuple[Reached, complex]]:
        """Yield the rate of a point on a moving line relative to the body's own point there, with the unit normal to
        the line.
        """
        members = dict(self.bodies())
        for joint in self.derivation.layout.given.slots:
            if joint.point in self.points:
                base = next((name for name in members.get(joint.on, ()) if name in self.points), None)
                if base is not None:
                    own = self.points[base].plus(self.turned(joint.on, joint.point, base))
                    yield (
                        self.points[joint.point].plus(own, -1.0),
                        1j * self.derivation.layout.geometry.direction(joint),
                    )

    def turned(self, body: int, name: str, base: str) -> Reached:
        """Return the contribution of a body's rotation from one of its points to another."""
        derivation, rate = self.derivation, ids.LINK_RATE[self.what](body)
        arm = derivation.layout.points[name] - derivation.layout.points[base]
        known: dict[KnownPower, complex] = {}
        if self.what == "eps":
            known[(ids.angular_velocity(body), 2)] = -arm
        if not derivation.knows(rate):
            return Reached(known, {body: 1j * arm})
        known[(rate, 1)] = 1j * arm * math.copysign(1.0, derivation.motion.turn(self.what, body))
        return Reached(known, {})


def solve_velocities_together(derivation: Derivation) -> bool:
    """Enter the angular velocities of all bodies that are reached; return False if there are none."""
    known = [name for name in derivation.layout.points if derivation.knows_velocity(name)]
    start = {name: Reached({(ids.velocity(name), 1): direction_of(derivation.at(name))}, {}) for name in known}
    start |= {one.name: NOTHING for one in derivation.layout.centres.values() if one.rule in ("pivot", "contact")}
    loops = Loops(derivation, "omega", start)
    loops.lead_on()
    directions = {name: u for name, u in derivation.layout.directions.items() if not derivation.knows_velocity(name)}
    return _solved(loops, directions, [*loops.across_slots()])


def solve_accelerations_together(parts: Parts) -> bool:
    """Enter the angular accelerations of all bodies that are reached; return False if there are none."""
    derivation = parts.derivation
    start = {
        name: Reached({(vector.id, 1): vector.direction for vector in vectors}, {})
        for name, vectors in parts.of.items()
        if all(derivation.knows(vector.id) for vector in vectors)
    }
    loops = Loops(derivation, "eps", dict(start))
    loops.lead_on()
    return _solved(loops, {name: u for name, u in derivation.layout.slots.items() if name not in parts.of})


def _solved(loops: Loops, directions: Mapping[str, complex], more: Sequence[tuple[Reached, complex]] = ()) -> bool:
    equations = [*more, *((one, axis) for one in loops.closed for axis in (1 + 0j, 1j))]
    equations += [(loops.points[name], 1j * u) for name, u in directions.items() if name in loops.points]
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
    derivation = loops.derivation
    values = np.array([derivation.q.si(id) ** power for id, power in quantities])
    lines = tuple(
        _enter_rotation(loops, body, dict(zip(quantities, row, strict=True)))
        for body, row in zip(bodies, shares, strict=True)
    )
    rows = tuple(_row(loops.what, bodies, left[index], float(right[index] @ values)) for index in chosen)
    results = tuple(
        Chain((_symbol(loops.what, body), _number(float(row @ values), "rad/s" if loops.what == "omega" else "rad/s²")))
        for body, row in zip(bodies, shares, strict=True)
    )
    derivation.steps.append(Step(f"system-{loops.what}", lines, system=rows, results=results))
    return True


def _independent(left: np.ndarray) -> list[int]:
    """Return the indices of the first linearly independent equations, as many as there are unknowns."""
    kept: list[int] = []
    largest = np.abs(left).max(initial=0.0)
    for index in range(len(left)):
        trial = left[[*kept, index]]
        if np.linalg.matrix_rank(trial, tol=NEGLIGIBLE * max(largest, NEGLIGIBLE)) == len(trial):
            kept.append(index)
        if len(kept) == left.shape[1]:
            break
    return kept


def _enter_rotation(loops: Loops, body: int, shares: Mapping[KnownPower, float]) -> str:
    """Enter the magnitude of a rotation from known quantities with factors that depend on positions only; return its
    id.
    """
    q, what = loops.derivation.q, loops.what
    sense = math.copysign(1.0, loops.derivation.motion.turn(what, body))
    terms: list[Expression] = []
    for (of, power), share in shares.items():
        if abs(share) > NEGLIGIBLE:
            factor = q.give(ids.share(what, body, of), sense * share, Symbol("c"), "ratio", hidden=True)
            terms.append(Product((factor, q[of] if power == 1 else q[of] ** power)))
    # A construction has no line: the page prints the system and its solution instead.
    return q.define(ids.LINK_RATE[what](body), call("re", total(terms) if terms else Number(0.0))).id


def _along(vector: complex, axis: complex) -> float:
    return float((axis.conjugate() * vector).real)


def _row(what: str, bodies: list[int], factors: np.ndarray, value: float) -> Chain:
    """Return an equation of the system with its numbers."""
    largest = float(np.abs(factors).max())
    terms: list[Expression] = []
    for body, factor in zip(bodies, factors, strict=True):
        if abs(factor) > NEGLIGIBLE * largest:
            term = Product((_number(abs(float(factor))), _symbol(what, body)))
            terms.append(term if factor > 0 else Negative(term))
    return Chain((total(sorted(terms, key=lambda one: isinstance(one, Negative))), _number(value)))


def _symbol(what: str, body: int) -> Symbol:
    return vocabulary.symbol(ids.LINK_RATE[what](body))


def _number(value: float, unit: str = "") -> Number:
    """Return a number with the significant digits of a system."""
    if abs(value) < 1e-12:
        return Number(0.0, None, unit)
    return Number(value, max(0, FIGURES - 1 - math.floor(math.log10(abs(value)))), unit)


Ratio = tuple[tuple[Ref, ...], tuple[Ref, ...]]
"""The lengths in the numerator and in the denominator of a fraction."""


# --- in proportion to one shaft -------------------------------------------------------------------


def enter_proportion(derivation: Derivation) -> bool:
    """Enter the angular velocity of one more body through a lever; return False if there is no such lever."""
    for body, centre in derivation.layout.centres.items():
        if centre.rule != "pivot" or derivation.knows_omega(body) or not derivation.motion.omega(body):
            continue
        trial = Derivation(Calculation(derivation.q.positions), derivation.layout)
        trial.given(ids.angular_velocity(body), derivation.motion.omega(body))
        while derive(trial):
            pass
        for lever, names in derivation.layout.members.items():
            if lever not in derivation.layout.centres and _through_lever(derivation, trial, body, lever, names):
                return True
    return False


def _through_lever(derivation: Derivation, trial: Derivation, body: int, lever: int, names: list[str]) -> bool:
    """Enter ω of a body from a lever with known v_M, whose points P and Q have velocities proportional to ω."""
    driven = [name for name in names if trial.knows_velocity(name)]
    known = [name for name in names if derivation.knows_velocity(name) and derivation.q.si(ids.velocity(name))]
    for p, q in combinations(driven, 2):
        for m in known:
            if m not in (p, q) and is_across(derivation, p, q, m):
                _enter_proportion(derivation, trial, body, lever, (p, q, m))
                return True
    return False


def _enter_proportion(
    derivation: Derivation, trial: Derivation, body: int, lever: int, names: tuple[str, str, str]
) -> None:
    """Enter v_M PQ = v_P MQ + v_Q PM, each velocity with its sense and M between P and Q or beyond them."""
    p, q, m = names
    line = derivation.layout.points[q] - derivation.layout.points[p]
    share = ((derivation.layout.points[m] - derivation.layout.points[p]) / line).real
    sense = derivation.at(m)
    shaft = ids.angular_velocity(body)
    factors = [_factor(derivation, trial, name, shaft) for name in (p, q)]
    parts: list[Expression] = []
    for k, name, far, part in zip(factors, (p, q), (q, p), (1 - share, share), strict=True):
        along = (sense.conjugate() * derivation.at(name)).real
        parts.append(signed(along * part, k * derivation.length(m, far)))
    parts.sort(key=lambda part: not isinstance(part, Product))
    whole = derivation.q[ids.velocity(m)] * derivation.length(p, q)
    omega = derivation.q.define(shaft, whole / (parts[0] + parts[1]))
    derivation.steps.append(Step("proportion", (*(k.id for k in factors), omega.id), lever, m, p))


def _factor(derivation: Derivation, trial: Derivation, name: str, shaft: str) -> Ref:
    """Enter k of a point, v = k ω, as a product of lengths."""
    above, below = _ratio(trial, ids.velocity(name), shaft)
    for length in (*above, *below):
        if length.id not in derivation.q:
            derivation.q.enter(trial.q.families[length.id])
    top = above[0] if len(above) == 1 else Product(above)
    bottom = below[0] if len(below) == 1 else Product(below)
    return derivation.q.define(ids.velocity_factor(name), Fraction(top, bottom) if below else top)


def _ratio(trial: Derivation, id: str, shaft: str) -> Ratio:
    """Return the lengths in a rate divided by the shaft's rate; each step from body to body multiplies or divides by
    one.
    """
    if id == shaft:
        return (), ()
    match trial.q.families[id].definition:
        case Ref(leader):
            return _ratio(trial, leader, shaft)
        case Product((Ref(rate), Ref() as length)):
            above, below = _ratio(trial, rate, shaft)
            return (*above, length), below
        case Fraction(Ref(speed), Ref() as length):
            above, below = _ratio(trial, speed, shaft)
            return above, (*below, length)
        case leader:
            raise ValueError(f"{id} is no multiple of {shaft}: {leader}")
