"""Every reading of an indicator diagram has its number, also where many lie close together."""

from __future__ import annotations

from pathlib import Path

from reportgen import api, cases
from reportgen.drawing import Label
from reportgen.formula import Symbol
from reportgen.report import mechanism_figures
from reportgen.report.context import ReportContext

ENGINE = """
kind: engine-v
positions: {count: 12, direction: clockwise}
parameters:
  AB: 62 mm
  BC: 235 mm
  BD: 58 mm
  DE: 178 mm
  alpha: 60 deg
  beta: 120 deg
  n: 1500 rpm
  D: 110 mm
indicator:
  by: stroke
  unit: bar
  s:           [0, 0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 0.9, 1]
  intake:      [0.2, -0.1, -0.1, -0.1, -0.1, -0.1, -0.1, -0.1, -0.1]
  compression: [34, 16.2, 9.8, 4.9, 2.8, 1.1, 0.5, 0.1, -0.1]
  expansion:   [58, 58, 37.2, 20.4, 13.4, 7.5, 4.9, 3.3, 2.8]
  exhaust:     [0.2, 0.2, 0.2, 0.2, 0.2, 0.2, 0.2, 0.4, 2.8]
"""


def test_no_position_of_two_pistons_is_without_its_number(tmp_path: Path) -> None:
    """24 positions of a cycle on each of two pistons: 48 numbers, many of them on the two lines near p = 0."""
    file = tmp_path / "engine.yaml"
    file.write_text(ENGINE.lstrip(), encoding="utf-8")
    report = ReportContext(cases.opened(api.load(file, "en")))
    shown = {
        item.content
        for scene in mechanism_figures.indicator(report).scenes
        for item in scene.items
        if isinstance(item, Label)
    }
    numbers = {Symbol(str(k), f"({link})") for k in report.all_positions for link in (3, 5)}
    assert len(numbers) == 48
    assert numbers <= shown
