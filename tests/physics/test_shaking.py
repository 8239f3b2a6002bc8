"""Balancing against figures computed apart, statics of the frame, and searches that know nothing of its formulas."""

from __future__ import annotations

import cmath
import math
from pathlib import Path

import numpy as np
import pytest

from reportgen.balancing import balance_ids
from reportgen.balancing.counterweights import (
    Balancing,
    Counterweight,
    CounterweightRule,
    balanced,
    crank_rods,
    force_balance,
)
from reportgen.balancing.shaking_force import (
    CrankCurve,
    balanced_in,
    balanced_turn,
    counterweight,
    frame_reactions,
    round_points,
    seen_from_crank,
    shaking_force,
    shaking_moment,
)
from reportgen.base.records import replace
from reportgen.cases import MachineCase, open_case
from reportgen.formula.calculation import Calculation
from reportgen.machine import GROUND, Crank, Dyad, Guide, Inertia, Linkage, LinkPoint, joints
from reportgen.machine.analysis import Machine, analyse, motion_at
from reportgen.machine.force_analysis import inertia_loads, reaction_name, solve_forces
from reportgen.machine.kinematics import solve_motion
from reportgen.machine.load_laws import FULL_TURN
from reportgen.machine.rigid_motion import cross
from tests.lanes import matrix, proof

ASSIGNMENTS = Path(__file__).parents[2] / "assignments"


def machine_of(linkage: Linkage, speed: float, balancing: Balancing | None = None) -> Machine:
    topics = {} if balancing is None else {"balancing": balancing}
    return Machine("linkage", linkage, 0.0, 1, speed, 12, 1, Calculation(), (), topics=topics)


def slider_crank(r: float, l: float, e: float, share: complex, masses: tuple[float, float, float]) -> Linkage:  # noqa: E741
    """A crank with its mass at the pin, a rod with its mass centre at `share` of it, a slider."""
    return Linkage(
        {"O": 0j},
        Crank("O", "A", r),
        (Dyad("RRP", (2, 3), "A", "B", Guide(1j * e, 0.0), (l, 0.0)),),
        (LinkPoint("S1", 1, complex(r)), LinkPoint("S2", 2, share * l)),
        (Inertia(1, "S1", masses[0]), Inertia(2, "S2", masses[1], 1e-3), Inertia(3, "B", masses[2])),
    )


def four_bar(lengths: tuple[float, ...], masses: tuple[float, ...], places: tuple[complex, ...]) -> Linkage:
    """The bars a, b, c, d with mass centres at places of crank, coupler and rocker, in their frames (m)."""
    a, b, c, d = lengths
    names = ("S1", "S2", "S3")
    return Linkage(
        {"A": 0j, "D": complex(d)},
        Crank("A", "B", a),
        (Dyad("RRR", (2, 3), "B", "C", "D", (b, c), 1),),
        tuple(LinkPoint(name, link, place) for link, (name, place) in enumerate(zip(names, places, strict=True), 1)),
        tuple(
            Inertia(link, name, mass, mass * b**2 / 12)
            for link, (name, mass) in enumerate(zip(names, masses, strict=True), 1)
        ),
    )


INLINE = slider_crank(0.040, 0.160, 0.0, 0.35 + 0j, (0.0, 0.6, 0.5))
"""r 40, l 160 mm, a rod of 0.6 kg, its mass centre at 0.35 l, a slider of 0.5 kg; the crank is balanced by itself."""
SKEW = four_bar((0.050, 0.150, 0.120, 0.180), (0.4, 1.1, 0.9), (0.025 + 0j, 0.0675 + 0.020j, 0.060 + 0j))
"""A four-bar whose coupler has its mass centre beside it."""


