"""Instant centres of bodies and directions of velocities, found before any speed (`lay_out`).

A body pinned to the ground turns about the pin; one that rolls on the ground turns about the point of contact.
Otherwise two directions of velocities determine the centre: it is where their normals meet.  If the directions are
parallel and not perpendicular to the line of the points, the body is in translation at the instant.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from typing import Literal

from reportgen.base.records import Record, replace
from reportgen.exercise import file
from reportgen.exercise.point_positions import Geometry, parallel, perpendicular, unit
from reportgen.exercise.rate_conditions import GROUND
from reportgen.exercise.rate_solution import InstantMotion
from reportgen.formula.constructions import meet

CentreRule = Literal["pivot", "contact", "normals", "rate", "translation"]
SAME_PLACE = 1e-9
"""Points nearer than this (m) coincide."""
LETTERS = "PQIK"


class InstantCentre(Record):
    """The instant centre of a body: the rule that gives it, its name and position (m), and the points whose normals
    meet there.

    By the rule `rate` it lies on one normal, at the distance v/ω of a body whose rotation is known already.  In
    translation it is infinitely far: `direction` is then the direction of all velocities, 0 if it is not known.
    """

    body: int
    rule: CentreRule
    name: str = ""
    at: complex = 0j
    points: tuple[str, ...] = ()
    direction: complex = 0j

    @property
    def by_joint(self) -> bool:
        """Return True if a joint makes the body turn about a fixed point or move in translation, at any instant."""
        return self.rule == "pivot" or (self.rule == "translation" and not self.points)


@dataclass
class Layout:
    """Bodies with all points that move with them, the directions of their velocities, and the instant centres."""

    given: file.Parameters
    motion: InstantMotion
    points: dict[str, complex] = field(default_factory=dict)
    members: dict[int, list[str]] = field(default_factory=dict)
    directions: dict[str, complex] = field(default_factory=dict)
    """The line along which a point moves, as a unit vector; its sense is not known yet."""
    guided: dict[str, complex] = field(default_factory=dict)
    """The directions that follow from joints and data alone, without normals to velocities."""
    centres: dict[int, InstantCentre] = field(default_factory=dict)
    slots: dict[str, complex] = field(default_factory=dict)
    """Points that are guided along a straight line of the ground."""
    contacts: dict[int, str] = field(default_factory=dict)
    """The points in which discs touch, by the index of their joint."""
    belts: dict[int, tuple[str, str]] = field(default_factory=dict)
    """The ends of a straight part of each belt, by the index of its joint."""

    @property
    def geometry(self) -> Geometry:
        """Return the lines of the file, its contacts and belts."""
        return Geometry(self.given, self.points)

    def point_at(self, at: complex, letter: str) -> str:
        """Return the name of the point at a position (m), a new name if no point is declared there."""
        for name, place in self.points.items():
            if abs(place - at) < SAME_PLACE:
                return name
        number = next(n for n in range(1, 100) if f"{letter}{n}" not in self.points)
        self.points[f"{letter}{number}"] = at
        return f"{letter}{number}"

    def turn_on_ground(self, bodies: Iterable[int]) -> bool:
        """Return True if all bodies turn about fixed points."""
        return all(body in self.centres and self.centres[body].rule == "pivot" for body in bodies)

    def rims(self) -> Iterator[tuple[tuple[int, ...], tuple[str, ...]]]:
        """Yield pairs of discs, each with the point of its rim where it meets the other disc or the belt."""
        for index, joint in enumerate(self.given.joints):
            if isinstance(joint, file.RollingOnCircle | file.Gears):
                yield joint.discs, (self.contacts[index], self.contacts[index])
            elif isinstance(joint, file.Belt):
                yield joint.discs, self.belts[index]

    def own(self, body: int) -> list[str]:
        """Return the points that stay on a body, without those in which it only touches another body at the instant."""
        touching = {*self.contacts.values(), *(end for ends in self.belts.values() for end in ends)}
        declared = self.given.bodies[body].carried
        return [name for name in self.members[body] if name in declared or name not in touching]

    def in_line(self, point: str) -> bool:
        """Return True if a point lies on one line with the guided points of each of its bodies."""
        for names in (names for names in self.members.values() if point in names):
            arms = [self.points[name] - self.points[point] for name in names if name in self.guided and name != point]
            if any(abs((arms[0].conjugate() * arm).imag) > SAME_PLACE * abs(arms[0]) for arm in arms):
                return False
        return True

    def arm(self, centre: InstantCentre, point: str) -> complex:
        """Return the vector from the instant centre to a point (m)."""
        return self.points[point] - centre.at

    def is_centre(self, centre: InstantCentre, point: str) -> bool:
        return abs(self.arm(centre, point)) < SAME_PLACE


def lay_out(given: file.Parameters, motion: InstantMotion) -> Layout:
    """Find all directions and centres that follow from the joints and the given directions."""
    system = motion.system
    layout = Layout(given, motion, dict(system.points), {body: [] for body in system.bodies})
    for body, names in system.bodies.items():
        layout.members[body] += [name for name in names if _moves_alike(given, body, system.body_of(name), name)]
    for index, joint in enumerate(given.joints):
        _enter(layout, joint, index)
    for rate in given.given:
        if isinstance(rate, file.VelocityOf | file.FromRest):
            layout.directions[rate.point] = unit(rate.direction.si)
    layout.guided = _guided(layout)
    while _next_centre(layout) or _next_directions(layout):
        pass
    return layout


def _guided(layout: Layout) -> dict[str, complex]:
    """Return the directions that follow from joints and data, and those normal to the line to a point that moves across
    it.
    """
    guided = replace(layout, directions=dict(layout.directions))
    while _next_directions(guided):
        pass
    return guided.directions


def _moves_alike(given: file.Parameters, body: int, owner: int, point: str) -> bool:
    """Return True if a point of a body coincides with the same point of its owner, pinned together over any number of
    bodies.
    """
    reached, waiting = {owner}, [owner]
    while waiting:
        carrier = waiting.pop()
        for joint in given.joints:
            if isinstance(joint, file.Pin) and joint.at == point and carrier in joint.bodies:
                new = {*joint.bodies} - reached
                reached |= new
                waiting += new
    return body in reached


def _enter(layout: Layout, joint: file.Joint, index: int) -> None:
    given, known = layout.given, layout.points
    match joint:
        case file.Pin(at=at, bodies=bodies) if GROUND in bodies:
            body = max(bodies)
            layout.centres[body] = InstantCentre(body, "pivot", at, known[at])
        case file.SlotJoint(point=point, on=0):
            layout.directions[point] = layout.slots[point] = layout.geometry.direction(joint)
        case file.Slider(body=body, on=0):
            layout.centres[body] = InstantCentre(body, "translation", direction=layout.geometry.direction(joint))
        case file.Translation(body=body):
            layout.centres.setdefault(body, InstantCentre(body, "translation"))
        case file.RollingOnLine(disc=body, on=carrier):
            touch = layout.point_at(layout.geometry.contact_on_line(joint), "K")
            layout.contacts[index] = touch
            disc = given.disc(body)
            if carrier == GROUND and disc is not None:
                layout.centres[body] = InstantCentre(body, "contact", touch, known[touch])
                layout.slots[disc.centre] = layout.geometry.direction(joint)
            _share(layout, touch, body, carrier)
        case file.RollingOnCircle(discs=discs) | file.Gears(discs=discs):
            touch = layout.point_at(layout.geometry.contact_of_discs(joint), "K")
            layout.contacts[index] = touch
            if GROUND in discs:
                body = max(discs)
                layout.centres[body] = InstantCentre(body, "contact", touch, known[touch])
            _share(layout, touch, *discs)
        case file.Belt():
            _belt_ends(layout, joint, index)


def _belt_ends(layout: Layout, joint: file.Belt, index: int) -> None:
    """Enter the points in which a straight part of a belt touches its discs; each is a point of its disc."""
    ends = layout.geometry.belt_ends(joint)
    names = tuple(layout.point_at(at, "K") for at in ends)
    layout.belts[index] = names[0], names[1]
    for name, body in zip(names, joint.discs, strict=True):
        _share(layout, name, body)


def _share(layout: Layout, point: str, *bodies: int) -> None:
    """Let a point of contact move with both bodies."""
    for body in bodies:
        if body != GROUND and point not in layout.members[body]:
            layout.members[body].append(point)


def _next_centre(layout: Layout) -> bool:
    """Find the centre of one more body from directions; return False if none follows."""
    for body, names in layout.members.items():
        if body in layout.centres:
            continue
        known = [name for name in names if name in layout.directions]
        for first, second in _pairs(known):
            centre = _by_normals(layout, body, first, second)
            if centre is not None:
                layout.centres[body] = centre
                return True
    return False


def _by_normals(layout: Layout, body: int, first: str, second: str) -> InstantCentre | None:
    p, q, u, w = layout.points[first], layout.points[second], layout.directions[first], layout.directions[second]
    if parallel(u, w):
        if abs(p - q) < SAME_PLACE or perpendicular(u, (p - q) / abs(p - q)):
            return None
        return InstantCentre(body, "translation", points=(first, second), direction=u)
    at = meet(p, 1j * u, q, 1j * w)
    return InstantCentre(body, "normals", name_of_centre(layout, body, at), at, (first, second))


def name_of_centre(layout: Layout, body: int, at: complex) -> str:
    """Return the name of the point at an instant centre (m), or a new name."""
    letter = next(one for one in LETTERS if not any(name[0] == one for name in layout.given.points))
    return next((name for name, place in layout.points.items() if abs(place - at) < SAME_PLACE), f"{letter}{body}")


def _next_directions(layout: Layout) -> bool:
    """Find the directions of points of bodies with known centres; return False if none is new."""
    new = {
        name: direction
        for body, centre in layout.centres.items()
        for name in layout.members[body]
        if name not in layout.directions and (direction := _direction(layout, centre, name)) != 0
    }
    if not new:
        new = dict(_by_projection(layout))
    layout.directions.update(new)
    return bool(new)


def _by_projection(layout: Layout) -> Iterator[tuple[str, complex]]:
    """Yield points of a body whose velocity has no component along the line to a point that moves across that line."""
    for body, names in layout.members.items():
        known = [name for name in names if name in layout.directions]
        for name in names if body not in layout.centres else ():
            if name not in layout.directions:
                for base in known:
                    line = layout.points[name] - layout.points[base]
                    if abs(line) > SAME_PLACE and perpendicular(layout.directions[base], line / abs(line)):
                        yield name, layout.directions[base]


def _direction(layout: Layout, centre: InstantCentre, name: str) -> complex:
    if centre.rule == "translation":
        return centre.direction
    if layout.is_centre(centre, name):
        return 0j
    arm = layout.arm(centre, name)
    return 1j * arm / abs(arm)


def _pairs(names: list[str]) -> Iterator[tuple[str, str]]:
    for index, first in enumerate(names):
        for second in names[index + 1 :]:
            yield first, second
