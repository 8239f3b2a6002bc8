"""Animated drawings: their items, and the position of each item at every sample of a turn.

A position is a `Track`, an array over the samples, computed once; items name the tracks that they follow.  A machine is
drawn once, each link in its own frame; plans are arrows between two tracks.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from itertools import pairwise
from types import MappingProxyType

import numpy as np

from reportgen.base.records import Record, field
from reportgen.base.units import nice_up
from reportgen.drawing import Circle, Content, Item, Label, Line, Pen, Polyline, spring_drawings, style
from reportgen.drawing.charts import Plotted
from reportgen.drawing.geometry import bounds
from reportgen.drawing.scheme import Looks, Skeleton, ground_guides, parts_of, skeleton
from reportgen.drawing.vector_plan import BEYOND, PENS, Construction
from reportgen.formula import Number, vocabulary
from reportgen.formula.vocabulary import KINDS
from reportgen.machine import Crank, Linkage
from reportgen.machine.kinematics import Motion
from reportgen.machine.spring_geometry import Coil

ROOM = 9.0
"""Margin around moving items, for their labels (mm)."""
MARGIN = 7.0
"""Margin around a plan in its panel, for its labels (mm)."""
FEET = (-2.6 - 5j, 2.6 - 5j)
"""Distance from a fixed pivot to the feet of its support (mm)."""
SMALL = 6.0
"""Reach (mm) of a block around a point below which the point's name is placed outside the block."""
MACHINE = 120 + 110j
"""Approximate size of a machine on a screen (mm): letters and arrows of a larger one are enlarged as it is shrunk."""
MOST = 4.0
"""Largest factor by which they are enlarged."""
PANEL = 96 + 78j
"""Size of the panel of each plan (mm)."""
LEAST, FINER = 1 / 4, 3.0
"""A plan that fills less than the first share of its panel is drawn larger by the second factor."""
BAR = 0.3
"""Least share of its room that a scale bar takes."""
NO_UNITS: Mapping[str, str] = MappingProxyType({})
"""The empty table of units: each is written unchanged."""
TOGETHER = 1e-6
"""Values that vary by at most this share of the greatest are a constant."""


class Track:
    """Values over the samples of a turn or of the cycle, real or complex; a constant track has one value."""

    def __init__(self, values: np.ndarray) -> None:
        array = np.atleast_1d(np.asarray(values))
        finite = array[np.isfinite(array)]
        still = finite.size == array.size and np.abs(array - array[0]).max() <= TOGETHER * np.abs(array).max()
        self.values = array[:1] if still else array

    def __add__(self, other: Track) -> Track:
        return Track(self.values + other.values)


class Still(Record):
    """Items that do not move."""

    items: tuple[Item, ...]
    layer: str = ""


class MovingBody(Record):
    """Items in a frame that moves: its origin follows `at` and it turns by `angle` (rad)."""

    items: tuple[Item, ...]
    at: Track
    angle: Track | None = None
    layer: str = ""


class MovingVector(Record):
    """An arrow between two tracks, or with `head` 0 a line, extended by `beyond` mm at its end."""

    start: Track
    end: Track
    stroke: Pen
    head: float = style.HEAD
    label: Content | None = None
    name: str = ""
    layer: str = ""
    beyond: float = 0.0


class MovingName(Record):
    """A label that follows a track, on the side away from its `neighbours`."""

    content: Content
    at: Track
    neighbours: tuple[Track, ...] = ()
    gap: float = 1.0
    layer: str = ""


class Spot(Record):
    """A named point that displays its motion under the pointer.

    `on_stage` is its place on the drawing (mm); the other tracks are those of the machine: `place` (m), `velocity`
    (m/s) and `acceleration` (m/s²).
    """

    name: str
    on_stage: Track
    place: Track
    velocity: Track
    acceleration: Track


MovingItem = Still | MovingBody | MovingVector | MovingName


