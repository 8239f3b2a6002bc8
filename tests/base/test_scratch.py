"""Temporary files stand beside the results, for their owner alone, and go: those of a killed run at the next start."""

from __future__ import annotations

import errno
import os
import signal
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from reportgen.api import typesetting
from reportgen.base.errors import OutputError
from reportgen.base.files import PREFIX, held, put_files, scratch, sweep
from reportgen.cli import app
from tests.lanes import proof

ROOT = Path(__file__).parents[2]
SAMPLE = "assignments/slotted-lever-01.yaml"
HOLD = """
import sys, tempfile, time
from pathlib import Path
from reportgen.base.files import scratch
with scratch(Path(sys.argv[1])) as folder:
    Path(tempfile.mkdtemp(), "assignment.yaml").write_text("a student's")
    print(folder, flush=True)
    time.sleep(60)
"""


def test_they_are_the_owners_alone_and_go(tmp_path: Path) -> None:
    out = tmp_path / "a" / "out"
    before = tempfile.gettempdir()
    with scratch(out) as folder:
        assert folder.parent == out
        assert folder.stat().st_mode & 0o777 == 0o700
        assert Path(tempfile.mkdtemp()).parent == folder
    assert tempfile.gettempdir() == before
    # What was made for it alone goes with it.
    assert list(tmp_path.iterdir()) == []


def test_what_a_killed_run_left_is_swept_and_what_another_uses_is_not(tmp_path: Path) -> None:
    runs = [subprocess.Popen((sys.executable, "-c", HOLD, tmp_path), stdout=subprocess.PIPE, text=True) for _ in "12"]
    folders = [Path((run.stdout.readline() if run.stdout else "").strip()) for run in runs]
    try:
        runs[0].send_signal(signal.SIGKILL)
        runs[0].wait()
        assert any(folders[0].rglob("assignment.yaml"))
        sweep(tmp_path)
        assert not folders[0].exists()
        assert any(folders[1].rglob("assignment.yaml"))
    finally:
        for run in runs:
            run.kill()
            run.wait()
            if run.stdout:
                run.stdout.close()
    with scratch(tmp_path):
        assert not folders[1].exists()
    assert list(tmp_path.glob(f"{PREFIX}*")) == []


def test_a_sweep_ends_where_another_run_removes_the_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    out, scandir = tmp_path / "out", os.scandir
    out.mkdir()

    def removed(path: Path) -> Any:
        if Path(path) == out:
            out.rmdir()
        return scandir(path)

    monkeypatch.setattr(os, "scandir", removed)
    sweep(out)
    assert not out.exists()


SWEEP = """
import sys
from pathlib import Path
from reportgen.base.files import sweep
print(flush=True)
while True:
    sweep(Path(sys.argv[1]))
"""
WORK = """
import sys, tempfile
from pathlib import Path
from reportgen.base.files import put_files, scratch
out = Path(sys.argv[1])
for number in range(int(sys.argv[2])):
    with scratch(out) as folder:
        for part in "abc":
            made = Path(tempfile.mkdtemp())
            (made / part).write_text(part)
            assert (made / part).read_text() == part
        put_files(out / f"{sys.argv[3]}-{number}", {"report.pdf": b"x"})
    assert not folder.exists()
"""


@contextmanager
def sweeping(out: Path) -> Iterator[None]:
    """Three processes that only sweep."""
    command = (sys.executable, "-c", SWEEP, str(out))
    sweepers = [subprocess.Popen(command, stdout=subprocess.PIPE) for _ in range(3)]
    try:
        for sweeper in sweepers:
            assert sweeper.stdout is not None
            sweeper.stdout.readline()
        yield
        assert [sweeper.poll() for sweeper in sweepers] == [None] * 3
    finally:
        for sweeper in sweepers:
            sweeper.kill()
            sweeper.communicate()


@proof
def test_no_run_loses_its_folder_to_those_who_sweep(tmp_path: Path) -> None:
    with sweeping(tmp_path):
        works = [
            subprocess.Popen((sys.executable, "-c", WORK, tmp_path, "20", name), stderr=subprocess.PIPE, text=True)
            for name in "12"
        ]
        told = [work.communicate(timeout=120)[1] for work in works]
        assert told == ["", ""]
    assert list(tmp_path.glob(f"{PREFIX}*")) == []
    assert len(list(tmp_path.glob("*/report.pdf"))) == 40


BUILDS, AT_ONCE = 40, 4


@proof
def test_no_build_fails_beside_those_who_sweep(tmp_path: Path) -> None:
    """Whole builds, several at once, each a process of its own with a report of its own in one common folder."""
    text = (ROOT / "assignments" / "plane-motion" / "01.yaml").read_text(encoding="utf-8")
    out, files = tmp_path / "out", [tmp_path / f"k{number}.yaml" for number in range(BUILDS)]
    for file in files:
        file.write_text(text, encoding="utf-8")

    def build(file: Path) -> tuple[int, str, str]:
        command = (sys.executable, "-m", "reportgen.cli", "build", str(file), "--out", str(out))
        done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=300, check=False)
        return done.returncode, done.stdout, done.stderr

    with sweeping(out), ThreadPoolExecutor(AT_ONCE) as builders:
        assert list(builders.map(build, files)) == [(0, f"{out / file.stem / 'report.pdf'}\n", "") for file in files]
    assert list(out.glob(f"{PREFIX}*")) == []
    assert {path.parent.name for path in out.glob("*/report.pdf")} == {file.stem for file in files}


@pytest.mark.parametrize("lost", ["swept", "held by a sweep"])
def test_a_folder_lost_before_it_was_locked_is_made_anew(
    tmp_path: Path, lost: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    make, made, locks = tempfile.mkdtemp, [], ExitStack()

    def mkdtemp(suffix: str | None = None, prefix: str | None = None, dir: Path | None = None) -> str:
        made.append(Path(make(suffix, prefix, dir)))
        if len(made) == 1:
            if lost == "swept":
                sweep(tmp_path)
            else:
                locks.enter_context(held(made[0]))
        return str(made[-1])

    monkeypatch.setattr(tempfile, "mkdtemp", mkdtemp)
    with locks, scratch(tmp_path) as folder:
        assert folder == made[1]
        sweep(tmp_path)
        assert folder.exists()
    assert not folder.exists()


@pytest.mark.parametrize("command", ["build", "key"])
def test_no_command_writes_to_the_temporary_directory_of_the_system(
    tmp_path: Path, command: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of two engines the one that needs files: it is stopped when it is called, and tells where it stands."""
    seen: list[str] = []

    def typeset(*_: object) -> tuple[str, bytes]:
        seen.append(tempfile.gettempdir())
        return "", b""

    monkeypatch.setattr(typesetting, "typeset", typeset)
    out = tmp_path / "out"
    assert CliRunner().invoke(app, [command, SAMPLE, "--out", str(out), "--engine", "latex"]).exit_code == 0
    assert [Path(place).parent for place in seen] == [out]


def test_a_full_disk_names_the_path_and_leaves_no_empty_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(_: Path, content: bytes) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(Path, "write_bytes", full)
    with pytest.raises(OutputError) as told:
        put_files(tmp_path / "id", {"report.pdf": b"x"})
    assert str(told.value) == f"{tmp_path / 'id' / 'report.pdf'}: No space left on device"
    assert list(tmp_path.iterdir()) == []
