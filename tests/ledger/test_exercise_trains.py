"""Gears and belts on an arm that turns: each written solution comes to what Willis' formula gives by itself."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from reportgen import catalogue
from reportgen.case import ExerciseCase

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
