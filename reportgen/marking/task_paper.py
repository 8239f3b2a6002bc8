"""The task of an assignment as a document (`task_of`), and building blocks of all papers beside the report."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import partial
from itertools import groupby
from typing import Any

from reportgen import document as tree
from reportgen.base.records import replace
from reportgen.base.units import Language
from reportgen.case import AskedFor, Case, CaseOfParts, LoadedAssignment
from reportgen.case.answer_key import Key, KeyRow, Role
from reportgen.document import Block, Cell, Column, Document, InlineMath, Inlines, Paragraph, Table, Text
from reportgen.document.numbering import number
from reportgen.drawing.label_size import box
from reportgen.formula import Number
from reportgen.formula.vocabulary import KeyChapter
from reportgen.marking.answer_sheet import asked_positions, info_rows, open_cells
from reportgen.marking.toleranced_key import words_of
from reportgen.report.context import PLATES_UP_TO

MOST_POSITIONS, MOST_FILLED = 8, 4
"""Largest numbers of position columns in a table: for given values, and for values to be filled in."""
KNOWN_DIGITS = 5
"""Number of figures of the values given at each position."""
SYMBOL, UNIT, VALUE = 16.0, 22.0, 15.3
"""Widths (mm) of the columns of the answer sheet."""
WIDEST = 30.0
"""Largest width (mm) of a column that is filled in by hand."""
LAST = 12
"""Smallest number of rows on the last page of a sheet, so that it is never nearly empty."""
LEAST_WHAT = 50.0
"""Smallest width (mm) for the description of a row, unless a formula needs more."""
TABLE_SIZE, PADDING = 10.0, 4.0
"""Font size (points) of a table, and the padding of its cells (mm)."""


def paper(
    language: Language,
    words: Mapping[str, Any],
    title: str,
    blocks: Iterable[Block],
    owner: str = "",
    variant: str = "",
) -> Document:
    """Return a numbered document without a cover.

    Its header has the title on the left and the variant on the right; `owner` is its author.
    """
    note = words["variant"].format(variant=variant) if variant else ""
    terms = words["document"]
    header, footer = (title, note), ("", terms["page"])
    return number(
        Document(
            language=language,
            title=title,
            author=owner,
            header=header,
            footer=footer,
            words=tree.Words.among(words, language),
            blocks=tuple(blocks),
        )
    )


def fields(pairs: Iterable[tuple[str, str]]) -> Iterable[Block]:
    """Return labelled texts, one per line, as typed; an empty text becomes a dotted line to fill in."""
    lines: list[Text | tree.Strong | tree.LineBreak] = []
    empty: list[Block] = []
    for label, text in pairs:
        if not text:
            empty.append(tree.BlankLine(f"{label}:"))
            continue
        lines += [*([tree.LineBreak()] if lines else []), Text(f"{label}: "), tree.Strong((Text(text),))]
    return (*((Paragraph(tuple(lines)),) if lines else ()), *empty)


def heading(title: str, level: int = 1) -> tree.Section:
    """Return a heading without a number."""
    return tree.Section(level, (Text(title),), numbered=False)


def paragraph(text: str) -> Paragraph:
    """Return a paragraph of plain text."""
    return Paragraph((Text(text),))


def student_rows(key: Key) -> tuple[tuple[str, str], ...]:
    """Return label and text of the assignment, the variant (if any) and the student."""
    assignment, _, variant, *student = info_rows(key)
    return (assignment, *((variant,) if key.variant else ()), *student)


# --- cells of tables ------------------------------------------------------------------------------


DASH = "–"
"""Text of a cell whose value does not exist."""


def cells(contents: Iterable[str | Number | Inlines]) -> tuple[Cell, ...]:
    """Return the cells of a row from texts, numbers or other inline content."""
    return tuple(Cell(_inlines(content)) for content in contents)


def _inlines(content: str | Number | Inlines) -> Inlines:
    if isinstance(content, Number):
        return (tree.Value(content),) if content.value == content.value else (Text(DASH),)
    return content if isinstance(content, tuple) else (Text(content),) if content else ()


def symbol_inlines(row: KeyRow, with_id: bool) -> Inlines:
    """Return a quantity's symbol, optionally with its id below."""
    return (InlineMath(row.symbol), *((tree.LineBreak(), Text(row.id)) if with_id else ()))


