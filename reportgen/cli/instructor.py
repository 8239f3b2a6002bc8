"""Commands for a whole class: variants, papers, keys, marks."""

from __future__ import annotations

import sys
from collections.abc import Iterable
from pathlib import Path
from typing import Annotated, Any

import typer

from reportgen.base.files import put_files, reported, standing
from reportgen.base.output_formats import PRODUCTS, chosen, names
from reportgen.cli.common import (
    AT_FAULT,
    INTERRUPTED,
    USUAL_STANDARDS,
    AtlasOption,
    EngineOption,
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
    offered,
    refuse_inputs,
    say,
    tell,
    usual_formats,
)

PolicyOption = Annotated[
    Path | None,
    typer.Option("--policy", metavar="FILE", help="Policy: the questions and how they are marked.", show_default=False),
]
Roster = Annotated[Path, typer.Argument(metavar="ROSTER", help="The class list, CSV or XLSX.", show_default=False)]
OnePdfOption = Annotated[
    bool, typer.Option("--one-pdf", help="Also bind the PDFs of the class into one, for each product.")
]
MakeOption = Annotated[str, typer.Option("--make", help=offered(product.name for product in PRODUCTS))]
USUAL_PRODUCTS = ",".join(product.name for product in PRODUCTS if product.usual)
SharedOption = Annotated[
    list[Path] | None,
    typer.Option(
        "--shared",
        metavar="DIR",
        exists=True,
        file_okay=False,
        help="Further folder for tables that SPEC names; repeatable.",
        show_default=False,
    ),
]


def variants(
    spec: Annotated[Path, typer.Argument(metavar="SPEC", help="Assignment file with choices.", show_default=False)],
    roster: Roster,
    out: Annotated[Path, typer.Option("-o", "--out", metavar="DIR", help="Folder of the assignment files.")] = Path(
        "out/variants"
    ),
    force: Annotated[bool, typer.Option("--force", help="Also replace files edited by hand.")] = False,
    format: Annotated[str, format_option("variants")] = usual_formats("variants"),
    policy: PolicyOption = None,
    lang: LangOption = None,
    atlas: AtlasOption = None,
    shared: SharedOption = None,
    redraw: Annotated[
        list[str] | None,
        typer.Option(
            "--redraw", metavar="ID", help="Draw another variant for this student; repeatable.", show_default=False
        ),
    ] = None,
    drop: Annotated[
        list[str] | None,
        typer.Option("--drop", metavar="ID", help="This student has left the class; repeatable.", show_default=False),
    ] = None,
) -> None:
    """Draw a variant for each student of a class. It is frozen into DIR/<id>.yaml.

    With --format moodle-xml a bank of questions for a Moodle quiz goes to DIR/questions.xml, too.
    """
    from reportgen import api
    from reportgen.classes.variants import make_variants

    formats = listed(format, names("variants"), "--format", "no_format", lang)
    # A format with its own file name gives one file for the class.
    banks = {f"{row.stem}.{row.suffix}": row for row in chosen("variants", formats) if row.stem}
    with ending(lang):
        refuse_inputs([out / name for name in banks], [spec, roster, policy], lang)
        rules = api.policy(policy, lang)
        made = make_variants(
            spec, roster, out, force, lang, _bar, shared=shared or (), redraw=redraw or (), drop=drop or ()
        )
        print(
            *(path for file in made.files for path in (file.path, *file.parts)),
            *(("", *made.summary) if made.summary else ()),
            sep="\n",
        )
        print(*made.remarks, sep="\n", end="\n" * bool(made.remarks), file=sys.stderr)
        for name, row in banks.items():
            bank = row.load()([file.path for file in made.files], rules, spec.stem, lang)
            print(*put_files(out, {name: bank}), sep="\n")


