"""Exercises made at random: the steps from body to body come to what the linear system gives, which knows no steps."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

from reportgen import catalogue
from reportgen.base.errors import AssignmentError
from reportgen.exercise.case import ExerciseCase

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

THREE_RODS = """\
kind: plane-motion
parameters:
  points:
    O: {{at: [0 m, 0 m]}}
    A: {{at: [0.1 m, 0.2 m]}}
    B: {{at: [1.1 m, 0.{0} m]}}
    D: {{at: [0.4 m, 0.7 m]}}
    E: {{at: [0.8 m, 0.{1} m]}}
    C: {{at: [0.9 m, 1.5 m]}}
    F: {{at: [0.5 m, 1.1 m]}}
  bodies:
    1: {{points: [O, A, B]}}
    2: {{points: [A, D]}}
    3: {{points: [B, E]}}
    4: {{points: [D, E, F]}}
    5: {{points: [C, F]}}
  joints:
    - {{type: pin, at: O, bodies: [0, 1]}}
    - {{type: pin, at: A, bodies: [1, 2]}}
    - {{type: pin, at: D, bodies: [2, 4]}}
    - {{type: pin, at: B, bodies: [1, 3]}}
    - {{type: pin, at: E, bodies: [3, 4]}}
    - {{type: pin, at: F, bodies: [4, 5]}}
    - {{type: slot, point: C, body: 5, angle: {2} deg}}
  given:
    - {{type: omega, body: 1, value: {3} rad/s}}
    - {{type: omega, body: 5, value: {4} rad/s}}
    - {{type: epsilon, body: 1, value: {5} rad/s2}}
    - {{type: epsilon, body: 5, value: 0 rad/s2}}
  find: [v.D, v.F, omega.2, omega.3, omega.4, a.D, a.F, eps.2, eps.3, eps.4]
"""
"""A group of class III: three rods to a plate, none of which has two guided points."""
OFFSET_SLOT = """\
kind: plane-motion
parameters:
  points:
    O: {{at: [0 m, 0 m]}}
    C: {{at: [0.1 m, -0.5 m]}}
    A: {{from: O, distance: 0.2 m, angle: {1} deg}}
  bodies:
    1: {{points: [O, A]}}
    2: {{points: [C]}}
  joints:
    - {{type: pin, at: O, bodies: [0, 1]}}
    - {{type: pin, at: C, bodies: [0, 2]}}
    - {{type: slot, point: A, body: 1, on: 2, angle: {0} deg}}
  given:
    - {{type: omega, body: 1, value: {2} rad/s}}
    - {{type: epsilon, body: 1, value: {3} rad/s2}}
  find: [v.A, omega.2, eps.2]
"""
"""A line of a lever that does not pass through its pivot."""

CARRIED_SLOT = """\
kind: plane-motion
parameters:
  points:
    O: {{at: [0 m, 0 m]}}
    C: {{from: O, distance: 0.3 m, angle: 20 deg}}
    B: {{at: [0.7 m, 0.1 m]}}
    A: {{from: B, distance: 0.2 m, angle: {1} deg}}
  bodies:
    1: {{points: [B, A]}}
    2: {{points: [C]}}
    3: {{points: [O, C]}}
  joints:
    - {{type: pin, at: B, bodies: [0, 1]}}
    - {{type: pin, at: O, bodies: [0, 3]}}
    - {{type: pin, at: C, bodies: [2, 3]}}
    - {{type: slot, point: A, body: 1, on: 2, angle: {0} deg}}
  given:
    - {{type: omega, body: 1, value: {2} rad/s}}
    - {{type: epsilon, body: 1, value: {3} rad/s2}}
    - {{type: omega, body: 3, value: 1.5 rad/s}}
    - {{type: epsilon, body: 3, value: -2 rad/s2}}
  find: [omega.2, eps.2]
"""
"""A lever that a crank carries, its line through neither end."""

DRIVEN_SLOT = """\
kind: plane-motion
parameters:
  points:
    O: {{at: [0 m, 0 m]}}
    B: {{at: [0.7 m, 0.1 m]}}
    A: {{from: B, distance: 0.2 m, angle: {1} deg}}
  bodies:
    1: {{points: [B, A]}}
    2: {{points: [O]}}
  joints:
    - {{type: pin, at: B, bodies: [0, 1]}}
    - {{type: pin, at: O, bodies: [0, 2]}}
    - {{type: slot, point: A, body: 1, on: 2, angle: {0} deg}}
  given:
    - {{type: omega, body: 2, value: {2} rad/s}}
    - {{type: epsilon, body: 2, value: {3} rad/s2}}
  find: [v.A, omega.1, a.A, eps.1]
"""
"""A turning line that drives a crank."""

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
    holds(case)


@settings(max_examples=40, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.integers(1, 9), st.integers(1, 8), angles, rates, rates, rates)
def test_what_is_left_is_solved_together(
    tmp_path: Path, b: int, e: int, way: int, first: float, second: float, change: float
) -> None:
    path = tmp_path / "file.yaml"
    path.write_text(THREE_RODS.format(b, e, way, first, second, change), encoding="utf-8")
    try:
        case = ExerciseCase(catalogue.load(path))
    except AssignmentError:
        assume(False)
    motion = case.exercise.motion
    assume(all(0.01 < abs(motion.omega(body)) < 100 for body in motion.system.bodies))
    assert any(step.system for step in case.worked.steps)
    holds(case)


@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.sampled_from([OFFSET_SLOT, CARRIED_SLOT, DRIVEN_SLOT]), angles, angles, rates, rates)
def test_a_line_may_pass_through_no_known_point(
    tmp_path: Path, form: str, line: int, crank: int, omega: float, change: float
) -> None:
    """A lever, a lever on a crank, and a driven lever along which a slider goes, each with Coriolis' acceleration."""
    path = tmp_path / "file.yaml"
    path.write_text(form.format(line, crank, omega, change), encoding="utf-8")
    try:
        case = ExerciseCase(catalogue.load(path))
    except AssignmentError:
        assume(False)
    motion = case.exercise.motion
    assume(all(0.01 < abs(motion.omega(body)) < 100 for body in motion.system.bodies))
    assume(all(abs(motion.epsilon(body)) < 1e4 for body in motion.system.bodies))
    assert any(step.kind.startswith("acceleration-slot") for step in case.worked.steps)
    holds(case)


def holds(case: ExerciseCase) -> None:
    """What is asked has the size that the linear system of the whole gives it."""
    motion = case.exercise.motion
    ledger = case.ledger
    for asked in case.exercise.asked:
        whole = abs(motion.v(asked.of) if asked.what == "v" else motion.a(asked.of)) if not asked.of_body else 0.0
        if asked.of_body:
            whole = abs(motion.omega(asked.body) if asked.what == "omega" else motion.epsilon(asked.body))
        assert float(ledger[asked.id].values[0]) == pytest.approx(whole, rel=1e-8, abs=1e-9), asked.id
