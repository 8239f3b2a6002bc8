"""Drawing sheets: plates in true size on paper, the room inside frame and title block, and reports' figures enlarged.

A sheet's origin is its lower left corner; lengths are millimetres of paper.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import lru_cache
from typing import TypeVar

from reportgen.base.records import Record, field, replace
from reportgen.drawing import (
    Arc,
    Arrow,
    Circle,
    Content,
    Hatch,
    Item,
    Label,
    Line,
    Pen,
    Polyline,
    Scene,
    drawing_description,
    style,
)
from reportgen.drawing.drawing_description import Fact, fact
from reportgen.drawing.geometry import enlarged, moved
from reportgen.drawing.label_size import POINT, SCRIPT, box
from reportgen.formula import Number

GAP = 5.0
"""Gap between plates, and between them and the frame (mm)."""


class PlacedScene(Record):
    """A scene on a sheet with its lower left corner at `at`; `name` groups its items, `layer` is its CAD layer."""

    name: str
    layer: str
    scene: Scene
    at: complex = 0j

    @property
    def box(self) -> tuple[complex, complex]:
        """Return its lower left and upper right corner on the sheet (mm)."""
        return self.at, self.at + complex(self.scene.width, self.scene.height)


class DrawingSheet(Record):
    """A sheet of paper, `width` × `height` mm, with its drawings; `name` is the name of its size, such as A1.

    `fields` are the texts of its title block; a sheet without fields has no frame.
    """

    name: str
    width: float
    height: float
    parts: tuple[PlacedScene, ...] = ()
    fields: Mapping[str, str] = field(default_factory=dict)


class Room(Record):
    """Room inside a frame from corner `low` to `high`, without the title block.

    `block` (width, height) is the title block in the lower right corner.
    """

    low: complex
    high: complex
    block: complex


class TooLargeError(ValueError):
    """Raised if a plate, with its name and size (mm), does not fit a sheet of the requested size."""

    def __init__(self, name: str, width: float, height: float) -> None:
        super().__init__(name)
        self.name, self.width, self.height = name, width, height


# --- a report's figure with the letters, pens and arrowheads of a drawing sheet -------------------
# Letters are 3.5 mm high and indices 2.5 mm (ISO 3098), lines 0.7 or 0.35 mm wide (ISO 128). The figure is drawn
# small and enlarged like a photograph, so that labels keep the places that were found for them; then the few
# standard sizes replace the resulting ones.

CAPITAL = 0.683
"""Height of capitals as a share of the font size."""
LEAST = 2.5
"""The least height of capitals, that of indices (mm)."""
HEADING = 5.0
"""Height of capitals in the heading of a plate (mm)."""
WIDE, NARROW = 0.7, 0.35
"""Line widths (mm)."""
OUTLINE = 0.28
"""Pens of a report from this width (mm) become wide lines on a sheet."""
HEAD = 5.5
"""Length of every arrowhead (mm)."""

LINE_GAP = 2.5
"""Gap between the lines of a heading (mm)."""
TALLEST = "Ồg"
"""Letters of the greatest height and depth."""


def font_size(height: float) -> float:
    """Return the font size (pt) whose capitals are `height` mm high."""
    return height / (CAPITAL * POINT)


ENLARGED = font_size(LEAST) / (SCRIPT * style.SMALL)
"""Enlargement of a figure on a sheet relative to a report: the indices of its smallest letters become 2.5 mm high."""
LETTERS = ENLARGED * style.SMALL
"""Font size of all letters (pt)."""


def lettered(scene: Scene) -> Scene:
    """Return a report's figure as a drawing sheet has it: `ENLARGED` times as large, with its title below it.

    All letters, line widths and arrowheads get the standard sizes of a sheet.
    """
    items = [_standard(enlarged(item, ENLARGED)) for item in scene.items]
    facts = drawing_description.enlarged(scene.description, ENLARGED)
    width, height = ENLARGED * scene.width, ENLARGED * scene.height
    if not scene.title:
        return Scene(width, height, tuple(items), description=facts)
    title = box(scene.title, LETTERS)
    by, below = max(title.width - width, 0.0) / 2, title.height + title.depth + LINE_GAP / 2
    items = [moved(item, complex(by, below)) for item in items]
    items.append(Label(complex(by + width / 2, 0), scene.title, "bottom", LETTERS))
    return Scene(width + 2 * by, height + below, tuple(items), description=(fact("part", scene.title), *facts))


def _standard(item: Item) -> Item:
    match item:
        case Label():
            return replace(item, size=LETTERS)
        case Arrow(_, _, stroke, head) | Arc(_, _, _, _, stroke, head):
            return replace(item, stroke=_pen(stroke), head=HEAD if head > 0 else 0.0)
        case Line(_, _, stroke) | Hatch(_, _, stroke):
            return replace(item, stroke=_pen(stroke))
        case Circle(_, _, outline) | Polyline(_, outline):
            return replace(item, stroke=outline and _pen(outline))


@lru_cache(maxsize=256)
def _pen(stroke: Pen) -> Pen:
    return replace(stroke, width=WIDE if stroke.width >= ENLARGED * OUTLINE else NARROW)


def headed(name: str, *lines: Content) -> Scene:
    """Return the head of a plate: its name in larger letters, and lines below it, on fixed baselines."""
    rows: list[tuple[Content, float]] = [(name, font_size(HEADING)), *((line, LETTERS) for line in lines)]
    boxes = [box(content, size) for content, size in rows]
    widest = max(extent.width for extent in boxes)
    items: list[Item] = []
    base = 0.0
    for (content, size), extent in zip(rows, boxes, strict=True):
        tall = box(TALLEST, size)
        base -= tall.height
        items.append(Label(complex(widest / 2, base - extent.depth), content, "bottom", size))
        base -= tall.depth + LINE_GAP
    facts = (fact("plate", name), *(fact("line", line) for line in lines))
    return Scene(widest, -base, tuple(moved(item, -1j * base) for item in items), description=facts)


# --- a ruled table as a drawing, for sheets that contain only drawings -----------------------------
ROW = 5.0
"""Height of a row (mm)."""
PADDING = 1.4
"""Padding beside the widest content of a column (mm)."""
EDGE, RULE = Pen(0.35), Pen(0.15)


def widths(rows: Sequence[Sequence[Content]]) -> list[float]:
    """Return the widths (mm) of the columns of a table: the widest cell with its padding.

    Raises `ValueError` if the rows have different numbers of cells.
    """
    columns = zip(*rows, strict=True)
    return [max(box(cell, style.SMALL).width for cell in column) + 2 * PADDING for column in columns]


def grid(head: Sequence[Sequence[Content]], rows: Sequence[Sequence[Content]]) -> Scene:
    """Draw a table of `head` rows and the `rows` below them; columns are as wide as their widest cell.

    Raises `ValueError` if the rows have different numbers of cells.
    """
    every = [*head, *rows]
    across = widths(every)
    width, height = sum(across), ROW * len(every)
    items: list[Item] = []
    for number, row in enumerate(every):
        left, middle = 0.0, height - ROW * (number + 0.5)
        for cell, wide in zip(row, across, strict=True):
            if cell != "":
                items.append(Label(complex(left + wide / 2, middle), cell, size=style.SMALL))
            left += wide
        if number:
            below = height - ROW * number
            items.append(Line(complex(0, below), complex(width, below), EDGE if number == len(head) else RULE))
    for left in (sum(across[:n]) for n in range(1, len(across))):
        items.append(Line(complex(left, 0), complex(left, height), RULE))
    items.append(Polyline((0j, complex(width, 0), complex(width, height), complex(0, height)), EDGE, closed=True))
    facts = (fact("table", Number(len(rows)), Number(len(across))),)
    return Scene(width, height, tuple(items), description=facts)


# --- scenes of one scale together -----------------------------------------------------------------

Part = TypeVar("Part")

TITLE_HEIGHT = 4.5
NOTE_HEIGHT = 6.0
TRIM = 3.5
"""Part of a drawing's margin (mm, each side) that its neighbours on a sheet may use."""


