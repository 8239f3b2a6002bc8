"""An induction motor far too strong for its machine runs near its synchronous speed, or is refused in true words."""

from __future__ import annotations

import math
import re
from pathlib import Path

import numpy as np
import pytest

from reportgen import api
from reportgen.motion.drives import MotionAsked
from reportgen.motion.energy_equation import ReducedMachine
from reportgen.motion.steady_running import steady
from reportgen.motion.true_motion import at_positions

SHAPER = (Path(__file__).parents[2] / "assignments" / "shaper-04.yaml").read_text(encoding="utf-8")
RATIO, SLIP, SYNCHRONOUS = 1 / 16, 0.25, 1000 * math.pi / 30


def strong(folder: Path, breakdown: int, inertia: str) -> Path:
    """The shaper of the samples without inertia on its crank but that of the motor, if any."""
    text = re.sub(
        r"  J1: .*\n|  flywheel: .*\n|    flywheel: .*\n|    start: .*\n|      motors:\n(?:        - .*\n)*", "", SHAPER
    )
    text = text.replace("Mk: 18 N m", f"Mk: {breakdown} N m").replace("n: 60 rpm", "n: 62.5 rpm")
    text = re.sub(r"      J: .*\n", f"      J: {inertia}\n" if inertia else "", text)
    file = folder / "strong.yaml"
    file.write_text(text, encoding="utf-8")
    return file


def test_it_runs_near_its_synchronous_speed(tmp_path: Path) -> None:
    """1000 times as strong: the torque M at even speed takes the slip s = M s_k/(2 M_k), with M_k at the crank."""
    breakdown = 18000
    file = strong(tmp_path, breakdown, "1e-4 kg m2")
    assert [one.code for one in api.check(file) if one.code.startswith("motion")] == []
    analysis = api.analyse(api.load(file))
    machine = analysis.machine
    asked = machine.topic("motion", MotionAsked)
    assert asked is not None
    assert asked.drive is not None
    own = [float(angle) for angle in machine.cycle_angles]
    motion = steady(ReducedMachine(machine, asked.inertia), asked.drive, machine.speed, own)
    speeds = motion.run.speed[at_positions(machine, motion)][: len(own)]
    slip = 1 - speeds / (SYNCHRONOUS * RATIO)
    # Planned for the synchronous speed, 1000/16 rpm; what is left is of the order of the slip and of the motor's J.
    even = analysis.torque * SLIP / (2 * breakdown / RATIO)
    assert slip == pytest.approx(even, abs=1e-3 * np.abs(even).max())
    assert np.abs(slip).max() < 1e-4


@pytest.mark.parametrize(("breakdown", "inertia"), [(180, ""), (1800, ""), (18000, ""), (1800, "1e-8 kg m2")])
def test_without_inertia_the_place_is_named_where_there_is_none(breakdown: int, inertia: str, tmp_path: Path) -> None:
    """All that moves is at rest at the ends of the stroke, φ₁ = 180° + θ and 360° − θ with sin θ = H/(2l₃)."""
    faults = [one for one in api.check(strong(tmp_path, breakdown, inertia), "en") if one.code.startswith("motion")]
    assert [one.code for one in faults] == ["motion-no-inertia"]
    found = re.search(r"at (\S+)°", faults[0].message)
    assert found is not None
    θ = math.degrees(math.asin(0.300 / (2 * 0.550)))
    assert min(abs(float(found[1]) - end) for end in (180 + θ, 360 - θ)) < (2 if inertia else 0.06)
