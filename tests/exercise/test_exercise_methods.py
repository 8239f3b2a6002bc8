"""The methods of plane motion agree: every velocity that one leads to has the size that the linear system gives it."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any, get_args

import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

from reportgen import api, catalogue
from reportgen.base.errors import AssignmentError
from reportgen.document import text_of
from reportgen.exercise import instant_centres
from reportgen.exercise.case import ExerciseCase
from reportgen.exercise.file import Method
from reportgen.exercise.instant_centres import lay_out
from reportgen.exercise.ledger import Worked, belongs, work_out
from reportgen.exercise.plane_motion import why_not
from reportgen.exercise.solution_page import solution

FOLDER = Path(__file__).parents[2] / "assignments" / "plane-motion"
FILES = sorted(FOLDER.glob("*.yaml"))
NOWHERE = {("12", "base point"), ("08", "base point"), ("08", "projection")}
"""Where a method has what it needs and still leads to nothing asked: the lever of 12 has no end to begin at, and only
instant centres tell how D of 8 moves, by which its crank is joined to the rest."""
METHODS: tuple[Any, ...] = get_args(Method)

FOUR_BAR = """\
kind: plane-motion
parameters:
  points:
    O: {{at: [0 m, 0 m]}}
    O1: {{at: [1 m, 0.1 m]}}
    A: {{from: O, distance: 0.3 m, angle: {a} deg}}
    B: {{from: O1, distance: 0.5 m, angle: {b} deg}}
    M: {{at: [{x} m, 0.7 m]}}
  bodies:
    1: {{points: [O, A]}}
    2: {{points: [A, B, M]}}
    3: {{points: [O1, B]}}
  joints:
    - {{type: pin, at: O, bodies: [0, 1]}}
    - {{type: pin, at: A, bodies: [1, 2]}}
    - {{type: pin, at: B, bodies: [2, 3]}}
    - {{type: pin, at: O1, bodies: [0, 3]}}
  given: [{{type: omega, body: 1, value: {rate} rad/s}}]
  find: [v.B, v.M, omega.2, omega.3]
"""
SLIDER_CRANK = """\
kind: plane-motion
parameters:
  points:
    O: {{at: [0 m, 0 m]}}
    A: {{from: O, distance: 0.3 m, angle: {a} deg}}
    B: {{from: A, distance: 0.9 m, on: {{through: O, angle: {b} deg}}}}
    M: {{at: [{x} m, 0.7 m]}}
  bodies:
    1: {{points: [O, A]}}
    2: {{points: [A, B, M]}}
  joints:
    - {{type: pin, at: O, bodies: [0, 1]}}
    - {{type: pin, at: A, bodies: [1, 2]}}
    - {{type: slot, point: B, body: 2, angle: {b} deg}}
  given: [{{type: omega, body: 1, value: {rate} rad/s}}]
  find: [v.B, v.M, omega.2]
"""
WHEEL_WITH_ROD = """\
kind: plane-motion
parameters:
  points:
    C: {{at: [0 m, 0.4 m]}}
    K: {{at: [0 m, 0 m]}}
    A: {{from: C, distance: 0.3 m, angle: {a} deg}}
    B: {{from: A, distance: 1.2 m, on: {{through: K, angle: 0 deg}}}}
    M: {{at: [{x} m, 0.7 m]}}
  bodies:
    1: {{points: [K, A], disc: {{centre: C, radius: 0.4 m}}}}
    2: {{points: [A, B, M]}}
  joints:
    - {{type: rolling on line, disc: 1, through: K, angle: 0 deg}}
    - {{type: pin, at: A, bodies: [1, 2]}}
    - {{type: slot, point: B, body: 2, angle: 0 deg}}
  given: [{{type: velocity, point: C, size: {rate} m/s, direction: 0 deg}}]
  find: [v.A, v.B, v.M, omega.1, omega.2]
