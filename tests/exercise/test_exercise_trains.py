"""Gears and belts on an arm that turns: each written solution comes to what Willis' formula gives by itself."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from reportgen import catalogue
from reportgen.exercise.case import ExerciseCase

TRAIN = """\
kind: plane-motion
parameters:
  points:
    O: {{at: [0 m, 0 m]}}
    A: {{from: O, distance: {apart} m, angle: {angle} deg}}
    M: {{from: A, distance: {r2} m, angle: {of} deg}}
  bodies:
    1: {{disc: {{centre: O, radius: {r1} m}}}}
    2: {{points: [M], disc: {{centre: A, radius: {r2} m}}}}
    3: {{points: [O, A]}}
  joints:
    - {{type: pin, at: O, bodies: [0, 1]}}
    - {{type: pin, at: O, bodies: [0, 3]}}
    - {{type: pin, at: A, bodies: [2, 3]}}
    - {{{joint}}}
  given:
    - {{type: omega, body: 1, value: {w1} rad/s}}
    - {{type: omega, body: 3, value: {w3} rad/s}}
    - {{type: epsilon, body: 1, value: {e1} rad/s2}}
    - {{type: epsilon, body: 3, value: {e3} rad/s2}}
  find: [omega.2, v.M, eps.2, a.M]
"""
JOINTS = {
    "type: gears, discs: [1, 2]": -1,
    "type: gears, discs: [2, 1]": -1,
    "type: rolling on circle, discs: [1, 2]": -1,
    "type: belt, discs: [1, 2]": 1,
    "type: belt, discs: [2, 1], crossed: true": -1,
}
RATES = st.integers(-9, 9)


def case_of(tmp_path: Path, **numbers: Any) -> ExerciseCase:
    path = tmp_path / "file.yaml"
    path.write_text(TRAIN.format(**numbers), encoding="utf-8")
    return ExerciseCase(catalogue.load(path))


def has_no_dust(case: ExerciseCase) -> None:
    """What floats leave of 0 prints as 0."""
    numbers = {id: case.ledger.number(id).value for id in case.ledger.families}
    assert all(value == 0 or abs(value) > 1e-9 for value in numbers.values()), numbers


@settings(max_examples=40, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    st.sampled_from(list(JOINTS)),
    st.integers(1, 9),
    st.integers(1, 9),
    st.integers(-180, 180),
    st.integers(-180, 180),
    st.tuples(RATES, RATES, RATES, RATES),
)
def test_discs_on_an_arm(
    tmp_path: Path, joint: str, r1: int, r2: int, angle: int, of: int, rates: tuple[int, int, int, int]
) -> None:
    """The rotations against the arm are as the radii inversely, and so are the accelerations."""
    w1, w3, e1, e3 = rates
    apart = r1 + r2 if "belt" not in joint else r1 + r2 + 3
    told = {"joint": joint, "r1": r1 / 10, "r2": r2 / 10, "apart": apart / 10, "angle": angle, "of": of}
    case = case_of(tmp_path, **told, w1=w1, w3=w3, e1=e1, e3=e3)
    ratio = JOINTS[joint] * r1 / r2
    expected = {"omega.2": w3 + ratio * (w1 - w3), "eps.2": e3 + ratio * (e1 - e3)}
    for id, value in expected.items():
        assert float(case.ledger[id].values[0]) == pytest.approx(abs(value), abs=1e-9)
        if value:
            assert float(case.ledger[f"turn.{id}"].values[0]) == pytest.approx(value, abs=1e-9)
    motion = case.exercise.motion
    assert float(case.ledger["a.M"].values[0]) == pytest.approx(abs(motion.a("M")), abs=1e-7)
    assert "train-eps" in {step.kind for step in case.worked.steps}
    has_no_dust(case)


def test_a_ring_is_driven_by_the_planet(tmp_path: Path) -> None:
    """Inner meshing: with the sun (r1) at rest the ring turns at 2 (r1 + r2)/(r1 + 2 r2) times the arm."""
    ring = TRAIN.format(
        joint="type: gears, discs: [1, 2]", r1=0.3, r2=0.1, apart=0.4, angle=35, of=10, w1=0, w3=5, e1=0, e3=-2
    )
    ring = ring.replace("  joints:", "    4: {disc: {centre: O, radius: 0.5 m}}\n  joints:")
    ring = ring.replace(
        "  given:", "    - {type: pin, at: O, bodies: [0, 4]}\n    - {type: gears, discs: [2, 4]}\n  given:"
    )
    path = tmp_path / "file.yaml"
    path.write_text(ring.replace("[omega.2,", "[omega.4, eps.4, omega.2,"), encoding="utf-8")
    ledger = ExerciseCase(catalogue.load(path)).ledger
    assert float(ledger["omega.4"].values[0]) == pytest.approx(5 * 2 * 0.4 / 0.5)
    assert float(ledger["turn.eps.4"].values[0]) == pytest.approx(-2 * 2 * 0.4 / 0.5)


RACKS = """\
kind: plane-motion
parameters:
  points:
    O: {{at: [0 m, 0 m]}}
    A: {{from: O, distance: 0.2 m, angle: {up} deg}}
    B: {{from: O, distance: 0.2 m, angle: {down} deg}}
    M: {{from: O, distance: 0.15 m, angle: 10 deg}}
  bodies:
    1: {{points: [A]}}
    2: {{points: [B]}}
    3: {{points: [M], disc: {{centre: O, radius: 0.2 m}}}}
  joints:
    - {{type: slider, body: 1, angle: {way} deg}}
    - {{type: slider, body: 2, angle: {way} deg}}
    - {{type: rolling on line, disc: 3, on: 1, through: A, angle: {way} deg}}
    - {{type: rolling on line, disc: 3, on: 2, through: B, angle: {way} deg}}
  given:
    - {{type: velocity, point: B, size: {v} m/s, direction: {way} deg}}
    - {{type: acceleration, point: B, size: {a} m/s2, direction: {way} deg}}
    {driven}
  find: [v.O, a.O, a.M, {asked}]
