"""Run the command line inside the test process.

A process of its own spends most of its time on loading the program. `process` starts one for tests of what only a
process shows: signals, limits of memory, what is loaded, the workers of a batch.
"""

from __future__ import annotations

import gc
import io
import os
import signal
import subprocess
import sys
import warnings
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, redirect_stderr, redirect_stdout
from dataclasses import dataclass
from pathlib import Path

import pytest

from reportgen import cli

ROOT = Path(__file__).parents[1]
PLAIN = {"PATH": "/usr/bin:/bin:/usr/local/bin", "COLUMNS": "100"}
"""Environment of a user without any settings."""
KEPT = ("XDG_CACHE_HOME",)
"""Variables that keep their values in all tests."""
SIGNALS = [getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name)]
"""Signals that a command handles itself."""


@dataclass(frozen=True)
class Done:
    """The result of a command: its exit code and its output."""

    returncode: int
    stdout: str
    stderr: str


def reportgen(*arguments: object, cwd: Path = ROOT, **environment: str) -> Done:
    """Run `reportgen` with these arguments through its entry point, in this process."""
    surroundings = {**PLAIN, **{name: os.environ[name] for name in KEPT if name in os.environ}, **environment}
    out, err = (io.TextIOWrapper(io.BytesIO(), encoding="utf-8") for _ in range(2))
    line = ["reportgen", *map(str, arguments)]
    alone = _as_if_alone(line, cwd, surroundings)
    with alone, redirect_stdout(out), redirect_stderr(err), pytest.raises(SystemExit) as end:
        cli.main()
    code = end.value.code or 0
    assert isinstance(code, int)
    return _sound(Done(code, _text(out), _text(err)))


def process(*arguments: object, cwd: Path = ROOT, **environment: str) -> Done:
    """Run `reportgen` with these arguments in a separate process."""
    done = subprocess.run(
        [sys.executable, "-m", "reportgen.cli", *map(str, arguments)],
        cwd=cwd,
        capture_output=True,
        text=True,
        encoding="utf-8",
        timeout=300,
        check=False,
        env={"PYTHONPATH": str(ROOT), **PLAIN, **environment},
    )
    return _sound(Done(done.returncode, done.stdout, done.stderr))


def _sound(done: Done) -> Done:
    assert "Traceback" not in done.stderr + done.stdout
    return done


def _text(stream: io.TextIOWrapper) -> str:
    stream.flush()
    assert isinstance(stream.buffer, io.BytesIO)
    return stream.buffer.getvalue().decode()


@contextmanager
def _as_if_alone(line: list[str], cwd: Path, environment: Mapping[str, str]) -> Iterator[None]:
    """Give this process another command line, folder and environment for the duration of the block."""
    handlers = {number: signal.getsignal(number) for number in SIGNALS}
    surroundings = dict(os.environ)
    with pytest.MonkeyPatch.context() as patch, warnings.catch_warnings():
        # As Python sets it by default.
        for category in (DeprecationWarning, PendingDeprecationWarning, ImportWarning, ResourceWarning):
            warnings.simplefilter("ignore", category)
        for name in list(os.environ):
            patch.delenv(name)
        for name, value in environment.items():
            patch.setenv(name, value)
        patch.chdir(cwd)
        patch.setattr(sys, "argv", line)
        try:
            yield
        finally:
            gc.unfreeze()
            for number, handler in handlers.items():
                signal.signal(number, handler)
            # A command hands its language and its school's folder to its workers by variables of its own.
            for name in os.environ.keys() - surroundings.keys():
                del os.environ[name]
