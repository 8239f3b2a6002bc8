"""True motion of a machine: worked figures, an integration in time of all links, conservation of energy, limits."""

from __future__ import annotations

import math
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
import yaml
from time_integration import integrate

from reportgen import catalogue
from reportgen.assignment.common import Positions
from reportgen.base.records import replace
from reportgen.flywheel.regulation import flywheel
from reportgen.formula.calculation import Calculation
from reportgen.machine import Crank, Dyad, Guide, Inertia, Linkage, LinkPoint
from reportgen.machine.analysis import Machine, analyse, breaks
from reportgen.machine.load_laws import FULL_TURN, AngleLaw, ConstantLaw, Law, Stroke, TableLaw, by_stroke, opposing
from reportgen.machine.loads import Applied, Torque, course, crank_motion, fixed
from reportgen.machine.reduction import reduced
from reportgen.machine.spring_geometry import Anchor
from reportgen.motion.drives import ConstantDrive, Drive, Geared, KlossDrive, LinearDrive, Motor, TableDrive
from reportgen.motion.energy_equation import ReducedMachine
from reportgen.motion.motors import DriveDemand, judged
from reportgen.motion.starting import start, stop
from reportgen.motion.steady_running import MotionRun, NoMotionError, mean_torque, steady
from reportgen.motion.true_motion import at_positions, at_true_speeds
from reportgen.springs.spring_laws import SpringLaw
from tests.lanes import matrix, proof

ASSIGNMENTS = Path(__file__).parents[2] / "assignments"
MOTOR = LinearDrive(600.0, 20.0)
KLOSS = KlossDrive(150.0, 0.2, 30.0)
EIGHTHS = np.arange(8) * math.pi / 4
OUTWARD = Stroke(3, 2, "B", "A", 0.5 + 0j, 0.3 + 0j, 0.0, math.pi, 0.0)
WORKING = TableLaw(OUTWARD, by_stroke((0.0, 1.0), (1500.0, 1500.0), (-200.0, -200.0)), turns=1)
SLIDER_CRANK = Linkage(
    ground={"O": 0j},
    driver=Crank("O", "A", 0.1),
    groups=(Dyad("RRP", (2, 3), "A", "B", Guide(0j, 0.0), (0.4, 0.0)),),
    points=(LinkPoint("S2", 2, 0.14),),
    inertias=(Inertia(1, "O", 0.0, 0.8), Inertia(2, "S2", 4.0, 0.08), Inertia(3, "B", 6.0)),
    gravity=0j,
)


def with_load(law: Law, linkage: Linkage = SLIDER_CRANK, torques: tuple[Torque, ...] = ()) -> Machine:
    applied = (Applied("P3", 3, "B", fixed(1 + 0j), law),)
    return Machine("", linkage, 0.0, 1, 27.0, 12, 1, Calculation(), (), applied=applied, torques=torques)


R3 = with_load(WORKING)
MEAN = 340 / (2 * math.pi)
"""The mean resistance (N·m): 1300 N over the stroke of 0.2 m both ways, 300 J and 40 J."""


def at(run: MotionRun, degrees: float) -> int:
    return run.place(math.radians(degrees))


# --- worked figures: half a unit of the last digit ------------------------------------------------------


@pytest.mark.parametrize(
    ("degrees", "inertia", "slope", "torque"),
    [
        (0, 0.8219, 0, 0),
        (30, 0.8503312, 0.0931339, -91.366342),
        (60, 0.8955465, 0.0578988, -146.536289),
        (90, 0.9, -0.0382134, -150),
        (120, 0.8671223, -0.0735024, -113.271332),
        (150, 0.8341831, -0.0460743, -58.633658),
        (270, 0.9, 0.0382134, -20),
    ],
)
def test_what_the_machine_comes_to_at_its_crank(degrees: float, inertia: float, slope: float, torque: float) -> None:
    (J,), (J1,), (M,) = reduced(R3, np.radians([float(degrees)]))
    assert pytest.approx((inertia, slope), abs=5e-8) == (J, J1)
    assert pytest.approx(torque, abs=5e-7) == M


