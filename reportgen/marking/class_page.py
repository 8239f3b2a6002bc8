"""Make the page about a class for the instructor (`class_document`): marks, question statistics, first errors."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from statistics import fmean, median
from typing import Any

from reportgen.base.template_folders import search_path
from reportgen.base.units import Language, nice_up, write
from reportgen.base.words import load_words
from reportgen.case.answer_key import capitalised
from reportgen.document import TEXT_WIDTH, Block, Column, Document, Figure, InlineMath, Inlines, Table, Text
from reportgen.drawing import Content
from reportgen.drawing.count_charts import bars, histogram
from reportgen.drawing.statistics_charts import intervals, scatter
from reportgen.formula.plain_text import formula
from reportgen.marking.class_marks import identity_of, mistake_name, open_cells, section_name, state
from reportgen.marking.feedback import amended, points_text
from reportgen.marking.item_statistics import Item, by_question, by_section
from reportgen.marking.marking_data import Marking, Unmarked
from reportgen.marking.marking_policy import Policy
from reportgen.marking.task_paper import DASH, cells, heading, paper, paragraph
from reportgen.marking.variant_fairness import VariantGroup, groups

CLASSES = 10
"""Number of columns of the histogram."""
MOST_BARS = 24
"""Largest number of quantities with their own bar; there are fewer named mistakes."""
WIDTHS = (32.0, 50.0, 24.0, 14.0, 14.0, 12.0, 14.0)
"""Widths (mm) of the columns of marks."""
SYMBOL, PART, SHARE, DISCRIMINATION = 22.0, 40.0, 18.0, 25.0
"""Widths (mm) of the columns of questions; the descriptions take the remaining width."""
VALUE = 34.0
"""Width (mm) of the column of a datum's values."""
TICKS = 5
"""Number of steps of an axis of marks."""

PageWords = Mapping[str, Any]


def class_document(
    markings: Sequence[Marking],
    title: str,
    language: Language,
    unmarked: Sequence[Unmarked] = (),
    policy: Policy | None = None,
) -> Document:
    """Return the page of a class; `title` names the assignment, `unmarked` are the students without marks."""
    words, rules = load_words(search_path(language)), policy or Policy()
    page = words["class_page"]
    blocks: list[Block] = [
        heading(page["title"]),
        *_summary(markings, page, language, unmarked),
        _marks(markings, words, language, unmarked, rules),
        *_unmarked(unmarked, words),
        *_late(markings, words, language, rules),
        *_amended(markings, words),
        *_open(markings, words),
    ]
    if markings:
        blocks += [_spread(markings, page), *_questions(markings, words, language)]
        blocks += [*_variants(groups(markings, rules, language), words, language, rules)]
        blocks += [*_errors(markings, words, language)]
    return paper(language, words, f"{page['title']} – {title}", blocks)


# --- who has which marks ----------------------------------------------------------------------------


def _summary(
    markings: Sequence[Marking], page: PageWords, language: Language, unmarked: Sequence[Unmarked]
) -> Iterator[Block]:
    if markings:
        shares = [100 * marking.share for marking in markings]
        text = page["summary"].format(
            count=len(markings), mean=write(fmean(shares), 0, language), median=write(median(shares), 0, language)
        )
        yield paragraph(text)
    counts = Counter(
        "unsettled" if row.unsettled is not None else "refused" if row.reasons else "missing" for row in unmarked
    )
    names = ("missing", "refused", "unsettled")
    yield from (paragraph(page[name].format(count=counts[name])) for name in names if counts[name])


def _marks(
    markings: Sequence[Marking], words: PageWords, language: Language, unmarked: Sequence[Unmarked], policy: Policy
) -> Table:
    """Return the table of marks, with a row for each student in the given order."""
    names, page = words["grades"], words["class_page"]
    heads = (*(names[name] for name in ("id", "name", "class", "points", "out_of")), page["share"], names["mark"])
    rows = [
        (
            *identity_of(marking.key),
            points_text(marking.points, language),
            points_text(marking.out_of, language),
            write(100 * marking.share, 0, language),
            points_text(policy.mark(marking.share, marking.days_late), language),
        )
        for marking in markings
    ]
    rows += [(*identity_of(one.key), *(DASH,) * 4) for one in unmarked]
    columns = tuple(Column(width, "left" if n < 2 else "center") for n, width in enumerate(WIDTHS))
    return Table(columns, (cells(heads),), tuple(map(cells, rows)), (Text(page["list"]),))


