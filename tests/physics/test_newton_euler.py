"""The whole analysis against an independent solve with constraint Jacobian and multipliers."""

from __future__ import annotations

import math
from collections.abc import Callable

import linkages as made
import newton_euler as ne
import numpy as np
import pytest
from agreement import AGREEMENT, Acting, Pairs, collect, off, weights
from hypothesis import HealthCheck, given, reject, settings
from hypothesis import strategies as st

from reportgen.base.records import replace
from reportgen.machine import Crank, Dyad, Guide, Inertia, Linkage, LinkPoint, SlidingDriver
from reportgen.machine.force_analysis import Forces, Load, inertia_loads, solve_forces, virtual_work_torque
from reportgen.machine.force_analysis import weights as forces_of_weight
from reportgen.machine.kinematics import Motion, solve_motion
from tests.lanes import matrix, proof

CONDITION = 1e3
"""Greatest condition number of the constraint Jacobian (lengths near 1 m): beyond it a position counts as
near-singular.  Accelerations and forces then hold ε·10³·10³ = 2e-10 of their greatest."""

quick = settings(max_examples=40, deadline=None, suppress_health_check=list(HealthCheck))

Given = list[Acting]
Change = Callable[[Linkage, Motion], tuple[Motion, tuple[Load, ...]]]


def plainly(linkage: Linkage, motion: Motion) -> tuple[Motion, tuple[Load, ...]]:
    return motion, inertia_loads(linkage, motion)


def disagreement(
    linkage: Linkage,
    motion: Motion,
    given_loads: Given,
    change: Change = plainly,
    change_forces: Callable[[Forces], Forces] = lambda forces: forces,
    acceleration: float = 0.0,
) -> dict[str, float] | None:
    """Largest difference of each sort of quantity from the witness, over its own maximum.

    None when no position is well conditioned.  `change` and `change_forces` put faults in.
    """
    motion, inertia = change(linkage, motion)
    given_arrays = made.as_loads(given_loads, motion)
    forces = change_forces(solve_forces(linkage, motion, (*given_arrays, *forces_of_weight(linkage, motion), *inertia)))
    bodies, joints, keys = made.told(linkage)
    poses = list(made.poses(motion))
    pairs: Pairs = {}
    for k in np.flatnonzero(motion.reachable):
        loads = [*given_loads, *weights(bodies, poses[k], linkage.gravity)]
        turning = isinstance(linkage.driver, Crank)
        answer = ne.solve(bodies, joints, turning, float(motion.rate[k]), poses[k], loads, CONDITION, acceleration)
        if answer is not None:
            collect(pairs, motion, forces, keys, answer, int(k))
            pairs.setdefault("residual", []).append((answer.residual + 1.0, 1.0))
    if not pairs:
        return None
    # What is nothing by the linkage's nature (ε of a sliding link, say) is read against the size that
    # such a quantity has in a linkage of about 1 m; a couple against the largest force at 1 m as well.
    rate = float(np.abs(motion.rate).max())
    floor = {"residual": 1.0, "v": rate, "ω": rate, "a": rate**2, "ε": rate**2, "R": 1.0, "effort": 1.0}
    floor["moment"] = max(abs(theirs) for _, theirs in pairs["R"])
    return off(pairs, floor)


def prove(linkage: Linkage, rate: float, given_loads: Given, acceleration: float = 0.0) -> None:
    driver = made.REFERENCE + np.array([-0.11, -0.04, 0.0, 0.03, 0.09])
    motion = solve_motion(linkage, driver, rate, acceleration)
    found = disagreement(linkage, motion, given_loads, acceleration=acceleration)
    if found is None:
        reject()
    assert max(found.values()) < AGREEMENT, found


