"""Many drawings of one scale on common sheets, as a draughtsman would lay them out: rows, in order."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from reportgen.figures.geometry import moved
from reportgen.figures.labels import Content
from reportgen.figures.scene import Item, Label, Scene
from reportgen.figures.style import LABEL

TITLE_HEIGHT = 4.5
NOTE_HEIGHT = 6.0
TRIM = 3.5
"""What of a drawing's white margin (mm, each side) its neighbours may use."""


def sheets(
    scenes: Sequence[Scene],
    width: float,
    height: float,
    note: Content | None = None,
    trim: float = TRIM,
) -> tuple[Scene, ...]:
    """The scenes in true size on as many sheets of `width` × `height` mm as they need.

    Rows are filled in order and spread over the width; each scene's title stands below it and `note` (the
    common scale) below all.  Of each scene's margin `trim` mm are given up.  A scene larger than the sheet
    gets one of its own size.
    """
    room = height - (NOTE_HEIGHT if note is not None else 0.0)
    pages: list[list[_Row]] = []
    for row in _rows(scenes, width, trim):
        if not pages or sum(other.height for other in pages[-1]) + row.height > room:
            pages.append([])
        pages[-1].append(row)
    return tuple(_sheet(page, width, note) for page in pages)


@dataclass(frozen=True, slots=True)
class _Row:
    """Scenes side by side, each without `trim` mm of its margin."""

    scenes: tuple[Scene, ...]
    trim: float

    @property
    def width(self) -> float:
        return sum(map(self.wide, self.scenes))

    @property
    def height(self) -> float:
        return max(scene.height for scene in self.scenes) - 2 * self.trim + TITLE_HEIGHT

    def wide(self, scene: Scene) -> float:
        return scene.width - 2 * self.trim


def _rows(scenes: Sequence[Scene], width: float, trim: float) -> list[_Row]:
    rows: list[_Row] = []
    for scene in scenes:
        if rows and rows[-1].width + rows[-1].wide(scene) <= width:
            rows[-1] = _Row((*rows[-1].scenes, scene), trim)
        else:
            rows.append(_Row((scene,), trim))
    return rows


def _sheet(rows: Sequence[_Row], width: float, note: Content | None) -> Scene:
    """One sheet, as high as its rows; scenes of a row stand on a common base line."""
    wide = max(width, *(row.width for row in rows))
    foot = NOTE_HEIGHT if note is not None else 0.0
    top = height = foot + sum(row.height for row in rows)
    items: list[Item] = []
    for row in rows:
        top -= row.height
        space = (wide - row.width) / (len(row.scenes) + 1)
        x = space
        for scene in row.scenes:
            corner = complex(x - row.trim, top + TITLE_HEIGHT - row.trim)
            items += [moved(item, corner) for item in scene.items]
            if scene.title:
                middle = complex(x + row.wide(scene) / 2, top + TITLE_HEIGHT / 2)
                items.append(Label(middle, scene.title, size=LABEL))
            x += row.wide(scene) + space
    if note is not None:
        items.append(Label(complex(wide / 2, NOTE_HEIGHT / 3), note, size=LABEL))
    return Scene(wide, height, tuple(items))