def _people(
    title: str, heads: Sequence[str], rows: Sequence[tuple[str, str, str | Inlines]], words: PageWords
) -> Iterator[Table]:
    """Yield a table of students with a remark on each; yield nothing if there are no rows."""
    if rows:
        names = words["grades"]
        columns = (*(Column(width, "left") for width in WIDTHS[:2]), Column(TEXT_WIDTH - sum(WIDTHS[:2]), "left"))
        yield Table(columns, (cells((names["id"], names["name"], *heads)),), tuple(map(cells, rows)), (Text(title),))


def _unmarked(unmarked: Sequence[Unmarked], words: PageWords) -> Iterator[Block]:
    """Yield the table of students without marks, with the reason: no submission, or one that could not be marked."""
    rows = [(*identity_of(one.key)[:2], state(one, words)) for one in sorted(unmarked, key=lambda one: not one.reasons)]
    yield from _people(words["class_page"]["unmarked"], (words["grades"]["state"],), rows, words)


def _late(markings: Sequence[Marking], words: PageWords, language: Language, policy: Policy) -> Iterator[Block]:
    """Yield the table of late submissions, with the days and the deduction."""
    page = words["class_page"]
    rows = [
        (
            *identity_of(marking.key)[:2],
            page["late_row"].format(
                days=marking.days_late,
                off=points_text(policy.deducted(marking.share, marking.days_late), language),
                mark=points_text(policy.mark(marking.share, marking.days_late), language),
            ),
        )
        for marking in markings
        if marking.days_late
    ]
    yield from _people(page["late"], (words["grades"]["late"],), rows, words)


def _amended(markings: Sequence[Marking], words: PageWords) -> Iterator[Block]:
    """Yield the table of the instructor's corrections."""
    rows = [
        (*identity_of(marking.key)[:2], amended(marking, amendment, words))
        for marking in markings
        for amendment in marking.amendments
    ]
    yield from _people(words["class_page"]["amended"], (words["grades"]["corrections"],), rows, words)


def _open(markings: Sequence[Marking], words: PageWords) -> Iterator[Block]:
    """Yield the table of students with unread values. These earn no points until somebody settles them."""
    rows = [(*identity_of(marking.key)[:2], text) for marking in markings if (text := open_cells(marking))]
    yield from _people(words["class_page"]["open"], (words["grades"]["unread"],), rows, words)


def _spread(markings: Sequence[Marking], page: PageWords) -> Figure:
    """Return a histogram of the share of points reached; its last column includes 100 %."""
    counts = Counter(min(int(CLASSES * marking.share), CLASSES - 1) for marking in markings)
    edges = [100 * n / CLASSES for n in range(CLASSES + 1)]
    scene = histogram([counts[n] for n in range(CLASSES)], edges, page["x_share"], page["students"])
    return Figure((scene,), (Text(page["histogram"]),), here=True)


# --- questions and variants -------------------------------------------------------------------------


def _questions(markings: Sequence[Marking], words: PageWords, language: Language) -> Iterator[Block]:
    """Yield facility and discrimination of each section and question, the hardest first.

    Questions that all students answered correctly are only counted, because they do not discriminate.
    """
    page, names = words["class_page"], words["answer_sheet"]
    yield heading(page["questions_title"], 2)
    yield paragraph(page["questions_lead"])
    statistics = (page["facility"], page["discrimination"])
    columns = (Column(SHARE), Column(DISCRIMINATION))
    sections = sorted(by_section(markings, language), key=lambda item: item.facility)
    rows = [(section_name(item.key, item.row, language), *_statistics(item, language)) for item in sections]
    yield Table(
        (Column(PART + 3 * SHARE, "left"), *columns),
        (cells((words["feedback"]["part"], *statistics)),),
        tuple(map(cells, rows)),
        (Text(page["by_section"]),),
    )
    questions = sorted(by_question(markings), key=lambda item: item.facility)
    hard = [item for item in questions if item.facility < 1 - 1e-9]
    if hard:
        what = TEXT_WIDTH - SYMBOL - PART - SHARE - DISCRIMINATION
        heads = (words["table"]["symbol"], names["what"], words["feedback"]["part"], *statistics)
        lines = (
            cells(
                (
                    (InlineMath(item.row.symbol),),
                    capitalised(item.row.what),
                    section_name(item.key, item.row, language),
                    *_statistics(item, language),
                )
            )
            for item in hard
        )
        by_width = (Column(SYMBOL), Column(what, "left"), Column(PART, "left"), *columns)
        yield Table(by_width, (cells(heads),), tuple(lines), (Text(page["by_question"]),))
    if easy := len(questions) - len(hard):
        yield paragraph(page["all_right"].format(count=easy))
    correlated = [item for item in hard if not math.isnan(item.discrimination)]
    if correlated:
        scene = scatter(
            [100 * item.facility for item in correlated],
            [item.discrimination for item in correlated],
            [20.0 * n for n in range(6)],
            [0.5 * n for n in range(-2, 3)],
            page["facility"],
            page["discrimination"],
        )
        yield Figure((scene,), (Text(page["scatter"]),), here=True)


