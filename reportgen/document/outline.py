"""Case → Document: cover, contents and the sections that the machine's outline names."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from reportgen.case import Calculation
from reportgen.document.namespace import names
from reportgen.document.numbering import number
from reportgen.document.report import Report
from reportgen.document.tree import Block, Contents, Cover, Document, PageBreak, Words


def compose(case: Calculation) -> Document:
    """The finished, numbered report of a machine; raises `TemplateError` for a fault in its words."""
    report = Report(case)
    words, named = report.words, names(report)
    blocks: list[Block] = [_cover(report)]
    for section in _sections(report):
        if section == "contents":
            blocks += [PageBreak(), Contents(words["document"]["contents"])]
        else:
            blocks += report.prose.render(section, named)
    assignment = case.assignment
    return number(
        Document(
            language=assignment.language,
            title=f"{words['cover']['title']} – {case.title}",
            author=assignment.report.student.name or "",
            header=(words["header"].format(course=case.course), case.variant_line),
            footer=("", words["document"]["page"]),
            words=Words(**words["document"]),
            blocks=tuple(blocks),
        )
    )


def _sections(report: Report) -> Iterator[str]:
    """The sections of the outline, that on instant centres behind the velocities if any link has one."""
    outline = report.machine.outline
    last = max((outline.index(name) for name in ("velocity", "summary") if name in outline), default=-1)
    for index, section in enumerate(outline):
        yield section
        if report.plane_links and index == last:
            yield "centres"


def _cover(report: Report) -> Cover:
    """The title page; a field without a value is a dotted line to fill in."""
    given, labels = report.assignment.report, report.words["cover"]
    student = given.student
    fields: tuple[tuple[Any, str | None], ...] = (
        (labels["student"], student.name),
        (labels["id"], student.id),
        (labels["class"], student.class_),
        (labels["section"], student.section),
        (labels["email"], student.email),
        (labels["supervisor"], given.supervisor),
    )
    return Cover(
        tuple(part for part in (given.university, given.faculty, given.department) if part),
        (labels["title"], report.case.course),
        (
            *((f"{labels['variant']}: {report.variant}",) if report.variant else ()),
            f"{labels['machine']}: {report.case.title}",
        ),
        tuple((label, value or "") for label, value in fields),
        report.place_and_date,
    )
