"""Slips of writing down are told by their own names, cost no more than their values, and make nobody a cheat."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from reportgen.cases import opened
from reportgen.marking.judging import mark
from reportgen.marking.marking_data import Marking
from reportgen.marking.marking_policy import Policy
from reportgen.marking.marking_scheme import MarkingScheme
from reportgen.marking.mistakes import AGREED, Mistake
from tests.marking import students

WORKED = (4, 12)


@pytest.fixture(scope="module")
def scheme() -> MarkingScheme:
    return students.scheme("engine-twin-05", WORKED)


def marked(scheme: MarkingScheme, cell: Callable[[students.Row, int, float], float | None]) -> Marking:
    """A right sheet of three figures with what `cell` makes of it."""
    return mark(scheme, students.sheet(scheme, lambda row, k, value: cell(row, k, students.figures(value))))


def names(marking: Marking) -> set[str]:
    return {cell.mistake for cell in marking.first_errors}


def test_two_figures_are_no_other_data(scheme: MarkingScheme) -> None:
    """Four intermediate results cut to two figures, all else from them: four marks, and no talk of other data."""
    cut = {"R", "F", "m.2", "m.3"}
    made = {id: (lambda value, _, id=id: value * _cut(scheme, id)) for id in cut}
    marking = mark(scheme, students.written(scheme, students.worked_out(scheme, Mistake("", "R", made))))
    assert names(marking) == {"too-few-figures"}
    assert {cell.id for cell in marking.first_errors} == cut
    assert marking.points == marking.out_of - len(cut)
    assert marking.warnings == ()


def _cut(scheme: MarkingScheme, id: str) -> float:
    value = float(scheme.key.row(id).values[0])
    return students.figures(value, 2) / value


@pytest.mark.parametrize(
    ("name", "measured"),
    [
        ("angle-clockwise", lambda angle: -angle % 360),
        ("angle-from-vertical", lambda angle: (90 - angle) % 360),
        ("angle-from-vertical", lambda angle: (angle - 90) % 360),
    ],
)
def test_angles_by_another_convention(scheme: MarkingScheme, name: str, measured: Callable[[float], float]) -> None:
    marking = marked(scheme, lambda row, k, value: measured(value) if row.id.startswith("dir.") else value)
    found = [cell.mistake for cell in marking.first_errors]
    assert found.count(name) >= AGREED * len(found)


def test_one_angle_shows_no_convention(scheme: MarkingScheme) -> None:
    marking = marked(scheme, lambda row, k, value: -value % 360 if row.id == "dir.v.S2" else value)
    assert "angle-clockwise" not in names(marking)


def test_rows_exchanged(scheme: MarkingScheme) -> None:
    other = {"R.14": "R.05", "R.05": "R.14"}

    def cell(row: students.Row, k: int, value: float) -> float:
        there = scheme.key.row(other.get(row.id, row.id))
        return students.figures(float(there.values[there.at(k)]))

    marking = marked(scheme, cell)
    named = {(one.id, one.mistake) for one in marking.first_errors}
    assert named == {("R.14", "rows-swapped"), ("R.05", "rows-swapped")}
    assert marking.points == marking.out_of - 2 * len(WORKED)


def test_opposite_signs_are_no_exchange(scheme: MarkingScheme) -> None:
    """ω2 = −ω4 where the pins stand opposite: with clockwise as positive, both signs are wrong, not both rows."""
    marking = marked(scheme, lambda row, k, value: -value if row.id.startswith("turn.omega") else value)
    assert names(marking) == {"direction-reversed"}


def test_value_beside_its_cell(scheme: MarkingScheme) -> None:
    row = scheme.key.row("p.3")
    at = students.figures(float(row.values[row.at(4)]))
    marking = marked(scheme, lambda row, k, value: value if row.id != "p.3" else None if k == 4 else at)
    assert [(one.id, one.position, one.mistake) for one in marking.first_errors] == [("p.3", 12, "wrong-column")]
    assert marking.points == marking.out_of - 2


def test_slips_are_named_without_the_guard_too() -> None:
    scheme = students.marking_scheme(opened(students.assignment("four-bar-01", (2,))), Policy(guard=False))
    marking = marked(scheme, lambda row, k, value: students.figures(value, 2) if row.id == "l.BE" else value)
    assert names(marking) == {"too-few-figures"}


def test_a_slip_of_arithmetic_is_no_other_datum(scheme: MarkingScheme) -> None:
    """v_A 12.3 for 13.2 could come from another n or H, but ω1 and R, which stand on them too, are right."""
    marking = marked(scheme, lambda row, k, value: value * 0.932 if row.id == "v.A" else value)
    assert [(one.id, one.mistake) for one in marking.first_errors] == [("v.A", "")]


def test_two_slips_of_arithmetic_are_no_other_variant(scheme: MarkingScheme) -> None:
    """Area and mass both worked out wrongly, all else from them: two marks, not the whole sheet."""
    made = {"F": lambda value, _: value * 0.79, "m.2": lambda value, _: value * 1.21}
    marking = mark(scheme, students.written(scheme, students.worked_out(scheme, Mistake("", "F", made))))
    assert {cell.id for cell in marking.first_errors} == set(made)
    assert marking.points == marking.out_of - 2
    assert marking.warnings == ()


def test_a_plan_at_another_scale_than_the_one_written(scheme: MarkingScheme) -> None:
    """All of the velocity plan 1.6 times as large, the task's μ kept: the plan is right, its scale is not."""

    def cell(row: students.Row, k: int, value: float) -> float:
        on_plan = row.id.startswith("seg.v.") or (row.id.startswith("h.") and row.id.endswith(".p"))
        return value * 1.6 if on_plan else value

    marking = marked(scheme, cell)
    assert [(one.id, one.mistake) for one in marking.first_errors] == [("mu.v", "other-scale")]
    assert marking.points == marking.out_of - 1
