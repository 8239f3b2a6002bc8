"""Laws of loads: what they answer for themselves, and forces whose direction changes with the positions."""

from __future__ import annotations

import ast
import re
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import get_args

import numpy as np
import pytest

import reportgen
from reportgen import api
from reportgen.base.arrays import Complexes, Floats
from reportgen.base.records import replace
from reportgen.derivation import enter_plans
from reportgen.machine import load_laws
from reportgen.machine.analysis import Machine, analyse
from reportgen.machine.gas_pressure import IndicatorTable, StrokeIndicator
from reportgen.machine.kinematics import Motion
from reportgen.machine.load_laws import (
    AngleLaw,
    ConstantLaw,
    GasLaw,
    Law,
    Opposing,
    Stroke,
    TableLaw,
    TravelLaw,
    by_stroke,
    opposing,
)
from reportgen.machine.loads import Applied

ROOMS = Path(reportgen.__file__).parent
FOUR_BAR = ROOMS.parent / "assignments" / "four-bar-01.yaml"


# --- each question once ---------------------------------------------------------------------------


def law_classes() -> set[str]:
    """The names of all classes of laws and of their tables."""
    return {name for name, kind in vars(load_laws).items() if isinstance(kind, type) and issubclass(kind, Law)} | {
        kind.__name__ for kind in get_args(IndicatorTable)
    }


def asked(text: str, names: set[str]) -> Iterator[int]:
    """The lines of a module that ask whether something is of a class of these names."""
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id in ("isinstance", "type"):
            found = {inner.id for part in node.args for inner in ast.walk(part) if isinstance(inner, ast.Name)}
        elif isinstance(node, ast.MatchClass):
            found = {inner.id for inner in ast.walk(node.cls) if isinstance(inner, ast.Name)}
        else:
            continue
        if found & names:
            yield node.lineno if isinstance(node, ast.Call) else node.cls.lineno


def test_a_question_about_a_class_is_noticed() -> None:
    text = (
        "isinstance(a.law, (int, TableLaw))\nmatch a:\n    case TravelLaw():\n        TableLaw(a)\nisinstance(a, str)\n"
    )
    assert sorted(asked(text, law_classes())) == [1, 3]


def test_no_room_asks_which_law_a_load_has() -> None:
    """What is to be said of a law it says itself, so that a further law changes no other room."""
    names = law_classes()
    assert {"TableLaw", "GasLaw", "Opposing", "StrokeIndicator"} <= names
    anywhere = re.compile("|".join(names))
    told = {path: path.read_text(encoding="utf-8") for path in ROOMS.rglob("*.py") if path.parent.name != "machine"}
    assert not [
        f"{path.relative_to(ROOMS)}:{line}"
        for path, text in told.items()
        if anywhere.search(text)
        for line in asked(text, names)
    ]


COURSE = Stroke(link=3, rod=2, pin="B", crank_pin="A", top=1j, bottom=0j, top_angle=0.0, bottom_angle=np.pi, phase=0.0)


@pytest.mark.parametrize(
    ("law", "constant", "acts", "rows"),
    [
        (ConstantLaw(5.0), True, True, None),
        (Opposing(5.0, (0.0, np.pi), 1.0), False, True, None),
        (AngleLaw((0.0, 2 * np.pi), (3.0, 3.0)), True, True, 1),
        (AngleLaw((0.0, 2 * np.pi), (3.0, 4.0)), False, True, 1),
        (TravelLaw((0.0, 0.1), (0.0, 0.0), 0.1), True, False, 1),
        (TableLaw(COURSE, by_stroke((0.0, 1.0), (2.0, 2.0), (0.0, 0.0)), turns=1), False, True, 2),
        (TableLaw(COURSE, by_stroke((0.0, 1.0), (2.0, 2.0), (2.0, 2.0)), turns=1), True, True, 2),
        (GasLaw(COURSE, StrokeIndicator((0.0, 1.0), *[(1e5, 0.0)] * 4), area=1e-2), False, True, 4),
    ],
)
def test_what_a_law_says(law: Law, constant: bool, acts: bool, rows: int | None) -> None:
    """A size is constant where only one is given; a table of one turn has two strokes, of two turns four."""
    assert (law.constant, law.acts) == (constant, acts)
    assert (None if law.tabled is None else len(law.tabled.rows)) == rows


