"""What is wrong with a finished scene: labels on strokes, on one another, or off the sheet."""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any
from unittest import mock

import numpy as np

from reportgen.drawing import Arc, Circle, Item, Label, Line, Polyline, Scene, canvas, labels
from reportgen.drawing.geometry import bounds, corners, frame, overlap, segments
from reportgen.drawing.style import GRAY

CLEARANCE = 0.1
"""White between a label and a stroke, mm."""


def overlaps(scene: Scene) -> list[str]:
    """Faults of a finished scene: labels on strokes, on one another, or off the sheet.

    One on paper of its own may break gray lines of construction.
    """
    faults: list[str] = []
    written = [item for item in scene.items if isinstance(item, Label)]
    every = segments(scene.items)
    firm = segments(item for item in scene.items if not _gray(item))
    frames = [frame(item) for item in written]
    for n, (item, (centre, half)) in enumerate(zip(written, frames, strict=True)):
        strokes = firm if item.background else every
        if len(strokes):
            hits = overlap(np.array([centre]), np.array([half]), strokes, CLEARANCE)[0]
            if hits.any():
                where = strokes[int(np.argmax(hits))]
                faults.append(f"{item.content} stands on the stroke {where[0]:.1f} – {where[1]:.1f}")
        for other, (middle, its_half) in zip(written[:n], frames[:n], strict=True):
            gap, room = centre - middle, half + its_half
            if abs(gap.real) < room.real - 1e-6 and abs(gap.imag) < room.imag - 1e-6:
                faults.append(f"{item.content} stands on {other.content}")
        low, high = corners(item)
        if low.real < 0 or low.imag < 0 or high.real > scene.width or high.imag > scene.height:
            faults.append(f"{item.content} is off the sheet")
    return faults


def _gray(item: Item) -> bool:
    return isinstance(item, (Line, Arc, Circle, Polyline)) and item.stroke is not None and item.stroke.colour == GRAY


# --- labels with what they name ---------------------------------------------------------------------


@dataclass(frozen=True)
class Placed:
    """A label on paper: what it names, the box around it, the leader that ties it to its point if it has one."""

    named: tuple[complex, ...]
    mark: bool
    """Whether it is one of the many marks of a curve, which may stand past others on a leader."""
    low: complex
    high: complex
    leader: Line | None

    def to(self, point: complex) -> float:
        """How far the label is from a point, mm."""
        aside = max(self.low.real - point.real, 0.0, point.real - self.high.real)
        return abs(complex(aside, max(self.low.imag - point.imag, 0.0, point.imag - self.high.imag)))


@contextmanager
def watched() -> Iterator[list[list[Placed]]]:
    """The labels of each figure that is drawn meanwhile."""
    figures: list[list[Placed]] = []
    rounds: list[list[Placed]] = []
    place, place_in = labels.place, labels._place_in

    def placing(order: Any, spots: Any, *others: Any) -> Any:
        done, crowded = place_in(order, spots, *others)
        rounds.append([_placed(spots[i].request, items) for i, items in done.items() if items])
        return done, crowded

    def all_rounds(items: Any, requests: Any) -> Any:
        rounds.clear()
        result = place(items, requests)
        # A figure that was drawn before has its labels already.
        figures.extend(rounds[-1:])
        return result

    place.cache_clear()
    with mock.patch.object(labels, "_place_in", placing), mock.patch.object(canvas, "place", all_rounds):
        yield figures


def _placed(request: labels.Request, items: tuple[Item, ...]) -> Placed:
    low, high = bounds(item for item in items if isinstance(item, Label))
    return Placed(
        request.named,
        request.short == labels.LEFT_OUT,
        low,
        high,
        next((item for item in items if isinstance(item, Line)), None),
    )


def astray(figure: list[Placed]) -> list[Placed]:
    """The labels that are nearer to a point that another one names than to any of their own."""
    return [
        one
        for one in figure
        if one.named
        and min(map(one.to, (p for other in figure if other is not one for p in other.named)), default=math.inf)
        < min(map(one.to, one.named)) - 1e-9
    ]


def cross(one: Line, other: Line) -> bool:
    """Whether two lines cross."""

    def side(line: Line, point: complex) -> float:
        return ((line.end - line.start).conjugate() * (point - line.start)).imag

    return side(one, other.start) * side(one, other.end) < 0 and side(other, one.start) * side(other, one.end) < 0
