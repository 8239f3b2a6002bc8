"""Digits that a person would write, in every file of the repository and in variants of every kind."""

from __future__ import annotations

import math
from collections import defaultdict
from pathlib import Path

import numpy as np
import pytest
from random_variants import cases
from recompute import worst_lines

from reportgen.formula import ids
from reportgen.formula.ledger import Ledger
from reportgen.formula.sheet import ZERO, Family
from reportgen.formula.vocabulary import MAX_DIGITS, Chapter
from reportgen.plans import ONE_QUANTITY
from tests.lanes import matrix
from tests.report import built

RESULTS = {"velocity", "acceleration", "angular velocity", "angular acceleration", "force", "torque", "work", "power"}
CONSTANTS = {"omega.1"}
"""What many lines are computed with, and which therefore may have more figures than a result."""
VARIANTS = 4
LISTED = 0.01
"""Share of the printed quantities whose lines may be listed because their inputs have too few figures."""


def largest(family: Family) -> float:
    return float(np.nanmax(np.abs(family.values))) / family.how.scale


def printed(ledger: Ledger) -> dict[str, tuple[Family, int]]:
    """The quantities that are rounded, with their decimals; without those that are nothing."""
    return {
        id: (family, decimals)
        for id, family in ledger.families.items()
        if (decimals := ledger.decimals[id]) is not None and not (family.hidden or family.is_plane)
        if largest(family) > ZERO * max(1.0, family.scale / family.how.scale)
    }


def figures(value: float, decimals: int) -> int:
    """Significant figures of a value printed with so many decimals."""
    return decimals + 1 + math.floor(math.log10(value) + 1e-12)


def assert_lines_recompute(ledger: Ledger) -> None:
    lines = [line for line in worst_lines(ledger) if line[1] not in ledger.cancellations]
    assert max(lines)[0] <= 1, max(lines)
    assert len(ledger.cancellations) <= max(LISTED * len(printed(ledger)), 3)


def assert_figures(ledger: Ledger) -> None:
    """Results have three to five figures, or are whole numbers; mostly four."""
    together = {id: same for same in ONE_QUANTITY for id in same if id in ledger}
    computed = []
    for id, (family, decimals) in printed(ledger).items():
        if family.kind == "segment":
            assert decimals <= 2, id
        if family.kind in RESULTS and family.definition is not None and id not in CONSTANTS:
            size = max(largest(ledger[one]) for one in together.get(id, (id,)))
            computed.append(figures(size, decimals))
            assert computed[-1] <= 5 or decimals == 0, id
            # A small term of a sum has no more decimals than the sum itself could show.
            beside = max(size, family.scale / family.how.scale)
            assert computed[-1] >= 3 or figures(beside, decimals) >= MAX_DIGITS, id
    assert np.median(computed) in {3, 4}


def assert_one_quantity_has_one_number_of_decimals(ledger: Ledger) -> None:
    """By plan, with its sign and as a size; a formula or a check beside it differs rarely, and by two at most."""
    plans, all_ways = defaultdict(set), defaultdict(set)
    for id, (family, decimals) in printed(ledger).items():
        if family.kind != "segment":
            name = family.symbol, family.kind
            all_ways[name].add(decimals)
            if family.chapter is not Chapter.formulas and not any(id in name for name in ids.CENTRES):
                plans[name].add(decimals)
    assert {name: found for name, found in plans.items() if len(found) > 1} == {}
    differing = {name: found for name, found in all_ways.items() if len(found) > 1}
    assert {name: found for name, found in differing.items() if max(found) - min(found) > 2} == {}
    assert len(differing) <= 0.1 * len(all_ways), differing
    for same in ONE_QUANTITY:
        assert len({ledger.decimals[id] for id in same if id in ledger and ledger.decimals[id] is not None}) <= 1, same


def assert_a_person_would_write_it(ledger: Ledger) -> None:
    assert_lines_recompute(ledger)
    assert_figures(ledger)
    assert_one_quantity_has_one_number_of_decimals(ledger)


@pytest.mark.parametrize("path", matrix(built.FILES, built.TELLING), ids=lambda path: path.stem)
def test_files(path: Path) -> None:
    """A line that is listed for some position holds at those at which it is written out."""
    case = built.case(path, built.own_language(path))
    assignment, ledger = case.assignment, case.ledger
    assert_a_person_would_write_it(ledger)
    worked = {(k - 1) % turn + 1 for k in assignment.worked_positions for turn in (assignment.positions.count, 10**6)}
    assert [
        line for line in worst_lines(ledger) if line[1] in ledger.cancellations and line[2] in worked if line[0] > 1
    ] == []


@pytest.mark.parametrize("path", matrix(built.TYPESET, built.TYPESET[2:5]), ids=lambda path: path.stem)
def test_variants(path: Path, tmp_path: Path) -> None:
    for case in cases(path, VARIANTS, tmp_path):
        assert_a_person_would_write_it(case.ledger)