def test_steady_motion_with_a_motor() -> None:
    motion = steady(ReducedMachine(R3), MOTOR, 27.0, EIGHTHS)
    places = [motion.run.place(angle) for angle in EIGHTHS]
    speeds = (29.795793, 27.402106, 24.820780, 24.956560, 26.824132, 27.883303, 27.899318, 28.782758)
    assert motion.run.speed[places] == pytest.approx(speeds, abs=5e-7)
    rates = (4.96915, -122.98594, -38.49389, 39.96823, 77.28113, 6.68756, 7.93501, 52.23703)
    assert motion.run.acceleration[places] == pytest.approx(rates, abs=5e-6)
    assert (motion.fastest.speed, motion.slowest.speed) == pytest.approx((29.796944, 24.568578), abs=5e-7)
    assert math.degrees(motion.fastest.angle) == pytest.approx(0.793, abs=5e-4)
    assert math.degrees(motion.slowest.angle) == pytest.approx(109.085, abs=5e-4)
    assert (motion.unevenness, motion.period) == pytest.approx((0.192341, 0.231031), abs=5e-7)
    assert motion.work == pytest.approx(340, rel=1e-9)


def test_a_start_from_rest() -> None:
    body = ReducedMachine(R3)
    run = start(body, MOTOR, steady(body, MOTOR, 27.0), 0.0, EIGHTHS).run
    figures = {
        45: (0.0594609, 19.813201),
        90: (0.0975481, 21.258243),
        180: (0.1648987, 26.077490),
        270: (0.2223977, 27.729447),
        360: (0.2771187, 29.746351),
    }
    for degrees, (time, speed) in figures.items():
        assert run.time[at(run, degrees)] == pytest.approx(time, abs=5.01e-8)
        assert run.speed[at(run, degrees)] == pytest.approx(speed, abs=5e-7)


def test_a_constant_drive_keeps_the_mean_that_is_asked_for() -> None:
    motion = steady(ReducedMachine(R3), ConstantDrive(MEAN), 27.0)
    assert motion.mean == pytest.approx(27, rel=1e-12)
    assert motion.run.speed[0] == pytest.approx(30.219169, abs=5e-6)
    # Their source looked at every quarter degree.
    assert (motion.fastest.speed, motion.slowest.speed) == pytest.approx((30.418112, 23.581888), abs=2e-5)
    assert motion.unevenness == pytest.approx(0.253193, abs=2e-6)


def test_a_stop_under_a_brake() -> None:
    body = ReducedMachine(R3)
    run = stop(body, ConstantDrive(-80.0), float(steady(body, MOTOR, 27.0).run.speed[0]))
    assert math.degrees(run.angle[-1]) == pytest.approx(108.13068, abs=5e-6)
    assert run.time[-1] == pytest.approx(0.123419, abs=5e-7)
    assert run.speed[-1] == 0


def test_the_flywheel_and_the_unevenness_that_it_leaves() -> None:
    wheel = flywheel(R3, 1 / 20).moment
    assert wheel == pytest.approx(3.38350, abs=5e-5)
    body = ReducedMachine(R3, wheel)
    assert steady(body, ConstantDrive(MEAN), 27.0).unevenness == pytest.approx(0.05, abs=1e-5 * 0.05)
    motion = steady(body, MOTOR, 27.0)
    assert (motion.fastest.speed, motion.slowest.speed) == pytest.approx((28.027405, 26.707506), abs=1e-5)
    assert motion.unevenness == pytest.approx(0.048229, abs=5e-7)


def test_an_induction_motor_starts_after_swinging_back() -> None:
    """Its start takes 1.5 s to 90°: at 44° and again at 64° the resistance pushes the crank back."""
    body = ReducedMachine(R3)
    motion = steady(body, KLOSS, 27.0)
    figures = (motion.run.speed[0], motion.fastest.speed, motion.slowest.speed, motion.unevenness)
    assert figures == pytest.approx((30.249585, 30.296880, 26.648715, 0.128128), abs=2e-5)
    started = start(body, KLOSS, motion, 0.0, EIGHTHS)
    assert np.degrees(started.turns_back) == pytest.approx((43.6, 64.2), abs=0.1)
    run = started.run
    assert np.degrees(run.angle.min()) == pytest.approx(-84.2, abs=0.1)
    for degrees, time, speed in ((90, 1.517292, 15.58127), (360, 1.737817, 30.16328)):
        assert run.time[at(run, degrees)] == pytest.approx(time, abs=5e-7)
        assert run.speed[at(run, degrees)] == pytest.approx(speed, abs=5e-6)


# --- laws ----------------------------------------------------------------------------------------------


