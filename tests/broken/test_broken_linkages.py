"""Wrong files of the linkage of the user's own and of the V engine: every fault where it stands."""

from __future__ import annotations

from pathlib import Path

import pytest

from reportgen.catalogue import check

BASE = """\
kind: linkage
parameters:
  frame: {A: [0 mm, 0 mm], D: [400 mm, 0 mm]}
  driver: {type: crank, centre: A, pin: B, length: 120 mm, n: 60 rpm}
  groups:
    - {type: RRR, links: [2, 3], joints: [B, C, D], lengths: [340 mm, 280 mm], side: left}
    - type: RRP
      links: [4, 5]
      joints: [E, F]
      length: 400 mm
      guide: {at: [0 mm, 500 mm], angle: 0 deg}
  points:
    E: {link: 3, at: [300 mm, 0 mm]}
    S2: {link: 2, at: [170 mm, 0 mm]}
  masses:
    - {link: 2, at: S2, G: 30 N}
  loads:
    - {by: constant, link: 3, M: 5 N m}
    - {by: stroke, link: 5, unit: N, s: [0, 1], inward: [1, 1], outward: [0, 0]}
  declared: {W: 1, class: 2, groups: [[2, 3], [4, 5]]}
"""

V = """\
kind: engine-v
parameters: {AB: 91 mm, BC: 253 mm, BD: 66 mm, DE: 196 mm, alpha: 50 deg, beta: 70 deg, n: 1800 rpm, PC: 1 kN}
"""

# (name, the file, what is replaced in it, by what, the faults expected)
EDITS = [
    ("name of a point", BASE, "E: {link: 3", "e1: {link: 3", ["13:5 point-name"]),
    ("unknown point", BASE, "joints: [B, C, D]", "joints: [B, C, X]", ["6:49 no-such-point"]),
    ("point of a later group", BASE, "joints: [B, C, D]", "joints: [F, C, D]", ["6:43 not-placed"]),
    ("point named twice", BASE, "joints: [E, F]", "joints: [E, C]", ["9:19 point-taken"]),
    ("link numbered twice", BASE, "links: [4, 5]", "links: [4, 3]", ["8:18 link-taken", "19:26 no-slider"]),
    ("crank's centre", BASE, "centre: A", "centre: B", ["4:33 no-such-point"]),
    (
        "guide on a later link",
        BASE,
        "angle: 0 deg}",
        "angle: 0 deg, on: 5}",
        ["11:53 link-not-placed", "19:26 no-slider"],
    ),
    ("point on no link", BASE, "{link: 3, at: [300", "{link: 8, at: [300", ["9:16 not-placed", "13:15 no-such-link"]),
    ("mass on another link", BASE, "at: S2, G", "at: F, G", ["16:21 not-on-link"]),
    ("mass by nothing", BASE, "at: S2, G: 30 N", "at: S2", ["16:7 missing-key"]),
    ("flywheel without loads", V, "PC: 1 kN", "flywheel: {delta: 1/50}", ["2:102 flywheel-without-loads"]),
    ("load on no slider", BASE, "stroke, link: 5", "stroke, link: 3", ["19:26 no-slider"]),
    ("force and torque", BASE, "M: 5 N m", "M: 5 N m, F: 3 N", ["18:41 force-or-torque"]),
    ("load without size", BASE, "link: 3, M: 5 N m", "link: 3", ["18:7 missing-key"]),
    ("other degree of freedom", BASE, "W: 1", "W: 2", ["20:17 not-as-declared"]),
    ("other class", BASE, "class: 2", "class: 3", ["20:27 not-as-declared"]),
    ("other groups", BASE, "[4, 5]]", "[4, 6]]", ["20:38 not-as-declared"]),
    ("speed twice", BASE, "n: 60 rpm", "n: 60 rpm, omega1: 6 rad/s", ["4:71 both-given"]),
    ("no speed", BASE, ", n: 60 rpm", "", ["4:3 missing-key"]),
    ("unknown key of a group", BASE, "side: left", "side: left, hand: left", ["6:92 unknown-key"]),
    ("kind of group", BASE, "type: RRP", "type: RRX", ["7:13 choice"]),
    (
        "gas in one turn",
        BASE,
        "{by: stroke, link: 5, unit: N, s: [0, 1], inward: [1, 1], outward: [0, 0]}",
        "{by: gas, link: 5, D: 9 cm, diagram: {unit: bar, by: crank_angle, angle: [0 deg, 720 deg], p: [1, 1]}}",
        ["19:12 gas-needs-two-turns"],
    ),
    ("does not assemble over a turn", BASE, "280 mm]", "150 mm]", ["6:7 no-assembly"]),
    ("never assembles", BASE, "[340 mm, 280 mm]", "[34 mm, 28 mm]", ["6:7 never-assembled"]),
    ("toggle position", BASE, "[340 mm, 280 mm]", "[300 mm, 220 mm]", ["6:7 dead-point"]),
    ("block leaves its slot", BASE, "angle: 0 deg}", "angle: 0 deg, slot: [0 mm, 650 mm]}", ["11:55 out-of-slot"]),
    ("articulation beyond the rod", V, "BD: 66 mm", "BD: 260 mm", ["2:41 out-of-range"]),
    ("rod too short", V, "BC: 253 mm", "BC: 80 mm", ["2:29 no-assembly"]),
    ("bore without diagram", V, "PC: 1 kN", "D: 80 mm", ["1:1 missing-key"]),
    ("force and bore", V, "PC: 1 kN", "PC: 1 kN, D: 80 mm", ["1:1 missing-key", "2:102 both-given"]),
]


