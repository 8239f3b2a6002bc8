"""Balancing marked: right work in any way of taking the curve, and the mistakes of this chapter by name."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from reportgen.balancing import balance_ids
from reportgen.base.template_folders import search_path
from reportgen.base.words import load_words
from reportgen.cases import open_case, opened
from reportgen.marking.judging import mark
from reportgen.marking.marking_data import Verdict
from reportgen.marking.marking_scheme import MarkingScheme, marking_scheme
from reportgen.marking.mistakes import mistakes_in
from tests.lanes import proof
from tests.marking import students

NAMES = {"slider-crank-04": "max", "four-bar-04": "", "balancing/twin-270": "share"}
CLASS = 12


@cache
def scheme_of(name: str) -> MarkingScheme:
    return marking_scheme(open_case(students.ASSIGNMENTS / f"{name}.yaml"))


@pytest.mark.parametrize("name", NAMES)
def test_what_is_right_earns_all(name: str) -> None:
    """Three figures of every value that is asked for: F, its direction, M, U, angle, mass and what is left."""
    scheme = scheme_of(name)
    found = mark(scheme, students.written(scheme, students.worked_out(scheme)))
    assert found.points == pytest.approx(found.out_of)
    asked = {cell.id for cell in found.cells}
    wanted = {balance_ids.FORCE, balance_ids.DIRECTION, balance_ids.MOMENT, balance_ids.AFTER_TORQUE}
    assert wanted | {name(1) for name in (balance_ids.product, balance_ids.angle, balance_ids.mass)} <= asked


@proof
def test_a_class_of_twelve_that_draws_by_hand() -> None:
    """Twelve variants, each drawn with errors of half a millimetre and written with three figures: all is right."""
    for number in range(CLASS):
        rng = np.random.default_rng(number)
        scheme = marking_scheme(opened(students.varied("slider-crank-04", rng, worked=(2,))))
        found = mark(scheme, students.written(scheme, students.worked_out(scheme, drawn=rng)))
        wrong = [cell.id for cell in found.cells if cell.verdict is Verdict.wrong]
        assert wrong == [], (number, wrong)


@pytest.mark.parametrize(
    ("name", "id", "mistake"),
    [
        ("slider-crank-04", balance_ids.angle(1), "counterweight-on-pin-side"),
        ("four-bar-04", balance_ids.angle(3), "counterweight-on-pin-side"),
        ("slider-crank-04", balance_ids.centrifugal(1), "omega-not-squared"),
        ("balancing/twin-270", balance_ids.rule_component("share", "x"), "share-of-turning-part"),
        ("four-bar-04", balance_ids.force_of_link(2, "y"), "degrees-for-radians"),
        ("balancing/twin-270", balance_ids.star(2, "forward", "y"), "order-with-single-angle"),
        ("slider-crank-04", balance_ids.series(2), "ratio-inverted"),
    ],
)
def test_mistakes_of_the_chapter_have_names(name: str, id: str, mistake: str) -> None:
    """Made where it can be made, it is told where it first shows, and all that follows earns its points."""
    scheme = scheme_of(name)
    made = next(one for one in mistakes_in(scheme, id, {}) if one.name == mistake)
    found = mark(scheme, students.written(scheme, students.worked_out(scheme, made)))
    first = found.first_errors
    assert {cell.mistake for cell in first} == {mistake}
    assert found.points > found.out_of - 3


def test_every_mistake_of_the_chapter_has_words() -> None:
    for language in ("vi", "en"):
        words = load_words(search_path(language))
        for name in (
            "counterweight-on-pin-side",
            "omega-not-squared",
            "share-of-turning-part",
            "order-with-single-angle",
        ):
            assert words["mistakes"][name]
            assert words["mistake_names"][name]
