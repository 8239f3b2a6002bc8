"""The bench measures what its names say; no speeds are asserted."""

from __future__ import annotations

import importlib
import json
import shutil
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from bench import batch, growth, measure, page, plain, steps
from bench.__main__ import Bench, Row, table
from bench.closed_form import solve
from bench.growth import Growth
from bench.size import Size, size_of
from bench.solving import compare, machine

from reportgen.document import Equation, Figure, List, Paragraph, Table, Text
from reportgen.drawing import Circle, Label, Line, Scene
from reportgen.formula import Number
from reportgen.machine.analysis import analyse
from tests.lanes import proof

SAMPLE = Path(__file__).parents[1] / "assignments" / "engine-twin-05.yaml"
TINY = Size(pages=3, figures=1, labels=2, strokes=6, formulas=4, tables=1, rows=3, words=30)


def same(found: np.ndarray, expected: np.ndarray) -> bool:
    """Return True if equal to 1e-9 of the quantity's own maximum: far above rounding, far below a formula's error."""
    return bool(np.abs(found - expected).max() <= 1e-9 * np.abs(expected).max())


@pytest.mark.parametrize(
    "changed",
    [
        {},
        {"direction: anticlockwise": "direction: clockwise"},
        {"crank_angle: 180 deg": "crank_angle: 100 deg", "firing: [intake, compression]": ""},
    ],
    ids=["sample", "clockwise", "crank of 100°"],
)
def test_the_closed_form_is_the_engine(tmp_path: Path, changed: dict[str, str]) -> None:
    text = SAMPLE.read_text(encoding="utf-8")
    for old, new in changed.items():
        assert old in text
        text = text.replace(old, new)
    file = tmp_path / "engine.yaml"
    file.write_text(text, encoding="utf-8")
    built, engine = machine(file)
    angles = np.linspace(0, 4 * np.pi, 360, endpoint=False)
    library, by_hand = analyse(built, angles), solve(engine, angles)

    assert same(by_hand.torque, library.torque)
    assert same(by_hand.torque_by_work, library.torque_by_work)
    assert same(by_hand.bearing, library.forces.reactions["R01"].force)
    gas = {load.name: load.force for load in library.applied}
    for side, pin, piston, rod in zip(by_hand.sides, "AC", "BD", (2, 4), strict=True):
        link, points, reactions = library.motion.links[rod], library.motion.points, library.forces.reactions
        assert same(np.exp(1j * side.angle), np.exp(1j * link.angle))
        assert same(side.omega, link.omega)
        assert same(side.epsilon, link.epsilon)
        for k, order in enumerate("pva"):
            assert same(side.pin[k], getattr(points[pin], order))
            assert same(side.centre[k], getattr(points[f"S{rod}"], order))
            assert same(1j * side.piston[k], getattr(points[piston], order))
        assert same(side.gas, np.abs(gas[f"P{rod + 1}"]) * np.sign(side.gas))
        assert same(side.crank_on_rod, reactions[f"R1{rod}"].force)
        assert same(side.piston_on_rod, reactions[f"R{rod + 1}{rod}"].force)
        assert same(side.wall_on_piston, reactions[f"R0{rod + 1}"].force)


def test_solver_and_closed_form_are_both_timed() -> None:
    taken = compare(SAMPLE, positions=16, rounds=1)
    assert set(taken) == {"solver", "motion", "closed form"}
    assert all(time > 0 for time in taken.values())


def test_a_process_costs_time_and_memory(tmp_path: Path) -> None:
    code = "import time; held = bytearray(b'x') * 60_000_000; time.sleep(0.05)"
    cost = measure.run((sys.executable, "-c", code), tmp_path)
    assert cost.seconds > 0.05
    # The array alone takes 60 MB; a bare interpreter well under 60 more, or what this process had before exec.
    assert cost.memory > 60


def test_a_process_that_fails_says_why(tmp_path: Path) -> None:
    with pytest.raises(RuntimeError, match="no such luck"):
        measure.run((sys.executable, "-c", "raise SystemExit('no such luck')"), tmp_path)