class BarScale(Record):
    """The scale of a drawing for a `kind` of quantity: `per` is the SI value that one millimetre represents.

    Its bar is visible with any of its `layers`, or always if it has none.
    """

    per: float
    kind: str
    layers: tuple[str, ...] = ()

    def bar(self, room: float, units: Mapping[str, str] = NO_UNITS) -> tuple[Number, float]:
        """Return the round value of a bar in a room of `room` mm, and the bar's length (mm).

        The value is in the unit of the kind, which `units` may translate; the bar takes at least `BAR` of the room.
        """
        how = KINDS[self.kind]
        value = nice_up(BAR * room * self.per / how.scale, (1.0, 2.0, 5.0))
        return Number(value, None, units.get(how.unit, how.unit)), value * how.scale / self.per


class Pane(Record):
    """A moving drawing, in mm, in the box from `low` to `high`, with its scales as bars below.

    With `finer`, one scale is used at a time, and `finer` is its index at each sample; the items are drawn at the first
    scale.
    """

    key: str
    title: str
    items: tuple[MovingItem, ...]
    low: complex
    high: complex
    scales: tuple[BarScale, ...]
    spots: tuple[Spot, ...] = ()
    finer: Track | None = None

    @property
    def enlargement(self) -> float:
        """Return the factor by which letters, arrowheads and pens of arrows are larger than in figures."""
        size = self.high - self.low
        return min(max(size.real / MACHINE.real, size.imag / MACHINE.imag, 1.0), MOST)


BARS, STRIP, UP = 2, 7.0, 1.5
"""Number of scale bars in a row, height of a row (mm), height of a bar above the lower edge of its row (mm)."""
TICK = 0.8
"""Half the length of the strokes at the ends of a scale bar (mm)."""


def scale_bars(pane: Pane, units: Mapping[str, str]) -> tuple[complex, list[tuple[BarScale, tuple[Item, ...]]]]:
    """Return the lower left corner (mm) of a pane with its bars, and a bar for each scale, its value above it.

    Bars of scales that alternate are at the same place.
    """
    enlargement, room = pane.enlargement, (pane.high - pane.low).real / BARS
    tick, stroke = 1j * TICK * enlargement, Pen(round(style.VISIBLE.width * enlargement, 3))
    bars: list[tuple[BarScale, tuple[Item, ...]]] = []
    for number, scale in enumerate(pane.scales):
        strip, column = divmod(0 if pane.finer else number, BARS)
        value, length = scale.bar(room, units)
        start = pane.low + (column * room + enlargement) - 1j * ((strip + 1) * STRIP - UP) * enlargement
        end = start + length
        strokes = ((start, end), (start - tick, start + tick), (end - tick, end + tick))
        label = Label(start + 1.5 * tick, value, "bottom-left", style.SMALL * enlargement)
        bars.append((scale, (*(Line(*ends, stroke) for ends in strokes), label)))
    strips = 1 if pane.finer else math.ceil(len(pane.scales) / BARS)
    return pane.low - 1j * strips * STRIP * enlargement, bars


class Curve(Record):
    """A curve of a chart: its label, and its values in the unit of its axis."""

    label: Content
    values: Track


class Chart(Record):
    """A chart with a cursor along the driver's travel.

    On the chart `of_run` the working point of the drive moves: the speed across, the torque upwards.
    """

    plotted: Plotted
    curves: tuple[Curve, ...]
    of_run: bool = False


class TimedRun(Record):
    """A motion that can be played in time: "steady", "start" or "stop".

    At the times t (s) [K] the driver has turned by the `angle` (degrees) [K] from the first position, which may exceed
    a cycle or be negative, and has the `speed` (rad/s) [K]; `drive` is the torque of the drive (N·m) [K].
    """

    key: str
    time: np.ndarray
    angle: np.ndarray
    speed: np.ndarray
    drive: np.ndarray


