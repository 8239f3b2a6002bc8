"""A bounded call ends with all that it has started, whatever becomes of it and of the one that called."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from functools import partial
from pathlib import Path

import pytest

from reportgen.base.process_limits import LimitError, Limits, call_within

pytestmark = pytest.mark.skipif(os.name == "nt", reason="processes are looked for by signals")

LIMITS = Limits(1, 500)
CALLER = "from tests.base.test_limits import *; call_within(Limits(60, 500), {}, Path({!r}))"


def started(note: Path) -> int:
    """Starts a process that would run for long, and notes its number and the own one."""
    sleeping = subprocess.Popen(["sleep", "300"])
    note.write_text(f"{sleeping.pid} {os.getpid()}", encoding="utf-8")
    return sleeping.pid


def endless(note: Path) -> None:
    started(note)
    while True:
        pass


def nested(_: None) -> tuple[int, int]:
    return os.getpid(), call_within(LIMITS, own, None)


def own(_: None) -> int:
    return os.getpid()


def runs(number: int) -> bool:
    """Whether a process runs; one that ended and that nobody waited for does not."""
    try:
        os.kill(number, 0)
        state = Path(f"/proc/{number}/stat")
        return not state.exists() or state.read_text().rsplit(")", 1)[1].split()[0] != "Z"
    except (ProcessLookupError, FileNotFoundError):
        return False


def gone(numbers: list[int]) -> bool:
    """Whether processes have ended, in a few seconds at the latest."""
    end = time.monotonic() + 10
    while any(map(runs, numbers)) and time.monotonic() < end:
        time.sleep(0.02)
    return not any(map(runs, numbers))


def test_a_call_leaves_no_process(tmp_path: Path) -> None:
    assert gone([call_within(LIMITS, started, tmp_path / "note")])


def test_a_call_that_is_ended_leaves_no_process(tmp_path: Path) -> None:
    note = tmp_path / "note"
    with pytest.raises(LimitError):
        call_within(LIMITS, endless, note)
    assert gone(list(map(int, note.read_text(encoding="utf-8").split())))


@pytest.mark.parametrize("end", [signal.SIGKILL, signal.SIGTERM, signal.SIGINT])
def test_a_caller_that_is_ended_leaves_no_process(tmp_path: Path, end: signal.Signals) -> None:
    note = tmp_path / "note"
    root = Path(__file__).parents[2]
    code = CALLER.format("endless", str(note))
    # A shell that runs the tests in the background makes its processes ignore Ctrl-C; this one has to hear it.
    hears = partial(signal.signal, signal.SIGINT, signal.SIG_DFL)
    command = [sys.executable, "-c", code]
    caller = subprocess.Popen(command, cwd=root, stderr=subprocess.DEVNULL, preexec_fn=hears)
    while not note.exists() or not note.read_text(encoding="utf-8"):
        assert caller.poll() is None
        time.sleep(0.02)
    numbers = list(map(int, note.read_text(encoding="utf-8").split()))
    assert all(map(runs, numbers))
    caller.send_signal(end)
    caller.wait()
    assert gone(numbers)


def test_a_call_within_a_call_starts_no_further_process() -> None:
    outer, inner = call_within(LIMITS, nested, None)
    assert outer == inner != os.getpid()
