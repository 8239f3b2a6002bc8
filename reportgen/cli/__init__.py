"""The command line: parse, call, print, end with the right code; no logic of its own.

Exit codes: 0 done · 1 an input file is at fault · 2 wrong usage · 3 the typesetter or the system failed.
"""

from __future__ import annotations

import gc
import io
import os
import signal
import sys
from functools import cache

TYPE_CHECKING = False
# Until `main` runs Ctrl-C is not heard: `typing` alone takes as long as all that is loaded before.
if TYPE_CHECKING:
    from typing import Any, NoReturn, TextIO

    import typer

    app: typer.Typer

LACKING = "reportgen: không đủ bộ nhớ (not enough memory: a limit is set, see ulimit -v)\n"
STOPPED = "reportgen: đã dừng (interrupted)\n"
"""Said where no words are loaded yet."""

COLLECTED = 1_000_000
"""New objects between two searches for garbage: a report makes many that last, and hardly any cycles."""


def main() -> None:
    """Entry point of the `reportgen` command, which hears Ctrl-C before it has loaded anything."""
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, _leave)
    from reportgen.cli.limited import WATCHED, ends_by_itself, is_limited

    if is_limited():
        _watch()
    gc.set_threshold(COLLECTED)
    import warnings

    # What others plug into models is none of ours, and looking for it takes time.
    os.environ.setdefault("PYDANTIC_DISABLE_PLUGINS", "__all__")
    import typer

    from reportgen.cli.common import SYSTEM, WRONG_USAGE, complain_of_program, language_of_run, misused

    for stream in (sys.stdout, sys.stderr):
        # Vietnamese must not fail on a terminal or pipe of another encoding.
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(encoding="utf-8", errors="backslashreplace")
    warnings.showwarning = _tell
    try:
        language_of_run(sys.argv[1:])
        sys.exit(_app()(standalone_mode=False, prog_name="reportgen") or 0)
    except typer.TyperException as error:
        misused(error)
        sys.exit(WRONG_USAGE)
    except Exception as error:
        # What is watched over has little memory: libraries that are there cannot be loaded.
        if WATCHED in os.environ and isinstance(error, (ImportError, MemoryError)):
            os.write(2, LACKING.encode())
        else:
            complain_of_program(error)
        sys.exit(SYSTEM)
    finally:
        ends_by_itself()
        # All memory goes with the process: no need to look through it once more on the way out.
        gc.freeze()


def _watch() -> NoReturn:
    """Let another process run this command, and say what it cannot say itself where memory ends it."""
    from reportgen.cli.limited import run_watched

    code = run_watched()
    if code is None:
        os.write(2, LACKING.encode())
    sys.exit(3 if code is None else code)


def _leave(*_: object) -> None:
    """End at once: before a command begins its work there is nothing to tidy up, and half an import to fall over."""
    os.write(2, STOPPED.encode())
    os._exit(128 + signal.SIGINT)


@cache
def _app() -> typer.Typer:
    """The commands in the order of the help."""
    import typer

    from reportgen.cli import instructor, reading, student, takeaway, translator
    from reportgen.cli.common import begin
    from reportgen.cli.helping import Command, Commands

    made = typer.Typer(
        name="reportgen",
        cls=Commands,
        help="Coursework reports in the Theory of Machines from one assignment file.",
        invoke_without_command=True,
        context_settings={"help_option_names": ["-h", "--help"]},
        pretty_exceptions_enable=False,
        rich_markup_mode=None,
    )
    made.callback()(begin)
    for command in (
        student.new,
        student.check,
        student.build,
        student.sheet,
        takeaway.figure,
        takeaway.plot,
        student.watch,
        student.edit,
        student.solve,
        student.compare,
        student.read,
        student.kinds,
        student.samples,
        student.schema,
        instructor.variants,
        instructor.batch,
        instructor.key,
        instructor.grade,
        translator.words,
        reading.docs,
    ):
        made.command(cls=Command)(command)
    return made


def __getattr__(name: str) -> Any:
    """The `app`, made when it is asked for."""
    if name != "app":
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return _app()


def _tell(
    message: Warning | str,
    category: type[Warning],
    filename: str,
    lineno: int,
    file: TextIO | None = None,
    line: str | None = None,
) -> None:
    """Print a warning as the command line's other messages are."""
    print(f"reportgen: {message}", file=file or sys.stderr)