@pytest.mark.parametrize("sliding", matrix([False, True], [False]), ids=["crank", "slide"])
@pytest.mark.parametrize("kind", made.KINDS)
@quick
@given(data=st.data())
def test_every_kind(kind: made.DyadKind, sliding: bool, data: st.DataObject) -> None:
    linkage = data.draw(made.linkages((kind,), sliding))
    prove(linkage, data.draw(made.RATE), data.draw(made.applied(linkage)))


@proof
@settings(quick, max_examples=100)
@given(data=st.data())
def test_chains_of_three_groups(data: st.DataObject) -> None:
    kinds = tuple(data.draw(st.lists(st.sampled_from(made.KINDS), min_size=3, max_size=3)))
    linkage = data.draw(made.linkages(kinds, data.draw(st.booleans())))
    prove(linkage, data.draw(made.RATE), data.draw(made.applied(linkage)))


ACCELERATION = st.sampled_from((60.0, -35.0))
"""ε₁ or a beside a rate of 7: of the size of its square."""


def prove_accelerated(data: st.DataObject, kinds: tuple[made.DyadKind, ...], sliding: bool) -> None:
    """A driver that accelerates, no gravity, a moment and a force on every link."""
    linkage = replace(data.draw(made.linkages(kinds, sliding)), gravity=0j)
    prove(linkage, data.draw(made.RATE), data.draw(made.applied(linkage)), data.draw(ACCELERATION))


@settings(quick, max_examples=8)
@given(data=st.data())
def test_an_accelerated_driver(data: st.DataObject) -> None:
    prove_accelerated(data, (data.draw(st.sampled_from(made.KINDS)),), data.draw(st.booleans()))


@proof
@settings(quick, max_examples=300)
@given(data=st.data())
def test_accelerated_chains(data: st.DataObject) -> None:
    kinds = tuple(data.draw(st.lists(st.sampled_from(made.KINDS), min_size=1, max_size=3)))
    prove_accelerated(data, kinds, data.draw(st.booleans()))


STEP = 1e-4
"""Seconds: the second difference leaves out STEP²/12 of the fourth derivative and rounds at 1e-16/STEP²."""


def test_accelerations_by_differences_in_time() -> None:
    """ε of every link and a of every point of a four-bar at φ₁ = 50° + ω₁t + ε₁t²/2, and of a slide likewise."""
    four_bar = Linkage(
        ground={"A": 0j, "D": 0.4 + 0j},
        driver=Crank("A", "B", 0.12),
        groups=(Dyad("RRR", (2, 3), "B", "C", "D", (0.35, 0.3)),),
    )
    slide = replace(four_bar, driver=SlidingDriver("B", Guide(0.05j, 0.3)))
    for linkage, first, rate, acceleration in ((four_bar, math.radians(50), 12.0, 60.0), (slide, 0.05, 0.3, -2.0)):
        t = np.array([-STEP, 0.0, STEP])
        at = first + rate * t + acceleration * t**2 / 2
        moved = solve_motion(linkage, at, rate + acceleration * t, acceleration)
        for link in moved.links.values():
            assert np.diff(link.angle, 2)[0] / STEP**2 == pytest.approx(link.epsilon[1], rel=1e-5, abs=1e-5)
        for point in moved.points.values():
            assert abs(np.diff(point.p, 2)[0] / STEP**2 - point.a[1]) < 1e-5 * max(1.0, abs(point.a[1]))


# --- the proof notices faults ------------------------------------------------------------------------


def test_joints_that_lie_in_one_point_but_for_rounding() -> None:
    """Blocks 4 and 5 on one point of a link that turns: their distance is the rounding of that point."""
    names = [f"T{link}" for link in range(1, 6)]
    guide = Guide(at=0.04j, angle=0.0, link=1)
    linkage = Linkage(
        ground={"O": 0j},
        driver=Crank("O", "A", 0.1),
        groups=(
            Dyad("RRP", (2, 3), "A", "M0", guide, (math.hypot(0.1, 0.04), 0.0), -1),
            Dyad("RPP", (4, 5), "T3", "M1", guide, (0.0, 0.0), slide_angle=0.3),
        ),
        points=tuple(LinkPoint(name, link, 0.01j * (link == 5)) for link, name in enumerate(names, 1)),
        inertias=tuple(Inertia(link, name, 0.5, 0.05) for link, name in enumerate(names, 1)),
        gravity=-9.81j,
    )
    prove(linkage, 7.0, [])


