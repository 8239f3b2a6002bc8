"""1.400 N: what a Vietnamese reader may mean as a thousand is told with both readings, all else is read as typed."""

from __future__ import annotations

from pathlib import Path

import pytest

from reportgen import api
from reportgen.base.errors import Problem
from reportgen.base.units import two_readings
from reportgen.classes.variants import make_variants

CRANK = """\
kind: slider-crank
report: {{language: en, student: {{id: 12.340, class: 1.200}}}}
variant: 1.400
parameters: {{r: 0.2 m, l: 1 m, n: 300 rpm, m3: 2 kg, force: {force}}}
"""
PISTON = "{{by: constant, F: {F}, stroke: inward}}"


def checked(folder: Path, F: str) -> list[Problem]:
    file = folder / "a.yaml"
    file.write_text(CRANK.format(force=PISTON.format(F=F)), encoding="utf-8")
    return api.examine(file)


@pytest.mark.parametrize(
    ("text", "decimals", "thousands"),
    [
        ("1.400 N", "1.4 N", "1400 N"),
        ("999.990 mm", "999.99 mm", "999990 mm"),
        ("12.000 rpm", "12 rpm", "12000 rpm"),
        ("−1.250 kN", "-1.25 kN", "-1250 kN"),
        ("1.500", "1.5", "1500"),
        ("2.500vg/ph", "2.5vg/ph", "2500vg/ph"),
    ],
)
def test_both_readings(text: str, decimals: str, thousands: str) -> None:
    assert two_readings(text) == (decimals, thousands)


@pytest.mark.parametrize(
    "text",
    [
        *("1400 N", "1.4 N", "1.40 N", "1.375 mm", "31.416 rad/s", "9.807 m/s2"),
        *("0.350", "012.400 N", "1234.500 N", "1.4000 N", "1.400e3 N", "1.400 parsnip", "A1.400", "1.400/2.800"),
        *("1.400.000 N", "1,400 N", "", "N"),
    ],
)
def test_nothing_else_is_doubted(text: str) -> None:
    assert two_readings(text) is None


def test_check_warns_and_the_file_is_in_order(tmp_path: Path) -> None:
    """Texts are no numbers: a student's id stays as it is."""
    (problem,) = checked(tmp_path, "1.400 N")
    assert str(problem) == (
        f"{tmp_path / 'a.yaml'}:4:79: warning[thousands]: “1.400 N” is read as 1.4 N; "
        "with a point before the thousands it would be 1400 N\n    hint: write 1.4 N or 1400 N"
    )
    assert api.load(tmp_path / "a.yaml").parameters.force.F.si == 1.4


@pytest.mark.parametrize("F", ["1400 N", "1.4 N", "1.375 N", "9.807 N"])
def test_check_is_silent_where_there_is_no_doubt(tmp_path: Path, F: str) -> None:
    assert checked(tmp_path, F) == []


def test_a_comma_where_yaml_parts_is_the_fault(tmp_path: Path) -> None:
    """One fault, at the number, in place of two about a unit and a key that nobody wrote."""
    (problem,) = checked(tmp_path, "1,600 N")
    assert (problem.code, problem.location.column, problem.hint) == ("decimal-comma", 79, "write 1.6 N or 1600 N")
    (problem,) = checked(tmp_path, "1,400,000 N")
    assert (problem.code, problem.hint) == ("decimal-comma", "write 1400000 N")
    (problem,) = checked(tmp_path, "1.600,5 N")
    assert (problem.code, problem.hint) == ("decimal-comma", "write 1600.5 N")
    (problem,) = checked(tmp_path, "\N{MINUS SIGN}1,600 N")
    assert (problem.code, problem.hint) == ("decimal-comma", "write -1.6 N or -1600 N")
    # A key that is one is none of the number's digits.
    assert [one.code for one in checked(tmp_path, "16 N, 5: 3")] == ["unknown-key"]
    assert [one.code for one in checked(tmp_path, "16 N, 5 N")] == ["unknown-key"]


def test_no_hint_leads_into_the_doubt(tmp_path: Path) -> None:
    """A unit that is missing is named with both readings of 1.600, and beside 1.375 alone."""
    assert [one.hint for one in checked(tmp_path, "1.600")] == ["write 1.6 N or 1600 N"]
    assert [one.hint for one in checked(tmp_path, "1.375")] == ["write for example “1.375 N”"]


def test_the_point_of_a_list_is_the_decimal_one_where_another_number_says_so(tmp_path: Path) -> None:
    """[0.250, 0.500, 1.000] leaves no doubt; numbers with units of their own are told."""
    text = (Path(__file__).parents[1] / "broken" / "files" / "engine-twin.yaml").read_text(encoding="utf-8")
    file = tmp_path / "a.yaml"
    for row, told in (("[1, 1.250, 3.6]", []), ("[1.250, 2.500, 3.500]", ["thousands"] * 3)):
        file.write_text(text.replace("[1, 1, 3.6]", row), encoding="utf-8")
        assert [one.code for one in api.examine(file)] == told


def test_the_files_of_parts_are_looked_at_too(tmp_path: Path) -> None:
    folder = Path(__file__).parents[2] / "assignments" / "coursework"
    for path in folder.iterdir():
        (tmp_path / path.name).write_bytes(path.read_bytes())
    cam = tmp_path / "feed-cam.yaml"
    text = cam.read_text(encoding="utf-8")
    assert "r0: 80 mm" in text
    cam.write_text(text.replace("r0: 80 mm", "r0: 80.000 mm"), encoding="utf-8")
    (problem,) = api.examine(tmp_path / "shaper.yaml")
    assert (problem.code, problem.level, problem.location.file) == ("thousands", "warning", str(cam))


def test_who_draws_variants_is_told(tmp_path: Path) -> None:
    (tmp_path / "class.csv").write_text("id,name\nK1,An\n", encoding="utf-8")
    spec = CRANK.replace("variant: 1.400", "salt: s").format(force=PISTON.format(F="1400 N"))
    spec = spec.replace("l: 1 m", "l: [1.100 m, 1.2 m]")
    (tmp_path / "spec.yaml").write_text(spec, encoding="utf-8")
    remarks = make_variants(tmp_path / "spec.yaml", tmp_path / "class.csv", tmp_path / "out").remarks
    assert [one.partition(": ")[2][:18] for one in remarks if "thousands" in one] == ["warning[thousands]"]
