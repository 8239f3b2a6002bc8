"""Model of a `linkage` file: frame points, driver, groups in the order of assembly, points, masses, loads."""

from __future__ import annotations

import math
from typing import Annotated, ClassVar, Literal

from pydantic import Field

from reportgen.assignment.common import Part
from reportgen.assignment.fields import (
    Acceleration,
    Angle,
    AngularAcceleration,
    AngularVelocity,
    Coordinate,
    ForceUnit,
    Fractions,
    Length,
    Mass,
    MomentOfInertia,
    NodeValues,
    PointCoordinates,
    RotationalSpeed,
    Weight,
    Whole,
    quantity,
)
from reportgen.base.errors import Where
from reportgen.base.units import Given
from reportgen.catalogue.declared_loads import LAST_LINK, LEVEL, Constant, Link, Name, OverAngle, OverWay
from reportgen.catalogue.given_loads import Diagram
from reportgen.catalogue.parameters import UnderGravity
from reportgen.machine import Crank, Dyad, Guide, Inertia, Linkage, LinkPoint, SlidingDriver, Triad, TriadLeg

MOST_GROUPS = 12
MOST_NAMES = 60
Carrier = Annotated[int, Whole(0, LAST_LINK)]
GroupLink = Annotated[int, Whole(2, LAST_LINK)]
DriverSpeed = Annotated[Given, quantity("m/s", least=1e-6, most=1e3)]

NOWHERE = Given(0.0, 0.0, "mm", "0 mm")


TwoGroupLinks = Annotated[tuple[GroupLink, ...], Field(min_length=2, max_length=2)]
SomeGroupLinks = Annotated[tuple[GroupLink, ...], Field(min_length=2, max_length=4)]
Two = Annotated[tuple[Name, ...], Field(min_length=2, max_length=2)]
Three = Annotated[tuple[Name, ...], Field(min_length=3, max_length=3)]
Lengths = Annotated[tuple[Length, ...], Field(min_length=2, max_length=2)]
Ways = Annotated[tuple[Coordinate, ...], Field(min_length=2, max_length=2)]


def place(at: tuple[Given, ...]) -> complex:
    """Return a pair of coordinates as a point (m)."""
    return complex(at[0].si, at[1].si)


class GuideSection(Part):
    """A straight guide through `at` in direction `angle`, on the frame or in the axes of the link `on`.

    `slot` are the least and the greatest displacement of the slider from `at` in that direction.
    """

    at: PointCoordinates = (NOWHERE, NOWHERE)
    angle: Angle = LEVEL
    on: Carrier = 0
    slot: Ways | None = None

    @property
    def line(self) -> Guide:
        """The guide in the axes of its link."""
        return Guide(place(self.at), self.angle.si, self.on)


# --- driver and groups ----------------------------------------------------------------------------


class CrankDriver(Part):
    """Link 1 turns about a point of the frame."""

    type: Literal["crank"]
    centre: Name
    pin: Name
    length: Length
    n: RotationalSpeed | None = None
    omega1: AngularVelocity | None = None
    epsilon1: AngularAcceleration | None = None

    @property
    def driver(self) -> Crank:
        return Crank(self.centre, self.pin, self.length.si)

    @property
    def rate(self) -> float:
        """|ω1| (rad/s)."""
        given = self.n or self.omega1
        assert given is not None, "a file without speed is refused by the kind's checks"
        return given.si

    @property
    def rest(self) -> float:
        """The angle (rad) at which assembly modes are selected where a group names no other."""
        return 0.0

    @property
    def rate2(self) -> float:
        """ε1 (rad/s²), positive in the sense of ω1."""
        return 0.0 if self.epsilon1 is None else self.epsilon1.si


class SlideDriver(Part):
    """Link 1 moves along a guide of the frame from displacement `start` to `end`.

    Its `acceleration` is positive in the sense of its speed.
    """

    type: Literal["slider"]
    pin: Name
    guide: GuideSection = GuideSection()
    start: Coordinate = NOWHERE
    end: Coordinate
    speed: DriverSpeed
    acceleration: Acceleration | None = None

    @property
    def driver(self) -> SlidingDriver:
        return SlidingDriver(self.pin, self.guide.line)

    @property
    def rate(self) -> float:
        """|v| (m/s)."""
        return self.speed.si

    @property
    def rest(self) -> float:
        """The displacement (m) at which assembly modes are selected."""
        return self.start.si

    @property
    def rate2(self) -> float:
        """a (m/s²), positive in the sense of v."""
        return 0.0 if self.acceleration is None else self.acceleration.si

    @property
    def span(self) -> float:
        """The length of its travel (m)."""
        return abs(self.end.si - self.start.si)


Driver = Annotated[CrankDriver | SlideDriver, Field(discriminator="type")]


