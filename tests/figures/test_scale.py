"""Scales: the series, the true-scale rule, one force scale for all polygons."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from reportgen.figures.scale import (
    SERIES,
    choose_force_scale,
    crank_scales,
    enlargement,
    extent,
    nice,
    nice_below,
)

positive = st.floats(1e-12, 1e12)


@given(positive)
def test_nice_rounds_up_to_the_next_member(value: float) -> None:
    result = nice(value)
    mantissa = result / 10 ** math.floor(math.log10(result) + 1e-12)
    assert min(abs(mantissa - member) for member in SERIES) < 1e-9  # binary rounding of the mantissa
    assert result >= value * (1 - 1e-12)
    # Neighbours of the series are at most a factor 2 apart.
    assert result <= 2 * value * (1 + 1e-12)


@given(positive)
def test_a_member_is_its_own_scale(value: float) -> None:
    assert nice(nice(value)) == nice(value) == nice_below(nice(value))


@given(positive)
def test_nice_below_rounds_down(value: float) -> None:
    assert value / 2 * (1 - 1e-12) <= nice_below(value) <= value * (1 + 1e-12)


@pytest.mark.parametrize("value", [0.0, -1.0, math.nan, math.inf])
def test_a_scale_is_positive(value: float) -> None:
    with pytest.raises(ValueError, match="positive"):
        nice(value)


def test_crank_scales_of_the_reference_engine() -> None:
    # Printed to 4 and 5 figures in the reference, section 1.
    scales = crank_scales(0.0475, 230.383, 50.0)
    assert scales.length == pytest.approx(0.00095, abs=5e-8)
    assert scales.velocity == pytest.approx(0.2189, abs=5e-5)
    assert scales.acceleration == pytest.approx(50.421, abs=2e-3)  # ω1 is printed as 230.38


def test_one_force_scale_fits_every_polygon() -> None:
    polygons = [np.array([0, 3000, 3000 + 9000j]), np.array([0, -6000 + 17500j])]
    scale = choose_force_scale(polygons, (160.0, 200.0))
    assert scale == 100.0
    for polygon in polygons:
        width, height = extent(polygon / scale)
        assert width <= 160
        assert height <= 200


def test_extent_passes_over_unreachable_points() -> None:
    assert extent([0, complex(math.nan, math.nan), 3 + 4j]) == (3.0, 4.0)


@given(st.floats(1e-6, 3.0))
def test_insets_are_never_longer_than_asked(length: float) -> None:
    assert 10.0 * (1 - 1e-9) <= length * enlargement(length, 20.0) <= 20.0 * (1 + 1e-9)
