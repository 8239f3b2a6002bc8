"""Reports of cams: every line recomputes from its printed operands, every cell from the lines, in both languages."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from reportgen import document as tree
from reportgen.base.units import Language
from reportgen.case.design_case import DesignCase
from reportgen.cases import open_case
from reportgen.formula import Chain, Number, Symbol, walk
from reportgen.formula.evaluation import evaluate
from reportgen.marking.toleranced_key import key_of
from tests.lanes import matrix
from tests.report import built

FILES = sorted((Path(__file__).parents[2] / "assignments" / "cam").glob("*.yaml"))
CASES = [(file.stem, language) for file in FILES for language in ("vi", "en")]
TELLING = [("roller-01", "vi"), ("shaper-feed", "en"), ("knife-01", "en"), ("rocker-flat-01", "en"), ("flat-01", "vi")]


ZERO = 0.0005
"""Half a unit of the last decimal of lengths (mm)."""


def file_of(name: str) -> Path:
    return next(file for file in FILES if file.stem == name)


def chains(blocks: tuple[tree.Block, ...]) -> Iterator[Chain]:
    for block in blocks:
        if isinstance(block, tree.Equation):
            yield from (row for row in block.rows if isinstance(row, Chain))


def recomputes(chain: Chain) -> bool | None:
    """Whether the line's last formula comes to its result as it is printed; None for a line without numbers in it."""
    *_, formula, result = chain.parts
    if not isinstance(result, Number) or len(chain.parts) < 3:
        return None
    if any(isinstance(part, Symbol) and part.value is None for part in walk(formula)):
        return None
    value = float(evaluate(formula))
    value = math.degrees(value) if result.unit == "°" else value
    # What is nothing is printed as 0: the values of a graph leave half a thousandth at most.
    half = ZERO if result.value == 0 else result.half_unit
    # Exact results are free of the dust of floats; ties may fall either way.
    return abs(value - result.printed) <= half * (1 + 1e-6) + 1e-9 * max(abs(value), 1)


@pytest.mark.parametrize(("name", "language"), matrix(CASES, TELLING))
def test_every_line_recomputes(name: str, language: Language) -> None:
    case = built.case(file_of(name), language)
    found = [recomputes(chain) for chain in chains(case.document().blocks)]
    assert found.count(True) >= 10
    assert False not in found


@pytest.mark.parametrize("name", [file.stem for file in FILES])
def test_every_value_recomputes_from_printed_ones(name: str) -> None:
    """Each quantity at each position, from the printed values of what its line names; and the ledger is the cam's."""
    case = built.case(file_of(name), "en")
    written = case.printed
    for id, family in written.families.items():
        if family.definition is None or family.hidden:
            continue
        positions = range(1, len(family.values) + 1) if len(family.values) > 1 else (None,)
        for k in positions:
            chain = written.chain(id, k)
            assert recomputes(chain) in (True, None), (id, k)
    profile, ledger = case.solution.profile, case.ledger.evaluate()  # type: ignore[attr-defined]
    pairs = {"cam.s": profile.s, "cam.psi": profile.s, "cam.alpha": profile.alpha, "cam.rho": profile.rho}
    if not case.solution.cam.flat:  # type: ignore[attr-defined]
        pairs |= {"cam.pitch.x": profile.pitch.real, "cam.pitch.y": profile.pitch.imag}
    pairs |= {"cam.profile.x": profile.working.real, "cam.profile.y": profile.working.imag}
    for id, values in pairs.items():
        if id in ledger:
            assert np.abs(ledger[id] - values).max() <= 1e-12 * np.abs(values).max(), id


def test_a_corrupted_digit_is_caught() -> None:
    line = Chain((Symbol("x"), Number(2.0) * Number(1.5, 1), Number(3.1, 1)))
    assert recomputes(line) is False


@pytest.mark.parametrize("language", ["vi", "en"])
def test_a_short_report_has_less(language: str) -> None:
    from reportgen.api import load
    from reportgen.cases import opened

    assignment = load(file_of("roller-01"), language)  # type: ignore[arg-type]
    full, short = (len(opened(assignment.with_extent(one)).document().blocks) for one in ("full", "short"))  # type: ignore[arg-type]
    assert short < full


def test_the_words_of_both_languages_name_the_same() -> None:
    """No row of a key is without words, in either language."""
    for file in FILES:
        for language in ("vi", "en"):
            rows = key_of(open_case(file, language)).rows  # type: ignore[arg-type]
            assert [row.id for row in rows if not row.what] == [], (file.stem, language)


@pytest.mark.parametrize("name", ["cam/roller-01", "gears/pair-least-shift", "gears/train-single", "rotor/disc"])
def test_a_design_has_no_figure_of_an_unknown_name(name: str) -> None:
    case = open_case(built.ROOT / "assignments" / f"{name}.yaml", "en")
    assert isinstance(case, DesignCase)
    with pytest.raises(KeyError):
        list(case.PAGE(case).scenes("profil"))
