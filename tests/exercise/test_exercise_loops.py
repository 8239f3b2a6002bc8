"""Loops of systems with one coordinate: their places hold at any time, and their rates are differences of these."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

from reportgen import api, catalogue
from reportgen.base.errors import AssignmentError
from reportgen.cases import opened
from reportgen.exercise.case import ExerciseCase
from reportgen.exercise.ledger import Worked, work_out
from reportgen.formula import ids, refs
from tests.exercise.displaced import Displaced
from tests.exercise.test_exercise_equations import FILES, OF_SEVERAL, by_equations
from tests.exercise.test_exercise_steps import DRIVEN_SLOT, OFFSET_SLOT
from tests.lanes import matrix
from tests.report import trees
from tests.report.calculator import misses

EXACT = 1e-9
STEP = 1e-4
"""s: differences over it are of the order 1e-8 of the rates off, and floats leave 1e-15/1e-8 of accelerations."""
DIFFERENCES = 1e-5


def by_loops(case: ExerciseCase) -> Worked:
    return work_out(case.exercise, case.words["units"], case.words["symbols"], "equations", True)


# --- over time ------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "file", matrix([one for one in FILES if one.stem not in OF_SEVERAL], [FILES[8], FILES[16], FILES[17]])
)
def test_places_hold_at_any_time_and_differ_by_their_rates(tmp_path: Path, file: Path) -> None:
    """With the angles and ways that the joints alone give some time later, the printed places are those of then."""
    case, moved = opened(api.load(by_equations(file, tmp_path))), Displaced(file)
    worked, system = by_loops(case), case.exercise.motion.system
    ledger = worked.ledger
    turned = {id: int(found["link"]) for id in ledger.families if (found := ids.formula_angle.read(id)) is not None}
    assert set(turned.values()) <= set(system.bodies)

    def placed(time: float) -> dict[str, float]:
        poses = moved.poses(time)
        changes = {id: float(ledger[id].values[0]) + poses[body][1] for id, body in turned.items()}
        return {id: float(values[0]) for id, values in ledger.evaluate(changes).items() if id in ids.formula_coordinate}

    times = [-STEP, 0.0, STEP]
    over_time = [placed(time) for time in times]
    checked = 0
    for id, family in ledger.families.items():
        found = ids.formula_coordinate.read(id)
        if found is None or family.definition is None or any(one in ids.slide_way for one in refs(family.definition)):
            continue
        axis, point = found["axis"], found["line"]

        def part(of: complex, axis: str = axis) -> float:
            return of.real if axis == "x" else of.imag

        for time, values in zip(times, over_time, strict=True):
            there = part(moved.at(moved.poses(time), moved.owner(point), moved.points[point]))
            assert values[id] == pytest.approx(there, abs=EXACT), (id, time)
        before, now, after = (values[id] for values in over_time)
        motion = case.exercise.motion
        if (rate := ids.velocity_component(point, axis)) in ledger:
            difference = (after - before) / (2 * STEP)
            assert float(ledger[rate].values[0]) == pytest.approx(difference, abs=DIFFERENCES * motion.fastest), rate
            checked += 1
        if moved.accelerated and (rate := ids.acceleration_component(point, axis)) in ledger:
            difference = (after - 2 * now + before) / STEP**2
            close = DIFFERENCES * max(motion.steepest, 1.0)
            assert float(ledger[rate].values[0]) == pytest.approx(difference, abs=close), rate
            checked += 1
    assert checked or not any(step.kind == "equations-point" for step in worked.steps)


@pytest.mark.parametrize("file", [one for one in FILES if one.stem not in OF_SEVERAL], ids=lambda file: file.stem)
def test_a_calculator_comes_to_every_line(tmp_path: Path, file: Path) -> None:
    """Formula, numbers and result of every line, as the page has them, with the numbers of the lines before."""
    case = opened(api.load(by_equations(file, tmp_path), "en"))
    shown = [id for step in case.worked.steps for id in (*step.read, *step.ids)]
    ledger = case.worked.printed
    lines = trees.lines((ledger.chain(id, 1) for id in shown if not ledger[id].constructed), "en")
    assert misses(lines) == []
    # Whatever a line is worked out from was given, told before it, or is a length in the list of distances.
    told = {id for id, family in ledger.families.items() if family.definition is None and not _is_read(id)}
    for step in case.worked.steps:
        for id in (*step.read, *step.ids):
            definition = ledger[id].definition
            if definition is not None and step.kind.removeprefix("acceleration-").startswith("equations-"):
                assert {*refs(definition)} <= told | {*step.read, *step.ids}, (step.kind, id)
            told.add(id)


def _is_read(id: str) -> bool:
    return id in ids.formula_angle or id in ids.slide_way or id in ids.loop_distance


# --- at random ------------------------------------------------------------------------------------

SIX_BAR = """\
kind: plane-motion
parameters:
  points:
    O: {{at: [0 m, 0 m]}}
    Q1: {{at: [1 m, 0.1 m]}}
    A: {{from: O, distance: 0.3 m, angle: {0} deg}}
    B: {{from: Q1, distance: 0.6 m, angle: {1} deg}}
    E: {{from: Q1, distance: 0.9 m, angle: {1} deg}}
    M: {{at: [0.4 m, 0.7 m]}}
    F: {{from: E, distance: 1.9 m, on: {{through: M, angle: 20 deg}}}}
  bodies:
    1: {{points: [O, A]}}
    2: {{points: [A, B, M]}}
    3: {{points: [Q1, B, E]}}
    4: {{points: [E, F]}}
    5: {{points: [F]}}
  joints:
    - {{type: pin, at: O, bodies: [0, 1]}}
    - {{type: pin, at: A, bodies: [1, 2]}}
    - {{type: pin, at: B, bodies: [2, 3]}}
    - {{type: pin, at: Q1, bodies: [0, 3]}}
    - {{type: pin, at: E, bodies: [3, 4]}}
    - {{type: pin, at: F, bodies: [4, 5]}}
    - {{type: slider, body: 5, angle: 20 deg}}
  given:
    - {{type: omega, body: 1, value: {2} rad/s}}
    - {{type: epsilon, body: 1, value: {3} rad/s2}}
  find: [v.M, v.F, omega.2, omega.4, a.M, a.F, eps.2, eps.4]
