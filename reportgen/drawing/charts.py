"""Charts on paper: curves over the driver's angle (`chart`), and the polar diagram of a load (`polar`)."""

from __future__ import annotations

import cmath
import math
import re
from collections.abc import Sequence
from itertools import chain, count

import numpy as np
from numpy.typing import ArrayLike, NDArray

from reportgen.base.records import Record, replace
from reportgen.base.stable_digits import ALIKE, first_greatest, first_least, settled
from reportgen.base.units import nice_up
from reportgen.drawing import (
    Arc,
    Circle,
    Content,
    Diagram,
    Item,
    Label,
    Line,
    Pen,
    PlottedCurve,
    Polyline,
    Scene,
    style,
)
from reportgen.drawing.canvas import Canvas, finish
from reportgen.drawing.chart_data import Inclination
from reportgen.drawing.drawing_description import of_chart, of_hodograph
from reportgen.drawing.geometry import clusters
from reportgen.drawing.label_size import box
from reportgen.drawing.labels import LEFT_OUT, Request, joined, label
from reportgen.formula import Chain, Number, Symbol

WIDTH, HEIGHT = 128.0, 62.0
"""The area inside the axes of curves (mm); with its text a chart is about 150 × 85 mm."""
LOW = 46.0
"""The height of that area for low charts (mm)."""
SHEET_WIDTH, SHEET_HEIGHT = 90.0, 45.0
"""Largest size of that area on a drawing sheet (mm)."""
HALF_WIDTH, HALF_HEIGHT = 78.0, 46.0
"""Width of a chart with its text and height of its area, for two charts side by side (mm)."""
CHART_MARGIN = 1.5
AXIS_NAME = 8.0
"""Width of the vertical name of an axis beside its numbers (mm)."""
LINE = 4.5
"""Line spacing of that name (mm)."""
POLAR_SIZE = 84.0
"""Largest size of a single polar diagram in either direction (mm)."""
POLAR_PAIRS = 58.0, 54.0, 50.0
"""Sizes of two polar diagrams side by side, if they are narrow enough (mm)."""
PENS = (
    Pen(0.4, style.BLUE),
    Pen(0.4, style.RED, style.DASHED),
    Pen(0.4, style.BLACK, style.CHAIN),
    Pen(0.4, style.GRAY, style.DOTTED),
)
"""Pens of the curves in order, distinguished by dashes as well as by colour."""
GRID = Pen(0.1, style.PALE)
EDGE = Pen(0.25)
MEAN = Pen(0.25, style.BLACK, (4.0, 1.0, 0.8, 1.0))
BEYOND = 4.0
"""Length of the horizontal side of an angle beyond its arc (mm)."""
MARK, DOT = 0.75, 0.45
"""Radius of the circle at a marked point, and of a measured point (mm)."""
TICKS = 6
"""Approximate number of steps of an axis of a polar diagram or of counts."""
MOST_TURNED = 10
"""Largest number of steps of an axis of angles."""
LEAST_POWER = 12
"""Powers of ten in the search for the steps of an axis of angles; shorter ranges are within rounding errors."""
BETWEEN = 1.0
"""Least gap between the numbers of an axis (mm)."""

STEPS = (1.0, 2.0, 2.5, 5.0)
"""Steps of the ticks of curves, times a power of ten."""
CLOSE = 0.025
"""Points of a curve nearer than this (mm) to the line through others are left out: a sixteenth of the pen's width."""
TINY = 1e-12
"""Square of a length (mm²) that counts as 0."""

Vertices = NDArray[np.float64]


class Area(Record):
    """The room inside the axes that a chart may fill (mm), at round scales, which are printed.

    Room and scales are those of the chart after enlargement by `enlarged`.  `scales` across and upwards, in the units
    of the axes per mm, are kept whatever room they need.  `mm` is the language's unit symbol for millimetre.
    """

    width: float = SHEET_WIDTH
    height: float = SHEET_HEIGHT
    enlarged: float = 1.0
    scales: tuple[float, float] | None = None
    mm: str = "mm"

    def per_mm(self, length: float, room: float) -> float:
        """Return the round scale of the enlarged chart at which a length in the unit of its axis fits a room (mm)."""
        return nice_up(length / room)


