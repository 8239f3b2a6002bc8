"""Drawing sheets: plates in true size on paper, and the room that frame and title block leave them.

A sheet's origin is its lower left corner; lengths are millimetres of paper.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import lru_cache
from itertools import pairwise

from reportgen.drawing import Arc, Arrow, Circle, Content, Hatch, Item, Label, Line, Pen, Polyline, Scene, style
from reportgen.drawing.geometry import POINT, SCRIPT, box, enlarged, moved
from reportgen.formula import Chain, Number, Symbol

GAP = 5.0
"""White between plates, and between them and the frame, mm."""


@dataclass(frozen=True, slots=True)
class PlacedScene:
    """A scene on a sheet with its lower left corner `at`; `name` groups its items, `layer` says what it shows.

    `table` is the width and height of what of it may be stretched, nothing if it is no table.
    """

    name: str
    layer: str
    scene: Scene
    at: complex = 0j
    table: complex = 0j

    @property
    def box(self) -> tuple[complex, complex]:
        """Its lower left and upper right corner on the sheet."""
        return self.at, self.at + complex(self.scene.width, self.scene.height)


@dataclass(frozen=True, slots=True)
class DrawingSheet:
    """A sheet of paper `width` × `height` with what is drawn on it; `name` is that of its size, such as A1.

    `fields` are what its title block says; one without has no frame.
    """

    name: str
    width: float
    height: float
    parts: tuple[PlacedScene, ...] = ()
    fields: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Room:
    """What a frame leaves free: from corner `low` to `high`, without the box from `low`'s height up at the right.

    `block` (width, height) is the title block in the lower right corner.
    """

    low: complex
    high: complex
    block: complex

    @property
    def area(self) -> float:
        size = self.high - self.low
        return size.real * size.imag - self.block.real * self.block.imag


class TooLargeError(ValueError):
    """A plate has no place on a sheet of the size asked for."""

    def __init__(self, part: PlacedScene) -> None:
        super().__init__(part.name)
        self.part = part


def filled(parts: Iterable[PlacedScene], room: Room) -> float:
    """The share of a sheet's free area that the boxes of plates, captions included, take."""
    return sum(part.scene.width * part.scene.height for part in parts) / room.area


# --- a report's figure with the letters, pens and arrowheads of a drawing sheet -------------------
# Letters are 3.5 mm high and indices 2.5 mm (ISO 3098), lines 0.7 or 0.35 mm wide (ISO 128). The figure is drawn
# small and enlarged as a photograph is, so that labels keep the places that were found for them; then the few sizes
# of the standards take the place of those that came out.

CAPITAL = 0.683
"""Height of capitals in font sizes."""
LEAST = 2.5
"""The least height of capitals, mm: that of indices."""
HEADING = 5.0
"""Height of capitals in the heading of a plate, mm."""
WIDE, NARROW = 0.7, 0.35
"""Widths of lines, mm."""
OUTLINE = 0.28
"""What a report draws with a pen of this width (mm) or a wider one is wide on a sheet."""
HEAD = 5.5
"""Length of every arrowhead, mm."""

LINE_GAP = 2.5
"""White between the lines of a heading, mm."""


def font_size(height: float) -> float:
    """The font size in points whose capitals are `height` mm high."""
    return height / (CAPITAL * POINT)


ENLARGED = font_size(LEAST) / (SCRIPT * style.SMALL)
"""How many times a sheet shows a figure larger than a report: the indices of its smallest letters are 2.5 mm high."""
LETTERS = ENLARGED * style.SMALL
"""Font size of all letters, in points."""


def lettered(scene: Scene) -> Scene:
    """A figure of a report as a sheet shows it, `ENLARGED` times as large.

    The scales that it prints are as much smaller, as after any enlargement.
    """
    items = tuple(_standard(enlarged(item, ENLARGED)) for item in scene.items)
    return Scene(ENLARGED * scene.width, ENLARGED * scene.height, items, scene.title)


