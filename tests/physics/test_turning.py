"""Laws that every machine obeys over a whole turn, whatever its numbers."""

from __future__ import annotations

import math

import numpy as np
import pytest

from reportgen.base.records import replace
from reportgen.machine import Crank, Dyad, Guide, Inertia, Linkage, LinkPoint, joints, mobility
from reportgen.machine.force_analysis import (
    Load,
    as_single_force,
    inertia_loads,
    percussion_points,
    solve_forces,
    virtual_work_torque,
    weights,
)
from reportgen.machine.kinematics import Motion, solve_motion
from reportgen.machine.quadrature import mean_over
from reportgen.machine.rigid_motion import cross

COUNT = 256
"""Positions of a turn: the machines' spectra fall below rounding long before the 128th harmonic."""
DIFFERENTIATION = 1e-9
"""Rounding 1e-16 of a coordinate, twice multiplied by the highest harmonic kept (128²) with room."""
ROUNDING = 1e-11
OMEGA = 7.0
TURN = np.arange(COUNT) * 2 * math.pi / COUNT


def with_masses(linkage: Linkage) -> Linkage:
    """A mass off the axis on every moving link, the driver too."""
    points = tuple(LinkPoint(f"S{k}", k, 0.11 + 0.02 * k + 0.03j) for k in linkage.links)
    masses = tuple(Inertia(k, f"S{k}", 1 + 0.3 * k, 0.02 * k) for k in linkage.links)
    return replace(linkage, points=(*linkage.points, *points), inertias=masses)


MACHINES = {
    "twin": Linkage(
        {"O": 0},
        Crank("O", "A", 0.2),
        (
            Dyad("RRP", (2, 3), "A", "B", Guide(0, math.pi / 2), (0.72, 0)),
            Dyad("RRP", (4, 5), "C", "D", Guide(0, math.pi / 2), (0.72, 0)),
        ),
        (LinkPoint("C", 1, -0.2),),
    ),
    "four-bar, rocker to slider": Linkage(
        {"O": 0, "E": 1 - 0.1j},
        Crank("O", "A", 0.25),
        (
            Dyad("RRR", (2, 3), "A", "B", "E", (0.9, 0.6), 1),
            Dyad("RRP", (4, 5), "F", "G", Guide(0.9j, 0.1), (0.8, 0), -1),
        ),
        (LinkPoint("F", 3, 0.7 + 0.05j),),
    ),
    "shaper": Linkage(
        {"O": 0.27j, "E": 0},
        Crank("O", "A", 0.103),
        (
            Dyad("RPR", (2, 3), "A", "A3", "E", (0, 0.01), 1),
            Dyad("RRP", (4, 5), "D", "H", Guide(0.52j, math.pi), (0.1, 0), 1),
        ),
        (LinkPoint("D", 3, 0.55 + 0.01j),),
    ),
    "scotch yoke, then a turning guide": Linkage(
        {"O": 0, "E": -0.9 - 0.8j},
        Crank("O", "A", 0.3),
        (
            Dyad("RPP", (2, 3), "A", "B", Guide(-0.5j, 0.0), slide_angle=1.4),
            Dyad("RPR", (4, 5), "T", "T5", "E", (0, 0.1), 1),
            Dyad("RRP", (6, 7), "A", "K", Guide(0.3j, 0.2, 5), (2.0, 0), 1),
        ),
        (LinkPoint("T", 3, 0.1j),),
    ),
    "two guides that turn": Linkage(
        {"O": 0, "E": 1.0},
        Crank("O", "A", 0.3),
        (
            Dyad("RRR", (2, 3), "A", "B", "E", (0.9, 0.6), 1),
            Dyad("PRP", (4, 5), Guide(0.2j, 0.0, 2), "Q", Guide(0.1j, 0.0, 3)),
        ),
    ),
}
MACHINES = {name: with_masses(linkage) for name, linkage in MACHINES.items()}


