"""Where the points of a plane-motion exercise are, what its lines are, and the conditions that its joints make."""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Any

from reportgen.catalogue import plane_motion_file as file
from reportgen.catalogue.linkage_file import place
from reportgen.errors import Finding, Where
from reportgen.plane_motion import conditions as on
from reportgen.plane_motion.conditions import Condition
from reportgen.plane_motion.solving import System
from reportgen.units import Given

TOP: Where = ("parameters",)
TOUCHING = 1e-6
"""Discs and lines whose distance is off by less than this share of the radius touch."""
PARALLEL = 1e-9
ROUND = 1e-12

Places = dict[str, complex]


class MisplacedError(Exception):
    """What a point, a line or a contact is at fault with."""

    def __init__(self, code: str, *where: str | int, **arguments: str) -> None:
        super().__init__(code)
        self.finding = Finding(code, (*TOP, *where), arguments)


def unit(angle: float) -> complex:
    """The unit vector at an angle; whole quarters of a turn are exact."""
    quarters = angle / (cmath.pi / 2)
    if abs(quarters - round(quarters)) < 1e-12:
        return (1 + 0j, 1j, -1 + 0j, -1j)[round(quarters) % 4]
    return cmath.exp(1j * angle)


def places(given: file.Parameters) -> Places:
    """The points in the order of the file.  Raises `MisplacedError` for the first that has no place."""
    found: Places = {}
    for name, point in given.points.items():
        found[name] = _place(name, point, found)
    return found


def _place(name: str, point: file.PointAt, known: Places) -> complex:
    where = ("points", name)

    def at(other: str, *key: str | int) -> complex:
        if other not in known:
            raise MisplacedError("no-such-point", *where, *key, text=other, known=", ".join(known) or "–")
        return known[other]

    if point.at is not None:
        return place(point.at)
    if point.lines is not None:
        one, two = point.lines
        p, u = at(one.through, "lines", 0, "through"), unit(one.angle.si)
        q, w = at(two.through, "lines", 1, "through"), unit(two.angle.si)
        across = (u.conjugate() * w).imag
        if abs(across) < PARALLEL:
            raise MisplacedError("lines-parallel", *where, "lines", text=name)
        return p + u * (((q - p).conjugate() * w).imag / across)
    if point.distances is not None:
        first, second = (at(end.from_, "distances", index, "from") for index, end in enumerate(point.distances))
        r1, r2 = (end.distance.si for end in point.distances)
        span = abs(second - first)
        if span < PARALLEL or not abs(r1 - r2) <= span * (1 + ROUND) or span * (1 - ROUND) > r1 + r2:
            raise MisplacedError("circles-apart", *where, "distances", text=name)
        along = (r1**2 - r2**2 + span**2) / (2 * span)
        across = math.sqrt(max(r1**2 - along**2, 0.0)) * (1 if point.side == "left" else -1)
        return first + (second - first) / span * complex(along, across)
    assert point.from_ is not None
    assert point.distance is not None
    centre, radius = at(point.from_, "from"), point.distance.si
    if point.angle is not None:
        return centre + radius * unit(point.angle.si)
    assert point.on is not None
    start, u = at(point.on.through, "on", "through"), unit(point.on.angle.si)
    foot = start + u * (u.conjugate() * (centre - start)).real
    off = float(radius**2 - abs(centre - foot) ** 2)
    if off < 0:
        raise MisplacedError("out-of-reach", *where, "distance", text=name)
    return foot + (1 if point.end == "far" else -1) * u * math.sqrt(off)


def direction(line: file.Directed, known: Mapping[str, complex]) -> complex:
    """The unit vector of a line."""
    if line.along is not None:
        way = known[line.along[1]] - known[line.along[0]]
        return way / abs(way)
    assert line.angle is not None
    return unit(line.angle.si)


def contact_on_line(joint: file.RollingOnLine, index: int, given: file.Parameters, known: Places) -> complex:
    """Where a disc touches its line.  Raises `MisplacedError` for one that does not."""
    disc = given.disc(joint.disc)
    assert disc is not None
    u, centre = direction(joint, known), known[disc.centre]
    foot = known[joint.through] + u * (u.conjugate() * (centre - known[joint.through])).real
    if abs(abs(centre - foot) - disc.radius.si) > TOUCHING * disc.radius.si:
        raise MisplacedError(
            "no-contact",
            *("joints", index),
            text=str(joint.disc),
            distance=f"{abs(centre - foot) * 1e3:.6g}",
            radius=f"{disc.radius.si * 1e3:.6g}",
        )
    return foot


def contact_of_discs(
    joint: file.RollingOnCircle | file.Gears, index: int, given: file.Parameters, known: Places
) -> complex:
    """Where two discs touch, outside or inside.  Raises `MisplacedError` for discs that do not."""
    one, other = (given.disc(body) for body in joint.discs)
    assert one is not None
    assert other is not None
    way = known[other.centre] - known[one.centre]
    first, second, apart = one.radius.si, other.radius.si, abs(way)
    for wanted, reach in ((first + second, first), (first - second, first), (second - first, -first)):
        if wanted > 0 and abs(apart - wanted) <= TOUCHING * (first + second):
            return known[one.centre] + way / apart * reach
    raise MisplacedError(
        "no-contact-of-discs",
        *("joints", index),
        text=str(joint.discs[0]),
        other=str(joint.discs[1]),
        distance=f"{apart * 1e3:.6g}",
        radii=f"{first * 1e3:.6g}, {second * 1e3:.6g}",
    )