# --- figures computed apart ---------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("rule", "U", "greatest", "rms"),
    [
        (None, 0.0, 4599.0, 3006.201979),
        ("rotating", 0.0156, 3195.0, 1864.781579),
        ("rms", 0.0298, 1917.0, 1357.986133),
        ("max", 0.03235413, 1687.128377, 1377.3044),
        # A search at steps of 1e-5 rad finds this maximum at 97.354°; coarser ones end below it.
        ("share", 0.03453333, 1847.444905, 1423.236571),
    ],
)
def test_a_slider_crank_by_each_rule(rule: CounterweightRule | None, U: float, greatest: float, rms: float) -> None:
    """Tolerances are half a unit of the last digit that the figures are given with."""
    machine = machine_of(INLINE, 300.0)
    curve = seen_from_crank(machine)
    product = 0j if rule is None else counterweight(machine, curve, rule, 2 / 3)
    assert product == pytest.approx(-U, abs=5e-9)
    assert curve.greatest(product)[0] * 300**2 == pytest.approx(greatest, abs=5e-7)
    assert curve.rms(product) * 300**2 == pytest.approx(rms, abs=5e-5)


def test_all_of_what_goes_to_and_fro() -> None:
    machine = machine_of(INLINE, 300.0)
    curve = seen_from_crank(machine)
    product = counterweight(machine, curve, "share", 1.0)
    assert product == pytest.approx(-0.044, abs=1e-15)
    assert curve.greatest(product)[0] * 300**2 == pytest.approx(2639.825449, abs=5e-7)
    assert curve.rms(product) * 300**2 == pytest.approx(1864.781579, abs=5e-7)


def test_where_the_smallest_circle_touches() -> None:
    """At 0° and ±100.84246° of an in-line slider-crank, at the ends of a diameter of a four-bar without symmetry."""
    degrees = np.degrees(seen_from_crank(machine_of(INLINE, 300.0)).circle.touching)
    assert sorted((degrees + 180) % 360 - 180) == pytest.approx([-100.84246, 0.0, 100.84246], abs=5e-6)
    circle = seen_from_crank(machine_of(SKEW, 20.0)).circle
    assert np.degrees(circle.touching) == pytest.approx([22.829, 325.622], abs=5e-4)
    assert circle.radius * 20**2 == pytest.approx(20.7382, abs=5e-5)


def test_a_four_bar_with_one_counterweight() -> None:
    curve = seen_from_crank(machine_of(SKEW, 20.0))
    assert curve.greatest()[0] * 20**2 == pytest.approx(46.613875, abs=5e-6)
    assert curve.rms() * 20**2 == pytest.approx(28.836090, abs=5e-7)
    least = -curve.mean
    assert abs(least) == pytest.approx(0.0645214, abs=5e-8)
    assert math.degrees(cmath.phase(least)) == pytest.approx(174.6474, abs=5e-5)
    assert curve.rms(least) * 20**2 == pytest.approx(12.862274, abs=5e-6)


def test_the_whole_balance_of_a_four_bar() -> None:
    crank, rocker = force_balance(SKEW).values()
    assert abs(crank) == pytest.approx(0.04091259, abs=5e-9)
    assert math.degrees(cmath.phase(crank)) == pytest.approx(169.67428, abs=5e-6)
    assert abs(rocker) == pytest.approx(0.11475766, abs=5e-9)
    assert math.degrees(cmath.phase(rocker)) == pytest.approx(-171.17792, abs=5e-6)


# --- machines made at random --------------------------------------------------------------------------


def some_linkage(random: np.random.Generator, kind: str = "") -> Linkage:
    """A slider-crank or a crank-rocker by Grashof, of any sizes, masses and mass centres."""
    masses = tuple(random.uniform(0.1, 3.0, 3))
    if (kind or random.choice(["slider", "bars"])) == "slider":
        r, e = random.uniform(0.02, 0.2), random.uniform(-0.3, 0.3)
        l = r * random.uniform(1.5, 6.0) + r * abs(e)  # noqa: E741
        return slider_crank(r, l, e * r, complex(*random.uniform(-0.3, 1.0, 2)), masses)
    while True:
        a, *others = np.sort(random.uniform(0.05, 0.5, 4))
        # A crank-rocker near a dead point has peaks that no even places of a turn show to nine figures.
        if a + others[2] < 0.85 * (others[0] + others[1]):
            b, c, d = random.permutation(others)
            places = tuple(complex(*random.uniform(-0.2, 0.4, 2)) for _ in range(3))
            return four_bar((a, b, c, d), masses, places)


