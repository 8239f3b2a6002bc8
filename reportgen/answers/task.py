"""The task: what a student is handed, from the given data to the empty answer sheet; no answer is in it."""

from __future__ import annotations

from reportgen.analysis import Analysis
from reportgen.answers.key import Key
from reportgen.answers.paper import fields, paper
from reportgen.answers.sheet import answer_blocks, asked_positions, known_blocks, student_rows
from reportgen.case import Case
from reportgen.document.outline import variant_line
from reportgen.document.report import PLATES_UP_TO, Report
from reportgen.document.tree import Block, Document, Paragraph, Strong, Text


def task(case: Case, key: Key) -> Document:
    """The handout of a case.  Raises `TemplateError`."""
    report = Report(case)
    prose, names, words, about = report.prose, report.names(), case.words, case.assignment.report
    (heading, *given) = prose.render("given.md", names)
    names |= {
        "sheet": tuple(answer_blocks(key)),
        "asked": tuple(key.labels[k - 1] for k in asked_positions(key)),
        "known_tables": tuple(known_blocks(key, _known_positions(key, case.analysis))),
    }
    course = about.course or words["cover"]["course"]
    blocks: list[Block] = [
        heading,
        Paragraph((Strong((Text(case.title),)),), "center"),
        *fields(student_rows(key)),
        *given,
        *prose.render("task.md", names),
    ]
    return paper(case.assignment.language, words, course, about.student.name or "", variant_line(case), blocks)


def _known_positions(key: Key, analysis: Analysis) -> tuple[int, ...]:
    """All positions of the cycle, or those asked for when there are very many."""
    machine = analysis.machine
    return tuple(range(1, machine.positions + 1)) if machine.count <= PLATES_UP_TO else asked_positions(key)
