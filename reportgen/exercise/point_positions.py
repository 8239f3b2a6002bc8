"""Positions of the points of a plane-motion exercise, its lines, and the conditions of its joints (`exercise_of`)."""

from __future__ import annotations

import cmath
from collections.abc import Iterator, Mapping
from typing import Any

from reportgen.assignment import Assignment
from reportgen.base.errors import Finding, Where
from reportgen.base.records import Record, replace
from reportgen.base.units import Given
from reportgen.exercise import file
from reportgen.exercise import rate_conditions as on
from reportgen.exercise.rate_conditions import Condition
from reportgen.exercise.rate_solution import InstantMotion, System
from reportgen.formula.constructions import circle_circle, circle_line, cross, foot, meet, real_root

TOP: Where = ("parameters",)
TOUCHING = 1e-6
"""Discs and lines touch if their distance is off by less than this share of the radius."""
PARALLEL = 1e-9
DUST = 1e-12
SAME_DIRECTION = 1e-9
"""Directions nearer than this (rad) are equal."""


class MisplacedError(Exception):
    """Raised for a point, line or contact that does not exist."""

    def __init__(self, code: str, *where: str | int, **arguments: str) -> None:
        super().__init__(code)
        self.finding = Finding(code, (*TOP, *where), arguments)


def unit(angle: float) -> complex:
    """Return the unit vector at an angle (rad); multiples of a quarter turn are exact."""
    quarters = angle / (cmath.pi / 2)
    if abs(quarters - round(quarters)) < 1e-12:
        return (1 + 0j, 1j, -1 + 0j, -1j)[round(quarters) % 4]
    return cmath.exp(1j * angle)


def direction_of(vector: complex) -> complex:
    """Return the unit direction of a vector; 0 for a zero vector."""
    return vector / abs(vector) if vector else 0j


def perpendicular(u: complex, w: complex) -> bool:
    """Return True if two unit directions are perpendicular."""
    return abs((u.conjugate() * w).real) < SAME_DIRECTION


def parallel(u: complex, w: complex) -> bool:
    """Return True if two unit directions are equal or opposite."""
    return abs((u.conjugate() * w).imag) < SAME_DIRECTION


