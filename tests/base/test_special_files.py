"""Pipes and devices in place of files: written into where the user names one, never replaced."""

from __future__ import annotations

import errno
import json
import os
import stat
import sys
import threading
from pathlib import Path

import pytest
from typer.testing import CliRunner

from reportgen.base import files
from reportgen.base.files import NotRegularError, put_file, put_files, put_set
from reportgen.cli import app

ASSIGNMENT = Path(__file__).parents[2] / "assignments" / "four-bar-01.yaml"

if not hasattr(os, "mkfifo"):
    pytest.skip("a system without named pipes", allow_module_level=True)


@pytest.fixture
def pipe(tmp_path: Path) -> Path:
    path = tmp_path / "pipe.json"
    os.mkfifo(path)
    return path


def test_results_go_into_a_pipe(pipe: Path) -> None:
    """Who reads from it has all of them, and it is a pipe still."""
    read: list[str] = []
    reader = threading.Thread(target=lambda: read.append(pipe.read_text(encoding="utf-8")))
    reader.start()
    done = CliRunner().invoke(app, ["solve", str(ASSIGNMENT), "--json", str(pipe)])
    reader.join()
    assert done.exit_code == 0
    assert json.loads(read[0])["kind"] == "four-bar"
    assert stat.S_ISFIFO(pipe.stat().st_mode)


def test_a_new_file_goes_into_a_pipe_though_something_is_there(pipe: Path) -> None:
    read: list[str] = []
    reader = threading.Thread(target=lambda: read.append(pipe.read_text(encoding="utf-8")))
    reader.start()
    done = CliRunner().invoke(app, ["new", "four-bar", "-o", str(pipe)])
    reader.join()
    assert done.exit_code == 0
    assert "kind: four-bar" in read[0]
    assert [path.name for path in pipe.parent.iterdir()] == [pipe.name]


def test_a_pipe_among_files_that_belong_together_is_refused(pipe: Path) -> None:
    """Nobody reads from it, perhaps, and what stands beside it stays."""
    beside = pipe.with_name("beside.json")
    beside.write_bytes(b"old")
    with pytest.raises(NotRegularError) as refused:
        put_set({beside: b"new", pipe: b"new"})
    assert refused.value.filename == str(pipe)
    assert (beside.read_bytes(), stat.S_ISFIFO(pipe.stat().st_mode)) == (b"old", True)
    assert sorted(path.name for path in pipe.parent.iterdir()) == ["beside.json", "pipe.json"]


def test_a_report_in_place_of_a_pipe_is_refused(tmp_path: Path) -> None:
    (tmp_path / "x").mkdir()
    os.mkfifo(tmp_path / "x" / "report.pdf")
    with pytest.raises(files.OutputError, match=r"report\.pdf: no regular file"):
        put_files(tmp_path / "x", {"report.pdf": b"%PDF"})


def test_what_is_open_already_is_written_into(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """/dev/stdout leads to a regular file where output is redirected: the link would be replaced."""
    target, link = tmp_path / "redirected", tmp_path / "dev" / "stdout"
    target.write_text("before\n")
    link.parent.mkdir()
    link.symlink_to(target)
    monkeypatch.setattr(files, "_STREAMS", (str(link.parent),))
    assert files.is_stream(link)
    files.write_stream(link, b"after\n")
    assert (target.read_text(), link.is_symlink()) == ("before\nafter\n", True)


def test_a_file_in_memory_is_a_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """What lies in /dev/shm is replaced as anywhere else."""
    target = tmp_path / "shm" / "x.json"
    target.parent.mkdir()
    monkeypatch.setattr(files, "_STREAMS", (str(tmp_path),))
    for content in (b"long before", b"after"):
        put_file(target, content)
    assert (files.is_stream(target), target.read_bytes()) == (False, b"after")


FULL = (1, 7)
"""Linux' numbers of the device that is always full."""


@pytest.fixture
def device(tmp_path: Path) -> Path:
    """A node of our own of the device that is always full, where one may be made and opened."""
    path = tmp_path / "full"
    try:
        os.mknod(path, stat.S_IFCHR | 0o600, os.makedev(*FULL))
        with path.open("wb", buffering=0):
            return path
    except OSError:
        pytest.skip("nodes of devices are for administrators")


@pytest.mark.skipif(sys.platform != "linux", reason="another system has other devices")
def test_a_full_device_is_named_alone(device: Path) -> None:
    """“None” is no second file."""
    done = CliRunner().invoke(app, ["solve", str(ASSIGNMENT), "--json", str(device), "--lang", "en"])
    assert done.exit_code == 3
    assert str(device) in done.output
    assert "None" not in done.output
    assert stat.S_ISCHR(device.stat().st_mode)


def test_a_full_disk_names_one_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(self: Path, content: bytes) -> int:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(Path, "write_bytes", full)
    with pytest.raises(OSError, match=r"x\.json") as failed:
        put_file(tmp_path / "x.json", b"{}")
    assert str(failed.value) == f"[Errno {errno.ENOSPC}] {os.strerror(errno.ENOSPC)}: '{tmp_path / 'x.json'}'"
