"""Convert a scene into the source of either typesetter, in true size, with labels in the report's fonts.

For Typst, a drawing is a sequence of calls of its primitives, whose short names (`S`, `L`, `A`, …) the frame defines.
For LaTeX, it is a TeX box of PDF operators under one matrix that makes the millimetre their unit. Coordinates are those
of the scene to 0.001 mm.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import groupby

from reportgen.drawing import Anchor, Arc, Arrow, Circle, Hatch, Item, Label, Line, Pen, Polyline, Scene
from reportgen.drawing.style import Bezier, Triangle, arc_to_beziers, arc_with_head, arrow_head, clip_hatch, decimal
from reportgen.formula.formula_setter import TextSetter

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
"""Typst's alignment, and the share of the sheet's width and height (from the top) that offsets are measured from."""
LABEL_SIZE = 9.0
"""Default size of labels in points, which LaTeX's `\\scene` sets; any other size is written before its label."""


# --- Typst ----------------------------------------------------------------------------------------


def paint_typst(scene: Scene, formulas: TextSetter) -> str:
    """Return a Typst code expression that draws the scene in a box of `scene.width` × `scene.height` mm."""
    strokes = dict.fromkeys(
        item.stroke for item in scene.items if not isinstance(item, Label) and item.stroke is not None
    )
    lines = [f"let p{index}={_typst_pen(stroke)}" for index, stroke in enumerate(strokes)]
    pens: dict[Pen | None, str] = {stroke: f"p{index}" for index, stroke in enumerate(strokes)}
    pens[None] = "none"
    lines += [line for item in scene.items for line in _calls(item, scene, pens, formulas)]
    return f"S({decimal(scene.width)},{decimal(scene.height)},{{" + "\n".join(lines) + "})"


def _calls(item: Item, scene: Scene, pens: Mapping[Pen | None, str], formulas: TextSetter) -> list[str]:
    """Return the calls that draw an item; the y axis is reversed here, once for all items."""

    def at(*points: complex) -> str:
        return ",".join(f"{decimal(point.real)},{decimal(scene.height - point.imag)}" for point in points)

    def head(triangle: Triangle | None, stroke: Pen) -> list[str]:
        return [f"G({_rgb(stroke.colour)},{at(*triangle)})"] if triangle else []

    match item:
        case Line(start, end, stroke):
            return [f"L({pens[stroke]},{at(start, end)})"]
        case Arrow(start, end, stroke, length):
            shaft_end, triangle = arrow_head(start, end, length)
            return [f"L({pens[stroke]},{at(start, shaft_end)})", *head(triangle, stroke)]
        case Circle(centre, radius, outline, fill):
            corner = at(complex(centre.real - radius, centre.imag + radius))
            return [f"O({pens[outline]},{_rgb(fill)},{corner},{decimal(radius)})"]
        case Arc(stroke=stroke):
            curves, triangle = arc_with_head(item)
            cubics = ",".join(at(*curve[1:]) for curve in curves)
            return [f"B({pens[stroke]},{at(curves[0][0])},{cubics})", *head(triangle, stroke)]
        case Polyline(points, outline, closed, fill):
            name = "C" if closed else "Y"
            return [f"{name}({pens[outline]},{_rgb(fill)},{at(*points)})"] if points else []
        case Hatch(points, spacing, stroke, turn):
            strokes = clip_hatch(points, spacing, turn)
            ends = ",".join(at(*segment) for segment in strokes)
            return [f"H({pens[stroke]},{ends})"] if strokes else []
        case Label():
            return [_call_of_label(item, scene, formulas)]


def _call_of_label(label: Label, scene: Scene, formulas: TextSetter) -> str:
    options = (",turn:true" if label.turn else "") + (",paper:true" if label.background else "")
    options += f",narrow:{100 * label.narrow:.4g}%" if label.narrow < 1.0 else ""
    anchor, across, down = ANCHORS[label.anchor]
    x = decimal(label.at.real - across * scene.width)
    y = decimal((1 - down) * scene.height - label.at.imag)
    return f"T({anchor},{x},{y},{label.size:g}pt,{formulas.content(label.content)}{options})"


def _typst_pen(stroke: Pen) -> str:
    dash = "".join(f"{decimal(length)}mm," for length in stroke.dash)
    return f"P({decimal(stroke.width)},{_rgb(stroke.colour)},{f'({dash})' if dash else 'none'})"


def _rgb(colour: str | None) -> str:
    return "none" if colour is None else f'rgb("{colour}")'


# --- LaTeX ----------------------------------------------------------------------------------------


