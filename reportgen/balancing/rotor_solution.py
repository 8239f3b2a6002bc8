"""A rotor with its ledger, and common mistakes in its quantities."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property

from reportgen.balancing import rotor_ids
from reportgen.balancing.rotor_calculation import AFTER, BEFORE, RotorCalculation, resultant
from reportgen.balancing.rotor_file import BEARINGS, LEFT, RIGHT, Parameters
from reportgen.case import Misconceptions
from reportgen.case.design_case import DesignCase
from reportgen.formula import PI, Expression, Number, Ref, cis, heading
from reportgen.formula.calculation import ZERO, Calculation
from reportgen.formula.ledger import MistakenValues


@dataclass(frozen=True)
class SolvedRotor(DesignCase):
    """An assignment of a rotor with its ledger."""

    @property
    def given(self) -> Parameters:
        parameters: Parameters = self.assignment.parameters
        return parameters

    @property
    def finds(self) -> bool:
        """True if the place of plane B or two masses are sought."""
        return self.given.finds_plane or bool(self.given.sought_masses)

    @property
    def weighed(self) -> tuple[str, ...]:
        """The places of the masses that are given."""
        return tuple(place for place in self.masses if place not in self.given.sought_masses)

    @property
    def two_planes(self) -> bool:
        return self.given.planes.B is not None

    @cached_property
    def masses(self) -> tuple[str, ...]:
        """The places of the unbalanced masses."""
        return tuple(str(number) for number in range(1, len(self.given.masses) + 1))

    @property
    def moments(self) -> tuple[str, ...]:
        """Places of the masses with a moment about plane A; () if all are in that plane."""
        return self.masses if self.given.has_couple else ()

    @cached_property
    def calculation(self) -> Calculation:
        return RotorCalculation(self.given).written()

    @property
    def speed(self) -> float | None:
        """Angular velocity of the rotor (rad/s)."""
        return None if self.given.n is None else self.given.n.si

    @property
    def planes(self) -> tuple[str, ...]:
        """The names of the correction planes, from left to right."""
        return tuple(self.given.planes_by_name)

    def force_on(self, when: str, place: str) -> complex:
        """Return the force on a bearing (N, x + iy) in the axes that turn with the rotor; 0 instead of a rounding
        error.
        """
        ω = self.ledger["rotor.omega"].at(1)
        x, y = (self.ledger[rotor_ids.share(when, axis, place)].at(1) for axis in "xy")
        most = sum(abs(self.ledger[rotor_ids.unbalance(mass)].at(1)) for mass in self.masses)
        return 0j if abs(complex(x, y)) <= ZERO * most else complex(x, y) * ω**2

    @property
    def permitted(self) -> tuple[bool, ...] | None:
        """Flags by bearing, True if the remaining unbalance with the printed corrections is within the grade; None
        without a grade.
        """
        if self.given.grade is None:
            return None
        most = self.printed[rotor_ids.permitted("plane")].at(1)
        return tuple(bool(self.printed[rotor_ids.at_bearing(AFTER, place)].at(1) <= most) for place in BEARINGS)

    # --- what is often taken for something else

    @cached_property
    def misconceptions(self) -> Misconceptions:
        """Common mistakes: planes exchanged, z from a wrong plane, statics alone, the wrong side, ω for ω², degrees for
        radians.
        """
        changed: dict[str, list[tuple[str, Expression]]] = {}
        mistakes = *self._of_planes(), *self._of_sides(), *self._of_degrees(), *self._of_speed()
        for id, name, formula in mistakes:
            if id in self.ledger:
                changed.setdefault(id, []).append((name, formula))
        return Misconceptions(changed=changed)

    @property
    def _α(self) -> Mapping[str, Expression]:
        return {place: Ref(rotor_ids.angle(place)) for place in self.masses}

    @property
    def _U(self) -> Mapping[str, Expression]:
        return {place: Ref(rotor_ids.unbalance(place)) for place in self.masses}

    @property
    def _V(self) -> Mapping[str, Expression]:
        return {place: Ref(rotor_ids.moment(place)) for place in self.moments}

    def _of_planes(self) -> MistakenValues:
        """Yield common mistakes with two planes."""
        if self.given.finds_plane:
            yield (
                rotor_ids.station(RIGHT),
                "rotor-plane-side",
                2 * Ref(rotor_ids.station(LEFT)) - Ref(rotor_ids.station(RIGHT)),
            )
            return
        if not self.two_planes:
            return
        U, V, α, L = self._U, self._V, self._α, Ref("rotor.L")
        far = -(resultant(V, α) / L)
        near = -(resultant(U, α) + far)
        static = -resultant(U, α)
        for plane, exchanged in ((RIGHT, near), (LEFT, far)):
            yield from taken(plane, "rotor-planes-exchanged", exchanged)
            for number in (1.0, 2.0):
                yield from taken(plane, "rotor-static-only", static / number)
        for origin in self._origins():
            moments = {place: U[place] * (Ref(rotor_ids.station(place)) - origin) for place in self.masses}
            for place, moment in moments.items():
                yield rotor_ids.moment(place), "rotor-plane-z", moment
                yield rotor_ids.moment(place), "rotor-plane-z", -moment
            # Moments about plane B give the correction of plane A.
            if origin != Ref(rotor_ids.station(RIGHT)):
                yield from taken(RIGHT, "rotor-plane-z", -(resultant(moments, α) / L))

    def _origins(self) -> Iterator[Expression]:
        """Yield wrong origins of z: the right plane, the origin of all z, a bearing."""
        at = {place: self.ledger[rotor_ids.station(place)].values[0] for place in (LEFT, RIGHT)}
        yield Ref(rotor_ids.station(RIGHT))
        if at[LEFT]:
            yield Number(0.0)
        for place in BEARINGS if self.given.bearings else ():
            if self.ledger[rotor_ids.station(place)].values[0] != at[LEFT]:
                yield Ref(rotor_ids.station(place))

    def _of_sides(self) -> MistakenValues:
        """Yield the mistake of placing the mass on the side of the unbalance, not opposite to it."""
        drawn = ("U", RIGHT) if self.given.finds_plane else ("V", RIGHT)
        for of, plane in (drawn, *([] if self.given.finds_plane else [("U", LEFT)])):
            yield rotor_ids.direction(plane), "rotor-wrong-side", heading(Ref(rotor_ids.drawn(of, plane))) + PI

    def _of_degrees(self) -> MistakenValues:
        """Yield the mistake of entering degrees into a calculator in radian mode, for all masses."""
        α = {place: in_degrees(angle) for place, angle in self._α.items()}
        static, name = resultant(self._U, α), "degrees-for-radians"
        if self.given.finds_plane:
            yield from ()
        elif self.two_planes:
            yield from taken(RIGHT, name, -(resultant(self._V, α) / Ref("rotor.L")))
            own = Ref(rotor_ids.unbalance(RIGHT)) * cis(in_degrees(Ref(rotor_ids.direction(RIGHT))))
            yield from taken(LEFT, name, -(static + own))
            yield from taken(LEFT, name, -(static - resultant(self._V, α) / Ref("rotor.L")))
        else:
            yield from taken(LEFT, name, -static)
        if self.given.bearings is None:
            return
        near, far = BEARINGS
        A, b = Ref(rotor_ids.station(LEFT)), Ref("rotor.b")
        for place, opposite in ((near, far), (far, near)):
            moment = static * (Ref(rotor_ids.station(opposite)) - A)
            if self.moments:
                moment = moment - resultant(self._V, α)
            for id, factor in self._of_bearing(place):
                yield id, name, abs(moment / b) * factor

    def _of_bearing(self, place: str) -> Iterator[tuple[str, Expression]]:
        yield rotor_ids.at_bearing(BEFORE, place), Number(1.0)
        yield rotor_ids.bearing_force(BEFORE, place), Ref("rotor.omega") ** 2

    def _of_speed(self) -> MistakenValues:
        """Yield the mistake U ω for U ω²."""
        for when in (BEFORE, AFTER):
            for place in BEARINGS:
                U = Ref(rotor_ids.at_bearing(when, place))
                yield rotor_ids.bearing_force(when, place), "rotor-speed-once", U * Ref("rotor.omega")


def in_degrees(angle: Expression) -> Expression:
    return angle * 180 / PI


def taken(plane: str, name: str, correction: Expression) -> MistakenValues:
    """Yield the mistake of using another vector as the correction in a plane: its size and its direction."""
    yield rotor_ids.unbalance(plane), name, abs(correction)
    yield rotor_ids.direction(plane), name, heading(correction)
