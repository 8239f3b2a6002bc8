"""The true motion of a machine is asked for, followed and marked, and its mistakes are named."""

from __future__ import annotations

import numpy as np
import pytest

from reportgen.marking.judging import mark
from reportgen.marking.marking_scheme import MarkingScheme
from reportgen.marking.mistakes import mistakes_in
from tests.marking import students

EVERY = tuple(range(1, 9))


@pytest.fixture(scope="module")
def scheme() -> MarkingScheme:
    return students.scheme("slider-crank-03", EVERY)


def test_what_is_asked_for(scheme: MarkingScheme) -> None:
    asked = {row.id for row in scheme.key.asked if row.id.startswith("run.")}
    assert {"run.dJ", "run.Md", "run.A", "run.T", "run.omega", "run.eps", "run.delta", "run.power"} <= asked
    assert {f"run.{name}.wheel" for name in ("omega", "eps", "delta", "power")} <= asked
    # The bounds lie between the positions, start and stop between all of them: they stand in the key alone.
    alone = {"run.max", "run.min", "run.t.start", "run.t.stop", "run.period"}
    assert alone <= {row.id for row in scheme.key.rows} - asked


def test_a_student_without_a_mistake_has_every_mark(scheme: MarkingScheme) -> None:
    marking = mark(scheme, students.written(scheme, students.worked_out(scheme)))
    assert marking.points == marking.out_of


def test_who_works_from_the_positions_alone_has_every_mark_but_for_the_bounds(scheme: MarkingScheme) -> None:
    """The trapezoid rule over eight positions misses the work by up to 9 J of 100 J; that belongs to the tolerance."""
    ledger = scheme.ledger
    rests = {id: np.zeros(1) for id in ledger.families if id.startswith("rest.run.")}
    of_curve = {id: one for id, one in rests.items() if id.split(".")[2] not in ("max", "min")}
    world = ledger.evaluate(of_curve)
    marking = mark(scheme, students.written(scheme, world))
    assert [cell.id for cell in marking.first_errors if cell.id.startswith("run.")] == []


@pytest.mark.parametrize(
    ("id", "name"),
    [
        ("run.omega", "half-forgotten"),
        ("run.eps", "slope-left-out"),
        ("run.eps", "speed-not-squared"),
        ("run.eps", "half-of-slope"),
        ("run.eps", "load-sign"),
        ("run.Md", "motor-constant"),
        ("run.power", "two-pi-forgotten"),
        ("run.delta", "bounds-of-table"),
        ("run.omega.wheel", "half-forgotten"),
    ],
)
def test_mistakes_of_true_motion(scheme: MarkingScheme, id: str, name: str) -> None:
    mistake = next(one for one in mistakes_in(scheme, id, {}) if one.name == name)
    marking = mark(scheme, students.written(scheme, students.worked_out(scheme, mistake)))
    assert (id, name) in {(cell.id, cell.mistake) for cell in marking.first_errors}
