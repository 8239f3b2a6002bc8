"""Dead points and gaps of every kind of group, where no sample of the driver's way meets them.

A right triangle 3 : 4 : 5 puts them at ±53.13°, which is no multiple of the samples' half degree.
"""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from reportgen.catalogue import check

HEAD = """\
kind: linkage
report: {{language: en}}
parameters:
  frame: {{A: [0 mm, 0 mm], D: [60 mm, 80 mm]}}
  driver: {{type: crank, centre: A, pin: B, length: {crank} mm, n: 60 rpm}}
  groups:
    - {group}
"""
SLIDE = """\
kind: linkage
report: {{language: en}}
parameters:
  frame: {{D: [100.1 mm, 50 mm]}}
  driver: {{type: slider, pin: B, start: 0 mm, end: 200 mm, speed: 1 m/s}}
  groups:
    - {{type: RRR, links: [2, 3], joints: [B, C, D], lengths: [100 mm, {rod} mm], side: left}}
"""
RPR = "{{type: RPR, links: [2, 3], joints: [B, C, D], offset: {offset} mm}}"
GUIDE = "{at: [-48 mm, 64 mm], angle: 36.86989764584402 deg}"

DEAD = [
    # The pin comes as near to D as the slot's offset: |AD| − |AB| = 100 − 40 = 60, the crank along AD.
    ("offset slot", HEAD.format(crank=40, group=RPR.format(offset=60)), "dead-point", "53.13"),
    ("offset slot on the right", HEAD.format(crank=40, group=RPR.format(offset=-60)), "dead-point", "53.13"),
    # |AB| = |AD|: the pin meets the pivot, and the lever has no direction.
    ("pin on the pivot", HEAD.format(crank=100, group=RPR.format(offset=0)), "dead-point", "53.13"),
    # |BC| + |CD| = 65 + 75 = |AD| + |AB|: stretched, with the crank pointing away from D.
    (
        "rods stretched",
        HEAD.format(
            crank=40, group="{type: RRR, links: [2, 3], joints: [B, C, D], lengths: [65 mm, 75 mm], side: left}"
        ),
        "dead-point",
        "-126.9",
    ),
    # The guide passes A at 80 mm; the pin is 80 + 50 = 130 mm off it with the crank square to it, away from it.
    (
        "rod square to the guide",
        HEAD.format(crank=50, group=f"{{type: RRP, links: [2, 3], joints: [B, C], length: 130 mm, guide: {GUIDE}}}"),
        "dead-point",
        "-53.13",
    ),
    # A guide along the crank and one at 33.3°: parallel when the crank stands there or opposite.
    (
        "parallel guides",
        HEAD.format(
            crank=40,
            group="{type: PRP, links: [2, 3], joints: [C], guides: [{at: [0 mm, 9 mm], on: 1}, {angle: 33.3 deg}]}",
        ),
        "dead-point",
        ("33.3", "-146.7"),
    ),
    # Both slides along one line.
    (
        "slides in line",
        HEAD.format(
            crank=40,
            group="{type: RPP, links: [2, 3], joints: [B, C], across: 0 deg, guide: {at: [0 mm, 90 mm], angle: 0 deg}}",
        ),
        "dead-point",
        "stands at",
    ),
    # D is 50 mm from the way, at 100.1 mm, and 150 − 100 = 50.
    ("rods folded along a way", SLIDE.format(rod=150), "dead-point-slide", "100.1 mm"),
]


@pytest.mark.parametrize(("name", "content", "code", "place"), DEAD, ids=[case[0] for case in DEAD])
def test_a_dead_point_between_the_samples_is_named(
    name: str, content: str, code: str, place: str | tuple[str, ...], tmp_path: Path
) -> None:
    path = tmp_path / "file.yaml"
    path.write_text(content, encoding="utf-8")
    (found,) = check(path)
    assert found.code == code
    assert found.mark.line == 7
    assert "(2, 3)" in found.message
    assert any(one in found.message for one in ([place] if isinstance(place, str) else place))


@pytest.mark.parametrize(
    ("content", "code", "ends"),
    [
        # 100² + 40² − 2·100·40 cos δ = 60.00005² at δ = 0.0702°
        (
            HEAD.format(crank=40, group=RPR.format(offset=60.00005)),
            "no-assembly",
            tuple(53.130102 + sign * math.degrees(math.acos((11600 - 60.00005**2) / 8000)) for sign in (-1, 1)),
        ),
        # 50² + x² = 50.0001² at x = ±0.1 mm
        (SLIDE.format(rod=150.0001), "no-assembly-slide", (100.0, 100.2)),
    ],
)
def test_a_gap_between_the_samples_is_named(content: str, code: str, ends: tuple[float, float], tmp_path: Path) -> None:
    path = tmp_path / "file.yaml"
    path.write_text(content, encoding="utf-8")
    (found,) = check(path)
    assert found.code == code
    for end in ends:
        assert f"{end:.4g}" in found.message


def test_what_only_comes_near_goes_round(tmp_path: Path) -> None:
    """An offset of 59.9 mm leaves the pin 0.1 mm, and its slide 3.5 mm, from the dead point."""
    path = tmp_path / "file.yaml"
    path.write_text(HEAD.format(crank=40, group=RPR.format(offset=59.9)), encoding="utf-8")
    assert check(path) == []
