"""What a script or the command line calls: load, check, solve, build, and the makers of report, task and key.

The whole way in one place: file → `Assignment` → `Machine` → `Analysis` → `Ledger` → `Document` → PDF.
What comes before the document is in a `Case`.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, nullcontext, suppress
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from reportgen import catalogue
from reportgen.api.letters import Engine as Engine
from reportgen.api.letters import letter_of as letter_of
from reportgen.api.letters import letters_of
from reportgen.assignment import Assignment
from reportgen.assignment.common import Extent
from reportgen.assignment.reading import inputs
from reportgen.base import made
from reportgen.base.errors import NotOfferedError, ReportgenError, TypesetterError
from reportgen.base.files import put_files, reported, scratch, version
from reportgen.base.languages import setting_of
from reportgen.base.steps import step
from reportgen.base.template_folders import school_folder
from reportgen.base.units import Language
from reportgen.base.words import templates_hash, word
from reportgen.cases import MachineCase, open_case, opened
from reportgen.report.case import bounded

if TYPE_CHECKING:
    from reportgen.drawing.sheet import DrawingSheet
    from reportgen.machine.analysis import Analysis
    from reportgen.marking.key import Ask
    from reportgen.marking.policy import Policy
    from reportgen.report import Document
    from reportgen.report.case import Case
    from reportgen.report.key import Key
    from reportgen.report.layout import Letter
    from reportgen.writers.pdflatex import Ahead

SUFFIX: Mapping[Engine, str] = {"typst": ".typ", "latex": ".tex"}
FORMATS = ("pdf", "html", "docx")
"""What a report can be written as."""


load, check, examine, assess = catalogue.load, catalogue.check, catalogue.examine, catalogue.assess
schema, sample, examples, example = catalogue.schema, catalogue.sample, catalogue.examples, catalogue.example


def analyse(assignment: Assignment) -> Analysis:
    """Everything computed of an assignment, as arrays over its positions."""
    return MachineCase(assignment).analysis


def solve(assignment: Assignment, positions: int | None = None, printed: bool = False) -> dict[str, Any]:
    """The results as the contract's JSON object (SI, unrounded); `positions` overrides the count a turn.

    What the report prints stands beside as `printed`, if it is asked for and there is a report of it.  Raises
    `NotOfferedError` for positions of an exercise, which is one instant.
    """
    from reportgen.results import printed_values, results

    if positions is not None and not catalogue.kind(assignment.kind).counts_positions:
        raise NotOfferedError(word("no_positions", assignment.language, kind=assignment.kind))
    chosen = assignment if positions is None else assignment.with_positions(positions)
    case = opened(chosen)
    found = results(case)
    if printed:
        with suppress(NotOfferedError):
            found["printed"] = printed_values(case.printed)
    return found


def print_tables(results: Mapping[str, Any], language: Language) -> None:
    """Print results as tables on a terminal."""
    from reportgen.results import tables

    tables.print_tables(results, language)


RESULT_FORMATS = ("csv", "xlsx", "json")
DEGREES_OF_A_TURN = 360
"""Positions of the table of a full turn."""


def result_files(
    path: Path | str, formats: Sequence[str], positions: int | None = None, language: Language | None = None
) -> Mapping[str, bytes]:
    """The results of a full turn, by degrees unless `positions` says otherwise, in some of `RESULT_FORMATS`.

    CSV, which has one table a file, has a further file for each part of a coursework, results-cam.csv.
    """
    from reportgen.results.files import result_file

    assignment = load(path, language)
    wanted = positions or (DEGREES_OF_A_TURN if catalogue.kind(assignment.kind).counts_positions else None)
    results = solve(assignment, wanted)
    files = {f"results.{name}": result_file(results, name) for name in formats}
    parts = results.get("parts", {}) if "csv" in formats else {}
    return files | {f"results-{part}.csv": result_file(one, "csv") for part, one in parts.items()}


def document(assignment: Assignment) -> Document:
    """The report as a numbered tree, ready for any writer."""
    return opened(assignment).document()


def build(
    path: Path | str,
    out: Path | str = "out",
    engine: Engine = "typst",
    language: Language | None = None,
    keep_source: bool = False,
    formats: Sequence[str] = ("pdf",),
    extent: Extent | None = None,
    listing: bool = False,
) -> Path:
    """Write the complete report to `out`/<id>/report.pdf and return that path; of several formats that of the first.

    It has the language and the extent of the file unless others are given.  A `listing` adds a program of the closed
    formulas, which also stands beside it as report.py; raises `NotOfferedError` where there are none.
    Files appear whole or not at all.  Raises `AssignmentError`, `TemplateError`, `TypesetterError`,
    `OutputError`.
    """
    put = build_each(path, out, engine, language, keep_source, formats, extent=extent, listing=listing)
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
) -> made.Put:
    """Write the complete report in some of `FORMATS`; gives their paths in that order, and what became of others."""
    from reportgen.report import Listing

    assignment = load(path, language)
    if extent is not None:
        assignment = assignment.with_extent(extent)
    if listing:
        assignment = assignment.with_listing()
    letter = letter_of(assignment, engine) if "pdf" in formats else None
    files: dict[str, bytes] = {}
    with reported(), scratch(Path(out)), _ahead(assignment, engine, letter) as ahead:
        step("solve")
        case = opened(assignment)
        step("compose")
        tree = case.document()
        if "pdf" in formats:
            if ahead is not None:
                source, pdf = typeset(tree, engine, letter, ahead)
            else:
                source, pdf = bounded(assignment, typeset, tree, engine, letter)
            files = {**({f"report{SUFFIX[engine]}": source.encode()} if keep_source else {}), "report.pdf": pdf}
        if "html" in formats:
            files["report.html"] = _page(case, tree)
        if "docx" in formats:
            files["report.docx"] = _word(assignment, tree)
        program = next((block for block in tree.blocks if isinstance(block, Listing)), None)
        if program is not None:
            files["report.py"] = "\n".join((*program.lines, "")).encode()
        elif listing:
            raise NotOfferedError(word("no_listing", assignment.language, kind=assignment.kind))
    put = made.put_made(Path(out) / assignment.id, files, "report", made_of(path, engine, assignment.language))
    return replace(put, paths=tuple(Path(out) / assignment.id / f"report.{name}" for name in formats))


def made_of(path: Path | str, engine: str, language: Language | None, **more: str) -> made.MadeOf:
    """All input that decides the bytes of what is made of an assignment file now, in its own language without another.

    Raises `AssignmentError`, `OutputError`.
    """
    spoken = language or load(path).language
    with reported():
        assignment = made.assignment_hash(*inputs(Path(path)))
    return made.made_of(assignment, engine, spoken, templates_hash(), version(), **more)


def _ahead(assignment: Assignment, engine: Engine, letter: Letter | None) -> AbstractContextManager[Ahead | None]:
    """The typesetter, if it has something to read while the report is worked out; under a school's templates later."""
    if engine != "latex" or letter is None or assignment.school is not None:
        return nullcontext()
    from reportgen.writers import latex, pdflatex

    return pdflatex.Ahead(latex.opening(letter, assignment.report.extent == "short", assignment.language))


