"""Hundreds of spoilt files of each kind, title blocks and templates among them: results or located faults."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests import fuzz
from tests.lanes import proof

pytestmark = proof

CASES, PARTS, SEED = 600, 6, 16


@pytest.mark.parametrize("part", range(PARTS))
@pytest.mark.filterwarnings("ignore::RuntimeWarning")
def test_spoilt_files_come_to_results_or_faults(tmp_path: Path, part: int) -> None:
    """No traceback, no nan in results, both torques the same to nine figures."""
    outcomes = [fuzz.attempt(number, SEED, tmp_path) for number in range(part, CASES, PARTS)]
    assert [(one.number, one.kind, one.wrong) for one in outcomes if one.wrong] == []
    # Both ends are met, or the test would see little.
    assert {"right", "fault"} <= {one.came_to for one in outcomes}
