"""Exercises made at random with symbols: expressions are what the numbers come to, at whatever angles."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

from reportgen import catalogue
from reportgen.case import ExerciseCase
from reportgen.errors import AssignmentError
from reportgen.notation.evaluation import evaluate

FOUR_BAR = """\
kind: plane-motion
parameters:
  symbols: {{r: 0.3 m, l: 0.5 m, omega: 2 rad/s, x: 1 m}}
  points:
    O: {{at: [0 m, 0 m]}}
    O1: {{at: [x, r/2]}}
    A: {{from: O, distance: r, angle: {a} deg}}
    B: {{from: O1, distance: 2*l - r, angle: {b} deg}}
    M: {{at: [x/2, r + l/3]}}
  bodies:
    1: {{points: [O, A]}}
    2: {{points: [A, B, M]}}
    3: {{points: [O1, B]}}
  joints:
    - {{type: pin, at: O, bodies: [0, 1]}}
    - {{type: pin, at: A, bodies: [1, 2]}}
    - {{type: pin, at: B, bodies: [2, 3]}}
    - {{type: pin, at: O1, bodies: [0, 3]}}
  given: [{{type: omega, body: 1, value: omega}}]
  find: [v.B, v.M, omega.2, omega.3]
"""


@settings(max_examples=3, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.integers(-179, 180), st.integers(-179, 180))
def test_expressions_come_to_the_numbers(tmp_path: Path, a: int, b: int) -> None:
    path = tmp_path / "file.yaml"
    path.write_text(FOUR_BAR.format(a=a, b=b), encoding="utf-8")
    try:
        case = ExerciseCase(catalogue.load(path))
    except AssignmentError:
        assume(False)
    motion, board = case.exercise.motion, case.literal
    assume(all(1e-3 < abs(motion.omega(body)) < 1e3 for body in motion.system.bodies))
    assert board is not None
    for asked in case.exercise.asked:
        found = board[asked.id]
        assert found is not None
        number = abs(motion.v(asked.of)) if asked.what == "v" else abs(motion.omega(asked.body))
        assert float(evaluate(found, board.at)) == pytest.approx(number, rel=1e-8, abs=1e-9)
