"""Geometry of the items of a scene: strokes, bounding boxes, moving, enlarging, clipping, overlaps."""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable, Iterable, Sequence
from functools import lru_cache
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from reportgen.base.arrays import Complexes, Flags
from reportgen.base.records import Record, replace
from reportgen.base.stable_digits import settled
from reportgen.drawing import Arc, Arrow, Circle, Hatch, Item, Label, Line, Pen, Polyline
from reportgen.drawing.label_size import box

Part = TypeVar("Part")

CIRCLE_SIDES = 24
"""Number of chords of a full circle."""
CELL = 0.25
"""Side of the cells of paper (mm) of the stroke index."""


def ends(item: Item) -> Sequence[complex] | Complexes:
    """Return the item's strokes as segments (mm) [2 × strokes], alternating start and end; none for a label.

    Circles and arcs become short chords; a hatch becomes its outline.
    """
    match item:
        case Line(start, end):
            return start, end
        case Arrow(start, end, _, head):
            size = abs(end - start)
            if size == 0:
                return start, end
            # Labels keep away from the head, which is a third as wide as it is long.
            u = (end - start) / size
            head = min(head, size)
            left, right = end - head * u * (1 + 0.18j), end - head * u * (1 - 0.18j)
            return start, end, end, left, end, right, left, right
        case Circle(centre, radius):
            return _chain(_arc(centre, radius, 0.0, math.tau))
        case Arc(centre, radius, start, stop):
            return _chain(_arc(centre, radius, start, stop))
        case Polyline(points, _, closed):
            return _chain(np.array([*points, points[0]] if closed else points))
        case Hatch(points):
            return _chain(np.array([*points, points[0]]))
        case Label():
            return ()


def _arc(centre: complex, radius: float, start: float, stop: float) -> Complexes:
    sides = max(2, math.ceil(CIRCLE_SIDES * abs(stop - start) / math.tau))
    return np.asarray(centre + radius * np.exp(1j * np.linspace(start, stop, sides + 1)))


def _chain(points: Complexes) -> Complexes:
    return np.column_stack((points[:-1], points[1:])).ravel()


def segments(items: Iterable[Item]) -> Complexes:
    """Return all strokes of the items as segments (mm) [K, 2], rounded by `settled` for placing labels."""
    return settled(_stacked(map(ends, items))).reshape(-1, 2)


def _stacked(parts: Iterable[Sequence[complex] | Complexes]) -> Complexes:
    """Return all points of the parts in a row; most parts are a few points, for which separate arrays would be slow."""
    few: list[complex] = []
    many: list[Complexes] = []
    for part in parts:
        if isinstance(part, np.ndarray):
            many.append(part.ravel())
        else:
            few += part
    return np.concatenate((np.array(few, dtype=np.complex128), *many))


def frame(label: Label) -> tuple[complex, complex]:
    """Return centre and half size (width + i height, mm) of a label's box on the sheet."""
    extent = box(label.content, label.size)
    width, height = extent.width * label.narrow, extent.height + extent.depth
    if label.turn == 90:
        width, height = height, width
    right = ("left" in label.anchor) - ("right" in label.anchor)
    up = ("bottom" in label.anchor) - ("top" in label.anchor)
    return label.at + complex(right * width, up * height) / 2, complex(width, height) / 2


def corners(item: Item) -> Sequence[complex] | Complexes:
    """Return points (mm) [K] with the same bounding box as the item."""
    match item:
        case Label():
            centre, half = frame(item)
            return centre - half, centre + half
        case Circle(centre, radius):
            return centre - radius * (1 + 1j), centre + radius * (1 + 1j)
        case _:
            return ends(item)


def bounds(items: Iterable[Item]) -> tuple[complex, complex]:
    """Return the lower left and upper right corner (mm) of the box around all items; (0, 0) without items."""
    points = _stacked(map(corners, items))
    return corners_of(points) if points.size else (0j, 0j)


def corners_of(points: Sequence[complex] | Complexes) -> tuple[complex, complex]:
    """Return the lower left and upper right corner of the box around points [N], in their unit.

    Raises `ValueError` without points.
    """
    p = np.asarray(points, dtype=np.complex128)
    return complex(p.real.min(), p.imag.min()), complex(p.real.max(), p.imag.max())


def moved(item: Item, by: complex) -> Item:
    """Return the item shifted by a vector (mm)."""
    match item:
        case Line(start, end, stroke):
            return Line(start + by, end + by, stroke)
        case Arrow(start, end, stroke, head, name):
            return Arrow(start + by, end + by, stroke, head, name)
        case Circle(centre, radius, outline, fill):
            return Circle(centre + by, radius, outline, fill)
        case Arc(centre):
            return replace(item, centre=centre + by)
        case Polyline(points) | Hatch(points):
            return replace(item, points=tuple(point + by for point in points))
        case Label(at, content, anchor, size, turn, background, narrow):
            return Label(at + by, content, anchor, size, turn=turn, background=background, narrow=narrow)


