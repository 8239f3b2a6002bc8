"""Flywheels of R. S. Khurmi and J. K. Gupta, Theory of Machines, chapter 16, and of Shigley, chapter 16.

Examples and pages of Khurmi as in the textbook companion at https://tbc-python.fossee.in. The books
round ω and the areas on the way: their results agree to the last printed digit or two.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import pytest

from reportgen import load, solve

EXAMPLES = Path(__file__).parents[2] / "assignments" / "turning-moment"
HEAD = "kind: turning-moment\nreport: {language: en}\nparameters:\n"


def wheel(tmp_path: Path, *lines: str) -> Any:
    """Return the results of a file with these parameters."""
    file = tmp_path / "wheel.yaml"
    file.write_text(HEAD + "".join(f"  {line}\n" for line in lines), encoding="utf-8")
    return solve(load(file))["positions"][0]["wheel"]


def test_petrol_engine_by_areas() -> None:
    """Khurmi 16.4, p. 574: areas of 295, 685, 40, 340, 960, 270 mm², 36 kg at 150 mm, 1800 rpm: 86 N·m, C_s = 0.3 %."""
    found = solve(load(EXAMPLES / "areas.yaml"))["positions"][0]["wheel"]
    assert found["range"] == pytest.approx(985 * math.pi / 36)
    assert found["range"] == pytest.approx(86, abs=0.5)
    assert found["delta"] == pytest.approx(0.003, abs=0.00005)


def test_multi_cylinder_engine_by_areas(tmp_path: Path) -> None:
    """Khurmi 16.5, p. 575: 1 mm is 600 N·m and 3°; ±1.5 % at 600 rpm, 0.5 m: ΔE = 172 mm² = 5404 N·m, m = 183 kg."""
    areas = "areas: {values: [52, -124, 92, -140, 85, -72, 107], torque: 600 N m, angle: 3 deg}"
    found = wheel(tmp_path, areas, "n: 600 rpm", "delta: 0.03", "k: 0.5 m")
    assert found["range"] == pytest.approx(5404, abs=1)
    assert found["mass"] == pytest.approx(183, abs=1)


def test_engine_by_a_curve() -> None:
    """Khurmi 16.11, p. 585: T = 20 000 + 9500 sin 2θ − 5700 cos 2θ; 377 kW, 3121 kg·m² for 1 % at 180 rpm, and
    3.044 rad/s² at 45°.
    """
    found = solve(load(EXAMPLES / "curve.yaml"))["positions"][0]["wheel"]
    assert found["range"] == pytest.approx(math.hypot(9500, 5700))
    assert found["power"] == pytest.approx(377e3, abs=500)
    assert found["inertia"] == pytest.approx(3121, rel=2e-3)
    assert found["acceleration"] == pytest.approx(3.044, abs=0.004)


def test_engine_and_load_by_curves() -> None:
    """Khurmi 16.12, p. 587: 5000 + 600 sin 2θ against 5000 + 500 sin θ, 500 kg at 0.4 m, 150 rpm; 1204 N·m, 6.1 %."""
    position = solve(load(EXAMPLES / "two-curves.yaml"))["positions"][0]
    assert position["wheel"]["range"] == pytest.approx(1204, abs=0.5)
    assert position["wheel"]["delta"] == pytest.approx(0.061, abs=0.0005)
    cosine = math.acos(500 / 1200)
    assert list(position["intersections"].values()) == pytest.approx([0, cosine, math.pi, 2 * math.pi - cosine])


def test_three_cylinder_engine_by_a_table(tmp_path: Path) -> None:
    """Khurmi 16.8, p. 580: triangles of 90 N·m at 120° add up to 45 … 90 N·m; 4.24 kW, 11.78 N·m, 3.9 %, 293 rad/s²."""
    torque = "driving: {phi: [0 deg, 60 deg, 120 deg], M: [45, 90, 45], unit: N m}"
    found = wheel(tmp_path, torque, "n: 600 rpm", "m: 12 kg", "k: 80 mm", "at: 60 deg")
    assert found["mean"] == pytest.approx(67.5)
    assert found["power"] == pytest.approx(4.24e3, abs=5)
    assert found["range"] == pytest.approx(11.78, abs=0.005)
    assert found["delta"] == pytest.approx(0.039, abs=0.0005)
    assert found["acceleration"] == pytest.approx(293, abs=0.5)


def test_locomotive_flywheel_by_its_fluctuation(tmp_path: Path) -> None:
    """Khurmi 16.1, p. 573: 6.5 t at 1.8 m, ΔE = 56 kN·m, 120 rpm; 121 rpm and 119 rpm."""
    found = wheel(tmp_path, "areas: {values: [56, -56], unit: kJ}", "n: 120 rpm", "m: 6500 kg", "k: 1.8 m")
    speeds = [found[name] * 30 / math.pi for name in ("fastest", "slowest")]
    assert speeds == pytest.approx([121, 119], abs=0.1)


SHIGLEY = """0 2800 2090 2430 2160 1840 1590 1210 1066 803 532 184 0 -107 -206 -260 -323 -310 -242 -126 -8 89 125 85 0
-85 -125 -89 8 126 242 310 323 280 206 107 0 -107 -206 -292 -355 -371 -362 -312 -272 -274 -548 -760 0"""


def test_four_stroke_engine_by_a_table(tmp_path: Path) -> None:
    """Shigley: torques every 15° of two turns (lbf·in), about 3368 in·lbf in a cycle and 3531 in·lbf between ω_min and
    ω_max; the book adds ordinates, which differs from straight lines by a few per cent.
    """
    torques = SHIGLEY.split()
    angles = ", ".join(f"{15 * k} deg" for k in range(len(torques)))
    table = f"driving: {{phi: [{angles}], M: [{', '.join(torques)}], unit: N m}}"
    found = wheel(tmp_path, table, "n: 250 rad/s", "delta: 0.1")
    assert found["work"] == pytest.approx(3368, rel=0.02)
    assert found["range"] == pytest.approx(3531, rel=0.02)
