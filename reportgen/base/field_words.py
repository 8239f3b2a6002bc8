"""Labels of the keys of assignment files: name, remark and group of each, in every language.

The labels of a kind's own parameters are with its words, in the section `fields`. Those of all kinds, and the words
of choices and groups, are in `fields.yaml` of the language. A topic labels the keys of its section and their
choices in the sections `fields` and `choices` of its words. Keys are identified by their paths without list indices
and without names chosen by the user: `groups.guide.at`.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from functools import lru_cache
from pathlib import Path
from typing import Any

from reportgen.base.atlas_words import machine_parameters, machine_words
from reportgen.base.errors import TemplateError
from reportgen.base.languages import setting_of
from reportgen.base.records import Record
from reportgen.base.template_folders import kind_words, languages, machine_files, topic_file, words_file
from reportgen.base.topics import topics
from reportgen.base.units import Language
from reportgen.base.words import sections
from reportgen.base.yaml_source import MappingNode, plain, read_own, read_words

SECTION, FILE = "fields", "fields.yaml"
CHOICES = "choices"
PARAMETERS = "parameters"


class FieldWords(Record):
    """Labels of a key: its name, a remark about its use, and the title of its group."""

    name: str
    remark: str = ""
    group: str = ""

    @property
    def label(self) -> str:
        """The name with a capital letter, unless it begins with a symbol."""
        first, rest = self.name[:1], self.name[1:]
        return first.upper() + rest if rest[:1].islower() or rest[:1] == " " else self.name

    @property
    def whole(self) -> str:
        """Name and remark."""
        return f"{self.name}, {self.remark}" if self.remark else self.name


def field_words(kind: str, language: Language) -> Mapping[str, FieldWords]:
    """Return the labels of all keys of a kind's file, by their paths, in the order of a form.

    A kind without the section has only the common ones.  Raises `TemplateError` for a section that is not a table.
    """
    own, common = kind_words(language, kind), words_file(language, FILE)
    of_topics = _of_topics(language)
    times = [file.stat().st_mtime_ns for file in (own, common, *of_topics)]
    if (machine := next(iter(machine_files(kind)), None)) is None:
        return _words_by_path(own, common, of_topics, *times)
    shared = _words_by_path(None, common, of_topics, *times)
    groups: Mapping[str, str] = _common(common, common.stat().st_mtime_ns)["groups"]
    own_words = _of_machine(machine, language, groups, shared)
    return own_words | {path: said for path, said in shared.items() if path not in own_words}


def _of_machine(
    file: Path, language: Language, groups: Mapping[str, str], shared: Mapping[str, FieldWords]
) -> dict[str, FieldWords]:
    """Return the labels of the parameters of a machine of the atlas, with their bounds, by their paths.

    A parameter that the machine does not name has the label that it has in other kinds, else its key.
    """
    names, labels = machine_words(file, language).get(PARAMETERS, {}), dict[str, FieldWords]()
    for key, about in machine_parameters(file).items():
        path = f"{PARAMETERS}.{key}"
        usual = shared[path].name if path in shared else key
        labels[path] = FieldWords(str(names.get(key, usual)), about.range, groups[about.group])
    return labels


def shared_keys(language: Language) -> frozenset[str]:
    """Return the parameters that have the same label in every kind that has them."""
    common = words_file(language, FILE)
    tables = [_common(common, common.stat().st_mtime_ns)[PARAMETERS], *map(_own, _of_topics(language))]
    return frozenset(key for groups in tables for keys in groups.values() for key in keys)


def choice_words(language: Language) -> Mapping[str, str]:
    """Return the labels of the values that a key may choose among."""
    common = words_file(language, FILE)
    table: Mapping[str, str] = _common(common, common.stat().st_mtime_ns)["choices"]
    of_topics = {key: said for file in _of_topics(language) for key, said in _own(file, CHOICES).items()}
    # Each language by its own name, unless this one has another for it.
    return {**{name: setting_of(name).name for name in languages()}, **of_topics, **table}


def group_titles(language: Language) -> list[str]:
    """Return the titles of groups in the order of a form."""
    common = words_file(language, FILE)
    return list(_common(common, common.stat().st_mtime_ns)["groups"].values())


def also(language: Language) -> str:
    """Return the word between two ways to give the same value (“or”)."""
    common = words_file(language, FILE)
    return str(_common(common, common.stat().st_mtime_ns)["or"])


def _of_topics(language: Language) -> tuple[Path, ...]:
    """Return the template files of all topics; those of the reference language where the language has none."""
    files = (words_file(language, topic_file(topic)) for topic in topics())
    return tuple(file for file in files if file.is_file())


@lru_cache(maxsize=64)
def _words_by_path(own: Path | None, common: Path, of_topics: tuple[Path, ...], *_: int) -> Mapping[str, FieldWords]:
    shared = _common(common, common.stat().st_mtime_ns)
    groups: Mapping[str, str] = shared["groups"]
    words = {path: _words(said) for path, said in shared["file"].items()}
    tables = (*([] if own is None else [_own(own)]), shared[PARAMETERS], *map(_own, of_topics))
    parameters = [entry for table in tables for entry in _grouped(table, groups)]
    # The kind's own words for a key take precedence over the common ones.
    return words | {f"{PARAMETERS}.{path}": said for path, said in reversed(dict(reversed(parameters)).items())}


def _own(file: Path, name: str = SECTION) -> Mapping[str, Any]:
    """Return a section of the words of a kind or a topic: the table of its keys by groups."""
    section = sections(file).get(name)
    if section is None:
        return {}
    top = read_own(section.text, str(file)).top
    if not isinstance(top, MappingNode):
        raise TemplateError(f"{file}:{section.line}: a table of words is wanted here")
    table: Mapping[str, Any] = plain(top)
    return table


def _grouped(table: Mapping[str, Any], groups: Mapping[str, str]) -> Iterator[tuple[str, FieldWords]]:
    for group, keys in table.items():
        for path, said in keys.items():
            yield path, _words(said, groups[group])


def _words(said: Any, group: str = "") -> FieldWords:
    name, remark = said if isinstance(said, list) else (said, "")
    return FieldWords(name, remark, group)


@lru_cache(maxsize=8)
def _common(path: Path, _: int) -> Mapping[str, Any]:
    source = read_words(path)
    if source.top is None or source.faults:
        raise TemplateError(f"{path}:1: a table of words is wanted here")
    table: Mapping[str, Any] = plain(source.top)
    return table


# --- starter files ----------------------------------------------------------------------------------

COLUMN = 32
"""Column at which remarks begin, if there is room."""
_ENTRY = re.compile(r"(?P<indent> *)(?:# )?(?P<key>[^\W\d][\w-]*):(?P<value>.*)")


def remarked(text: str, words: Mapping[str, FieldWords], more: Callable[[str, str], str]) -> str:
    """Return a starter file with a remark on each key; `more` returns further text for a key's path and value.

    A key that contains other keys, or that already has a remark, is left unchanged.
    """
    lines = text.splitlines()
    entries = [_ENTRY.fullmatch(line) for line in lines]
    above: list[tuple[int, str]] = []
    done: list[str] = []
    for line, entry, following in zip(lines, entries, [*entries[1:], None], strict=True):
        done.append(line)
        if entry is None:
            continue
        depth = len(entry["indent"])
        above = [*((column, key) for column, key in above if column < depth), (depth, entry["key"])]
        heads = not entry["value"].strip() and following is not None and len(following["indent"]) > depth
        path = ".".join(key for _, key in above)
        if path in words and not heads and " #" not in entry["value"]:
            remark = f"{words[path].whole}{more(path, entry['value'].strip())}"
            done[-1] = f"{line.rstrip():{COLUMN - 1}} # {remark}"
    return "\n".join(done) + "\n"