def enlarged(item: Item, factor: float) -> Item:
    """Return the item enlarged about the origin by a factor; pens, arrowheads and letters grow as in a photograph."""

    def pen(stroke: Pen) -> Pen:
        return _enlarged_pen(stroke, factor)

    match item:
        case Line(start, end, stroke):
            return Line(start * factor, end * factor, pen(stroke))
        case Arrow(start, end, stroke, head):
            return replace(item, start=start * factor, end=end * factor, stroke=pen(stroke), head=head * factor)
        case Circle(centre, radius, outline):
            return replace(item, centre=centre * factor, radius=radius * factor, stroke=outline and pen(outline))
        case Arc(centre, radius, _, _, stroke, head):
            return replace(item, centre=centre * factor, radius=radius * factor, stroke=pen(stroke), head=head * factor)
        case Polyline(points, outline):
            return replace(item, points=tuple(p * factor for p in points), stroke=outline and pen(outline))
        case Hatch(points, spacing, stroke):
            return replace(item, points=tuple(p * factor for p in points), spacing=spacing * factor, stroke=pen(stroke))
        case Label(at, _, _, size):
            return replace(item, at=at * factor, size=size * factor)


@lru_cache(maxsize=256)
def _enlarged_pen(stroke: Pen, factor: float) -> Pen:
    """Return the enlarged pen; results are cached because a few pens draw every figure."""
    return replace(stroke, width=factor * stroke.width, dash=tuple(factor * part for part in stroke.dash))


def clipped(start: complex, end: complex, low: complex, high: complex) -> tuple[complex, complex] | None:
    """Return the part of a segment inside the box low…high (mm), by the algorithm of Liang and Barsky.

    None if the segment misses the box or has only one point in common with it.
    """
    d = end - start
    enter, leave = 0.0, 1.0
    for speed, lower, upper in (
        (d.real, low.real - start.real, high.real - start.real),
        (d.imag, low.imag - start.imag, high.imag - start.imag),
    ):
        if speed == 0:
            if lower > 0 or upper < 0:
                return None
            continue
        first, last = sorted((lower / speed, upper / speed))
        enter, leave = max(enter, first), min(leave, last)
    return (start + enter * d, start + leave * d) if enter < leave else None


class HalfPlane(Record):
    """Half-plane on the side of `inward` of a line through `at` (mm)."""

    at: complex
    inward: complex

    def depth(self, point: complex) -> float:
        """Return the depth of a point in the half-plane (mm); negative outside."""
        return ((point - self.at) * self.inward.conjugate()).real


def region(planes: Sequence[HalfPlane], box: Sequence[complex]) -> list[complex]:
    """Return the corners of the part of a convex polygon `box` (mm) in all half-planes; empty without such a part.

    By the algorithm of Sutherland and Hodgman.
    """
    corners = list(box)
    for plane in planes:
        kept: list[complex] = []
        for start, end in zip(corners, [*corners[1:], *corners[:1]], strict=True):
            here, there = plane.depth(start), plane.depth(end)
            if here >= 0:
                kept.append(start)
            if here * there < 0:
                kept.append(start + (end - start) * here / (here - there))
        corners = kept
        if not corners:
            break
    return corners


def clusters(parts: Iterable[Part], reach: float, at: Callable[[Part], complex]) -> list[list[Part]]:
    """Group parts of a figure, in order: a part whose place `at` is within `reach` mm of any in a group joins it.

    Groups can thus be chains whose ends are farther apart; see `coincident`.
    """
    parts = list(parts)
    points = list(map(at, parts))
    group = list(range(len(points)))
    for i, p in enumerate(points):
        for j in range(i):
            if abs(p - points[j]) <= reach and group[i] != group[j]:
                old, new = max(group[i], group[j]), min(group[i], group[j])
                group = [new if g == old else g for g in group]
    return [[part for part, g in zip(parts, group, strict=True) if g == key] for key in sorted(set(group))]


def coincident(parts: Iterable[Part], reach: float, at: Callable[[Part], complex]) -> list[list[Part]]:
    """Group parts of a figure, in order, so that all places `at` of a group are within `reach` mm of one another."""
    groups: list[list[Part]] = []
    for part in parts:
        own_place = at(part)
        own = next((group for group in groups if all(abs(at(other) - own_place) <= reach for other in group)), None)
        if own is None:
            groups.append([part])
        else:
            own.append(part)
    return groups