def _page(case: Case, tree: Document) -> bytes:
    from reportgen.page import page

    step("page")
    return page(case, tree).encode()


def _word(assignment: Assignment, tree: Document) -> bytes:
    """The Word file of a report, in the letter and the size that its file gives; a school's own look goes before.

    Raises `TemplateError` for a school's Word file that is refused.
    """
    from reportgen.workbook.letterhead import LETTERHEAD

    step("word")
    look = school_folder(assignment.school) / LETTERHEAD if assignment.school is not None else None
    return bounded(assignment, _written, assignment, tree, look)


def _written(assignment: Assignment, tree: Document, look: Path | None) -> bytes:
    """The Word file of a report with the look of a school's Word file, if there is one."""
    from reportgen.report.layout import Letter
    from reportgen.workbook.letterhead import read_letterhead
    from reportgen.writers import pictures
    from reportgen.writers import word as writer
    from reportgen.writers.word_elements import Own

    letters_of(assignment)
    given = assignment.report
    usual = setting_of(tree.language).word
    size = float(given.size.removesuffix(" pt")) if "size" in given.model_fields_set else usual.size
    own = None
    if look is not None and look.exists():
        letterhead = read_letterhead(look, tree.language)
        own = Own(letterhead.styles, letterhead.header, letterhead.footer, letterhead.margins)
    drawn = partial(pictures.for_word, language=tree.language)
    return writer.write(tree, drawn, Letter(given.font or usual.font, size), own)


