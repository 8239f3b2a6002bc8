"""Stock answers earn nothing, whatever follows from what in them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from reportgen.answers.key import Key
from reportgen.grading.marking import mark
from reportgen.grading.marks import Policy, Verdict
from reportgen.grading.mistakes import Mistake
from reportgen.grading.working import Guide
from tests.grading import students

WORKED = (4, 12)
OTHERS = (
    {"H": "100 mm", "n": "2000 rpm"},
    {"lambda": "1/3.8", "D": "95 mm"},
    {"G2": "24 N", "G3": "18 N", "D": "102 mm"},
)


@pytest.fixture(scope="module")
def mine() -> Guide:
    return students.guide("engine-twin-05", WORKED)


def other(**parameters: str) -> Guide:
    return students.open_guide(students.assignment("engine-twin-05", WORKED, **parameters))


def named(key: Key, id: str) -> Key:
    return replace(key, id=id)


@pytest.mark.parametrize("value", [0.0, 1.0, 50.0])
def test_one_number_throughout(mine: Guide, value: float) -> None:
    marking = mark(mine, students.sheet(mine, lambda row, k, _: value))
    assert marking.points == 0
    assert marking.warnings == ("stock",)


@pytest.mark.parametrize("parameters", OTHERS)
def test_sheet_of_an_unknown_variant(mine: Guide, parameters: dict[str, str]) -> None:
    copied = students.sheet(other(**parameters), lambda row, k, value: students.figures(value))
    marking = mark(mine, copied)
    assert marking.points == 0
    assert marking.warnings == ("other-variant",)


@pytest.mark.parametrize("parameters", [*OTHERS, {"H": "100 mm"}, {"n": "2100 rpm"}])
def test_sheet_of_a_classmate(mine: Guide, parameters: dict[str, str]) -> None:
    theirs = other(**parameters)
    copied = students.sheet(theirs, lambda row, k, value: students.figures(value))
    marking = mark(mine, copied, [mine.key, named(theirs.key, "SV02")])
    assert marking.points == 0
    assert marking.warnings in (("classmate",), ("other-variant",))
    assert {name for cell in marking.cells for name in cell.classmates} == {"SV02"}


def test_own_sheet_is_nobody_elses(mine: Guide) -> None:
    """Values that two variants share (lengths on plans of one shape) flag nobody."""
    keys = [named(other(**parameters).key, f"SV{number}") for number, parameters in enumerate(OTHERS)]
    marking = mark(mine, students.sheet(mine, lambda row, k, value: students.figures(value)), keys)
    assert marking.points == marking.out_of
    assert marking.warnings == ()


def test_few_values_of_a_classmate_are_flagged(mine: Guide) -> None:
    """Four reactions taken from another's key: they are wrong, flagged, and what follows from them earns nothing."""
    theirs = other(H="120 mm")
    taken = {"v.B", "a.B", "Pqt3", "omega.2"} | {"turn.omega.2", "v.BA", "a.S2"}

    def cell(row: students.Row, k: int, value: float) -> float:
        return float(theirs.key.row(row.id).values[row.at(k)]) if row.id in taken else value

    marking = mark(mine, students.sheet(mine, cell), [named(theirs.key, "SV02")])
    flagged = {cell.id for cell in marking.cells if cell.classmates}
    assert {"v.B", "a.B", "v.BA", "a.S2"} <= flagged <= taken
    assert all(cell.points == 0 for cell in marking.cells if cell.classmates)


def test_constant_row(mine: Guide) -> None:
    """One number for a velocity that varies over eight positions earns nothing, not even where it is right."""
    guide = students.guide("engine-twin-05")
    value = float(guide.key.row("v.B").values[3])
    marking = mark(guide, students.sheet(guide, lambda row, k, right: value if row.id == "v.B" else right))
    assert marking.warnings == ("constant",)
    verdicts = {cell.verdict for cell in marking.cells if cell.id == "v.B"}
    assert verdicts == {Verdict.wrong, Verdict.implausible}
    assert all(cell.points == 0 for cell in marking.cells if cell.id == "v.B")


def test_value_out_of_proportion(mine: Guide) -> None:
    """From a radius of 7.3 m everything would follow; nothing of it is earned."""
    mistake = Mistake("", "R", {"R": lambda value, _: value * 0 + 7.3})
    marking = mark(mine, students.written(mine, students.worked_out(mine, mistake)))
    assert "proportion" in marking.warnings
    assert all(cell.verdict is not Verdict.follows for cell in marking.cells)


def test_shared_scatter_is_no_attack(mine: Guide) -> None:
    """Random numbers meet a wide band now and then, and earn next to nothing."""
    rng = np.random.default_rng(7)
    marking = mark(mine, students.sheet(mine, lambda row, k, value: float(rng.uniform(0, 100))))
    assert marking.points < 0.06 * marking.out_of


def test_guard_can_be_left_out(mine: Guide) -> None:
    trusting = replace(mine, policy=Policy(guard=False))
    copied = students.sheet(other(H="100 mm", n="2000 rpm"), lambda row, k, value: students.figures(value))
    marking = mark(trusting, copied)
    assert marking.points > 0
    assert marking.warnings == ()
