"""The slotted lever: ω1 = 1 1/s as in the lecture, and positions whose answers are exact."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from reportgen import api
from reportgen.derivation import write_ledger
from reportgen.machine.analysis import Analysis, analyse

FILE = Path(__file__).parents[2] / "assignments" / "slotted-lever-01.yaml"
EXACT = 1e-12
"""Rounding of a few dozen operations, relative."""


def at(*phi: float) -> Analysis:
    """The lever of the assignment (r = 40, d = 80 mm, ω1 = 1 1/s) at crank angles from +x, in degrees."""
    machine = api.analyse(api.load(FILE)).machine
    return analyse(machine, np.radians(np.asarray(phi)) - machine.start)


def test_crank_in_line_with_the_lever() -> None:
    """ω3 = ω1 r/(d + r) above A and −ω1 r/(d − r) below it, v_r and ε3 are nothing."""
    motion = at(90, 270).motion
    assert motion.links[3].omega == pytest.approx([1 / 3, -1], rel=EXACT)
    assert motion.links[3].epsilon == pytest.approx([0, 0], abs=EXACT)
    assert motion.slides[3, 2].v == pytest.approx([0, 0], abs=EXACT)
    assert np.abs(motion.points["D"].v) == pytest.approx([0.05, 0.15], rel=EXACT)


def test_crank_square_to_the_lever() -> None:
    """At 30° below the horizontal: ω3 = 0, v_r = ω1 r all along the lever, ε3 = ω1² r/(d cos 30°) = tan 30°."""
    motion = at(-30, 210).motion
    assert motion.links[3].omega == pytest.approx([0, 0], abs=EXACT)
    assert motion.slides[3, 2].v == pytest.approx([0.04, -0.04], rel=EXACT)
    assert motion.links[3].epsilon == pytest.approx([math.tan(math.pi / 6), -math.tan(math.pi / 6)], rel=EXACT)


def test_swing_and_ratio() -> None:
    """sin θ = r/d = 1/2, so the crank turns through 240° and 120°."""
    ledger = write_ledger(api.analyse(api.load(FILE))).ledger
    assert float(ledger["theta"].at(1)) == pytest.approx(math.pi / 6, rel=EXACT)
    assert float(ledger["K"].at(1)) == pytest.approx(2, rel=EXACT)


def test_coriolis_acceleration_is_the_relative_velocity_turned_with_the_lever() -> None:
    """aᵏ = 2ω3 v_r, v_r of the lever's point over the block turned by 90° in the sense of ω3, on the plan too."""
    analysis = api.analyse(api.load(FILE))
    ledger, motion = write_ledger(analysis).ledger, analysis.motion
    for k in range(1, analysis.machine.count + 1):
        relative = motion.points["B3"].v[k - 1] - motion.points["B"].v[k - 1]
        omega = motion.links[3].omega[k - 1]
        drawn = complex(ledger["plan.a.k.B3B"].at(k) - ledger["plan.a.b"].at(k)) * float(ledger["mu.a"].at(k))
        assert drawn == pytest.approx(2j * omega * relative, abs=EXACT)
        assert float(ledger["a.B3B.k"].at(k)) == pytest.approx(2 * abs(omega * relative), abs=EXACT)


def test_a_crank_longer_than_the_centres_turns_the_lever_right_round(tmp_path: Path) -> None:
    file = tmp_path / "a.yaml"
    file.write_text(FILE.read_text().replace("AB: 40", "AB: 100").replace("CD: 150", "CD: 200"))
    analysis = api.analyse(api.load(file))
    turned = analyse(analysis.machine, np.linspace(0, 2 * math.pi, 9)).motion.links[3].angle
    assert turned[-1] - turned[0] == pytest.approx(2 * math.pi, rel=EXACT)
    assert "theta" not in write_ledger(analysis).ledger
