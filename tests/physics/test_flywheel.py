"""The flywheel against the conservation of energy, and against cases that can be done by hand."""

from __future__ import annotations

import cmath
import math
import re
from pathlib import Path

import numpy as np
import pytest

from reportgen import api, catalogue
from reportgen.base.kinds import program_kinds
from reportgen.base.records import replace
from reportgen.cases import open_case
from reportgen.derivation import write_ledger
from reportgen.drawing import Polyline
from reportgen.flywheel.regulation import flywheel, regulate, regulated_in
from reportgen.flywheel.views import wittenbauer
from reportgen.formula.calculation import Calculation
from reportgen.machine.analysis import Machine, analyse, motion_at
from reportgen.machine.load_laws import FULL_TURN
from reportgen.machine.quadrature import accumulated
from reportgen.machine.reduction import reduced_inertia
from reportgen.machine.regulated_cycle import RegulatedCycle
from reportgen.report.context import ReportContext
from tests.lanes import matrix

ASSIGNMENTS = Path(__file__).parents[2] / "assignments"


FILES = (
    *("engine-single-VII", "slider-crank-01", "engine-twin-05", "engine-v-01", "four-bar-01", "slotted-lever-02"),
    *("shaper-02", "lever-six-bar-01", "toggle-press-01", "scotch-yoke-01", "linkage-8"),
)
"""An assignment of every kind with a crank and loads."""
TELLING = ("engine-twin-05", "four-bar-01", "shaper-02", "linkage-8")


@pytest.fixture(scope="module", params=matrix(FILES, TELLING))
def machine(request: pytest.FixtureRequest) -> Machine:
    return api.analyse(api.load(ASSIGNMENTS / f"{request.param}.yaml")).machine


def test_every_machine_has_its_case() -> None:
    loaded = {api.load(ASSIGNMENTS / f"{name}.yaml").kind for name in FILES}
    assert loaded == {kind for kind in program_kinds() if hasattr(catalogue.module(kind), "machine")}


def test_speed_stays_within_the_unevenness_and_meets_it(machine: Machine) -> None:
    found = flywheel(machine, 1 / 50)
    assert (found.speed.max() - found.speed.min()) / machine.speed == pytest.approx(1 / 50, rel=1e-9)
    assert (found.speed.max() + found.speed.min()) / 2 == pytest.approx(machine.speed, rel=1e-9)


def acting(machine: Machine, angle: np.ndarray, constant: float) -> np.ndarray:
    """Power of weights, loads and the constant torque over ω₁ (N·m), point by point."""
    there = motion_at(machine, angle)
    total = np.full(angle.shape, constant)
    for body in machine.linkage.inertias:
        fall = there.points[body.centre].v * np.conj(machine.linkage.gravity)
        total += body.mass * fall.real / machine.speed
    for force in machine.applied:
        along = (np.conj(force.direction(there)) * there.points[force.point].v).real
        total += force.law.value(angle, there) * along / machine.speed
    for torque in machine.torques:
        total += torque.law.value(angle, there) * there.links[torque.link].omega / machine.speed
    return total


def kinetic_over_square(machine: Machine, angle: np.ndarray) -> np.ndarray:
    """Twice the links' kinetic energy over ω₁²."""
    there = motion_at(machine, angle)
    total = np.zeros(angle.shape)
    for body in machine.linkage.inertias:
        total += body.mass * np.abs(there.points[body.centre].v / machine.speed) ** 2
        total += body.moment * (there.links[body.link].omega / machine.speed) ** 2
    return total


def test_the_equation_of_motion_gives_the_unevenness_asked_for(machine: Machine) -> None:
    """(J_d + J) ω dω/dφ + ½ω² dJ/dφ = M, by Runge–Kutta from the found speed at the start, swings by δ."""
    delta = 1 / 40
    found = flywheel(machine, delta)
    steps = 2880 * machine.turns
    angle = np.linspace(0.0, machine.turns * FULL_TURN, 2 * steps + 1)
    step, small = angle[2], 1e-4
    moment = found.moment + kinetic_over_square(machine, angle)
    ahead, behind = (kinetic_over_square(machine, angle + way) for way in (small, -small))
    slope, torque = (ahead - behind) / (2 * small), acting(machine, angle, found.constant)

    def rate(node: int, speed: float) -> float:
        return float((torque[node] - speed**2 * slope[node] / 2) / (moment[node] * speed))

    speeds = [float(found.speed[0])]
    for node in range(0, 2 * steps, 2):
        now = speeds[-1]
        one = rate(node, now)
        two = rate(node + 1, now + step / 2 * one)
        three = rate(node + 1, now + step / 2 * two)
        four = rate(node + 2, now + step * three)
        speeds.append(now + step / 6 * (one + 2 * two + 2 * three + four))
    uneven = (max(speeds) - min(speeds)) / machine.speed
    # A jump of the load within a step of an eighth of a degree is misjudged by up to half a step's work.
    assert uneven == pytest.approx(delta, rel=2e-3)
    assert speeds[-1] == pytest.approx(speeds[0], rel=2e-3 * delta)


