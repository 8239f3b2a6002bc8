"""The task: what a student is handed, from the given data to the empty answer sheet; no answer is in it."""

from __future__ import annotations

from reportgen.analysis import Analysis
from reportgen.answers.key import Key
from reportgen.answers.paper import fields, paper
from reportgen.answers.sheet import answer_blocks, asked_positions, known_blocks, student_rows
from reportgen.case import Case
from reportgen.document.outline import PLATES_UP_TO, prepare
from reportgen.document.tree import Block, Document, Paragraph, Strong, Text


def task(case: Case, key: Key) -> Document:
    """The handout of a case.  Raises `TemplateError`."""
    assignment, words = case.assignment, case.words
    prose, names = prepare(case)
    (heading, *given) = prose.render("given.md", names)
    names |= {
        "sheet": tuple(answer_blocks(key)),
        "asked": tuple(key.labels[k - 1] for k in asked_positions(key)),
        "known_tables": tuple(known_blocks(key, _known_positions(key, case.analysis))),
    }
    report = assignment.report
    course = report.course or words["cover"]["course"]
    blocks: list[Block] = [
        heading,
        Paragraph((Strong((Text(case.title),)),), "center"),
        *fields(student_rows(key)),
        *given,
        *prose.render("task.md", names),
    ]
    variant = words["variant"].format(variant=assignment.variant) if assignment.variant else ""
    return paper(assignment.language, words, course, report.student.name or "", variant, blocks)


def _known_positions(key: Key, analysis: Analysis) -> tuple[int, ...]:
    """All positions of the cycle, or those asked for when there are very many."""
    machine = analysis.machine
    return tuple(range(1, machine.positions + 1)) if machine.count <= PLATES_UP_TO else asked_positions(key)
