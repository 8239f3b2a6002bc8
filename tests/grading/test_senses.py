"""Whoever takes every sign as the words beside its row say loses nothing; where they say nothing, any sign is right.

The values are put together from the vectors of `reportgen solve` by what stands on the sheet, not from the ledger.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import pytest

from reportgen.answers.key import Row
from reportgen.answers.results import results
from reportgen.case import Case
from reportgen.grading.marking import mark
from reportgen.grading.marks import Marking, Verdict
from reportgen.grading.working import Guide, open_guide
from tests.grading import students

Position = Mapping[str, Any]
WORKED = (2, 4, 7)

HEADINGS = {
    "to the right": 0,
    "to the right and up": 45,
    "upwards": 90,
    "to the left and up": 135,
    "to the left": 180,
    "to the left and down": 225,
    "downwards": 270,
    "to the right and down": 315,
}
TURN_OF_X = "positive along y, which is x turned by 90° in the direction of rotation"


def opened(name: str) -> tuple[Guide, list[Position]]:
    """The guide of an English sheet and the vectors at its positions."""
    assignment = students.assignment(name, WORKED).with_language("en")
    guide = open_guide(assignment)
    fixed = {name: {"p": [at.real, at.imag]} for name, at in guide.analysis.machine.linkage.ground.items()}
    return guide, [{**one, "points": {**fixed, **one["points"]}} for one in results(Case(assignment))["positions"]]


def vector(pair: list[float]) -> complex:
    return complex(*pair)


def along(vector: complex, axis: complex) -> float:
    return (vector * np.conj(axis / abs(axis))).real


AXES: dict[str, dict[str, Callable[[Position], complex]]] = {
    "engine-twin-05": {
        # The crank leaves its upper dead centre to the left: it turns anticlockwise.
        "positive to the side to which the crank leaves the top dead centre": lambda _: -1 + 0j,
        "positive away from the crankshaft": lambda _: 1j,
    },
    # This one turns clockwise.
    "engine-single-III": {"positive along x, upwards": lambda _: 1j, TURN_OF_X: lambda _: 1 + 0j},
    "slider-crank-01": {"positive along x, away from the crank": lambda _: 1 + 0j, TURN_OF_X: lambda _: 1j},
    "four-bar-01": {
        "positive along x, from A to D": lambda one: place(one, "D") - place(one, "A"),
        TURN_OF_X: lambda one: 1j * (place(one, "D") - place(one, "A")),
    },
    "linkage-8": {},
    "linkage-slide": {},
}
"""The axes that the words of closed formulas speak of, as one draws them."""


def place(one: Position, point: str) -> complex:
    return vector(one["points"][point]["p"])


def signed(name: str, row: Row, one: Position) -> float | None:
    """A quantity with the sign that the words beside its row give it; None for one that is not tried."""
    points, kind = one["points"], row.id.split(".")
    if found := re.fullmatch(r"(turn|f)\.(omega|eps)\.(\d)", row.id):
        assert row.positive == "positive anticlockwise"
        return float(one["links"][found[3]]["omega" if found[2] == "omega" else "epsilon"])
    if kind[:2] == ["ic", "along"]:
        start, end = re.fullmatch(r"positive from (\w+) to (\w+)", row.positive).groups()  # type: ignore[union-attr]
        return along(vector(points[kind[3]]["v"]), place(one, end) - place(one, start))
    if found := re.fullmatch(r"R\.(\d\d)\.t", row.id):
        words = re.fullmatch(r"positive along ([A-Z]\w*?)([A-Z]\w*) turned by 90° anticlockwise", row.positive)
        assert words is not None, row.positive
        return along(vector(one["reactions"][f"R{found[1]}"]), 1j * (place(one, words[2]) - place(one, words[1])))
    if (found := re.fullmatch(r"f\.([va])\.([A-Z])", row.id)) and row.positive:
        heading = np.exp(1j * np.radians(HEADINGS[row.positive.removeprefix("positive ")]))
        return along(vector(points[found[2]][found[1]]), complex(heading))
    if found := re.fullmatch(r"f\.[xy]\.(\w+)\.([va])", row.id):
        return along(vector(points[found[1]][found[2]]), AXES[name][row.positive](one))
    if row.id in ("M.eq", "M.vw") and "balancing_torque" in one:
        assert row.positive == "positive anticlockwise"
        return float(one["balancing_torque"]["equilibrium"])
    return None


def tried(name: str, turned: float = 1.0) -> tuple[Marking, list[tuple[str, int]]]:
    """The marking of a sheet with the signs of its words, or all of them `turned`, and where it has such signs."""
    guide, positions = opened(name)
    places: list[tuple[str, int]] = []

    def cell(row: Row, position: int, value: float) -> float:
        own = None if row.single else signed(name, row, positions[position - 1])
        if own is None or abs(own) < 1e-9:
            return value
        places.append((row.id, position))
        return turned * own / guide.ledger[row.id].how.scale

    return mark(guide, students.sheet(guide, cell)), places


@pytest.mark.parametrize("name", AXES)
def test_signs_by_the_words_beside_the_rows_lose_nothing(name: str) -> None:
    marking, places = tried(name)
    assert len({id for id, _ in places}) >= 8
    assert {cell.verdict for cell in marking.cells if cell.given is not None} == {Verdict.right}


@pytest.mark.parametrize("name", AXES)
def test_the_words_decide_the_sign(name: str) -> None:
    marking, places = tried(name, -1.0)
    cells = {(cell.id, cell.position): cell for cell in marking.cells}
    assert all(
        cells[place].verdict is not Verdict.right or abs(cells[place].expected) <= cells[place].band for place in places
    )


@pytest.mark.parametrize("name", ["engine-twin-05", "engine-single-III", "four-bar-01", "linkage-8"])
def test_a_couple_of_inertia_has_either_sign(name: str) -> None:
    """It is asked for as a magnitude; anticlockwise positive, it has the sign that ε has not."""
    guide, positions = opened(name)

    def cell(row: Row, position: int, value: float) -> float:
        found = re.fullmatch(r"M\.Pqt(\d)", row.id)
        return -np.sign(positions[position - 1]["links"][found[1]]["epsilon"]) * value if found else value

    marking = mark(guide, students.sheet(guide, cell))
    assert {cell.given < 0 for cell in marking.cells if cell.id.startswith("M.Pqt") and cell.given} == {True, False}
    assert {cell.verdict for cell in marking.cells if cell.given is not None} == {Verdict.right}


def test_a_sense_that_the_sheet_leaves_open_is_right_either_way() -> None:
    guide, _ = opened("engine-v-01")
    left_open = {row.id for row in guide.key.asked if row.open_sense}
    assert {"f.h", "beta.4", "f.across.v"} <= left_open
    assert all(not row.positive for row in guide.key.asked if row.open_sense and not row.id.startswith("M.Pqt"))
    marking = mark(guide, students.sheet(guide, lambda row, _, value: -value if row.id in left_open else value))
    assert {cell.verdict for cell in marking.cells if cell.given is not None} == {Verdict.right}
