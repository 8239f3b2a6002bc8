"""Item statistics of a class: facility and discrimination of each cell, question and section.

The facility is the mean share of its points that the class earned. The discrimination is the correlation between a
student's share of it and that of the rest of the sheet (the corrected item-total correlation). Source: L. Crocker, J.
Algina, Introduction to Classical and Modern Test Theory, 1986, ch. 14.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from reportgen.base.records import Record
from reportgen.base.template_folders import search_path
from reportgen.base.units import Language
from reportgen.base.words import load_words
from reportgen.case.answer_key import Key, KeyRow
from reportgen.marking.class_marks import DECIMALS, CellValue, section_name
from reportgen.marking.marking_data import Marked, Marking, Place, Verdict
from reportgen.marking.toleranced_key import symbol_text

LEAST = 10
"""Smallest number of students for a correlation: with fewer, 0.6 may be chance (1 in 20)."""


class Item(Record):
    """Cells of a class under one name, with their statistics.

    These are the number of students asked, the share of the points that they earned, its correlation with the rest of
    the sheet (NaN for few students or if one of the two does not vary), and the share left blank.
    """

    key: Key
    place: Place
    count: int
    facility: float
    discrimination: float
    blank: float

    @property
    def row(self) -> KeyRow:
        """The quantity of its first cell."""
        return self.key.row(self.place[0])


def items_by(markings: Sequence[Marking], name: Callable[[Key, Marked], object]) -> list[Item]:
    """Return an item for each name of the cells, in the order of the sheets; cells worth no points are left out."""
    of_name: dict[object, list[tuple[Marking, list[Marked]]]] = {}
    for marking in markings:
        own: dict[object, list[Marked]] = {}
        for cell in marking.cells:
            if cell.worth and cell.verdict is not Verdict.unread:
                own.setdefault(name(marking.key, cell), []).append(cell)
        for called, cells in own.items():
            of_name.setdefault(called, []).append((marking, cells))
    return [_item(students) for students in of_name.values()]


def _item(students: Sequence[tuple[Marking, Sequence[Marked]]]) -> Item:
    marking, cells = students[0]
    points = np.array([[sum(cell.points for cell in own), sum(cell.worth for cell in own)] for _, own in students])
    rest = np.array([[marking.points, marking.out_of] for marking, _ in students]) - points
    shares = points[:, 0] / points[:, 1]
    blanks = [cell.verdict is Verdict.blank for _, own in students for cell in own]
    return Item(
        marking.key,
        (cells[0].id, cells[0].position),
        len(students),
        float(shares.mean()),
        _correlation(shares, np.divide(rest[:, 0], rest[:, 1], out=np.zeros(len(rest)), where=rest[:, 1] > 0)),
        float(np.mean(blanks)),
    )


def _correlation(x: np.ndarray, y: np.ndarray) -> float:
    """Return the correlation of two rows [N]; NaN for fewer than `LEAST` students or if one row does not vary."""
    # 1e-9: floating-point noise is not variation.
    if len(x) < LEAST or np.ptp(x) < 1e-9 or np.ptp(y) < 1e-9:
        return float("nan")
    return float(np.corrcoef(x, y)[0, 1])


def by_section(markings: Sequence[Marking], language: Language) -> list[Item]:
    """Return an item for each section, separately for the parts of a coursework."""
    return items_by(markings, lambda key, cell: section_name(key, key.row(cell.id), language))


def by_question(markings: Sequence[Marking]) -> list[Item]:
    """Return an item for each quantity over its positions."""
    return items_by(markings, lambda key, cell: cell.id)


def by_cell(markings: Sequence[Marking]) -> list[Item]:
    """Return an item for each cell."""
    return items_by(markings, lambda key, cell: (cell.id, cell.position))


def question_rows(markings: Sequence[Marking], language: Language) -> tuple[tuple[CellValue, ...], ...]:
    """Return the head and the rows of `questions.csv`: sections, then questions, then cells."""
    names = load_words(search_path(language))["question_columns"]
    rows: list[tuple[CellValue, ...]] = [tuple(names.values())]
    levels = (by_section(markings, language), by_question(markings), by_cell(markings))
    for level, items in zip(("section", "question", "cell"), levels, strict=True):
        for item in items:
            named = () if level == "section" else (item.row.id, symbol_text(item.row, item.key), item.row.what)
            label = item.key.label(item.place[1], item.place[0]) if level == "cell" and item.place[1] else None
            rows.append(
                (
                    level,
                    section_name(item.key, item.row, language),
                    *(named or (None, None, None)),
                    label,
                    item.count,
                    *(_number(value) for value in (item.facility, item.discrimination, item.blank)),
                )
            )
    return tuple(rows)


def _number(value: float) -> float | None:
    """Return a number rounded to the decimals of a share, or None for NaN."""
    return None if np.isnan(value) else round(value, DECIMALS)