def _statistics(item: Item, language: Language) -> tuple[str, str]:
    """Return the facility (per cent) and the discrimination of an item."""
    return write(100 * item.facility, 0, language), write(item.discrimination, 2, language)


def _variants(
    compared: Sequence[VariantGroup], words: PageWords, language: Language, policy: Policy
) -> Iterator[Block]:
    """Yield the marks by variant and by the drawn data, and say whether any group differs by more than chance."""
    if not compared:
        return
    page = words["class_page"]
    yield heading(page["variants_title"], 2)
    yield paragraph(page["some_differ" if any(group.differs for group in compared) else "none_differs"])

    def named(group: VariantGroup) -> str | Inlines:
        return page["variant"] if group.symbol is None else (InlineMath(group.symbol),)

    rows = [
        (
            named(group),
            group.value,
            str(group.count),
            write(group.mean, 2, language),
            write(group.spread, 2, language),
            page["differs"] if group.differs else "",
        )
        for group in compared
    ]
    heads = (page["datum"], page["value"], page["students"], page["mean"], page["spread"], "")
    rest = TEXT_WIDTH - SYMBOL - VALUE - 3 * SHARE
    widths = (Column(SYMBOL), Column(VALUE), *(Column(SHARE),) * 3, Column(rest, "left"))
    yield Table(widths, (cells(heads),), tuple(map(cells, rows)), (Text(page["by_variant"]),))
    step = nice_up(policy.scale.highest / TICKS, (1, 2, 2.5, 5))
    ticks = [step * n for n in range(math.ceil(policy.scale.highest / step) + 1)]
    # A figure has room for a limited number of lines.
    for start in range(0, len(compared), MOST_BARS):
        drawn = compared[start : start + MOST_BARS]
        scene = intervals(
            [f"{_plain_name(group, words, language)} {group.value}" for group in drawn],
            [group.mean for group in drawn],
            [group.spread for group in drawn],
            ticks,
            page["mean_axis"],
        )
        yield Figure((scene,), (Text(page["variants_figure"]),), here=True)


def _plain_name(group: VariantGroup, words: PageWords, language: Language) -> str:
    return str(words["class_page"]["variant"]) if group.symbol is None else f"{formula(group.symbol, language)} ="


# --- first errors -----------------------------------------------------------------------------------


def _errors(markings: Sequence[Marking], words: PageWords, language: Language) -> Iterator[Block]:
    """Yield the first errors, counted by quantity and then by recognised mistake."""
    page = words["class_page"]
    yield heading(page["errors_title"], 2)
    firsts = [(marking.key, cell) for marking in markings for cell in marking.first_errors]
    if not firsts:
        yield paragraph(page["nothing"])
        return
    symbols: dict[str, Content] = {cell.id: key.row(cell.id).symbol for key, cell in firsts}
    quantities = Counter(cell.id for _, cell in firsts).most_common()
    mistakes: list[tuple[Content, int]] = [
        *Counter[Content](mistake_name(key, cell, language) for key, cell in firsts).most_common()
    ]
    by_quantity = [(symbols[id], count) for id, count in quantities]
    for title, counted in ((page["quantities"], by_quantity), (page["mistakes"], mistakes)):
        most_frequent, others = counted[:MOST_BARS], counted[MOST_BARS:]
        if others:
            most_frequent.append((page["others"].format(count=len(others)), sum(count for _, count in others)))
        names, counts = zip(*most_frequent, strict=True)
        yield Figure((bars(names, counts, page["errors"]),), (Text(title),), here=True)
