"""Exercises made at random: the steps from body to body come to what the linear system gives, which knows no steps."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

from reportgen import catalogue
from reportgen.case import ExerciseCase
from reportgen.errors import AssignmentError

TWO_CRANKS = """\
kind: plane-motion
parameters:
  points:
    O: {{at: [0 m, 0 m]}}
    Q1: {{at: [1 m, 0 m]}}
    A: {{from: O, distance: 0.2 m, angle: {0} deg}}
    B: {{from: Q1, distance: 0.3 m, angle: {1} deg}}
    C: {{at: [{2} m, {3} m]}}
    M: {{at: [0.4 m, 0.5 m]}}
  bodies:
    1: {{points: [O, A]}}
    2: {{points: [A, C, M]}}
    3: {{points: [B, C]}}
    4: {{points: [Q1, B]}}
  joints:
    - {{type: pin, at: O, bodies: [0, 1]}}
    - {{type: pin, at: A, bodies: [1, 2]}}
    - {{type: pin, at: C, bodies: [2, 3]}}
    - {{type: pin, at: B, bodies: [3, 4]}}
    - {{type: pin, at: Q1, bodies: [0, 4]}}
  given:
    - {{type: omega, body: 1, value: {4} rad/s}}
    - {{type: omega, body: 4, value: {5} rad/s}}
    - {{type: epsilon, body: 1, value: {6} rad/s2}}
    - {{type: epsilon, body: 4, value: 0 rad/s2}}
  find: [v.C, v.M, omega.2, omega.3, a.C, a.M, eps.2, eps.3]
"""
"""Two cranks, each with its own rate; their rods meet in C."""

angles = st.integers(-179, 180)
rates = st.integers(-40, 40).filter(bool).map(lambda tenths: tenths / 10)


@settings(max_examples=40, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(angles, angles, st.integers(3, 7), st.integers(6, 12), rates, rates, rates)
def test_both_ways_agree(
    tmp_path: Path, a: int, b: int, x: int, y: int, first: float, second: float, change: float
) -> None:
    path = tmp_path / "file.yaml"
    path.write_text(TWO_CRANKS.format(a, b, x / 10, y / 10, first, second, change), encoding="utf-8")
    try:
        case = ExerciseCase(catalogue.load(path))
    except AssignmentError:
        # Rods in one line: there the motion is not determined.
        assume(False)
    motion = case.exercise.motion
    points = motion.system.points
    one, other = (points["C"] - points[name] for name in "AB")
    assume(abs((one.conjugate() * other).imag) > 0.05 and min(abs(motion.omega(2)), abs(motion.omega(3))) > 0.01)
    ledger = case.ledger
    for asked in case.exercise.asked:
        whole = abs(motion.v(asked.of) if asked.what == "v" else motion.a(asked.of)) if not asked.of_body else 0.0
        if asked.of_body:
            whole = abs(motion.omega(asked.body) if asked.what == "omega" else motion.epsilon(asked.body))
        assert float(ledger[asked.id].values[0]) == pytest.approx(whole, rel=1e-9, abs=1e-9), asked.id
