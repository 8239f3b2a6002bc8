"""The cards on which a user chooses a kind: name, uses, scheme, samples, and the words by which it is found.

The scheme of a kind is a file of the templates, `frames/schemes/KIND.svg`, which `docs/schemes.py` draws. A machine of
the user's folder has none; the page asks for its drawing when it shows the card.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from functools import cache, lru_cache
from pathlib import Path
from typing import Any

from reportgen import catalogue
from reportgen.base.atlas_words import machine_source
from reportgen.base.records import Record
from reportgen.base.template_folders import (
    DEFAULT_LANGUAGE,
    REFERENCE,
    atlas_files,
    is_own_machine,
    is_users_machine,
    kind_places,
    templates,
)
from reportgen.base.units import Language
from reportgen.base.words import load_words

REST = "others"
"""Group of the kinds whose words name no group."""
_SCHEME = re.compile(r'<svg [^>]*viewBox="([^"]*)">\s*<style>(.*?)</style>\s*(.*?)\s*</svg>', re.DOTALL)
_REMARK = re.compile(r"# (.*(?:\n# .*)*)")
_SENTENCE = re.compile(r".*?(?=[;.](?:\s|$)|$)")
_NEEDS_FILES = re.compile(r"(?m)^\s*-?\s*file: ")


class CardDrawing(Record):
    """The drawing of a kind: its box, the style sheet's rules of its pens, its elements."""

    box: str
    rules: str
    elements: str


class Sample(Record):
    """An example of a kind with the first sentence of its remark, which is in English."""

    name: str
    remark: str


class Card(Record):
    """A kind as the page offers it; `terms` are the words by which the kind is found."""

    kind: str
    title: str
    uses: str
    scheme: CardDrawing | None
    samples: tuple[Sample, ...]
    terms: str


def scheme_file(kind: str) -> Path:
    """Return the file with the scheme of a kind, whether it exists or not."""
    return templates() / "frames" / "schemes" / f"{kind}.svg"


def scheme(kind: str) -> CardDrawing | None:
    """Return the scheme of a kind; None for a machine of the user's folder, also if one of the program has its name."""
    file = scheme_file(kind)
    parts = _SCHEME.match(file.read_text(encoding="utf-8")) if file.is_file() and not is_users_machine(kind) else None
    return CardDrawing(*parts.groups()) if parts else None


@cache
def samples_of() -> Mapping[str, tuple[Sample, ...]]:
    """Return the samples of each kind that need no other file, in the order of their names."""
    return {
        kind: tuple(
            Sample(name, _first_sentence(text))
            for name, path in examples.items()
            if not _NEEDS_FILES.search(text := path.read_text(encoding="utf-8"))
        )
        for kind, examples in catalogue.all_examples().items()
    }


def _first_sentence(text: str) -> str:
    """Return the first sentence of the remark at the top of a file; empty if there is none."""
    remark = _REMARK.match(text)
    sentence = _SENTENCE.match(remark[1].replace("\n# ", " ")) if remark else None
    return sentence[0] if sentence else ""


def cards(language: Language) -> Mapping[str, tuple[Card, ...]]:
    """Return the cards of all kinds by the keys of their groups, in a language."""
    files = [(kind, file) for kind, file in atlas_files().items() if is_own_machine(file)]
    return _cards(language, tuple((kind, machine_source(file).text) for kind, file in files))


@lru_cache(maxsize=8)
def _cards(language: Language, _machines: tuple[tuple[str, str], ...]) -> Mapping[str, tuple[Card, ...]]:
    """Return the cards, cached while the files of the user's folder have the same texts."""
    grouped: dict[str, list[Card]] = {}
    for kind in catalogue.sound_kinds():
        words = _words(kind, language)
        # A machine of the user's folder need not have the parameters of a sample of its name.
        samples = () if is_users_machine(kind) else samples_of().get(kind, ())
        card = Card(kind, words["title"], words.get("uses", ""), scheme(kind), samples, _terms(kind))
        grouped.setdefault(words.get("group", REST), []).append(card)
    return {group: tuple(members) for group, members in grouped.items()}


def _words(kind: str, language: Language) -> Mapping[str, Any]:
    return load_words(kind_places(language, kind))


def _terms(kind: str) -> str:
    """Return the name and the uses of a kind in Vietnamese and in English."""
    spoken = (_words(kind, language) for language in (DEFAULT_LANGUAGE, REFERENCE))
    return " ".join(f"{words['title']} {words.get('uses', '')}" for words in spoken)
