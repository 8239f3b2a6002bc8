"""A declared linkage as the mechanism core knows it."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from reportgen.catalogue import linkage_file as file
from reportgen.mechanism.structure import (
    Crank,
    Dyad,
    DyadKind,
    Guide,
    Inertia,
    Linkage,
    LinkPoint,
    SlidingDriver,
)


def linkage(given: file.Parameters) -> Linkage:
    """The whole mechanism: frame, driver, groups in their order, points, masses."""
    return Linkage(
        ground={name: file.place(at) for name, at in given.frame.items()},
        driver=_driver(given.driver),
        dyads=tuple(map(dyad, given.groups)),
        points=tuple(LinkPoint(name, one.link, file.place(one.at)) for name, one in given.points.items()),
        inertias=tuple(
            Inertia(body.link, body.at, body.mass(given.g.si), body.J.si if body.J else 0.0)
            for body in given.masses
        ),
        gravity=-1j * given.g.si,
    )


def _driver(driver: file.Driver) -> Crank | SlidingDriver:
    if isinstance(driver, file.CrankDriver):
        return Crank(driver.centre, driver.pin, driver.length.si)
    return SlidingDriver(driver.pin, guide(driver.guide))


def guide(given: file.Guide) -> Guide:
    """A guide in the axes of its link."""
    return Guide(file.place(given.at), given.angle.si, given.on)


def dyad(group: file.Group) -> Dyad:
    """A group with its links, joints and orientation."""
    return _DYADS[group.type](group)


def _links(group: file.Group) -> tuple[int, int]:
    return group.links[0], group.links[1]


def _rrr(group: file.Group) -> Dyad:
    assert isinstance(group, file.RRR)
    first, middle, last = group.joints
    lengths = group.lengths[0].si, group.lengths[1].si
    return Dyad("RRR", _links(group), first, middle, last, lengths, 1 if group.side == "left" else -1)


def _rrp(group: file.Group) -> Dyad:
    assert isinstance(group, file.RRP)
    lengths = group.length.si, 0.0
    sign = 1 if group.end == "far" else -1
    start, middle = group.joints
    return Dyad("RRP", _links(group), start, middle, guide(group.guide), lengths, sign)


def _rpr(group: file.Group) -> Dyad:
    assert isinstance(group, file.RPR)
    lengths, sign = (0.0, group.offset.si), 1 if group.axis == "towards" else -1
    start, middle, end = group.joints
    return Dyad("RPR", _links(group), start, middle, end, lengths, sign)


def _prp(group: file.Group) -> Dyad:
    assert isinstance(group, file.PRP)
    first, second = map(guide, group.guides)
    return Dyad("PRP", _links(group), first, group.joints[0], second)


def _rpp(group: file.Group) -> Dyad:
    assert isinstance(group, file.RPP)
    start, middle = group.joints
    return Dyad("RPP", _links(group), start, middle, guide(group.guide), slide_angle=group.across.si)


_DYADS: Mapping[DyadKind, Callable[[file.Group], Dyad]] = {
    "RRR": _rrr,
    "RRP": _rrp,
    "RPR": _rpr,
    "PRP": _prp,
    "RPP": _rpp,
}