class _Window(Record):
    """Data ranges and the size of their paper: x0…x1 over `width` mm, y0…y1 over `height` mm."""

    x: tuple[float, float]
    y: tuple[float, float]
    width: float
    height: float

    def vertices(self, x: ArrayLike, y: ArrayLike) -> Vertices:
        """Return points on paper (mm) [K, 2] for x [K] and y [K]; NaN stays NaN, a gap."""
        across = (np.asarray(x, dtype=np.float64) - self.x[0]) / (self.x[1] - self.x[0]) * self.width
        up = (np.asarray(y, dtype=np.float64) - self.y[0]) / (self.y[1] - self.y[0]) * self.height
        return np.column_stack((across, up))

    def at(self, x: float, y: float) -> complex:
        """Return the point on paper (mm) of x and y in the units of the axes."""
        across, up = self.vertices([x], [y])[0]
        return complex(across, up)


class Plotted(Record):
    """A chart with its coordinates: the corners of its axes on the scene (mm), and the values there."""

    scene: Scene
    low: complex
    high: complex
    x: tuple[float, float]
    y: tuple[float, float]


def chart(diagram: Diagram, *, half: bool = False, area: Area | None = None) -> Scene:
    """Return the scene (mm) of a diagram; see `plotted`."""
    return plotted(diagram, half=half, area=area).scene


def plotted(diagram: Diagram, *, half: bool = False, height: float = HEIGHT, area: Area | None = None) -> Plotted:
    """Draw a diagram on paper and return its scene with the coordinates of its axes.

    If x is an angle, its ticks are those of `angle_ticks`.  The area inside the axes is `height` mm high.  With `half`,
    two charts fit side by side; with an `area`, both scales are round and printed.  Raises `ValueError` if no x or no
    value is finite.
    """
    series, turn, levels = diagram.curves, diagram.turn, diagram.levels
    window, x_ticks, y_ticks = _window(
        series, [level for level, _ in levels], turn, half, area, height, zero=diagram.zero
    )
    items = _frame(window, x_ticks, y_ticks, "°" if turn else "")
    requests: list[Request] = []
    for level, name in levels:
        start, end = window.at(window.x[0], level), window.at(window.x[1], level)
        items.append(Line(start, end, MEAN))
        places = [start + (end - start) * share for share in (0.97, 0.9, 0.06, 0.5, 0.25, 0.75)]
        requests.append(label(places, name, prefer=(math.pi / 2, -math.pi / 2)))
    for n, curve in enumerate(series):
        vertices = window.vertices(curve.x, curve.y)
        pen = PENS[n % len(PENS)]
        if curve.dots:
            items += [Circle(complex(*at), DOT, None, pen.colour) for at in vertices if np.isfinite(at).all()]
        else:
            items += [Polyline(points, pen) for points in _paths(vertices)]
        requests += _marked(curve, vertices, pen, items)
        if curve.label and len(series) > 1:
            requests.append(label(_places(vertices), curve.label))
    for inclination in diagram.inclinations:
        drawn, request = _inclined(window, inclination)
        items += drawn
        requests.append(request)
    items += _titles(window, diagram.x, diagram.y, items, area is not None)
    notes: Sequence[Content] = ()
    if area is not None:
        across, up = window.width * area.enlarged, window.height * area.enlarged
        notes = _scale(diagram.x, window.x, across, area.mm, turn), _scale(diagram.y, window.y, up, area.mm)
    draft = Canvas(tuple(items), tuple(requests), tuple(of_chart(diagram, window.x, window.y)))
    scene = replace(finish(draft, notes=notes, margin=CHART_MARGIN), diagram=diagram)
    # The frame is the first closed line; finishing moves all items alike.
    frame = next(item for item in scene.items if isinstance(item, Polyline) and item.closed)
    return Plotted(scene, frame.points[0], frame.points[2], window.x, window.y)


