"""Where templates and words are looked for, and the short words of `words.yaml` as nested tables."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import lru_cache
from pathlib import Path
from typing import Any

from reportgen import installation
from reportgen.errors import Mark, TemplateError
from reportgen.notation.numbers import Language

FILE = "words.yaml"
FILES = 32
"""How many files of words are kept."""


def search_path(
    language: Language, kind: str = "", school: str = "", root: Path | None = None
) -> tuple[Path, ...]:
    """The folders in which templates and words are looked for; the first that has a name wins.

    A school's own words, then those of one kind of machine, then those common to all.
    """
    root = root or installation.templates()
    return (
        *((root / school / language,) if school else ()),
        *((root / language / kind,) if kind else ()),
        root / language,
    )


def load_words(directories: Sequence[Path]) -> Mapping[str, Any]:
    """All words found in `directories` (see `search_path`): tables of tables, lists and words.

    A file nearer on the search path need only hold the words it changes.  Raises `TemplateError` with
    file and line for what cannot be read, and where no directory has the file.
    """
    files = [path for directory in directories if (path := directory / FILE).is_file()]
    if not files:
        raise TemplateError(f"{directories[-1] / FILE}: the file is missing")
    words: Mapping[str, Any] = {}
    for path in reversed(files):
        words = _over(words, _read(path))
    return words


def _read(path: Path) -> Mapping[str, Any]:
    about = path.stat()
    return _as_of(path, about.st_mtime_ns, about.st_size)


@lru_cache(maxsize=FILES)
def _as_of(path: Path, changed: int, size: int) -> Mapping[str, Any]:
    """A file's words, read once for as long as it stays the same; nobody changes them."""
    from reportgen.assignment.source import Table, plain, read_source

    source = read_source(path)
    if source.faults:
        raise TemplateError("\n".join(f"{fault.mark}: {fault.code}" for fault in source.faults))
    if not isinstance(source.top, Table):
        raise TemplateError(f"{Mark(str(path))}: a table of words is wanted here")
    content: Mapping[str, Any] = plain(source.top)
    return content


def _over(below: Mapping[str, Any], above: Mapping[str, Any]) -> Mapping[str, Any]:
    """Both tables in one; where both have a word, the one `above`, whose words also come first."""
    result: dict[str, Any] = {}
    for key, value in above.items():
        both_tables = isinstance(value, Mapping) and isinstance(below.get(key), Mapping)
        result[key] = _over(below[key], value) if both_tables else value
    return result | {key: value for key, value in below.items() if key not in result}
