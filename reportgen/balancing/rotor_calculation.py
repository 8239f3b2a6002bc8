"""The calculation of a rotor: products, both plans, the same by components, loads of the bearings, the quality
grade.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from reportgen.balancing import rotor_ids as names
from reportgen.balancing.rotor_file import BEARINGS, LEFT, RIGHT, Parameters
from reportgen.balancing.rotor_unknowns import unknown_masses, unknown_plane
from reportgen.base.units import MM, nice_up
from reportgen.drawing.geometry import corners_of
from reportgen.formula import PI, Expression, Number, Ref, Symbol, atan, cis, cos, heading, meet, sin, sqrt, total
from reportgen.formula.calculation import DUST, Calculation
from reportgen.formula.vocabulary import KeyChapter

ROOM = 105 + 85j
"""Largest width and height of a plan on a page (mm)."""
AXES: Mapping[str, Callable[[Expression], Expression]] = {"x": cos, "y": sin}
STRAIGHT, WHOLE_TURN = Number(180.0, unit="°"), Number(360.0, unit="°")
BEFORE, AFTER = "before", "after"


class RotorCalculation:
    """The calculation of a rotor during its construction; `written()` returns it."""

    def __init__(self, given: Parameters) -> None:
        self.given, self.q = given, Calculation()
        self.masses = tuple(str(number) for number in range(1, len(given.masses) + 1))
        self.known = tuple(place for place in self.masses if place not in given.sought_masses)
        self.α: dict[str, Ref] = {}
        self.U: dict[str, Ref] = {}
        self.V: dict[str, Ref] = {}
        self.z: dict[str, Ref] = {}

    def written(self) -> Calculation:
        with self.q.within(KeyChapter.data):
            self._enter_given()
        with self.q.within(KeyChapter.geometry):
            self._enter_products()
        with self.q.within(KeyChapter.loads):
            self._enter_plans()
        with self.q.within(KeyChapter.formulas):
            self._enter_components()
        with self.q.within(KeyChapter.forces):
            self._enter_bearings()
        with self.q.within(KeyChapter.cycle):
            self._enter_grade()
        return self.q

    def _enter_given(self) -> None:
        q, given = self.q, self.given
        for place, mass in zip(self.masses, given.masses, strict=True):
            if not mass.is_sought:
                q.give(names.mass(place), mass.m.si)
            q.give(names.radius(place), mass.r.si)
            self.α[place] = q.give(names.angle(place), mass.angle.si)
            if given.has_couple:
                self.z[place] = q.give(names.station(place), mass.z.si)
        stations = given.planes_by_name if given.has_couple or given.bearings else {}
        for place, station in (*stations.items(), *zip(BEARINGS, given.bearings or (), strict=False)):
            if not (place == RIGHT and given.finds_plane):
                self.z[place] = q.give(names.station(place), station.si)
        for plane, known in given.known_masses.items():
            for family, datum in ((names.radius, known.r), (names.mass, known.m)):
                if datum is not None:
                    q.give(family(plane), datum.si)
        if given.known_angle is not None:
            q.give(names.direction(LEFT), given.known_angle.si)
        if given.n is not None:
            q.give("rotor.n", given.n.si * 30 / math.pi)
        for id, datum in (("rotor.grade", given.grade), ("rotor.M", given.mass)):
            if datum is not None:
                q.give(id, datum.si)

    # --- U = m r and V = m r z

    def _enter_products(self) -> None:
        q = self.q
        for place in self.known:
            U = self.U[place] = q.define(names.unbalance(place), q[names.mass(place)] * q[names.radius(place)])
            q.set_out("unbalances", U)
        for place in self.known if self.given.has_couple else ():
            V = self.V[place] = q.define(names.moment(place), self.U[place] * (self.z[place] - self.z[LEFT]))
            q.set_out("moments", V)
        if self.given.planes.B is not None and not self.given.finds_plane:
            q.set_out("length", q.define("rotor.L", self.z[RIGHT] - self.z[LEFT], optional=True))

    # --- plans

    def _enter_plans(self) -> None:
        """Enter the plans: V_B closes the plan of V about plane A, where U_A has no moment; U_A closes the plan
        of U.
        """
        if self.given.finds_plane:
            self._enter_plans_with_plane()
            self._enter_masses()
            return
        if self.given.sought_masses:
            self._enter_plan_of_masses()
        q, U = self.q, dict(self.U)
        directions = dict(self.α)
        if RIGHT in self.given.planes_by_name:
            μ = self._lay_off("V", self.V, directions)
            line = self._close("V", RIGHT, self.V, directions, μ)
            U_B = q.define(names.unbalance(RIGHT), μ * line / q["rotor.L"], scale=self._scale_of(RIGHT))
            directions[RIGHT] = self._directed(RIGHT, "V", U_B)
            U[RIGHT] = U_B
            q.set_out("right", U_B)
        μ = self._lay_off("U", U, directions)
        line = self._close("U", LEFT, U, directions, μ)
        U_A = q.define(names.unbalance(LEFT), μ * line, scale=self._scale_of(LEFT))
        self._directed(LEFT, "U", U_A)
        q.set_out("left", U_A)
        self._enter_masses()

    def _enter_plans_with_plane(self) -> None:
        """Enter the plans if the place of B is sought: V_B closes the plan of V and gives the line of U_B, along which
        the plan of U closes with U_A at its known angle; z_B = z_A ± V_B/U_B.
        """
        q, solution = self.q, unknown_plane(self.given)
        assert solution is not None, "checks refuse a rotor without a solution"
        μ = self._lay_off("V", self.V, self.α)
        side = self._close("V", RIGHT, self.V, self.α, μ)
        V_B = q.define(names.moment(RIGHT), μ * side, scale=self._all(self.V))
        q.set_out("right_moment", V_B)
        α = q[names.direction(LEFT)]
        μ = self._lay_off("U", self.U, self.α, ends=(-solution.far,))
        start = resultant(self.U, self.α) / μ
        corner = meet(start, cis(α), Number(0.0), Ref(names.drawn("V", RIGHT)))
        drawn: dict[str, Expression] = {LEFT: corner - start, RIGHT: -corner}
        for plane, line in ((LEFT, "left"), (RIGHT, "right")):
            q.construct(names.drawn("U", plane), drawn[plane])
            side = self._side("U", plane, μ)
            q.set_out(line, q.define(names.unbalance(plane), μ * side, scale=self._scale_of(plane)))
        U_B = q[names.unbalance(RIGHT)]
        self._directed(RIGHT, "U", U_B)
        L = q.define("rotor.L", V_B / U_B, optional=True)
        z_B = self.z[LEFT] + L if solution.distance > 0 else self.z[LEFT] - L
        self.z[RIGHT] = q.define(names.station(RIGHT), z_B)
        q.set_out("place", L, self.z[RIGHT])

    def _enter_plan_of_masses(self) -> None:
        """Enter the plan of V that two masses at known angles close, and their masses m = V/(r (z − z_A))."""
        q = self.q
        first, second = self.given.sought_masses
        known = {place: self.α[place] for place in self.known}
        solution = unknown_masses(self.given)
        assert solution is not None, "checks refuse a rotor without a solution"
        arm = self.given.sought_masses[second].z.si - self.given.planes.A.si
        last = solution[second] * arm * np.exp(1j * q.si(self.α[second]))
        μ = self._lay_off("V", self.V, known, ends=(-last,))
        start = resultant(self.V, known) / μ if known else Number(0.0)
        corner = meet(start, cis(self.α[first]), Number(0.0), cis(self.α[second]))
        for place, drawn in ((first, corner - start), (second, -corner)):
            q.construct(names.drawn("V", place), drawn)
            side = self._side("V", place, μ)
            away = self.given.sought_masses[place].z.si > self.given.planes.A.si
            arm_of = self.z[place] - self.z[LEFT] if away else self.z[LEFT] - self.z[place]
            U = self.U[place] = q.define(names.unbalance(place), μ * side / arm_of)
            m = q.define(names.mass(place), U / q[names.radius(place)])
            self.V[place] = q.define(names.moment(place), U * (self.z[place] - self.z[LEFT]), optional=True)
            q.set_out("sought", U, m)
        self.U, self.V = ({place: sizes[place] for place in self.masses} for sizes in (self.U, self.V))

    def _lay_off(
        self, of: str, sizes: Mapping[str, Ref], directions: Mapping[str, Ref], ends: Sequence[complex] = ()
    ) -> Ref:
        """Return the scale of a plan, and its known sides on paper; `ends` are further corners of the plan (SI)."""
        q = self.q
        unit_size = q.families[next(iter(sizes.values())).id].how.scale
        steps = [q.si(sizes[place]) * np.exp(1j * q.si(directions[place])) / unit_size for place in sizes]
        low, high = corners_of(np.array([*np.cumsum([0.0, *steps]), *(end / unit_size for end in ends)]))
        room = max((high - low).real / ROOM.real, (high - low).imag / ROOM.imag)
        per_mm = nice_up(room) * unit_size * MM
        μ = q.give(names.scale(of), per_mm, optional=True)
        for place, size in sizes.items():
            q.define(
                names.laid_off(of, place), size / μ, Symbol("s", f"{of}{place}"), optional=True, scale=abs(ROOM) / MM
            )
        return μ

    def _close(self, of: str, plane: str, sizes: Mapping[str, Ref], directions: Mapping[str, Ref], μ: Ref) -> Ref:
        """Return the measured side that closes a plan: the sum of all others, reversed."""
        self.q.construct(names.drawn(of, plane), -(resultant(sizes, directions) / μ))
        return self._side(of, plane, μ)

    def _side(self, of: str, place: str, μ: Ref) -> Ref:
        """Return the measured length of a side that is drawn."""
        q, sizes = self.q, self.U if of == "U" else self.V
        all_sides = sum(abs(q.si(size)) for size in sizes.values()) / q.si(μ)
        drawn = abs(Ref(names.drawn(of, place)))
        side = Symbol("s", f"{of}{place}")
        return q.define(names.laid_off(of, place), drawn, side, optional=True, scale=all_sides)

    def _directed(self, plane: str, of: str, size: Ref) -> Ref:
        return self.q.define(names.direction(plane), heading(Ref(names.drawn(of, plane))), of=size.id)

    def _enter_masses(self) -> None:
        q = self.q
        for plane in self.given.known_masses:
            U = q[names.unbalance(plane)]
            if names.radius(plane) in q:
                q.set_out("corrections", q.define(names.mass(plane), U / q[names.radius(plane)]))
            else:
                q.set_out("corrections", q.define(names.radius(plane), U / q[names.mass(plane)]))

    # --- components

    def _enter_components(self) -> None:
        q = self.q
        plans = {
            of: {place: sizes[place] for place in self.known if place in sizes}
            for of, sizes in (("U", self.U), ("V", self.V))
        }
        for of, sizes in plans.items():
            every = self._all(sizes)
            for axis, function in AXES.items() if sizes else ():
                parts = [
                    q.define(
                        names.component(of, axis, place), size * function(self.α[place]), optional=True, scale=every
                    )
                    for place, size in sizes.items()
                ]
                both = q.define(names.resultant(of, axis), total(parts), optional=True, scale=every)
                q.set_out(f"resultant_{of}", both)
        U = {axis: q[names.resultant("U", axis)] for axis in AXES}
        far: dict[str, Ref] = {}
        if self.given.finds_plane:
            self._enter_plane_by_components(U)
            return
        forces: dict[str, Expression] = dict(U)
        for place, m in self._masses_by_components().items():
            forces = {axis: forces[axis] + m * q[names.radius(place)] * AXES[axis](self.α[place]) for axis in AXES}
        if RIGHT in self.given.planes_by_name:
            L = q["rotor.L"]
            far = {axis: self._part(RIGHT, axis, -q[names.resultant("V", axis)] / L) for axis in AXES}
            self._enter_polar(RIGHT, far)
        near = {axis: self._part(LEFT, axis, -(forces[axis] + far[axis]) if far else -forces[axis]) for axis in AXES}
        self._enter_polar(LEFT, near)

    def _enter_plane_by_components(self, U: Mapping[str, Ref]) -> None:
        """Enter U_A = −U × V/(e × V) with its direction e, U_B = −(U + U_A e), and z_B by V + U_B (z_B − z_A) = 0."""
        q, α = self.q, self.q[names.direction(LEFT)]
        V = {axis: q[names.resultant("V", axis)] for axis in AXES}
        across = cos(α) * V["y"] - sin(α) * V["x"]
        U_A = q.define(
            names.by_components("U", LEFT), -(U["x"] * V["y"] - U["y"] * V["x"]) / across, scale=self._scale_of(LEFT)
        )
        q.set_out("by_components", U_A)
        far = {axis: self._part(RIGHT, axis, -(U[axis] + U_A * function(α))) for axis, function in AXES.items()}
        self._enter_polar(RIGHT, far)
        U_B = q[names.by_components("U", RIGHT)]
        place = self.z[LEFT] - (V["x"] * far["x"] + V["y"] * far["y"]) / U_B**2
        q.set_out("by_components", q.define(names.by_components("z", RIGHT), place))

    def _masses_by_components(self) -> dict[str, Ref]:
        """Return the sought masses: V_i = −V × e_j/(e_i × e_j) with their directions e_i and e_j, over r (z − z_A)."""
        q, sought = self.q, tuple(self.given.sought_masses)
        if not sought:
            return {}
        α, β = (self.α[place] for place in sought)
        across = cos(α) * sin(β) - sin(α) * cos(β)
        x, y = (q[names.resultant("V", axis)] for axis in AXES)
        masses: dict[str, Ref] = {}
        tops = y * cos(β) - x * sin(β), x * sin(α) - y * cos(α)
        for place, top in zip(sought, tops, strict=True):
            V = q.define(names.by_components("V", place), top / across, optional=True)
            arm = self.z[place] - self.z[LEFT]
            m = masses[place] = q.define(names.by_components("m", place), V / (q[names.radius(place)] * arm))
            q.set_out("by_components", V, m)
        return masses

    def _all(self, sizes: Mapping[str, Ref]) -> float:
        """Return the sum of the sizes of all masses (SI); 1e-9 of it is negligible."""
        return sum(abs(self.q.si(one)) for one in sizes.values())

    def _scale_of(self, plane: str) -> float:
        """Return the size of a correction (kg·m) if all masses pulled in one direction."""
        if self.given.finds_plane:
            return self._all(self.U)
        couples = self._all(self.V) / self.q.si("rotor.L") if RIGHT in self.given.planes_by_name else 0.0
        return couples if plane == RIGHT else self._all(self.U) + couples

    def _part(self, plane: str, axis: str, formula: Expression) -> Ref:
        scale = self._scale_of(plane)
        part = self.q.define(names.component("U", axis, plane), formula, optional=True, scale=scale)
        self.q.set_out("by_components", part)
        return part

    def _enter_polar(self, plane: str, parts: Mapping[str, Ref]) -> None:
        """Enter the size of a correction and its angle within one turn."""
        q, x, y = self.q, parts["x"], parts["y"]
        size = q.define(names.by_components("U", plane), sqrt(x**2 + y**2), scale=self._scale_of(plane))
        α = q.define(names.by_components("alpha", plane), angle_of(q, x, y), of=size.id)
        # A correction of size zero has no direction.
        q.set_out("by_components", size, *([α] if q.families[size.id].at(1) else []))

    # --- bearings

    def _enter_bearings(self) -> None:
        q = self.q
        if self.given.bearings is None:
            return
        ω = q.define("rotor.omega", 2 * PI * q["rotor.n"] / 60)
        near, far = BEARINGS
        b = q.define("rotor.b", self.z[far] - self.z[near], optional=True)
        q.set_out("speed", ω, b)
        for when in (BEFORE, AFTER):
            for place, opposite, sense in ((near, far, -1), (far, near, 1)):
                parts = {axis: self._at_bearing(when, axis, place, opposite, sense) for axis in AXES}
                self._enter_force(when, place, parts)

    def _at_bearing(self, when: str, axis: str, place: str, opposite: str, sense: int) -> Ref:
        """Return the share of the whole unbalance at a bearing, by moments about the opposite bearing."""
        q, z, b = self.q, self.z, self.q["rotor.b"]
        arm = z[opposite] - z[LEFT] if sense < 0 else z[LEFT] - z[opposite]
        if when == BEFORE:
            moment = q[names.resultant("U", axis)] * arm
            if self.V:
                V = q[names.resultant("V", axis)]
                moment = moment - V if sense < 0 else moment + V
            formula = moment / b
        else:
            formula = q[names.share(BEFORE, axis, place)]
            for plane in self.given.planes_by_name:
                U, α = q[names.unbalance(plane)], q[names.direction(plane)]
                arm = z[opposite] - z[plane] if sense < 0 else z[plane] - z[opposite]
                formula = formula + U * AXES[axis](α) * arm / b
        traits: dict[str, Any] = {"optional": True, "residue": self._left_by_rounding(when), "scale": self._borne()}
        return q.define(names.share(when, axis, place), formula, **traits)

    def _borne(self) -> float:
        """Return the load of a bearing (kg·m) if all masses pulled in one direction."""
        q = self.q
        arm = max(abs(q.si(self.z[bearing]) - q.si(self.z[LEFT])) for bearing in BEARINGS)
        return (self._all(self.U) * arm + self._all(self.V)) / q.si("rotor.b")

    def _left_by_rounding(self, when: str) -> bool:
        """Return True if the only remaining load comes from rounding of the printed corrections."""
        return when == AFTER and (RIGHT in self.given.planes_by_name or not self.V)

    def _enter_force(self, when: str, place: str, parts: Mapping[str, Ref]) -> None:
        q, borne = self.q, self._borne()
        traits: dict[str, Any] = {"residue": self._left_by_rounding(when), "scale": borne}
        U = q.define(names.at_bearing(when, place), sqrt(parts["x"] ** 2 + parts["y"] ** 2), **traits)
        in_metres = q.define(names.in_metres(when, place), U, q.families[U.id].symbol, optional=True, **traits)
        traits["scale"] = borne * q.si("rotor.omega") ** 2
        N = q.define(names.bearing_force(when, place), in_metres * q["rotor.omega"] ** 2, **traits)
        q.set_out(f"{when}_{place}", *parts.values(), U, in_metres, N)

    # --- the quality grade

    def _enter_grade(self) -> None:
        q, given = self.q, self.given
        if given.grade is None:
            return
        e = q.define(names.permitted("e"), q["rotor.grade"] / q["rotor.omega"])
        U = q.define(names.permitted("U"), q["rotor.M"] * e)
        half = q.define(names.permitted("plane"), U / 2, optional=True)
        q.set_out("grade", e, U, half)
        share = half if RIGHT in given.planes_by_name else U
        for plane in given.known_masses:
            q.set_out("tolerances", q.define(names.tolerance(plane), share / q[names.radius(plane)]))


def resultant(sizes: Mapping[str, Expression], directions: Mapping[str, Expression]) -> Expression:
    """Return Σ U e^{iα}."""
    return total([size * cis(directions[place]) for place, size in sizes.items()])


def angle_of(q: Calculation, x: Ref, y: Ref) -> Expression:
    """Return the direction of a vector with these components, from 0° to 360°."""
    across, along = q.si(y), q.si(x)
    if abs(along) <= DUST * abs(across) or along == 0:
        return Number(90.0 if across >= 0 else 270.0, unit="°")
    if along < 0:
        return STRAIGHT + atan(y / x)
    return atan(y / x) if across >= 0 else WHOLE_TURN + atan(y / x)
