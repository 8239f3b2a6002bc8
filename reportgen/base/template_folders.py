"""Folders of words, frames and examples: the program's, those of schools, and the order in which they are read."""

from __future__ import annotations

import os
import re
from collections.abc import Mapping
from functools import cache, lru_cache
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
ATLAS = "atlas"
"""The folder beside the languages with a file for each machine of the atlas; its kind is `atlas/NAME`."""
ATLAS_BASE = "linkage"
"""The kind whose reports, words and checks the machines of the atlas have."""
ATLAS_VARIABLE = "REPORTGEN_ATLAS"
"""The variable of the environment that names a further folder of machines, for all files of a run."""
MOST_MACHINES = 200
"""Largest number of machines that are read from a folder."""
_MACHINE_NAME = re.compile(r"[a-z0-9][a-z0-9-]{0,60}")


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


@cache
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

    The places are the file of a school (its folder, or its name among the templates), the file of a machine of the
    atlas, the file of the kind, and the folder of the language.
    """
    root = root or templates()
    return (
        *((root / school / f"{language}.md",) if school else ()),
        *machine_files(kind),
        *((kind_file(language, kind, root),) if kind else ()),
        root / language,
    )


def kind_file(language: Language, kind: str, root: Path | None = None) -> Path:
    """Return the file with all words of a kind of machine; all machines of the atlas share one."""
    return (root or templates()) / language / MACHINES / f"{_words_of(kind)}.md"


def _words_of(kind: str) -> str:
    return ATLAS_BASE if is_of_atlas(kind) else kind


def kind_places(language: Language, kind: str) -> tuple[Path, ...]:
    """Return the places of the words of a kind alone, in a language or in the reference language."""
    return *machine_files(kind), kind_words(language, kind)


def kind_words(language: Language, kind: str) -> Path:
    """Return the file of `kind_file`; that of the reference language if the language has none."""
    return words_file(language, f"{MACHINES}/{_words_of(kind)}.md")


# --- the atlas ------------------------------------------------------------------------------------


def is_of_atlas(kind: str) -> bool:
    """Return True for a kind that is a machine of the atlas, whether its file exists or not."""
    return kind.startswith(f"{ATLAS}/")


def atlas_files() -> Mapping[str, Path]:
    """Return the files of the machines of the atlas, by kind: the program's, then those of the user's folder.

    A machine of the user's folder replaces one of the same name.
    """
    own = os.environ.get(ATLAS_VARIABLE, "")
    folders = (templates() / ATLAS, *((Path(own).absolute(),) if own else ()))
    return {kind: file for folder in folders for kind, file in _machines_in(folder, _changed(folder)).items()}


def machine_files(kind: str) -> tuple[Path, ...]:
    """Return the file of a machine of the atlas; () for any other kind."""
    file = atlas_files().get(kind) if is_of_atlas(kind) else None
    return () if file is None else (file,)


def is_own_machine(file: Path) -> bool:
    """Return True if a machine's file is not the program's, so that it is read with care."""
    return not file.is_relative_to(templates())


def is_users_machine(kind: str) -> bool:
    """Return True for a machine of the user's folder, also if it replaces one of the program."""
    return any(map(is_own_machine, machine_files(kind)))


def is_machine_name(name: str) -> bool:
    """Return True for a name that a file of the atlas can have, without its ending."""
    return _MACHINE_NAME.fullmatch(name) is not None


def _changed(folder: Path) -> int:
    try:
        return folder.stat().st_mtime_ns
    except (OSError, ValueError):
        return 0


@lru_cache(maxsize=8)
def _machines_in(folder: Path, _changed: int) -> Mapping[str, Path]:
    """Return the first machines of a folder by kind, cached while its list of files is unchanged.

    Files with other names, and links that lead out of the folder, are left out.
    """
    try:
        files = sorted(folder.glob("*.yaml"))
    except (OSError, ValueError):
        return {}
    named = [file for file in files if is_machine_name(file.stem) and not leads_out(file, folder)]
    return {f"{ATLAS}/{file.stem}": file for file in named[:MOST_MACHINES]}


def ignored_machine_files() -> tuple[list[Path], list[Path]]:
    """Return the files of the user's folder that are no machine: those with a wrong name, and those past the limit.

    Links that lead out of the folder are in neither list.
    """
    own = os.environ.get(ATLAS_VARIABLE, "")
    if not own:
        return [], []
    folder = Path(own).absolute()
    files = [file for file in sorted(folder.glob("[!.]*.y*ml")) if not leads_out(file, folder)]
    right = [file for file in files if file.suffix == ".yaml" and is_machine_name(file.stem)]
    return [file for file in files if file not in right], right[MOST_MACHINES:]


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