def on_one_line(longer: tuple[complex, complex], shorter: tuple[complex, complex], apart: float, least: float) -> bool:
    """Return True if the shorter of two segments lies within `apart` mm of the line of the longer one, and they share
    more than `least` mm of it.

    The segments (mm) may be given in either order.
    """
    longer, shorter = sorted((longer, shorter), key=lambda ends: -abs(ends[1] - ends[0]))
    u = unit(longer[1] - longer[0])
    ends = [(end - longer[0]) * u.conjugate() for end in shorter]
    if max(abs(end.imag) for end in ends) > apart:
        return False
    low, high = sorted(end.real for end in ends)
    return min(high, abs(longer[1] - longer[0])) - max(low, 0.0) > least


def unit(vector: complex) -> complex:
    """Return the unit direction of a vector; 1 for a zero vector."""
    size = abs(vector)
    return vector / size if size > 0 else 1 + 0j


def polar(angle: float) -> complex:
    """Return the unit vector e^{iφ} at an angle φ (rad)."""
    return cmath.exp(1j * angle)


def rectangle(centre: complex, length: float, width: float, angle: float = 0.0) -> tuple[complex, ...]:
    """Return the four corners of a rectangle (mm), anticlockwise; its length has the direction `angle` (rad)."""
    u = polar(angle)
    a, b = complex(length, width) / 2, complex(length, -width) / 2
    return (centre - u * a, centre + u * b, centre + u * a, centre - u * b)


def overlap(centres: Complexes, half: Complexes, strokes: Complexes, clearance: float) -> Flags:
    """Return flags [K, S]: True where a box [K] (mm) comes nearer than `clearance` (mm) to a segment [S, 2] (mm).

    `half` is half the size of each box, as width + i height.  The separating axes of a box and a segment are x, y and
    the segment's normal.
    """
    middle, reach = (strokes[:, 0] + strokes[:, 1]) / 2, (strokes[:, 1] - strokes[:, 0]) / 2
    along, up = reach.real.copy(), reach.imag.copy()
    hw, hh = half.real[:, None] + clearance, half.imag[:, None] + clearance
    rx, ry = np.abs(along), np.abs(up)
    dx, dy = centres.real[:, None] - middle.real, centres.imag[:, None] - middle.imag
    touching: Flags = np.abs(dx) < hw + rx
    touching &= np.abs(dy) < hh + ry
    dy *= along
    dx *= up
    dy -= dx
    touching &= np.abs(dy, out=dy) < hw * ry + hh * rx
    return touching


def _added_up(counts: NDArray[np.unsignedinteger]) -> NDArray[np.unsignedinteger]:
    """Return the sums down each column [R, C] of counts; C is a multiple of 4.

    No sum may need more bits than a count has: the counts that share 64 bits are added as one number, several times
    faster.
    """
    together = np.ascontiguousarray(counts).view(np.uint64)
    return np.cumsum(together, axis=0, out=together).view(counts.dtype)


class Ink:
    """Strokes of a figure in cells of paper, with the number of inked cells to the lower left of each corner.

    Four corners decide whether a box touches a stroke, however many strokes there are.
    """

    def __init__(self, strokes: Complexes) -> None:
        self.strokes = strokes
        self.low, high = corners_of(strokes.ravel()) if len(strokes) else (0j, 0j)
        along = strokes[:, 1] - strokes[:, 0]
        steps = np.ceil(settled(np.abs(along)) / CELL).astype(np.intp) + 1
        stroke = np.repeat(np.arange(len(steps)), steps)
        step = np.arange(len(stroke)) - np.repeat(np.cumsum(steps) - steps, steps)
        dots = settled(strokes[stroke, 0] + along[stroke] * (step / np.maximum(steps - 1, 1)[stroke]) - self.low) / CELL
        self.size = int((high - self.low).real / CELL) + 2, int((high - self.low).imag / CELL) + 2
        rows, columns = (4 * (extent // 4 + 1) for extent in self.size)
        inked = np.zeros((rows, columns), dtype=np.uint16 if len(dots) < 1 << 16 else np.uint32)
        inked[dots.real.astype(np.intp) + 1, dots.imag.astype(np.intp) + 1] = 1
        self.inked = _added_up(_added_up(inked).T).T

    def touches(self, centres: Complexes, half: Complexes) -> Flags:
        """Return flags of the boxes [N] that touch a stroke, to within half a cell.

        `centres` and `half`, half their sizes as width + i height, are in mm.
        """
        return np.asarray(self.covered(centres, half) != 0)

    def covered(self, centres: Complexes, half: Complexes) -> NDArray[np.unsignedinteger]:
        """Return the number of inked cells that each box covers [N], by centres and half sizes (mm)."""
        cells = settled(np.stack((centres - half, centres + half)) - self.low) / CELL
        x, y = (
            np.minimum(np.maximum(np.rint(at), 0), size).astype(np.intp)
            for at, size in zip((cells.real, cells.imag), self.size, strict=True)
        )
        (x0, x1), (y0, y1) = x, y
        inked = self.inked
        return np.asarray(inked[x1, y1] - inked[x0, y1] - inked[x1, y0] + inked[x0, y0])
