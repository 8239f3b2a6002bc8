"""Commands for one assignment: check it, solve it, report it."""

from __future__ import annotations

import itertools
import json
import os
import sys
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from reportgen.base.errors import Fault, Location
from reportgen.base.files import is_stream, put_set, reported, standing
from reportgen.base.output_formats import names
from reportgen.base.template_folders import ATLAS_VARIABLE, machine_files
from reportgen.cli.common import (
    AT_FAULT,
    USUAL_STANDARDS,
    AtlasOption,
    EngineOption,
    File,
    Files,
    LangOption,
    StandardOption,
    TemplatesOption,
    complain,
    ending,
    for_each,
    format_option,
    kept,
    listed,
    refuse,
    refuse_inputs,
    say,
    tell,
    usual_formats,
    write,
)

if TYPE_CHECKING:
    from reportgen.base.units import Language


def build(
    files: Files,
    out: Annotated[Path, typer.Option("--out", metavar="DIR", help="Folder of the reports.")] = Path("out"),
    engine: EngineOption = "typst",
    lang: LangOption = None,
    keep_source: Annotated[bool, typer.Option("--keep-source", help="Also keep the source with its figures.")] = False,
    format: Annotated[str, format_option("report")] = usual_formats("report"),
    extent: Annotated[
        Literal["full", "short"] | None,
        typer.Option("--extent", help="Extent of the report, in place of the file's own.", show_default=False),
    ] = None,
    listing: Annotated[
        bool, typer.Option("--listing", help="Add a Python program of the closed formulas, also as report.py.")
    ] = False,
    standard: StandardOption = USUAL_STANDARDS,
    templates: TemplatesOption = None,
    atlas: AtlasOption = None,
) -> None:
    """Write the complete report of each FILE to DIR/<id>/report.pdf; as .html it is a page, as .docx a Word file."""
    from reportgen import api

    formats = listed(format, api.FORMATS, "--format", "no_format", lang)
    standards = kept(standard, lang)

    def work(file: Path) -> None:
        folder = out / file.stem
        refuse_inputs((*standing(folder, "report"), folder / f"report{api.SUFFIX[engine]}"), files, lang)
        made = api.build_each(
            file, out, engine, lang, keep_source, formats, extent=extent, listing=listing, standards=standards
        )
        tell(made, lang)

    for_each(files, lang, work)


def sheet(
    files: Files,
    size: Annotated[
        Literal["A0", "A1", "A2", "A3"] | None,
        typer.Option("--size", help="Paper size.", show_default="the smallest that holds each set"),
    ] = None,
    sets: Annotated[
        Literal["kinematics", "forces", "balancing", "all"], typer.Option("--set", help="Contents of the sheets.")
    ] = "all",
    every: Annotated[
        bool, typer.Option("--all", help="Include all plans of the report, not only those to hand in.")
    ] = False,
    format: Annotated[str, format_option("sheet")] = usual_formats("sheet"),
    block: Annotated[
        str | None,
        typer.Option(
            "--block",
            metavar="NAME|FILE",
            help="Title block: tcvn, gost, gb, iso, or a file.",
            show_default="that of the language",
        ),
    ] = None,
    out: Annotated[Path, typer.Option("--out", metavar="DIR", help="Folder of the sheets.")] = Path("out"),
    standard: StandardOption = USUAL_STANDARDS,
    lang: LangOption = None,
    templates: TemplatesOption = None,
    atlas: AtlasOption = None,
) -> None:
    """Arrange the plans on drawing sheets, true to scale. The files are DIR/<id>/sheet-1.pdf, sheet-1.dxf, …."""
    from reportgen import api
    from reportgen.base.files import scratch
    from reportgen.base.provenance import hash_of, put_made

    formats = listed(format, api.SHEET_FORMATS, "--format", "no_format", lang)
    standards = kept(standard, lang)

    def work(file: Path) -> None:
        assignment = api.load(file, lang)
        known = api.blocks(assignment)
        path = None if block is None else known.get(block, Path(block))
        if path is not None and not path.exists():
            raise typer.BadParameter(say("no_block", lang, name=block, known=", ".join(known)), param_hint="--block")
        refuse_inputs(standing(out / assignment.id, "sheet"), [*files, path], lang)
        with reported(), scratch(out):
            made = api.sheet_files(
                file,
                engine="typst",
                language=lang,
                size=size or "",
                sets=() if sets == "all" else (sets,),
                formats=formats,
                block=path,
                every=every,
                standards=standards,
            )
            layout = " ".join((size or "", "all" if every else "", hash_of(path) if path else "")).strip()
            of = api.made_of(file, "typst", assignment.language, standards, layout=layout)
            tell(put_made(out / assignment.id, made, "sheet", of), lang)

    for_each(files, lang, work)


