"""Write files atomically, read them safely; locks, run folders and the cache.

A reader of a file sees the old content or the new, never a part.
"""

from __future__ import annotations

import errno
import os
import re
import shutil
import stat
import tempfile
import time
import unicodedata
from collections.abc import Collection, Iterable, Iterator, Mapping
from contextlib import ExitStack, contextmanager, suppress
from functools import cache
from hashlib import sha256
from importlib import metadata
from pathlib import Path

from reportgen.base.errors import Fault, Location, OutputError
from reportgen.base.output_formats import endings, file_names

_STREAMS = ("/dev", "/proc")
"""Folders whose links refer to open streams, even if they lead to a regular file."""
_UNFINISHED = re.compile(rf"\..+\.(?:{'|'.join(endings())})\.[a-z0-9_]{{8}}")
"""Pattern of the names of temporary files that `_beside` makes."""


def put_files(folder: Path, files: Mapping[str, bytes], gone: Collection[Path] = ()) -> list[Path]:
    """Write files by name into a folder and remove the files `gone`, together or not at all.  Raises `OutputError`."""
    with reported():
        folder.mkdir(parents=True, exist_ok=True)
        written = {folder / name: content for name, content in files.items()}
        try:
            put_set(written, gone)
        except OSError:
            # An empty folder left behind would be of no use.
            with suppress(OSError):
                folder.rmdir()
            raise
    return list(written)


def put_file(target: Path, content: bytes) -> None:
    """Replace a file by `content` in one step: a reader sees the old content or the new, never a part.

    A missing folder is created.
    """
    target.parent.mkdir(parents=True, exist_ok=True)
    put_set({target: content})


def renew_file(target: Path, content: bytes) -> None:
    """Write a user's own file like `put_file`: the target of a link is replaced, with its permissions.

    Raises `OSError`, also for a file that may not be written.
    """
    real = Path(os.path.realpath(target))
    with ExitStack() as temporary, _named(target):
        mode = stat.S_IMODE(real.stat().st_mode)
        if not mode & 0o222 or not os.access(real, os.W_OK):
            raise PermissionError(errno.EACCES, os.strerror(errno.EACCES), str(target))
        written = _beside(real, temporary)
        written.write_bytes(content)
        written.chmod(mode)
        written.replace(real)


def put_set(files: Mapping[Path, bytes], gone: Collection[Path] = ()) -> None:
    """Write files and remove the files `gone`, together or not at all: after a failure everything is as before.

    All files are written before the first is moved into place.  Until the last one is moved, each old file keeps a
    second name.
    """
    with ExitStack() as temporary, ExitStack() as undo:
        written = {}
        for target, content in files.items():
            # The error of a full disk does not name the file that had no room.
            with _named(target):
                if is_stream(target):
                    raise NotRegularError(errno.EINVAL, "no regular file", str(target))
                written[target] = _beside(target, temporary)
                written[target].write_bytes(content)
        for target in (*files, *gone):
            with _named(target):
                if os.path.lexists(target):
                    undo.callback(os.replace, _second_name(target, temporary), target)
                else:
                    undo.callback(target.unlink, missing_ok=True)
        for target, new in written.items():
            with _named(target):
                new.replace(target)
        for target in gone:
            with _named(target):
                target.unlink(missing_ok=True)
        undo.pop_all()


def is_stream(target: Path) -> bool:
    """Return True if a name is a pipe, a device or an open stream (/dev/stdout), which cannot be replaced."""
    try:
        mode = target.stat().st_mode
    except OSError:
        return False
    folder = Path(os.path.abspath(target)).parent
    is_open = target.is_symlink() and any(folder.is_relative_to(one) for one in _STREAMS)
    return is_open or not (stat.S_ISREG(mode) or stat.S_ISDIR(mode))


def write_stream(target: Path, content: bytes) -> None:
    """Write to a pipe or character device like a redirection.  Raises `OSError`, also for a disk."""
    with _named(target):
        if stat.S_ISBLK(target.stat().st_mode):
            raise NotRegularError(errno.EINVAL, "no regular file", str(target))
        with target.open("ab") as stream:
            stream.write(content)


def _beside(target: Path, until: ExitStack) -> Path:
    """Return an empty file in the folder of its target, with the permissions of a new file; `until` deletes it."""
    handle, name = tempfile.mkstemp(dir=target.parent, prefix=f".{target.name}.")
    os.close(handle)
    until.callback(Path(name).unlink, missing_ok=True)
    umask = os.umask(0)
    os.umask(umask)
    Path(name).chmod(0o666 & ~umask)
    return Path(name)


