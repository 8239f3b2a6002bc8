"""A command under a limit of memory: libraries that get none end a process at once, so another one watches over it."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from contextlib import suppress

WATCHED = "REPORTGEN_WATCHED"
"""Stands in the environment of a command that is watched over."""
LEFT = 128
"""Codes above it say which signal a command was ended by, if it left at once."""
FEW = dict.fromkeys(("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS", "RAYON_NUM_THREADS"), "1")
"""Each thread of a library takes memory, needed or not."""


def is_limited() -> bool:
    """Whether this process may have so much memory and no more, and nobody watches over it yet."""
    with suppress(ImportError, OSError, ValueError):
        import resource

        return resource.getrlimit(resource.RLIMIT_AS)[0] != resource.RLIM_INFINITY and WATCHED not in os.environ
    return False


def run_watched() -> int | None:
    """The exit code of this very command in another process; None where that did not end by itself."""
    command = [sys.executable, "-m", "reportgen.cli", *sys.argv[1:]]
    reading, telling = os.pipe()
    surroundings = {**FEW, **os.environ, WATCHED: str(telling)}
    with subprocess.Popen(command, env=surroundings, pass_fds=(telling,)) as process:
        os.close(telling)
        for number in (signal.SIGTERM, signal.SIGINT):
            # Both hear Ctrl-C; what ends this process is passed on, and the other one tidies up.
            signal.signal(number, lambda number, _: process.send_signal(number))
        code = process.wait()
    with os.fdopen(reading, "rb") as stream:
        return code if stream.read() or code > LEFT else None


def ends_by_itself() -> None:
    """Tell who watches, if somebody does: libraries in C end a process from within, with any code."""
    if pipe := os.environ.get(WATCHED):
        with suppress(OSError):
            os.write(int(pipe), b".")
