"""Groups of class III: the case R1 from the books, random groups against independent systems, their assembly modes."""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence

import linkages as made
import newton_euler as ne
import numpy as np
import pytest
from agreement import AGREEMENT, Pairs, collect, off, weights
from made_triads import DEGREE, R1, clear_places, random_linkages, random_places, triad

from reportgen.base.records import replace
from reportgen.machine import Crank, Linkage, Triad, joints, mobility
from reportgen.machine.force_analysis import Load, inertia_loads, solve_forces, virtual_work_torque
from reportgen.machine.force_analysis import weights as forces_of_weight
from reportgen.machine.kinematics import Motion, course_of, solve_motion
from reportgen.machine.triads import Pose, assemblies
from tests.lanes import matrix

# --- the case R1 ----------------------------------------------------------------------------------

OMEGA = 20.0


def printed(value: float, digits: int) -> object:
    """A value that rounds to the printed one."""
    return pytest.approx(value, abs=0.51 * 10.0**-digits)


def test_structure() -> None:
    found = mobility(R1)
    assert (found.n, found.lower_pairs, found.W, found.mechanism_class) == (5, 7, 1, 3)
    assert [joint.links for joint in joints(R1)] == [(0, 1), (1, 2), (2, 3), (0, 4), (4, 3), (0, 5), (5, 3)]


def test_positions_and_rates_of_r1() -> None:
    motion = solve_motion(R1, [60 * DEGREE], OMEGA)
    for name, x, y in (("D", 82.739263, 159.775205), ("E", 166.586132, 105.280227), ("F", 209.340354, 244.463834)):
        assert (motion.points[name].p[0].real * 1e3, motion.points[name].p[0].imag * 1e3) == (
            printed(x, 6),
            printed(y, 6),
        )
    for link, angle, omega, epsilon in (
        (2, 63.631148, -7.890453, 84.265143),
        (3, -33.021232, 0.261241, -114.774782),
        (4, 134.602028, -0.497064, 219.565201),
        (5, -21.730488, 0.556080, -245.874540),
    ):
        moved = motion.links[link]
        assert moved.angle[0] / DEGREE == printed(angle, 6)
        assert moved.omega[0] == printed(omega, 6)
        assert moved.epsilon[0] == printed(epsilon, 6)
    for name, v, at_v, a, at_a in (
        ("D", 0.0691524, 39.95759, 30.599963, -139.90852),
        ("E", 0.0944422, 44.60203, 41.717415, -135.33350),
        ("F", 0.0834120, 68.26951, 36.881210, -111.80255),
    ):
        point = motion.points[name]
        assert (abs(point.v[0]), np.angle(point.v[0]) / DEGREE) == (printed(v, 7), printed(at_v, 5))
        assert (abs(point.a[0]), np.angle(point.a[0]) / DEGREE) == (printed(a, 6), printed(at_a, 5))


def test_other_positions_of_r1() -> None:
    rows = (
        (0, 58.117476, 129.746316, -35.784540, -0.738454, -5.609896, 7.293113, 95.31759),
        (120, 63.800309, 138.246018, -35.932819, -0.162586, 5.169043, -6.507785, 80.87875),
        (180, 39.087596, 94.675235, -31.521037, 2.243022, 2.864966, -4.448223, -7.28751),
        (240, 30.310054, 74.345650, -27.123215, 0.338046, 0.266515, -0.498000, -49.39690),
        (300, 35.294073748, 86.290520, -29.860396, -2.023544, -2.102424, 3.485341, -31.62247),
    )
    motion = solve_motion(R1, [row[0] * DEGREE for row in rows], OMEGA)
    for k, (_, x, y, angle, *omegas, epsilon) in enumerate(rows):
        place = motion.points["D"].p[k] * 1e3
        assert (place.real, place.imag) == (printed(x, 6), printed(y, 6))
        assert motion.links[3].angle[k] / DEGREE == printed(angle, 6)
        assert [motion.links[link].omega[k] for link in (3, 4, 5)] == [printed(omega, 6) for omega in omegas]
        assert motion.links[3].epsilon[k] == printed(epsilon, 5)


def test_forces_of_r1() -> None:
    motion = solve_motion(R1, [60 * DEGREE], OMEGA)
    still = np.zeros(1)
    loads = (
        *forces_of_weight(R1, motion),
        *inertia_loads(R1, motion),
        Load("M4", 4, still + 0j, still + 0j, still + 60.0),
    )
    forces = solve_forces(R1, motion, loads)
    for name, size, angle in (
        ("R12", 263.471423, 64.84146),
        ("R04", 424.746968, -94.57157),
        ("R05", 235.881471, 158.77173),
        ("R32", 281.780282, -117.94613),
        ("R34", 415.753628, 88.60545),
        ("R35", 231.339347, -24.22246),
    ):
        force = forces.reactions[name].force[0]
        assert (abs(force), np.angle(force) / DEGREE) == (printed(size, 6), printed(angle, 5))
    assert forces.torque[0] == printed(1.111835, 6)
    assert virtual_work_torque(R1, motion, loads)[0] == pytest.approx(forces.torque[0], rel=1e-10)