def watch(
    file: File,
    no_open: Annotated[bool, typer.Option("--no-open", help="Do not open a browser; print only the address.")] = False,
    pdf: Annotated[bool, typer.Option("--pdf", help="Also renew DIR/<id>/report.pdf.")] = False,
    out: Annotated[Path, typer.Option("--out", metavar="DIR", help="Folder of the PDF.")] = Path("out"),
    lang: LangOption = None,
    templates: TemplatesOption = None,
    atlas: AtlasOption = None,
) -> None:
    """Show the report in a browser and renew it when FILE changes. Ctrl-C ends it."""
    from reportgen.api import serving

    with ending(lang):
        if pdf:
            refuse_inputs(standing(out / file.stem, "report"), [file], lang)
        serving.watch(file, lang, _pdf_writer(file, out) if pdf else None, browser=not no_open)


def edit(
    what: Annotated[
        str | None,
        typer.Argument(metavar="[FILE|KIND]", help="Assignment file, or a kind for a new file.", show_default="choose"),
    ] = None,
    output: Annotated[
        Path | None, typer.Option("-o", "--output", metavar="FILE", help="File to create.", show_default="KIND.yaml")
    ] = None,
    no_open: Annotated[bool, typer.Option("--no-open", help="Do not open a browser; print only the address.")] = False,
    out: Annotated[Path, typer.Option("--out", metavar="DIR", help="Folder of the products.")] = Path("out"),
    lang: LangOption = None,
    templates: TemplatesOption = None,
    atlas: AtlasOption = None,
) -> None:
    """Edit FILE in a browser, with a form beside the moving machine. A KIND creates a new file. Ctrl-C ends it."""
    from reportgen.api import serving
    from reportgen.base.kinds import kinds

    def begin(kind: str, sample: str) -> Path:
        """Return a new file of a kind, or a copy of its sample: the file that was named, or the first free name."""
        name = Path(kind).name
        names = (Path(f"{name}{f'-{number}' if number else ''}.yaml") for number in itertools.count())
        file = output or next(name for name in names if not os.path.lexists(name))
        _begin(kind, file, lang, sample)
        return file

    def products(file: Path) -> dict[str, tuple[str, ...]]:
        return _products(file, out, lang)

    with ending(lang):
        if what is None:
            serving.choose(begin, products, lang, browser=not no_open)
            return
        begins = what in kinds() and not Path(what).exists()
        if output is not None and not begins:
            from reportgen.base.words import unknown

            raise typer.BadParameter(unknown("no_kind", what, list(kinds()), lang), param_hint="KIND")
        file = Path(what)
        if begins:
            file = output or Path(f"{Path(what).name}.yaml")
            _begin(what, file, lang)
        serving.edit(file, products, lang, browser=not no_open)


def _begin(kind: str, file: Path, lang: Language | None, sample: str = "") -> None:
    """Write the first file of a kind, or a copy of its sample, never over an existing one."""
    from reportgen import api
    from reportgen.base.words import spoken

    if os.path.lexists(file):
        refuse([Fault("already-there", Location(str(file)))], file, lang)
    language = lang or spoken()
    write(file, api.example(api.examples(kind)[sample], language) if sample else api.sample(kind, language))


def _products(file: Path, out: Path, lang: Language | None) -> dict[str, tuple[str, ...]]:
    """Return the commands with which the page of a file makes products."""
    spoken = ("--lang", lang) if lang else ()
    commands = {
        "pdf": ("build", "--format", "pdf"),
        "docx": ("build", "--format", "docx"),
        "html": ("build", "--format", "html"),
        "sheet": ("sheet",),
        "key": ("key",),
    }
    begun = (sys.executable, "-m", "reportgen.cli")
    return {name: (*begun, *command, str(file), "--out", str(out), *spoken) for name, command in commands.items()}


