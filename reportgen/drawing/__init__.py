"""Drawings as data: a sheet of paper in millimetres and the items on it.

Points are complex numbers in mm, x to the right and y up, with the origin at the sheet's lower left corner.  Items are
painted in order.  A `Scene` is a finished drawing, which writers convert to a file format; scenes do not depend on
machines, nor writers on figures.
"""

from __future__ import annotations

from typing import Literal

from reportgen.base.records import Record, uncompared
from reportgen.drawing.chart_data import Content as Content
from reportgen.drawing.chart_data import Diagram as Diagram
from reportgen.drawing.chart_data import PlottedCurve as PlottedCurve
from reportgen.drawing.drawing_description import Description as Description

Anchor = Literal["center", "left", "right", "top", "bottom", "top-left", "top-right", "bottom-left", "bottom-right"]


class Pen(Record):
    """A pen: width in mm, colour as #rrggbb, dashes (on, off, …) in mm; empty dashes draw solid."""

    width: float = 0.25
    colour: str = "#000000"
    dash: tuple[float, ...] = ()


class Line(Record):
    """A straight line from `start` to `end` (mm)."""

    start: complex
    end: complex
    stroke: Pen = Pen()


class Arrow(Record):
    """Straight arrow whose tip lies exactly on `end`; `head` is the head's length in mm.

    `name` (e.g. "pb") identifies the arrow for measurements of the drawing; it is not printed.
    """

    start: complex
    end: complex
    stroke: Pen = Pen()
    head: float = 2.6
    name: str = ""


class Circle(Record):
    """A circle about `centre` with a `radius` (mm); `stroke` and `fill` (#rrggbb) are None where it has none."""

    centre: complex
    radius: float
    stroke: Pen | None = Pen()
    fill: str | None = None


class Arc(Record):
    """An arc about `centre` with a `radius` (mm), from `start` to `stop` (rad, anticlockwise if stop > start).

    A `head` > 0 (mm) is the length of an arrow tip at the stop.
    """

    centre: complex
    radius: float
    start: float
    stop: float
    stroke: Pen = Pen()
    head: float = 0.0


class Polyline(Record):
    """Straight lines through points (mm).

    `smooth` marks a curve whose lines are so short that the CAD file may contain a spline as well.
    """

    points: tuple[complex, ...]
    stroke: Pen | None = Pen()
    closed: bool = False
    fill: str | None = None
    smooth: bool = False


class Hatch(Record):
    """Parallel strokes that fill a convex polygon (ground, sections), `spacing` mm apart.

    They rise at 45° from the direction `turn` (rad).
    """

    points: tuple[complex, ...]
    spacing: float = 1.2
    stroke: Pen = Pen(0.13)
    turn: float = 0.0


class Label(Record):
    """Text at a point (mm); `anchor` is the point of its box that lies on `at`."""

    at: complex
    content: Content
    anchor: Anchor = "center"
    size: float = 9.0
    """Font size (pt)."""
    turn: int = 0
    """Rotation in degrees anticlockwise, 0 or 90."""
    background: bool = False
    """White paper under the box, for a label that must be placed on a line."""
    narrow: float = 1.0
    """The width of its letters, as a share of the normal width."""


Item = Line | Arrow | Circle | Arc | Polyline | Hatch | Label


@uncompared("diagram", "description")
class Scene(Record):
    """A drawing of `width` × `height` mm in true size."""

    width: float
    height: float
    items: tuple[Item, ...] = ()
    title: str = ""
    """A short plain title printed below one of several scenes of a figure, e.g. "a)"."""
    margin: float = 0.0
    """The margin on each side (mm)."""
    crowded: bool = False
    """True if its labels need more room than the drawing has."""
    at: str = ""
    """The position of the machine, if the figure has a scene for each of several positions; it is not printed."""
    diagram: Diagram | None = None
    """The diagram that it was drawn from, if it is a chart."""
    description: Description = ()
    """Text description for screen readers."""

    def __repr__(self) -> str:
        return f"<scene, {self.width:.0f} × {self.height:.0f} mm, {len(self.items)} items>"
