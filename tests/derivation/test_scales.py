"""Scales one measures with: members of the series, never below what is needed."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from reportgen.base.units import SERIES, nice_up

positive = st.floats(1e-12, 1e12)


@given(positive)
def test_nice_rounds_up_to_the_next_member(value: float) -> None:
    result = nice_up(value)
    mantissa = result / 10 ** math.floor(math.log10(result) + 1e-12)
    assert min(abs(mantissa - member) for member in SERIES) < 1e-9  # binary rounding of the mantissa
    assert result >= value * (1 - 1e-12)
    # Neighbours of the series are at most a factor 2 apart.
    assert result <= 2 * value * (1 + 1e-12)


@given(positive)
def test_a_member_is_its_own_scale(value: float) -> None:
    assert nice_up(nice_up(value)) == nice_up(value)


@pytest.mark.parametrize("value", [0.0, -1.0, math.nan, math.inf])
def test_a_scale_is_positive(value: float) -> None:
    with pytest.raises(ValueError, match="positive"):
        nice_up(value)
