"""Values beyond what the field knows, and linkages next to a dead point: faults of the file, or they work out."""

from __future__ import annotations

import math
import re
from pathlib import Path

import numpy as np
import pytest

from reportgen import api
from reportgen.cases import MachineCase
from reportgen.catalogue import check
from reportgen.document import text_of
from tests.report import trees
from tests.report.calculator import misses

SLIDER = """\
kind: slider-crank
report: {language: en}
parameters: {r: 150 mm, l: 600 mm, n: 100 rpm, m2: 3 kg, m3: 2 kg, force: {by: constant, F: 300 N}}
"""
FOUR_BAR = """\
kind: four-bar
report: {language: en}
parameters: {AB: 100 mm, BC: 300 mm, CD: 300 mm, AD: 490 mm, n: 100 rpm, m2: 3 kg, m3: 2 kg, torque: {M: 30 N m}}
"""
LEVER = """\
kind: slotted-lever
report: {language: en}
parameters: {AB: 100 mm, AC: 140 mm, CD: 300 mm, n: 100 rpm, m3: 2 kg, torque: {M: 30 N m}}
"""
TWIN = Path("assignments/engine-twin-05.yaml").read_text(encoding="utf-8")


def put(tmp_path: Path, text: str, old: str, new: str) -> Path:
    assert old in text
    file = tmp_path / "a.yaml"
    file.write_text(text.replace(old, new, 1), encoding="utf-8")
    return file


@pytest.mark.parametrize(
    ("text", "old", "new"),
    [
        (SLIDER, "100 rpm", "1e-12 rpm"),
        (SLIDER, "100 rpm", "1e-300 rpm"),
        (SLIDER, "n: 100 rpm", "omega1: 1e-9 rad/s"),
        (SLIDER, "3 kg", "1e-300 kg"),
        (SLIDER, "300 N", "-1e-300 N"),
        (SLIDER, "r: 150 mm", "r: 0.0001 mm"),
        (SLIDER, "l: 600 mm", "e: 1e-9 mm, l: 600 mm"),
        (FOUR_BAR, "100 mm", "0.0001 mm"),
        (FOUR_BAR, "30 N m", "1e-30 N m"),
        (TWIN, "1/3.6", "1/1e308"),
        (TWIN, "1/3.6", "1e-4"),
        (TWIN, "s: 0.35", "s: 1e-200"),
        (TWIN, "[1.0, -2.5", "[1e-200, -2.5"),
    ],
)
def test_what_no_machine_has_is_out_of_range(tmp_path: Path, text: str, old: str, new: str) -> None:
    assert [problem.code for problem in check(put(tmp_path, text, old, new), "en")] == ["out-of-range"]


@pytest.mark.parametrize(
    ("text", "old", "new", "group", "place"),
    [
        (SLIDER, "r: 150 mm", "r: 599.9999999 mm", "(2, 3)", "90°"),
        (SLIDER, "r: 150 mm", "r: 150 mm, e: 449.999999 mm", "(2, 3)", "270°"),
        (FOUR_BAR, "490 mm", "499.9999999 mm", "(2, 3)", "180°"),
        (LEVER, "140 mm", "100.0001 mm", "(2, 3)", "270°"),
        (LEVER, "140 mm", "99.9999 mm", "(2, 3)", "270°"),
        (TWIN, "1/3.6", "0.999999999", "(2, 3)", "°"),
    ],
)
def test_next_to_a_dead_point_is_a_located_fault(
    tmp_path: Path, text: str, old: str, new: str, group: str, place: str
) -> None:
    """It names group, angle, how near, and from which value on it is accepted."""
    (problem,) = check(put(tmp_path, text, old, new), "en")
    assert problem.code in ("near-dead-point", "near-pivot")
    assert group in problem.message
    assert place in problem.message
    assert "at least" in problem.message
    assert problem.location.line > 1


def transmitted(degrees: float) -> dict[str, tuple[str, str, str]]:
    """Linkages whose least angle of transmission is so large: text, what is replaced, by what."""
    angle = math.radians(degrees)
    rod = 600 * math.cos(angle)
    span = 600 * math.cos(angle / 2)
    pivot = 100 + math.sin(angle) * 620  # mm; the lever sweeps 600 mm in all
    return {
        "centred slider": (SLIDER, "r: 150 mm", f"r: {rod:.9f} mm"),
        "offset slider": (SLIDER, "r: 150 mm", f"r: 150 mm, e: {rod - 150:.9f} mm"),
        "four-bar": (FOUR_BAR, "490 mm", f"{span - 100:.9f} mm"),
        "slotted lever": (LEVER, "140 mm", f"{pivot:.9f} mm"),
        "engine": (TWIN, "1/3.6", f"{math.cos(angle):.15f}"),
        "issue": (SLIDER, "r: 150 mm", "r: 599.999 mm"),
    }


@pytest.mark.parametrize("name", ["centred slider", "offset slider", "four-bar", "slotted lever", "engine", "issue"])
@pytest.mark.parametrize("degrees", [0.11, 1.0])
def test_what_is_accepted_works_out_to_nine_figures(tmp_path: Path, name: str, degrees: float) -> None:
    """The quadrature settles, both torques agree, and the energy of the cycle is balanced."""
    analysis = MachineCase(api.load(put(tmp_path, *transmitted(degrees)[name]))).analysis
    size = np.abs(analysis.torque).max()
    assert np.abs(analysis.torque - analysis.torque_by_work).max() <= 1e-9 * size
    assert analysis.summary.energy_error < 1e-9


def test_a_machine_at_the_bounds_has_a_report_whose_lines_recompute(tmp_path: Path) -> None:
    """900 t on a crank of 40 m at 100 000 rpm: what is very large is rounded to its figures, with a power of ten."""
    text = SLIDER.replace("150 mm", "40 m").replace("600 mm", "99 m").replace("100 rpm", "100000 rpm")
    file = tmp_path / "a.yaml"
    file.write_text(text.replace("3 kg", "900000 kg").replace("2 kg", "900000 kg"), encoding="utf-8")
    document = api.document(api.load(file))
    assert misses(trees.lines(trees.chains(document), "en")) == []
    # ω² r = (2π·10⁵/60)²·40 m/s².
    assert "4.3865·10^9 m/s²" in text_of(document)
    assert not re.search(r"[0-9]{10}", text_of(document))
