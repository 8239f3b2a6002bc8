"""The pairs of a structure exercise at their places in the drawing, as given and with higher pairs replaced.

Places are points of the file (m), x to the right and y up, as complex numbers. The drawing is not to scale.
"""

from __future__ import annotations

import cmath
from collections.abc import Iterable, Iterator, Mapping
from functools import cached_property

import numpy as np

from reportgen.base.records import Record, replace
from reportgen.catalogue.linkage_file import place
from reportgen.drawing.geometry import polar
from reportgen.structure.splitting import FRAME, ChainJoint
from reportgen.structure.structure_file import PairPoint, Parameters

ROOM = 112.0, 78.0
"""Largest distances across and up between the points of a scheme (mm of paper)."""
SMALL_ROOM = 47.0, 44.0
"""The same in a drawing of which two are side by side (mm)."""
WIDE_ROOM, MOST_SMALL = (95.0, 62.0), 8
"""The same in one of a mechanism with more moving links than this."""
SAME_PLACE = 1e-9
"""Points within this distance (m) are one place."""


class Profile(Record):
    """The profile of a link in a higher pair at the contact.

    `centre` is its centre of curvature, None if it is straight; `axis` is the centre of the circle that represents it
    in the drawing, which is the pitch circle of a gear.
    """

    centre: complex | None
    axis: complex | None


class PlacedJoint(Record):
    """A joint with its letter and place.

    A sliding pair has the direction of its guide in `slide` (rad); its first link is the block, its last the guide.
    A higher pair has the `profiles` of its two links, in the order of its links.
    """

    name: str
    links: tuple[int, ...]
    at: complex
    slide: float | None = None
    profiles: tuple[Profile, ...] = ()
    gears: bool = False

    @property
    def turns(self) -> bool:
        """Return True for a turning pair."""
        return self.slide is None and not self.profiles

    @property
    def chain_joint(self) -> ChainJoint:
        return ChainJoint(self.links, higher=bool(self.profiles))


class PlacedJoints(Record, dict=True):
    """The joints of a mechanism at their places, with the numbers of links that replace higher pairs."""

    joints: tuple[PlacedJoint, ...]
    added: tuple[int, ...] = ()

    @cached_property
    def links(self) -> tuple[int, ...]:
        """The moving links in ascending order."""
        return tuple(sorted({link for joint in self.joints for link in joint.links} - {FRAME}))

    def of(self, link: int) -> tuple[PlacedJoint, ...]:
        """Return the joints of a link."""
        return tuple(joint for joint in self.joints if link in joint.links)

    def between(self, links: Iterable[int]) -> PlacedJoints:
        """Return the joints that are left if the mechanism has only these links."""
        kept = {*links}
        rest = (replace(joint, links=tuple(link for link in joint.links if link in kept)) for joint in self.joints)
        return replace(self, joints=tuple(joint for joint in rest if len(joint.links) > 1))

    def split_off(self, links: Iterable[int]) -> PlacedJoints:
        """Return the lower pairs that these links keep when all others are split off.

        Where a moving link was joined to one that is gone, it keeps a free pin or its guide.
        """
        kept, joints = {*links}, list[PlacedJoint]()
        for joint in self.joints:
            rest = tuple(link for link in joint.links if link in kept)
            if joint.slide is not None and rest == joint.links[:1]:
                joint = replace(joint, slide=None)
            if rest and rest != (FRAME,):
                joints.append(replace(joint, links=rest))
        return replace(self, joints=tuple(joints))

    def active(self, given: Parameters) -> PlacedJoints:
        """Return the joints without passive links and rollers, whose higher pairs pass to the links that carry them."""
        passive, rollers = {*(given.passive or ())}, {*(given.rollers or ())}
        joints = self.between({FRAME, *self.links} - passive).joints
        carriers = {roller: _carrier(joints, roller) for roller in rollers}
        kept = list[PlacedJoint]()
        for joint in joints:
            if joint.profiles:
                kept.append(replace(joint, links=tuple(carriers.get(link, link) for link in joint.links)))
            else:
                kept.append(replace(joint, links=tuple(link for link in joint.links if link not in rollers)))
        return replace(self, joints=tuple(joint for joint in kept if len(joint.links) > 1))

    def scale(self, room: tuple[float, float]) -> float:
        """Return the millimetres of paper per metre at which all points and gears fit a room (mm)."""
        points = [joint.at for joint in self.joints]
        for joint in self.joints:
            circles = [(each.axis, abs(joint.at - each.axis)) for each in joint.profiles if each.axis is not None]
            points += [axis + radius * 1j**k for axis, radius in circles if joint.gears for k in range(4)]
        spread = np.array(points)
        return 1 / max(float(np.ptp(spread.real)) / room[0], float(np.ptp(spread.imag)) / room[1], 1e-6)

    @property
    def step_scale(self) -> float:
        """Millimetres of paper per metre in drawings of the replacement and of the steps."""
        return self.scale(SMALL_ROOM if len(self.links) <= MOST_SMALL else WIDE_ROOM)

    def scaled(self, by: float) -> PlacedJoints:
        """Return the joints with places multiplied by a factor, in its unit."""

        def profile(of: Profile) -> Profile:
            return Profile(*(None if point is None else point * by for point in (of.centre, of.axis)))

        joints = (
            replace(joint, at=joint.at * by, profiles=tuple(map(profile, joint.profiles))) for joint in self.joints
        )
        return replace(self, joints=tuple(joints))

    @property
    def with_lower_pairs(self) -> PlacedJoints:
        """The joints with a link and two lower pairs for each higher pair, numbered after the last link.

        The pairs are at the centres of curvature. The added link turns about that of the curved profile and slides
        along a straight one.
        """
        joints, added, number = list[PlacedJoint](), list[int](), max(self.links, default=0)
        for joint in self.joints:
            if joint.profiles:
                number += 1
                added.append(number)
                joints += _replacing(joint, number)
            else:
                joints.append(joint)
        return PlacedJoints(tuple(joints), tuple(added))


