"""Solved examples of two textbooks, with their printed answers.

Khurmi: R. S. Khurmi, J. K. Gupta, Theory of Machines, 14th edition, Eurasia 2009. Bevan: T. Bevan, The Theory of
Machines, 3rd edition, 2005. Data, answers and page numbers are those of the textbook companions at
https://tbc-python.fossee.in (folders Theory_Of_Machines and The_Theory_of_Machines_by_T._Bevan).
"""

from __future__ import annotations

import math
from typing import Any

import pytest

import reportgen
from reportgen.gears import train_ids
from reportgen.notebook import Model

DEGREES = 180 / math.pi


def opened(kind: str, parameters: str) -> Model:
    return reportgen.open(f"kind: {kind}\nreport: {{language: en}}\nparameters: {{{parameters}}}\n")


def position(kind: str, parameters: str) -> Any:
    return reportgen.solve(opened(kind, parameters).assignment)["positions"][0]


Printed = dict[str, tuple[float, float]]
"""Answers as printed, with half a unit (or one, if cut off) of the last digit."""

WHEELS: dict[str, tuple[str, Printed]] = {
    # Printed 5628; 300 kW at 90 rpm are 200 kJ a turn, of which a tenth fluctuates.
    "Khurmi 16.3, p. 574": (
        "areas: {values: [20, -20], unit: kJ}, n: 90 rpm, delta: 0.01, k: 2 m",
        {"mass": (5628, 1)},
    ),
    # Two triangles in a turn of a steam engine; the fluctuation is 18 % of the work.
    "Khurmi 16.7, p. 578": (
        "driving: {phi: [0 deg, 80 deg, 180 deg, 270 deg, 360 deg], M: [0, 2000, 0, 1500, 0], unit: N m},"
        "n: 100 rpm, delta: 0.015, k: 1.75 m",
        {"share": (0.18, 0.005), "mass": (197.3, 0.05), "mean": (875, 0.5)},
    ),
    # 20 kW at 300 rpm: 8 kJ a cycle; expansion gives 3/2 of it, compression takes 1/2; both are triangles.
    "Khurmi 16.9, p. 582": (
        "driving: {phi: [0 deg, 180 deg, 270 deg, 360 deg, 450 deg, 540 deg, 720 deg],"
        f"M: [0, 0, {-8000 / math.pi:.4f}, 0, {24000 / math.pi:.4f}, 0, 0], unit: N m}}, n: 300 rpm, delta: 0.04",
        {"inertia": (255.4, 0.05), "power": (20e3, 1)},
    ),
    # Constant resistance; printed 157.1 kW and 0.1 %.
    "Khurmi 16.13, p. 589": (
        "driving: {mean: 5000 N m, terms: [{order: 3, sin: 1500 N m}]}, n: 300 rpm, J: 1000 kg m2",
        {"power": (157.1e3, 50), "delta": (0.001, 0.0005)},
    ),
    # 2500 ft·lbf, 3.5 ft; printed 1.86 long tons.
    "Bevan 12.8, p. 443": (
        "areas: {values: [3389.54, -3389.54], unit: J}, n: 120 rpm, delta: 0.01, k: 1.0668 m",
        {"mass": (1.86 * 1016.05, 0.005 * 1016.05)},
    ),
}


@pytest.mark.parametrize("example", WHEELS)
def test_flywheel(example: str) -> None:
    parameters, printed = WHEELS[example]
    wheel = position("turning-moment", parameters)["wheel"]
    for name, (value, digit) in printed.items():
        assert wheel[name] == pytest.approx(value, abs=digit), name


def test_speeds_are_extreme_where_the_torque_meets_its_mean() -> None:
    """Khurmi 16.7, p. 578: least speed at 35°, greatest at 136°."""
    angles = position("turning-moment", WHEELS["Khurmi 16.7, p. 578"][0])["intersections"]
    assert [angles["2"] * DEGREES, angles["3"] * DEGREES] == pytest.approx([35, 136], abs=0.5)


