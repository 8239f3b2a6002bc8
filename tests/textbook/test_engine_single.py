"""The single-cylinder engine against the published figures of variant VII, and its lettered positions."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest

from reportgen import api
from reportgen.derivation import write_ledger
from reportgen.machine import Crank
from reportgen.machine.analysis import Analysis, lettered

ASSIGNMENTS = Path(__file__).parents[2] / "assignments"
VARIANTS = ("I", "II", "III", "IV", "V", "VI", "VII", "VIII")


@pytest.fixture(scope="module")
def seven() -> Analysis:
    return api.analyse(api.load(ASSIGNMENTS / "engine-single-VII.yaml"))


def lengths(analysis: Analysis) -> tuple[float, float]:
    """Crank and rod (m)."""
    linkage = analysis.machine.linkage
    assert isinstance(linkage.driver, Crank)
    return linkage.driver.length, linkage.dyads[0].lengths[0]


def test_crank_and_rod_of_variant_seven(seven: Analysis) -> None:
    # Printed r = 106.80 mm, l = 410.57 mm: half of the last digit.
    assert lengths(seven) == pytest.approx((0.10680, 0.41057), abs=0.5e-5)


def test_published_kinematics_at_position_1(seven: Analysis) -> None:
    """30° after the top; printed by a program, so each figure holds to half of its last digit."""
    k = seven.machine.labels.index("1")
    points, rod = seven.motion.points, seven.motion.links[2]
    length = lengths(seven)[1]
    assert abs(rod.omega[k]) * length == pytest.approx(5.50, abs=0.005)
    assert abs(points["S2"].v[k]) == pytest.approx(5.31, abs=0.005)
    assert abs(points["C"].v[k]) == pytest.approx(4.07, abs=0.005)
    assert abs(rod.omega[k]) == pytest.approx(13.40, abs=0.005)
    assert rod.omega[k] ** 2 * length == pytest.approx(73.7, abs=0.05)
    # Printed 239.0 beside ε = 582.2, whose product with l is 239.05: rounded down, so a whole digit.
    assert abs(rod.epsilon[k]) * length == pytest.approx(239.0, abs=0.1)
    assert abs(points["S2"].a[k]) == pytest.approx(400.1, abs=0.05)
    # Printed 409.6 for 409.65, rounded down likewise.
    assert abs(points["C"].a[k]) == pytest.approx(409.6, abs=0.1)
    assert abs(rod.epsilon[k]) == pytest.approx(582.2, abs=0.05)
    assert rod.omega[k] > 0 > rod.epsilon[k]  # the crank turns clockwise


@pytest.mark.parametrize("variant", VARIANTS)
def test_every_variant_has_the_stroke_and_the_travel_times_it_asks_for(variant: str) -> None:
    assignment = api.load(ASSIGNMENTS / f"engine-single-{variant}.yaml")
    machine = api.analyse(assignment).machine
    course, given = machine.sliders[0], assignment.parameters
    down = course.bottom_angle
    # R and L come from one closed formula, the dead centres from another.
    assert course.stroke == pytest.approx(given.H.si, rel=1e-12)
    assert down / (2 * math.pi - down) == pytest.approx(given.K.si, rel=1e-12)
    assert [course.top.real, course.bottom.real] == pytest.approx([given.e.si] * 2, rel=1e-12)


@pytest.mark.parametrize("variant", VARIANTS)
def test_lettered_positions_are_dead_centres_and_greatest_speeds(variant: str) -> None:
    analysis = api.analyse(api.load(ASSIGNMENTS / f"engine-single-{variant}.yaml"))
    labels, angles = analysis.machine.labels, analysis.machine.cycle_angles
    assert [label for label in labels if label.isdigit()] == [str(n) for n in range(24)]
    assert [label for label in labels if label.isalpha()] == list("abcdef")
    assert (np.diff(angles) > 0).all()
    assert np.degrees(angles[[labels.index("0"), labels.index("12")]]) == pytest.approx([0, 360])
    piston = analysis.motion.points["C"]
    speed, acceleration = abs(piston.v), abs(piston.a)
    for fast in "acdf":
        assert acceleration[labels.index(fast)] < 1e-9 * acceleration.max()
    for still in ("0", "b", "12", "e"):
        assert speed[labels.index(still)] < 1e-9 * speed.max()
    assert speed[: labels.index("b")].argmax() == labels.index("a")


def test_an_in_line_engine_has_its_bottom_among_the_numbers() -> None:
    places, labels = lettered(12, 1, (0.0, math.pi, 1.3, 2 * math.pi - 1.3, 2 * math.pi))
    assert labels == ("0", "1", "2", "a", "3", "4", "5", "6", "7", "8", "9", "b", "10", "11")
    assert len(places) == 14


def test_strokes_run_between_the_true_dead_centres(seven: Analysis) -> None:
    labels, (gas,) = seven.machine.labels, seven.gas.values()
    starts = [labels[k] for k in range(30) if k == 0 or gas.stroke[k] != gas.stroke[k - 1]]
    assert starts == ["0", "b", "12", "e"]


def test_pressure_is_the_height_times_the_scale(seven: Analysis) -> None:
    """The published diagram: 140 mm at 2 N/cm² each on a piston of 170 mm at the top of expansion."""
    k = seven.machine.labels.index("12")
    assert seven.gas["P3"].pressure[k] == pytest.approx(280e4, rel=1e-12)
    assert seven.applied[0].force[k] == pytest.approx(-1j * 280e4 * math.pi / 4 * 0.17**2, rel=1e-12)


def test_the_cycle_balances(seven: Analysis) -> None:
    # Mean torque by quadrature, work from the diagram; both settle to 1e-12.
    assert seven.summary.energy_error < 1e-10
    assert seven.torque == pytest.approx(seven.torque_by_work, abs=1e-9 * np.abs(seven.torque).max())


def test_given_lengths_stand_for_stroke_and_ratio(seven: Analysis, tmp_path: Path) -> None:
    text = (ASSIGNMENTS / "engine-single-VII.yaml").read_text(encoding="utf-8")
    R, L = lengths(seven)
    file = tmp_path / "a.yaml"
    file.write_text(
        text.replace("  H: 215 mm\n", f"  R: {R!r} m\n  L: {L!r} m\n").replace("  K: 1.04\n", ""), encoding="utf-8"
    )
    other = api.analyse(api.load(file))
    assert other.machine.sliders[0].stroke == pytest.approx(0.215, rel=1e-12)
    assert other.torque == pytest.approx(seven.torque, abs=1e-9 * np.abs(seven.torque).max())


def test_results_name_positions_by_number_and_label() -> None:
    results = api.solve(api.load(ASSIGNMENTS / "engine-single-VII.yaml"))
    json.dumps(results, allow_nan=False)
    names = [(position["number"], position["label"]) for position in results["positions"]]
    assert names[:5] == [(1, "0"), (2, "1"), (3, "2"), (4, "a"), (5, "3")]
    assert len(names) == 30
    assert set(results["positions"][0]["loads"]) == {"P3"}


def test_worked_positions_count_the_lettered_ones(tmp_path: Path) -> None:
    text = (ASSIGNMENTS / "engine-single-VII.yaml").read_text(encoding="utf-8")
    file = tmp_path / "a.yaml"
    file.write_text(text.replace("worked_positions: [2] ", "worked_positions: [30]"), encoding="utf-8")
    assert api.check(file) == []
    file.write_text(text.replace("worked_positions: [2] ", "worked_positions: [31]"), encoding="utf-8")
    assert [problem.code for problem in api.check(file)] == ["no-such-position"]


def test_the_scale_is_round_where_no_drawn_length_is_asked_for(seven: Analysis) -> None:
    ledger = write_ledger(seven).ledger
    scale = float(ledger["mu.l"].values[0])
    assert scale == pytest.approx(float(f"{scale:.1e}"), rel=1e-12)
    # Two figures of the scale put the crank within 5 % of the 40 mm aimed at.
    assert ledger["drawn.AB"].values[0] == pytest.approx(0.040, rel=0.05)
