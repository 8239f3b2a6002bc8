"""A linkage at one position as plain geometry in mm (`skeleton`), its kinematic scheme, its driver and Assur groups
drawn separately, and the legend of line styles.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator, Mapping, Sequence
from itertools import combinations

import numpy as np

from reportgen.base.arrays import Complexes, Floats
from reportgen.base.records import Record, field, replace
from reportgen.base.stable_digits import settled
from reportgen.drawing import Arc, Arrow, Circle, Content, Item, Label, Line, Pen, Scene, style
from reportgen.drawing.canvas import Canvas, finish, settle
from reportgen.drawing.drawing_description import Fact, PaperLength, alignment, direction, fact, listed, turning
from reportgen.drawing.geometry import clusters, polar
from reportgen.drawing.label_candidates import distances
from reportgen.drawing.labels import Request, joined, label
from reportgen.drawing.spring_drawings import coil_symbols
from reportgen.formula import Symbol, vocabulary
from reportgen.machine import DRIVER, GROUND, Crank, Dyad, Guide, Linkage
from reportgen.machine.kinematics import Motion
from reportgen.machine.spring_geometry import Coil


class Slide(Record):
    """A block of `link` at its point `name` on a guide of link `on`, along `angle` (rad) from `low` to `high` (mm)."""

    link: int
    name: str
    on: int
    at: complex
    angle: float
    low: complex
    high: complex
    turns: bool
    """True if the block is a separate link, pinned at its middle; False if it is the end of a longer link."""


class Skeleton(Record):
    """Points (mm) by name, joints of each moving link, slides, ground pivots.

    `owners` gives the link of each further point (mass centres, coupler points); `reached` is False if the mechanism
    cannot take the position.
    """

    points: Mapping[str, complex]
    bars: Mapping[int, tuple[str, ...]]
    slides: tuple[Slide, ...]
    pivots: tuple[str, ...]
    joints: tuple[str, ...]
    owners: Mapping[str, int]
    reached: bool

    def slide_of(self, link: int) -> Slide | None:
        """Return the slide whose block is the link; None without one."""
        return next((slide for slide in self.slides if slide.link == link), None)


def skeleton(linkage: Linkage, motion: Motion, index: int, scale: float) -> Skeleton:
    """Return the mechanism at position `index`, `scale` mm of paper per m; guides are as long as the motion needs."""
    points = {name: complex(point.p[index]) * scale for name, point in motion.points.items()}
    bars: dict[int, list[str]] = {link: [] for link in linkage.links}
    slides: list[Slide] = []
    joints: list[str] = []
    owners = {point.name: point.link for point in linkage.points}

    def pin(name: str, link: int) -> None:
        """Enter a revolute joint of `link` at the named point, which may belong to another link."""
        for number in (link, owners.get(name, GROUND)):
            if number in bars and name not in bars[number]:
                bars[number].append(name)
        if name not in joints:
            joints.append(name)

    def slide(link: int, name: str, guide: Guide | Dyad, turns: bool = True) -> None:
        """Enter the block of a link on a guide, or on the other link of its dyad, with the ends of its travel."""
        on, angle, base = _axis(motion, guide)
        p, direction = motion.points[name].p, np.exp(1j * angle)
        along = ((p - base) * direction.conj()).real
        along = along[np.isfinite(along)] * scale
        low, high = (float(along.min()), float(along.max())) if along.size else (0.0, 0.0)
        foot, u = complex(base[index]) * scale, complex(direction[index])
        slides.append(
            Slide(
                link,
                name,
                on,
                at=points[name],
                angle=float(angle[index]),
                low=foot + low * u,
                high=foot + high * u,
                turns=turns,
            )
        )

    driver = linkage.driver
    if isinstance(driver, Crank):
        pin(driver.centre, DRIVER)
    else:
        slide(DRIVER, driver.pin, driver.guide)
    pin(driver.pin, DRIVER)
    for dyad in linkage.dyads:
        i, j = dyad.links
        if isinstance(dyad.start, str):
            pin(dyad.start, i)
        if isinstance(dyad.end, str):
            pin(dyad.end, j)
        for link in {"RRR": (i, j), "RRP": (i,)}.get(dyad.kind, ()):
            pin(dyad.middle, link)
        if dyad.kind in ("RPR", "RPP"):
            slide(i, str(dyad.start), dyad)
        for link, end in ((i, dyad.start), (j, dyad.end)):
            if isinstance(end, Guide):
                slide(link, dyad.middle, end, turns=dyad.kind != "RPP")
        if dyad.kind == "PRP":
            joints.append(dyad.middle)
    for triad in linkage.triads:
        for leg in triad.legs:
            for name, link in ((leg.outer, leg.link), (leg.inner, leg.link), (leg.inner, triad.plate)):
                pin(name, link)
    return Skeleton(
        points=points,
        bars={link: tuple(names) for link, names in bars.items()},
        slides=tuple(slides),
        pivots=tuple(name for name in joints if name in linkage.ground),
        joints=tuple(joints),
        owners=owners,
        reached=bool(motion.reachable[index]),
    )


def _axis(motion: Motion, guide: Guide | Dyad) -> tuple[int, Floats, Complexes]:
    """Return the link that carries a guide, and its axis at all positions [N]: direction (rad) and a point of it (m).

    A dyad's own guide is the line of link j on which the block i slides at its pin P: of an RPR beside T at the
    distance e, of an RPP through Q.
    """
    if isinstance(guide, Guide) and guide.link == GROUND:
        return GROUND, np.full(motion.driver.shape, guide.angle), np.full(motion.driver.shape, guide.at)
    link = guide.link if isinstance(guide, Guide) else guide.links[1]
    angle, origin = motion.links[link].angle, motion.origins[link].p
    if isinstance(guide, Guide):
        return link, angle + guide.angle, origin + guide.at * np.exp(1j * angle)
    if guide.kind == "RPP":
        return link, angle + guide.slide_angle, origin
    return link, angle, origin + 1j * guide.lengths[1] * np.exp(1j * angle)


# --- drawings -------------------------------------------------------------------------------------


class Looks(Record):
    """Drawing options of a machine.

    `blocks` gives the length (along the guide) and width of a slider's block in mm of paper (a piston's bore, say);
    `centres` are points drawn as mass centres; `scale` is the figure's own μ_l, printed below.  The springs `coils` are
    drawn with the whole machine.
    """

    blocks: Mapping[int, tuple[float, float]] = field(default_factory=dict)
    centres: tuple[str, ...] = ()
    scale: Content | None = None
    coils: tuple[Coil, ...] = ()

    @property
    def notes(self) -> tuple[Content, ...]:
        """Return the notes printed below the figure."""
        return () if self.scale is None else (self.scale,)

    def block(self, link: int) -> tuple[float, float]:
        """Return length and width of a block (mm)."""
        return self.blocks.get(link, style.BLOCK)


def scheme(linkage: Linkage, motion: Motion, index: int, scale: float, looks: Looks) -> Scene:
    """Draw the kinematic scheme at position `index`, `scale` mm of paper per m."""
    bones = skeleton(linkage, motion, index, scale)
    draft = mechanism(bones, (GROUND, *linkage.links), looks) + driver_marks(linkage, motion, bones)
    hung = coil_symbols(looks.coils, linkage, motion, index, scale, bones.pivots)
    return finish(hung + draft, notes=looks.notes)


def groups(
    linkage: Linkage, motion: Motion, index: int, scale: float, looks: Looks, titles: Sequence[str] = ()
) -> tuple[Scene, ...]:
    """Return scenes of the driver with the ground and of each Assur group, at `scale` mm per m, each with its title."""
    bones = skeleton(linkage, motion, index, scale)
    parts = [mechanism(bones, (GROUND, DRIVER), looks) + driver_marks(linkage, motion, bones)]
    parts += [mechanism(bones, group.links, looks) for group in linkage.groups]
    return tuple(finish(part, title=title) for part, title in zip(parts, titles or [""] * len(parts), strict=True))


LEGS = math.cos(math.radians(75))
"""Least angle (75°) of the arrow of ω1 from vertically down, where the pivot's support is."""
CLEAR = 1.0
"""Least distance of the arrow of ω1 from the links that the crank moves (mm)."""
TURNS = 0.0, 0.15, 0.3, 0.45, 0.6, 0.75, 0.9
"""Angles (rad) along the arrow of ω1 at which its distance from them is checked."""
NUMBER = 6.0
"""Room for a link's number beside its bar (mm)."""
THUMBNAIL = 34.0, 40.0
"""Largest width and height of a small mechanism beside a plan (mm)."""


