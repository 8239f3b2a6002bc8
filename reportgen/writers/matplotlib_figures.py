"""Draw scenes and diagrams with matplotlib: axes that a user can extend, EPS files, and charts.

Only this module imports matplotlib, and it is imported on demand, because most commands do not need it. Everything is
drawn on a separate `Figure` without a window; pyplot is only asked for its current axes.
"""

from __future__ import annotations

import io
import re
from collections.abc import Iterator, Sequence
from functools import cache
from typing import Any

import matplotlib
from cycler import cycler
from matplotlib.artist import Artist
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.font_manager import findfont, get_font
from matplotlib.patches import Circle as CirclePatch
from matplotlib.patches import PathPatch, Polygon
from matplotlib.path import Path
from matplotlib.text import Text

from reportgen.base.units import Language
from reportgen.drawing import Arc, Arrow, Circle, Diagram, Hatch, Item, Label, Line, Pen, Polyline, Scene, style
from reportgen.drawing.mathtext import MathText
from reportgen.drawing.style import Bezier, Triangle, arc_with_head, arrow_head, clip_hatch

INCH, POINT = 25.4, 25.4 / 72
"""Millimetres per inch, and per point of matplotlib."""
STYLE: Any = {
    "mathtext.fontset": "stix",
    "ps.fonttype": 3,
    "pdf.fonttype": 3,
    "svg.hashsalt": "reportgen",
    "legend.framealpha": 1.0,
}
"""Fonts similar to the report's, no transparency (EPS has none), and the same bytes in every run."""
SIZE = (6.3, 3.6)
"""Size of a chart in inches: the width of a page's text."""
COLOURS = (style.BLUE, style.RED, style.BLACK, style.GRAY) * 2
DASHES = ("-", "--", "-.", ":", "--", "-.", ":", "-")
"""Dashes of successive curves."""
FONTS = ("STIXGeneral", "DejaVu Serif")
"""Fonts of texts: the first one that has all letters is used; for Vietnamese, this is the second."""
_DATED = re.compile(rb"^%%CreationDate: .*\n", re.MULTILINE)


def figure(scene: Scene, language: Language) -> Figure:
    """Return a figure with the size of a scene, true to scale; one unit of its axes is a millimetre."""
    with matplotlib.rc_context(STYLE):
        made = Figure((scene.width / INCH, scene.height / INCH))
        axes = made.add_axes((0.0, 0.0, 1.0, 1.0))
        axes.set(xlim=(0.0, scene.width), ylim=(0.0, scene.height))
        axes.axis("off")
        setter = MathText(language)
        for order, item in enumerate(scene.items):
            for artist in _artists(item, setter):
                artist.set_zorder(order)
                axes.add_artist(artist)
    return made


def eps(scene: Scene, language: Language) -> bytes:
    """Return a scene as Encapsulated PostScript, with STIX fonts."""
    return saved(figure(scene, language), "eps")


def eps_files(scenes: Sequence[Scene], language: Language, dpi: int = 0) -> list[bytes]:
    """Return scenes as EPS, whose lines need no `dpi`."""
    return [eps(scene, language) for scene in scenes]


def chart(diagram: Diagram, language: Language) -> Figure:
    """Return a figure of a diagram; its curves are distinguishable without colour, too."""
    with matplotlib.rc_context({**STYLE, "axes.prop_cycle": cycler(color=COLOURS) + cycler(linestyle=DASHES)}):
        made = Figure(SIZE, layout="constrained")
        diagram.on(made.subplots(), language)
        for text in made.findobj(Text):
            text.set_fontfamily(_font(text.get_text()))
    return made


def current_axes() -> Any:
    """Return the axes that pyplot shows in a notebook or a window; create them if there are none."""
    from matplotlib import pyplot

    return pyplot.gca()