class MomentValue(Record):
    """A number that the page displays for the current moment: its symbol, its unit, its values in that unit."""

    symbol: Content
    unit: str
    values: Track
    decimals: int


class Errors(Record):
    """Largest errors from linear interpolation between samples."""

    place: float
    """Error of drawn points (mm)."""
    crank: float
    """Length of the drawn crank (mm), or the travel of a sliding driver."""
    share: float
    """Error of velocities, accelerations and forces as a share of their greatest value."""


class Animation(Record):
    """An animation in a panel of a page.

    `knots` are the samples of one turn in degrees, from 0 to 360; tracks of the cycle continue through all `turns`. The
    animation of a coursework's part has the part's `name` and `title`.
    """

    knots: np.ndarray
    turns: int
    span: float
    """The travel (mm) of a sliding driver, which replaces the turn; 0 for a crank."""
    positions: tuple[tuple[str, float], ...]
    """Label and cycle angle (degrees) of each numbered position."""
    opening: int
    """The index of the position at which the page opens."""
    panes: tuple[Pane, ...]
    charts: tuple[Chart, ...]
    values: tuple[MomentValue, ...]
    errors: Errors
    layers: tuple[str, ...] = ()
    """Layers that can be switched on: first those of `LAYERS`, then those of the topics."""
    name: str = ""
    title: str = ""
    runs: tuple[TimedRun, ...] = ()
    """Motions that can be played in real time, the steady one first; `()` without a drive."""
    units: Mapping[str, str] = field(default_factory=dict)
    """Units as the language writes them; a missing unit is written unchanged."""
    instants: tuple[float, ...] = ()
    """Driver coordinate of each single instant (degrees, or mm of a slide), at equally spaced knots."""


LAYERS = (*("paths", "velocities", "accelerations", "centres", "loads", "inertia", "weights", "reactions"),)
"""The layers of any machine; the first is visible from the start.  Topics add theirs."""


# --- drawings that move --------------------------------------------------------------------------------


def linkage_items(linkage: Linkage, motion: Motion, at: int, scale: float, looks: Looks) -> list[MovingItem]:
    """Return the items of a linkage in painting order, drawn as at the sample `at`, `scale` mm of paper per m."""
    bones = skeleton(linkage, motion, at, scale)
    places = {name: Track(point.p * scale) for name, point in motion.points.items()}
    frames = {link: (Track(motion.origins[link].p * scale), Track(motion.links[link].angle)) for link in linkage.links}
    parts = {
        link: parts_of(
            bones, link, looks, complex(motion.origins[link].p[at]) * scale, float(motion.links[link].angle[at])
        )
        for link in linkage.links
    }
    items: list[MovingItem] = [Still(ground_guides(bones, looks)), *_crank_circle(linkage, bones)]
    for coil in looks.coils:
        items += spring_items(coil, linkage, motion, at, scale, bones.pivots)
    for layer in ("rails", "bars", "blocks"):
        for link, (origin, angle) in frames.items():
            if drawn := getattr(parts[link], layer):
                items.append(MovingBody(drawn, origin, angle))
    items += [Still(style.pivot(bones.points[name])) for name in bones.pivots]
    joints = [name for name in bones.joints if name not in bones.pivots]
    items += [MovingBody((style.joint(0j),), places[name]) for name in joints]
    items += [MovingBody(style.mass_centre(0j), places[name]) for name in looks.centres]
    further = [name for name in places if name not in {*bones.joints, *looks.centres}]
    items += [MovingBody((style.point(0j),), places[name]) for name in further]
    items += [
        MovingName(
            vocabulary.point(name), place, tuple(_neighbours(name, bones, places)), _reach(name, bones, looks) + 0.5
        )
        for name, place in places.items()
    ]
    return items


