"""A reader with a calculator comes to every printed digit: read from the typesetter's source, and in the tree."""

from __future__ import annotations

import re
from itertools import cycle
from pathlib import Path
from typing import Any

import pytest

from reportgen import api
from reportgen.base.units import Language
from reportgen.document import Document
from reportgen.report.composing import compose
from reportgen.writers import latex, typst
from tests.derivation.random_variants import cases
from tests.exercise.test_exercise_equations import OF_SEVERAL, by_equations
from tests.lanes import matrix
from tests.report import built, trees
from tests.report.calculator import misses
from tests.report.source_lines import latex_formulas, typst_formulas, worked_lines
from tests.report.source_tables import cells, columns, extremes

EXERCISES = sorted((built.ROOT / "assignments" / "plane-motion").glob("*.yaml"))
YOKE = built.ROOT / "assignments" / "scotch-yoke-01.yaml"
SLIDER = built.ROOT / "assignments" / "slider-crank-01.yaml"
SHAPER = built.ROOT / "assignments" / "shaper-01.yaml"
MACHINES = [*built.TYPESET, built.SLIDE]
"""One file a kind, and a sliding driver."""
VARIANTS = 4


def all_worked(path: Path, folder: Path) -> Path:
    """A copy of an assignment whose report works out every position."""
    text, count = re.subn(r"worked_positions: *\[.*?\]", "worked_positions: all", path.read_text(encoding="utf-8"))
    assert count == 1
    copy = folder / path.name
    copy.write_text(text, encoding="utf-8")
    return copy


def assert_lines_hold(document: Document) -> int:
    """By both writers; the reader sees every line of the tree."""
    steps = sum(len(list(trees.steps(chain))) for chain in trees.chains(document))
    for formulas in (typst_formulas(typst.write(document)), latex_formulas(latex.write(document))):
        lines = worked_lines(formulas)
        assert misses(lines) == []
        assert len(lines) == steps
    return steps


def by_language(paths: list[Path], telling: list[tuple[Path, Language]]) -> list[Any]:
    found = [pytest.param(path, language, id=f"{path.stem}-{language}") for path in paths for language in ("vi", "en")]
    return matrix(found, telling)


@pytest.mark.parametrize(
    ("path", "language"),
    matrix([pytest.param(*turn, id=f"{turn[0].stem}-{turn[1]}") for turn in zip(MACHINES, cycle(("vi", "en")))], []),
)
def test_machines(path: Path, language: Language, tmp_path: Path) -> None:
    """Every position worked out; cells of tables show what the lines do."""
    document = api.document(api.load(all_worked(path, tmp_path), language))
    assert assert_lines_hold(document) > 200
    compared = list(cells(typst.write(document)))
    assert [cell for cell in compared if not cell.agrees] == []
    assert len(compared) > 100


@pytest.mark.parametrize("path", matrix(MACHINES, [YOKE, SHAPER]), ids=lambda path: path.stem)
def test_tables_agree_with_one_another(path: Path) -> None:
    """The difference of two torques is that of those printed; no extreme lies inside what a table shows."""
    source = typst.write(built.written(path, built.own_language(path)).document)
    shown = columns(source)
    assert len(shown) > 10
    largest = {symbol: {max(map(abs, one.values())) for one in some} for symbol, some in shown.items()}
    assert {symbol: size for symbol, size in extremes(source) if size not in largest.get(symbol, {size})} == {}
    ways = [column for symbol, some in shown.items() if symbol.endswith(('^("(1)")', '^("(2)")')) for column in some]
    differences = [column for symbol, some in shown.items() if "Δ" in symbol for column in some]
    assert len(ways) == 2 * len(differences)
    for difference in differences:
        assert difference == {k: abs(ways[0][k] - ways[1][k]) for k in difference}


@pytest.mark.parametrize(
    ("path", "language"),
    by_language(EXERCISES, [(path, "vi") for path in EXERCISES if path.stem in ("01", "08", "20")]),
)
def test_exercises(path: Path, language: Language) -> None:
    assert_lines_hold(api.document(api.load(path, language)))


@pytest.mark.parametrize(
    ("path", "language"),
    by_language(
        [path for path in EXERCISES if path.stem not in OF_SEVERAL],
        [(path, "en") for path in EXERCISES if path.stem in ("08", "20")],
    ),
)
def test_exercises_by_their_equations(path: Path, language: Language, tmp_path: Path) -> None:
    assert_lines_hold(api.document(api.load(by_equations(path, tmp_path), language)))


def test_one_corrupted_digit_is_caught(tmp_path: Path) -> None:
    lines = worked_lines(typst_formulas(typst.write(api.document(api.load(all_worked(YOKE, tmp_path))))))
    assert [wrong for line in lines for wrong in line.corrupted if wrong.holds] == []


# --- random variants ------------------------------------------------------------------------------


def assert_variants_hold(path: Path, count: int, folder: Path) -> None:
    for case in cases(path, count, folder):
        chains = (*trees.chains(compose(case)), *trees.every_chain(case.printed))
        lines = trees.lines(chains, "en")
        assert misses(lines) == []
        assert len(lines) > 200


def test_a_variant(tmp_path: Path) -> None:
    """The first of those that `make proof` takes."""
    assert_variants_hold(SLIDER, 1, tmp_path)


@pytest.mark.proof
@pytest.mark.parametrize("path", built.TYPESET, ids=lambda path: path.stem)
def test_variants(path: Path, tmp_path: Path) -> None:
    assert_variants_hold(path, VARIANTS, tmp_path)