def symbol_width(unnamed: Iterable[str], least: float) -> float:
    """Return the width (mm) of a column of symbols, with the ids of `unnamed` rows below them."""
    return max((least, *(box(id, TABLE_SIZE).width + PADDING for id in unnamed)))


def unnamed_rows(rows: Iterable[KeyRow]) -> frozenset[str]:
    """Return the ids of rows that share both symbol and description with another row: only these print the id."""
    rows = tuple(rows)
    count = Counter((row.symbol, row.described) for row in rows)
    return frozenset(row.id for row in rows if count[row.symbol, row.described] > 1)


# --- the task -------------------------------------------------------------------------------------


def task_of(case: Case, key: Key, by_section: bool = False, self_check: bool = True) -> Document:
    """Return the task of a case, from the given data to the empty answer sheet of `key`; it contains no answers.

    `by_section` puts each section of the sheet on separate pages, headed by its student. `self_check` adds instructions
    for checking the sheet. Raises `TemplateError`.
    """
    if isinstance(case, CaseOfParts):
        pages = zip(case.parts.values(), key.pages, strict=True)
        return case.joined_task([task_of(part, page, by_section, self_check) for part, (_, page) in pages])
    assert isinstance(case, LoadedAssignment), "a case without parts is a single work"
    return case.bounded(partial(_task, key=key, by_section=by_section, self_check=self_check))


def _task(case: LoadedAssignment, key: Key, by_section: bool, self_check: bool) -> Document:
    title, blocks = case.question(_asked_for(case, key, by_section, self_check))
    student = case.assignment.report.student.name or ""
    contents = (*title, *fields(student_rows(key)), *blocks)
    language = case.assignment.language
    document = paper(language, case.words, case.course, contents, student, key.variant)
    # The course is the page header; programs that open the file use its own title.
    named = next((tree.plain(block.title, language) for block in title if isinstance(block, tree.Section)), "")
    return replace(document, title=f"{named or case.course} – {key.id}")


def given_of(case: Case, key: Key) -> Document:
    """Return the part of a task before its answer sheet: given data, requested values, positions.

    It has the blocks of `task_of` without the title, the student and the sheet with its instructions. Raise
    `TemplateError`.
    """
    if isinstance(case, CaseOfParts):
        pages = zip(case.parts.values(), key.pages, strict=True)
        first, *others = [_bare(part, page) for part, (_, page) in pages]
        # A handout replaces the title and the line below it at the beginning of each further part.
        head = (heading(case.title), Paragraph(()))
        return case.joined_task([first, *(replace(one, blocks=(*head, *one.blocks)) for one in others)])
    return _bare(case, key)


def _bare(case: Case, key: Key) -> Document:
    assert isinstance(case, LoadedAssignment), "a case without parts is a single work"
    return case.bounded(partial(_given, key=key))


def _given(case: LoadedAssignment, key: Key) -> Document:
    title, blocks = case.question(_asked_for(case, key, by_section=False, self_check=False))
    # The last two headings are those of the instructions and of the sheet.
    *_, instructions, _ = (index for index, block in enumerate(blocks) if isinstance(block, tree.Section))
    # Keep the blocks below the title, like headings of level 2.
    document = paper(case.assignment.language, case.words, case.course, (title[0], *blocks[:instructions]))
    return replace(document, blocks=document.blocks[1:])


def _asked_for(case: Case, key: Key, by_section: bool, self_check: bool) -> AskedFor:
    """Return the requests of a key's answer sheet, with the values given at the positions."""
    asked = asked_positions(key)
    known = range(1, len(case.span.labels) + 1) if case.span.count <= PLATES_UP_TO else asked
    return AskedFor(
        answers=empty_sheet(key, by_section),
        positions=tuple(map(key.label, asked)),
        known=tuple(_known_tables(key, known)),
        scales=any(row.role is Role.scale for row in key.asked),
        by_section=by_section,
        self_check=self_check,
    )


def empty_sheet(key: Key, by_section: bool) -> tuple[Block, ...]:
    """Return the answer sheet to fill in by hand; `by_section` puts each section on separate pages."""
    return tuple(_sections(key) if by_section else answer_tables(key))


def _sections(key: Key) -> Iterator[Block]:
    """Yield the empty sheet with a page break before each section but the first, and the student's name in each."""
    whose = " – ".join(filter(None, (key.id, key.student.get("name", ""), key.student.get("id", ""))))
    parts = [part for part in KeyChapter if any(row.part is part for row in key.asked)]
    for part in parts:
        if part is not parts[0]:
            yield tree.PageBreak()
        yield heading(str(words_of(key)["parts"][part]), 2)
        yield paragraph(whose)
        yield from answer_tables(key, part)


