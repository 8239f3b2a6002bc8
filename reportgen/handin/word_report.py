"""Read a submitted Word report for a key, and return a copy with comments."""

from __future__ import annotations

import re
from collections.abc import Collection
from pathlib import Path

from reportgen.base.errors import Fault, Location
from reportgen.base.records import replace
from reportgen.case.answer_key import Key
from reportgen.handin import FileReading, agree
from reportgen.handin.word_comments import MarginNote, with_comments
from reportgen.handin.word_file import open_word, word_faults
from reportgen.handin.word_reader import lines_of, read_report
from reportgen.handin.word_text import WordLocation
from reportgen.marking.feedback import cell_comment
from reportgen.marking.marking_data import Answer, Marking, Place
from reportgen.marking.marking_policy import Policy
from reportgen.marking.summary_comment import comment
from reportgen.marking.toleranced_key import words_of

MARKED = "marked.docx"


@word_faults()
def read(path: Path, data: bytes, key: Key, plans: object = None) -> FileReading:
    """Return the values of a key's quantities in a report; raise `RefusedError` if the file is rejected."""
    file = open_word(path, data)
    reading = read_report(file.blocks, key, str(path), file.tree)
    notes = (*file.notes, *reading.notes)
    unseen: frozenset[Place] = frozenset()
    if file.unseen:
        whole = read_report(file.all_blocks, key, str(path))
        unseen = frozenset(place for place, answer in whole.values.items() if not _has(reading, place, answer))
        unseen |= (whole.unread.keys() & reading.values.keys()) | (whole.unread.keys() - reading.unread.keys())
        if unseen:
            notes = (*notes, Fault("word-unseen", Location(str(path)), {"count": str(len(unseen))}))
    if not reading.values and not reading.unread:
        notes = (*notes, Fault("word-nothing", Location(str(path)), {"count": str(file.pictures)}))
    return replace(reading, notes=notes, unseen=unseen)


def _has(reading: FileReading, place: Place, answer: Answer) -> bool:
    return place in reading.values and agree(reading.values[place], answer)


@word_faults()
def names(path: Path, data: bytes, known: Collection[str]) -> Collection[str]:
    """Return the given names that occur in a report as words; raise `RefusedError`."""
    text = "\n".join(line.text for line in lines_of(open_word(path, data).blocks)).casefold()
    return [name for name in known if name and re.search(rf"(?<!\w){re.escape(name.casefold())}(?!\w)", text)]


@word_faults()
def marked(path: Path, data: bytes, reading: FileReading, marking: Marking, policy: Policy) -> tuple[str, bytes]:
    """Return the report with a comment at each number that needs one, and a summary at its head."""
    words = words_of(marking.key)
    remarks = [MarginNote("\n".join(comment(marking, policy)))]
    for cell in marking.cells:
        place = (cell.id, cell.position)
        own, counted = reading.values.get(place), marking.submission.values.get(place)
        fault = reading.unread.get(place)
        location = own.location if own is not None else fault.location if fault is not None else None
        # If a sheet counts, a different value in the report is not the one that was judged.
        judged = own is None or (counted is not None and agree(own, counted))
        text = cell_comment(cell, marking, words, policy.show_answers)
        if text and judged and isinstance(location, WordLocation):
            remarks.append(MarginNote(text, location.element))
    return MARKED, with_comments(open_word(path, data), remarks)
