"""Replace letters in a finished drawing: labels that become wider are moved off strokes and other labels."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence

import numpy as np

from reportgen.base.arrays import Complexes
from reportgen.base.records import replace
from reportgen.drawing import Content, Item, Label, Scene
from reportgen.drawing.geometry import corners_of, frame, moved, overlap, segments
from reportgen.drawing.label_candidates import CLEAR
from reportgen.drawing.label_size import box

Frame = tuple[complex, complex]
"""Centre and half size of a label (mm)."""
STEPS = sorted(
    (complex(along, up) for up in range(-3, 4) for along in range(-3, 4)), key=lambda step: (abs(step), step.imag)
)
"""Shifts of a row, in shares of half of its growth: short ones and those along its line first."""
TOUCHING = 1e-6
"""Labels no farther apart than this (mm) are parts of one row."""
WHITE = 0.5
"""Least distance between a label and the edge of its drawing (mm)."""


def respelled(scene: Scene, spell: Callable[[Content], Content]) -> Scene:
    """Return a scene in which `spell` has replaced the content of every label.

    A row of labels that grows keeps its middle, or is moved by up to 3/2 of its growth sideways, up or down, to where
    it touches fewest strokes and other labels.  If it leaves the drawing, the drawing grows.
    """
    items = list(scene.items)
    strokes = segments(item for item in items if not isinstance(item, Label))
    for row in _rows(scene.items):
        labels = [label for _, label in row]
        spelled = [replace(label, content=spell(label.content)) for label in labels]
        if spelled == labels:
            continue
        own = {n for n, _ in row}
        others = [frame(item) for n, item in enumerate(items) if isinstance(item, Label) and n not in own]
        placed, growth = _side_by_side(labels, spelled)
        frames = [frame(label) for label in placed]
        by = min((growth * step for step in STEPS), key=lambda by: _touched(frames, by, strokes, others))
        for n, label in zip(sorted(own), placed, strict=True):
            items[n] = moved(label, by)
    return scene if items == list(scene.items) else _widened(replace(scene, items=tuple(items)))


def _rows(items: Iterable[Item]) -> Iterator[list[tuple[int, Label]]]:
    """Yield labels with their places among the items; adjacent labels are grouped as parts of one text."""
    row: list[tuple[int, Label]] = []
    for n, item in enumerate(items):
        if isinstance(item, Label):
            if row and not _goes_on(row[-1][1], item):
                yield row
                row = []
            row.append((n, item))
    if row:
        yield row


def _goes_on(label: Label, following: Label) -> bool:
    (centre, half), (middle, reach) = frame(label), frame(following)
    return label.turn == following.turn == 0 and abs((middle - centre - half - reach).real) < TOUCHING


def _side_by_side(old: Sequence[Label], new: Sequence[Label]) -> tuple[list[Label], complex]:
    """Return the new labels of a row about its old middle and on its line, and half of its growth (mm)."""
    before, after = (2 * sum(frame(label)[1] for label in labels) for labels in (old, new))
    if new[0].turn == 90:
        return list(new), 1j * (after - before).imag / 2
    growth = complex((after - before).real / 2)
    first, half = frame(old[0])
    x, placed = (first - half - growth).real, []
    for label, spelled in zip(old, new, strict=True):
        was, extent = box(label.content, label.size), box(spelled.content, spelled.size)
        line = frame(label)[0].imag - (was.height - was.depth) / 2
        width = 2 * frame(spelled)[1].real
        centre = complex(x + width / 2, line + (extent.height - extent.depth) / 2)
        placed.append(replace(spelled, at=centre, anchor="center"))
        x += width
    return placed, growth


def _touched(labels: Sequence[Frame], by: complex, strokes: Complexes, others: Sequence[Frame]) -> int:
    """Return how many strokes and other labels the labels of a row come too close to, after a move."""
    centres, halves = (np.array(parts) for parts in zip(*labels, strict=True))
    met = int(overlap(centres + by, halves, strokes, CLEAR).sum())
    for middle, reach in others:
        gaps, rooms = centres + by - middle, halves + reach
        met += int(((np.abs(gaps.real) < rooms.real) & (np.abs(gaps.imag) < rooms.imag)).sum())
    return met


def _widened(scene: Scene) -> Scene:
    """Return the scene, enlarged on the sides where labels leave it."""
    centres, halves = (np.array(parts) for parts in zip(*_frames(scene), strict=True))
    white = complex(WHITE, WHITE)
    low, high = corners_of((0j, *(centres - halves - white)))[0], complex(scene.width, scene.height)
    high = corners_of((high, *(centres + halves + white)))[1]
    if (low, high) == (0j, complex(scene.width, scene.height)):
        return scene
    size = high - low
    return replace(scene, width=size.real, height=size.imag, items=tuple(moved(item, -low) for item in scene.items))


def _frames(scene: Scene) -> list[Frame]:
    return [frame(item) for item in scene.items if isinstance(item, Label)]
