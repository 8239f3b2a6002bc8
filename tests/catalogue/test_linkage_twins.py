"""Every machine of the catalogue is also a `linkage`: its twin, written by hand, gives its results."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from reportgen import api

SAME = 1e-12
"""Of each quantity's greatest size over the cycle: one solver, whose numbers differ by the rounding of the input."""

SLIDER_CRANK = """
positions: {count: 8, start: 0 deg}
parameters:
  frame: {A: [0 mm, 0 mm]}
  driver: {type: crank, centre: A, pin: B, length: 0.2 m, omega1: 10 rad/s}
  groups:
    - type: RRP
      links: [2, 3]
      joints: [B, C]
      length: 1 m
      guide: {at: [0 m, -0.565685424949238 m], angle: 0 deg}
  loads:
    - {by: stroke, link: 3, unit: N, s: [0, 1], inward: [50, 50], outward: [0, 0]}
"""

FOUR_BAR = f"""
positions: {{count: 8, start: 0 deg}}
parameters:
  frame: {{A: [0 mm, 0 mm], D: [400 mm, 0 mm]}}
  driver: {{type: crank, centre: A, pin: B, length: 120 mm, omega1: 20 rad/s}}
  groups:
    - {{type: RRR, links: [2, 3], joints: [B, C, D], lengths: [340 mm, 280 mm], side: left}}
  points:
    E: {{link: 2, at: [150 mm, 110 mm]}}
    F: {{link: 2, at: [220 mm, 0 mm]}}
    S2: {{link: 2, at: [170 mm, 0 mm]}}
    S3: {{link: 3, at: [140 mm, 0 mm]}}
  masses:
    - {{link: 2, at: S2, G: 30 N, J: {30 / 9.81 * 0.34**2 / 12!r} kg m2}}
    - {{link: 3, at: S3, G: 25 N, J: {25 / 9.81 * 0.28**2 / 12!r} kg m2}}
  loads:
    - {{by: constant, link: 3, M: 40 N m, against: motion}}
"""

LEVER = f"""
positions: {{count: 12}}
parameters:
  frame: {{B: [0 mm, 0 mm], D: [-10 mm, -106 mm]}}
  driver: {{type: crank, centre: B, pin: A, length: 34 mm, omega1: 89 rad/s}}
  groups:
    - {{type: RRR, links: [2, 3], joints: [A, C, D], lengths: [90 mm, 60 mm], side: left}}
    - type: RRP
      links: [4, 5]
      joints: [E, F]
      length: 110 mm
      guide: {{at: [0 mm, -73 mm]}}
      end: near
  points:
    S1: {{link: 1, at: [17 mm, 0 mm]}}
    E: {{link: 2, at: [60 mm, 0 mm]}}
    S2: {{link: 2, at: [45 mm, 0 mm]}}
    S3: {{link: 3, at: [30 mm, 0 mm]}}
    S4: {{link: 4, at: [55 mm, 0 mm]}}
  masses:
    - {{link: 2, at: S2, G: 9 N, J: {9 / 9.81 * 0.09**2 / 12!r} kg m2}}
    - {{link: 3, at: S3, G: 6 N, J: {6 / 9.81 * 0.06**2 / 12!r} kg m2}}
    - {{link: 4, at: S4, G: 11 N, J: {11 / 9.81 * 0.11**2 / 12!r} kg m2}}
    - {{link: 5, at: F, G: 20 N}}
  loads:
    - {{by: constant, link: 5, at: F, F: 400 N, against: motion}}
"""

TOGGLE_PRESS = f"""
positions: {{count: 12}}
parameters:
  frame: {{O: [0 mm, 0 mm], D: [-300 mm, 220 mm]}}
  driver: {{type: crank, centre: O, pin: A, length: 60 mm, n: 150 rpm}}
  groups:
    - {{type: RRR, links: [2, 3], joints: [A, B, D], lengths: [232 mm, 250 mm], side: left}}
    - type: RRP
      links: [4, 5]
      joints: [B, C]
      length: 250 mm
      guide: {{at: [-300 mm, 0 mm], angle: 90 deg}}
      end: near
  points:
    S2: {{link: 2, at: [116 mm, 0 mm]}}
    S3: {{link: 3, at: [100 mm, 0 mm]}}
    S4: {{link: 4, at: [125 mm, 0 mm]}}
  masses:
    - {{link: 2, at: S2, G: 45 N, J: {45 / 9.81 * 0.232**2 / 12!r} kg m2}}
    - {{link: 3, at: S3, G: 60 N, J: {60 / 9.81 * 0.25**2 / 12!r} kg m2}}
    - {{link: 4, at: S4, G: 60 N, J: {60 / 9.81 * 0.25**2 / 12!r} kg m2}}
    - {{link: 5, at: C, G: 400 N}}
  loads:
    - {{by: stroke, link: 5, unit: N, s: [0, 0.4, 1], inward: [0, 500, 4000], outward: [0, 0, 0]}}
"""

