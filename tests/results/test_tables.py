"""Results on a terminal: what stands in which column."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from reportgen import api
from reportgen.results.result_files import result_rows
from reportgen.results.terminal_tables import _column, print_tables, tables

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


EXTREME = """\
kind: slider-crank
report: {language: en}
parameters: {r: 40 m, l: 99 m, n: 100000 rpm, m2: 900000 kg, m3: 900000 kg}
"""


def test_a_column_has_five_figures_of_its_largest_value(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A linkage of 0.2 mm, slow: in fixed decimals all would be nothing."""
    file = tmp_path / "small.yaml"
    file.write_text(EXTREME.replace("40 m,", "0.2 mm,").replace("99 m,", "0.5 mm,").replace("100000", "0.01"), "utf-8")
    print_tables(api.solve(api.load(file)), "en")
    table = capsys.readouterr().out.partition("Accelerations")[0]
    # v_B = ω·r = 2π·0.01/60 · 0.0002 m/s.
    assert "2.0944·10⁻⁷" in table
    body = [cell.strip() for line in table.splitlines() if line.startswith("│") for cell in line.split("│")[3:-1]]
    # Nothing is what rests: C at its dead centres.
    assert body.count("0") == 2
    assert all(len(cell.partition("·")[0].replace(".", "")) == 5 for cell in body if cell != "0")


def test_a_very_large_value_has_a_power_of_ten(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "large.yaml"
    file.write_text(EXTREME, encoding="utf-8")
    print_tables(api.solve(api.load(file)), "en")
    out = capsys.readouterr().out
    # a_B = ω²·r = (2π·10⁵/60)²·40 m/s².
    assert "4.3865·10⁹" in out
    assert not re.search(r"\d{8}", out)


@pytest.mark.parametrize(
    ("values", "scale", "shown"),
    [
        ([100.0, 0.0004, 1e-12], 100.0, ["100.00", "0.00040000", "0.00"]),
        ([7.16e16, 7.16e8, 7160.0], 1.0, ["7.1600·10¹⁶", "7.1600·10⁸", "0"]),
        ([1.0, 2.0], 2.0, ["1", "2"]),
        ([0.00125, -0.0005], 1.0, ["0.0012500", "−0.0005000"]),
        ([None, "a"], 1.0, ["–", "a"]),
    ],
)
def test_what_is_not_nothing_is_never_printed_as_0(
    values: list[float | str | None], scale: float, shown: list[str]
) -> None:
    assert _column(values, scale, "en") == shown


def test_a_list_in_the_results_has_a_column_for_each_entry() -> None:
    """A pair of numbers is a plane vector; any other list, also one of lists or tables, is numbered."""
    entries = {"v": [3.0, 4.0], "three": [1.0, 2.0, 3.0], "pairs": [[5.0, 6.0], {"m": 7.0}], "none": []}
    assert result_rows({"positions": [entries, None]}) == [
        ["v.x", "v.y", "three.1", "three.2", "three.3", "pairs.1.x", "pairs.1.y", "pairs.2.m", "number"],
        [3.0, 4.0, 1.0, 2.0, 3.0, 5.0, 6.0, 7.0, None],
        [*[None] * 8, 2.0],
    ]
