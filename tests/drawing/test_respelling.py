"""Finished drawings with other letters: what grows stays a row, touches nothing, and stays on the sheet."""

from __future__ import annotations

from itertools import pairwise

import pytest

from reportgen.drawing import Circle, Content, Label, Line, Pen, style
from reportgen.drawing.canvas import Canvas, finish
from reportgen.drawing.geometry import frame
from reportgen.drawing.label_replacement import respelled
from reportgen.drawing.labels import label
from reportgen.formula import Symbol
from tests.drawing.overlaps import overlaps

M, LONG = Symbol("m"), Symbol("m", "gears")


def longer(content: Content) -> Content:
    return LONG if content == M else content


@pytest.mark.parametrize("beside", [1, -1, 1j, -1j, 1 + 1j, -1 - 1j])
def test_a_row_that_grows_touches_nothing(beside: complex) -> None:
    """Between two strokes 28 mm apart, wherever its point lies among them."""
    walls = tuple(Line(complex(x, -20), complex(x, 20), style.VISIBLE) for x in (-14, 14))
    drawn = finish(
        Canvas((*walls, Circle(beside, 0.5, Pen(0.2))), (label(beside, "s = ", M, " / 2", prefer=(0.0,)),)), margin=0.0
    )
    grown = respelled(drawn, longer)
    assert overlaps(grown) == []
    row = [item for item in grown.items if isinstance(item, Label)]
    assert [item.content for item in row] == ["s = ", LONG, " / 2"]
    ends = [(centre - half, centre + half) for centre, half in map(frame, row)]
    assert all(right.real == pytest.approx(left.real) for (_, right), (left, _) in pairwise(ends))


def test_a_label_at_the_edge_takes_the_sheet_with_it() -> None:
    drawn = finish(Canvas((Line(0j, 10 + 0j, style.VISIBLE),), (label(10 + 0j, M, prefer=(0.0,)),)), margin=0.0)
    grown = respelled(drawn, longer)
    assert overlaps(grown) == []
    assert grown.width > drawn.width
    assert respelled(drawn, lambda content: content) is drawn
