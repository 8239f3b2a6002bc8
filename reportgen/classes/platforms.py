"""What is handed in, sheets and own reports and drawings: files, folders, and what a learning platform gives for
download, also as a zip.

Moodle puts the files of a student into a folder `Name_4711_assignsubmission_file`, or before the names of the files;
Canvas names each file `name_userid_attachmentid_file`.  What is given back to the student must carry the same
beginning.  An archive is read in place, member by member: nothing of it is written to disk.
"""

from __future__ import annotations

import io
import re
import stat
import time
import unicodedata
import zipfile
from bisect import bisect_right
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from pathlib import Path, PurePosixPath

from reportgen.base.errors import Fault, Mark
from reportgen.base.files import cause, leads_out
from reportgen.handin import files as own_files
from reportgen.workbook.package import MOST_RATIO, SMALL, UNREADABLE_ZIP
from reportgen.workbook.reading import BOOKS, LARGEST
from reportgen.workbook.writing import MOMENT

SHEETS = BOOKS | {".csv"}
"""Endings of files that may be meant as sheets; a fault is reported for those that cannot be read."""
SUBMISSIONS = SHEETS | own_files.OWN
"""Those of all files that are read: sheets, and a student's own report and drawings."""
ARCHIVE = ".zip"
MOST_MEMBERS = 20_000
MOST_BYTES = 2_000_000_000
"""Of all members of an archive, unpacked; only its sheets are read, one at a time."""

_MOODLE_FOLDER = re.compile(r"(?P<name>.+)_(?P<number>\d+)_assignsubmission_file_?")
_MOODLE_FILE = re.compile(r"(?P<prefix>(?P<name>.+?)_(?P<number>\d+)_assignsubmission_file_).+")
_CANVAS = re.compile(r"(?P<prefix>(?P<name>\w+?)(?P<late>_LATE)?_(?P<number>\d+)_\d+_).+")
_CANVAS_BLIND = re.compile(r"(?P<prefix>(?P<late>LATE_)?anon_(?P<number>[A-Za-z0-9]+)_\d+_).+")
_DRIVE = re.compile(r"[A-Za-z]:")


@dataclass(frozen=True, slots=True)
class Owner:
    """Who handed a file in, as the platform says: a number of its own, a name ("" if it tells none).

    `prefix` begins the names of the files that are given back: a folder, or the beginning of a file's name.  `late`
    says that the platform calls it late, without a date.
    """

    number: str
    name: str
    prefix: str
    late: bool = field(default=False, compare=False)

    def may_be(self, name: str) -> bool:
        """Whether it can be the student of that name, whatever the order of names, case and accents."""
        if not self.name or not name:
            return True
        own, given = _words(self.name), _words(name)
        return sorted("".join(own)) == sorted("".join(given)) or not (own - given and given - own)


@dataclass(frozen=True, slots=True)
class Handed:
    """A file that may be a sheet: `path` names it, `data` is its content where it comes from an archive.

    `when` is the year, month, day, hour, minute and second of its last change.  What was handed in without a sheet has
    the `fault`.
    """

    path: Path
    owner: Owner | None = None
    data: bytes | None = None
    when: tuple[int, ...] = ()
    fault: Fault | None = None

    @property
    def is_own(self) -> bool:
        """Whether it is a report or a drawing in place of a sheet."""
        return self.fault is None and self.path.suffix.lower() in own_files.OWN


def handed_in(paths: Sequence[Path], faults: list[Fault]) -> Iterator[Handed]:
    """The answer sheets among files, in folders and archives, one at a time.

    Faults are added for archives that are refused.
    """
    for path in paths:
        if path.is_dir():
            files = sorted(file for file in path.rglob("*") if file.is_file())
            inside = [file for file in files if not leads_out(file, path)]
            strays = sorted(set(files) - set(inside))
            faults += [Fault("path-outside", Mark(str(file)), {"text": file.name}) for file in strays]
            named = [(file.relative_to(path.parent).as_posix(), file) for file in inside]
            owners = _owners([name for name, _ in named])
            yield from (Handed(file, owners[name], when=changed(file)) for name, file in named if _is_sheet(name))
            yield from _without_sheet(path.parent, owners)
        elif path.suffix.lower() == ARCHIVE and path.is_file():
            yield from _from_archive(path, faults)
        else:
            fault = Fault("own-not-read", Mark(str(path))) if path.suffix.lower() in own_files.NOT_READ else None
            yield Handed(path, owner_of(path.as_posix()), when=changed(path), fault=fault)


def changed(path: Path) -> tuple[int, ...]:
    """When a file was last changed; who reads it tells of one that is not there."""
    with suppress(OSError):
        return time.localtime(path.stat().st_mtime)[:6]
    return ()


def files_read(paths: Sequence[Path]) -> Iterator[Path]:
    """The files that answer sheets are read from: those given, archives too, and what may be a sheet in a folder."""
    for path in paths:
        if path.is_dir():
            yield from (file for file in path.rglob("*") if _is_sheet(file.as_posix()))
        else:
            yield path


def owner_of(name: str) -> Owner | None:
    """Who handed in the file of this path, None if it does not come from a platform."""
    path = PurePosixPath(name)
    for part in path.parts[:-1]:
        if match := _MOODLE_FOLDER.fullmatch(part):
            return Owner(match["number"], match["name"], f"{part}/")
    for pattern in (_MOODLE_FILE, _CANVAS_BLIND, _CANVAS):
        if match := pattern.fullmatch(path.name):
            said = match.groupdict()
            return Owner(match["number"], said.get("name") or "", match["prefix"], bool(said.get("late")))
    return None


