"""The kinematic scheme of any linkage, and its driver and Assur groups taken apart."""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field

from reportgen.figures import symbols
from reportgen.figures.draft import Draft, finish
from reportgen.figures.geometry import clusters, polar
from reportgen.figures.labels import Content, Request, label
from reportgen.figures.scene import Arc, Item, Line, Scene, Stroke
from reportgen.figures.skeleton import Skeleton, Slide, skeleton
from reportgen.figures.style import AXIS, HEAD, HEAVY
from reportgen.mechanism.motion import Motion
from reportgen.mechanism.structure import DRIVER, GROUND, Crank, Linkage
from reportgen.notation.expressions import Symbol
from reportgen.notation.symbols import point as point_symbol


@dataclass(frozen=True, slots=True)
class Looks:
    """What a kind of machine wants its drawings to show, as plain data.

    `names` replaces printed names of points, `hidden` leaves points unnamed; `blocks` gives the length
    (along the guide) and width of a slider's block in mm of paper (a piston's bore, say); `centres` are
    points drawn as mass centres; `scale` is the figure's own μ_l, printed below.
    """

    names: Mapping[str, Content] = field(default_factory=dict)
    hidden: frozenset[str] = frozenset()
    blocks: Mapping[int, tuple[float, float]] = field(default_factory=dict)
    centres: tuple[str, ...] = ()
    scale: Content | None = None

    def name(self, point: str) -> Content:
        return self.names.get(point, point_symbol(point))

    def block(self, link: int) -> tuple[float, float]:
        return self.blocks.get(link, symbols.BLOCK)


def scheme(
    linkage: Linkage,
    motion: Motion,
    index: int,
    scale: float,
    looks: Looks | None = None,
    *,
    title: str = "",
) -> Scene:
    """The kinematic scheme at position `index`, `scale` mm of paper per m."""
    looks = looks or Looks()
    bones = skeleton(linkage, motion, index, scale)
    links = (GROUND, *linkage.links)
    draft = mechanism(bones, links, looks) + driver_marks(linkage, motion, bones, looks)
    return finish(draft, notes=() if looks.scale is None else (looks.scale,), title=title)


def groups(
    linkage: Linkage,
    motion: Motion,
    index: int,
    scale: float,
    looks: Looks | None = None,
    titles: Sequence[str] = (),
) -> tuple[Scene, ...]:
    """The driver with the ground, then each Assur group alone, a scene each."""
    looks = looks or Looks()
    bones = skeleton(linkage, motion, index, scale)
    parts = [mechanism(bones, (GROUND, DRIVER), looks) + driver_marks(linkage, motion, bones, looks)]
    parts += [mechanism(bones, dyad.links, looks) for dyad in linkage.dyads]
    named = [titles[n] if n < len(titles) else "" for n in range(len(parts))]
    return tuple(finish(part, title=title) for part, title in zip(parts, named, strict=True))


def mechanism(
    bones: Skeleton, links: Iterable[int], looks: Looks, *, pen: Stroke = HEAVY, numbered: bool = True
) -> Draft:
    """The chosen links with their joints, names and numbers; with link 0 its pivots and guides."""
    shown = tuple(links)
    rails: list[Item] = []
    bars: list[Item] = []
    blocks: list[Item] = []
    requests: list[Request] = []
    for slide in bones.slides:
        size = looks.block(slide.link)
        if slide.on in shown and (slide.on != GROUND or slide.link in shown):
            rails += _rail(slide, size)
        if slide.link in shown:
            # Of the group alone, the guide shows as a short piece of its axis.
            if slide.on not in shown:
                on = polar(slide.angle) * (size[0] / 2 + 5)
                rails.append(Line(slide.at - on, slide.at + on, AXIS))
            blocks += symbols.block(slide.at, slide.angle, size)
    names: list[str] = []
    marked: list[str] = []
    for link in shown:
        joints = bones.bars.get(link, ())
        own = _marked(bones, link, looks)
        marked += own
        bars += symbols.body([*_body_points(bones, link), *(bones.points[name] for name in own)], pen)
        names += [name for name in joints if name not in names]
        if numbered and link != GROUND:
            requests += _number(bones, link, looks)
    names += [name for name in bones.joints if name not in names and _on_block(bones, name, shown)]
    if GROUND in shown:
        standing = [name for name in bones.pivots if len(shown) > 2 or name in names]
        names += [name for name in standing if name not in names]
    else:
        standing = []
    pins = [item for name in names for item in _pin(bones, name, name in standing)]
    centres = [name for name in looks.centres if bones.owners.get(name) in shown]
    marks = [item for name in centres for item in symbols.mass_centre(bones.points[name])]
    marks += [item for name in marked for item in symbols.point(bones.points[name])]
    requests += _names([*names, *centres, *marked], bones, looks)
    return Draft((*rails, *bars, *blocks, *pins, *marks), tuple(requests))


