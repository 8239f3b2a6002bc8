"""Lengths that a four-bar and a slider-crank find: published ones, and those of machines from their own analysis."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from reportgen import api, catalogue
from reportgen.formula.calculation import Calculation

TYPED = 1e-9
"""Wanted values are typed to twelve places."""


def sheet(folder: Path, kind: str, parameters: str) -> Calculation:
    """Return the quantities of a machine from the flow mapping of its parameters."""
    path = folder / f"{kind}.yaml"
    path.write_text(f"kind: {kind}\nparameters: {{{parameters}, omega1: 10 rad/s}}\n", encoding="utf-8")
    return api.analyse(api.load(path)).machine.calculation


def test_slider_crank_with_a_known_offset(tmp_path: Path) -> None:
    """K 1.4, H 50, e 20 mm: r 22.15909, l 49.91017 mm, γ_min 32.36026°."""
    q = sheet(tmp_path, "slider-crank", "r: find, l: find, e: 20 mm, stroke: {K: 1.4, H: 50 mm}")
    assert [q.si(id) * 1e3 for id in ("l.AB", "l.BC")] == pytest.approx((22.15909, 49.91017), abs=1e-5)
    assert math.degrees(q.si("gamma.least")) == pytest.approx(32.36026, abs=1e-5)


def test_crank_rocker_of_the_best_transmission(tmp_path: Path) -> None:
    """K 1.3, ψ 42°, c 120 mm: a 39.52636, b 92.17501, d 116.46185 mm, γ_min 39.87604°."""
    q = sheet(tmp_path, "four-bar", "AB: find, BC: find, AD: find, CD: 120 mm, swing: {K: 1.3, psi: 42 deg}")
    found = [q.si(id) * 1e3 for id in ("l.AB", "l.BC", "l.AD")]
    assert found == pytest.approx((39.52636, 92.17501, 116.46185), abs=2e-5)
    assert math.degrees(q.si("theta")) == pytest.approx(23.47826, abs=1e-5)
    assert math.degrees(q.si("gamma.least")) == pytest.approx(39.87604, abs=1e-5)


@pytest.mark.parametrize("known", ["AB", "AD"])
@pytest.mark.parametrize("lengths", [(40, 95, 80, 110), (30, 90, 70, 75), (25, 60, 80, 90)])
def test_a_crank_rocker_is_found_again(tmp_path: Path, lengths: tuple[float, ...], known: str) -> None:
    """From the swing and K that its extreme positions give, and one length, its other lengths are found."""
    own = dict(zip(("AB", "BC", "CD", "AD"), lengths, strict=True))
    given = sheet(tmp_path, "four-bar", ", ".join(f"{name}: {length} mm" for name, length in own.items()))
    wanted = f"swing: {{K: {given.si('K'):.13f}, psi: {math.degrees(given.si('swing')):.12f} deg, A: {{}}}}"
    solutions = []
    for side in ("beyond", "before"):
        typed = {"AB": "find", "BC": "find", "AD": "find", "CD": f"{own['CD']} mm"} | {known: f"{own[known]} mm"}
        text = ", ".join(f"{name}: {value}" for name, value in typed.items())
        path = tmp_path / "found.yaml"
        path.write_text(
            f"kind: four-bar\nparameters: {{{text}, {wanted.replace('{}', side)}, omega1: 1 rad/s}}\n", encoding="utf-8"
        )
        if not catalogue.check(path):
            q = api.analyse(api.load(path)).machine.calculation
            solutions.append([q.si(id) * 1e3 for id in ("l.AB", "l.BC", "l.AD")])
    assert any(np.allclose(found, (own["AB"], own["BC"], own["AD"]), rtol=1e-7) for found in solutions), solutions


@pytest.mark.parametrize(("r", "rod", "e"), [(30, 100, 25), (50, 160, 60)])
def test_a_slider_crank_is_found_again(tmp_path: Path, r: float, rod: float, e: float) -> None:
    """From the stroke and K that its dead centres give; the crank finds the offset, the offset the crank."""
    out, back = math.sqrt((rod + r) ** 2 - e**2), math.sqrt((rod - r) ** 2 - e**2)
    θ = math.degrees(math.acos(e / (rod + r)) - math.acos(e / (rod - r)))
    stroke = f"stroke: {{K: {(180 + θ) / (180 - θ):.13f}, H: {out - back:.12f} mm}}"
    for known in (f"r: find, e: {e} mm", f"r: {r} mm, e: find"):
        q = sheet(tmp_path, "slider-crank", f"{known}, l: find, {stroke}")
        assert [q.si(id) * 1e3 for id in ("l.AB", "l.BC", "e")] == pytest.approx((r, rod, e), rel=1e-7)


@pytest.mark.parametrize("direction", ["anticlockwise", "clockwise"])
def test_the_motion_is_as_wanted(tmp_path: Path, direction: str) -> None:
    """The course of the slider has the stroke, and the angles between its dead centres the ratio, of the file."""
    path = tmp_path / "slider.yaml"
    path.write_text(
        f"kind: slider-crank\npositions: {{direction: {direction}}}\n"
        "parameters: {r: find, l: find, e: find, stroke: {K: 1.25, H: 80 mm}, n: 60 rpm}\n",
        encoding="utf-8",
    )
    course = api.analyse(api.load(path)).machine.sliders[0]
    assert abs(course.top - course.bottom) == pytest.approx(0.08, rel=TYPED)
    turned = course.bottom_angle - course.top_angle
    ratio = max(turned, 2 * math.pi - turned) / min(turned, 2 * math.pi - turned)
    assert ratio == pytest.approx(1.25, rel=TYPED)
