"""A figure while it is drawn: items and labels to place, in mm about any origin, and its finishing.

Every figure makes a `Draft`; drafts drawn in one system of coordinates add up; `finish` places the
labels, crops to the content and gives the `Scene`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from reportgen.figures.geometry import bounds, moved
from reportgen.figures.labels import Content, Request, place
from reportgen.figures.metrics import box
from reportgen.figures.scene import Item, Label, Scene
from reportgen.figures.style import LABEL

MARGIN = 6.0


@dataclass(frozen=True, slots=True)
class Draft:
    """Items in the order of painting and the labels still to be placed."""

    items: tuple[Item, ...] = ()
    requests: tuple[Request, ...] = ()

    def __add__(self, other: Draft) -> Draft:
        return Draft(self.items + other.items, self.requests + other.requests)

    def moved(self, by: complex) -> Draft:
        """The settled draft shifted by a vector; its labels must have been placed."""
        return Draft(tuple(moved(item, by) for item in self.items))


def settle(draft: Draft) -> Draft:
    """The draft with its labels placed."""
    return Draft(draft.items + place(draft.items, draft.requests))


def finish(
    draft: Draft,
    *,
    notes: Sequence[Content] = (),
    title: str = "",
    margin: float = MARGIN,
    frame: tuple[complex, complex] | None = None,
) -> Scene:
    """The scene: labels placed, `notes` (the figure's scale) below, cropped with `margin` mm around.

    `frame` (lower left, upper right) is paper to keep even where nothing is drawn, so that several
    scenes come out alike.
    """
    done = settle(draft)
    low, high = bounds(done.items)
    if frame:
        low = complex(min(low.real, frame[0].real), min(low.imag, frame[0].imag))
        high = complex(max(high.real, frame[1].real), max(high.imag, frame[1].imag))
    written = _notes(notes, (low.real + high.real) / 2, low.imag - 3.0)
    below, above = bounds((*done.items, *written))
    low = complex(min(low.real, below.real), min(low.imag, below.imag)) - complex(margin, margin)
    high = complex(max(high.real, above.real), max(high.imag, above.imag)) + complex(margin, margin)
    size = high - low
    items = tuple(moved(item, -low) for item in (*done.items, *written))
    return Scene(size.real, size.imag, items, title)


def _notes(notes: Sequence[Content], x: float, y: float) -> tuple[Item, ...]:
    """Lines of text centred on x, the first below y."""
    lines: list[Item] = []
    for note in notes:
        extent = box(note, LABEL)
        height = extent.height + extent.depth
        lines.append(Label(complex(x, y - height / 2), note, "center", LABEL))
        y -= height + 1.5
    return tuple(lines)
