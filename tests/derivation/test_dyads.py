"""The ledger's plans and force plans give what the arrays give, for every dyad kind and for chains.

The two ways share no formula: the ledger meets lines on a plan and takes moments link by link, the arrays solve
linear systems.  Both are exact but for rounding, so they agree to 1e-12 of each quantity's own size times the
condition of the position; made linkages whose position is worse conditioned than `WORST` are left out.
"""

from __future__ import annotations

from typing import Any

import linkages as lk
import numpy as np
import pytest
from books import MACHINES, RATE, Book, keep
from hypothesis import HealthCheck, Phase, assume, given, settings
from hypothesis import strategies as st

from reportgen.machine import DyadKind
from tests.lanes import matrix

STEPS = np.array([0.0, 0.01, 0.02])
"""Three positions near the one where a made linkage is assembled."""
RELATIVE = 1e-12
MILD = 30.0
"""Made linkages whose relative rates exceed the driver's by more are near a singular place: rounding of the
given lengths, 1e-16, is magnified by about the square of this ratio, to 1e-13 at most."""


def biggest(*values: np.ndarray) -> float:
    return max(float(np.abs(value).max()) for value in values)


def check_motion(book: Book) -> None:
    b, motion = book.b, book.motion
    for what, rank in (("v", "v"), ("a", "a")):
        size = biggest(*(getattr(point, rank) for point in motion.points.values())) or 1.0
        for name, point in motion.points.items():
            if f"plan.{what}.{name.lower()}" not in b:
                assert biggest(getattr(point, rank)) == 0, name
                continue
            drawn = b.value(f"plan.{what}.{name.lower()}") * b.value(f"mu.{what}")
            assert biggest(drawn - getattr(point, rank)) <= RELATIVE * size, (what, name)
            sized = b.value(f"{what}.{name}")
            assert biggest(sized - np.abs(getattr(point, rank))) <= RELATIVE * size, (what, name)
    for id, rate, order in (("turn.omega", "omega", 1), ("turn.eps", "epsilon", 2)):
        size = max(biggest(*(getattr(link, rate) for link in motion.links.values())), RATE**order)
        for number, link in motion.links.items():
            known = b.value(f"{id}.{number}") if f"{id}.{number}" in b else np.zeros(1)
            if number != 1:
                assert biggest(known - getattr(link, rate)) <= RELATIVE * size, (id, number)


def check_forces(book: Book) -> None:
    b, found = book.b, book.forces
    size = biggest(*(reaction.force for reaction in found.reactions.values()))
    length = biggest(*(point.p for point in book.motion.points.values())) or 1.0
    listed = 0
    for name, reaction in found.reactions.items():
        if f"F.{name}" not in b:
            continue
        listed += 1
        assert biggest(b.value(f"F.{name}") - reaction.force) <= RELATIVE * size, name
        digits = name.removeprefix("R")
        assert biggest(b.value(f"R.{digits}") - np.abs(reaction.force)) <= RELATIVE * size, name
        if f"M.{digits}" in b:
            assert biggest(b.value(f"M.{digits}") + reaction.moment) <= RELATIVE * size * length, name
    assert listed >= len(found.reactions) // 2
    torque = biggest(found.torque, *(load.moment(0j) for load in book.loads))
    for id in ("M.eq", "M.vw"):
        assert biggest(b.value(id) - found.torque) <= RELATIVE * max(torque, size * length), id
        assert biggest(b.value(id) - book.work) <= RELATIVE * max(torque, size * length), id


def is_mild(book: Book) -> bool:
    """Whether nothing moves much faster than the driver and nothing is much loaded by its loads."""
    motion = book.motion
    if not motion.reachable.all():
        return False
    rates = [link.omega for link in motion.links.values()] + [slide.v for slide in motion.slides.values()]
    swings = [link.epsilon for link in motion.links.values()] + [slide.a for slide in motion.slides.values()]
    forces = [reaction.force for reaction in book.forces.reactions.values()]
    loads = biggest(*(load.force for load in book.loads))
    return biggest(*rates) < MILD * RATE and biggest(*swings) < MILD * RATE**2 and biggest(*forces) < MILD * loads


@st.composite
def books(draw: Any, kinds: tuple[DyadKind, ...], sliding: bool = False) -> Book:
    linkage = draw(lk.linkages(kinds, sliding))
    assume(all(dyad.start != dyad.end for dyad in linkage.dyads))
    turn = draw(st.sampled_from((1, -1)))
    driver = lk.REFERENCE + turn * STEPS * (0.1 if sliding else 1.0)
    unit = np.exp(1j * draw(lk.ANGLE))
    pushes = tuple((link, f"T{link}", unit, 40.0) for link in linkage.links)
    torques = tuple((link, draw(lk.hundredths(-900, 900))) for link in linkage.links)
    return keep(linkage, driver, turn, pushes, torques)


ONE = settings(
    max_examples=12, deadline=None, suppress_health_check=list(HealthCheck), derandomize=True, phases=[Phase.generate]
)


@pytest.mark.parametrize("sliding", matrix([False, True], [False]))
@pytest.mark.parametrize("kind", lk.KINDS)
@ONE
@given(st.data())
def test_one_group(kind: DyadKind, sliding: bool, data: Any) -> None:
    book = data.draw(books((kind,), sliding))
    assume(is_mild(book))
    check_motion(book)
    check_forces(book)


@pytest.mark.parametrize(
    ("first", "second"),
    matrix(
        [(first, second) for first in lk.KINDS for second in lk.KINDS],
        # Each kind once before and once behind another.
        list(zip(lk.KINDS, lk.KINDS[1:] + lk.KINDS[:1], strict=True)),
    ),
)
@settings(ONE, max_examples=5)
@given(st.data())
def test_chain(first: DyadKind, second: DyadKind, data: Any) -> None:
    book = data.draw(books((first, second)))
    assume(is_mild(book))
    check_motion(book)
    check_forces(book)


@pytest.mark.parametrize("turn", [1, -1])
@pytest.mark.parametrize("name", MACHINES)
def test_ordinary_machines(name: str, turn: int) -> None:
    """A whole turn, with the crank at dead centres too."""
    angles = turn * np.radians(np.arange(0.0, 360.0, 15.0))
    link = MACHINES[name].dyads[-1].links[1]
    point = MACHINES[name].dyads[-1].middle
    pushes = () if point == "B3" else ((link, point, -1 + 0j, 50.0),)
    book = keep(MACHINES[name], angles, turn, pushes)
    assert book.motion.reachable.all()
    check_motion(book)
    check_forces(book)
