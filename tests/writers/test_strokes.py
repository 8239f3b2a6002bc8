"""Geometry of drawings: arcs as Bézier curves, arrow heads, hatching."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from reportgen.drawing.style import arc_to_beziers, arrow_head, clip_hatch

ANGLES = st.floats(-7, 7)


@given(ANGLES, st.floats(0.1, 6.2), st.sampled_from([1, -1]))
def test_beziers_follow_their_circle(start: float, sweep: float, sense: int) -> None:
    """The best cubic over 45° errs by 4.2e-6 of the radius at its worst."""
    for p, q, r, s in arc_to_beziers(1 + 2j, 10, start, start + sense * sweep):
        for t in (0.0, 0.2, 0.5, 0.8, 1.0):
            point = p * (1 - t) ** 3 + 3 * q * t * (1 - t) ** 2 + 3 * r * t**2 * (1 - t) + s * t**3
            assert abs(abs(point - 1 - 2j) - 10) < 1e-4


@given(st.complex_numbers(max_magnitude=100), st.complex_numbers(max_magnitude=100), st.floats(0.1, 5))
def test_a_head_ends_at_the_tip_and_covers_the_end_of_the_shaft(a: complex, b: complex, length: float) -> None:
    shaft_end, head = arrow_head(a, b, length)
    if abs(b - a) < 1e-6:
        return
    assert head is not None
    assert head[0] == b
    along = (b - a) / abs(b - a)
    back = ((head[1] - b) / along).real
    assert back == pytest.approx(-min(length, 0.75 * abs(b - a)))
    assert back < ((shaft_end - b) / along).real < 0


@given(st.floats(1, 40), st.floats(1, 40), ANGLES, st.floats(0.5, 3))
def test_hatch_lies_inside_and_has_its_spacing(width: float, height: float, turn: float, spacing: float) -> None:
    """The strokes of a rectangle, moved along by the spacing, cover its area to within a stroke's share."""
    by = complex(math.cos(turn), math.sin(turn))
    points = [corner * by for corner in (0j, width + 0j, width + height * 1j, height * 1j)]
    strokes = clip_hatch(points, spacing)
    for start, end in strokes:
        assert ((end - start) / (1 + 1j)).imag == pytest.approx(0, abs=1e-6)
        for point in (start / by, end / by):
            assert -1e-6 <= point.real <= width + 1e-6
            assert -1e-6 <= point.imag <= height + 1e-6
    area = spacing * sum(abs(end - start) for start, end in strokes)
    assert abs(area - width * height) <= spacing * 2 * math.hypot(width, height)


def test_hatch_refuses_no_spacing() -> None:
    with pytest.raises(ValueError, match="spacing"):
        clip_hatch([0j, 1 + 0j, 1j], 0.0)