def test_tasks_take_turns_and_are_compared_round_by_round() -> None:
    order: list[str] = []
    seconds = iter((1.0, 10.0, 5.0, 30.0, 3.0, 20.0))

    def task(name: str) -> measure.Cost:
        order.append(name)
        return measure.Cost(next(seconds), 1.0)

    costs = measure.in_turns({name: lambda name=name: task(name) for name in "ab"}, 3)
    assert "".join(order) == "ababab"
    assert measure.middle(costs["a"]) == measure.Cost(3.0, 1.0)
    assert measure.ratio(costs["b"], costs["a"]) == 20 / 3  # of 10, 6 and 20/3


def test_runs_one_after_the_other_add_up() -> None:
    costs = iter((measure.Cost(1.0, 5.0), measure.Cost(2.0, 4.0)))
    assert measure.repeated(lambda: next(costs), 2) == measure.Cost(3.0, 5.0)


def test_the_size_of_a_document() -> None:
    scene = Scene(10, 10, (Line(0j, 1j), Circle(0j, 1), Label(0j, "A")))
    blocks = (
        Paragraph((Text("hai từ"),)),
        List(((Equation((Number(1), Number(2))),),)),
        Table((), (), ((), (), ())),
        Figure((scene, scene)),
    )
    assert size_of(blocks, 7) == Size(7, figures=2, labels=2, strokes=4, formulas=2, tables=1, rows=3, words=2)


def test_shares_are_even_and_whole() -> None:
    shares = [list(plain.share(7, 3, k)) for k in range(3)]
    assert [i for part in shares for i in part] == list(range(7))
    assert {len(part) for part in shares} == {2, 3}


@proof
@pytest.mark.skipif(shutil.which("pdflatex") is None, reason="pdflatex is not installed")
def test_the_plain_script_makes_a_document_of_that_size(tmp_path: Path) -> None:
    from dataclasses import asdict

    import pymupdf

    code = (sys.executable, plain.__file__, str(tmp_path), json.dumps(asdict(TINY)))
    measure.run(code, tmp_path)
    with pymupdf.open(tmp_path / "plain.pdf") as pdf:
        assert len(pdf) == TINY.pages
    source = (tmp_path / "plain.tex").read_text(encoding="utf-8")
    assert source.count(r"\begin{equation}") == TINY.formulas
    assert source.count(r"\includegraphics") == TINY.figures
    assert source.count(r"\begin{longtable}") == TINY.tables


def test_both_ways_of_setting_a_source_are_measured(tmp_path: Path) -> None:
    bench = Bench(SAMPLE, tmp_path, ("typst",))
    bench.source("typst").parent.mkdir(parents=True)
    bench.source("typst").write_text("A report.", encoding="utf-8")
    assert bench.typst_alone().seconds > 0
    assert (tmp_path / "alone.pdf").read_bytes().startswith(b"%PDF")


def test_the_table_is_aligned() -> None:
    lines = table([Row("a", "≤ 1.5", "1.20", "words"), Row("longer", "", "12.00")]).splitlines()
    assert len({line.index(end) + len(end) for line, end in zip(lines, ("result", "1.20", "12.00"), strict=True)}) == 1


@proof
def test_a_class_is_made_and_its_workers_memory_taken(tmp_path: Path) -> None:
    group = batch.Class(tmp_path, students=2)
    group.draw()
    cost = group.reports(2)
    assert cost.seconds > 0
    # An interpreter with all libraries takes more than that; without /proc nothing is told.
    assert cost.memory > 30 or not Path("/proc/self/status").exists()


@pytest.mark.proof
def test_a_command_is_taken_apart_into_steps() -> None:
    """Each function that counts as a step exists and is called; steps that no command here needs are excluded."""
    bench = Bench(SAMPLE, SAMPLE.parent, ())
    checked = json.loads(bench.ask("-m", "tests.bench.steps", "check", str(SAMPLE)))
    solved = json.loads(bench.ask("-m", "tests.bench.steps", "solve", str(SAMPLE)))
    assert {steps.LOADED, steps.REST, "reading the file", "checking its data"} == set(checked)
    assert set(solved) - set(checked) == {"motion", "forces", "torque by virtual work"}
    assert all(time > 0 for time in solved.values())