def test_the_slope_of_the_inertia_is_that_of_its_values() -> None:
    angle, h = np.linspace(0.0, FULL_TURN, 50), 1e-5
    ahead, behind = reduced(R3, angle + h)[0], reduced(R3, angle - h)[0]
    # The error of the difference is h² and rounding over h.
    assert reduced(R3, angle)[1] == pytest.approx((ahead - behind) / (2 * h), abs=1e-8)


@pytest.mark.parametrize("drive", [MOTOR, ConstantDrive(MEAN), KLOSS])
def test_work_becomes_energy(drive: Drive) -> None:
    """½Jω² grows by ∫(M_r + M_d) dφ, by Simpson's rule, which has no part in the solution."""
    run = steady(ReducedMachine(R3), drive, 27.0, EIGHTHS).run
    energy = run.inertia * run.speed**2 / 2
    low, high = at(run, 45), at(run, 135)
    work = 0.0
    for first, last in pairwise(run.at[(run.at >= low) & (run.at <= high)]):
        part = slice(first, last + 1)
        speed = np.polynomial.Polynomial.fit(run.angle[part], run.speed[part], last - first)
        angle = np.linspace(run.angle[first], run.angle[last], 17)
        acting = reduced(R3, angle)[2] + drive.torque(speed(angle))
        shares = np.array([1.0, *(4.0, 2.0) * 7, 4.0, 1.0]) / 48
        work += float(acting @ shares) * (angle[-1] - angle[0])
    assert energy[high] - energy[low] == pytest.approx(work, abs=1e-9 * float(energy.max()))
    assert energy[-1] == pytest.approx(energy[0], rel=1e-9)


def test_a_cycle_after_the_steady_one_is_the_same() -> None:
    body = ReducedMachine(R3, 2.0)
    motion = steady(body, MOTOR, 27.0)
    started = start(body, MOTOR, motion)
    left = [abs(started.run.speed[end] - motion.run.speed[0]) for end in started.ends]
    # Each cycle leaves that share of the deviation of the energy which Newton's method has found.
    assert len(left) > 2
    assert left[-1] / left[-2] == pytest.approx(motion.settles, rel=0.02)


def test_a_gear_makes_the_torque_greater_and_the_speed_less() -> None:
    geared = Geared(KlossDrive(7.5, 0.2, 600.0), 1 / 20)
    speeds = np.linspace(0.0, 40.0, 9)
    assert geared.torque(speeds) == pytest.approx(KLOSS.torque(speeds))
    assert geared.slope(speeds) == pytest.approx(KLOSS.slope(speeds))


@pytest.mark.parametrize("drive", [MOTOR, KLOSS, Geared(KLOSS, 0.5), TableDrive((0.0, 10.0, 30.0), (60.0, 80.0, 0.0))])
def test_slopes_of_characteristics(drive: Drive) -> None:
    speed, h = np.array([1.0, 7.0, 14.0, 28.0]), 1e-6
    by_differences = (drive.torque(speed + h) - drive.torque(speed - h)) / (2 * h)
    assert drive.slope(speed) == pytest.approx(by_differences, rel=1e-7, abs=1e-7)


# --- the witness -----------------------------------------------------------------------------------------


def test_each_link_by_itself_in_time() -> None:
    """ω and t to 1e-8 against all links with multipliers, from the steady speed over a sixth of a turn."""
    stops = np.radians([20.0, 40.0, 60.0, 80.0])
    run = steady(ReducedMachine(R3, 0.3), MOTOR, 27.0, stops).run
    places = [run.place(stop) for stop in stops]
    found = integrate(R3, 0.3, lambda speed: float(MOTOR.torque(np.array([speed]))[0]), stops, run.speed[places[0]], 1)
    for (time, speed), place in zip(found, places, strict=True):
        assert run.speed[place] == pytest.approx(speed, rel=1e-8)
        assert run.time[place] - run.time[places[0]] == pytest.approx(time, abs=1e-8 * run.time[-1])


# --- what does not come about -------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("drive", "code"),
    [
        (ConstantDrive(60.0), "runs-away"),
        (ConstantDrive(50.0), "runs-down"),
        (KlossDrive(5.0, 0.2, 30.0), "runs-down"),
        (LinearDrive(30.0, 1.0), "runs-down"),
    ],
)
def test_drives_that_do_not_fit_their_loads(drive: Drive, code: str) -> None:
    with pytest.raises(NoMotionError) as told:
        steady(ReducedMachine(R3), drive, 27.0)
    assert told.value.code == code


