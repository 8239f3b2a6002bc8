"""Build the finished document of a case: its blocks, numbered, with title, author, header and footer."""

from __future__ import annotations

from collections.abc import Iterable

from reportgen.case import LoadedAssignment
from reportgen.document import Block, Document, Words
from reportgen.document.numbering import number


def finished(case: LoadedAssignment, blocks: Iterable[Block], close: bool = False, title: str = "") -> Document:
    """Return the numbered document of a case with its header and footer; its title is that of a report unless `title`
    is given.

    Raises `DocumentError`.
    """
    words = case.words
    return number(
        Document(
            language=case.assignment.language,
            title=title or f"{words['cover']['title']} – {case.title}",
            author=case.assignment.report.student.name or "",
            header=(words["header"].format(course=case.course), case.variant_line),
            footer=("", words["document"]["page"]),
            words=Words.among(words, case.assignment.language),
            blocks=tuple(blocks),
            close=close,
            date=case.assignment.report.date,
        )
    )
