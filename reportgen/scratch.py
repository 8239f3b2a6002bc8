"""Temporary files beside the results: only their owner can read them, and what a killed run left is swept.

A run holds a lock on its folder for as long as it lives, so that another one does not take it for left behind.
"""

from __future__ import annotations

import os
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path

PREFIX = ".reportgen-"


@contextmanager
def scratch(out: Path) -> Iterator[Path]:
    """A folder below `out` (mode 0700) for all temporary files made meanwhile; it goes with all in it.

    Folders made for it go too, if nothing else was put there.  Raises `OSError` where there can be none.
    """
    made = [folder for folder in (out, *out.parents) if not folder.exists()]
    out.mkdir(parents=True, exist_ok=True)
    sweep(out)
    before = tempfile.tempdir
    try:
        with tempfile.TemporaryDirectory(prefix=PREFIX, dir=out) as name, ExitStack() as held:
            # Some network folders know no locks; there nothing is swept either.
            with suppress(OSError):
                held.enter_context(_held(Path(name)))
            tempfile.tempdir = name
            yield Path(name)
    finally:
        tempfile.tempdir = before
        with suppress(OSError):
            for folder in made:
                folder.rmdir()


def sweep(out: Path) -> None:
    """Remove the folders of runs that are no more."""
    for folder in out.glob(f"{PREFIX}*"):
        with suppress(OSError), _held(folder):
            shutil.rmtree(folder, ignore_errors=True)


@contextmanager
def _held(folder: Path) -> Iterator[None]:
    """Holds the lock of a folder; raises `OSError` if another process does, or if there are no such locks."""
    try:
        import fcntl
    except ImportError:  # no such locks on this system
        yield
        return
    handle = os.open(folder, os.O_RDONLY)
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        yield
    finally:
        os.close(handle)
