"""Flywheel, true motion and motor of a machine whose joints rub: the friction is part of what they balance."""

from __future__ import annotations

import math
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pytest

from reportgen import catalogue
from reportgen.cases import MachineCase, open_case
from reportgen.document import text_of
from reportgen.flywheel.regulation import flywheel
from reportgen.machine.analysis import Machine
from reportgen.motion.true_motion import TrueMotion, true_motion_of
from tests.lanes import proof

R, L, F = 0.1, 0.4, 500.0
TEXT = Path(__file__).with_name("motion.yaml").read_text(encoding="utf-8")


def lost(f: float) -> float:
    """What the slider takes in a turn (J): ∮ f N |dx|, N = F tan β/(1 ∓ f tan β) against the load and with it."""
    φ = np.linspace(0.0, math.pi, 100_001)
    tanβ = np.tan(np.arcsin(R * np.sin(φ) / L))
    rate = R * np.sin(φ) + R**2 * np.sin(φ) * np.cos(φ) / np.sqrt(L**2 - (R * np.sin(φ)) ** 2)
    pressing = F * tanβ / (1 - f * tanβ) + F * tanβ / (1 + f * tanβ)
    return float(np.trapezoid(f * pressing * rate, φ))


def written(folder: Path, f: float, small: float = 240.0) -> Path:
    file = folder / "machine.yaml"
    file.write_text(TEXT.replace("3: 0.12", f"3: {f}").replace("240 W", f"{small} W"), encoding="utf-8")
    return file


@cache
def opened(f: float, small: float = 240.0) -> tuple[Machine, TrueMotion]:
    with TemporaryDirectory() as folder:
        assignment = catalogue.load(written(Path(folder), f, small))
    machine = catalogue.module(assignment.kind).machine(assignment)
    motion = true_motion_of(machine)
    assert motion is not None
    return machine, motion


@pytest.mark.parametrize("f", [0.1, 0.6])
def test_the_drive_does_the_work_of_loads_and_friction(f: float) -> None:
    """30 N·m on the crank, none of the force over a turn, and that of the slider, for wheel, drive and motor alike."""
    machine, motion = opened(f)
    work = 2 * math.pi * 30 + lost(f)
    assert flywheel(machine, 0.05).constant * 2 * math.pi == pytest.approx(work, rel=1e-7)
    for steady in motion.states.values():
        assert steady.work == pytest.approx(work, rel=1e-7)
    assert motion.demand(machine).mean * 2 * math.pi == pytest.approx(work, rel=1e-7)


def test_the_brake_has_less_to_do() -> None:
    """From the stop on φ the energy has gone into brake, load and slider."""
    _, motion = opened(0.6)
    _, smooth = opened(1e-6)
    assert motion.stopped is not None
    assert smooth.stopped is not None
    assert motion.stopped.angle[-1] < smooth.stopped.angle[-1]
    assert motion.started is not None
    assert smooth.started is not None
    assert motion.started.time > smooth.started.time


@proof
def test_the_motor_overcomes_friction() -> None:
    """A motor that endures the loads alone is too weak for them and the slider."""
    f = 0.6
    machine, motion = opened(f)
    needed = motion.demand(machine).effective * 100 * math.pi / 30
    machine, motion = opened(f, small=round(needed * 0.99, 1))
    assert [checks.fits for checks in motion.motors(machine)] == [False, True]
    machine, smooth = opened(1e-6, small=round(needed * 0.99, 1))
    assert [checks.fits for checks in smooth.motors(machine)] == [True, True]


def test_text_task_and_key_say_so(tmp_path: Path) -> None:
    case = open_case(written(tmp_path, 0.3))
    assert isinstance(case, MachineCase)
    text = text_of(case.document())
    assert "The friction of the joints is a resistance as well" in text
    assert "The friction of the joints is taken into account." in text
    ledger = case.ledger
    # M_tt is the torque of the load and what friction takes of it; the power balance at ω₁ has both.
    gained = ledger["friction.M"].values - ledger["M.eq"].values
    assert float(gained.min()) > -1e-9
    assert ledger["friction.reduced"].values == pytest.approx(-gained, abs=1e-9 * float(np.abs(gained).max()))
    assert ledger["M.r"].values == pytest.approx(-ledger["friction.M"].values, abs=1e-6)


def test_a_mechanism_that_locks_anywhere_is_refused(tmp_path: Path) -> None:
    """tan β = 0.559 where the rod is steepest, f tan β = 1.12; position 1, which is worked out, is a dead centre."""
    file = tmp_path / "locks.yaml"
    text = TEXT.replace("3: 0.12", "3: 1.999").replace("l: 400 mm", "l: 205 mm").replace("[3]", "[1]")
    file.write_text(text.replace("count: 8", "count: 4"), encoding="utf-8")
    faults = catalogue.check(file)
    assert any(fault.code == "locks-in-cycle" for fault in faults)


WIDE = """\
kind: slider-crank
report: {{language: en, worked_positions: [3]}}
positions: {{count: 12}}
parameters:
  r: 80 mm
  l: 300 mm
  n: 200 rpm
  m3: 7 kg
  force: {{by: constant, F: 1200 N, stroke: inward}}
  loads:
    - {{by: constant, link: 3, M: {M} N m}}
  faces:
    3: {{from: -60 mm, to: 60 mm, below: 0 mm}}
  friction: {{sliders: {{3: 0.12}}}}
"""


@pytest.mark.parametrize(("M", "tilts"), [(-20, True), (0, False)])
def test_a_slider_that_tilts_rubs_at_both_ends(M: float, tilts: bool, tmp_path: Path) -> None:
    """Under 20 N·m both ends bear: |N₁| + |N₂| = 2|M|/0.12 m where the face forces are opposite, more than |N|."""
    file = tmp_path / "wide.yaml"
    file.write_text(WIDE.format(M=M), encoding="utf-8")
    case = open_case(file)
    assert isinstance(case, MachineCase)
    assert ("friction acts at both of them" in text_of(case.document())) == tilts
    if tilts:
        rubbing = case.ledger["friction.R.03"].values[2]
        assert rubbing == pytest.approx(2 * 20.0 / 0.12, rel=1e-6)
