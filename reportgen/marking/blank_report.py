"""Make the frame of a report (`frame_of`): its headings, its formulas in symbols, and a named blank for each result.

In a report written into this frame, every number can be assigned to its quantity and position.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from hashlib import sha256
from itertools import groupby

from reportgen.case import Case
from reportgen.case.answer_key import Key, KeyRow
from reportgen.document import Blank, Block, Document, Inline, InlineMath, Paragraph, Text
from reportgen.formula import Chain, refs
from reportgen.marking.marking_data import Place
from reportgen.marking.task_paper import fields, heading, paper, paragraph, student_rows
from reportgen.marking.toleranced_key import formula_in_symbols, symbol_text, words_of

LONGEST = 40
"""Largest number of characters in a bookmark's name."""


def blank_name(key: Key, place: Place) -> str:
    """Return the name of the blank at a place, with the label of its position: v.B@2."""
    id, position = place
    return f"{id}@{key.label(position, id)}" if position else id


def bookmark_name(name: str) -> str:
    """Return the name in the form allowed for bookmarks: letters, digits and underscores, at most 40 characters."""
    bare = f"rg_{re.sub('[^A-Za-z0-9]', '_', name)}"
    # The hash keeps names different that differ only in removed characters.
    return f"{bare[: LONGEST - 7]}_{sha256(name.encode()).hexdigest()[:6]}"


def blanks(key: Key) -> dict[str, Place]:
    """Return the places of a key by the names of their blanks and of their bookmarks."""
    places = [(row.id, k) for row in key.asked for k in row.positions]
    names = {blank_name(key, place): place for place in places}
    return names | {bookmark_name(name): place for name, place in names.items()}


def frame_of(case: Case, key: Key) -> Document:
    """Return the frame for everything that a key asks for, in the language of the case."""
    words = words_of(key)["frame"]
    student = [block for pair in student_rows(key) for block in fields([pair])]
    blocks = (heading(words["title"]), *student, paragraph(words["note"]), *_works(case, key))
    owner = key.student.get("name", "")
    return paper(key.language, words_of(key), case.course, blocks, owner, key.variant)


def _works(case: Case, key: Key) -> Iterator[Block]:
    """Yield the parts of a coursework in order, or the single work."""
    if not key.parts:
        yield from _work(case, key, key, {row.id: row.id for row in key.rows})
        return
    for part, (title, page) in zip(key.parts, key.pages, strict=True):
        yield heading(title)
        own = {row.id: part.own(row.id) for row in page.rows}
        yield from _work(case.parts[part.name], page, key, own)


def _work(case: Case, page: Key, whole: Key, own: Mapping[str, str]) -> Iterator[Block]:
    """Yield the single values by chapter, then each position with its chapters."""
    names = words_of(page)["parts"]
    positions = sorted({k for row in page.asked for k in row.positions})
    for position in positions:
        rows = [row for row in page.asked if position in row.positions]
        said = words_of(page)["answer_sheet"]["position"].format(label=page.label(position))
        yield heading(said if position else words_of(page)["frame"]["single"], 2)
        for part, members in groupby(rows, lambda row: row.part):
            yield heading(str(names[part]), 3)
            for row in members:
                yield _line(case, whole, row, position, own)


def _line(case: Case, whole: Key, row: KeyRow, position: int, own: Mapping[str, str]) -> Paragraph:
    """Return a line: description, formula in symbols if all its inputs have rows, and the blank with its unit."""
    ledger = case.ledger
    known = set(own.values())
    definition = ledger[own[row.id]].definition if own[row.id] in ledger else None
    formula: Inline = InlineMath(row.symbol)
    if definition is not None and refs(definition) and all(ref in known for ref in refs(definition)):
        formula = InlineMath(Chain((row.symbol, formula_in_symbols(ledger, own[row.id]))))
    name = blank_name(whole, (row.id, position))
    label = whole.label(position, row.id)
    title = f"{symbol_text(row, whole)} ({label})" if position else symbol_text(row, whole)
    what = (Text(f"{row.named}: "),) if row.named else ()
    unit = (Text(f" {row.unit}"),) if row.unit else ()
    return Paragraph((*what, formula, Text(" = "), Blank(name, bookmark_name(name), title), *unit))
