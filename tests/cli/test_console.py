"""Bare `reportgen` that was double-clicked on Windows opens the chooser; with a shell in its console it does not."""

from __future__ import annotations

import ctypes
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from typer.testing import CliRunner

from reportgen.cli import app
from reportgen.page import file_watch

PYTHON, LAUNCHER = r"C:\Python\python.exe", r"C:\Python\Scripts\reportgen.exe"


class Kernel:
    """The calls of the console of Windows, for a console with processes of these programs."""

    def __init__(self, *programs: str) -> None:
        self.programs, self.open = programs, 0

    def GetConsoleProcessList(self, processes: Any, most: int) -> int:
        if len(self.programs) <= most:
            processes[: len(self.programs)] = [4 * (number + 1) for number in range(len(self.programs))]
        return len(self.programs)

    def OpenProcess(self, access: int, inherit: bool, process: int) -> int:
        self.open += 1
        return process

    def QueryFullProcessImageNameW(self, handle: int, form: int, name: Any, size: Any) -> int:
        name.value = self.programs[handle // 4 - 1]
        return int(bool(name.value))

    def CloseHandle(self, handle: int) -> int:
        self.open -= 1
        return 1


@pytest.mark.parametrize(
    ("programs", "chooses"),
    [
        ([PYTHON], True),
        ([PYTHON, LAUNCHER], True),
        ([PYTHON, LAUNCHER, r"C:\Windows\System32\cmd.exe"], False),
        ([PYTHON, r"C:\Program Files\PowerShell\7\pwsh.exe"], False),
        ([PYTHON, ""], False),
        ([PYTHON] * 99, False),
        ([], False),
    ],
)
def test_what_is_double_clicked_lets_choose_a_kind(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, programs: list[str], chooses: bool
) -> None:
    kernel, chosen = Kernel(*programs), []
    monkeypatch.setattr(ctypes, "windll", SimpleNamespace(kernel32=kernel), raising=False)
    monkeypatch.setattr(file_watch, "choose", lambda *_, browser, **more: chosen.append((Path.cwd(), browser)))
    # The working folder of a program that is double-clicked is its own, which is no place for a coursework.
    (scripts := tmp_path / "Scripts").mkdir()
    (home := tmp_path / "home").mkdir()
    monkeypatch.chdir(scripts)
    monkeypatch.setattr("sys.argv", [str(scripts / "reportgen.exe")])
    monkeypatch.setattr(Path, "home", lambda: home)
    done = CliRunner().invoke(app, [])
    assert chosen == ([(home, True)] if chooses else [])
    assert done.exit_code == 0
    assert bool(done.stdout) != chooses
    assert kernel.open == 0