def typeset(
    tree: Document, engine: Engine, letter: Letter | None = None, ahead: Ahead | None = None
) -> tuple[str, bytes]:
    """The source that a writer makes of a document in a letter, and its PDF; raises `TypesetterError`.

    LaTeX may have read `ahead` what the source begins with.
    """
    from reportgen.report.layout import Letter

    step("typeset")
    letter = letter or Letter()
    if engine == "latex":
        from reportgen.writers import latex, pdflatex

        if not setting_of(tree.language).latex:
            raise TypesetterError(word("typst_alone", tree.language, language=tree.language))
        compiled = pdflatex.compile(latex.pieces(tree, letter), ahead=ahead)
        return compiled.source, compiled.pdf
    from reportgen.writers import typst

    source = typst.write(tree, letter)
    return source, typst.compile(source, system=bool(letter.font))


def typeset_sheet(sheet: DrawingSheet, title: str, language: Language) -> bytes:
    """The PDF of a drawing sheet.  Raises `TypesetterError`."""
    from reportgen.writers import typst

    step("typeset")
    return typst.compile(typst.write_sheet(sheet, title, language))


# --- products: what a batch makes of an assignment file -----------------------------------------------


Maker = Callable[..., Mapping[str, bytes]]
"""Makes the files of one product, by name, from path, engine and language, and of `ASKING` also from `ask`.

It depends on its arguments alone, so that it can run anywhere.
"""

KEY_FORMATS = ("pdf", "xlsx", "csv", "json")


def report_files(path: Path, engine: Engine, language: Language | None) -> Mapping[str, bytes]:
    """The complete report."""
    assignment = load(path, language)
    letter = letter_of(assignment, engine)
    return {"report.pdf": bounded(assignment, typeset, document(assignment), engine, letter)[1]}


def page_files(path: Path, engine: Engine, language: Language | None) -> Mapping[str, bytes]:
    """The complete report as a page for a browser, whatever the engine."""
    case = open_case(path, language)
    return {"report.html": _page(case, case.document())}


def word_files(path: Path, engine: Engine, language: Language | None) -> Mapping[str, bytes]:
    """The complete report as a Word file, whatever the engine."""
    case = open_case(path, language)
    return {"report.docx": _word(case.assignment, case.document())}


def task_files(path: Path, engine: Engine, language: Language | None, ask: Ask | None = None) -> Mapping[str, bytes]:
    """The student's handout, the answer sheet of what is to be asked, and the data to check oneself by, if wanted.

    No answer is in them.
    """
    from reportgen.assignment.handed_out import handed_out
    from reportgen.marking.key import Ask, key_of
    from reportgen.marking.paper import task_of
    from reportgen.marking.sheet import answer_book
    from reportgen.workbook import write_xlsx

    case = open_case(path, language)
    chosen = ask or Ask()
    key = chosen.on_paper(key_of(case))
    letter = letter_of(case.assignment, engine)
    task = task_of(case, key, chosen.by_section, chosen.self_check)
    files = {"task.pdf": bounded(case.assignment, typeset, task, engine, letter)[1]}
    files["answers.xlsx"] = write_xlsx(answer_book(key, chosen.by_section, chosen.self_check))
    return files | ({"assignment.yaml": handed_out(path).encode()} if chosen.self_check else {})


def frame_files(path: Path, engine: Engine, language: Language | None, ask: Ask | None = None) -> Mapping[str, bytes]:
    """The frame of a report as a Word file, with a field for each result that is asked for, whatever the engine."""
    from reportgen.marking.frame import frame_of
    from reportgen.marking.key import Ask, key_of

    case = open_case(path, language)
    return {"frame.docx": _word(case.assignment, frame_of(case, (ask or Ask()).of(key_of(case))))}


def key_files(
    path: Path,
    engine: Engine,
    language: Language | None,
    formats: Sequence[str] = ("pdf", "xlsx"),
    ask: Ask | None = None,
) -> Mapping[str, bytes]:
    """The answer key in some of `KEY_FORMATS`; it says what the answer sheet asks for, and holds everything."""
    from reportgen.marking import key_files as files
    from reportgen.marking.key import Ask, key_of
    from reportgen.workbook import write_csv, write_xlsx

    step("solve")
    case = open_case(path, language)
    key = (ask or Ask()).of(key_of(case))
    makers: Mapping[str, Callable[[], bytes]] = {
        "pdf": lambda: bounded(case.assignment, typeset, files.key_document(key, case.title), engine)[1],
        "xlsx": lambda: write_xlsx(files.key_book(key)),
        "csv": lambda: write_csv(files.key_rows(key)),
        "json": lambda: files.key_json(key).encode(),
    }
    return {f"key.{name}": makers[name]() for name in formats}