def thumbnail(linkage: Linkage, motion: Motion, index: int) -> Canvas:
    """Draw the mechanism at position `index` as a small sketch, not to scale: links, joints and their names."""
    whole = skeleton(linkage, motion, index, 1.0)
    ends = np.array([*whole.points.values(), *(end for s in whole.slides if s.on == GROUND for end in (s.low, s.high))])
    size = max(float(np.ptp(ends.real)) / THUMBNAIL[0], float(np.ptp(ends.imag)) / THUMBNAIL[1])
    bones = skeleton(linkage, motion, index, 1.0 / size)
    items: list[Item] = []
    for slide in bones.slides:
        if abs(slide.high - slide.low) > 0:
            items.append(Line(slide.low, slide.high, style.THIN if slide.on == GROUND else style.KNOWN))
    for link in linkage.links:
        items += style.body(_body_points(bones, link), style.KNOWN, fill=None)
    items += [style.block(slide.at, slide.angle, style.SMALL_BLOCK) for slide in bones.slides]
    items += [item for name in bones.pivots for item in style.small_pivot(bones.points[name])]
    joints = [name for name in bones.joints if name not in bones.pivots]
    items += [Circle(bones.points[name], style.POINT, style.THIN, style.PAPER) for name in joints]
    names = tuple(_names([*bones.pivots, *joints], bones, style.SMALL, style.POINT))
    return settle(Canvas(tuple(items), names, (fact("beside"),)))


