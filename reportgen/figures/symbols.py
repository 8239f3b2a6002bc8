"""The signs of a kinematic scheme: joints, pivots on the ground, blocks, guides, mass centres, links."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from reportgen.figures.geometry import polar, rectangle, unit
from reportgen.figures.scene import Circle, Hatch, Item, Line, Polyline, Stroke
from reportgen.figures.style import BLACK, HEAVY, PAPER, THIN, TINT, VISIBLE

JOINT = 1.2
"""Radius of a revolute joint, mm."""
POINT = 0.7
"""Radius of a point that is no joint."""
BLOCK = (9.0, 5.0)
"""Length along the guide and width of a block, mm."""
STRIP = 1.7
"""Width of a strip of ground."""
PLAY = 0.35
"""White between a block and its guide."""


def joint(at: complex) -> tuple[Item, ...]:
    return (Circle(at, JOINT, VISIBLE, PAPER),)


def point(at: complex) -> tuple[Item, ...]:
    """A named point of a link where nothing is joined to it."""
    return (Circle(at, POINT, None, BLACK),)


def pivot(at: complex) -> tuple[Item, ...]:
    """A revolute joint on the ground: two legs on a hatched strip."""
    left, right = at + complex(-2.6, -5), at + complex(2.6, -5)
    return (
        Polyline((at, left, right), VISIBLE, closed=True, fill=PAPER),
        *ground(at + complex(-4.6, -5), at + complex(4.6, -5), -1),
        *joint(at),
    )


def ground(start: complex, end: complex, side: int) -> tuple[Item, ...]:
    """A standing edge with its hatching to the left (+1) or right (−1) of the way from start to end."""
    out = unit(end - start) * 1j * side * STRIP
    return (
        Hatch((start, end, end + out, start + out), 1.2, Stroke(0.13)),
        Line(start, end, VISIBLE),
    )


def guide(low: complex, high: complex, size: tuple[float, float] = BLOCK) -> tuple[Item, ...]:
    """Walls on both sides of the way of a block, half a block longer than the way."""
    u = unit(high - low)
    away = u * 1j * (size[1] / 2 + PLAY)
    on = u * (size[0] / 2 + 2.0)
    start, end = low - on, high + on
    return (*ground(start + away, end + away, 1), *ground(start - away, end - away, -1))


def block(at: complex, angle: float, size: tuple[float, float] = BLOCK) -> tuple[Item, ...]:
    return (Polyline(rectangle(at, *size, angle), VISIBLE, closed=True, fill=TINT),)


def body(points: Sequence[complex], pen: Stroke = HEAVY, fill: str | None = TINT) -> tuple[Item, ...]:
    """A link through its joints: a bar where they are in line, else the triangle or polygon around them."""
    if len(points) < 2:
        return ()
    p = np.asarray(points)
    base = max(((a, b) for a in points for b in points), key=lambda pair: abs(pair[1] - pair[0]))
    u = unit(base[1] - base[0])
    if len(points) == 2 or np.abs(((p - base[0]) * u.conjugate()).imag).max() < 0.05:
        return (Line(base[0], base[1], pen),)
    return (Polyline(tuple(_around(points)), pen, closed=True, fill=fill),)


def _around(points: Sequence[complex]) -> list[complex]:
    """The corners of the convex polygon around points, anticlockwise."""
    ordered = sorted(set(points), key=lambda p: (p.real, p.imag))

    def chain(ways: Sequence[complex]) -> list[complex]:
        kept: list[complex] = []
        for p in ways:
            while len(kept) > 1 and ((kept[-1] - kept[-2]).conjugate() * (p - kept[-1])).imag <= 0:
                kept.pop()
            kept.append(p)
        return kept[:-1]

    return [*chain(ordered), *chain(ordered[::-1])]


def mass_centre(at: complex, radius: float = 1.2) -> tuple[Item, ...]:
    """A circle with two black quarters."""
    quarters = []
    for start in (0.0, math.pi):
        rim = (at + radius * polar(start + k * math.pi / 8) for k in range(5))
        quarters.append(Polyline((at, *rim), None, closed=True, fill=BLACK))
    return (Circle(at, radius, Stroke(0.2), PAPER), *quarters)


def path_circle(at: complex, radius: float) -> tuple[Item, ...]:
    return (Circle(at, radius, THIN),)
