"""Mechanisms that are large beside their crank: no page beyond A0, and the drawn crank that fits is named."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from reportgen import api
from reportgen.cases import MachineCase
from reportgen.catalogue import check
from reportgen.document import Plate
from reportgen.report.composing import compose
from tests.lanes import matrix

FOUR_BAR = """\
kind: four-bar
report: {language: en}
drawing: {crank: 30 mm}
parameters: {AB: 120 mm, BC: 340 mm, CD: 280 mm, AD: 400 mm, omega1: 20 rad/s, E: {along: 150 mm, across: 110 mm}}
"""
SLIDER = """\
kind: slider-crank
report: {language: en}
drawing: {crank: 30 mm}
parameters: {r: 150 mm, l: 600 mm, n: 100 rpm}
"""
TWIN = Path("assignments/engine-twin-05.yaml").read_text(encoding="utf-8")
SHEETS = {(297.0, 420.0), (420.0, 594.0), (594.0, 841.0), (841.0, 1189.0)}

FAR = {
    "coupler point": (FOUR_BAR, "along: 150 mm", "along: 90 m"),
    "crank": (FOUR_BAR, "AB: 120 mm", "AB: 1 mm"),
    "rod": (SLIDER, "l: 600 mm", "l: 15 m"),
    "without a drawn crank": (SLIDER, "drawing: {crank: 30 mm}\nparameters: {r: 150 mm", "parameters: {r: 1 mm"),
}


def put(tmp_path: Path, text: str, *changes: str) -> Path:
    file = tmp_path / "a.yaml"
    for old, new in zip(changes[::2], changes[1::2], strict=True):
        assert old in text
        text = text.replace(old, new, 1)
    file.write_text(text, encoding="utf-8")
    return file


@pytest.mark.parametrize("name", FAR)
def test_the_longest_drawn_crank_is_named_and_fits(tmp_path: Path, name: str) -> None:
    text, *change = FAR[name]
    (problem,) = check(put(tmp_path, text, *change), "en")
    assert problem.code == "too-large-to-draw"
    named = re.search(r"fits is ([\d.]+) mm", problem.message)
    assert named
    text = text.replace(change[0], change[1]).replace("crank: 30 mm", f"crank: {named[1]} mm")
    if "drawing" not in text:
        text += f"drawing: {{crank: {named[1]} mm}}\n"
    assert check(put(tmp_path, text), "en") == []
    report = compose(MachineCase(api.load(put(tmp_path, text))))
    papers = {tuple(sorted(block.paper)) for block in report.blocks if isinstance(block, Plate)}
    assert papers <= SHEETS


@pytest.mark.parametrize(
    ("text", "old"), [(FOUR_BAR, "crank: 30 mm"), (SLIDER, "crank: 30 mm"), (TWIN, "crank: 50 mm")]
)
@pytest.mark.parametrize("drawn", matrix([60, 100, 150], [150]))
def test_a_larger_drawing_takes_a_larger_sheet_of_the_series(tmp_path: Path, text: str, old: str, drawn: int) -> None:
    file = put(tmp_path, text, old, f"crank: {drawn} mm")
    report = compose(MachineCase(api.load(file)))
    papers = {tuple(sorted(block.paper)) for block in report.blocks if isinstance(block, Plate)}
    assert papers <= SHEETS
