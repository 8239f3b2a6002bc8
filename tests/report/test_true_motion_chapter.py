"""The chapter on the true motion of a machine: its values are the solver's, its verdict names what is permitted."""

from __future__ import annotations

from pathlib import Path
from unittest import mock

import pytest
import yaml

from reportgen import catalogue
from reportgen.cases import MachineCase, open_case
from reportgen.document import Table, Value, text_of
from reportgen.drawing import Label
from reportgen.formula import Number
from reportgen.motion import views as running
from reportgen.motion.curves import stopping
from reportgen.motion.true_motion import at_positions, motion_in
from reportgen.report.context import ReportContext
from reportgen.report.result_tables import residuals
from tests.lanes import proof
from tests.report import built, trees
from tests.report.calculator import misses

FILE = built.ROOT / "assignments" / "slider-crank-03.yaml"


HEADINGS = [
    "True motion of the machine",
    "Torque of the drive",
    "Reduced moment of inertia and reduced torque",
    "Equation of motion",
    "Steady motion",
    "Working points and energy",
    "Calculation by steps",
    "Forces in the true motion",
    "Start",
    "Stop",
]


@pytest.fixture(scope="module")
def lines() -> list[str]:
    """The lines of the whole report."""
    return text_of(built.written(FILE, "en").document).splitlines()


def test_what_stands_in_it(lines: list[str]) -> None:
    numbered = [line.partition(" ") for line in lines if line.startswith("2.6")]
    assert [title for _, _, title in numbered] == HEADINGS
    blocks = built.written(FILE, "en").document.blocks
    keys = [block.key for block in blocks if isinstance(block, Table) and block.key.startswith("tab.run")]
    assert keys == ["tab.run", "tab.run.wheel", "tab.run.steps", "tab.run.forces.2", "tab.run.start", "tab.run.stop"]


def test_the_ledger_has_the_values_of_the_solver() -> None:
    case = built.case(FILE, "en")
    motion, machine = motion_in(case.analysis), case.analysis.machine
    for state, suffix in (("", ""), ("wheel", ".wheel")):
        steady = motion.states[state]
        at = at_positions(machine, steady)
        for name, values in (("omega", steady.run.speed), ("eps", steady.run.acceleration), ("t", steady.run.time)):
            # T is the first energy and the work from there on: as exact as the integration.
            assert case.ledger[f"run.{name}{suffix}"].values == pytest.approx(values[at], rel=1e-9, abs=1e-9)
        assert case.ledger[f"run.delta{suffix}"].values[0] == pytest.approx(steady.unevenness)
    # J′ from the plans is that of the motion at unit speed.
    slope = motion.alone.run.slope[at_positions(machine, motion.alone)]
    assert case.ledger["run.dJ"].values == pytest.approx(slope, abs=1e-10)


def test_readings_and_steadiness_are_checked() -> None:
    checked = residuals(ReportContext(built.case(FILE, "en")))
    assert checked["drive"] < 1e-12
    assert checked["run_energy"] < 1e-12


def test_its_lines_recompute() -> None:
    found = trees.lines(trees.chains(built.written(FILE, "en").document), "en")
    assert misses(found) == []


def test_the_verdict_names_both(lines: list[str]) -> None:
    """In the summary, and in the chapter."""
    verdicts = [line for line in lines if line.startswith("Verdict.")]
    assert len(verdicts) == 2
    for verdict in verdicts:
        assert "0.048997, without it 0.19233; the permissible one is 1/20" in verdict
        assert verdict.endswith("the condition is fulfilled.")


