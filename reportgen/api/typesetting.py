"""Typeset a document or a drawing sheet as PDF, with one of the two typesetters."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import AbstractContextManager, contextmanager, nullcontext
from contextvars import ContextVar
from typing import TYPE_CHECKING

from reportgen.api.report_fonts import Engine
from reportgen.assignment import Assignment
from reportgen.base.errors import TypesetterError
from reportgen.base.languages import setting_of
from reportgen.base.pdf_standards import STANDARDS, Standards
from reportgen.base.progress import leave_source, step
from reportgen.base.words import word

if TYPE_CHECKING:
    from reportgen.document import Document
    from reportgen.document.layout import Letter
    from reportgen.drawing.drawing_sheet import DrawingSheet
    from reportgen.writers.pdflatex import Ahead

OF_SYSTEM = "// with fonts of the system\n"
"""First line of a source that was left for a preview and may use fonts of the system."""
SUFFIX: Mapping[Engine, str] = {"typst": ".typ", "latex": ".tex"}
_sources_alone: ContextVar[bool] = ContextVar("sources_alone", default=False)


@contextmanager
def sources_alone() -> Iterator[None]:
    """Write sources without typesetting them inside this context: their PDF is empty.

    A process that others are forked from runs no typesetter, whose threads a fork does not copy.
    """
    token = _sources_alone.set(True)
    try:
        yield
    finally:
        _sources_alone.reset(token)


def reading_ahead(
    assignment: Assignment, engine: Engine, letter: Letter | None
) -> AbstractContextManager[Ahead | None]:
    """Return a context that starts LaTeX on the beginning of a report's source while the report is computed.

    Pass the result of the context to `typeset` as `ahead`. It is None for typst, for a school's templates, and without
    a `letter`.
    """
    if engine != "latex" or letter is None or assignment.school is not None:
        return nullcontext()
    from reportgen.writers import latex, pdflatex

    return pdflatex.Ahead(latex.opening(letter, assignment.report.extent == "short", assignment.language))


def typeset(
    tree: Document,
    engine: Engine,
    letter: Letter | None = None,
    standards: Standards = STANDARDS,
    ahead: Ahead | None = None,
) -> tuple[str, bytes]:
    """Return the typst or LaTeX source of a document, by the `engine`, and its PDF.

    `letter` is the font and size of the text; None selects the default. A PDF by typst conforms to the `standards`,
    which LaTeX ignores. `ahead` is the LaTeX process of `reading_ahead`, or None. Raises `TypesetterError`, also if
    LaTeX cannot set the language of the document.
    """
    from reportgen.document.layout import Letter

    step("typeset")
    letter = letter or Letter()
    if engine == "latex":
        from reportgen.writers import latex, pdflatex

        if not setting_of(tree.language).latex:
            raise TypesetterError(word("typst_alone", tree.language, language=tree.language))
        pieces = latex.pieces(tree, letter)
        if _sources_alone.get():
            return "".join(pieces), b""
        compiled = pdflatex.compile(pieces, ahead=ahead)
        return compiled.source, compiled.pdf
    from reportgen.writers import typst, typst_compiler

    source = typst.write(tree, letter)
    if _sources_alone.get():
        return source, b""
    pdf = typst_compiler.compile(source, bool(letter.font), standards)
    leave_source(f"{OF_SYSTEM}{source}" if letter.font else source)
    return source, pdf


def pages_of(source: str) -> tuple[list[bytes], list[int]]:
    """Return the pages of a typst source that was left for a preview, as SVG, and the page of each of its headings.

    Raises `TypesetterError`.
    """
    from reportgen.writers import typst_compiler

    system = source.startswith(OF_SYSTEM)
    return typst_compiler.compile_as(source, "svg", system=system), typst_compiler.heading_pages(source, system)


def typeset_sheet(
    sheet: DrawingSheet,
    title: str,
    assignment: Assignment,
    phrases: Mapping[str, str],
    standards: Standards = STANDARDS,
) -> bytes:
    """Return the PDF of a drawing sheet of an assignment, by typst, with a text alternative in `phrases`.

    Raises `TypesetterError`.
    """
    from reportgen.writers import typst, typst_compiler

    step("typeset")
    said = assignment.report
    source = typst.write_sheet(
        sheet, title, assignment.language, phrases, author=said.student.name or "", date=said.date
    )
    return b"" if _sources_alone.get() else typst_compiler.compile(source, standards=standards)