def _standard(item: Item) -> Item:
    match item:
        case Label(_, content):
            return replace(item, content=_rescaled(content), size=LETTERS)
        case Arrow(_, _, stroke, head) | Arc(_, _, _, _, stroke, head):
            return replace(item, stroke=_pen(stroke), head=HEAD if head > 0 else 0.0)
        case Line(_, _, stroke) | Hatch(_, _, stroke):
            return replace(item, stroke=_pen(stroke))
        case Circle(_, _, outline) | Polyline(_, outline):
            return replace(item, stroke=outline and _pen(outline))


@lru_cache(maxsize=256)
def _pen(stroke: Pen) -> Pen:
    return replace(stroke, width=WIDE if stroke.width >= ENLARGED * OUTLINE else NARROW)


def _rescaled(content: Content) -> Content:
    """A printed scale after the enlargement: μ = 4 N/mm becomes μ = 2 N/mm where all is twice as long."""
    match content:
        case Chain((Symbol("μ") as symbol, Number(value) as number), note):
            return Chain((symbol, replace(number, value=float(f"{value / ENLARGED:.5g}"), decimals=None)), note)
        case _:
            return content


def headed(scene: Scene, name: str, place: str) -> Scene:
    """A plate: its name in larger letters, below it what it shows of this in a line, then the scene."""
    lines = [(name, font_size(HEADING)), *([(place, LETTERS)] if place else [])]
    boxes = [box(content, size) for content, size in lines]
    width = max(scene.width, *(one.width for one in boxes))
    items: list[Item] = [moved(item, complex((width - scene.width) / 2, 0)) for item in scene.items]
    top = scene.height + sum(one.height + one.depth + LINE_GAP for one in boxes)
    height = top
    for (content, size), extent in zip(lines, boxes, strict=True):
        items.append(Label(complex(width / 2, top), content, "top", size))
        top -= extent.height + extent.depth + LINE_GAP
    return Scene(width, height, tuple(items))


# --- a ruled table as a drawing, for sheets on which everything is drawn --------------------------
ROW = 5.0
"""Height of a row, mm."""
PADDING = 1.4
"""White beside the widest content of a column, mm."""
EDGE, RULE = Pen(0.35), Pen(0.15)


@dataclass(frozen=True, slots=True)
class Form:
    """How a sheet sets what has no size of its own.

    Of a long table: how wide it may be (mm), how many rows it may have; of curves: their `shape`, width over height.
    """

    widest: float = 180.0
    rows: int = 100
    parts: int = 1
    """It is broken into so many parts at least."""
    shape: float = 2.0

    def broken(self, positions: Sequence[int]) -> list[Sequence[int]]:
        """The positions in parts of about as many rows each."""
        count = min(max(math.ceil(len(positions) / self.rows), self.parts), len(positions))
        ends = [round(n * len(positions) / count) for n in range(count + 1)]
        return [positions[start:end] for start, end in pairwise(ends)]


USUAL_FORM = Form()


def widths(rows: Sequence[Sequence[Content]]) -> list[float]:
    """The widths of columns: of each its widest cell with the white beside it."""
    columns = zip(*rows, strict=True)
    return [max(box(cell, style.SMALL).width for cell in column) + 2 * PADDING for column in columns]


def grid(head: Sequence[Sequence[Content]], rows: Sequence[Sequence[Content]]) -> Scene:
    """Rows below head rows, all of as many cells; columns are as wide as their widest cell."""
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
    return Scene(width, height, tuple(items))


def stretched(scene: Scene, table: complex, stretch: complex) -> Scene:
    """A table of a width and a height, and what stands above it, in the middle: the table so many times as large.

    Letters stay as they are.
    """
    width = max(scene.width, table.real * stretch.real)
    left = (scene.width - table.real) / 2
    begin = (width - table.real * stretch.real) / 2

    def at(point: complex) -> complex:
        return complex(begin + (point.real - left) * stretch.real, point.imag * stretch.imag)

    higher = complex((width - scene.width) / 2, table.imag * (stretch.imag - 1))
    items: list[Item] = []
    for one in scene.items:
        match one:
            case Label(place):
                items.append(replace(one, at=place + higher if place.imag > table.imag else at(place)))
            case Line(start, end):
                items.append(replace(one, start=at(start), end=at(end)))
            case Polyline(points):
                items.append(replace(one, points=tuple(map(at, points))))
            case _:
                raise TypeError(one)
    return Scene(width, scene.height + higher.imag, tuple(items), scene.title)
