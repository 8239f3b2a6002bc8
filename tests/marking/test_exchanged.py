"""Who exchanges two positions goes wrong once; what is wrong beside that is wrong as on any sheet."""

from __future__ import annotations

import pytest

from reportgen.base.records import replace
from reportgen.document import text_of
from reportgen.marking.exchanged_positions import NAME
from reportgen.marking.feedback import feedback_document
from reportgen.marking.judging import mark
from reportgen.marking.marking_data import Marking, Submission, Verdict
from reportgen.marking.marking_scheme import MarkingScheme
from tests.marking import students

PAIR = (2, 5)


def right_sheet(scheme: MarkingScheme) -> Submission:
    return students.sheet(scheme, lambda row, k, value: students.figures(value, 4))


def exchanged(submission: Submission, pair: tuple[int, int] = PAIR, ids: frozenset[str] | None = None) -> Submission:
    """The same with all values of two positions, or those of some rows, exchanged."""
    places = {
        (id, k): (id, sum(pair) - k)
        for id, k in submission.values
        if k in pair and (id, sum(pair) - k) in submission.values and (ids is None or id in ids)
    }
    return replace(submission, values={places.get(at, at): one for at, one in submission.values.items()})


def of_exchange(marking: Marking) -> list[tuple[str, int]]:
    return [(cell.id, cell.position) for cell in marking.cells if cell.mistake == NAME]


@pytest.mark.parametrize("name", ["slider-crank-01", "four-bar-01", "shaper-01"])
def test_two_positions_exchanged_are_one_mistake(name: str) -> None:
    scheme = students.scheme(name)
    submission = exchanged(right_sheet(scheme))
    marking = mark(scheme, submission)
    [lost] = marking.first_errors
    assert lost.mistake == NAME
    assert {lost.position, lost.exchanged} == {*PAIR}
    assert marking.points == marking.out_of - lost.worth
    assert lost.worth == 1
    written = {(cell.id, cell.position): cell.written for cell in marking.cells if cell.written is not None}
    assert all(written[at] == submission.values[at].value for at in written)


def test_the_feedback_names_both_positions() -> None:
    scheme = students.scheme("slider-crank-01")
    marking = mark(scheme, exchanged(right_sheet(scheme)))
    said = text_of(feedback_document(marking, ""))
    first, second = (scheme.key.label(k) for k in PAIR)
    assert f"{first} và {second} bị đổi chỗ" in said


def test_an_exchange_hides_no_wrong_value() -> None:
    """What is wrong at a place where it belongs is wrong where it was exchanged, too."""
    scheme = students.scheme("slider-crank-01")
    single = next(row.id for row in scheme.judged if row.single and row.id in {"omega.1", "v.A"})
    row = next(
        row for row in reversed(scheme.judged) if {*PAIR} <= {*row.positions} and row.part != scheme.rows[single].part
    )
    sheet = right_sheet(scheme)
    wrong = dict(sheet.values)
    for k in PAIR:
        wrong[row.id, k] = replace(wrong[row.id, k], value=wrong[row.id, k].value * 1.37 + 5)
    sheet = replace(sheet, values=wrong)
    honest, other = mark(scheme, sheet), mark(scheme, exchanged(sheet))
    assert of_exchange(other)
    assert other.points == honest.points - 1
    assert all(cell.verdict is Verdict.wrong for cell in other.cells if cell.id == row.id and cell.position in PAIR)


def test_a_few_rows_exchanged_are_wrong() -> None:
    scheme = students.scheme("slider-crank-01")
    rows = [row.id for row in scheme.judged if {*PAIR} <= {*row.positions}]
    marking = mark(scheme, exchanged(right_sheet(scheme), ids=frozenset(rows[-3:])))
    assert not of_exchange(marking)


def test_a_copied_position_is_no_exchange() -> None:
    """The values of one position at both are right once."""
    scheme = students.scheme("slider-crank-01")
    sheet = right_sheet(scheme)
    values = {
        (id, k): sheet.values.get((id, PAIR[0]), one) if k == PAIR[1] else one for (id, k), one in sheet.values.items()
    }
    assert not of_exchange(mark(scheme, replace(sheet, values=values)))


def test_a_right_sheet_has_none() -> None:
    scheme = students.scheme("slider-crank-01")
    marking = mark(scheme, right_sheet(scheme))
    assert marking.points == marking.out_of
    assert not of_exchange(marking)