def paint_latex(scene: Scene, formulas: TextSetter) -> str:
    """Return the TeX source of one box, `scene.width` × `scene.height` mm, with its reference point at the lower left.

    Raises `TypesetterError` for a label with a character that the fonts do not have.
    """
    runs: list[str] = []
    size = LABEL_SIZE
    for labels, items in groupby(scene.items, key=lambda item: isinstance(item, Label)):
        if labels:
            for item in items:
                assert isinstance(item, Label)
                # Changing the font size is slow in LaTeX.
                if item.size != size:
                    size = item.size
                    runs.append(rf"\fontsize{{{decimal(size)}}}{{{decimal(1.2 * size)}}}\selectfont")
                runs.append(_box_of_label(item, formulas))
        else:
            runs.append("\\strokes{" + "\n".join(_operators(items)) + "}%")
    body = "\n".join(runs)
    return f"\\scene{{{decimal(scene.width)}}}{{{decimal(scene.height)}}}{{%\n{body}\n}}"


def _box_of_label(label: Label, formulas: TextSetter) -> str:
    content = formulas.content(label.content)
    if label.turn % 360 == 90:
        content = rf"\lbturned{{{content}}}"
    if label.background:
        content = rf"\lbpaper{{{content}}}"
    # Shares of the box's width and height to the left of and below the anchor.
    along = "0" if "left" in label.anchor else "1" if "right" in label.anchor else ".5"
    up = "0" if "bottom" in label.anchor else "1" if "top" in label.anchor else ".5"
    return rf"\lb{{{decimal(label.at.real)}}}{{{decimal(label.at.imag)}}}{{{along}}}{{{up}}}{{{content}}}%"


def _operators(items: Iterable[Item]) -> Iterator[str]:
    """Yield PDF operators of items that are not labels; a pen is written only where it changes."""
    pen: Pen | None = None
    paper: str | None = None
    for item in items:
        stroke, fill, path = _shape(item)
        if stroke and stroke != pen:
            yield _pen(stroke)
            pen = stroke
        if fill and fill != paper:
            yield f"{_colour(fill)} rg"
            paper = fill
        yield path


def _shape(item: Item) -> tuple[Pen | None, str | None, str]:
    """Return pen, fill colour and path with its painting operators of an item."""
    match item:
        case Line(start, end, stroke):
            return stroke, None, _path((start, end), "S")
        case Arrow(start, end, stroke, head):
            shaft, triangle = arrow_head(start, end, head)
            return stroke, stroke.colour, _path((start, shaft), "S") + _head(triangle)
        case Circle(centre, radius, pen, fill):
            pieces = arc_to_beziers(centre, radius, 0.0, math.tau)
            return pen, fill, _curve(pieces) + " h" + _paint(pen, fill)
        case Arc(stroke=stroke):
            pieces, triangle = arc_with_head(item)
            return stroke, stroke.colour if triangle else None, _curve(pieces) + " S" + _head(triangle)
        case Polyline(points, pen, closed, fill):
            return pen, fill, _path(points, "h" if closed else "") + _paint(pen, fill)
        case Hatch(points, spacing, stroke, turn):
            return stroke, None, "\n".join(_path(pair, "S") for pair in clip_hatch(points, spacing, turn))
        case _:
            return None, None, ""


def _path(points: Sequence[complex], end: str) -> str:
    """Return the operators of a polyline, followed by `end`."""
    if len(points) < 2:
        return "n"
    first, *others = (_point(point) for point in points)
    return " ".join([f"{first} m", *(f"{point} l" for point in others), end]).rstrip()


def _curve(pieces: Sequence[Bezier]) -> str:
    later = " ".join(f"{_point(b)} {_point(c)} {_point(d)} c" for _, b, c, d in pieces)
    return f"{_point(pieces[0][0])} m {later}"


def _head(triangle: Triangle | None) -> str:
    return "\n" + _path(triangle, "h f") if triangle else ""


def _paint(pen: Pen | None, fill: str | None) -> str:
    return " B" if pen and fill else " f" if fill else " S" if pen else " n"


def _pen(stroke: Pen) -> str:
    dash = " ".join(map(decimal, stroke.dash))
    return f"{decimal(stroke.width)} w {_colour(stroke.colour)} RG [{dash}] 0 d"


def _colour(colour: str) -> str:
    return " ".join(decimal(int(colour[at : at + 2], 16) / 255) for at in (1, 3, 5))


def _point(point: complex) -> str:
    return f"{decimal(point.real)} {decimal(point.imag)}"
