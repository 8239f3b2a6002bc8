"""Find submissions in files, folders and downloads of a learning platform, also zipped: `handed_in`.

Submissions are sheets, reports and drawings. Moodle puts a student's files into a folder
`Name_4711_assignsubmission_file`, or uses that as a prefix of their names. Canvas names each file
`name_userid_attachmentid_file`. Files returned to the student must have the same prefix. Moodle may hide names
(`Participant_4711_assignsubmission_file`); then only the number is known.
"""

from __future__ import annotations

import re
import time
import unicodedata
from collections.abc import Collection, Iterator, Sequence
from contextlib import suppress
from functools import cache
from pathlib import Path, PurePosixPath

from reportgen.base.errors import Fault, Location
from reportgen.base.files import leads_out
from reportgen.base.records import Record, replace, uncompared
from reportgen.base.template_folders import languages
from reportgen.base.words import messages
from reportgen.classes.archives import ARCHIVE, LARGEST_INSIDE, opened
from reportgen.classes.roster import folded
from reportgen.handin import file_kinds as own_files
from reportgen.workbook.table_reading import BOOKS, LARGEST
from reportgen.workbook.zip_package import RefusedError

SHEETS = BOOKS | {".csv"}
"""Suffixes of files that may be sheets; a fault is reported for those that cannot be read."""
SUBMISSIONS = SHEETS | own_files.OWN
"""Suffixes of all files that are read: sheets, and a student's own report and drawings."""
DEEPEST = 1
"""Deepest nesting of archives: those in a class download are opened, archives inside a submitted archive are not."""

_MOODLE_FOLDER = re.compile(r"(?P<name>.+)_(?P<number>\d+)_assignsubmission_file_?")
_MOODLE_FILE = re.compile(r"(?P<prefix>(?P<name>.+?)_(?P<number>\d+)_assignsubmission_file_).+")
_CANVAS = re.compile(r"(?P<prefix>(?P<name>\w+?)(?P<late>_LATE)?_(?P<number>\d+)_\d+_).+")
_LOST = "?_\ufffd"
"""Characters that programs write in place of letters that their encoding lacks."""
_CANVAS_BLIND = re.compile(r"(?P<prefix>(?P<late>LATE_)?anon_(?P<number>[A-Za-z0-9]+)_\d+_).+")


@uncompared("late")
class Owner(Record):
    """The submitter of a file according to the platform: its own number, and a name ("" if it is hidden).

    `prefix` begins the names of returned files: a folder, or the beginning of a file's name. `late` is True if the
    platform calls the file late, without a date.
    """

    number: str
    name: str
    prefix: str
    late: bool = False

    def may_be(self, name: str) -> bool:
        """Return True if this can be the student of that name, ignoring the order of names, case and accents."""
        if not self.name or not name or self.is_hidden:
            return True
        own, given = _words(self.name), _words(name)
        same = sorted("".join(own)) == sorted("".join(given)) or not (own - given and given - own)
        return same or _fits(self.name, name)

    @property
    def is_hidden(self) -> bool:
        """True if the platform writes "Participant" in place of the name, also after a group: "Group A-Participant"."""
        return folded(self.name.rpartition("-")[2]) in _hidden_names()


class Handed(Record):
    """A file that may be a sheet: `path` names it, `data` is its content if it comes from an archive.

    `when` is the year, month, day, hour, minute and second of its last change. A submission without a sheet has the
    `fault`.
    """

    path: Path
    owner: Owner | None = None
    data: bytes | None = None
    when: tuple[int, ...] = ()
    fault: Fault | None = None

    @property
    def is_own(self) -> bool:
        """True if this is a report or a drawing in place of a sheet."""
        return self.fault is None and self.path.suffix.lower() in own_files.OWN


def handed_in(paths: Sequence[Path], faults: list[Fault], names: Collection[str] = ()) -> Iterator[Handed]:
    """Yield the submissions among files, in folders and archives, one at a time; submitted archives are opened too.

    `names` are those of the students; they help to decode the names of an archive without a stated encoding. Faults are
    added for rejected archives.
    """
    people = frozenset(map(_words_of, filter(None, names)))
    for path in paths:
        if path.is_dir():
            files = sorted(file for file in path.rglob("*") if file.is_file())
            inside = [file for file in files if not leads_out(file, path)]
            strays = sorted(set(files) - set(inside))
            faults += [Fault("path-outside", Location(str(file)), {"text": file.name}) for file in strays]
            named = [(file.relative_to(path.parent).as_posix(), file) for file in inside]
            owners = _owners([name for name, _ in named])
            with_work: set[str] = set()
            for name, file in named:
                if _is_sheet(name):
                    yield from _noted(iter([Handed(file, owners[name], when=modification_time(file))]), with_work)
                elif _is_archive(name):
                    yield from _noted(_from_archive(Handed(file, owners[name]), people, 0), with_work)
            yield from _without_sheet(path.parent, owners, with_work)
        elif path.suffix.lower() == ARCHIVE and path.is_file():
            try:
                yield from _members(Handed(path), people, 0)
            except RefusedError as refused:
                faults.append(refused.fault)
        else:
            fault = own_files.not_read(path)
            yield Handed(path, owner_of(path.as_posix()), when=modification_time(path), fault=fault)


def _noted(handed: Iterator[Handed], with_work: set[str]) -> Iterator[Handed]:
    """Yield submissions, adding the numbers of their owners to `with_work`."""
    for file in handed:
        if file.owner:
            with_work.add(file.owner.number)
        yield file


