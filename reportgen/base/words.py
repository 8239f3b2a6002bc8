"""Texts that are not in a template: texts of faults and of the command line, short words of the reports.

They are YAML in `templates/`: `<language>/messages.yaml` for the program's messages, `<language>/words.yaml` for
its documents. The sections `words` in the files of a school and of a kind of machine override the common ones. A
topic adds words in the sections `words` and `messages` of its file.
"""

from __future__ import annotations

import difflib
import locale
import os
import re
import unicodedata
from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import cache, lru_cache
from hashlib import sha256
from itertools import pairwise
from pathlib import Path
from typing import Any

from reportgen.base.atlas_words import machine_source, over_linkage
from reportgen.base.errors import AssignmentError, Fault, Level, Location, Problem, TemplateError, Where
from reportgen.base.placeholders import FILLS, filled, gaps, plain_gaps
from reportgen.base.records import Record, replace
from reportgen.base.template_folders import (
    DEFAULT_LANGUAGE,
    MACHINES,
    REFERENCE,
    atlas_files,
    is_own_machine,
    is_school,
    languages,
    school_files,
    school_strays,
    templates,
    topic_files,
)
from reportgen.base.units import Language
from reportgen.base.yaml_source import (
    STRANGE,
    MappingNode,
    Scalar,
    Source,
    in_a_line,
    plain,
    read_own,
    read_text,
    read_words,
    scalars,
    text_in,
)
from reportgen.base.yaml_values import at, path_text

LONGEST_SHOWN = 40
"""Largest number of characters of the file that a message repeats."""

FILE = "words.yaml"
SECTION = "words"
MESSAGES_FILE, MESSAGES_SECTION = "messages.yaml", "messages"
LONGEST = 2000
"""Largest number of characters of a school's phrase; the program's own have up to 340."""
FILES = 32
"""Largest number of cached tables of words."""


TEMPLATES = "REPORTGEN_TEMPLATES"
"""The variable of the environment that names a school's folder, for all files of a run."""


def templates_hash() -> str:
    """Return the SHA-256 of the names and contents of all templates, those of schools and own machines included."""
    root, own, digest = str(templates()), named_school(), sha256()
    paths = (os.path.join(folder, name) for folder, _, names in os.walk(root) for name in names)
    named = sorted((path.removeprefix(root).replace(os.sep, "/"), path) for path in paths if os.path.isfile(path))
    for name, path in (*named, *((path.name, str(path)) for path in (school_files(own) if own else ()))):
        with open(path, "rb") as file:
            _add(digest, name.encode(), file.read())
    for kind, machine in atlas_files().items():
        if is_own_machine(machine):
            _add(digest, kind.encode(), machine_source(machine).text.encode())
    return digest.hexdigest()


def _add(digest: Any, *parts: bytes) -> None:
    for part in parts:
        digest.update(len(part).to_bytes(8, "big") + part)


def named_school() -> Path | None:
    """Return the school's folder that was named for all files of a run.

    Raises `TemplateError` if there is no such folder, or if a link in it leads out.
    """
    if not (named := os.environ.get(TEMPLATES)):
        return None
    folder = Path(named).absolute()
    if strays := school_strays(folder):
        location = Location(str(strays[0]))
        raise TemplateError(str(as_problem(Fault("path-outside", location, {"text": strays[0].name}), None)))
    if not is_school(folder):
        raise TemplateError(word("no_templates", None, place=folder))
    return folder


def load_words(places: Sequence[Path]) -> Mapping[str, Any]:
    """Return all words found in `places` (see `search_path`): tables of tables, lists and words.

    A place nearer on the search path needs only the words that it changes. Raises `TemplateError` with file and
    line for a file that cannot be read or has another form than the words it changes, and if no place has any
    words.
    """
    merged: Mapping[str, Any] | None = None
    for place in reversed(places):
        if (table := _words_in(place, places[-1])) is not None:
            merged = table if merged is None else _over(merged, table, place)
    if merged is None:
        raise TemplateError(f"{places[-1]}: there are no words here")
    return merged