def mechanism(bones: Skeleton, links: Sequence[int], looks: Looks) -> Canvas:
    """Draw the given links with their joints, names and numbers; with link 0, the ground, its pivots and guides."""
    rails: list[Item] = []
    bars: list[Item] = []
    blocks: list[Item] = []
    requests: list[Request] = []
    for slide in bones.slides:
        size = looks.block(slide.link)
        if slide.on in links and (slide.on != GROUND or slide.link in links):
            rails += _rail(slide, size, _bars(bones, links, looks))
        if slide.link in links:
            # If a group is drawn alone, a short piece of its axis represents the guide.
            if slide.on not in links:
                on = polar(slide.angle) * (size[0] / 2 + 5)
                rails.append(Line(slide.at - on, slide.at + on, style.AXIS))
            blocks.append(style.block(slide.at, slide.angle, size))
    names: list[str] = []
    marked: list[str] = []
    for link in links:
        joints = bones.bars.get(link, ())
        own = _marked(bones, link, looks)
        marked += own
        bars += style.body([*_body_points(bones, link), *(bones.points[name] for name in own)])
        names += [name for name in joints if name not in names]
        if link != GROUND:
            requests += _number(bones, link, looks, [slide for slide in bones.slides if slide.link in links])
    names += [name for name in bones.joints if name not in names and _on_block(bones, name, links)]
    # A block that does not rotate has only a point in its middle, not a joint.
    marked += [s.name for s in bones.slides if s.link in links and not s.turns and s.name not in names]
    standing = [name for name in bones.pivots if GROUND in links and (len(links) > 2 or name in names)]
    names += [name for name in standing if name not in names]
    pins: list[Item] = []
    for name in names:
        at = bones.points[name]
        pins += style.pivot(at) if name in standing else (style.joint(at),)
    centres = [name for name in looks.centres if bones.owners.get(name) in links]
    marks = [item for name in centres for item in style.mass_centre(bones.points[name])]
    marks += [style.point(bones.points[name]) for name in marked]
    requests += _names([*names, *centres, *marked], bones)
    return Canvas((*rails, *bars, *blocks, *pins, *marks), tuple(requests), tuple(link_facts(bones, links)))


