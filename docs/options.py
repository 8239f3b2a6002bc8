"""Write `docs/reference/options.md` and its translation: the arguments and options of each command, from its help.

`make pictures` runs this in the project's folder, too. `docs/reference/commands.md` says what the commands do.
"""

from __future__ import annotations

import os
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import typer

from reportgen.base.units import Language
from reportgen.base.words import SPOKEN
from reportgen.cli import app
from reportgen.cli.help_texts import OTHERS, PAGES, described, translated

FOLDER = Path(__file__).resolve().parent / "reference"
TEXTS: Mapping[Language, Mapping[str, str]] = {
    "en": {
        "file": "options.md",
        "top": """# Options of the commands

What `reportgen COMMAND -h` prints, as one page. [Commands](commands.md) has the exit codes, the formats and the rules
that all commands share.
""",
        "head": "| argument, option | meaning |",
        "more": "More: [{title}]({file})",
    },
    "vi": {
        "file": "options.vi.md",
        "top": """# Các tùy chọn của lệnh

Trang này gom nội dung mà `reportgen LỆNH -h` in ra. Trang [các lệnh](commands.vi.md) nói về mã kết thúc, các định dạng
và những quy tắc chung của mọi lệnh.
""",
        "head": "| đối số, tùy chọn | ý nghĩa |",
        "more": "Đọc thêm: [{title}]({file})",
    },
}
"""Words of the page by language, and its file."""


def page(language: Language) -> str:
    """Return the page of all commands in a language."""
    before = os.environ.get(SPOKEN)
    os.environ[SPOKEN] = language
    try:
        group: Any = typer.main.get_command(app)
        sections = [section(name, command, language) for name, command in group.commands.items()]
    finally:
        os.environ.pop(SPOKEN)
        os.environ |= {SPOKEN: before} if before is not None else {}
    return "\n".join((TEXTS[language]["top"], *sections))


def section(name: str, command: Any, language: Language) -> str:
    """Return a command with its description and the table of its parameters."""
    texts = TEXTS[language]
    context = command.context_class(command, info_name=name, help_option_names=["-h", "--help"])
    rows = [row for kind in ("argument", "option") for row in described(command, context, kind)]
    lines = [f"| {as_code(names)} | {as_cell(text)} |" for names, text in rows if "--help" not in names]
    about = "\n\n".join(translated(paragraph) for paragraph in (command.help or "").split("\n\n"))
    file = FOLDER / f"{OTHERS}.md" if name not in PAGES else next(FOLDER.parent.rglob(f"{PAGES[name]}.md"))
    translation = file.with_suffix(".vi.md")
    target = translation if language == "vi" and translation.exists() else file
    more = texts["more"].format(title=file.stem, file=Path(os.path.relpath(target, FOLDER)).as_posix())
    return "\n".join((f"## `{name}`", "", about, "", texts["head"], "| --- | --- |", *lines, "", f"{more}.", ""))


def as_code(names: str) -> str:
    """Return the names of a parameter as code: `--size A0|A1`, with bars that do not end a cell, and N for a number."""
    plain = re.sub(r"[<>{}]", "", " ".join(names.split())).replace("int range", "N")
    return f"`{plain}`".replace("|", "\\|")


def as_cell(text: str) -> str:
    """Return a help text for a cell of a table."""
    return re.sub(r"[|<*]", r"\\\g<0>", " ".join(text.split()))


def pages() -> dict[Path, str]:
    """Return the text of each file that this script writes."""
    return {FOLDER / texts["file"]: page(language) for language, texts in TEXTS.items()}


if __name__ == "__main__":
    for file, text in pages().items():
        file.write_text(text, encoding="utf-8")
