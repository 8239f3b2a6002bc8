"""Wrong files of the slotted lever and the shaper: what their own keys and checks refuse, and in which words."""

from __future__ import annotations

from pathlib import Path

import pytest

from reportgen.catalogue import check

SHAPER = """\
kind: shaper
parameters:
  a: 270 mm
  b: 520 mm
  l3: 550 mm
  l4: 100 mm
  H: 420 mm
  n: 89 rpm
  cutting: {F: 1000 N, free: 0.05}
"""
LEVER = """\
kind: slotted-lever
parameters:
  AB: 40 mm
  AC: 80 mm
  CD: 150 mm
  omega1: 1 rad/s
"""

# (name, file, what is replaced, by what, the faults expected)
EDITS = [
    ("no stroke", SHAPER, "  H: 420 mm\n", "", ["2:1 missing-key"]),
    ("speed twice", SHAPER, "  n: 89 rpm", "  n: 89 rpm\n  omega1: 9 rad/s", ["9:3 both-given"]),
    ("weight and mass", SHAPER, "  n: 89 rpm", "  n: 89 rpm\n  G3: 1 N\n  m3: 1 kg", ["10:3 both-given"]),
    ("force without unit", SHAPER, "F: 1000 N", "F: 1000", ["9:16 missing-unit"]),
    ("nothing left to cut", SHAPER, "free: 0.05", "free: 0.5", ["9:30 out-of-range"]),
    ("free without force", SHAPER, "{F: 1000 N, free: 0.05}", "{free: 0.05}", ["9:3 missing-key"]),
    ("rocker that is a crank", SHAPER, "H: 420 mm", "H: 1100 mm", ["7:6 rocker-turns"]),
    ("rocker too short for its block", SHAPER, "l3: 550 mm", "l3: 400 mm", ["5:7 leaves-slot", "6:7 never-assembled"]),
    ("link too short", SHAPER, "l4: 100 mm", "l4: 25 mm", ["6:7 no-assembly"]),
    ("link far too short", SHAPER, "b: 520 mm", "b: 700 mm", ["6:7 never-assembled"]),
    ("link square to its guide", SHAPER, "l4: 100 mm", "l4: 30 mm", ["6:7 dead-point"]),
    ("block on the pivot", LEVER, "AB: 40 mm", "AB: 80 mm", ["3:7 block-on-pivot", "5:7 leaves-slot"]),
    ("lever too short for its block", LEVER, "CD: 150 mm", "CD: 120 mm", ["5:7 leaves-slot"]),
    ("no lever", LEVER, "  CD: 150 mm\n", "", ["2:1 missing-key"]),
    ("no speed", LEVER, "  omega1: 1 rad/s\n", "", ["2:1 missing-key"]),
]


def write(folder: Path, text: str) -> Path:
    file = folder / "a.yaml"
    file.write_text(text, encoding="utf-8")
    return file


@pytest.mark.parametrize(("base", "old", "new", "expected"), [e[1:] for e in EDITS], ids=[e[0] for e in EDITS])
def test_edit_of_a_right_file(tmp_path: Path, base: str, old: str, new: str, expected: list[str]) -> None:
    assert old in base
    found = check(write(tmp_path, base.replace(old, new, 1)), "en")
    assert [f"{p.mark.line}:{p.mark.column} {p.code}" for p in found] == expected


@pytest.mark.parametrize("text", [SHAPER, LEVER], ids=["shaper", "slotted-lever"])
def test_the_files_they_start_from_are_right(tmp_path: Path, text: str) -> None:
    assert check(write(tmp_path, text)) == []


@pytest.mark.parametrize("language", ["vi", "en"])
def test_link_group_and_angle_are_named(tmp_path: Path, language: str) -> None:
    """A rocker of 400 mm ends before the block at its farthest, 270 + 141.75 mm, the crank upright."""
    text = SHAPER.replace("l3: 550 mm", "l3: 400 mm").replace("b: 520 mm", "b: 385 mm")
    (problem,) = check(write(tmp_path, text), "vi" if language == "vi" else "en")
    for said in ("(2, 3)", "90°", "411.75 mm", "400 mm"):
        assert said in problem.message
    text = SHAPER.replace("l4: 100 mm", "l4: 25 mm")
    (problem,) = check(write(tmp_path, text), "vi" if language == "vi" else "en")
    assert "4, 5" in problem.message
    assert "DE" in problem.message
