"""Help and pages in the language that is spoken: nothing is left in English where the locale is Vietnamese."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any

import pytest
import typer

from reportgen.base.documentation import heading, pages
from reportgen.base.template_folders import languages
from reportgen.base.units import Language
from reportgen.base.words import SPOKEN, helps
from reportgen.cli import app
from reportgen.cli.help_texts import OTHERS, PAGES, start

GROUP: Any = typer.main.get_command(app)
COMMANDS: dict[str, Any] = GROUP.commands
ENGLISH = re.compile(r"\b(the|of|or|and|with|is|Usage|default|required|Options|Arguments|Show|Print|Folder)\b")


LISTS = re.compile(r"(?<=^Of ).*(?=; separated by commas\.$)|(?<=^Write the table of a full turn: ).*(?=\.$)")
"""Lists of names in these texts: one translation serves any list."""


def texts() -> Iterator[str]:
    """Every text of the commands, as it stands in their code."""
    for command in (GROUP, *COMMANDS.values()):
        yield from (command.help or "").split("\n\n")
        for parameter in command.params:
            yield parameter.help or ""
            if isinstance(parameter.show_default, str):
                yield parameter.show_default


def shown(command: Any, language: Language, monkeypatch: pytest.MonkeyPatch) -> str:
    monkeypatch.setenv(SPOKEN, language)
    name = "reportgen" if command is GROUP else command.name
    context: Any = command.context_class(command, info_name=name, help_option_names=["-h", "--help"])
    return str(command.get_help(context))


@pytest.mark.parametrize("language", [language for language in languages() if language != "en"])
def test_each_text_has_its_own_in_every_other_language_and_no_other_is_kept(language: Language) -> None:
    plain = {LISTS.sub("{names}", " ".join(text.split())) for text in texts()} - {""}
    # Typer's own.
    plain.add("Show this message and exit.")
    own = set(helps(language)["texts"])
    # A further language may lack some, which then come in English.
    assert own == plain if language == "vi" else own <= plain


@pytest.mark.parametrize("name", ["", *COMMANDS])
def test_help_has_nothing_of_the_other_language(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    command = COMMANDS[name] if name else GROUP
    vietnamese = shown(command, "vi", monkeypatch)
    assert not ENGLISH.search(re.sub(r"--[\w-]+|<.*?>", "", vietnamese))
    assert "Cách dùng: " in vietnamese
    assert shown(command, "en", monkeypatch).replace("…", "").isascii()


def test_each_help_names_a_page_that_there_is(monkeypatch: pytest.MonkeyPatch) -> None:
    assert set(PAGES) <= set(COMMANDS)
    known = pages("en")
    assert {*PAGES.values(), OTHERS} <= set(known)
    assert shown(COMMANDS["grade"], "en", monkeypatch).endswith("More: reportgen docs grading")


def test_the_start_leads_to_the_form_then_from_the_kinds_to_the_report(monkeypatch: pytest.MonkeyPatch) -> None:
    for language in languages():
        monkeypatch.setenv(SPOKEN, language)
        named = re.findall(r"reportgen (\w+)", start())
        assert [name for name in named if name in COMMANDS][:5] == ["edit", "kinds", "new", "check", "build"]
        # The list of commands has the same order.
        first = dict.fromkeys(name for name in named if name in COMMANDS)
        assert [*first] == [name for name in COMMANDS if name in first]


def test_the_first_page_is_in_the_language_and_the_others_are_all_there() -> None:
    assert [heading(pages(language)["README"]) for language in ("vi", "en")] == [
        "reportgen: thuyết minh bài tập lớn Nguyên lý máy",
        "reportgen",
    ]
    assert {"class", "assignment", "commands", "machines"} <= set(pages("vi"))


@pytest.mark.parametrize("name", ["build", "grade", "variants", "batch"])
def test_help_has_no_python_types_and_every_default_in_words(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    for language in languages():
        text = shown(COMMANDS[name], language, monkeypatch)
        assert not re.search(r"<(list\[|path>|int>|str>)", text, re.IGNORECASE)
        assert "(one a core)" not in " ".join(text.split())