def _bar(things: Iterable[Any], count: int) -> Iterable[Any]:
    """Show the progress over the things on a terminal."""
    from rich.console import Console
    from rich.progress import track

    return track(things, "", count, console=Console(stderr=True), transient=True) if sys.stderr.isatty() else things


def batch(
    roster: Roster,
    spec: Annotated[
        Path | None,
        typer.Option(
            "--spec",
            metavar="SPEC.yaml",
            help="Assignment file with choices, from which variants are drawn.",
            show_default=False,
        ),
    ] = None,
    assignments: Annotated[
        Path | None, typer.Option("--assignments", metavar="DIR", help="Assignment files by id.", show_default=False)
    ] = None,
    make: MakeOption = USUAL_PRODUCTS,
    jobs: Annotated[
        int | None, typer.Option("--jobs", metavar="N", min=1, help="Number of processes.", show_default="one a core")
    ] = None,
    engine: EngineOption = "typst",
    lang: LangOption = None,
    out: Annotated[Path, typer.Option("--out", metavar="DIR", help="Folder of the results.")] = Path("out"),
    cluster: Annotated[
        str | None, typer.Option("--cluster", metavar="ADDRESS", help="Address of a Dask scheduler.")
    ] = None,
    policy: PolicyOption = None,
    shared: SharedOption = None,
    standard: StandardOption = USUAL_STANDARDS,
    templates: TemplatesOption = None,
    atlas: AtlasOption = None,
    one_pdf: OnePdfOption = False,
) -> None:
    """Make tasks, reports, keys or sheets of a whole class. It goes on where an earlier run was stopped."""
    from reportgen import api
    from reportgen.classes.batch_manifest import NAME
    from reportgen.classes.batch_run import Order, run_batch
    from reportgen.classes.one_pdf import bind_products

    if (spec is None) == (assignments is None):
        raise typer.BadParameter(say("one_of_spec", lang))
    products = listed(make, api.MAKERS, "--make", "no_product", lang)
    standards = kept(standard, lang)
    with ending(lang):
        made = (
            path
            for kind in {product.files or product.name for product in PRODUCTS}
            for path in standing(out, kind, "*/")
        )
        refuse_inputs((out / NAME, *made), [roster, spec, policy], lang)
        ask = None if policy is None else api.policy(policy, lang).ask
        order = Order(
            roster=roster,
            spec=spec,
            assignments=assignments,
            out=out,
            products=products,
            engine=engine,
            language=lang,
            jobs=jobs or 0,
            cluster=cluster,
            ask=ask,
            shared=tuple(shared or ()),
            standards=standards,
        )
        try:
            result = run_batch(order, sys.stderr)
        except KeyboardInterrupt:
            complain(say("batch_stopped", lang))
            raise typer.Exit(INTERRUPTED) from None
        print(*result.summary(lang), sep="\n", file=sys.stderr)
        print(result.manifest, flush=True)
        if one_pdf:
            print(*bind_products(out, result.students, products), sep="\n")
        raise typer.Exit(result.exit_code)


def key(
    files: Files,
    format: Annotated[str, format_option("key")] = usual_formats("key"),
    out: Annotated[Path, typer.Option("--out", metavar="DIR", help="Folder of the keys.")] = Path("out"),
    engine: EngineOption = "typst",
    lang: LangOption = None,
    policy: PolicyOption = None,
    standard: StandardOption = USUAL_STANDARDS,
    templates: TemplatesOption = None,
    atlas: AtlasOption = None,
) -> None:
    """Write the answer key of each FILE. It has every value with the bands within which it is right, in DIR/<id>/."""
    from reportgen import api
    from reportgen.base.files import scratch
    from reportgen.base.provenance import put_made

    formats = listed(format, api.KEY_FORMATS, "--format", "no_format", lang)
    standards = kept(standard, lang)

    with ending(lang):
        made = (path for file in files for path in standing(out / file.stem, "key"))
        refuse_inputs(made, [*files, policy], lang)
        ask = None if policy is None else api.policy(policy, lang).ask
        api.check_ask(ask, files, lang)

    def work(file: Path) -> None:
        with reported(out), scratch(out):
            made = api.key_files(file, engine, lang, formats, ask, standards)
        of = api.made_of(file, engine, lang, standards, ask="" if ask is None else str(ask))
        tell(put_made(out / file.stem, made, "key", of), lang)

    for_each(files, lang, work)