def _words_in(place: Path, last: Path) -> Mapping[str, Any] | None:
    """Return the words of a file of sections, of a machine of the atlas, or of a folder, with the `last` place."""
    if place.suffix == ".yaml":
        return over_linkage(place, of_file(last))
    if place.suffix == ".md":
        section = sections(place).get(SECTION)
        return None if section is None else _as_written(section, place, not place.is_relative_to(last))
    return _with_topics(place, FILE, SECTION) if (place / FILE).is_file() else None


def words_alone(language: Path) -> Mapping[str, Any]:
    """Return the words in the folder of a language, without those that topics add."""
    return _read(language / FILE)


def _with_topics(language: Path, name: str, section: str) -> Mapping[str, Any]:
    """Return a file of words of a language with the additions of topics in a section; words in the file take
    precedence.
    """
    further = of_topics(language, section)
    return _beneath(further, _read(language / name)) if further else _read(language / name)


def of_topics(language: Path, section: str = SECTION) -> Mapping[str, Any]:
    """Return the words that all topics have in a section of their files in the folder of a language."""
    table: Mapping[str, Any] = {}
    for file in topic_files(language):
        if (passage := sections(file).get(section)) is not None:
            table = _beneath(_as_written(passage, file, False), table)
    return table


def _read(path: Path) -> Mapping[str, Any]:
    about = path.stat()
    return _as_of(path, about.st_mtime_ns, about.st_size)


@lru_cache(maxsize=FILES)
def _as_of(path: Path, changed: int, size: int) -> Mapping[str, Any]:
    """Return a file's words, cached as long as the file is unchanged; callers must not change them."""
    return _table(read_words(path))


@lru_cache(maxsize=FILES)
def _as_written(section: Passage, place: Path, of_others: bool) -> Mapping[str, Any]:
    """Return the words of a section; text of others, such as schools, is parsed with the careful reader.

    Raises `TemplateError` for a placeholder with more than a plain value, for a text that is too long, and for a
    strange sign.
    """
    source = (read_text if of_others else read_own)(section.text, str(section.file))
    for scalar in scalars(source.top):
        for key, sound in (
            ("template_unsafe", plain_gaps(scalar.text)),
            ("template_word", len(scalar.text) <= LONGEST),
            ("template_character", not STRANGE.search(in_a_line(scalar.text))),
        ):
            if not sound:
                refusal = word(key, of_file(place), longest=LONGEST)
                raise TemplateError(f"{_below(scalar.location, section.line)}: {refusal}")
    return _table(source, section.line)


class _Word(str):
    """A text that knows its location, at which a placeholder that cannot be filled is reported."""

    mark = Location("")

    def format(self, *values: object, **named: object) -> str:
        """Fill the placeholders like `str.format`. Raises `TemplateError`."""
        try:
            return filled(self, values, named)
        except (AttributeError, LookupError, TypeError, ValueError) as error:
            raise TemplateError(f"{self.mark}: {unfilled(self, named, of_file(Path(self.mark.file)))}") from error

    def __str__(self) -> str:
        return self

    def __reduce__(self) -> tuple[type[str], tuple[str]]:
        return str, (self[:],)


def unfilled(text: str, known: Iterable[str], language: Language) -> str:
    """Return the message about a placeholder that cannot be filled."""
    return word("template_gap", language, text=_quotable(text), known=", ".join(known) or "–")


def of_file(file: Path) -> Language:
    """Return the language of a file of templates."""
    names = (file.stem, file.parent.name, file.parent.parent.name)
    return next((name for name in names if name in languages()), DEFAULT_LANGUAGE)


def _table(source: Source, above: int = 0) -> Mapping[str, Any]:
    """Return the table that a file is, or the part of one below its first lines."""
    if source.faults:
        raise TemplateError("\n".join(f"{_below(fault.location, above)}: {fault.wordless}" for fault in source.faults))
    if not isinstance(source.top, MappingNode):
        raise TemplateError(f"{_below(Location(source.file), above)}: a table of words is wanted here")

    def said(scalar: Scalar) -> str:
        text = _Word(in_a_line(scalar.text))
        text.mark = _below(scalar.location, above)
        return text

    content: Mapping[str, Any] = plain(source.top, said)
    return content


