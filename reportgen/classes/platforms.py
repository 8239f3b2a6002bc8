"""Sheets as they are handed in: files, folders, and what a learning platform gives for download, also as a zip.

Moodle puts the files of a student into a folder `Name_4711_assignsubmission_file`, or before the names of the files;
Canvas names each file `name_userid_attachmentid_file`.  What is given back to the student must carry the same
beginning.  An archive is read in place, member by member: nothing of it is written to disk.
"""

from __future__ import annotations

import io
import re
import stat
import unicodedata
import zipfile
from bisect import bisect_right
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path, PurePosixPath

from reportgen.base.errors import AssignmentError, Fault, Mark, Problem
from reportgen.base.files import cause, leads_out
from reportgen.base.limits import Limits
from reportgen.base.source import encoding_of
from reportgen.base.units import Language
from reportgen.base.words import as_error, as_problem
from reportgen.classes.pool import each_within
from reportgen.marking.marks import Scale
from reportgen.workbook import Page, read
from reportgen.workbook.package import MOST_RATIO, SMALL, UNREADABLE_ZIP
from reportgen.workbook.reading import BOOKS, LARGEST, SEPARATORS
from reportgen.workbook.writing import MOMENT

SUBMISSIONS = BOOKS | {".csv"}
"""Endings of files that may be meant as sheets; a fault is reported for those that cannot be read."""
ARCHIVE = ".zip"
MOST_MEMBERS = 20_000
MOST_BYTES = 2_000_000_000
"""Of all members of an archive, unpacked; only its sheets are read, one at a time."""

_MOODLE_FOLDER = re.compile(r"(?P<name>.+)_(?P<number>\d+)_assignsubmission_file_?")
_MOODLE_FILE = re.compile(r"(?P<prefix>(?P<name>.+?)_(?P<number>\d+)_assignsubmission_file_).+")
_CANVAS = re.compile(r"(?P<prefix>(?P<name>\w+?)(?:_LATE)?_(?P<number>\d+)_\d+_).+")
_CANVAS_BLIND = re.compile(r"(?P<prefix>(?:LATE_)?anon_(?P<number>[A-Za-z0-9]+)_\d+_).+")
_DRIVE = re.compile(r"[A-Za-z]:")


@dataclass(frozen=True, slots=True)
class Owner:
    """Who handed a file in, as the platform says: a number of its own, a name ("" if it tells none).

    `prefix` begins the names of the files that are given back: a folder, or the beginning of a file's name.
    """

    number: str
    name: str
    prefix: str

    def may_be(self, name: str) -> bool:
        """Whether it can be the student of that name, whatever the order of names, case and accents."""
        if not self.name or not name:
            return True
        own, given = _words(self.name), _words(name)
        return sorted("".join(own)) == sorted("".join(given)) or not (own - given and given - own)


@dataclass(frozen=True, slots=True)
class Handed:
    """A file that may be a sheet: `path` names it, `data` is its content where it comes from an archive."""

    path: Path
    owner: Owner | None = None
    data: bytes | None = None


def handed_in(paths: Sequence[Path], faults: list[Fault]) -> Iterator[Handed]:
    """The answer sheets among files, in folders and archives, one at a time.

    Faults are added for archives that are refused and for students without a file that can be a sheet.
    """
    for path in paths:
        if path.is_dir():
            files = sorted(file for file in path.rglob("*") if file.is_file())
            inside = [file for file in files if not leads_out(file, path)]
            strays = sorted(set(files) - set(inside))
            faults += [Fault("path-outside", Mark(str(file)), {"text": file.name}) for file in strays]
            named = [(file.relative_to(path.parent).as_posix(), file) for file in inside]
            owners = _owners([name for name, _ in named])
            yield from (Handed(file, owners[name]) for name, file in named if _is_sheet(name))
            faults += _without_sheet(path.parent, owners)
        elif path.suffix.lower() == ARCHIVE and path.is_file():
            yield from _from_archive(path, faults)
        else:
            yield Handed(path, owner_of(path.as_posix()))


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
            return Owner(match["number"], match.groupdict().get("name") or "", match["prefix"])
    return None


