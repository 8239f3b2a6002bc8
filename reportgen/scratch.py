"""Temporary files beside the results: only their owner can read them, and what a killed run left is swept.

A run holds a lock on its folder for as long as it lives, so that another one does not take it for left behind.
"""

from __future__ import annotations

import errno
import os
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path

PREFIX = ".reportgen-"
_NO_LOCKS = frozenset({errno.EBADF, errno.EINVAL, errno.ENOLCK, errno.EOPNOTSUPP, errno.ENOSYS})
"""What network folders that know no locks answer."""


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
        with tempfile.TemporaryDirectory(prefix=PREFIX, dir=out) as name, ExitStack() as locks:
            with suppress(OSError):
                locks.enter_context(held(Path(name)))
            tempfile.tempdir = name
            yield Path(name)
    finally:
        tempfile.tempdir = before
        with suppress(OSError):
            for folder in made:
                folder.rmdir()


def sweep(out: Path) -> None:
    """Remove the folders of runs that are no more; where there are no locks, nobody knows, and they stay."""
    for folder in out.glob(f"{PREFIX}*"):
        with suppress(OSError), held(folder) as alone:
            if alone:
                shutil.rmtree(folder, ignore_errors=True)


@contextmanager
def held(folder: Path) -> Iterator[bool]:
    """Holds the lock of a folder, without leaving a trace; False where the system or the file system knows no locks.

    Raises `BlockingIOError` if another process holds it, `OSError` if the folder cannot be opened.
    """
    try:
        import fcntl
    except ImportError:  # no such locks on this system
        yield False
        return
    handle = os.open(folder, os.O_RDONLY)
    try:
        locked = True
        try:
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError as error:
            if error.errno not in _NO_LOCKS:
                raise
            locked = False
        yield locked
    finally:
        os.close(handle)
