"""Words by sections: a file has many, each behind a line `%% name`, in the order in which they are read.

A machine's words and a school's are one file a language; those that all machines share are a folder, in which
`report.md` has the section `foreword`, and `dyads.md` the section `RRR-forces` of the name `dyads/RRR-forces`.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from pathlib import Path

from reportgen.errors import TemplateError

HEADING = "%%"
MACHINES = "catalogue"
"""The folder beside `report.md` with a file for each kind of machine or exercise."""

KEPT_FILES = 128
"""How many files are kept."""


@dataclass(frozen=True, slots=True)
class Passage:
    """The words of a section, which begin on the line below its heading in line `line` of the file."""

    file: Path
    line: int
    text: str


def sections(file: Path) -> Mapping[str, Passage]:
    """The sections of a file by their names, in its order; none if there is no such file.

    What stands before the first is a note about the file, and blank lines between two belong to neither.  Raises
    `TemplateError` with file and line for a name that is empty or met again and for what cannot be read.
    """
    try:
        about = file.stat()
    except (FileNotFoundError, NotADirectoryError):
        return {}
    return _sections_of(file, about.st_mtime_ns, about.st_size)


def find(name: str, places: Sequence[Path]) -> Passage | None:
    """The section of this name in the first of some places (files, folders) that has it."""
    found = (sections(file).get(section) for file, section in (home(name, place) for place in places))
    return next(filter(None, found), None)


def home(name: str, place: Path) -> tuple[Path, str]:
    """The file in which the section `name` would stand in a place, and what it would be called there."""
    if place.suffix == ".md":
        return place, name
    file, _, section = name.rpartition("/")
    return place / f"{file or 'report'}.md", section


def refuse_strangers(places: Sequence[Path]) -> None:
    """Raise `TemplateError` for a section of a school that no report in the language (the last place) has.

    It would never be read: its name is misspelt, or is that of an older version.
    """
    language = places[-1]
    for file in places:
        if file.is_relative_to(language):
            continue
        known = set(_names(language))
        for name, section in sections(file).items():
            if name not in known:
                raise TemplateError(f"{file}:{section.line}: no report has a section {name}")


def _names(language: Path) -> Iterator[str]:
    """The names of all sections of a language, those of the machines included."""
    for file in language.glob("*.md"):
        yield from (name if file.stem == "report" else f"{file.stem}/{name}" for name in sections(file))
    for file in (language / MACHINES).glob("*.md"):
        yield from sections(file)


@lru_cache(maxsize=KEPT_FILES)
def _sections_of(file: Path, changed: int, size: int) -> Mapping[str, Passage]:
    """The sections of a file, read once for as long as it stays the same."""
    try:
        lines = file.read_text(encoding="utf-8-sig").split("\n")
    except (OSError, UnicodeDecodeError) as error:
        raise TemplateError(f"{file}:1: {error}") from error
    headings = [number for number, line in enumerate(lines, start=1) if line.startswith(HEADING)]
    found: dict[str, Passage] = {}
    for number, end in pairwise([*headings, len(lines) + 1]):
        name = lines[number - 1].removeprefix(HEADING).strip()
        if not name:
            raise TemplateError(f"{file}:{number}: a section has a name, as in {HEADING} given")
        if name in found:
            raise TemplateError(f"{file}:{number}: the section {name} is there already, in line {found[name].line}")
        found[name] = Passage(file, number, "\n".join(lines[number : end - 1]).rstrip("\n") + "\n")
    return found
