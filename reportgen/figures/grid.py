"""A ruled table as a drawing, for sheets on which everything is drawn."""

from __future__ import annotations

from collections.abc import Sequence

from reportgen.figures import style
from reportgen.figures.metrics import box
from reportgen.figures.scene import Content, Item, Label, Line, Polyline, Scene, Stroke

ROW = 5.0
"""Height of a row, mm."""
PADDING = 1.4
"""White beside the widest content of a column, mm."""
EDGE, RULE = Stroke(0.35), Stroke(0.15)


def grid(head: Sequence[Sequence[Content]], rows: Sequence[Sequence[Content]]) -> Scene:
    """Rows below head rows, all of as many cells; columns are as wide as their widest cell."""
    every = [*head, *rows]
    widths = [max(box(cell, style.SMALL).width for cell in column) + 2 * PADDING for column in zip(*every, strict=True)]
    width, height = sum(widths), ROW * len(every)
    items: list[Item] = []
    for number, row in enumerate(every):
        left, middle = 0.0, height - ROW * (number + 0.5)
        for cell, wide in zip(row, widths, strict=True):
            if cell != "":
                items.append(Label(complex(left + wide / 2, middle), cell, size=style.SMALL))
            left += wide
        if number:
            below = height - ROW * number
            items.append(Line(complex(0, below), complex(width, below), EDGE if number == len(head) else RULE))
    for left in (sum(widths[:n]) for n in range(1, len(widths))):
        items.append(Line(complex(left, 0), complex(left, height), RULE))
    items.append(Polyline((0j, complex(width, 0), complex(width, height), complex(0, height)), EDGE, closed=True))
    return Scene(width, height, tuple(items))
