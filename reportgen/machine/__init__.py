"""Data classes for a planar mechanism: ground, a driver, and Assur dyads in the order of their assembly.

Link 0 is the ground and link 1 the driver. Every moving link has a frame: its origin is the link's first named
point, its real axis points towards the second. A point on a link is a complex number in that frame. All classes are
frozen; the module also counts the joints and the degree of freedom. `machine.kinematics` computes the motion of a
linkage, `machine.force_analysis` its forces.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from typing import Literal

from reportgen.base.records import Record

DyadKind = Literal["RRR", "RRP", "RPR", "PRP", "RPP"]

GROUND = 0
DRIVER = 1


class Guide(Record):
    """A straight guide fixed in the frame of `link`: a line through `at` (m) in the direction `angle` (rad)."""

    at: complex
    angle: float
    link: int = GROUND


class Crank(Record):
    """The rotating driver, a crank of the `length` (m): link 1 turns about the ground point `centre`; its frame points
    to `pin`.
    """

    centre: str
    pin: str
    length: float


class SlidingDriver(Record):
    """The sliding driver: link 1 moves along `guide`; its `pin` is at the guide's `at` plus s·e^{i angle}, s in m."""

    pin: str
    guide: Guide


class LinkPoint(Record):
    """A named point at `local` (m) in a moving link's frame: a mass centre, coupler point or pin of a later dyad."""

    name: str
    link: int
    local: complex


class Dyad(Record):
    """An Assur group of class II: links i, j = `links`, two outer joints and the inner joint `middle`.

    ==== ============ ============== ============ ==============================================
    kind `start` (i)  inner joint    `end` (j)    geometry
    ==== ============ ============== ============ ==============================================
    RRR  point P      revolute Q     point T      `lengths` = (|PQ|, |TQ|)
    RRP  point P      revolute Q     guide        `lengths` = (|PQ|, 0); Q runs on the guide line
    RPR  point P      slide on j     point T      `lengths` = (0, e): P runs on the line of link j
                                                  that is parallel to its axis at distance e to the
                                                  left of T; `middle` names P as a point of link j
    PRP  guide        revolute Q     guide        Q runs on both guide lines
    RPP  point P      slide i on j   guide        `middle` names the point Q of link j that runs on
                                                  the guide; P runs on the line of link j through Q
                                                  turned by `slide_angle` from the guide
    ==== ============ ============== ============ ==============================================

    `start` and `end` name a fixed or already placed point (a revolute joint there), or give a `Guide` on ground or
    on a link already placed. `sign` (+1, -1) is the stored orientation. RRR: Q to the left (+1) or right of the line
    from P to T. RRP: Q the farther (+1) or nearer of the two meeting points along the guide's direction. RPR: link
    j's axis points from T to the foot of P (+1) or away from it (-1). PRP and RPP have only one assembly mode and
    ignore it.

    Frames. RRR: i at P towards Q, j at T towards Q. RRP: i at P towards Q, j at Q with the guide's angle. RPR: i at
    P and j at T, both with the angle of the line on j. PRP: i and j at Q, each with its own guide's angle. RPP: i
    at P, j at Q, both with the guide's angle.
    """

    kind: DyadKind
    links: tuple[int, int]
    start: str | Guide
    middle: str
    end: str | Guide
    lengths: tuple[float, float] = (0.0, 0.0)
    sign: int = 1
    slide_angle: float = 0.0


class TriadLeg(Record):
    """A rod of a triad: `link` of the `length` (m), from the placed point `outer` to the joint `inner` on the plate."""

    link: int
    outer: str
    inner: str
    length: float


