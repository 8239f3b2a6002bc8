"""What is worth keeping from one run to the next, in the user's cache folder.

It saves time and nothing else: all of it may be deleted at any moment, several processes may write it at once, and
where nothing can be kept (a read-only home, a full disk, somebody else's folder) everything is worked out anew.
"""

from __future__ import annotations

import os
import stat
import tempfile
from contextlib import suppress
from functools import cache
from pathlib import Path


def kept(name: str) -> bytes | None:
    """What was kept under a name; None if there is nothing to be had."""
    with suppress(OSError):
        if (found := folder()) is not None:
            return (found / name).read_bytes()
    return None


def keep(name: str, data: bytes) -> Path | None:
    """Keep something under a name, whole or not at all; the file it stands in, None where it could not be kept."""
    found = folder()
    if found is None:
        return None
    with suppress(OSError):
        with tempfile.NamedTemporaryFile(dir=found, prefix=f"{name}-", delete=False) as stream:
            stream.write(data)
        try:
            os.replace(stream.name, found / name)
        except OSError:
            os.unlink(stream.name)
            raise
        return found / name
    return None


@cache
def folder() -> Path | None:
    """The folder that things are kept in; None where there can be none of this user's own."""
    from platformdirs import user_cache_path

    found = user_cache_path("reportgen", appauthor=False)
    with suppress(OSError):
        found.mkdir(mode=0o700, parents=True, exist_ok=True)
        if _is_private(found):
            return found
    return None


def _is_private(found: Path) -> bool:
    """Whether nobody else can have written there: what is kept is run."""
    if not hasattr(os, "getuid"):
        return True
    about = found.stat()
    return about.st_uid == os.getuid() and not about.st_mode & (stat.S_IWGRP | stat.S_IWOTH)
