"""What all commands share: their options, and how an outcome becomes words and an exit code."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from enum import StrEnum
from pathlib import Path
from typing import Annotated, Literal

import typer

from reportgen.errors import AssignmentError, ReportgenError
from reportgen.notation.numbers import Language

AT_FAULT, USAGE, SYSTEM, INTERRUPTED = 1, 2, 3, 130

app = typer.Typer(
    name="reportgen",
    help="Coursework reports in the Theory of Machines from one assignment file.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
)


class Lang(StrEnum):
    vi = "vi"
    en = "en"


class Engine(StrEnum):
    typst = "typst"
    latex = "latex"


File = Annotated[Path, typer.Argument(metavar="FILE", help="Assignment file.", show_default=False)]
Files = Annotated[list[Path], typer.Argument(metavar="FILE", help="Assignment files.", show_default=False)]
LangOption = Annotated[
    Lang | None, typer.Option("--lang", help="Language, instead of the file's own.", show_default=False)
]


class Outcome:
    """The exit code of a piece of work."""

    code = 0


@contextmanager
def ending(lang: Lang | None) -> Iterator[Outcome]:
    """Prints what goes wrong inside, never a traceback, and remembers the exit code it means."""
    outcome = Outcome()
    try:
        yield outcome
    except AssignmentError as fault:
        print(*fault.problems, sep="\n", file=sys.stderr)
        outcome.code = fault.exit_code
    except ReportgenError as fault:
        print(f"reportgen: {fault}", file=sys.stderr)
        outcome.code = fault.exit_code
    except BrokenPipeError:
        raise
    except OSError as fault:
        complain("system", lang, text=str(fault))
        outcome.code = SYSTEM
    except (typer.Exit, typer.BadParameter):
        raise
    except Exception as fault:
        unexpected(fault, lang)
        outcome.code = SYSTEM


def unexpected(fault: BaseException, lang: Lang | None = None) -> None:
    complain("unexpected", lang, name=type(fault).__name__, text=" ".join(str(fault).split()))


def complain(name: str, lang: Lang | None, /, **arguments: str) -> None:
    from reportgen.assignment.messages import word

    print(f"reportgen: {word(name, language(lang) or 'vi').format(**arguments)}", file=sys.stderr)


def language(lang: Lang | None) -> Language | None:
    return None if lang is None else "en" if lang is Lang.en else "vi"


def typesetter(engine: Engine) -> Literal["typst", "latex"]:
    return "latex" if engine is Engine.latex else "typst"


def refuse_same_names(files: list[Path], language: Language | None) -> None:
    """Two files of one name would write to one folder."""
    from reportgen.assignment.messages import word

    seen: dict[str, Path] = {}
    for file in files:
        if file.stem in seen:
            text = word("same_name", language or "vi")
            raise typer.BadParameter(text.format(first=seen[file.stem], second=file))
        seen[file.stem] = file


def write(path: Path, text: str) -> None:
    """To standard output for `-`; else to the file, which is replaced only once all is written."""
    from reportgen import api

    if str(path) == "-":
        sys.stdout.write(text)
    else:
        api.replace(path, text.encode())
