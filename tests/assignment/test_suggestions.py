"""Faults that say what was meant: another key or unit, a deleted section, a quotation mark that is left open."""

from __future__ import annotations

from pathlib import Path

import pytest

from reportgen import catalogue
from reportgen.assignment.fields import UNIT_KEY
from reportgen.assignment.schema import alternatives_to, file_schema, keys_at, places
from reportgen.base.errors import Problem
from reportgen.base.units import measures
from tests.commands import reportgen
from tests.kinds import KINDS

ENGINE = catalogue.sample("engine-twin", "en")


def problems(file: Path, text: str) -> list[Problem]:
    file.write_text(text, encoding="utf-8")
    return catalogue.check(file, "en")


def with_line(key: str, line: str) -> str:
    """The commented file of an engine with another line for a key."""
    return "\n".join(line if own.strip().startswith(f"{key}:") else own for own in ENGINE.splitlines())


@pytest.mark.parametrize(
    ("key", "line", "code", "hint", "remedy"),
    [
        ("G3", "  G3: 6 kg", "wrong-unit", "m3: 6 kg", ()),
        ("G3", "  m3: 60 N", "wrong-unit", "G3: 60 N", ()),
        ("n", "  n: 230 rad/s2", "wrong-unit", "expected: rpm", ()),
        ("G3", "  G3: 40 Niutơn", "unknown-unit", "40 N", ("40 N",)),
        ("G3", "  G3: 0.8 KN", "unknown-unit", "0.8 kN", ("0.8 kN",)),
        ("n", "  n: 5 vòng/giây", "unknown-unit", "5 rps", ("5 rps",)),
        ("n", "  n: 900 RPM", "unknown-unit", "900 rpm", ("900 rpm",)),
        ("H", "  H: 95 MM", "unknown-unit", "95 mm", ("95 mm",)),
        ("n", "  n: 5 ngày", "unknown-unit", "write for example rpm", ()),
        ("worked_positions", "  worked_positions: tất cả", "wrong-type", "write all, or a list", ("all",)),
    ],
)
def test_a_fault_says_what_was_meant(
    tmp_path: Path, key: str, line: str, code: str, hint: str, remedy: tuple[str, ...]
) -> None:
    (problem,) = problems(tmp_path / "x.yaml", with_line(key, line))
    assert problem.code == code
    assert hint in str(problem.hint)
    assert problem.remedies == remedy


def _pairs(kind: str) -> list[tuple[str, str, str]]:
    """The parameters of a kind that have a partner of another unit: key, partner, the partner's unit."""
    schema = file_schema(catalogue.kind(kind))

    def unit(key: str) -> str:
        return next((form[UNIT_KEY] for form in places(schema, schema, ("parameters", key)) if UNIT_KEY in form), "")

    keys = keys_at(schema, ("parameters",))
    pairs = [(key, other) for key in keys for other in alternatives_to(catalogue.kind(kind), ("parameters", key))]
    return [
        (key, other, unit(other))
        for key, other in pairs
        if unit(key) and unit(other) and not measures(unit(other), unit(key))
    ]


PAIRS = {kind: pairs for kind in sorted(KINDS) if (pairs := _pairs(kind))}


def test_most_kinds_have_keys_in_pairs() -> None:
    assert {"engine-twin", "shaper", "four-bar", "slider-crank"} <= PAIRS.keys()


@pytest.mark.parametrize("kind", PAIRS)
def test_each_pair_of_keys_names_its_partner(tmp_path: Path, kind: str) -> None:
    """A value in the unit of the other key of a pair leads to that key, for every pair of every kind."""
    for key, other, unit in PAIRS[kind]:
        text = f"kind: {kind}\nparameters: {{{key}: 7 {unit}}}\n"
        (fault,) = [one for one in problems(tmp_path / "x.yaml", text) if one.code == "wrong-unit"]
        assert f"{other}: 7 {unit}" in str(fault.hint)


def test_a_deleted_line_of_a_section_is_one_fault(tmp_path: Path) -> None:
    text = "\n".join(line for line in ENGINE.splitlines() if not line.startswith("parameters:"))
    (problem,) = problems(tmp_path / "x.yaml", text)
    assert (problem.code, problem.location.line) == ("missing-section", text[: text.index("\n  H:")].count("\n") + 2)
    assert "“parameters:”" in problem.message


@pytest.mark.parametrize(
    ("key", "line", "column"),
    [
        ("course", '  course: "Theory', 11),
        ("course", "  course: 'Theory", 11),
        ("worked_positions", "  worked_positions: [2", 21),
    ],
)
def test_a_sign_left_open_is_reported_where_it_opens(tmp_path: Path, key: str, line: str, column: int) -> None:
    text = with_line(key, line)
    (problem,) = problems(tmp_path / "x.yaml", text)
    assert problem.code == "syntax"
    assert (problem.location.line, problem.location.column) == (text[: text.index(line)].count("\n") + 1, column)


@pytest.mark.parametrize(
    ("content", "name"),
    [
        (b"PK\x03\x04....word/document.xml", "Word"),
        (b"PK\x03\x04....xl/workbook.xml", "Excel"),
        (b"PK\x03\x04....", "ZIP"),
        (b"%PDF-1.7", "PDF"),
        (b"\x89PNG\r\n", "PNG"),
    ],
)
def test_another_kind_of_file_is_named(tmp_path: Path, content: bytes, name: str) -> None:
    (file := tmp_path / "x.docx").write_bytes(content)
    (problem,) = catalogue.check(file, "en")
    assert problem.code == "not-yaml"
    assert name in problem.message


def test_plot_without_quantities_lists_them(tmp_path: Path) -> None:
    file = tmp_path / "x.yaml"
    file.write_text(catalogue.sample("slider-crank", "en"), encoding="utf-8")
    lines = reportgen("plot", file, "--lang", "en").stdout.splitlines()
    names = {line.split()[0]: line for line in lines}
    assert {"v.C", "a.C", "omega.2"} <= set(names)
    assert names["v.C"].split() == ["v.C", "v_C", "(m/s)", "velocity", "of", "C"]
    assert reportgen("plot", file, "--of", ",".join(list(names)[:3]), "--out", tmp_path, "--lang", "en").returncode == 0


@pytest.mark.parametrize("line", ["-h --lang vi", "--lang vi -h", "build -h --lang vi", "--lang vi build -h"])
def test_help_in_a_language_at_every_level(line: str) -> None:
    done = reportgen(*line.split())
    assert done.returncode == 0
    assert done.stdout.startswith("Cách dùng: reportgen")


def test_a_language_before_the_command_is_that_of_the_command(tmp_path: Path) -> None:
    assert reportgen("--lang", "en", "kinds").stdout == reportgen("kinds", "--lang", "en").stdout
    assert reportgen("--lang", "en", "kinds", "--lang", "vi").stdout == reportgen("kinds", "--lang", "vi").stdout
