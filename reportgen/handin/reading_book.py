"""Prefilled answer sheet with the values read from a student's files, to be completed by hand.

A cell has the value that was read, or “?” if the file has an entry that could not be read. A fingerprint of the
original content is stored in the sheet, so that an edited sheet can be recognised.
"""

from __future__ import annotations

from collections.abc import Iterator
from hashlib import sha256

from reportgen.base.records import replace
from reportgen.case.answer_key import Key, KeyRow
from reportgen.marking.answer_sheet import (
    UNSETTLED,
    answer_book,
    asked_positions,
    given_entry,
    grid,
    info_page,
    named_pages,
    open_cells,
    page,
    sheet_rows,
)
from reportgen.marking.marking_data import Submission
from reportgen.marking.toleranced_key import symbol_text, words_of
from reportgen.workbook import Book, Entry, WorksheetData, write_xlsx

NAME = "reading.xlsx"
_SHORT = 16
"""Number of characters of a fingerprint."""
_WIDTHS = (12.0, 12.0, 12.0, 18.0, 90.0)


def fingerprint(submission: Submission) -> str:
    """Return a short hash of all cells of a prefilled sheet."""
    cells = [f"{id} {k} {answer.value:.10g}" for (id, k), answer in submission.values.items()]
    cells += [f"{id} {k} {UNSETTLED}" for id, k in submission.unread]
    cells += [f"{id} {k} !" for id, k in submission.problems]
    return sha256("\n".join(sorted(cells)).encode()).hexdigest()[:_SHORT]


def is_unchanged(submission: Submission) -> bool:
    """Return True if a prefilled sheet has not been changed since it was written."""
    return submission.fingerprint == fingerprint(submission)


def reading_book(key: Key, submission: Submission) -> bytes:
    """Return the prefilled answer sheet; a separate page lists the unread entries with location and reason."""
    words = words_of(key)["answer_sheet"]
    empty = answer_book(key)
    pages = [_page(part, name, submission) for name, part in named_pages(key, words["answers"])]
    info = info_page(key)
    marked = (Entry(words["fingerprint"], "bold"), Entry(fingerprint(submission)))
    unread = (_unread_page(key, submission),) if submission.unread else ()
    return write_xlsx(Book((*pages, *unread, replace(info, rows=(*info.rows, marked))), empty.title))


def _page(key: Key, name: str, submission: Submission) -> WorksheetData:
    words, cells = words_of(key)["answer_sheet"], open_cells(key)

    def filling(row: KeyRow, position: int) -> Entry | None:
        place = (row.id, position)
        if position not in cells.get(row.id, ()):
            return given_entry(row, position)
        if (answer := submission.values.get(place)) is not None:
            return Entry(answer.value, "input", comment=f"{answer.location}\n{answer.text}", unlocked=True)
        if (problem := submission.unread.get(place)) is not None:
            return Entry(UNSETTLED, "doubt", comment=f"{problem.location}\n{problem.message}", unlocked=True)
        return Entry(None, "input", unlocked=True)

    rows = grid(key, words["title"], words["reading_note"], filling, sheet_rows(key), asked_positions(key))
    return page(name, rows)


def _unread_page(key: Key, submission: Submission) -> WorksheetData:
    """Return the page of unread entries: quantity, position, location and reason."""
    words = words_of(key)["answer_sheet"]
    heads = (words["id"], words["symbol"], words["position"].format(label="").strip(), words["where"], words["text"])
    rows = [tuple(Entry(head, "head") for head in heads), *_unread_rows(key, submission)]
    return WorksheetData(words["not_read"], rows, _WIDTHS, (1, 0), protected=True)


def _unread_rows(key: Key, submission: Submission) -> Iterator[tuple[Entry, ...]]:
    order = {row.id: number for number, row in enumerate(key.rows)}
    for place in sorted(submission.unread, key=lambda place: (order[place[0]], place[1])):
        id, position = place
        problem = submission.unread[place]
        where = str(problem.location).rpartition("/")[2]
        label = key.label(position, id)
        yield tuple(map(Entry, (id, symbol_text(key.row(id), key), label, where, problem.message)))
