"""The ledger's plans and force plans of a group of class III give what the arrays give.

The arrays choose the special point of each position, the ledger one for all, and draws: only rounding is common.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from books import Book, keep
from made_triads import R1, clear_places, random_linkages

from reportgen.base.records import replace
from reportgen.derivation.group_motion import enter_kinematics
from reportgen.formula import Fraction, Negative, ids, walk
from reportgen.formula.calculation import Calculation
from reportgen.machine import Crank, Dyad, Guide, Linkage
from reportgen.machine.kinematics import solve_motion

RATE = 7.0
RELATIVE = 1e-9
"""Of the greatest size: positions may be ten times nearer to a dead point than is usual."""


def check_plans(linkage: Linkage, driver: np.ndarray, turn: int = 1) -> Calculation:
    motion = solve_motion(linkage, driver, turn * RATE)
    q = Calculation(len(driver))
    if isinstance(linkage.driver, Crank):
        q.give("phi.1", driver)
        q.give("omega.1", RATE)
    else:
        q.give("s.1", driver)
        q.give(f"v.{linkage.driver.pin}", RATE)
    enter_kinematics(q, linkage, turn)
    for name, point in motion.points.items():
        assert np.abs(q.value(f"p.{name}") - point.p).max() < RELATIVE
        for what in ("v", "a"):
            rate = getattr(point, what)
            if f"plan.{what}.{name.lower()}" not in q:
                assert np.abs(rate).max() == 0
                continue
            size = max(float(np.abs(getattr(every, what)).max()) for every in motion.points.values())
            drawn = q.value(f"plan.{what}.{name.lower()}") * q.value(f"mu.{what}")
            assert np.abs(drawn - rate).max() < RELATIVE * size, (what, name)
            assert np.abs(q.value(f"{what}.{name}") - np.abs(rate)).max() < RELATIVE * size, (what, name)
    for id, rate in (("turn.omega", "omega"), ("turn.eps", "epsilon")):
        size = max(float(np.abs(getattr(link, rate)).max()) for link in motion.links.values())
        for number, link in motion.links.items():
            if number != 1:
                known = q.value(f"{id}.{number}") if f"{id}.{number}" in q else 0.0
                assert np.abs(known - getattr(link, rate)).max() < RELATIVE * size, (id, number)
    return q


@pytest.mark.parametrize("turn", [1, -1])
def test_r1_over_a_turn(turn: int) -> None:
    """S24 is the special point that stays within 203 mm of O; v_S24 and ω₃ at 60° are those of the reference case."""
    q = check_plans(R1, np.radians(60 + 30.0 * turn * np.arange(12)), turn)
    assert np.abs(q.value("p.S24")).max() < 0.203
    assert q.value("v.S24")[0] / RATE * 20 == pytest.approx(0.0669941, abs=1e-7)
    assert q.value("dir.v.S24")[0] == pytest.approx(math.radians(44.60203 if turn > 0 else 224.60203), abs=1e-7)
    assert q.value("omega.3")[0] / RATE * 20 == pytest.approx(0.261241, abs=1e-6)


def test_a_dyad_hung_on_the_plate() -> None:
    slider = Dyad("RRP", (6, 7), "F", "G", Guide(0.4 + 0.3j, 0.2), (0.3, 0.0))
    check_plans(replace(R1, groups=(*R1.groups, slider)), np.radians(np.arange(0, 360, 45.0)))


def test_random_triads_and_chains() -> None:
    rng = np.random.default_rng(650)
    used = 0
    for chained in (False, True):
        for linkage in random_linkages(6, rng, chained):
            places = clear_places(linkage, rng, 3)
            if places.size:
                used += 1
                check_plans(linkage, places)
    assert used >= 7


# --- forces ---------------------------------------------------------------------------------------


def check_forces(book: Book) -> None:
    q, found = book.b, book.forces
    size = max(float(np.abs(reaction.force).max()) for reaction in found.reactions.values())
    listed = [name for name in found.reactions if f"F.{name}" in q]
    assert len(listed) >= len(found.reactions) // 2
    for name in listed:
        force = found.reactions[name].force
        assert np.abs(q.value(f"F.{name}") - force).max() < RELATIVE * size, name
        assert np.abs(q.value(f"R.{name[1:]}") - np.abs(force)).max() < RELATIVE * size, name
    reach = max(float(np.abs(point.p).max()) for point in book.motion.points.values())
    for id in ("M.eq", "M.vw"):
        assert np.abs(q.value(id) - found.torque).max() < RELATIVE * size * reach, id


def test_forces_of_r1() -> None:
    """The parts of the reactions at 60°, with the torque of 60 N·m on link 4, at the speed of the reference case."""
    book = keep(R1, np.radians(60 + 30.0 * np.arange(12)), 1, (), ((4, 60.0),), rate=20.0)
    check_forces(book)
    for id, value in (
        ("R.12.n", 263.412642),
        ("R.12.t", 5.565147),
        ("R.04.n", 277.686570),
        ("R.04.t", 321.403416),
        ("R.05.n", -235.872410),
        ("R.05.t", -2.067564),
        ("M.eq", 1.111835),
    ):
        assert book.b.value(id)[0] == pytest.approx(value, abs=1e-6), id


def test_forces_of_random_chains() -> None:
    rng = np.random.default_rng(651)
    used = 0
    for chained in (False, True):
        for linkage in random_linkages(6, rng, chained):
            places = clear_places(linkage, rng, 3)
            if places.size:
                used += 1
                pushes = tuple((link, f"S{link}", 0.6 - 0.8j, 30.0) for link in linkage.links)
                check_forces(keep(linkage, places, 1, pushes))
    assert used >= 7


@pytest.mark.parametrize("turn", [1, -1])
def test_the_plate_turns_about_its_instant_centre(turn: int) -> None:
    """v_D + iω₃(P − D) = 0, as for the leg on the crank; projections on a link agree; legs on the frame have no P."""
    driver = np.radians(60 + 30.0 * turn * np.arange(12))
    motion, q = solve_motion(R1, driver, turn * RATE), check_plans(R1, driver, turn)
    for link, base in ((2, "A"), (3, "D")):
        left = motion.points[base].v + 1j * motion.links[link].omega * (q.value(f"ic.{link}") - motion.points[base].p)
        assert np.abs(left).max() < 1e-9 * RATE
        ends = [q.value(f"ic.along.{link}.{point}") for point in (base, "E" if link == 3 else "D")]
        assert np.abs(ends[0] - ends[1]).max() < 1e-9 * RATE
    assert "ic.4" not in q
    assert "ic.5" not in q


def test_a_leg_without_moments_has_no_term() -> None:
    """The line of the axial part names the part across leg 4, which has a torque, and those of no other leg.

    No fraction has another in its numerator, and no denominator is negative.
    """
    bare = replace(R1, inertias=tuple(body for body in R1.inertias if body.link == 3))
    ledger = keep(bare, np.radians(15 + 30.0 * np.arange(12)), 1, (), ((4, 60.0),)).ledger()
    assert ledger["R.12.t"].values == pytest.approx(0)
    assert ledger["R.05.t"].values == pytest.approx(0)
    assert {id for id in ledger.inputs["R.05.n"] if id in ids.reaction} == {"R.04.t"}
    for k in range(1, 13):
        chain = ledger.chain("R.05.n", k)
        fractions = [node for part in chain.parts for node in walk(part) if isinstance(node, Fraction)]
        assert fractions
        assert not any(isinstance(node, Fraction | Negative) for one in fractions for node in (one.top, one.bottom))
