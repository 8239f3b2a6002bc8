"""The command line: parse, call, print, end with the right code; no logic of its own.

Exit codes: 0 done · 1 an input file is at fault · 2 wrong usage · 3 the typesetter or the system failed.
"""

from __future__ import annotations

import io
import json
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


@app.command()
def build(
    files: Files,
    out: Annotated[Path, typer.Option("--out", metavar="DIR", help="Folder of the reports.")] = Path("out"),
    engine: Annotated[Engine, typer.Option("--engine", help="Typesetter.")] = Engine.typst,
    lang: LangOption = None,
    keep_source: Annotated[
        bool, typer.Option("--keep-source", help="Also leave the source with its figures.")
    ] = False,
) -> None:
    """Write the complete report of each FILE to DIR/<id>/report.pdf."""
    _refuse_same_names(files, _language(lang))
    from reportgen import api

    code = 0
    for file in files:
        with _outcome(lang) as outcome:
            print(api.build(file, out, _typesetter(engine), _language(lang), keep_source), flush=True)
        code = max(code, outcome.code)
    raise typer.Exit(code)


@app.command()
def solve(
    file: File,
    positions: Annotated[
        int | None,
        typer.Option(
            "--positions", metavar="N", min=4, max=360, help="Positions a turn.", show_default=False
        ),
    ] = None,
    json_file: Annotated[
        Path | None,
        typer.Option("--json", metavar="FILE|-", help="Write the results as JSON.", show_default=False),
    ] = None,
    lang: LangOption = None,
) -> None:
    """Compute motion, forces and torque; print readable tables, or JSON in SI units."""
    from reportgen import api
    from reportgen.tables import print_tables

    with _outcome(lang) as outcome:
        assignment = api.load(file, _language(lang))
        results = api.solve(assignment, positions)
        if json_file is None:
            print_tables(results, assignment.language)
        else:
            text = json.dumps(results, ensure_ascii=False, allow_nan=False, indent=1) + "\n"
            _write(json_file, text)
    raise typer.Exit(outcome.code)


@app.command()
def check(files: Files, lang: LangOption = None) -> None:
    """Validate each FILE; silent when all is well."""
    from reportgen import api

    problems = [problem for file in files for problem in api.check(file, _language(lang))]
    for problem in problems:
        print(problem, file=sys.stderr)
    raise typer.Exit(AT_FAULT if problems else 0)


@app.command()
def variants(
    spec: Annotated[Path, typer.Argument(metavar="SPEC", help="Assignment file with choices.", show_default=False)],
    roster: Annotated[Path, typer.Argument(metavar="ROSTER", help="The class, CSV or XLSX.", show_default=False)],
    out: Annotated[
        Path, typer.Option("-o", "--out", metavar="DIR", help="Folder of the assignment files.")
    ] = Path("out/variants"),
    force: Annotated[bool, typer.Option("--force", help="Also replace files edited by hand.")] = False,
    lang: LangOption = None,
) -> None:
    """Draw a variant for each student of ROSTER and freeze it into DIR/<id>.yaml."""
    from reportgen.batch.variants import make_variants

    with _outcome(lang) as outcome:
        made = make_variants(spec, roster, out, force, _language(lang))
        print(*(file.path for file in made.files), "", *made.summary, sep="\n")
        print(*made.remarks, sep="\n", end="\n" * bool(made.remarks), file=sys.stderr)
    raise typer.Exit(outcome.code)


@app.command()
def new(
    kind: Annotated[str, typer.Argument(metavar="KIND", help="A kind of machine, see `kinds`.")],
    output: Annotated[
        Path | None, typer.Option("-o", "--output", metavar="FILE", help="Write here.", show_default=False)
    ] = None,
    lang: LangOption = None,
) -> None:
    """Print a commented assignment file to fill in."""
    from reportgen import catalogue
    from reportgen.assignment.messages import word

    language = _language(lang) or "vi"
    if kind not in catalogue.MODULES:
        known = ", ".join(catalogue.MODULES)
        raise typer.BadParameter(word("no_kind", language).format(kind=kind, known=known))
    with _outcome(lang) as outcome:
        _write(output or Path("-"), catalogue.sample(kind, language))
    raise typer.Exit(outcome.code)


@app.command()
def kinds(lang: LangOption = None) -> None:
    """List the machines that are known, a line each."""
    from reportgen import catalogue

    titles = catalogue.titles(_language(lang) or "vi")
    width = max(map(len, titles))
    for kind, title in titles.items():
        print(f"{kind:{width}}  {title}")


@app.command()
def schema() -> None:
    """Print the JSON Schema of the assignment file, for editors."""
    from reportgen import catalogue

    print(json.dumps(catalogue.schema(), ensure_ascii=False, indent=2))