def link_facts(bones: Skeleton, links: Sequence[int]) -> Iterator[Fact]:
    """Yield the facts of the given links: their bars from joint to joint, blocks and guides, the pivots on the
    ground.
    """
    for link in links:
        first, *others = bones.bars.get(link, ()) or ("",)
        for name in others:
            bar = bones.points[name] - bones.points[first]
            ends = vocabulary.point(first), vocabulary.point(name)
            yield fact("bar", str(link), *ends, PaperLength(abs(bar)), direction(bar))
        for slide in (slide for slide in bones.slides if slide.link == link):
            along = alignment(polar(slide.angle))
            if slide.on == GROUND:
                yield fact("slider", str(link), vocabulary.point(slide.name), along)
            else:
                yield fact("slider-on", str(link), vocabulary.point(slide.name), str(slide.on), along)
    standing = listed(vocabulary.point(name) for name in bones.pivots if GROUND in links)
    if standing:
        yield fact("pivots", standing)


class LinkShape(Record):
    """A link drawn in its own frame (mm): the guide it carries, its bars, its block, in painting order."""

    rails: tuple[Item, ...]
    bars: tuple[Item, ...]
    blocks: tuple[Item, ...]


def parts_of(bones: Skeleton, link: int, looks: Looks, origin: complex, angle: float) -> LinkShape:
    """Return the parts that move with a link, relative to its frame at `origin` (mm) with the angle `angle` (rad)."""
    u = polar(angle)
    slides = tuple(
        replace(
            slide,
            at=(slide.at - origin) / u,
            angle=slide.angle - angle,
            low=(slide.low - origin) / u,
            high=(slide.high - origin) / u,
        )
        for slide in bones.slides
    )
    own = replace(bones, points={name: (at - origin) / u for name, at in bones.points.items()}, slides=slides)
    rails = [item for slide in slides if slide.on == link for item in _rail(slide, looks.block(slide.link), ())]
    bars = style.body([*_body_points(own, link), *(own.points[name] for name in _marked(own, link, looks))])
    blocks = [style.block(slide.at, slide.angle, looks.block(link)) for slide in slides if slide.link == link]
    return LinkShape(tuple(rails), bars, tuple(blocks))


def ground_guides(bones: Skeleton, looks: Looks) -> tuple[Item, ...]:
    """Return the guides on the ground along the whole travel of their blocks, not interrupted by links that
    cross them.
    """
    rails = [_rail(slide, looks.block(slide.link), ()) for slide in bones.slides if slide.on == GROUND]
    return tuple(item for items in rails for item in items)


def driver_marks(linkage: Linkage, motion: Motion, bones: Skeleton) -> Canvas:
    """Draw the circle of a crank's pin and the arrow of ω1; return an empty canvas for a sliding driver."""
    driver = linkage.driver
    if not isinstance(driver, Crank):
        return Canvas()
    centre = bones.points[driver.centre]
    circle = Circle(centre, abs(bones.points[driver.pin] - centre), style.THIN)
    return Canvas((circle,)) + driver_arrow(linkage, motion, bones)