@pytest.fixture(params=list(MACHINES), name="linkage")
def _linkage(request: pytest.FixtureRequest) -> Linkage:
    return MACHINES[request.param]


@pytest.fixture(name="motion")
def _motion(linkage: Linkage) -> Motion:
    motion = solve_motion(linkage, TURN, OMEGA)
    assert motion.reachable.all()
    return motion


def all_loads(linkage: Linkage, motion: Motion) -> tuple[Load, ...]:
    still = np.zeros_like(motion.driver)
    last = linkage.links[-1]
    push = Load("P", last, still - 40 + 15j, motion.origins[last].p + 0.05, still + 3.0)
    return (push, *weights(linkage, motion), *inertia_loads(linkage, motion))


def derivative(values: np.ndarray) -> np.ndarray:
    """d/dt of a quantity periodic over the turn, by its Fourier series."""
    harmonics = np.fft.fftfreq(COUNT, 1 / COUNT)
    harmonics[COUNT // 2] = 0
    return np.fft.ifft(1j * harmonics * OMEGA * np.fft.fft(values))


def assert_same(ours: np.ndarray, theirs: np.ndarray, floor: float, bound: float) -> None:
    assert np.abs(ours - theirs).max() <= bound * max(np.abs(theirs).max(), floor)


def test_rates_are_derivatives(linkage: Linkage, motion: Motion) -> None:
    # The point of a slotted link under its slider is another one at every moment: no one path.
    passing = {dyad.middle for dyad in linkage.dyads if dyad.kind == "RPR"}
    # Quantities that are nothing by nature are read against the crank's own ωr, ω²r with r near 0.3 m.
    for point in (point for name, point in motion.points.items() if name not in passing):
        assert_same(point.v, derivative(point.p), OMEGA * 0.1, DIFFERENTIATION)
        assert_same(point.a, derivative(point.v), OMEGA**2 * 0.1, DIFFERENTIATION)
    for link in motion.links.values():
        turned = np.exp(1j * link.angle)
        rate = (derivative(turned) / (1j * turned)).real
        assert_same(link.omega, rate, OMEGA * 0.1, DIFFERENTIATION)
        assert_same(link.epsilon, derivative(link.omega).real, OMEGA**2 * 0.1, DIFFERENTIATION)
    for slide in motion.slides.values():
        assert_same(slide.v, derivative(slide.s).real, OMEGA * 0.1, DIFFERENTIATION)
        assert_same(slide.a, derivative(slide.v).real, OMEGA**2 * 0.1, DIFFERENTIATION)


def test_rods_keep_their_lengths_and_pins_their_guides(linkage: Linkage, motion: Motion) -> None:
    for dyad in linkage.dyads:
        middle = motion.points[dyad.middle].p
        if dyad.kind in ("RRR", "RRP"):
            span = np.abs(middle - motion.points[str(dyad.start)].p)
            assert span == pytest.approx(np.full(COUNT, dyad.lengths[0]), rel=ROUNDING)
        if dyad.kind == "RRR":
            span = np.abs(middle - motion.points[str(dyad.end)].p)
            assert span == pytest.approx(np.full(COUNT, dyad.lengths[1]), rel=ROUNDING)
        if isinstance(dyad.end, Guide) and dyad.end.link == 0:
            assert cross(np.exp(1j * dyad.end.angle), middle - dyad.end.at) == pytest.approx(
                np.zeros(COUNT), abs=ROUNDING
            )


def test_every_link_is_in_equilibrium(linkage: Linkage, motion: Motion) -> None:
    loads = all_loads(linkage, motion)
    forces = solve_forces(linkage, motion, loads)
    largest = max(np.abs(reaction.force).max() for reaction in forces.reactions.values())
    for link in linkage.links:
        force = sum(load.force for load in loads if load.link == link)
        moment = sum(load.moment(0) for load in loads if load.link == link)
        for joint in joints(linkage):
            if link in joint.links:
                other = next(number for number in joint.links if number != link)
                reaction = forces.reactions[f"R{other}{link}"]
                opposite = forces.reactions[f"R{link}{other}"]
                assert np.array_equal(reaction.force, -opposite.force)
                force = force + reaction.force
                at = motion.points[joint.point].p
                moment = moment + cross(at, reaction.force) + reaction.moment
        if link == 1:
            moment = moment + forces.torque
        assert np.abs(force).max() <= ROUNDING * largest
        assert np.abs(moment).max() <= ROUNDING * largest  # arms are near 1 m


def test_a_guide_pushes_square_to_itself_with_one_resultant(linkage: Linkage, motion: Motion) -> None:
    forces = solve_forces(linkage, motion, all_loads(linkage, motion))
    for joint in joints(linkage):
        if joint.kind == "P":
            reaction = forces.reactions["R{}{}".format(*joint.links)]
            along = (reaction.force * np.conj(motion.slides[joint.links].direction)).real
            assert np.abs(along).max() <= ROUNDING * np.abs(reaction.force).max()
            at = motion.points[joint.point].p
            arm = cross(reaction.point - at, reaction.force)
            assert arm == pytest.approx(reaction.moment, abs=1e-9 * np.abs(reaction.moment).max())


def test_both_torques_are_equal(linkage: Linkage, motion: Motion) -> None:
    loads = all_loads(linkage, motion)
    by_work = virtual_work_torque(linkage, motion, loads)
    by_equilibrium = solve_forces(linkage, motion, loads).torque
    assert np.abs(by_work - by_equilibrium).max() <= 1e-9 * np.abs(by_work).max()


def test_inertia_gives_no_work_over_a_turn(linkage: Linkage, motion: Motion) -> None:
    # Weights and inertia return to where they were, so their mean torque is nothing; on a periodic
    # function the mean of equal steps is spectrally exact.
    loads = (*weights(linkage, motion), *inertia_loads(linkage, motion))
    torque = virtual_work_torque(linkage, motion, loads)
    assert abs(torque.mean()) <= 1e-9 * np.abs(torque).max()


# --- invariances -----------------------------------------------------------------------------------


def changed(linkage: Linkage, turn: complex, mirror: bool) -> Linkage:
    """The linkage multiplied by a complex number (rotation and scale), or reflected in the x axis first."""
    angle, size = float(np.angle(turn)), abs(turn)

    def place(p: complex) -> complex:
        return complex(np.conj(p) if mirror else p)

    def guide(end: str | Guide) -> str | Guide:
        if isinstance(end, str):
            return end
        own = -end.angle if mirror else end.angle
        # A guide on a moving link moves and turns with that link's frame.
        if end.link:
            return Guide(size * place(end.at), own, end.link)
        return Guide(turn * place(end.at), own + angle, 0)

    def dyad(old: Dyad) -> Dyad:
        flips = old.kind == "RRR" and mirror
        return replace(
            old,
            start=guide(old.start),
            end=guide(old.end),
            # e is measured to the left of the axis, so a mirror changes its side; a rod has no side.
            lengths=(size * old.lengths[0], size * old.lengths[1] * (-1 if mirror and old.kind == "RPR" else 1)),
            sign=-old.sign if flips else old.sign,
            slide_angle=-old.slide_angle if mirror else old.slide_angle,
        )

    assert isinstance(linkage.driver, Crank)
    return replace(
        linkage,
        ground={name: turn * place(p) for name, p in linkage.ground.items()},
        driver=replace(linkage.driver, length=size * linkage.driver.length),
        groups=tuple(dyad(old) for old in linkage.dyads),
        points=tuple(replace(point, local=size * place(point.local)) for point in linkage.points),
        inertias=tuple(replace(body, moment=size**2 * body.moment) for body in linkage.inertias),
        gravity=size * np.exp(1j * angle) * place(linkage.gravity),
    )


@pytest.mark.parametrize("turn", [np.exp(0.8j), 2.5 + 0j, 0.01 * np.exp(-2j)])
def test_rotation_and_scale(linkage: Linkage, motion: Motion, turn: complex) -> None:
    other = changed(linkage, turn, mirror=False)
    moved = solve_motion(other, TURN + np.angle(turn), OMEGA)
    for name, point in motion.points.items():
        assert_same(moved.points[name].a, turn * point.a, abs(turn) * OMEGA**2 * 0.1, ROUNDING)
    for number, link in motion.links.items():
        assert_same(moved.links[number].epsilon, link.epsilon, OMEGA**2 * 0.1, ROUNDING)
    ours = solve_forces(linkage, motion, inertia_loads(linkage, motion))
    theirs = solve_forces(other, moved, inertia_loads(other, moved))
    # Forces m·a grow with the size, torques with its square.
    assert_same(theirs.torque, abs(turn) ** 2 * ours.torque, 0.0, 1e-10)
    for key, reaction in ours.reactions.items():
        assert_same(theirs.reactions[key].force, turn * reaction.force, abs(turn), 1e-10)


def test_clockwise_is_the_mirrored_anticlockwise_machine(linkage: Linkage, motion: Motion) -> None:
    other = changed(linkage, 1 + 0j, mirror=True)
    mirrored = solve_motion(other, -TURN, -OMEGA)
    for name, point in motion.points.items():
        assert_same(mirrored.points[name].p, np.conj(point.p), 0.1, ROUNDING)
        assert_same(mirrored.points[name].v, np.conj(point.v), OMEGA * 0.1, ROUNDING)
        assert_same(mirrored.points[name].a, np.conj(point.a), OMEGA**2 * 0.1, ROUNDING)
    for number, link in motion.links.items():
        assert_same(mirrored.links[number].omega, -link.omega, OMEGA * 0.1, ROUNDING)
        assert_same(mirrored.links[number].epsilon, -link.epsilon, OMEGA**2 * 0.1, ROUNDING)
    loads = (*weights(linkage, motion), *inertia_loads(linkage, motion))
    theirs_loads = (*weights(other, mirrored), *inertia_loads(other, mirrored))
    ours, theirs = solve_forces(linkage, motion, loads), solve_forces(other, mirrored, theirs_loads)
    assert_same(theirs.torque, -ours.torque, 0.0, 1e-10)
    for key, reaction in ours.reactions.items():
        assert_same(theirs.reactions[key].force, np.conj(reaction.force), 1.0, 1e-10)


# --- single results ----------------------------------------------------------------------------------


def test_angles_are_continuous_even_between_few_positions() -> None:
    # The yoke-driven arm of a quick return turns fully with its crank, unevenly: over the short way by
    # more than half a turn between two of four positions.
    linkage = Linkage({"O": 0, "E": 0.25}, Crank("O", "A", 0.3), (Dyad("RPR", (2, 3), "A", "A3", "E"),))
    coarse = solve_motion(linkage, np.arange(5) * math.pi / 2 + 0.8, 5.0).links[3].angle
    fine = solve_motion(linkage, np.arange(721) * math.pi / 360 + 0.8, 5.0).links[3].angle
    assert coarse == pytest.approx(fine[::180], abs=ROUNDING)
    assert coarse[-1] - coarse[0] == pytest.approx(2 * math.pi)


def test_unreachable_positions_are_nan() -> None:
    linkage = Linkage(
        {"O": 0, "E": 1.0},
        Crank("O", "A", 0.6),
        (Dyad("RRR", (2, 3), "A", "B", "E", (0.5, 0.5), 1), Dyad("RRP", (4, 5), "B", "C", Guide(0, 0.0), (2.0, 0))),
    )
    degrees = np.arange(0, 360, 10)
    motion = solve_motion(linkage, np.radians(degrees), 3.0)
    # |AE|² = 1.36 − 1.2 cos φ ≤ 1: A comes within reach of E where cos φ ≥ 0.3, |φ| ≤ 72.5°.
    assert degrees[~motion.reachable].tolist() == list(range(80, 290, 10))
    for array in (motion.points["B"].p, motion.points["C"].a, motion.links[4].angle):
        assert np.isnan(array[~motion.reachable]).all()
        assert np.isfinite(array[motion.reachable]).all()
    forces = solve_forces(linkage, motion, weights(linkage, motion))
    assert (np.isnan(forces.torque) == ~motion.reachable).all()
    assert np.isfinite(forces.reactions["R03"].force[motion.reachable]).all()


def test_a_singular_position_is_not_guessed() -> None:
    # Rod as long as crank on a guide through the centre: at 90° the rod stands square to the guide.
    linkage = Linkage({"O": 0}, Crank("O", "A", 0.3), (Dyad("RRP", (2, 3), "A", "B", Guide(0, 0.0), (0.3, 0)),))
    motion = solve_motion(linkage, np.radians([60.0, 90.0]), 2.0)
    assert motion.reachable.tolist() == [True, False]
    assert np.isnan(motion.points["B"].v[1])


def test_one_force_stands_for_inertia_force_and_couple(motion: Motion, linkage: Linkage) -> None:
    for load in inertia_loads(linkage, motion):
        point = as_single_force(load)
        alone = cross(point - load.point, load.force)
        assert alone == pytest.approx(load.couple, abs=1e-10 * max(np.abs(load.couple).max(), 1e-6))
        where = np.abs(load.couple) > 0
        arm = np.abs(point - load.point)[where]
        assert arm == pytest.approx(np.abs(load.couple[where]) / np.abs(load.force[where]), rel=1e-9)


def test_one_force_in_its_limits() -> None:
    zero = np.zeros(1)
    at = np.array([1 + 1j])
    assert as_single_force(Load("", 2, zero + 3j, at, zero))[0] == at[0]
    assert np.isnan(as_single_force(Load("", 2, zero + 0j, at, zero + 2.0))[0])


def test_the_drawn_point_of_percussion_lies_on_the_one_force() -> None:
    linkage = MACHINES["twin"]
    linkage = replace(linkage, points=tuple(replace(p, local=0.25) if p.name == "S2" else p for p in linkage.points))
    motion = solve_motion(linkage, TURN + 0.01, OMEGA)
    body = next(body for body in linkage.inertias if body.link == 2)
    load = next(load for load in inertia_loads(linkage, motion) if load.link == 2)
    a, s = motion.points["A"], motion.points["S2"]
    distance = body.moment / (body.mass * 0.25)
    _, q = percussion_points(a.p, s.p, a.a, s.a, distance)
    moment = cross(q - s.p, load.force)
    assert moment == pytest.approx(load.couple, abs=1e-9 * np.abs(load.couple).max())


def test_mobility_counts_links_and_joints(linkage: Linkage) -> None:
    found = mobility(linkage)
    assert found.W == 1
    assert (found.n, found.lower_pairs) == (1 + 2 * len(linkage.dyads), 1 + 3 * len(linkage.dyads))
    assert found.mechanism_class == 2
    assert {joint.group for joint in found.joints} == {(), *(dyad.links for dyad in linkage.dyads)}


def test_mean_over_a_function_with_a_jump() -> None:
    # ∫₀² f with f = e^x below 1 and 5 above: (e − 1 + 5)/2.
    mean = mean_over(lambda x: np.where(x < 1, np.exp(x), 5.0), [1.0], 0.0, 2.0)
    assert mean == pytest.approx((math.e + 4) / 2, rel=1e-13)


def test_lines_that_do_not_meet_give_no_point_of_percussion() -> None:
    # At a dead centre of a central slider-crank a_A and a_SA lie along one line.
    linkage = MACHINES["twin"]
    motion = solve_motion(linkage, math.pi / 2 + np.array([0.0, math.pi]), OMEGA)
    a, b = motion.points["A"], motion.points["B"]
    s = a.p + 0.35 * (b.p - a.p)
    a_s = a.a + 0.35 * (b.a - a.a)
    assert np.isnan(percussion_points(a.p, s, a.a, a_s, 0.1)[1]).all()
