"""The equations of motion give what the whole system's solution gives, and the published figures."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from reportgen import api
from reportgen.base.errors import AssignmentError
from reportgen.cases import opened
from reportgen.formula import ids

PUBLISHED = Path(__file__).parents[2] / "assignments" / "plane-motion"
FILES = sorted(PUBLISHED.glob("*.yaml"))
EXACT = 1e-9
"""Of the largest rate: floats, and places typed to twelve figures."""

ROLLING = """
kind: plane-motion
parameters:
  points:
    C: {at: [0 mm, 0 mm]}
    A: {from: C, distance: 200 mm, angle: 90 deg}
    B: {from: C, distance: 100 mm, angle: 20 deg}
  bodies:
    1: {points: [C, A, B], disc: {centre: C, radius: 200 mm}}
  joints:
    - {type: rolling on line, disc: 1, through: K, angle: 0 deg}
  given:
    - {type: velocity, point: C, size: 3 m/s, direction: 0 deg}
    - {type: acceleration, point: C, size: 4 m/s2, direction: 180 deg}
  find: [omega.1, v.A, v.B, eps.1, a.B]
  methods: [equations]
""".replace("    B: {from", "    K: {from: C, distance: 200 mm, angle: -90 deg}\n    B: {from")

INCLINED = """
kind: plane-motion
parameters:
  points:
    O: {at: [0 mm, 0 mm]}
    A: {from: O, distance: 250 mm, angle: 200 deg}
    B: {from: O, distance: 300 mm, angle: 75 deg}
    M: {from: A, distance: 120 mm, angle: 10 deg}
  bodies:
    1: {points: [A, B, M]}
  joints:
    - {type: slot, point: A, body: 1, angle: 20 deg}
    - {type: slot, point: B, body: 1, angle: 75 deg}
  given:
    - {type: velocity, point: A, size: 0.4 m/s, direction: 20 deg}
    - {type: acceleration, point: A, size: 1.5 m/s2, direction: 20 deg}
  find: [omega.1, v.B, v.M, eps.1, a.B, a.M]
  methods: [equations, base point, instant centre]
"""


def by_equations(file: Path, folder: Path) -> Path:
    """A file with the equations as its one method."""
    plain = re.sub(r"^  methods: .*\n", "", file.read_text(encoding="utf-8"), flags=re.MULTILINE)
    path = folder / file.name
    path.write_text(f"{plain.rstrip()}\n  methods: [equations]\n", encoding="utf-8")
    return path


@pytest.mark.parametrize("text", [ROLLING, INCLINED], ids=["rolling", "inclined guides"])
def test_values_are_those_of_the_whole_system(tmp_path: Path, text: str) -> None:
    path = tmp_path / "own.yaml"
    path.write_text(text, encoding="utf-8")
    agrees(path)


OF_SEVERAL = {"13": 2, "19": 3}
"""Exercises of the lecture with more than one coordinate: two points of one line are driven, a body moves freely."""


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.stem)
def test_published_exercises_by_their_equations(tmp_path: Path, file: Path) -> None:
    """All that the lecture asks in its exercises with one coordinate follows from their equations alone."""
    path = by_equations(file, tmp_path)
    if file.stem in OF_SEVERAL:
        with pytest.raises(AssignmentError) as told:
            api.load(path, "en")
        assert f"leave {OF_SEVERAL[file.stem]} coordinates free" in str(told.value)
        return
    agrees(path)
    case = opened(api.load(path))
    assert not {one for one in case.alone[0].missing if not one.startswith("centre")}


def agrees(path: Path) -> None:
    """What the solution comes to, and of its components each, is what the system of all conditions gives."""
    case = opened(api.load(path))
    motion, ledger = case.exercise.motion, case.worked.ledger
    own = [step for step in case.worked.steps if step.kind.removeprefix("acceleration-").startswith("equations")]
    assert own
    for id in (id for step in own for id in step.ids):
        value = float(ledger[id].values[0])
        if found := ids.velocity_component.read(id):
            v, axis = motion.v(found["point"]), found["axis"]
            assert value == pytest.approx(v.real if axis == "x" else v.imag, abs=EXACT * motion.fastest), id
        elif found := ids.acceleration_component.read(id):
            a, axis = motion.a(found["point"]), found["axis"]
            assert value == pytest.approx(a.real if axis == "x" else a.imag, abs=EXACT * motion.steepest), id
        elif found := ids.angular_velocity.read(id):
            assert value == pytest.approx(abs(motion.omega(int(found["link"]))), rel=EXACT), id
        elif found := ids.angular_acceleration.read(id):
            assert value == pytest.approx(abs(motion.epsilon(int(found["link"]))), rel=EXACT), id
        elif found := ids.formula_coordinate.read(id):
            place = case.worked.layout.points[found["line"]]
            assert value == pytest.approx(place.real if found["axis"] == "x" else place.imag, abs=EXACT), id


def test_the_trammels_published_figures(tmp_path: Path) -> None:
    """v_B = 10√3 cm/s, ω = 1 rad/s, v_M = 10 cm/s."""
    text = (PUBLISHED / "01.yaml").read_text(encoding="utf-8")
    path = tmp_path / "trammel.yaml"
    path.write_text(text.replace("[base point, instant centre]", "[equations]"), encoding="utf-8")
    ledger = opened(api.load(path)).worked.ledger
    found = [float(ledger[id].values[0]) for id in ("v.B", "omega.1", "v.M")]
    assert found == pytest.approx([0.1 * np.sqrt(3), 1.0, 0.1], rel=EXACT)
