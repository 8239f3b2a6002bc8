"""Wrong files of the slider-crank and the single-cylinder engine: what their own keys and checks refuse."""

from __future__ import annotations

from pathlib import Path

import pytest

from reportgen.catalogue import check

SLIDER = """\
kind: slider-crank
parameters:
  r: 150 mm
  l: 600 mm
  e: 40 mm
  n: 300 rpm
  G2: 40 N
  force:
    by: stroke
    unit: N
    s: [0, 0.5, 1]
    inward: [0, 1, 2]
    outward: [0, 0, 0]
"""
ENGINE = """\
kind: engine-single
positions: {count: 12, direction: clockwise}
parameters:
  H: 215 mm
  e: 45 mm
  K: 1.04
  D: 170 mm
  n: 600 rpm
  s: 0.35
  G2: 120 N
  G3: 200 N
indicator:
  by: ordinates
  scale: 2 N/cm2
  angle: [0 deg, 360 deg, 720 deg]
  height: [0, 140, 0]
"""
CASES = [
    # the slider-crank
    ("rod shorter than crank and offset", SLIDER, "l: 600 mm", "l: 190 mm", ["4:6 out-of-range"]),
    ("offset beyond the rod", SLIDER, "e: 40 mm", "e: -450 mm", ["4:6 out-of-range"]),
    ("no crank", SLIDER, "  r: 150 mm\n", "", ["2:1 missing-key"]),
    ("speed twice", SLIDER, "n: 300 rpm", "n: 300 rpm\n  omega1: 31 rad/s", ["7:3 both-given"]),
    ("weight and mass", SLIDER, "G2: 40 N", "G2: 40 N\n  m2: 4 kg", ["8:3 both-given"]),
    ("form of the force", SLIDER, "by: stroke", "by: hand", ["9:9 choice"]),
    ("no form of the force", SLIDER, "    by: stroke\n", "", ["8:3 missing-key"]),
    ("force in kilograms", SLIDER, "unit: N", "unit: kg", ["10:11 wrong-unit"]),
    ("short row of forces", SLIDER, "[0, 1, 2]", "[0, 1]", ["12:13 row-length"]),
    ("fractions that fall", SLIDER, "[0, 0.5, 1]", "[0, 1, 0.5]", ["11:15 not-increasing"]),
    ("table ends early", SLIDER, "[0, 0.5, 1]", "[0, 0.5, 0.9]", ["11:17 table-end"]),
    ("row of the other form", SLIDER, "    unit: N", "    unit: N\n    F: [1, 2]", ["11:5 unknown-key"]),
    ("an indicator", SLIDER, "kind: slider-crank", "kind: slider-crank\nindicator: {}", ["2:1 unknown-key"]),
    (
        "stroke of no name",
        SLIDER,
        SLIDER[SLIDER.index("    by:") :],
        "    by: constant\n    F: 5 N\n    stroke: up\n",
        ["11:13 choice"],
    ),
    (
        "angles of two turns",
        SLIDER,
        SLIDER[SLIDER.index("    by:") :],
        "    by: crank_angle\n    unit: N\n    angle: [0 deg, 720 deg]\n    F: [0, 1]\n",
        ["11:20 out-of-range"],
    ),
    ("unevenness in words", SLIDER, "e: 40 mm", "e: 40 mm\n  flywheel: {delta: small}", ["6:21 not-a-number"]),
    ("unevenness of 40", SLIDER, "e: 40 mm", "e: 40 mm\n  flywheel: {delta: 40}", ["6:21 out-of-range"]),
    ("flywheel of nothing", SLIDER, "e: 40 mm", "e: 40 mm\n  flywheel: {}", ["6:3 missing-key"]),
    # the engine
    ("faster down than up", ENGINE, "K: 1.04", "K: 0.96", ["6:6 out-of-range"]),
    ("equal travel times beside an offset", ENGINE, "K: 1.04", "K: 1", ["6:6 out-of-range"]),
    ("offset that no crank can have", ENGINE, "e: 45 mm", "e: 3500 mm", ["5:6 out-of-range"]),
    ("no offset beside K", ENGINE, "e: 45 mm", "e: 0 mm", ["5:6 out-of-range"]),
    ("no travel times", ENGINE, "  K: 1.04\n", "", ["3:1 missing-key"]),
    ("lengths twice", ENGINE, "K: 1.04", "K: 1.04\n  R: 107 mm\n  L: 411 mm", ["4:3 both-given"]),
    ("crank without rod", ENGINE, "  H: 215 mm\n  e: 45 mm\n  K: 1.04", "  R: 107 mm", ["3:1 missing-key"]),
    (
        "rod shorter than crank and offset",
        ENGINE,
        "  H: 215 mm\n  e: 45 mm\n  K: 1.04",
        "  R: 107 mm\n  e: 45 mm\n  L: 150 mm",
        ["6:6 out-of-range"],
    ),
    ("gyration and moment", ENGINE, "G3: 200 N", "G3: 200 N\n  rho: 0.16\n  J2: 1 kg m2", ["13:3 both-given"]),
    ("heights without angles", ENGINE, "[0, 140, 0]", "[0, 140]", ["16:11 row-length"]),
    ("scale without unit", ENGINE, "scale: 2 N/cm2", "scale: 2", ["14:10 missing-unit"]),
    ("pressures for heights", ENGINE, "  height:", "  p:", ["12:1 missing-key", "16:3 unknown-key"]),
    (
        "firing of one cylinder",
        ENGINE,
        "  by: ordinates",
        "  by: ordinates\n  firing: [intake, exhaust]",
        ["14:3 unknown-key"],
    ),
    (
        "position after the cycle",
        ENGINE,
        "parameters:",
        "report: {worked_positions: [30, 31]}\nparameters:",
        ["3:33 no-such-position"],
    ),
]


@pytest.mark.parametrize(
    ("base", "old", "new", "expected"), [case[1:] for case in CASES], ids=[case[0] for case in CASES]
)
def test_edit_of_a_right_file(tmp_path: Path, base: str, old: str, new: str, expected: list[str]) -> None:
    assert old in base
    file = tmp_path / "a.yaml"
    file.write_text(base.replace(old, new, 1), encoding="utf-8")
    assert [f"{p.mark.line}:{p.mark.column} {p.code}" for p in check(file, "en")] == expected


@pytest.mark.parametrize("text", [SLIDER, ENGINE], ids=["slider-crank", "engine-single"])
def test_the_files_they_start_from_are_right(tmp_path: Path, text: str) -> None:
    file = tmp_path / "a.yaml"
    file.write_text(text, encoding="utf-8")
    assert check(file) == []
