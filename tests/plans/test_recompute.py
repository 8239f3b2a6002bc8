"""Every line that a ledger prints recomputes, and the ledger evaluates itself."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from books import MACHINES, RATE, keep
from recompute import excess, worst_lines

from reportgen import api
from reportgen.formula import Chain, Number
from reportgen.formula.ledger import Ledger
from reportgen.plans import write_ledger

ROUND = np.radians(17.0 + 30.0 * np.arange(12))
"""Positions of a turn at which no length or force happens to vanish."""
DEAD = np.radians([90.0, 270.0])
"""Crank across x: links that shift for a moment, forces that pass through a pin."""
SLACK = 1.02
"""Decimals are chosen to first order; what rounding does to second order is far below a last digit."""


@pytest.fixture(scope="module")
def engine() -> Ledger:
    """The twin engine's ledger, 16 positions."""
    file = Path(__file__).parents[2] / "assignments" / "engine-twin-05.yaml"
    return write_ledger(api.analyse(api.load(file))).ledger


def assert_recomputes(ledger: Ledger) -> None:
    lines = [line for line in worst_lines(ledger) if line[1] not in ledger.cancellations]
    assert lines
    assert max(lines)[0] <= SLACK, max(lines)


def test_engine_recomputes(engine: Ledger) -> None:
    assert engine.cancellations == ()
    assert_recomputes(engine)


@pytest.mark.parametrize("turn", [1, -1])
@pytest.mark.parametrize("name", MACHINES)
def test_every_kind_recomputes(name: str, turn: int) -> None:
    ledger = keep(MACHINES[name], turn * np.append(ROUND, DEAD), turn).ledger()
    assert_recomputes(ledger)
    # Sums and quotients of what nearly cancels may keep three digits only; they are listed, and few.
    printed = sum(not family.hidden for family in ledger.families.values())
    assert len(ledger.cancellations) <= 0.04 * printed


def test_wrong_digit_is_caught(engine: Ledger) -> None:
    chain = engine.chain("a.BA.n", 4)
    *parts, result = chain.parts
    assert isinstance(result, Number)
    assert result.decimals is not None
    assert excess(chain) <= SLACK
    off = replace(result, value=result.value + 3 * 10.0**-result.decimals)
    assert excess(Chain((*parts, off))) > 1


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


def test_two_ways_print_one_torque(engine: Ledger) -> None:
    for position in range(1, engine.positions + 1):
        assert engine.number("M.eq", position).shown == engine.number("M.vw", position).shown
