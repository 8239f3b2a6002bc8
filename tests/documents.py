"""The documents of the project for tests: their text, the files that they print and the commands that they show."""

from __future__ import annotations

import ast
import contextlib
import io
import os
import re
import shlex
import shutil
import subprocess
import sys
import textwrap
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parent.parent
PAGES = (
    *("README.md", "README.vi.md"),
    *sorted(page.relative_to(ROOT).as_posix() for page in (ROOT / "docs").rglob("*.md")),
)
"""Pages for users; each is read, and its commands are run, separately."""

DOCUMENTS = (*PAGES, "CONTRIBUTING.md", "ARCHITECTURE.md", "CHANGELOG.md")

FENCE = re.compile(r"^```(\w+)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
FILE = re.compile(r"`([\w./-]+\.\w+)`[^`\n]*:\n\n```(?!diff)\w+\n(.*?)^```$", re.MULTILINE | re.DOTALL)
STEP = re.compile(
    r"^(?:```(console|diff)\n(.*?)^```$|\| (?:cell|ô) \|[^\n]*\n\|[-| ]+\n((?:\|[^\n]*\n)+))", re.MULTILINE | re.DOTALL
)
"""Commands, a change of a text file, or a table of cells of a workbook that are filled in."""

_INDENTED = re.compile(r"^(?P<blanks> +)```\w+\n.*?^(?P=blanks)```$", re.MULTILINE | re.DOTALL)
"""A code block within a step of a list."""


def text_of(document: str) -> str:
    """Return the text of a document, with the code blocks within lists at the margin."""
    text = (ROOT / document).read_text(encoding="utf-8")
    return _INDENTED.sub(lambda block: textwrap.dedent(block[0]), text)


def fences(document: str, language: str) -> list[str]:
    return [body for name, body in FENCE.findall(text_of(document)) if name == language]


def section(text: str, heading: str) -> str:
    """Return the text between a heading and the next one of any level, ignoring headings in code blocks."""
    found = re.search(rf"^{re.escape(heading)}\n((?:^```.*?^```$|.)*?)(?=^##+ |\Z)", text, re.MULTILINE | re.DOTALL)
    assert found, heading
    return found[1]


@dataclass(frozen=True, slots=True)
class Command:
    """A line of a console block and its shown output."""

    line: str
    output: tuple[str, ...]

    @property
    def is_make(self) -> bool:
        return self.line.startswith("make ")

    @property
    def runnable(self) -> str:
        """The command to run; make only does a dry run, because it would install and run everything again."""
        return self.line.replace("make ", "make -n ", 1) if self.is_make else self.line

    @property
    def possible(self) -> bool:
        return "--engine latex" not in self.line or shutil.which("pdflatex") is not None


FEWER = (("[:60]", "[:5]"), ("60 made", "5 made"), ("S60", "S05"), ("the 60 variants", "the 5 variants"))
"""The class of the tutorial with five students, so that a test takes seconds."""


def played(document: str, whole: bool = False) -> str:
    """Return the text of a document as a test plays it, or with the whole class."""
    text = text_of(document)
    for shown, tried in FEWER if Path(document).name.startswith("class-of-60.") and not whole else ():
        assert shown in text
        text = text.replace(shown, tried)
    return text


def commands(document: str, whole: bool = False) -> Iterator[Command]:
    """Yield the commands of a page, and its changes of the file that it names last before each of them."""
    text = played(document, whole)
    for step in STEP.finditer(text):
        language, block, cells = step.groups()
        if language != "console":
            file = re.findall(r"`([\w./-]+\.\w+)`", text[: step.start()])[-1]
            yield fill(file, cells) if cells else edit(file, block)
            continue
        shown = re.split(r"^\$ ", block, flags=re.MULTILINE)
        assert shown[0] == "", f"a console block begins with a command: {block}"
        for one in shown[1:]:
            line, *output = one.splitlines()
            yield Command(line, tuple(output))


def edit(file: str, change: str) -> Command:
    """Return a command that replaces each text behind `-` by the next one behind `+`; the file must have it once."""
    signs = [(line[0], line[1:].strip()) for line in change.splitlines()]
    old, new = ([text for one, text in signs if one == sign] for sign in "-+")
    code = (
        f"import pathlib; file = pathlib.Path({file!r})\n"
        f"for old, new in {list(zip(old, new, strict=True))!r}:\n"
        "    text = file.read_text(encoding='utf-8')\n"
        "    assert text.count(old) == 1, old\n"
        "    file.write_text(text.replace(old, new), encoding='utf-8')\n"
    )
    return Command(f"python -c {shlex.quote(code)}", ())


def fill(file: str, table: str) -> Command:
    """Return a command that writes the last column of a table into the cells in its first column."""
    rows = [[cell.strip() for cell in row.split("|")[1:-1]] for row in table.splitlines()]
    values = {cell: float(value) for cell, *_, value in rows}
    code = (
        f"import openpyxl; book = openpyxl.load_workbook({file!r}); sheet = book.worksheets[0]; "
        f"[sheet.__setitem__(cell, value) for cell, value in {values!r}.items()]; book.save({file!r})"
    )
    return Command(f"python -c {shlex.quote(code)}", ())


def agrees(shown: Sequence[str], printed: Sequence[str]) -> bool:
    """Return True if the lines match the output; `…` stands for any text, or for any lines if alone on its line.

    Columns may be wider or narrower: blanks between words count as two.
    """
    if not shown:
        return not printed
    if shown[0] == "…":
        return any(agrees(shown[1:], printed[start:]) for start in range(len(printed) + 1))
    if not printed:
        return False
    wanted, line = (re.sub(r"(?<=\S) {2,}", "  ", text.rstrip()) for text in (shown[0], printed[0]))
    pattern = re.sub(r"[*?[]", r"[\g<0>]", wanted).replace("…", "*")
    return fnmatchcase(line, pattern) and agrees(shown[1:], printed[1:])


def run(lines: Sequence[str], place: Path) -> list[tuple[list[str], int]]:
    """Return each command's output in one shell that knows `reportgen` and `python`, and its exit code.

    `$?` passes from one to the next.
    """
    programs = place / ".programs"
    programs.mkdir(exist_ok=True)
    for name, arguments in (("reportgen", "-m reportgen.cli"), ("python", "")):
        program = programs / name
        program.write_text(f'#!/bin/sh\nexec "{sys.executable}" {arguments} "$@"\n', encoding="utf-8")
        program.chmod(0o755)
    mark = "\x1e"
    script = "".join(f"(exit $status)\n{line}\nstatus=$?; printf '{mark}%s{mark}' $status\n" for line in lines)
    done = subprocess.run(
        ["sh", "-c", "status=0\n" + script],
        cwd=place,
        env={
            **os.environ,
            "PATH": f"{programs}{os.pathsep}{os.environ['PATH']}",
            "PYTHONPATH": str(place),
            "COLUMNS": "100",
        },
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        encoding="utf-8",
        timeout=300,
        check=True,
    )
    outputs, codes = done.stdout.split(mark)[:-1:2], done.stdout.split(mark)[1::2]
    return [(output.strip("\n").splitlines(), int(code)) for output, code in zip(outputs, codes, strict=True)]


def copy_of_repository(place: Path) -> Path:
    """Copy the package with its compiled files, since each command is a process that would compile it again."""
    for name in ("reportgen", "templates", "assignments"):
        # What another process is about to write has a name that will be gone.
        shutil.copytree(ROOT / name, place / name, ignore=shutil.ignore_patterns("*.pyc.*"))
    for name in ("Makefile", "pyproject.toml", "requirements-dev.lock"):
        shutil.copy(ROOT / name, place)
    (place / "out").mkdir()
    return place


def play(document: str, place: Path, whole: bool = False) -> list[tuple[Command, list[str], int]]:
    """Write the files that a document prints and run its commands; return each with its output and exit code."""
    for name, content in FILE.findall(played(document, whole)):
        file = place / name
        assert not file.exists(), f"{name} is there already"
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(content, encoding="utf-8")
    shown = [command for command in commands(document, whole) if command.possible]
    printed = run([command.runnable for command in shown], place)
    return [(command, output, code) for command, (output, code) in zip(shown, printed, strict=True)]


def follow(document: str, place: Path) -> list[str]:
    """Play a document in a folder; return what differs from what it shows."""
    return [
        "\n".join((f"$ {command.line}", *output))
        for command, output, code in play(document, place)
        if not (code == 0 if command.is_make else agrees(command.output, output))
    ]


@dataclass(frozen=True, slots=True)
class Cell:
    """A cell of a notebook that a page shows, and what it did."""

    code: str
    shown: tuple[str, ...]
    """The lines that the page shows as printed."""
    printed: tuple[str, ...]
    value: Any
    """The value of its last line, which a notebook displays; None if that line ends with a semicolon."""
    names: Mapping[str, Any]
    """All variables after the cell."""


_CELL = re.compile(r"^```python\n(.*?)^```$(?:\n\n```text\n(.*?)^```$)?", re.MULTILINE | re.DOTALL)


def cells(document: str, place: Path) -> list[Cell]:
    """Run the Python blocks of a page as the cells of one notebook in this folder."""
    names: dict[str, Any] = {}
    done = []
    with contextlib.chdir(place):
        for code, shown in _CELL.findall(text_of(document)):
            out, value, lines = io.StringIO(), None, ast.parse(code)
            last = lines.body[-1]
            with contextlib.redirect_stdout(out):
                if isinstance(last, ast.Expr) and not code.rstrip().endswith(";"):
                    exec(compile(ast.Module(lines.body[:-1], []), document, "exec"), names)
                    value = eval(compile(ast.Expression(last.value), document, "eval"), names)
                else:
                    exec(compile(lines, document, "exec"), names)
            done.append(Cell(code, tuple(shown.splitlines()), tuple(out.getvalue().splitlines()), value, dict(names)))
    return done


def lint(place: Path, *files: str) -> str:
    """Return the style and type errors of `make lint` for new or changed files, "" if there are none."""
    if (known := ROOT / ".mypy_cache").is_dir():
        # Where types were checked before, only these files are new.
        shutil.copytree(known, place / known.name, dirs_exist_ok=True)
    code = [file for file in files if file.startswith("reportgen/")]
    checks = (("ruff", "format", "--check", *files), ("ruff", "check", *files), ("mypy", *code))
    done = [
        subprocess.run([sys.executable, "-m", *check], cwd=place, capture_output=True, text=True, check=False)
        for check in checks
    ]
    return "".join(one.stdout + one.stderr for one in done if one.returncode)