def _below(location: Location, above: int) -> Location:
    return replace(location, line=location.line + above) if above else location


def _over(below: Mapping[str, Any], above: Mapping[str, Any], place: Path, where: Where = ()) -> Mapping[str, Any]:
    """Merge both tables; words in `above` override those in `below` and come first.

    Raises `TemplateError` with a place in the file `above` where its words have another form.
    """
    result: dict[str, Any] = {}
    for key, value in above.items():
        here, common = (*where, key), below.get(key, value)
        if not _alike(value, common):
            section = sections(place)[SECTION]
            node = at(read_text(section.text).top, here)
            line = section.line + (node.location.line if node else 0)
            raise TemplateError(f"{place}:{line}: {word('template_form', of_file(place), text=path_text(here))}")
        result[key] = _over(common, value, place, here) if isinstance(value, Mapping) else value
    return result | {key: value for key, value in below.items() if key not in result}


def _alike(present: Any, standing_in: Any) -> bool:
    """Return True if a word can replace another: both are tables, or texts, or lists of equal length whose
    items can.
    """
    if isinstance(present, list) and isinstance(standing_in, list):
        return len(present) == len(standing_in) and all(map(_alike, present, standing_in))
    return all(isinstance(present, kind) == isinstance(standing_in, kind) for kind in (Mapping, str))


def language_of(source: Source) -> Language:
    """Return the language that a file requests, found by its line so that faulty syntax does not matter.

    A file that requests none is reported in the default language; one that cannot be read gives no language.
    """
    known = "|".join(languages())
    asked = re.search(rf"^[^#\n]*[\s{{]language:\s*['\"]?({known})\b", source.text, re.MULTILINE)
    if asked:
        return asked[1]
    return DEFAULT_LANGUAGE if source.text else spoken()


SPOKEN = "REPORTGEN_LANG"
"""Environment variable with the language of messages, also for processes that are started."""


def speak(language: Language) -> None:
    """Set the language for cases in which no file and no option gives one."""
    os.environ[SPOKEN] = language


def spoken() -> Language:
    """Return the language for cases without a file or an option: the one that was set, else that of the locale.

    The locale C gives the default language; a locale in an unknown language gives the reference language.
    """
    named = next(filter(None, map(os.environ.get, (SPOKEN, "LC_ALL", "LC_MESSAGES", "LANG"))), None)
    named = named or (os.name == "nt" and locale.getlocale()[0]) or "C"
    tongue = re.split(r"[_.@-]", named)[0].casefold()
    if tongue in {"c", "posix"}:
        return DEFAULT_LANGUAGE
    # Some systems call a language by its name: Vietnamese_Vietnam.
    return tongue if tongue in languages() else DEFAULT_LANGUAGE if tongue.startswith(DEFAULT_LANGUAGE) else REFERENCE


@cache
def messages(language: Language) -> Mapping[str, Any]:
    """Return the message table: `faults`, `hints`, `words` (kinds of value, reasons), `columns` and `cli`."""
    return _with_reference(language, MESSAGES_FILE, MESSAGES_SECTION)


@cache
def helps(language: Language) -> Mapping[str, Any]:
    """Return the help of the command line: its `frame`, the short `start`, and `texts` by their English ones."""
    return _with_reference(language, "help.yaml")


@cache
def common_words(language: Language) -> Mapping[str, Any]:
    """Return the short words of a language that no kind and no school changes."""
    return _with_reference(language, FILE, SECTION)


def _with_reference(language: Language, name: str, section: str = "") -> Mapping[str, Any]:
    """Return a file of words with the sections of topics; words missing in a language are those of the reference."""
    folder, reference = (templates() / one for one in (language, REFERENCE))
    if language == REFERENCE or not (folder / name).is_file():
        return _with_topics(reference, name, section)
    return _beneath(_with_topics(reference, name, section), _with_topics(folder, name, section))


