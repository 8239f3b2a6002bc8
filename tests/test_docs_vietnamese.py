"""The Vietnamese pages: commands that the program has and assignment files without errors.

Their commands are those of the English pages, which are run; here they are only parsed.
"""

from __future__ import annotations

import re
import shlex
from collections.abc import Iterator
from pathlib import Path

import pytest
import typer

from reportgen import catalogue
from reportgen.cli import app
from tests.documents import FENCE, FILE, PAGES, text_of

VIETNAMESE = [page for page in PAGES if page.endswith(".vi.md")]

_INLINE = re.compile(r"`(reportgen [^`\n]+)`")


def shown_commands(page: str) -> Iterator[str]:
    """Yield the calls of `reportgen` on a page, in code blocks and in its sentences, each up to a pipe or a `>`."""
    text = text_of(page)
    marks = {"sh": "", "console": "$ "}
    blocks = [(marks[name], body.splitlines()) for name, body in FENCE.findall(text) if name in marks]
    shown = [line.removeprefix(mark) for mark, lines in blocks for line in lines if line.startswith(mark)]
    for line in (*shown, *_INLINE.findall(text)):
        # An upper-case word stands for any command.
        if line.startswith("reportgen ") and not line.split()[1].isupper():
            yield re.split(r" (?:\||\d?>) ", line)[0]


@pytest.mark.parametrize("page", VIETNAMESE)
def test_a_vietnamese_page_shows_commands_that_the_program_has(page: str) -> None:
    program = typer.main.get_command(app)
    commands = vars(program)["commands"]
    for line in shown_commands(page):
        _, *words = shlex.split(line)
        command = commands.get(words[0])
        assert command or words[0].startswith("-"), line
        if command:
            parser = command.make_parser(command.context_class(command, info_name=words[0], **program.context_settings))
            parser.parse_args(words[1:])


@pytest.mark.parametrize("page", [page for page in VIETNAMESE if FILE.search(text_of(page))])
def test_the_assignment_files_of_a_vietnamese_page_are_right(page: str, tmp_path: Path) -> None:
    files = dict(FILE.findall(text_of(page)))
    for name, content in files.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(content, encoding="utf-8")
    for name, content in files.items():
        if content.startswith("kind:") and "file:" not in content and "{from:" not in content:
            assert catalogue.check(tmp_path / name, "vi") == [], name
