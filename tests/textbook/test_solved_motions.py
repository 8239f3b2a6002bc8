"""Solved examples of motion in R. S. Khurmi, J. K. Gupta, Theory of Machines, 14th edition, chapters 7, 8 and 15.

Data, answers and page numbers are those of the textbook companion at https://tbc-python.fossee.in (folder
Theory_Of_Machines), crank angles and frames of its figures. Where the book draws, its readings differ from the exact
values by the tolerance in the row; where it calculates, it takes two terms of the series in λ.
"""

from __future__ import annotations

import math

import pytest

import reportgen
from reportgen import api
from reportgen.machine.kinematics import Motion


def motion(kind: str, parameters: str, positions: str) -> Motion:
    text = f"kind: {kind}\nreport: {{language: en}}\nparameters: {{{parameters}}}\npositions: {{{positions}}}\n"
    return api.analyse(reportgen.open(text).assignment).motion


def rates(moving: Motion, link: int) -> tuple[float, float]:
    return float(moving.links[link].omega[0]), float(moving.links[link].epsilon[0])


def sizes(moving: Motion, point: str) -> tuple[float, float]:
    return abs(complex(moving.points[point].v[0])), abs(complex(moving.points[point].a[0]))


@pytest.mark.parametrize(
    ("parameters", "angle", "slider", "centre", "rod"),
    [
        # Example 15.1, p. 521: Klein's construction, read to 2 mm of 127 mm.
        ("r: 200 mm, l: 700 mm, omega1: 120 rad/s, s: 0.5", 30, (15.24, 2880), (16.8, 2779.2), (29.66, 1913.14)),
        # Example 15.2, p. 522: D at 150 mm from the crank pin; read to 1 mm of 78 mm.
        ("r: 150 mm, l: 600 mm, n: 450 rpm, s: 0.25", 60, (6.833, 124.4), (6.833, 266.48), (6.126, 481.14)),
    ],
)
def test_slider_crank_by_drawing(
    parameters: str, angle: int, slider: tuple[float, float], centre: tuple[float, float], rod: tuple[float, float]
) -> None:
    moving = motion("slider-crank", parameters, f"at: [{angle} deg]")
    reading = 0.03
    assert sizes(moving, "C") == pytest.approx(slider, rel=reading)
    assert sizes(moving, "S2") == pytest.approx(centre, rel=reading)
    assert [abs(rate) for rate in rates(moving, 2)] == pytest.approx(rod, rel=reading)


@pytest.mark.parametrize(
    ("r", "rod", "n", "angle", "printed"),
    [
        (0.3, 1.0, 200, 75, (6.54, None)),  # example 15.3, p. 527: the greatest velocity
        (0.3, 1.5, 180, 40, (4.19, 85.36)),  # example 15.4, p. 528
        (0.15, 0.6, 450, 60, (6.9, 124.91)),  # example 15.5, p. 528
    ],
)
def test_slider_crank_by_two_terms(
    r: float, rod: float, n: int, angle: int, printed: tuple[float, float | None]
) -> None:
    """The book's two terms give its digits; the exact values differ from them by less than λ³ of r ω and of r ω²."""
    moving = motion("slider-crank", f"r: {r} m, l: {rod} m, n: {n} rpm", f"at: [{angle} deg]")
    θ, ω, λ = math.radians(angle), n * math.pi / 30, r / rod
    series = (r * ω * (math.sin(θ) + λ * math.sin(2 * θ) / 2), r * ω**2 * (math.cos(θ) + λ * math.cos(2 * θ)))
    for value, book, terms, unit in zip(sizes(moving, "C"), printed, series, (r * ω, r * ω**2), strict=True):
        if book is not None:
            assert terms == pytest.approx(book, abs=0.05 if book == 6.9 else 0.01)
            assert value == pytest.approx(terms, abs=λ**3 * unit)


def test_piston_without_acceleration() -> None:
    """Example 15.4, p. 528: at 79.27° by two terms, where the exact acceleration is under 1 % of r ω²."""
    moving = motion("slider-crank", "r: 0.3 m, l: 1.5 m, n: 180 rpm", "at: [79.27 deg]")
    assert sizes(moving, "C")[1] < 0.01 * 0.3 * (6 * math.pi) ** 2


def test_angular_velocity_of_a_long_rod() -> None:
    """Example 7.2, p. 148: ω₂ = 3.4 rad/s.

    The drawing gives 8.15 m/s for the piston, r ω sin(θ + φ)/cos φ is 7.86 m/s: 3.5 % less.
    """
    moving = motion("slider-crank", "r: 0.5 m, l: 2 m, n: 180 rpm", "at: [45 deg]")
    assert abs(rates(moving, 2)[0]) == pytest.approx(3.4, abs=0.05)
    φ = math.asin(math.sin(math.pi / 4) / 4)
    exact = 0.5 * 6 * math.pi * math.sin(math.pi / 4 + φ) / math.cos(φ)
    assert sizes(moving, "C")[0] == pytest.approx(exact)
    assert exact == pytest.approx(8.15, rel=0.04)


def test_four_bar_with_a_coupler_as_long_as_the_frame() -> None:
    """Example 7.1, p. 148: 4.8 rad/s."""
    moving = motion("four-bar", "AB: 40 mm, BC: 150 mm, CD: 80 mm, AD: 150 mm, n: 120 rpm", "at: [60 deg]")
    assert rates(moving, 3)[0] == pytest.approx(4.8, abs=0.05)


def test_four_bar_at_constant_speed() -> None:
    """Example 8.4, p. 184: 1.9 and 3.79 rad/s, 23.43 and 47.1 rad/s²; 0.333 m/s over 0.175 m is read 4 % short."""
    lengths = "AB: 62.5 mm, BC: 175 mm, CD: 112.5 mm, AD: 200 mm, omega1: 10 rad/s"
    moving = motion("four-bar", lengths, "at: [60 deg]")
    (ω2, ε2), (ω3, ε3) = rates(moving, 2), rates(moving, 3)
    assert abs(ω2) == pytest.approx(1.9, rel=0.045)
    assert ω3 == pytest.approx(3.79, abs=0.005)
    assert (ε2, ε3) == pytest.approx((23.43, 47.1), rel=0.025)


def test_four_bar_whose_crank_gains_speed() -> None:
    """Example 8.5, p. 186: 10 rad/s and 30 rad/s² clockwise; 5.7 and 6.1 rad/s, 37.8 and 73.9 rad/s², 29.6 m/s².

    By symmetry (360 mm twice) both rates are 6.02 rad/s: the drawing reads 2.05 and 2.2 m/s for one velocity.
    """
    lengths = "AB: 300 mm, BC: 360 mm, CD: 360 mm, AD: 600 mm, omega1: 10 rad/s, epsilon1: 30 rad/s2"
    moving = motion("four-bar", lengths, "at: [60 deg], direction: clockwise")
    (ω2, ε2), (ω3, ε3) = rates(moving, 2), rates(moving, 3)
    assert (ω2, ω3) == pytest.approx((5.7, -6.1), rel=0.06)
    assert ω2 == pytest.approx(-ω3)
    assert (ε2, ε3) == pytest.approx((37.8, 73.9), rel=0.05)
    assert sizes(moving, "C")[1] == pytest.approx(29.6, rel=0.045)
