"""The indicator diagram beside its cylinder: stroke in line with and in the scale of the piston's way.

It is drawn in the coordinates of the position plan, so that a line across from the piston meets the
curve at the piston's own position.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from reportgen.figures import style
from reportgen.figures.draft import Draft
from reportgen.figures.geometry import clusters, unit
from reportgen.figures.labels import CLEAR, joined, label
from reportgen.figures.metrics import box
from reportgen.figures.scene import Arrow, Circle, Content, Item, Label, Line, Polyline, Stroke
from reportgen.notation.numbers import nice_up

STROKES = (
    Stroke(0.35, style.BLUE, style.CHAIN),
    Stroke(0.25, style.BLACK),
    Stroke(0.5, style.RED),
    Stroke(0.35, style.BLACK, style.DASHED),
)
"""Pens of the branches in their order, told apart by dashes and width as well as by colour."""
WIDTH = 80.0
"""Of the diagram at most, mm."""
NARROW, SHAPE = 46.0, 1.5
"""On a sheet it is so wide at least (mm), and so many times as wide as high at most."""
AWAY = 0.94
"""How far beside the cylinder it stands, in its widths."""
AXIS_PEN = Stroke(0.2)
TICK = 1.0


@dataclass(frozen=True, slots=True)
class Branch:
    """One stroke's line: fractions of the stroke from the top dead centre and pressures (any one unit)."""

    label: Content
    fraction: tuple[float, ...]
    pressure: tuple[float, ...]


@dataclass(frozen=True, slots=True)
class Reading:
    """A numbered position on the diagram: where it is read, and the place it is projected from (mm)."""

    label: Content
    fraction: float
    pressure: float
    from_point: complex | None = None


@dataclass(frozen=True, slots=True)
class Frame:
    """Where the diagram stands, in mm: its stroke axis runs from `top` to `bottom`, pressure along `side`.

    `scale` is μ_p, pressure per mm; `axis` and `note` are the label of the pressure axis and the
    printed scale.
    """

    top: complex
    bottom: complex
    side: complex
    scale: float
    axis: Content = ""
    note: Content = ""

    def at(self, fraction: float, pressure: float) -> complex:
        """The place on paper of a fraction of the stroke and a pressure."""
        way = self.bottom - self.top
        return self.top + fraction * way + unit(self.side) * pressure / self.scale


def beside(
    top: complex, bottom: complex, side: complex, highest: float, enlarged: float | None = None
) -> tuple[complex, complex, float]:
    """The ends of the diagram's axis beside the cylinder, and the μ_p that makes it fit.

    μ_p is round once the drawing is `enlarged` so many times, as on a drawing sheet; there the diagram is no wider than
    goes with its stroke.
    """
    width = WIDTH
    if enlarged is not None:
        width = min(WIDTH, max(NARROW, SHAPE * abs(top - bottom)))
    else:
        enlarged = 1.0
    away = unit(side) * AWAY * width
    return top + away, bottom + away, nice_up(highest / width / enlarged) * enlarged


def indicator(frame: Frame, branches: Sequence[Branch], readings: Sequence[Reading] = ()) -> Draft:
    """The diagram with its branches named, its readings numbered and projected from the slider."""
    pressures = [p for branch in branches for p in branch.pressure]
    lowest, highest = min([0.0, *pressures]), max([0.0, *pressures])
    items = [*_diagram_axes(frame, lowest, highest), *_projections(frame, readings)]
    requests = []
    for n, branch in enumerate(branches):
        points = tuple(frame.at(x, p) for x, p in zip(branch.fraction, branch.pressure, strict=True))
        items.append(Polyline(points, STROKES[n % len(STROKES)]))
        requests.append(label(_along(points), branch.label, size=style.SMALL))
    read = [(frame.at(reading.fraction, reading.pressure), reading.label) for reading in readings]
    items += [Circle(at, 0.5, Stroke(0.2), style.PAPER) for at, _ in read]
    for group in clusters(read, 0.3, lambda one: one[0]):
        numbers = joined(number for _, number in group)
        outward = (cmath.phase(unit(frame.side)),)
        requests.append(label(group[0][0], *numbers, prefer=outward, gap=0.9, size=style.SMALL))
    if frame.axis:
        tip = frame.at(0.0, highest) + 12 * unit(frame.side)
        requests.append(label(tip, frame.axis, prefer=(cmath.phase(frame.top - frame.bottom),), gap=1.0))
    if frame.note:
        middle = frame.at(1.0, (highest + lowest) / 2)
        requests.append(label(middle, frame.note, prefer=(-math.pi / 2,), gap=8))
    return Draft(tuple(items), tuple(requests))


def _diagram_axes(frame: Frame, lowest: float, highest: float) -> list[Item]:
    """The stroke axis at p = 0, the pressure axis at the top dead centre with ticks, limits dashed."""
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
        # The box's half size across the axis: a wide number beside an upright axis stands farther off.
        half = (abs(across.real) * extent.width + abs(across.imag) * (extent.height + extent.depth)) / 2
        items.append(Label(at + across * (TICK + CLEAR + half), number, "center", style.SMALL))
    return items


def _projections(frame: Frame, readings: Sequence[Reading]) -> list[Item]:
    """Thin lines from the slider's places to the farthest reading at each."""
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
    """Places along a polyline at even shares of its length, the middle ones first."""
    p = np.asarray(points)
    way = np.concatenate(([0.0], np.cumsum(np.abs(np.diff(p)))))
    shares = np.array([0.5, 0.4, 0.6, 0.3, 0.7, 0.2, 0.8, 0.12, 0.88]) * way[-1]
    return [complex(q) for q in np.interp(shares, way, p.real) + 1j * np.interp(shares, way, p.imag)]
