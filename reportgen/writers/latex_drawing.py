r"""Scene → a TeX box of its exact size: strokes as PDF operators, labels set by TeX itself.

The operators run under one matrix that makes the millimetre their unit, so coordinates stay those of
the scene to 0.001 mm.  The macros \scene, \strokes, \lb, \lbpaper and \lbturned are the frame's.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from itertools import groupby

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
from reportgen.writers.latex_math import mathematics
from reportgen.writers.latex_text import escape
from reportgen.writers.strokes import (
    Bezier,
    Triangle,
    arc_to_beziers,
    arc_with_head,
    arrow_head,
    clip_hatch,
    decimal,
)

LABEL_SIZE = 9.0
"""The size of labels, in points, that `\\scene` sets; any other is written at the label."""


def paint(scene: Scene, language: Language) -> str:
    """The TeX source of one box, `scene.width` × `scene.height` mm, its reference point at the lower left.

    Raises `TypesetterError` for a label with a character the fonts do not have.
    """
    runs: list[str] = []
    for labels, items in groupby(scene.items, key=lambda item: isinstance(item, Label)):
        if labels:
            runs += (_label(item, language) for item in items if isinstance(item, Label))
        else:
            runs.append("\\strokes{" + "\n".join(_operators(items)) + "}%")
    body = "\n".join(runs)
    return f"\\scene{{{decimal(scene.width)}}}{{{decimal(scene.height)}}}{{%\n{body}\n}}"


# --- labels ---------------------------------------------------------------------------------------


def _label(label: Label, language: Language) -> str:
    words = label.content
    content = escape(words) if isinstance(words, str) else f"${mathematics(words, language)}$"
    if label.size != LABEL_SIZE:
        content = rf"\fontsize{{{decimal(label.size)}}}{{{decimal(1.2 * label.size)}}}\selectfont {content}"
    if label.turn % 360 == 90:
        content = rf"\lbturned{{{content}}}"
    if label.background:
        content = rf"\lbpaper{{{content}}}"
    along, up = _share(label.anchor)
    return rf"\lb{{{decimal(label.at.real)}}}{{{decimal(label.at.imag)}}}{{{along}}}{{{up}}}{{{content}}}%"


def _share(anchor: Anchor) -> tuple[str, str]:
    """Which part of the box's width and height lies left of and below the anchor."""
    along = "0" if "left" in anchor else "1" if "right" in anchor else ".5"
    up = "0" if "bottom" in anchor else "1" if "top" in anchor else ".5"
    return along, up


# --- strokes --------------------------------------------------------------------------------------


def _operators(items: Iterable[Item]) -> Iterator[str]:
    """PDF operators of items that are not labels; a pen is written only where it changes."""
    pen: Stroke | None = None
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


def _shape(item: Item) -> tuple[Stroke | None, str | None, str]:
    """(pen, fill colour, path with its painting operators) of an item."""
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
        case Hatch(points, spacing, stroke):
            return stroke, None, "\n".join(_path(pair, "S") for pair in clip_hatch(points, spacing))
        case _:
            return None, None, ""


def _path(points: Sequence[complex], end: str) -> str:
    """The operators of a broken line, then `end`."""
    if len(points) < 2:
        return "n"
    first, *others = (_point(point) for point in points)
    return " ".join([f"{first} m", *(f"{point} l" for point in others), end]).rstrip()


def _curve(pieces: Sequence[Bezier]) -> str:
    later = " ".join(f"{_point(b)} {_point(c)} {_point(d)} c" for _, b, c, d in pieces)
    return f"{_point(pieces[0][0])} m {later}"


def _head(triangle: Triangle | None) -> str:
    return "\n" + _path(triangle, "h f") if triangle else ""


def _paint(pen: Stroke | None, fill: str | None) -> str:
    return " B" if pen and fill else " f" if fill else " S" if pen else " n"


def _pen(stroke: Stroke) -> str:
    dash = " ".join(map(decimal, stroke.dash))
    return f"{decimal(stroke.width)} w {_colour(stroke.colour)} RG [{dash}] 0 d"


def _colour(colour: str) -> str:
    return " ".join(decimal(int(colour[at : at + 2], 16) / 255) for at in (1, 3, 5))


def _point(point: complex) -> str:
    return f"{decimal(point.real)} {decimal(point.imag)}"
