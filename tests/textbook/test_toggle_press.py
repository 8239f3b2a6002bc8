"""The toggle press against a solution of its triangles in complex numbers, differentiated numerically."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from reportgen import api
from reportgen.derivation import write_ledger
from reportgen.machine.analysis import Analysis

ASSIGNMENT = Path(__file__).parents[2] / "assignments" / "toggle-press-01.yaml"
EXACT = 1e-12
"""Rounding of a few dozen operations, relative."""
DIFFERENCED = 1e-6
"""Central differences with a step of 1e-4 rad: its square, and rounding over its square."""
STEP = 1e-4
OA, AB, BD, SPEED = 0.06, 0.232, 0.25, 5 * math.pi
LENGTHS = "OA: 60 mm, AB: 232 mm, BD: 250 mm, n: 150 rpm"
LEFT, RIGHT = "D: {x: -300 mm, y: 220 mm}, B: left", "D: {x: 300 mm, y: 220 mm}, B: right"
PRESS = "press: {unit: N, s: [0, 0.4, 0.8, 1], P: [0, 500, 1500, 4000]}"
MASSES = "G2: 45 N, G3: 60 N, G4: 60 N, G5: 400 N"


def write(folder: Path, parameters: str, positions: str = "count: 12") -> Path:
    file = folder / "a.yaml"
    file.write_text(f"kind: toggle-press\npositions: {{{positions}}}\nparameters: {{{parameters}}}\n")
    return file


def analysed(folder: Path, parameters: str, positions: str = "count: 12") -> Analysis:
    return api.analyse(api.load(write(folder, parameters, positions)))


def places(angle: np.ndarray, pivot: complex) -> tuple[np.ndarray, np.ndarray]:
    """B and C for crank angles: two circles meet at B, on the outside as seen from D; C is D mirrored in B's height."""
    pin = OA * np.exp(1j * angle)
    way = pin - pivot
    along = (np.abs(way) ** 2 + BD**2 - AB**2) / (2 * np.abs(way))
    across = np.sqrt(BD**2 - along**2)
    # Towards the vertical through D: to the right of the way from D to A where D stands on the left.
    side = -1j if pivot.real < 0 else 1j
    knee = pivot + way / np.abs(way) * (along + side * across)
    return knee, pivot.real + 1j * (2 * knee.imag - pivot.imag)


@pytest.mark.parametrize("direction", ["anticlockwise", "clockwise"])
@pytest.mark.parametrize(("where", "pivot"), [(LEFT, -0.3 + 0.22j), (RIGHT, 0.3 + 0.22j)])
def test_places_and_rates(where: str, pivot: complex, direction: str, tmp_path: Path) -> None:
    analysis = analysed(tmp_path, f"{LENGTHS}, {where}", f"count: 24, start: 20 deg, direction: {direction}")
    turn = 1 if direction == "anticlockwise" else -1
    angle = math.radians(20) + turn * 2 * math.pi * np.arange(24) / 24
    before, now, after = (places(angle + step, pivot) for step in (-STEP, 0.0, STEP))
    rate = turn * SPEED / STEP
    for index, name in enumerate("BC"):
        point = analysis.motion.points[name]
        assert point.p == pytest.approx(now[index], abs=EXACT)
        first = (after[index] - before[index]) * rate / 2
        second = (after[index] - 2 * now[index] + before[index]) * rate**2
        assert np.abs(point.v - first).max() < DIFFERENCED * np.abs(first).max()
        assert np.abs(point.a - second).max() < DIFFERENCED * np.abs(second).max()


@pytest.mark.parametrize("direction", ["anticlockwise", "clockwise"])
@pytest.mark.parametrize("where", [LEFT, RIGHT])
def test_the_printed_formulas_give_the_motion_with_its_signs(where: str, direction: str, tmp_path: Path) -> None:
    analysis = analysed(tmp_path, f"{LENGTHS}, {where}", f"count: 24, start: 20 deg, direction: {direction}")
    ledger, motion = write_ledger(analysis).ledger, analysis.motion
    # Coordinates and rates are positive upwards, turning is positive anticlockwise, whichever way the crank turns.
    for id, values in {
        "f.y.C": motion.points["C"].p.imag,
        "f.v.C": motion.points["C"].v.imag,
        "f.a.C": motion.points["C"].a.imag,
        "f.omega.2": motion.links[2].omega,
        "f.omega.3": motion.links[3].omega,
        "f.eps.3": motion.links[3].epsilon,
    }.items():
        assert ledger[id].values == pytest.approx(values, rel=0, abs=1e-11 * np.abs(values).max()), id
    # As the docstring of the machine says, link 4 mirrors link 3.
    assert motion.links[4].omega == pytest.approx(-motion.links[3].omega, abs=1e-11 * SPEED)


@pytest.mark.parametrize("direction", ["anticlockwise", "clockwise"])
def test_both_torques_agree_and_pay_for_the_pressing(direction: str, tmp_path: Path) -> None:
    analysis = analysed(tmp_path, f"{LENGTHS}, {LEFT}, {MASSES}, {PRESS}", f"count: 12, direction: {direction}")
    assert analysis.torque == pytest.approx(analysis.torque_by_work, abs=1e-9 * np.abs(analysis.torque).max())
    # The knee stands at the dead centres where crank and rod are in line: |OB| = AB ± OA on the circle about D.
    ends = []
    for reach in (AB - OA, AB + OA):
        span = abs(-0.3 + 0.22j)
        along = (span**2 + BD**2 - reach**2) / (2 * span)
        towards = (0.3 - 0.22j) / span
        knee = -0.3 + 0.22j + towards * (along - 1j * math.sqrt(BD**2 - along**2))
        ends.append(2 * knee.imag - 0.22)
    stroke = ends[0] - ends[1]
    assert analysis.machine.sliders[0].stroke == pytest.approx(stroke, rel=1e-9)
    work = stroke * (0.4 * 250 + 0.4 * 1000 + 0.2 * 2750)
    turn = 1 if direction == "anticlockwise" else -1
    assert analysis.summary.work == pytest.approx(-work, rel=1e-9)
    assert analysis.summary.mean_torque * turn == pytest.approx(work / (2 * math.pi), rel=1e-9)


def test_the_force_is_on_the_way_down_only(tmp_path: Path) -> None:
    analysis = analysed(tmp_path, f"{LENGTHS}, {LEFT}, {PRESS}", "count: 36")
    force, speed = analysis.applied[0].force, analysis.motion.points["C"].v.imag
    assert (force[speed > 1e-9] == 0).all()
    assert (force[speed < -1e-9] > 0).any()


def test_the_toggle_of_the_assignment_is_almost_stretched_at_the_bottom() -> None:
    """The ram comes within a hundredth of the stretched length."""
    lowest = api.analyse(api.load(ASSIGNMENT).with_positions(360)).motion.points["C"].p.imag.min()
    assert 0.22 - 2 * BD < lowest < 0.22 - 2 * BD * 0.99


def test_without_mass_and_force_there_is_kinematics_only(tmp_path: Path) -> None:
    analysis = analysed(tmp_path, f"{LENGTHS}, {LEFT}")
    assert analysis.loads == ()
    assert not {"working", "loads", "groups", "crank"} & set(analysis.machine.outline)