SCOTCH_YOKE = """
positions: {count: 12, direction: clockwise, start: 20 deg}
parameters:
  frame: {O: [0 mm, 0 mm]}
  driver: {type: crank, centre: O, pin: A, length: 50 mm, n: 240 rpm}
  groups:
    - {type: RPP, links: [2, 3], joints: [A, B], guide: {at: [0 mm, 0 mm], angle: 20 deg}, across: 90 deg}
  masses:
    - {link: 2, at: A, G: 8 N}
    - {link: 3, at: B, G: 60 N}
  loads:
    - {by: constant, link: 3, at: B, F: -900 N, direction: 20 deg}
"""

SLOTTED_LEVER = """
positions: {count: 12, start: 90 deg}
parameters:
  frame: {A: [0 mm, 0 mm], C: [0 mm, -80 mm]}
  driver: {type: crank, centre: A, pin: B, length: 40 mm, omega1: 1 rad/s}
  groups:
    - {type: RPR, links: [2, 3], joints: [B, B3, C]}
  points:
    D: {link: 3, at: [150 mm, 0 mm]}
    S3: {link: 3, at: [60 mm, 0 mm]}
  masses:
    - {link: 2, at: B, G: 2 N}
    - {link: 3, at: S3, G: 20 N, J: 0.004 kg m2}
  loads:
    - {by: constant, link: 3, M: 4 N m, against: motion}
"""

SHAPER = f"""
positions: {{count: 12, start: 0 deg}}
parameters:
  frame: {{A: [0 mm, 0 mm], C: [0 mm, -270 mm]}}
  driver: {{type: crank, centre: A, pin: B, length: {270 * 420 / 1100!r} mm, n: 89 rpm}}
  groups:
    - {{type: RPR, links: [2, 3], joints: [B, B3, C]}}
    - type: RRP
      links: [4, 5]
      joints: [D, E]
      length: 100 mm
      guide: {{at: [0 mm, 250 mm]}}
      end: near
  points:
    D: {{link: 3, at: [550 mm, 0 mm]}}
  loads:
    - {{by: stroke, link: 5, unit: N, s: [0, 1], inward: [1000, 1000], outward: [0, 0]}}
"""

V_ENGINE = """
positions: {count: 8}
parameters:
  frame: {A: [0 mm, 0 mm]}
  driver: {type: crank, centre: A, pin: B, length: 91 mm, n: 1800 rpm}
  groups:
    - {type: RRP, links: [2, 3], joints: [B, C], length: 253 mm, guide: {angle: 50 deg}}
    - {type: RRP, links: [4, 5], joints: [D, E], length: 196 mm, guide: {angle: 70 deg}}
  points:
    D: {link: 2, at: [66 mm, 0 mm]}
  loads:
    - {by: constant, link: 3, at: C, F: -5600 N, direction: 50 deg}
    - {by: constant, link: 5, at: E, F: -2200 N, direction: 70 deg}
  also_at: [50 deg, 230 deg]
"""

TWIN_DIAGRAM = """{unit: N/cm2, by: stroke, s: [0, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1],
        intake: [1.0, -2.5, -2.5, -2.5, -2.5, -2.5, -2.5, -2.5, -2.5, -2.5, -2.5, -2.5],
        compression: [28, 23.2, 19.5, 12.6, 8.1, 5.3, 3.4, 2.0, 0.9, 0, -1.0, -2.5],
        expansion: [28, 40, 36.5, 27.4, 20.8, 16.2, 13.0, 10.6, 8.8, 7.3, 5.6, 3.6],
        exhaust: [1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.6, 3.6]}"""
