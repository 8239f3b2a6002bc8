"""The closed loops of groups, solved by formulas, give what the plans give: for linkages of every kind of group.

A plan meets lines and measures, a loop is differentiated and solved: they share the lengths and nothing else.
"""

from __future__ import annotations

from itertools import product
from typing import Any

import linkages as lk
import numpy as np
import pytest
from books import Book
from hypothesis import HealthCheck, Phase, assume, given, settings
from hypothesis import strategies as st
from test_dyads import RELATIVE, biggest, books, is_mild

from reportgen.catalogue.vector_components import typed
from reportgen.catalogue.vector_loops import ClosedLoops
from reportgen.formula import ids
from reportgen.machine import DyadKind
from tests.lanes import matrix

PAIRS = list(product(lk.KINDS, repeat=2))
EACH = 8
"""Linkages for each of the 25 pairs of groups: 200 in all."""
TURNING: dict[DyadKind, int] = {"RRR": 2, "RRP": 1, "RPR": 2, "PRP": 0, "RPP": 0}
"""How many links of a group turn by themselves."""
FORMULAS = 1e3
"""Formulas of the made linkages go by angles and lose so many more units of rounding: they agree to 1e-9."""


def looped(book: Book) -> ClosedLoops:
    """The loops of a linkage, entered on the sheet of its plans."""
    fixed = {name: typed(place) for name, place in book.linkage.ground.items()}
    loops = ClosedLoops(book.linkage, int(np.sign(book.motion.rate[0])), fixed)
    loops.write(book.b)
    return loops


def check(book: Book, loops: ClosedLoops) -> None:
    """Every velocity and acceleration that both know, and of formulas the points by their components."""
    b, motion = book.b, book.motion
    largest = {
        "v": biggest(*(point.v for point in motion.points.values())),
        "a": biggest(*(point.a for point in motion.points.values())),
        "omega": biggest(*(link.omega for link in motion.links.values())),
        "eps": biggest(*(link.epsilon for link in motion.links.values())),
    }
    # What stands still beside the driver is nothing beside it.
    error = FORMULAS * RELATIVE
    for plan, formula in loops.compared:
        size = max(largest[plan.split(".")[0]], 1.0)
        assert biggest(np.abs(b.value(plan)) - np.abs(b.value(formula))) <= error * size, plan
    for name, point in motion.points.items():
        for what in "va":
            for axis, part in (("x", np.real), ("y", np.imag)):
                id = ids.formula_component(axis, name, what)
                if id in b:
                    assert biggest(b.value(id) - part(getattr(point, what))) <= error * max(largest[what], 1.0), id
    for (guide, slider), slide in motion.slides.items():
        joint = ids.joint(guide, slider)
        for id, values in ((ids.slide_velocity(joint), slide.v), (ids.slide_acceleration(joint), slide.a)):
            if id in b:
                assert biggest(b.value(id) - values) <= error * max(largest["v"], largest["a"], 1.0), id
    known = {plan for plan, _ in loops.compared}
    owned = [dyad.middle for dyad in loops.linkage.dyads] + [point.name for point in loops.linkage.points]
    for name in owned:
        if biggest(motion.points[name].v) > 0:
            assert ids.velocity(name) in known, f"no formula for the velocity of {name}"
    for dyad in loops.linkage.dyads:
        for link in dyad.links[: TURNING[dyad.kind]]:
            assert {ids.angular_velocity(link), ids.angular_acceleration(link)} <= known


@pytest.mark.parametrize("sliding", matrix([False, True], [False]))
@pytest.mark.parametrize(("first", "second"), matrix(PAIRS, [(kind, kind) for kind in lk.KINDS]))
@settings(
    max_examples=EACH, deadline=None, suppress_health_check=list(HealthCheck), derandomize=True, phases=[Phase.generate]
)
@given(st.data())
def test_two_groups(first: DyadKind, second: DyadKind, sliding: bool, data: Any) -> None:
    book = data.draw(books((first, second), sliding))
    assume(is_mild(book))
    check(book, looped(book))
