"""Positions of points by the coordinates of the bodies: chains of vectors from the ground, and loops that they close.

Each body has an angle φ, each point on a straight line its travel s along it.  A point reached by two chains closes a
loop, Σ legs = Σ legs; a disc that rolls or meshes relates angles and travels by constant factors, Σ factor · coordinate
= const.  Both hold at any time, so their derivatives hold, too.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator
from dataclasses import dataclass, field

from reportgen.base.records import Record, replace
from reportgen.exercise import file
from reportgen.exercise.derivation import Derivation, angle
from reportgen.exercise.instant_centres import SAME_PLACE
from reportgen.exercise.point_positions import unit
from reportgen.exercise.rate_conditions import GROUND
from reportgen.formula import (
    MINUS_ONE,
    NOTHING,
    ONE,
    Expression,
    Ref,
    Symbol,
    between,
    ids,
    is_zero,
    minus,
    plus,
    refs,
    signed,
)
from reportgen.formula.calculation import is_short
from reportgen.formula.constructions import cross, dot

HALF_TURN = math.pi
SAME_ANGLE = 1e-9


class Turn(Record):
    """The angle of a body; a rod that only keeps two points apart has a number that the file does not use."""

    body: int


class SlideTravel(Record):
    """The travel of a point along a straight line, by the number of the line."""

    number: int


GeneralizedCoordinate = Turn | SlideTravel


class Direction(Record):
    """A direction that turns with a body, at `offset` (rad) from its φ; on the ground, from the x-axis."""

    body: int
    offset: float


class CoordinateRate(Record):
    """The derivative of a coordinate, or the speed of a point if that is not a coordinate."""

    of: GeneralizedCoordinate | str
    order: int


class LoopVector(Record):
    """A vector of a loop or of its derivative: a length along a direction turned by right angles.

    `slide` is the coordinate that the length represents; in a derivative, `rates` are further factors of the length.
    """

    length: Expression
    value: float
    direction: Direction
    quarters: int = 0
    slide: SlideTravel | None = None
    rates: tuple[CoordinateRate, ...] = ()

    def reversed(self) -> LoopVector:
        return replace(self, length=minus(self.length), value=-self.value)


class Place(Record):
    """Position of a point: the coordinates of a fixed point and a chain of legs from there."""

    fixed: tuple[Expression, Expression] = (NOTHING, NOTHING)
    legs: tuple[LoopVector, ...] = ()

    def by(self, *legs: LoopVector) -> Place:
        return replace(self, legs=(*self.legs, *(leg for leg in legs if abs(leg.value) > SAME_PLACE or leg.slide)))


class Closure(Record):
    """A point reached by two chains; the loop runs outward along one and back along the other."""

    point: str
    outward: Place
    back: Place


class StraightPath(Record):
    """A point that slides along a straight line: the point, its body, the body of the line and its unit direction."""

    point: str
    body: int
    on: int
    along: complex


Relation = dict[GeneralizedCoordinate, tuple[Expression, float]]
"""Σ factor · rate = 0, each factor with its value."""


@dataclass
class Linked:
    """The positions of all points of a system, its loops and relations, as functions of its coordinates."""

    derivation: Derivation
    places: dict[str, Place] = field(default_factory=dict)
    closures: list[Closure] = field(default_factory=list)
    relations: list[Relation] = field(default_factory=list)
    lines: list[StraightPath] = field(default_factory=list)
    rods: dict[int, tuple[str, str]] = field(default_factory=dict)
    """The ends of rods that are not bodies of the file, by their numbers."""
    reference: dict[int, float] = field(default_factory=dict)
    """The φ of each body at the instant (rad)."""
    turning: dict[int, int] = field(default_factory=dict)
    """The body with which each body turns."""
    read_off: dict[str, tuple[float, Symbol]] = field(default_factory=dict)
    """The travels along lines that are read off the figure unless a formula gives them before they are needed."""

    def __post_init__(self) -> None:
        given, layout = self.derivation.layout.given, self.derivation.layout
        self.members = {body: layout.own(body) for body in layout.members}
        self._join_turns()
        moving = {name for names in self.members.values() for name in names}
        self.places = {name: Place(self._coordinates(name)) for name in given.points if name not in moving}
        for joint in given.joints:
            if isinstance(joint, file.Pin) and GROUND in joint.bodies:
                self.places[joint.at] = Place(self._coordinates(joint.at))
                body = max(joint.bodies)
                if joint.at not in self.members[body]:
                    self.members[body].append(joint.at)
        waiting, joints = dict(self.members), [*enumerate(given.joints)]
        while (
            self._next_body(waiting, driven=True)
            or self._next_joint(waiting, joints)
            or self._next_body(waiting, driven=False)
        ):
            pass
        for joint in given.joints:
            if isinstance(joint, file.Gears | file.RollingOnCircle | file.Belt):
                self._relate_discs(joint)

    # --- angles

    def _join_turns(self) -> None:
        """Let bodies that slide along a guide without rotating relative to it turn with its body."""
        self.turning = {GROUND: GROUND, **{body: body for body in self.members}}
        for joint in self.derivation.layout.given.joints:
            match joint:
                case file.Slider(body=body, on=on):
                    self._turn_alike(body, on)
                case file.Translation(body=body):
                    self._turn_alike(body, GROUND)

    def _turn_alike(self, first_body: int, second_body: int) -> None:
        least, most = sorted((self.turning[first_body], self.turning[second_body]))
        self.turning |= {body: least for body, leader in self.turning.items() if leader == most}

    def direction(self, body: int, of: complex) -> tuple[Direction, int]:
        """Return a unit direction as it turns with a body, and its sense along φ: +1, or −1 against it."""
        leader, now = self.turning.get(body, body), cmath.phase(of)
        if leader == GROUND:
            return Direction(GROUND, now), 1
        if leader not in self.reference:
            known = self.derivation.q.find(ids.formula_angle(leader))
            self.reference[leader] = now if known is None else self.derivation.q.si(known)
        offset = math.remainder(now - self.reference[leader], 2 * math.pi)
        if abs(abs(offset) - HALF_TURN) < SAME_ANGLE:
            return Direction(leader, 0.0), -1
        return Direction(leader, 0.0 if abs(offset) < SAME_ANGLE else offset), 1

    def heading(self, direction: Direction) -> float:
        """Return a direction at the instant (rad from +x)."""
        return self.reference.get(direction.body, 0.0) + direction.offset

    def angle(self, direction: Direction) -> Expression:
        """Return a direction for formulas: φ₂, φ₂ + 30°, 60°."""
        return self._from(self.phi(direction.body) if direction.body else NOTHING, direction.offset)

    def phi(self, body: int) -> Expression:
        """Return the angle of a body as read off the figure."""
        q, id = self.derivation.q, ids.formula_angle(body)
        return q.find(id) or q.give(id, self.reference[body], Symbol("φ", self.letter(body)), exact=False)

    def travel_id(self, slide: SlideTravel) -> str:
        return ids.slide_way(f"{self.lines[slide.number].body},{slide.number}")

    def with_travels(self, of: Expression) -> Expression:
        """Return a length after its travels have been entered in the derivation."""
        for id in refs(of):
            if id not in self.derivation.q:
                value, symbol = self.read_off[id]
                self.derivation.q.give(id, value, symbol, exact=False)
        return of

    def letter(self, body: int) -> str:
        """Return the index of the letters of a body: its number, or the ends of a rod."""
        return "".join(self.rods[body]) if body in self.rods else str(body)

    def _from(self, start: Expression, offset: float) -> Expression:
        if abs(offset) < SAME_ANGLE and start != NOTHING:
            return start
        size = angle(self.derivation.q, abs(offset))
        if start == NOTHING:
            return size if offset >= 0 or is_zero(size) else minus(size)
        return plus(start, size if offset > 0 else minus(size))

    def between(self, start_direction: Direction, end_direction: Direction) -> Expression:
        """Return the angle from one direction to another, as an expression."""
        if start_direction.body == end_direction.body:
            return self._from(NOTHING, math.remainder(end_direction.offset - start_direction.offset, 2 * math.pi))
        start, end = self.angle(start_direction), self.angle(end_direction)
        return minus(start) if is_zero(end) else between(end, start)

    # --- lengths

    def _coordinates(self, point: str) -> tuple[Expression, Expression]:
        at = self.derivation.layout.points[point]
        x, y = (self._coordinate(axis, point, part) for axis, part in zip("xy", (at.real, at.imag), strict=True))
        return x, y

    def _coordinate(self, axis: str, point: str, value: float) -> Expression:
        if abs(value) < SAME_PLACE:
            return NOTHING
        q, id = self.derivation.q, ids.formula_coordinate(axis, point)
        return q.find(id) or q.give(id, value, exact=is_short(value))

    def arm(self, body: int, base: str, point: str) -> tuple[LoopVector, ...]:
        """Return the legs from one point of a body to another; `()` if they coincide."""
        reach = self.derivation.layout.points[point] - self.derivation.layout.points[base]
        if abs(reach) < SAME_PLACE:
            return ()
        direction, sense = self.direction(body, reach)
        return (LoopVector(signed(sense, self.derivation.length(base, point)), sense * abs(reach), direction),)

    # --- chains

    def _next_body(self, waiting: dict[int, list[str]], driven: bool) -> bool:
        """Reach all points of a body that has a reached point: first driving bodies, then driven ones."""

        def is_driven(body: int) -> bool:
            return self.derivation.knows_omega(body) or any(
                name in self.places and self.places[name].legs for name in waiting[body]
            )

        reached = [body for body, names in waiting.items() if any(name in self.places for name in names)]
        chosen = [body for body in reached if is_driven(body)] if driven else reached
        if not chosen:
            return False
        body = min(chosen, key=lambda one: not self.derivation.knows_omega(one))
        names = waiting.pop(body)
        base = min((name for name in names if name in self.places), key=lambda name: len(self.places[name].legs))
        for name in names:
            if name != base:
                self._reach(name, self.places[base].by(*self.arm(body, base, name)))
        return True

    def _reach(self, point: str, place: Place) -> None:
        known = self.places.get(point)
        if known is None:
            self.places[point] = place
            return
        self.closures.append(Closure(point, known, place))
        if len(place.legs) < len(known.legs):
            self.places[point] = place

    def _next_joint(self, waiting: dict[int, list[str]], joints: list[tuple[int, file.Joint]]) -> bool:
        """Reach points over a joint by which points move along lines or keep their distance."""
        for number, (_, joint) in enumerate(joints):
            if isinstance(joint, file.SlotJoint | file.Slider | file.RollingOnLine):
                line = self._line(joint)
                if line.on != GROUND and line.on in waiting and line.point not in self.places:
                    continue
                del joints[number]
                self._slide(joint, line)
                return True
            if isinstance(joint, file.Cord | file.RollingOnCircle):
                ends = self._ends(joint)
                if not any(end in self.places for end in ends):
                    continue
                del joints[number]
                if not isinstance(joint, file.RollingOnCircle) or self._arm_of(*ends) is None:
                    self._apart(*ends)
                return True
        return False

    def _line(self, joint: file.SlotJoint | file.Slider | file.RollingOnLine) -> StraightPath:
        along = self.derivation.layout.geometry.direction(joint)
        match joint:
            case file.SlotJoint(point=point, body=body):
                return StraightPath(point, body, joint.on, along)
            case file.Slider(body=body):
                return StraightPath(self.derivation.layout.given.bodies[body].carried[0], body, joint.on, along)
        return StraightPath(self.derivation.layout.geometry.disc(joint.disc).centre, joint.disc, joint.on, along)

    def _slide(self, joint: file.Joint, line: StraightPath) -> None:
        """Enter P = T + s e + h n, along and across the line from a point of its body, or from the origin on the
        ground.
        """
        q, points, number = self.derivation.q, self.derivation.layout.points, len(self.lines)
        self.lines.append(line)
        on_ground = self.turning.get(line.on, line.on) == GROUND and line.on == GROUND
        base = "" if on_ground else self._base(line)
        there = points[line.point] - (points[base] if base else 0j)
        direction, sense = self.direction(line.on, line.along)
        slide, relative = SlideTravel(number), "" if on_ground else "r"
        gone = sense * dot(line.along, there)
        id = self.travel_id(slide)
        self.read_off[id] = (gone, Symbol("s", line.point, relative))
        legs = [LoopVector(Ref(id), gone, direction, slide=slide)]
        if abs(off := sense * cross(line.along, there)) > SAME_PLACE:
            id = ids.loop_distance(f"{line.body},{number}")
            h = q.give(id, abs(off), Symbol("h", line.point, relative), exact=is_short(abs(off)))
            legs.append(LoopVector(signed(off, h), off, direction, 1))
        if sense < 0:
            self.lines[number] = replace(line, along=-line.along)
        if base and base not in self.places:
            self._reach(base, self.places[line.point].by(*(leg.reversed() for leg in legs)))
        else:
            self._reach(line.point, (self.places[base] if base else Place()).by(*legs))
        if isinstance(joint, file.RollingOnLine):
            self._roll(joint, slide, self.lines[number])

    def _base(self, line: StraightPath) -> str:
        """Return the reached point of a line's body from which travels count, on the line if possible."""
        points, names = self.derivation.layout.points, self.members[line.on]
        known = [name for name in names if name in self.places] or names

        def rank(name: str) -> tuple[bool, int]:
            off = abs(cross(line.along, points[name] - points[line.point])) > SAME_PLACE
            return off, len(self.places[name].legs) if name in self.places else 0

        return min(known, key=rank)

    def _roll(self, joint: file.RollingOnLine, slide: SlideTravel, line: StraightPath) -> None:
        """Relate ṡ = R (ω of the line − ω of the disc), for a disc to the left of the line."""
        layout = self.derivation.layout
        touch = layout.geometry.contact_on_line(joint)
        side = math.copysign(1.0, cross(line.along, layout.points[line.point] - touch))
        radius = self._radius(joint.disc, layout.contacts[layout.given.joints.index(joint)])
        value = side * self.derivation.q.si(radius)
        relation: Relation = {slide: (ONE, 1.0), Turn(self.turning[joint.disc]): (signed(side, radius), value)}
        if leader := self.turning[joint.on]:
            relation[Turn(leader)] = minus(signed(side, radius)), -value
        self.relations.append(relation)

    def _radius(self, disc: int, touch: str) -> Ref:
        return self.derivation.length(self.derivation.layout.geometry.disc(disc).centre, touch)

    # --- points at constant distances

    def _ends(self, joint: file.Cord | file.RollingOnCircle | file.Gears | file.Belt) -> tuple[str, str]:
        if isinstance(joint, file.Cord):
            start, end = joint.points
            return start, end
        first, second = self.derivation.layout.geometry.discs(joint)
        return first.centre, second.centre

    def _apart(self, base: str, tip: str) -> int:
        """Add a rod between two points, one of which is reached, and return its number."""
        if tip in self.places and base not in self.places:
            base, tip = tip, base
        number = 1 + max((*self.turning, *self.rods))
        self.rods[number] = base, tip
        self.turning[number] = number
        self._reach(tip, self.places[base].by(*self.arm(number, base, tip)))
        return number

    def _arm_of(self, *ends: str) -> int | None:
        """Return the body that carries both points; None if no body does, the ground if both are fixed."""
        fixed = [end for end in ends if end in self.places and not self.places[end].legs]
        if len(fixed) == len(ends):
            return GROUND
        carrying = [body for body, names in self.members.items() if {*ends} <= {*names}]
        rods = [number for number, names in self.rods.items() if {*ends} == {*names}]
        return next(iter((*carrying, *rods)), None)

    def _relate_discs(self, joint: file.Gears | file.RollingOnCircle | file.Belt) -> None:
        """Relate (ω₁ − ω_c) r₁ ± (ω₂ − ω_c) r₂ = 0 about the line of centres, + for discs that turn in
        opposite senses.
        """
        layout, index = self.derivation.layout, self.derivation.layout.given.joints.index(joint)
        ends = self._ends(joint)
        if not all(end in self.places for end in ends):
            return
        arm = self._arm_of(*ends)
        if arm is None:
            arm = self._apart(*ends)
        if isinstance(joint, file.Belt):
            touching, alike = layout.belts[index], not joint.crossed
        else:
            touching = (layout.contacts[index],) * 2
            first, second = (layout.points[touching[0]] - layout.points[end] for end in ends)
            alike = dot(first, second) > 0
        relation: Relation = {}
        for disc, touch, factor in zip(joint.discs, touching, (ONE, MINUS_ONE if alike else ONE), strict=True):
            radius, sense = self._radius(disc, touch), -1.0 if factor == MINUS_ONE else 1.0
            size = self.derivation.q.si(radius)
            for body, sign in ((disc, sense), (arm, -sense)):
                if leader := self.turning[body]:
                    before, value = relation.get(Turn(leader), (NOTHING, 0.0))
                    relation[Turn(leader)] = plus(before, signed(sign, radius)), value + sign * size
        self.relations.append({one: factor for one, factor in relation.items() if abs(factor[1]) > SAME_PLACE})


def legs_of(closure: Closure) -> Iterator[LoopVector]:
    """Yield the legs of a loop, outward and back, without those that both chains share."""
    outward, back = list(closure.outward.legs), list(closure.back.legs)
    for leg in closure.outward.legs:
        if leg in back:
            outward.remove(leg)
            back.remove(leg)
    yield from outward
    yield from (leg.reversed() for leg in back)


def given_direction(degrees: float, size: float) -> Direction:
    """Return the direction of a given vector at an angle (degrees) from +x; its magnitude (SI) may be negative."""
    return Direction(GROUND, cmath.phase(unit(degrees) * (1 if size >= 0 else -1)))