def test_energy_is_conserved(machine: Machine) -> None:
    """What links and flywheel gain between two angles is what the forces do there, each taken by itself."""
    found = flywheel(machine, 1 / 40)
    pick = np.linspace(0, found.angle.size - 1, 40).astype(int)
    motion = motion_at(machine, found.angle[pick])
    share = found.speed[pick] / machine.speed
    kinetic = found.moment * found.speed[pick] ** 2 / 2
    for body in machine.linkage.inertias:
        kinetic = kinetic + body.mass * np.abs(motion.points[body.centre].v * share) ** 2 / 2
        kinetic = kinetic + body.moment * (motion.links[body.link].omega * share) ** 2 / 2

    work = accumulated(lambda angle: acting(machine, angle, found.constant), found.angle)[pick]
    gained = kinetic - kinetic[0]
    assert gained == pytest.approx(work, rel=0, abs=1e-9 * kinetic.max())


def test_the_cycle_closes(machine: Machine) -> None:
    found = flywheel(machine, 1 / 50)
    assert found.work[-1] == pytest.approx(0, abs=1e-9 * np.abs(found.work).max())
    assert found.speed[-1] == pytest.approx(found.speed[0], rel=1e-9)
    # The other side's constant torque is the mean balancing torque: inertia gives back what it takes.
    assert found.constant == pytest.approx(machine.turn * api_mean(machine), abs=1e-9 * np.abs(found.torque).max())


def test_a_constant_resistance_of_a_swinging_lever(tmp_path: Path) -> None:
    """Against M the lever goes through 4θ in a turn, sin θ = AB/AC: M_c = 4Mθ/2π; without mass J_r is left out."""
    text = (ASSIGNMENTS / "slotted-lever-02.yaml").read_text(encoding="utf-8")
    massless = "\n".join(line for line in text.splitlines() if not re.match(r"  (G2|G3|s3|J3):", line))
    file = tmp_path / "massless.yaml"
    file.write_text(massless, encoding="utf-8")
    analysis = api.analyse(api.load(file))
    written, regulated = write_ledger(analysis), regulated_in(analysis)
    theta, omega = math.asin(60 / 140), 150 * math.pi / 30
    assert regulated.constant == pytest.approx(24 * 4 * theta / (2 * math.pi), rel=1e-9)
    assert "J.r" not in written.ledger
    # Excess work by hand: M_c φ − 24·(the lever's way), φ from where the crank points away from the pivot.
    # The lever turns back at φ = 90° ∓ θ before and after; its way is 2θ on each side of the far end.
    phi = np.linspace(0, 2 * math.pi, 200001)
    lever = np.unwrap(np.angle(140j + 60 * np.exp(1j * (phi + math.pi / 2))))
    way = np.concatenate(([0.0], np.cumsum(np.abs(np.diff(lever)))))
    excess = regulated.constant * phi - 24 * way
    expected = (excess.max() - excess.min()) / (omega**2 / 25)
    assert regulated.moment == pytest.approx(expected, rel=1e-6)


def test_weights_alone_do_no_work(tmp_path: Path) -> None:
    text = (ASSIGNMENTS / "slotted-lever-02.yaml").read_text(encoding="utf-8")
    file = tmp_path / "idle.yaml"
    file.write_text(text.replace("  torque: {M: 24 N m}\n", ""), encoding="utf-8")
    assert write_ledger(api.analyse(api.load(file))).ledger.number("M.c").value == 0


def test_links_that_are_even_enough_need_no_flywheel() -> None:
    """J_r constant and no work: J_d + J_r = 0, no speed is told."""
    angle = np.linspace(0, FULL_TURN, 721)
    still = np.zeros(angle.shape)
    found = regulate(angle, still, still, np.full(angle.shape, 0.3), 20.0, 0.02)
    assert found.moment == pytest.approx(-0.3)
    assert np.isnan(found.speed).all()


def api_mean(machine: Machine) -> float:
    from reportgen.machine.analysis import summarise

    return summarise(machine).mean_torque


def with_unevenness(machine: Machine, delta: float) -> Machine:
    """The machine of an assignment that asks for the flywheel of δ."""
    sheet = Calculation()
    for family in machine.calculation.families.values():
        if family.id != "unevenness":
            sheet.enter(family)
    sheet.give("unevenness", delta, "δ", "ratio")
    return replace(machine, topics={**machine.topics, "flywheel": delta}, calculation=sheet)


