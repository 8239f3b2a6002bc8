"""Delete temporary files left by a killed batch run, from the process that its workers are forked from.

That process outlives a killed run: it ends when no process is left that could ask it for a new worker.
"""

from __future__ import annotations

import atexit
import multiprocessing.util
import os
import shutil
import tempfile
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path

from reportgen.base.files import sweep

SOCKETS, OUT = "REPORTGEN_SOCKETS", "REPORTGEN_OUT"
"""Environment variables with the folder of the sockets of all processes, and that of the results."""


LONGEST = 103 - len("/pymp-12345678/listener-12345678")
"""Longest name (bytes) of the temporary folder in which socket names still fit: 103 on macOS, 107 on Linux."""
SHORT = ("/tmp", "/var/tmp")
"""Folders for the sockets if that folder's own name is longer."""


def sockets() -> str | None:
    """Return the folder that multiprocessing makes for sockets; None if no place has a short enough name."""
    usual = tempfile.tempdir
    places = (tempfile.gettempdir(), *SHORT)
    try:
        # A run that ends normally removes it.
        tempfile.tempdir = next(filter(_takes_sockets, places), None)
        return None if tempfile.tempdir is None else multiprocessing.util.get_temp_dir()
    finally:
        tempfile.tempdir = usual


def _takes_sockets(folder: str) -> bool:
    return len(os.fsencode(folder)) <= LONGEST and os.access(folder, os.W_OK | os.X_OK)


def environment(folder: str, out: Path | None) -> Mapping[str, str]:
    """Return the environment variables of the process, including the `folder` of sockets."""
    return {SOCKETS: folder, OUT: "" if out is None else os.path.abspath(out)}


def _tidy_up() -> None:
    """Remove the folders after the last worker has ended, because it may still write into one of them."""
    with suppress(ChildProcessError):
        while True:
            os.wait()
    shutil.rmtree(os.environ[SOCKETS], ignore_errors=True)
    if out := os.environ[OUT]:
        sweep(Path(out))


if SOCKETS in os.environ:
    atexit.register(_tidy_up)
