"""Hundreds of spoilt files of each kind, including templates and title blocks, give results or located faults."""

from __future__ import annotations

import random
import re
import subprocess
from pathlib import Path

import pytest

from tests import fuzz
from tests.lanes import proof

pytestmark = proof

CASES, PARTS, SEED = 600, 6, 16


@pytest.mark.parametrize("part", range(PARTS))
@pytest.mark.filterwarnings("ignore::RuntimeWarning")
def test_spoilt_files_come_to_results_or_faults(tmp_path: Path, part: int) -> None:
    """There is no traceback, no nan in results, and both torques agree to nine figures."""
    outcomes = [fuzz.attempt(number, SEED, tmp_path) for number in range(part, CASES, PARTS)]
    assert [(one.number, one.kind, one.wrong) for one in outcomes if one.wrong] == []
    # Both outcomes must occur, or the test would check little.
    assert {"right", "fault"} <= {one.came_to for one in outcomes}


def test_what_is_done_outside_is_heard(tmp_path: Path) -> None:
    """A file written outside the folder, a forbidden read, and a command are each reported with their file."""
    (tmp_path / "in").mkdir()

    def reaching(number: int, chance: random.Random, folder: Path) -> None:
        (folder / "a.yaml").write_text("allowed", encoding="utf-8")
        (folder.parent / "out").write_text("written", encoding="utf-8")
        Path("/etc/passwd").read_bytes()
        subprocess.run(("true",), check=True)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(fuzz, "KINDS", dict.fromkeys(fuzz.KINDS, reaching))
        wrong = fuzz.attempt(0, SEED, tmp_path / "in").wrong
    assert re.findall(r"(open|subprocess.Popen) (\S+?)(?:,|$)", wrong)[:3] == [
        ("open", str(tmp_path / "out")),
        ("open", "/etc/passwd"),
        ("subprocess.Popen", "true"),
    ]
