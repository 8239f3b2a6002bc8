"""A copy of the class is whole, however many are made at once."""

from __future__ import annotations

import shutil
import threading
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from reportgen.base.errors import ReportgenError
from reportgen.server import backups
from reportgen.server.backups import back_up
from tests.server.served import Served


def test_two_copies_at_once_are_both_whole(served: Served, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    both, copy_database = threading.Barrier(2), backups._copy_database

    def copied(source: Path, target: Path) -> None:
        both.wait(20)
        copy_database(source, target)

    monkeypatch.setattr(backups, "_copy_database", copied)
    with ThreadPoolExecutor(2) as threads:
        calls = [threads.submit(back_up, served.folder, tmp_path / "copies") for _ in range(2)]
        made = [call.result() for call in calls]
    assert len(set(made)) == 2
    for copy in made:
        assert (copy / "server" / "class.db").is_file()
        assert (copy / "roster.csv").is_file()
    assert sorted((tmp_path / "copies").iterdir()) == sorted(made)


def test_a_copy_that_loses_its_folder_is_no_copy(
    served: Served, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    copy_database = backups._copy_database

    def copied(source: Path, target: Path) -> None:
        copy_database(source, target)
        shutil.rmtree(target.parents[1])

    monkeypatch.setattr(backups, "_copy_database", copied)
    with pytest.raises(ReportgenError):
        back_up(served.folder, tmp_path / "copies")
    assert not list((tmp_path / "copies").iterdir())
