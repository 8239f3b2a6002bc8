"""Every line of made linkages recomputes as it is written down, and the ledger evaluates itself."""

from __future__ import annotations

import numpy as np
import pytest
from books import MACHINES, RATE, keep
from made_triads import R1
from test_loops import looped

from reportgen.formula.rounded_ledger import printed
from tests.lanes import matrix
from tests.report import trees
from tests.report.calculator import misses

ROUND = np.radians(17.0 + 30.0 * np.arange(12))
"""Positions of a turn at which no length or force happens to vanish."""
DEAD = np.radians([90.0, 270.0])
"""Crank across x: links that shift for a moment, forces that pass through a pin."""


@pytest.mark.parametrize("turn", matrix([1, -1], [1]))
@pytest.mark.parametrize("name", MACHINES)
def test_every_kind_recomputes(name: str, turn: int) -> None:
    ledger = printed(keep(MACHINES[name], turn * np.append(ROUND, DEAD), turn).ledger())
    lines = trees.lines(trees.every_chain(ledger), "en")
    assert len(lines) > 200
    assert misses(lines) == []


def test_a_group_of_class_iii_recomputes() -> None:
    """The arm by which the moments about the special point are divided is negative: all signs change.

    The lines of its closed formulas contain every number of the iteration for its angles.
    """
    book = keep(R1, ROUND[:4], 1, (), ((4, 60.0),))
    looped(book)
    arms = [family for id, family in book.b.families.items() if id.startswith("h.R0") and ".n." in id]
    assert arms
    assert all((family.values < 0).all() for family in arms)
    lines = trees.lines(trees.every_chain(printed(book.ledger())), "en")
    assert len(lines) > 400
    assert sum("Δφ" in str(line) for line in lines) >= 2 * 2 * 4
    assert misses(lines) == []


@pytest.mark.parametrize("name", MACHINES)
def test_evaluates_itself(name: str) -> None:
    ledger = keep(MACHINES[name], ROUND).ledger()
    values = ledger.evaluate()
    for id, family in ledger.families.items():
        np.testing.assert_array_equal(values[id], family.values, err_msg=id)


@pytest.mark.parametrize("name", MACHINES)
def test_changes_follow_through(name: str) -> None:
    """Twice the speed: velocities double and accelerations are four times as great, reactions follow."""
    ledger = keep(MACHINES[name], ROUND).ledger()
    changed = ledger.evaluate({"omega.1": 2 * RATE})
    faster = keep(MACHINES[name], ROUND).b
    for id, family in ledger.families.items():
        factor = {"v.": 2.0, "a.": 4.0}.get(id[:2])
        if factor is not None:
            np.testing.assert_allclose(changed[id], factor * faster.value(id), rtol=1e-9, err_msg=id)
        assert np.isfinite(changed[id]).all() or not np.isfinite(family.values).all(), id
    assert not np.allclose(changed["M.eq"], ledger["M.eq"].values)