def test_a_motor_that_is_strong_enough_in_the_mean_alone_stalls() -> None:
    """57 N·m at most exceed the mean of 54 N·m, but not 150 N·m for a quarter of a turn without a flywheel."""
    weak = KlossDrive(57.0, 0.2, 30.0)
    with pytest.raises(NoMotionError) as told:
        steady(ReducedMachine(R3), weak, 27.0)
    assert told.value.code == "stalls"
    ((missing,),) = (reduced(R3, np.array([told.value.angle]))[2:],)
    assert told.value.missing == pytest.approx(-missing[0] - weak.torque(np.zeros(1))[0], rel=1e-6)


@proof
def test_a_motor_starts_only_where_its_torque_suffices() -> None:
    """140 N·m get over 150 N·m at 90° with the energy of a longer way: from 101° on, and until before 55°."""
    motor = LinearDrive(140.0, 4.0)
    body = ReducedMachine(R3)
    motion = steady(body, motor, 27.0)
    with pytest.raises(NoMotionError) as told:
        start(body, motor, motion, math.radians(90.0))
    assert told.value.code == "does-not-start"
    assert told.value.missing == pytest.approx(10)
    (_, until), (since, _) = told.value.ranges
    assert until < math.radians(54.0)
    for angle, moves in ((since, 1), (since - math.radians(1), -1)):
        assert np.sign(reduced(R3, np.array([angle]))[2] + 140) == moves
    assert start(body, motor, motion, until).time > 0
    with pytest.raises(NoMotionError) as told:
        start(body, motor, motion, until + math.radians(1.1))
    assert told.value.code == "start-stalls"


@pytest.mark.parametrize("inertia", [0.0, 50.0])
def test_where_a_start_stalls_does_not_depend_on_the_inertia(inertia: float) -> None:
    """A torque that is the same at every speed does the same work to every angle: more inertia is no remedy."""
    body = ReducedMachine(R3, inertia)
    with pytest.raises(NoMotionError) as told:
        start(body, ConstantDrive(100.0), steady(body, ConstantDrive(MEAN), 27.0))
    assert told.value.code == "start-stalls"
    # ∫(100 + M_r) dφ vanishes there, by Simpson's rule.
    angle = np.linspace(0.0, told.value.angle, 2001)
    acting = reduced(R3, angle)[2] + 100.0
    work = (acting[0] + 4 * acting[1:-1:2].sum() + 2 * acting[2:-1:2].sum() + acting[-1]) * angle[1] / 3
    assert work == pytest.approx(0.0, abs=1e-8 * 100.0)


@proof
def test_a_motor_that_starts_nowhere() -> None:
    """5 N·m are less than the slider asks for at every angle from which it would have to get over 150 N·m."""
    motor = KlossDrive(200.0, 0.001, 30.0)
    body = ReducedMachine(R3)
    with pytest.raises(NoMotionError) as told:
        start(body, motor, steady(ReducedMachine(R3, 20.0), KLOSS, 27.0), math.radians(90.0))
    assert told.value.code == "starts-nowhere"


def test_a_resistance_holds_what_it_has_stopped() -> None:
    """A load that only resists does not push the crank back: where it is too great, the machine stalls."""
    machine = with_load(ConstantLaw(0.0))
    resisting = opposing(1500.0, lambda angle: -np.sin(angle))
    machine = replace(machine, applied=(Applied("P3", 3, "B", fixed(1 + 0j), resisting),))
    body = ReducedMachine(machine)
    motion = steady(ReducedMachine(machine, 50.0), KLOSS, 27.0)
    with pytest.raises(NoMotionError) as told:
        start(body, KLOSS, motion)
    assert told.value.code == "start-stalls"


# --- many machines --------------------------------------------------------------------------------------


@pytest.mark.parametrize("seed", matrix(range(100), (0, 3)))
def test_machines_made_at_random(seed: int) -> None:
    prove(*made_at_random(seed), math.radians(10.0), math.radians(40.0))


@pytest.mark.parametrize("kind", ["shaper", "engine-single"])
@pytest.mark.parametrize("seed", matrix(range(50), (0,)))
def test_cutting_forces_and_gases(kind: str, seed: int, tmp_path: Path) -> None:
    """A shaper whose tool goes into the work or out of it, and an engine in its four strokes, of any size."""
    rng = np.random.default_rng(seed)
    machine = of_any_size(kind, rng, tmp_path / "machine.yaml")
    (mean, _), swing = mean_and_swing(machine)
    added = rng.uniform(3.0, 10.0) * swing / machine.speed**2
    slope = rng.uniform(0.5, 3.0) * abs(mean) / machine.speed
    jumps = [angle for angle in breaks(machine) if 0.5 < angle < machine.turns * FULL_TURN - 0.5]
    jump = float(rng.choice(jumps))
    prove(machine, added, LinearDrive(slope * machine.speed - mean, slope), jump - 0.2, jump + 0.15)


