"""What acts at one place twice: two masses in a pin, gas and a working force on a slider, the ends of a spring."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from reportgen import catalogue
from reportgen.cases import MachineCase, open_case
from reportgen.derivation import write_ledger
from reportgen.document import text_of
from reportgen.machine.reduction import reduced

FOUR_BAR = """\
kind: linkage
report: {language: en, worked_positions: [2]}
positions: {count: 6}
parameters:
  frame: {A: [0 mm, 0 mm], D: [300 mm, 0 mm]}
  driver: {type: crank, centre: A, pin: B, length: 80 mm, n: 100 rpm}
  groups:
    - {type: RRR, links: [2, 3], joints: [B, C, D], lengths: [250 mm, 220 mm], side: left}
  masses:
    - {link: 1, at: A, m: 0.001 kg, J: 0.5 kg m2}
    - {link: 2, at: C, m: 2 kg, J: 0.01 kg m2}
    - {link: 3, at: C, m: 3 kg, J: 0.01 kg m2}
  loads:
    - {by: constant, link: 3, M: -20 N m}
"""
ENGINE = """\
kind: linkage
report: {language: en, worked_positions: [2]}
positions: {count: 6}
parameters:
  frame: {A: [0 mm, 0 mm]}
  driver: {type: crank, centre: A, pin: B, length: 80 mm, n: 100 rpm}
  groups:
    - {type: RRP, links: [2, 3], joints: [B, C], length: 250 mm, guide: {at: [0 mm, 0 mm], angle: 0 deg}, end: far}
  masses:
    - {link: 3, at: C, m: 3 kg}
"""
GAS = """\
    - by: gas
      link: 3
      D: 60 mm
      diagram:
        by: stroke
        unit: bar
        s: [0, 0.5, 1]
        intake: [0, 0, 0]
        compression: [10, 3, 0]
        expansion: [20, 8, 0]
        exhaust: [0, 0, 0]
"""
WORKING = "    - {by: stroke, link: 3, inward: [0, 100, 200], outward: [10, 10, 0], unit: N, s: [0, 0.5, 1]}\n"


def case_of(tmp_path: Path, text: str) -> MachineCase:
    file = tmp_path / "machine.yaml"
    file.write_text(text, encoding="utf-8")
    case = open_case(file)
    assert isinstance(case, MachineCase)
    return case


def test_two_masses_in_one_pin_and_a_true_motion(tmp_path: Path) -> None:
    """J′ = 2 Σ(m v a^v + J ω ε)/ω₁³ of both masses at C is the slope of J between two angles beside each position."""
    case = case_of(tmp_path, FOUR_BAR + "  motion: {drive: {M0: 100 N m, k: 5 N m s}}\n")
    assert case.document().blocks
    machine, h = case.analysis.machine, 1e-5
    ahead, behind = (reduced(machine, machine.cycle_angles + step)[0] for step in (h, -h))
    assert case.ledger["run.dJ"].values == pytest.approx((ahead - behind) / (2 * h), abs=1e-7)


def test_two_masses_in_one_pin_and_balancing(tmp_path: Path) -> None:
    """F_x = −Σ m a_x of all masses, two of them at C."""
    case = case_of(tmp_path, FOUR_BAR + "  balancing: {counterweight: {rules: [max], radius: 60 mm}}\n")
    assert case.document().blocks
    acceleration = case.analysis.motion.points["C"].a
    size = np.abs(5.0 * acceleration)
    assert case.ledger["balance.F"].values == pytest.approx(size, rel=1e-9)


@pytest.mark.parametrize("loads", [GAS + WORKING, WORKING + GAS])
def test_gas_and_a_working_force_on_one_slider(loads: str, tmp_path: Path) -> None:
    """p = p′ + (p″ − p′)(x − x′)/(x″ − x′) by the way of the gas, whichever load comes first."""
    case = case_of(tmp_path, ENGINE + "  loads:\n" + loads + "  turns: 2\n")
    assert case.document().blocks
    planned = write_ledger(case.analysis, case.ledger.units, (2,)).ledger
    way = 0.33 - np.real(case.analysis.motion.points["C"].p)
    assert planned["s.3"].values == pytest.approx(way, abs=1e-9)


@pytest.mark.parametrize(
    ("place", "free", "meets"), [("250 mm, 0", 50, True), ("250 mm, 0", 0, False), ("250 mm, 8", 50, False)]
)
def test_the_ends_of_a_spring_do_not_meet(place: str, free: int, meets: bool, tmp_path: Path) -> None:
    """C runs from 170 to 330 mm along the axis; a spring to 250 mm there would have no length on its way.

    One without a free length pulls with c times the vector between its ends, which passes through nothing.
    """
    file = tmp_path / "spring.yaml"
    spring = f"  springs:\n    - {{link: 3, at: C, to: [{place} mm], c: 1 N/mm, free: {free} mm}}\n"
    file.write_text(ENGINE + spring, encoding="utf-8")
    assert ("spring-ends-meet" in [problem.code for problem in catalogue.check(file)]) == meets


SLIDE = """\
kind: linkage
report: {language: en, worked_positions: [3]}
positions: {count: 6}
parameters:
  frame: {D: [400 mm, 0 mm]}
  driver: {type: slider, pin: B, guide: {at: [0 mm, 0 mm], angle: 0 deg}, start: 0 mm, end: 120 mm, speed: 0.4 m/s}
  groups:
    - {type: RRR, links: [2, 3], joints: [B, C, D], lengths: [260 mm, 240 mm], side: left}
  springs:
    - {link: 3, at: C, to: [100 mm, 400 mm], c: 1 N/mm, free: 80 mm}
"""


def test_the_spring_of_a_slide_does_work(tmp_path: Path) -> None:
    """C by two circles at both ends of the way: ½c(l − l₀)² falls by 2.18 J, and the report says so."""

    def energy(x: float) -> float:
        apart = 0.4 - x
        along = (0.26**2 - 0.24**2 + apart**2) / (2 * apart)
        place = complex(x + along, np.sqrt(0.26**2 - along**2))
        return 1000.0 * (abs(place - (0.1 + 0.4j)) - 0.08) ** 2 / 2

    work = energy(0.0) - energy(0.12)
    assert work == pytest.approx(2.18, abs=0.005)
    said = text_of(case_of(tmp_path, SLIDE).document())
    assert "its work is zero" not in said
    assert f"over the stroke this is {work:.4f} J" in said
