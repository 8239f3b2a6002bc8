"""The twenty worked examples of a lecture on plane motion of rigid bodies: its printed answers, and two checks of each.

Literal answers hold at the numbers of our files.  Every number is checked by moving the bodies on by a small time, and
the written solution, which goes from body to body, against the linear system, which knows no order.
"""

from __future__ import annotations

import math
from functools import cache
from pathlib import Path

import pytest

from reportgen import catalogue
from reportgen.exercise.case import ExerciseCase
from reportgen.exercise.rate_solution import InstantMotion
from tests.exercise.displaced import Displaced

FOLDER = Path(__file__).parents[2] / "assignments" / "plane-motion"
FILES = sorted(FOLDER.glob("*.yaml"))
ROOT2, ROOT3, ROOT5 = math.sqrt(2), math.sqrt(3), math.sqrt(5)
FREE = {"19"}
"""Only accelerations are known: there is no telling where the plate goes next."""


@cache
def case(name: str) -> ExerciseCase:
    return ExerciseCase(catalogue.load(FOLDER / f"{name}.yaml"))


def motion(name: str) -> InstantMotion:
    return case(name).exercise.motion


def size(name: str, id: str) -> float:
    """The size of what is found, SI."""
    what, of = id.split(".")
    found = motion(name)
    if what in ("omega", "eps"):
        return abs(found.omega(int(of)) if what == "omega" else found.epsilon(int(of)))
    return abs(found.v(of) if what == "v" else found.a(of))


# Exercise, quantity, its published value, half a unit of its last printed digit; literal ones with our numbers put in.
EXACT = 1e-9
PRINTED = [
    ("01", "v.B", 0.10 * ROOT3, EXACT),
    ("01", "omega.1", 1.0, EXACT),
    ("01", "v.M", 0.10, EXACT),
    ("02", "v.A", 2 * 0.3, EXACT),
    ("02", "omega.2", 2 * 0.3 / 0.1, EXACT),
    ("02", "v.B", ROOT2 * 0.6, EXACT),
    ("02", "v.C", 2 * 0.6, EXACT),
    ("03", "v.B", 0.10 * ROOT3, EXACT),
    ("04", "omega.1", 1.0, EXACT),
    ("04", "v.M", 0.10, EXACT),
    ("05", "v.A1", 0.0, EXACT),
    ("05", "v.A2", 2 * ROOT2, EXACT),
    ("05", "v.A3", 2 * 2.0, EXACT),
    ("05", "v.A4", 2 * ROOT2, EXACT),
    ("06", "omega.2", 2 / 3 * 3, EXACT),
    ("06", "v.B", 0.2 * 3, EXACT),
    ("06", "v.D", ROOT5 / 2 * 0.2 * 3, EXACT),
    ("07", "v.D", 0.60 / ROOT3, EXACT),
    ("07", "omega.1", 2 / ROOT3, EXACT),
    ("09", "v.B", ROOT3 * 0.1 * 3, EXACT),
    ("09", "omega.4", ROOT3 * 3 / 3, EXACT),
    ("09", "v.C", 0.1 * 3, EXACT),
    ("10", "omega.2", 2 * ROOT3 * 0.1 * 6 / (3 * 0.3), EXACT),
    ("10", "v.B", ROOT3 * 0.1 * 6 / 3, EXACT),
    ("10", "v.C", ROOT3 * 0.1 * 6 / 3, EXACT),
    ("10", "omega.4", ROOT3 * 0.1 * 6 / (3 * 0.3), EXACT),
    ("11", "v.A", 0.2, EXACT),
    ("11", "omega.2", 1.072, 0.0005),
    ("11", "v.D", 0.254, 0.0005),
    ("12", "omega.1", (0.12 + 0.18) * 0.15 * 0.5 / (0.08 * 0.18 * 0.15 - 0.05 * 0.12 * 0.1), EXACT * 100),
    ("13", "omega.4", (0.4 * 0.2 - 0.1 * 0.3) / (0.3**2 + 0.2**2), EXACT),
    ("13", "v.C", (0.12 * 0.4 * 0.2 + 0.3 * (0.3 - 0.12) * 0.1) / 0.3**2, EXACT),
    ("14", "omega.1", 2 / 0.3, EXACT),
    ("14", "eps.1", 3 / 0.3, EXACT),
    ("15", "a.A1", 2**2 / 0.3, EXACT),
    ("16", "omega.3", 0.0, EXACT),
    ("16", "a.B", 5 / 2 * 0.1 * 4**2, EXACT),
    ("16", "eps.3", ROOT3 / 2 * 4**2, EXACT),
    ("17", "omega.2", 0.5, EXACT),
    ("17", "v.C", 0.050 * ROOT2, EXACT),
    ("17", "a.C", 0.1075, 0.00005),
    ("18", "v.A", 2.0, EXACT),
    ("18", "omega.2", 2.0, EXACT),
    ("18", "a.B", 5.66, 0.005),
    ("18", "eps.2", 16.0, EXACT),
    ("19", "omega.1", ROOT2, EXACT),
    ("19", "eps.1", 2.0, EXACT),
    ("19", "a.C", 0.040 * ROOT2, EXACT),
    ("20", "v.A", 3.0, EXACT),
    ("20", "omega.2", 3 / 4, EXACT),
]


