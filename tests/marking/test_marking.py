"""Marking follows a student's own values: right sheets, rounded ones, drawn ones, and single slips."""

from __future__ import annotations

import warnings
from collections import Counter

import numpy as np
import pytest

from reportgen.base.records import replace
from reportgen.case.answer_key import KeyRow
from reportgen.cases import open_case, opened
from reportgen.marking.judging import mark
from reportgen.marking.marking_data import Marking, Verdict
from reportgen.marking.marking_policy import Policy
from reportgen.marking.marking_scheme import marking_scheme
from reportgen.marking.mistakes import Mistake
from tests.lanes import matrix
from tests.marking import students

KINDS = (
    "engine-twin-05",
    "engine-single-I",
    "engine-v-01",
    "slider-crank-01",
    "four-bar-01",
    "four-bar-02",
    "lever-six-bar-01",
    "slotted-lever-01",
    "shaper-02",
    "linkage-8",
    "linkage-slide",
    "engine-v-02",
    "slotted-lever-02",
)
TELLING = ("engine-twin-05", "four-bar-02", "slotted-lever-02", "linkage-slide")
"""Two cylinders, rods, a sliding block with a flywheel, a sliding driver; the others are for `make proof`."""
TWIN = "engine-twin-05"
AT = 4


def verdicts(marking: Marking) -> dict[tuple[str, int], Verdict]:
    return {(cell.id, cell.position): cell.verdict for cell in marking.cells}


@pytest.mark.parametrize("name", matrix(KINDS, TELLING))
@pytest.mark.parametrize("digits", [12, 3])
def test_right_sheet_scores_full(name: str, digits: int) -> None:
    """Also with every value rounded to three figures: a correctly rounded value always passes."""
    scheme = students.scheme(name)
    marking = mark(scheme, students.sheet(scheme, lambda row, k, value: students.figures(value, digits)))
    assert marking.points == marking.out_of > 0
    assert {cell.verdict for cell in marking.cells} == {Verdict.right}
    assert marking.warnings == ()


@pytest.mark.parametrize("name", matrix(KINDS, TELLING))
def test_what_the_report_prints_is_right(name: str) -> None:
    """The values of the report's own lines and tables, handed in as they are printed, in every cell."""
    scheme = students.scheme(name)
    printed = students.sheet(scheme, lambda row, k, _: float(row.printed[row.at(k)]))
    marking = mark(scheme, printed)
    assert marking.points == marking.out_of > 0
    assert {cell.verdict for cell in marking.cells if cell.given is not None} == {Verdict.right}
    assert marking.warnings == ()


@pytest.mark.parametrize("name", matrix(KINDS, TELLING))
def test_careful_drawing_is_right(name: str) -> None:
    """Every point off by up to 0.5 mm, every value written with three figures: at most 3 values in 1000 fail.

    A band reaches to three standard deviations of what is inherited (2.7 in 1000 of a normal spread lie
    beyond), and what lies beyond mostly still follows from the student's own values.
    """
    scheme = students.scheme(name)
    counted: Counter[Verdict] = Counter()
    for seed in range(4):
        world = students.worked_out(scheme, drawn=np.random.default_rng(seed))
        counted.update(cell.verdict for cell in mark(scheme, students.written(scheme, world)).cells)
    earned = counted[Verdict.right] + counted[Verdict.follows]
    assert earned >= 0.997 * counted.total()


def slip(id: str, factor: float, name: str = TWIN, policy: Policy | None = None) -> Marking:
    """A sheet on which one value came out wrong, and everything after it was worked out from that."""
    scheme = students.scheme(name, (AT,))
    scheme = scheme if policy is None else replace(scheme, policy=policy)
    world = students.worked_out(scheme, Mistake("", id, {id: lambda value, _: value * factor}))
    return mark(scheme, students.written(scheme, world))


@pytest.mark.parametrize("id", ["R", "v.BA", "seg.v.pb", "a.BA.n", "Pqt2", "R.12.t", "R.14", "h.P3.p"])
def test_wrong_value_costs_its_own_mark_once(id: str) -> None:
    marking = slip(id, 1.37)
    found = verdicts(marking)
    position = 0 if (id, 0) in found else AT
    assert found.pop((id, position)) is Verdict.wrong
    assert marking.points == marking.out_of - 1
    assert {cell.id for cell in marking.first_errors} == {id}
    assert Verdict.follows in found.values()


def test_what_follows_is_named_as_following() -> None:
    """ω₂ = v_BA/l and a_BA^n = v_BA²/l stand on v_BA; v_B, read from the plan, does not."""
    found = verdicts(slip("v.BA", 1.37))
    assert found[("turn.omega.2", AT)] is Verdict.follows
    assert found[("a.BA.n", AT)] is Verdict.follows
    assert found[("v.B", AT)] is Verdict.right


def test_second_slip_costs_a_second_mark() -> None:
    scheme = students.scheme(TWIN, (AT,))
    changes = {"v.BA": lambda value, _: value * 1.4, "eps.2": lambda value, _: value * 1.6}
    marking = mark(scheme, students.written(scheme, students.worked_out(scheme, Mistake("", "", changes))))
    assert marking.points == marking.out_of - 2
    assert [cell.id for cell in marking.first_errors] == ["v.BA"]


def test_policy_gives_a_share_for_following() -> None:
    full, half = slip("v.BA", 1.37), slip("v.BA", 1.37, policy=Policy(follows=0.5))
    following = sum(cell.verdict is Verdict.follows for cell in full.cells)
    assert half.points == full.points - following / 2


