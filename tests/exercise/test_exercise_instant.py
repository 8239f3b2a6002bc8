"""One instant of plane motion: what stays open, what contradicts, and rates that show where bodies go next."""

from __future__ import annotations

import cmath
import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from reportgen.exercise.rate_conditions import (
    Condition,
    distance,
    given_acceleration,
    given_epsilon,
    given_omega,
    given_velocity,
    no_turning,
    pin,
    slot,
)
from reportgen.exercise.rate_solution import InstantMotion, System


def four_bar(a: float, b: float, c: float, d: float, angle: float) -> dict[str, complex]:
    """The points of a four-bar linkage with its crank at an angle, by the theorem of cosines."""
    A, D = 0j, complex(d)
    B = a * cmath.exp(1j * angle)
    span = D - B
    lift = math.acos((b**2 + abs(span) ** 2 - c**2) / (2 * b * abs(span)))
    return {"A": A, "B": B, "C": B + b * span / abs(span) * cmath.exp(1j * lift), "D": D}


BODIES = {1: ("A", "B"), 2: ("B", "C"), 3: ("C", "D")}


def pinned(points: dict[str, complex]) -> tuple[Condition, ...]:
    joints = (("A", 0, 1), ("B", 1, 2), ("C", 2, 3), ("D", 0, 3))
    return tuple(one for name, i, j in joints for one in pin(f"pin {name}", points[name], i, j))


@settings(max_examples=30, deadline=None)
@given(st.floats(0.2, 6.0), st.floats(-3, 3), st.floats(-5, 5))
def test_rates_of_a_four_bar_are_the_differences_of_its_positions(angle: float, omega: float, eps: float) -> None:
    """A crank-rocker, a + d shorter than b + c, moved on by a small time: its points by the theorem of cosines."""
    lengths = (0.1, 0.35, 0.3, 0.3)
    points = four_bar(*lengths, angle)
    rates = (given_omega("omega", 1, omega), given_epsilon("eps", 1, eps))
    motion = InstantMotion(System(points, BODIES, (*pinned(points), *rates)))

    def C(time: float) -> complex:
        return four_bar(*lengths, angle + omega * time + eps * time**2 / 2)["C"]

    step = 1e-3
    v = (8 * (C(step) - C(-step)) - (C(2 * step) - C(-2 * step))) / (12 * step)
    a = (16 * (C(step) + C(-step)) - (C(2 * step) + C(-2 * step)) - 30 * C(0)) / (12 * step**2)
    assert motion.v("C") == pytest.approx(v, abs=1e-8)
    assert motion.a("C") == pytest.approx(a, abs=1e-6)
    # Every point of the rod turns about its instant centre.
    centre = motion.centre(2)
    if centre is not None:
        assert 1j * motion.omega(2) * (points["C"] - centre) == pytest.approx(motion.v("C"), abs=1e-9)


def test_what_is_not_held_stays_open() -> None:
    """Without the rocker's pivot the crank tells of B, but not of C."""
    points = four_bar(0.1, 0.35, 0.3, 0.3, 1.0)
    joints = tuple(one for one in pinned(points) if one.name != "pin D")
    motion = InstantMotion(System(points, BODIES, (*joints, given_omega("omega", 1, 2.0))))
    assert motion.velocity_conflicts == ()
    assert (motion.knows_velocity("B"), motion.knows_velocity("C"), motion.knows_omega(2)) == (True, False, False)


def test_velocities_are_known_before_the_accelerations() -> None:
    points = four_bar(0.1, 0.35, 0.3, 0.3, 1.0)
    motion = InstantMotion(System(points, BODIES, (*pinned(points), given_omega("omega", 1, 2.0))))
    assert (motion.knows_velocity("C"), motion.knows_acceleration("C"), motion.knows_epsilon(2)) == (True, False, False)


def test_contradictions_are_told_by_name() -> None:
    """The crank says what the velocity of C is; another one given for it is refused, with what it stands against."""
    points = four_bar(0.1, 0.35, 0.3, 0.3, 1.0)
    rates = (given_omega("omega 1", 1, 2.0), given_omega("omega 3", 3, 5.0))
    (conflict,) = InstantMotion(System(points, BODIES, (*pinned(points), *rates))).velocity_conflicts
    assert conflict.name == "omega 3"
    assert set(conflict.others) == {"pin A", "pin B", "pin C", "pin D", "omega 1"}


def test_a_passive_condition_is_none() -> None:
    """A parallelogram's coupler does not turn; to say so once more changes nothing, velocities and accelerations."""
    points = {"A": 0j, "B": 1j, "C": 2 + 1j, "D": 2 + 0j}
    rates = (given_omega("omega", 1, 3.0), given_epsilon("eps", 1, 1.0))
    conditions = (*pinned(points), *no_turning("translation", 2), *rates)
    motion = InstantMotion(System(points, BODIES, conditions))
    assert motion.velocity_conflicts == motion.acceleration_conflicts == ()
    assert motion.omega(2) == 0
    assert motion.centre(2) is None
    assert motion.a("C") == pytest.approx(-1 - 9j)


def test_coriolis_in_a_slot_that_turns() -> None:
    """A point going out along a turning bar: r'' = 0, its acceleration −r ω² and 2 r' ω."""
    points = {"O": 0j, "A": 0.5 + 0j}
    bodies = {1: ("O",), 2: ("A",)}
    held = (*pin("pin O", 0j, 0, 1), *slot("slot A", points["A"], 2, 1, 1 + 0j), *no_turning("block", 2, 1))
    # r' = 0.3 m/s, ω = 2 rad/s: the velocity of A is (0.3, 1), its acceleration (−2, 1.2).
    rates = (given_velocity("v", points["A"], 2, 1 + 0j, 0.3), given_acceleration("a", points["A"], 2, 1 + 0j, -2.0))
    turning = (given_omega("omega", 1, 2.0), given_epsilon("eps", 1, 0.0))
    motion = InstantMotion(System(points, bodies, (*held, *rates, *turning)))
    assert motion.v("A") == pytest.approx(0.3 + 1j)
    assert motion.a("A") == pytest.approx(-2 + 1.2j)


def test_a_taut_cord_bends_the_way_of_its_end() -> None:
    """A weight on a cord of 2 m about a fixed point, level, at 3 m/s upwards: v²/l towards the point."""
    points = {"O": 0j, "A": 2 + 0j}
    cord = (*distance("cord", points["A"], 1, 0j, 0), *no_turning("weight", 1))
    rates = (given_velocity("v", points["A"], 1, 1j, 3.0), given_acceleration("a", points["A"], 1, 1j, 0.0))
    assert InstantMotion(System(points, {1: ("A",)}, (*cord, *rates))).a("A") == pytest.approx(-4.5)


def test_accelerations_alone_tell_how_fast_a_free_body_turns() -> None:
    """Two corners of a plate of 2 m that turns at 3 rad/s about the one at rest: only ω² is known."""
    points = {"A": 0j, "B": 2 + 0j}
    ways = (("a A", 0j, 1 + 0j, 0.0), ("a A", 0j, 1j, 0.0), ("a B", 2 + 0j, 1 + 0j, -18.0), ("a B", 2 + 0j, 1j, 1.0))
    motion = InstantMotion(
        System(points, {1: ("A", "B")}, tuple(given_acceleration(n, p, 1, u, s) for n, p, u, s in ways))
    )
    assert (motion.omega(1), motion.epsilon(1)) == (pytest.approx(3), pytest.approx(0.5))
    assert (motion.knows_omega(1), motion.knows_velocity("A")) == (True, False)