@pytest.mark.parametrize("brake", [300, 3000])
def test_a_stop_within_a_few_degrees_has_its_curves(brake: int, tmp_path: Path) -> None:
    """55° and 7°: the axis of angles has its ticks all the same."""
    text = FILE.read_text(encoding="utf-8").replace("brake: 80 N m", f"brake: {brake} N m")
    file = tmp_path / "stop.yaml"
    file.write_text(text, encoding="utf-8")
    case = open_case(file)
    assert isinstance(case, MachineCase)
    scenes = stopping(ReportContext(case)).scenes
    over_angle = [item.content for item in scenes[0].items if isinstance(item, Label)]
    angles = [content.value for content in over_angle if isinstance(content, Number) and content.unit == "°"]
    assert len(angles) > 2


def _with_drive(tmp_path: Path, text: str) -> Path:
    file = tmp_path / "drive.yaml"
    file.write_text(text, encoding="utf-8")
    return file


@proof
def test_a_machine_at_another_speed_than_planned_is_warned_of(tmp_path: Path) -> None:
    """M₀/k = 30 rad/s without load: planned for 60 rad/s it is another machine, planned for 28 it is not."""
    text = FILE.read_text(encoding="utf-8")
    speed = next(line for line in text.splitlines() if line.lstrip().startswith(("n:", "omega1:")))
    far = _with_drive(tmp_path, text.replace(speed, "  omega1: 60 rad/s"))
    assert [problem.code for problem in catalogue.examine(far) if problem.level == "warning"] == ["motion-off-speed"]
    assert "motion-off-speed" not in [problem.code for problem in catalogue.examine(FILE)]
    case = open_case(far)
    assert isinstance(case, MachineCase)
    assert "máy chạy ở vận tốc khác" in text_of(case.document())


@pytest.mark.parametrize(("true", "verdict"), [(0.033343, "exceeded"), (0.0333334, "kept"), (0.0333, "kept")])
def test_the_verdict_compares_what_is_printed(true: float, verdict: str) -> None:
    """1/30 to the decimals of δ is 0.033333; 0.033343 exceeds it by 0.03 %."""
    report = ReportContext(built.case(FILE, "en"))
    delta = Number(true, 6)
    with (
        mock.patch.object(running, "_permitted", return_value=1 / 30),
        mock.patch.object(type(report.ledger), "number", return_value=delta),
    ):
        assert running.verdict(report) == verdict
        by = running.exceeded_by(report)
    assert [value.number.printed for value in by if isinstance(value, Value)] == (
        [0.03] if verdict == "exceeded" else []
    )


ENGINE = built.ROOT / "assignments" / "engine-single-load.yaml"


def test_an_engine_stops_with_its_load_uncoupled(tmp_path: Path) -> None:
    """It has no motor that could be switched off: the gas goes on working against the brake."""
    drive = "drive: {M0: 0 N m, k: 4.7 N m s}"
    text = ENGINE.read_text(encoding="utf-8").replace("language: vi", "language: en", 1)
    assert drive in text
    case = open_case(_with_drive(tmp_path, text.replace(drive, drive + "\n    stop: {brake: 5000 N m}")))
    assert isinstance(case, MachineCase)
    said = text_of(case.document())
    assert "the motor is switched off" not in said
    assert "the load is uncoupled, and the brake acts" in said
    assert "with the load uncoupled and the brake acting" in said


def test_an_engine_at_single_instants(tmp_path: Path) -> None:
    """Crank at 30° and 400°, dead centre at 90°: 60° and 50° before the top, at the end of exhaust and compression."""
    text = (built.ROOT / "assignments" / "engine-single-I.yaml").read_text(encoding="utf-8")
    data = yaml.safe_load(text)
    data["positions"] = {"at": ["30 deg", "400 deg"]}
    data["report"] = {"language": "en"}
    data["parameters"].pop("flywheel", None)
    case = open_case(_with_drive(tmp_path, yaml.safe_dump(data, sort_keys=False)))
    assert isinstance(case, MachineCase)
    said = text_of(case.document())
    assert "positions of the cycle" not in said
    assert "that is in 2 positions" not in said
    sentence = "At position I piston 3 is on its exhaust stroke, at position II piston 3 is on its compression stroke."
    assert sentence in said
    assert "I–II" not in said
