"""Kinematic scheme of a structure exercise, drawn from the places of its pairs: the whole, with its higher pairs
replaced, or a step in which a group is split off.

Lengths are millimetres of paper. Bars and plates join the pairs of a link; the frame is hatched.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Collection, Iterable, Iterator, Sequence
from functools import cached_property
from itertools import combinations, pairwise

import numpy as np

from reportgen.base.records import Record, replace
from reportgen.base.stable_digits import settled
from reportgen.drawing import Arc, Arrow, Circle, Hatch, Item, Label, Line, Pen, Polyline, Scene, style
from reportgen.drawing.canvas import Canvas, finish
from reportgen.drawing.drawing_description import Fact, alignment, fact, listed
from reportgen.drawing.geometry import clusters, polar
from reportgen.drawing.label_candidates import distances
from reportgen.drawing.labels import Request, joined, label
from reportgen.formula import vocabulary
from reportgen.structure.placed_joints import ROOM, PlacedJoint, PlacedJoints, Profile
from reportgen.structure.splitting import FRAME, Splitting, formula_part

TOGETHER = 0.3
"""Points within this distance are drawn as one."""
LARGEST_DISC = 24.0
"""Profiles with a larger radius are drawn as an arc at the contact, unless they are gears."""
HALF_PROFILE = 8.0
"""Half the length of such an arc, or of a straight profile."""
SMALL_MARGIN = 3.0
"""Margin of drawings of which two are side by side."""
CHORD = 4.0
"""Length of the strips that hatch a round profile of the frame."""
RAIL = 5.0
"""Length of a guide beyond each end of its block."""
TRAVEL = 5.0
"""Half the travel of a block on the frame, for which its guide is drawn."""
RING = 4.0
"""Distance from a disc at which its number has room."""
SHORT_CRANK = 9.0
"""The arrow of a shorter crank goes around its pin."""
CLEAR = 1.0
"""Least distance of the driver's arrow from the links."""
COS_TO_SUPPORT = math.cos(math.radians(75))
"""Cosine of the least angle (75°) of the driver's arrow from vertically down, where the pivot's support is."""
SWEEP = 1.0
"""Angle (rad) of the driver's arrow."""
FADED = Pen(0.2, style.GRAY)
AMONG_OTHERS = Pen(0.5, style.BLUE, style.DASHED)
"""Pen of an emphasized link beside links in black, from which it differs without colour, too."""