def test_weights_by_pattern() -> None:
    scheme = replace(students.scheme(TWIN, (AT,)), policy=Policy(weights={"seg.*": 0.0, "M.eq": 5.0}))
    marking = mark(scheme, students.sheet(scheme, students.right))
    worth = {cell.id: cell.worth for cell in marking.cells}
    assert (worth["seg.v.pb"], worth["M.eq"], worth["v.B"]) == (0.0, 5.0, 1.0)
    assert marking.points == marking.out_of


def test_blank_value_is_replaced_by_the_key() -> None:
    """Whoever leaves v_BA out is judged on ω₂ from the key's v_BA, or from the own length it comes from."""
    scheme = students.scheme(TWIN, (AT,))

    def cell(row: KeyRow, k: int, value: float) -> float | None:
        return None if row.id == "v.BA" else value

    found = verdicts(mark(scheme, students.sheet(scheme, cell)))
    assert found.pop(("v.BA", AT)) is Verdict.blank
    assert set(found.values()) == {Verdict.right}


def test_follows_through_a_blank() -> None:
    """A wrong length ab, v_BA left out, ω₂ worked out from the wrong length: it follows."""
    scheme = students.scheme(TWIN, (AT,))
    world = students.worked_out(scheme, Mistake("", "", {"seg.v.ab": lambda value, _: value * 1.3}))
    filled = students.written(scheme, world)
    values = {place: given for place, given in filled.values.items() if place[0] != "v.BA"}
    found = verdicts(mark(scheme, replace(filled, values=values)))
    assert found[("seg.v.ab", AT)] is Verdict.wrong
    assert found[("turn.omega.2", AT)] is Verdict.follows


@pytest.mark.parametrize("factor", [0.5, 2.0, 1.25])
def test_own_scales_are_the_students_choice(factor: float) -> None:
    """Plans of velocity and force drawn at another μ: longer lengths, the same vectors."""
    scheme = students.scheme(TWIN, (AT,))

    def cell(row: KeyRow, k: int, value: float) -> float:
        if row.id in ("mu.v", "mu.R23"):
            return value * factor
        on_plan = row.id.startswith(("seg.v.", "seg.23.")) or (row.id.startswith("h.") and row.id.endswith(".p"))
        return value / factor if on_plan else value

    marking = mark(scheme, students.sheet(scheme, cell))
    assert marking.points == marking.out_of


def test_wrong_scale_is_a_wrong_value() -> None:
    """μ_v ten times too large with pa as drawn: μ_v is wrong, what is computed with it follows."""
    marking = slip("mu.v", 10.0)
    assert [(cell.id, cell.mistake) for cell in marking.first_errors] == [("mu.v", "thousands-mark")]
    assert marking.points == marking.out_of - 1


def test_kinematics_of_the_first_turn_serve_the_second() -> None:
    """Reactions at position 12 stand on the accelerations of position 4, which the sheet asks for once."""
    scheme = students.scheme(TWIN, (4, 12))
    assert scheme.rows["a.S2"].positions == scheme.rows["Pqt2"].positions == (4,)
    assert scheme.rows["P3"].positions == scheme.rows["R.12"].positions == (4, 12)
    world = students.worked_out(scheme, Mistake("", "", {"a.S2": lambda value, _: value * 1.4}))
    found = verdicts(mark(scheme, students.written(scheme, world)))
    assert found[("a.S2", 4)] is Verdict.wrong
    assert found[("Pqt2", 4)] is found[("R.12", 4)] is found[("R.12", 12)] is Verdict.follows


def test_every_asked_value_is_judged_once() -> None:
    scheme = students.scheme(TWIN, (4, 12))
    marking = mark(scheme, students.sheet(scheme, students.right))
    places = [(cell.id, cell.position) for cell in marking.cells]
    assert len(places) == len(set(places))
    assert set(places) == {(row.id, k) for row in scheme.judged for k in row.positions}


def test_computed_band_holds_three_figures_through_the_chain() -> None:
    """Every value on the way rounded to three figures, each from the rounded ones before.

    All earn; two in a hundred may lie beyond three deviations, where long chains share their errors.
    """
    scheme = marking_scheme(opened(students.assignment(TWIN, (AT,))), Policy(paper=0.0))

    def rounding(value: np.ndarray, _: object) -> np.ndarray:
        return np.array([students.figures(one) for one in value])

    plain = [
        id
        for id, family in scheme.ledger.families.items()
        if not (family.hidden or family.is_plane or family.exact or family.definition is None)
    ]
    world = students.worked_out(scheme, Mistake("", "", dict.fromkeys(plain, rounding)))
    found = verdicts(mark(scheme, students.written(scheme, world)))
    counted = Counter(found.values())
    assert set(counted) <= {Verdict.right, Verdict.follows}
    assert counted[Verdict.right] >= 0.98 * counted.total()


@pytest.mark.parametrize("name", ["four-bar-01", "cam/rocker-flat-01", "gears/pair-equal-sliding"])
def test_any_number_may_stand_on_a_sheet(name: str) -> None:
    """All or a quarter of the values far too large, far too small, or 0: wrong, and neither a warning nor an end."""
    scheme = marking_scheme(open_case(students.ASSIGNMENTS / f"{name}.yaml"))
    right = students.sheet(scheme, students.right)
    for share in (1, 4):
        for number, value in enumerate((1e308, 1e-308, 0.0)):
            values = {
                place: replace(one, value=value) if (k + number) % share == 0 else one
                for k, (place, one) in enumerate(right.values.items())
            }
            with warnings.catch_warnings(action="error"):
                marking = mark(scheme, replace(right, values=values))
            assert marking.points < marking.out_of