def sheets(
    scenes: Sequence[Scene], width: float, height: float, note: Content | None = None, trim: float = TRIM
) -> tuple[Scene, ...]:
    """Return the scenes in true size on as many sheets, `width` mm wide and at most `height` mm high, as they need.

    Rows are filled in order and spread over the width; each scene's title is below it and `note` (the common scale)
    below all.  `trim` mm of each scene's margin are removed on each side.  A sheet is only as high as its rows; a scene
    larger than the sheet enlarges it.
    """
    foot = NOTE_HEIGHT if note is not None else 0.0

    def wide(scene: Scene) -> float:
        return scene.width - 2 * trim

    def high(row: Sequence[Scene]) -> float:
        return max(scene.height for scene in row) - 2 * trim + TITLE_HEIGHT

    def sheet(rows: Sequence[Sequence[Scene]]) -> Scene:
        """Return a sheet as high as its rows; the scenes of a row share a base line."""
        across = max(width, *(sum(map(wide, row)) for row in rows))
        top = full = foot + sum(map(high, rows))
        items: list[Item] = []
        facts: list[Fact] = []
        for row in rows:
            top -= high(row)
            x = space = (across - sum(map(wide, row))) / (len(row) + 1)
            for scene in row:
                corner = complex(x - trim, top + TITLE_HEIGHT - trim)
                items += [moved(item, corner) for item in scene.items]
                facts += [fact("part", scene.title)] if scene.title else []
                facts += scene.description
                if scene.title:
                    items.append(Label(complex(x + wide(scene) / 2, top + TITLE_HEIGHT / 2), scene.title))
                x += wide(scene) + space
        if note is not None:
            items.append(Label(complex(across / 2, NOTE_HEIGHT / 3), note))
            facts.append(fact("scale", note))
        return Scene(across, full, tuple(items), description=tuple(facts))

    rows = _filled(scenes, wide, width)
    return tuple(map(sheet, _filled(rows, high, height - foot)))


def _filled(parts: Iterable[Part], size: Callable[[Part], float], room: float) -> list[list[Part]]:
    """Return the parts in groups, in order, each filled as far as the room allows."""
    groups: list[list[Part]] = []
    for part in parts:
        if groups and sum(map(size, groups[-1])) + size(part) <= room:
            groups[-1].append(part)
        else:
            groups.append([part])
    return groups
