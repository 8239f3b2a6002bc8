"""Sheets whose plates stand in columns, and sheets with nothing but a profile in true size."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path

import numpy as np

from reportgen.base.errors import SheetError
from reportgen.base.units import MM
from reportgen.base.words import word
from reportgen.drawing import Circle, Item, Line, Pen, Polyline, Scene
from reportgen.drawing.sheet import GAP, DrawingSheet, PlacedScene, Room, headed, lettered
from reportgen.report.case import Opened
from reportgen.sheets.frame import DEFAULT, SIZES, blocks, fields_of, frame_scene, read_block, room

MARGIN = 15.0
"""White around the profile that is cut (mm)."""
AXES = Pen(0.18, "#6b6b6b", (5.0, 1.0, 0.8, 1.0))
CONTOUR = Pen(0.5)

Plate = tuple[str, str, Scene]
"""Name, layer and drawing."""


def titled(scene: Scene, title: str) -> Scene:
    return headed(lettered(scene), title, "")


def in_columns(
    case: Opened,
    title: str,
    sizes: Sequence[str],
    block: Path | None,
    drawn: Callable[[str], Iterable[Iterable[Plate]]],
    crowded: str,
) -> DrawingSheet:
    """The sheet of the first of the sizes that has room for the plates `drawn` for it, the first of which fit.

    Raises `SheetError`, with the word `crowded`, where none has.
    """
    language = case.assignment.language
    frame = read_block(block or blocks(case.assignment.report.school or "")[DEFAULT[language]], language)
    for paper in sizes:
        space = room(paper, frame.margins, frame.size)
        if parts := next(filter(None, (_placed(plates, space) for plates in drawn(paper))), None):
            width, height = SIZES[paper]
            fields = fields_of(case) | {"title": title, "sheet": "1", "sheets": "1", "format": paper}
            corner = complex(space.high.real - frame.size[0], space.low.imag)
            own = (
                PlacedScene("frame", "frame", frame_scene(paper, frame.margins, frame.note(fields))),
                PlacedScene("title block", "frame", frame.scene(fields), corner),
            )
            return DrawingSheet(paper, width, height, (*own, *parts))
    raise SheetError(word(crowded, language, size=sizes[-1]))


def _placed(plates: Iterable[Plate], space: Room) -> list[PlacedScene]:
    """The plates in columns, each as high as there is room above the title block; none where they do not fit."""
    parts: list[PlacedScene] = []
    left, top, widest = space.low.real + GAP, space.high.imag - GAP, 0.0
    for name, layer, scene in plates:
        while True:
            below = space.low.imag + GAP
            if left + scene.width > space.high.real - space.block.real:
                below += space.block.imag
            if top - scene.height >= below:
                break
            if top == space.high.imag - GAP:
                return []
            left, top, widest = left + widest + GAP, space.high.imag - GAP, 0.0
        if left + scene.width > space.high.real - GAP:
            return []
        parts.append(PlacedScene(name, layer, scene, complex(left, top - scene.height)))
        top, widest = top - scene.height - GAP, max(widest, scene.width)
    return parts


def true_size(outline: np.ndarray, name: str = "1:1") -> DrawingSheet:
    """A closed profile (m) 1:1 with its axes, on paper as large as it needs."""
    points = outline * MM
    low = complex(points.real.min(), points.imag.min()) - MARGIN * (1 + 1j)
    high = complex(points.real.max(), points.imag.max()) + MARGIN * (1 + 1j)
    size = complex(math.ceil((high - low).real), math.ceil((high - low).imag))
    shift = -low
    axes: tuple[Item, ...] = (
        Line(complex(0, shift.imag), complex(size.real, shift.imag), AXES),
        Line(complex(shift.real, 0), complex(shift.real, size.imag), AXES),
        Circle(shift, 1.0, Pen(0.25)),
    )
    profile = Polyline(tuple(complex(p) for p in points + shift), CONTOUR, closed=True, smooth=True)
    parts = (
        PlacedScene("axes", "axes", Scene(size.real, size.imag, axes)),
        PlacedScene("profile", "profile", Scene(size.real, size.imag, (profile,))),
    )
    return DrawingSheet(name, size.real, size.imag, parts)
