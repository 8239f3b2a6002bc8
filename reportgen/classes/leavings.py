"""What a killed batch leaves, tidied up by the process that its workers are forked from.

That process ends when nobody is left who could ask it for another one: it outlives a run that was killed.
"""

from __future__ import annotations

import atexit
import multiprocessing.util
import os
import shutil
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path

from reportgen.base.files import sweep

SOCKETS, OUT = "REPORTGEN_SOCKETS", "REPORTGEN_OUT"
"""By these names in its environment it knows the folder of the sockets of all processes, and that of the results."""


def environment(out: Path | None) -> Mapping[str, str]:
    """What the process has to know, for its environment."""
    # The folder that multiprocessing makes; a run that ends by itself removes it.
    sockets = multiprocessing.util.get_temp_dir()
    return {SOCKETS: sockets, OUT: "" if out is None else os.path.abspath(out)}


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
