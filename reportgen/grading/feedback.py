"""A student's own sheet back: values coloured by verdict, comments on what is not right, points."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from reportgen.answers.key import Row
from reportgen.answers.sheet import (
    NAMES,
    asked_positions,
    given_entry,
    grid,
    info_page,
    page,
    rows_shown,
    words_of,
)
from reportgen.grading.marks import Marked, Marking, Verdict
from reportgen.grading.sentences import note
from reportgen.workbook import Book, Entry, Sheet
from reportgen.workbook.writing import Style

STYLES: Mapping[Verdict, Style] = {
    Verdict.right: "good",
    Verdict.follows: "linked",
    Verdict.wrong: "warn",
    Verdict.blank: "input",
    Verdict.unreadable: "doubt",
    Verdict.implausible: "doubt",
}
FIRST: Style = "bad"
"""How a wrong value looks before which nothing is wrong."""


def feedback_book(marking: Marking, show_answers: bool = True) -> Book:
    """The marked sheet as a workbook: the layout of the answer sheet, points behind each row and their sum below."""
    key, words = marking.key, words_of(marking.key)
    feedback = words["feedback"]
    cells = {(cell.id, cell.position): cell for cell in marking.cells}
    positions = asked_positions(key)

    def filling(row: Row, position: int) -> Entry | None:
        cell = cells.get((row.id, position))
        if cell is not None:
            return _marked(marking, words, cell, show_answers)
        return _unmarked(marking, row, position) if position in row.positions else given_entry(row, position)

    def tail(row: Row) -> Sequence[Entry]:
        own = [cells[row.id, k] for k in row.positions if (row.id, k) in cells]
        return _points(own) if own else ()

    heads = (feedback["points"], feedback["out_of"])
    rows = grid(key, feedback["marked"], "", filling, rows_shown(key), positions, heads, tail)
    between = (Entry(),) * (NAMES - 2 + len(positions))
    total = (Entry(), Entry(feedback["total"], "bold"), *between, *_points(marking.cells, "bold"))
    title = f"{feedback['marked']} {key.id}"
    return Book((page(feedback["marked"], (*rows, total)), _legend(words), info_page(key)), title)


def _marked(marking: Marking, words: Mapping[str, Any], cell: Marked, show_answers: bool) -> Entry:
    """A judged cell: the student's value on the colour of its verdict."""
    key, problem = marking.key, marking.submission.problems.get((cell.id, cell.position))
    comment = note(cell, key, words, problem.message if problem else "", show_answers)
    first = cell.first and cell.verdict is Verdict.wrong
    return Entry(cell.given, FIRST if first else STYLES[cell.verdict], comment)


def _unmarked(marking: Marking, row: Row, position: int) -> Entry:
    """A value that is worth nothing."""
    given = marking.submission.values.get((row.id, position))
    return Entry(None if given is None else given.value)


def _points(cells: Iterable[Marked], style: Style = "") -> tuple[Entry, Entry]:
    """Points earned and points to be earned."""
    counted = list(cells)
    return (
        Entry(round(sum(cell.points for cell in counted), 2), style),
        Entry(round(sum(cell.worth for cell in counted), 2), style),
    )


def _legend(words: Mapping[str, Any]) -> Sheet:
    """What the colours mean."""
    notes, verdicts = words["verdict_notes"], words["verdicts"]
    styles = [(verdict.value, style) for verdict, style in STYLES.items()]
    styles.insert(2, ("first", FIRST))
    rows = tuple(
        (Entry(str(verdicts[name]), style), Entry(str(notes[name]).partition(":")[0])) for name, style in styles
    )
    return Sheet(words["feedback"]["legend"], rows, (18.0, 80.0), protected=True)