class Sketch(Record, dict=True):
    """A mechanism to be drawn: its joints (mm), its driver, and the links that are emphasized.

    The other links may be drawn in gray, without their numbers and letters.
    """

    joints: PlacedJoints
    driver: int
    emphasized: Collection[int] = ()
    others_gray: bool = False

    def plain(self, link: int) -> bool:
        """Return True if a link is not drawn in gray."""
        return link in self.emphasized or not self.others_gray

    def pen(self, link: int) -> Pen:
        """Return the pen of the bar or the plate of a link."""
        if link in self.emphasized:
            return style.NEW if self.others_gray else AMONG_OTHERS
        return FADED if self.others_gray else style.HEAVY

    def clear_joint(self, joint: PlacedJoint) -> bool:
        """Return True if a joint has a link that is not drawn in gray."""
        return any(self.plain(link) for link in joint.links if link != FRAME)

    # --- shapes of links

    def body_points(self, link: int) -> list[complex]:
        """Return the points that the bar or plate of a link joins."""
        places, discs = list[complex](), list[tuple[complex, float]]()
        for joint in self.joints.of(link):
            if joint.profiles:
                profile = profile_of(joint, link)
                if is_disc(joint, profile):
                    discs.append(_disc(joint, profile))
                else:
                    places.append(joint.at)
            elif joint.slide is None or joint.links[0] == link != joint.links[-1]:
                places.append(joint.at)
        for centre, radius in discs:
            outside = [at for at in places if abs(at - centre) > radius + TOGETHER]
            places = [*outside, centre] if outside else []
        for joint in self.rails_of(link):
            # A rod may end behind the block; a plate, which the block would cover, ends at an end of the guide.
            ends = (joint.at,) if _in_line(joint.at, places) else rail_ends(joint)
            places.append(min(ends, key=lambda end: settled(abs(end - places[0]))) if places else joint.at)
        return [group[0] for group in clusters(places, TOGETHER, lambda at: at)]

    def rails_of(self, link: int) -> list[PlacedJoint]:
        """Return the sliding pairs whose guide a moving link carries."""
        own = self.joints.of(link)
        return [joint for joint in own if joint.slide is not None and joint.links[-1] == link != FRAME]

    @cached_property
    def sides(self) -> list[tuple[complex, complex]]:
        """The straight lines between the points of each moving link."""
        bodies = (self.body_points(link) for link in self.joints.links)
        return [side for body in bodies for side in combinations(body, 2)]

    # --- drawing

    def draft(self) -> Canvas:
        """Return the drawing with the requests of its labels."""
        discs, rails, bars, rims, blocks, pins = (list[Item]() for _ in range(6))
        for link in self.joints.links:
            pen, fill = self.pen(link), style.TINT if self.plain(link) else None
            bars += style.body(self.body_points(link), pen, fill)
            rails += [Line(*rail_ends(joint), pen) for joint in self.rails_of(link)]
        for joint in self.joints.joints:
            ink: Iterable[Item]
            if joint.profiles:
                for link in joint.links:
                    ink = _profile(joint, link)
                    discs += self._inked(ink, self.plain(link))
                    # The outline again, which a plate would cover.
                    rims += self._inked((replace(i, fill=None) for i in ink if isinstance(i, Circle)), self.plain(link))
            elif joint.slide is not None:
                clear = self.clear_joint(joint)
                if joint.links[-1] == FRAME:
                    along = TRAVEL * polar(joint.slide)
                    ink = style.guide(joint.at - along, joint.at + along, style.BLOCK, self.sides)
                    rails += self._inked(ink, clear)
                if len(joint.links) == 1:
                    continue
                blocks += self._inked((style.block(joint.at, joint.slide, style.BLOCK),), self.plain(joint.links[0]))
                if not self._pinned(joint):
                    pins += self._inked((style.point(joint.at),), clear)
            else:
                ink = style.pivot(joint.at) if FRAME in joint.links else (style.joint(joint.at),)
                pins += self._inked(ink, self.clear_joint(joint))
        # A smaller disc, as a wheel in an internal gear, is in front of a larger one.
        discs.sort(key=lambda item: -settled(item.radius) if isinstance(item, Circle) else -math.inf)
        items = (*discs, *rails, *bars, *rims, *blocks, *pins)
        requests = [*self._letters(), *(request for link in self.joints.links for request in self._number(link))]
        return Canvas((*items, *self._driver_arrow()), tuple(requests), tuple(self._facts()))

    def _inked(self, items: Iterable[Item], plain: bool) -> Iterable[Item]:
        return items if plain else map(faded, items)

    def _pinned(self, slide: PlacedJoint) -> bool:
        """Return True if the block of a sliding pair turns about a pin in its middle."""
        return any(joint.turns and abs(joint.at - slide.at) <= TOGETHER for joint in self.joints.of(slide.links[0]))

    def _driver_arrow(self) -> tuple[Item, ...]:
        """Return the arrow of the driver's motion, about its pivot or along its guide; () if the driver is gray."""
        own = [joint for joint in self.joints.of(self.driver) if FRAME in joint.links and not joint.profiles]
        if not own or not self.plain(self.driver):
            return ()
        joint, pen = own[0], Pen(0.25)
        if joint.slide is not None:
            along = polar(joint.slide)
            beside = style.BLOCK[1] / 2 + style.PLAY + style.STRIP + 1.5
            tails = [joint.at + 1j * side * beside * along - 5 * along for side in (1, -1)]
            tail = max(
                tails, key=lambda start: settled(self._clearance([start, start + 5 * along, start + 10 * along]))
            )
            return (Arrow(tail, tail + 10 * along, pen, style.HEAD),)
        ends = [at for at in self.body_points(self.driver) if abs(at - joint.at) > TOGETHER]
        angle = cmath.phase(ends[0] - joint.at) if ends else math.pi / 2
        radii = [abs(at - joint.at) for at in ends] + [
            _disc(contact, profile_of(contact, self.driver))[1] * 2.2
            for contact in self.joints.of(self.driver)
            if contact.profiles and is_disc(contact, profile_of(contact, self.driver))
        ]
        nearest = min(radii, default=12.0)
        reach = min(0.55 * nearest, 12.0) if nearest > SHORT_CRANK else nearest + 3.0
        starts = [angle + 0.25 + quarter * math.pi / 2 for quarter in range(4)]
        free = [start for start in starts if math.cos(start + SWEEP / 2 + math.pi / 2) < COS_TO_SUPPORT] or starts

        def clearance(start: float) -> float:
            return settled(self._clearance([joint.at + reach * polar(start + SWEEP * k / 6) for k in range(7)]))

        start = next((start for start in free if clearance(start) > CLEAR), max(free, key=clearance))
        return (Arc(joint.at, reach, start, start + SWEEP, pen, style.HEAD),)

    def _clearance(self, along: Iterable[complex]) -> float:
        """Return the least distance of places from the links."""
        sides = np.array(self.sides)
        return float(distances(sides, np.array(list(along))).min()) if len(sides) else math.inf

    # --- labels

    def _letters(self) -> Iterator[Request]:
        """Yield one label for the joints at each place."""
        named = [joint for joint in self.joints.joints if joint.name and self.clear_joint(joint)]
        for group in clusters(named, TOGETHER, lambda joint: joint.at):
            names = joined((vocabulary.point(joint.name) for joint in group), " ≡ ")
            yield label(group[0].at, *names, prefer=_beside_contact(group[0]), gap=style.JOINT + 0.5)

    def _number(self, link: int) -> Iterator[Request]:
        """Yield the ringed number of a link that is not gray: beside its longest bar, its block or its profile."""
        if not self.plain(link):
            return
        points, own = self.body_points(link), self.joints.of(link)
        across, gap = 0.0, 0.9
        blocks = [joint for joint in own if joint.slide is not None and joint.links[0] == link != joint.links[-1]]
        if len(points) > 1:
            start, end = max(combinations(points, 2), key=lambda pair: settled(abs(pair[1] - pair[0])))
            across = cmath.phase(end - start) + math.pi / 2
            places = [start + (end - start) * share for share in (0.5, 0.4, 0.6, 0.3, 0.7, 0.2, 0.8)]
        elif blocks:
            at, along = blocks[0].at, polar(blocks[0].slide or 0.0)
            across, gap = (blocks[0].slide or 0.0) + math.pi / 2, style.BLOCK[1] / 2 + 1.0
            places = [at, at + along * style.BLOCK[0] / 4, at - along * style.BLOCK[0] / 4]
        else:
            discs = [(joint, profile_of(joint, link)) for joint in own if joint.profiles]
            rims = (_disc(*disc) for disc in discs if is_disc(*disc))
            around = [(centre, radius, polar(k * math.pi / 6)) for centre, radius in rims for k in range(12)]
            around.sort(key=lambda rim: -settled(self._clearance([rim[0] + (rim[1] + RING) * rim[2]])))
            places = [centre + radius * out for centre, radius, out in around] or [joint.at for joint in own]
            across = cmath.phase(around[0][2]) if around else 0.0
        yield label(places, str(link), prefer=(across, across + math.pi), gap=gap, size=style.SMALL, ring=True)

    def _facts(self) -> Iterator[Fact]:
        """Yield each link with its joints, the blocks on their guides, contacts, pivots on the frame, the driver."""
        for link in filter(self.plain, self.joints.links):
            names = listed(vocabulary.point(joint.name) for joint in self.joints.of(link) if joint.name)
            yield fact("structure-link", str(link), names) if names else fact("structure-added", str(link))
        for joint in filter(self.clear_joint, self.joints.joints):
            if joint.profiles:
                yield fact("structure-contact", vocabulary.point(joint.name), *map(str, joint.links))
            elif joint.slide is not None and joint.name and len(joint.links) > 1:
                block, on = joint.links
                along, name = alignment(polar(joint.slide)), vocabulary.point(joint.name)
                if on == FRAME:
                    yield fact("slider", str(block), name, along)
                else:
                    yield fact("slider-on", str(block), name, str(on), along)
        pivots = [joint for joint in self.joints.joints if joint.turns and FRAME in joint.links and joint.name]
        if standing := listed(vocabulary.point(joint.name) for joint in pivots if self.clear_joint(joint)):
            yield fact("pivots", standing)
        if self.plain(self.driver):
            yield fact("structure-driving", str(self.driver))