class Geometry:
    """The points and lines of a file in numbers (m); a subclass computes with symbols instead.

    Constructions do not check that their result exists; `placed` has checked that with numbers.
    """

    def __init__(self, given: file.Parameters, points: Mapping[str, Any]) -> None:
        self.given = given
        self.points = points

    # --- the arithmetic

    def size(self, given: Given) -> Any:
        return given.si

    def unit(self, angle: Given) -> Any:
        return unit(angle.si)

    def point(self, x: Any, y: Any) -> Any:
        return complex(x, y)

    def root(self, of: Any) -> Any:
        return real_root(of)

    def is_inner(self, joint: file.RollingOnCircle | file.Gears) -> bool:
        """Return True if the first disc of a joint lies within the second."""
        inner, outer = self.discs(joint)
        apart, smaller = abs(self.points[outer.centre] - self.points[inner.centre]), outer.radius.si - inner.radius.si
        return smaller > 0 and abs(apart - smaller) <= TOUCHING * (inner.radius.si + outer.radius.si)

    # --- constructed points

    def place(self, point: file.PointAt) -> Any:
        """Return the position of a point (m), from the points before it."""
        if point.at is not None:
            return self.point(*map(self.size, point.at))
        if point.lines is not None:
            line1, two = point.lines
            first, second = self.points[line1.through], self.points[two.through]
            return meet(first, self.unit(line1.angle), second, self.unit(two.angle))
        if point.distances is not None:
            (c1, r1), (c2, r2) = ((self.points[one.from_], self.size(one.distance)) for one in point.distances)
            return circle_circle(c1, r1, c2, r2, 1 if point.side == "left" else -1, self.root)
        assert point.from_ is not None
        assert point.distance is not None
        centre, radius = self.points[point.from_], self.size(point.distance)
        if point.angle is not None:
            return centre + self.unit(point.angle) * radius
        assert point.on is not None
        start, u = self.points[point.on.through], self.unit(point.on.angle)
        return circle_line(centre, radius, start, u, 1 if point.end == "far" else -1, self.root)

    def direction(self, line: file.Directed) -> Any:
        """Return the unit vector of a line."""
        if line.along is not None:
            start, end = (self.points[name] for name in line.along)
            return (end - start) / abs(end - start)
        assert line.angle is not None
        return self.unit(line.angle)

    def disc(self, body: int) -> file.Disc:
        """Return the disc of a body.

        Raises `ValueError` for a body that is not a disc.
        """
        disc = self.given.disc(body)
        if disc is None:
            raise ValueError(f"body {body} is no disc")
        return disc

    def discs(self, joint: file.RollingOnCircle | file.Gears | file.Belt) -> tuple[file.Disc, file.Disc]:
        first, second = joint.discs
        return self.disc(first), self.disc(second)

    def contact_on_line(self, joint: file.RollingOnLine) -> Any:
        """Return the point (m) where a disc touches its line."""
        return foot(self.points[self.disc(joint.disc).centre], self.points[joint.through], self.direction(joint))

    def contact_of_discs(self, joint: file.RollingOnCircle | file.Gears) -> Any:
        """Return the contact (m) of two discs on the line of their centres, beyond the first centre if that disc lies
        within the second.
        """
        disc, touched = self.discs(joint)
        start, end, radius = self.points[disc.centre], self.points[touched.centre], self.size(disc.radius)
        return start + (end - start) / abs(end - start) * (-radius if self.is_inner(joint) else radius)

    def belt_ends(self, joint: file.Belt) -> tuple[Any, Any]:
        """Return the points (m) where a belt leaves one disc, on the left side towards the other, and where it reaches
        the other.
        """
        left, reached = self.discs(joint)
        first, second = self.points[left.centre], self.points[reached.centre]
        r1, r2 = self.size(left.radius), self.size(reached.radius)
        reach = -r2 if joint.crossed else r2
        apart = abs(second - first)
        share = (r1 - reach) / apart
        along = (second - first) / apart
        out = along * share + 1j * along * self.root(1 - share**2)
        return first + out * r1, second + out * reach


# --- checks that constructions exist --------------------------------------------------------------


def placed(given: file.Parameters) -> Geometry:
    """Return the geometry of a file, its points placed in order.

    Raises `MisplacedError` for the first point without a position, otherwise for the first invalid contact or belt.
    """
    points: dict[str, complex] = {}
    geometry = Geometry(given, points)
    for name, point in given.points.items():
        _require_place(name, point, geometry)
        points[name] = complex(geometry.place(point))
    for index, joint in enumerate(given.joints):
        match joint:
            case file.RollingOnLine():
                _require_contact_on_line(joint, index, geometry)
            case file.RollingOnCircle() | file.Gears():
                _require_contact_of_discs(joint, index, geometry)
            case file.Belt():
                _require_length(joint, index, geometry)
    return geometry


def _require_place(name: str, point: file.PointAt, geometry: Geometry) -> None:
    where, known = ("points", name), geometry.points

    def at(base: str, *key: str | int) -> complex:
        if base not in known:
            raise MisplacedError("no-such-point", *where, *key, text=base, known=", ".join(known) or "–")
        return complex(known[base])

    if point.at is not None:
        return
    if point.lines is not None:
        for index, line in enumerate(point.lines):
            at(line.through, "lines", index, "through")
        if abs(cross(*(unit(line.angle.si) for line in point.lines))) < PARALLEL:
            raise MisplacedError("lines-parallel", *where, "lines", text=name)
    elif point.distances is not None:
        first, second = (at(end.from_, "distances", index, "from") for index, end in enumerate(point.distances))
        r1, r2 = (end.distance.si for end in point.distances)
        span = abs(second - first)
        if span < PARALLEL or not abs(r1 - r2) <= span * (1 + DUST) or span * (1 - DUST) > r1 + r2:
            raise MisplacedError("circles-apart", *where, "distances", text=name)
    elif point.from_ is not None and point.distance is not None:
        centre = at(point.from_, "from")
        if point.on is not None and point.angle is None:
            off = foot(centre, at(point.on.through, "on", "through"), unit(point.on.angle.si)) - centre
            if point.distance.si < abs(off):
                raise MisplacedError("out-of-reach", *where, "distance", text=name)