def saved(made: Figure, format: str, dpi: int = 0) -> bytes:
    """Return the file of a figure, with the same bytes in every run."""
    stream = io.BytesIO()
    undated = {"svg": {"Date": None}, "pdf": {"CreationDate": None}}
    with matplotlib.rc_context(STYLE):
        made.savefig(stream, format=format, dpi=dpi or "figure", metadata=undated.get(format))
    return _DATED.sub(b"", stream.getvalue()) if format == "eps" else stream.getvalue()


# --- scenes ---------------------------------------------------------------------------------------


def _artists(item: Item, setter: MathText) -> Iterator[Artist]:
    """Yield the artists that draw an item of a scene."""
    match item:
        case Line(start, end, pen):
            yield _strokes([(start, end)], pen)
        case Arrow(start, end, pen, head):
            shaft, triangle = arrow_head(start, end, head)
            yield _strokes([(start, shaft)], pen)
            yield from _head(triangle, pen)
        case Circle(centre, radius, outline, fill):
            yield CirclePatch((centre.real, centre.imag), radius, **_look(outline, fill))
        case Arc(stroke=pen):
            pieces, triangle = arc_with_head(item)
            yield PathPatch(_curve(pieces), **_look(pen, None))
            yield from _head(triangle, pen)
        case Polyline(points, outline, closed, fill):
            if closed or fill:
                yield Polygon(_pairs(points), closed=closed, joinstyle="miter", **_look(outline, fill))
            elif outline:
                yield _strokes([points], outline)
        case Hatch(points, spacing, pen, turn):
            yield _strokes(clip_hatch(points, spacing, turn), pen)
        case Label():
            yield _text(item, setter)


def _strokes(runs: Sequence[Sequence[complex]], pen: Pen) -> LineCollection:
    look = _look(pen, None)
    return LineCollection(
        list(map(_pairs, runs)),
        colors=look["edgecolor"],
        linewidths=look["linewidth"],
        linestyles=[look["linestyle"]],
        capstyle="butt",
        joinstyle="miter",
    )


def _head(triangle: Triangle | None, pen: Pen) -> Iterator[Polygon]:
    if triangle:
        yield Polygon(_pairs(triangle), facecolor=pen.colour, edgecolor="none")


def _curve(pieces: Sequence[Bezier]) -> Path:
    places = [pieces[0][0], *(place for piece in pieces for place in piece[1:])]
    return Path(_pairs(places), [Path.MOVETO, *[Path.CURVE4] * (len(places) - 1)])


def _look(pen: Pen | None, fill: str | None) -> dict[str, Any]:
    """Return pen and fill of a patch; dashes are in multiples of the pen's width."""
    face = {"facecolor": fill or "none"}
    if pen is None:
        return {**face, "edgecolor": "none", "linewidth": 0.0, "linestyle": "-"}
    dash = (0.0, tuple(part / pen.width for part in pen.dash)) if pen.dash else "-"
    return {**face, "edgecolor": pen.colour, "linewidth": pen.width / POINT, "linestyle": dash}


def _pairs(points: Sequence[complex]) -> list[tuple[float, float]]:
    return [(point.real, point.imag) for point in points]


def _text(label: Label, setter: MathText) -> Text:
    text = setter.label(label.content)
    return Text(
        label.at.real,
        label.at.imag,
        text,
        family=_font(text),
        size=label.size,
        rotation=label.turn,
        horizontalalignment="left" if "left" in label.anchor else "right" if "right" in label.anchor else "center",
        verticalalignment="top" if "top" in label.anchor else "bottom" if "bottom" in label.anchor else "center",
        bbox={"facecolor": "white", "edgecolor": "none", "pad": 1.0} if label.background else None,
    )


@cache
def _letters(font: str) -> frozenset[int]:
    return frozenset(get_font(findfont(font)).get_charmap())


def _font(text: str) -> str:
    return next((font for font in FONTS if _letters(font).issuperset(map(ord, text))), FONTS[-1])
