"""Functions for scripts and the command line: load, check, solve, build, and the makers of report, task and key.

The complete pipeline is file → `Assignment` → `Machine` → `Analysis` → `Ledger` → `Document` → PDF. Everything before
the document is in a `Case`.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

from reportgen import catalogue
from reportgen.api import typesetting
from reportgen.api.format_writers import KeyJob, ReportJob, SheetJob, dated, word_file
from reportgen.api.report_fonts import Engine as Engine
from reportgen.api.report_fonts import letter_of as letter_of
from reportgen.api.typesetting import reading_ahead
from reportgen.assignment import Assignment
from reportgen.assignment.common import Extent
from reportgen.assignment.reading import inputs
from reportgen.base import provenance
from reportgen.base.errors import NotOfferedError, ReportgenError
from reportgen.base.files import put_files, reported, scratch, version
from reportgen.base.output_formats import ENGINE, PRODUCTS, chosen, names, usual
from reportgen.base.pdf_standards import STANDARDS, Standards, other_than_usual
from reportgen.base.progress import step
from reportgen.base.records import replace
from reportgen.base.units import Language
from reportgen.base.words import templates_hash, word
from reportgen.case import bounded
from reportgen.cases import MachineCase, open_case, opened

if TYPE_CHECKING:
    from reportgen.case.answer_key import Key
    from reportgen.document import Document
    from reportgen.machine.analysis import Analysis
    from reportgen.marking.marking_policy import Policy
    from reportgen.marking.toleranced_key import Ask

FORMATS = names("report")
"""Formats of a report."""


load, check, examine, assess = catalogue.load, catalogue.check, catalogue.examine, catalogue.assess
faulty_machines = catalogue.faulty_machines
ignored_machines = catalogue.ignored_machines
schema, sample, examples, example = catalogue.schema, catalogue.sample, catalogue.examples, catalogue.example
typeset, typeset_sheet, SUFFIX = (typesetting.typeset, typesetting.typeset_sheet, typesetting.SUFFIX)


def analyse(assignment: Assignment) -> Analysis:
    """Return everything computed for an assignment, as arrays over its positions."""
    return MachineCase(assignment).analysis


def solve(assignment: Assignment, positions: int | None = None, printed: bool = False) -> dict[str, Any]:
    """Return the results as the contract's JSON object (SI, unrounded); `positions` overrides the count per turn.

    With `printed`, it also has the values that the report prints, if there is a report. Raises `NotOfferedError` for
    positions of an exercise, which is one instant.
    """
    from reportgen.results import printed_values, results

    if positions is not None and not catalogue.kind(assignment.kind).counts_positions:
        raise NotOfferedError(word("no_positions", assignment.language, kind=assignment.kind))
    chosen = assignment if positions is None else assignment.with_positions(positions)
    case = opened(chosen)
    solution = results(case)
    if printed:
        with suppress(NotOfferedError):
            solution["printed"] = printed_values(case.printed)
    return solution


def print_tables(results: Mapping[str, Any], language: Language) -> None:
    """Print results as tables on a terminal."""
    from reportgen.results import terminal_tables

    terminal_tables.print_tables(results, language)


RESULT_FORMATS = names("results")
DEGREES_OF_A_TURN = 360
"""Number of positions in the table of a full turn."""


def result_files(
    path: Path | str, formats: Sequence[str], positions: int | None = None, language: Language | None = None
) -> Mapping[str, bytes]:
    """Return the results of a full turn in some of `RESULT_FORMATS`, by degrees unless `positions` is given.

    A CSV file has only one table, so each part of a coursework has a further file, such as results-cam.csv.
    """
    assignment = load(path, language)
    wanted = positions or (DEGREES_OF_A_TURN if catalogue.kind(assignment.kind).counts_positions else None)
    results = solve(assignment, wanted)
    rows = chosen("results", formats)
    files = {f"results.{row.suffix}": row.load()(results) for row in rows}
    parts = results.get("parts", {}).items()
    return files | {
        f"results-{part}.{row.suffix}": row.load()(part_results)
        for row in rows
        if row.per_part
        for part, part_results in parts
    }


def document(assignment: Assignment) -> Document:
    """Return the report as a numbered tree, ready for any writer."""
    return opened(assignment).document()


def build(
    path: Path | str,
    out: Path | str = "out",
    engine: Engine = "typst",
    language: Language | None = None,
    keep_source: bool = False,
    formats: Sequence[str] = usual("report"),
    extent: Extent | None = None,
    listing: bool = False,
    standards: Standards = STANDARDS,
) -> Path:
    """Write the complete report to `out`/<id>/report.pdf and return that path; with several formats, that of the first.

    Language and extent are those of the file unless others are given. A `listing` adds a program of the closed
    formulas, which is also written as report.py; raises `NotOfferedError` if there are none. A PDF by typst conforms to
    the `standards`. Files are written whole or not at all. Raises `AssignmentError`, `TemplateError`,
    `TypesetterError`, `OutputError`.
    """
    put = build_each(
        path, out, engine, language, keep_source, formats, extent=extent, listing=listing, standards=standards
    )
    return put.paths[0]


def build_each(
    path: Path | str,
    out: Path | str,
    engine: Engine,
    language: Language | None,
    keep_source: bool,
    formats: Sequence[str],
    extent: Extent | None = None,
    listing: bool = False,
    standards: Standards = STANDARDS,
) -> provenance.Put:
    """Write the complete report in some of `FORMATS`; return the paths in that order, and the fate of other files."""
    from reportgen.document import Listing

    assignment = load(path, language)
    if extent is not None:
        assignment = assignment.with_extent(extent)
    if listing:
        assignment = assignment.with_listing()
    rows = chosen("report", formats)
    letter = letter_of(assignment, engine) if any(ENGINE in row.needs for row in rows) else None
    files: dict[str, bytes] = {}
    with reported(), scratch(Path(out)), reading_ahead(assignment, engine, letter) as ahead:
        step("solve")
        case = opened(assignment)
        step("compose")
        tree = case.document()
        job = ReportJob(case, tree, engine, letter, standards, ahead)
        for row in rows:
            for ending, content in row.load()(job).items():
                if keep_source or ending == row.suffix:
                    files[f"report.{ending}"] = content
        program = next((block for block in tree.blocks if isinstance(block, Listing)), None)
        if program is not None:
            files["report.py"] = "\n".join((*program.lines, "")).encode()
        elif listing:
            raise NotOfferedError(word("no_listing", assignment.language, kind=assignment.kind))
    of = made_of(path, engine, assignment.language, standards)
    put = provenance.put_made(Path(out) / assignment.id, files, "report", of)
    return replace(put, paths=tuple(Path(out) / assignment.id / f"report.{row.suffix}" for row in rows))


def made_of(
    path: Path | str, engine: str, language: Language | None, standards: Standards = STANDARDS, **more: str
) -> provenance.MadeOf:
    """Return all inputs that determine the products of an assignment file, in its own language unless one is given.

    Raises `AssignmentError`, `OutputError`.
    """
    spoken = language or load(path).language
    with reported():
        assignment = provenance.assignment_hash(*inputs(Path(path)))
    more["standards"] = other_than_usual(standards)
    return provenance.made_of(assignment, engine, spoken, templates_hash(), version(), **more)


# --- products that a batch makes of an assignment file ------------------------------------------------


Maker = Callable[..., Mapping[str, bytes]]
"""Makes the files of one product, by name, from path, engine and language.