def polar(diagram: Diagram, *, size: float = POLAR_SIZE, area: Area | None = None) -> Scene:
    """Draw hodographs of vectors (x, y) about the pole at equal scales, with their marks and the names of the axes.

    The longer side inside the axes is `size` mm; with an `area`, which replaces `size`, the scale is round and printed.
    Curves of `dots` have only their marks.  A load that is zero throughout is a dot at the pole.
    """
    x, y = (
        np.concatenate([np.asarray(getattr(curve, axis), dtype=np.float64) for curve in diagram.curves])
        for axis in "xy"
    )
    extent = float(np.nanmax([0.0, *x, *y]) - np.nanmin([0.0, *x, *y]))
    step = nice_up(extent / TICKS, (1, 2, 5)) if extent > 0 else 1.0
    x_ticks, y_ticks = (_around(min(0.0, float(np.nanmin(of))), max(0.0, float(np.nanmax(of))), step) for of in (x, y))
    (x0, *_, x1), (y0, *_, y1) = x_ticks, y_ticks
    per = size / max(x1 - x0, y1 - y0)
    if area is not None:
        per = 1 / area.per_mm(max((x1 - x0) / area.width, (y1 - y0) / area.height), 1.0) / area.enlarged
    window = _Window((x0, x1), (y0, y1), (x1 - x0) * per, (y1 - y0) * per)
    items = _frame(window, x_ticks, y_ticks, "")
    items += [Line(window.at(x0, 0), window.at(x1, 0), EDGE), Line(window.at(0, y0), window.at(0, y1), EDGE)]
    requests: list[Request] = []
    for n, curve in enumerate(diagram.curves):
        vertices, pen = window.vertices(curve.x, curve.y), PENS[n % len(PENS)]
        items += [] if curve.dots else [Polyline(points, pen) for points in _paths(vertices)]
        requests += _marked(curve, vertices, pen, items)
        if curve.label and len(diagram.curves) > 1:
            requests.append(label(_places(vertices), curve.label))
    items.append(Circle(window.at(0, 0), MARK, EDGE, style.PAPER))
    items += _titles(window, diagram.x, diagram.y, items, area is not None)
    notes = () if area is None else (_scale(diagram.x, window.x, window.width * area.enlarged, area.mm),)
    draft = Canvas(tuple(items), tuple(requests), tuple(of_hodograph(diagram, window.x, window.y)))
    scene = finish(draft, notes=notes, title=diagram.title, margin=2.0)
    return replace(scene, diagram=diagram)


# --- curves ---------------------------------------------------------------------------------------