SEEDS = matrix(range(25), range(1))
"""Twenty machines each."""


def finely(curve: np.ndarray) -> np.ndarray:
    """A curve at even places of a turn [N] at four times as many, by its discrete Fourier transform."""
    waves, half = np.fft.fft(curve), len(curve) // 2
    return np.fft.ifft(np.concatenate((waves[:half], np.zeros(3 * len(curve)), waves[half:]))) * 4


def greatest_of(seen: np.ndarray) -> np.ndarray:
    """The greatest size over a turn [K] of curves at even places [N, K], by parabolas about the peaks."""
    square = np.abs(seen) ** 2
    before, after = np.roll(square, 1, axis=0), np.roll(square, -1, axis=0)
    bend = before - 2 * square + after
    peaks = np.where((square >= before) & (square >= after) & (bend < 0), bend, -np.inf)
    return np.sqrt((square - (after - before) ** 2 / (8 * peaks)).max(axis=0))


@pytest.mark.parametrize("seed", SEEDS)
def test_no_counterweight_is_better(seed: int) -> None:
    """A search over size and angle, on places of the curve computed anew, gains no billionth on either rule.

    Both measures are convex, so that where none of the directions about a place is better at any step, none is.
    """
    random = np.random.default_rng(seed)
    ways = np.exp(1j * np.arange(6) * (FULL_TURN / 6))
    steps = (np.array([0.3, 1e-2, 1e-4, 1e-6])[:, None] * ways).ravel()
    for _ in range(20):
        machine = machine_of(some_linkage(random), 10.0)
        curve = seen_from_crank(machine)
        motion = motion_at(machine, np.arange(4000) * (FULL_TURN / 4000))
        seen = finely(shaking_force(machine.linkage, motion) * np.exp(-1j * motion.driver) / machine.speed**2)
        least, mean = -curve.circle.centre, -curve.mean
        greatest, rms = curve.greatest(least)[0], curve.rms(mean)
        assert greatest_of((seen + least)[:, None]) == pytest.approx(greatest, rel=1e-9)
        assert np.sqrt(np.mean(np.abs(seen + mean) ** 2)) == pytest.approx(rms, rel=1e-9)
        tried = steps * curve.circle.radius
        assert greatest_of(seen[:, None] + (least + tried)).min() >= greatest * (1 - 1e-9)
        # |c + U|² in the mean is the mean of |c|² and what U adds.
        square = (
            np.mean(np.abs(seen) ** 2) + 2 * np.real(np.conj(np.mean(seen)) * (mean + tried)) + abs(mean + tried) ** 2
        )
        assert np.sqrt(square.min()) >= rms * (1 - 1e-9)


@pytest.mark.parametrize("seed", SEEDS)
def test_a_balanced_four_bar_leaves_no_force(seed: int) -> None:
    """Its mass centre rests: 1e-12 of the force before is what rounding leaves of sums of some ten terms."""
    random = np.random.default_rng(seed)
    for _ in range(20):
        linkage = some_linkage(random, "bars")
        motion = solve_motion(linkage, np.linspace(0, FULL_TURN, 90), 10.0)
        weights = [Counterweight(link, product, 0.1) for link, product in force_balance(linkage).items()]
        whole = balanced(linkage, weights)
        with_them = solve_motion(whole, np.linspace(0, FULL_TURN, 90), 10.0)
        # Rounding is of the size of the forces of single bodies, where these nearly cancel already.
        size = max(np.abs(load.force).max() for load in inertia_loads(whole, with_them))
        assert np.abs(shaking_force(whole, with_them)).max() <= 1e-12 * max(
            size, np.abs(shaking_force(linkage, motion)).max()
        )
        places = sum(body.mass * with_them.points[body.centre].p for body in whole.inertias)
        assert np.ptp(places.real) + np.ptp(places.imag) <= 1e-12 * np.abs(places).max()