def _beneath(below: Mapping[str, Any], above: Mapping[str, Any]) -> Mapping[str, Any]:
    """Return the words `above`, and those of `below` under keys that are not there."""
    both = {
        key: _beneath(below[key], value)
        if isinstance(value, Mapping) and isinstance(below.get(key), Mapping)
        else value
        for key, value in above.items()
    }
    return both | {key: value for key, value in below.items() if key not in both}


def word(key: str, language: Language | None, /, **arguments: object) -> str:
    """Return a text of the command line with its arguments filled in."""
    said = {name: one if isinstance(one, FILLS) else str(one) for name, one in arguments.items()}
    return str(messages(language or spoken())["cli"][key]).format(**said)


def counted(key: str, language: Language | None, count: int, /, **arguments: object) -> str:
    """Return a text of the command line with a count; a count of one has its text under `key`_one."""
    return word(f"{key}_one" if count == 1 else key, language, count=count, **arguments)


def unexpected(error: BaseException, language: Language | None) -> str:
    """Return a fault of the program itself, in one line."""
    return word("unexpected", language, name=type(error).__name__, text=" ".join(str(error).split()))


def as_problem(fault: Fault, language: Language | None, level: Level = "error") -> Problem:
    """Return the fault with its message; it has a hint if the arguments of the hint are known."""
    table = messages(language or spoken())
    # The list of known names comes from the program, so it is shown in full.
    arguments = {
        name: text if name in {"known", "place"} else _quotable(text) for name, text in fault.arguments.items()
    }
    for name in arguments.keys() & {"expected", "reason", "range"}:
        words = [table["words"].get(one) for one in fault.arguments[name].split("+")]
        if None not in words:
            arguments[name] = "".join(map(str, words)).format_map(arguments)
    message = str(table["faults"][fault.code]).format_map(arguments)
    # The requested hint comes first, then the hint of the code and its second form.
    keys = (fault.arguments.get("hint"), fault.code, f"{fault.code}-otherwise")
    hints = (str(table["hints"][key]) for key in keys if table["hints"].get(key))
    hint = next((hint for hint in hints if gaps(hint) <= arguments.keys()), None)
    advice = hint.format_map(arguments) if hint else None
    called = str(table["words"]["hint"])
    problem = Problem(fault.code, message, fault.location, advice, level, called)
    return replace(problem, where=fault.where, remedies=fault.remedies, missing=fault.missing)


def as_error(faults: Iterable[Fault], language: Language | None) -> AssignmentError:
    """Return the error with the messages of these faults, each once."""
    return AssignmentError(list(dict.fromkeys(as_problem(fault, language) for fault in faults)))


def close_or_known(key: str, known: Sequence[str]) -> dict[str, str]:
    """Return arguments for a message about an unknown key: the known key that was probably meant, or all known keys."""
    # A name that differs in case alone is closer than any other.
    same = [name for name in known if name.casefold() == key.casefold()]
    close = same or difflib.get_close_matches(key, known, n=1, cutoff=0.6)
    return {"close": close[0]} if close else {"known": ", ".join(known)}


def unknown(key: str, text: str, known: Sequence[str], language: Language | None) -> str:
    """Return a message about an unknown name, with the known name that was probably meant, or all known names."""
    near = close_or_known(text, known)
    hint = messages(language or spoken())["hints"]["unknown-key" if "close" in near else "unknown-key-otherwise"]
    return f"{word(key, language, text=_quotable(text))}: {hint.format(**near)}"


def _quotable(text: str) -> str:
    """Return a piece of the file for a message: one line, no control characters, limited length."""
    clean = "".join("\N{REPLACEMENT CHARACTER}" if unicodedata.category(c) in {"Cc", "Cs"} else c for c in text)
    return clean if len(clean) <= LONGEST_SHOWN else f"{clean[:LONGEST_SHOWN]}…"


