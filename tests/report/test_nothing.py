"""Weights, masses and loads that are zero: the machine has none, which is told in words, and no plan of nothing."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from reportgen import api
from reportgen.cases import MachineCase
from reportgen.document import text_of
from reportgen.report.composing import compose
from tests.lanes import matrix

SAMPLES = Path("assignments")
TELLING = ("engine-single-I", "four-bar-01", "scotch-yoke-01")
"""A diagram, a torque, a force; the others, and Vietnamese, are for `make proof`."""
ONE_EACH = (
    "engine-single-I",
    "engine-twin-05",
    "engine-v-01",
    "four-bar-01",
    "lever-six-bar-01",
    "linkage-8",
    "linkage-slide",
    "scotch-yoke-01",
    "slider-crank-01",
    "toggle-press-01",
)
MASSES = re.compile(r"\b([GmJ][1-9]?): *[0-9][-0-9.e]*(?= *(?:N|kg)\b)")
SIZES = re.compile(r"\b(F|P|M|PC|PE): *[0-9][-0-9.e]*(?= *k?N)")
ROWS = re.compile(r"\b(intake|compression|expansion|exhaust|inward|outward|P|F|p|height|values): *\[([^\]]*)\]")
TOLD = {
    "en": "All the masses and loads of the assignment are zero",
    "vi": "Mọi khối lượng và tải trọng trong đề bài đều bằng không",
}


def case(tmp_path: Path, name: str, *, masses: bool = False, loads: bool = False, language: str = "en") -> MachineCase:
    """The case of a sample whose masses or loads are all zero."""
    text = (SAMPLES / f"{name}.yaml").read_text(encoding="utf-8")
    if masses:
        text = MASSES.sub(r"\1: 0", text)
    if loads:
        text = SIZES.sub(r"\1: 0", text)
        text = ROWS.sub(lambda row: f"{row[1]}: [{re.sub('[-0-9.e]+', '0', row[2])}]", text)
    file = tmp_path / f"{name}.yaml"
    file.write_text(text, encoding="utf-8")
    return MachineCase(api.load(file, "vi" if language == "vi" else "en"))


@pytest.mark.parametrize("language", matrix(["en", "vi"], ["en"]))
@pytest.mark.parametrize("name", matrix(ONE_EACH, TELLING))
def test_a_machine_of_nothing_is_told_and_ends_with_its_kinematics(tmp_path: Path, name: str, language: str) -> None:
    opened = case(tmp_path, name, masses=True, loads=True, language=language)
    assert not opened.analysis.loads
    assert "M.eq" not in opened.ledger
    if language == "vi" or name in ("linkage-8", "engine-v-01"):
        assert TOLD[language] in text_of(compose(opened))


@pytest.mark.parametrize(
    ("name", "masses"),
    matrix(
        [("linkage-8", True), ("engine-twin-05", False), ("engine-v-01", False)],
        [("linkage-8", True), ("engine-v-01", False)],
    ),
)
def test_what_is_left_still_loads_the_machine(tmp_path: Path, name: str, masses: bool) -> None:
    opened = case(tmp_path, name, masses=masses, loads=not masses)
    if name == "engine-v-01":
        # One piston of two is left with its force.
        file = tmp_path / "v.yaml"
        file.write_text((SAMPLES / f"{name}.yaml").read_text("utf-8").replace("PC: 5600 N", "PC: 0 N"), "utf-8")
        opened = MachineCase(api.load(file, "en"))
    assert opened.analysis.loads
    torque, by_work = opened.analysis.torque, opened.analysis.torque_by_work
    assert np.abs(torque - by_work).max() < 1e-9 * np.abs(torque).max()
    text = text_of(compose(opened))
    assert TOLD["en"] not in text
    if name == "engine-twin-05":
        assert "pressure of the surrounding air" in text


def test_a_diagram_below_zero_is_drawn(tmp_path: Path) -> None:
    """A cylinder at 5 N/cm² below the air's pressure throughout, as of an engine that is braked by its throttle."""
    text = (SAMPLES / "engine-twin-05.yaml").read_text(encoding="utf-8")
    text = ROWS.sub(lambda row: f"{row[1]}: [{re.sub('[-0-9.]+', '-5', row[2])}]", text)
    file = tmp_path / "a.yaml"
    file.write_text(text, encoding="utf-8")
    opened = MachineCase(api.load(file, "en"))
    force = opened.ledger["P3"].values
    assert force == pytest.approx(np.full(16, -5e4 * np.pi * 0.098**2 / 4))
    assert "tab.gas" not in text_of(compose(opened))


ACROSS = """\
kind: linkage
report: {language: en}
positions: {count: 6}
parameters:
  frame: {A: [0 mm, 0 mm]}
  driver: {type: crank, centre: A, pin: B, length: 40 mm, n: 100 rpm}
  groups:
    - {type: RRP, links: [2, 3], joints: [B, C], length: 150 mm, guide: {at: [0 mm, 0 mm], angle: 0 deg}, end: far}
  loads:
    - {by: constant, link: 3, at: C, direction: 90 deg, F: 50 N}
"""


def test_a_force_across_the_guide_hands_nothing_on_to_the_crank(tmp_path: Path) -> None:
    """The guide holds all of it: rod and crank are free of forces, so that there is no polar diagram to draw."""
    file = tmp_path / "a.yaml"
    file.write_text(ACROSS, encoding="utf-8")
    opened = MachineCase(api.load(file, "en"))
    assert np.abs(opened.analysis.torque).max() < 1e-9
    text = text_of(compose(opened))
    assert "The groups hand no force on to the crank" in text
    assert "polar diagram" not in text
    assert [opened.ledger["M.least"].at(None), opened.ledger["M.greatest"].at(None)] == [0, 0]
