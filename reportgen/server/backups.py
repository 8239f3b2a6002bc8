"""Copies of a class while it is served, and what becomes of its personal data after the term."""

from __future__ import annotations

import datetime
import errno
import os
import shutil
import sqlite3
import tempfile
from collections.abc import Iterator
from contextlib import closing
from itertools import count
from pathlib import Path

from reportgen.base.files import reported
from reportgen.server.class_folder import ClassFolder, synced

DATABASE = "class.db"
PERSONAL = ("server", "handed", "marked", "tasks", "keys", "variants", "roster.csv", "handed-in.csv", "corrections.csv")
"""What names students or has their work."""


def back_up(folder: ClassFolder, target: Path) -> Path:
    """Copy a class into a new folder below `target`, named by the time; return it. Raises `OutputError`.

    The database is copied first: a file that it names was on the disk before.
    """
    now = datetime.datetime.now()
    name = f"{folder.path.absolute().name}-{now:%Y%m%d-%H%M%S}"
    with reported(target):
        target.mkdir(parents=True, exist_ok=True, mode=0o700)
        # Each copy has a folder of its own: two may be made within a second.
        part = Path(tempfile.mkdtemp(prefix=f".{name}.", suffix=".part", dir=target))
        try:
            _copy_class(folder, target, part)
            made = next(free for free in _names(target, name) if not os.path.lexists(free))
            os.replace(part, made)
        except BaseException:
            shutil.rmtree(part, ignore_errors=True)
            raise
        synced(target)
    return made


def _names(target: Path, name: str) -> Iterator[Path]:
    yield target / name
    for number in count(2):
        yield target / f"{name}-{number}"


def _copy_class(folder: ClassFolder, target: Path, part: Path) -> None:
    (part / "server").mkdir(mode=0o700)
    _copy_database(folder.server / DATABASE, part / "server" / DATABASE)
    skipped = {folder.server / f"{DATABASE}{end}" for end in ("", "-wal", "-shm")}
    for file in sorted(folder.path.rglob("*")):
        inside = file.relative_to(folder.path)
        if inside.parts[:2] == ("server", "backups") or target.absolute() in file.absolute().parents:
            continue
        if file.is_file() and not file.is_symlink() and file not in skipped and file.suffix != ".part":
            (part / inside).parent.mkdir(parents=True, exist_ok=True)
            _copy(file, part / inside)
    if not (part / "server" / DATABASE).is_file():
        raise FileNotFoundError(errno.ENOENT, os.strerror(errno.ENOENT), str(part / "server" / DATABASE))


def _copy_database(source: Path, target: Path) -> None:
    with closing(sqlite3.connect(source)) as present, closing(sqlite3.connect(target)) as copied:
        present.backup(copied)
    target.chmod(0o600)
    with open(target, "rb") as file:
        os.fsync(file.fileno())


def _copy(file: Path, target: Path) -> None:
    try:
        shutil.copy2(file, target)
    except FileNotFoundError:
        if file.exists():
            # The copy itself is gone.
            raise
        # It was removed after the folder was listed.
        return
    with open(target, "rb") as copied:
        os.fsync(copied.fileno())


def forget(folder: ClassFolder) -> list[Path]:
    """Delete all personal data of a class; spec and policy stay for the next one. Return what was deleted."""
    gone = [folder.path / name for name in PERSONAL if os.path.lexists(folder.path / name)]
    with reported(folder.path):
        for path in gone:
            if path.is_dir() and not path.is_symlink():
                shutil.rmtree(path)
            else:
                path.unlink()
    return gone
