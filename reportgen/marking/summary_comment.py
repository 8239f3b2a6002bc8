"""The summary that a student reads first, in a few lines of plain text: `comment`, `unmarked_comment`.

It fits the comment field of a learning platform, or can be pasted.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import groupby
from pathlib import Path
from typing import Any

from reportgen.case.answer_key import Key
from reportgen.document import Text, plain
from reportgen.marking.class_marks import open_text
from reportgen.marking.feedback import amended, blank_positions, blank_rows, lateness, mistake_inlines, points_text
from reportgen.marking.marking_data import Marked, Marking, Unmarked, points_of
from reportgen.marking.marking_policy import Policy
from reportgen.marking.toleranced_key import symbol_text, words_of

FIRSTS = 5
"""Largest number of first mistakes listed; the feedback page lists them all."""

BLANKS = 10
"""Largest number of blank quantities listed; the feedback page lists them all."""


def comment(marking: Marking, policy: Policy) -> Iterator[str]:
    """Yield the lines: mark, lateness, first mistakes by name, points by chapter, the instructor's corrections.

    They also list the values not read and the quantities left blank. Long lists of mistakes and of values are cut
    (`FIRSTS`, `BLANKS`). The lines give no answers.
    """
    return (plain((Text(line),), marking.key.language) for line in _lines(marking, policy))


def _lines(marking: Marking, policy: Policy) -> Iterator[str]:
    key, words = marking.key, words_of(marking.key)
    said, language = words["comment"], key.language
    yield said["score"].format(
        mark=points_text(policy.mark(marking.share, marking.days_late), language),
        highest=points_text(policy.scale.highest, language),
        points=points_text(marking.points, language),
        out_of=points_text(marking.out_of, language),
    )
    yield from lateness(marking, policy, words)
    yield from (words["warnings"][warning] for warning in marking.warnings)
    firsts = [cell for cell in marking.first_errors if cell.given is not None]
    given = any(cell.given is not None for cell in marking.cells)
    yield said["firsts" if firsts else "no_firsts" if given else "nothing_given"]
    yield from (
        f"– {_named(cell, key)}: {plain(mistake_inlines(cell, key, words), language)}" for cell in firsts[:FIRSTS]
    )
    if len(firsts) > FIRSTS:
        yield said["others"].format(count=len(firsts) - FIRSTS)
    yield from _open(marking, said)
    yield from _left_blank(marking, said)
    yield said["by_part"].format(parts="; ".join(_by_part(marking, words)))
    if marking.amendments:
        yield f"{words['feedback']['amended']}:"
        yield from (f"– {plain(amended(marking, one, words), language)}" for one in marking.amendments)


def _open(marking: Marking, said: Mapping[str, Any]) -> Iterator[str]:
    """Yield the values that were not read, and say how they are treated."""
    if marking.open:
        yield said["open"].format(count=len(marking.open))
        yield from (f"– {open_text(marking, cell)}" for cell in marking.open[:FIRSTS])
    if len(marking.open) > FIRSTS:
        yield said["others"].format(count=len(marking.open) - FIRSTS)


def unmarked_comment(student: Unmarked) -> Iterator[str]:
    """Yield the lines for a student whose own files were read too incompletely for a mark.

    They say how much was read, and which values are open.
    """
    key, submission = student.key, student.unsettled
    assert submission is not None, "only read work is unsettled"
    said = words_of(key)["comment"]
    if submission.is_unrecognised:
        yield said["unrecognised"]
    else:
        yield said["unsettled"].format(read=round(100 * submission.share_read), count=len(submission.unread))
    for note in (*submission.notes, *submission.unread.values()):
        yield f"– {Path(note.location.file).name}: {note.message}" + (f" ({note.hint})" if note.hint else "")


def _named(cell: Marked, key: Key) -> str:
    """Return a quantity with its position and description: v_BA (3), velocity of B about A."""
    row = key.row(cell.id)
    where = f"{symbol_text(row, key)} ({key.label(cell.position, cell.id)})" if cell.position else symbol_text(row, key)
    return ", ".join(filter(None, (where, row.what)))


def _left_blank(marking: Marking, said: Mapping[str, Any]) -> Iterator[str]:
    """Yield the requested quantities that were left empty, one per line."""
    rows = blank_rows(marking)
    if rows:
        yield said["left_blank"]
    for id, blank in list(rows.items())[:BLANKS]:
        row, labels = marking.key.row(id), blank_positions(marking, blank)
        symbol = symbol_text(row, marking.key)
        yield f"– {', '.join(filter(None, (f'{symbol} ({labels})' if labels else symbol, row.what)))}"
    if len(rows) > BLANKS:
        yield said["others"].format(count=len(rows) - BLANKS)


def _by_part(marking: Marking, words: Mapping[str, Any]) -> Iterator[str]:
    """Yield the points of each chapter that earns any, after the title of its part."""
    key = marking.key
    for (owner, part), of_part in groupby(marking.cells, lambda cell: (key.owner(cell.id), key.row(cell.id).part)):
        cells = list(of_part)
        earned, worth = points_of(cells)
        if worth:
            names = words_of(key.part(cells[0].id))["parts"] if owner else words["parts"]
            title = ": ".join(filter(None, (key.title_of(owner), str(names[part]))))
            yield f"{title} {points_text(earned, key.language)}/{points_text(worth, key.language)}"
