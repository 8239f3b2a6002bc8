"""The indicator diagram beside its cylinder: its stroke axis has the direction and scale of the piston's travel.

It is drawn in the coordinates of the position plan, so that a perpendicular line from the piston meets the curve at the
piston's position.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable, Iterator, Sequence

import numpy as np

from reportgen.base.records import Record
from reportgen.base.stable_digits import settled
from reportgen.base.units import nice_up
from reportgen.drawing import Arrow, Circle, Content, Item, Label, Line, Pen, Polyline, Scene, style
from reportgen.drawing.canvas import Canvas
from reportgen.drawing.drawing_description import Fact, fact
from reportgen.drawing.geometry import clusters, unit
from reportgen.drawing.label_candidates import CLEAR
from reportgen.drawing.label_size import box
from reportgen.drawing.labels import LEFT_OUT, joined, label
from reportgen.formula import Number

TOGETHER = 0.3
"""Readings nearer to one another than this (mm of paper) share a label."""

STROKES = (
    Pen(0.35, style.BLUE, style.CHAIN),
    Pen(0.25, style.BLACK),
    Pen(0.5, style.RED),
    Pen(0.35, style.BLACK, style.DASHED),
)
"""Pens of the branches in order, distinguished by dashes and width as well as by colour."""
WIDTH = 80.0
"""Largest width of the diagram (mm)."""
AWAY = 0.94
"""Distance from the cylinder, in widths of the diagram."""
AXIS_PEN = Pen(0.2)
TICK = 1.0
"""Length of a tick (mm)."""
READ = 4
"""Digits of a pressure that is read from the diagram."""


class Branch(Record):
    """One stroke's line: fractions of the stroke from the top dead centre [K] and pressures [K] (any one unit)."""

    label: Content
    fraction: tuple[float, ...]
    pressure: tuple[float, ...]


class Reading(Record):
    """A numbered position on the diagram: its reading, and the place from which it is projected (mm), or None."""

    label: Content
    fraction: float
    pressure: float
    from_point: complex | None = None


ReadingGroup = Sequence[Reading]
"""Readings whose numbers are side by side in one label."""


class ChartFrame(Record):
    """Position of the diagram in mm: its stroke axis runs from `top` to `bottom`, pressure along `side`.

    `scale` is μ_p, pressure per mm; `axis` and `note` are the label of the pressure axis and the printed scale.
    """

    top: complex
    bottom: complex
    side: complex
    scale: float
    axis: Content = ""
    note: Content = ""

    def at(self, fraction: float, pressure: float) -> complex:
        """Return the place on paper (mm) of a fraction of the stroke and a pressure."""
        axis = self.bottom - self.top
        return self.top + fraction * axis + unit(self.side) * pressure / self.scale

    def of(self, reading: Reading) -> complex:
        """Return the place on paper (mm) of a reading."""
        return self.at(reading.fraction, reading.pressure)


def beside(
    top: complex, bottom: complex, side: complex, highest: float, enlarged: float = 1.0
) -> tuple[complex, complex, float]:
    """Return the ends (mm) of the diagram's stroke axis beside the cylinder, and the round μ_p (Pa/mm) that fits.

    `top` and `bottom` are the dead centres (mm), `side` is the direction away from the cylinder (any length), and
    `highest` is the greatest pressure (Pa).  μ_p is that of the drawing after enlargement by `enlarged`.
    """
    away = unit(side) * AWAY * WIDTH / enlarged
    return top + away, bottom + away, nice_up(highest / WIDTH)


def indicator(
    frame: ChartFrame,
    branches: Sequence[Branch],
    readings: Sequence[Reading] = (),
    groups: Sequence[ReadingGroup] | None = None,
) -> Canvas:
    """Draw the diagram with its branches named, its readings numbered and projected from the slider.

    Readings of one of the `groups`, or without groups those at one place, share a label.
    """
    pressures = [p for branch in branches for p in branch.pressure]
    lowest, highest = min([0.0, *pressures]), max([0.0, *pressures])
    items = [*_diagram_axes(frame, lowest, highest), *_projections(frame, readings)]
    requests = []
    for n, branch in enumerate(branches):
        points = tuple(frame.at(x, p) for x, p in zip(branch.fraction, branch.pressure, strict=True))
        items.append(Polyline(points, STROKES[n % len(STROKES)]))
        requests.append(label(_along(points), branch.label, size=style.SMALL))
    items += [Circle(frame.of(reading), 0.5, Pen(0.2), style.PAPER) for reading in readings]
    outward = (cmath.phase(unit(frame.side)),)
    for group in clusters(readings, TOGETHER, frame.of) if groups is None else groups:
        places, numbers = [frame.of(reading) for reading in group], joined(reading.label for reading in group)
        requests.append(label(places, *numbers, prefer=outward, gap=0.9, size=style.SMALL, each=True, short=LEFT_OUT))
    if frame.axis:
        tip = frame.at(0.0, highest) + 12 * unit(frame.side)
        requests.append(label(tip, frame.axis, prefer=(cmath.phase(frame.top - frame.bottom),), gap=1.0))
    if frame.note:
        middle = frame.at(1.0, (highest + lowest) / 2)
        requests.append(label(middle, frame.note, prefer=(-math.pi / 2,), gap=8))
    return Canvas(tuple(items), tuple(requests), tuple(_branch_facts(frame, branches)))


