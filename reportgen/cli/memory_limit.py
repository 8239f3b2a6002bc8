"""Run a command under a memory limit: libraries without memory kill a process, so another process watches over it."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from contextlib import suppress

WATCHED = "REPORTGEN_WATCHED"
"""Environment variable of a watched command."""
LEFT = 128
"""Exit codes above it encode the signal that ended a command."""
FEW = dict.fromkeys(("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS", "RAYON_NUM_THREADS"), "1")
"""Environment that limits threads, because each thread of a library takes memory, needed or not."""


def is_limited() -> bool:
    """Return True if this process has a memory limit and is not watched yet."""
    with suppress(ImportError, OSError, ValueError):
        import resource

        return resource.getrlimit(resource.RLIMIT_AS)[0] != resource.RLIM_INFINITY and WATCHED not in os.environ
    return False


def run_watched() -> int | None:
    """Run this command in another process and return its exit code; None if it was killed or crashed."""
    command = [sys.executable, "-m", "reportgen.cli", *sys.argv[1:]]
    reading, telling = os.pipe()
    surroundings = {**FEW, **os.environ, WATCHED: str(telling)}
    with subprocess.Popen(command, env=surroundings, pass_fds=(telling,)) as process:
        os.close(telling)
        for number in (signal.SIGTERM, signal.SIGINT):
            # Both processes receive Ctrl-C; signals that would end this process are passed on, and the other one cleans
            # up.
            signal.signal(number, lambda number, _: process.send_signal(number))
        code = process.wait()
    with os.fdopen(reading, "rb") as stream:
        return code if stream.read() or code > LEFT else None


def announce_normal_end() -> None:
    """Inform a watching process that this one ends normally: C libraries end a process internally, with any code."""
    if pipe := os.environ.get(WATCHED):
        with suppress(OSError):
            os.write(int(pipe), b".")
