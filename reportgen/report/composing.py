"""Compose the finished report of a machine: cover, contents and the sections that the machine's outline names."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from itertools import chain

from reportgen.base.records import replace
from reportgen.case import MachineAnalysis
from reportgen.case.finished_document import finished
from reportgen.document import Block, Document, PageBreak, Paragraph, Plate, Reference
from reportgen.document.figure_placement import PAPERS
from reportgen.document.layout import contents, plates_last
from reportgen.document.used_symbols import used_symbols
from reportgen.report import phrases
from reportgen.report.context import ReportContext
from reportgen.report.named_tables import table
from reportgen.report.template_names import names

LISTING = "symbols"
"""The section that lists the symbols of all other sections."""
OWN_LETTERS = "structure"
"""The section of the mobility formula.  It explains its letters itself: its W is not the work."""


def compose(case: MachineAnalysis) -> Document:
    """Return the finished, numbered report of a machine.  Raises `TemplateError` for a fault in its templates."""
    report = ReportContext(case)
    words, named = report.words, names(report)
    written: dict[str, Sequence[Block]] = {}
    # The list of symbols comes last: it lists those of all other sections.
    for section in sorted(report.sections, key=LISTING.__eq__):
        if section == "contents":
            continue
        if section == LISTING:
            others = (blocks for name, blocks in written.items() if name != OWN_LETTERS)
            whole = replace(report, used_symbols=used_symbols(chain.from_iterable(others)))
            named["table"] = partial(table, whole)
        written[section] = report.prose.render(section, named)
    if "contents" in report.sections:
        brief = not report.parts("contents-page")
        every = chain.from_iterable(written.values())
        listed = contents(words["document"]["contents"], every, brief, case.assignment.language)
        written["contents"] = [PageBreak(), listed]
    blocks = [case.cover, *chain.from_iterable(written[section] for section in report.sections)]
    return finished(case, plates_last(blocks, partial(_plate_is_last, report)), close=not report.parts("usual-type"))


def _plate_is_last(report: ReportContext, plate: Plate) -> Paragraph:
    """Return the sentence that refers the reader to a plate at the end of the report."""
    paper = PAPERS.get(min(plate.paper), "")
    return Paragraph(phrases.say(report, report.words["plate"], figure=(Reference(plate.key),), paper=paper))