def _require_contact_on_line(joint: file.RollingOnLine, index: int, geometry: Geometry) -> None:
    disc = geometry.disc(joint.disc)
    apart = abs(geometry.points[disc.centre] - geometry.contact_on_line(joint))
    if abs(apart - disc.radius.si) > TOUCHING * disc.radius.si:
        sizes = {"distance": f"{apart * 1e3:.6g}", "radius": f"{disc.radius.si * 1e3:.6g}"}
        raise MisplacedError("no-contact", "joints", index, text=str(joint.disc), **sizes)


def _require_contact_of_discs(joint: file.RollingOnCircle | file.Gears, index: int, geometry: Geometry) -> None:
    disc, touched = geometry.discs(joint)
    first, second = disc.radius.si, touched.radius.si
    apart = abs(geometry.points[touched.centre] - geometry.points[disc.centre])
    reaches = (first + second, abs(first - second))
    if not any(reach > 0 and abs(apart - reach) <= TOUCHING * (first + second) for reach in reaches):
        raise MisplacedError(
            "no-contact-of-discs",
            *("joints", index),
            text=str(joint.discs[0]),
            other=str(joint.discs[1]),
            distance=f"{apart * 1e3:.6g}",
            radii=f"{first * 1e3:.6g}, {second * 1e3:.6g}",
        )


def _require_length(joint: file.Belt, index: int, geometry: Geometry) -> None:
    disc, touched = geometry.discs(joint)
    first, second = disc.radius.si, touched.radius.si
    least = first + second if joint.crossed else abs(first - second)
    if abs(geometry.points[touched.centre] - geometry.points[disc.centre]) <= least:
        discs = {"text": str(joint.discs[0]), "other": str(joint.discs[1])}
        raise MisplacedError("belt-too-short", "joints", index, **discs)


# --- the conditions -------------------------------------------------------------------------------


def system(given: file.Parameters) -> System:
    """Return the whole system of a valid file.

    Raises `MisplacedError`.
    """
    geometry = placed(given)
    bare = System(geometry.points, carried(given), ())
    return replace(bare, conditions=tuple(conditions(geometry, bare)))


def carried(given: file.Parameters) -> dict[int, tuple[str, ...]]:
    """Return the points that move with each body except the ground."""
    return {number: body.carried for number, body in given.bodies.items() if number}


def conditions(geometry: Geometry, bare: System) -> Iterator[Condition]:
    """Yield the conditions of the joints and the given quantities on the rates of the bodies."""
    for index, joint in enumerate(geometry.given.joints):
        yield from _joint(joint, index, geometry, bare)
    for index, rate in enumerate(geometry.given.given):
        yield from _rate(rate, index, geometry, bare)


def name_of(index: int, section: str, *called: object) -> str:
    """Return the name of the conditions of a joint or of a given quantity: joints[2] (pin A)."""
    return f"{section}[{index}] ({' '.join(map(str, called))})"


def named(given: file.Parameters) -> dict[str, tuple[Where, str]]:
    """Return the location of each joint and given quantity, and its name in messages, by the name of its conditions."""
    listed = {"joints": given.joints, "given": given.given}
    return {
        name_of(index, section, *named_rate.called): ((*TOP, section, index), " ".join(map(str, named_rate.called)))
        for section, several in listed.items()
        for index, named_rate in enumerate(several)
    }


