"""A proof sheet has every sentence of a language beside the English one, in all its cases, numbered."""

from __future__ import annotations

import re
from itertools import count
from pathlib import Path

import pytest

from reportgen.api import language_check
from reportgen.base.template_folders import REFERENCE, templates
from reportgen.base.words import sections
from reportgen.document import Emph, Inlines, Strong, Text
from reportgen.document.proof_sheet import ProofReader
from tests.lanes import proof


def read(text: str, **names: object) -> list[str]:
    def plain(line: Inlines) -> str:
        return "".join(
            one.text if isinstance(one, Text) else plain(one.of) if isinstance(one, (Emph, Strong)) else "…"
            for one in line
        )

    return [plain(line) for line in ProofReader(names).paragraphs(text)]


def test_a_sentence_stands_there_in_all_its_cases() -> None:
    text = "# Loads\n\nThe {% if several %}links\nare{% elif one %}link is{% else %}– {% endif %} heavy."
    assert read(text, several=True) == ["Loads", "The [several: links are | one: link is | – : – ] heavy."]


def test_what_the_machine_has_is_filled_in_and_the_rest_is_named() -> None:
    assert read("Link {{ i }} at {{ missing(i) }}.", i=3) == ["Link 3 at ‹missing(i)›."]


@proof
@pytest.mark.parametrize("language", ["vi"])
def test_every_section_is_there_and_the_numbers_go_on(language: str) -> None:
    import pymupdf

    with pymupdf.open(stream=language_check.proof_sheet(templates() / language, language)) as document:
        text = "\n".join(page.get_text() for page in document)
    named = set(re.findall(r"%% ([\w/-]+)", text))
    files = [path for path in (templates() / REFERENCE).rglob("*.md") if path.is_file()]
    wanted = {name for file in files for name in sections(file) if name != "new"}
    assert wanted - named == set()
    numbers = [int(line) for line in text.splitlines() if re.fullmatch(r"\d{1,5}", line)]
    following = count(1)
    expected = next(following)
    for number in numbers:
        if number == expected:
            expected = next(following)
    assert expected > 2000
    assert "\ufffd" not in text


def test_a_place_is_a_language_or_a_folder(tmp_path: Path) -> None:
    assert language_check.folder_of("vi") == templates() / "vi"
    assert language_check.folder_of(str(tmp_path)) == tmp_path
