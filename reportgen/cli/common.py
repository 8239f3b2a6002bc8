"""Shared parts of all commands: options, language, error messages and exit codes."""

from __future__ import annotations

import os
import re
import signal
import sys
from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal, get_args, get_origin, get_type_hints

import typer
from typer.core import TyperGroup

from reportgen.base import output_formats
from reportgen.base.errors import AssignmentError, Fault, ReportgenError
from reportgen.base.files import is_stream, overwritten, put_file, write_stream
from reportgen.base.files import version as own_version
from reportgen.base.pdf_standards import KNOWN, NONE, STANDARDS, Standards
from reportgen.base.template_folders import ATLAS_VARIABLE, Language, languages

if TYPE_CHECKING:
    from reportgen.base.provenance import Put

AT_FAULT, WRONG_USAGE, SYSTEM, INTERRUPTED = 1, 2, 3, 130
ENDED = frozenset({"SIGTERM", "SIGHUP"})
"""Signals that end a command with cleanup, if the system has them."""
ASSIGNMENTS = frozenset({".yaml", ".yml"})
"""Suffixes of assignment files."""

File = Annotated[Path, typer.Argument(metavar="FILE", help="Assignment file.", show_default=False)]
Files = Annotated[list[Path], typer.Argument(metavar="FILE", help="Assignment files.", show_default=False)]
if TYPE_CHECKING:
    NamedLanguage = Language
else:
    # As a type of choices, the option lists the languages in its help, its completion and its errors.
    NamedLanguage = Literal[languages()]
LangOption = Annotated[
    NamedLanguage | None, typer.Option("--lang", help="Language, instead of the file's own.", show_default=False)
]
TemplatesOption = Annotated[
    Path | None,
    typer.Option(
        "--templates",
        metavar="DIR",
        envvar="REPORTGEN_TEMPLATES",
        exists=True,
        file_okay=False,
        help="Folder with a school's own templates.",
        show_default=False,
        callback=lambda folder: _use("REPORTGEN_TEMPLATES", folder),
    ),
]
AtlasOption = Annotated[
    Path | None,
    typer.Option(
        "--atlas",
        metavar="DIR",
        envvar=ATLAS_VARIABLE,
        exists=True,
        file_okay=False,
        help="Folder with machines of your own.",
        show_default=False,
        callback=lambda folder: _use(ATLAS_VARIABLE, folder),
    ),
]
EngineOption = Annotated[Literal["typst", "latex"], typer.Option("--engine", help="Typesetter.")]
StandardOption = Annotated[
    str,
    typer.Option(
        "--standard",
        metavar="LIST",
        help="Standards that a PDF of typst follows: of ua-1, a-2a, …, separated by commas, or none.",
    ),
]
USUAL_STANDARDS = ",".join(STANDARDS)


def offered(known: Iterable[str]) -> str:
    """Return the help of an option that takes a list of names.

    Its translation is found by the words around the names.
    """
    return f"Of {', '.join(known)}; separated by commas."


def format_option(product: str) -> Any:
    """Return the option `--format` of a command that writes a product in the formats of the table."""
    return typer.Option("--format", metavar="LIST", help=offered(output_formats.names(product)))


def usual_formats(product: str) -> str:
    """Return the default formats of a product, as its option writes them."""
    return ",".join(output_formats.usual(product))


def _use(variable: str, folder: Path | None) -> Path | None:
    """Set a folder of words or of machines for the whole run, in all processes that it starts."""
    if folder is not None:
        os.environ[variable] = str(folder.absolute())
    return folder


def begin(
    context: typer.Context,
    version: Annotated[bool, typer.Option("--version", help="Print the version.", is_eager=True)] = False,
    lang: LangOption = None,
) -> None:
    """Coursework reports in the Theory of Machines from one assignment file."""
    if lang is not None:
        assert isinstance(context.command, TyperGroup), "only a group has commands"
        # A command that has an option of this name takes it from here unless its own is given.
        context.default_map = {name: {"lang": lang} for name in context.command.commands}
    if version:
        print("reportgen", own_version())
    elif context.invoked_subcommand is None:
        from reportgen.cli.help_texts import start
        from reportgen.cli.own_console import is_double_clicked

        if is_double_clicked():
            _choose(context)
        else:
            print(start())


def _choose(context: typer.Context) -> None:
    """Start `edit` without arguments for a double click; its file goes to the home folder, never beside the program."""
    if Path.cwd() == Path(sys.argv[0]).absolute().parent:
        os.chdir(Path.home())
    assert isinstance(context.command, TyperGroup), "only a group has commands"
    context.invoke(context.command.commands["edit"])


@contextmanager
def ending(lang: Language | None) -> Iterator[None]:
    """Print errors raised inside, never a traceback, and exit with the matching code."""
    if signal.getsignal(signal.SIGINT) is not signal.SIG_IGN:
        # From here on there is something to clean up.
        signal.signal(signal.SIGINT, signal.default_int_handler)
    for name in ENDED & {*dir(signal)}:
        if signal.getsignal(number := getattr(signal, name)) is signal.SIG_DFL:
            signal.signal(number, lambda number, _: sys.exit(128 + number))
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
    except ImportError:
        raise
    except Exception as error:
        complain_of_program(error, lang)
        code = SYSTEM
    else:
        return
    raise typer.Exit(code)


