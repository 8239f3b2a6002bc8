"""Track which inputs each output file was built from: skip up-to-date files, delete stale ones, keep edited ones.

A file is stale if it was made from other inputs than the present ones. It is deleted only if its bytes are
unchanged; a file that a user edited stays and is reported. The same rule applies to a batch, whose manifest records
the files of a class, and to the folder of one assignment, which has a hidden record.
"""

from __future__ import annotations

import json
import os
from collections.abc import Collection, Iterator, Mapping
from hashlib import sha256
from pathlib import Path, PurePath
from typing import Any

from reportgen.base.files import contents, put_files, standing
from reportgen.base.records import Record, field

MADE_OF = ("assignment", "engine", "language", "templates", "version")
"""Inputs that decide the bytes of every product; a product may add others, such as the questions of a sheet."""
MadeOf = Mapping[str, str | None]

RECORD = ".reportgen.json"
"""Name of the record in a folder."""
FORMAT = "reportgen-made/1"
LARGEST = 1_000_000
"""Bytes of a record."""


class Made(Record):
    """Files of a folder by name, with the SHA-256 of their written contents, and the inputs they were made from."""

    made_of: MadeOf = field(default_factory=dict)
    files: Mapping[str, str] = field(default_factory=dict)

    def edited(self, folder: Path) -> Iterator[Path]:
        """Yield the files that were changed after they were made, for example a filled-in answer sheet."""
        for name, known in self.files.items():
            if hash_of(folder / name) not in ("", known):
                yield folder / name

    def without(self, names: Collection[str], folder: Path) -> Made:
        """Return the record of the files that still exist, without some names."""
        there = {name for name in self.files if name not in names and os.path.lexists(folder / name)}
        return Made(self.made_of, {name: self.files[name] for name in self.files if name in there})

    def outlived(self, made: Collection[str], folder: Path) -> Iterator[Path]:
        """Yield unchanged files that are no longer in `made`; names with a folder are skipped."""
        for name, known in self.files.items():
            if name not in made and PurePath(name).name == name and hash_of(folder / name) == known:
                yield folder / name


class Put(Record):
    """Result of putting files into a folder: the `paths` written, the stale files `gone`, and the files `left`.

    Files that are left were changed after they were made, or are not in any record.
    """

    paths: tuple[Path, ...]
    gone: tuple[Path, ...] = ()
    left: tuple[Path, ...] = ()


def assignment_hash(content: bytes, beside: Mapping[str, bytes]) -> str:
    """Return the SHA-256 of an assignment file together with the files beside it."""
    return sha256(b"\0".join((content, *beside.values()))).hexdigest()


def made_of(
    assignment: str, engine: str, language: str | None, templates: str, version: str, **more: str
) -> dict[str, str | None]:
    """Return the values of `MADE_OF`, and all other inputs of a product that are not empty."""
    known = dict(zip(MADE_OF, (assignment, engine, language, templates, version), strict=True))
    return {**known, **{name: value for name, value in more.items() if value}}


def hash_of(path: Path) -> str:
    """Return the SHA-256 of a file; "" if it cannot be read."""
    try:
        return sha256(contents(path)).hexdigest()
    except (OSError, ValueError):
        return ""


def put_made(folder: Path, files: Mapping[str, bytes], kind: str, of: MadeOf, alone: bool = False) -> Put:
    """Put files of a product into a folder, together or not at all, and remove its stale files.

    The folder's record then lists the inputs `of` each. Files put `alone` leave all others unchanged. Raises
    `OutputError`.
    """
    record = _read(folder)
    earlier = record.get(kind, [])
    same = {name: known for one in earlier if one.made_of == of for name, known in one.files.items()}
    stale = [one for one in earlier if one.made_of != of]
    outlived = {path for one in stale for path in one.outlived(files, folder)}
    settled = files.keys() | same.keys() | (set() if alone else {path.name for path in outlived})
    now = {
        **{name: known for name, known in same.items() if os.path.lexists(folder / name)},
        **{name: sha256(content).hexdigest() for name, content in files.items()},
    }
    before = [one.without(settled, folder) for one in stale]
    made = [one for one in (Made(of, now), *before) if one.files]
    gone = set() if alone else outlived
    *paths, _ = put_files(folder, {**files, RECORD: _text({**record, kind: made})}, gone)
    left = {folder / name for one in before for name in one.files} | standing(folder, kind)
    strays = () if alone else sorted(path for path in left if path.name not in settled)
    return Put(tuple(paths), tuple(sorted(gone)), tuple(strays))


def _text(record: Mapping[str, list[Made]]) -> bytes:
    kinds = {
        kind: [{"made_of": dict(one.made_of), "files": dict(one.files)} for one in made]
        for kind, made in record.items()
    }
    content = {"format": FORMAT, "made": kinds}
    return (json.dumps(content, ensure_ascii=False, indent=1, sort_keys=True) + "\n").encode()


def _read(folder: Path) -> dict[str, list[Made]]:
    """Return the record of a folder by the kinds of files; an unreadable record counts as missing."""
    try:
        content: Any = json.loads(contents(folder / RECORD, LARGEST))
        if content["format"] != FORMAT:
            return {}
        return {kind: [_made(one) for one in made] for kind, made in content["made"].items()}
    except (OSError, ValueError, RecursionError, KeyError, TypeError, AttributeError):
        return {}


def _made(plain: Any) -> Made:
    """Return the record of files made from one input; raises `ValueError` for data that this program never wrote."""
    of, files = dict(plain["made_of"]), dict(plain["files"])
    names = all(isinstance(name, str) and PurePath(name).name == name for name in files)
    if not (names and all(isinstance(known, str) for known in files.values())):
        raise ValueError("no record")
    return Made(of, files)