def answer_tables(key: Key, only: KeyChapter | None = None) -> Iterator[Table]:
    """Yield the empty sheet, or `only` one part of it, as tables to fill in by hand.

    Each table has as many positions as fit. The first one has the single values, in a cell across all positions.
    """
    rows = [row for row in key.rows if row.positions and only in (None, row.part)]
    positions = sorted({k for row in rows if not row.single for k in row.positions})
    for some in list(_split(positions, MOST_FILLED)) or [()]:
        first = list(some) == positions[: len(some)]
        asked = [row for row in rows if (first if row.single else set(row.positions) & set(some))]
        if asked:
            yield _answer_table(key, asked, some, only is None)


def _known_tables(key: Key, positions: Sequence[int]) -> Iterator[Table]:
    """Yield tables of the values given at each position (the crank's angle, a load that follows the motion)."""
    words = words_of(key)
    caption = (Text(str(words["answer_sheet"]["known"])),)
    rows = [
        row for row in key.rows if row.role is Role.given and not row.single and row.part is not KeyChapter.formulas
    ]
    for some in _split(positions, MOST_POSITIONS) if rows else ():
        head = (words["table"]["symbol"], words["table"]["unit"], *map(key.label, some))
        body = (cells((symbol_inlines(row, False), row.unit, *(_known_number(row, k) for k in some))) for row in rows)
        columns = (Column(SYMBOL), Column(UNIT), *(Column(VALUE),) * len(some))
        yield Table(columns, (cells(head),), tuple(body), caption)


def _known_number(row: KeyRow, position: int) -> Number:
    """Return a given number shortened for a column; an angle may have many figures if it is computed from lengths."""
    return Number(float(f"{row.printed[row.at(position)]:.{KNOWN_DIGITS}g}"), None)


def _split(positions: Sequence[int], most: int) -> Iterator[Sequence[int]]:
    """Yield the positions in the smallest number of groups of nearly equal size with at most `most` members."""
    count = -(-len(positions) // most)
    for start in range(count):
        yield positions[start * len(positions) // count : (start + 1) * len(positions) // count]


def _heads(key: Key, positions: Sequence[int]) -> tuple[str, ...]:
    """Return the headings of the columns of a table."""
    words = words_of(key)
    table, sheet = words["table"], words["answer_sheet"]
    labels = [key.label(k) for k in positions]
    if len(labels) == 1:
        labels = [sheet["at"].format(label=labels[0])]
    return (table["symbol"], sheet["what"], table["unit"], *(labels or [table["value"]]))


def _answer_table(key: Key, rows: Sequence[KeyRow], positions: Sequence[int], headed: bool) -> Table:
    """Return a table with one quantity and its description per row; if `headed`, each part begins with its name."""
    unnamed, open_at = unnamed_rows(rows), open_cells(key)
    count = max(len(positions), 1)
    symbol = symbol_width(unnamed, SYMBOL)
    rest = tree.TEXT_WIDTH - symbol - UNIT
    # A formula is broken only at its equals sign.
    formulas = (one.expression for row in rows for one in row.described if isinstance(one, InlineMath))
    least = max((LEAST_WHAT, *(box(formula, TABLE_SIZE).width + PADDING for formula in formulas)))
    value = min((rest - least) / count, WIDEST)
    columns = (Column(symbol), Column(rest - value * count, "left"), Column(UNIT), *(Column(value),) * count)

    def fill_in(row: KeyRow) -> tuple[Cell, ...]:
        what = cells((symbol_inlines(row, row.id in unnamed), row.described, row.unit))
        if row.single:
            return (*what, Cell((Text("" if 0 in open_at[row.id] else DASH),), span=count))
        return (*what, *cells("" if k in open_at[row.id] else DASH for k in positions))

    body: list[tuple[Cell, ...]] = []
    for part, members in groupby(rows, lambda row: row.part):
        if headed:
            body.append((Cell((tree.Strong((Text(str(words_of(key)["parts"][part])),)),), span=len(columns)),))
        body += map(fill_in, members)
    return Table(columns, (cells(_heads(key, positions)),), tuple(body), last=LAST)
