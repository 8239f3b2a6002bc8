"""Checks of the points of a structure exercise: one for each pair, apart from each other, with fitting profiles."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from reportgen.base.errors import Finding
from reportgen.structure.placed_joints import ROOM, SAME_PLACE, PlacedJoint, gear_axes, placed
from reportgen.structure.splitting import FRAME, ChainJoint
from reportgen.structure.structure_file import PairPoint, Parameters

POINTS = ("parameters", "points")
APART = 4.0
"""Least distance (mm of paper) of two turning pairs, whose circles have a diameter of 2.4 mm."""
OFF_LINE = 0.01
"""Greatest distance of a contact from the line of the centres of curvature, as a share of their distance."""


def of_points(given: Parameters) -> Iterator[Finding]:
    """Yield the faults of the points; of their places only if each pair has a point of its kind."""
    if given.points is not None:
        yield from [*_of_pairs(given, given.points)] or _of_places(given, given.points)


def _named(links: Iterable[int]) -> dict[str, str]:
    return {"links": ", ".join(map(str, links))}


def _of_pairs(given: Parameters, points: Mapping[str, PairPoint]) -> Iterator[Finding]:
    """Require one point for each pair, with the keys of its kind."""
    joints = {frozenset(joint.links): joint for joint in given.whole_chain.joints}
    first_of = dict[frozenset[int], str]()
    for name, point in points.items():
        key = frozenset(point.links)
        if key not in joints or len(key) < len(point.links):
            yield Finding("structure-point-pair", (*POINTS, name, "links"), _named(point.links))
        elif key in first_of:
            yield Finding(
                "structure-point-twice", (*POINTS, name, "links"), {**_named(point.links), "point": first_of[key]}
            )
        else:
            first_of[key] = name
            yield from _of_kind(joints[key], name, point)
    for key, joint in joints.items():
        if key not in first_of:
            yield Finding("structure-point-missing", POINTS, _named(joint.links))


def _of_kind(joint: ChainJoint, name: str, point: PairPoint) -> Iterator[Finding]:
    if point.slide is not None and (joint.higher or len(joint.links) > 2):
        yield Finding("structure-point-slide", (*POINTS, name, "slide"))
    if point.centres is not None and point.teeth is not None:
        yield Finding("both-given", (*POINTS, name, "teeth"), {"first": "centres", "second": "teeth"}, at="key")
    elif joint.higher and point.centres is None and point.teeth is None:
        yield Finding("structure-point-profile", (*POINTS, name))
    for key in ("centres", "teeth"):
        if not joint.higher and getattr(point, key) is not None:
            yield Finding("structure-point-lower", (*POINTS, name, key))


def _of_places(given: Parameters, points: Mapping[str, PairPoint]) -> Iterator[Finding]:
    """Require turning pairs that are apart, and contacts on the line of the centres of curvature."""
    mechanism = placed(given)
    scale = mechanism.scale(ROOM)
    names = [*points]
    joints = sorted(mechanism.joints, key=lambda joint: names.index(joint.name))
    pins = [joint for joint in joints if joint.turns]
    for number, pin in enumerate(pins):
        for earlier in pins[:number]:
            if abs(pin.at - earlier.at) * scale < APART:
                yield _close(pin, earlier)
    for joint in joints:
        if joint.gears and not gear_axes(points[joint.name], points):
            yield Finding("structure-point-gears", (*POINTS, joint.name), _named(joint.links))
        elif any(profile.axis is not None and abs(joint.at - profile.axis) <= SAME_PLACE for profile in joint.profiles):
            yield Finding("structure-point-radius", (*POINTS, joint.name, "at"))
        elif joint.profiles and not _in_contact(joint):
            yield Finding("structure-point-contact", (*POINTS, joint.name, "at"))


def _close(pin: PlacedJoint, earlier: PlacedJoint) -> Finding:
    """Return the fault of two turning pairs at one place: a link of no length, or a pin of several links."""
    shared = sorted({*pin.links} & {*earlier.links} - {FRAME})
    where, names = (*POINTS, pin.name, "at"), {"first": earlier.name, "second": pin.name}
    if shared:
        return Finding("structure-point-length", where, {**names, "link": str(shared[0])})
    return Finding("structure-point-close", where, names)


def _in_contact(joint: PlacedJoint) -> bool:
    """Return True if the contact is on the line through the axes of both profiles, which are apart."""
    axes = [profile.axis for profile in joint.profiles if profile.axis is not None]
    if len(axes) < 2:
        return True
    along = axes[1] - axes[0]
    if abs(along) <= SAME_PLACE:
        return False
    off = abs(((joint.at - axes[0]) * along.conjugate()).imag) / abs(along)
    return off <= OFF_LINE * abs(along)
