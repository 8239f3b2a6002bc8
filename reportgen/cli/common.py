"""What all commands share: their options, and how an outcome becomes words and an exit code."""

from __future__ import annotations

import signal
import sys
from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Annotated, Literal

import typer

from reportgen.base.errors import AssignmentError, Fault, ReportgenError
from reportgen.base.files import overwritten, put_file
from reportgen.base.units import Language

AT_FAULT, SYSTEM, INTERRUPTED = 1, 3, 130

File = Annotated[Path, typer.Argument(metavar="FILE", help="Assignment file.", show_default=False)]
Files = Annotated[list[Path], typer.Argument(metavar="FILE", help="Assignment files.", show_default=False)]
LangOption = Annotated[
    Language | None, typer.Option("--lang", help="Language, instead of the file's own.", show_default=False)
]
EngineOption = Annotated[Literal["typst", "latex"], typer.Option("--engine", help="Typesetter.")]


@contextmanager
def ending(lang: Language | None) -> Iterator[None]:
    """Prints what goes wrong inside, never a traceback, and ends with the exit code it means."""
    if signal.getsignal(signal.SIGINT) is not signal.SIG_IGN:
        # From here on there is something to tidy up.
        signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        yield
    except KeyboardInterrupt:
        complain(say("interrupted", lang))
        raise
    except (typer.Exit, typer.BadParameter, BrokenPipeError):
        raise
    except AssignmentError as error:
        print(*error.problems, sep="\n", file=sys.stderr)
        code = error.exit_code
    except ReportgenError as error:
        complain(str(error))
        code = error.exit_code
    except OSError as error:
        complain(say("system", lang, text=error))
        code = SYSTEM
    except MemoryError:
        complain(say("memory", lang))
        code = SYSTEM
    except Exception as error:
        complain_of_program(error, lang)
        code = SYSTEM
    else:
        return
    raise typer.Exit(code)


def for_each(files: list[Path], lang: Language | None, work: Callable[[Path], None]) -> None:
    """Does the work for every file, whatever comes of the others, and ends with the gravest exit code.

    Files of one name, which would write to one folder, are wrong usage.
    """
    seen: dict[str, Path] = {}
    for file in files:
        if seen.setdefault(file.stem, file) is not file:
            raise typer.BadParameter(say("same_name", lang, first=seen[file.stem], second=file))
    code = 0
    for file in files:
        try:
            with ending(lang):
                work(file)
        except typer.Exit as end:
            code = max(code, end.exit_code)
    raise typer.Exit(code)


def complain(text: str) -> None:
    print(f"reportgen: {text}", file=sys.stderr)


def complain_of_program(error: BaseException, lang: Language | None = None) -> None:
    """Says that an exception nobody expected is a fault of the program."""
    from reportgen.base.words import unexpected

    complain(unexpected(error, lang))


def say(key: str, lang: Language | None, /, **arguments: object) -> str:
    """A text of the message table in the language of the command line."""
    from reportgen.base.words import word

    return word(key, lang, **arguments)


def listed(text: str, known: Collection[str], option: str, complaint: str, lang: Language | None) -> tuple[str, ...]:
    """The names in a list separated by commas, each once; a name that is not `known` is wrong usage."""
    names = tuple(dict.fromkeys(name.strip() for name in text.split(",")))
    for name in names:
        if name not in known:
            text = say(complaint, lang, text=name, known=", ".join(known))
            raise typer.BadParameter(text, param_hint=option)
    return names


def refuse_inputs(outputs: Iterable[Path], inputs: Sequence[Path | None], lang: Language | None) -> None:
    """Raises `AssignmentError` where a command would write over one of its inputs; asked before all else."""
    given = [path for path in inputs if path is not None]
    refuse(overwritten(outputs, given), given[0], lang)


def refuse(faults: Iterable[Fault], file: Path, lang: Language | None) -> None:
    """Raises `AssignmentError` with these faults, if there are any, in the language of a file."""
    if found := list(faults):
        from reportgen.base.source import read_source
        from reportgen.base.words import as_error, language_of

        raise as_error(found, lang or language_of(read_source(file)))


def write(path: Path, text: str) -> None:
    """To standard output for `-`; else to the file, which is replaced only once all is written."""

    if str(path) == "-":
        sys.stdout.write(text)
    else:
        put_file(path, text.encode())