@app.command()
def batch(
    roster: Annotated[
        Path, typer.Argument(metavar="ROSTER", help="The class, CSV or XLSX.", show_default=False)
    ],
    spec: Annotated[
        Path | None,
        typer.Option("--spec", metavar="SPEC.yaml", help="Draw the variants of this.", show_default=False),
    ] = None,
    assignments: Annotated[
        Path | None,
        typer.Option("--assignments", metavar="DIR", help="Assignment files by id.", show_default=False),
    ] = None,
    make: Annotated[str, typer.Option("--make", help="What to make, parted by commas.")] = "report",
    jobs: Annotated[
        int | None, typer.Option("--jobs", metavar="N", min=1, help="Processes.", show_default="one a core")
    ] = None,
    engine: Annotated[Engine, typer.Option("--engine", help="Typesetter.")] = Engine.typst,
    lang: LangOption = None,
    out: Annotated[Path, typer.Option("--out", metavar="DIR", help="Folder of the results.")] = Path("out"),
    cluster: Annotated[
        str | None,
        typer.Option("--cluster", metavar="ADDRESS", help="A Dask scheduler to work for us."),
    ] = None,
) -> None:
    """Make task, report or key of everybody on ROSTER; go on where an earlier run was stopped."""
    from reportgen.assignment.messages import word
    from reportgen.products import MAKERS
    from reportgen.batch.start import Order, start, told

    language = _language(lang) or "vi"
    products = tuple(dict.fromkeys(name.strip() for name in make.split(",")))
    if (spec is None) == (assignments is None):
        raise typer.BadParameter(word("one_of_spec", language))
    for name in products:
        if name not in MAKERS:
            raise typer.BadParameter(
                word("no_product", language).format(text=name, known=", ".join(MAKERS)), param_hint="--make"
            )
    order = Order(
        roster, spec, assignments, out, products, _typesetter(engine), _language(lang), jobs or 0, cluster
    )
    with _outcome(lang) as outcome:
        try:
            done = start(order, sys.stderr)
        except KeyboardInterrupt:
            _complain("batch_stopped", lang)
            raise typer.Exit(INTERRUPTED) from None
        print(*told(done, language), sep="\n", file=sys.stderr)
        print(done.result.manifest, flush=True)
        outcome.code = done.result.exit_code
    raise typer.Exit(outcome.code)


class _Outcome:
    """The exit code of a piece of work."""

    code = 0


@contextmanager
def _outcome(lang: Lang | None) -> Iterator[_Outcome]:
    """Prints what goes wrong inside, never a traceback, and remembers the exit code it means."""
    outcome = _Outcome()
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
        _complain("system", lang, text=str(fault))
        outcome.code = SYSTEM
    except (typer.Exit, typer.BadParameter):
        raise
    except Exception as fault:
        _unexpected(fault, lang)
        outcome.code = SYSTEM


def _unexpected(fault: BaseException, lang: Lang | None = None) -> None:
    _complain("unexpected", lang, name=type(fault).__name__, text=" ".join(str(fault).split()))


def _complain(name: str, lang: Lang | None, /, **arguments: str) -> None:
    from reportgen.assignment.messages import word

    print(f"reportgen: {word(name, _language(lang) or 'vi').format(**arguments)}", file=sys.stderr)


def _language(lang: Lang | None) -> Language | None:
    return None if lang is None else "en" if lang is Lang.en else "vi"


def _typesetter(engine: Engine) -> Literal["typst", "latex"]:
    return "latex" if engine is Engine.latex else "typst"


def _refuse_same_names(files: list[Path], language: Language | None) -> None:
    """Two files of one name would write to one folder."""
    from reportgen.assignment.messages import word

    seen: dict[str, Path] = {}
    for file in files:
        if file.stem in seen:
            text = word("same_name", language or "vi")
            raise typer.BadParameter(text.format(first=seen[file.stem], second=file))
        seen[file.stem] = file


def _write(path: Path, text: str) -> None:
    """To standard output for `-`; else to the file, which is replaced only once all is written."""
    from reportgen import api

    if str(path) == "-":
        sys.stdout.write(text)
    else:
        api.replace(path, text.encode())


def main() -> None:
    """Entry point of the `reportgen` command."""
    for stream in (sys.stdout, sys.stderr):
        # Vietnamese must not fail on a terminal or pipe of another encoding.
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(encoding="utf-8", errors="backslashreplace")
    try:
        app()
    except Exception as fault:
        _unexpected(fault)
        sys.exit(SYSTEM)


if __name__ == "__main__":
    main()
