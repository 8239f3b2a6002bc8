"""A ruled table as a drawing, for sheets on which everything is drawn."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

from reportgen.figures import style
from reportgen.figures.metrics import box
from reportgen.figures.scene import Content, Item, Label, Line, Polyline, Scene, Stroke

ROW = 5.0
"""Height of a row, mm."""
PADDING = 1.4
"""White beside the widest content of a column, mm."""
EDGE, RULE = Stroke(0.35), Stroke(0.15)


@dataclass(frozen=True, slots=True)
class Form:
    """How a sheet sets what has no size of its own.

    Of a long table: how wide it may be (mm), how many rows it may have; of curves: their `shape`, width over height.
    """

    widest: float = 180.0
    rows: int = 100
    parts: int = 1
    """It is broken into so many parts at least."""
    shape: float = 2.0

    def broken(self, positions: Sequence[int]) -> list[Sequence[int]]:
        """The positions in parts of about as many rows each."""
        count = min(max(math.ceil(len(positions) / self.rows), self.parts), len(positions))
        ends = [round(n * len(positions) / count) for n in range(count + 1)]
        return [positions[start:end] for start, end in pairwise(ends)]


USUAL_FORM = Form()


def widths(rows: Sequence[Sequence[Content]]) -> list[float]:
    """The widths of columns: of each its widest cell with the white beside it."""
    columns = zip(*rows, strict=True)
    return [max(box(cell, style.SMALL).width for cell in column) + 2 * PADDING for column in columns]


def grid(head: Sequence[Sequence[Content]], rows: Sequence[Sequence[Content]]) -> Scene:
    """Rows below head rows, all of as many cells; columns are as wide as their widest cell."""
    every = [*head, *rows]
    across = widths(every)
    width, height = sum(across), ROW * len(every)
    items: list[Item] = []
    for number, row in enumerate(every):
        left, middle = 0.0, height - ROW * (number + 0.5)
        for cell, wide in zip(row, across, strict=True):
            if cell != "":
                items.append(Label(complex(left + wide / 2, middle), cell, size=style.SMALL))
            left += wide
        if number:
            below = height - ROW * number
            items.append(Line(complex(0, below), complex(width, below), EDGE if number == len(head) else RULE))
    for left in (sum(across[:n]) for n in range(1, len(across))):
        items.append(Line(complex(left, 0), complex(left, height), RULE))
    items.append(Polyline((0j, complex(width, 0), complex(width, height), complex(0, height)), EDGE, closed=True))
    return Scene(width, height, tuple(items))


def stretched(scene: Scene, table: complex, stretch: complex) -> Scene:
    """A table of a width and a height, and what stands above it, in the middle: the table so many times as large.

    Letters stay as they are.
    """
    width = max(scene.width, table.real * stretch.real)
    left = (scene.width - table.real) / 2
    begin = (width - table.real * stretch.real) / 2

    def at(point: complex) -> complex:
        return complex(begin + (point.real - left) * stretch.real, point.imag * stretch.imag)

    higher = complex((width - scene.width) / 2, table.imag * (stretch.imag - 1))
    items: list[Item] = []
    for one in scene.items:
        match one:
            case Label(place):
                items.append(replace(one, at=place + higher if place.imag > table.imag else at(place)))
            case Line(start, end):
                items.append(replace(one, start=at(start), end=at(end)))
            case Polyline(points):
                items.append(replace(one, points=tuple(map(at, points))))
            case _:
                raise TypeError(one)
    return Scene(width, scene.height + higher.imag, tuple(items), scene.title)