def _second_name(target: Path, until: ExitStack) -> Path:
    """Return a second name of a file; a copy if the file system cannot give one."""
    name = _beside(target, until)
    name.unlink()
    try:
        os.link(target, name, follow_symlinks=False)
    except (OSError, NotImplementedError):
        shutil.copy2(target, name, follow_symlinks=False)
    return name


def remove_unfinished(folder: Path) -> None:
    """Remove the temporary files that a killed run was writing."""
    if folder.is_dir():
        for path in folder.iterdir():
            if _UNFINISHED.fullmatch(path.name):
                path.unlink(missing_ok=True)


@contextmanager
def _named(target: Path) -> Iterator[None]:
    """Make system errors in this context name this file."""
    try:
        yield
    except NotRegularError:
        raise
    except OSError as error:
        # OSError would report a second name even if it is None.
        raise OSError(error.errno, error.strerror or str(error), str(target)) from error


@contextmanager
def reported(about: Path | None = None) -> Iterator[None]:
    """Report a full disk or a forbidden folder as a fault in one line, with its path, or else with `about`."""
    try:
        yield
    except OSError as error:
        place = error.filename or about
        raise OutputError(f"{place}: {error.strerror or error}" if place else str(error)) from error


# --- reading files ------------------------------------------------------------------------------------


class NotRegularError(OSError):
    """A pipe, a device or a socket in place of a file: reading it might never end."""


def cause(error: OSError) -> str:
    """Return the reason why the system refused a file: the name of the error, which has a message, or the system's
    text.
    """
    return error.strerror if type(error) is OSError and error.strerror else type(error).__name__


def contents(path: Path, most: int = -1) -> bytes:
    """Return the bytes of a file, at most `most` unless that is negative.  Raises `OSError`; never waits for a pipe."""
    mode = path.stat().st_mode
    if not (stat.S_ISREG(mode) or stat.S_ISDIR(mode)):
        raise NotRegularError(errno.EINVAL, "no regular file", str(path))
    with path.open("rb") as stream:
        return stream.read(most)


def leads_out(path: Path, *folders: Path) -> bool:
    """Return True if a path, with its links followed, is outside of all the given folders."""
    try:
        return not any(path.resolve().is_relative_to(folder.resolve()) for folder in folders)
    except (OSError, RuntimeError, ValueError):  # a loop of links, or no path at all
        return True


# --- existing files ---------------------------------------------------------------------------------


def standing(folder: Path, kind: str, below: str = "") -> set[Path]:
    """Return the files of a folder, or of those `below` it, that belong to a product by their names in any case."""
    pattern = re.compile(file_names(kind), re.IGNORECASE)
    return {path for path in folder.glob(f"{below}*") if pattern.fullmatch(path.name)}


def overwritten(outputs: Iterable[Path], inputs: Iterable[Path]) -> Iterator[Fault]:
    """Yield a fault for each output that is also an input, under any name: a link, another path, another case."""
    known = {identity: path for path in inputs for identity in _identities(path)}
    for output in outputs:
        if same := [known[identity] for identity in _identities(output) if identity in known]:
            yield Fault("is-input", Location(str(output)), {"text": str(same[0])})


def _identities(path: Path) -> list[str | tuple[int, int]]:
    """Return keys that all names of one file share: its real path without case, and its device and inode if it
    exists.
    """
    real = unicodedata.normalize("NFC", os.path.realpath(path)).casefold()
    with suppress(OSError):
        about = path.stat()
        return [real, (about.st_dev, about.st_ino)]
    return [real]


# --- temporary files beside the results -----------------------------------------------------------
# Only their owner can read them, and files left by a killed run are swept.
# A run locks its folder as long as it lives, so that another run does not consider it abandoned.

PREFIX = ".reportgen-"
MOST_SWEPT = 1000
"""Largest number of new folders in a row that another run may sweep before they are locked; one is rare."""
_NO_LOCKS = frozenset({errno.EBADF, errno.EINVAL, errno.ENOLCK, errno.EOPNOTSUPP, errno.ENOSYS})
"""Error codes of network folders that do not support locks."""


@contextmanager
def scratch(out: Path) -> Iterator[Path]:
    """Provide a folder below `out` (mode 0700) for all temporary files in this context, and remove it with its
    contents.

    Folders created for it are removed too, if they are empty. Raises `OSError` if no folder can be made.
    """
    made = [folder for folder in (out, *out.parents) if not folder.exists()]
    sweep(out)
    before = tempfile.tempdir
    try:
        with ExitStack() as lock:
            own = _own(out, lock)
            # The folder is removed while it is still locked, so that no sweep considers it abandoned.
            lock.callback(shutil.rmtree, own, ignore_errors=True)
            tempfile.tempdir = str(own)
            yield own
    finally:
        tempfile.tempdir = before
        with suppress(OSError):
            for folder in made:
                folder.rmdir()


