"""Sets of files: put in place together or not at all, whatever fails and whenever."""

from __future__ import annotations

import errno
import os
import shutil
from pathlib import Path

import pytest

from reportgen.base.errors import OutputError
from reportgen.base.files import put_files
from reportgen.base.provenance import RECORD, put_made

MINE = {"mine.xlsx": b"mine"}
OLD = {"key.pdf": b"old pdf", "key.xlsx": b"old xlsx", "key.csv": b"old csv", **MINE}
NEW = {"key.pdf": b"new pdf", "key.json": b"new json", "key.xlsx": b"new xlsx"}


def content(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.iterdir() if path.name != RECORD}


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    put_made(tmp_path, {name: text for name, text in OLD.items() if name not in MINE}, "key", {"assignment": "old"})
    (tmp_path / "mine.xlsx").write_bytes(b"mine")
    return tmp_path


def test_a_new_set_leaves_nothing_of_the_old_one(folder: Path) -> None:
    put = put_made(folder, NEW, "key", {"assignment": "new"})
    assert (put.paths, put.gone, put.left) == (tuple(folder / name for name in NEW), (folder / "key.csv",), ())
    assert content(folder) == NEW | MINE
    assert {path.stat().st_nlink for path in folder.iterdir()} == {1}


@pytest.mark.parametrize("step", ["write_bytes", "replace", "unlink"])
@pytest.mark.parametrize("count", range(5))
@pytest.mark.parametrize("linked", [True, False], ids=["links", "copies"])
def test_a_full_disk_leaves_the_old_set_whole(
    folder: Path, monkeypatch: pytest.MonkeyPatch, step: str, count: int, linked: bool
) -> None:
    """Wherever the room ends: at some file's writing, its putting in place, or an old one's removal."""
    plain, left, record = getattr(Path, step), [count], (folder / RECORD).read_bytes()

    def failing(path: Path, *arguments: object, **others: object) -> object:
        left[0] -= 1
        if left[0] == -1:
            raise OSError(errno.ENOSPC, "No space left on device")
        return plain(path, *arguments, **others)

    def no_link(*_: object, **__: object) -> None:
        raise OSError(errno.EPERM, "no links here")

    monkeypatch.setattr(Path, step, failing)
    if not linked:
        monkeypatch.setattr(os, "link", no_link)
    said = ""
    try:
        put_made(folder, NEW, "key", {"assignment": "new"})
    except OutputError as error:
        said = str(error)
    monkeypatch.undo()
    if left[0] < 0:
        assert said.startswith(str(folder))
        assert said.endswith("No space left on device")
        assert content(folder) == OLD
        assert (folder / RECORD).read_bytes() == record
    else:
        assert not said
        assert content(folder) == NEW | MINE


def test_what_stands_in_the_way_is_found_before_anything_is_replaced(folder: Path) -> None:
    (folder / "key.xlsx").unlink()
    (folder / "key.xlsx").mkdir()
    with pytest.raises(OutputError, match=r"key\.xlsx"):
        put_made(folder, NEW, "key", {"assignment": "new"})
    shutil.rmtree(folder / "key.xlsx")
    assert content(folder) == {name: text for name, text in OLD.items() if name != "key.xlsx"}


@pytest.mark.parametrize("kind", ["report", "key", "sheet"])
def test_a_stranger_is_part_of_no_set(tmp_path: Path, kind: str) -> None:
    strangers = dict.fromkeys(("sheet-mine.pdf", "my-key.pdf", "report.typ", "report.pdf.bak", "answers.xlsx"), b"")
    put_files(tmp_path, strangers)
    assert put_made(tmp_path, {"new": b""}, kind, {}).left == ()
    assert content(tmp_path) == strangers | {"new": b""}
