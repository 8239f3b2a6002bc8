"""What is read between two given values has its line: forces over the stroke or the angle, lengths of points."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from reportgen import api, cases
from reportgen.document import text_of
from reportgen.formula import Chain, Number, walk
from reportgen.machine.kinematics import solve_motion
from reportgen.report.context import ReportContext
from tests.report import built

PRESS = """
kind: toggle-press
report: {worked_positions: [4]}
positions: {count: 8, direction: clockwise}
parameters:
  OA: 75 mm
  AB: 285 mm
  BD: 310 mm
  D: {x: -370 mm, y: 270 mm}
  B: left
  n: 95 rpm
  G2: 70 N
  G5: 620 N
"""
BY_WAY = "  press: {unit: N, s: [0, 0.4, 0.8, 1], P: [0, 800, 2500, 6000]}\n"

CRANK = """
kind: slider-crank
report: {worked_positions: [4]}
positions: {count: 8, direction: anticlockwise, start: 70 deg}
parameters:
  r: 60 mm
  l: 240 mm
  n: 120 rpm
  m3: 4 kg
"""
OVER_A_TURN = (
    "  force: {by: crank_angle, unit: N, angle: [0 deg, 100 deg, 250 deg, 360 deg], F: [0, -400, -900, -100]}\n"
)


def opened(text: str, folder: Path) -> ReportContext:
    file = folder / "machine.yaml"
    file.write_text(text.lstrip(), encoding="utf-8")
    return ReportContext(cases.opened(api.load(file, "en")))


def line(report: ReportContext, id: str, k: int) -> Chain:
    chain = report.ledger.chain(id, k)
    assert len(chain.parts) == 4, "symbol = formula = numbers = result"
    return chain


def test_the_force_of_a_press_is_worked_out_from_the_stroke(tmp_path: Path) -> None:
    """H is the way between the dead centres, found here by a fine search; 2500 + 3500 (s/H − 0.8)/0.2."""
    report = opened(PRESS + BY_WAY, tmp_path)
    machine = report.machine
    C = solve_motion(machine.linkage, np.linspace(0, 2 * np.pi, 200_001), machine.turn * machine.speed).points["C"].p
    H = np.ptp(C.imag)
    s = C.imag.max() - report.analysis.motion.points["C"].p[3].imag
    P = 2500 + 3500 * (s / H - 0.8) / 0.2
    last = line(report, "P5", 4).parts[-1]
    assert isinstance(last, Number)
    assert last.value == pytest.approx(P, abs=0.2)
    text = text_of(report.case.document())
    assert f"H_5 = {H:.6f} m" in text
    assert "P_5 = P^′ + (P^″ − P^′)/(x^″ − x^′)·(s_5/H_5 − x^′) = 2500 + (6000 − 2500)/(1 − 0.8)" in text


@pytest.mark.parametrize("k", range(1, 9))
def test_a_force_over_the_angle_is_read_in_the_first_turn(k: int, tmp_path: Path) -> None:
    """The crank is at 70° + 45° (k − 1) from its outer dead centre, less a turn from 360° on."""
    report = opened(CRANK + OVER_A_TURN, tmp_path)
    φ = (70 + 45 * (k - 1)) % 360
    angles, forces = [0, 100, 250, 360], [0, -400, -900, -100]
    shown = line(report, "P3", k)
    numbers = {abs(round(part.value, 6)) for part in walk(shown.parts[2]) if isinstance(part, Number)}
    place = np.searchsorted(angles, φ, side="right") - 1
    assert {φ, angles[place + 1], -forces[place + 1]} <= numbers
    last = shown.parts[-1]
    assert isinstance(last, Number)
    assert last.value == pytest.approx(np.interp(φ, angles, forces), abs=0.05)


def test_a_length_from_coordinates_has_its_line() -> None:
    """l_BE = √(110² + 60²) mm, and from C, whose rod is 170 mm: √((170 − 110)² + 60²) mm."""
    report = ReportContext(built.case(built.ROOT / "assignments" / "linkage-8.yaml", "vi"))
    text = text_of(report.case.document())
    assert "l_BE = √(0,11^2 + 0,06^2) = 0,12530 m" in text
    assert "= 0,084853 m" in text