def test_every_example_is_there() -> None:
    assert [path.stem for path in FILES] == [f"{number:02d}" for number in range(1, 21)]
    assert all(catalogue.check(path) == [] for path in FILES)


@pytest.mark.parametrize(("name", "id", "value", "tolerance"), PRINTED)
def test_published_answers(name: str, id: str, value: float, tolerance: float) -> None:
    assert size(name, id) == pytest.approx(value, rel=0, abs=tolerance)


def test_published_directions() -> None:
    """v_M of the trammel at 60°; a_C at 80.54° to CD; a_C of the wheel to its centre; a_C of the plate at 45° to CD."""
    assert math.degrees(math.atan2(motion("01").v("M").imag, motion("01").v("M").real)) == pytest.approx(60)
    points, a = motion("17").system.points, motion("17").a("C")
    way = points["D"] - points["C"]
    between = math.degrees(math.acos((way.conjugate() * a).real / abs(way) / abs(a)))
    assert between == pytest.approx(80.54, abs=0.005)
    assert motion("15").a("A1") == pytest.approx(1j * abs(motion("15").a("A1")))
    assert motion("19").a("C") == pytest.approx(0.04 - 0.04j)
    # Anticlockwise, as the source has it for a1 b2 r2 > a2 b1 r1.
    assert motion("12").omega(1) > 0
    assert motion("18").a("B").real < 0


def test_the_press_that_is_only_posed() -> None:
    """v_F = v_A/cos δ, as the normals of D and E give it, with tan δ = r/l."""
    assert size("08", "v.F") == pytest.approx(4 * math.pi * 0.1 / math.cos(math.atan(0.1 / 0.4)))


def test_the_last_example_is_finished() -> None:
    """ε of the slotted bar from its angle φ(x) = atan(h/x): φ' = −h ẋ/(x² + h²), with A's own coordinates."""
    found = motion("20")
    arm = found.system.points["A"] - found.system.points["O"]
    x, y = arm.real, arm.imag
    v, a = found.v("A"), found.a("A")
    moment, square = x * v.imag - y * v.real, x**2 + y**2
    rate = x * a.imag - y * a.real
    expected = rate / square - moment * 2 * (x * v.real + y * v.imag) / square**2
    assert found.epsilon(2) == pytest.approx(expected)
    assert found.epsilon(2) == pytest.approx(5 / 16)


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_bodies_move_on_as_their_rates_say(path: Path) -> None:
    """Five positions of the whole system around the instant, by the geometry of its joints alone."""
    if path.stem in FREE:
        pytest.skip("only its accelerations are known")
    found, moved = motion(path.stem), Displaced(path)
    step = 2e-3 * found.size / found.fastest
    for name in found.system.points:
        if found.system.body_of(name):
            v, a = moved.point(name, step)
            assert found.v(name) == pytest.approx(v, abs=1e-8 * found.fastest)
            if moved.accelerated:
                assert found.a(name) == pytest.approx(a, abs=1e-6 * found.fastest**2 / found.size)
    for body in found.system.bodies:
        omega, eps = moved.turn(body, step)
        assert found.omega(body) == pytest.approx(omega, abs=1e-8 * found.fastest / found.size)
        if moved.accelerated:
            assert found.epsilon(body) == pytest.approx(eps, abs=1e-6 * (found.fastest / found.size) ** 2)


@pytest.mark.parametrize("name", sorted(path.stem for path in FILES))
def test_the_written_steps_come_to_the_same(name: str) -> None:
    """Every velocity, acceleration and rotation on the derivation has the size that the linear system gives it."""
    ledger = case(name).worked.ledger
    values = ledger.evaluate()
    compared = 0
    for id in ledger.families:
        what, _, of = id.partition(".")
        known = of in motion(name).system.points if what in ("v", "a") else what in ("omega", "eps")
        if known and not (what == "v" and name in FREE):
            assert float(values[id][0]) == pytest.approx(size(name, id), abs=1e-9, rel=1e-9), id
            compared += 1
    assert compared >= len([one for one in case(name).exercise.asked if one.what != "centre"])
