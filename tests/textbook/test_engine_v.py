"""The published V engine with an articulated rod: lAB 91, lBC 253, lBD 66, lDE 196 mm, 60π rad/s, α = 50°, β = 70°."""

from __future__ import annotations

import cmath
import math
import re
from pathlib import Path

import numpy as np
import pytest

from reportgen import api
from reportgen.base.errors import Location
from reportgen.base.yaml_source import MappingNode, Scalar, read_source
from reportgen.base.yaml_values import put, text_of
from reportgen.catalogue import module
from reportgen.machine.analysis import Analysis, analyse
from tests.told import told

FILE = Path(__file__).parents[2] / "assignments" / "engine-v-01.yaml"
ALPHA, BETA = math.radians(50), math.radians(70)


@pytest.fixture(scope="module")
def published() -> Analysis:
    return api.analyse(api.load(FILE))


def test_ten_positions_eight_even_and_the_dead_points_at_50_and_230_degrees(published: Analysis) -> None:
    turned = np.degrees(published.cycle_angle)
    assert turned == pytest.approx([0, 45, 50, 90, 135, 180, 225, 230, 270, 315], abs=1e-9)
    assert published.machine.labels == ("0", "1", "a", "2", "3", "4", "5", "b", "6", "7")
    dead = np.flatnonzero(np.abs(published.motion.points["C"].v) < 1e-9)
    assert [published.machine.labels[k] for k in dead] == ["a", "b"]


def test_both_pistons_top_out_level(published: Analysis) -> None:
    """Printed to 0.1 mm: 344.0 and 343.5 mm from the crank's centre."""
    first, second = (abs(course.top) * 1e3 for course in published.machine.sliders)
    assert first == pytest.approx(344.0, abs=0.05)
    assert second == pytest.approx(343.5, abs=0.05)


def by_hand(phi: float) -> tuple[float, float]:
    """The pistons' distances (m) from A by Pythagoras, D on the line BC."""
    pin = 0.091 * cmath.exp(1j * phi)
    in_first = pin * cmath.exp(-1j * ALPHA)
    first = in_first.real + math.sqrt(0.253**2 - in_first.imag**2)
    piston = first * cmath.exp(1j * ALPHA)
    joint = pin + (piston - pin) * 66 / 253
    in_second = joint * cmath.exp(-1j * BETA)
    return first, in_second.real + math.sqrt(0.196**2 - in_second.imag**2)


def test_the_torque_balances_the_power_of_both_forces(published: Analysis) -> None:
    """M dφ = P_C dx_C + P_E dx_E; sixth-order differences over 0.01 rad are good to 1e-10."""
    step = 0.01
    for phi, torque in zip(published.motion.driver, published.torque, strict=True):
        weights = {1: 3 / 4, 2: -3 / 20, 3: 1 / 60}
        slopes = [
            sum(w * (by_hand(phi + n * step)[i] - by_hand(phi - n * step)[i]) for n, w in weights.items()) / step
            for i in (0, 1)
        ]
        # The forces push inwards, so that moving out needs the torque.
        assert torque == pytest.approx(5600 * slopes[0] + 2200 * slopes[1], abs=1e-6)


def test_closed_formulas_give_the_plans(published: Analysis) -> None:
    from reportgen.derivation import write_ledger

    ledger = write_ledger(published).ledger
    for plan, formula in published.machine.closed_formulas.compared:
        one, other = (np.abs(ledger[id].values) for id in (plan, formula))
        assert one == pytest.approx(other, abs=1e-9 * other.max()), plan


@pytest.mark.parametrize("direction", ["anticlockwise", "clockwise"])
def test_both_rods_on_one_pin(tmp_path: Path, direction: str) -> None:
    """The plain V: with equal rods and masses, cylinder E repeats cylinder C by the angle between them later."""
    path = tmp_path / "v.yaml"
    path.write_text(
        "kind: engine-v\n"
        f"positions: {{count: 12, direction: {direction}}}\n"
        "parameters: {AB: 60 mm, BC: 200 mm, DE: 200 mm, alpha: 30 deg, beta: 90 deg, omega1: 100 rad/s,\n"
        "  G2: 20 N, G3: 15 N, G4: 20 N, G5: 15 N, PC: 100 N, PE: 100 N}\n",
        encoding="utf-8",
    )
    machine = module("engine-v").machine(api.load(path))
    turn = machine.turn
    angles = np.linspace(0.0, 2 * math.pi, 60, endpoint=False)
    one, other = analyse(machine, angles), analyse(machine, np.mod(angles + turn * math.radians(60), 2 * math.pi))
    axis = {"C": cmath.exp(1j * math.radians(30)), "E": 1j}
    for part in ("p", "v", "a"):
        first = getattr(one.motion.points["C"], part) / axis["C"]
        second = getattr(other.motion.points["E"], part) / axis["E"]
        assert second == pytest.approx(first, abs=1e-9 * np.abs(first).max())


