"""The sine mechanism against its closed form: x = r cos φ, v = −ωr sin φ, a = −ω²r cos φ."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from reportgen import api
from reportgen.derivation import write_ledger
from reportgen.machine.analysis import Analysis

EXACT = 1e-12
"""Rounding of a few dozen operations, relative."""
R, SPEED = 0.05, 8 * math.pi
CRANK = "r: 50 mm, n: 240 rpm"
MASSES = "G2: 8 N, G3: 60 N"
BY_STROKE = (
    "force: {by: stroke, unit: N, s: [0, 0.1, 0.9, 1],"
    " inward: [-1200, 150, 150, 150], outward: [-1200, -1200, -1200, 150]}"
)


def write(folder: Path, parameters: str, positions: str = "count: 12") -> Path:
    file = folder / "a.yaml"
    file.write_text(f"kind: scotch-yoke\npositions: {{{positions}}}\nparameters: {{{parameters}}}\n")
    return file


def analysed(folder: Path, parameters: str, positions: str = "count: 12") -> Analysis:
    return api.analyse(api.load(write(folder, parameters, positions)))


@pytest.mark.parametrize("direction", ["anticlockwise", "clockwise"])
@pytest.mark.parametrize("guide", [0, 35, -120])
@pytest.mark.parametrize("start", ["", ", start: 70 deg"])
def test_motion_and_printed_formulas(start: str, guide: int, direction: str, tmp_path: Path) -> None:
    analysis = analysed(tmp_path, f"{CRANK}, guide: {guide} deg", f"count: 24, direction: {direction}{start}")
    turn = 1 if direction == "anticlockwise" else -1
    first = turn * math.radians(70 - guide) if start else 0.0
    φ = first + 2 * math.pi * np.arange(24) / 24
    x, v, a = R * np.cos(φ), -SPEED * R * np.sin(φ), -(SPEED**2) * R * np.cos(φ)
    along = np.exp(1j * math.radians(guide))
    yoke, ledger = analysis.motion.points["B"], write_ledger(analysis).ledger
    for found, printed, expected, size in (
        (yoke.p, "f.x.B", x, R),
        (yoke.v, "f.v.B", v, SPEED * R),
        (yoke.a, "f.a.B", a, SPEED**2 * R),
    ):
        assert np.abs(found / along - expected).max() < EXACT * size
        assert ledger[printed].values == pytest.approx(expected, abs=EXACT * size)
    assert ledger["f.v.r"].values == pytest.approx(SPEED * R * np.cos(φ), abs=EXACT * SPEED * R)
    assert ledger["f.a.r"].values == pytest.approx(-(SPEED**2) * R * np.sin(φ), abs=EXACT * SPEED**2 * R)
    for link in (2, 3):
        assert np.abs(analysis.motion.links[link].omega).max() < EXACT * SPEED


def test_exact_answers_at_60_degrees(tmp_path: Path) -> None:
    """A crank of 0.2 m at 10 rad/s: x = 0.1 m, v = −√3 m/s, a = −10 m/s²."""
    yoke = analysed(tmp_path, "r: 200 mm, omega1: 10 rad/s").motion.points["B"]
    assert [yoke.p[2], yoke.v[2], yoke.a[2]] == pytest.approx([0.1, -math.sqrt(3), -10], rel=EXACT)


@pytest.mark.parametrize("direction", ["anticlockwise", "clockwise"])
@pytest.mark.parametrize("guide", [0, 35, 90])
def test_the_torque_is_the_power_over_the_speed(guide: int, direction: str, tmp_path: Path) -> None:
    """M ω₁ = −Σ P·v of the loads, with weights and inertia forces, on a yoke and a block in translation."""
    analysis = analysed(
        tmp_path, f"{CRANK}, guide: {guide} deg, {MASSES}, {BY_STROKE}", f"count: 24, direction: {direction}"
    )
    assert analysis.torque == pytest.approx(analysis.torque_by_work, abs=1e-10)
    turn = 1 if direction == "anticlockwise" else -1
    φ, along = 2 * math.pi * np.arange(24) / 24, np.exp(1j * math.radians(guide))
    v, a = -SPEED * R * np.sin(φ) * along, -(SPEED**2) * R * np.cos(φ) * along
    pin = R * np.exp(1j * turn * φ) * along
    v_pin, a_pin = 1j * turn * SPEED * pin, -(SPEED**2) * pin
    way = (1 - np.cos(φ)) / 2
    inward = np.arange(24) < 12
    force = np.where(
        inward,
        np.interp(way, [0, 0.1, 0.9, 1], [-1200, 150, 150, 150]),
        np.interp(way, [0, 0.1, 0.9, 1], [-1200, -1200, -1200, 150]),
    )

    def power(one: np.ndarray, other: np.ndarray) -> np.ndarray:
        return np.real(one * np.conj(other))

    loads = power(force * along - 60j - 60 / 9.81 * a, v) + power(-8j - 8 / 9.81 * a_pin, v_pin)
    expected = -loads / (turn * SPEED)
    assert analysis.torque == pytest.approx(expected, abs=1e-9 * np.abs(expected).max())


def test_the_mean_torque_pays_for_the_work_of_the_pump(tmp_path: Path) -> None:
    summary = analysed(tmp_path, f"{CRANK}, {MASSES}, {BY_STROKE}").summary
    # Over H = 100 mm: the yoke goes inward against the direction of the guide, outward along it.
    inward = -0.1 * (0.1 * (-1200 + 150) / 2 + 0.9 * 150)
    outward = 0.1 * (0.9 * -1200 + 0.1 * (-1200 + 150) / 2)
    assert summary.work == pytest.approx(inward + outward, rel=1e-9)
    assert summary.mean_torque == pytest.approx(-summary.work / (2 * math.pi), rel=1e-9)


def test_a_constant_force_on_the_way_out(tmp_path: Path) -> None:
    analysis = analysed(tmp_path, f"{CRANK}, force: {{by: constant, F: -900 N, stroke: outward}}", "count: 8")
    assert analysis.applied[0].force == pytest.approx([0, 0, 0, 0, -900, -900, -900, -900])


def test_without_mass_and_force_there_is_kinematics_only(tmp_path: Path) -> None:
    analysis = analysed(tmp_path, CRANK)
    assert analysis.loads == ()
    assert not {"working", "loads", "groups", "crank"} & set(analysis.machine.outline)