def _owners(names: Sequence[str]) -> dict[str, Owner | None]:
    """Who handed in each file; where all have one name, they are hidden ("Participant") and it says nothing."""
    owners = {name: owner_of(name) for name in names}
    known = {(owner.number, owner.name) for owner in owners.values() if owner}
    if len({number for number, _ in known}) > 1 and len({name for _, name in known}) == 1:
        return {name: Owner(one.number, "", one.prefix) if one else None for name, one in owners.items()}
    return owners


def _is_sheet(name: str) -> bool:
    """Whether it may be a sheet: not what a spreadsheet or a system keeps beside its files."""
    path = PurePosixPath(name)
    hidden = path.name.startswith((".", "~$")) or "__MACOSX" in path.parts
    return path.suffix.lower() in SUBMISSIONS and not hidden


def _without_sheet(place: Path, owners: dict[str, Owner | None]) -> Iterator[Fault]:
    """Students who handed in something, but nothing that can be a sheet."""
    sheets = {owner.number for name, owner in owners.items() if owner and _is_sheet(name)}
    seen: set[str] = set()
    for name, owner in owners.items():
        if owner and owner.number not in sheets and owner.number not in seen:
            seen.add(owner.number)
            yield Fault("download-no-sheet", Mark(str(place / name)), {"text": owner.name or owner.number})


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
                    yield Handed(path / info.filename, owners[info.filename], _content(archive, info))
            faults += _without_sheet(path, owners)
    except UNREADABLE_ZIP:
        faults.append(Fault("archive-damaged", mark))
    except OSError as error:
        faults.append(Fault("unreadable", mark, {"reason": cause(error)}))


def _content(archive: zipfile.ZipFile, info: zipfile.ZipInfo) -> bytes:
    """What a member holds, but no more than a sheet may have and one byte, which shows that it has too many."""
    with archive.open(info) as stream:
        return stream.read(LARGEST + 1)


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


# --- marks filled into the table that a learning platform gave for it -----------------------------
# All else in the file stays byte for byte.
# Moodle's grading worksheet has its headings in the teacher's language, so its columns are found by their place and
# content: the first one ends in each participant's number, and the grade stands before the column of the greatest
# grade, which is one number throughout. Canvas's gradebook has English headings, a row "Points Possible", and a
# column `Title (id)` for each assignment.

DECIMALS = 2
"""Of a grade, where the table does not show how many it has."""

_NUMBER = re.compile(r"\d+(?:[.,]\d+)?")
_PARTICIPANT = re.compile(r"\D+(\d+)")
_TITLE = re.compile(r"(.+?)\s*\((\d+)\)")


@dataclass(frozen=True, slots=True)
class StudentResult:
    """The result of one student: ids by which a row may name them, the platform's number ("" if unknown), the share."""

    who: str
    ids: frozenset[str]
    number: str
    share: float


@dataclass(frozen=True, slots=True)
class _Cell:
    """A cell of the file's text: where it begins and ends, what it says, whether in quotation marks."""

    start: int
    end: int
    text: str
    quoted: bool


@dataclass(frozen=True, slots=True)
class _Table:
    """The table's students: each with the cell of the grade, the platform's number, what else the row says of them."""

    rows: tuple[tuple[_Cell, str, frozenset[str]], ...]
    highest: str
    """The greatest grade, as the table writes it."""


@dataclass(frozen=True, slots=True)
class Gradebook:
    """A platform's table: its text between the `mark` of its encoding and the end, and where its grades go."""

    path: Path
    text: str
    mark: bytes
    encoding: str
    separator: str
    table: _Table

    def filled(self, results: Sequence[StudentResult], scale: Scale) -> tuple[bytes, list[Fault]]:
        """The file with the grades, and faults for students that it has no row for."""
        changes: dict[_Cell, str] = {}
        faults: list[Fault] = []
        for student in results:
            cells = _of(student, self.table.rows)
            if len(cells) == 1:
                changes[cells[0]] = _grade(scale.mark(student.share) / scale.highest, self.table.highest)
            else:
                faults.append(Fault("gradebook-no-row", Mark(str(self.path)), {"text": student.who}))
        return self.mark + _changed(self.text, changes, self.separator).encode(self.encoding), faults