def _joint(joint: file.Joint, index: int, geometry: Geometry, bare: System) -> tuple[Condition, ...]:
    known = geometry.points
    name = name_of(index, "joints", *joint.called)
    match joint:
        case file.Pin(at=at, bodies=bodies):
            first_body, partner = bodies
            return on.pin(name, known[at], first_body, partner)
        case file.SlotJoint(point=point, body=body, on=carrier):
            return on.slot(name, known[point], body, carrier, geometry.direction(joint))
        case file.Slider(body=body, on=carrier):
            some = known[bare.bodies[body][0]]
            return (*on.slot(name, some, body, carrier, geometry.direction(joint)), *on.no_turning(name, body, carrier))
        case file.Translation(body=body):
            return on.no_turning(name, body)
        case file.RollingOnLine(disc=body, on=carrier):
            disc, touch = geometry.disc(body), geometry.contact_on_line(joint)
            return on.rolling_on_line(name, body, known[disc.centre], geometry.size(disc.radius), touch, carrier)
        case file.RollingOnCircle(discs=discs) | file.Gears(discs=discs):
            first_body, partner = discs
            first, second = geometry.discs(joint)
            touch = geometry.contact_of_discs(joint)
            make = on.meshing if isinstance(joint, file.Gears) else on.rolling_on_circle
            return make(name, first_body, known[first.centre], partner, known[second.centre], touch)
        case file.Belt(discs=discs):
            first, second = geometry.discs(joint)
            centres = known[first.centre], known[second.centre]
            return on.belt(name, geometry.belt_ends(joint), centres, *discs)
        case file.Cord(points=points):
            a, b = points
            ends = known[a], bare.body_of(a), known[b], bare.body_of(b)
            return on.distance(name, *ends)


def _rate(rate: file.GivenRate, index: int, geometry: Geometry, bare: System) -> Iterator[Condition]:
    name = name_of(index, "given", *rate.called)
    size, unit = geometry.size, geometry.unit
    match rate:
        case file.OmegaOf(body=body, value=value):
            yield on.given_omega(name, body, size(value))
        case file.EpsilonOf(body=body, value=value):
            yield on.given_epsilon(name, body, size(value))
        case file.VelocityOf(point=point, direction=angle) | file.AccelerationOf(point=point, direction=angle):
            make = on.given_velocity if isinstance(rate, file.VelocityOf) else on.given_acceleration
            along = None if rate.size is None else size(rate.size)
            yield from _vector(make, name, bare, point, unit(angle), along)
        case file.FromRest(point=point, acceleration=acceleration, time=time, direction=angle):
            u = unit(angle)
            yield from _vector(on.given_velocity, name, bare, point, u, size(acceleration) * size(time))
            yield from _vector(on.given_acceleration, name, bare, point, u, size(acceleration))


def _vector(
    make: on.GivenComponent, name: str, bare: System, point: str, along: complex, size: float | None
) -> Iterator[Condition]:
    """Yield the conditions of a vector of known direction: zero across it, and its magnitude (SI) along it if that is
    known.
    """
    at, body = bare.points[point], bare.body_of(point)
    yield make(name, at, body, 1j * along, 0.0)
    if size is not None:
        yield make(name, at, body, along, size)


# --- the exercise ---------------------------------------------------------------------------------


class Exercise(Record):
    """A system in motion at one instant, with the requested quantities."""

    given: file.Parameters
    motion: InstantMotion

    @property
    def asked(self) -> tuple[file.Asked, ...]:
        return self.given.find

    def determines_sense(self, asked: file.Asked) -> bool:
        """Return True if the data determine the sense of the requested quantity, and not its size alone."""
        return asked.what not in ("omega", "eps") or self.motion.knows_sense(asked.what, asked.body)


def exercise_of(assignment: Assignment) -> Exercise:
    """Return the exercise of a valid assignment."""
    given: file.Parameters = assignment.parameters
    return Exercise(given, InstantMotion(system(given)))