# --- words by sections ----------------------------------------------------------------------------
# Each follows a line `%% name`, in reading order.  The words of a machine or of a school are one file per language,
# those of all machines a folder: `report.md` has `foreword`, `dyads.md` the section `RRR-forces` of `dyads/RRR-forces`.

HEADING = "%%"
KEPT_FILES = 128
"""Largest number of cached files."""


class Passage(Record):
    """The template text of a section, which begins below its heading in line `line` of the file."""

    file: Path
    line: int
    text: str


def sections(file: Path) -> Mapping[str, Passage]:
    """Return the sections of a file by their names, in its order; an empty mapping if there is no such file.

    Text before the first section is a note about the file, and blank lines between two sections belong to neither.
    Raises `TemplateError` with file and line for an empty or repeated name and for a file that cannot be read.
    """
    try:
        about = file.stat()
    except (FileNotFoundError, NotADirectoryError):
        return {}
    return _sections_of(file, about.st_mtime_ns, about.st_size)


_NAME = re.compile(r"[\w-]+(/[\w-]+)?")
"""A section's name, perhaps with that of its file before it; no other path matches."""


def find(name: str, places: Sequence[Path]) -> Passage | None:
    """Return the section of this name in the first of some places (files, folders) that has it."""
    if not _NAME.fullmatch(name):
        return None
    passages = (sections(file).get(section) for place in places for file, section in homes(name, place))
    return next(filter(None, passages), None)


def homes(name: str, place: Path) -> Iterator[tuple[Path, str]]:
    """Yield the files in which a section may be in a place, each with the name of the section there.

    In a folder the name says which file it is; the files of topics have the whole names of their sections.
    """
    if place.suffix == ".md":
        yield place, name
    if place.suffix:
        # The text of a machine of the atlas, in YAML, is not divided into sections.
        return
    file, _, section = name.rpartition("/")
    yield place / f"{file or 'report'}.md", section
    yield from ((topic, name) for topic in topic_files(place))


def of_school(places: Sequence[Path]) -> list[Path]:
    """Return the places that a school wrote; the others are in the folder of the language, the last one."""
    return [place for place in places if place.suffix == ".md" and not place.is_relative_to(places[-1])]


def refuse_strangers(places: Sequence[Path]) -> None:
    """Raise `TemplateError` for a section of a school that no report in the language (the last place) has.

    Such a section would never be used: its name is misspelt, or from an older version.
    """
    language = places[-1]
    for file in of_school(places):
        known = set(_names(language))
        for name, section in sections(file).items():
            if name not in known:
                raise TemplateError(f"{file}:{section.line}: no report has a section {name}")


def _names(language: Path) -> Iterator[str]:
    """Yield the names of all sections of a language, those of the machines included."""
    for file in language.glob("*.md"):
        yield from (name if file.stem == "report" else f"{file.stem}/{name}" for name in sections(file))
    for file in (*topic_files(language), *(language / MACHINES).glob("*.md")):
        yield from sections(file)


@lru_cache(maxsize=KEPT_FILES)
def _sections_of(file: Path, changed: int, size: int) -> Mapping[str, Passage]:
    """Return the sections of a file, read once for as long as it stays the same."""
    text = text_in(file)
    if isinstance(text, Fault):
        raise TemplateError(str(as_problem(text, of_file(file))))
    lines = re.split(r"\r\n?|\n", text)
    headings = [number for number, line in enumerate(lines, start=1) if line.startswith(HEADING)]
    passages: dict[str, Passage] = {}
    for number, end in pairwise([*headings, len(lines) + 1]):
        name = lines[number - 1].removeprefix(HEADING).strip()
        if not name:
            raise TemplateError(f"{file}:{number}: a section has a name, as in {HEADING} given")
        if name in passages:
            raise TemplateError(f"{file}:{number}: the section {name} is there already, in line {passages[name].line}")
        passages[name] = Passage(file, number, "\n".join(lines[number : end - 1]).rstrip("\n") + "\n")
    return passages