def test_every_step_is_a_function_of_the_program() -> None:
    for path in steps.STEPS:
        home, _, name = path.rpartition(".")
        assert callable(getattr(importlib.import_module(home), name)), path


def test_a_step_within_a_step_counts_once() -> None:
    clock = steps.Clock()
    with clock.step("outer"):
        time.sleep(0.02)
        with clock.step("inner"):
            time.sleep(0.05)
        time.sleep(0.02)
    taken = clock.stop()
    # A sleep is never shorter than asked for; the outer one has slept 0.04 s itself.
    assert taken["inner"] >= 0.05
    assert taken["outer"] >= 0.04
    assert list(taken) == [steps.REST, "outer", "inner"]


def test_steps_are_told_with_their_shares() -> None:
    taken = steps.middle([{"a": 10.0, "b": 300.0, "c": 1.0}, {"a": 99.0, "b": 500.0}, {"a": 11.0, "b": 389.0}])
    assert taken == {"b": 389.0, "a": 11.0, "c": 0.0}
    assert steps.told("build", taken) == "build: b 389 ms (97%), a 11 ms (3%), all else 0 ms (0%)"


def test_the_efficiency_of_two_is_taken_round_by_round() -> None:
    one = [measure.Cost(10.0, 1.0), measure.Cost(40.0, 1.0), measure.Cost(10.0, 1.0)]
    two = [measure.Cost(6.25, 1.0), measure.Cost(25.0, 1.0), measure.Cost(5.0, 1.0)]
    assert batch.efficiency(one, two) == pytest.approx(0.8)  # of 0.8, 0.8 and 1


def test_bytecode_is_kept_whatever_the_surroundings_say(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Otherwise every build would compile the checkout again, which an installed package never does."""
    monkeypatch.setenv("PYTHONDONTWRITEBYTECODE", "1")
    bench = Bench(SAMPLE, tmp_path, ("typst",))
    measure.run((sys.executable, "-c", "import reportgen.base.errors"), tmp_path, bench.installed())
    assert list((tmp_path / "bytecode").rglob("reportgen/base/errors.*.pyc"))


def test_pages_are_told_as_the_documents_have_them() -> None:
    head, rule, row = page.table([page.Page("engine-twin-05", 1.41, 0.62, 37.4)])
    assert row == "| `engine-twin-05` | 37 | 0.62 s | 1.41 MB |"
    assert f"{head}\n{rule}\n| `engine-twin-05` |" in (
        SAMPLE.parents[1] / "docs" / "explanation" / "speed.md"
    ).read_text(encoding="utf-8")


def test_growth_tells_a_line_from_a_curve() -> None:
    straight = Growth("build", "positions", {n: measure.Cost(2.0 + 0.01 * n, 90.0) for n in (8, 36, 90, 360)})
    bent = Growth("build", "positions", {n: measure.Cost(2.0 + 1e-4 * n * n, 90.0) for n in (8, 36, 90, 360)})
    assert straight.slope == pytest.approx(0.01)
    assert straight.bend == pytest.approx(1.0)
    # Of n² the last stretch has the slope n₂ + n₁, the whole n₂ + n₀.
    assert bent.bend == pytest.approx((360 + 90) / (360 + 8))


@proof
def test_growth_measures_the_main_process_and_draws_it(tmp_path: Path) -> None:
    cost = growth.Trial(tmp_path).variants(2)
    assert cost.seconds > 0
    assert 20 < cost.memory < 1000
    assert len(list((tmp_path / "given-2").glob("*.yaml"))) == 2
    one = Growth("variants", "students", {1: cost, 2: cost, 3: cost})
    growth.plot([one] * 4, tmp_path / "growth.png")
    assert (tmp_path / "growth.png").read_bytes().startswith(b"\x89PNG")