def _pdf_writer(path: Path, out: Path) -> Callable[[Callable[[], bytes], Language], None]:
    """Return a function that writes each finished report as PDF, whole or not at all; it reports errors in one line."""
    from reportgen.api import made_of
    from reportgen.base.errors import ReportgenError
    from reportgen.base.provenance import put_made

    def write(pdf_of_report: Callable[[], bytes], language: Language) -> None:
        try:
            pdf = {"report.pdf": pdf_of_report()}
            of = made_of(path, "typst", language)
            tell(put_made(out / path.stem, pdf, "report", of, alone=True), None)
        except ReportgenError as error:
            complain(say("system", language, text=error))

    return write


def solve(
    file: File,
    positions: Annotated[
        int | None,
        typer.Option("--positions", metavar="N", min=4, max=360, help="Positions per turn.", show_default=False),
    ] = None,
    json_file: Annotated[
        Path | None, typer.Option("--json", metavar="FILE|-", help="Write the results as JSON.", show_default=False)
    ] = None,
    format: Annotated[
        str | None,
        typer.Option(
            "--format",
            metavar="LIST",
            help=f"Write the table of a full turn: {', '.join(names('results'))}.",
            show_default=False,
        ),
    ] = None,
    out: Annotated[Path, typer.Option("--out", metavar="DIR", help="Folder of these tables.")] = Path("out"),
    lang: LangOption = None,
    atlas: AtlasOption = None,
) -> None:
    """Compute motion, forces and torque. Print them as tables, or write them as JSON in SI units."""
    from reportgen import api
    from reportgen.base.provenance import put_made

    formats = listed(format, api.RESULT_FORMATS, "--format", "no_format", lang) if format is not None else ()

    with ending(lang):
        tables = standing(out / file.stem, "results") if formats else ()
        refuse_inputs((*tables, *([json_file] if json_file else ())), [file], lang)
        assignment = api.load(file, lang)
        if formats:
            files = api.result_files(file, formats, positions, lang)
            of = api.made_of(file, "", assignment.language)
            tell(put_made(out / file.stem, files, "results", of), lang)
        if formats and json_file is None:
            return
        results = api.solve(assignment, positions, printed=json_file is not None and positions is None)
        if json_file is None:
            api.print_tables(results, assignment.language)
        else:
            text = json.dumps(results, ensure_ascii=False, allow_nan=False, indent=1) + "\n"
            write(json_file, text)


def check(files: Files, lang: LangOption = None, templates: TemplatesOption = None, atlas: AtlasOption = None) -> None:
    """Check each FILE and print its errors and warnings. Without errors, the exit code is 0."""
    from reportgen.catalogue import examine

    problems = [problem for file in files for problem in examine(file, lang)]
    for problem in problems:
        print(problem, file=sys.stderr)
    raise typer.Exit(AT_FAULT if any(problem.level == "error" for problem in problems) else 0)


def new(
    kind: Annotated[
        str, typer.Argument(metavar="KIND", help="A kind of machine, see `kinds`.", autocompletion=lambda: _kinds())
    ],
    output: Annotated[
        Path | None, typer.Option("-o", "--output", metavar="FILE", help="File to write.", show_default=False)
    ] = None,
    example: Annotated[
        str | None,
        typer.Option("--from", metavar="EXAMPLE", help="Start from this example, see `samples`.", show_default=False),
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="Also replace an existing file.")] = False,
    lang: LangOption = None,
    atlas: AtlasOption = None,
) -> None:
    """Print a commented assignment file to fill in, or an example."""
    from reportgen import api
    from reportgen.base.kinds import kinds
    from reportgen.base.words import spoken, unknown

    if kind not in kinds():
        raise typer.BadParameter(unknown("no_kind", kind, list(kinds()), lang))
    examples = api.examples(kind) if example is not None else {}
    if example is not None and example not in examples:
        raise typer.BadParameter(unknown("no_example", example, list(examples), lang), param_hint="--from")
    with ending(lang):
        if output is not None and os.path.lexists(output) and not (force or is_stream(output)):
            refuse([Fault("already-there", Location(str(output)))], output, lang)
        text = api.sample(kind, lang or spoken()) if example is None else api.example(examples[example], lang)
        write(output or Path("-"), text)