# --- statics of the frame -----------------------------------------------------------------------------


@pytest.mark.parametrize("seed", SEEDS)
def test_force_and_moment_are_what_the_joints_hand_to_the_frame(seed: int) -> None:
    """Reactions and guide couples on the frame, and the drive's own moment on it, when nothing but inertia acts."""
    random = np.random.default_rng(seed)
    for _ in range(20):
        linkage = some_linkage(random)
        motion = solve_motion(linkage, np.linspace(0, FULL_TURN, 60), 10.0)
        forces = solve_forces(linkage, motion, inertia_loads(linkage, motion))
        force = shaking_force(linkage, motion)
        assert np.abs(frame_reactions(linkage, motion) - force).max() <= 1e-11 * np.abs(force).max()
        moment = -forces.torque
        for joint in joints(linkage):
            if joint.links[0] == GROUND:
                reaction = forces.reactions[reaction_name(joint.links[1], GROUND)]
                moment = moment + cross(motion.points[joint.point].p, reaction.force) + reaction.moment
        shaken = shaking_moment(linkage, motion)
        # Moments of single reactions, of which the sum is left, are larger than it.
        assert np.abs(moment - shaken).max() <= 1e-10 * np.abs(force).max() * linkage.driver.length * 100


# --- the smallest circle ------------------------------------------------------------------------------


def test_the_smallest_circle_round_points() -> None:
    """Of a right triangle that on its hypotenuse; of points on a circle that circle; of one point the point."""
    assert round_points(np.array([0j, 4, 3j]))[:2] == pytest.approx((2 + 1.5j, 2.5))
    on_a_circle = 3 + 1j + 2 * np.exp(1j * np.array([0.1, 1.3, 2.9, 4.4, 5.0]))
    centre, radius, support = round_points(on_a_circle)
    assert (centre, radius) == pytest.approx((3 + 1j, 2.0))
    assert len(support) == 3
    assert round_points(np.array([2 + 1j, 2 + 1j])) == (2 + 1j, 0.0, (0,))


def test_a_scotch_yoke_is_seen_as_a_circle() -> None:
    """F = m r ω² cos φ along a line is, seen from the crank, a circle about half of it: touched everywhere."""
    harmonics = np.zeros(1440, complex)
    harmonics[0] = harmonics[-2] = 0.5
    circle = CrankCurve(harmonics).circle
    assert (circle.centre, circle.radius) == pytest.approx((0.5, 0.5), abs=1e-12)


# --- the ledger and what is carried out ---------------------------------------------------------------

NAMES = ("slider-crank-04", "four-bar-04", "balancing/twin-180", "balancing/twin-270", "balancing/v-60")
TELLING = ("slider-crank-04", "four-bar-04", "balancing/twin-270")


@pytest.fixture(scope="module", params=matrix(NAMES, TELLING))
def case(request: pytest.FixtureRequest) -> MachineCase:
    opened = open_case(ASSIGNMENTS / f"{request.param}.yaml")
    assert isinstance(opened, MachineCase)
    return opened


def test_the_ledger_says_the_same(case: MachineCase) -> None:
    """Components by directions and sizes of a plan, against vectors: twelve figures of the greatest."""
    linkage, motion, ledger = case.analysis.machine.linkage, case.analysis.motion, case.ledger
    force, moment = shaking_force(linkage, motion), shaking_moment(linkage, motion)
    x, y = (ledger[balance_ids.component(axis)].values for axis in "xy")
    assert np.abs(x + 1j * y - force).max() <= 1e-11 * np.abs(force).max()
    assert np.abs(ledger[balance_ids.MOMENT].values - moment).max() <= 1e-11 * max(
        np.abs(moment).max(), np.abs(force).max() * linkage.driver.length
    )