MOST_TOGETHER = 6
"""Largest number of readings in one label: with more, it would not be clear which reading is which."""


def all_numbered(
    draw: Callable[[Sequence[ReadingGroup]], Scene], frame: ChartFrame, readings: Sequence[Reading]
) -> Scene:
    """Return a scene with the number of every reading; a number without room joins its neighbours' label.

    `draw` makes it from groups of readings that share a label.  A group without room joins the nearest placed group
    that is not full, repeatedly, until every number is placed or none can move.
    """
    groups = clusters(readings, TOGETHER, frame.of)
    while True:
        scene = draw(groups)
        labelled = {item.content for item in scene.items if isinstance(item, Label)}
        placed = [list(group) for group in groups if group[0].label in labelled]
        left = []
        for missing in (group for group in groups if group[0].label not in labelled):
            fitting = [group for group in placed if len(group) + len(missing) <= MOST_TOGETHER]
            if not fitting:
                left.append(missing)
                continue
            nearest = min(
                fitting, key=lambda group: settled(min(abs(frame.of(a) - frame.of(b)) for a in group for b in missing))
            )
            nearest += missing
        if len(placed) + len(left) == len(groups):
            return scene
        groups = [*placed, *left]


def _branch_facts(frame: ChartFrame, branches: Sequence[Branch]) -> Iterator[Fact]:
    """Yield the facts of the diagram: its axis and scale, and each branch's pressure at its beginning and end."""
    if frame.axis:
        yield fact("pressure", frame.axis)
    for branch in branches:
        ends = (Number(float(f"{branch.pressure[end]:.{READ}g}")) for end in (0, -1))
        yield fact("branch", branch.label, *ends)
    if frame.note:
        yield fact("scale", frame.note)


def _diagram_axes(frame: ChartFrame, lowest: float, highest: float) -> list[Item]:
    """Return the stroke axis at p = 0, the pressure axis at the top dead centre with ticks, and dashed limits."""
    u = unit(frame.side)
    across = unit(frame.top - frame.bottom)
    over = 10 * u
    step = nice_up((highest - lowest) / 6)
    items: list[Item] = [
        Line(frame.top, frame.bottom, AXIS_PEN),
        Arrow(frame.at(0, min(lowest, 0)), frame.at(0, highest) + over, AXIS_PEN, 2.2),
        Line(frame.at(1, min(lowest, 0)), frame.at(1, highest) + 0.5 * over, style.AXIS),
    ]
    for k in range(1, int(highest / step + 1e-9) + 1):
        at = frame.at(0, k * step)
        items.append(Line(at, at + across * TICK, AXIS_PEN))
        number = f"{k * step:g}"
        extent = box(number, style.SMALL)
        # The box's half size across the axis: a wide number is farther away from a vertical axis.
        half = (abs(across.real) * extent.width + abs(across.imag) * (extent.height + extent.depth)) / 2
        items.append(Label(at + across * (TICK + CLEAR + half), number, "center", style.SMALL))
    return items


def _projections(frame: ChartFrame, readings: Sequence[Reading]) -> list[Item]:
    """Return thin lines from the slider's places to the farthest reading at each."""
    farthest: dict[complex, complex] = {}
    for reading in readings:
        if reading.from_point is None:
            continue
        to = frame.at(reading.fraction, reading.pressure)
        key = next((p for p in farthest if abs(p - reading.from_point) < 0.05), reading.from_point)
        if key not in farthest or abs(to - key) > abs(farthest[key] - key):
            farthest[key] = to
    return [Line(start, end, style.CONSTRUCTION) for start, end in farthest.items()]


def _along(points: Sequence[complex]) -> list[complex]:
    """Return places along a polyline at equal shares of its length, the middle ones first."""
    p = np.asarray(points)
    lengths = np.concatenate(([0.0], np.cumsum(np.abs(np.diff(p)))))
    shares = np.array([0.5, 0.4, 0.6, 0.3, 0.7, 0.2, 0.8, 0.12, 0.88]) * lengths[-1]
    return [complex(q) for q in np.interp(shares, lengths, p.real) + 1j * np.interp(shares, lengths, p.imag)]
