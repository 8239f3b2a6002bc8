"""Enlarged insets: vectors too short to measure, drawn again at a printed ratio beside the figure."""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from dataclasses import dataclass

from reportgen.figures.draft import Draft, settle
from reportgen.figures.geometry import bounds, clipped, clusters
from reportgen.figures.labels import Content, Request, label
from reportgen.figures.scale import TINY, enlargement
from reportgen.figures.scene import Arrow, Circle, Item, Label, Line, Polyline, Stroke
from reportgen.figures.style import GRAY, HEAD, PALE, SMALL, THIN

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


def insets(tiny: Sequence[Tiny], others: Sequence[tuple[complex, complex]], figure: Draft) -> Draft:
    """Insets for groups of short vectors, stacked to the right of `figure`; empty where there are none.

    `others` are the figure's vectors, whose stubs show inside the frames where they pass.  Each inset
    prints its ratio (e.g. 10:1), and a thin circle marks in the figure what it enlarges.
    """
    if not tiny:
        return Draft()
    # The figure's own labels are placed later; they seldom stand out further than LABELS.
    high = bounds(figure.items)[1]
    top = complex(high.real + LABELS + SPACE, high.imag)
    result = Draft()
    for group in _groups(tiny):
        part = _inset([tiny[i] for i in group], others)
        floor, ceiling = bounds(part.items)
        by = top - complex(floor.real, ceiling.imag)
        result += part.moved(by)
        result += Draft((_mark([tiny[i] for i in group]),))
        top -= 1j * ((ceiling - floor).imag + SPACE / 2)
    return result


def _groups(tiny: Sequence[Tiny]) -> list[list[int]]:
    """Indices of vectors with neighbouring middles, a group each.

    What would still be short at the ratio of a much longer neighbour, or far off at it, gets an inset of its own.
    """
    result: list[list[int]] = []
    middles = [(t.start + t.end) / 2 for t in tiny]
    for group in clusters(middles, NEIGHBOUR):
        rest = group
        while rest:
            sizes = {i: abs(tiny[i].end - tiny[i].start) for i in rest}
            longest = max(rest, key=lambda i: sizes[i])
            ratio = enlargement(sizes[longest])
            together = [
                i
                for i in rest
                if sizes[i] * ratio >= TINY and abs(middles[i] - middles[longest]) * ratio <= APART
            ]
            result.append(together)
            rest = [i for i in rest if i not in together]
    return result


def _mark(group: Sequence[Tiny]) -> Item:
    ends = [p for t in group for p in (t.start, t.end)]
    centre = (
        complex(min(p.real for p in ends), min(p.imag for p in ends))
        + complex(max(p.real for p in ends), max(p.imag for p in ends))
    ) / 2
    return Circle(centre, max(abs(p - centre) for p in ends) + 1.2, Stroke(0.1, GRAY), None)


def _inset(group: Sequence[Tiny], others: Sequence[tuple[complex, complex]]) -> Draft:
    """One inset with its labels placed, in coordinates about its own middle."""
    lengths = [abs(t.end - t.start) for t in group]
    ratio = enlargement(max(lengths))
    points = [p for t in group for p in (t.start, t.end)]
    low = complex(min(p.real for p in points), min(p.imag for p in points))
    high = complex(max(p.real for p in points), max(p.imag for p in points))
    middle = (low + high) / 2
    half = (high - low) / 2 * ratio + complex(ROOM, ROOM)

    def enlarged(p: complex) -> complex:
        return (p - middle) * ratio

    own = {(t.start, t.end) for t in group}
    stubs: list[Item] = []
    for other in others:
        if other not in own and (part := clipped(enlarged(other[0]), enlarged(other[1]), -half, half)):
            stubs.append(Line(*part, Stroke(0.15, PALE)))
    arrows = [
        Arrow(enlarged(t.start), enlarged(t.end), t.stroke, HEAD, f"{t.name} ×{ratio:g}") for t in group
    ]
    border = Polyline((-half, half.conjugate(), half, -half.conjugate()), THIN, closed=True)
    requests: list[Request] = []
    seen: set[tuple[Content, ...]] = set()
    for t in group:
        way = t.end - t.start
        for at, names, side in ((t.start, t.start_names, -1), (t.end, t.end_names, 1)):
            if names and names not in seen:
                seen.add(names)
                requests.append(label(enlarged(at), *names, prefer=(cmath.phase(side * way),), size=SMALL))
        if t.label is not None:
            across = cmath.phase(way) + math.pi / 2
            requests.append(
                label(enlarged((t.start + t.end) / 2), t.label, prefer=(across, across - math.pi), size=SMALL)
            )
    note = Label(half.imag * 1j + 1.2j, f"{ratio:g}:1", "bottom", SMALL)
    return settle(Draft((*stubs, *arrows, border, note), tuple(requests)))
