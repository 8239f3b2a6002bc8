"""Read the files of the atlas: their nodes, and the words of a machine that replace those of a linkage.

A machine's file has words in some languages: its title, its uses, a description, names of its parameters and links.
They are plain text everywhere. What else a file contains is read in `reportgen.catalogue.atlas_file`.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path
from typing import Any

from reportgen.base.records import Record
from reportgen.base.template_folders import DEFAULT_LANGUAGE, REFERENCE, atlas_files, is_own_machine
from reportgen.base.units import Language
from reportgen.base.yaml_source import STRANGE, MappingNode, Source, in_a_line, plain, read_source, read_words

GROUP = "atlas"
"""The group of the machines of the atlas in the form's first view."""
LONGEST_WORDS = 2000
"""Largest number of characters of a text of a machine."""
KEPT_MACHINES = 256
TABLES = frozenset({"parameters", "links"})
"""Words of a machine that are tables; all others are texts."""


def is_machine_file(source: Source) -> bool:
    """Return True for the nodes of a machine's file, which has words or a linkage, and no kind."""
    top = source.top
    if not isinstance(top, MappingNode) or top.find("kind") is not None:
        return False
    return top.find("linkage") is not None or top.find("words") is not None


def machine_source(file: Path) -> Source:
    """Return the nodes of a machine's file, cached while the file is unchanged; one of a user is read with care."""
    try:
        about = file.stat()
    except OSError:
        return read_source(file)
    return _read(file, about.st_mtime_ns, about.st_size)


@lru_cache(maxsize=KEPT_MACHINES)
def _read(file: Path, _changed: int, _size: int) -> Source:
    return (read_source if is_own_machine(file) else read_words)(file)


def machine_words(file: Path, language: Language) -> Mapping[str, Any]:
    """Return the words of a machine in a language, else in the reference language, else in any that it has.

    Texts that are not in order are left out; a machine without a title has its name.
    """
    source = machine_source(file)
    table = plain(source.top) if source.top is not None else None
    languages = table.get("words") if isinstance(table, dict) else None
    known = languages if isinstance(languages, dict) else {}
    order = (language, REFERENCE, DEFAULT_LANGUAGE, *known)
    words: dict[str, Any] = next((known[name] for name in order if isinstance(known.get(name), dict)), {})
    sound = ((key, _sound(value)) for key, value in words.items())
    fitting = {key: value for key, value in sound if value and isinstance(value, dict) == (key in TABLES)}
    return {"title": file.stem, **fitting}


def _sound(value: Any) -> Any:
    """Return a text in one line, or a table of such texts; None for anything else."""
    if isinstance(value, dict):
        return {key: text for key, text in value.items() if isinstance(text, str) and _sound(text)}
    text = in_a_line(value) if isinstance(value, str) else ""
    return text if text and len(text) <= LONGEST_WORDS and not STRANGE.search(text) else None


class ParameterWords(Record):
    """What the form says of a parameter besides its name: its bounds as typed, and the key of its group."""

    range: str
    group: str


def machine_parameters(file: Path) -> Mapping[str, ParameterWords]:
    """Return the parameters of a machine in the order of its file."""
    source = machine_source(file)
    table = plain(source.top) if source.top is not None else None
    given = table.get("parameters") if isinstance(table, dict) else None
    return {
        key: ParameterWords(_range(about), _group(key, str(about.get("default", ""))))
        for key, about in (given if isinstance(given, dict) else {}).items()
        if isinstance(about, dict)
    }


def _range(about: Mapping[str, Any]) -> str:
    least, most = about.get("least"), about.get("most")
    return f"{least} … {most}" if least and most else f"≥ {least}" if least else f"≤ {most}" if most else ""


def _group(key: str, default: str) -> str:
    """Return the group of a parameter by the unit of its default; weights and forces differ by their letters."""
    unit = re.sub(r"^[-+\d./eE ]*", "", default).replace("·", " ")
    if re.match(r"(kg|g)\b|t$", unit) or (key[:1] == "G" and re.match(r"[kM]?N$", unit)):
        return "masses"
    if re.match(r"rpm|rad/s|rps|[a-z]*m/s|vòng|об", unit):
        return "motion"
    return "loads" if re.match(r"[kM]?(N|Pa)|bar", unit) else "dimensions"


def of_kind(kind: str, language: Language) -> Mapping[str, Any]:
    """Return the words of a machine of the atlas by its kind; {} for any other kind."""
    file = atlas_files().get(kind)
    return {} if file is None else machine_words(file, language)


def over_linkage(file: Path, language: Language) -> Mapping[str, Any]:
    """Return the words of a machine that replace those of a linkage: its title, its uses, its group."""
    words = machine_words(file, language)
    return {"title": words["title"], "uses": words.get("uses", ""), "group": GROUP}