Those of `ASKING` also take `ask`, those of `TYPESET` the `standards` of their PDF. The result depends only on the
arguments, so that a maker can run anywhere.
"""

KEY_FORMATS = names("key")


def report_files(
    path: Path, engine: Engine, language: Language | None, standards: Standards = STANDARDS
) -> Mapping[str, bytes]:
    """Return the complete report."""
    case = open_case(path, language)
    letter = letter_of(case.assignment, engine)
    return _report("pdf", ReportJob(case, case.document(), engine, letter, standards))


def page_files(path: Path, engine: Engine, language: Language | None) -> Mapping[str, bytes]:
    """Return the complete report as a page for a browser, whatever the engine."""
    case = open_case(path, language)
    return _report("html", ReportJob(case, case.document()))


def word_files(path: Path, engine: Engine, language: Language | None) -> Mapping[str, bytes]:
    """Return the complete report as a Word file, whatever the engine."""
    case = open_case(path, language)
    return _report("docx", ReportJob(case, case.document()))


def _report(name: str, job: ReportJob) -> Mapping[str, bytes]:
    """Return the file of a report in one format."""
    (row,) = chosen("report", (name,))
    return {f"report.{row.suffix}": row.load()(job)[row.suffix]}


def task_files(
    path: Path, engine: Engine, language: Language | None, ask: Ask | None = None, standards: Standards = STANDARDS
) -> Mapping[str, bytes]:
    """Return the student's handout, the answer sheet and, unless disabled, the data for a self-check.

    They contain no answers.
    """
    from reportgen.assignment.student_copy import handed_out
    from reportgen.marking.answer_sheet import answer_book
    from reportgen.marking.task_paper import task_of
    from reportgen.marking.toleranced_key import Ask, key_of
    from reportgen.workbook import write_xlsx

    case = open_case(path, language)
    chosen = ask or Ask()
    key = chosen.on_paper(key_of(case))
    letter = letter_of(case.assignment, engine)
    task = task_of(case, key, chosen.by_section, chosen.self_check)
    files = {"task.pdf": bounded(case.assignment, typeset, dated(task, case), engine, letter, standards)[1]}
    files["answers.xlsx"] = write_xlsx(answer_book(key, chosen.by_section, chosen.self_check))
    return files | ({"assignment.yaml": handed_out(path).encode()} if chosen.self_check else {})


def frame_files(path: Path, engine: Engine, language: Language | None, ask: Ask | None = None) -> Mapping[str, bytes]:
    """Return the frame of a report as a Word file, with a field for each requested result, whatever the engine."""
    from reportgen.marking.blank_report import frame_of
    from reportgen.marking.toleranced_key import Ask, key_of

    case = open_case(path, language)
    return {"frame.docx": word_file(case.assignment, frame_of(case, (ask or Ask()).of(key_of(case))))}


def key_files(
    path: Path,
    engine: Engine,
    language: Language | None,
    formats: Sequence[str] = usual("key"),
    ask: Ask | None = None,
    standards: Standards = STANDARDS,
) -> Mapping[str, bytes]:
    """Return the answer key in some of `KEY_FORMATS`; it marks the requested cells and contains all values."""
    from reportgen.marking.toleranced_key import Ask, key_of

    step("solve")
    case = open_case(path, language)
    job = KeyJob(case, (ask or Ask()).of(key_of(case)), engine, standards)
    return {f"key.{row.suffix}": row.load()(job) for row in chosen("key", formats)}


SHEET_FORMATS = names("sheet")


def sheet_files(
    path: Path,
    engine: Engine = "typst",
    language: Language | None = None,
    size: str = "",
    sets: Collection[str] = (),
    formats: Sequence[str] = usual("sheet"),
    block: Path | None = None,
    every: bool = False,
    standards: Standards = STANDARDS,
) -> Mapping[str, bytes]:
    """Return the drawing sheets, `sheet-1.pdf`, `sheet-1.dxf`, …, whatever the engine of the report.

    Without a `size`, each set gets the smallest sheet that it fits on. Without `sets`, all are drawn; with `every`,
    they include every plate, not only those usually submitted. The title `block` is that of the language unless a file
    is given. Raises `SheetError` if there is nothing to draw, and `AssignmentError` if a plate does not fit on the
    size.
    """
    from reportgen.sheets import drawing_sheets

    step("solve")
    case = open_case(path, language)
    sheets = drawing_sheets(case, size, sets, block, every)
    rows = chosen("sheet", formats)
    return {
        f"sheet-{number}.{row.suffix}": row.load()(SheetJob(case, sheet, standards))
        for number, sheet in enumerate(sheets, start=1)
        for row in rows
    }


def blocks(assignment: Assignment) -> dict[str, Path]:
    """Return the title blocks that have a name: the program's, and those of the assignment's school."""
    from reportgen.sheets import title_block

    return title_block.blocks(assignment.school or "", assignment.language)


MAKERS: Mapping[str, Maker] = {product.name: product.load() for product in PRODUCTS}
"""The products by the names that `--make` accepts."""
USUAL = tuple(product.name for product in PRODUCTS if product.usual)
"""Default products of a batch."""
ASKING = frozenset(product.name for product in PRODUCTS if product.asks)
"""Products that depend on the selection of the answer sheet."""
TYPESET = frozenset(product.name for product in PRODUCTS if product.typeset)
"""Products that have a PDF."""


def policy(path: Path | None, language: Language | None) -> Policy:
    """Return the marking policy of a file, or the default without one; raise `AssignmentError`."""
    from reportgen.marking.marking_policy import Policy, read_policy

    return Policy() if path is None else read_policy(path, language)


def compare(
    path: Path, files: Sequence[Path], hint: bool = False, language: Language | None = None
) -> tuple[tuple[str, ...], bool]:
    """Return the messages to a student about an answer sheet or a report and drawings, and True if they agree so far.

    Raises `AssignmentError`.
    """
    from reportgen.handin import self_check

    return self_check.compare(open_case(path, language), open_case(path), files, hint)


def read(
    path: Path, files: Sequence[Path], out: Path, ask: Ask | None = None, language: Language | None = None
) -> tuple[Path, str]:
    """Write the values read from a report and drawings to `out`/<id>/reading.xlsx; return its path and a summary line.

    Raises `AssignmentError`, also if somebody has completed the existing sheet, and `OutputError`.
    """
    from reportgen.handin import reading_book, self_check
    from reportgen.marking.toleranced_key import Ask

    case = open_case(path, language)
    key, own = self_check.read(case, open_case(path), files, ask or Ask())
    folder = out / case.assignment.id
    book = self_check.reading(key, own, folder / reading_book.NAME)
    (written,) = put_files(folder, {reading_book.NAME: book})
    return written, self_check.summary(own, case.assignment.language)


def check_ask(ask: Ask | None, files: Iterable[Path], language: Language | None) -> None:
    """Raise `AssignmentError` if a policy asks for something that no machine of these assignments has."""

    from reportgen.marking.toleranced_key import key_of

    def keys() -> Iterator[Key]:
        """Yield a key of each kind of machine; cases that cannot be computed are skipped and reported later."""
        seen: set[str] = set()
        for path in files:
            with suppress(ReportgenError):
                case = open_case(path, language)
                if case.assignment.kind not in seen:
                    seen.add(case.assignment.kind)
                    yield key_of(case)

    if ask is not None:
        ask.check(keys(), language)
