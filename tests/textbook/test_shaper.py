"""The shaper against the published closed expressions, its synthesis, and the work of the cutting force."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from reportgen import api
from reportgen.assignment import Assignment
from reportgen.derivation import write_ledger
from reportgen.machine.analysis import Analysis, analyse

ASSIGNMENTS = Path(__file__).parents[2] / "assignments"
FINE = 720
EXACT = 1e-12
"""Rounding of a few dozen operations, relative."""
DIFFERENTIATION = 1e-9
"""Of the greatest value: rounding 1e-16 times the highest harmonic of 720 positions squared, with room."""


def assignment(variant: int) -> Assignment:
    return api.load(ASSIGNMENTS / f"shaper-{variant:02}.yaml")


def fine(variant: int) -> Analysis:
    """The machine of an assignment at 720 positions from φ1 = 0."""
    return analyse(api.analyse(assignment(variant)).machine, np.arange(FINE) * 2 * math.pi / FINE)


def published(phi: np.ndarray, l1: float) -> np.ndarray:
    """x_E (m) by the source's expressions, its tangent's two branches joined by arctan2."""
    a, b, l3, l4 = 0.27, 0.52, 0.55, 0.1
    phi3 = np.arctan2(a + l1 * np.sin(phi), l1 * np.cos(phi))
    phi4 = math.pi - np.arcsin((b - l3 * np.sin(phi3)) / l4)
    return l3 * np.cos(phi3) + l4 * np.cos(phi4)


def rate(values: np.ndarray, omega: float) -> np.ndarray:
    """d/dt of values over one turn, by their Fourier series."""
    harmonics = np.fft.fftfreq(FINE, 1 / FINE)
    return np.real(np.fft.ifft(1j * harmonics * np.fft.fft(values))) * omega


def test_length_of_the_crank() -> None:
    first, second = (write_ledger(api.analyse(assignment(variant))).ledger for variant in (1, 2))
    # Printed 103.09 mm, half its last digit; the second variant's 810/11 mm and 23π/30 rad/s are exact.
    assert float(first["l.AB"].at(1)) == pytest.approx(0.10309, abs=5e-6)
    assert float(second["l.AB"].at(1)) == pytest.approx(0.81 / 11, rel=EXACT)
    assert float(second["omega.1"].at(1)) == pytest.approx(23 * math.pi / 30, rel=EXACT)


@pytest.mark.parametrize(("variant", "l1", "n"), [(1, 0.27 * 0.42 / 1.1, 89), (2, 0.81 / 11, 23)])
def test_course_of_the_ram(variant: int, l1: float, n: int) -> None:
    analysis = fine(variant)
    ram, omega = analysis.motion.points["E"], 2 * math.pi * n / 60
    x = published(analysis.motion.driver, l1)
    v = rate(x, omega)
    assert np.real(ram.p) == pytest.approx(x, abs=EXACT)
    assert np.real(ram.v) == pytest.approx(v, abs=DIFFERENTIATION * np.abs(v).max())
    assert np.real(ram.a) == pytest.approx(rate(v, omega), abs=DIFFERENTIATION * omega**2)
    assert np.imag(ram.p) == pytest.approx(np.full(FINE, 0.25), abs=EXACT)


@pytest.mark.parametrize(("variant", "stroke"), [(1, 0.42), (2, 0.3)])
def test_the_stroke_is_the_one_asked_for_and_its_ends_are_where_the_crank_is_square_to_the_rocker(
    variant: int, stroke: float
) -> None:
    machine = api.analyse(assignment(variant)).machine
    course, theta = machine.sliders[0], math.asin(stroke / 1.1)
    ends = analyse(machine, np.array([2 * math.pi - theta, 3 * math.pi + theta]))
    assert course.stroke == pytest.approx(stroke, rel=EXACT)
    assert ends.motion.points["E"].p == pytest.approx([course.top, course.bottom], rel=EXACT)
    assert ends.motion.links[3].omega == pytest.approx([0, 0], abs=EXACT * machine.speed)
    ledger = write_ledger(api.analyse(assignment(variant))).ledger
    ratio = (math.pi + 2 * theta) / (math.pi - 2 * theta)
    assert float(ledger["K"].at(1)) == pytest.approx(ratio, rel=EXACT)
    assert float(ledger["v.back"].at(1)) == pytest.approx(ratio * float(ledger["v.work"].at(1)), rel=EXACT)


def test_the_crank_gives_the_power_that_the_cutting_takes() -> None:
    """Without masses M ω1 = −F v_E: +1000 N along x for φ1 in [−θ, π + θ), nothing on the return."""
    analysis = fine(1)
    phi, theta = analysis.motion.driver, math.asin(0.42 / 1.1)
    works = np.cos((phi - math.pi / 2) / 2) ** 2 > math.cos((math.pi / 2 + theta) / 2) ** 2
    force = np.where(works, 1000.0, 0.0)
    torque = -force * np.real(analysis.motion.points["E"].v) / analysis.machine.speed
    assert np.real(analysis.applied[0].force) == pytest.approx(force)
    assert analysis.torque == pytest.approx(torque, abs=1e-9 * torque.max())
    assert analysis.torque_by_work == pytest.approx(torque, abs=1e-9 * torque.max())
    # 1000 N over 0.42 m each turn.
    assert analysis.summary.mean_torque == pytest.approx(420 / (2 * math.pi), rel=EXACT)
    assert analysis.summary.work == pytest.approx(-420, rel=EXACT)


def test_the_ends_of_the_stroke_are_free() -> None:
    """A twentieth of 0.3 m at each end: 1000 N over 0.27 m, between x_E of the ends found on the way itself."""
    analysis = fine(2)
    x = np.real(analysis.motion.points["E"].p)
    works = (np.real(analysis.motion.points["E"].v) < 0) & (np.abs(x - (x.max() + x.min()) / 2) < 0.45 * 0.3)
    inside = np.abs(np.abs(x - (x.max() + x.min()) / 2) - 0.135) > 1e-3
    assert np.real(analysis.applied[0].force)[inside] == pytest.approx(np.where(works, 1000.0, 0.0)[inside])
    assert analysis.summary.work == pytest.approx(-270, rel=1e-10)
    assert analysis.summary.energy_error < 1e-10


def test_clockwise_is_the_mirror_image(tmp_path: Path) -> None:
    text = (ASSIGNMENTS / "shaper-02.yaml").read_text()
    file = tmp_path / "a.yaml"
    file.write_text(text.replace("{count: 12}", "{count: 12, direction: clockwise}"))
    one, other = api.analyse(assignment(2)), api.analyse(api.load(file))
    for name in ("B", "D", "E", "S3"):
        ours, theirs = one.motion.points[name], other.motion.points[name]
        for quantity in ("p", "v", "a"):
            mirrored = -np.conj(getattr(ours, quantity))
            assert getattr(theirs, quantity) == pytest.approx(mirrored, abs=1e-11)
    assert other.torque == pytest.approx(-one.torque, abs=1e-11 * np.abs(one.torque).max())