def scheme(joints: PlacedJoints, driver: int) -> Scene:
    """Draw the whole mechanism."""
    return finish(Sketch(joints.scaled(joints.scale(ROOM)), driver).draft())


def replacement(joints: PlacedJoints, driver: int) -> tuple[Scene, Scene]:
    """Draw a mechanism with its higher pairs, and with a link and two lower pairs for each of them."""
    joints = joints.scaled(joints.step_scale)
    equivalent = joints.with_lower_pairs
    sketches = Sketch(joints, driver), Sketch(equivalent, driver, emphasized=equivalent.added)
    before, after = (
        finish(sketch.draft(), margin=SMALL_MARGIN, title=title)
        for sketch, title in zip(sketches, ("a)", "b)"), strict=True)
    )
    return before, after


def steps(joints: PlacedJoints, splitting: Splitting) -> Iterator[Scene]:
    """Draw each group as it is split off from the rest, the last of the assembly first, and then the driver.

    The joints are lower pairs. The group is emphasized, the rest is gray; below is the group's part of the formula.
    """
    joints = joints.scaled(joints.step_scale)
    rest = {FRAME, *joints.links}
    for group in reversed(splitting.groups):
        sketch = Sketch(joints.split_off(rest), splitting.driver, group.links, others_gray=True)
        yield finish(sketch.draft(), margin=SMALL_MARGIN, title=formula_part(group.assur_class, group.links))
        rest -= {*group.links}
    sketch = Sketch(joints.split_off(rest), splitting.driver, (splitting.driver,), others_gray=True)
    yield finish(sketch.draft(), margin=SMALL_MARGIN, title=formula_part(1, (FRAME, splitting.driver)))


