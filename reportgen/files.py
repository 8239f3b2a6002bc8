"""Files put in place whole or not at all: a reader sees the old one or the new one, never a half."""

from __future__ import annotations

import os
import re
import tempfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path

from reportgen.errors import OutputError

_SHEET = re.compile(r"sheet-\d+\.(pdf|dxf)")


def put_files(folder: Path, files: Mapping[str, bytes]) -> list[Path]:
    """Write files by name into a folder, each in one step; raises `OutputError`."""
    with reported():
        folder.mkdir(parents=True, exist_ok=True)
        try:
            for name, content in files.items():
                put_file(folder / name, content)
        except OSError:
            # A folder without a file tells nobody anything.
            with suppress(OSError):
                folder.rmdir()
            raise
    return [folder / name for name in files]


def put_file(target: Path, content: bytes) -> None:
    """Put `content` in place of a file in one step: a reader sees the old or the new, never a half."""
    handle, name = tempfile.mkstemp(dir=target.parent, prefix=f".{target.name}.")
    temporary = Path(name)
    try:
        with os.fdopen(handle, "wb") as stream:
            stream.write(content)
        umask = os.umask(0)
        os.umask(umask)
        temporary.chmod(0o666 & ~umask)
        temporary.replace(target)
    except BaseException as error:
        temporary.unlink(missing_ok=True)
        if isinstance(error, OSError):
            # A full disk does not say itself what had no room on it.
            error.filename = error.filename or str(target)
        raise


@contextmanager
def reported(about: Path | None = None) -> Iterator[None]:
    """A full disk or a forbidden folder is a fault in one line, which names its path, or else `about`."""
    try:
        yield
    except OSError as error:
        place = error.filename or about
        raise OutputError(f"{place}: {error.strerror or error}" if place else str(error)) from error


def put_sheets(folder: Path, files: Mapping[str, bytes]) -> list[Path]:
    """Write drawing sheets into a folder; those of an earlier set that had more sheets go."""
    written = put_files(folder, files)
    for path in folder.glob("sheet-*.*"):
        if _SHEET.fullmatch(path.name) and path not in written:
            path.unlink(missing_ok=True)
    return written