def for_each(files: list[Path], lang: Language | None, work: Callable[[Path], None]) -> None:
    """Do the work for every file, whatever happens to the others, and exit with the highest exit code.

    Files with the same name, which would write to the same folder, are wrong usage.
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
    """Print a message on standard error, after the name of the program."""
    print(f"reportgen: {text}", file=sys.stderr)


def complain_of_program(error: BaseException, lang: Language | None = None) -> None:
    """Report an unexpected exception as a bug of the program."""
    from reportgen.base.words import unexpected

    complain(unexpected(error, lang))


def say(key: str, lang: Language | None, /, **arguments: object) -> str:
    """Return a text of the message table in the language of the command line."""
    from reportgen.base.words import word

    return word(key, lang, **arguments)


def tell(put: Put, lang: Language | None) -> None:
    """Print the paths of written files; report which stale files were deleted, and which were kept."""
    print(*put.paths, sep="\n", flush=True)
    for key, paths in (("stale_gone", put.gone), ("stale_left", put.left)):
        for path in paths:
            complain(say(key, lang, path=path))


def listed(text: str, known: Collection[str], option: str, complaint: str, lang: Language | None) -> tuple[str, ...]:
    """Return the names in a list separated by commas, each once; a name that is not `known` is wrong usage."""
    names = tuple(dict.fromkeys(name.strip() for name in text.split(",")))
    for name in names:
        if name not in known:
            from reportgen.base.words import unknown

            raise typer.BadParameter(unknown(complaint, name, list(known), lang), param_hint=option)
    return names


def kept(standard: str, lang: Language | None) -> Standards:
    """Return the standards that an option names; () for `none`, which cannot be combined with others."""
    names = listed(standard, (NONE, *KNOWN), "--standard", "no_standard", lang)
    if NONE in names and len(names) > 1:
        raise typer.BadParameter(say("no_standard", lang, text=standard), param_hint="--standard")
    return () if NONE in names else names


def refuse_inputs(outputs: Iterable[Path], inputs: Sequence[Path | None], lang: Language | None) -> None:
    """Raise `AssignmentError` if a command would overwrite one of its inputs; called before anything else."""
    given = [path for path in inputs if path is not None]
    refuse(overwritten(outputs, given), given[0], lang)


def refuse(faults: Iterable[Fault], file: Path, lang: Language | None) -> None:
    """Raise `AssignmentError` with these faults, if there are any, in the language of a file."""
    if listed := list(faults):
        from reportgen.base.words import as_error, language_of
        from reportgen.base.yaml_source import read_source

        raise as_error(listed, lang or language_of(read_source(file)))


def write(path: Path, text: str) -> None:
    """Write to standard output for `-`, to a pipe or a device, or else to the file, replaced only when complete."""
    if str(path) == "-":
        sys.stdout.write(text)
    elif is_stream(path):
        write_stream(path, text.encode())
    else:
        put_file(path, text.encode())


# --- in which language ------------------------------------------------------------------------------


def language_of_run(arguments: Sequence[str]) -> None:
    """Set the language of a command line: that of `--lang`, else that of the first assignment that it names.

    For a folder, use the first assignment file in it; if there is none, the locale decides.
    """
    from reportgen.base.words import speak

    if language := next(_asked_for(arguments), None):
        speak(language)


def _asked_for(arguments: Sequence[str]) -> Iterator[Language]:
    from reportgen.base.words import language_of
    from reportgen.base.yaml_source import Source, text_in

    line = " ".join(arguments).replace("--lang=", "--lang ")
    yield from (language for language in languages() if re.search(rf"(^| )--lang {language}( |$)", line))
    for path in map(Path, arguments):
        # The reader reports a text that is not a path at all.
        with suppress(OSError, ValueError):
            for file in sorted(path.glob("*.y*ml"))[:1] if path.is_dir() else [path]:
                text = text_in(file) if file.suffix.lower() in ASSIGNMENTS else ""
                if isinstance(text, str) and re.search(r"^kind:", text, re.MULTILINE):
                    yield language_of(Source(str(file), text))


# --- wrong usage ------------------------------------------------------------------------------------


def misused(error: Any) -> None:
    """Report an error of a command line, and where its help is.

    typer's own messages are only in English, so its errors are distinguished by their attributes.
    """
    complain(_usage_message(error))
    if error.ctx is not None:
        complain(say("see_help", None, command=f"{error.ctx.command_path} -h"))


def _usage_message(error: Any) -> str:
    from reportgen.base.words import unknown

    if hasattr(error, "possibilities"):
        known = [name for one in error.ctx.command.params for name in one.opts if name.startswith("-")]
        return unknown("no_option", error.option_name, known, None)
    if hasattr(error, "option_name"):
        given = any(argument.startswith(f"{error.option_name}=") for argument in sys.argv)
        return say("option_alone" if given else "option_needs", None, option=error.option_name)
    if not hasattr(error, "param_hint"):
        extra = re.search(r" \((.*)\)$", error.message)
        return say("extra_arguments", None, text=extra[1] if extra else error.message)
    if error.param is None:
        return f"{error.param_hint}: {error.message}" if error.param_hint else str(error.message)
    name = error.param.metavar if error.param.param_type_name == "argument" else error.param.opts[0]
    return say("missing_argument", None, name=name) if hasattr(error, "param_type") else f"{name}: {_allowed(error)}"


def _allowed(error: Any) -> str:
    """Return what the parameter of an error accepts, from the types of the command's own parameters."""
    hint = get_type_hints(error.ctx.command.callback, include_extras=True)[error.param.name]
    choices = [choice for one in _within(hint) if get_origin(one) is Literal for choice in get_args(one)]
    if choices:
        return say("takes_one_of", None, known=", ".join(choices))
    least, most = error.param.min, error.param.max
    if least is None:
        return say("takes_folder", None)
    return say("takes_number", None, least=least) if most is None else say("takes_range", None, least=least, most=most)


def _within(hint: Any) -> Iterator[Any]:
    """Yield a type and all types that it consists of."""
    yield hint
    if get_origin(hint) is not Literal:
        for inner in get_args(hint):
            yield from _within(inner)