def _carrier(joints: Iterable[PlacedJoint], roller: int) -> int:
    pin = next(joint for joint in joints if roller in joint.links and not joint.profiles)
    return next(link for link in pin.links if link != roller)


def _replacing(joint: PlacedJoint, number: int) -> Iterator[PlacedJoint]:
    """Yield the two lower pairs of the link that replaces a higher pair."""
    pivot = next(profile.centre for profile in joint.profiles if profile.centre is not None)
    for link, profile in zip(joint.links, joint.profiles, strict=True):
        if profile.centre is None:
            yield PlacedJoint("", (number, link), pivot, slide=cmath.phase((joint.at - pivot) * 1j))
        else:
            yield PlacedJoint("", (link, number), profile.centre)


# --- from the file --------------------------------------------------------------------------------


def placed(given: Parameters) -> PlacedJoints:
    """Return the joints at the places of their points; without points there are none.

    A joint has the links in the order of its point, so that the first slides on the last. Gears whose axes no link
    joins are circles about the contact, which `check` reports.
    """
    points = given.points or {}
    joints = tuple(_placed(name, point, points) for name, point in points.items())
    order = {frozenset(joint.links): number for number, joint in enumerate(given.whole_chain.joints)}
    return PlacedJoints(tuple(sorted(joints, key=lambda joint: order.get(frozenset(joint.links), len(order)))))


def _placed(name: str, point: PairPoint, points: Mapping[str, PairPoint]) -> PlacedJoint:
    at, links = place(point.at), point.links
    if point.slide is not None:
        block_first = links if links[0] != FRAME else links[::-1]
        return PlacedJoint(name, block_first, at, slide=point.slide.si)
    if point.centres is not None:
        centres: list[complex | None] = [place(centre) for centre in point.centres]
        profiles = tuple(Profile(centre, centre) for centre in (*centres, None)[:2])
        return PlacedJoint(name, links, at, profiles=profiles)
    if point.teeth is not None:
        return PlacedJoint(name, links, at, profiles=_teeth(point, points), gears=True)
    return PlacedJoint(name, links, at)


def gear_axes(point: PairPoint, points: Mapping[str, PairPoint]) -> tuple[complex, ...]:
    """Return the axes of two gears in mesh, on the link that carries both; () without such a link."""
    first, second = point.links
    pins = [each for each in points.values() if each.slide is None and not each.centres and not each.teeth]
    for pin in pins:
        for second_pin in pins:
            shared = {*pin.links} & {*second_pin.links} - {first, second}
            if first in pin.links and second in second_pin.links and shared and pin is not second_pin:
                return place(pin.at), place(second_pin.at)
    return ()


def _teeth(point: PairPoint, points: Mapping[str, PairPoint]) -> tuple[Profile, ...]:
    """Return the profiles of gears: involutes, whose centres of curvature are the feet on the line of action."""
    assert point.teeth is not None, "gears have a pressure angle"
    contact, axes = place(point.at), gear_axes(point, points) or (place(point.at),) * 2
    distance = axes[1] - axes[0]
    across = distance / abs(distance) * 1j if abs(distance) > SAME_PLACE else 1j
    action = across * polar(point.teeth.si)
    feet = (contact + action * ((axis - contact) * action.conjugate()).real for axis in axes)
    return tuple(Profile(foot, axis) for foot, axis in zip(feet, axes, strict=True))
