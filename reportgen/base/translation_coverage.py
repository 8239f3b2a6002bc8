"""Check which assignment kinds and topics a language translates completely; a document is never partly translated.

Words are complete if they have every section and every key of the reference language; `reportgen words` reports
other differences.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cache
from pathlib import Path
from typing import Any

from reportgen.base.kinds import kinds
from reportgen.base.template_folders import DEFAULT_LANGUAGE, REFERENCE, kind_file, templates, topic_file
from reportgen.base.units import Language
from reportgen.base.words import FILE, SECTION, load_words, sections, words_alone

UNTOLD = frozenset({"units", "symbols", "months"})
"""Words that a language may do without."""


@cache
def is_whole(language: Language, kind: str) -> bool:
    """Return True if the language has all words of reports of this kind, apart from the words of topics."""
    return _has_all(language) and not any(_missing(kind_file(language, kind), kind_file(REFERENCE, kind)))


@cache
def is_topic_whole(language: Language, topic: str) -> bool:
    """Return True if a language has all words of a topic."""
    own, reference = (templates() / one / topic_file(topic) for one in (language, REFERENCE))
    return not any(_missing(own, reference))


def offered(language: Language) -> list[str]:
    """Return the kinds whose words are whole in a language."""
    return [kind for kind in kinds() if is_whole(language, kind)]


@cache
def _has_all(language: Language) -> bool:
    """Return True if a language has all words that reports of any kind use, apart from the words of topics."""
    if language in (DEFAULT_LANGUAGE, REFERENCE):
        # The program's tests check these, and skipping them makes checking a file faster.
        return True
    own, reference = templates() / language, templates() / REFERENCE
    if not (own / FILE).is_file() or any(_absent(words_alone(own), words_alone(reference))):
        return False
    return not any(name for file in reference.glob("*.md") for name in _missing(own / file.name, file))


def _missing(own: Path, reference: Path) -> Iterator[str]:
    """Yield the sections and the words that a file lacks; all of them if there is no such file."""
    here, there = sections(own), sections(reference)
    yield from there.keys() - here.keys()
    if SECTION in here and SECTION in there:
        yield from _absent(load_words((own,)), load_words((reference,)))


def _absent(own: Mapping[str, Any], reference: Mapping[str, Any]) -> Iterator[str]:
    """Yield the keys of a table, and of the tables in it, that another one lacks."""
    for key in reference.keys() - UNTOLD:
        if key not in own:
            yield key
        elif isinstance(reference[key], Mapping) and isinstance(own[key], Mapping):
            yield from _absent(own[key], reference[key])
