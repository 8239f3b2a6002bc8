"""Wrong files of the four-bar linkage and the six-link lever mechanism, and machines that cannot go round."""

from __future__ import annotations

import math
import re
from pathlib import Path

import pytest

from reportgen.catalogue import check

FOUR = """\
kind: four-bar
report: {language: en}
parameters:
  AB: 120 mm
  BC: 340 mm
  CD: 280 mm
  AD: 400 mm
  omega1: 20 rad/s
  E: {along: 150 mm, across: 110 mm}
  torque: {M: 40 N m}
"""
SIX = """\
kind: lever-six-bar
report: {language: en}
parameters:
  AB: 34 mm
  AC: 90 mm
  CD: 60 mm
  CE: 30 mm
  EF: 110 mm
  D: {x: -10 mm, y: -106 mm}
  guide: -73 mm
  omega1: 89 rad/s
"""
CASES = [
    # keys and values
    ("no speed", FOUR, "  omega1: 20 rad/s\n", "", ["3:1 missing-key"]),
    ("speed twice", FOUR, "omega1: 20 rad/s", "omega1: 20 rad/s\n  n: 9 rpm", ["9:3 both-given"]),
    ("weight and mass", FOUR, "BC: 340 mm", "BC: 340 mm\n  G2: 3 N\n  m2: 1 kg", ["7:3 both-given"]),
    ("branch of no name", FOUR, "CD: 280 mm", "CD: 280 mm\n  branch: upper", ["7:11 choice"]),
    ("half a coupler point", FOUR, "{along: 150 mm, across: 110 mm}", "{across: 110 mm}", ["9:3 missing-key"]),
    ("torque in newtons", FOUR, "M: 40 N m", "M: 40 N", ["10:15 wrong-unit"]),
    ("force without direction", FOUR, "torque: {M: 40 N m}", "force: {P: 40 N}", ["10:3 missing-key"]),
    ("an indicator", FOUR, "kind: four-bar", "kind: four-bar\nindicator: {}", ["2:1 unknown-key"]),
    ("no fixed point", SIX, "  D: {x: -10 mm, y: -106 mm}\n", "", ["3:1 missing-key"]),
    ("E beyond A", SIX, "CE: 30 mm", "CE: 95 mm", ["7:7 out-of-range"]),
    ("side of no name", SIX, "CE: 30 mm", "CE: 30 mm\n  F: above", ["8:6 choice"]),
    ("flywheel, no loads", SIX, "CE: 30 mm", "CE: 30 mm\n  flywheel: {delta: 0.1}", ["8:3 flywheel-without-loads"]),
    # machines that do not go round
    ("crank too long", FOUR, "AB: 120 mm", "AB: 300 mm", ["5:7 no-assembly"]),
    ("links too short", FOUR, "AD: 400 mm", "AD: 900 mm", ["5:7 never-assembled"]),
    ("change point", FOUR, "BC: 340 mm", "BC: 240 mm", ["5:7 dead-point"]),
    ("no rocker", FOUR.replace("120 mm", "300 mm"), "AD: 400 mm", "AD: 100 mm\n  link3: rocker", ["8:10 not-a-rocker"]),
    ("no crank", FOUR, "AD: 400 mm", "AD: 400 mm\n  link3: crank", ["8:10 not-a-crank"]),
    ("coupler too short", SIX, "AC: 90 mm", "AC: 70 mm", ["6:7 no-assembly"]),
    ("rod too short", SIX, "EF: 110 mm", "EF: 30 mm", ["8:7 no-assembly"]),
    ("guide out of reach", SIX, "guide: -73 mm", "guide: 300 mm", ["8:7 never-assembled"]),
    (
        "rocker that is a crank",
        SIX.replace("AB: 34 mm", "AB: 140 mm").replace("CD: 60 mm", "CD: 130 mm").replace("110 mm", "600 mm"),
        "AC: 90 mm",
        "AC: 120 mm",
        ["6:7 not-a-rocker"],
    ),
]


@pytest.mark.parametrize(("base", "old", "new", "expected"), [case[1:] for case in CASES], ids=[c[0] for c in CASES])
@pytest.mark.parametrize("language", ["vi", "en"])
def test_faults(tmp_path: Path, base: str, old: str, new: str, expected: list[str], language: str) -> None:
    assert old in base
    file = tmp_path / "a.yaml"
    file.write_text(base.replace(old, new).replace("language: en", f"language: {language}"))
    found = check(file)
    assert [f"{fault.mark.line}:{fault.mark.column} {fault.code}" for fault in found] == expected
    assert all("{" not in fault.message for fault in found)


def test_bases_are_in_order(tmp_path: Path) -> None:
    for base in (FOUR, SIX):
        file = tmp_path / "a.yaml"
        file.write_text(base)
        assert check(file) == []


def test_the_range_of_the_crank_is_told(tmp_path: Path) -> None:
    """With AB = 300 mm, BD would have to be longer than BC + CD = 620 mm beyond a crank angle."""
    file = tmp_path / "a.yaml"
    file.write_text(FOUR.replace("AB: 120 mm", "AB: 300 mm"))
    (fault,) = check(file)
    assert "(2, 3)" in fault.message
    assert "BC, CD" in fault.message
    numbers = [float(number) for number in re.findall(r"(-?[\d.]+)°", fault.message)]
    limit = math.degrees(math.acos((300**2 + 400**2 - 620**2) / (2 * 300 * 400)))
    # Printed with four figures.
    assert sorted(numbers) == pytest.approx([-limit, limit], abs=0.05)


def test_a_dead_point_is_told_with_its_angle(tmp_path: Path) -> None:
    """AB + AD = BC + CD: at 180° coupler and link 3 lie in one line."""
    file = tmp_path / "a.yaml"
    file.write_text(FOUR.replace("BC: 340 mm", "BC: 240 mm"))
    (fault,) = check(file)
    angle = float(re.findall(r"(-?[\d.]+)°", fault.message)[0])
    assert abs(angle) == pytest.approx(180, abs=0.1)
