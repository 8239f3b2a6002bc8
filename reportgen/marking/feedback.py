"""The feedback on a marked sheet: the student's workbook with colours and comments, and a page of text.

`feedback_book` and `feedback_document` make them.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import groupby
from typing import Any

import numpy as np

from reportgen import document as tree
from reportgen.base.errors import Problem
from reportgen.base.stable_digits import significant
from reportgen.base.units import Language, rounded, write
from reportgen.case.answer_key import Key, KeyRow
from reportgen.case.quantity_wording import sentence
from reportgen.document import Block, Column, Document, Inline, InlineMath, Inlines, Paragraph, Table, Text, plain
from reportgen.formula import Number
from reportgen.formula.calculation import ZERO
from reportgen.marking.answer_sheet import (
    NAMES,
    asked_positions,
    given_entry,
    grid,
    info_page,
    named_pages,
    page,
    sheet_rows,
)
from reportgen.marking.key_files import band, band_decimals
from reportgen.marking.marking_data import Amendment, Marked, Marking, Verdict, points_of
from reportgen.marking.marking_policy import Policy
from reportgen.marking.task_paper import DASH, cells, fields, heading, paper, paragraph, student_rows
from reportgen.marking.toleranced_key import shown_number, words_of
from reportgen.workbook import Book, Entry, WorksheetData
from reportgen.workbook.table_writing import CellStyle

STYLES: Mapping[Verdict, CellStyle] = {
    Verdict.right: "good",
    Verdict.follows: "linked",
    Verdict.wrong: "warn",
    Verdict.blank: "input",
    Verdict.unreadable: "doubt",
    Verdict.implausible: "doubt",
    Verdict.unread: "doubt",
}
FIRST: CellStyle = "bad"
"""Style of the first wrong value of a chain."""

POINTS, COUNT = 15.0, 16.5
"""Widths (mm) of columns of points and of counts."""

LEAST, MOST = 1e-6, 1e9
"""Range in which a student's value is written out; outside it, it is written with a power of ten."""


# --- the workbook ---------------------------------------------------------------------------------


def feedback_book(marking: Marking, show_answers: bool = True) -> Book:
    """Return the marked sheet as a workbook: the answer sheet's layout with points after each row and a total."""
    key, words = marking.key, words_of(marking.key)
    feedback = words["feedback"]
    marked = {(cell.id, cell.position): cell for cell in marking.cells}

    def filling(row: KeyRow, position: int) -> Entry | None:
        place = (row.id, position)
        if place in marked:
            return _marked(marking, words, marked[place], show_answers)
        if position not in row.positions:
            return given_entry(row, position)
        # A value that is not marked is shown as it was typed.
        answer = marking.submission.values.get(place)
        return Entry(answer.value if answer else None)

    def tail(row: KeyRow) -> Sequence[Entry]:
        own = [marked[row.id, k] for k in row.positions if (row.id, k) in marked]
        return _points(own) if own else ()

    heads = (feedback["points"], feedback["out_of"])

    def marked_page(name: str, part: Key) -> WorksheetData:
        positions = asked_positions(part)
        rows = grid(
            part,
            feedback["marked"],
            "",
            filling=filling,
            rows=sheet_rows(part),
            positions=positions,
            tail_head=heads,
            tail=tail,
        )
        between = (Entry(),) * (NAMES - 2 + len(positions))
        ids = {row.id for row in part.rows}
        total = _points([cell for cell in marking.cells if cell.id in ids], "bold")
        return page(name, (*rows, (Entry(), Entry(feedback["total"], "bold"), *between, *total)))

    pages = (marked_page(name, part) for name, part in named_pages(key, feedback["marked"]))
    legend = _legend(words, bool(marking.submission.unread))
    return Book((*pages, legend, info_page(key)), f"{feedback['marked']} {key.id}")


def _marked(marking: Marking, words: Mapping[str, Any], cell: Marked, show_answers: bool) -> Entry:
    """Return the entry of a judged cell: the student's value on the colour of its verdict."""
    comment = cell_comment(cell, marking, words, show_answers)
    return Entry(cell.written, FIRST if cell.first else STYLES[cell.verdict], comment)


def _points(judged: Sequence[Marked], style: CellStyle = "") -> tuple[Entry, Entry]:
    """Return two entries: the points earned and the points available."""
    earned, worth = points_of(judged)
    return (Entry(round(earned, 2), style), Entry(round(worth, 2), style))


