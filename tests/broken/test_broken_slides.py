"""Wrong files of a linkage whose driver slides: what it has not of a crank, its loads over the way, its slots."""

from __future__ import annotations

from pathlib import Path

import pytest

from reportgen.catalogue import check

BASE = """\
kind: linkage
positions: {count: 5}
drawing: {}
parameters:
  frame: {D: [400 mm, 0 mm]}
  driver: {type: slider, pin: B, guide: {angle: 0 deg}, start: 0 mm, end: 120 mm, speed: 0.3 m/s}
  groups:
    - {type: RRR, links: [2, 3], joints: [B, C, D], lengths: [260 mm, 240 mm], side: left}
    - type: RRP
      links: [4, 5]
      joints: [E, F]
      length: 300 mm
      guide: {at: [520 mm, 0 mm], angle: 90 deg}
  points:
    E: {link: 3, at: [60 mm, -200 mm]}
  loads:
    - {by: way, link: 5, at: F, direction: 90 deg, unit: N, way: [0 mm, 60 mm, 120 mm], values: [0, 5, 9]}
"""
CRANK = "{type: crank, centre: A, pin: B, length: 20 mm, n: 60 rpm}"
SLIDER = BASE.splitlines()[5].removeprefix("  driver: ")

# (name, what is replaced, by what, the faults expected)
EDITS = [
    ("angle of the start", "count: 5", "count: 5, start: 30 deg", ["2:23 no-crank"]),
    ("direction", "count: 5", "count: 5, direction: clockwise", ["2:23 no-crank"]),
    ("drawn crank", "drawing: {}", "drawing: {crank: 40 mm}", ["3:11 no-crank"]),
    ("turns", "  frame:", "  turns: 2\n  frame:", ["5:3 no-crank"]),
    ("angles added", "  frame:", "  also_at: [35 deg]\n  frame:", ["5:3 no-crank"]),
    (
        "load over an angle",
        "{by: way, link: 5, at: F, direction: 90 deg, unit: N, way: [0 mm, 60 mm, 120 mm], values: [0, 5, 9]}",
        "{by: angle, link: 5, at: F, unit: N, angle: [0 deg, 360 deg], values: [0, 5]}",
        ["17:12 needs-a-crank"],
    ),
    ("key unknown to a load by way", "unit: N", "unit: N, units: N", ["17:61 unknown-key"]),
    ("way of a crank", SLIDER, CRANK, ["6:33 no-such-point", "17:12 needs-a-slide"]),
    ("end of the table", "60 mm, 120 mm]", "60 mm, 100 mm]", ["17:80 table-end"]),
    ("order of the table", "60 mm, 120 mm]", "60 mm, 50 mm]", ["17:80 not-increasing"]),
    ("a value too few", "[0, 5, 9]", "[0, 5]", ["17:97 row-length"]),
    ("load without unit", "unit: N, ", "", ["17:7 missing-key"]),
    ("torque at a point", "unit: N,", "unit: N, torque_unit: N m,", ["17:61 force-or-torque"]),
    ("end of the driver's slot", "{angle: 0 deg}", "{slot: [0 mm, 100 mm]}", ["6:83 driver-out-of-slot"]),
    ("start of the driver's slot", "{angle: 0 deg}", "{slot: [1 mm, 120 mm]}", ["6:72 driver-out-of-slot"]),
    ("block leaves its slot", "angle: 90 deg}", "angle: 90 deg, slot: [300 mm, 400 mm]}", ["13:56 out-of-slot-slide"]),
]


@pytest.mark.parametrize(("name", "old", "new", "expected"), EDITS, ids=[edit[0] for edit in EDITS])
@pytest.mark.parametrize("language", ["vi", "en"])
def test_fault(name: str, old: str, new: str, expected: list[str], language: str, tmp_path: Path) -> None:
    assert BASE.count(old) == 1
    path = tmp_path / "file.yaml"
    path.write_text(BASE.replace(old, new), encoding="utf-8")
    found = check(path, "vi" if language == "vi" else "en")
    assert [f"{p.mark.line}:{p.mark.column} {p.code}" for p in found] == expected


def test_the_base_is_in_order(tmp_path: Path) -> None:
    path = tmp_path / "file.yaml"
    path.write_text(BASE, encoding="utf-8")
    assert check(path) == []


def test_a_slot_left_is_told_by_the_way_of_the_driver(tmp_path: Path) -> None:
    """The lever turns with the clock, so F sinks: lowest at the end of the driver's way, 120 mm."""
    path = tmp_path / "file.yaml"
    path.write_text(BASE.replace("angle: 90 deg}", "angle: 90 deg, slot: [460 mm, 500 mm]}"), encoding="utf-8")
    (problem,) = check(path, "en")
    assert "with link 1 at 120 mm" in problem.message
