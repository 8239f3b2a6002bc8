"""Other letters in a finished drawing: a label that they make wider goes on to where the paper is white."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from reportgen.drawing import Content, Item, Label, Scene
from reportgen.drawing.geometry import Complexes, frame, moved, overlap, segments
from reportgen.drawing.spots import CLEAR

Frame = tuple[complex, complex]
"""Centre and half size of a label (mm)."""
STEPS = tuple(complex(along, up) for up in (0, 1, -1) for along in (0, 1, -1))
"""Where a label may go, in shares of what half of it has grown by: along its line first."""
WHITE = 0.5
"""What remains at least between a label and the edge of its drawing (mm)."""


def respelled(scene: Scene, spell: Callable[[Content], Content]) -> Scene:
    """A scene whose labels say `spell` of what they said.

    A label that grows keeps its middle or one of its ends, or goes as far up or down, whichever touches least of the
    strokes and other labels; where it leaves the drawing, that grows with it.
    """
    items = [replace(item, content=spell(item.content)) if isinstance(item, Label) else item for item in scene.items]
    if items == list(scene.items):
        return scene
    frames = {n: frame(item) for n, item in enumerate(items) if isinstance(item, Label)}
    strokes = segments(item for item in items if not isinstance(item, Label))
    for n, (centre, half) in frames.items():
        if items[n] == scene.items[n]:
            continue
        way = _growth(scene.items[n], items[n])
        others = [one for k, one in frames.items() if k != n]
        by = min((way * step for step in STEPS), key=lambda by: _touched((centre + by, half), strokes, others))
        items[n], frames[n] = moved(items[n], by), (centre + by, half)
    return _widened(replace(scene, items=tuple(items)), list(frames.values()))


def _growth(old: Item, new: Item) -> complex:
    """From the middle of a label to where it is if one of its ends stays as it was (mm)."""
    assert isinstance(old, Label)
    assert isinstance(new, Label)
    more = frame(new)[1] - frame(old)[1]
    return 1j * more.imag if new.turn == 90 else complex(more.real)


def _touched(label: Frame, strokes: Complexes, others: Sequence[Frame]) -> int:
    """How many strokes and labels a label comes too close to."""
    centre, half = label
    met = int(overlap(np.array([centre]), np.array([half]), strokes, CLEAR).sum())
    for middle, reach in others:
        gap, room = centre - middle, half + reach
        met += abs(gap.real) < room.real and abs(gap.imag) < room.imag
    return met


def _widened(scene: Scene, frames: Sequence[Frame]) -> Scene:
    """The scene, wider on both sides where labels ask for it."""
    before = max(0.0, *(WHITE + half.real - centre.real for centre, half in frames))
    width = max(scene.width, *(centre.real + half.real + WHITE for centre, half in frames)) + before
    return replace(
        scene, width=width, items=tuple(moved(item, before) for item in scene.items) if before else scene.items
    )
