"""Enlarged insets: vectors too short to measure, drawn again at a printed ratio beside the figure."""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from dataclasses import dataclass

from reportgen.figures import style
from reportgen.figures.draft import Draft, settle
from reportgen.figures.geometry import bounds, clipped, clusters, corners_of
from reportgen.figures.labels import Request, label
from reportgen.figures.scene import Arrow, Circle, Content, Item, Label, Line, Polyline, Stroke
from reportgen.notation.numbers import SERIES

TINY = 3.0
"""Vectors drawn shorter than this (mm) get an enlarged inset."""
INVISIBLE = 0.001
"""What is drawn shorter than this (mm) is a point on any paper and gets no inset."""
TARGET = 20.0
"""The longest vector of an inset is enlarged to at most this (mm)."""
SPACE = 8.0
"""White between the figure and its insets, mm."""
LABELS = 5.0
"""How far labels stand out to the right of what they name, mm."""
ROOM = 6.0
"""White inside an inset's frame around the enlarged vectors, mm."""
NEIGHBOUR = 3.0
"""Tiny vectors nearer than this (mm) share an inset."""
APART = 30.0
"""Unless their middles would be farther apart than this in the inset (mm)."""


@dataclass(frozen=True, slots=True)
class Tiny:
    """A short vector with its own label and the names of its ends."""

    start: complex
    end: complex
    stroke: Stroke
    name: str
    label: Content | None
    start_names: tuple[Content, ...]
    end_names: tuple[Content, ...]

    @property
    def middle(self) -> complex:
        return (self.start + self.end) / 2

    @property
    def length(self) -> float:
        return abs(self.end - self.start)


def insets(tiny: Sequence[Tiny], others: Sequence[tuple[complex, complex]], figure: Draft) -> Draft:
    """Insets for groups of short vectors, stacked to the right of `figure`; empty if there are none.

    `others` are the figure's vectors, of which the parts inside the frames are shown.  Each inset prints its
    ratio (e.g. 10:1), and a thin circle in the figure marks what it enlarges.
    """
    if not tiny:
        return Draft()
    # The figure's own labels are placed later; they seldom stand out further than LABELS.
    high = bounds(figure.items)[1]
    top = complex(high.real + LABELS + SPACE, high.imag)
    result = Draft()
    for group in _groups(tiny):
        part = _inset(group, others)
        floor, ceiling = bounds(part.items)
        result += part.moved(top - complex(floor.real, ceiling.imag)) + Draft((_mark(group),))
        top -= 1j * ((ceiling - floor).imag + SPACE / 2)
    return result


def enlargement(longest: float) -> float:
    """The printed ratio of an inset: the largest of the series that draws `longest` mm within the target."""
    most = TARGET / longest
    decade = math.floor(math.log10(most) + 1e-12)
    ratios = (float(f"{step}e{power}") for power in (decade, decade - 1) for step in reversed(SERIES))
    # A ratio that exceeds the target in its last binary digits only still counts.
    return next(ratio for ratio in ratios if ratio <= most * (1 + 1e-12))


def _groups(tiny: Sequence[Tiny]) -> list[list[Tiny]]:
    """Vectors with neighbouring middles in groups, an inset each.

    A vector that would still be short, or too far off, at the ratio of the longest one goes to another inset.
    """
    result: list[list[Tiny]] = []
    for indices in clusters([vector.middle for vector in tiny], NEIGHBOUR):
        rest = [tiny[i] for i in indices]
        while rest:
            longest = max(rest, key=lambda vector: vector.length)
            ratio = enlargement(longest.length)
            group = [
                vector
                for vector in rest
                if vector.length * ratio >= TINY and abs(vector.middle - longest.middle) * ratio <= APART
            ]
            result.append(group)
            rest = [vector for vector in rest if vector not in group]
    return result


def _mark(group: Sequence[Tiny]) -> Item:
    ends = [end for vector in group for end in (vector.start, vector.end)]
    low, high = corners_of(ends)
    centre = (low + high) / 2
    return Circle(centre, max(abs(end - centre) for end in ends) + 1.2, Stroke(0.1, style.GRAY), None)


def _inset(group: Sequence[Tiny], others: Sequence[tuple[complex, complex]]) -> Draft:
    """One inset with its labels placed, in coordinates about its own middle."""
    ratio = enlargement(max(vector.length for vector in group))
    low, high = corners_of([end for vector in group for end in (vector.start, vector.end)])
    middle = (low + high) / 2
    half = (high - low) / 2 * ratio + complex(ROOM, ROOM)

    def enlarged(p: complex) -> complex:
        return (p - middle) * ratio

    own = {(vector.start, vector.end) for vector in group}
    items: list[Item] = []
    for start, end in others:
        if (start, end) not in own and (part := clipped(enlarged(start), enlarged(end), -half, half)):
            items.append(Line(*part, Stroke(0.15, style.PALE)))
    items += (
        Arrow(enlarged(vector.start), enlarged(vector.end), vector.stroke, style.HEAD, f"{vector.name} ×{ratio:g}")
        for vector in group
    )
    items.append(Polyline((-half, half.conjugate(), half, -half.conjugate()), style.THIN, closed=True))
    items.append(Label(half.imag * 1j + 1.2j, f"{ratio:g}:1", "bottom", style.SMALL))
    requests: list[Request] = []
    seen: set[tuple[Content, ...]] = set()
    for vector in group:
        way = vector.end - vector.start
        for at, names, side in ((vector.start, vector.start_names, -1), (vector.end, vector.end_names, 1)):
            if names and names not in seen:
                seen.add(names)
                requests.append(label(enlarged(at), *names, prefer=(cmath.phase(side * way),), size=style.SMALL))
        if vector.label is not None:
            across = cmath.phase(way) + math.pi / 2
            sides = (across, across - math.pi)
            requests.append(label(enlarged(vector.middle), vector.label, prefer=sides, size=style.SMALL))
    return settle(Draft(tuple(items), tuple(requests)))