"""
"""Crank, coupler with a point, rocker, rod and slider."""

WHEEL = """\
kind: plane-motion
parameters:
  points:
    C: {{at: [0 m, 0.4 m]}}
    K: {{at: [0 m, 0 m]}}
    A: {{from: C, distance: 0.3 m, angle: {0} deg}}
    B: {{from: A, distance: 1.2 m, on: {{through: K, angle: 0 deg}}}}
    D: {{at: [1.5 m, 0.{1:02d} m]}}
    E: {{from: B, distance: 1 m, angle: 70 deg}}
  bodies:
    1: {{points: [K, A], disc: {{centre: C, radius: 0.4 m}}}}
    2: {{points: [A, B]}}
    3: {{points: [B, E]}}
    4: {{points: [D, E]}}
  joints:
    - {{type: rolling on line, disc: 1, through: K, angle: 0 deg}}
    - {{type: pin, at: A, bodies: [1, 2]}}
    - {{type: slot, point: B, body: 2, angle: 0 deg}}
    - {{type: pin, at: B, bodies: [2, 3]}}
    - {{type: pin, at: E, bodies: [3, 4]}}
    - {{type: pin, at: D, bodies: [0, 4]}}
  given:
    - {{type: velocity, point: C, size: {2} m/s, direction: 0 deg}}
    - {{type: acceleration, point: C, size: {3} m/s2, direction: 0 deg}}
  find: [v.B, v.E, omega.2, omega.3, a.B, eps.2, eps.3, eps.4]
"""
"""A rolling wheel, a rod from its rim to a slider, and a rod and a rocker that the slider moves."""

PLANK = """\
kind: plane-motion
parameters:
  points:
    S: {{at: [0 m, 0 m]}}
    C: {{at: [0.1 m, 0.3 m]}}
    A: {{from: C, distance: 0.2 m, angle: {0} deg}}
    O: {{at: [0.9 m, 0.{1:02d} m]}}
  bodies:
    1: {{points: [S]}}
    2: {{points: [A], disc: {{centre: C, radius: 0.3 m}}}}
    3: {{points: [A, O]}}
  joints:
    - {{type: slider, body: 1, angle: 0 deg}}
    - {{type: rolling on line, disc: 2, on: 1, through: S, angle: 0 deg}}
    - {{type: pin, at: A, bodies: [2, 3]}}
    - {{type: pin, at: O, bodies: [0, 3]}}
  given:
    - {{type: velocity, point: S, size: {2} m/s, direction: 0 deg}}
    - {{type: acceleration, point: S, size: {3} m/s2, direction: 180 deg}}
  find: [v.A, omega.2, omega.3, eps.2, eps.3]
