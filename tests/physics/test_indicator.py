"""The gas cycle: strokes at dead centres, interpolation, and indicated work against known integrals."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from reportgen.machine.gas_pressure import AngleIndicator, StrokeIndicator, indicated_work, stroke_at
from reportgen.machine.quadrature import mean_over

ROUNDING = 1e-12
ROD = 3.6  # L/R


def fraction(angle: np.ndarray) -> np.ndarray:
    """s/H of a central slider-crank, R = 1/2 of the stroke."""
    return (1 - np.cos(angle) + ROD - np.sqrt(ROD**2 - np.sin(angle) ** 2)) / 2


def fraction_rate(angle: np.ndarray) -> np.ndarray:
    sine, cosine = np.sin(angle), np.cos(angle)
    return (sine + sine * cosine / np.sqrt(ROD**2 - sine**2)) / 2


TABLE = StrokeIndicator(
    fractions=(0.0, 0.1, 0.4, 1.0),
    intake=(1e4, -2e4, -2e4, -2e4),
    compression=(28e4, 19e4, 5e4, -2e4),
    expansion=(28e4, 36e4, 16e4, 4e4),
    exhaust=(1e4, 1e4, 1e4, 4e4),
)


@given(st.integers(-8, 8), st.floats(-0.9e-9, 0.9e-9))
def test_a_dead_centre_belongs_to_the_stroke_that_begins(half_turns: int, rounding: float) -> None:
    assert stroke_at(half_turns * math.pi + rounding) == half_turns % 4


def test_dead_centres_of_an_offset_machine_are_as_given() -> None:
    starts = (0.0, 3.2, 2 * math.pi, 2 * math.pi + 3.2)
    angles = [0.0, math.pi, 3.2, 2 * math.pi, 2 * math.pi + math.pi, 2 * math.pi + 3.2, 4 * math.pi]
    assert stroke_at(angles, starts).tolist() == [0, 0, 1, 2, 2, 3, 0]


def test_pressure_is_linear_between_nodes_and_follows_the_stroke() -> None:
    angles = np.array([0.1, math.pi + 0.1, 2 * math.pi + 0.1, 3 * math.pi + 0.1])
    assert TABLE.pressure(angles, np.full(4, 0.25)) == pytest.approx([-2e4, 12e4, 26e4, 1e4], rel=ROUNDING)


def test_work_by_stroke_equals_the_integral_over_the_crank_angle() -> None:
    area, stroke = 0.0075, 0.095
    by_angle = mean_over(
        lambda angle: TABLE.pressure(angle, fraction(angle)) * fraction_rate(angle),
        TABLE.breaks(fraction),
        0.0,
        4 * math.pi,
    )
    # The quadrature settles to 1e-12 of the mean of |p ds/dφ|; the signed sum here is a third of it.
    assert TABLE.work(area, stroke) == pytest.approx(area * stroke * 4 * math.pi * by_angle, rel=1e-11)


def test_breaks_are_where_the_piston_stands_at_a_node() -> None:
    breaks = np.array(TABLE.breaks(fraction))
    assert breaks.size == 5 + 4 * 2
    distance = np.abs(fraction(breaks)[:, None] - np.array(TABLE.fractions)).min(axis=1)
    assert distance.max() < ROUNDING


def test_work_by_crank_angle_of_a_pressure_known_in_closed_form() -> None:
    # p rises linearly from 0 to P over the cycle: ∫ p dV = −(P/4π) ∫ V dφ, since V returns; over a turn the
    # mean of s/H of a central crank is (1 + ROD − mean √(ROD² − sin²))/2, by the periodic trapezoid rule.
    top = 30e4
    indicator = AngleIndicator((0.0, 4 * math.pi), (0.0, top))
    turn = np.arange(256) * 2 * math.pi / 256
    expected = top * (fraction(np.zeros(1))[0] - fraction(turn).mean())
    assert indicated_work(indicator, 1.0, 1.0, fraction_rate) == pytest.approx(expected, rel=1e-12)


def test_both_forms_agree_where_they_say_the_same() -> None:
    constant = StrokeIndicator((0.0, 1.0), (1e5, 1e5), (0.0, 0.0), (2e5, 2e5), (0.0, 0.0))
    edge = 1e-9
    angles = np.array([0, math.pi - edge, math.pi, 2 * math.pi - edge, 2 * math.pi, 3 * math.pi - edge, 3 * math.pi])
    by_angle = AngleIndicator((*angles, 4 * math.pi), (1e5, 1e5, 0, 0, 2e5, 2e5, 0, 0))
    # The ramps of 1e-9 rad meet dead centres, where the piston stands still: nothing is lost there.
    assert by_angle.work(fraction_rate) == pytest.approx(constant.work(1.0, 1.0), rel=1e-9)


def test_an_ill_made_table_is_refused() -> None:
    with pytest.raises(ValueError):
        StrokeIndicator((0.0, 0.5), (1, 1), (1, 1), (1, 1), (1, 1))
    with pytest.raises(ValueError):
        StrokeIndicator((0.0, 1.0), (1, 1), (1, 1, 1), (1, 1), (1, 1))
    with pytest.raises(ValueError):
        AngleIndicator((0.0, 2.0, 1.0, 4 * math.pi), (0, 0, 0, 0))