def read_gradebook(path: Path, column: str = "", language: Language | None = None) -> Gradebook:
    """A platform's table; `column` chooses one of Canvas's assignments by its heading, title or id.

    Raises `AssignmentError` if the file cannot be read or is neither of the two tables.
    """
    if path.suffix.lower() in BOOKS:
        raise as_error([Fault("gradebook-no-csv", Mark(str(path)))], language)
    # What cannot be read as CSV is refused here, with its place.
    read(path, language)
    data = path.read_bytes()
    mark, encoding = encoding_of(data)
    text = data.removeprefix(mark).decode(encoding)
    separator = _separator(text)
    rows = [row for row in _rows(text, separator) if any(cell.text.strip() for cell in row)]
    table = _canvas(rows, column, path) if _is_canvas(rows) else _moodle(rows, path)
    if isinstance(table, Fault):
        raise as_error([table], language)
    return Gradebook(path, text, mark, encoding, separator, table)


def _of(student: StudentResult, rows: Sequence[tuple[_Cell, str, frozenset[str]]]) -> list[_Cell]:
    """The cells of the rows that are the student's: by the platform's number if it is known, else by id or e-mail."""
    if student.number and (cells := [cell for cell, number, _ in rows if number == student.number]):
        return cells
    return [cell for cell, _, names in rows if names & student.ids]


def _grade(share: float, highest: str) -> str:
    """A grade with the decimal mark and the decimals of the greatest one."""
    whole, point, decimals = highest.partition("," if "," in highest else ".")
    value = share * float(f"{whole}.{decimals or 0}")
    shown = f"{value:.{len(decimals) if point else DECIMALS}f}"
    return shown.replace(".", point or ".")


def _names(texts: Sequence[str]) -> frozenset[str]:
    return frozenset(text.strip().casefold() for text in texts if text.strip())


# --- Moodle -----------------------------------------------------------------------------------------


def _moodle(rows: Sequence[Sequence[_Cell]], path: Path) -> _Table | Fault:
    """Moodle's grading worksheet: the grade is the column before that of the greatest grade."""
    head, *body = rows or [()]
    full = [row for row in body if len(row) == len(head)]
    numbers = [match[1] if row and (match := _PARTICIPANT.fullmatch(row[0].text.strip())) else "" for row in full]
    if not full or len(full) < len(body) or not all(numbers) or len(set(numbers)) < len(numbers):
        return Fault("gradebook-unknown", Mark(str(path)))
    columns = [[row[k].text.strip() for row in full] for k in range(len(head))]
    # A scale of words has no greatest grade, and Moodle takes no numbers for it.
    graded = [k for k in range(2, len(head)) if _is_greatest(columns[k], columns[k - 1])]
    if len(graded) != 1:
        return Fault("gradebook-no-column", Mark(str(path)))
    (greatest,) = graded
    table = zip(full, numbers, strict=True)
    return _Table(
        tuple(
            (row[greatest - 1], number, _names([cell.text for cell in row[1 : greatest - 1]])) for row, number in table
        ),
        columns[greatest][0],
    )


def _is_greatest(column: Sequence[str], before: Sequence[str]) -> bool:
    """Whether a column is one number throughout, and the one before it empty or no greater."""
    if len(set(column)) != 1 or not _NUMBER.fullmatch(column[0]):
        return False
    return all(not text or (_NUMBER.fullmatch(text) and _value(text) <= _value(column[0])) for text in before)


def _value(text: str) -> float:
    return float(text.replace(",", "."))


# --- Canvas -----------------------------------------------------------------------------------------


def _is_canvas(rows: Sequence[Sequence[_Cell]]) -> bool:
    head = [cell.text for cell in rows[0]] if rows else []
    return "Section" in head and ("Student" in head[:1] or head[:2] == ["LastName", "FirstName"])