def _own(out: Path, lock: ExitStack) -> Path:
    """Return a new folder below `out`, locked. Raises `OSError` if none can be made.

    If a sweep came between making and locking, or another run removed `out`, another folder is made.
    """
    for _ in range(MOST_SWEPT):
        out.mkdir(parents=True, exist_ok=True)
        with suppress(FileNotFoundError, BlockingIOError):
            own = Path(tempfile.mkdtemp(prefix=PREFIX, dir=out))
            with ExitStack() as holding:
                holding.enter_context(held(own))
                # The file there now stays: only the owner of its lock may sweep it.
                own.stat()
                lock.push(holding.pop_all())
                return own
    raise BlockingIOError(errno.EAGAIN, os.strerror(errno.EAGAIN), str(out))


def sweep(out: Path) -> None:
    """Remove the folders of runs that have ended; without locks this is unknown, and they stay."""
    folders: list[Path] = []
    # Another run may remove `out`, if it is empty, while it is read.
    with suppress(FileNotFoundError):
        folders += out.glob(f"{PREFIX}*")
    for folder in folders:
        with suppress(OSError), held(folder) as alone:
            if alone:
                shutil.rmtree(folder, ignore_errors=True)


@contextmanager
def held(folder: Path) -> Iterator[bool]:
    """Lock a folder in this context without leaving a trace; yield False if the system or file system has no locks.

    Raises `BlockingIOError` if another process has the lock, `OSError` if the folder cannot be opened.
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


# --- the cache: data kept from one run to the next, in the user's cache folder --------------------
# The cache only saves time: all of it may be deleted at any moment, several processes may write it together, and if it
# cannot be used (a read-only home, a full disk, somebody else's folder), everything is computed again.


LARGEST, OLDEST = 20_000_000, 60 * 24 * 3600.0
"""Largest size of the cache (bytes), and largest age since the last use (s); the least used files beyond them are
removed.
"""


def kept(name: str) -> bytes | None:
    """Return the data that this version of the program cached under a name; None if there is none or it is damaged."""
    with suppress(OSError):
        if (kept_in := folder()) is not None:
            seal, _, data = (kept_in / name).read_bytes().partition(b"\n")
            if seal == _seal(data):
                with suppress(OSError):
                    os.utime(kept_in / name)
                return data
    return None


def keep(name: str, data: bytes) -> Path | None:
    """Cache data under a name, atomically. Return the path of the file, or None if it could not be written."""
    kept_in = folder()
    if kept_in is None:
        return None
    with suppress(OSError):
        with tempfile.NamedTemporaryFile(dir=kept_in, prefix=f"{name}-", delete=False) as stream:
            stream.write(_seal(data) + b"\n" + data)
        try:
            os.replace(stream.name, kept_in / name)
        except OSError:
            os.unlink(stream.name)
            raise
        prune(kept_in)
        return kept_in / name
    return None


def _seal(data: bytes) -> bytes:
    """Return the first line of a cached file: the version of the program and a checksum."""
    return f"reportgen {version()} {sha256(data).hexdigest()}".encode()


@cache
def version() -> str:
    """Return the version as installed; "0" in a checkout that is not installed."""
    try:
        return metadata.version("reportgen")
    except metadata.PackageNotFoundError:
        return "0"


@cache
def prune(folder_kept: Path) -> None:
    """Remove the least recently used files from the folder, down to the `LARGEST` size, and those older than `OLDEST`.

    It runs once in a process, when a file is added, since examining every file takes longer than reading a few.
    """
    files = []
    for path in folder_kept.iterdir():
        # Another process may have removed it meanwhile.
        with suppress(OSError):
            files.append((path.lstat(), path))
    now, size = time.time(), 0
    for about, path in sorted(files, key=lambda file: -file[0].st_mtime):
        size += about.st_size
        if size > LARGEST or now - about.st_mtime > OLDEST:
            with suppress(OSError):
                path.unlink()


@cache
def folder() -> Path | None:
    """Return the cache folder; None if there is no folder that belongs to this user alone."""
    from platformdirs import user_cache_path

    private = user_cache_path("reportgen", appauthor=False)
    with suppress(OSError):
        private.mkdir(mode=0o700, parents=True, exist_ok=True)
        if _is_private(private):
            return private
    return None


def _is_private(place: Path) -> bool:
    """Return True if only this user can have written there, since cached data may be executed."""
    if not hasattr(os, "getuid"):
        return True
    about = place.stat()
    return about.st_uid == os.getuid() and not about.st_mode & (stat.S_IWGRP | stat.S_IWOTH)
