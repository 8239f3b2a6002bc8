"""Bars and histograms: as long as their counts, with whole ticks, within the page."""

from __future__ import annotations

import pytest

from reportgen.figures.scene import Label, Polyline, Scene
from reportgen.figures.tallies import bars, histogram
from reportgen.notation.expressions import Number, Symbol


def boxes(scene: Scene) -> list[tuple[float, float]]:
    """Width and height of each bar."""
    return [
        (abs(bar.points[1] - bar.points[0]), abs(bar.points[2] - bar.points[1]))
        for bar in scene.items
        if isinstance(bar, Polyline) and bar.closed
    ]


def test_bars_are_in_proportion_to_their_counts() -> None:
    scene = bars([Symbol("v", "BA"), "the pressure of the other piston", Symbol("M", "cb")], [8, 2, 4], "errors")
    lengths = [width for width, _ in boxes(scene)]
    # 1e-9: of floats.
    assert lengths[0] == pytest.approx(4 * lengths[1], rel=1e-9)
    assert lengths[0] == pytest.approx(2 * lengths[2], rel=1e-9)
    assert scene.width < 160


def test_a_histogram_has_a_column_for_each_class_that_is_not_empty() -> None:
    scene = histogram([0, 3, 6, 1], [0, 25, 50, 75, 100], "%", "students")
    heights = [height for _, height in boxes(scene)]
    assert heights[1] == pytest.approx(2 * heights[0], rel=1e-9)
    assert len(heights) == 3
    assert scene.width < 160


@pytest.mark.parametrize("largest", [0, 1, 3, 7, 40, 1234])
def test_ticks_are_whole_and_reach_the_largest_count(largest: int) -> None:
    scene = bars(["x"], [largest], "errors")
    ticks = [item.content.value for item in scene.items if isinstance(item, Label) and isinstance(item.content, Number)]
    assert all(tick == int(tick) for tick in ticks)
    assert ticks[-1] >= max(largest, 1)
    assert len(ticks) <= 8


def test_nothing_to_count_is_an_error() -> None:
    with pytest.raises(ValueError, match="count"):
        bars([], [], "x")
    with pytest.raises(ValueError, match="edge"):
        histogram([1, 2], [0, 1], "x", "y")