def _legend(words: Mapping[str, Any], unread: bool) -> WorksheetData:
    """Return the page that explains the colours; it omits the colour of unread cells unless there are `unread` ones."""
    notes, verdicts = words["verdict_notes"], words["verdicts"]
    styles = [(verdict.value, style) for verdict, style in STYLES.items() if unread or verdict is not Verdict.unread]
    styles.insert(2, ("first", FIRST))
    rows = tuple(
        (Entry(str(verdicts[name]), style), Entry(str(notes[name]).partition(":")[0])) for name, style in styles
    )
    return WorksheetData(words["feedback"]["legend"], rows, (18.0, 80.0), protected=True)


# --- the page -------------------------------------------------------------------------------------


def feedback_document(marking: Marking, title: str, policy: Policy | None = None) -> Document:
    """Return the feedback on one submission, in the language of its assignment; `title` is the machine's name.

    The `policy` (default `Policy()`) has the deduction for lateness, and whether answers are shown.

    It contains no data of other students.
    """
    key, words = marking.key, words_of(marking.key)
    feedback, rules = words["feedback"], policy or Policy()
    score = sentence(
        feedback["score"],
        points=points_text(marking.points, key.language),
        out_of=points_text(marking.out_of, key.language),
    )
    blocks: list[Block] = [
        heading(feedback["title"]),
        *fields(((words["answer_sheet"]["kind"], title), *student_rows(key))),
        Paragraph((tree.Strong(score),)),
        *map(paragraph, lateness(marking, rules, words)),
        *(paragraph(words["warnings"][warning]) for warning in marking.warnings),
        *_section(feedback["firsts"], _firsts(marking, words, rules.show_answers)),
        *_section(feedback["followed"], _listed_cells(marking, words, _followed(marking), feedback["followed_lead"])),
        *_section(feedback["approximated"], _approximated(marking, words)),
        *_section(feedback["elsewhere"], _listed_cells(marking, words, marking.elsewhere, feedback["elsewhere_lead"])),
        *_section(feedback["left_blank"], _left_blank(marking, words)),
        *_section(feedback["amended"], _amended(marking, words)),
        *_section(feedback["unread"], _unread(marking, words)),
        *_section(feedback["noted"], _listed(marking.submission.notes)),
        _by_part(marking, words),
    ]
    owner = key.student.get("name", "")
    return paper(key.language, words, f"{feedback['title']} – {key.id}", blocks, owner, key.variant)


def _section(title: str, blocks: Iterable[Block]) -> tuple[Block, ...]:
    """Return a section with its heading, or () if it has no blocks."""
    inner = tuple(blocks)
    return (heading(title, 2), *inner) if inner else ()


def _firsts(marking: Marking, words: Mapping[str, Any], show_answers: bool) -> Iterator[Block]:
    """Yield the first error of each chain, in the order of the sheet."""
    firsts = [cell for cell in marking.first_errors if cell.given is not None]
    if not firsts:
        if not any(cell.given is not None for cell in marking.cells):
            yield paragraph(words["feedback"]["nothing_given"])
        elif not any(cell.verdict is Verdict.wrong for cell in marking.cells):
            yield paragraph(words["feedback"]["no_firsts"])
        return
    yield paragraph(words["feedback"]["firsts_lead"])
    lines = (_first(cell, marking.key, words, show_answers) for cell in firsts)
    yield tree.List(tuple((Paragraph(line),) for line in lines), ordered=True)


def _first(cell: Marked, key: Key, words: Mapping[str, Any], show_answers: bool) -> Inlines:
    """Return one error as text: quantity, position, given value, expected value (if shown), and mistake."""
    feedback, row = words["feedback"], key.row(cell.id)
    assert cell.written is not None
    number = _expected(row, cell)
    expected = tree.Value(Number(number.value, number.decimals, row.unit))
    label = key.label(cell.position, cell.id)
    return (
        InlineMath(row.symbol),
        *((Text(f" ({row.what})"),) if row.what else ()),
        *(sentence(feedback["at"], label=label) if label else ()),
        *sentence(feedback["yours"], value=_given_value(row, cell.written)),
        *(sentence(feedback["expected"], value=expected) if show_answers else ()),
        Text(". "),
        *mistake_inlines(cell, key, words),
    )


def _expected(row: KeyRow, cell: Marked) -> Number:
    """Return the expected value with the decimals of its tolerance, or the report's decimals if these are fewer."""
    width = band(row, cell.on_sheet.band)
    if not width:
        return shown_number(row, cell.on_sheet.expected)
    fine = band_decimals(width)
    return Number(cell.on_sheet.expected, fine if row.decimals is None else min(fine, row.decimals))


def _followed(marking: Marking) -> list[Marked]:
    """Return the values that differ from the key but earned points because they follow from own values."""
    return [cell for cell in marking.cells if cell.verdict is Verdict.follows and not cell.mistake]


