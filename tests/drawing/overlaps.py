"""What is wrong with a finished scene: labels on strokes, on one another, or off the sheet."""

from __future__ import annotations

import numpy as np

from reportgen.drawing import Label, Scene
from reportgen.drawing.geometry import corners, frame, overlap, segments

CLEARANCE = 0.1
"""White between a label and a stroke, mm."""


def overlaps(scene: Scene) -> list[str]:
    """Faults of a finished scene: labels on strokes, on one another, or off the sheet."""
    faults: list[str] = []
    labels = [item for item in scene.items if isinstance(item, Label)]
    strokes = segments(scene.items)
    frames = [frame(item) for item in labels]
    for n, (item, (centre, half)) in enumerate(zip(labels, frames, strict=True)):
        if not item.background and len(strokes):
            hits = overlap(np.array([centre]), np.array([half]), strokes, CLEARANCE)[0]
            if hits.any():
                where = strokes[int(np.argmax(hits))]
                faults.append(f"{item.content} stands on the stroke {where[0]:.1f} – {where[1]:.1f}")
        for other, (middle, its_half) in zip(labels[:n], frames[:n], strict=True):
            gap, room = centre - middle, half + its_half
            if abs(gap.real) < room.real - 1e-6 and abs(gap.imag) < room.imag - 1e-6:
                faults.append(f"{item.content} stands on {other.content}")
        low, high = corners(item)
        if low.real < 0 or low.imag < 0 or high.real > scene.width or high.imag > scene.height:
            faults.append(f"{item.content} is off the sheet")
    return faults