# --- profiles of higher pairs ---------------------------------------------------------------------


def profile_of(joint: PlacedJoint, link: int) -> Profile:
    """Return the profile of a link in a higher pair."""
    return joint.profiles[joint.links.index(link)]


def is_disc(joint: PlacedJoint, profile: Profile) -> bool:
    """Return True if a profile is drawn as a full circle."""
    return profile.axis is not None and (joint.gears or abs(joint.at - profile.axis) <= LARGEST_DISC)


def rail_ends(joint: PlacedJoint) -> tuple[complex, complex]:
    """Return the ends of the guide of a sliding pair on a moving link."""
    on = polar(joint.slide or 0.0) * (style.BLOCK[0] / 2 + RAIL)
    return joint.at - on, joint.at + on


def _in_line(at: complex, places: Sequence[complex]) -> bool:
    """Return True if places are on a straight line through a point."""
    arms = [place - at for place in places]
    longest = max(arms, key=lambda arm: settled(abs(arm)), default=0j)
    return all(abs((arm * longest.conjugate()).imag) <= TOGETHER * abs(longest) for arm in arms)


def _beside_contact(joint: PlacedJoint) -> tuple[float, ...]:
    """Return the directions (rad) of the common tangent of a higher pair; () for a lower pair."""
    centre = next((profile.axis for profile in joint.profiles if profile.axis is not None), joint.at)
    normal = cmath.phase(joint.at - centre)
    return (normal + math.pi / 2, normal - math.pi / 2) if joint.profiles else ()


def _disc(joint: PlacedJoint, profile: Profile) -> tuple[complex, float]:
    centre = joint.at if profile.axis is None else profile.axis
    return centre, abs(joint.at - centre)


def _profile(joint: PlacedJoint, link: int) -> tuple[Item, ...]:
    """Draw the profile of a link: a disc, or a piece of it at the contact; that of the frame is hatched."""
    profile = profile_of(joint, link)
    if profile.axis is None:
        centre = next(each.axis for each in joint.profiles if each.axis is not None)
        across = HALF_PROFILE * polar(cmath.phase(joint.at - centre)) * 1j
        outline: Item = Line(joint.at - across, joint.at + across, style.HEAVY)
        points = [joint.at - across, joint.at + across]
    else:
        radius, angle = abs(joint.at - profile.axis), cmath.phase(joint.at - profile.axis)
        if radius <= TOGETHER:
            return ()
        half = math.pi if is_disc(joint, profile) else HALF_PROFILE / radius
        outline = Arc(profile.axis, radius, angle - half, angle + half, style.HEAVY)
        if is_disc(joint, profile):
            outline = Circle(profile.axis, radius, style.VISIBLE, None if link == FRAME else style.TINT)
        chords = max(2, round(2 * half * radius / CHORD))
        points = [profile.axis + radius * polar(angle - half + 2 * half * k / chords) for k in range(chords + 1)]
    return (*(_hatched(joint, points) if link == FRAME else ()), outline)


def _hatched(joint: PlacedJoint, points: Sequence[complex]) -> Iterator[Item]:
    """Yield the hatching of a profile of the frame, on the side away from the link that touches it."""
    touching = joint.profiles[1 - joint.links.index(FRAME)].axis
    if touching is None:
        touching = 2 * joint.at - (profile_of(joint, FRAME).axis or 0j)
    start, end = min(pairwise(points), key=lambda chord: settled(abs(sum(chord) / 2 - joint.at)))
    side = -1 if ((touching - joint.at) * (end - start).conjugate()).imag > 0 else 1
    return (
        item for start, end in pairwise(points) for item in style.ground(start, end, side) if isinstance(item, Hatch)
    )


def faded(item: Item) -> Item:
    """Return an item in thin gray lines, without tint."""
    match item:
        case Line() | Arc() | Arrow() | Hatch():
            return replace(item, stroke=replace(FADED, width=min(FADED.width, item.stroke.width)))
        case Circle() | Polyline():
            pen = None if item.stroke is None else FADED
            fill = {style.TINT: style.PAPER, style.BLACK: style.GRAY}.get(item.fill or "", item.fill)
            return replace(item, stroke=pen, fill=fill)
        case Label():
            return item