class Triad(Record):
    """An Assur group of class III (3RRR): a ternary link, the `plate`, on three legs.

    `at` are the places (m) of the second and third inner joint in the plate's axes, whose origin is the first inner
    joint. Of the at most six assembly modes, the group has the one whose joints are nearest to the points `near` (m)
    when the driver is at the coordinate `near_at` (rad or m); it keeps this mode while the driver moves.

    Frames. A leg at its outer joint, towards its inner joint. The plate at the first inner joint, with the axes of
    `at`.
    """

    plate: int
    legs: tuple[TriadLeg, TriadLeg, TriadLeg]
    at: tuple[complex, complex]
    near: tuple[tuple[str, complex], ...]
    near_at: float = 0.0

    @property
    def kind(self) -> str:
        """The name of the kind, as in files."""
        return "3RRR"

    @property
    def links(self) -> tuple[int, int, int, int]:
        """Numbers of the links: the first leg, the plate, the two other legs."""
        first, second, third = self.legs
        return first.link, self.plate, second.link, third.link

    @property
    def locals(self) -> tuple[complex, complex, complex]:
        """Places of the inner joints (m) in the plate's axes."""
        return (0j, *self.at)


Group = Dyad | Triad


class Inertia(Record):
    """Mass, mass centre (a named point of the link) and moment of inertia about it; kg, kg·m²."""

    link: int
    centre: str
    mass: float
    moment: float = 0.0


class Linkage(Record):
    """A whole mechanism.

    `ground` gives the fixed points (m) and `points` further points on moving links; the driver and the groups, in the
    order of their assembly, declare the points of their joints themselves. `gravity` is in m/s², as a complex vector.
    """

    ground: Mapping[str, complex]
    driver: Crank | SlidingDriver
    groups: tuple[Group, ...]
    points: tuple[LinkPoint, ...] = ()
    inertias: tuple[Inertia, ...] = ()
    gravity: complex = -9.81j

    @property
    def links(self) -> tuple[int, ...]:
        """Numbers of the moving links, the driver first."""
        return (DRIVER, *(link for group in self.groups for link in group.links))

    @property
    def dyads(self) -> tuple[Dyad, ...]:
        """The groups of class II."""
        return tuple(group for group in self.groups if isinstance(group, Dyad))

    @property
    def triads(self) -> tuple[Triad, ...]:
        """The groups of class III."""
        return tuple(group for group in self.groups if isinstance(group, Triad))


def rods(linkage: Linkage) -> Mapping[int, tuple[str, str]]:
    """Return the pins that define the axis of each link that turns about one: the link's origin, and the other pin.

    A link that slides on another one has its axis through the block's pin.
    """
    driver, ends = linkage.driver, dict[int, tuple[str, str]]()
    if isinstance(driver, Crank):
        ends[DRIVER] = driver.centre, driver.pin
    for dyad in linkage.dyads:
        (i, j), (first, last) = dyad.links, (dyad.start, dyad.end)
        if isinstance(first, str) and dyad.kind in {"RRR", "RRP"}:
            ends[i] = first, dyad.middle
        if isinstance(last, str):
            ends[j] = last, str(first) if dyad.kind == "RPR" else dyad.middle
    for triad in linkage.triads:
        ends[triad.plate] = triad.legs[0].inner, triad.legs[1].inner
        ends |= {leg.link: (leg.outer, leg.inner) for leg in triad.legs}
    return ends


def under(name: str, link: int, taken: Collection[str]) -> str:
    """Return the name of the point of a link that lies under a pin now: B on link 3 → B3, B′3 where B3 is taken."""
    plain = f"{name}{link}"
    return f"{name}′{link}" if plain in taken else plain


# --- joints and freedom ---------------------------------------------------------------------------


class Joint(Record):
    """A lower pair: "R" revolute or "P" prismatic, between `links` at the named `point`.

    In a prismatic joint the first link has the guide and the second slides; in a revolute one the
    first was placed first.  `group` are the links of the group it came with, () for the driver's.
    """

    kind: Literal["R", "P"]
    links: tuple[int, int]
    point: str
    group: tuple[int, ...] = ()