TWIN_ENGINE = f"""
positions: {{count: 8, start: 90 deg}}
parameters:
  frame: {{O1: [0 mm, 0 mm]}}
  driver: {{type: crank, centre: O1, pin: A, length: 47.5 mm, n: 2200 rpm}}
  groups:
    - {{type: RRP, links: [2, 3], joints: [A, B], length: 171 mm, guide: {{angle: 90 deg}}}}
    - {{type: RRP, links: [4, 5], joints: [C, D], length: 171 mm, guide: {{angle: 90 deg}}}}
  points:
    C: {{link: 1, at: [-47.5 mm, 0 mm]}}
    S2: {{link: 2, at: [{0.35 * 171!r} mm, 0 mm]}}
    S4: {{link: 4, at: [{0.35 * 171!r} mm, 0 mm]}}
  masses:
    - {{link: 2, at: S2, G: 20 N, J: {20 / 9.81 * 0.171**2 / 12!r} kg m2}}
    - {{link: 3, at: B, G: 22 N}}
    - {{link: 4, at: S4, G: 20 N, J: {20 / 9.81 * 0.171**2 / 12!r} kg m2}}
    - {{link: 5, at: D, G: 22 N}}
  turns: 2
  loads:
    - by: gas
      link: 3
      D: 98 mm
      diagram: {TWIN_DIAGRAM}
    - by: gas
      link: 5
      D: 98 mm
      intake: second top
      diagram: {TWIN_DIAGRAM}
"""

SINGLE_ENGINE = f"""
positions: {{count: 8, direction: clockwise, start: 90 deg}}
parameters:
  frame: {{A: [0 mm, 0 mm]}}
  driver: {{type: crank, centre: A, pin: B, length: 47.5 mm, n: 2200 rpm}}
  groups:
    - {{type: RRP, links: [2, 3], joints: [B, C], length: 171 mm, guide: {{angle: 90 deg}}}}
  points:
    S2: {{link: 2, at: [{0.35 * 171!r} mm, 0 mm]}}
  masses:
    - {{link: 2, at: S2, G: 20 N, J: {20 / 9.81 * 0.171**2 / 12!r} kg m2}}
    - {{link: 3, at: C, G: 22 N}}
  turns: 2
  also_at: [ALSO]
  loads:
    - by: gas
      link: 3
      D: 98 mm
      diagram: {TWIN_DIAGRAM}
"""

PAIRS = {
    "slider-crank": (
        "positions: {count: 8, start: 0 deg}\n"
        "parameters: {r: 0.2 m, l: 1 m, e: -0.565685424949238 m, omega1: 10 rad/s,\n"
        "  force: {by: constant, F: 50 N, stroke: inward}}",
        SLIDER_CRANK,
    ),
    "four-bar": (
        "positions: {count: 8, start: 0 deg}\n"
        "parameters: {AB: 120 mm, BC: 340 mm, CD: 280 mm, AD: 400 mm, omega1: 20 rad/s, BF: 220 mm,\n"
        "  E: {along: 150 mm, across: 110 mm}, G2: 30 N, G3: 25 N, torque: {M: 40 N m, sense: opposing}}",
        FOUR_BAR,
    ),
    "lever-six-bar": (
        "positions: {count: 12, start: 0 deg}\n"
        "parameters: {AB: 34 mm, AC: 90 mm, CD: 60 mm, CE: 30 mm, EF: 110 mm, D: {x: -10 mm, y: -106 mm},\n"
        "  guide: -73 mm, C: left, F: left, omega1: 89 rad/s, G2: 9 N, G3: 6 N, G4: 11 N, G5: 20 N,\n"
        "  force: {P: 400 N, sense: opposing}}",
        LEVER,
    ),
    "toggle-press": (
        "positions: {count: 12, start: 0 deg}\n"
        "parameters: {OA: 60 mm, AB: 232 mm, BD: 250 mm, D: {x: -300 mm, y: 220 mm}, n: 150 rpm, s3: 0.4, G2: 45 N,\n"
        "  G3: 60 N, G4: 60 N, G5: 400 N, press: {unit: N, s: [0, 0.4, 1], P: [0, 500, 4000]}}",
        TOGGLE_PRESS,
    ),
    "scotch-yoke": (
        "positions: {count: 12, direction: clockwise}\n"
        "parameters: {r: 50 mm, guide: 20 deg, n: 240 rpm, G2: 8 N, G3: 60 N, force: {by: constant, F: -900 N}}",
        SCOTCH_YOKE,
    ),
    "slotted-lever": (
        "positions: {count: 12, start: 90 deg}\n"
        "parameters: {AB: 40 mm, AC: 80 mm, CD: 150 mm, omega1: 1 rad/s, G2: 2 N, G3: 20 N, s3: 0.4, J3: 0.004 kg m2,\n"
        "  torque: {M: 4 N m}}",
        SLOTTED_LEVER,
    ),
    "shaper": (
        "positions: {count: 12, start: 0 deg}\n"
        "parameters: {a: 270 mm, b: 520 mm, l3: 550 mm, l4: 100 mm, H: 420 mm, n: 89 rpm, cutting: {F: 1000 N}}",
        SHAPER,
    ),
    "engine-v": (
        "positions: {count: 8}\n"
        "parameters: {AB: 91 mm, BC: 253 mm, BD: 66 mm, DE: 196 mm, alpha: 50 deg, beta: 70 deg, n: 1800 rpm,\n"
        "  PC: 5600 N, PE: 2200 N}",
        V_ENGINE,
    ),
    "engine-twin": (
        "positions: {count: 8}\n"
        "parameters: {H: 95 mm, lambda: 1/3.6, n: 2200 rpm, D: 98 mm, s: 0.35, G2: 20 N, G3: 22 N}\n"
        f"indicator: {TWIN_DIAGRAM}",
        TWIN_ENGINE,
    ),
    "engine-single": (
        "positions: {count: 8, direction: clockwise, start: 90 deg}\n"
        "parameters: {D: 98 mm, R: 47.5 mm, L: 171 mm, n: 2200 rpm, s: 0.35, G2: 20 N, G3: 22 N, g: 9.81 m/s2}\n"
        f"indicator: {TWIN_DIAGRAM}",
        SINGLE_ENGINE,
    ),
}
"""Each preset and its twin."""