def driver_arrow(linkage: Linkage, motion: Motion, bones: Skeleton) -> Canvas:
    """Draw the arrow of ω1 about a crank's centre; return an empty canvas for a sliding driver."""
    driver = linkage.driver
    if not isinstance(driver, Crank):
        return Canvas()
    centre, pin = bones.points[driver.centre], bones.points[driver.pin]
    radius = abs(pin - centre)
    sense = math.copysign(1.0, motion.rate[0])
    angle = cmath.phase(pin - centre)
    reach = max(5.0, min(0.45 * radius, 12.0))
    # The arrow begins beside the crank, or at least a quarter turn later if it would cover the pivot's support or a
    # link.
    starts = [angle + sense * (0.25 + quarter * math.pi / 2) for quarter in (0, 1, 2, 3)]
    free = [one for one in starts if math.cos(one + sense * 0.45 + math.pi / 2) < LEGS]
    clear = {one: _clearance(bones, [centre + reach * polar(one + sense * turn) for turn in TURNS]) for one in free}
    start = next((one for one in free if clear[one] > CLEAR), max(free, key=lambda one: settled(clear[one])))
    stop = start + sense * 0.9
    arrow = Arc(centre, reach, start, stop, Pen(0.25), style.HEAD)
    places = [centre + reach * polar(start + share * (stop - start)) for share in (0.6, 0.3, 0.9)]
    name = Symbol("ω", "1")
    omega = label(places, name, prefer=((start + stop) / 2,))
    return Canvas((arrow,), (omega,), (turning(name, sense),))


def _bars(bones: Skeleton, links: Sequence[int], looks: Looks) -> list[tuple[complex, complex]]:
    """Return the straight lines between the joints of the links, and the guides that they carry."""
    joints = [[bones.points[name] for name in bones.bars.get(link, ())] for link in links]
    bars = [bar for ends in joints for bar in combinations(ends, 2)]
    return bars + [_carried(slide, looks.block(slide.link)) for slide in bones.slides if slide.on in links and slide.on]


def _carried(slide: Slide, size: tuple[float, float]) -> tuple[complex, complex]:
    """Return the ends of the line that represents a guide on a moving link."""
    on = polar(slide.angle) * (size[0] / 2 + 3.0)
    return slide.low - on, slide.high + on


def _rail(slide: Slide, size: tuple[float, float], bars: Sequence[tuple[complex, complex]]) -> tuple[Item, ...]:
    """Return the guide of a block along its travel; if it does not travel, along a short piece of its axis."""
    along = polar(slide.angle)
    if slide.on != GROUND:
        return (Line(*_carried(slide, size), style.HEAVY),)
    if abs(slide.high - slide.low) > 1e-6:
        return style.guide(slide.low, slide.high, size, bars)
    return style.guide(slide.at - 0.5 * along, slide.at + 0.5 * along, size, bars)


def _clearance(bones: Skeleton, along: Sequence[complex]) -> float:
    """Return the least distance (mm) of places from the links that the crank moves."""
    owned = {link: [bones.points[name] for name, owner in bones.owners.items() if owner == link] for link in bones.bars}
    bodies = ((*_body_points(bones, link), *owned[link]) for link in bones.bars if link != DRIVER)
    sides = np.array([side for body in bodies for side in combinations(body, 2) if abs(side[1] - side[0]) > 0])
    return float(distances(sides, np.array(along)).min()) if len(sides) else math.inf


def _body_points(bones: Skeleton, link: int) -> list[complex]:
    """Return the joints of a link, and the beginning of its slideway if that is away from the joints."""
    points = [bones.points[name] for name in bones.bars.get(link, ())]
    slide = bones.slide_of(link)
    if slide and not points:
        points = [slide.at]
    for slideway in bones.slides:
        if slideway.on == link and points and link != GROUND:
            ends = (slideway.low, slideway.high)
            points.append(min(ends, key=lambda p: settled(abs(p - points[0]))))
    return points


def _marked(bones: Skeleton, link: int, looks: Looks) -> list[str]:
    """Return the named points of a link that are neither joints nor mass centres: coupler points, ends of levers."""
    owned = [name for name, owner in bones.owners.items() if owner == link != GROUND]
    return [name for name in owned if name not in {*bones.joints, *looks.centres}]


def _on_block(bones: Skeleton, name: str, links: Sequence[int]) -> bool:
    """Return True if a joint is the middle of a drawn block."""
    return any(slide.name == name and slide.link in links and slide.turns for slide in bones.slides)


