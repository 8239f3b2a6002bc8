"""A report's figure with the letters, pens and arrowheads of a drawing sheet.

Letters are 3.5 mm high and indices 2.5 mm (ISO 3098), lines 0.7 or 0.35 mm wide (ISO 128).  The figure is drawn
small and enlarged as a photograph is, so that labels keep the places that were found for them; then the few sizes of
the standards take the place of those that came out.
"""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

from reportgen.figures import style
from reportgen.figures.geometry import enlarged, moved
from reportgen.figures.metrics import POINT, SCRIPT, box
from reportgen.figures.scene import Arc, Arrow, Circle, Content, Hatch, Item, Label, Line, Polyline, Scene, Stroke
from reportgen.notation.expressions import Chain, Number, Symbol

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
def _pen(stroke: Stroke) -> Stroke:
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
