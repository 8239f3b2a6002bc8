"""Scene → Typst: its own primitives at true size, labels set in the report's fonts.

The short names (`S`, `L`, `A`, …) are defined once, in the frame that the writer puts before the report.
"""

from __future__ import annotations

from collections.abc import Mapping

from reportgen.figures.scene import (
    Anchor,
    Arc,
    Arrow,
    Circle,
    Hatch,
    Item,
    Label,
    Line,
    Polyline,
    Scene,
    Stroke,
)
from reportgen.notation.numbers import Language
from reportgen.writers.strokes import Triangle, arc_with_head, arrow_head, clip_hatch, decimal
from reportgen.writers.typst_math import literal, math

ANCHORS: dict[Anchor, tuple[str, float, float]] = {
    "center": ("center+horizon", 0.5, 0.5),
    "left": ("left+horizon", 0.0, 0.5),
    "right": ("right+horizon", 1.0, 0.5),
    "top": ("center+top", 0.5, 0.0),
    "bottom": ("center+bottom", 0.5, 1.0),
    "top-left": ("left+top", 0.0, 0.0),
    "top-right": ("right+top", 1.0, 0.0),
    "bottom-left": ("left+bottom", 0.0, 1.0),
    "bottom-right": ("right+bottom", 1.0, 1.0),
}
"""Typst's alignment, and the share of the sheet's width and height (from the top) that it measures from."""


def paint(scene: Scene, language: Language) -> str:
    """A Typst code expression that draws the scene in a box of `scene.width` × `scene.height` mm."""
    strokes = dict.fromkeys(
        item.stroke for item in scene.items if not isinstance(item, Label) and item.stroke is not None
    )
    lines = [f"let p{index}={_pen(stroke)}" for index, stroke in enumerate(strokes)]
    pens: dict[Stroke | None, str] = {stroke: f"p{index}" for index, stroke in enumerate(strokes)}
    pens[None] = "none"
    lines += [line for item in scene.items for line in _item(item, scene, pens, language)]
    return f"S({decimal(scene.width)},{decimal(scene.height)},{{" + "\n".join(lines) + "})"


def _item(item: Item, scene: Scene, pens: Mapping[Stroke | None, str], language: Language) -> list[str]:
    """The calls that draw an item; y is turned over here, once for all."""

    def at(*points: complex) -> str:
        return ",".join(f"{decimal(point.real)},{decimal(scene.height - point.imag)}" for point in points)

    def head(triangle: Triangle | None, stroke: Stroke) -> list[str]:
        return [f"G({_colour(stroke.colour)},{at(*triangle)})"] if triangle else []

    match item:
        case Line(start, end, stroke):
            return [f"L({pens[stroke]},{at(start, end)})"]
        case Arrow(start, end, stroke, length):
            shaft_end, triangle = arrow_head(start, end, length)
            return [f"L({pens[stroke]},{at(start, shaft_end)})", *head(triangle, stroke)]
        case Circle(centre, radius, outline, fill):
            corner = at(complex(centre.real - radius, centre.imag + radius))
            return [f"O({pens[outline]},{_colour(fill)},{corner},{decimal(radius)})"]
        case Arc(stroke=stroke):
            curves, triangle = arc_with_head(item)
            cubics = ",".join(at(*curve[1:]) for curve in curves)
            return [f"B({pens[stroke]},{at(curves[0][0])},{cubics})", *head(triangle, stroke)]
        case Polyline(points, outline, closed, fill):
            name = "C" if closed else "Y"
            return [f"{name}({pens[outline]},{_colour(fill)},{at(*points)})"] if points else []
        case Hatch(points, spacing, stroke):
            strokes = clip_hatch(points, spacing)
            ends = ",".join(at(*segment) for segment in strokes)
            return [f"H({pens[stroke]},{ends})"] if strokes else []
        case Label():
            return [_label(item, scene, language)]


def _label(label: Label, scene: Scene, language: Language) -> str:
    content = label.content
    body = literal(content) if isinstance(content, str) else f"${math(content, language)}$"
    options = (",turn:true" if label.turn else "") + (",paper:true" if label.background else "")
    anchor, across, down = ANCHORS[label.anchor]
    x = decimal(label.at.real - across * scene.width)
    y = decimal((1 - down) * scene.height - label.at.imag)
    return f"T({anchor},{x},{y},{label.size:g}pt,{body}{options})"


def _pen(stroke: Stroke) -> str:
    dash = "".join(f"{decimal(length)}mm," for length in stroke.dash)
    return f"P({decimal(stroke.width)},{_colour(stroke.colour)},{f'({dash})' if dash else 'none'})"


def _colour(colour: str | None) -> str:
    return "none" if colour is None else f"rgb({literal(colour)})"
