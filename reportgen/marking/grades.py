"""The marks of a class for the instructor: the rows of `grades.csv`, and the class on a page."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from functools import lru_cache
from pathlib import Path
from statistics import fmean, median
from typing import Any

from reportgen.base.template_folders import search_path
from reportgen.base.units import Language, write
from reportgen.base.words import load_words
from reportgen.drawing import Content
from reportgen.drawing.counts import bars, histogram
from reportgen.formula.vocabulary import Chapter
from reportgen.marking.feedback import points_text
from reportgen.marking.key import symbol_text
from reportgen.marking.marks import Marked, Marking, Verdict, points_of
from reportgen.marking.paper import DASH, cells, heading, paper, paragraph
from reportgen.marking.policy import Scale
from reportgen.report import TEXT_WIDTH, Block, Column, Document, Figure, InlineMath, Table, Text
from reportgen.report.key import Key, KeyRow, capitalised

Value = str | float | None

CLASSES = 10
"""Columns of the histogram."""
MOST_BARS = 24
"""Quantities with a bar of their own; there are fewer mistakes with names."""
WIDTHS = (32.0, 50.0, 24.0, 14.0, 14.0, 12.0, 14.0)
"""Widths (mm) of the columns of marks."""
SYMBOL, PART, SHARE = 22.0, 40.0, 18.0
"""Widths (mm) of the columns of questions; what they are has the rest."""


def grade_rows(
    markings: Sequence[Marking], language: Language, missing: Sequence[Key] = (), scale: Scale | None = None
) -> tuple[tuple[Value, ...], ...]:
    """Head and rows of `grades.csv`: who, points, the mark, points by part, all first errors, warnings, flags, remarks.

    `missing` are keys of those who handed nothing in; their points stay empty.
    """
    marks = scale or Scale()
    words = load_words(search_path(language))
    names = words["grades"]
    judged = {marking.key.row(cell.id).part for marking in markings for cell in marking.cells}
    parts = [part for part in Chapter if part in judged]
    owners = {part.name: part.title for marking in markings for part in marking.key.parts}
    head = (
        *(names[name] for name in ("id", "name", "class", "points", "out_of", "percent", "mark")),
        *(str(words["parts"][part]) for part in parts),
        *owners.values(),
        *(names[name] for name in ("firsts", "warnings", "flags", "elsewhere")),
    )
    people = {key.id: person(key) for key in (*(marking.key for marking in markings), *missing)}
    rows: list[tuple[Value, ...]] = [head]
    rows += [
        (
            *_who(marking.key),
            round(marking.points, 2),
            round(marking.out_of, 2),
            round(100 * marking.share, 1),
            marks.mark(marking.share),
            *(_points_of(marking, part) for part in parts),
            *(_points_of_owner(marking, owner) for owner in owners),
            "; ".join(_error_text(marking.key, cell, language) for cell in marking.first_errors),
            ", ".join(words["warning_names"][warning] for warning in marking.warnings),
            _flags(marking, words, people),
            ", ".join(_cell_text(marking.key, cell) for cell in marking.elsewhere),
        )
        for marking in markings
    ]
    rows += [(*_who(key), *(None,) * 4, *(None for _ in (*parts, *owners)), "", "", "", "") for key in missing]
    return tuple(rows)


def person(key: Key) -> str:
    """An assignment and whose it is: K225520103001 Nguyễn Văn An."""
    return " ".join(filter(None, (key.id, key.student.get("name", ""))))


def _error_text(key: Key, cell: Marked, language: Language) -> str:
    """A first error and its name: v_BA (3): scale forgotten."""
    return f"{_cell_text(key, cell)}: {_mistake_name(key, cell, language)}"


def _mistake_name(key: Key, cell: Marked, language: Language) -> str:
    """What the mistake behind a cell is called where its kind of work is marked."""
    return str(_words(search_path(language, key.part(cell.id).kind))["mistake_names"][cell.mistake or "none"])


def _section_name(key: Key, row: KeyRow, language: Language) -> str:
    """The section of a quantity, behind the title of its part."""
    section = str(_words(search_path(language, key.part(row.id).kind))["parts"][row.part])
    return ": ".join(filter(None, (key.title_of(key.owner(row.id)), section)))


@lru_cache(maxsize=8)
def _words(places: tuple[Path, ...]) -> Mapping[str, Any]:
    """The words of a kind of work, put together once for all cells of a class."""
    return load_words(places)


def _who(key: Key) -> tuple[str, str, str]:
    """Id (or else the assignment's), name and class of a student, as far as they are known."""
    student = key.student
    return (student.get("id", key.id), student.get("name", ""), student.get("class", ""))


def _points_of(marking: Marking, part: Chapter) -> float:
    return round(points_of(cell for cell in marking.cells if marking.key.row(cell.id).part is part)[0], 2)


def _points_of_owner(marking: Marking, owner: str) -> float:
    return round(points_of(cell for cell in marking.cells if marking.key.owner(cell.id) == owner)[0], 2)


def _cell_text(key: Key, cell: Marked) -> str:
    """A quantity and its position in one line: v_BA (3)."""
    symbol = symbol_text(key.row(cell.id), key)
    return f"{symbol} ({key.label(cell.position, cell.id)})" if cell.position else symbol


SHOWN = 4
"""Places that are listed of a flag."""


def _flags(marking: Marking, words: Mapping[str, Any], people: Mapping[str, str]) -> str:
    """Every flag in full: its kind, whose values, where, the chance of an honest sheet, cells it cost."""
    texts: list[str] = []
    for flag in marking.flags:
        cells = [cell for cell in marking.cells if (cell.id, cell.position) in {*flag.places[:SHOWN]}]
        where = ", ".join(_cell_text(marking.key, cell) for cell in cells) + (", …" if len(flag.places) > SHOWN else "")
        of = f" = {people.get(flag.other, flag.other)}" if flag.other else ""
        chance = f", p < {max(flag.chance, 1e-9):.0e}" if flag.kind.startswith("classmate") else ""
        taken = f", {words['warning_names']['taken']}: {len(flag.taken)}" if flag.taken else ""
        texts.append(f"{words['warning_names'][flag.kind]}{of} ({len(flag.places)}: {where}{chance}{taken})")
    return "; ".join(texts)


# --- the class on a page --------------------------------------------------------------------------


def class_document(
    markings: Sequence[Marking], title: str, language: Language, missing: Sequence[Key] = (), scale: Scale | None = None
) -> Document:
    """The page of a class; `title` names the assignment, `missing` are keys of those who handed nothing in."""
    words = load_words(search_path(language))
    page = words["class_page"]
    blocks: list[Block] = [
        heading(page["title"]),
        *_summary(markings, page, language, missing),
        _marks(markings, words, language, missing, scale or Scale()),
    ]
    if markings:
        blocks += [_spread(markings, page), *_shares(markings, words, language), *_errors(markings, words, language)]
    return paper(language, words, f"{page['title']} – {title}", blocks)


def _summary(
    markings: Sequence[Marking], page: Mapping[str, Any], language: Language, missing: Sequence[Key]
) -> Iterator[Block]:
    if markings:
        shares = [100 * marking.share for marking in markings]
        text = page["summary"].format(
            count=len(markings), mean=write(fmean(shares), 0, language), median=write(median(shares), 0, language)
        )
        yield paragraph(text)
    if missing:
        yield paragraph(page["missing"].format(count=len(missing)))


def _marks(
    markings: Sequence[Marking], words: Mapping[str, Any], language: Language, missing: Sequence[Key], scale: Scale
) -> Table:
    """A row for each student, in the order given."""
    names, page = words["grades"], words["class_page"]
    heads = (*(names[name] for name in ("id", "name", "class", "points", "out_of")), page["share"], names["mark"])
    rows = [
        (
            *_who(marking.key),
            points_text(marking.points, language),
            points_text(marking.out_of, language),
            write(100 * marking.share, 0, language),
            points_text(scale.mark(marking.share), language),
        )
        for marking in markings
    ]
    rows += [(*_who(key), *(DASH,) * 4) for key in missing]
    columns = tuple(Column(width, "left" if n < 2 else "center") for n, width in enumerate(WIDTHS))
    return Table(columns, (cells(heads),), tuple(map(cells, rows)), (Text(page["list"]),))


def _spread(markings: Sequence[Marking], page: Mapping[str, Any]) -> Figure:
    """How many students reached which share of the points; the highest class holds 100 %."""
    counts = Counter(min(int(CLASSES * marking.share), CLASSES - 1) for marking in markings)
    edges = [100 * n / CLASSES for n in range(CLASSES + 1)]
    scene = histogram([counts[n] for n in range(CLASSES)], edges, page["x_share"], page["students"])
    return Figure((scene,), (Text(page["histogram"]),))


def _shares(markings: Sequence[Marking], words: Mapping[str, Any], language: Language) -> Iterator[Block]:
    """Which share of the class was right, a section and a question a row, the hardest first.

    A value that follows from the student's own counts as right, an empty cell as wrong; what is not marked does
    not count.  Questions that all had right are only counted.
    """
    page, names = words["class_page"], words["answer_sheet"]
    asked = [
        (marking.key, marking.key.row(cell.id), cell) for marking in markings for cell in marking.cells if cell.worth
    ]
    sections = _right([(_section_name(key, row, language), cell) for key, row, cell in asked])
    parts = [(name, _percent(share, language)) for name, share in sections]
    widths = (Column(PART + 3 * SHARE, "left"), Column(SHARE))
    yield Table(
        widths,
        (cells((words["feedback"]["part"], page["right"])),),
        tuple(map(cells, parts)),
        (Text(page["by_section"]),),
    )
    rows = {row.id: (key, row) for key, row, _ in asked}
    questions = [(rows[id], share) for id, share in _right([(row.id, cell) for _, row, cell in asked])]
    hard = [(key, row, share) for (key, row), share in questions if share < 1]
    if hard:
        what = TEXT_WIDTH - SYMBOL - PART - SHARE
        heads = (words["table"]["symbol"], names["what"], words["feedback"]["part"], page["right"])
        lines = (
            cells(
                (
                    (InlineMath(row.symbol),),
                    capitalised(row.what),
                    _section_name(key, row, language),
                    _percent(share, language),
                )
            )
            for key, row, share in hard
        )
        columns = (Column(SYMBOL), Column(what, "left"), Column(PART, "left"), Column(SHARE))
        yield Table(columns, (cells(heads),), tuple(lines), (Text(page["by_question"]),))
    if easy := len(questions) - len(hard):
        yield paragraph(page["all_right"].format(count=easy))


def _right(judged: Sequence[tuple[str, Marked]]) -> list[tuple[str, float]]:
    """Each name's share of cells that are right or follow, the least first, else in the order given."""
    counts: dict[str, list[bool]] = {}
    for name, cell in judged:
        counts.setdefault(name, []).append(cell.verdict in (Verdict.right, Verdict.follows))
    return sorted(((name, fmean(right)) for name, right in counts.items()), key=lambda item: item[1])


def _percent(share: float, language: Language) -> str:
    return write(100 * share, 0, language)


def _errors(markings: Sequence[Marking], words: Mapping[str, Any], language: Language) -> Iterator[Block]:
    """First errors by quantity, then by the mistakes that were recognised."""
    page = words["class_page"]
    firsts = [(marking.key, cell) for marking in markings for cell in marking.first_errors]
    if not firsts:
        yield paragraph(page["nothing"])
        return
    symbols: dict[str, Content] = {cell.id: key.row(cell.id).symbol for key, cell in firsts}
    quantities = Counter(cell.id for _, cell in firsts).most_common()
    mistakes: list[tuple[Content, int]] = [
        *Counter[Content](_mistake_name(key, cell, language) for key, cell in firsts).most_common()
    ]
    by_quantity = [(symbols[id], count) for id, count in quantities]
    for title, counted in ((page["quantities"], by_quantity), (page["mistakes"], mistakes)):
        shown, others = counted[:MOST_BARS], counted[MOST_BARS:]
        if others:
            shown.append((page["others"].format(count=len(others)), sum(count for _, count in others)))
        names, counts = zip(*shown, strict=True)
        yield Figure((bars(names, counts, page["errors"]),), (Text(title),))