@pytest.fixture
def engine() -> Linkage:
    """An offset slider-crank with a coupler-driven rocker: nothing in it is nothing by symmetry."""
    return Linkage(
        {"O": 0, "E": 1.2 + 0.5j},
        Crank("O", "A", 0.3),
        (Dyad("RRP", (2, 3), "A", "B", Guide(-0.1j, 0.0), (0.9, 0.0)), Dyad("RRR", (4, 5), "S2", "D", "E", (0.7, 0.6))),
        (LinkPoint("S2", 2, 0.4 + 0.1j), LinkPoint("S4", 4, 0.3), LinkPoint("S5", 5, 0.2 + 0.1j)),
        (Inertia(2, "S2", 2.0, 0.1), Inertia(3, "B", 1.0), Inertia(4, "S4", 1.5, 0.06), Inertia(5, "S5", 1.0, 0.04)),
    )


TURN = np.linspace(0, 2 * math.pi, 8, endpoint=False) + 0.1


def test_the_proof_passes_without_a_fault(engine: Linkage) -> None:
    found = disagreement(engine, solve_motion(engine, TURN, -9.0), [(3, -80 + 0j, 0.5 - 0.1j, 0.0)])
    assert found is not None
    assert max(found.values()) < AGREEMENT


def wrong_moment(linkage: Linkage, motion: Motion) -> tuple[Motion, tuple[Load, ...]]:
    turned = replace(linkage, inertias=tuple(replace(body, moment=-body.moment) for body in linkage.inertias))
    return motion, inertia_loads(turned, motion)


def wrong_epsilon(linkage: Linkage, motion: Motion) -> tuple[Motion, tuple[Load, ...]]:
    links = {number: replace(link, epsilon=-link.epsilon) for number, link in motion.links.items()}
    motion = replace(motion, links=links)
    return motion, inertia_loads(linkage, motion)


def wrong_inertia(linkage: Linkage, motion: Motion) -> tuple[Motion, tuple[Load, ...]]:
    return motion, tuple(replace(load, force=-load.force) for load in inertia_loads(linkage, motion))


@pytest.mark.parametrize("fault", [wrong_moment, wrong_epsilon, wrong_inertia])
def test_the_proof_fails_on_a_wrong_sign_of_inertia(engine: Linkage, fault: Change) -> None:
    found = disagreement(engine, solve_motion(engine, TURN, -9.0), [], fault)
    assert found is not None
    assert found["R"] > 1e3 * AGREEMENT
    assert found["effort"] > 1e3 * AGREEMENT


@pytest.mark.parametrize("key", ["R01", "R12", "R23", "R03", "R24", "R45", "R05"])
def test_the_proof_fails_on_a_wrong_sign_of_any_reaction(engine: Linkage, key: str) -> None:
    def fault(forces: Forces) -> Forces:
        wrong = replace(forces.reactions[key], force=-forces.reactions[key].force)
        return replace(forces, reactions={**forces.reactions, key: wrong})

    found = disagreement(engine, solve_motion(engine, TURN, -9.0), [], plainly, fault)
    assert found is not None
    assert found["R"] > 1e3 * AGREEMENT


def test_both_torques_fail_to_agree_on_a_wrong_sign_of_epsilon(engine: Linkage) -> None:
    motion = solve_motion(engine, TURN, -9.0)
    _, inertia = wrong_epsilon(engine, motion)
    right = virtual_work_torque(engine, motion, inertia_loads(engine, motion))
    wrong = solve_forces(engine, motion, inertia).torque
    assert np.abs(right - wrong).max() > 1e-3 * np.abs(right).max()
