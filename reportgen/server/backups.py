"""Copies of a class while it is served, and what becomes of its personal data after the term."""

from __future__ import annotations

import datetime
import os
import shutil
import sqlite3
from contextlib import closing
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
    made = target / f"{folder.path.absolute().name}-{now:%Y%m%d-%H%M%S}"
    part = made.with_name(f".{made.name}.part")
    with reported(target):
        shutil.rmtree(part, ignore_errors=True)
        (part / "server").mkdir(parents=True, mode=0o700)
        _copy_database(folder.server / DATABASE, part / "server" / DATABASE)
        skipped = {folder.server / f"{DATABASE}{end}" for end in ("", "-wal", "-shm")}
        for file in sorted(folder.path.rglob("*")):
            inside = file.relative_to(folder.path)
            if inside.parts[:2] == ("server", "backups") or target.absolute() in file.absolute().parents:
                continue
            if file.is_file() and not file.is_symlink() and file not in skipped and file.suffix != ".part":
                (part / inside).parent.mkdir(parents=True, exist_ok=True)
                _copy(file, part / inside)
        os.replace(part, made)
        synced(target)
    return made


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
        # It was replaced while the folder was listed.
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
