"""Read zip archives from untrusted sources: check them, decode their names, and read members in memory.

Nothing of an archive is written to disk. An archive without the UTF-8 flag does not state the encoding of its names;
`decoded_names` infers it.
"""

from __future__ import annotations

import io
import stat
import struct
import unicodedata
import zipfile
from bisect import bisect_right
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path, PurePosixPath

from reportgen.base.errors import Fault, Location
from reportgen.base.files import cause
from reportgen.base.records import Record
from reportgen.workbook.table_writing import MOMENT
from reportgen.workbook.zip_package import MOST_RATIO, SMALL, UNREADABLE_ZIP, RefusedError

ARCHIVE = ".zip"
MOST_MEMBERS = 20_000
MOST_BYTES = 2_000_000_000
"""Largest total size of an archive's members, unpacked; only its sheets are read, one at a time."""
LARGEST_INSIDE = 100_000_000
"""Largest size (bytes) of an archive inside another one."""
ENCODINGS = ("utf-8", "cp437", "cp866", "cp1251", "gbk", "cp1258", "cp850", "cp1252")
"""Encodings of names, in the order in which they are tried: current systems, the zip standard, old programs."""
_UTF_8 = 1 << 11
"""Flag of a member whose name is in UTF-8."""
_UNICODE_PATH = 0x7075
"""Extra field in which Info-ZIP writes the name in UTF-8."""
_DRIVES = frozenset("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz")

CountStudents = Callable[[Sequence[str]], int]
"""Returns how many of the given names are those of students."""


class ArchiveMember(Record):
    """A file in an archive, with its decoded name."""

    name: str
    info: zipfile.ZipInfo


class Archive(Record):
    """An opened archive that passed the safety checks."""

    members: tuple[ArchiveMember, ...]
    file: zipfile.ZipFile

    def content(self, member: ArchiveMember, most: int) -> bytes:
        """Return a member's content, at most `most` + 1 bytes; the extra byte shows that there are more."""
        with self.file.open(member.info) as stream:
            return stream.read(most + 1)


@contextmanager
def opened(path: Path, data: bytes | None, judge: CountStudents) -> Iterator[Archive]:
    """Open an archive on disk, or one whose content is `data`; `path` names it.

    Raises `RefusedError` for one that is damaged, encrypted, unpacks to too much or has names that lead outside; also
    while its members are read.
    """
    location = Location(str(path))
    try:
        with zipfile.ZipFile(path if data is None else io.BytesIO(data)) as file:
            infos = [info for info in file.infolist() if not info.is_dir()]
            names = decoded_names(infos, judge)
            members = tuple(ArchiveMember(name, info) for name, info in zip(names, infos, strict=True))
            if fault := _fault(members, path):
                raise RefusedError(fault.code, fault.location, **fault.arguments)
            yield Archive(members, file)
    except UNREADABLE_ZIP:
        raise RefusedError("archive-damaged", location) from None
    except OSError as error:
        raise RefusedError("unreadable", location, reason=cause(error)) from None


def decoded_names(infos: Sequence[zipfile.ZipInfo], judge: CountStudents) -> list[str]:
    """Return the names of members in the encoding that gives most students; at a tie, in the first one."""
    known = [_stated(info) for info in infos]
    raw = {k: infos[k].orig_filename.encode("cp437", "replace") for k, name in enumerate(known) if name is None}
    if not any(not content.isascii() for content in raw.values()):
        return [info.filename if name is None else name for info, name in zip(infos, known, strict=True)]
    best: Mapping[int, str] = {}
    most = -1
    for encoding in ENCODINGS:
        # No other encoding has the patterns of UTF-8, and cp437 decodes all bytes.
        with suppress(UnicodeError):
            names = {k: content.decode(encoding) for k, content in raw.items()}
            count = judge(list(names.values()))
            if count > most:
                best, most = names, count
        if encoding == "utf-8" and best:
            break
    return [name if name is not None else best[k].partition("\0")[0] for k, name in enumerate(known)]


def _stated(info: zipfile.ZipInfo) -> str | None:
    """Return the name of a member if the archive states its encoding, else None."""
    if info.flag_bits & _UTF_8:
        return info.filename
    extra = info.extra
    while len(extra) >= 4:
        kind, length = struct.unpack_from("<HH", extra)
        if kind == _UNICODE_PATH and length > 5:
            with suppress(UnicodeError):
                return extra[9 : 4 + length].decode("utf-8")
        extra = extra[4 + length :]
    return None


def _fault(members: Sequence[ArchiveMember], path: Path) -> Fault | None:
    """Return the reason to reject an archive, or None: outside names, links, encryption, or too much content."""
    for member in members:
        info, location = member.info, Location(str(path / PurePosixPath(member.name).name))
        if not _is_harmless(member.name) or stat.S_ISLNK(info.external_attr >> 16):
            return Fault("archive-path", location, {"text": member.name})
        if info.flag_bits & 1:
            return Fault("archive-encrypted", location)
        if info.file_size > SMALL and info.file_size > MOST_RATIO * max(info.compress_size, 1):
            return Fault("archive-bomb", location)
    twice = [name for name, count in Counter(member.name for member in members).items() if count > 1]
    if twice:
        return Fault("archive-path", Location(str(path)), {"text": twice[0]})
    # Members that share their bytes unpack to more than any one of them shows.
    ordered = sorted((member.info for member in members), key=lambda info: info.header_offset)
    starts = [info.header_offset for info in ordered]
    for info in ordered:
        following = bisect_right(starts, info.header_offset)
        if following < len(starts) and info.header_offset + info.compress_size > starts[following]:
            return Fault("archive-bomb", Location(str(path)))
    if len(members) > MOST_MEMBERS or sum(member.info.file_size for member in members) > MOST_BYTES:
        return Fault("archive-bomb", Location(str(path)))
    return None


def _is_harmless(name: str) -> bool:
    """Return True if a member's name stays inside the folder that it is unpacked to, on any system."""
    parts = PurePosixPath(name).parts
    strange = "\\" in name or any(unicodedata.category(letter) in ("Cc", "Cs") for letter in name)
    has_drive = name[1:2] == ":" and name[0] in _DRIVES
    return bool(parts) and not (name.startswith("/") or ".." in parts or strange or has_drive)


def zipped(files: Mapping[str, bytes]) -> bytes:
    """Return files as an archive; the same files give the same bytes."""
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in sorted(files.items()):
            member = zipfile.ZipInfo(name, MOMENT)
            member.compress_type = zipfile.ZIP_DEFLATED
            member.external_attr = 0o644 << 16
            archive.writestr(member, content)
    return stream.getvalue()
