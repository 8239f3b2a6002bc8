"""The slider-crank against a textbook's figures, an example with exact answers, and the laws of its table."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from reportgen import api
from reportgen.derivation import write_ledger
from reportgen.machine.analysis import Analysis, analyse

ASSIGNMENTS = Path(__file__).parents[2] / "assignments"
EXACT = 1e-12
"""Rounding of a few dozen operations, relative."""


def analysed(text: str, folder: Path) -> Analysis:
    file = folder / "a.yaml"
    file.write_text("kind: slider-crank\nparameters:\n  r: 150 mm\n  l: 600 mm\n  n: 300 rpm\n" + text)
    return api.analyse(api.load(file))


@pytest.fixture(scope="module")
def textbook() -> Analysis:
    """Crank 150 mm, rod 600 mm, 300 rpm; position 2 is 45° from the dead centre with the slider outside."""
    return api.analyse(api.load(ASSIGNMENTS / "slider-crank-01.yaml"))


def test_printed_figures_at_45_degrees(textbook: Analysis) -> None:
    points = textbook.motion.points
    # Printed 4.713 with π = 3.142; v and a of S are drawn: read to 0.1 m/s of 4.1 and 1 m/s² of 117.
    assert abs(points["B"].v[1]) == pytest.approx(4.713, abs=1e-3)
    assert abs(points["S2"].v[1]) == pytest.approx(4.1, abs=0.11)
    assert abs(points["S2"].a[1]) == pytest.approx(117, abs=1)


@pytest.fixture(scope="module")
def offset() -> Analysis:
    """OA 0.2 m at 10 rad/s, AB 1 m, guide 0.4√2 m below O; position 2 has the crank at 45°."""
    return api.analyse(api.load(ASSIGNMENTS / "slider-crank-02.yaml"))


def test_exact_answers_of_the_offset_example(offset: Analysis) -> None:
    motion, root = offset.motion, math.sqrt(2)
    assert motion.points["B"].p[1] == pytest.approx(0.1 * root * (1 + 1j), rel=EXACT)
    assert motion.points["C"].p[1] == pytest.approx(0.6 * root - 0.4j * root, rel=EXACT)
    assert motion.links[2].omega[1] == pytest.approx(-2, rel=EXACT)
    assert motion.links[2].epsilon[1] == pytest.approx(16, rel=EXACT)
    assert motion.points["C"].a[1] == pytest.approx(-4 * root, rel=EXACT)


def test_the_printed_formulas_give_the_exact_answers(offset: Analysis) -> None:
    ledger = write_ledger(offset).ledger
    found = {id: float(ledger[id].at(2)) for id in ("phi.3", "beta.2", "f.omega.2", "f.eps.2", "f.a.C")}
    expected = {
        "phi.3": math.pi / 4,
        "beta.2": -math.pi / 4,
        "f.omega.2": -2,
        "f.eps.2": 16,
        "f.a.C": -4 * math.sqrt(2),
    }
    assert found == pytest.approx(expected, rel=EXACT)


@pytest.mark.parametrize("direction", ["anticlockwise", "clockwise"])
@pytest.mark.parametrize("offset", [0, 80, -80])
def test_dead_centres_are_where_the_links_lie_in_line(direction: str, offset: int, tmp_path: Path) -> None:
    text = f"  e: {offset} mm\n  guide: 20 deg\npositions: {{count: 36, direction: {direction}}}\n"
    machine = analysed(text, tmp_path).machine
    course = machine.sliders[0]
    there = analyse(machine, np.array([0.0, course.bottom_angle])).motion
    pin, slider = there.points["B"].p, there.points["C"]
    assert slider.p == pytest.approx([course.top, course.bottom], rel=EXACT)
    assert abs(slider.p) == pytest.approx([0.75, 0.45], rel=EXACT)
    assert np.abs(slider.v).max() < 1e-12
    assert slider.p / abs(slider.p) * [1, -1] == pytest.approx(pin / abs(pin), rel=EXACT)


@pytest.mark.parametrize("offset", [0, 80, -80])
def test_closed_formulas_are_the_motion(offset: int, tmp_path: Path) -> None:
    text = f"  e: {offset} mm\n  s: 0.3\n  guide: -35 deg\npositions: {{count: 24, direction: clockwise}}\n"
    analysis = analysed(text, tmp_path)
    ledger = write_ledger(analysis).ledger
    along = np.exp(1j * math.radians(-35))
    slider, rod = analysis.motion.points["C"], analysis.motion.links[2]
    for id, values in {
        "f.v.C": (slider.v / along).real,
        "f.a.C": (slider.a / along).real,
        "f.omega.2": rod.omega,  # anticlockwise, though the crank turns clockwise
        "f.eps.2": rod.epsilon,
        "f.v.S2": abs(analysis.motion.points["S2"].v),
        "f.a.S2": abs(analysis.motion.points["S2"].a),
    }.items():
        assert ledger[id].values == pytest.approx(values, rel=0, abs=EXACT * np.abs(values).max()), id


CONSTANT = "  force: {by: constant, F: 90 N, stroke: inward}\n"
BY_STROKE = "  force: {by: stroke, unit: kN, s: [0, 0.4, 1], inward: [1, 2, 2], outward: [0, 0, -3]}\n"
BY_ANGLE = "  force: {by: crank_angle, unit: N, angle: [0 deg, 90 deg, 360 deg], F: [0, 80, 20]}\n"


def test_a_force_on_one_stroke_only(tmp_path: Path) -> None:
    """A position at a dead centre belongs to the stroke that begins there."""
    analysis = analysed(CONSTANT, tmp_path)
    assert analysis.applied[0].force == pytest.approx([90, 90, 90, 90, 0, 0, 0, 0])


def test_a_force_over_the_stroke(tmp_path: Path) -> None:
    analysis = analysed(BY_STROKE, tmp_path)
    way = (0.75 - analysis.motion.points["C"].p.real) / 0.3
    expected = np.where(np.arange(8) < 4, np.interp(way, [0, 0.4, 1], [1e3, 2e3, 2e3]), 0)
    expected[4:] = np.interp(way[4:], [0, 0.4, 1], [0, 0, -3e3])
    assert analysis.applied[0].force == pytest.approx(expected, rel=1e-9, abs=1e-9)


def test_a_force_over_the_crank_angle_may_jump_where_the_turn_closes(tmp_path: Path) -> None:
    analysis = analysed(BY_ANGLE, tmp_path)
    expected = np.interp(np.arange(8) * 45, [0, 90, 360], [0, 80, 20])
    assert analysis.applied[0].force == pytest.approx(expected, rel=1e-9, abs=1e-9)


@pytest.mark.parametrize(
    ("force", "work"),
    [
        (CONSTANT, -90 * 0.3),  # against 90 N over the stroke of 2 r, and nothing on the way back
        (BY_STROKE, -(1.5e3 * 0.4 + 2e3 * 0.6) * 0.3 + (-1.5e3 * 0.6) * 0.3),
    ],
)
def test_the_mean_torque_pays_for_the_work_of_the_force(force: str, work: float, tmp_path: Path) -> None:
    summary = analysed("  G2: 40 N\n  m3: 6 kg\n" + force, tmp_path).summary
    # Weights and inertia give back over a turn what they take; quadrature settles to 1e-12.
    assert summary.work == pytest.approx(work, rel=1e-10)
    assert summary.mean_torque == pytest.approx(-work / (2 * math.pi), rel=1e-10)
    assert summary.energy_error < 1e-10


def test_without_mass_and_force_there_is_kinematics_only(tmp_path: Path) -> None:
    analysis = analysed("", tmp_path)
    assert analysis.loads == ()
    assert not {"working", "loads", "groups", "crank"} & set(analysis.machine.outline)
