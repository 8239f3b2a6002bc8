"""Whoever takes every sign as the words beside its row say loses nothing; where they say nothing, any sign is right.

The values are put together from the vectors of `reportgen solve` by what stands on the sheet, not from the ledger.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import pytest

from reportgen.case.answer_key import KeyRow
from reportgen.cases import MachineCase, open_case
from reportgen.marking.judging import mark
from reportgen.marking.marking_data import Marking, Verdict
from reportgen.marking.marking_scheme import MarkingScheme, marking_scheme
from reportgen.results import results as results_of
from tests.lanes import matrix
from tests.marking import students

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
DEGREE = np.pi / 180
TURN_OF_X = "positive along y, which is x turned by 90° in the direction of rotation"


def opened(name: str) -> tuple[MarkingScheme, list[Position]]:
    """The guide of an English sheet and the vectors at its positions."""
    assignment = students.assignment(name, WORKED).with_language("en")
    case = MachineCase(assignment)
    fixed = {name: {"p": [at.real, at.imag]} for name, at in case.analysis.machine.linkage.ground.items()}
    positions = results_of(case)["positions"]
    return marking_scheme(case), [{**one, "points": {**fixed, **one["points"]}} for one in positions]


def vector(pair: list[float]) -> complex:
    return complex(*pair)


def along(vector: complex, axis: complex) -> float:
    return (vector * np.conj(axis / abs(axis))).real


TELLING = ("slider-crank-01", "four-bar-01", "slotted-lever-02")
"""Axes of a guide and of a frame, a lever that swings; the others are for `make proof`."""
OF_THE_SHEET: dict[str, Callable[[Position], complex]] = {
    "positive to the right": lambda _: 1 + 0j,
    "positive upwards": lambda _: 1j,
}
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
    "linkage-8": OF_THE_SHEET,
    "linkage-slide": OF_THE_SHEET,
    "lever-six-bar-01": OF_THE_SHEET,
    # Cylinder C stands at 50° from x.
    "engine-v-01": {
        "positive to the side to which the crank leaves the top dead centre": lambda _: complex(np.exp(140j * DEGREE)),
        "positive away from the crankshaft": lambda _: complex(np.exp(50j * DEGREE)),
    },
    "slotted-lever-02": {},
}
"""The axes that the words of closed formulas speak of, as one draws them."""


def place(one: Position, point: str) -> complex:
    return vector(one["points"][point]["p"])


def of_the_v_engine(row: KeyRow, one: Position) -> float | None:
    """The joint D and its motion by the axis of cylinder E, at 70° from x; the engine turns anticlockwise."""
    axis = complex(np.exp(1j * np.radians(70.0)))
    side, joint = 1j * axis, one["points"]["D"]
    ahead = "positive to the side to which the crank leaves the top dead centre of piston 5"
    if row.id in ("f.h", "beta.4"):
        assert row.positive == (ahead if row.id == "f.h" else "positive where h is")
        h = along(vector(joint["p"]), side)
        return h if row.id == "f.h" else float(np.arcsin(h / 0.196))
    if found := re.fullmatch(r"f\.(across|along)\.([va])", row.id):
        assert row.positive == (ahead if found[1] == "across" else "positive away from the crankshaft")
        return along(vector(joint[found[2]]), side if found[1] == "across" else axis)
    return None


def of_the_slotted_lever(row: KeyRow, one: Position) -> float | None:
    """The end D of the lever, and the Coriolis acceleration of the block, 2ω × v along CB."""
    across = 1j * (place(one, "D") - place(one, "C"))
    if row.id in ("f.v.D", "f.a.D.t"):
        assert row.positive == "positive where the lever turns or speeds up anticlockwise"
        return along(vector(one["points"]["D"][row.id[2]]), across)
    if row.id == "f.a.k":
        assert row.positive == "positive along CB turned by 90° anticlockwise"
        sliding = along(vector(one["points"]["B"]["v"]), place(one, "B") - place(one, "C"))
        return 2 * float(one["links"]["3"]["omega"]) * sliding
    return None


def of_the_four_bar(row: KeyRow, one: Position) -> float | None:
    """The entries of both matrices, from the closed loop AB + BC = AD + DC projected on x and y."""
    x = (place(one, "D") - place(one, "A")) / abs(place(one, "D") - place(one, "A"))
    bar = {"A.11": "BC", "A.21": "BC", "A.12": "DC", "A.22": "DC", "B.1": "AB", "B.2": "AB"}.get(row.id)
    if bar is None:
        return None
    own = np.conj(x) * (place(one, bar[1]) - place(one, bar[0]))
    first = row.id in ("A.11", "A.12", "B.1")
    assert row.positive.startswith("sign as in a₁₁ = −BC·sin φ₂" if first else "sign as in a₂₁ = BC·cos φ₂")
    # d/dt of it: −BC sin φ₂ ω₂ + CD sin φ₃ ω₃ = AB sin φ₁ ω₁; BC cos φ₂ ω₂ − CD cos φ₃ ω₃ = −AB cos φ₁ ω₁.
    return float((-own.imag if bar == "BC" else own.imag) if first else (own.real if bar == "BC" else -own.real))


OWN: dict[str, Callable[[KeyRow, Position], float | None]] = {
    "engine-v-01": of_the_v_engine,
    "slotted-lever-02": of_the_slotted_lever,
    "four-bar-01": of_the_four_bar,
}
"""What one machine alone has."""


def signed(name: str, row: KeyRow, one: Position) -> float | None:
    """A quantity with the sign that the words beside its row give it; None for one that is not tried."""
    points, kind = one["points"], row.id.split(".")
    if name in OWN and (own := OWN[name](row, one)) is not None:
        return own
    if found := re.fullmatch(r"(turn|f)\.(omega|eps)\.(\d)", row.id):
        assert row.positive == "positive anticlockwise"
        return float(one["links"][found[3]]["omega" if found[2] == "omega" else "epsilon"])
    if kind[:2] == ["ic", "along"]:
        ends = re.fullmatch(r"positive from (\w+) to (\w+)", row.positive)
        assert ends is not None
        start, end = ends.groups()
        return along(vector(points[kind[3]]["v"]), place(one, end) - place(one, start))
    if found := re.fullmatch(r"R\.(\d\d)\.t", row.id):
        words = re.fullmatch(r"positive along ([A-Z]\w*?)([A-Z]\w*) turned by 90° anticlockwise", row.positive)
        assert words is not None, row.positive
        return along(vector(one["reactions"][f"R{found[1]}"]), 1j * (place(one, words[2]) - place(one, words[1])))
    if (found := re.fullmatch(r"f\.([va])\.([A-Z])", row.id)) and row.positive:
        heading = np.exp(1j * np.radians(HEADINGS[row.positive.removeprefix("positive ")]))
        # The words name the nearest of eight headings of a slider, which moves along its guide.
        motion = vector(points[found[2]][found[1]])
        return float(np.copysign(abs(motion), along(motion, complex(heading))))
    if found := re.fullmatch(r"f\.[xy]\.(\w+)\.([va])", row.id):
        return along(vector(points[found[1]][found[2]]), AXES[name][row.positive](one))
    if row.id in ("M.eq", "M.vw") and "balancing_torque" in one:
        assert row.positive == "positive anticlockwise"
        return float(one["balancing_torque"]["equilibrium"])
    return None


def tried(name: str, turned: float = 1.0) -> tuple[Marking, list[tuple[str, int]]]:
    """The marking of a sheet with the signs of its words, or all of them `turned`, and where it has such signs."""
    scheme, positions = opened(name)
    places: list[tuple[str, int]] = []

    def cell(row: KeyRow, position: int, value: float) -> float:
        own = None if row.single else signed(name, row, positions[position - 1])
        if own is None or abs(own) < 1e-9:
            return value
        places.append((row.id, position))
        return turned * own / scheme.ledger[row.id].how.scale

    return mark(scheme, students.sheet(scheme, cell)), places


@pytest.mark.parametrize("name", matrix(AXES, TELLING))
def test_signs_by_the_words_beside_the_rows_lose_nothing(name: str) -> None:
    marking, places = tried(name)
    assert len({id for id, _ in places}) >= 8
    assert {cell.verdict for cell in marking.cells if cell.given is not None} == {Verdict.right}


@pytest.mark.parametrize("name", matrix(AXES, TELLING))
def test_the_words_decide_the_sign(name: str) -> None:
    marking, places = tried(name, -1.0)
    cells = {(cell.id, cell.position): cell for cell in marking.cells}
    assert all(
        cells[place].verdict is not Verdict.right or abs(cells[place].expected) <= cells[place].band for place in places
    )


@pytest.mark.parametrize(
    "name", matrix(["engine-twin-05", "engine-single-III", "four-bar-01", "linkage-8"], ["engine-single-III"])
)
def test_a_couple_of_inertia_has_either_sign(name: str) -> None:
    """It is asked for as a magnitude; anticlockwise positive, it has the sign that ε has not."""
    scheme, positions = opened(name)

    def cell(row: KeyRow, position: int, value: float) -> float:
        found = re.fullmatch(r"M\.Pqt(\d)", row.id)
        return -np.sign(positions[position - 1]["links"][found[1]]["epsilon"]) * value if found else value

    marking = mark(scheme, students.sheet(scheme, cell))
    assert {cell.given < 0 for cell in marking.cells if cell.id.startswith("M.Pqt") and cell.given} == {True, False}
    assert {cell.verdict for cell in marking.cells if cell.given is not None} == {Verdict.right}


def test_what_is_asked_for_as_a_magnitude_is_right_either_way() -> None:
    scheme, _ = opened("four-bar-01")
    magnitudes = {row.id for row in scheme.key.asked if row.positive == "magnitude"}
    assert {"q.2", "q.3", "M.Pqt2"} <= magnitudes
    marking = mark(scheme, students.sheet(scheme, lambda row, _, value: -value if row.id in magnitudes else value))
    assert {cell.verdict for cell in marking.cells if cell.given is not None} == {Verdict.right}


@pytest.mark.parametrize(
    "name",
    matrix(
        sorted(path.stem for path in students.ASSIGNMENTS.glob("*.yaml")),
        ["four-bar-01", "shaper-03", "engine-twin-05"],
    ),
)
def test_no_sheet_leaves_a_sense_open(name: str) -> None:
    """Whatever can be negative has words: which sense is positive, or that its magnitude is asked for."""
    scheme = students.scheme(name)
    assert [row.id for row in scheme.key.asked if row.open_sense and not row.positive] == []


@pytest.mark.parametrize(
    ("name", "free"),
    [
        ("cam/roller-01", {"cam.c.1", "cam.c.2", "cam.w"}),
        ("cam/shaper-feed", {"cam.w", "cam.m.1", "cam.m.2"}),
        ("gears/pair-equal-sliding", {"gears.dy"}),
        ("gears/train-motor", {"train.N"}),
    ],
)
def test_what_may_be_set_up_the_other_way_round_is_right_so(name: str, free: set[str]) -> None:
    """w = e − s′, the factor y − x_Σ of the tip circle: with the opposite sign, what follows is right as well."""
    scheme = marking_scheme(open_case(students.ASSIGNMENTS / f"{name}.yaml", "en"))
    assert free <= {row.id for row in scheme.key.asked}
    sheet = students.sheet(scheme, lambda row, _, value: -value if row.id in free else value)
    cells = mark(scheme, sheet).cells
    assert {cell.verdict for cell in cells if cell.given is not None} == {Verdict.right}
    assert not any(cell.mistake or cell.elsewhere for cell in cells)
