"""Items of a scene as plain geometry: segments, extents, moving, clipping."""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from functools import lru_cache
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from reportgen.figures.metrics import box
from reportgen.figures.scene import Arc, Arrow, Circle, Hatch, Item, Label, Line, Polyline, Stroke

Complexes = NDArray[np.complex128]
Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]
Part = TypeVar("Part")

CIRCLE_SIDES = 24


def ends(item: Item) -> Complexes:
    """The item's strokes as segments, an array [K, 2] of complex points; a label has none."""
    match item:
        case Line(start, end):
            return np.array([[start, end]])
        case Arrow(start, end, _, head):
            size = abs(end - start)
            if size == 0:
                return np.array([[start, end]])
            # Labels keep clear of the head, which is a third as wide as it is long.
            u = (end - start) / size
            head = min(head, size)
            left, right = end - head * u * (1 + 0.18j), end - head * u * (1 - 0.18j)
            return np.array([[start, end], [end, left], [end, right], [left, right]])
        case Circle(centre, radius):
            return _chain(_arc(centre, radius, 0.0, math.tau))
        case Arc(centre, radius, start, stop):
            return _chain(_arc(centre, radius, start, stop))
        case Polyline(points, _, closed):
            return _chain(np.array([*points, points[0]] if closed else points))
        case Hatch(points):
            return _chain(np.array([*points, points[0]]))
        case Label():
            return np.empty((0, 2), dtype=np.complex128)


def _arc(centre: complex, radius: float, start: float, stop: float) -> Complexes:
    sides = max(2, math.ceil(CIRCLE_SIDES * abs(stop - start) / math.tau))
    return np.asarray(centre + radius * np.exp(1j * np.linspace(start, stop, sides + 1)))


def _chain(points: Complexes) -> Complexes:
    return np.column_stack((points[:-1], points[1:]))


def segments(items: Iterable[Item]) -> Complexes:
    """All strokes of the items as segments [K, 2]."""
    parts = [ends(item) for item in items]
    return np.concatenate(parts) if parts else np.empty((0, 2), dtype=np.complex128)


def frame(label: Label) -> tuple[complex, complex]:
    """Centre and half size (width + i height, mm) of a label's box on the sheet."""
    extent = box(label.content, label.size)
    width, height = extent.width, extent.height + extent.depth
    if label.turn == 90:
        width, height = height, width
    right = ("left" in label.anchor) - ("right" in label.anchor)
    up = ("bottom" in label.anchor) - ("top" in label.anchor)
    return label.at + complex(right * width, up * height) / 2, complex(width, height) / 2


def corners(item: Item) -> Complexes:
    """Points whose bounding box is the item's."""
    match item:
        case Label():
            centre, half = frame(item)
            return np.array([centre - half, centre + half])
        case Circle(centre, radius):
            return np.array([centre - radius * (1 + 1j), centre + radius * (1 + 1j)])
        case _:
            return ends(item).ravel()


def bounds(items: Iterable[Item]) -> tuple[complex, complex]:
    """Lower left and upper right corner of the box around all items; (0, 0) for none."""
    points = [corners(item) for item in items]
    return corners_of(np.concatenate(points)) if points else (0j, 0j)


def corners_of(points: Sequence[complex] | Complexes) -> tuple[complex, complex]:
    """Lower left and upper right corner of the box around points."""
    p = np.asarray(points, dtype=np.complex128)
    return complex(p.real.min(), p.imag.min()), complex(p.real.max(), p.imag.max())


def moved(item: Item, by: complex) -> Item:
    """The item shifted by a vector in mm."""
    match item:
        case Line(start, end) | Arrow(start, end):
            return replace(item, start=start + by, end=end + by)
        case Circle(centre) | Arc(centre):
            return replace(item, centre=centre + by)
        case Polyline(points) | Hatch(points):
            return replace(item, points=tuple(point + by for point in points))
        case Label(at):
            return replace(item, at=at + by)


def enlarged(item: Item, factor: float) -> Item:
    """The item as a photographic enlargement about the origin shows it: pens, arrowheads and letters grow too."""

    def pen(stroke: Stroke) -> Stroke:
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
def _enlarged_pen(stroke: Stroke, factor: float) -> Stroke:
    """The same few pens draw every figure."""
    return replace(stroke, width=factor * stroke.width, dash=tuple(factor * part for part in stroke.dash))


def clipped(start: complex, end: complex, low: complex, high: complex) -> tuple[complex, complex] | None:
    """The part of a segment inside the box low…high, or None (Liang–Barsky)."""
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


def clusters(parts: Iterable[Part], reach: float, at: Callable[[Part], complex]) -> list[list[Part]]:
    """Parts of a figure grouped, in order, so that those with places `at` within `reach` mm share a group."""
    parts = list(parts)
    points = list(map(at, parts))
    group = list(range(len(points)))
    for i, p in enumerate(points):
        for j in range(i):
            if abs(p - points[j]) <= reach and group[i] != group[j]:
                old, new = max(group[i], group[j]), min(group[i], group[j])
                group = [new if g == old else g for g in group]
    return [[part for part, g in zip(parts, group, strict=True) if g == key] for key in sorted(set(group))]


def on_one_line(one: tuple[complex, complex], other: tuple[complex, complex], apart: float, least: float) -> bool:
    """Whether two segments lie within `apart` mm of the longer one's line and cover more than `least` mm of it."""
    one, other = sorted((one, other), key=lambda ends: -abs(ends[1] - ends[0]))
    u = unit(one[1] - one[0])
    ends = [(end - one[0]) * u.conjugate() for end in other]
    if max(abs(end.imag) for end in ends) > apart:
        return False
    low, high = sorted(end.real for end in ends)
    return min(high, abs(one[1] - one[0])) - max(low, 0.0) > least


def unit(vector: complex) -> complex:
    """The direction of a vector; 1 for a vector of no length."""
    size = abs(vector)
    return vector / size if size > 0 else 1 + 0j


def polar(angle: float) -> complex:
    """e^{iφ}."""
    return cmath.exp(1j * angle)


def rectangle(centre: complex, length: float, width: float, angle: float = 0.0) -> tuple[complex, ...]:
    """Corners of a rectangle, its length along `angle`."""
    u = polar(angle)
    a, b = complex(length, width) / 2, complex(length, -width) / 2
    return (centre - u * a, centre + u * b, centre + u * a, centre - u * b)


def overlap(centres: Complexes, half: Complexes, strokes: Complexes, clearance: float) -> Flags:
    """Whether boxes [K] (centre, half size as width + i height) touch segments [S, 2]: flags [K, S].

    The separating axes of a box and a segment are x, y and the segment's normal.
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
