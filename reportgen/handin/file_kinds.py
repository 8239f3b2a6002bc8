"""Kinds of files submitted in place of a sheet, by suffix: how to read each, and how to mark a copy."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from reportgen.base.errors import Fault, Location
from reportgen.base.files import cause, contents
from reportgen.base.records import Record
from reportgen.base.units import Language
from reportgen.base.words import as_error
from reportgen.case.answer_key import Key
from reportgen.handin import FileReading
from reportgen.marking.marking_data import Marking
from reportgen.marking.marking_policy import Policy
from reportgen.workbook.zip_package import RefusedError

if TYPE_CHECKING:
    from reportgen.handin.drawing_reader import WantedPlans

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
        ".rar",
        ".7z",
    }
)
"""Suffixes of files that may be a student's work but are not read."""
LARGEST = 50_000_000
"""Largest size (bytes) of a file."""


class FileKind(Record):
    """A kind of file: functions that read it for a key, find names in it, and write a marked copy.

    A student may have `several` files of one work; their copies have a {number} in their name.
    """

    read: Callable[[Path, bytes, Key, WantedPlans | None], FileReading]
    names: Callable[[Path, bytes, Collection[str]], Collection[str]]
    marked: Callable[[Path, bytes, FileReading, Marking, Policy], tuple[str, bytes]]
    several: bool = False


def kinds() -> Mapping[str, FileKind]:
    """Return the kinds by suffix; their readers are imported on demand."""
    from reportgen.handin import drawing_file, word_report

    return {
        ".docx": FileKind(word_report.read, word_report.names, word_report.marked),
        DRAWING: FileKind(drawing_file.read, drawing_file.names, drawing_file.marked, several=True),
    }


DRAWING = ".dxf"
"""Suffix of drawings, which are read for the plans of an assignment."""
OWN = frozenset({".docx", DRAWING})
"""Suffixes of `kinds`."""


def not_read(path: Path) -> Fault | None:
    """Return the fault of a file that may be a student's work but is not read; None for any other."""
    ending = path.suffix.lower()
    if ending not in NOT_READ:
        return None
    return Fault("drawing-dwg" if ending == ".dwg" else "own-not-read", Location(str(path)))


def content(path: Path, data: bytes | None, language: Language | None) -> bytes:
    """Return the bytes of a file, up to the size limit and one more.

    Given `data` are returned unchanged. Raises `AssignmentError` if the file cannot be read.
    """
    if data is not None:
        return data
    try:
        return contents(path, LARGEST + 1)
    except OSError as error:
        raise as_error([Fault("unreadable", Location(str(path)), {"reason": cause(error)})], language) from error


def read_file(
    path: Path, data: bytes, key: Key, language: Language | None, plans: WantedPlans | None = None
) -> FileReading:
    """Return the values of a key's quantities in a file; in a drawing, `plans` are searched for.

    Raises `AssignmentError` if the file is rejected.
    """
    try:
        return kinds()[path.suffix.lower()].read(path, data, key, plans)
    except RefusedError as refused:
        raise as_error([refused.fault], language) from None


def names_in(path: Path, data: bytes, names: Collection[str], language: Language | None) -> Collection[str]:
    """Return the given names that occur in a file; raise `AssignmentError` if the file is rejected."""
    try:
        return kinds()[path.suffix.lower()].names(path, data, names)
    except RefusedError as refused:
        raise as_error([refused.fault], language) from None


def marked_copy(path: Path, data: bytes, reading: FileReading, marking: Marking, policy: Policy) -> tuple[str, bytes]:
    """Return the name and the content of a student's file with the results of marking written into it.

    The name has a {number} if a student may have several files of the kind. Raises `RefusedError` if nothing can be
    written into the file.
    """
    return kinds()[path.suffix.lower()].marked(path, data, reading, marking, policy)