def test_modes_of_r1() -> None:
    """Two assembly modes at 60°, as found by Newton's iteration from 6,000 starts; each keeps to itself for a turn."""
    crank_pin = cmath.rect(0.05, 60 * DEGREE)
    first, second = assemblies(R1.triads[0], (crank_pin, R1.ground["B"], R1.ground["C"]))
    assert (first.d * 1e3, cmath.phase(first.turn) / DEGREE) == (
        pytest.approx(82.739263 + 159.775205j, abs=1e-6),
        printed(-33.021232, 6),
    )
    assert (second.d * 1e3, cmath.phase(second.turn) / DEGREE) == (
        pytest.approx(154.904353 + 38.315372j, abs=1e-6),
        printed(65.466828, 6),
    )
    course = course_of(R1, R1.triads[0])
    assert course.closes
    lower = replace(R1.triads[0], near=(("D", 0.15 + 0.04j),))
    motion = solve_motion(replace(R1, groups=(lower,)), [60 * DEGREE], OMEGA)
    assert motion.points["D"].p[0] == pytest.approx(second.d, abs=1e-12)


def test_the_order_of_positions_does_not_matter() -> None:
    """A mode belongs to the crank's angle: backwards, over many turns and one by one it is the same."""
    angles = np.radians([10.0, 200.0, 725.0, -340.0, 55.0])
    together = solve_motion(R1, angles, OMEGA).points["F"].p
    alone = [solve_motion(R1, [angle], OMEGA).points["F"].p[0] for angle in angles]
    assert np.abs(together - np.array(alone)).max() < 1e-14
    again = solve_motion(R1, angles[::-1] % (2 * math.pi), -OMEGA).points["F"].p[::-1]
    assert np.abs(together - again).max() < 1e-14


# --- random groups --------------------------------------------------------------------------------

RNG_SEED = 65
STEP = 3e-5
"""Step of differences of the fourth order: they round at 1e-16/STEP and leave out STEP⁴/30 of the fifth derivative."""


@pytest.mark.parametrize("count", matrix([60, 500], [60]))
def test_random_triads(count: int) -> None:
    """Lengths to 1e-12, rates by differences to 1e-7, the three rates by the linear system of the pose to 1e-9."""
    rng = np.random.default_rng(RNG_SEED)
    used = 0
    for linkage in random_linkages(count, rng):
        places = clear_places(linkage, rng, 6)
        group = linkage.triads[0]
        if not places.size:
            continue
        used += 1
        motion = solve_motion(linkage, places, 1.0)
        around = [solve_motion(linkage, places + k * STEP, 1.0).points for k in (-2, -1, 1, 2)]
        rows, known, known_a = [], [], []
        for leg, local in zip(group.legs, group.locals, strict=True):
            p, q = motion.points[leg.outer], motion.points[leg.inner]
            assert np.abs(np.abs(q.p - p.p) - leg.length).max() < 1e-12
            in_plate = (q.p - motion.points[group.legs[0].inner].p) * np.exp(-1j * motion.links[group.plate].angle)
            assert np.abs(in_plate - local).max() < 1e-12
            for rate, value in (("v", "p"), ("a", "v")):
                far, near, next_, last = (getattr(points[leg.inner], value) for points in around)
                difference = (far - 8 * near + 8 * next_ - last) / (12 * STEP)
                known_rate = getattr(q, rate)
                assert np.abs(difference - known_rate).max() < 1e-7 * max(1.0, np.abs(known_rate).max())
            rod, arm = q.p - p.p, q.p - motion.points[group.legs[0].inner].p
            rows.append((rod.real, rod.imag, (np.conj(rod) * 1j * arm).real))
            known.append((np.conj(rod) * p.v).real)
            turning = np.conj(rod) * motion.links[group.plate].omega ** 2 * arm
            known_a.append((np.conj(rod) * p.a).real + turning.real - np.abs(q.v - p.v) ** 2)
        matrix_ = np.moveaxis(np.array(rows), 2, 0)
        for right, point, spin in ((known, "v", "omega"), (known_a, "a", "epsilon")):
            x, y, rate = np.linalg.solve(matrix_, np.array(right).T[:, :, None])[:, :, 0].T
            moved = getattr(motion.points[group.legs[0].inner], point)
            size = max(1.0, float(np.abs(moved).max()))
            assert np.abs(x + 1j * y - moved).max() < AGREEMENT * size
            found = getattr(motion.links[group.plate], spin)
            assert np.abs(rate - found).max() < AGREEMENT * max(1.0, float(np.abs(found).max()))
    assert used > 0.6 * count


CONDITION = 3e3