def _owners(names: Sequence[str]) -> dict[str, Owner | None]:
    """Who handed in each file; where all have one name, they are hidden ("Participant") and it says nothing."""
    owners = {name: owner_of(name) for name in names}
    known = {(owner.number, owner.name) for owner in owners.values() if owner}
    if len({number for number, _ in known}) > 1 and len({name for _, name in known}) == 1:
        return {name: replace(one, name="") if one else None for name, one in owners.items()}
    return owners


def _is_sheet(name: str) -> bool:
    """Whether it may be a sheet: not what a spreadsheet or a system keeps beside its files."""
    path = PurePosixPath(name)
    hidden = path.name.startswith((".", "~$")) or "__MACOSX" in path.parts
    return path.suffix.lower() in SUBMISSIONS and not hidden


def _without_sheet(place: Path, owners: dict[str, Owner | None]) -> Iterator[Handed]:
    """Students who handed in something, but nothing that can be a sheet."""
    sheets = {owner.number for name, owner in owners.items() if owner and _is_sheet(name)}
    seen: set[str] = set()
    for name, owner in owners.items():
        if owner and owner.number not in sheets and owner.number not in seen:
            seen.add(owner.number)
            own = (one for one, owned in owners.items() if owned and owned.number == owner.number)
            works = sorted(one for one in own if PurePosixPath(one).suffix.lower() in own_files.NOT_READ)
            about = {"text": owner.name or owner.number}
            fault = Fault("download-no-sheet", Mark(str(place / name)), about)
            if works:
                fault = Fault("own-not-read", Mark(str(place / works[0])))
            yield Handed(place / name, owner, fault=fault)


# --- archives ---------------------------------------------------------------------------------------


def _from_archive(path: Path, faults: list[Fault]) -> Iterator[Handed]:
    mark = Mark(str(path))
    try:
        with zipfile.ZipFile(path) as archive:
            members = [info for info in archive.infolist() if not info.is_dir()]
            refused = _refused(members, path)
            if refused:
                faults.append(refused)
                return
            owners = _owners([info.filename for info in members])
            for info in members:
                if _is_sheet(info.filename):
                    content = _content(archive, info)
                    yield Handed(path / info.filename, owners[info.filename], content, info.date_time)
            yield from _without_sheet(path, owners)
    except UNREADABLE_ZIP:
        faults.append(Fault("archive-damaged", mark))
    except OSError as error:
        faults.append(Fault("unreadable", mark, {"reason": cause(error)}))


def _content(archive: zipfile.ZipFile, info: zipfile.ZipInfo) -> bytes:
    """What a member holds, but no more than a sheet may have and one byte, which shows that it has too many."""
    own = PurePosixPath(info.filename).suffix.lower() in own_files.OWN
    with archive.open(info) as stream:
        return stream.read((own_files.LARGEST if own else LARGEST) + 1)


def _refused(members: Sequence[zipfile.ZipInfo], path: Path) -> Fault | None:
    """Why an archive is not read: names that lead out of it, links, encryption, or more than a class hands in."""
    for info in members:
        mark = Mark(str(path / PurePosixPath(info.filename).name))
        if not _is_harmless(info.filename) or stat.S_ISLNK(info.external_attr >> 16):
            return Fault("archive-path", mark, {"text": info.filename})
        if info.flag_bits & 1:
            return Fault("archive-encrypted", mark)
        if info.file_size > SMALL and info.file_size > MOST_RATIO * max(info.compress_size, 1):
            return Fault("archive-bomb", mark)
    twice = [name for name, count in Counter(info.filename for info in members).items() if count > 1]
    if twice:
        return Fault("archive-path", Mark(str(path)), {"text": twice[0]})
    # Members that share their bytes unpack to more than any one of them shows.
    ordered = sorted(members, key=lambda info: info.header_offset)
    starts = [info.header_offset for info in ordered]
    for info in ordered:
        following = bisect_right(starts, info.header_offset)
        if following < len(starts) and info.header_offset + info.compress_size > starts[following]:
            return Fault("archive-bomb", Mark(str(path)))
    if len(members) > MOST_MEMBERS or sum(info.file_size for info in members) > MOST_BYTES:
        return Fault("archive-bomb", Mark(str(path)))
    return None


def _is_harmless(name: str) -> bool:
    """Whether a member's name stays inside the folder that it is unpacked to, on any system."""
    parts = PurePosixPath(name).parts
    strange = "\\" in name or any(unicodedata.category(letter) in ("Cc", "Cs") for letter in name)
    return bool(parts) and not (name.startswith("/") or ".." in parts or strange or _DRIVE.match(name))


def zipped(files: Mapping[str, bytes]) -> bytes:
    """Files as an archive, the same files the same bytes."""
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in sorted(files.items()):
            member = zipfile.ZipInfo(name, MOMENT)
            member.compress_type = zipfile.ZIP_DEFLATED
            member.external_attr = 0o644 << 16
            archive.writestr(member, content)
    return stream.getvalue()


def _words(name: str) -> set[str]:
    """The words of a name without case and accents: {"nguyen", "van", "an"}."""
    bare = unicodedata.normalize("NFD", name.casefold().replace("đ", "d"))
    letters = "".join(letter for letter in bare if not unicodedata.combining(letter))
    return set(re.findall(r"[^\W_]+", letters))