class Mobility(Record):
    """W = 3n − (2t + c) + r − s: n moving links, t lower and c higher pairs, r passive constraints, s
    redundant freedoms; with the joints, the groups and the mechanism's class.
    """

    n: int
    lower_pairs: int
    W: int
    joints: tuple[Joint, ...]
    groups: tuple[Group, ...]
    mechanism_class: int
    higher_pairs: int = 0
    passive: int = 0
    redundant: int = 0


def mobility(linkage: Linkage) -> Mobility:
    """Count links and joints, all of them lower pairs: W = 3n − 2t; the class is that of the highest group, else I."""
    listed = joints(linkage)
    n, pairs = len(linkage.links), len(listed)
    highest = 3 if linkage.triads else 2 if linkage.groups else 1
    return Mobility(n, pairs, 3 * n - 2 * pairs, listed, linkage.groups, highest)


def owners(linkage: Linkage) -> Mapping[str, int]:
    """Return the link that each named point belongs to; a joint belongs to the link that was placed first.

    A slide's `middle` (RPR, RPP) is a point of the group's second link, a triad's inner joint one of its plate.
    Raises `ValueError` when a name is given to two points.
    """
    names: dict[str, int] = {}

    def enter(name: str, link: int) -> None:
        if name in names:
            raise ValueError(f"two points are named {name}")
        names[name] = link

    for name in linkage.ground:
        enter(name, GROUND)
    enter(linkage.driver.pin, DRIVER)
    for group in linkage.groups:
        if isinstance(group, Triad):
            for leg in group.legs:
                enter(leg.inner, group.plate)
        else:
            enter(group.middle, group.links[1] if group.kind in {"RPR", "RPP"} else group.links[0])
    for point in linkage.points:
        enter(point.name, point.link)
    return names


def joints(linkage: Linkage) -> tuple[Joint, ...]:
    """Return all joints in the order of assembly: the driver's, then start, inner and end of every dyad, or the outer
    and the inner joint of every leg of a triad.

    Raises `ValueError` for a group that hangs on the `middle` of an RPR: that point of the guide link
    changes from moment to moment, so no pin can be there (the slider's own pin can be named instead).
    """
    owner = owners(linkage)
    passing = {dyad.middle for dyad in linkage.dyads if dyad.kind == "RPR"}
    for group in linkage.groups:
        for end in (leg.outer for leg in group.legs) if isinstance(group, Triad) else (group.start, group.end):
            if end in passing:
                raise ValueError(f"group {group.links} cannot hang on {end}, which slides along its link")
    driver = linkage.driver
    first = (
        Joint("R", (GROUND, DRIVER), driver.centre)
        if isinstance(driver, Crank)
        else Joint("P", (GROUND, DRIVER), driver.pin)
    )
    return (first, *(joint for group in linkage.groups for joint in _of_group(group, owner)))


def _of_group(group: Group, owner: Mapping[str, int]) -> Iterator[Joint]:
    if isinstance(group, Dyad):
        yield from _of_dyad(group, owner)
        return
    for leg in group.legs:
        yield Joint("R", (owner[leg.outer], leg.link), leg.outer, group.links)
        yield Joint("R", (leg.link, group.plate), leg.inner, group.links)


def _of_dyad(dyad: Dyad, owner: Mapping[str, int]) -> Iterator[Joint]:
    i, j = dyad.links
    yield _outer(dyad, dyad.start, i, owner)
    if dyad.kind in {"RPR", "RPP"}:
        # The slide between the links is measured where the slider's pin is.
        yield Joint("P", (j, i), str(dyad.start), dyad.links)
    else:
        yield Joint("R", (i, j), dyad.middle, dyad.links)
    yield _outer(dyad, dyad.end, j, owner)


def _outer(dyad: Dyad, end: str | Guide, link: int, owner: Mapping[str, int]) -> Joint:
    if isinstance(end, Guide):
        return Joint("P", (end.link, link), dyad.middle, dyad.links)
    return Joint("R", (owner[end], link), end, dyad.links)