TRAINS: dict[str, tuple[str, dict[str, int], Printed]] = {
    # Internal wheel A fixed; arm at 18 rpm: C at 58.5 rpm, B at 46.8 rpm the other way.
    "Khurmi 13.6, p. 443": (
        "scheme: single, u: 3.25, k: 2, z: {from: 20}, m: 3 mm, n_in: 58.5 rpm",
        {"1": 32, "2": 20, "3": 72},
        {"H": (18, 0.01), "2": (-46.8, 0.05)},
    ),
    # D fixed: the arm makes 0.308 of a revolution of A.
    "Khurmi 13.7, p. 444": (
        "scheme: single, u: 3.25, k: 2, z: {from: 25}, m: 3 mm, n_in: 100 rpm",
        {"1": 40, "2": 25, "3": 90},
        {"H": (30.8, 0.05)},
    ),
    # A pitch circle of 224 mm with a module of 4 mm, one turn of the arm for five of the sun.
    "Khurmi 13.9, p. 447": (
        "scheme: single, u: 5, k: 2, least_teeth: 14, m: 4 mm, n_in: 100 rpm",
        {"1": 14, "2": 21, "3": 56},
        {"H": (20, 1e-9)},
    ),
    # C of 50 teeth, D 20, E 35, G 105: the shaft B at 50 rpm.
    "Khurmi 13.10, p. 448": (
        "scheme: double, u: 2.2, k: 2, z: {from: 20}, m: 4 mm, n_in: 110 rpm",
        {},
        {"H": (50, 0.5)},
    ),
    # Rows 40/30 before and 50/80 behind, H of 40, K 20, L 30, C 90: shaft B at 100 rpm.
    "Khurmi 13.14, p. 453": (
        "scheme: double, u: 2.5, k: 2, z: {from: 20}, m: 4 mm, n_in: 300 rpm, before: [[40, 30]], behind: [[50, 80]]",
        {},
        {"5": (-400, 1e-9), "7": (100, 0.05)},
    ),
}


@pytest.mark.parametrize("example", TRAINS)
def test_planetary_train(example: str) -> None:
    parameters, teeth, speeds = TRAINS[example]
    model = opened("planetary-train", parameters)
    ledger = model.case.ledger
    for wheel, number in teeth.items():
        assert float(ledger[train_ids.teeth(wheel)].at(1)) == number, wheel
    for member, (speed, digit) in speeds.items():
        assert float(ledger[train_ids.omega(member)].at(1)) * 30 / math.pi == pytest.approx(speed, abs=digit), member


def test_torque_that_holds_the_internal_wheel() -> None:
    """Khurmi 13.20, p. 465: 16 and 64 teeth; 100 N·m on the sun need 400 N·m on the fixed wheel."""
    ledger = opened(
        "planetary-train", "scheme: single, u: 5, k: 2, least_teeth: 16, m: 4 mm, n_in: 100 rpm, torque: {M: 100 N m}"
    ).case.ledger
    assert [float(ledger[train_ids.teeth(wheel)].at(1)) for wheel in "13"] == [16, 64]
    assert float(ledger[train_ids.torque("3")].at(1)) == pytest.approx(400)


def test_sliding_of_a_pair() -> None:
    """Khurmi 12.4 and 12.5, p. 399 and 400: 29.43° of the pinion; 3973 and 3610 mm/s at 2000 rpm, 455.3 at 1.2 m/s."""
    ledger = opened("gear-pair", "m: 5 mm, z1: 20, z2: 40, shifts: {x1: 0, x2: 0}").case.ledger
    path, base, first, last = (float(ledger[f"gears.{id}"].at(1)) for id in ("g_a", "d_b.1", "rho_p.1", "rho_a.1"))
    assert path / (base / 2) * DEGREES == pytest.approx(29.43, abs=0.01)
    pitch = 0.05 * math.sin(math.radians(20))
    both = 2000 * math.pi / 30 * 1.5
    assert [both * (pitch - first) * 1e3, both * (last - pitch) * 1e3] == pytest.approx([3973, 3610], abs=1)
    assert 1.2 / 0.05 * 1.5 * (pitch - first) * 1e3 == pytest.approx(455.3, abs=0.05)


def test_contact_of_a_pinion_with_17_teeth() -> None:
    """Khurmi 12.6, p. 401: 34.6° of the pinion and 12° of the wheel."""
    ledger = opened("gear-pair", "m: 6 mm, z1: 17, z2: 49, shifts: {x1: 0, x2: 0}").case.ledger
    path, pinion, wheel = (float(ledger[f"gears.{id}"].at(1)) for id in ("g_a", "d_b.1", "d_b.2"))
    assert path / (pinion / 2) * DEGREES == pytest.approx(34.6, abs=0.05)
    assert path / (wheel / 2) * DEGREES == pytest.approx(12, abs=0.05)


def test_contact_of_teeth_with_a_short_addendum() -> None:
    """Khurmi 12.3, p. 398: 30 and 80 teeth, addendum 10 mm for a module of 12 mm: path 52.3 mm, arc 55.61 mm."""
    ledger = opened("gear-pair", "m: 12 mm, z1: 30, z2: 80, ha: 0.833333333, shifts: {x1: 0, x2: 0}").case.ledger
    path = float(ledger["gears.g_a"].at(1))
    assert path * 1e3 == pytest.approx(52.3, abs=0.05)
    assert path * 1e3 / math.cos(math.radians(20)) == pytest.approx(55.61, abs=0.05)
    assert float(ledger["gears.epsilon"].at(1)) == pytest.approx(1.5, abs=0.05)