def spring_items(
    coil: Coil, linkage: Linkage, motion: Motion, at: int, scale: float, pivots: Sequence[str]
) -> list[MovingItem]:
    """Return the items of a spring, `scale` mm of paper per m.

    A stretched spring is a zigzag between its ends; the ground at a fixed end is drawn as at the sample `at`, except at
    `pivots`.  A wound spring is a spiral that turns about its pin.
    """
    start, end = (place * scale for place in coil.at(motion))
    if coil.wound:
        turned = np.angle(end - start)
        known = np.isfinite(turned)
        turned[known] = np.unwrap(turned[known])
        behind = Track(start - spring_drawings.OUTER * np.exp(1j * turned))
        return [
            MovingBody((spring_drawings.spiral(),), Track(start), Track(turned)),
            MovingName(spring_drawings.named(coil), behind, (Track(start),)),
        ]
    corners = list(map(Track, spring_drawings.zigzag(start, end)))
    ground = spring_drawings.mounts(coil, linkage, complex(start[at]), complex(end[at]), pivots)
    return [
        Still(tuple(ground)),
        *(MovingVector(*ends, style.VISIBLE, 0.0) for ends in pairwise(corners)),
        MovingName(
            spring_drawings.named(coil), Track((start + end) / 2), (corners[0], corners[-1]), spring_drawings.SIDE + 0.5
        ),
    ]


def _crank_circle(linkage: Linkage, bones: Skeleton) -> list[MovingItem]:
    driver = linkage.driver
    if not isinstance(driver, Crank):
        return []
    centre = bones.points[driver.centre]
    return [Still((Circle(centre, abs(bones.points[driver.pin] - centre), style.THIN),))]


def _reach(name: str, bones: Skeleton, looks: Looks) -> float:
    """Return the reach of a point's sign (mm): its joint, or a small block about it."""
    blocks = (max(looks.block(slide.link)) / 2 for slide in bones.slides if abs(slide.at - bones.points[name]) < 1.0)
    return max((reach for reach in blocks if reach < SMALL), default=style.JOINT)


def _neighbours(name: str, bones: Skeleton, places: dict[str, Track]) -> Iterable[Track]:
    """Return the points that bars connect to a point, and its support: its label keeps away from them."""
    if name in bones.pivots:
        yield from (Track(places[name].values + foot) for foot in FEET)
    for link, joints in bones.bars.items():
        own = [*joints, *(point for point, owner in bones.owners.items() if owner == link and point not in joints)]
        if name in own:
            yield from (places[other] for other in own if other != name)


def path_items(linkage: Linkage, motion: Motion, names: Sequence[str], scale: float) -> list[MovingItem]:
    """Return the curves that the points `names` trace, at `scale` mm of paper per m, on the layer "paths".

    Positions that the mechanism cannot reach are left out.
    """
    curves: list[MovingItem] = []
    for name in names:
        curve = motion.points[name].p[motion.reachable] * scale
        curves.append(Still((Polyline(tuple(complex(p) for p in curve), style.PATH),), "paths"))
    return curves


def plan_items(plan: Construction[str], tracks: Mapping[str, Track]) -> list[MovingItem]:
    """Return the items of a moving plan; each of its corners follows the track of the same name (mm)."""
    items: list[MovingItem] = [
        MovingVector(tracks[line.start], tracks[line.end], style.CONSTRUCTION, 0.0, beyond=BEYOND)
        for line in plan.lines
    ]
    items += [
        MovingVector(tracks[vector.start], tracks[vector.end], PENS[vector.style], label=vector.label, name=vector.name)
        for vector in plan.vectors
    ]
    if plan.pole:
        items.append(MovingBody((Circle(0j, 0.7, Pen(0.25), style.PAPER),), tracks[plan.points[0].at]))
    return items + _names(plan, tracks, 0.9)