def _approximated(marking: Marking, words: Mapping[str, Any]) -> Iterator[Block]:
    """Yield the values computed by an accepted approximation, each with its name."""
    chosen = [cell for cell in marking.cells if cell.verdict is Verdict.follows and cell.mistake]
    if chosen:
        lines = (mistake_inlines(cell, marking.key, words) for cell in chosen)
        yield tree.List(tuple((Paragraph(line),) for line in lines))


def _listed_cells(marking: Marking, words: Mapping[str, Any], chosen: Sequence[Marked], lead: str) -> Iterator[Block]:
    """Yield a paragraph that lists the chosen values by quantity, after a lead; nothing if there are none."""
    key = marking.key
    if not chosen:
        return
    line: list[Any] = []
    for id, of_row in groupby(chosen, lambda cell: cell.id):
        symbol = InlineMath(key.row(id).symbol)
        labels = ", ".join(key.label(cell.position, cell.id) for cell in of_row if cell.position)
        line += [Text("; ")] if line else []
        line += sentence(words["feedback"]["with_labels"], symbol=symbol, labels=labels) if labels else (symbol,)
    yield Paragraph((Text(f"{lead} "), *line, Text(".")))


def blank_rows(marking: Marking) -> dict[str, list[Marked]]:
    """Return the cells that earn marks and were left empty, by the id of their row, in the order of the sheet."""
    rows: dict[str, list[Marked]] = {}
    for cell in marking.cells:
        if cell.verdict is Verdict.blank and cell.worth:
            rows.setdefault(cell.id, []).append(cell)
    return rows


def blank_positions(marking: Marking, blank: Sequence[Marked]) -> str:
    """Return the labels of the positions at which a row is empty, or "" if the whole row is empty."""
    asked = sum(cell.id == blank[0].id for cell in marking.cells)
    return ", ".join(marking.key.label(cell.position, cell.id) for cell in blank) if len(blank) < asked else ""


def _left_blank(marking: Marking, words: Mapping[str, Any]) -> Iterator[Block]:
    """Yield each requested quantity that was left empty, with its positions if only some of them are empty."""
    lines = []
    for id, blank in blank_rows(marking).items():
        row, labels = marking.key.row(id), blank_positions(marking, blank)
        symbol = InlineMath(row.symbol)
        named = sentence(words["feedback"]["with_labels"], symbol=symbol, labels=labels) if labels else (symbol,)
        lines.append((*named, *((Text(f", {row.what}"),) if row.what else ())))
    if lines:
        yield paragraph(words["feedback"]["left_blank_lead"])
        yield tree.List(tuple((Paragraph(line),) for line in lines))


def _amended(marking: Marking, words: Mapping[str, Any]) -> Iterator[Block]:
    """Yield the instructor's corrections, one per line."""
    if marking.amendments:
        yield tree.List(tuple((Paragraph(amended(marking, one, words)),) for one in marking.amendments))


def _unread(marking: Marking, words: Mapping[str, Any]) -> Iterator[Block]:
    """Yield the values that were not read, after a sentence that says how they are treated."""
    submission = marking.submission
    lines = [*_listed((*submission.problems.values(), *submission.unread.values()))]
    if lines:
        yield paragraph(words["feedback"]["unread_lead"])
        yield from lines


def _listed(problems: Iterable[Problem]) -> Iterator[Block]:
    """Yield the problems of single cells, each with its location in the student's own file."""
    in_order = sorted(problems, key=lambda problem: problem.location)
    if in_order:
        texts = (f"{str(one.location).removeprefix(f'{one.location.file}:')}: {one.message}." for one in in_order)
        yield tree.List(tuple((paragraph(text),) for text in texts))


def _by_part(marking: Marking, words: Mapping[str, Any]) -> Table:
    """Return a table of verdict counts and points, with a row for each part and a total."""
    key, feedback = marking.key, words["feedback"]
    verdicts = [verdict for verdict in Verdict if any(cell.verdict is verdict for cell in marking.cells)]
    heads = (feedback["part"], *(str(words["verdicts"][v]) for v in verdicts), feedback["points"], feedback["out_of"])
    first = tree.TEXT_WIDTH - len(verdicts) * COUNT - 2 * POINTS
    columns = (Column(first, "left"), *(Column(COUNT),) * len(verdicts), Column(POINTS), Column(POINTS))
    rows = []
    for owner, of_owner in groupby(marking.cells, lambda cell: key.owner(cell.id)):
        here = list(of_owner)
        rows += [_counted((tree.Strong((Text(key.title_of(owner)),)),), here, verdicts, key)] if owner else []
        names = words_of(key.part(here[0].id))["parts"] if owner else words["parts"]
        for part, of_part in groupby(here, lambda cell: key.row(cell.id).part):
            rows.append(_counted(str(names[part]), list(of_part), verdicts, key))
    rows.append(_counted(feedback["total"], marking.cells, verdicts, key))
    return Table(columns, (cells(heads),), tuple(map(cells, rows)), (Text(feedback["by_part"]),))


