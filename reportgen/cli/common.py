"""What all commands share: their options, and how an outcome becomes words and an exit code."""

from __future__ import annotations

import sys
from collections.abc import Collection, Iterator
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
EngineOption = Annotated[Engine, typer.Option("--engine", help="Typesetter.")]


class Outcome:
    """The exit code of a piece of work."""

    code = 0


@contextmanager
def ending(lang: Lang | None) -> Iterator[Outcome]:
    """Prints what goes wrong inside, never a traceback, and remembers the exit code it means."""
    outcome = Outcome()
    try:
        yield outcome
    except AssignmentError as error:
        print(*error.problems, sep="\n", file=sys.stderr)
        outcome.code = error.exit_code
    except ReportgenError as error:
        complain(str(error))
        outcome.code = error.exit_code
    except BrokenPipeError:
        raise
    except OSError as error:
        complain(say("system", lang, text=error))
        outcome.code = SYSTEM
    except (typer.Exit, typer.BadParameter):
        raise
    except Exception as error:
        complain_of_program(error, lang)
        outcome.code = SYSTEM


def complain(text: str) -> None:
    print(f"reportgen: {text}", file=sys.stderr)


def complain_of_program(error: BaseException, lang: Lang | None = None) -> None:
    """Says that an exception nobody expected is a fault of the program."""
    from reportgen.assignment.faults import unexpected

    complain(unexpected(error, language(lang)))


def say(key: str, lang: Lang | None, /, **arguments: object) -> str:
    """A text of the message table in the language of the command line."""
    from reportgen.assignment.faults import word

    return word(key, language(lang), **arguments)


def language(lang: Lang | None) -> Language | None:
    return None if lang is None else "en" if lang is Lang.en else "vi"


def typesetter(engine: Engine) -> Literal["typst", "latex"]:
    return "latex" if engine is Engine.latex else "typst"


def refuse_same_names(files: list[Path], lang: Lang | None) -> None:
    """Two files of one name would write to one folder."""
    seen: dict[str, Path] = {}
    for file in files:
        if file.stem in seen:
            raise typer.BadParameter(say("same_name", lang, first=seen[file.stem], second=file))
        seen[file.stem] = file


def listed(text: str, known: Collection[str], option: str, complaint: str, lang: Lang | None) -> tuple[str, ...]:
    """The names in a list separated by commas, each once; a name that is not `known` is wrong usage."""
    names = tuple(dict.fromkeys(name.strip() for name in text.split(",")))
    for name in names:
        if name not in known:
            text = say(complaint, lang, text=name, known=", ".join(known))
            raise typer.BadParameter(text, param_hint=option)
    return names


def write(path: Path, text: str) -> None:
    """To standard output for `-`; else to the file, which is replaced only once all is written."""
    from reportgen import api

    if str(path) == "-":
        sys.stdout.write(text)
    else:
        api.replace(path, text.encode())