def belt_ends(geometry: Geometry, joint: file.Belt) -> tuple[Any, Any]:
    """Where a belt leaves one disc, to the left of the way to the other, and where it comes to the other."""
    one, other = (geometry.given.disc(body) for body in joint.discs)
    assert one is not None
    assert other is not None
    first, second = geometry.points[one.centre], geometry.points[other.centre]
    r1, r2 = geometry.size(one.radius), geometry.size(other.radius)
    reach = -r2 if joint.crossed else r2
    apart = abs(second - first)
    share = (r1 - reach) / apart
    way = (second - first) / apart
    out = way * share + 1j * way * geometry.root(1 - share**2)
    return first + out * r1, second + out * reach


class Geometry:
    """The points and lines of a file in numbers; whoever works with symbols has another one."""

    def __init__(self, given: file.Parameters, points: Mapping[str, Any]) -> None:
        self.given = given
        self.points = points

    def size(self, told: Given) -> Any:
        return told.si

    def unit(self, angle: Given) -> Any:
        return unit(angle.si)

    def root(self, of: Any) -> Any:
        return math.sqrt(of)

    def direction(self, line: file.Directed) -> Any:
        return direction(line, self.points)

    def contact_on_line(self, joint: file.RollingOnLine, index: int) -> Any:
        return contact_on_line(joint, index, self.given, dict(self.points))

    def contact_of_discs(self, joint: file.RollingOnCircle | file.Gears, index: int) -> Any:
        return contact_of_discs(joint, index, self.given, dict(self.points))


def system(given: file.Parameters) -> System:
    """The whole system of a file that is in order.  Raises `MisplacedError`."""
    geometry = Geometry(given, places(given))
    bare = System(geometry.points, carried(given), ())
    return replace(bare, conditions=tuple(conditions(geometry, bare)))


def carried(given: file.Parameters) -> dict[int, tuple[str, ...]]:
    """The points that move with each body but the ground."""
    return {number: body.carried for number, body in given.bodies.items() if number}


def conditions(geometry: Geometry, bare: System) -> Iterator[Condition]:
    """What the joints and the given quantities say of the rates of the bodies."""
    for index, joint in enumerate(geometry.given.joints):
        yield from _joint(joint, index, geometry, bare)
    for index, rate in enumerate(geometry.given.given):
        yield from _rate(rate, index, geometry, bare)


def name_of(index: int, section: str, *called: object) -> str:
    """The name of the conditions of a joint or of a given quantity: joints[2] (pin A)."""
    return f"{section}[{index}] ({' '.join(map(str, called))})"


def named(given: file.Parameters) -> dict[str, tuple[Where, str]]:
    """Where each joint and each given quantity stands, and what a message calls it, by the name of its conditions."""
    listed = {"joints": given.joints, "given": given.given}
    return {
        name_of(index, section, *one.called): ((*TOP, section, index), " ".join(map(str, one.called)))
        for section, several in listed.items()
        for index, one in enumerate(several)
    }


def _joint(joint: file.Joint, index: int, geometry: Geometry, bare: System) -> tuple[Condition, ...]:
    given, known = geometry.given, geometry.points
    name = name_of(index, "joints", *joint.called)
    match joint:
        case file.Pin(at=at, bodies=bodies):
            one, other = bodies
            return on.pin(name, known[at], one, other)
        case file.SlotJoint(point=point, body=body, on=carrier):
            return on.slot(name, known[point], body, carrier, geometry.direction(joint))
        case file.Slider(body=body, on=carrier):
            some = known[bare.bodies[body][0]]
            return (*on.slot(name, some, body, carrier, geometry.direction(joint)), *on.no_turning(name, body, carrier))
        case file.Translation(body=body):
            return on.no_turning(name, body)
        case file.RollingOnLine(disc=body, on=carrier):
            disc = given.disc(body)
            assert disc is not None
            touch = geometry.contact_on_line(joint, index)
            return on.rolling_on_line(name, body, known[disc.centre], geometry.size(disc.radius), touch, carrier)
        case file.RollingOnCircle(discs=discs) | file.Gears(discs=discs):
            one, other = discs
            touch = geometry.contact_of_discs(joint, index)
            first, second = given.disc(one), given.disc(other)
            assert first is not None
            assert second is not None
            make = on.meshing if isinstance(joint, file.Gears) else on.rolling_on_circle
            return make(name, one, known[first.centre], other, known[second.centre], touch)
        case file.Belt(discs=discs):
            first, second = (given.disc(body) for body in discs)
            assert first is not None
            assert second is not None
            if abs(bare.points[second.centre] - bare.points[first.centre]) <= _least(joint, first, second):
                raise MisplacedError("belt-too-short", "joints", index, text=str(discs[0]), other=str(discs[1]))
            centres = known[first.centre], known[second.centre]
            return on.belt(name, belt_ends(geometry, joint), centres, *discs)
        case file.Cord(points=points):
            a, b = points
            ends = known[a], bare.body_of(a), known[b], bare.body_of(b)
            return on.distance(name, *ends)


def _least(joint: file.Belt, first: file.Disc, second: file.Disc) -> float:
    """The distance of the centres that two discs with a belt have to exceed."""
    sum_of = first.radius.si + second.radius.si
    return sum_of if joint.crossed else abs(first.radius.si - second.radius.si)


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
    """A vector of known direction: nothing across it, and along it its size if that is known."""
    at, body = bare.points[point], bare.body_of(point)
    yield make(name, at, body, 1j * along, 0.0)
    if size is not None:
        yield make(name, at, body, along, size)