"""
"""A disc that rolls on a moving plank and is held by a rod from its rim."""

IN_A_RING = """\
kind: plane-motion
parameters:
  points:
    O: {{at: [0 m, 0 m]}}
    C: {{from: O, distance: 0.5 m, angle: {0} deg}}
    A: {{from: C, distance: 0.3 m, angle: {1} deg}}
    B: {{at: [1.9 m, 0.2 m]}}
    D: {{at: [1.6 m, 1.1 m]}}
  bodies:
    0: {{disc: {{centre: O, radius: 0.8 m}}}}
    1: {{points: [A], disc: {{centre: C, radius: 0.3 m}}}}
    2: {{points: [A, B]}}
    3: {{points: [D, B]}}
  joints:
    - {{type: rolling on circle, discs: [1, 0]}}
    - {{type: pin, at: A, bodies: [1, 2]}}
    - {{type: pin, at: B, bodies: [2, 3]}}
    - {{type: pin, at: D, bodies: [0, 3]}}
  given:
    - {{type: omega, body: 1, value: {2} rad/s}}
    - {{type: epsilon, body: 1, value: {3} rad/s2}}
  find: [v.C, v.A, v.B, omega.2, omega.3, a.A, a.B, eps.3]
"""
"""A wheel that rolls within a fixed ring, with no arm, and drives a rod and a rocker."""

CORD = """\
kind: plane-motion
parameters:
  points:
    O: {{at: [0 m, 0 m]}}
    A: {{from: O, distance: 0.3 m, angle: {0} deg}}
    Q1: {{at: [1.2 m, 0.{1:02d} m]}}
    B: {{from: Q1, distance: 0.5 m, angle: 75 deg}}
  bodies:
    1: {{points: [O, A]}}
    2: {{points: [Q1, B]}}
  joints:
    - {{type: pin, at: O, bodies: [0, 1]}}
    - {{type: pin, at: Q1, bodies: [0, 2]}}
    - {{type: cord, points: [A, B]}}
  given:
    - {{type: omega, body: 1, value: {2} rad/s}}
    - {{type: epsilon, body: 1, value: {3} rad/s2}}
  find: [v.B, omega.2, a.B, eps.2]
"""
"""A rod of which nothing is asked."""

BELT = """\
kind: plane-motion
parameters:
  points:
    O: {{at: [0 m, 0 m]}}
    C: {{from: O, distance: 1 m, angle: {0} deg}}
    A: {{from: C, distance: 0.1 m, angle: {1} deg}}
    B: {{from: A, distance: 2 m, on: {{through: O, angle: 0 deg}}}}
  bodies:
    0: {{disc: {{centre: O, radius: 0.3 m}}}}
    1: {{points: [O, C]}}
    2: {{points: [A], disc: {{centre: C, radius: 0.2 m}}}}
    3: {{points: [A, B]}}
  joints:
    - {{type: pin, at: O, bodies: [0, 1]}}
    - {{type: pin, at: C, bodies: [1, 2]}}
    - {{type: belt, discs: [0, 2], crossed: true}}
    - {{type: pin, at: A, bodies: [2, 3]}}
    - {{type: slot, point: B, body: 3, angle: 0 deg}}
  given:
    - {{type: omega, body: 1, value: {2} rad/s}}
    - {{type: epsilon, body: 1, value: {3} rad/s2}}
  find: [v.A, v.B, omega.2, omega.3, a.A, a.B, eps.2, eps.3]
"""
"""A wheel on an arm, turned by a crossed belt about a fixed wheel, and a rod from it to a slider."""

CLASS_III = """\
kind: plane-motion
parameters:
  points:
    O: {{at: [0 m, 0 m]}}
    A: {{from: O, distance: 0.2 m, angle: {0} deg}}
    D: {{at: [0.4 m, 0.7 m]}}
    E: {{at: [0.8 m, 0.{1:02d} m]}}
    F: {{at: [0.5 m, 1.1 m]}}
    B: {{at: [1.1 m, 0.2 m]}}
    C: {{at: [0.9 m, 1.5 m]}}
  bodies:
    1: {{points: [O, A]}}
    2: {{points: [A, D]}}
    3: {{points: [B, E]}}
    4: {{points: [D, E, F]}}
    5: {{points: [C, F]}}
  joints:
    - {{type: pin, at: O, bodies: [0, 1]}}
    - {{type: pin, at: A, bodies: [1, 2]}}
    - {{type: pin, at: D, bodies: [2, 4]}}
    - {{type: pin, at: B, bodies: [0, 3]}}
    - {{type: pin, at: E, bodies: [3, 4]}}
    - {{type: pin, at: F, bodies: [4, 5]}}
    - {{type: pin, at: C, bodies: [0, 5]}}
  given:
    - {{type: omega, body: 1, value: {2} rad/s}}
    - {{type: epsilon, body: 1, value: {3} rad/s2}}
  find: [v.D, v.F, omega.2, omega.4, a.D, a.F, eps.3, eps.4]
