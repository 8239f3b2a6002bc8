"""Springs against the independent Newton–Euler solution, which is told their forces as plain numbers."""

from __future__ import annotations

import cmath
import math

import linkages as made
import newton_euler as ne
import numpy as np
import pytest
from agreement import AGREEMENT, CONDITION, collect, off
from hypothesis import HealthCheck, given, reject, settings
from hypothesis import strategies as st

import reportgen
from reportgen.base.errors import AssignmentError
from reportgen.machine import Linkage
from reportgen.machine.analysis import Analysis
from reportgen.machine.force_analysis import inertia_loads, solve_forces, weights
from reportgen.machine.kinematics import Motion, solve_motion
from reportgen.machine.loads import Applied, Torque
from reportgen.machine.spring_geometry import Anchor
from reportgen.springs.spring_laws import SpringLaw, TorsionLaw
from tests.lanes import proof

TEXT = """
kind: four-bar
positions: {count: 12}
parameters:
  AB: 120 mm
  BC: 350 mm
  CD: 300 mm
  AD: 400 mm
  omega1: 12 rad/s
  m1: 1 kg
  m2: 5 kg
  m3: 4 kg
  E: {along: 150 mm, across: 60 mm}
  springs:
    - {link: 3, at: C, to: [300 mm, 420 mm], c: 4 N/mm, free: 90 mm}
    - {link: 3, about: D, c: 5 N m/rad, free: 100 deg}
    - {link: 2, at: E, to: D, c: 1 N/mm, free: 20 mm}
    - {link: 2, at: E, to: {link: 1, at: S1}, c: 2 kN/m, free: 100 mm}
"""


@pytest.fixture(scope="module")
def analysis() -> Analysis:
    found: Analysis = reportgen.open(TEXT).case.analysis
    return found


def test_the_pull_of_every_spring(analysis: Analysis) -> None:
    """F = c(l − l₀) towards the other end, M = −c(φ − φ₀); both ends of a spring between links pull alike."""
    p = {name: point.p for name, point in analysis.motion.points.items()}
    φ3 = np.array([cmath.phase(one) for one in p["C"] - p["D"]])
    by_name = {load.name: load for load in analysis.applied}
    assert {*by_name} == {"P3", "M3", "P2", "P2a", "P1"}
    ends = {"P3": ("C", 0.3 + 0.42j, 4e3, 0.09), "P2": ("E", p["D"], 1e3, 0.02), "P2a": ("E", p["S1"], 2e3, 0.1)}
    for name, (at, to, c, free) in ends.items():
        way = to - p[at]
        assert by_name[name].force == pytest.approx(c * (abs(way) - free) * way / abs(way))
        assert by_name[name].point == pytest.approx(p[at])
    assert by_name["P1"].force == pytest.approx(-by_name["P2a"].force)
    assert by_name["M3"].couple == pytest.approx(-5 * (φ3 - math.radians(100)))


def test_springs_do_no_work_over_a_turn(analysis: Analysis) -> None:
    """The mean torque is nothing beside the greatest; the two ways to the torque agree."""
    greatest = float(np.abs(analysis.torque).max())
    assert abs(analysis.summary.mean_torque) < 1e-9 * greatest
    assert analysis.summary.energy_error < 1e-9
    assert analysis.torque_by_work == pytest.approx(analysis.torque, abs=1e-9 * greatest)


def test_springs_begin_with_what_they_are_typed_as() -> None:
    """On the page lengths are metres, so that stiffness is in N/m; 4 N/mm is 4000 N/m in the worked line."""
    ledger = reportgen.open(TEXT).case.printed
    assert (ledger["spring.c.1"].values[0], ledger["spring.c.1"].how.unit) == (4000.0, "N/m")
    F, c, length, free = (ledger[id].at(2) for id in ("P3", "spring.c.1", "spring.l.1", "spring.free.1"))
    assert pytest.approx(c * (length - free), rel=1e-4) == F


# --- made linkages --------------------------------------------------------------------------------


def springs_on(linkage: Linkage, data: st.DataObject) -> list[Applied | Torque]:
    """A spring from each tip to the frame or to a tip of another link, and a torsion spring on the frame's crank."""
    found: list[Applied | Torque] = []
    tips = [f"T{link}" for link in linkage.links]
    for link, tip in zip(linkage.links, tips, strict=True):
        far = data.draw(st.sampled_from([other for other in tips if other != tip] + [""]))
        ends = Anchor(tip), Anchor(far, data.draw(made.PLACE) + 3.0)
        law = SpringLaw(link, ends, data.draw(made.hundredths(100, 900)), data.draw(made.LENGTH))
        found.append(Applied(f"F{link}", link, tip, law.towards(0), law))
        if far:
            found.append(Applied(f"B{link}", int(far[1:]), far, law.towards(1), law))
    found.append(Torque("M1", 1, TorsionLaw(0, 1, "O", "A", 20.0, data.draw(made.ANGLE))))
    return found


