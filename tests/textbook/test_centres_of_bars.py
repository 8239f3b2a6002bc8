"""A four-bar with mass centres beside its bars: R. L. Norton, Design of Machinery, example 11-3.

Crank 5 in, coupler 15 in, rocker 10 in, ground 19 in; the crank at 60° with 25 rad/s and −40 rad/s².  The crank's
centre is 3 in from its pivot at 30° to its line, the coupler's 9 in at 45°.  An external force of 80 lb at 330° acts on
the coupler 3 in from its centre at 100°, a torque of 120 lb·in on the rocker.  The weights give masses with g =
386 in/s² and do no work themselves.
"""

from __future__ import annotations

import cmath
import math
from pathlib import Path

import pytest

from reportgen.cases import open_case

INCH, POUND = 0.0254, 4.4482216152605
BLOB = POUND / INCH
"""The mass (kg) of one lb·s²/in."""


def at(size: float, degrees: float) -> complex:
    return cmath.rect(size, math.radians(degrees))


def test_norton_11_3(tmp_path: Path) -> None:
    crank, coupler = at(3, 30), at(9, 45)
    loaded = coupler + at(3, 100)
    masses = ", ".join(f"m{link}: {weight / 386 * BLOB} kg" for link, weight in ((1, 1.5), (2, 7.7), (3, 5.8)))
    moments = ", ".join(f"J{link}: {J * POUND * INCH} kg m2" for link, J in ((1, 0.4), (2, 1.5), (3, 0.8)))
    path = tmp_path / "norton.yaml"
    path.write_text(f"""
kind: four-bar
report: {{language: en}}
positions: {{at: [60 deg]}}
parameters: {{AB: 5 in, BC: 15 in, CD: 10 in, AD: 19 in, omega1: 25 rad/s, epsilon1: -40 rad/s2, plane: horizontal,
  {masses}, {moments},
  S1: [{crank.real:.9f} in, {crank.imag:.9f} in], S2: [{coupler.real:.9f} in, {coupler.imag:.9f} in],
  E: {{along: {loaded.real:.9f} in, across: {loaded.imag:.9f} in}},
  loads: [{{by: constant, link: 3, M: {120 * POUND * INCH} N m}},
    {{by: constant, link: 2, at: E, F: {80 * POUND} N, direction: 330 deg}}]}}
""")
    ledger = open_case(path, "en").ledger
    read = ("turn.omega", "turn.eps", "a.S", "dir", "M.eq")
    value = {id: float(family.values[0]) for id, family in ledger.families.items() if id.startswith(read)}
    rotations = [value[id] for id in ("turn.omega.2", "turn.omega.3", "turn.eps.2", "turn.eps.3")]
    assert rotations == pytest.approx([-5.87, 7.93, 120.9, 276.29], abs=0.05)
    sizes = [value[f"a.S{link}"] / INCH for link in (1, 2, 3)]
    assert sizes == pytest.approx([1878.84, 3646.1, 1416.8], abs=0.05)
    directions = [math.degrees(value[f"dir.a.S{link}"]) for link in (2, 3)]
    assert directions == pytest.approx([226.51, 207.24], abs=0.005)
    assert value["M.eq"] / (POUND * INCH) == pytest.approx(243.2, abs=0.05)
