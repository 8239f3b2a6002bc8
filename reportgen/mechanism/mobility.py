"""Structure of a mechanism: its joints one by one, degree of freedom, Assur groups, class."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Literal

from reportgen.mechanism.structure import DRIVER, GROUND, Crank, Dyad, Guide, Linkage


@dataclass(frozen=True, slots=True)
class Joint:
    """A lower pair: "R" revolute or "P" prismatic, between `links` at the named `point`.

    In a prismatic joint the first link has the guide and the second slides; in a revolute one the
    first was placed first.  `group` are the links of the dyad it came with, () for the driver's.
    """

    kind: Literal["R", "P"]
    links: tuple[int, int]
    point: str
    group: tuple[int, ...] = ()


@dataclass(frozen=True, slots=True)
class Mobility:
    """W = 3n − (2t + c) + r − s: n moving links, t lower and c higher pairs, r passive constraints, s
    redundant freedoms; with the joints, the groups and the mechanism's class."""

    n: int
    lower_pairs: int
    higher_pairs: int
    passive: int
    redundant: int
    W: int
    joints: tuple[Joint, ...]
    groups: tuple[Dyad, ...]
    mechanism_class: int


def mobility(linkage: Linkage, *, passive: int = 0, redundant: int = 0) -> Mobility:
    """Count links and joints: W = 3n − (2t + c) + r − s; class II with any dyad, else I."""
    listed = joints(linkage)
    n, pairs = len(linkage.links), len(listed)
    return Mobility(
        n=n,
        lower_pairs=pairs,
        higher_pairs=0,
        passive=passive,
        redundant=redundant,
        W=3 * n - 2 * pairs + passive - redundant,
        joints=listed,
        groups=linkage.dyads,
        mechanism_class=2 if linkage.dyads else 1,
    )


def owners(linkage: Linkage) -> Mapping[str, int]:
    """The link that each named point belongs to; a joint belongs to the link that was placed first.

    A slide's `middle` (RPR, RPP) is a point of the group's second link.  Raises `ValueError` when a
    name is given to two points.
    """
    names: dict[str, int] = {}

    def enter(name: str, link: int) -> None:
        if name in names:
            raise ValueError(f"two points are named {name}")
        names[name] = link

    for name in linkage.ground:
        enter(name, GROUND)
    enter(linkage.driver.pin, DRIVER)
    for dyad in linkage.dyads:
        enter(dyad.middle, dyad.links[1] if dyad.kind in {"RPR", "RPP"} else dyad.links[0])
    for point in linkage.points:
        enter(point.name, point.link)
    return names


def joints(linkage: Linkage) -> tuple[Joint, ...]:
    """All joints in the order of assembly: the driver's, then start, inner and end of every dyad.

    Raises `ValueError` for a dyad that hangs on the `middle` of an RPR: that point of the guide link
    changes from moment to moment, so no pin can be there (the slider's own pin can be named instead).
    """
    owner = owners(linkage)
    passing = {dyad.middle for dyad in linkage.dyads if dyad.kind == "RPR"}
    for dyad in linkage.dyads:
        for end in (dyad.start, dyad.end):
            if end in passing:
                raise ValueError(f"dyad {dyad.links} cannot hang on {end}, which slides along its link")
    driver = linkage.driver
    first = (
        Joint("R", (GROUND, DRIVER), driver.centre)
        if isinstance(driver, Crank)
        else Joint("P", (GROUND, DRIVER), driver.pin)
    )
    return (first, *(joint for dyad in linkage.dyads for joint in _of_dyad(dyad, owner)))


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