def told(motion: Motion, springs: list[Applied | Torque], k: int) -> list[tuple[int, complex, complex, float]]:
    """The springs as plain numbers, worked out here: places of their ends, c and free length."""
    acting = []
    for load in springs:
        law = load.law
        if isinstance(law, TorsionLaw):
            line = complex(motion.points["A"].p[k] - motion.points["O"].p[k])
            acting.append((1, 0j, 0j, -law.c * cmath.phase(line * cmath.exp(-1j * law.free))))
            continue
        assert isinstance(law, SpringLaw)
        places = [complex(motion.points[end.name].p[k]) if end.name else end.place for end in law.ends]
        here, there = places if load.name.startswith("F") else places[::-1]
        way = there - here
        acting.append((load.link, law.c * (abs(way) - law.free) * way / abs(way), here, 0.0))
    return acting


def prove(data: st.DataObject, kinds: tuple[made.DyadKind, ...]) -> None:
    linkage = data.draw(made.linkages(kinds))
    motion = solve_motion(linkage, made.REFERENCE + np.array([-0.05, 0.0, 0.06]), 7.0, 30.0)
    springs = springs_on(linkage, data)
    for load in springs:
        if isinstance(load.law, SpringLaw) and (np.abs(load.law.along(motion)) < made.SHORTEST).any():
            reject()
    loads = [load.load(np.zeros(3), motion) for load in springs]
    forces = solve_forces(linkage, motion, (*loads, *inertia_loads(linkage, motion), *weights(linkage, motion)))
    bodies, joints, keys = made.told(linkage)
    pairs: dict[str, list[tuple[complex, complex]]] = {}
    for k, pose in enumerate(made.poses(motion)):
        if not motion.reachable[k]:
            continue
        weighed = [
            (body, it.mass * linkage.gravity, pose[body][0] + it.centre * cmath.exp(1j * pose[body][1]), 0.0)
            for body, it in bodies.items()
        ]
        acting = [*told(motion, springs, k), *weighed]
        answer = ne.solve(bodies, joints, True, 7.0, pose, acting, CONDITION / 10, 30.0)
        if answer is not None:
            collect(pairs, motion, forces, keys, answer, k)
    if not pairs:
        reject()
    floor = {"v": 7.0, "ω": 7.0, "a": 49.0, "ε": 49.0, "R": 1.0, "effort": 1.0}
    floor["moment"] = max(abs(theirs) for _, theirs in pairs["R"])
    assert max(off(pairs, floor).values()) < AGREEMENT


@settings(max_examples=5, deadline=None, suppress_health_check=list(HealthCheck))
@given(data=st.data())
def test_springs_on_a_group(data: st.DataObject) -> None:
    prove(data, (data.draw(st.sampled_from(made.KINDS)),))


@proof
@settings(max_examples=150, deadline=None, suppress_health_check=list(HealthCheck))
@given(data=st.data())
def test_springs_on_chains(data: st.DataObject) -> None:
    prove(data, tuple(data.draw(st.lists(st.sampled_from(made.KINDS), min_size=1, max_size=3))))


SLOTTED = """
kind: linkage
positions: {count: 36}
parameters:
  frame: {A: [0 mm, 0 mm], D: [20 mm, -160 mm]}
  driver: {type: crank, centre: A, pin: B, length: 60 mm, n: 90 rpm}
  groups:
    - {type: RPR, links: [2, 3], joints: [B, B3, D], offset: 30 mm, axis: away}
  springs:
    - {link: 3, about: D, c: 5 N m/rad, free: FREE deg}
"""


@pytest.mark.parametrize(("free", "turns"), [(40, 0), (-236.5, 0), (123.5, 1)])
def test_a_torsion_spring_acts_by_the_angle_of_its_link(free: float, turns: int) -> None:
    """The slot passes its pivot at 30 mm; M = −c(φ₃ − φ₀) does no work, though it is wound by more than half a turn.

    φ₀ = −236.5° winds it by 143° to 187°; what is slack at φ₀ + 360° is the same spring.
    """
    model = reportgen.open(SLOTTED.replace("FREE", str(free)))
    B = 0.06 * np.exp(1j * np.radians(np.arange(0, 360, 10)))
    DB = B - (0.02 - 0.16j)
    # The axis points away from the block, which lies to its left by the offset.
    φ3 = np.angle(DB) - np.pi + np.arcsin(0.03 / np.abs(DB))
    φ3 = np.unwrap(np.angle(np.exp(1j * φ3)))
    assert φ3.max() - φ3.min() < np.pi
    M = -5 * (φ3 - math.radians(free) + 2 * math.pi * turns)
    assert np.array(model["M3"]) == pytest.approx(M, rel=1e-9)
    greatest = float(np.abs(model.case.analysis.torque).max())
    assert model.case.analysis.summary.mean_torque == pytest.approx(0, abs=1e-9 * greatest)


def test_a_torsion_spring_on_a_link_that_turns_round() -> None:
    """It is wound up without end: a link that makes whole turns has none."""
    turning = SLOTTED.replace("D: [20 mm, -160 mm]", "D: [10 mm, -20 mm]").replace("offset: 30", "offset: 0")
    with pytest.raises(AssignmentError, match="spring-winds-up"):
        reportgen.open(turning.replace("FREE", "0"))
