"""Turn drafts (`Canvas`) into finished scenes.

Every figure makes a `Canvas` in mm about any origin; drafts with the same origin can be added, together with their
descriptions.  `finish` places the labels, crops to the content and returns the `Scene`.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import reduce

from reportgen.base.records import Record
from reportgen.base.stable_digits import settled
from reportgen.drawing import Content, Description, Item, Scene, style
from reportgen.drawing.drawing_description import fact
from reportgen.drawing.geometry import bounds, corners_of, moved
from reportgen.drawing.label_size import Box, box
from reportgen.drawing.labels import Request, label_row, place
from reportgen.formula import Chain, Symbol

MARGIN = 6.0
"""Usual margin of a scene on each side (mm)."""


class Canvas(Record):
    """A draft: items in painting order, labels still to be placed, and the text description for screen readers."""

    items: tuple[Item, ...] = ()
    requests: tuple[Request, ...] = ()
    says: Description = ()

    def __add__(self, other: Canvas) -> Canvas:
        return Canvas(self.items + other.items, self.requests + other.requests, self.says + other.says)

    def moved(self, by: complex) -> Canvas:
        """Return the items and the description, shifted by a vector (mm).

        Label requests are dropped: place the labels with `settle` first.
        """
        return Canvas(tuple(moved(item, by) for item in self.items), says=self.says)


def settle(draft: Canvas) -> Canvas:
    """Return the draft with its labels placed, as items; it has no requests left.

    The lines of a key (`Placed.key`) are not drawn.
    """
    return Canvas(draft.items + place(draft.items, draft.requests).items, says=draft.says)


def finish(
    draft: Canvas,
    *,
    notes: Sequence[Content] = (),
    title: str = "",
    margin: float = MARGIN,
    frame: tuple[complex, complex] | None = None,
) -> Scene:
    """Place the labels of a draft and return its scene, cropped to the content with a `margin` (mm) on each side.

    The key of the labels and the `notes` (the figure's scale) are centred below the content; the notes come last in
    the text description.  The `frame` (lower left and upper right corner, mm) stays inside the scene even if nothing
    is drawn there, so that several scenes have the same size.
    """
    labels = place(draft.items, draft.requests)
    done = Canvas(draft.items + labels.items)
    low, high = corners_of((*bounds(done.items), *(frame or ())))
    below = _notes([*labels.key, *((note,) for note in notes)], (low.real + high.real) / 2, low.imag - 3.0)
    low, high = corners_of((low, high, *(bounds(below) if below else ())))
    white = complex(margin, margin)
    size = high + white - (low - white)
    items = tuple(moved(item, -(low - white)) for item in (*done.items, *below))
    description = (*draft.says, *(fact("scale" if _is_scale(note) else "line", note) for note in notes))
    return Scene(settled(size.real), settled(size.imag), items, title, margin, labels.crowded, description=description)


def _is_scale(note: Content) -> bool:
    """Return True if a note gives a scale, μ of something, and no other quantity."""
    first = note.parts[0] if isinstance(note, Chain) else note
    return isinstance(first, Symbol) and first.base == "μ"


def _notes(notes: Iterable[Sequence[Content]], x: float, y: float) -> tuple[Item, ...]:
    """Return lines of text, each of several parts, centred on x, the first one below y."""
    lines: list[Item] = []
    for note in notes:
        extent = reduce(Box.beside, (box(part, style.LABEL) for part in note))
        height = extent.height + extent.depth
        lines += label_row(complex(x, y - height / 2), note, style.LABEL)
        y -= height + 1.5
    return tuple(lines)
