"""The style of all figures: colours, pens and sizes, and the signs of links and joints.

The mechanism is black, with two accent colours; construction lines are gray.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence

import numpy as np

from reportgen.base.stable_digits import settled
from reportgen.base.units import rounded
from reportgen.drawing import Arc, Circle, Hatch, Item, Line, Pen, Polyline
from reportgen.drawing.geometry import clipped, polar, rectangle, unit

BLACK, GRAY, PALE = "#000000", "#6b6b6b", "#a8a8a8"
BLUE, RED = "#123c7c", "#9c1c1c"
PAPER, TINT = "#ffffff", "#eef1f5"

VISIBLE = Pen(0.35)
"""Outlines of links and curves."""
HEAVY = Pen(0.5)
THIN = Pen(0.15, GRAY)
"""Circles, guides, lines of projection."""
AXIS = Pen(0.13, GRAY, (5.0, 1.0, 0.8, 1.0))
"""Axes of symmetry and of guides."""
PROJECTION = Pen(0.18, BLACK, (5.0, 1.0, 0.8, 1.0))
"""Pen of an axis on which vectors are projected."""
CONSTRUCTION = Pen(0.13, GRAY, (1.6, 1.0))
"""Auxiliary directions of a plan, which extend a little beyond their end."""
LEADER = Pen(0.1, GRAY)
SOLID, DASHED, CHAIN, DOTTED = (), (2.4, 0.9), (3.6, 0.8, 0.6, 0.8), (0.9, 0.7)
"""Dashes that distinguish lines printed without colour, beside their widths."""
KNOWN = Pen(0.35)
RELATIVE = Pen(0.3, BLUE, CHAIN)
FOUND = Pen(0.3, RED, DASHED)
"""A vector that is found by closing a plan."""
ACTIVE = Pen(0.5, BLUE)
REACTION = Pen(0.3, RED, DASHED)
PATH = Pen(0.3, BLUE, CHAIN)
"""The curve that a point traces."""
NORMAL = Pen(0.18, RED, (1.8, 1.0))
"""A normal to a velocity, through an instant centre."""
NEW = Pen(0.5, BLUE)
"""Pen of the parts that a construction stage adds."""
OLD = Pen(0.2, GRAY)
DIMENSION = Pen(0.13)

ON_LINE, BESIDE = 0.4, 1.6
"""Arrows within the first distance (mm) of one line overlap: the later one is drawn beside it, by the second
distance.
"""

HEAD, DIMENSION_HEAD = 2.6, 1.6
LABEL, SMALL = 9.0, 8.6
"""Font sizes (pt), the second for dense labels, whose indices, 0.7 of it, still have six points."""

# --- signs ----------------------------------------------------------------------------------------

JOINT = 1.2
"""Radius of a revolute joint (mm)."""
POINT = 0.7
"""Radius of a point that is not a joint (mm)."""
BLOCK = (9.0, 5.0)
"""Length along the guide and width of a block (mm)."""
SMALL_BLOCK = (4.0, 2.2)
"""The same in a small sketch."""
STRIP = 1.7
"""Width of a strip of ground (mm)."""
OPEN = 1.0
"""Gap between a bar and the wall that it passes (mm)."""
SHORTEST_WALL = 3.0
"""Shorter pieces of wall (mm) between two bars are left out."""
PLAY = 0.35
"""Gap between a block and its guide (mm)."""
CENTRE = 1.2
"""Radius of the sign of a mass centre (mm)."""


def joint(at: complex) -> Item:
    """Return a revolute joint between two moving links, at a place (mm)."""
    return Circle(at, JOINT, VISIBLE, PAPER)


def point(at: complex) -> Item:
    """Return a named point of a link that is not a joint, at a place (mm)."""
    return Circle(at, POINT, None, BLACK)


def pivot(at: complex) -> tuple[Item, ...]:
    """Return a revolute joint on the ground, at a place (mm): two legs on a hatched strip."""
    left, right = at + complex(-2.6, -5), at + complex(2.6, -5)
    return (
        Polyline((at, left, right), VISIBLE, closed=True, fill=PAPER),
        *ground(at + complex(-4.6, -5), at + complex(4.6, -5), -1),
        joint(at),
    )


def small_pivot(at: complex) -> tuple[Item, ...]:
    """Return a revolute joint on the ground in a small sketch, at a place (mm)."""
    left, right = at + complex(-1.3, -2.4), at + complex(1.3, -2.4)
    return (
        Polyline((at, left, right), THIN, closed=True, fill=PAPER),
        Line(left - 0.8, right + 0.8, VISIBLE),
        Circle(at, POINT, VISIBLE, PAPER),
    )


def ground(start: complex, end: complex, side: int) -> tuple[Item, ...]:
    """Return an edge of the ground with its hatching at 45°, on the left (+1) or right (−1) from start to end (mm)."""
    u = unit(end - start)
    out = u * 1j * side * STRIP
    turn = math.remainder(cmath.phase(u), math.pi / 2)
    return Hatch((start, end, end + out, start + out), turn=turn), Line(start, end, VISIBLE)


def guide(
    low: complex, high: complex, size: tuple[float, float], bars: Sequence[tuple[complex, complex]] = ()
) -> tuple[Item, ...]:
    """Return the walls on both sides of a block that travels from `low` to `high` (mm), open where `bars` cross them.

    `size` is the length and width of the block (mm).  Each wall extends half a block and 2 mm beyond the travel.
    """
    u = unit(high - low)
    away = u * 1j * (size[1] / 2 + PLAY)
    on = u * (size[0] / 2 + 2.0)
    walls = [(low - on + side * away, high + on + side * away, side) for side in (1, -1)]
    return tuple(
        item
        for start, end, side in walls
        for piece in _uncrossed(start, end, side, bars)
        for item in ground(*piece, side)
    )


def _uncrossed(
    start: complex, end: complex, side: int, bars: Sequence[tuple[complex, complex]]
) -> list[tuple[complex, complex]]:
    """Return the pieces of a wall that bars crossing its strip leave."""
    u, length = unit(end - start), abs(end - start)
    gaps = []
    for bar in bars:
        # In coordinates along the wall and outwards, which the strip fills from 0 to STRIP.
        a, b = (complex(p.real, side * p.imag) for p in ((point - start) * u.conjugate() for point in bar))
        if part := clipped(a, b, complex(-OPEN, 0.0), complex(length + OPEN, STRIP)):
            low, high = sorted(p.real for p in part)
            gaps.append((low - OPEN, high + OPEN))
    pieces, at = [], 0.0
    for low, high in [*sorted(gaps), (length, length)]:
        if low - at >= SHORTEST_WALL or (at == 0.0 and low >= length):
            pieces.append((start + u * at, start + u * min(low, length)))
        at = max(at, high)
    return pieces


def block(at: complex, angle: float, size: tuple[float, float]) -> Item:
    """Return a block at a place (mm) with a `size` (length, width in mm), its length at an angle (rad) to x."""
    return Polyline(rectangle(at, *size, angle), VISIBLE, closed=True, fill=TINT)


def body(points: Sequence[complex], pen: Pen = HEAVY, fill: str | None = TINT) -> tuple[Item, ...]:
    """Return a link through its joints (mm): a bar if they are collinear, otherwise the convex polygon around them.

    The result is empty for fewer than two joints.
    """
    if len(points) < 2:
        return ()
    p = np.asarray(points)
    base = max(((a, b) for a in points for b in points), key=lambda pair: settled(abs(pair[1] - pair[0])))
    u = unit(base[1] - base[0])
    if len(points) == 2 or np.abs(((p - base[0]) * u.conjugate()).imag).max() < 0.05:
        return (Line(base[0], base[1], pen),)
    return (Polyline(tuple(_around(points)), pen, closed=True, fill=fill),)


def _around(points: Sequence[complex]) -> list[complex]:
    """Return the corners of the convex polygon around points, anticlockwise."""
    places = {settled(point): point for point in points}
    ordered = [places[place] for place in sorted(places, key=lambda p: (p.real, p.imag))]

    def chain(corners: Sequence[complex]) -> list[complex]:
        kept: list[complex] = []
        for p in corners:
            while len(kept) > 1 and ((kept[-1] - kept[-2]).conjugate() * (p - kept[-1])).imag <= 0:
                kept.pop()
            kept.append(p)
        return kept[:-1]

    return [*chain(ordered), *chain(ordered[::-1])]


def mass_centre(at: complex) -> tuple[Item, ...]:
    """Return a circle with two black quarters, at a place (mm)."""
    quarters = []
    for start in (0.0, math.pi):
        rim = (at + CENTRE * polar(start + k * math.pi / 8) for k in range(5))
        quarters.append(Polyline((at, *rim), None, closed=True, fill=BLACK))
    return (Circle(at, CENTRE, Pen(0.2), PAPER), *quarters)


# --- replacements for writers without such items --------------------------------------------------

Segment = tuple[complex, complex]
Bezier = tuple[complex, complex, complex, complex]
Triangle = tuple[complex, complex, complex]

HEAD_SLENDERNESS = 0.32
"""Width of an arrow head over its length."""
HEAD_SHARE = 0.75
"""Largest share of a short arrow that its head may take."""


def arrow_head(start: complex, end: complex, length: float) -> tuple[complex, Triangle | None]:
    """Return the end of the shaft and the head's triangle, tip first, of an arrow (mm) whose tip lies on `end`.

    The shaft ends inside the head, so that no square pen end is visible beside the tip; the head shrinks on an arrow
    shorter than itself.  If the arrow or its head has no length, the triangle is None.
    """
    span = abs(end - start)
    if span == 0 or length <= 0:
        return end, None
    head = min(length, HEAD_SHARE * span)
    along = (end - start) / span
    back = end - head * along
    side = 0.5 * HEAD_SLENDERNESS * head * along * 1j
    return end - 0.7 * head * along, (end, back + side, back - side)


def arc_to_beziers(centre: complex, radius: float, start: float, stop: float) -> list[Bezier]:
    """Return cubic Bézier pieces (mm) of an arc from `start` to `stop` (rad), each of at most 45°.

    The handles are (4/3) tan(Δ/4) of the radius; the error stays below 5e-6 of the radius.
    """
    count = max(1, math.ceil(abs(stop - start) / (math.pi / 4) - 1e-9))
    step = (stop - start) / count
    handle = 4 / 3 * math.tan(step / 4)
    pieces = []
    for index in range(count):
        first = cmath.rect(radius, start + index * step)
        last = cmath.rect(radius, start + (index + 1) * step)
        handles = centre + first * (1 + 1j * handle), centre + last * (1 - 1j * handle)
        pieces.append((centre + first, *handles, centre + last))
    return pieces


def arc_with_head(arc: Arc) -> tuple[list[Bezier], Triangle | None]:
    """Return the pieces of the arc and its head's triangle or None; the head is a chord whose tip is the arc's stop."""
    sweep = arc.stop - arc.start
    if arc.head <= 0 or arc.radius <= 0 or sweep == 0:
        return arc_to_beziers(arc.centre, arc.radius, arc.start, arc.stop), None
    # The chord of the head spans this angle, at most that of the arc itself.
    chord = min(arc.head / arc.radius, HEAD_SHARE * abs(sweep), 1.0)
    angle = math.copysign(2 * math.asin(chord / 2), sweep)
    tip = arc.centre + cmath.rect(arc.radius, arc.stop)
    tail = arc.centre + cmath.rect(arc.radius, arc.stop - angle)
    _, triangle = arrow_head(tip + (tail - tip) / HEAD_SHARE, tip, abs(tip - tail))
    return arc_to_beziers(arc.centre, arc.radius, arc.start, arc.stop - 0.7 * angle), triangle


def clip_hatch(points: Sequence[complex], spacing: float, turn: float = 0.0) -> list[Segment]:
    """Return strokes at 45° to `turn` (rad) inside a convex polygon (mm), `spacing` mm apart.

    They are counted from the sheet's origin, so that neighbouring hatches join.  Raises `ValueError` for a spacing that
    is not positive.
    """
    if spacing <= 0:
        raise ValueError("the spacing of a hatch must be positive")
    along = cmath.exp(1j * (turn + math.pi / 4))
    turned = [settled(point / along) for point in points]
    heights = [point.imag for point in turned]
    if not turned:
        return []
    strokes = []
    for index in range(math.ceil(min(heights) / spacing), math.floor(max(heights) / spacing) + 1):
        height = index * spacing
        crossings = [
            a.real + (b.real - a.real) * (height - a.imag) / (b.imag - a.imag)
            for a, b in zip(turned, turned[1:] + turned[:1], strict=True)
            if (a.imag <= height) != (b.imag <= height)
        ]
        if len(crossings) == 2 and abs(crossings[0] - crossings[1]) > 1e-6:
            left, right = sorted(crossings)
            strokes.append((complex(left, height) * along, complex(right, height) * along))
    return strokes


def decimal(value: float) -> str:
    """Return a length (mm) to a thousandth, without trailing zeros and without a negative zero."""
    text = f"{rounded(value, 3):.3f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text