def test_the_report_prints_what_was_found(machine: Machine) -> None:
    """The printed definitions of J_r and J_d, evaluated, are the arrays they stand for."""
    analysis = analyse(with_unevenness(machine, 1 / 50))
    written = write_ledger(analysis)
    ledger, regulated = written.ledger, regulated_in(analysis)
    expected = reduced_inertia(analysis.machine, analysis.motion)
    if expected.any():
        assert ledger["J.r"].values == pytest.approx(expected, rel=1e-12)
    else:
        assert "J.r" not in ledger
    assert ledger["J.d"].values == pytest.approx([regulated.moment], rel=1e-12)
    at = np.searchsorted(regulated.angle, analysis.cycle_angle - 1e-9)
    assert regulated.angle[at] == pytest.approx(analysis.cycle_angle, abs=1e-9)


def test_a_sine_torque_on_constant_inertia() -> None:
    """A = M₀(1 − cos φ), from 0 to 2M₀: with J_r constant, J_d + J_r = 2 M₀/(δ ω²) but for δ²."""
    angle = np.linspace(0, FULL_TURN, 721)
    inertia = np.full(angle.shape, 0.3)
    found = regulate(angle, 40 * np.sin(angle), 40 * (1 - np.cos(angle)), inertia, 20.0, 0.02)
    # ω_max² − ω_min² = 2δω², so ½(J_d + J_r)·2δω² = 2M₀ holds exactly.
    assert found.moment + 0.3 == pytest.approx(2 * 40 / (0.02 * 20**2), rel=1e-12)
    assert math.degrees(found.angle[found.high]) == pytest.approx(180)


def test_wittenbauers_lines_touch_the_curve(machine: Machine) -> None:
    found: RegulatedCycle = flywheel(machine, 1 / 30)
    for bound, height, sign in ((found.fastest, found.upper, 1), (found.slowest, found.lower, -1)):
        line = height + bound**2 / 2 * found.inertia
        assert (sign * (line - found.work)).min() == pytest.approx(0, abs=1e-9 * np.abs(found.work).max())


@pytest.mark.parametrize("delta", [1 / 20, 1 / 100])
def test_mercalovs_way_differs_by_no_more_than_the_inertia_of_the_links(machine: Machine, delta: float) -> None:
    """J_I = ΔT_I/(δ ω²) with the links' energy at the mean speed, off by the share δ + δ²/4 of it at most, either way.

    So J_d ≤ J_I ≤ J_d + (1 + δ/4) max J_r: the difference is of the order of δ beside ΔT_I/(δ ω²).
    """
    ledger, found = write_ledger(analyse(with_unevenness(machine, delta))).ledger, flywheel(machine, delta)
    links = kinetic_over_square(machine, found.angle)
    if "J.I" not in ledger:
        assert not links.any() or found.moment <= 0
        return
    energy = found.work - machine.speed**2 / 2 * links
    by_energy, by_diagram = (ledger[id].values[0] for id in ("J.I", "J.d"))
    assert by_energy == pytest.approx((energy.max() - energy.min()) / (delta * machine.speed**2), rel=1e-9)
    dust = 1e-9 * by_energy
    assert -dust <= by_energy - by_diagram <= (1 + delta / 4) * links.max() + dust


@pytest.mark.parametrize("name", ["engine-single-I", "slider-crank-01", "toggle-press-01"])
def test_the_tangents_are_drawn_to_the_axis_at_their_inclinations(name: str) -> None:
    """From J = 0, at a and b, at the angles ψ that the text prints to 0.01° and at its scales μ_J, μ_A."""
    case = open_case(ASSIGNMENTS / f"{name}.yaml")
    ledger, (scene,) = case.printed, wittenbauer(ReportContext(case)).scenes
    frame = next(item for item in scene.items if isinstance(item, Polyline) and item.closed)
    left = frame.points[0].real
    open_lines = [item.points for item in scene.items if isinstance(item, Polyline) and not item.closed]
    upper, lower = ((points[0], points[-1]) for points in open_lines if abs(points[0].real - left) < 1e-9)
    for points, bound in ((upper, "max"), (lower, "min")):
        angle = math.degrees(cmath.phase(points[1] - points[0]))
        assert angle == pytest.approx(ledger.number(f"psi.{bound}").printed, abs=0.01)
    apart = ledger.number("A.upper").value - ledger.number("A.lower").value
    # Both heights are printed with five figures.
    assert (upper[0] - lower[0]).imag * ledger.number("mu.A").value == pytest.approx(apart, rel=2e-4)
    reach = (upper[1] - upper[0]).real * ledger.number("mu.J").value
    assert reach == pytest.approx(regulated_in(case.analysis).inertia.max())