@pytest.mark.parametrize(("name", "base", "old", "new", "expected"), EDITS, ids=[edit[0] for edit in EDITS])
@pytest.mark.parametrize("language", ["vi", "en"])
def test_fault(name: str, base: str, old: str, new: str, expected: list[str], language: str, tmp_path: Path) -> None:
    assert base.count(old) == 1
    path = tmp_path / "file.yaml"
    path.write_text(base.replace(old, new), encoding="utf-8")
    found = check(path, "vi" if language == "vi" else "en")
    assert [f"{p.mark.line}:{p.mark.column} {p.code}" for p in found] == expected


@pytest.mark.parametrize("base", [BASE, V])
def test_the_bases_are_in_order(base: str, tmp_path: Path) -> None:
    path = tmp_path / "file.yaml"
    path.write_text(base, encoding="utf-8")
    assert check(path) == []


def told(tmp_path: Path, content: str) -> str:
    path = tmp_path / "file.yaml"
    path.write_text(content, encoding="utf-8")
    return "\n".join(str(problem) for problem in check(path, "en"))


def test_what_does_not_assemble_is_named_with_links_and_angles(tmp_path: Path) -> None:
    """By the triangle BCD: BD ≤ 340 + 150 fails where 120² + 400² − 2·120·400 cos φ > 490², beyond ±133.2°."""
    message = told(tmp_path, BASE.replace("280 mm]", "150 mm]"))
    assert "group (2, 3)" in message
    assert "BC, CD" in message
    assert "133.2" in message


def test_a_slide_has_no_flywheel(tmp_path: Path) -> None:
    text = (Path(__file__).parents[2] / "assignments" / "linkage-slide.yaml").read_text(encoding="utf-8")
    path = tmp_path / "slide.yaml"
    path.write_text(text.replace("parameters:\n", "parameters:\n  flywheel: {delta: 1/50}\n"), encoding="utf-8")
    line = 1 + path.read_text(encoding="utf-8").splitlines().index("  flywheel: {delta: 1/50}")
    assert [(p.mark.line, p.mark.column, p.code) for p in check(path)] == [(line, 3, "flywheel-of-slide")]