def _from_archive(archive: Handed, people: Collection[HeaderWords], depth: int) -> Iterator[Handed]:
    """Yield the sheets in a student's archive, or the fault for which it is not read."""
    try:
        if depth > DEEPEST:
            raise RefusedError("archive-nested", Location(str(archive.path)))
        if archive.data is not None and len(archive.data) > LARGEST_INSIDE:
            raise RefusedError("archive-bomb", Location(str(archive.path)))
        yield from _members(archive, people, depth)
    except RefusedError as refused:
        yield replace(archive, data=None, fault=refused.fault)


def _members(handed: Handed, people: Collection[HeaderWords], depth: int) -> Iterator[Handed]:
    """Yield the sheets among the members of an archive, all with its owner; raise `RefusedError`."""

    def judge(names: Sequence[str]) -> int:
        owners = {owner.name for name in names if (owner := owner_of(name))}
        return sum(_words_of(name) in people for name in owners)

    with opened(handed.path, handed.data, judge) as archive:
        owners = _owners([member.name for member in archive.members])
        if handed.owner is not None:
            owners = dict.fromkeys(owners, handed.owner)
        with_work: set[str] = set()
        for member in archive.members:
            name, owner, when = handed.path / member.name, owners[member.name], member.info.date_time
            if _is_sheet(member.name):
                own = PurePosixPath(member.name).suffix.lower() in own_files.OWN
                content = archive.content(member, own_files.LARGEST if own else LARGEST)
                yield from _noted(iter([Handed(name, owner, content, when)]), with_work)
            elif _is_archive(member.name):
                content = archive.content(member, LARGEST_INSIDE)
                yield from _noted(_from_archive(Handed(name, owner, content, when), people, depth + 1), with_work)
        yield from _without_sheet(handed.path, owners, with_work)


def modification_time(path: Path) -> tuple[int, ...]:
    """Return the time of a file's last change, or () if it does not exist; reading it reports the fault."""
    with suppress(OSError):
        return time.localtime(path.stat().st_mtime)[:6]
    return ()


def files_read(paths: Sequence[Path]) -> Iterator[Path]:
    """Yield the files that sheets are read from: those given, archives too, and possible sheets in folders."""
    for path in paths:
        if path.is_dir():
            yield from (one for one in path.rglob("*") if _is_sheet(one.as_posix()) or _is_archive(one.as_posix()))
        else:
            yield path


def owner_of(name: str) -> Owner | None:
    """Return the submitter of the file at a path, or None if it does not come from a platform."""
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
    """Return the submitter of each file; a name shared by all, such as "Participant", is removed."""
    owners = {name: owner_of(name) for name in names}
    known = {(owner.number, owner.name) for owner in owners.values() if owner}
    if len({number for number, _ in known}) > 1 and len({name for _, name in known}) == 1:
        return {name: replace(one, name="") if one else None for name, one in owners.items()}
    return owners


def _is_sheet(name: str) -> bool:
    """Return True for a possible sheet, excluding files that a spreadsheet or a system keeps beside its own."""
    return PurePosixPath(name).suffix.lower() in SUBMISSIONS and not _is_hidden(name)


def _is_hidden(name: str) -> bool:
    """Return True for a file that a program or a system keeps beside its own files."""
    path = PurePosixPath(name)
    return path.name.startswith((".", "~$")) or "__MACOSX" in path.parts


def _is_archive(name: str) -> bool:
    """Return True for an archive that somebody submitted."""
    return PurePosixPath(name).suffix.lower() == ARCHIVE and not _is_hidden(name)


def _without_sheet(place: Path, owners: dict[str, Owner | None], with_work: Collection[str]) -> Iterator[Handed]:
    """Yield students who submitted files, but no possible sheet; `with_work` are the numbers of the others."""
    seen: set[str] = set()
    for name, owner in owners.items():
        if owner and owner.number not in with_work and owner.number not in seen:
            seen.add(owner.number)
            own = (one for one, owned in owners.items() if owned and owned.number == owner.number)
            works = sorted(one for one in own if PurePosixPath(one).suffix.lower() in own_files.NOT_READ)
            about = {"text": owner.name or owner.number}
            fault = Fault("download-no-sheet", Location(str(place / name)), about)
            if works:
                fault = Fault("own-not-read", Location(str(place / works[0])))
            yield Handed(place / name, owner, fault=fault)


HeaderWords = tuple[str, ...]


def _words_of(name: str) -> HeaderWords:
    """Return the words of a name in sorted order, for comparing names."""
    return tuple(sorted(_words(name)))


@cache
def _hidden_names() -> frozenset[str]:
    """Return the words that platforms use for students with hidden names, in every language."""
    return frozenset(folded(name) for language in languages() for name in messages(language)["hidden_names"])


def _words(name: str) -> set[str]:
    """Return the words of a name without case and accents: {"nguyen", "van", "an"}."""
    return set(re.findall(r"[^\W_]+", _bare(name)))


def _bare(name: str) -> str:
    """Return a name without case and accents."""
    letters = unicodedata.normalize("NFD", name.casefold().replace("đ", "d"))
    return "".join(letter for letter in letters if not unicodedata.combining(letter))


def _fits(damaged: str, name: str) -> bool:
    """Return True if a name with lost letters, "Nguy?n V?n An", can be that of a student."""
    pattern = "".join(".?" if letter in _LOST else re.escape(letter) for letter in _bare(damaged))
    return any(letter in damaged for letter in _LOST) and re.fullmatch(pattern, _bare(name)) is not None