"""
"""A wheel that rolls and a rod from its rim to a slider on the ground; b says nothing of it."""


def by(case: ExerciseCase, method: Any, alone: bool = True) -> Worked:
    return work_out(case.exercise, case.words["units"], case.words["symbols"], method, alone)


def agrees(case: ExerciseCase, worked: Worked) -> int:
    """How many velocities and rates are as the linear system has them; fails at the first that is not."""
    motion, compared = case.exercise.motion, 0
    values = worked.ledger.evaluate()
    for id in worked.ledger.families:
        what, _, of = id.partition(".")
        if what == "omega" or (what == "v" and of in motion.system.points):
            found = abs(motion.omega(int(of)) if what == "omega" else motion.v(of))
            scale = motion.fastest / (motion.size if what == "omega" else 1)
            assert float(values[id][0]) == pytest.approx(found, rel=1e-9, abs=1e-9 * scale), (worked.method, id)
            compared += 1
    return compared


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_every_example_by_every_method_that_applies(path: Path, method: Any) -> None:
    case = ExerciseCase(catalogue.load(path))
    if why_not(method, lay_out(case.exercise.given, case.exercise.motion)):
        assert not [step for step in by(case, method).steps if belongs(step, method)]
    elif (path.stem, method) in NOWHERE:
        assert not by(case, method).by_method
    else:
        assert agrees(case, by(case, method)) > 0
        # As the first method it leads to everything that is asked, the others' steps helping it.
        assert by(case, method, alone=False).missing == ()


@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    st.sampled_from([FOUR_BAR, SLIDER_CRANK, WHEEL_WITH_ROD]),
    st.integers(-179, 180),
    st.integers(-179, 180),
    st.integers(2, 9),
    st.integers(-40, 40).filter(bool),
)
def test_all_methods_that_apply_agree(tmp_path: Path, form: str, a: int, b: int, x: int, rate: int) -> None:
    # Above the wheel's centre or below it C tells along which line A moves, but no projection tells how fast.
    assume(form is not WHEEL_WITH_ROD or abs(a) != 90)
    path = tmp_path / "file.yaml"
    path.write_text(form.format(a=a, b=b, x=x / 10, rate=rate / 10), encoding="utf-8")
    try:
        case = ExerciseCase(catalogue.load(path))
    except AssignmentError:
        # At a dead centre, or out of reach.
        assume(False)
    motion = case.exercise.motion
    rates = [motion.omega(body) for body in motion.system.bodies]
    assume(all(1e-3 < abs(one) < 1e3 for one in rates if one))
    applying = [one for one in METHODS if not why_not(one, lay_out(case.exercise.given, motion))]
    assert applying
    for method in applying:
        assert agrees(case, by(case, method)) > 0
        # A point off the line of the others follows from projections, a rotation never does.
        left = set(by(case, method).missing)
        assert not left or (method == "projection" and left <= {"v.M", *(f"omega.{body}" for body in (1, 2, 3))}), left


def test_a_file_may_ask_for_several(tmp_path: Path) -> None:
    text = (FOLDER / "01.yaml").read_text(encoding="utf-8")
    path = tmp_path / "file.yaml"
    path.write_text(
        text.partition("  methods:")[0] + "  methods: [base point, projection, instant centre]\n", encoding="utf-8"
    )
    case = ExerciseCase(catalogue.load(path))
    assert case.worked.method == "base point"
    assert [one.method for one in case.further] == ["projection", "instant centre"]
    kinds = [{step.kind for step in worked.steps} for worked in (case.worked, *case.further)]
    assert kinds[0] >= {"base-rate", "base-point"}
    assert kinds[1] == {"projection"}
    assert kinds[2] >= {"rate-normals", "speed-normals"}
    for worked in (case.worked, *case.further):
        assert float(worked.ledger["v.B"].values[0]) == pytest.approx(0.1 * math.sqrt(3), rel=1e-12)


TRAMMEL = """\
kind: plane-motion
parameters:
  points:
    O: {{at: [0 cm, 0 cm]}}
    A: {{at: [-12 cm, 0 cm]}}
    B: {{at: [0 cm, 9 cm]}}
    M: {{at: {m}}}
  bodies:
    1: {{points: [A, M, B]}}
  joints:
    - {{type: slot, point: A, body: 1, angle: 0 deg}}
    - {{type: slot, point: B, body: 1, angle: 90 deg}}
  given: [{{type: velocity, point: A, size: 9 cm/s, direction: 0 deg}}]
  find: [v.B, v.M, omega.1]
  methods: [base point, projection]
"""
"""A trammel of 3, 4 and 5, turning at 1 rad/s about (-12, 9) cm."""


def trammel(tmp_path: Path, m: str) -> ExerciseCase:
    path = tmp_path / "file.yaml"
    path.write_text(TRAMMEL.format(m=m), encoding="utf-8")
    return ExerciseCase(api.load(path, "en"))


def test_projection_alone_tells_nothing_across_its_line(tmp_path: Path) -> None:
    """Of the middle M of AB it has but the component along AB, and of the rotation nothing: both are said."""
    case = trammel(tmp_path, "[-6 cm, 4.5 cm]")
    base, projection = case.alone
    assert base.missing == ()
    assert projection.missing == ("v.M", "omega.1")
    assert {step.kind for step in projection.steps} == {"projection"}
    page = text_of(solution(case))
    assert "Projection alone cannot give v_M: the point lies on one line" in page
    assert "contains no angular velocity, so that it alone cannot give ω_1" in page


@pytest.mark.parametrize(
    ("m", "v"),
    [("[0 cm, 0 cm]", math.hypot(9, 12)), ("[-12 cm, 4 cm]", 5.0), ("[3 cm, 9 cm]", 15.0), ("[-12 cm, 9 cm]", 0.0)],
    ids=["corner", "above A", "beyond B", "instant centre"],
)
def test_projections_on_two_lines_tell_a_velocity(tmp_path: Path, m: str, v: float) -> None:
    """v = ω · distance from (-12, 9) cm, with ω = 1 rad/s."""
    projection = trammel(tmp_path, m).alone[1]
    assert projection.missing == ("omega.1",)
    assert float(projection.ledger["v.M"].values[0]) == pytest.approx(v / 100, rel=1e-9, abs=1e-12)


@pytest.mark.parametrize("method", ["base point", "projection"])
@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_no_method_borrows_from_instant_centres(path: Path, method: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    """Who knows nothing of normals to velocities finds the same by base points and by projections."""
    case = ExerciseCase(catalogue.load(path))
    own = by(case, method)
    monkeypatch.setattr(instant_centres, "_next_centre", lambda _: False)
    found = [step.ids for step in by(case, method).steps if step.kind != "centre-rate"]
    assert found == [step.ids for step in own.steps if step.kind != "centre-rate"]