def _pair(links: tuple[int, ...]) -> tuple[int, int]:
    return links[0], links[1]


class RRR(Part):
    """Two rods: `joints` are the outer joint of the first, their common joint, the outer joint of the second.

    The common joint lies on the `side` of the line from the first outer joint to the second.
    """

    type: Literal["RRR"]
    links: TwoGroupLinks
    joints: Three
    lengths: Lengths
    side: Literal["left", "right"]

    @property
    def dyad(self) -> Dyad:
        """The group as the mechanism core knows it."""
        first, middle, last = self.joints
        lengths = self.lengths[0].si, self.lengths[1].si
        return Dyad(
            "RRR", _pair(self.links), first, middle, last, lengths=lengths, sign=1 if self.side == "left" else -1
        )


class RRP(Part):
    """A rod from the first of `joints` to the pin of a slider, at the farther or nearer position along its guide."""

    type: Literal["RRP"]
    links: TwoGroupLinks
    joints: Two
    length: Length
    guide: GuideSection
    end: Literal["far", "near"] = "far"

    @property
    def dyad(self) -> Dyad:
        """The group as the mechanism core knows it."""
        (start, middle), sign = self.joints, 1 if self.end == "far" else -1
        return Dyad("RRP", _pair(self.links), start, middle, self.guide.line, lengths=(self.length.si, 0.0), sign=sign)


class RPR(Part):
    """A block on the first of `joints` and a slotted link that turns about the third; the second names the
    slotted link's point under the block.

    The slot's line passes at `offset` to the left of the pivot; the link's axis points `towards` the block
    or `away` from it.  `slot` are the least and the greatest way of the block along it.
    """

    type: Literal["RPR"]
    links: TwoGroupLinks
    joints: Three
    offset: Coordinate = NOWHERE
    axis: Literal["towards", "away"] = "towards"
    slot: Ways | None = None

    @property
    def dyad(self) -> Dyad:
        """The group as the mechanism core knows it."""
        (start, middle, end), sign = self.joints, 1 if self.axis == "towards" else -1
        return Dyad("RPR", _pair(self.links), start, middle, end, lengths=(0.0, self.offset.si), sign=sign)


class PRP(Part):
    """Two sliders with a common pin, each on its guide."""

    type: Literal["PRP"]
    links: TwoGroupLinks
    joints: Annotated[tuple[Name, ...], Field(min_length=1, max_length=1)]
    guides: Annotated[tuple[GuideSection, ...], Field(min_length=2, max_length=2)]

    @property
    def dyad(self) -> Dyad:
        """The group as the mechanism core knows it."""
        first, second = self.guides
        return Dyad("PRP", _pair(self.links), first.line, self.joints[0], second.line)


class RPP(Part):
    """A block on the first of `joints`, sliding on a link that itself slides along a guide.

    The second joint names a point of that link on the guide; the block's line passes through it, turned by
    `across` from the guide.
    """

    type: Literal["RPP"]
    links: TwoGroupLinks
    joints: Two
    guide: GuideSection
    across: Angle = Given(math.pi / 2, 90.0, "deg", "90 deg")

    @property
    def dyad(self) -> Dyad:
        """The group as the mechanism core knows it."""
        start, middle = self.joints
        return Dyad("RPP", _pair(self.links), start, middle, self.guide.line, slide_angle=self.across.si)


class LegSection(Part):
    """A leg of a triad: a rod of the `length` from the first of `joints` to the second, which is on the plate."""

    link: GroupLink
    joints: Two
    length: Length


class TernaryGroup(Part):
    """A group of class III: the link `plate` on three `legs`.

    `at` are the places of the second and third leg's joint in the axes of the plate, whose origin is the first leg's
    joint. `near` are points near which joints of the plate lie when the crank is at the angle `near_at`, or the slide
    at its start: they select the assembly mode.
    """

    type: Literal["3RRR"]
    plate: GroupLink
    legs: Annotated[tuple[LegSection, ...], Field(min_length=3, max_length=3)]
    at: Annotated[dict[Name, PointCoordinates], Field(min_length=2, max_length=2)]
    near: Annotated[dict[Name, PointCoordinates], Field(min_length=1, max_length=3)]
    near_at: Angle | None = None

    @property
    def links(self) -> tuple[int, ...]:
        """The first leg, the plate, the two other legs."""
        first, *others = (leg.link for leg in self.legs)
        return (first, self.plate, *others)

    @property
    def inner(self) -> tuple[str, ...]:
        """The joints of the plate."""
        return tuple(leg.joints[1] for leg in self.legs)

    def triad(self, start: float) -> Triad:
        """Return the group as the mechanism core knows it, for a driver that starts at the coordinate `start`."""
        first, second, third = (TriadLeg(leg.link, leg.joints[0], leg.joints[1], leg.length.si) for leg in self.legs)
        # A name that is missing is a fault that the checks report.
        second_at, third_at = (place(self.at[name]) if name in self.at else 0j for name in self.inner[1:])
        near = tuple((name, place(at)) for name, at in self.near.items())
        near_at = start if self.near_at is None else self.near_at.si
        return Triad(self.plate, (first, second, third), (second_at, third_at), near, near_at)