def numbers(value: Any, where: tuple[str, ...] = ()) -> Iterator[tuple[tuple[str, ...], Any]]:
    """Every number of a position by its place; what only one of the two tells is left out."""
    if isinstance(value, dict):
        for key, inner in value.items():
            if key != "pressures":
                yield from numbers(inner, (*where, key))
    elif isinstance(value, list):
        for index, inner in enumerate(value):
            yield from numbers(inner, (*where, "xy"[index]))
    else:
        yield where, value


def solved(path: Path, kind: str, content: str) -> dict[str, Any]:
    path.write_text(f"kind: {kind}\n{content}", encoding="utf-8")
    return api.solve(api.load(path))


@pytest.mark.parametrize("kind", PAIRS)
def test_a_preset_equals_its_twin(kind: str, tmp_path: Path) -> None:
    content, own = PAIRS[kind]
    preset = solved(tmp_path / "preset.yaml", kind, content)
    # A preset chooses some positions by itself; its twin is told them.
    first = [one for one in preset["positions"] if one["cycle_angle"] < math.tau - 1e-9]
    lettered = [one["crank_angle"] for one in first if one.get("label", "0").isalpha()]
    also = ", ".join(f"{math.degrees(math.remainder(angle, math.tau))!r} deg" for angle in lettered)
    twin = solved(tmp_path / "twin.yaml", "linkage", own.replace("ALSO", also))
    assert twin["dyad_signs"] == preset["dyad_signs"]
    ours, theirs = ([dict(numbers(one)) for one in result["positions"]] for result in (twin, preset))
    assert [set(one) for one in ours] == [set(one) for one in theirs]
    off = {}
    for place in theirs[0]:
        pairs = [(mine[place], other[place]) for mine, other in zip(ours, theirs, strict=True)]
        if place[-1] in {"label", "number"} or any(None in pair for pair in pairs):
            assert all(mine == other for mine, other in pairs), place
            continue
        # Components are read against their vector: the sizes beside one another belong together.
        group = [key for key in theirs[0] if key[:-1] == place[:-1]] if place[-1] in "xy" else [place]
        size = max(abs(one[key]) for one in theirs for key in group if one[key] is not None)
        # An angle is read against a radian, so that one of nothing may be its rounding.
        size = max(size, 1.0) if place[-1] == "angle" else size or 1.0
        off[place] = max(abs(mine - other) for mine, other in pairs) / size
    assert {place: misfit for place, misfit in off.items() if misfit > SAME} == {}
