"""Results on a terminal: what stands in which column."""

from __future__ import annotations

from pathlib import Path

import pytest

from reportgen import api
from reportgen.marking.results import print_tables, tables

ASSIGNMENTS = Path(__file__).parents[2] / "assignments"


def test_positions_stand_by_their_labels(capsys: pytest.CaptureFixture[str]) -> None:
    """Twelve even positions 0…11 of the first turn, dead centres and greatest speeds lettered between them."""
    results = api.solve(api.load(ASSIGNMENTS / "engine-single-I.yaml"))
    labels = [row["position"] for row in tables(results["positions"])["velocities"]]
    assert [label for label in labels if str(label).isdigit()] == [str(number) for number in range(24)]
    assert [label for label in labels if str(label).isalpha()] == list("abcdef")
    print_tables(results, "en")
    assert "│        a │" in capsys.readouterr().out


def test_without_labels_positions_are_numbers() -> None:
    results = api.solve(api.load(ASSIGNMENTS / "engine-twin-05.yaml"))
    rows = tables(results["positions"])["velocities"]
    assert [row["position"] for row in rows] == [str(number) for number in range(1, len(rows) + 1)]


def test_a_sliding_driver_is_told_by_its_way(capsys: pytest.CaptureFixture[str]) -> None:
    results = api.solve(api.load(ASSIGNMENTS / "linkage-slide.yaml", "en"))
    found = tables(results["positions"])
    assert all("crank_angle" not in row for rows in found.values() for row in rows)
    assert [row["driver_way"] for row in found["force"]] == pytest.approx([0, 20, 40, 60, 80, 100, 120])
    assert "torque" not in found
    print_tables(results, "en")
    out = capsys.readouterr().out
    assert "s (mm)" in out
    assert "Balancing force (N)" in out
    assert "φ" not in out


def test_a_driver_that_slides_back_is_told_by_the_way_it_has_gone(tmp_path: Path) -> None:
    text = (ASSIGNMENTS / "linkage-slide.yaml").read_text(encoding="utf-8")
    path = tmp_path / "back.yaml"
    path.write_text(text.replace("start: 0 mm, end: 120 mm", "start: 120 mm, end: 0 mm"), encoding="utf-8")
    positions = api.solve(api.load(path))["positions"]
    assert [one["crank_angle"] for one in positions] == pytest.approx([0.12, 0.1, 0.08, 0.06, 0.04, 0.02, 0], abs=1e-12)
    assert [one["driver_way"] for one in positions] == pytest.approx([0, 0.02, 0.04, 0.06, 0.08, 0.1, 0.12], abs=1e-12)