def _counted(
    name: str | Inlines, judged: Sequence[Marked], verdicts: Sequence[Verdict], key: Key
) -> tuple[str | Inlines, ...]:
    counts = Counter(cell.verdict for cell in judged)
    numbers = (str(counts[verdict] or DASH) for verdict in verdicts)
    return (name, *numbers, *(points_text(value, key.language) for value in points_of(judged)))


# --- the instructor's word, and when it was handed in ---------------------------------------------


def amended(marking: Marking, amendment: Amendment, words: Mapping[str, Any]) -> Inlines:
    """Return the text of an instructor's correction: the cells, the points that they earn now, and the reason."""
    points, out_of = (points_text(value, marking.key.language) for value in marking.points_at(amendment.places))
    what = tree.Emph(amendment.what) if len(amendment.what) > 1 else amendment.what[0]
    return sentence(words["feedback"]["amended_line"], what=what, points=points, out_of=out_of, reason=amendment.reason)


def lateness(marking: Marking, policy: Policy, words: Mapping[str, Any]) -> Iterator[str]:
    """Yield a line with the days of delay, the deduction and the remaining mark; yield nothing if it is in time."""
    if marking.days_late:
        language = marking.key.language
        yield words["feedback"]["late"].format(
            days=marking.days_late,
            off=points_text(policy.deducted(marking.share, marking.days_late), language),
            mark=points_text(policy.mark(marking.share, marking.days_late), language),
            highest=points_text(policy.scale.highest, language),
        )


# --- verdicts and mistakes in words ---------------------------------------------------------------


def points_text(points: float, language: Language) -> str:
    """Return points with at most two decimals."""
    return write(rounded(points, 2), None, language)


def _given_value(row: KeyRow, value: float) -> Inline:
    """Return a student's value with its unit, to six figures; a value negligible beside the key's values is 0."""
    if abs(value) < ZERO * np.nanmax(np.abs(row.values), initial=0.0):
        value = 0.0
    return tree.Value(Number(significant(value, 6 if LEAST < abs(value) < MOST else 4), None, row.unit))


def mistake_inlines(cell: Marked, key: Key, words: Mapping[str, Any]) -> Inlines:
    """Return a sentence about the mistake; a general one if no mistake was recognised."""
    if not cell.mistake:
        return (Text(words["feedback"]["unnamed"]),)
    # The key may have no row for the quantity in which the mistake was made.
    row = key.find(cell.where) or key.row(cell.id)
    named = words_of(key.part(cell.id))["mistakes"] if key.parts else words["mistakes"]
    return sentence(named[cell.mistake], symbol=InlineMath(row.symbol), **cell.exchanged_labels(key))


def cell_comment(cell: Marked, marking: Marking, words: Mapping[str, Any], show_answers: bool) -> str:
    """Return the comment on a cell that is not right; "" if there is nothing to say."""
    key, place = marking.key, (cell.id, cell.position)
    notes = words["verdict_notes"]
    if cell.corrected:
        return str(words["feedback"]["amended_note"]).format(reason=cell.corrected)
    if cell.verdict is Verdict.right:
        return str(words["feedback"]["elsewhere_note"]) if cell.elsewhere else ""
    if cell.verdict in (Verdict.unreadable, Verdict.unread):
        return str(notes[cell.verdict]).format(message=marking.submission.problem(place).message)
    accepted = cell.verdict is Verdict.follows and bool(cell.mistake)
    lines = [] if accepted else [str(notes["first" if cell.first else cell.verdict])]
    if cell.mistake and (cell.first or accepted):
        lines.append(plain(mistake_inlines(cell, key, words), key.language))
    if show_answers:
        row = key.row(cell.id)
        number, width = _expected(row, cell), band(row, cell.on_sheet.band) or 0.0
        expected = str(words["feedback"]["expected_note"]).format(
            value=write(number.value, number.decimals, key.language),
            band=write(width, band_decimals(width), key.language),
            unit=row.unit,
        )
        # If there is no unit, a space is left before the full stop.
        lines.append(expected.replace(" .", "."))
    return "\n".join(lines)
