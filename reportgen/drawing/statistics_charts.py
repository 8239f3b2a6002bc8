"""Charts of statistics: points over two numbers, and means with their spread by name."""

from __future__ import annotations

from collections.abc import Sequence

from reportgen.drawing import Circle, Content, Item, Label, Line, Pen, Scene, style
from reportgen.drawing.canvas import Canvas, finish
from reportgen.drawing.charts import EDGE, GRID
from reportgen.drawing.count_charts import COUNT_WIDTH, LENGTH, ROW
from reportgen.drawing.drawing_description import fact
from reportgen.drawing.label_size import box
from reportgen.formula import Number

WIDTH, HEIGHT = 110.0, 60.0
"""The area inside the axes of points (mm)."""
DOT = 0.8
"""Radius of a point (mm)."""
SPREAD = Pen(0.5, style.BLUE)


def scatter(
    xs: Sequence[float],
    ys: Sequence[float],
    x_ticks: Sequence[float],
    y_ticks: Sequence[float],
    x_label: Content,
    y_label: Content,
) -> Scene:
    """Draw a point for each x [N] and y [N]; the axes run from the first to the last of the evenly spaced ticks."""
    items: list[Item] = []

    def at(x: float, y: float) -> complex:
        across = (x - x_ticks[0]) / (x_ticks[-1] - x_ticks[0])
        return complex(WIDTH * across, HEIGHT * (y - y_ticks[0]) / (y_ticks[-1] - y_ticks[0]))

    for x in x_ticks:
        items.append(Line(at(x, y_ticks[0]), at(x, y_ticks[-1]), GRID))
        items.append(Label(at(x, y_ticks[0]) - 3j, Number(x), size=style.SMALL))
    for y in y_ticks:
        items.append(Line(at(x_ticks[0], y), at(x_ticks[-1], y), EDGE if y == 0 else GRID))
        items.append(Label(at(x_ticks[0], y) - 1.5, Number(y), "right", style.SMALL))
    items.append(Line(0j, complex(0, HEIGHT), EDGE))
    items += [Circle(at(x, y), DOT, None, style.BLUE) for x, y in zip(xs, ys, strict=True)]
    items.append(Label(complex(WIDTH / 2, -8.5), x_label))
    items.append(Label(complex(-11.0, HEIGHT / 2), y_label, turn=90))
    facts = [
        fact(phrase, name, Number(ticks[0]), Number(ticks[-1]))
        for phrase, name, ticks in (("across", x_label, x_ticks), ("up", y_label, y_ticks))
    ]
    facts.append(fact("points", Number(len(xs))))
    facts += (fact("place", Number(x), Number(y)) for x, y in zip(xs, ys, strict=True))
    return finish(Canvas(tuple(items), says=tuple(facts)), margin=1.5)


def intervals(
    names: Sequence[Content], means: Sequence[float], spreads: Sequence[float], ticks: Sequence[float], x_label: Content
) -> Scene:
    """Draw a row for each mean [N], its name on the left, with a line as long as the spread [N] on either side of it.

    The axis runs from the first to the last of the evenly spaced ticks; lines are cut at its ends.
    """
    widest = max(box(name, style.SMALL).width for name in names)
    length = max(COUNT_WIDTH - widest - 10.0, LENGTH)
    height = ROW * len(names)
    low, high = ticks[0], ticks[-1]
    items: list[Item] = []

    def at(value: float) -> float:
        return length * (min(max(value, low), high) - low) / (high - low)

    for tick in ticks:
        items.append(Line(complex(at(tick), 0), complex(at(tick), height), GRID))
        items.append(Label(complex(at(tick), -3.0), Number(tick), size=style.SMALL))
    for number, (name, mean, spread) in enumerate(zip(names, means, spreads, strict=True)):
        y = height - ROW * (number + 0.5)
        items.append(Line(complex(at(mean - spread), y), complex(at(mean + spread), y), SPREAD))
        items.append(Circle(complex(at(mean), y), DOT, None, style.BLUE))
        items.append(Label(complex(-1.5, y), name, "right", style.SMALL))
    items.append(Line(0j, complex(0, height), EDGE))
    items.append(Label(complex(length / 2, -8.5), x_label))
    rows = zip(names, means, spreads, strict=True)
    facts = (
        fact("mean", name, Number(float(f"{mean:.3g}")), Number(float(f"{spread:.3g}"))) for name, mean, spread in rows
    )
    return finish(Canvas(tuple(items), says=(fact("means", x_label), *facts)), margin=1.5)
