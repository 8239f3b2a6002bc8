"""How often what occurs: horizontal bars with a name each, and the histogram of a spread of values."""

from __future__ import annotations

import math
from collections.abc import Sequence

from reportgen.figures.draft import Draft, finish
from reportgen.figures.labels import Content
from reportgen.figures.metrics import box
from reportgen.figures.scale import nice
from reportgen.figures.scene import Item, Label, Line, Polyline, Scene, Stroke
from reportgen.figures.style import BLUE, PALE, SMALL, TINT
from reportgen.notation.expressions import Number

WIDTH = 148.0
"""Of a figure with its text, mm."""
LENGTH = 100.0
"""Of the axis of bars at least, mm."""
ROW, BAR = 6.0, 4.0
"""From one horizontal bar to the next, and their thickness, mm."""
HEIGHT = 55.0
"""Of a histogram, mm."""
EDGE = Stroke(0.25)
GRID = Stroke(0.1, PALE)
OUTLINE = Stroke(0.3, BLUE)
TICKS = 6


def bars(names: Sequence[Content], counts: Sequence[int], x_label: Content) -> Scene:
    """One bar below the other, its name on the left and its count at its end; raises `ValueError` for none."""
    if not counts:
        raise ValueError("bars need something to count")
    widest = max(box(name, SMALL).width for name in names)
    length = max(WIDTH - widest - 10.0, LENGTH)
    step, most = _axis(max(counts))
    height = ROW * len(counts)
    items: list[Item] = []
    for tick in range(0, most + 1, step):
        x = length * tick / most
        items.append(Line(complex(x, 0), complex(x, height), GRID))
        items.append(Label(complex(x, -3.0), Number(tick), size=SMALL))
    for number, (name, count) in enumerate(zip(names, counts, strict=True)):
        y = height - ROW * (number + 0.5)
        items.append(_bar(complex(0, y - BAR / 2), complex(length * count / most, y + BAR / 2)))
        items.append(Label(complex(-1.5, y), name, "right", SMALL))
    items.append(Line(0j, complex(0, height), EDGE))
    items.append(Label(complex(length / 2, -8.5), x_label))
    return finish(Draft(tuple(items)), margin=1.5)


def histogram(counts: Sequence[int], edges: Sequence[float], x_label: Content, y_label: Content) -> Scene:
    """How many values lie between each two of the `edges` [K+1], which are evenly spaced; `counts` [K]."""
    if len(edges) != len(counts) + 1 or not counts:
        raise ValueError("a histogram has one more edge than counts")
    step, most = _axis(max(counts))
    width = (WIDTH - 20.0) / len(counts)
    items: list[Item] = []
    for tick in range(0, most + 1, step):
        y = HEIGHT * tick / most
        items.append(Line(complex(0, y), complex(width * len(counts), y), GRID))
        items.append(Label(complex(-1.5, y), Number(tick), "right", SMALL))
    for number, count in enumerate(counts):
        if count:
            items.append(_bar(complex(width * number, 0), complex(width * (number + 1), HEIGHT * count / most)))
    items += [Label(complex(width * n, -3.0), Number(edge), size=SMALL) for n, edge in enumerate(edges)]
    items.append(Line(0j, complex(width * len(counts), 0), EDGE))
    items.append(Label(complex(width * len(counts) / 2, -8.5), x_label))
    items.append(Label(complex(-9.0, HEIGHT / 2), y_label, turn=90))
    return finish(Draft(tuple(items)), margin=1.5)


def _axis(largest: int) -> tuple[int, int]:
    """A whole step between ticks, and the last tick, at or above the largest count."""
    step = max(round(nice(max(largest, 1) / TICKS, (1, 2, 5))), 1)
    return step, step * max(math.ceil(largest / step), 1)


def _bar(low: complex, high: complex) -> Polyline:
    corners = (low, complex(high.real, low.imag), high, complex(low.real, high.imag))
    return Polyline(corners, OUTLINE, closed=True, fill=TINT)