SHEET_FORMATS = ("pdf", "dxf")


def sheet_files(
    path: Path,
    engine: Engine = "typst",
    language: Language | None = None,
    size: str = "",
    sets: Collection[str] = (),
    formats: Sequence[str] = SHEET_FORMATS,
    block: Path | None = None,
    every: bool = False,
) -> Mapping[str, bytes]:
    """The drawing sheets, `sheet-1.pdf`, `sheet-1.dxf`, …, whatever the engine of the report.

    Without a `size` they have the smallest that holds each set on one sheet; without `sets` they show all, with `every`
    plate or those usually handed in; the title `block` is that of the language unless a file of one is given.  Raises
    `SheetError` where there is nothing to draw, and `AssignmentError` where a plate has no place on the size.
    """
    from reportgen.sheets import drawing_sheets, dxf

    step("solve")
    case = open_case(path, language)
    sheets = drawing_sheets(case, size, sets, block, every)
    writers: Mapping[str, Callable[[DrawingSheet], bytes]] = {
        "pdf": lambda sheet: bounded(case.assignment, typeset_sheet, sheet, case.title, case.assignment.language),
        "dxf": lambda sheet: dxf.write_sheet(sheet, case.assignment.language),
    }
    return {
        f"sheet-{number}.{name}": writers[name](sheet)
        for number, sheet in enumerate(sheets, start=1)
        for name in formats
    }


def blocks(assignment: Assignment) -> dict[str, Path]:
    """The title blocks that are known by a name: the program's, and those of the assignment's school."""
    from reportgen.sheets import frame

    return frame.blocks(assignment.school or "", assignment.language)


MAKERS: Mapping[str, Maker] = {
    "task": task_files,
    "report": report_files,
    "page": page_files,
    "docx": word_files,
    "key": key_files,
    "sheet": sheet_files,
    "frame": frame_files,
}
"""The products by the names that `--make` takes."""
USUAL = ("task", "report", "key")
"""What a batch makes unless it is told."""
ASKING = frozenset({"task", "key", "frame"})
"""Those that depend on what the answer sheet asks for."""


def policy(path: Path | None, language: Language | None) -> Policy:
    """How a class is marked: as a file says, or what holds without one.  Raises `AssignmentError`."""
    from reportgen.marking.policy import Policy, read_policy

    return Policy() if path is None else read_policy(path, language)


def compare(
    path: Path, files: Sequence[Path], hint: bool = False, language: Language | None = None
) -> tuple[tuple[str, ...], bool]:
    """What a student is told of a filled answer sheet, or of a report and drawings, and whether they agree so far.

    Raises `AssignmentError`.
    """
    from reportgen.handin import checking

    return checking.compare(open_case(path, language), open_case(path), files, hint)


def read(
    path: Path, files: Sequence[Path], out: Path, ask: Ask | None = None, language: Language | None = None
) -> tuple[Path, str]:
    """Write what was read of a report and drawings to `out`/<id>/reading.xlsx; gives the path and a line about it.

    Raises `AssignmentError` also where somebody has completed the sheet that stands there, and `OutputError`.
    """
    from reportgen.handin import checking, reading_book
    from reportgen.marking.key import Ask

    case = open_case(path, language)
    key, own = checking.read(case, open_case(path), files, ask or Ask())
    folder = out / case.assignment.id
    book = checking.reading(key, own, folder / reading_book.NAME)
    (written,) = put_files(folder, {reading_book.NAME: book})
    return written, checking.summary(own, case.assignment.language)


def check_ask(ask: Ask | None, files: Iterable[Path], language: Language | None) -> None:
    """Raises `AssignmentError` if a policy asks for what no machine of these assignments has."""

    from reportgen.marking.key import key_of

    def keys() -> Iterator[Key]:
        """A key of each kind of machine; what cannot be computed is told where its turn comes."""
        seen: set[str] = set()
        for path in files:
            with suppress(ReportgenError):
                case = open_case(path, language)
                if case.assignment.kind not in seen:
                    seen.add(case.assignment.kind)
                    yield key_of(case)

    if ask is not None:
        ask.check(keys(), language)