"""
"""A crank that drives a plate on three rods, of which no two can be solved by themselves."""

COUPLER_GIVEN = """\
kind: plane-motion
parameters:
  points:
    O: {{at: [0 m, 0 m]}}
    A: {{from: O, distance: 0.3 m, angle: {0} deg}}
    B: {{from: A, distance: 1.1 m, on: {{through: O, angle: 0 deg}}}}
    C: {{from: B, distance: 0.{1:02d} m, angle: 90 deg}}
  bodies:
    1: {{points: [O, A]}}
    2: {{points: [A, B]}}
    3: {{points: [B, C]}}
  joints:
    - {{type: pin, at: O, bodies: [0, 1]}}
    - {{type: pin, at: A, bodies: [1, 2]}}
    - {{type: pin, at: B, bodies: [2, 3]}}
    - {{type: slider, body: 3, angle: 0 deg}}
  given:
    - {{type: velocity, point: C, size: {2} m/s, direction: 0 deg}}
    - {{type: acceleration, point: C, size: {3} m/s2, direction: 0 deg}}
  find: [v.A, omega.1, omega.2, a.A, eps.1, eps.2]
"""
"""A piston moves the crank; given is a point of it that its guide is not told by."""

FORMS = [SIX_BAR, WHEEL, PLANK, IN_A_RING, CORD, BELT, CLASS_III, COUPLER_GIVEN, OFFSET_SLOT, DRIVEN_SLOT]
rates = st.integers(-40, 40).filter(bool).map(lambda tenths: tenths / 10)


def drawn(folder: Path, form: str, *numbers: object) -> ExerciseCase:
    path = folder / "file.yaml"
    path.write_text(form.format(*numbers), encoding="utf-8")
    try:
        return ExerciseCase(catalogue.load(path))
    except AssignmentError:
        # At a dead centre, or out of reach.
        assume(False)
        raise


def agrees(case: ExerciseCase) -> None:
    """Everything that is asked is found, and every rate of bodies and points is that of the whole system's solution."""
    motion, worked = case.exercise.motion, by_loops(case)
    assert not worked.missing
    for id, family in worked.ledger.families.items():
        value = family.values[0]
        fast, steep = motion.fastest, motion.steepest
        if found := ids.velocity_component.read(id):
            v = motion.v(found["point"])
            assert value == pytest.approx(v.real if found["axis"] == "x" else v.imag, abs=EXACT * fast), id
        elif found := ids.acceleration_component.read(id):
            a = motion.a(found["point"])
            assert value == pytest.approx(a.real if found["axis"] == "x" else a.imag, abs=EXACT * steep), id
        elif (found := ids.angular_velocity.read(id)) and int(found["link"]) in motion.system.bodies:
            whole = abs(motion.omega(int(found["link"])))
            assert value == pytest.approx(whole, rel=EXACT, abs=EXACT * fast / motion.size), id
        elif (found := ids.angular_acceleration.read(id)) and int(found["link"]) in motion.system.bodies:
            whole = abs(motion.epsilon(int(found["link"])))
            assert value == pytest.approx(whole, rel=EXACT, abs=EXACT * steep / motion.size), id


@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.sampled_from(FORMS), st.integers(-179, 180), st.integers(10, 90), rates, rates)
def test_loops_come_to_what_the_whole_system_does(
    tmp_path: Path, form: str, one: int, other: int, v: float, a: float
) -> None:
    case = drawn(tmp_path, form, one, other, v, a)
    motion = case.exercise.motion
    # Near a dead centre both lose their figures.
    assume(all(abs(motion.omega(body)) < 1e2 and abs(motion.epsilon(body)) < 1e4 for body in motion.system.bodies))
    agrees(case)


@pytest.mark.parametrize("form", FORMS)
def test_every_form_is_solved_by_its_loops(tmp_path: Path, form: str) -> None:
    """As the one method of its file, too, with a page whose lines hold."""
    asked = form.rstrip() + "\n  methods: [equations]\n"
    case = drawn(tmp_path, asked, 70, 40, 1.5, 2.0)
    agrees(case)
    assert not case.worked.missing
    assert misses(trees.lines(trees.every_chain(case.worked.printed), "en")) == []
    assert case.document().blocks
