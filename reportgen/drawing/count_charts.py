"""Charts of counts: bars by name, and a histogram."""

from __future__ import annotations

import math
from collections.abc import Sequence

from reportgen.base.units import nice_up
from reportgen.drawing import Content, Item, Label, Line, Pen, Polyline, Scene, style
from reportgen.drawing.canvas import Canvas, finish
from reportgen.drawing.charts import EDGE, GRID, TICKS, framed
from reportgen.drawing.drawing_description import fact
from reportgen.drawing.label_size import box
from reportgen.formula import Number

COUNT_WIDTH = 148.0
"""Width of a chart of bars or of a histogram, with its text (mm)."""
COLUMN_HEIGHT = 55.0
"""Height of the area inside the axes of a histogram (mm)."""
LENGTH = 100.0
"""Least length of the axis of bars (mm)."""
ROW, BAR = 6.0, 4.0
"""Distance from one horizontal bar to the next, and their thickness (mm)."""
OUTLINE = Pen(0.3, style.BLUE)


def bars(names: Sequence[Content], counts: Sequence[int], x_label: Content) -> Scene:
    """Draw a horizontal bar for each of the `counts` [K], with its name on the left, over a scale of whole numbers.

    The counts themselves are only in the text description.  Raises `ValueError` if there are no counts.
    """
    if not counts:
        raise ValueError("bars need something to count")
    widest = max(box(name, style.SMALL).width for name in names)
    length = max(COUNT_WIDTH - widest - 10.0, LENGTH)
    step, most = _whole_steps(max(counts))
    height = ROW * len(counts)
    items: list[Item] = []
    for tick in range(0, most + 1, step):
        x = length * tick / most
        items.append(Line(complex(x, 0), complex(x, height), GRID))
        items.append(Label(complex(x, -3.0), Number(tick), size=style.SMALL))
    for number, (name, count) in enumerate(zip(names, counts, strict=True)):
        y = height - ROW * (number + 0.5)
        items.append(_bar(complex(0, y - BAR / 2), complex(length * count / most, y + BAR / 2)))
        items.append(Label(complex(-1.5, y), name, "right", style.SMALL))
    items.append(Line(0j, complex(0, height), EDGE))
    items.append(Label(complex(length / 2, -8.5), x_label))
    facts = (fact("bar-count", name, Number(count)) for name, count in zip(names, counts, strict=True))
    return finish(Canvas(tuple(items), says=(fact("bars", x_label), *facts)), margin=1.5)


def histogram(counts: Sequence[int], edges: Sequence[float], x_label: Content, y_label: Content) -> Scene:
    """Draw a histogram: `counts` [K] of the values between each two of the evenly spaced `edges` [K+1].

    Raises `ValueError` if there are no counts, or not one more edge than counts.
    """
    if len(edges) != len(counts) + 1 or not counts:
        raise ValueError("a histogram has one more edge than counts")
    step, most = _whole_steps(max(counts))
    width = (COUNT_WIDTH - 20.0) / len(counts)
    items: list[Item] = []
    for tick in range(0, most + 1, step):
        y = COLUMN_HEIGHT * tick / most
        items.append(Line(complex(0, y), complex(width * len(counts), y), GRID))
        items.append(Label(complex(-1.5, y), Number(tick), "right", style.SMALL))
    for number, count in enumerate(counts):
        if count:
            items.append(_bar(complex(width * number, 0), complex(width * (number + 1), COLUMN_HEIGHT * count / most)))
    items += [Label(complex(width * n, -3.0), Number(edge), size=style.SMALL) for n, edge in enumerate(edges)]
    items.append(Line(0j, complex(width * len(counts), 0), EDGE))
    items.append(Label(complex(width * len(counts) / 2, -8.5), x_label))
    items.append(Label(complex(-9.0, COLUMN_HEIGHT / 2), y_label, turn=90))
    between = zip(edges, edges[1:], counts, strict=False)
    facts = (fact("between", Number(low), Number(high), Number(count)) for low, high, count in between if count)
    return finish(Canvas(tuple(items), says=(fact("histogram", y_label, x_label), *facts)), margin=1.5)


# --- counts ---------------------------------------------------------------------------------------


def _whole_steps(largest: int) -> tuple[int, int]:
    """Return a whole step between ticks, and the last tick, at or above the largest count."""
    step = max(round(nice_up(max(largest, 1) / TICKS, (1, 2, 5))), 1)
    return step, step * max(math.ceil(largest / step), 1)


def _bar(low: complex, high: complex) -> Polyline:
    return framed(low, high, OUTLINE, style.TINT)
