"""Digits that a person would write, in every file of the repository and in variants of every kind."""

from __future__ import annotations

from collections import defaultdict
from pathlib import Path

import numpy as np
import pytest

from reportgen.cases import MachineCase
from reportgen.derivation import ONE_QUANTITY
from reportgen.formula.calculation import is_short, is_typed
from tests.derivation.printed import MEDIAN, SHARE, differences, largest
from tests.derivation.random_variants import cases
from tests.lanes import matrix
from tests.report import built

VARIANTS, FEW = 20, 2
FIGURES = 5
"""Of a computed quantity's largest value."""
GIVEN_WITH = {
    "segment": 2,
    "angle": 2,
    "direction": 1,
    "count": 0,
    "sign": 0,
    "share": 3,
    "trial angle": 4,
    "trial length": 7,
}
"""Decimals of what is not told by figures."""


@pytest.mark.parametrize("path", matrix(built.ALL, built.TELLING), ids=lambda path: path.stem)
def test_files(path: Path) -> None:
    """A computed quantity has five figures at its largest or is short; one quantity has one number of decimals."""
    case = built.case(path, built.own_language(path))
    ledger, printed = case.ledger, case.printed
    together = defaultdict(set)
    for id, family in ledger.families.items():
        decimals = printed.decimals[id]
        if family.hidden or family.is_plane or family.definition is None or not (size := largest(family)):
            continue
        values = printed[id].values / family.how.scale
        if decimals is None:
            assert is_short(values) or is_typed(values), id
            continue
        together[family.symbol, family.kind].add(decimals)
        if family.kind in GIVEN_WITH:
            assert decimals == GIVEN_WITH[family.kind], id
        else:
            figures = decimals + 1 + int(np.floor(np.log10(size / family.how.scale) + 1e-12))
            assert figures <= FIGURES + ("scale" in family.kind) or decimals == 0, id
    assert {name: found for name, found in together.items() if len(found) > 1} == {}
    for same in ONE_QUANTITY:
        assert len({printed.decimals[id] for id in same if id in ledger} - {None}) <= 1, same


def assert_near(case: MachineCase) -> None:
    """What is printed lies near what is unrounded."""
    found = list(differences(case.ledger, case.printed))
    assert [off for off in found if off.share > 1] == []
    assert np.median([off.share for off in found if off.what == "computed"]) * SHARE <= MEDIAN


@pytest.mark.parametrize("path", built.TYPESET, ids=lambda path: path.stem)
def test_a_few_variants(path: Path, tmp_path: Path) -> None:
    for case in cases(path, FEW, tmp_path):
        assert_near(case)


@pytest.mark.proof
@pytest.mark.parametrize("path", built.TYPESET, ids=lambda path: path.stem)
def test_variants(path: Path, tmp_path: Path) -> None:
    for case in cases(path, VARIANTS, tmp_path):
        assert_near(case)
