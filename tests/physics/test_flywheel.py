"""The flywheel against the conservation of energy, and against cases that can be done by hand."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from reportgen import api
from reportgen.analysis import FULL_TURN, motion_at
from reportgen.catalogue.machine import Machine
from reportgen.cycle.flywheel import Flywheel, accumulated, regulate
from reportgen.ledger.report import keep
from reportgen.regulation import flywheel, reduced_inertia

ASSIGNMENTS = Path(__file__).parents[2] / "assignments"


@pytest.fixture(scope="module", params=["engine-single-VII", "slider-crank-01", "engine-twin-05"])
def machine(request: pytest.FixtureRequest) -> Machine:
    return api.analyse(api.load(ASSIGNMENTS / f"{request.param}.yaml")).machine


def test_speed_stays_within_the_unevenness_and_meets_it(machine: Machine) -> None:
    found = flywheel(machine, 1 / 50)
    assert (found.speed.max() - found.speed.min()) / machine.speed == pytest.approx(1 / 50, rel=1e-9)
    assert (found.speed.max() + found.speed.min()) / 2 == pytest.approx(machine.speed, rel=1e-9)


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

    def power(angle: np.ndarray) -> np.ndarray:
        there = motion_at(machine, angle)
        total = np.full(angle.shape, found.constant)
        for body in machine.linkage.inertias:
            fall = there.points[body.centre].v * np.conj(machine.linkage.gravity)
            total += body.mass * fall.real / machine.speed
        for force in machine.applied:
            along = (np.conj(force.direction) * there.points[force.point].v).real
            total += force.law.value(angle, there) * along / machine.speed
        return total

    work = accumulated(power, found.angle)[pick]
    gained = kinetic - kinetic[0]
    assert gained == pytest.approx(work, rel=0, abs=1e-9 * kinetic.max())


def test_the_cycle_closes(machine: Machine) -> None:
    found = flywheel(machine, 1 / 50)
    assert found.work[-1] == pytest.approx(0, abs=1e-9 * np.abs(found.work).max())
    assert found.speed[-1] == pytest.approx(found.speed[0], rel=1e-9)
    # The other side's constant torque is the mean balancing torque: inertia gives back what it takes.
    assert found.constant == pytest.approx(
        machine.turn * api_mean(machine), abs=1e-9 * np.abs(found.torque).max()
    )


def api_mean(machine: Machine) -> float:
    from reportgen.analysis import summarise

    return summarise(machine).mean_torque


def test_the_report_prints_what_was_found() -> None:
    """The printed definitions of J_r and J_d, evaluated, are the arrays they stand for."""
    analysis = api.analyse(api.load(ASSIGNMENTS / "engine-single-VII.yaml"))
    books = keep(analysis)
    assert books.flywheel is not None
    expected = reduced_inertia(analysis.machine, analysis.motion)
    assert books.ledger["J.r"].values == pytest.approx(expected, rel=1e-12)
    assert books.ledger["J.d"].values == pytest.approx([books.flywheel.moment], rel=1e-12)
    at = np.searchsorted(books.flywheel.angle, analysis.cycle_angle - 1e-9)
    assert books.flywheel.angle[at] == pytest.approx(analysis.cycle_angle, abs=1e-9)


def test_a_sine_torque_on_constant_inertia() -> None:
    """A = M₀(1 − cos φ), from 0 to 2M₀: with J_r constant, J_d + J_r = 2 M₀/(δ ω²) but for δ²."""
    angle = np.linspace(0, FULL_TURN, 721)
    inertia = np.full(angle.shape, 0.3)
    found = regulate(angle, 40 * np.sin(angle), 40 * (1 - np.cos(angle)), inertia, 20.0, 0.02)
    # ω_max² − ω_min² = 2δω², so ½(J_d + J_r)·2δω² = 2M₀ holds exactly.
    assert found.moment + 0.3 == pytest.approx(2 * 40 / (0.02 * 20**2), rel=1e-12)
    assert math.degrees(found.angle[found.high]) == pytest.approx(180)


def test_wittenbauers_lines_touch_the_curve(machine: Machine) -> None:
    found: Flywheel = flywheel(machine, 1 / 30)
    for bound, height, sign in ((found.fastest, found.upper, 1), (found.slowest, found.lower, -1)):
        line = height + bound**2 / 2 * found.inertia
        assert (sign * (line - found.work)).min() == pytest.approx(0, abs=1e-9 * np.abs(found.work).max())