def grade(
    submissions: Annotated[
        list[Path],
        typer.Argument(
            metavar="SUBMISSION",
            help="Sheets, reports, folders, or downloads of a learning platform.",
            show_default=False,
        ),
    ],
    assignments: Annotated[
        Path, typer.Option("--assignments", metavar="DIR", help="Assignment files of the class.", show_default=False)
    ],
    policy: PolicyOption = None,
    out: Annotated[Path, typer.Option("--out", metavar="DIR", help="Folder of the results.")] = Path("out/marked"),
    engine: EngineOption = "typst",
    lang: LangOption = None,
    roster: Annotated[
        Path | None, typer.Option("--roster", metavar="FILE", help="The class list, for the names.", show_default=False)
    ] = None,
    gradebook: Annotated[
        Path | None,
        typer.Option(
            "--gradebook", metavar="FILE", help="Table of a learning platform to fill in.", show_default=False
        ),
    ] = None,
    corrections: Annotated[
        Path | None,
        typer.Option(
            "--corrections", metavar="FILE", help="Your corrections of marks, CSV or XLSX.", show_default=False
        ),
    ] = None,
    column: Annotated[
        str,
        typer.Option(
            "--column", metavar="NAME", help="Column of the gradebook for this assignment.", show_default=False
        ),
    ] = "",
    standard: StandardOption = USUAL_STANDARDS,
    templates: TemplatesOption = None,
    atlas: AtlasOption = None,
    one_pdf: OnePdfOption = False,
) -> None:
    """Mark sheets, or reports, from each student's own values. Feedback, grades.csv and the class page are written."""
    from reportgen import api
    from reportgen.classes import class_marking, class_outputs
    from reportgen.classes.corrections import read_corrections
    from reportgen.classes.gradebooks import read_gradebook
    from reportgen.classes.platforms import files_read

    standards = kept(standard, lang)
    with ending(lang):
        made = (*standing(out, "feedback", "*/"), *standing(out, "class"))
        filled = () if gradebook is None else (class_outputs.filled_gradebook(gradebook, out),)
        refuse_inputs((*made, *filled), [*files_read(submissions), policy, roster, gradebook, corrections], lang)
        rules = api.policy(policy, lang)
        # Errors in these files must be reported before an hour of marking, not after it.
        table = None if gradebook is None else read_gradebook(gradebook, column, lang)
        judged = () if corrections is None else read_corrections(corrections, lang)
        graded = class_marking.grade(
            submissions, assignments, rules, lang, roster, corrections=judged, gradebook=table, out=out
        )
        problems = list(graded.problems)
        lines = dict(class_outputs.student_lines(graded, lang))
        for path in class_outputs.put(graded, rules, out, engine, lang, standards, problems=problems):
            # One line a student, as soon as the student's files are written.
            line = str(path) if path.parent == out else lines.pop(path.parent.relative_to(out), None)
            if line is not None:
                print(line, flush=True)
        print(*lines.values(), sep="\n", end="\n" * bool(lines))
        if one_pdf:
            print(*class_outputs.put_one_pdf(graded, out), sep="\n", flush=True)
        if table is not None:
            written, unknown = class_outputs.put_gradebook(graded, table, rules, out, lang)
            print(written, flush=True)
            problems += unknown
        for line in class_outputs.without_marks(graded, lang):
            print(line)
        print(*problems, sep="\n", end="\n" * bool(problems), file=sys.stderr)
        raise typer.Exit(AT_FAULT if any(one.level == "error" for one in problems) else 0)