def _canvas(rows: Sequence[Sequence[_Cell]], wanted: str, path: Path) -> _Table | Fault:
    """Canvas's gradebook: one of its assignments, which `wanted` must name if there are several."""
    head = [cell.text for cell in rows[0]]
    mark = Mark(str(path))
    points = next((row for row in rows[1:] if "Points Possible" in row[0].text), None)
    if points is None or "ID" not in head:
        return Fault("gradebook-unknown", mark)
    titles = {k: match for k in range(head.index("Section") + 1, len(head)) if (match := _TITLE.fullmatch(head[k]))}
    open_ones = {
        k: match for k, match in titles.items() if k < len(points) and _NUMBER.fullmatch(points[k].text.strip())
    }
    chosen = [k for k, match in open_ones.items() if not wanted or wanted in (match[0], match[1], match[2])]
    if len(chosen) != 1:
        known = "; ".join(match[0] for match in open_ones.values())
        return Fault("gradebook-which-column", mark, {"known": known or "–"})
    (column,) = chosen
    people = [head.index(name) for name in ("SIS User ID", "SIS Login ID") if name in head]
    students = [
        row for row in rows[1:] if row is not points and len(row) > column and row[head.index("ID")].text.strip()
    ]
    return _Table(
        tuple(
            (row[column], row[head.index("ID")].text.strip(), _names([row[k].text for k in people])) for row in students
        ),
        points[column].text.strip(),
    )


# --- the file ---------------------------------------------------------------------------------------


def _separator(text: str) -> str:
    header = next((line for line in text.splitlines() if line.strip()), "")
    outside = re.sub(r'"[^"]*"?', "", header)
    return max(SEPARATORS, key=outside.count)


def _rows(text: str, separator: str) -> Iterator[list[_Cell]]:
    """The cells of each line with their places; a quoted cell may hold separators and line ends."""
    cell = re.compile(rf'"([^"]*+(?:""[^"]*+)*+)"|([^{re.escape(separator)}\r\n]*+)')
    at = 0
    row: list[_Cell] = []
    while at < len(text):
        match = cell.match(text, at)
        assert match is not None, "any text begins with a cell, which may be empty"
        quoted = match[1] is not None
        row.append(_Cell(at, match.end(), match[1].replace('""', '"') if quoted else match[2], quoted))
        at = match.end()
        if text.startswith(separator, at):
            at += 1
            if at == len(text):
                row.append(_Cell(at, at, "", False))
            continue
        yield row
        row = []
        at += 2 if text.startswith("\r\n", at) else 1
    if row:
        yield row


def _changed(text: str, changes: Mapping[_Cell, str], separator: str) -> str:
    """The text with other contents in some cells."""
    parts: list[str] = []
    at = 0
    for cell in sorted(changes, key=lambda cell: cell.start):
        new = changes[cell]
        parts += [text[at : cell.start], f'"{new}"' if cell.quoted or separator in new else new]
        at = cell.end
    return "".join((*parts, text[at:]))


# --- sheets read as they were handed in, each in a process of its own time and memory -------------
# A file may be made so that reading it takes hours or all memory; that is the fault of whoever handed it in, and must
# not keep the others from their marks.

LIMITS = Limits(seconds=60.0, megabytes=1000)
"""For one sheet: the largest that is not refused anyhow takes about an eighth of them."""

Pages = tuple[Page, ...]


def read_sheets(handed: Iterable[Handed], language: Language | None) -> Iterator[tuple[Handed, Pages | list[Problem]]]:
    """Each file with its pages, in their order, or with the faults for which it cannot be read."""
    calls = ((one, language) for one in handed)
    for (sheet, _), pages in each_within(LIMITS, _read, calls, __name__):
        yield sheet, [_beyond(sheet.path, language)] if pages is None else pages


def _read(call: tuple[Handed, Language | None]) -> Pages | list[Problem]:
    """The pages of a file, in the process that reads it."""
    sheet, language = call
    try:
        return read(sheet.path, language, sheet.data)
    except AssignmentError as error:
        return list(error.problems)


def _beyond(path: Path, language: Language | None) -> Problem:
    limits = {"seconds": f"{LIMITS.seconds:g}", "largest": str(LIMITS.megabytes)}
    return as_problem(Fault("sheet-beyond-limits", Mark(str(path)), limits), language)
