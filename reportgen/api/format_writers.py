"""Writers of reports, keys and drawing sheets for the table of formats, and their arguments."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from reportgen.api import typesetting
from reportgen.api.report_fonts import Engine, letters_of
from reportgen.assignment import Assignment
from reportgen.base.languages import setting_of
from reportgen.base.pdf_standards import STANDARDS, Standards
from reportgen.base.progress import step
from reportgen.base.records import Record, replace
from reportgen.base.template_folders import school_folder
from reportgen.case import bounded

if TYPE_CHECKING:
    from reportgen.case import Case
    from reportgen.case.answer_key import Key
    from reportgen.document import Document
    from reportgen.document.layout import Letter
    from reportgen.drawing.drawing_sheet import DrawingSheet
    from reportgen.writers.pdflatex import Ahead


class ReportJob(Record):
    """A report to write: its case and its tree; for a typesetter also the letter, and the opening read `ahead`."""

    case: Case
    tree: Document
    engine: Engine = "typst"
    letter: Letter | None = None
    standards: Standards = STANDARDS
    ahead: Ahead | None = None


def report_pdf(job: ReportJob) -> Mapping[str, bytes]:
    """Return the source and the PDF of a report, by suffix; raise `TypesetterError`."""
    if job.ahead is not None:
        source, pdf = typesetting.typeset(job.tree, job.engine, job.letter, job.standards, job.ahead)
    else:
        asked = job.case.assignment
        source, pdf = bounded(asked, typesetting.typeset, job.tree, job.engine, job.letter, job.standards)
    return {typesetting.SUFFIX[job.engine].removeprefix("."): source.encode(), "pdf": pdf}


def report_page(job: ReportJob) -> Mapping[str, bytes]:
    """Return a report as a page for a browser."""
    from reportgen.page import page

    step("page")
    return {"html": page(job.case, job.tree).encode()}


def report_word(job: ReportJob) -> Mapping[str, bytes]:
    """Return a report as a Word file."""
    return {"docx": word_file(job.case.assignment, job.tree)}


def word_file(assignment: Assignment, tree: Document) -> bytes:
    """Return a document as a Word file, in the letter and the size of its assignment.

    A school's own look takes precedence. Raises `TemplateError` if a school's Word file is rejected.
    """
    from reportgen.workbook.letterhead import LETTERHEAD

    step("word")
    look = school_folder(assignment.school) / LETTERHEAD if assignment.school is not None else None
    return bounded(assignment, _written, assignment, tree, look)


def _written(assignment: Assignment, tree: Document, look: Path | None) -> bytes:
    """Return a Word file with the look of a school's Word file, if there is one."""
    from reportgen.document.layout import Letter
    from reportgen.workbook.letterhead import read_letterhead
    from reportgen.writers import picture_files
    from reportgen.writers import word as writer
    from reportgen.writers.word_elements import Own

    letters_of(assignment)
    given = assignment.report
    default = setting_of(tree.language).word
    size = float(given.size.removesuffix(" pt")) if "size" in given.model_fields_set else default.size
    own = None
    if look is not None and look.exists():
        letterhead = read_letterhead(look, tree.language)
        own = Own(letterhead.styles, letterhead.header, letterhead.footer, letterhead.margins)
    drawn = partial(picture_files.for_word, language=tree.language)
    return writer.write(tree, drawn, Letter(given.font or default.font, size), own)


# --- keys -----------------------------------------------------------------------------------------


class KeyJob(Record):
    """An answer key to write, and its case."""

    case: Case
    key: Key
    engine: Engine = "typst"
    standards: Standards = STANDARDS


def key_pdf(job: KeyJob) -> bytes:
    """Return the key as PDF; raise `TypesetterError`."""
    from reportgen.marking import key_files

    tree = dated(key_files.key_document(job.key, job.case.title), job.case)
    return bounded(job.case.assignment, typesetting.typeset, tree, job.engine, None, job.standards)[1]


def key_workbook(job: KeyJob) -> bytes:
    """Return the key as an Excel workbook."""
    from reportgen.marking import key_files
    from reportgen.workbook import write_xlsx

    return write_xlsx(key_files.key_book(job.key))


def key_table(job: KeyJob) -> bytes:
    """Return the key as CSV."""
    from reportgen.marking import key_files
    from reportgen.workbook import write_csv

    return write_csv(key_files.key_rows(job.key))


def key_json(job: KeyJob) -> bytes:
    """Return the key as JSON."""
    from reportgen.marking import key_files

    return key_files.key_json(job.key).encode()


def dated(tree: Document, case: Case) -> Document:
    """Return a document about a case with the date of its report."""
    return replace(tree, date=case.assignment.report.date)


# --- drawing sheets -------------------------------------------------------------------------------


class SheetJob(Record):
    """A drawing sheet to write, and the case that it shows."""

    case: Case
    sheet: DrawingSheet
    standards: Standards = STANDARDS


def sheet_pdf(job: SheetJob) -> bytes:
    """Return a drawing sheet as PDF; raise `TypesetterError`."""
    case = job.case
    pdf_of = partial(typesetting.typeset_sheet, phrases=case.words["told"], standards=job.standards)
    return bounded(case.assignment, pdf_of, job.sheet, case.title, case.assignment)


def sheet_dxf(job: SheetJob) -> bytes:
    """Return a drawing sheet as DXF."""
    from reportgen.sheets import dxf

    return dxf.write_sheet(job.sheet, job.case.assignment.language)
