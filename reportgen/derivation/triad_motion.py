"""Ledger entries for the motion of a group of class III, by a special point of Assur.

The lines of two legs meet in the special point S, taken as a point of the plate. All points of the plate on the line of
a leg have the same velocity along it, so S moves as the common joint of two rods would: v_S = v_P + v_SP, where v_SP is
square to the leg, for both legs. The joint Q of the third leg then follows from v_Q = v_S + v_QS and from its own leg,
which gives the rotation of the plate. The accelerations follow in the same order; a_S has the known parts aⁿ_QP of the
leg and aⁿ_SQ = ω² QS of the plate.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence

import numpy as np

from reportgen.base.records import Record
from reportgen.derivation.equation_sides import Scheme, Side, image, triad_sides
from reportgen.derivation.kinematic_entries import Kinematics, What
from reportgen.derivation.link_points import enter_rod, images, places
from reportgen.derivation.side_motion import (
    enter_relative,
    known_acceleration,
    relative_velocity,
    start_of,
    unknown_acceleration,
)
from reportgen.formula import Expression, Ref, Symbol, call, cross, ids, meet, sign, turned, unit
from reportgen.formula.calculation import Calculation
from reportgen.formula.ledger import Ledger
from reportgen.formula.vocabulary import drawn_length, on_plan, segment
from reportgen.machine import Crank, SlidingDriver, Triad, TriadLeg
from reportgen.machine.kinematics import Motion, solve_motion
from reportgen.machine.triads import PAIRS


class SpecialPoint(Record):
    """The special point of two legs of a triad: its `name`, the two legs, and the third leg."""

    name: str
    pair: tuple[TriadLeg, TriadLeg]
    third: TriadLeg


def special_points(triad: Triad, taken: Collection[str]) -> list[SpecialPoint]:
    """Return the three special points of a triad; their names are not among those `taken`."""
    points = []
    for i, j, third in PAIRS:
        first, second = sorted((triad.legs[i], triad.legs[j]), key=lambda leg: leg.link)
        name = f"S{first.link}{second.link}"
        while name in taken:
            name = name.replace("S", "S′", 1)
        points.append(SpecialPoint(name, (first, second), triad.legs[third]))
    return points


def nearest_point(k: Kinematics, triad: Triad, motion: Motion) -> SpecialPoint:
    """Return the special point that stays nearest: the one of the legs whose lines cross at the largest angles.

    Over the positions of the motion, the least sine of the angle between both legs decides.
    """
    e = [motion.points[leg.inner].p - motion.points[leg.outer].p for leg in triad.legs]
    sines = [float(np.nanmin(np.abs(np.sin(np.angle(e[i] / e[j]))))) for i, j, _ in PAIRS]
    return special_points(triad, k.scheme.owner)[int(np.argmax(sines))]


def entered_point(q: Calculation | Ledger, scheme: Scheme, triad: Triad) -> SpecialPoint:
    """Return the special point by which the plans of a triad were entered."""
    points = special_points(triad, scheme.owner)
    return next(point for point in points if ids.velocity(f"{point.third.inner}{point.name}") in q)


def enter_triad(k: Kinematics, triad: Triad) -> None:
    """Enter the places, velocities and accelerations of a triad and of the points of its links."""
    motion = _trial(k)
    _places(k, triad, motion)
    *rods, plate = triad_sides(k.scheme, triad)
    legs = {side.point: side for side in rods}
    turns = {side.link: side for side in (plate, *rods)}
    for link, turn in turns.items():
        places(k, link, turn)
    entry = _Entry(k, triad, nearest_point(k, triad, motion), legs)
    entry.velocities()
    for link, turn in turns.items():
        images(k, "v", link, turn)
    entry.accelerations()
    for link, turn in turns.items():
        images(k, "a", link, turn)


def _trial(k: Kinematics) -> Motion:
    """Return the motion at the positions of the calculation, with the driver at speed 1."""
    driver = k.scheme.linkage.driver
    assert isinstance(driver, Crank | SlidingDriver)
    return solve_motion(k.scheme.linkage, k.q.value("phi.1" if isinstance(driver, Crank) else "s.1"), 1.0)


def _places(k: Kinematics, triad: Triad, motion: Motion) -> None:
    """Place the plate by the drawing curve: its joints on both arcs, turned until the third one is on its arc, too.

    The place and direction near which the drawing is tried select the assembly mode.
    """
    q, (first, second, third) = k.q, triad.legs
    for leg in triad.legs:
        k.length(leg.outer, leg.inner, leg.length)
    drawn = [k.drawn(leg.outer, leg.inner) for leg in triad.legs]
    arms: list[Expression] = []
    for leg, local in zip((second, third), triad.at, strict=True):
        k.distance(first.inner, leg.inner, local.real, local.imag)
        turn = k.constant(ids.point_turn(leg.inner), local / abs(local))
        arms.append(k.drawn(first.inner, leg.inner) * turn)
    near = [
        q.give(ids.plate_trial(triad.plate, what), values, Symbol("near"), "ratio", hidden=True)
        for what, values in (
            ("d", motion.points[first.inner].p),
            ("turn", np.exp(1j * motion.links[triad.plate].angle)),
        )
    ]
    given: list[Expression | Ref] = []
    for leg, length in zip(triad.legs, drawn, strict=True):
        given += [k.place(leg.outer), length]
    given += [*arms, *near]
    at = q.construct(ids.place(first.inner), call("plate_place", *given))
    axis = q.construct(ids.link_axis(triad.plate), call("plate_turn", *given))
    for leg, arm in zip((second, third), arms, strict=True):
        q.construct(ids.place(leg.inner), at + arm * axis)
    for leg in triad.legs:
        enter_rod(k, leg.link, leg.outer, leg.inner)
    q.construct(ids.rod(triad.plate), k.place(second.inner) - at)
    k.put(triad.plate, first.inner, axis, second.inner)


class _Entry(Record):
    """The plans of a triad while they are entered; `legs` are the sides on which the plate's joints turn."""

    k: Kinematics
    triad: Triad
    special: SpecialPoint
    legs: dict[str, Side]

    @property
    def inner(self) -> str:
        """The third leg's joint on the plate."""
        return self.special.third.inner

    def pair(self) -> Sequence[Side]:
        """Return the sides of the two legs whose lines meet in the special point."""
        return [self.legs[leg.inner] for leg in self.special.pair]

    def velocities(self) -> None:
        """Enter v_S from both legs, v_Q of the third leg and ω of the plate, the other joints by similarity."""
        k, q, name, third = self.k, self.k.q, self.special.name, self.legs[self.inner]
        first, second = self.pair()
        ends = [(k.place(side.base), q[ids.rod(side.link)]) for side in (first, second)]
        q.construct(ids.place(name), meet(*ends[0], *ends[1]))
        across = [turned(q[ids.rod(side.link)]) for side in (first, second)]
        crossing = meet(start_of(k, "v", first), across[0], start_of(k, "v", second), across[1])
        k.vertex("v", image(name), crossing)
        for side in (first, second):
            if not side.still:
                self._special_velocity(side)
        k.absolute("v", name)
        arm, along = k.place(self.inner) - k.place(name), turned(q[ids.rod(third.link)])
        k.vertex("v", image(self.inner), meet(k.image("v", name), turned(arm), start_of(k, "v", third), along))
        self._rotation()
        for side in (first, second):
            k.vertex("v", image(side.point), self._similar("v", side.point))
        for side in (third, first, second):
            if not side.still:
                relative_velocity(k, side)
            k.absolute("v", side.point)
            if side.still:
                # Relative to a fixed point the velocity is the velocity itself.
                enter_relative(k, side, q[ids.velocity(side.point)])

    def _special_velocity(self, side: Side) -> None:
        """Enter the velocity of the special point relative to the outer joint of a leg."""
        k, name = self.k, self.special.name
        along = k.q[ids.plan_point("v", image(name))] - start_of(k, "v", side)
        drawn = k.segment(
            ids.segment("v", image(side.base), image(name)), on_plan(side.base), on_plan(name), along, "v"
        )
        relative = Symbol("v", f"{name}{side.shown}")
        k.q.define(ids.velocity(f"{name}{side.base}"), k.q["mu.v"] * drawn, relative, scale=k.sizes.velocity)

    def _measured(self, point: str) -> Ref:
        """Return the distance (m) of a joint of the plate from the special point, as measured on the drawing."""
        k, q, name = self.k, self.k.q, self.special.name
        arm = abs(k.place(point) - k.place(name)) / q["drawing"]
        drawn = q.define(ids.drawn(name, point), arm, drawn_length(name, point), scale=k.span())
        return q.define(ids.length(name, point), q["mu.l"] * drawn)

    def _rotation(self) -> None:
        """Enter v_QS and the plate's ω = v_QS/QS, with the sense in which Q turns about S."""
        k, q, name, plate = self.k, self.k.q, self.special.name, self.triad.plate
        along = q[ids.plan_point("v", image(self.inner))] - k.image("v", name)
        id = ids.segment("v", image(name), image(self.inner))
        drawn = k.segment(id, on_plan(name), on_plan(self.inner), along, "v")
        pair = f"{self.inner}{name}"
        relative = q.define(ids.velocity(pair), q["mu.v"] * drawn, Symbol("v", pair), scale=k.sizes.velocity)
        rotation = ids.angular_velocity(plate)
        omega = q.define(rotation, relative / self._measured(self.inner), scale=k.sizes.rotation)
        sense = sign(cross(k.place(self.inner) - k.place(name), along))
        q.define(ids.signed("omega", plate), omega * sense, scale=k.sizes.rotation, of=rotation)

    def _similar(self, what: What, point: str) -> Expression:
        """Return the image of a joint by the similarity theorem, from S and the joint of the third leg."""
        k, name = self.k, self.special.name
        ratio = (k.place(point) - k.place(name)) / (k.place(self.inner) - k.place(name))
        base = k.image(what, name)
        return base + ratio * (k.image(what, self.inner) - base)

    def accelerations(self) -> None:
        """Enter a_S from both legs, a_Q of the third leg and ε of the plate, the other joints by similarity."""
        k, q, name, third = self.k, self.k.q, self.special.name, self.legs[self.inner]
        starts = {side.point: known_acceleration(k, side) for side in self.legs.values()}
        first, second = self.pair()
        ends = [self._towards(starts[side.point], side.point, name) for side in (first, second)]
        across = [turned(q[ids.rod(side.link)]) for side in (first, second)]
        k.vertex("a", image(name), meet(ends[0], across[0], ends[1], across[1]))
        k.absolute("a", name)
        corner = self._towards(k.image("a", name), name, self.inner)
        arm, along = k.place(self.inner) - k.place(name), turned(q[ids.rod(third.link)])
        k.vertex("a", image(self.inner), meet(corner, turned(arm), starts[self.inner], along))
        self._angular_acceleration(corner)
        for side in (first, second):
            k.vertex("a", image(side.point), self._similar("a", side.point))
        for side in (third, first, second):
            unknown_acceleration(k, side, starts[side.point], True)
            k.absolute("a", side.point)

    def _towards(self, start: Expression, base: str, point: str) -> Ref:
        """Enter aⁿ = ω² l of a point of the plate about another, from point to base; return its end on the plan."""
        k, q, plate = self.k, self.k.q, self.triad.plate
        relative, name = f"{point}{base}", self.special.name
        joint = base if point == name else point
        length = q.find(ids.length(name, joint))
        formula = q[ids.angular_velocity(plate)] ** 2 * (self._measured(joint) if length is None else length)
        known = q.define(
            ids.acceleration(relative, "n"), formula, Symbol("a", relative, "n"), scale=k.sizes.acceleration
        )
        letters = segment(on_plan(base, True), Symbol("n", relative))
        drawn = q.define(ids.relative_segment("n", relative), known / q["mu.a"], letters, scale=k.paper("a"))
        corner = ids.relative_corner("n", relative)
        laid = -(drawn * unit(k.place(point) - k.place(base)))
        return k.vertex("a", corner, start + q.construct(ids.laid("a", corner), laid))

    def _angular_acceleration(self, corner: Ref) -> None:
        """Enter aᵗ_QS and the plate's ε = aᵗ_QS/QS, with the sense in which Q turns about S."""
        k, q, name, plate = self.k, self.k.q, self.special.name, self.triad.plate
        relative = f"{self.inner}{name}"
        along = q[ids.plan_point("a", image(self.inner))] - corner
        begin, end = Symbol("n", relative), on_plan(self.inner, True)
        drawn = k.segment(ids.relative_segment("t", relative), begin, end, along, "a")
        tangential = q.define(
            ids.acceleration(relative, "t"), q["mu.a"] * drawn, Symbol("a", relative, "τ"), scale=k.sizes.acceleration
        )
        rotation, scale = ids.angular_acceleration(plate), k.sizes.rotation**2
        eps = q.define(rotation, tangential / q[ids.length(name, self.inner)], scale=scale)
        sense = sign(cross(k.place(self.inner) - k.place(name), along))
        q.define(ids.signed("eps", plate), eps * sense, scale=scale, of=rotation)
