"""Belts between discs, and points at two distances: against textbook ratios and positions moved on by a small time."""

from __future__ import annotations

import cmath
import math
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from reportgen import catalogue
from reportgen.exercise.case import ExerciseCase
from reportgen.exercise.rate_conditions import belt, given_epsilon, given_omega, pin
from reportgen.exercise.rate_solution import InstantMotion, System

DRIVE = """\
kind: plane-motion
parameters:
  points:
    O1: {at: [0 mm, 0 mm]}
    O2: {at: [500 mm, 100 mm]}
    O3: {distances: [{from: O1, distance: 500 mm}, {from: O2, distance: 300 mm}], side: left}
    A: {from: O2, distance: 60 mm, angle: 90 deg}
  bodies:
    1: {disc: {centre: O1, radius: 100 mm}}
    2: {points: [A], disc: {centre: O2, radius: 60 mm}}
    3: {disc: {centre: O3, radius: 120 mm}}
  joints:
    - {type: pin, at: O1, bodies: [0, 1]}
    - {type: pin, at: O2, bodies: [0, 2]}
    - {type: pin, at: O3, bodies: [0, 3]}
    - {type: belt, discs: [1, 2]}
    - {type: belt, discs: [1, 3], crossed: true}
  given:
    - {type: omega, body: 1, value: 6 rad/s}
    - {type: epsilon, body: 1, value: 2 rad/s2}
  find: [omega.2, omega.3, v.A, a.A, eps.2, eps.3]
"""


@pytest.fixture
def drive(tmp_path: Path) -> ExerciseCase:
    path = tmp_path / "drive.yaml"
    path.write_text(DRIVE, encoding="utf-8")
    return ExerciseCase(catalogue.load(path))


def test_open_and_crossed_belts_turn_discs_by_their_radii(drive: ExerciseCase) -> None:
    motion = drive.exercise.motion
    assert (motion.omega(2), motion.epsilon(2)) == (pytest.approx(10), pytest.approx(10 / 3))
    assert (motion.omega(3), motion.epsilon(3)) == (pytest.approx(-5), pytest.approx(-5 / 3))


def test_the_solution_is_written_out(drive: ExerciseCase) -> None:
    kinds = {step.kind for step in drive.worked.steps}
    assert {"belt", "acceleration-rims"} <= kinds
    motion = drive.exercise.motion
    for asked in drive.exercise.asked:
        whole = abs(motion.v(asked.of) if asked.what == "v" else motion.a(asked.of)) if not asked.of_body else 0.0
        if asked.of_body:
            whole = abs(motion.omega(asked.body) if asked.what == "omega" else motion.epsilon(asked.body))
        assert float(drive.ledger[asked.id].values[0]) == pytest.approx(whole, rel=1e-9)


def test_a_point_at_two_distances_is_on_its_side(drive: ExerciseCase) -> None:
    points = drive.exercise.motion.system.points
    first, second, third = (points[name] for name in ("O1", "O2", "O3"))
    assert abs(third - first) == pytest.approx(0.5)
    assert abs(third - second) == pytest.approx(0.3)
    assert ((second - first).conjugate() * (third - first)).imag > 0


@settings(max_examples=40, deadline=None)
@given(st.floats(0.05, 0.3), st.floats(0.05, 0.3), st.booleans(), st.floats(-3, 3), st.floats(-4, 4), st.floats(-4, 4))
def test_a_belt_on_an_arm_that_turns(r1: float, r2: float, crossed: bool, arm: float, omega: float, eps: float) -> None:
    """Seen from the arm the discs turn as 1 : ± r1/r2 (Willis); arm and first disc change their rates as well."""
    d, way = 0.9, cmath.exp(0.7j)
    reach = -r2 if crossed else r2
    out = way * complex((r1 - reach) / d, math.sqrt(1 - ((r1 - reach) / d) ** 2))
    C1, C2 = 0j, d * way
    conditions = (
        *pin("O", C1, 0, 3),
        *pin("O", C1, 0, 1),
        *pin("C", C2, 3, 2),
        *belt("belt", (C1 + r1 * out, C2 + reach * out), (C1, C2), 1, 2),
        given_omega("arm", 3, arm),
        given_epsilon("arm", 3, eps / 2),
        given_omega("disc", 1, omega),
        given_epsilon("disc", 1, eps),
    )
    points = {"O": C1, "C": C2, "A": C2 + r2}
    motion = InstantMotion(System(points, {1: ("O",), 2: ("C", "A"), 3: ("O", "C")}, conditions))
    ratio = r1 / reach
    assert motion.velocities.omega(2) == pytest.approx(arm + ratio * (omega - arm), abs=1e-9)
    # Below 1e-9 of its scale a rate is nothing.
    nothing = 1e-9 * max(motion.steepest / motion.size, 1)
    assert motion.epsilon(2) == pytest.approx(eps / 2 + ratio * (eps - eps / 2), abs=nothing)