def driver_marks(linkage: Linkage, motion: Motion, bones: Skeleton, looks: Looks) -> Draft:
    """The circle of a crank's pin and the arc arrow of ω1; nothing for a sliding driver."""
    driver = linkage.driver
    if not isinstance(driver, Crank):
        return Draft()
    centre, pin = bones.points[driver.centre], bones.points[driver.pin]
    radius = abs(pin - centre)
    sense = math.copysign(1.0, motion.rate)
    angle = cmath.phase(pin - centre)
    reach = max(5.0, min(0.45 * radius, 12.0))
    start, stop = angle + sense * 0.25, angle + sense * 1.15
    arrow = Arc(centre, reach, start, stop, Stroke(0.25), HEAD)
    places = [centre + reach * polar(start + share * (stop - start)) for share in (0.6, 0.3, 0.9)]
    omega = label(places[0], Symbol("ω", "1"), prefer=(angle + sense * 0.7,), also=places[1:])
    return Draft((*symbols.path_circle(centre, radius), arrow), (omega,))


def _rail(slide: Slide, size: tuple[float, float]) -> tuple[Item, ...]:
    if slide.on == GROUND:
        return symbols.guide(*_long(slide), size)
    on = polar(slide.angle) * (size[0] / 2 + 3.0)
    low, high = slide.low - on, slide.high + on
    return (Line(low, high, HEAVY),)


def _long(slide: Slide) -> tuple[complex, complex]:
    """The way of a block; where it has no length, along the block."""
    if abs(slide.high - slide.low) > 1e-6:
        return slide.low, slide.high
    return slide.at - 0.5 * polar(slide.angle), slide.at + 0.5 * polar(slide.angle)


def _body_points(bones: Skeleton, link: int) -> list[complex]:
    """The joints of a link, and where its own slideway begins when that is away from the joints."""
    points = [bones.points[name] for name in bones.bars.get(link, ())]
    slide = bones.slide_of(link)
    if slide and not points:
        points = [slide.at]
    for way in bones.slides:
        if way.on == link and points and link != GROUND:
            ends = (way.low, way.high)
            points.append(min(ends, key=lambda p: abs(p - points[0])))
    return points


def _marked(bones: Skeleton, link: int, looks: Looks) -> list[str]:
    """The named points of a link that are neither joints nor mass centres: coupler points, ends of levers."""
    owned = [name for name, owner in bones.owners.items() if owner == link != GROUND]
    return [name for name in owned if name not in {*bones.joints, *looks.centres, *looks.hidden}]


def _on_block(bones: Skeleton, name: str, shown: Sequence[int]) -> bool:
    """Whether a joint is the middle of a block that is shown."""
    return any(slide.name == name and slide.link in shown and slide.turns for slide in bones.slides)


def _pin(bones: Skeleton, name: str, standing: bool) -> tuple[Item, ...]:
    at = bones.points[name]
    return symbols.pivot(at) if standing else symbols.joint(at)


def _number(bones: Skeleton, link: int, looks: Looks) -> list[Request]:
    """The link's number in a ring beside its longest bar, or beside its block."""
    joints = [bones.points[name] for name in bones.bars.get(link, ())]
    slide = bones.slide_of(link)
    if slide and len(joints) < 2:
        across = slide.angle + math.pi / 2
        gap = looks.block(link)[1] / 2 + 1.0
        along = polar(slide.angle) * looks.block(link)[0] / 4
        ends = (slide.at + along, slide.at - along)
        sides = (across, across + math.pi)
        return [label(slide.at, str(link), prefer=sides, gap=gap, also=ends, size=8.0, ring=True)]
    if len(joints) < 2:
        return []
    start, end = max(((a, b) for a in joints for b in joints), key=lambda pair: abs(pair[1] - pair[0]))
    across = cmath.phase(end - start) + math.pi / 2
    places = tuple(start + (end - start) * share for share in (0.6, 0.45, 0.75, 0.3))
    sides = (across, across + math.pi)
    return [label(places[0], str(link), prefer=sides, gap=0.9, also=places[1:], size=8.0, ring=True)]


def _names(names: Sequence[str], bones: Skeleton, looks: Looks) -> list[Request]:
    shown = [name for name in dict.fromkeys(names) if name not in looks.hidden]
    requests = []
    for group in clusters([bones.points[name] for name in shown], 0.3):
        members = [shown[i] for i in group]
        parts: list[Content] = []
        for name in members:
            parts += [" ≡ ", looks.name(name)] if parts else [looks.name(name)]
        requests.append(label(bones.points[members[0]], *parts, gap=symbols.JOINT + 0.5))
    return requests
