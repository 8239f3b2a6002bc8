"""The command line: parse, call, print, and exit with the right code; it contains no logic.

Exit codes: 0 done · 1 an input file is invalid · 2 wrong usage · 3 the typesetter or the system failed.
"""

from __future__ import annotations

import gc
import io
import os
import signal
import sys
from functools import cache
from importlib import import_module

TYPE_CHECKING = False
# Until `main` runs, Ctrl-C is not handled; importing `typing` alone takes as long as everything loaded before.
if TYPE_CHECKING:
    from typing import Any, NoReturn, TextIO

    import typer

    app: typer.Typer

LACKING = "reportgen: không đủ bộ nhớ (not enough memory: a limit is set, see ulimit -v)\n"
STOPPED = "reportgen: đã dừng (interrupted)\n"
"""Messages used before any words are loaded."""

COLLECTED = 1_000_000
"""Number of new objects between two garbage collections: a report makes many lasting objects and hardly any cycles."""

COMMANDS = {
    "edit": "student",
    "kinds": "student",
    "new": "student",
    "check": "student",
    "build": "student",
    "watch": "student",
    "sheet": "student",
    "compare": "student",
    "solve": "student",
    "plot": "export",
    "figure": "export",
    "read": "student",
    "samples": "student",
    "schema": "student",
    "variants": "instructor",
    "batch": "instructor",
    "key": "instructor",
    "grade": "instructor",
    "serve": "serving",
    "words": "translator",
    "docs": "documentation",
}
"""The commands, each a function of this name, with their modules: in the order of a student's work, then of an
instructor's.
"""


def main() -> None:
    """Run the `reportgen` command; Ctrl-C is handled before anything is loaded."""
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, _leave)
    from reportgen.cli.memory_limit import WATCHED, announce_normal_end, is_limited

    if is_limited():
        _watch()
    gc.set_threshold(COLLECTED)
    import warnings

    # Third-party plugins of models are not used, and searching for them takes time.
    os.environ.setdefault("PYDANTIC_DISABLE_PLUGINS", "__all__")
    import typer

    from reportgen.base.errors import OutputWarning
    from reportgen.cli.common import SYSTEM, WRONG_USAGE, complain_of_program, language_of_run, misused

    for stream in (sys.stdout, sys.stderr):
        # Vietnamese must not fail on a terminal or pipe with another encoding.
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(encoding="utf-8", errors="backslashreplace")
    warnings.showwarning = _print_warning
    # Warn about each file, not only the first.
    warnings.simplefilter("always", OutputWarning)
    try:
        language_of_run(sys.argv[1:])
        sys.exit(_app(*sys.argv[1:2])(standalone_mode=False, prog_name="reportgen") or 0)
    except typer.TyperException as error:
        misused(error)
        sys.exit(WRONG_USAGE)
    except Exception as error:
        # A watched process has little memory: installed libraries may fail to load.
        if WATCHED in os.environ and isinstance(error, (ImportError, MemoryError)):
            os.write(2, LACKING.encode())
        else:
            complain_of_program(error)
        sys.exit(SYSTEM)
    finally:
        announce_normal_end()
        # The memory is freed with the process; no final garbage collection is needed.
        gc.freeze()


def _watch() -> NoReturn:
    """Run this command in another process, and report a lack of memory that kills it."""
    from reportgen.cli.memory_limit import run_watched

    code = run_watched()
    if code is None:
        os.write(2, LACKING.encode())
    sys.exit(3 if code is None else code)


def _leave(*_: object) -> None:
    """Exit at once: before a command begins its work there is nothing to clean up, and imports may be incomplete."""
    os.write(2, STOPPED.encode())
    os._exit(128 + signal.SIGINT)


@cache
def _app(first: str = "") -> typer.Typer:
    """Return the application with all commands, or with one alone if the `first` word of the line is its name.

    Most of the time of a short command would else go into options of the others.
    """
    import typer

    from reportgen.cli.common import begin
    from reportgen.cli.help_texts import Command, Commands

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
    for name in (first,) if first in COMMANDS else COMMANDS:
        made.command(cls=Command)(getattr(import_module(f"reportgen.cli.{COMMANDS[name]}"), name))
    return made


def __getattr__(name: str) -> Any:
    """Return the `app`, created on demand."""
    if name != "app":
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return _app()


def _print_warning(
    message: Warning | str,
    category: type[Warning],
    filename: str,
    lineno: int,
    file: TextIO | None = None,
    line: str | None = None,
) -> None:
    """Print a warning in the form of the command line's other messages."""
    print(f"reportgen: {message}", file=file or sys.stderr)