# --- positions with labels, and an engine that does no work -----------------------------------------------


def with_worked(tmp_path: Path, worked: str) -> Path:
    """The published engine with other worked positions."""
    path = tmp_path / "v.yaml"
    text = FILE.read_text(encoding="utf-8").replace("worked_positions: [4] ", f"worked_positions: {worked} ")
    path.write_text(text, encoding="utf-8")
    return path


@pytest.mark.parametrize("named", ['["1", a, "2"]', "[2, 3, 4]", '["1", 3, "2"]', "['1', \"a\", 4]"])
def test_a_label_names_its_position_and_a_number_counts_all_of_them(tmp_path: Path, named: str) -> None:
    """The crank has turned 45°, 50° and 90°: the positions 1, a, 2 are the second, third and fourth."""
    path = with_worked(tmp_path, named)
    assert api.load(path).worked_positions == (2, 3, 4)
    (note,) = [problem for problem in api.examine(path, "en") if problem.level == "note"]
    assert (note.location.line, note.location.column) == (7, 21)
    assert "number 2, labelled 1; number 3, labelled a; number 4, labelled 2" in note.message


@pytest.mark.parametrize(
    ("named", "code"),
    [('["9"]', "no-such-label"), ("[c]", "no-such-label"), ("[11]", "no-such-position"), ('[2, "1"]', "repeated")],
)
def test_labels_that_no_position_has(tmp_path: Path, named: str, code: str) -> None:
    """The ten positions are 0, 1, a, 2, 3, 4, 5, b, 6, 7."""
    assert [problem.code for problem in api.check(with_worked(tmp_path, named))] == [code]


def test_labels_stay_labels_when_a_file_is_written_anew(tmp_path: Path) -> None:
    """A class's variant keeps the quotation marks of what is a label, beside a value that it puts in."""
    path = with_worked(tmp_path, '["1", a]')
    text = path.read_text(encoding="utf-8").replace(
        "report:\n", "report: {language: vi, worked_positions: ['1', a]}\n#"
    )
    path.write_text(re.sub(r"\n  (language|course|worked_positions):.*", "", text), encoding="utf-8")
    top = read_source(path).top
    assert isinstance(top, MappingNode)
    changed = put(top, ("report", "language"), Scalar("en", Location("")))
    assert isinstance(changed, MappingNode)
    path.write_text(text_of(changed, path.read_text(encoding="utf-8"), top), encoding="utf-8")
    assert (api.load(path).language, api.load(path).worked_positions) == ("en", (2, 3))


def test_constant_forces_do_no_work_and_check_warns_of_it() -> None:
    """A constant force on a piston that comes back to its place does no work, whatever the lengths."""
    problems = api.examine(FILE, "en")
    assert [(problem.level, problem.code) for problem in problems] == [
        ("note", "positions"),
        ("warning", "engine-without-work"),
    ]
    assert api.check(FILE) == []
    with_gas = FILE.with_name("engine-v-02.yaml")
    assert all(problem.level == "note" for problem in api.examine(with_gas))


def test_the_mean_of_the_positions_is_of_the_even_ones() -> None:
    """Eight even positions; the dead centres a and b are none of them."""
    from reportgen.cases import open_case

    ledger = open_case(FILE).printed
    torque = [ledger.number("M.eq", k).printed for k in (1, 2, 4, 5, 6, 7, 9, 10)]
    # Printed to a thousandth of 1 N·m.
    assert ledger.number("M.mean.positions").printed == pytest.approx(sum(torque) / 8, abs=5.1e-4)


@pytest.mark.proof
def test_the_report_says_why_there_is_no_power() -> None:
    """Summary and conclusion say that the mean torque is zero by construction."""
    text = told(api.document(api.load(FILE, "en")))
    assert text.count("what a combustion engine delivers comes from its indicator diagram") == 2
    with_gas = told(api.document(api.load(FILE.with_name("engine-v-02.yaml"), "en")))
    assert "zero, and with it the mean power" not in with_gas
