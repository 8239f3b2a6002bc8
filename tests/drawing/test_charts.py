"""Charts: curves where the data are, bars as long as their counts, whole ticks, clear labels."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from reportgen.drawing import Circle, Diagram, Label, PlottedCurve, Polyline, Scene
from reportgen.drawing.charts import CLOSE, HEIGHT, WIDTH, Area, _telling, _ticks, angle_ticks, chart, polar
from reportgen.drawing.count_charts import bars, histogram
from reportgen.formula import Chain, Number, Symbol
from tests.drawing.overlaps import overlaps

ANGLE = np.linspace(0, 720, 721)


def curves(scene: Scene) -> list[np.ndarray]:
    return [np.array(item.points) for item in scene.items if isinstance(item, Polyline) and not item.closed]


def torque() -> Scene:
    x = np.radians(ANGLE)
    series = PlottedCurve(Symbol("M", "cb"), ANGLE, 300 * np.sin(2 * x) - 120 * np.cos(x), tuple(range(0, 720, 45)))
    return chart(Diagram((series,), Symbol("φ", "1"), "M, N·m", levels=((-120.0, Symbol("M", "m")),)))


def test_a_chart_is_clear_and_of_its_size() -> None:
    scene = torque()
    assert overlaps(scene) == []
    assert WIDTH < scene.width < 160
    assert HEIGHT < scene.height < 95
    assert sum(isinstance(item, Circle) for item in scene.items) == 16


def test_angles_have_ticks_at_whole_multiples() -> None:
    ticks = [item.content for item in torque().items if isinstance(item, Label) and isinstance(item.content, Number)]
    assert [tick.value for tick in ticks if tick.unit == "°"] == [90.0 * k for k in range(9)]


@pytest.mark.parametrize(
    ("low", "high", "ticks"),
    [
        (0.0, 360.0, [0, 90, 180, 270, 360]),
        (0.0, 108.1, [0, 45, 90]),
        (0.0, 88.0, [0, 30, 60]),
        (30.0, 74.0, [30, 45, 60]),
        (100.0, 107.0, [100, 102, 104, 106]),
        (90.0, 90.0007, [90, 90.0002, 90.0004, 90.0006]),
        (0.0, 7200.0, [0, 1440, 2880, 4320, 5760, 7200]),
    ],
)
@pytest.mark.parametrize("half", [True, False])
def test_an_axis_of_angles_has_three_ticks_at_least(low: float, high: float, ticks: list[float], half: bool) -> None:
    """However short a start or a stop is, and however long; each curve of it can be drawn."""
    if half:
        assert angle_ticks(low, high, 5) == pytest.approx(ticks)
    scene = chart(Diagram((PlottedCurve("", (low, high), (20.0, 0.0)),), "φ", "ω", turn=True), half=half)
    figures = [item for item in scene.items if isinstance(item, Label) and getattr(item.content, "unit", "") == "°"]
    assert 1 <= len(figures) <= 11


def test_the_simplified_curve_stays_within_the_pen() -> None:
    curve = curves(torque())[0]
    assert len(curve) < 500  # simplified
    frame = next(item for item in torque().items if isinstance(item, Polyline) and item.closed)
    left, base = frame.points[0].real, frame.points[0].imag
    ticks = [
        i.content.value
        for i in torque().items
        if isinstance(i, Label) and i.anchor == "right" and isinstance(i.content, Number)
    ]
    per = (max(ticks) - min(ticks)) / HEIGHT
    x = np.radians((curve.real - left) / WIDTH * 720)
    drawn = (curve.imag - base) * per + min(ticks)
    error = np.abs(drawn - (300 * np.sin(2 * x) - 120 * np.cos(x))) / per
    assert error.max() < 0.2  # half a pen's width of 0.4 mm


@pytest.mark.parametrize("height", [25.0, 100.0])
def test_a_name_longer_than_its_axis_is_set_in_two_lines(height: float) -> None:
    """On a sheet, where the height of a chart is chosen."""
    name = Chain((Symbol("ω"),), "rad/s; positive: anticlockwise, seen from above")
    curve = PlottedCurve("", ANGLE[:361], np.sin(np.radians(ANGLE[:361])))
    scene = chart(Diagram((curve,), Symbol("φ"), name), area=Area(60.0, height))
    turned = [item for item in scene.items if isinstance(item, Label) and item.turn == 90]
    assert len(turned) == (2 if height < 50 else 1)
    assert overlaps(scene) == []
    # The line that ends with the unit is read first, that is, stands on the left.
    assert "rad/s" in max(turned, key=lambda label: -label.at.real).content.note


def test_two_curves_are_told_apart_without_colour() -> None:
    x = ANGLE[:361]
    series = [
        PlottedCurve(Symbol("v", "B"), x, np.sin(np.radians(x))),
        PlottedCurve(Symbol("v", "D"), x, np.cos(np.radians(x))),
    ]
    scene = chart(Diagram(tuple(series), Symbol("φ", "1"), "v, m/s"))
    assert overlaps(scene) == []
    pens = [item.stroke for item in scene.items if isinstance(item, Polyline) and not item.closed]
    assert len({pen.dash for pen in pens if pen}) == 2


def test_a_gap_stays_a_gap() -> None:
    y = np.sin(np.radians(ANGLE))
    y[300:340] = np.nan
    assert len(curves(chart(Diagram((PlottedCurve("y", ANGLE, y),), "x", "y")))) == 2


def test_nothing_finite_is_an_error() -> None:
    with pytest.raises(ValueError, match="finite"):
        chart(Diagram((PlottedCurve("y", [0.0, 1.0], [np.nan, np.nan]),), "x", "y"))


def test_a_polar_diagram_has_equal_scales() -> None:
    x = np.radians(ANGLE)
    load = PlottedCurve("", 4000 * np.cos(x), 9000 * np.sin(x) - 2000, tuple(range(0, 720, 90)), tuple("12345678"))
    scene = polar(Diagram((load,), "N", turn=False, equal=True))
    assert overlaps(scene) == []
    curve = curves(scene)[0]
    assert np.ptp(curve.real) / np.ptp(curve.imag) == pytest.approx(8000 / 18000, rel=2e-3)  # 0.025 mm in 50


def test_figures_without_room_side_by_side_are_left_out() -> None:
    """At every step (10000) stands a grid line, a figure at every second one, 0 among them."""
    load = PlottedCurve("", [-22000.0, 8000.0], [-43000.0, 9000.0])
    scene = polar(Diagram((load,), "N", turn=False, equal=True), size=58.0)
    assert overlaps(scene) == []
    figures = [item for item in scene.items if isinstance(item, Label) and isinstance(item.content, Number)]
    across = [item.content.value for item in figures if item.anchor == "center"]
    up = [item.content.value for item in figures if item.anchor == "right"]
    assert across == [-20000.0, 0.0]
    assert up == [-50000.0, -40000.0, -30000.0, -20000.0, -10000.0, 0.0, 10000.0]


@pytest.mark.parametrize("turns", [1, 4])
def test_what_a_curve_leaves_out_lies_close_to_what_it_keeps(turns: int) -> None:
    """A spiral runs back upon itself: far from the line through two of its points, near the line prolonged."""
    share = np.linspace(0, 1, 2000)
    places = 30 * share * np.exp(2j * np.pi * turns * share)
    kept = _telling(places)
    assert (kept[0], kept[-1]) == (0, len(places) - 1)
    assert len(kept) < 100 * turns
    for first, last in pairwise(kept):
        inner, chord = places[first : last + 1] - places[first], places[last] - places[first]
        along = (inner * np.conj(chord)).real / abs(chord)
        across = (inner * np.conj(chord)).imag / abs(chord)
        assert np.abs(across).max() <= CLOSE
        # 1e-9 mm: of floats.
        assert -CLOSE <= along.min() <= along.max() <= abs(chord) + CLOSE + 1e-9


@pytest.mark.parametrize(
    ("low", "high"), [(-3.1, 47.0), (0.0, 1e-4), (-2e6, -1e6), (7.0, 7.0), (0.0, 0.0), (2e-3, 2e-3)]
)
def test_ticks_are_round_and_hold_the_range(low: float, high: float) -> None:
    ticks = _ticks(low, high, 7)
    steps = np.diff(ticks)
    assert ticks[0] <= low <= high <= ticks[-1]
    assert 2 <= len(ticks) <= 9
    assert np.ptp(steps) < 1e-9 * steps[0]
    assert f"{steps[0]:.1e}"[:3] in {"1.0", "2.0", "2.5", "5.0"}


@pytest.mark.parametrize("value", [2.5e-3, 31.4159, -7e4])
def test_rounding_is_no_range(value: float) -> None:
    """A range in the last digits of its ends has the ticks of a single value, one step of that value's size."""
    ticks = _ticks(value, value + abs(value) * 4e-16, 7)
    assert ticks == _ticks(value, value, 7)
    assert len(ticks) == 2
    assert abs(value) / 7 <= ticks[1] - ticks[0] <= abs(value) / 2


def test_a_load_of_zero_is_a_dot_at_the_pole() -> None:
    """A link without mass and load may share a crank pin with a loaded one."""
    nothing = np.zeros(9)
    scene = polar(Diagram((PlottedCurve("", nothing, nothing, (0, 4), ("1", "5")),), "N", turn=False, equal=True))
    (pole,) = {item.centre for item in scene.items if isinstance(item, Circle)}
    assert np.isfinite(pole)


# --- bars and histograms ---------------------------------------------------------------------------


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
