"""Many drawings of one scale on common sheets, as a draughtsman would lay them out: rows, in order."""

from __future__ import annotations

from collections.abc import Sequence

from reportgen.figures.geometry import moved
from reportgen.figures.scene import Label, Scene
from reportgen.figures.style import LABEL

TITLE_HEIGHT = 5.0
GAP = 3.0


def sheets(scenes: Sequence[Scene], width: float, height: float) -> tuple[Scene, ...]:
    """The scenes in true size on as many sheets of `width` × `height` mm as they need.

    Rows are filled in order and spread over the width; each scene's title stands below it.  A scene
    larger than the sheet gets one of its own size.
    """
    pages: list[list[_Row]] = [[]]
    for row in _rows(scenes, width):
        used = sum(other[1] for other in pages[-1])
        if pages[-1] and used + row[1] > height:
            pages.append([])
        pages[-1].append(row)
    return tuple(_sheet(page, width) for page in pages if page)


_Row = tuple[list[Scene], float]
"""Scenes side by side and the height they take with their titles."""


def _rows(scenes: Sequence[Scene], width: float) -> list[_Row]:
    rows: list[list[Scene]] = []
    for scene in scenes:
        taken = sum(other.width + GAP for other in rows[-1]) if rows else 0.0
        if rows and taken + scene.width <= width:
            rows[-1].append(scene)
        else:
            rows.append([scene])
    return [(row, max(scene.height for scene in row) + TITLE_HEIGHT + GAP) for row in rows]


def _sheet(rows: Sequence[_Row], width: float) -> Scene:
    """One sheet, as high as its rows; scenes of a row stand on a common base line."""
    wide = max(width, *(sum(scene.width for scene in row) for row, _ in rows))
    height = sum(high for _, high in rows)
    items = []
    top = height
    for row, high in rows:
        base = top - high + TITLE_HEIGHT + GAP
        space = (wide - sum(scene.width for scene in row)) / (len(row) + 1)
        x = space
        for scene in row:
            items += [moved(item, complex(x, base)) for item in scene.items]
            if scene.title:
                items.append(Label(complex(x + scene.width / 2, base - TITLE_HEIGHT / 2), scene.title, size=LABEL))
            x += scene.width + space
        top -= high
    return Scene(wide, height, tuple(items))
