"""A student's feedback as a page: points, the first errors by name, what followed from them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import groupby
from typing import Any

from reportgen.answers.key import Key
from reportgen.answers.paper import fields, paper
from reportgen.answers.sheet import student_rows, words_of
from reportgen.document.tree import (
    TEXT_WIDTH,
    Block,
    Cell,
    Column,
    Document,
    InlineMath,
    Inlines,
    List,
    Paragraph,
    Section,
    Strong,
    Table,
    Text,
)
from reportgen.errors import Problem
from reportgen.grading.marks import Marked, Marking, Verdict
from reportgen.grading.sentences import (
    expected_value,
    given_value,
    mistake_inlines,
    place_text,
    points_text,
    sentence,
)

POINTS, COUNT = 15.0, 16.5
"""Widths (mm) of columns of points and of counts."""


def feedback_document(marking: Marking, title: str, show_answers: bool = True) -> Document:
    """The feedback on one submission, in the language of its assignment; `title` is the machine's name.

    It holds nothing of any other student.
    """
    key, words = marking.key, words_of(marking.key)
    feedback = words["feedback"]
    score = sentence(
        feedback["score"],
        points=points_text(marking.points, key.language),
        out_of=points_text(marking.out_of, key.language),
    )
    blocks: list[Block] = [
        Section(1, (Text(feedback["title"]),), numbered=False),
        *fields(((words["answer_sheet"]["kind"], title), *student_rows(key))),
        Paragraph((Strong(score),)),
        *(Paragraph((Text(words["warnings"][warning]),)) for warning in marking.warnings),
        *_section(feedback["firsts"], _firsts(marking, words, show_answers)),
        *_section(feedback["followed"], _followed(marking, words)),
        *_section(feedback["unread"], _listed(marking.submission.problems.values())),
        *_section(feedback["noted"], _listed(marking.submission.notes)),
        _by_part(marking, words),
    ]
    note = words["variant"].format(variant=key.variant) if key.variant else ""
    owner = key.student.get("name", "")
    return paper(key.language, words, f"{feedback['title']} – {key.id}", owner, note, blocks)


def _section(title: str, blocks: Iterable[Block]) -> tuple[Block, ...]:
    """A headed section, nothing if it is empty."""
    inner = tuple(blocks)
    return (Section(2, (Text(title),), numbered=False), *inner) if inner else ()


# --- errors ---------------------------------------------------------------------------------------


def _firsts(marking: Marking, words: Mapping[str, Any], show_answers: bool) -> Iterator[Block]:
    """The first error of each chain, in the order of the sheet."""
    firsts = [cell for cell in marking.firsts if cell.given is not None]
    if not firsts:
        if not any(cell.verdict is Verdict.wrong for cell in marking.cells):
            yield Paragraph((Text(words["feedback"]["no_firsts"]),))
        return
    yield Paragraph((Text(words["feedback"]["firsts_lead"]),))
    yield List(tuple((Paragraph(_first(cell, marking.key, words, show_answers)),) for cell in firsts), ordered=True)


def _first(cell: Marked, key: Key, words: Mapping[str, Any], show_answers: bool) -> Inlines:
    """One error: what, where, the value given, perhaps the one expected; then the mistake in words."""
    feedback, row = words["feedback"], key.row(cell.id)
    assert cell.given is not None
    label = key.labels[cell.position - 1] if cell.position else ""
    expected = sentence(feedback["expected"], value=expected_value(row, cell)) if show_answers else ()
    return (
        InlineMath(row.symbol),
        *(sentence(feedback["at"], label=label) if label else ()),
        *sentence(feedback["yours"], value=given_value(row, cell.given)),
        *expected,
        Text(". "),
        *mistake_inlines(cell, key, words),
    )


def _followed(marking: Marking, words: Mapping[str, Any]) -> Iterator[Block]:
    """What differs from the key and earned its points, quantity by quantity."""
    key = marking.key
    cells = [cell for cell in marking.cells if cell.verdict is Verdict.follows]
    if not cells:
        return
    line: list[Any] = []
    for id, of_row in groupby(cells, lambda cell: cell.id):
        symbol = InlineMath(key.row(id).symbol)
        labels = ", ".join(key.labels[cell.position - 1] for cell in of_row if cell.position)
        line += [Text("; ")] if line else []
        line += sentence(words["feedback"]["with_labels"], symbol=symbol, labels=labels) if labels else (symbol,)
    yield Paragraph((Text(f"{words['feedback']['followed_lead']} "), *line, Text(".")))


def _listed(problems: Iterable[Problem]) -> Iterator[Block]:
    """Faults of single cells, each with its place in the student's own file."""
    found = sorted(problems, key=lambda problem: problem.mark)
    if found:
        texts = (f"{place_text(problem.mark)}: {problem.message}." for problem in found)
        yield List(tuple((Paragraph((Text(text),)),) for text in texts))


# --- points ---------------------------------------------------------------------------------------


def _by_part(marking: Marking, words: Mapping[str, Any]) -> Table:
    """Counts of verdicts and points, a part a row, and their sums."""
    key, feedback = marking.key, words["feedback"]
    verdicts = [verdict for verdict in Verdict if any(cell.verdict is verdict for cell in marking.cells)]
    parts = [
        (str(words["parts"][part]), list(cells))
        for part, cells in groupby(marking.cells, lambda cell: key.row(cell.id).part)
    ]
    heads = (feedback["part"], *(str(words["verdicts"][v]) for v in verdicts), feedback["points"], feedback["out_of"])
    first = TEXT_WIDTH - len(verdicts) * COUNT - 2 * POINTS
    columns = (Column(first, "left"), *(Column(COUNT),) * len(verdicts), Column(POINTS), Column(POINTS))
    rows = [_counted(name, cells, verdicts, key) for name, cells in parts]
    rows.append(_counted(feedback["total"], marking.cells, verdicts, key))
    return Table(columns, (_texts(heads),), tuple(map(_texts, rows)), (Text(feedback["by_part"]),))


def _counted(name: str, cells: Sequence[Marked], verdicts: Sequence[Verdict], key: Key) -> tuple[str, ...]:
    counts = Counter(cell.verdict for cell in cells)
    points = (sum(cell.points for cell in cells), sum(cell.worth for cell in cells))
    numbers = (str(counts[verdict] or "–") for verdict in verdicts)
    return (name, *numbers, *(points_text(value, key.language) for value in points))


def _texts(texts: Iterable[str]) -> tuple[Cell, ...]:
    return tuple(Cell((Text(text),) if text else ()) for text in texts)