def _window(
    series: Sequence[PlottedCurve],
    levels: Sequence[float],
    turn: bool,
    half: bool,
    area: Area | None,
    height: float = HEIGHT,
    *,
    zero: bool = True,
) -> tuple[_Window, list[float], list[float]]:
    """Return the window, and ticks across and upwards: for an angle those of `angle_ticks`, otherwise of a
    round step.
    """
    x = np.concatenate([np.asarray(one.x, dtype=np.float64) for one in series])
    values = np.concatenate([np.asarray(one.y, dtype=np.float64) for one in series])
    if not (np.isfinite(x).any() and np.isfinite(values).any()):
        raise ValueError("a chart needs finite values")
    y = np.concatenate((values, [0.0] if zero else [], levels))
    x0, x1 = float(np.nanmin(x)), float(np.nanmax(x))
    y_ticks = _ticks(float(np.nanmin(y)), float(np.nanmax(y)), 6 if half else 7)
    if turn:
        x_ticks = angle_ticks(x0, x1, MOST_TURNED // 2 if half else MOST_TURNED)
    else:
        x_ticks = _ticks(x0, x1, 5 if half else 9)
        x0, x1 = x_ticks[0], x_ticks[-1]
    across, up = x1 - x0, y_ticks[-1] - y_ticks[0]
    if area is not None:
        scales = area.scales or (area.per_mm(across, area.width), area.per_mm(up, area.height))
        width, height = across / scales[0] / area.enlarged, up / scales[1] / area.enlarged
    else:
        width, height = (HALF_WIDTH - _beside(x_ticks, y_ticks), HALF_HEIGHT) if half else (WIDTH, height)
    return _Window((x0, x1), (y_ticks[0], y_ticks[-1]), width, height), x_ticks, y_ticks


def _scale(label: Content, ends: tuple[float, float], length: float, mm: str, degrees: bool = False) -> Content:
    """Return the scale of an axis: μ_M = 2 N·m/mm, for the name of the axis "M (N·m; positive: …)"."""
    named = label.parts[0] if isinstance(label, Chain) else None
    symbol = Symbol("μ", named.base) if isinstance(named, Symbol) else Symbol("μ")
    text = label.note if isinstance(label, Chain) else str(label)
    unit = "°" if degrees else re.split("[;；]", text)[0].replace("，", ", ").rpartition(", ")[2]
    above, stroke, below = unit.partition("/")
    below = below.strip("()")
    # A number in the unit would be read as part of the scale's number.
    per_mm = f"{above}/({below}·{mm})" if stroke else f"{above}/{mm}" if above else f"{mm}⁻¹"
    return Chain((symbol, Number(float(f"{(ends[1] - ends[0]) / length:.9g}"), unit=per_mm)))


def _beside(x_ticks: Sequence[float], y_ticks: Sequence[float]) -> float:
    """Return the width that figures and the turned name of a chart take left and right of its frame (mm)."""
    widest = max(box(_figure(tick, y_ticks, ""), style.SMALL).width for tick in y_ticks)
    last = box(_figure(x_ticks[-1], x_ticks, "°"), style.SMALL).width
    return widest + AXIS_NAME + last / 2 + 2 * CHART_MARGIN


def _ticks(low: float, high: float, most: int) -> list[float]:
    """Return ticks at round steps that enclose a range, with about `most` steps at most.

    Ends that differ only by rounding are a single value, which gets one step of its size.
    """
    size = max(abs(low), abs(high))
    if high - low > ALIKE * size:
        return _around(low, high, nice_up((high - low) / most, STEPS))
    level = (low + high) / 2
    return _around(level, level, nice_up(size / most, STEPS) if size > 0 else 1.0)


def angle_ticks(low: float, high: float, most: int) -> list[float]:
    """Return at least three ticks (degrees) within a range.

    The step is 45°, doubled until there are at most `most` steps.  For a range too short for three such ticks it is
    the largest of 30°, 15°, 10°, 5°, 2°, 1°, 0.5°, … that gives three; if none does, the two ends are returned.
    """

    def within(step: float) -> list[float]:
        slack = 1e-6 * step
        return [tick for tick in _around(low, high, step) if low - slack <= tick <= high + slack]

    step = next(step for step in (45.0 * 2**k for k in count()) if high - low <= most * step)
    finer = chain((step, 30.0, 15.0), (size * 10.0**-k for k in range(LEAST_POWER) for size in (10.0, 5.0, 2.0)))
    return next((ticks for ticks in map(within, finer) if len(ticks) > 2), [low, high])


def _around(low: float, high: float, step: float) -> list[float]:
    """Return multiples of a step that enclose a range; at least one step."""
    first, last = math.floor(low / step + 1e-9), math.ceil(high / step - 1e-9)
    return [k * step for k in range(first, max(last, first + 1) + 1)]


def _frame(window: _Window, x_ticks: Sequence[float], y_ticks: Sequence[float], unit: str) -> list[Item]:
    """Return the frame with its grid and its figures; the line of y = 0 is emphasised."""
    items: list[Item] = []
    figured = _with_room(window, x_ticks, unit)
    for tick in x_ticks:
        foot = window.at(tick, window.y[0])
        items.append(Line(foot, window.at(tick, window.y[1]), GRID))
        if tick in figured:
            items.append(Label(foot - 3.0j, _figure(tick, x_ticks, unit), "center", style.SMALL))
    for tick in y_ticks:
        left = window.at(window.x[0], tick)
        zero = abs(tick) < 1e-12 * max(map(abs, window.y))
        items.append(Line(left, window.at(window.x[1], tick), EDGE if zero else GRID))
        items.append(Label(left - 1.5, _figure(tick, y_ticks, ""), "right", style.SMALL))
    items.append(framed(window.at(window.x[0], window.y[0]), window.at(window.x[1], window.y[1]), EDGE))
    return items


def _with_room(window: _Window, ticks: Sequence[float], unit: str) -> list[float]:
    """Return the ticks that get a number: all, or every second or fifth from 0, so that the numbers fit side
    by side.
    """
    step = (ticks[-1] - ticks[0]) / (len(ticks) - 1)
    apart = step / (window.x[1] - window.x[0]) * window.width
    widest = max(box(_figure(tick, ticks, unit), style.SMALL).width for tick in ticks)
    stride = next((every for every in (1, 2, 5) if every * apart >= widest + BETWEEN), 10)
    return [tick for tick in ticks if round(tick / step) % stride == 0] or [ticks[0]]


def framed(low: complex, high: complex, pen: Pen, fill: str | None = None) -> Polyline:
    """Return a rectangle between two corners (mm)."""
    corners = (low, complex(high.real, low.imag), high, complex(low.real, high.imag))
    return Polyline(corners, pen, closed=True, fill=fill)


def _figure(tick: float, ticks: Sequence[float], unit: str) -> Number:
    """Return a tick's number with as many decimals as the step between ticks needs."""
    step = abs(ticks[1] - ticks[0]) if len(ticks) > 1 else 1.0
    decimals = max(0, -math.floor(math.log10(step) + 1e-9))
    if abs(step * 10**decimals - round(step * 10**decimals)) > 1e-6:
        decimals += 1
    return Number(tick, decimals, unit)


def _titles(
    window: _Window, x_label: Content, y_label: Content, items: Sequence[Item], in_lines: bool = False
) -> list[Item]:
    """Return the names of the axes: below the middle and, turned by 90°, left of the widest number.

    With `in_lines`, a vertical name that is longer than its axis is broken after the unit.
    """
    figures = [item for item in items if isinstance(item, Label) and item.anchor == "right"]
    widest = max((box(item.content, item.size).width for item in figures), default=0.0)
    titles: list[Item] = []
    if x_label:
        titles.append(Label(complex(window.width / 2, -8.5), x_label))
    lines = _lines(y_label) if in_lines and box(y_label, style.LABEL).width > window.height else [y_label]
    for number, line in enumerate(reversed(lines)):
        if line:
            titles.append(Label(complex(-widest - 5.5 - LINE * number, window.height / 2), line, turn=90))
    return titles


def _lines(name: Content) -> list[Content]:
    """Return "ω (rad/s; positive: anticlockwise)" as two lines: ω (rad/s), and the sense that is positive."""
    if not isinstance(name, Chain) or "; " not in name.note:
        return [name]
    unit, sense = name.note.split("; ", 1)
    return [replace(name, note=unit), f"({sense})"]


def _paths(vertices: Vertices) -> list[tuple[complex, ...]]:
    """Return the curve on paper, split at gaps, without points that lie close to the line through others."""
    places = settled(vertices[:, 0] + 1j * vertices[:, 1])
    gaps = np.flatnonzero(~np.isfinite(places))
    runs = (run[np.isfinite(run)] for run in np.split(places, gaps))
    return [tuple(complex(place) for place in run[_telling(run)]) for run in runs if len(run) > 1]


def _telling(places: NDArray[np.complex128]) -> NDArray[np.intp]:
    """Return the indices of points that a simplified line keeps: its ends and, repeatedly, the point furthest from each
    chord, if that is too far.

    D. H. Douglas and T. K. Peucker, 1973.
    """
    kept = np.zeros(len(places), dtype=bool)
    kept[[0, -1]] = True
    while True:
        ends = np.flatnonzero(kept)
        chord = np.clip(np.searchsorted(ends, np.arange(len(places)), side="right") - 1, 0, len(ends) - 2)
        start, along = places[ends[chord]], places[ends[chord + 1]] - places[ends[chord]]
        share = ((places - start) * along.conj()).real / np.maximum(np.abs(along) ** 2, TINY)
        off = settled(np.abs(places - start - np.minimum(np.maximum(share, 0.0), 1.0) * along))
        greatest = np.maximum.reduceat(off, ends[:-1])
        furthest = np.flatnonzero((off == greatest[chord]) & (off > CLOSE))
        if not furthest.size:
            return ends
        kept[furthest[np.unique(chord[furthest], return_index=True)[1]]] = True


def _marked(series: PlottedCurve, vertices: Vertices, pen: Pen, items: list[Item]) -> list[Request]:
    """Add circles at the marked points to the items, and return requests for their names."""
    where = [complex(*vertices[i]) for i in series.marks]
    solid = Pen(0.25, pen.colour)
    items += [Circle(at, MARK, solid, style.PAPER) for at in where if np.isfinite(at)]
    named = [(at, name) for at, name in zip(where, series.names, strict=False) if np.isfinite(at)]
    return [
        label(group[0][0], *joined(name for _, name in group), gap=MARK + 0.4, size=style.SMALL, short=LEFT_OUT)
        for group in clusters(named, 0.6, lambda mark: mark[0])
    ]


def _inclined(window: _Window, angle_drawn: Inclination) -> tuple[list[Item], Request]:
    """Return the arc of an angle from the horizontal, and the request for its label."""
    corner = window.at(angle_drawn.x, angle_drawn.y)
    across, up = window.at(1.0, 0.0) - window.at(0.0, 0.0), window.at(0.0, angle_drawn.slope) - window.at(0.0, 0.0)
    angle = cmath.phase(across + up)
    middle = corner + cmath.rect(angle_drawn.radius, angle / 2)
    items: list[Item] = [
        Line(corner, corner + angle_drawn.radius + BEYOND, EDGE),
        Arc(corner, angle_drawn.radius, 0.0, angle, Pen(0.18)),
    ]
    return items, label(middle, angle_drawn.label, prefer=(angle / 2,))


def _places(vertices: Vertices) -> list[complex]:
    """Return places along a curve for its label: the highest and lowest first, then all over."""
    finite = vertices[np.isfinite(vertices).all(axis=1)]
    spread = finite[np.linspace(0, len(finite) - 1, 17).astype(int)]
    ends = finite[[first_greatest(finite[:, 1]), first_least(finite[:, 1])]]
    return [complex(*p) for p in np.concatenate((ends, spread[1:-1]))]