Dyads = RRR | RRP | RPR | PRP | RPP
GroupSection = Annotated[Dyads | TernaryGroup, Field(discriminator="type")]


def rails(group: GroupSection) -> list[tuple[int, GuideSection, Where]]:
    """Return the guides of a group: the link that slides on each, the guide, its place in the group's section."""
    match group:
        case PRP(links=links, guides=guides):
            return [(links[index], guide, ("guides", index)) for index, guide in enumerate(guides)]
        case RRP() | RPP():
            return [(group.links[1], group.guide, ("guide",))]
    return []


# --- points, masses, loads ------------------------------------------------------------------------


class Point(Part):
    """A point of a link: its distances from the link's first joint along the link and to the left of it."""

    link: Link
    at: PointCoordinates


class Body(Part):
    """Weight or mass of a link, the named point that is its mass centre, its moment of inertia about it."""

    link: Link
    at: Name
    G: Weight | None = None
    m: Mass | None = None
    J: MomentOfInertia | None = None

    def mass(self, g: float) -> float:
        """Return m = G/g (kg)."""
        return self.G.si / g if self.G is not None and g else self.m.si if self.m is not None else 0.0


class OverStroke(Part):
    """A force on a slider along its guide: a row for each stroke, over s/H from the end farther along the guide."""

    by: Literal["stroke"]
    link: Link
    unit: ForceUnit
    s: Fractions
    inward: NodeValues
    outward: NodeValues


class Gas(Part):
    """The gas in a cylinder whose piston is the slider `link`; the guide points to the cylinder head.

    Intake starts at the first or at the second passage of the top after the first position.
    """

    by: Literal["gas"]
    link: Link
    D: Length
    intake: Literal["first top", "second top"] = "first top"
    diagram: Diagram


Loading = Annotated[Constant | OverAngle | OverWay | OverStroke | Gas, Field(discriminator="by")]


class Declared(Part):
    """Statements of the author about the structure, which the checks compare with the links."""

    W: Annotated[int, Whole(0, 9)] | None = None
    class_: Annotated[int, Whole(1, 9)] | None = Field(default=None, alias="class")
    groups: Annotated[tuple[SomeGroupLinks, ...], Field(max_length=MOST_GROUPS)] | None = None


class Parameters(UnderGravity):
    """A linkage as the user declares it."""

    frame: Annotated[dict[Name, PointCoordinates], Field(max_length=MOST_NAMES)] = Field(default_factory=dict)
    driver: Driver
    groups: Annotated[tuple[GroupSection, ...], Field(min_length=1, max_length=MOST_GROUPS)]
    points: Annotated[dict[Name, Point], Field(max_length=MOST_NAMES)] = Field(default_factory=dict)
    masses: Annotated[tuple[Body, ...], Field(max_length=LAST_LINK)] = ()
    loads: Annotated[tuple[Loading, ...], Field(max_length=LAST_LINK)] = ()
    turns: Annotated[int, Whole(1, 2)] = 1
    also_at: Annotated[tuple[Angle, ...], Field(max_length=24)] = ()
    paths: Annotated[tuple[Name, ...], Field(max_length=MOST_NAMES)] = ()
    declared: Declared = Declared()

    acceleration_key: ClassVar[tuple[str, ...]] = ("parameters", "driver", "epsilon1")
    load_keys: ClassVar[tuple[str, ...]] = ("masses", "loads")
    mass_keys: ClassVar[tuple[str, ...]] = ("masses",)

    @property
    def slides(self) -> bool:
        return isinstance(self.driver, SlideDriver)

    @property
    def linkage(self) -> Linkage:
        """The whole mechanism: frame, driver, groups in their order, points, masses."""
        bodies = (Inertia(one.link, one.at, one.mass(self.gravity), one.J.si if one.J else 0.0) for one in self.masses)
        return Linkage(
            ground={name: place(at) for name, at in self.frame.items()},
            driver=self.driver.driver,
            groups=tuple(
                group.triad(self.driver.rest) if isinstance(group, TernaryGroup) else group.dyad
                for group in self.groups
            ),
            points=tuple(LinkPoint(name, one.link, place(one.at)) for name, one in self.points.items()),
            inertias=tuple(body for body in bodies if body.mass or body.moment),
            gravity=-1j * self.gravity,
        )
