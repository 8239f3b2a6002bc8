"""The four-bar linkage against R. L. Norton, Design of Machinery (4-1, 6-7), its own loop of vectors, and FFT."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from reportgen import api
from reportgen.derivation import write_ledger
from reportgen.machine.analysis import Analysis

ASSIGNMENTS = Path(__file__).parents[2] / "assignments"
EXACT = 1e-12
"""Rounding of a few dozen operations, relative."""
BY_FFT = 1e-8
"""A smooth periodic function of 256 samples differentiated twice by FFT: ε·256² with room."""
PUBLISHED = "AB: 40 mm, BC: 120 mm, CD: 80 mm, AD: 100 mm, omega1: 25 rad/s"
DRAG_LINK = "AB: 300 mm, BC: 280 mm, CD: 260 mm, AD: 100 mm, omega1: 10 rad/s"


def analysed(folder: Path, parameters: str, positions: str = "count: 9, start: 0 deg") -> Analysis:
    file = folder / "a.yaml"
    file.write_text(f"kind: four-bar\npositions: {{{positions}}}\nparameters: {{{parameters}}}\n")
    return api.analyse(api.load(file))


@pytest.mark.parametrize(
    ("branch", "coupler", "output", "digit"), [("open", 20.298, 57.325, 1e-3), ("crossed", -60.98, -98.01, 1e-2)]
)
def test_published_positions_of_both_branches(
    tmp_path: Path, branch: str, coupler: float, output: float, digit: float
) -> None:
    """Crank 40 mm, coupler 120, output link 80, frame 100 mm, crank at 40°: angles within a printed digit.

    The source works with ratios of lengths rounded to four decimals.
    """
    links = analysed(tmp_path, f"{PUBLISHED}, branch: {branch}").motion.links
    assert np.degrees(links[2].angle[1]) == pytest.approx(coupler, abs=digit)
    assert np.degrees(links[3].angle[1]) == pytest.approx(output, abs=digit)


def test_published_velocities(tmp_path: Path) -> None:
    """The same linkage in its open branch at 25 rad/s: printed −4.121 and 6.998 rad/s."""
    links = analysed(tmp_path, PUBLISHED).motion.links
    assert links[2].omega[1] == pytest.approx(-4.121, abs=5e-4)
    assert links[3].omega[1] == pytest.approx(6.998, abs=5e-4)


@pytest.mark.parametrize("branch", ["open", "crossed"])
@pytest.mark.parametrize("direction", ["anticlockwise", "clockwise"])
@pytest.mark.parametrize("lengths", [PUBLISHED, DRAG_LINK])
def test_matrices_hold_and_give_the_plans_rates(tmp_path: Path, lengths: str, direction: str, branch: str) -> None:
    """[A][ω] = [B]ω₁ and [A][ε] = −[Ȧ][ω] + [Ḃ]ω₁ from the printed entries, by a general solver."""
    analysis = analysed(
        tmp_path,
        f"{lengths}, branch: {branch}, frame: 25 deg, E: {{along: 30 mm, across: -20 mm}}, BF: 60 mm",
        f"count: 7, start: 12 deg, direction: {direction}",
    )
    values = {id: family.values for id, family in write_ledger(analysis).ledger.families.items()}

    def matrix(name: str) -> np.ndarray:
        rows = [[np.broadcast_to(values[f"{name}.{i}{j}"], 7) for j in "12"] for i in "12"]
        return np.moveaxis(np.array(rows), 2, 0)

    def column(name: str) -> np.ndarray:
        return np.array([values[f"{name}.1"], values[f"{name}.2"]]).T

    omega1 = values["omega.1"][0]
    omega = np.linalg.solve(matrix("A"), column("B")[:, :, None] * omega1)
    right = -matrix("dA") @ omega + column("dB")[:, :, None] * omega1
    epsilon = np.linalg.solve(matrix("A"), right)
    links = analysis.motion.links
    for row, link in enumerate((2, 3)):
        speed, swing = links[link].omega, links[link].epsilon
        assert omega[:, row, 0] == pytest.approx(speed, abs=EXACT * 10 * abs(speed).max())
        assert epsilon[:, row, 0] == pytest.approx(swing, abs=EXACT * 100 * abs(swing).max())
        assert values[f"f.omega.{link}"] == pytest.approx(speed, abs=EXACT * 10 * abs(speed).max())
        assert values[f"f.eps.{link}"] == pytest.approx(swing, abs=EXACT * 100 * abs(swing).max())
    for plan, formula in analysis.machine.closed_formulas.compared:
        assert np.abs(values[plan]) == pytest.approx(
            np.abs(values[formula]), abs=EXACT * 100 * np.abs(values[plan]).max()
        )


def test_rates_are_derivatives_over_a_turn(tmp_path: Path) -> None:
    """Velocity and acceleration of a coupler point against its path, differentiated by FFT."""
    analysis = analysed(tmp_path, f"{PUBLISHED}, E: {{along: 50 mm, across: 40 mm}}", "count: 256")
    point, omega = analysis.motion.points["E"], analysis.motion.rate
    orders = np.fft.fftfreq(256, 1 / 256)
    spectrum = np.fft.fft(point.p)
    for rate, derivative in ((point.v, 1j * orders * omega), (point.a, (1j * orders * omega) ** 2)):
        assert np.fft.ifft(spectrum * derivative) == pytest.approx(rate, abs=BY_FFT * abs(rate).max())


def test_swing_and_ratio_of_times(tmp_path: Path) -> None:
    """ψ and K from the formulas against the rocker's own course over a finely divided turn."""
    analysis = analysed(tmp_path, f"{PUBLISHED}, n: 10 rpm".replace(", omega1: 25 rad/s", ""), "count: 360")
    values = {id: family.values for id, family in write_ledger(analysis).ledger.families.items()}
    angle = analysis.motion.links[3].angle
    # At the ends of the swing the angle is stationary: a step of 1° changes it by less than 1e-4 of a radian.
    assert float(values["swing"][0]) == pytest.approx(np.ptp(angle), abs=1e-4)
    forward = (int(np.argmax(angle)) - int(np.argmin(angle))) % 360
    ratio = max(forward, 360 - forward) / min(forward, 360 - forward)
    # Each end is found to half a step: 1° of about 180°.
    assert float(values["K"][0]) == pytest.approx(ratio, rel=2 / 180)


