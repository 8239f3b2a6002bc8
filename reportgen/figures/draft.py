"""From drafts to finished scenes, and scenes of one scale together on sheets of paper.

Every figure makes a `Draft` in mm about any origin; drafts with the same origin can be added.  `finish`
places the labels, crops to the content and gives the `Scene`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import TypeVar

from reportgen.figures import style
from reportgen.figures.geometry import bounds, corners_of, moved
from reportgen.figures.labels import Request, place
from reportgen.figures.metrics import box
from reportgen.figures.scene import Content, Item, Label, Scene

Part = TypeVar("Part")

MARGIN = 6.0
TITLE_HEIGHT = 4.5
NOTE_HEIGHT = 6.0
TRIM = 3.5
"""What of a drawing's white margin (mm, each side) its neighbours on a sheet may use."""


@dataclass(frozen=True, slots=True)
class Draft:
    """Items in the order of painting and the labels still to be placed."""

    items: tuple[Item, ...] = ()
    requests: tuple[Request, ...] = ()

    def __add__(self, other: Draft) -> Draft:
        return Draft(self.items + other.items, self.requests + other.requests)

    def moved(self, by: complex) -> Draft:
        """The draft shifted by a vector; its labels must have been placed before."""
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

    `frame` (lower left, upper right) is kept even where nothing is drawn, so that several scenes get
    the same paper.
    """
    done = settle(draft)
    low, high = corners_of((*bounds(done.items), *(frame or ())))
    below = _notes(notes, (low.real + high.real) / 2, low.imag - 3.0)
    low, high = corners_of((low, high, *bounds((*done.items, *below))))
    white = complex(margin, margin)
    size = high + white - (low - white)
    items = tuple(moved(item, -(low - white)) for item in (*done.items, *below))
    return Scene(size.real, size.imag, items, title)


def _notes(notes: Sequence[Content], x: float, y: float) -> tuple[Item, ...]:
    """Lines of text centred on x, the first below y."""
    lines: list[Item] = []
    for note in notes:
        extent = box(note, style.LABEL)
        height = extent.height + extent.depth
        lines.append(Label(complex(x, y - height / 2), note, "center", style.LABEL))
        y -= height + 1.5
    return tuple(lines)


# --- sheets ---------------------------------------------------------------------------------------


def sheets(
    scenes: Sequence[Scene], width: float, height: float, note: Content | None = None, trim: float = TRIM
) -> tuple[Scene, ...]:
    """The scenes in true size on as many sheets of `width` × `height` mm as they need.

    Rows are filled in order and spread over the width; each scene's title stands below it and `note` (the
    common scale) below all.  Of each scene's margin `trim` mm are given up.  A scene larger than the sheet
    gets one of its own size.
    """
    foot = NOTE_HEIGHT if note is not None else 0.0

    def wide(scene: Scene) -> float:
        return scene.width - 2 * trim

    def high(row: Sequence[Scene]) -> float:
        return max(scene.height for scene in row) - 2 * trim + TITLE_HEIGHT

    def sheet(rows: Sequence[Sequence[Scene]]) -> Scene:
        """As high as its rows; the scenes of a row stand on a common base line."""
        across = max(width, *(sum(map(wide, row)) for row in rows))
        top = full = foot + sum(map(high, rows))
        items: list[Item] = []
        for row in rows:
            top -= high(row)
            x = space = (across - sum(map(wide, row))) / (len(row) + 1)
            for scene in row:
                corner = complex(x - trim, top + TITLE_HEIGHT - trim)
                items += [moved(item, corner) for item in scene.items]
                if scene.title:
                    items.append(Label(complex(x + wide(scene) / 2, top + TITLE_HEIGHT / 2), scene.title))
                x += wide(scene) + space
        if note is not None:
            items.append(Label(complex(across / 2, NOTE_HEIGHT / 3), note))
        return Scene(across, full, tuple(items))

    rows = _filled(scenes, wide, width)
    return tuple(map(sheet, _filled(rows, high, height - foot)))


def _filled(parts: Iterable[Part], size: Callable[[Part], float], room: float) -> list[list[Part]]:
    """The parts in groups, in order, each group as large as the room allows."""
    groups: list[list[Part]] = []
    for part in parts:
        if groups and sum(map(size, groups[-1])) + size(part) <= room:
            groups[-1].append(part)
        else:
            groups.append([part])
    return groups
