"""Values that a machine of the atlas calculates from its parameters: their lines in the report recompute."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

import pytest

from reportgen import catalogue
from reportgen.base.atlas_words import machine_words
from reportgen.base.template_folders import ATLAS_VARIABLE, atlas_files, languages
from reportgen.base.units import Language
from reportgen.cases import open_case
from reportgen.catalogue.derived_values import own_symbol
from reportgen.document import text_of
from reportgen.formula import Chain, Negative, Number, Symbol
from tests.report import trees
from tests.report.calculator import misses

MACHINES = sorted(atlas_files())
FILE = """
words: {en: {title: A machine, description: It moves.}}
parameters:
  a: {default: 60 mm}
  b: {default: 20 cm}
  h: {default: 150 mm}
  beta: {default: 30 deg}
  k: {default: 1.5}
  w: {default: 60 rpm}
  m2: {default: 2 kg}
  F: {default: 0.4 kN}
linkage:
  frame: {A: [0 mm, 0 mm], D: [0 mm, -h]}
  driver: {type: crank, centre: A, pin: B, length: a, n: w}
  groups:
    - {type: RPR, links: [2, 3], joints: [B, C, D]}
  points: {E: {link: 3, at: [FORMULA, 10 mm]}}
  masses: [{link: 3, at: E, m: m2, J: m2*b^2/12 + 0.001 kg*h*h}]
  loads: [{by: angle, link: 3, at: E, unit: N, angle: [0 deg, 360 deg], values: [k*F*cos(beta), k*F*cos(beta)]}]
"""
"""A machine of a department, with lengths in different units and a formula to be put in."""


def lines_of(file: Path) -> tuple[Chain, ...]:
    """Return the lines of calculated values of a file's machine."""
    machine = catalogue.machine_of(catalogue.read_source(file), file)
    assert machine is not None
    lines = machine.closed_formulas.equations["derived"]
    assert bool(lines) == machine.facts["derived"]
    return tuple(line for line in lines if isinstance(line, Chain))


def worked(chains: Sequence[Chain]) -> list[Chain]:
    """Return the lines in which more than a sign is calculated, which have a substitution."""
    return [one for one in chains if not (isinstance(one.parts[-2], Negative) and isinstance(one.parts[-2].of, Symbol))]


@pytest.mark.parametrize("kind", MACHINES)
def test_each_calculated_value_of_a_machine_has_a_line_that_recomputes(kind: str) -> None:
    """A school calculator gives the printed digits, and the linkage has the same value."""
    sample = min(catalogue.examples(kind).values(), key=lambda path: path.stat().st_size)
    assignment = catalogue.load(sample)
    chains = lines_of(sample)
    found = trees.lines(chains, "en")
    assert len(found) == len(worked(chains))
    assert misses(found) == []
    heads = [chain.parts[0] for chain in chains if isinstance(chain.parts[0], Symbol)]
    assert len(set(heads)) == len(heads), "each value has a symbol of its own"
    values = [str(one) for one in _leaves(assignment.parameters.expanded)]
    for line in found:
        assert any(_same(line.digits, value) for value in values), line


def _leaves(of: object) -> list[float]:
    """Every number of a linkage in the units of its file, and in SI."""
    if hasattr(of, "si"):
        return [of.si, of.value]  # type: ignore[attr-defined]
    if isinstance(of, float):
        return [of]
    inner = (
        of if isinstance(of, (tuple, list)) else getattr(of, "__dict__", None) or (of if isinstance(of, dict) else ())
    )
    rows = inner.values() if isinstance(inner, dict) else inner
    return [value for row in rows for value in _leaves(row)]


def _same(digits: str, value: str) -> bool:
    return float(digits) == pytest.approx(float(value), rel=1e-5)


@pytest.mark.parametrize(
    ("formula", "numbers", "result"),
    [
        ("a/2", "60 2", "30 mm"),
        ("180 mm/2", "180 2", "90 mm"),
        ("20 mm + a", "20 60", "80 mm"),
        ("20 mm + b", "0.02 0.2", "0.22 m"),
        ("a - 2*(h - 100 mm)", "60 2 150 100", "-40 mm"),
        ("a*sin(beta)", "60 30", "30 mm"),
        ("sqrt(a^2 + 4*h*h)/k", "60 2 4 150 2 1.5", "203.961 mm"),
        ("h*cos(asin(a/h))", "150 60 150", "137.477 mm"),
        ("abs(a - h)", "60 150", "90 mm"),
    ],
)
def test_a_line_has_the_unit_of_its_parameters(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, formula: str, numbers: str, result: str
) -> None:
    folder, file = tmp_path / "machines", tmp_path / "mine.yaml"
    folder.mkdir()
    (folder / "made.yaml").write_text(FILE.replace("FORMULA", formula), "utf-8")
    monkeypatch.setenv(ATLAS_VARIABLE, str(folder))
    file.write_text("kind: atlas/made\nparameters: {}\n", "utf-8")
    assert [one for one in catalogue.check(file) if "error" in str(one)] == []
    found = trees.lines(lines_of(file), "en")
    assert misses(found) == []
    by_result = {one.result.replace(" ", ""): one for one in found}
    line = by_result[result.replace(" ", "")]
    assert re.findall(r"\d+(?:\.\d+)?", line.substitution) == numbers.split()
    # What is not in one unit is in SI units: 2·0.2²/12 + 0.001·0.15² and 1.5·400·cos 30°.
    assert by_result.keys() >= {"0.00668917kg·m²", "519.615N"}


