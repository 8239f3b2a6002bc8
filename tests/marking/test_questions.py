"""Facility, discrimination and the comparison of variants, against the textbook's definitions worked out by hand."""

from __future__ import annotations

import math

import numpy as np
import pytest

from reportgen.base.records import replace
from reportgen.case.answer_key import Role
from reportgen.drawing import Circle
from reportgen.drawing.statistics_charts import intervals, scatter
from reportgen.formula import Symbol
from reportgen.formula.vocabulary import KeyChapter
from reportgen.marking.item_statistics import by_cell, by_question, by_section, question_rows
from reportgen.marking.marking_data import Marking, Submission, Verdict
from reportgen.marking.marking_policy import Policy
from reportgen.marking.variant_fairness import groups, variant_rows
from tests.lanes import proof
from tests.marking.keys import row, small_key
from tests.marking.test_feedback import cell

RIGHT = {True: Verdict.right, False: Verdict.wrong}


def sheet(number: int, answers: list[bool], length: float = 0.15) -> Marking:
    """A student with right and wrong answers at ω₁ and at the four positions of v_B."""
    key = small_key("en", f"crank-{number:02}")
    given = row("l.AB", KeyChapter.data, Symbol("l", "AB"), "length", "m", [length], Role.given, decimals=None)
    key = replace(key, rows=(given, *key.rows[1:]))
    places = [("omega.1", 0), *(("v.B", k) for k in (1, 2, 3, 4))]
    cells = [cell(id, k, RIGHT[right], 1.0, 1.0) for (id, k), right in zip(places, answers, strict=True)]
    return Marking(key, Submission(key.id, "a.csv", {}, {}), tuple(cells))


CLASS = [
    sheet(1, [True, True, True, True, True]),
    sheet(2, [True, True, True, False, False]),
    sheet(3, [False, True, False, False, False]),
    sheet(4, [False, True, True, True, False]),
]
TWELVE = CLASS * 3
"""The same shares and correlations, of enough students."""


def test_facility_is_the_mean_share_of_the_points() -> None:
    assert {one.place[0]: one.facility for one in by_question(CLASS)} == {"omega.1": 0.5, "v.B": (4 + 2 + 1 + 3) / 16}
    assert [one.facility for one in by_cell(CLASS)] == [0.5, 1.0, 0.75, 0.5, 0.25]
    (section,) = by_section(CLASS, "en")
    assert section.facility == 12 / 20


def test_discrimination_is_the_correlation_with_the_rest_of_the_sheet() -> None:
    """ω₁: 1 1 0 0 against 4 2 1 3 of v_B, off their means by ½ ½ −½ −½ and 1½ −½ −1½ ½: products 1, squares 1 and 5."""
    omega = by_question(TWELVE)[0]
    assert omega.discrimination == pytest.approx(1 / math.sqrt(1 * 5))
    assert math.isnan(by_cell(TWELVE)[1].discrimination)
    assert math.isnan(by_question(CLASS)[0].discrimination)


def test_the_table_has_a_row_for_each_section_question_and_cell() -> None:
    head, *rows = question_rows(CLASS, "en")
    levels = [line[0] for line in rows]
    assert levels == ["section", "question", "question", *["cell"] * 5]
    named = dict(zip(head, rows[-1], strict=True))
    assert (named["symbol"], named["position"], named["students"], named["facility"]) == ("v_B", "4", 4, 0.25)


def test_harder_variants_are_told_from_chance() -> None:
    """24 students whose marks differ by one third between two lengths, and by nothing between two others."""
    spread = np.random.default_rng(1).permutation(24)
    hard = [sheet(k, [n % 2 == 0, n % 3 == 0, False, False, n % 4 == 0], 0.1) for k, n in enumerate(spread[:12])]
    easy = [sheet(k + 12, [n % 2 == 0, True, True, True, n % 4 == 0], 0.2) for k, n in enumerate(spread[12:])]
    found = groups([*hard, *easy], Policy(), "en")
    assert [(one.value, one.count, one.differs) for one in found] == [("0.1 m", 12, True), ("0.2 m", 12, True)]
    marks = [one.share * 10 for one in hard]
    assert found[0].mean == pytest.approx(np.mean(marks), abs=0.06)
    assert found[0].spread == pytest.approx(np.std(marks, ddof=1), abs=0.06)
    alike = [replace(one, key=sheet(n, [True] * 5, 0.1 + 0.1 * (n % 2)).key) for n, one in enumerate(easy)]
    assert not any(one.differs for one in groups(alike, Policy(), "en"))
    assert len(variant_rows(found, "en")) == 3


@proof
def test_chance_alone_seldom_makes_a_variant_look_harder() -> None:
    """All comparisons of a class together err once in 20: of 60 classes 3, and by 3 σ of the binomial at most 8."""
    generator = np.random.default_rng(7)
    told = 0
    for _ in range(60):
        answers = generator.random((30, 5)) < 0.6
        lengths = 0.1 + 0.1 * generator.integers(0, 5, 30)
        students = [
            sheet(k, [*map(bool, own)], float(at)) for k, (own, at) in enumerate(zip(answers, lengths, strict=True))
        ]
        told += any(one.differs for one in groups(students, Policy(), "en"))
    assert told <= 8


def test_points_lie_where_their_numbers_say() -> None:
    scene = scatter([0, 100], [-1, 1], [0, 50, 100], [-1, 0, 1], "x", "y")
    low, high = (item.centre for item in scene.items if isinstance(item, Circle))
    assert (high - low).real == pytest.approx(110)
    assert (high - low).imag == pytest.approx(60)
    one, other = (item.centre.real for item in intervals(["a", "b"], [0, 10], [1, 1], [0, 5, 10], "x").items
                  if isinstance(item, Circle))  # fmt: skip
    assert other - one >= 100