@pytest.mark.parametrize(
    ("count", "chained"), matrix([(40, False), (8, True), (200, False), (40, True)], [(40, False), (8, True)])
)
def test_forces_of_random_triads(count: int, chained: bool) -> None:
    """Rates, all reactions and the driver's effort against the bodies with constraints, at two positions of each."""
    rng = np.random.default_rng(RNG_SEED + chained)
    used = 0
    for linkage in random_linkages(count, rng, chained):
        places = clear_places(linkage, rng, 2)
        if not places.size:
            continue
        motion = solve_motion(linkage, places, 7.0, 11.0)
        pairs = against_witness(linkage, motion)
        if not pairs:
            continue
        used += 1
        found = off(pairs, dict.fromkeys(pairs, 1.0))
        assert max(found.values()) < AGREEMENT, (linkage, found)
    assert used > 0.3 * count


def against_witness(linkage: Linkage, motion: Motion) -> Pairs:
    forces = solve_forces(linkage, motion, (*forces_of_weight(linkage, motion), *inertia_loads(linkage, motion)))
    bodies, joined, keys = made.told(linkage)
    turning = isinstance(linkage.driver, Crank)
    pairs: Pairs = {}
    for k, pose in enumerate(made.poses(motion)):
        loads = weights(bodies, pose, linkage.gravity)
        answer = ne.solve(bodies, joined, turning, 7.0, pose, loads, CONDITION, 11.0)
        if answer is not None:
            assert answer.residual < 1e-12
            collect(pairs, motion, forces, keys, answer, k)
    return pairs


@pytest.mark.parametrize("count", matrix([30, 300], [30]))
def test_modes_by_a_dense_scan(count: int) -> None:
    """For each trial φ the first joint lies where two circles meet; the miss of the third leg is 0 at every mode."""
    rng = np.random.default_rng(RNG_SEED)
    turn = np.exp(1j * np.linspace(-math.pi, math.pi, 20_001))
    most = 0
    for _ in range(count):
        outer = random_places(rng, 3)
        group = triad(rng, (2, 3, 4, 5), list(zip("ABC", outer, strict=True)), 0.0)
        found = assemblies(group, outer)
        most = max(most, len(found))
        for pose in found:
            for leg, q, p in zip(group.legs, pose.joints(group), outer, strict=True):
                assert abs(q - p) == pytest.approx(leg.length, abs=1e-12)
        l1, l2, l3 = (leg.length for leg in group.legs)
        to = outer[1] - group.at[0] * turn - outer[0]
        along = (l1**2 - l2**2 + np.abs(to) ** 2) / (2 * np.abs(to))
        with np.errstate(invalid="ignore"):
            across = np.sqrt(l1**2 - along**2)
        scanned = 0
        for sign in (1, -1):
            d = outer[0] + to / np.abs(to) * (along + 1j * sign * across)
            miss = np.abs(d + group.at[1] * turn - outer[2]) - l3
            for k in np.flatnonzero(miss[:-1] * miss[1:] <= 0):
                scanned += 1
                assert min(abs(pose.turn - turn[k]) + abs(pose.d - d[k]) for pose in found) < 0.05
        # A mode next to a place where the circles touch can lie between two trials.
        touching = sum(1 for pose in found if _nearly_touching(group, pose, outer))
        assert scanned <= len(found) <= scanned + touching
    assert most >= 4


def _nearly_touching(group: Triad, pose: Pose, outer: Sequence[complex]) -> bool:
    first, second, _ = pose.joints(group)
    e, f = first - outer[0], second - outer[1]
    return abs((np.conj(e) * f).imag) < 0.1 * abs(e) * abs(f)


# --- dead points ----------------------------------------------------------------------------------


def test_a_course_ends_at_a_dead_point() -> None:
    """A longer crank cannot turn round: the mode ends where the lines of the legs meet; nothing runs off the sheet."""
    linkage = replace(R1, driver=Crank("O", "A", 0.12))
    group = linkage.triads[0]
    course = course_of(linkage, group)
    assert not course.whole
    assert not course.closes
    width = course.driver[-1] - course.driver[0]
    assert 0.5 < width < 2 * math.pi
    assert np.abs(course.determinant[[0, -1]]).max() < 1e-2
    ends = course.driver[[0, -1]]
    past = solve_motion(linkage, ends + np.array([-1e-3, 1e-3]), 1.0)
    assert not past.reachable.any()
    close = solve_motion(linkage, ends + np.array([1e-5, -1e-5]), 1.0)
    assert close.reachable.all()
    for leg in group.legs:
        length = np.abs(close.points[leg.inner].p - close.points[leg.outer].p)
        assert np.abs(length - leg.length).max() < 1e-12
        assert np.abs(close.points[leg.inner].p).max() < 1.0


def test_no_mode() -> None:
    """Legs that are too short: every position is unreachable, and nothing raises."""
    group = replace(R1.triads[0], legs=tuple(replace(leg, length=leg.length / 4) for leg in R1.triads[0].legs))
    motion = solve_motion(replace(R1, groups=(group,)), [0.0, 1.0, 2.0], 1.0)
    assert not motion.reachable.any()
    assert np.isnan(motion.points["D"].p).all()
