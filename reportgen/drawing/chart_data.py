"""A chart as data: curves, axes and labels, to be painted on paper (`drawing.charts`) or on axes of matplotlib."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from reportgen.base.records import Record
from reportgen.base.units import Language, write
from reportgen.drawing.mathtext import MathText
from reportgen.formula import Expression

Content = Expression | str
"""Content of a label: an expression, or plain text."""
WIDE = 450.0
"""Above this range (degrees), ticks are at multiples of 90 instead of 45."""
MEAN = {"linestyle": "-.", "linewidth": 0.8, "color": "black"}
"""Matplotlib style of the line at a level."""
BESIDE = {"textcoords": "offset points", "xytext": (3, 3), "fontsize": "small"}
"""Matplotlib style and offset (points) of the name at a marked point or an angle."""


class PlottedCurve(Record):
    """One curve: x [K] and y [K], its label, and indices of the points that get a mark.

    Measured values have `dots` only.
    """

    label: Content
    x: ArrayLike
    y: ArrayLike
    marks: tuple[int, ...] = ()
    names: tuple[Content, ...] = ()
    """Labels of the marks, if they have any."""
    dots: bool = False


class Inclination(Record):
    """The angle of a straight line of this `slope` (in the units of the axes) at the point x, y of a chart.

    Its arc has the `radius` (mm); the reference line is drawn a little beyond the arc.
    """

    label: Content
    x: float
    y: float
    slope: float
    radius: float


class Diagram(Record):
    """Curves in one frame whose axes are named `x` and `y`.

    With `turn`, x is an angle in degrees.  `levels` are horizontal lines with a name, e.g. a mean; with `equal`, both
    axes of a hodograph have one scale.  On paper y = 0 is within the range, unless `zero` is False.
    """

    curves: tuple[PlottedCurve, ...]
    x: Content = ""
    y: Content = ""
    turn: bool = True
    levels: tuple[tuple[float, Content], ...] = ()
    inclinations: tuple[Inclination, ...] = ()
    equal: bool = False
    title: str = ""
    zero: bool = True

    def __repr__(self) -> str:
        number = len(self.curves)
        return f"<diagram with {number} {'curve' if number == 1 else 'curves'}; draw it: .on(axes)>"

    def on(self, axes: Any, language: Language = "en", **look: Any) -> Any:
        """Add the diagram to axes of matplotlib and return the axes.

        `look` is passed to `axes.plot` for every curve.  An inclination gets only its name, without an arc.
        """
        label = MathText(language).label
        for curve in self.curves:
            x, y = np.asarray(curve.x, dtype=np.float64), np.asarray(curve.y, dtype=np.float64)
            own: dict[str, Any] = {"label": label(curve.label) or None}
            if curve.dots:
                own |= {"linestyle": "none", "marker": "o", "markersize": 3}
            elif curve.marks:
                own |= {"marker": "o", "markersize": 3.5, "markerfacecolor": "white", "markevery": list(curve.marks)}
            axes.plot(x, y, **(own | look))
            for at, name in zip(curve.marks, curve.names, strict=False):
                axes.annotate(label(name), (x[at], y[at]), **BESIDE)
        for level, name in self.levels:
            axes.axhline(level, **MEAN)
            axes.annotate(label(name), (1.0, level), xycoords=("axes fraction", "data"), ha="right", va="bottom")
        for inclination in self.inclinations:
            axes.annotate(label(inclination.label), (inclination.x, inclination.y), **BESIDE)
        axes.set(xlabel=label(self.x), ylabel=label(self.y))
        axes.grid(visible=True, linewidth=0.3)
        axes.yaxis.set_major_formatter(lambda value, _: write(float(f"{value:.10g}"), None, language))
        if self.title:
            axes.set_title(self.title)
        if self.equal:
            axes.set_aspect("equal")
        if self.turn:
            _in_degrees(axes)
        if len(axes.get_legend_handles_labels()[1]) > 1:
            axes.legend()
        return axes


def _in_degrees(axes: Any) -> None:
    """Set ticks at whole multiples of 45 or 90 degrees over the range of the contents."""
    low, high = axes.dataLim.intervalx
    step = 45.0 if high - low <= WIDE else 90.0
    ticks = step * np.arange(math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9) + 1)
    axes.set_xlim(low, high)
    axes.set_xticks(ticks, [f"{tick:g}°" for tick in ticks])
