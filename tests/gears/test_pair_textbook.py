"""Pairs with printed results: three of textbooks, and what follows from the theory of the involute."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from reportgen import load
from reportgen.formula.evaluation import arcinv, inv
from reportgen.gears.involute import Wheel
from reportgen.gears.pair_formulas import Rack
from reportgen.gears.pair_shifts import GearPair, PairLimits, balanced, least_shifts, least_sliding, sum_for

MM = 1e-3
ISO = Rack(math.radians(20))


def pair(m: float, teeth: tuple[int, int], *shifts: float) -> GearPair:
    return GearPair(ISO, m * MM, teeth, np.array(shifts))


def test_a_printed_pair_with_a_given_centre_distance() -> None:
    """m 3, z 12/24, a_w 56.5, x₁ 0.6: every figure as it is printed."""
    total = sum_for(ISO, 3 * MM, (12, 24), 56.5 * MM)
    assert round(total - 0.6, 2) == 0.36
    found = pair(3, (12, 24), 0.6, total - 0.6)
    assert round(math.degrees(float(found["alpha_w"])), 4) == 26.0888
    assert float(found["a_w"]) == pytest.approx(56.5 * MM, rel=1e-12)
    assert round(float(found["y"]), 5) == 0.83333
    printed = {
        "d": (36, 72),
        "d_b": (33.8289, 67.6579),
        "d_w": (37.667, 75.333),
        "d_a": (44.840, 79.400),
        "d_f": (32.100, 66.660),
    }
    for name, values in printed.items():
        # The source has x₂ and what follows from it to hundredths: 0.36 for 0.36004 is 0.0003 mm of a diameter.
        assert found[name] / MM == pytest.approx(values, abs=8e-4), name
    assert (found["d_a"] - found["d"]) / 2 / MM == pytest.approx((4.420, 3.700), abs=5e-4)
    assert (found["d_a"] - found["d_f"]) / 2 / MM == pytest.approx((6.370, 6.370), abs=5e-4)
    assert round(float(found["epsilon"]), 3) == 1.202


@pytest.mark.parametrize(
    ("teeth", "x", "angle", "a_w", "epsilon"),
    [((12, 28), 0.5, 25.7948, 208.738, 1.2275), ((13, 22), 0.3, 24.2947, 180.424, 1.3192)],
)
def test_computed_pairs(teeth: tuple[int, int], x: float, angle: float, a_w: float, epsilon: float) -> None:
    found = pair(10, teeth, x, x)
    assert round(math.degrees(float(found["alpha_w"])), 4) == angle
    assert round(float(found["a_w"]) / MM, 3) == a_w
    assert round(float(found["epsilon"]), 4) == epsilon


def test_tips_sliding_and_undercut_of_a_computed_pair() -> None:
    found = pair(10, (12, 28), 0.5, 0.5)
    assert np.round(found["d_a"] / MM, 3).tolist() == [147.475, 307.475]
    assert np.round(found["s_a"] / found.m, 3).tolist() == [0.496, 0.713]
    assert np.round(found.sliding, 2).tolist() == [-2.02, -1.56]
    assert round(float(found["x_min"][0]), 3) == 0.298


def test_the_inverse_of_the_involute_of_an_angle() -> None:
    angles = np.concatenate((np.geomspace(1e-4, 0.1, 50), np.linspace(0.1, 1.5, 200)))
    assert np.abs(arcinv(inv(angles)) / angles - 1).max() < 1e-7
    # From the value on nothing is lost.
    values = np.geomspace(1e-6, 10, 200)
    assert np.abs(inv(arcinv(values)) / values - 1).max() < 1e-9
    assert arcinv(0.0) == 0
    assert np.isnan(arcinv(-1e-3))


def test_working_thicknesses_fill_the_pitch() -> None:
    """Without backlash s_w1 + s_w2 = π d_w/z, whatever the shifts: a second way to the working pressure angle."""
    rng = np.random.default_rng(36)
    for _ in range(200):
        z1, z2 = rng.integers(8, 80, 2)
        found = pair(1, (int(z1), int(z2)), *rng.uniform(0, 0.8, 2))
        s_w = found["d_w"] * (found["s"] / found["d"] + inv(ISO.alpha) - inv(found["alpha_w"]))
        pitch = math.pi * found["d_w"][0] / z1
        assert s_w.sum() == pytest.approx(pitch, rel=1e-12)


def test_the_path_of_contact_is_the_contact_ratio() -> None:
    found = pair(10, (12, 28), 0.5, 0.5)
    active = found["rho_a"][0] - found["rho_p"][0]
    assert active / found["p_b"] == pytest.approx(float(found["epsilon"]), rel=1e-12)


def test_sliding_is_the_ratio_of_velocities() -> None:
    """λ₁ = (v₁ − v₂)/v₁ with the speeds ω ρ along the profiles."""
    found = pair(10, (12, 28), 0.5, 0.5)
    v1, v2 = found["rho_p"][0] * 28, found["rho_a"][1] * 12
    assert (v1 - v2) / v1 == pytest.approx(found.sliding[0], rel=1e-12)


# --- shifts ---------------------------------------------------------------------------------------


def test_least_shifts() -> None:
    assert least_shifts(pair(5, (12, 40), 0, 0)).tolist() == [0.3, 0.0]
    # 17 teeth need 0.0059 with h_a* 1 and 20°.
    assert least_shifts(pair(5, (17, 18), 0, 0)).tolist() == [0.01, 0.0]


def test_both_feet_slide_alike() -> None:
    found = pair(4, (13, 36), *balanced(pair(4, (13, 36), 0, 0), 0.9))
    assert found.x.sum() == pytest.approx(0.9, abs=1e-12)
    assert found.sliding[0] == pytest.approx(found.sliding[1], abs=1e-9)


def test_no_pair_of_hundredths_slides_less() -> None:
    """Each neighbour of the chosen shifts either breaks a limit or slides more."""
    limits = PairLimits()
    x = least_sliding(pair(4, (13, 36), 0, 0), limits)
    chosen = pair(4, (13, 36), *x)
    assert chosen.keeps(limits)
    for dx in (-0.01, 0, 0.01):
        for dy in (-0.01, 0, 0.01):
            other = pair(4, (13, 36), x[0] + dx, x[1] + dy)
            keeps = other.keeps(limits)
            assert not keeps or other.sliding.min() <= chosen.sliding.min() + 1e-12


def test_a_pair_has_its_numbers_from_the_formulas_of_its_report() -> None:
    """No quantity of the sheet is worked out a second time by the pair or by a wheel, but the shifts that they have."""
    names = {id.split(".")[1] for id in pair(10, (12, 28), 0.5, 0.5).calculation.families}
    assert {"alpha_w", "d_a", "rho_p", "lambda"} <= names
    fields = {"x", "z", "m"}
    assert not (names - fields) & ({*dir(GearPair)} | {*dir(Wheel)})


def worst_sliding(z: tuple[int, int], x: tuple[float, float], α: float) -> float:
    """The greater |λ| at the feet, by the involute function and the tip circles shortened by Δy = Σx − y."""

    def inv(angle: float) -> float:
        return math.tan(angle) - angle

    goal, low, high = inv(α) + 2 * sum(x) / sum(z) * math.tan(α), 1e-3, 1.2
    for _ in range(80):
        middle = (low + high) / 2
        low, high = (middle, high) if inv(middle) < goal else (low, middle)
    a_w = sum(z) / 2 * math.cos(α) / math.cos(low)
    shortened = sum(x) - (a_w - sum(z) / 2)
    base = [teeth / 2 * math.cos(α) for teeth in z]
    tips = [teeth / 2 + 1 + shift - shortened for teeth, shift in zip(z, x, strict=True)]
    at_tip = [math.sqrt(tip**2 - b**2) for tip, b in zip(tips, base, strict=True)]
    whole = a_w * math.sin(low)
    λ1 = 1 - z[0] / z[1] * at_tip[1] / (whole - at_tip[1])
    λ2 = 1 - z[1] / z[0] * at_tip[0] / (whole - at_tip[0])
    return max(-λ1, -λ2)


def test_equal_sliding_beyond_the_usual_shifts(tmp_path: Path) -> None:
    """z 14/98, α 17.5°: the least sliding lies at x₂ = 1.60, where the limits still hold."""
    file = tmp_path / "pair.yaml"
    file.write_text("kind: gear-pair\nparameters: {m: 5 mm, z1: 14, z2: 98, alpha: 17.5 deg, by: equal-sliding}\n")
    chosen = load(file).parameters.chosen
    assert chosen.pair.x == pytest.approx([0.71, 1.60])
    assert not list(chosen.broken())
    worst = worst_sliding((14, 98), (0.71, 1.60), math.radians(17.5))
    assert worst == pytest.approx(1.0388, abs=5e-5)
    assert -chosen.pair.sliding.min() == pytest.approx(worst, rel=1e-9)
