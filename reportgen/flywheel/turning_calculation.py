"""The calculation of a turning-moment diagram: mean torque, points of intersection, areas, energies, the flywheel."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cached_property
from itertools import pairwise

from reportgen.derivation.unprinted_values import with_rest
from reportgen.flywheel import turning_ids as names
from reportgen.flywheel.turning_diagram import SAME_ANGLE, TurningDiagram
from reportgen.flywheel.turning_file import Parameters, Torques
from reportgen.flywheel.turning_torques import CLOSE, DRIVING, RESISTING, diagram_of, mean_of, steady_run
from reportgen.formula import NOTHING, PI, Expression, Number, Operand, Ref, Symbol, call, cos, minus, plus, sin, total
from reportgen.formula.calculation import ZERO, Calculation
from reportgen.formula.vocabulary import KeyChapter

STRAIGHT = Number(180.0, unit="°")
MOST_TRAPEZOIDS = 6
"""Largest number of terms of a mean torque that is printed as a sum; of a longer table, only the result is printed."""


def multiple(order: float, angle: Ref) -> Expression:
    """Return a whole or half multiple of an angle, as it is printed."""
    return angle if order == 1 else Number(order) * angle


def extreme_points(energies: Sequence[float]) -> tuple[int, int]:
    """Return the numbers of the points with the greatest and the least energy; of equal ones, the first."""
    slack = ZERO * max(map(abs, energies))
    high, low = max(energies), min(energies)
    first = next(k for k, one in enumerate(energies, start=1) if one >= high - slack)
    return first, next(k for k, one in enumerate(energies, start=1) if one <= low + slack)


class TurningCalculation:
    """The calculation during its construction; `written()` returns it."""

    def __init__(self, given: Parameters) -> None:
        self.given, self.q = given, Calculation()
        self.κ: Ref | None = None

    @cached_property
    def diagram(self) -> TurningDiagram:
        return diagram_of(self.given)

    def written(self) -> Calculation:
        q, given = self.q, self.given
        with q.within(KeyChapter.data):
            self._enter_given()
        if given.areas is None:
            self.run = steady_run(given)
            with q.within(KeyChapter.geometry):
                self._enter_mean()
                φ = self._enter_points()
            with q.within(KeyChapter.loads):
                areas = self._enter_areas(φ)
        else:
            with q.within(KeyChapter.loads):
                areas = self._enter_measured()
        with q.within(KeyChapter.forces):
            self._enter_energies(areas)
        with q.within(KeyChapter.torque):
            self._enter_wheel()
        if given.at is not None:
            with q.within(KeyChapter.cycle):
                self._enter_acceleration(q[names.AT])
        return q

    # --- given data

    def _enter_given(self) -> None:
        q, given = self.q, self.given
        for side, torques in self._sides:
            self._enter_torques(side, torques)
        q.give(names.N, given.n.si * 30 / math.pi)
        for id, datum in (
            (names.DELTA, given.delta),
            (names.J, given.J),
            (names.MASS, given.m),
            (names.RADIUS, given.k),
            (names.AT, given.at),
        ):
            if datum is not None:
                q.give(id, datum.si)

    @property
    def _sides(self) -> list[tuple[str, Torques]]:
        """The torques that have a diagram, by their sides."""
        sides = ((DRIVING, self.given.driving), (RESISTING, self.given.resisting))
        return [(side, torques) for side, torques in sides if torques is not None and (torques.terms or torques.nodes)]

    def _enter_torques(self, side: str, torques: Torques) -> None:
        q, prime = self.q, "′" if side == RESISTING and len(self._sides) > 1 else ""
        for number, term in enumerate(torques.harmonics, start=1):
            index = f"{term.order:g}" if term.order % 1 == 0 else f"{2 * term.order:g}/2"
            q.give(names.cosine(side, number), term.cos.si, Symbol("p", index, prime))
            q.give(names.sine(side, number), term.sin.si, Symbol("q", index, prime))
        for number, (angle, torque) in enumerate(torques.nodes, start=1):
            q.give(names.node_angle(side, number), angle, Symbol("φ", f"t{number}", prime))
            q.give(names.node_torque(side, number), torque, Symbol("M", f"t{number}", prime))

    # --- the mean line

    def _nodes(self, side: str, torques: Torques) -> tuple[Ref, ...]:
        """Return angle and torque of each row of a table, one after another."""
        count = range(1, len(torques.nodes) + 1)
        return tuple(
            self.q[family(side, number)] for number in count for family in (names.node_angle, names.node_torque)
        )

    def _enter_mean(self) -> None:
        """Enter the mean torque and, with two diagrams of different means, the factor of the resisting one."""
        q = self.q
        q.give(names.CYCLE, self.diagram.cycle, optional=True)
        (side, torques), *further = self._sides
        M = self._mean(names.MEAN, side, torques)
        for load_side, load in further:
            if load.mean is None and load.terms:
                continue
            if abs(mean_of(load) / mean_of(torques) - 1) <= CLOSE:
                continue
            load_mean = self._mean(names.MEAN_OF_LOAD, load_side, load)
            self.κ = q.define(names.FACTOR, M / load_mean)
            q.set_out("factor", load_mean, self.κ)
        if self.given.follows_speed:
            q.set_out("mean", M)

    def _mean(self, id: str, side: str, torques: Torques) -> Ref:
        q = self.q
        if torques.terms:
            return q.give(id, mean_of(torques))
        nodes = self._nodes(side, torques)
        cycle = nodes[-2] - nodes[0]
        rows = list(zip(torques.nodes, nodes[::2], nodes[1::2], strict=True))
        # A jump has no width, and a piece with zero torque at both ends no area.
        areas = [
            (y0 + y1) / 2 * (x1 - x0)
            for ((at, low), x0, y0), ((end, high), x1, y1) in pairwise(rows)
            if end > at and (low or high)
        ]
        written = total(areas) / cycle if 0 < len(areas) <= MOST_TRAPEZOIDS else None
        M = q.define(id, call("line_area", nodes[0], nodes[-2], *nodes) / cycle, written=written)
        q.set_out("mean", M)
        return M

    # --- points of intersection

    def _enter_points(self) -> list[Ref]:
        """Enter the angles at which the torques are equal, after the start of the cycle."""
        q = self.q
        φ = [q.give(names.point(1), 0.0)]
        for number, at in enumerate(self.run.points[1:], start=2):
            by_constant = self._crossing(at)
            if self.given.follows_speed:
                φ.append(with_rest(q, names.point(number), at, by_constant, Symbol("φ", str(number)), "angle"))
            else:
                φ.append(q.define(names.point(number), by_constant))
            q.set_out("points", φ[-1])
        return φ

    def _signed(self, side: str, of: Expression) -> Expression:
        """Return a term of the excess torque: a resisting one with its factor and a minus."""
        if side == DRIVING:
            return of
        return minus(of if self.κ is None else self.κ * of)

    def _crossing(self, at: float) -> Expression:
        """Return the angle of a point of intersection: by interpolation in a single table, else as read off."""
        q, sides = self.q, self._sides
        if len(sides) == 1 and sides[0][1].nodes:
            side, torques = sides[0]
            return self._interpolated(side, torques, at)
        constant: list[Expression] = []
        slopes: list[Expression] = []
        waves: list[Operand] = []
        for side, torques in sides:
            for number, term in enumerate(torques.harmonics, start=1):
                a, b = q[names.cosine(side, number)], q[names.sine(side, number)]
                waves += [term.order, self._signed(side, a), self._signed(side, b)]
            if torques.nodes:
                i = self._row_at(torques, at)
                if torques.nodes[i][0] == torques.nodes[i + 1][0]:
                    return call("re", q[names.node_angle(side, i + 1)])
                x0, y0, x1, y1 = self._nodes(side, torques)[2 * i : 2 * i + 4]
                steep = (y1 - y0) / (x1 - x0)
                slopes.append(self._signed(side, steep))
                at_zero = self._signed(side, y0 - steep * x0)
                constant.append(at_zero + (q[names.MEAN] if side == RESISTING else -q[names.MEAN]))
        level, slope = (plus(*terms) if terms else NOTHING for terms in (constant, slopes))
        return call("crossing", at, level, slope, *waves)

    def _row_at(self, torques: Torques, at: float) -> int:
        """Return the index of the row before an angle; at a jump that changes the sign, of the jump."""
        angles = [angle for angle, _ in torques.nodes]
        rows = range(len(angles) - 1)
        jump = next((i for i in rows if angles[i] == angles[i + 1] and abs(angles[i] - at) < SAME_ANGLE), None)
        if jump is not None:
            return jump
        return next(i for i in rows if angles[i] < angles[i + 1] and angles[i] - 1e-12 <= at <= angles[i + 1] + 1e-12)

    def _interpolated(self, side: str, torques: Torques, at: float) -> Expression:
        q = self.q
        i = self._row_at(torques, at)
        x0, y0, x1, y1 = self._nodes(side, torques)[2 * i : 2 * i + 4]
        # At a jump, or where a row has the mean torque, the angle is that of the row.
        if torques.nodes[i][0] == torques.nodes[i + 1][0] or abs(at - torques.nodes[i][0]) < SAME_ANGLE:
            return call("re", x0)
        if abs(at - torques.nodes[i + 1][0]) < SAME_ANGLE:
            return call("re", x1)
        return x0 + (q[names.MEAN] - y0) / (y1 - y0) * (x1 - x0)

    # --- areas

    def _enter_areas(self, φ: Sequence[Ref]) -> list[Ref]:
        q, run = self.q, self.run
        ends = [*φ[1:], q[names.CYCLE]]
        size = float(max(abs(area) for area in run.areas))
        areas = []
        for number, (start, stop, area) in enumerate(zip(φ, ends, run.areas, strict=True), start=1):
            by_constant = plus(*(self._area(side, torques, start, stop) for side, torques in self._sides))
            if self.given.follows_speed:
                A = with_rest(q, names.area(number), area, by_constant, Symbol("A", str(number)), "work", scale=size)
            else:
                A = q.define(names.area(number), by_constant, scale=size)
            areas.append(A)
            q.set_out("areas", A)
        return areas

    def _area(self, side: str, torques: Torques, start: Ref, stop: Ref) -> Expression:
        """Return the work of one torque in excess of its mean between two angles."""
        q = self.q
        if torques.nodes:
            work = self._signed(side, call("line_area", start, stop, *self._nodes(side, torques)))
            of_mean = q[names.MEAN] * (stop - start)
            return work + of_mean if side == RESISTING else work - of_mean
        terms: list[Expression] = []
        for number, term in enumerate(torques.harmonics, start=1):
            n = term.order
            first, last = multiple(n, start), multiple(n, stop)
            if term.cos.si:
                a = q[names.cosine(side, number)]
                terms.append((a if n == 1 else a / Number(n)) * (sin(last) - sin(first)))
            if term.sin.si:
                b = q[names.sine(side, number)]
                terms.append((b if n == 1 else b / Number(n)) * (cos(first) - cos(last)))
        if side == DRIVING:
            return plus(*terms)
        if self.κ is not None:
            return minus(self.κ * plus(*terms))
        return plus(*map(minus, terms))

    def _enter_measured(self) -> list[Ref]:
        """Enter areas as given, in J or in mm² with the scales."""
        q, given = self.q, self.given.areas
        assert given is not None
        if given.unit is not None:
            return [q.give(names.area(k), a * given.unit.si) for k, a in enumerate(given.values, start=1)]
        assert given.torque is not None
        assert given.angle is not None
        with q.within(KeyChapter.data):
            μ_M = q.give(names.scale("M"), given.torque.si)
            μ_φ = q.give(names.scale("phi"), given.angle.si)
            on_paper = [q.give(names.on_paper(k), a) for k, a in enumerate(given.values, start=1)]
        μ = q.define(names.scale("A"), μ_M * μ_φ * PI / STRAIGHT)
        q.set_out("scale", μ)
        areas = [q.define(names.area(k), a * μ) for k, a in enumerate(on_paper, start=1)]
        q.set_out("areas", *areas)
        return areas

    # --- energies

    def _enter_energies(self, areas: Sequence[Ref]) -> None:
        q = self.q
        size = sum(abs(q.si(area)) for area in areas)
        E = [q.give(names.energy(1), 0.0)]
        for number, area in enumerate(areas[:-1], start=2):
            E.append(q.define(names.energy(number), E[-1] + area if number > 2 else area, scale=size))
            q.set_out("energies", E[-1])
        values = [q.si(one) for one in E]
        for bound, number in zip(("max", "min"), extreme_points(values), strict=True):
            at = E[number - 1]
            every = call(bound, *E)
            q.set_out("extremes", q.define(names.extreme(bound), every, scale=size, written=at))
        ΔE = q.define(names.RANGE, q[names.extreme("max")] - q[names.extreme("min")])
        q.set_out("range", ΔE)
        if (M := q.find(names.MEAN)) is not None:
            Φ = q[names.CYCLE]
            W = q.define(names.WORK, M * Φ * PI / STRAIGHT)
            q.set_out("share", W, q.define(names.SHARE, ΔE / W))

    # --- the flywheel

    def _enter_wheel(self) -> None:
        q, ΔE = self.q, self.q[names.RANGE]
        ω = q.define(names.OMEGA, 2 * PI * q[names.N] / 60)
        q.set_out("speed", ω)
        if (M := q.find(names.MEAN)) is not None:
            with q.within(KeyChapter.forces):
                q.set_out("power", q.define(names.POWER, M * ω))
            if self.given.follows_speed:
                c = q.give(names.PER_SPEED, self.run.per_speed, exact=False)
                q.set_out("per_speed", c)
        k = q.find(names.RADIUS)
        if self.given.delta is not None:
            J = q.define(names.J, ΔE / (q[names.DELTA] * ω**2))
            q.set_out("wheel", J)
            if k is not None:
                q.set_out("wheel", q.define(names.MASS, J / k**2))
        else:
            if self.given.m is not None:
                assert k is not None
                q.set_out("wheel", q.define(names.J, q[names.MASS] * k**2))
            q.set_out("wheel", q.define(names.DELTA, ΔE / (q[names.J] * ω**2)))
        for bound, sense in (("max", 1 + q[names.DELTA] / 2), ("min", 1 - q[names.DELTA] / 2)):
            q.set_out("bounds", q.define(names.speed(bound), ω * sense))

    def _enter_acceleration(self, φ: Ref) -> None:
        """Enter the excess torque at an angle, and the angular acceleration of the flywheel there."""
        q = self.q
        parts: list[Expression] = []
        for side, torques in self._sides:
            if torques.nodes:
                height = self._signed(side, call("line_at", φ, *self._nodes(side, torques)))
                parts.append(height + (q[names.MEAN] if side == RESISTING else -q[names.MEAN]))
            for number, term in enumerate(torques.harmonics, start=1):
                angle = multiple(term.order, φ)
                if term.cos.si:
                    parts.append(self._signed(side, q[names.cosine(side, number)] * cos(angle)))
                if term.sin.si:
                    parts.append(self._signed(side, q[names.sine(side, number)] * sin(angle)))
        size = self.diagram.least / 1e-12
        by_constant = plus(*parts)
        if self.given.follows_speed:
            ΔM = with_rest(q, names.TORQUE_AT, self.run.excess(q.si(φ)), by_constant, "ΔM", "torque", scale=size)
        else:
            ΔM = q.define(names.TORQUE_AT, by_constant, scale=size)
        q.set_out("acceleration", ΔM, q.define(names.ACCELERATION, ΔM / q[names.J], scale=size / q.si(names.J)))
