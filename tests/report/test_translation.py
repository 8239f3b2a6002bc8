"""Every language says what English says; what is spoilt in one is told with its place."""

from __future__ import annotations

import re
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from reportgen.base.kinds import kinds
from reportgen.base.template_folders import REFERENCE, languages, templates
from reportgen.base.translation_coverage import is_whole, offered
from reportgen.document.translation_check import faults
from reportgen.report.phrases import form_of

WARNED = frozenset({"words-term", "words-untranslated", "words-idle"})


def told(folder: Path) -> list[tuple[str, str]]:
    """The places and codes of what is wrong with a language."""
    return [
        (f"{Path(fault.location.file).name}:{fault.location.line}", fault.code)
        for fault in faults(folder)
        if fault.code not in WARNED
    ]


@pytest.mark.parametrize("language", languages())
def test_each_language_says_what_english_says(language: str) -> None:
    assert told(templates() / language) == []
    assert offered(language) == list(kinds())


def test_vietnamese_has_the_terms_of_the_glossary() -> None:
    assert [fault for fault in faults(templates() / "vi") if fault.code == "words-term"] == []


SPOILT: tuple[tuple[str, str, Callable[[str], str], str], ...] = (
    ("report.md", "a section that is gone", lambda text: text.replace("%% joints\n", "", 1), "words-missing"),
    ("report.md", "one too many", lambda text: text + "\n%% further\nMore.\n", "words-beyond"),
    ("report.md", "a heading", lambda text: text.replace("## Position plan", "# Position plan", 1), "words-headings"),
    ("report.md", "a reference", lambda text: text.replace("@tab.extremes", "@tab.other", 1), "words-missing"),
    ("report.md", "a formula", lambda text: text.replace("$n$", "$N$", 1), "words-missing"),
    ("report.md", "a name", lambda text: text.replace("{{ mobility_line() }}", "", 1), "words-missing"),
    (
        "report.md",
        "words in braces",
        lambda text: text.replace("%% joints\n", '%% joints\n{{ "are" if several else "is" }}\n', 1),
        "words-in-braces",
    ),
    ("words.yaml", "a word that is gone", lambda text: re.sub(r"(?m)^and: .*\n", "", text, count=1), "words-missing"),
    ("words.yaml", "a gap", lambda text: text.replace('"Variant {variant}"', '"Variant"', 1), "words-missing"),
    ("words.yaml", "a list", lambda text: text.replace("strokes: [Intake, ", "strokes: [", 1), "words-list"),
    ("words.yaml", "a form", lambda text: re.sub(r"(?m)^and: .*$", "and: [and]", text, count=1), "words-form"),
)


@pytest.mark.parametrize(("name", "what", "spoil", "code"), SPOILT, ids=[row[1] for row in SPOILT])
def test_what_is_spoilt_is_told_with_its_file(
    name: str, what: str, spoil: Callable[[str], str], code: str, tmp_path: Path
) -> None:
    folder = tmp_path / "xx"
    folder.mkdir()
    shutil.copy(templates() / REFERENCE / "language.yaml", folder)
    text = (templates() / REFERENCE / name).read_text(encoding="utf-8")
    assert spoil(text) != text, what
    (folder / name).write_text(spoil(text), encoding="utf-8")
    assert code in {one for place, one in told(folder) if place.startswith(name)}


def test_the_line_of_words_in_braces_is_theirs(tmp_path: Path) -> None:
    folder = tmp_path / "xx"
    folder.mkdir()
    shutil.copy(templates() / REFERENCE / "language.yaml", folder)
    lines = (templates() / REFERENCE / "report.md").read_text(encoding="utf-8").splitlines()
    at = lines.index("%% joints") + 1
    lines.insert(at, '{{ "one" if several }}')
    (folder / "report.md").write_text("\n".join(lines), encoding="utf-8")
    assert (f"report.md:{at + 1}", "words-in-braces") in told(folder)


def test_letters_that_no_font_has_are_told(tmp_path: Path) -> None:
    folder = tmp_path / "xx"
    folder.mkdir()
    shutil.copy(templates() / REFERENCE / "language.yaml", folder)
    (folder / "comments.md").write_text("%% moved\nAll Ω well\n", encoding="utf-8")
    letters = [fault for fault in faults(folder, lambda text: "Ω" if "Ω" in text else "") if "letters" in fault.code]
    assert [(fault.location.line, fault.arguments["text"]) for fault in letters] == [(2, "Ω")]


def test_a_kind_is_whole_or_not_offered() -> None:
    assert all(is_whole("vi", kind) for kind in kinds())
    assert not is_whole("frames", "cam")


@pytest.mark.parametrize(
    ("count", "two", "three"),
    [(1, 0, 0), (2, 1, 1), (4, 1, 1), (5, 1, 2), (11, 1, 2), (12, 1, 2), (21, 1, 0), (22, 1, 1)],
)
def test_a_number_has_its_form(count: int, two: int, three: int) -> None:
    """As 1 звено, 2 звена, 5 звеньев, 11 звеньев, 21 звено."""
    assert (form_of(count, 2), form_of(count, 3)) == (two, three)
