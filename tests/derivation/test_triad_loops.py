"""The closed loops of groups of class III give what their plans and the arrays give, wherever the iteration starts."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from books import Book, keep
from made_triads import R1, clear_places, random_linkages
from test_loops import looped

from reportgen import api
from reportgen.base.records import replace
from reportgen.catalogue import ternary_ids
from reportgen.catalogue.ternary_loop import MOST
from reportgen.catalogue.vector_loops import ClosedLoops
from reportgen.formula import ids
from reportgen.machine import Crank, Linkage
from reportgen.machine.kinematics import course_of

RELATIVE = 1e-9
"""Of the greatest size: the iteration ends with errors near the square of 1e-9, and dead points are near."""
AT_60 = {2: (-7.890453, 84.265143), 3: (0.261241, -114.774782), 4: (-0.497064, 219.565201), 5: (0.556080, -245.874540)}
"""ω (rad/s) and ε (rad/s²) of R1 at 60°, computed by Newton's iteration for the pose, and by differences."""


def check(book: Book, loops: ClosedLoops) -> None:
    b, motion = book.b, book.motion
    links = {link for triad in loops.linkage.triads for link in triad.links}
    for id, rate in ((ids.angular_velocity, "omega"), (ids.angular_acceleration, "epsilon")):
        size = max(float(np.abs(getattr(link, rate)).max()) for link in motion.links.values())
        for link in links:
            known = b.value(ids.formula(id(link)))
            assert np.abs(known - getattr(motion.links[link], rate)).max() < RELATIVE * size, (link, rate)
    for what in "va":
        size = max(float(np.abs(getattr(point, what)).max()) for point in motion.points.values())
        for name in {leg.inner for triad in loops.linkage.triads for leg in triad.legs}:
            x, y = (b.value(ids.formula_component(axis, name, what)) for axis in "xy")
            assert np.abs(x + 1j * y - getattr(motion.points[name], what)).max() < RELATIVE * size, (name, what)
    for link in links:
        turned = np.exp(1j * b.value(ids.formula_angle(link))) / np.exp(1j * motion.links[link].angle)
        assert np.abs(turned - 1).max() < RELATIVE, link
    compared = {plan for plan, _ in loops.compared}
    assert {id(link) for link in links for id in (ids.angular_velocity, ids.angular_acceleration)} <= compared


@pytest.mark.parametrize("turn", [1, -1])
@pytest.mark.parametrize("order", [(0, 1, 2), (1, 2, 0), (2, 0, 1)])
def test_r1_over_a_turn(order: tuple[int, int, int], turn: int) -> None:
    """The first leg is that on the crank, or one on the frame: the same rates follow."""
    triad = R1.triads[0]
    places = [triad.locals[n] for n in order]
    axis = (places[1] - places[0]) / abs(places[1] - places[0])
    at = tuple((place - places[0]) / axis for place in places[1:])
    legs = tuple(triad.legs[n] for n in order)
    linkage = replace(R1, groups=(replace(triad, legs=legs, at=at),), points=(), inertias=())
    book = keep(linkage, np.radians(60 + 30.0 * turn * np.arange(12)), turn, (), ((4, 1.0),), rate=20.0)
    loops = looped(book)
    check(book, loops)
    for link, (omega, epsilon) in AT_60.items():
        assert book.b.value(f"f.omega.{link}")[0] * turn == pytest.approx(omega, abs=1e-6)
        assert book.b.value(f"f.eps.{link}")[0] == pytest.approx(epsilon, abs=1e-6)


def test_random_chains() -> None:
    """Groups of class III after one another and after a group of class II, on a crank or a slide."""
    rng = np.random.default_rng(652)
    used = 0
    for chained in (False, True):
        for linkage in random_linkages(6, rng, chained):
            places = clear_places(linkage, rng, 3)
            if places.size:
                used += 1
                pushes = tuple((link, f"S{link}", 0.6 - 0.8j, 30.0) for link in linkage.links)
                book = keep(linkage, places, 1, pushes)
                check(book, looped(book))
    assert used >= 7


PRESS = Path(__file__).parents[2] / "assignments" / "linkage" / "press-class-iii.yaml"
LONGER = 0.12
"""Length (m) of a crank that stops in dead points of the group, before a turn is over."""


@pytest.mark.parametrize("linkage", [R1, api.load(PRESS, "en").parameters.linkage], ids=["r1", "press"])
def test_beside_dead_points_the_iteration_stays_with_its_assembly(linkage: Linkage) -> None:
    """Down to 0.1° of transmission angle, which no machine may have, it leads to the assembly of the plans.

    Two assemblies are less than a degree apart there: from whole degrees, the iteration leads to the wrong one.
    """
    linkage = replace(linkage, driver=Crank("O", "A", LONGER))
    triad = linkage.triads[0]
    course = course_of(linkage, triad)
    first, last = course.driver[[0, -1]]
    places = np.array([end + inwards * 10.0**-n for end, inwards in ((first, 1), (last, -1)) for n in range(1, 6)])
    book = keep(linkage, places, 1)
    looped(book)
    for link in triad.links:
        turned = np.exp(1j * (book.b.value(ids.formula_angle(link)) - book.motion.links[link].angle))
        assert np.abs(turned - 1).max() < RELATIVE, link
    read = np.degrees(book.b.value(ternary_ids.trial_angle(0, triad.plate)))
    whole = np.abs(read - np.round(read)) < 1e-6
    assert whole[[0, 1, 5, 6]].all()
    assert not whole.all()


def test_the_gaps_close_quadratically() -> None:
    """Each step squares the error, which shows that k are the derivatives of the gaps.

    With the angles read to a degree, the gaps of R1 are millimetres at first; a half degree turns 0.15 m by 1.3 mm.
    """
    book = keep(R1, np.radians(30.0 * np.arange(12)), 1, (), ((4, 1.0),))
    looped(book)
    steps = [n for n in range(MOST) if ternary_ids.trial_gap(n, 4) in book.b]
    gaps = [max(float(np.abs(book.b.value(ternary_ids.trial_gap(n, link))).max()) for link in (4, 5)) for n in steps]
    assert 1e-4 < gaps[0] < 3e-3
    for before, after in pairwise(gaps):
        assert after < 20 * before**2 + 1e-15
