"""Files that are handed in in place of a sheet, by their endings: how each is read, and how it is given back."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from reportgen.base.errors import Fault, Mark
from reportgen.base.files import cause, contents
from reportgen.base.units import Language
from reportgen.base.words import as_error
from reportgen.handin import FileReading
from reportgen.marking.marks import Marking
from reportgen.marking.policy import Policy
from reportgen.report.key import Key
from reportgen.workbook.package import RefusedError

NOT_READ = frozenset(
    {
        ".pdf",
        ".jpg",
        ".jpeg",
        ".png",
        ".heic",
        ".tif",
        ".tiff",
        ".bmp",
        ".webp",
        ".doc",
        ".odt",
        ".rtf",
        ".dwg",
        ".pages",
    }
)
"""Endings of what may well be somebody's work, and is not read."""
LARGEST = 50_000_000
"""Bytes of a file."""


@dataclass(frozen=True, slots=True)
class FileKind:
    """A kind of file: how it is read for a key, which names stand in it, and how it is given back with a marking."""

    read: Callable[[Path, bytes, Key], FileReading]
    names: Callable[[Path, bytes, Collection[str]], Collection[str]]
    marked: Callable[[Path, bytes, FileReading, Marking, Policy], tuple[str, bytes]]
    several: bool = False
    """Whether a student has several of them, that are all of one work."""


def kinds() -> Mapping[str, FileKind]:
    """The kinds by their endings; what reads them is imported when one comes."""
    from reportgen.handin import word_report

    return {".docx": FileKind(word_report.read, word_report.names, word_report.marked)}


OWN = frozenset({".docx"})
"""The endings of `kinds`."""


def content(path: Path, data: bytes | None, language: Language | None) -> bytes:
    """The bytes of a file, no more than may be; raises `AssignmentError` where there are none to be had."""
    if data is not None:
        return data
    try:
        return contents(path, LARGEST + 1)
    except OSError as error:
        raise as_error([Fault("unreadable", Mark(str(path)), {"reason": cause(error)})], language) from error


def read_file(path: Path, data: bytes, key: Key, language: Language | None) -> FileReading:
    """What a file says of the quantities that a key asks for; raises `AssignmentError` for one that is refused."""
    try:
        return kinds()[path.suffix.lower()].read(path, data, key)
    except RefusedError as refused:
        raise as_error([refused.fault], language) from None


def names_in(path: Path, data: bytes, names: Collection[str], language: Language | None) -> Collection[str]:
    """Which of some names stand in a file; raises `AssignmentError` for one that is refused."""
    try:
        return kinds()[path.suffix.lower()].names(path, data, names)
    except RefusedError as refused:
        raise as_error([refused.fault], language) from None


def marked_copies(
    files: Collection[tuple[Path, bytes, FileReading]], marking: Marking, policy: Policy
) -> Iterator[tuple[str, bytes]]:
    """The files of a student with what was found written into them, by their new names."""
    for path, data, reading in files:
        yield kinds()[path.suffix.lower()].marked(path, data, reading, marking, policy)
