"""Crank-rockers and slider-cranks from K and swing or stroke: known lengths, and random ones turned through a cycle."""

from __future__ import annotations

import math

import numpy as np
import pytest

from reportgen.structure.extreme_positions import CrankRockerTask, FourBar, crank_angle_between, slider_crank


def test_crank_rocker_of_the_best_transmission() -> None:
    """K 1.3, ψ 42°, c 120 mm: θ 23.478261°, circle 107.941858 mm, γ_min 39.876037°."""
    task = CrankRockerTask(1.3, math.radians(42), 120.0)
    assert math.degrees(task.angle) == pytest.approx(23.478261, abs=1e-6)
    assert task.radius == pytest.approx(107.941858, abs=1e-6)
    best = task.best()
    assert best is not None
    made = best[1]
    assert (made.crank, made.coupler, made.frame) == pytest.approx((39.52636, 92.17501, 116.46185), abs=2e-5)
    assert math.degrees(made.transmission) == pytest.approx(39.876037, abs=1e-6)


def test_slider_crank() -> None:
    """K 1.4, H 50, e 20 mm: θ 30°, r 22.159093, l 49.910173 mm, γ_min 32.360258°."""
    made = slider_crank(1.4, 50.0, 20.0)
    assert made is not None
    assert math.degrees(crank_angle_between(1.4)) == pytest.approx(30)
    assert (made.crank, made.rod) == pytest.approx((22.159093, 49.910173), abs=1e-6)
    assert math.degrees(made.transmission) == pytest.approx(32.360258, abs=1e-6)


def turned(made: FourBar) -> tuple[float, float, float]:
    """Return swing and least transmission angle (rad) over a finely divided turn, and K from its extremes."""
    φ = np.linspace(0, 2 * math.pi, 20001)
    A = made.crank * np.exp(1j * φ)
    to = made.frame - A
    diagonal = np.abs(to)
    cosine = (made.coupler**2 + made.rocker**2 - diagonal**2) / (2 * made.coupler * made.rocker)
    at_D = np.arccos((made.rocker**2 + diagonal**2 - made.coupler**2) / (2 * made.rocker * diagonal))
    rocker = np.unwrap(np.angle(-to) - at_D)
    γ = np.arccos(cosine)
    between = abs(φ[rocker.argmax()] - φ[rocker.argmin()])
    slow = max(between, 2 * math.pi - between)
    return float(np.ptp(rocker)), float(np.minimum(γ, math.pi - γ).min()), slow / (2 * math.pi - slow)


def test_random_crank_rockers_turn_as_wanted() -> None:
    random = np.random.default_rng(66)
    solved = 0
    for _ in range(200):
        K, ψ = random.uniform(1.05, 1.8), math.radians(random.uniform(15, 80))
        made = CrankRockerTask(K, ψ, 1.0).four_bar(random.uniform(0, 2 * math.pi))
        if made is None:
            continue
        solved += 1
        swing, least, ratio = turned(made)
        assert swing == pytest.approx(ψ, abs=1e-6)
        assert least == pytest.approx(made.transmission, abs=1e-6)
        assert ratio == pytest.approx(K, abs=2e-3)
    assert solved > 20


def test_random_slider_cranks_have_stroke_and_k_or_there_is_none() -> None:
    """K from both extreme directions of the rod; where there is none, a scan over all lengths finds none."""
    random = np.random.default_rng(67)
    absent = 0
    for _ in range(2000):
        K, e = random.uniform(1.02, 2.5), random.uniform(0.01, 2.0)
        made = slider_crank(K, 1.0, e)
        if made is None:
            absent += 1
            if absent <= 40:
                R, L = np.meshgrid(np.linspace(0.01, 0.6, 250), np.linspace(0.02, 6, 500))
                turns = R + e < L
                R, L = R[turns], L[turns]
                θ = np.arccos(e / (L + R)) - np.arccos(e / (L - R))
                H = np.sqrt((L + R) ** 2 - e**2) - np.sqrt((L - R) ** 2 - e**2)
                assert not np.any((np.abs(θ - crank_angle_between(K)) < 2e-3) & (np.abs(H - 1) < 2e-3))
            continue
        between = math.acos(e / (made.rod + made.crank)) - math.acos(e / (made.rod - made.crank))
        assert (math.pi + between) / (math.pi - between) == pytest.approx(K, abs=1e-9)
        assert made.stroke == pytest.approx(1.0, abs=1e-9)
    assert 0 < absent < 2000