def test_two_cranks_have_no_extreme_positions(tmp_path: Path) -> None:
    analysis = analysed(tmp_path, f"{DRAG_LINK}, link3: crank", "count: 36")
    assert not {"swing", "K"} & set(write_ledger(analysis).ledger.families)
    turned = np.ptp(analysis.motion.links[3].angle)
    assert turned > math.pi


def test_a_torque_against_the_rocker_takes_the_work_that_it_does(tmp_path: Path) -> None:
    """Over a turn M·2ψ is taken up, whatever the masses do: the mean balancing torque is 2ψM/2π."""
    analysis = analysed(tmp_path, f"{PUBLISHED}, m2: 2 kg, m3: 1 kg, torque: {{M: 7 N m}}", "count: 12")
    swing = float(write_ledger(analysis).ledger["swing"].values[0])
    assert analysis.summary.work == pytest.approx(-7 * 2 * swing, rel=EXACT * 10)
    assert analysis.summary.mean_torque == pytest.approx(7 * 2 * swing / (2 * math.pi), rel=1e-9)


def test_results_tell_a_torque_by_its_couple(tmp_path: Path) -> None:
    results = api.solve(api.load(ASSIGNMENTS / "four-bar-01.yaml"))
    first = results["positions"][0]
    assert set(first["points"]) == {"B", "C", "E", "F", "S2", "S3"}
    assert set(first["links"]) == {"1", "2", "3"}
    assert abs(first["loads"]["M3"]["couple"]) == 40
    assert first["loads"]["M3"]["force"] == [0, 0]
    assert results["dyad_signs"] == {"23": 1}
