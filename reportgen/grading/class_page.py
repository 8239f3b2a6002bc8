"""The class on a page: marks, how they are spread, where and how the class went wrong first."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from statistics import fmean, median
from typing import Any

from reportgen.answers.key import Key
from reportgen.answers.paper import paper
from reportgen.document.tree import (
    Block,
    Cell,
    Column,
    Document,
    Figure,
    Paragraph,
    Section,
    Table,
    Text,
)
from reportgen.figures.charts import bars, histogram
from reportgen.figures.scene import Content
from reportgen.grading.grades import who
from reportgen.grading.marks import Marking
from reportgen.grading.sentences import points_text
from reportgen.notation.numbers import Language, write
from reportgen.words import load_words, search_path

CLASSES = 10
"""Columns of the histogram."""
MOST_BARS = 24
"""Quantities told apart; there are fewer mistakes with names."""
WIDTHS = (34.0, 58.0, 28.0, 14.0, 14.0, 12.0)
"""Widths (mm) of the columns of marks."""


def class_document(
    markings: Sequence[Marking], title: str, language: Language, missing: Sequence[Key] = ()
) -> Document:
    """The page of a class; `title` names the assignment, `missing` are keys of those who handed nothing in."""
    words = load_words(search_path(language))
    page = words["class_page"]
    blocks: list[Block] = [
        Section(1, (Text(page["title"]),), numbered=False),
        *_summary(markings, page, language, missing),
        _marks(markings, words, language, missing),
    ]
    if markings:
        blocks += [_spread(markings, page), *_errors(markings, words)]
    return paper(language, words, f"{page['title']} – {title}", "", "", blocks)


def share(marking: Marking) -> float:
    """The share of the points that was earned, 0 where there are none."""
    return marking.points / marking.out_of if marking.out_of else 0.0


def _summary(
    markings: Sequence[Marking], page: Mapping[str, Any], language: Language, missing: Sequence[Key]
) -> Iterator[Block]:
    if markings:
        shares = [100 * share(marking) for marking in markings]
        text = page["summary"].format(
            count=len(markings),
            mean=write(fmean(shares), 0, language),
            median=write(median(shares), 0, language),
        )
        yield Paragraph((Text(text),))
    if missing:
        yield Paragraph((Text(page["missing"].format(count=len(missing))),))


def _marks(
    markings: Sequence[Marking], words: Mapping[str, Any], language: Language, missing: Sequence[Key]
) -> Table:
    """A row for each student, in the order given."""
    names, page = words["grades"], words["class_page"]
    heads = (*(names[name] for name in ("id", "name", "class", "points", "out_of")), page["share"])
    rows = [
        (
            *who(marking.key),
            points_text(marking.points, language),
            points_text(marking.out_of, language),
            write(100 * share(marking), 0, language),
        )
        for marking in markings
    ]
    rows += [(*who(key), "–", "–", "–") for key in missing]
    columns = tuple(Column(width, "left" if n < 2 else "center") for n, width in enumerate(WIDTHS))
    return Table(columns, (_texts(heads),), tuple(map(_texts, rows)), (Text(page["list"]),))


def _spread(markings: Sequence[Marking], page: Mapping[str, Any]) -> Figure:
    """How many students reached which share of the points; the highest class holds 100 %."""
    counts = Counter(min(int(CLASSES * share(marking)), CLASSES - 1) for marking in markings)
    edges = [100 * n / CLASSES for n in range(CLASSES + 1)]
    scene = histogram([counts[n] for n in range(CLASSES)], edges, page["x_share"], page["students"])
    return Figure((scene,), (Text(page["histogram"]),))


def _errors(markings: Sequence[Marking], words: Mapping[str, Any]) -> Iterator[Block]:
    """First errors by quantity, then by the mistakes that were recognised."""
    page = words["class_page"]
    firsts = [(marking.key, cell) for marking in markings for cell in marking.firsts]
    if not firsts:
        yield Paragraph((Text(page["nothing"]),))
        return
    rows = {cell.id: key.row(cell.id) for key, cell in firsts}
    quantities = Counter(cell.id for _, cell in firsts).most_common()
    mistakes = Counter(cell.mistake or "none" for _, cell in firsts).most_common()
    by_quantity = [(rows[id].symbol, count) for id, count in quantities]
    by_mistake = [(str(words["mistake_names"][name]), count) for name, count in mistakes]
    for title, tally in ((page["quantities"], by_quantity), (page["mistakes"], by_mistake)):
        names: list[Content] = [name for name, _ in tally[:MOST_BARS]]
        counts = [count for _, count in tally[:MOST_BARS]]
        if len(tally) > MOST_BARS:
            names.append(page["others"].format(count=len(tally) - MOST_BARS))
            counts.append(sum(count for _, count in tally[MOST_BARS:]))
        yield Figure((bars(names, counts, page["errors"]),), (Text(title),))


def _texts(texts: Iterable[str]) -> tuple[Cell, ...]:
    return tuple(Cell((Text(text),) if text else ()) for text in texts)
