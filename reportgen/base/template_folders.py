"""Folders of words, frames and examples: the program's, those of schools, and the order in which they are read."""

from __future__ import annotations

import os
from functools import cache
from pathlib import Path

from reportgen.base.files import leads_out
from reportgen.base.topics import topics

Language = str
"""Name of a folder that is a language; code that reads one from outside checks it against `languages`."""
DEFAULT_LANGUAGE: Language = "vi"
REFERENCE: Language = "en"
"""Reference language, whose words replace those missing in another language."""
LANGUAGE_FILE = "language.yaml"
"""Name of the file that makes a folder of templates a language."""

MACHINES = "catalogue"
"""The folder beside `report.md` with a file for each kind of machine or exercise."""
TOPICS = "topics"
"""The folder beside `report.md` with a file for each topic of a machine."""


def templates() -> Path:
    """Return the folder of words and frames: packed into the package, or beside it in a checkout."""
    return _packed("templates", "templates")


@cache
def languages() -> tuple[Language, ...]:
    """Return the available languages: the default one, the reference language, then all others by their names."""
    names = {file.parent.name for file in templates().glob(f"*/{LANGUAGE_FILE}")}
    first = [language for language in (DEFAULT_LANGUAGE, REFERENCE) if language in names]
    return (*first, *sorted(names - {*first}))


def samples() -> Path:
    """Return the folder of examples: packed into the package, or beside it in a checkout."""
    return _packed("samples", "assignments")


def documentation() -> Path:
    """Return the folder of the documentation: packed into the package, or beside it in a checkout."""
    return _packed("docs", "docs")


def _packed(name: str, beside: str) -> Path:
    package = Path(__file__).resolve().parents[1]
    packed = package / name
    return packed if packed.is_dir() else package.parent / beside


def _of_school(folder: Path) -> list[Path]:
    """Return the files of a school's folder that may be read: words for each language, the Word file, title blocks."""
    words = (f"{language}.md" for language in languages())
    patterns = (*words, "report.docx", "blocks", "blocks/*.yaml") if os.path.isdir(folder) else ()
    return [path for pattern in patterns for path in folder.glob(pattern)]


def school_files(folder: Path) -> list[Path]:
    """Return the files of a school's folder that are read: its words in each language, its title blocks and its
    Word file.
    """
    return sorted(path for path in _of_school(folder) if path.name != "blocks")


def school_strays(folder: Path, *within: Path) -> list[Path]:
    """Return the paths of a school's folder that lead out of it, or out of the folders `within`, by a link or `..`."""
    paths = [folder, *_of_school(folder)]
    return [path for path in paths if leads_out(path, folder) or (within and leads_out(path, *within))]


def is_school(folder: Path) -> bool:
    """Return True if a folder contains a school's own words or its Word file."""
    return any(path.suffix in (".md", ".docx") for path in school_files(folder))


def schools() -> list[str]:
    """List the template folders that belong to a school, such as `tnut`."""
    own = {*languages(), "frames"}
    return sorted(folder.name for folder in templates().iterdir() if folder.name not in own and is_school(folder))


def school_folder(school: Path | str) -> Path:
    """Return the folder of a school's own templates."""
    return templates() / school


def search_path(
    language: Language, kind: str = "", school: Path | str = "", root: Path | None = None
) -> tuple[Path, ...]:
    """Return the places in which sections and words are looked up; the first that has a name wins.

    The places are the file of a school (its folder, or its name among the templates), the file of the kind, and the
    folder of the language.
    """
    root = root or templates()
    return (
        *((root / school / f"{language}.md",) if school else ()),
        *((kind_file(language, kind, root),) if kind else ()),
        root / language,
    )


def kind_file(language: Language, kind: str, root: Path | None = None) -> Path:
    """Return the file with all words of one kind of machine."""
    return (root or templates()) / language / MACHINES / f"{kind}.md"


def topic_files(language: Path) -> list[Path]:
    """Return the files of the topics in the folder of a language, whether they exist or not."""
    return [language / topic_file(topic) for topic in topics()]


def topic_file(topic: str) -> str:
    """Return the path of the words of a topic in the folder of a language."""
    return f"{TOPICS}/{topic}.md"


def words_file(language: Language, name: str) -> Path:
    """Return a file of words of a language, also a kind's, `catalogue/cam.md`; that of the reference if it has none."""
    own = templates() / language / name
    return own if own.is_file() else templates() / REFERENCE / name