def test_a_parameter_with_a_changed_sign_is_substituted_by_its_result(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """-F = -400 N, and not -F = -400 = -400 N; the sign of a calculated value is worked as any formula."""
    folder, file = tmp_path / "machines", tmp_path / "mine.yaml"
    folder.mkdir()
    made = FILE.replace("FORMULA", "a").replace("[k*F*cos(beta), k*F*cos(beta)]", "[-F, -k*F*cos(beta)]")
    (folder / "made.yaml").write_text(made, "utf-8")
    monkeypatch.setenv(ATLAS_VARIABLE, str(folder))
    file.write_text("kind: atlas/made\nparameters: {}\n", "utf-8")
    (opposite,) = [one for one in lines_of(file) if one.parts[0] == Negative(Symbol("F"))]
    assert opposite.parts[1:] == (Number(-400.0, unit="N"),)
    (part,) = [one for one in trees.lines(lines_of(file), "en") if one.result.replace(" ", "") == "-519.615N"]
    assert re.findall(r"\d+(?:\.\d+)?", part.substitution) == ["1.5", "400", "30"]


def test_loads_of_one_link_and_a_stiffness(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Two loads have two symbols; a unit that no quantity of a linkage has is that of the SI."""
    folder, file = tmp_path / "machines", tmp_path / "mine.yaml"
    folder.mkdir()
    sizes = ["F/2", "c1*a"]
    loads = ", ".join(f"{{by: constant, link: 3, at: E, F: {size}, direction: 0 deg}}" for size in sizes)
    with_stiffness = FILE.replace("FORMULA", "k*a*sin(beta)").replace(
        "parameters:\n", "parameters:\n  c1: {default: 2 N/mm}\n"
    )
    (folder / "made.yaml").write_text(re.sub(r"loads: .*", f"loads: [{loads}]", with_stiffness), "utf-8")
    monkeypatch.setenv(ATLAS_VARIABLE, str(folder))
    file.write_text("kind: atlas/made\nparameters: {}\n", "utf-8")
    assert [one for one in catalogue.check(file) if "error" in str(one)] == []
    chains = lines_of(file)
    heads = {chain.parts[0]: line for chain, line in zip(worked(chains), trees.lines(chains, "en"), strict=True)}
    assert misses(list(heads.values())) == []
    half, spring = heads[Symbol("P", "3")], heads[Symbol("P", "3a")]
    assert half.result.replace(" ", "") == "0.2kN"
    assert re.findall(r"\d+(?:\.\d+)?", spring.substitution) == ["2000", "0.06"]
    assert spring.result.replace(" ", "") == "120N"


@pytest.mark.parametrize("language", languages())
def test_the_report_has_the_lines_and_the_names_of_the_machine(language: Language) -> None:
    """The length L of the jaw is not a length of a link, so the table of given data lists it for these lines."""
    sample = min(catalogue.examples("atlas/jaw-crusher").values())
    document = open_case(sample, language).document()
    printed = [chain.parts[-2:] for chain in trees.chains(document)]
    assert [line.parts[-2:] for line in lines_of(sample) if line.parts[-2:] not in printed] == []
    words, text = machine_words(atlas_files()["atlas/jaw-crusher"], language), text_of(document)
    rows = [line for line in text.splitlines() if line.casefold().startswith(words["parameters"]["L"])]
    assert any("700" in row for row in rows), rows
    # Links have their names where their group, their motion, mass centre, load and equilibrium are introduced.
    marks = "（{}）" if language == "zh" else "({})"
    counts = {link: text.count(marks.format(name)) for link, name in words["links"].items()}
    assert counts.items() >= {"1": 2, "2": 3, "3": 4, "4": 3, "5": 5}.items()


@pytest.mark.parametrize(
    ("name", "symbol"),
    [("m2", Symbol("m", "2")), ("O1A", Symbol("l", "O1A")), ("beta", Symbol("β")), ("Fmax", Symbol("F", "max"))],
)
def test_a_parameter_has_the_symbol_of_its_name(name: str, symbol: Symbol) -> None:
    assert own_symbol(name) == symbol
