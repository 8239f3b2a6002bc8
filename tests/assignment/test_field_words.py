"""Every key of every kind has its words in every language; schema and samples say them, with units and bounds."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any

import pytest

from reportgen import catalogue
from reportgen.assignment.schema import Schema, alternatives, choices_of, file_schema
from reportgen.base.field_words import choice_words, field_words
from reportgen.base.kinds import kinds
from reportgen.base.template_folders import languages
from reportgen.base.units import Language
from tests.kinds import KINDS

LANGUAGES: tuple[Language, ...] = languages()
PLAIN = re.compile(r"[0-9]?[A-Z]+[0-9]?|[0-9]+ pt|[0-9]+")
"""Choices that need no words: names of groups, sizes."""


def keys(part: Schema, root: Schema, path: tuple[str, ...] = ()) -> Iterator[tuple[str, Schema]]:
    """All keys of a schema by their paths, as words have them, with what stands behind them."""
    for one in alternatives(part, root):
        for inner in (one.get("items"), one.get("additionalProperties"), *one.get("patternProperties", {}).values()):
            if isinstance(inner, dict):
                yield from keys(inner, root, path)
        for key, about in one.get("properties", {}).items():
            yield ".".join((*path, key)), about
            yield from keys(about, root, (*path, key))


@pytest.mark.parametrize("language", LANGUAGES)
@pytest.mark.parametrize("kind", KINDS)
def test_every_key_has_words_and_no_words_are_idle(kind: str, language: Language) -> None:
    schema = file_schema(catalogue.kind(kind))
    found = dict(keys(schema, schema))
    words = field_words(kind, language)
    assert found.keys() <= words.keys()
    shared = set.intersection(*(set(field_words(other, language)) for other in KINDS))
    assert words.keys() - found.keys() <= shared
    assert all(said.name and not said.name.endswith((".", ",")) for said in words.values())
    chosen = {choice for about in found.values() for one in alternatives(about, schema) for choice in choices_of(one)}
    assert {choice for choice in chosen - choice_words(language).keys() if not PLAIN.fullmatch(choice)} <= {kind}


def test_languages_have_the_words_of_one_another() -> None:
    """Keys, remarks and their order are those of the other languages."""
    for kind in kinds():
        vi, *others = (field_words(kind, language) for language in LANGUAGES)
        forms = [(key, bool(said.remark), bool(said.group)) for key, said in vi.items()]
        for other in others:
            assert [(key, bool(said.remark), bool(said.group)) for key, said in other.items()] == forms
    assert all(choice_words(language).keys() == choice_words("en").keys() for language in LANGUAGES)


def test_schema_tells_units_bounds_defaults_and_what_checks_say() -> None:
    schema = catalogue.schema("en")
    shaper = schema["definitions"]["ShaperParameters"]
    l3, g = shaper["properties"]["l3"], shaper["properties"]["g"]
    assert (l3["title"], l3["description"]) == ("Rocker CD", "rocker CD, longer than a + l1")
    assert (l3["x-unit"], l3["x-range"]) == ("mm", {"minimum": 0.1, "exclusiveMaximum": 1e5})
    assert g["default"] == "9.81 m/s2"
    assert {"oneOf": [{"required": ["n"]}, {"required": ["omega1"]}]} in shaper["allOf"]
    assert {"not": {"required": ["G3", "m3"]}} in shaper["allOf"]
    stroke = schema["definitions"]["ByStroke"]
    assert ["s", "intake", "compression", "expansion", "exhaust"] in stroke["x-same-length"]
    assert stroke["properties"]["s"]["x-increasing"] == {"from": 0, "to": 1, "unit": ""}
    assert not list(_internal(schema)), "a default stands as a file would have it"


def test_definitions_have_readable_names() -> None:
    """The schema publishes no module path of the program, and all kinds together give each model one name."""
    schema = catalogue.schema("en")
    names = schema["definitions"].keys()
    assert {"FourBarParameters", "CamFileParameters", "TrainFileParameters", "ByStroke", "Taken"} <= names
    assert [name for name in names if not re.fullmatch("([A-Z]+[a-z]*)+", name) or "eportgen" in name] == []
    assert set(re.findall("#/definitions/([^']+)'", str(schema))) == set(names)
    assert all("eportgen" not in name for kind in kinds() for name in file_schema(catalogue.kind(kind))["$defs"])


def _internal(part: Any) -> Iterator[Any]:
    match part:
        case {"default": {"si": _}}:
            yield part
        case dict():
            for value in part.values():
                yield from _internal(value)
        case list():
            for value in part:
                yield from _internal(value)


def test_the_schema_of_a_kind_is_made_once() -> None:
    """A form asks for it with each change."""
    assert [kind for kind in KINDS if file_schema(catalogue.kind(kind)) is not file_schema(catalogue.kind(kind))] == []


@pytest.mark.parametrize("language", LANGUAGES)
@pytest.mark.parametrize("kind", KINDS)
def test_a_file_to_begin_with_says_what_its_keys_are(kind: str, language: Language) -> None:
    """Each parameter with one value in its line has a remark; what may be said otherwise is told in its unit."""
    text = catalogue.sample(kind, language)
    for line in text.splitlines():
        if re.match(r"  (# )?[A-Za-z_0-9]+: [^{\[ ]", line) and ": " in line.partition("#")[0]:
            assert " # " in line, line
    if kind == "shaper":
        assert re.search(r"n: 89 rpm .*omega1: 9\.32 rad/s$", text, re.MULTILINE)