def _number(bones: Skeleton, link: int, looks: Looks, slides: Sequence[Slide]) -> list[Request]:
    """Return the link's number in a ring beside its longest bar, away from the blocks of the `slides`, or beside its
    block.
    """
    joints = [bones.points[name] for name in bones.bars.get(link, ())]
    slide = bones.slide_of(link)
    if len(joints) > 1:
        start, end = max(((a, b) for a in joints for b in joints), key=lambda pair: settled(abs(pair[1] - pair[0])))
        across, gap = cmath.phase(end - start) + math.pi / 2, 0.9
        along_bar = [start + (end - start) * share for share in (0.6, 0.45, 0.75, 0.3, 0.52, 0.37, 0.2, 0.85)]
        places = [at for at in along_bar if not any(_near_block(at, slide, looks) for slide in slides)] or along_bar
    elif slide:
        across, gap = slide.angle + math.pi / 2, looks.block(link)[1] / 2 + 1.0
        along = polar(slide.angle) * looks.block(link)[0] / 4
        places = [slide.at, slide.at + along, slide.at - along]
    else:
        return []
    return [label(places, str(link), prefer=(across, across + math.pi), gap=gap, size=style.SMALL, ring=True)]


def _near_block(at: complex, slide: Slide, looks: Looks) -> bool:
    """Return True if a number beside a place would overlap a block."""
    length, width = looks.block(slide.link)
    off = (at - slide.at) / polar(slide.angle)
    return abs(off.real) < length / 2 + NUMBER and abs(off.imag) < width / 2 + NUMBER


def _names(
    names: Sequence[str], bones: Skeleton, size: float = style.LABEL, radius: float = style.JOINT
) -> list[Request]:
    """Return one label for points that coincide, clear of the circles drawn there."""
    return [
        label(bones.points[group[0]], *joined(map(vocabulary.point, group), " ≡ "), gap=radius + 0.5, size=size)
        for group in clusters(dict.fromkeys(names), 0.3, bones.points.__getitem__)
    ]


# --- the legend of lines ---------------------------------------------------------------------------

LINES: tuple[tuple[str, Pen], ...] = (
    ("link", style.HEAVY),
    ("other", style.THIN),
    ("axis", style.AXIS),
    ("construction", style.CONSTRUCTION),
    ("path", style.PATH),
    ("normal", style.NORMAL),
)
"""Lines of the mechanism and of constructions, by the keys of their names."""
ARROWS: tuple[tuple[str, Pen], ...] = (
    ("known", style.KNOWN),
    ("relative", style.RELATIVE),
    ("found", style.FOUND),
    ("load", style.ACTIVE),
    ("reaction", style.REACTION),
    ("new", style.NEW),
)
"""Vectors of plans, forces on links, and the additions of a construction step, by the keys of their names."""
SAMPLE, COLUMN, ROW, GAP = 18.0, 76.0, 6.5, 2.5
"""Length of a sample, and the distances between columns, between rows, and from a sample to its text (mm)."""


def line_styles(words: Mapping[str, str]) -> Scene:
    """Draw two columns of samples, lines and arrows; `words` has their texts by key; one without text is omitted."""
    items: list[Item] = []
    facts: list[Fact] = []
    for column, pens in enumerate((LINES, ARROWS)):
        for row, (name, pen) in enumerate((name, pen) for name, pen in pens if name in words):
            start = complex(column * COLUMN, -row * ROW)
            end = start + SAMPLE
            items.append(Arrow(start, end, pen, style.HEAD) if pens is ARROWS else Line(start, end, pen))
            items.append(Label(end + GAP, words[name], "left", style.LABEL))
            facts.append(fact(_dashes(pen), words[name], PaperLength(pen.width)))
    return finish(Canvas(tuple(items), says=tuple(facts)), margin=2.0)


def _dashes(pen: Pen) -> str:
    """Return the key of the phrase that describes a stroke without its colour."""
    return "solid" if not pen.dash else "dashed" if len(pen.dash) == 2 else "chain"
