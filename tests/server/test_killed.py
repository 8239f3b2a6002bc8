"""A server that is killed at any moment has every cell and upload that it confirmed, each of them once."""

from __future__ import annotations

import shutil
from pathlib import Path

from tests.lanes import proof
from tests.server.kills import Typist, faults, killed

ROUNDS, STUDENTS = 6, ("S1", "S2", "S3")


@proof
def test_nothing_confirmed_is_lost_and_nothing_is_there_twice(made_class: Path, tmp_path: Path) -> None:
    folder = tmp_path / "class"
    shutil.copytree(made_class, folder)
    typists: dict[str, Typist] = {}
    for number in range(ROUNDS):
        killed(folder, typists, 0.6 + 0.35 * number)
    assert set(typists) == set(STUDENTS)
    assert all(len(typist.confirmed) > ROUNDS for typist in typists.values())
    assert faults(folder, typists) == []