def lever_items(plan: Construction[str], tracks: Mapping[str, Track]) -> list[MovingItem]:
    """Return the items of a plan drawn as a rigid lever about its pole; its corners follow the `tracks` (mm)."""
    items: list[MovingItem] = [
        MovingVector(tracks[vector.start], tracks[vector.end], style.VISIBLE, 0.0) for vector in plan.vectors
    ]
    pole, *others = plan.points
    items += [MovingBody((Circle(0j, 0.7, style.VISIBLE, style.PAPER),), tracks[point.at]) for point in others]
    items.append(MovingBody((Circle(0j, 1.1, style.VISIBLE, style.PAPER),), tracks[pole.at]))
    return items + _names(plan, tracks, 1.3)


def _names(plan: Construction[str], tracks: Mapping[str, Track], gap: float) -> list[MovingItem]:
    """Return the names of a plan's points, each on the side away from the vectors that meet there."""
    joined: dict[str, list[Track]] = {}
    for vector in plan.vectors:
        joined.setdefault(vector.start, []).append(tracks[vector.end])
        joined.setdefault(vector.end, []).append(tracks[vector.start])
    named = dict.fromkeys((point.label, point.at) for point in plan.points)
    return [MovingName(label, tracks[at], tuple(joined.get(at, ())), gap) for label, at in named]


class Fitted(Record):
    """Moving corners that fit a panel.

    `tracks` are their places (mm from the panel's middle) at the first of the `scales`; `finer` is 1 at samples that
    use the second, finer scale, and None if none does.
    """

    tracks: Mapping[str, Track]
    scales: tuple[BarScale, ...]
    finer: Track | None


def fitted(corners: Mapping[str, np.ndarray], kind: str, turn: int, scale: float | None = None) -> Fitted:
    """Fit corners [N] or [1] (SI) into the panel at one scale, with the corners of each sample in its middle.

    A sample that would be too small to read uses a finer scale.  The tracks keep the first `turn` samples.  A given
    `scale` (SI per mm) replaces the scale at which the largest sample fills the panel.
    """
    length = max(corner.size for corner in corners.values())
    places = np.array([np.broadcast_to(corner, length) for corner in corners.values()])
    known = np.where(np.isfinite(places), places, 0.0)
    low = known.real.min(axis=0) + 1j * known.imag.min(axis=0)
    high = known.real.max(axis=0) + 1j * known.imag.max(axis=0)
    room, size = PANEL - 2 * complex(MARGIN, MARGIN), high - low
    needed = np.maximum(size.real / room.real, size.imag / room.imag)
    per = scale or float(needed.max()) or 1.0
    placed = (places - (low + high) / 2) / per
    small = Track((needed < LEAST * per).astype(float))
    scales = BarScale(per, kind), BarScale(per / FINER, kind)
    tracks = {name: Track(place[:turn]) for name, place in zip(corners, placed, strict=True)}
    return Fitted(tracks, scales, small) if small.values.any() else Fitted(tracks, scales[:1], None)


def extent(items: Iterable[MovingItem]) -> tuple[complex, complex]:
    """Return the lower left and upper right corner (mm) of all that the items ever cover, with room for labels.

    Bodies and vectors on a layer, which can be switched off, and names are ignored.
    """
    points: list[complex] = []
    for item in items:
        match item:
            case Still(still) if still:
                points += bounds(still)
            case MovingBody(carried, at, angle) if not item.layer:
                low, high = bounds(carried)
                turned = np.exp(1j * angle.values) if angle is not None else np.array([1.0])
                box = (low, high, complex(low.real, high.imag), complex(high.real, low.imag))
                points += [p for corner in box for p in _corners(Track(at.values + corner * turned))]
            case MovingVector(start, end) if not item.layer:
                points += [*_corners(start), *_corners(end)]
            case _:
                pass
    array = np.array(points)
    room = complex(ROOM, ROOM)
    low, high = complex(array.real.min(), array.imag.min()), complex(array.real.max(), array.imag.max())
    return low - room, high + room


def _corners(track: Track) -> tuple[complex, complex]:
    values = track.values[np.isfinite(track.values)]
    if not values.size:
        return 0j, 0j
    return complex(values.real.min(), values.imag.min()), complex(values.real.max(), values.imag.max())