def prove(machine: Machine, added: float, drive: Drive, low: float, high: float) -> None:
    """ω and t to 1e-8 between two cycle angles; energy closed over the cycle to 1e-9."""
    stops = np.array([low, *(angle for angle in breaks(machine) if low < angle < high), high])
    motion = steady(ReducedMachine(machine, added), drive, machine.speed, stops)
    run = motion.run
    places = [run.place(angle) for angle in stops]

    def torque(speed: float) -> float:
        return float(drive.torque(np.array([speed]))[0])

    found = integrate(machine, added, torque, stops, float(run.speed[places[0]]), 1)
    for (time, speed), place in zip(found, places, strict=True):
        assert run.speed[place] == pytest.approx(speed, rel=1e-8)
        assert run.time[place] - run.time[places[0]] == pytest.approx(time, abs=1e-8 * motion.period)
    energy = run.inertia * run.speed**2
    assert energy[-1] == pytest.approx(energy[0], rel=1e-9)


def of_any_size(kind: str, rng: np.random.Generator, path: Path) -> Machine:
    """The machine of a sample with lengths in another scale, other forces and weights, each by a factor of its own."""
    sample = {"shaper": "shaper-02.yaml", "engine-single": "engine-single-I.yaml"}[kind]
    given = yaml.safe_load((ASSIGNMENTS / sample).read_text(encoding="utf-8"))
    given["parameters"].pop("flywheel", None)
    given["positions"]["direction"] = str(rng.choice(["clockwise", "anticlockwise"]))
    scale = rng.uniform(0.5, 2.0)

    def other(value: str, by: float) -> str:
        size, unit = value.split(maxsplit=1)
        return f"{float(size) * by!r} {unit}"

    parameters = given["parameters"]
    for key, value in parameters.items():
        if isinstance(value, str) and key != "g":
            length = value.endswith(" mm")
            parameters[key] = other(value, scale if length else scale**4 * rng.uniform(0.7, 1.4))
    if kind == "shaper":
        parameters["n"] = f"{rng.uniform(20.0, 60.0)!r} rpm"
        parameters["cutting"] = {"F": f"{rng.uniform(300.0, 2000.0)!r} N", "free": float(rng.uniform(0.02, 0.12))}
    else:
        parameters["n"] = f"{rng.uniform(400.0, 900.0)!r} rpm"
        given["indicator"]["height"] = [
            float(height * rng.uniform(0.8, 1.2)) for height in given["indicator"]["height"]
        ]
    path.write_text(yaml.safe_dump(given), encoding="utf-8")
    assignment = catalogue.load(path)
    return catalogue.module(kind).machine(assignment)


def mean_and_swing(machine: Machine) -> tuple[tuple[float, float], float]:
    """The mean torque (N·m) and what it comes from, and how far the work of the rest swings (J), at 400 angles."""
    body = ReducedMachine(machine)
    mean = mean_torque(body, body.along(body.parted(0.0)))
    angle = np.linspace(0.0, machine.turns * FULL_TURN, 400)
    return mean, float(np.ptp(np.cumsum(reduced(machine, angle)[2] - mean[0]) * (angle[1] - angle[0])))


