"""What a killed batch leaves, tidied up by the process that its workers are forked from.

That process ends when nobody is left who could ask it for another one: it outlives a run that was killed.
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
"""By these names in its environment it knows the folder of the sockets of all processes, and that of the results."""


LONGEST = 103 - len("/pymp-12345678/listener-12345678")
"""Bytes of the folder of temporary files within which a socket has a name: 103 on macOS, 107 on Linux."""
SHORT = ("/tmp", "/var/tmp")
"""Where the sockets go if that folder's own name is longer."""


def sockets() -> str | None:
    """The folder that multiprocessing makes for sockets; None if there is no place whose name is short enough."""
    usual = tempfile.tempdir
    places = (tempfile.gettempdir(), *SHORT)
    try:
        # A run that ends by itself removes it.
        tempfile.tempdir = next(filter(_takes_sockets, places), None)
        return None if tempfile.tempdir is None else multiprocessing.util.get_temp_dir()
    finally:
        tempfile.tempdir = usual


def _takes_sockets(folder: str) -> bool:
    return len(os.fsencode(folder)) <= LONGEST and os.access(folder, os.W_OK | os.X_OK)


def environment(folder: str, out: Path | None) -> Mapping[str, str]:
    """What the process has to know, for its environment, the `folder` of sockets among it."""
    return {SOCKETS: folder, OUT: "" if out is None else os.path.abspath(out)}


def _tidy_up() -> None:
    """Remove the folders once the last worker has ended, which may be writing into one of them still."""
    with suppress(ChildProcessError):
        while True:
            os.wait()
    shutil.rmtree(os.environ[SOCKETS], ignore_errors=True)
    if out := os.environ[OUT]:
        sweep(Path(out))


if SOCKETS in os.environ:
    atexit.register(_tidy_up)