# --- directions that change -----------------------------------------------------------------------


@pytest.fixture(scope="module")
def followed() -> Machine:
    """A four-bar whose force on C stays square to the rocker DC, as that of a hydraulic jet or a cam would."""

    def square(motion: Motion) -> Complexes:
        arm = motion.points["C"].p - motion.points["D"].p
        return 1j * arm / np.abs(arm)

    machine = api.analyse(api.load(FOUR_BAR)).machine
    return replace(machine, applied=(Applied("P3", 3, "C", square, ConstantLaw(100.0)),), torques=(), idle=())


def test_a_force_that_follows_its_link_has_a_constant_moment(followed: Machine) -> None:
    """Square to DC it turns the rocker with P·DC wherever the rocker stands, so its power is P·DC·ω₃."""
    analysis = analyse(followed)
    (load,) = analysis.applied
    motion = analysis.motion
    arm = float(np.abs(motion.points["C"].p - motion.points["D"].p)[0])
    assert np.ptp(np.angle(load.force)) > 0.1
    assert load.moment(motion.points["D"].p) == pytest.approx(np.full(followed.positions, 100.0 * arm))
    assert load.power(motion) == pytest.approx(100.0 * arm * motion.links[3].omega)
    assert analysis.torque == pytest.approx(analysis.torque_by_work, abs=1e-9 * np.abs(analysis.torque).max())
    # The rocker comes back to where it was, so a moment that is constant does no work over the turn.
    assert analysis.summary.work == pytest.approx(0.0, abs=1e-9 * 100.0 * arm)


def test_its_force_plans_close(followed: Machine) -> None:
    """The plans lay it in its own direction at each position and come to the torque of the analysis."""
    analysis = analyse(followed)
    q, _ = enter_plans(analysis)
    largest = np.abs(analysis.torque).max()
    assert q.value("M.eq") == pytest.approx(analysis.torque, abs=1e-9 * largest)
    assert np.angle(q.value("sense.P3") / analysis.applied[0].force) == pytest.approx(0.0, abs=1e-12)


# --- reversals ------------------------------------------------------------------------------------

LEAN, OFFSET = 0.3, 0.2
"""λ = R/L and e/L of a slider-crank whose slider stands still where the crank and the coupler are in one line."""


def slider_speed(angle: Floats) -> Floats:
    """ẋ/(Rω) of an offset slider-crank."""
    down = LEAN * np.sin(angle) - OFFSET
    return -np.sin(angle) - down * np.cos(angle) / np.sqrt(1 - down**2)


def dead_centres() -> tuple[float, float]:
    """The crank angles at which sin θ = e/(L ± R)."""
    return float(np.arcsin(OFFSET / (1 + LEAN))), float(np.pi + np.arcsin(OFFSET / (1 - LEAN)))


@pytest.mark.parametrize("shape", [lambda rate: rate, np.sign, lambda rate: np.where(np.abs(rate) > 1e-12, rate, 0.0)])
@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_a_load_turns_where_the_motion_does(shape: Callable[[Floats], Floats], sense: float) -> None:
    """The places are those of the geometry, also of a rate that only has a sign (to the distance that counts as none)
    or that is 0 where it is rounding.
    """
    load = opposing(2.0, lambda angle: shape(sense * slider_speed(angle)))
    np.testing.assert_allclose(load.reversals, dead_centres(), atol=4e-9 if shape is np.sign else 1e-12)
    assert load.before == sense


def test_reversals_of_a_smooth_motion_take_few_solutions_of_it() -> None:
    """One over the turn, and one for each power of the width of an interval: w², w⁴, w⁸ with w = half a degree."""
    calls = 0

    def rate(angle: Floats) -> Floats:
        nonlocal calls
        calls += 1
        return slider_speed(angle)

    opposing(1.0, rate)
    assert calls == 4