def _kinds() -> list[str]:
    from reportgen.base.kinds import kinds

    return list(kinds())


def samples(
    folder: Annotated[Path, typer.Argument(metavar="DIR", help="Destination, usually a new folder.")],
    force: Annotated[bool, typer.Option("--force", help="Also replace existing files.")] = False,
    lang: LangOption = None,
) -> None:
    """Copy the examples, and a class to try, to DIR. Every kind of machine has examples."""
    from reportgen.base.template_folders import samples as packed

    with ending(lang):
        files = {folder / path.relative_to(packed()): path for path in sorted(packed().rglob("*")) if path.is_file()}
        if (there := next(filter(os.path.lexists, files), None)) and not force:
            refuse([Fault("already-there", Location(str(there)))], there, lang)
        with reported(folder):
            for path in files:
                path.parent.mkdir(parents=True, exist_ok=True)
            put_set({path: source.read_bytes() for path, source in files.items()})
        print(folder)


def kinds(lang: LangOption = None, atlas: AtlasOption = None) -> None:
    """List the kinds of assignments, one per line."""
    from reportgen.base.kinds import title
    from reportgen.base.languages import setting_of
    from reportgen.base.translation_coverage import offered
    from reportgen.base.words import spoken

    language, faulty = lang or spoken(), []
    if ATLAS_VARIABLE in os.environ:
        from reportgen import api

        faulty = api.faulty_machines(lang)
        for problem in (*faulty, *api.ignored_machines(lang)):
            print(problem, file=sys.stderr)
    files = {str(machine.location.file) for machine in faulty}
    sound = [kind for kind in offered(language) if not files & {*map(str, machine_files(kind))}]
    known = {kind: title(kind, language) for kind in sound}
    width = max(map(len, known), default=0)
    for kind, called in known.items():
        draft = setting_of(language).is_draft(kind)
        print(f"{kind:{width}}  {say('draft', lang, title=called) if draft else called}")
    raise typer.Exit(AT_FAULT if faulty else 0)


def schema(lang: LangOption = None, atlas: AtlasOption = None) -> None:
    """Print the JSON Schema of the assignment file, for editors, with descriptions in the language."""
    from reportgen import api

    print(json.dumps(api.schema(lang), ensure_ascii=False, indent=2))


HandedIn = Annotated[
    list[Path],
    typer.Argument(
        metavar="SHEET",
        help="Your filled answer sheet, or your report (.docx) and drawings (.dxf).",
        show_default=False,
    ),
]


def compare(
    file: File,
    sheet: HandedIn,
    hint: Annotated[bool, typer.Option("--hint", help="Also give hints.")] = False,
    lang: LangOption = None,
    templates: TemplatesOption = None,
    atlas: AtlasOption = None,
) -> None:
    """Check your own SHEET before handing it in. The first values that do not agree are named, without answers."""
    from reportgen import api

    with ending(lang):
        lines, agrees = api.compare(file, sheet, hint, lang)
        print(*lines, sep="\n")
        raise typer.Exit(0 if agrees else AT_FAULT)


def read(
    file: File,
    report: Annotated[
        list[Path], typer.Argument(metavar="REPORT", help="Report (.docx) and drawings (.dxf).", show_default=False)
    ],
    out: Annotated[Path, typer.Option("--out", metavar="DIR", help="Folder of the results.")] = Path("out"),
    policy: Annotated[
        Path | None,
        typer.Option(
            "--policy", metavar="FILE", help="Policy: the questions and how they are marked.", show_default=False
        ),
    ] = None,
    lang: LangOption = None,
    templates: TemplatesOption = None,
    atlas: AtlasOption = None,
) -> None:
    """Read a REPORT into an answer sheet. DIR/<id>/reading.xlsx lists what was read, and why the rest was not."""
    from reportgen import api

    with ending(lang):
        ask = None if policy is None else api.policy(policy, lang).ask
        written, said = api.read(file, report, out, ask, lang)
        print(f"{written}{said}")