"""
FIRST = (
    "- {{type: velocity, point: A, size: {w} m/s, direction: {way} deg}}\n"
    "    - {{type: acceleration, point: A, size: {b} m/s2, direction: {way} deg}}"
)
TURNED = "- {{type: omega, body: 3, value: {w} rad/s}}\n    - {{type: epsilon, body: 3, value: {b} rad/s2}}"


@settings(max_examples=40, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.booleans(), st.integers(-180, 180), st.tuples(RATES, RATES, RATES, RATES))
def test_a_disc_between_two_racks(tmp_path: Path, by_rack: bool, way: int, rates: tuple[int, int, int, int]) -> None:
    """ε = (a_A − a_B)/2r along the racks, and the centre moves with the mean of both, whichever of them is given."""
    v, a, w, b = rates
    driven, asked = (FIRST, "omega.3, eps.3") if by_rack else (TURNED, "v.A, a.A")
    told = {"way": way, "v": v, "a": a, "w": w, "b": b}
    path = tmp_path / "file.yaml"
    text = RACKS.format(up=way + 90, down=way - 90, driven=driven.format(**told), asked=asked, **told)
    path.write_text(text, encoding="utf-8")
    case = ExerciseCase(catalogue.load(path))
    ledger = case.ledger
    has_no_dust(case)
    # The upper rack goes ahead as the disc turns clockwise.
    change = (a - b) / 0.4 if by_rack else b
    upper = b if by_rack else a - 0.4 * change
    assert float(ledger["a.O"].values[0]) == pytest.approx(abs(a + upper) / 2, abs=1e-9)
    if by_rack:
        assert float(ledger["eps.3"].values[0]) == pytest.approx(abs(change), abs=1e-9)
    else:
        assert float(ledger["a.A"].values[0]) == pytest.approx(abs(upper), abs=1e-9)


CANCELLED = """\
kind: plane-motion
parameters:
  points:
    M: {{at: [0.1 m, 0.2 m]}}
    O: {{from: M, distance: 0.7 m, angle: {angle} deg}}
  bodies:
    1: {{points: [M, O]}}
  given:
    - {{type: velocity, point: M, size: 2.1 m/s, direction: {along} deg}}
    - {{type: omega, body: 1, value: 3 rad/s}}
  find: [v.O]
"""


@pytest.mark.parametrize("angle", range(1, 90, 7))
def test_components_that_cancel_are_nothing(tmp_path: Path, angle: int) -> None:
    """Both velocities are equal and mirrored in the y axis, so their sum has no component along x."""
    path = tmp_path / "file.yaml"
    path.write_text(CANCELLED.format(angle=angle, along=90 - angle), encoding="utf-8")
    case = ExerciseCase(catalogue.load(path))
    assert case.ledger.number("v.O.x").value == 0
    has_no_dust(case)


def test_a_centre_is_found_from_the_rotation(tmp_path: Path) -> None:
    """Of a wheel on a turning wheel nothing tells directions: its centre lies v/ω from a known point."""
    told = {"joint": "type: gears, discs: [1, 2]", "r1": 0.3, "r2": 0.2, "apart": 0.5, "angle": 40, "of": 130}
    text = TRAIN.format(**told, w1=-4, w3=2, e1=0, e3=0).replace("find: [omega.2,", "find: [centre.2, omega.2,")
    path = tmp_path / "file.yaml"
    path.write_text(text, encoding="utf-8")
    case = ExerciseCase(catalogue.load(path))
    centre = case.worked.layout.centres[2]
    # 1 m/s at A, 1.2 m/s against it at the rim, 0.2 m nearer to O: between them as their speeds are.
    assert abs(centre.at) == pytest.approx(0.5 - 0.2 * 1 / 2.2)
    motion = case.exercise.motion
    assert abs(motion.velocities.at(2, centre.at)) < 1e-9
    assert "centre-rate" in {step.kind for step in case.worked.steps}