def made_at_random(seed: int) -> tuple[Machine, float, Drive]:
    """A crank with a rod and a slider or a rocker, weights, a force that jumps, a spring, a torque; its motor.

    What a slider has besides resists its motion, or is a gas in two turns.
    """
    rng = np.random.default_rng(seed)
    r, l = rng.uniform(0.05, 0.12), rng.uniform(0.3, 0.5)  # noqa: E741 - the length's own letter
    slides, turn, axis = seed % 2 == 1, 1 if seed % 4 < 2 else -1, rng.uniform(-0.3, 0.3)
    if slides:
        dyad = Dyad("RRP", (2, 3), "A", "B", Guide(1j * rng.uniform(-0.05, 0.05), axis), (l, 0.0))
    else:
        dyad = Dyad("RRR", (2, 3), "A", "B", "D", (l, rng.uniform(0.25, 0.3)), 1)
    linkage = Linkage(
        ground={"O": 0j, "D": 0.4 + 0.05j},
        driver=Crank("O", "A", r),
        groups=(dyad,),
        points=(LinkPoint("S2", 2, complex(l / 3, rng.uniform(-0.05, 0.05))),),
        inertias=(
            Inertia(1, "O", 0.0, rng.uniform(0.02, 0.2)),
            Inertia(2, "S2", rng.uniform(1.0, 4.0), rng.uniform(0.01, 0.1)),
            Inertia(3, "B", rng.uniform(1.0, 6.0), 0.0),
        ),
    )
    motion_at = crank_motion(linkage, Positions(direction="anticlockwise" if turn > 0 else "clockwise"), 0.3)
    sizes = rng.uniform(-300.0, 300.0, 6)
    jump = math.radians(25.0)
    knots = (0.0, jump, float(np.nextafter(jump, 9.0)), 2.0, 4.0, FULL_TURN)
    table = AngleLaw(knots, (*map(float, sizes[:5]), float(sizes[0])))
    spring = SpringLaw(1, (Anchor("S2"), Anchor(place=0.2 + 0.4j)), rng.uniform(200.0, 900.0), 0.2)
    applied = [
        Applied("P3", 3, "B", fixed(np.exp(1j * rng.uniform(0, 6))), table),
        Applied("P2", 2, "S2", spring.towards(0), spring),
    ]
    if slides:
        along = np.exp(1j * axis)

        def rate(angle: np.ndarray) -> np.ndarray:
            return np.asarray((np.conj(along) * motion_at(angle).points["B"].v).real)

        if seed % 3:
            law: Law = opposing(rng.uniform(50.0, 200.0), rate)
        else:
            stroke = course(linkage, 3, motion_at)
            law = TableLaw(stroke, by_stroke((0.0, 0.3, 1.0), (900.0, 300.0, 0.0), (900.0, 100.0, 50.0)), turns=1)
        applied.append(Applied("P3a", 3, "B", fixed(along), law))
    resisting = Torque("M1", 1, ConstantLaw(-turn * rng.uniform(20.0, 40.0)))
    machine = Machine(
        "", linkage, 0.3, turn, 25.0, 12, 1, Calculation(), (), applied=tuple(applied), torques=(resisting,)
    )
    added = rng.uniform(0.5, 2.0)
    body = ReducedMachine(machine, added)
    mean, _ = mean_torque(body, body.along(body.parted(0.0)))
    slope = rng.uniform(1.0, 5.0)
    return machine, added, LinearDrive(-mean + slope * 25.0, slope)


# --- forces and motors ----------------------------------------------------------------------------------


def test_the_crank_is_balanced_at_its_true_speed() -> None:
    """Equilibrium of all links at ω and ε asks of the crank what the drive gives beside the flywheel's inertia."""
    motion = steady(ReducedMachine(R3, 2.0), MOTOR, 27.0, R3.cycle_angles)
    true = at_true_speeds(analyse(R3), motion)
    places = at_positions(R3, motion)
    given_ = motion.run.drive[places] - 2.0 * motion.run.acceleration[places]
    assert true.torque == pytest.approx(given_, abs=1e-9 * float(np.abs(given_).max()))


def test_the_least_motor_that_is_strong_enough() -> None:
    motion = steady(ReducedMachine(R3, 3.4), MOTOR, 27.0)
    demand = DriveDemand.of(motion, FULL_TURN)
    assert demand.mean == pytest.approx(MEAN)
    # The variance of the torque comes on top of the mean, here over nearly equal steps of time.
    assert demand.mean < demand.effective < demand.most
    assert demand.resistance == pytest.approx(154.63, abs=0.01)
    weak = Motor("weak", 27.0 * 50, 27.0, 500.0, 500.0)
    cold = Motor("cold", 27.0 * 80, 27.0, 100.0, 500.0)
    short = Motor("short", 27.0 * 90, 27.0, 500.0, demand.most * 0.99)
    good = Motor("good", 27.0 * 100, 27.0, 500.0, 500.0)
    checks = judged([good, short, weak, cold], demand, 1.0)
    assert [each.motor.name for each in checks] == ["weak", "cold", "short", "good"]
    assert [each.fits for each in checks] == [False, False, False, True]
    assert not checks[0].endures
    assert not checks[1].starts
    assert not checks[2].holds
    # A gear that makes the crank slower makes torques greater.
    assert judged([weak], demand, 0.5)[0].rated == pytest.approx(100)