def test_what_the_counterweights_change(case: MachineCase) -> None:
    """Force, R₀₁, M_cb and moment with them, against the whole analysis of the machine that has them as masses."""
    turn = balanced_in(case.analysis)
    after, ledger = analyse(turn.balanced), case.ledger
    expected = {
        balance_ids.AFTER_FORCE: np.abs(shaking_force(after.machine.linkage, after.motion)),
        balance_ids.AFTER_REACTION: np.abs(after.forces.reactions["R01"].force),
        balance_ids.AFTER_TORQUE: after.torque,
        balance_ids.AFTER_MOMENT: shaking_moment(after.machine.linkage, after.motion),
    }
    size = {id: np.abs(values).max() for id, values in expected.items()}
    size[balance_ids.AFTER_FORCE] = np.abs(shaking_force(turn.machine.linkage, after.motion)).max()
    for id, values in expected.items():
        if id in ledger:
            assert np.abs(ledger[id].values - values).max() <= 1e-10 * size[id], id


def test_products_of_the_rules(case: MachineCase) -> None:
    """U of each rule by the formulas of the report is that of the curve, and so is what it leaves."""
    turn, ledger = balanced_in(case.analysis), case.ledger
    speed = turn.machine.speed
    for rule, product in turn.products.items():
        parts = [
            ledger[id].values[0] if (id := balance_ids.rule_component(rule, axis)) in ledger else 0 for axis in "xy"
        ]
        assert complex(*parts) == pytest.approx(product, abs=1e-10 * abs(product))
        left = machine_of(balanced(turn.machine.linkage, [Counterweight(1, product, 0.05)]), speed)
        curve = seen_from_crank(replace(left, start=turn.machine.start, turn=turn.machine.turn))
        assert curve.greatest()[0] * speed**2 == pytest.approx(
            ledger[balance_ids.greatest("F", rule)].values[0], rel=1e-9
        )


def test_point_masses_give_the_same_force() -> None:
    """m_A at the pin and m_B with the slider in place of the rod: the force of an in-line slider-crank."""
    (rod,) = crank_rods(INLINE)
    assert (rod.turning, rod.reciprocating) == pytest.approx((0.39, 0.21 + 0.5))
    motion = solve_motion(INLINE, np.linspace(0, FULL_TURN, 50), 300.0)
    force = -rod.turning * motion.points["A"].a - rod.reciprocating * motion.points["B"].a
    assert np.abs(force - shaking_force(INLINE, motion)).max() <= 1e-12 * np.abs(force).max()


def test_a_mirrored_machine_is_mirrored() -> None:
    """A clockwise crank has the counterweight of its mirrored twin, at the opposite angle."""
    twin = four_bar((0.05, 0.15, 0.12, 0.18), (0.4, 1.1, 0.9), (0.025 + 0j, 0.0675 - 0.020j, 0.060 + 0j))
    twin = replace(twin, groups=(replace(twin.dyads[0], sign=-1),))
    here = seen_from_crank(machine_of(SKEW, 20.0))
    there = seen_from_crank(replace(machine_of(twin, 20.0), turn=-1))
    assert there.mean == pytest.approx(here.mean.conjugate(), rel=1e-12)
    assert there.circle.centre == pytest.approx(here.circle.centre.conjugate(), rel=1e-9)


@proof
def test_rules_of_a_machine_in_the_order_of_the_file() -> None:
    turn = balanced_turn(machine_of(INLINE, 300.0, Balancing(("max", "rms"), radius=0.06)))
    assert list(turn.products) == ["max", "rms"]
    (weight,) = turn.weights
    assert weight.mass == pytest.approx(0.03235413 / 0.06, abs=1e-6)
