"""Published worked examples: what a textbook prints, reproduced within its own reading error."""

from __future__ import annotations

import math

import numpy as np
import pytest

from reportgen.mechanism.forces import solve_forces
from reportgen.mechanism.loads import Load, inertia_loads, weights
from reportgen.mechanism.motion import Motion, solve_motion
from reportgen.mechanism.power import virtual_work_torque
from reportgen.mechanism.structure import Crank, Dyad, Guide, Inertia, Linkage, LinkPoint

DRAWN = 0.005
"""A plan drawn by hand is read to half a percent of a segment of usual length."""

# --- the parallel twin-cylinder engine ------------------------------------------------------------

R, L, G = 0.0475, 0.171, 9.81
OMEGA = 2200 * 2 * math.pi / 60
AREA = math.pi / 4 * 0.098**2


def twin() -> Linkage:
    rod, piston = 20 / G, 22 / G
    upward = Guide(0, math.pi / 2)
    return Linkage(
        ground={"O1": 0},
        driver=Crank("O1", "A", R),
        dyads=(
            Dyad("RRP", (2, 3), "A", "B", upward, (L, 0)),
            Dyad("RRP", (4, 5), "C", "D", upward, (L, 0)),
        ),
        points=(LinkPoint("C", 1, -R), LinkPoint("S2", 2, 0.35 * L), LinkPoint("S4", 4, 0.35 * L)),
        inertias=(
            Inertia(2, "S2", rod, rod * L**2 / 12),
            Inertia(3, "B", piston),
            Inertia(4, "S4", rod, rod * L**2 / 12),
            Inertia(5, "D", piston),
        ),
    )


@pytest.fixture(scope="module")
def twin_motion() -> Motion:
    return solve_motion(twin(), math.pi / 2 + np.arange(8) * math.pi / 4, OMEGA)


@pytest.mark.parametrize(
    ("point", "rate", "printed"),
    [
        ("B", "v", 6.173),
        ("S2", "v", 8.780),
        ("D", "v", 9.284),
        ("S4", "v", 9.689),
        ("A", "a", 2521),
        ("B", "a", 1770),
        ("D", "a", 1796),
        ("S2", "a", 2122),
        ("S4", "a", 2129),
    ],
)
def test_twin_points_at_position_4(twin_motion: Motion, point: str, rate: str, printed: float) -> None:
    assert abs(getattr(twin_motion.points[point], rate)[3]) == pytest.approx(printed, rel=DRAWN)


def test_twin_rods_at_position_4(twin_motion: Motion) -> None:
    second, fourth = twin_motion.links[2], twin_motion.links[4]
    assert second.omega[3] == pytest.approx(46.0, rel=DRAWN)
    assert fourth.omega[3] == pytest.approx(-46.0, rel=DRAWN)
    assert second.epsilon[3] == pytest.approx(10205, rel=DRAWN)
    assert fourth.epsilon[3] == pytest.approx(-10205, rel=DRAWN)
    assert abs(second.omega[3]) * L == pytest.approx(7.861, rel=DRAWN)
    assert second.omega[3] ** 2 * L == pytest.approx(363, rel=2 * DRAWN)  # a square doubles the error
    assert second.epsilon[3] * L == pytest.approx(1745, rel=DRAWN)


def test_twin_forces_at_position_4(twin_motion: Motion) -> None:
    linkage, still = twin(), np.zeros(8)
    inertia = inertia_loads(linkage, twin_motion)
    for load, printed in zip(inertia, (4326, 3969, 4341, 4028), strict=True):
        assert abs(load.force[3]) == pytest.approx(printed, rel=DRAWN)
    suction, pressure = 2.5e4 * AREA, 13.87e4 * AREA
    assert suction == pytest.approx(189, rel=DRAWN)
    assert pressure == pytest.approx(1046, rel=DRAWN)
    gas = (
        Load("P3", 3, still + 1j * suction, twin_motion.points["B"].p, still),
        Load("P5", 5, still - 1j * pressure, twin_motion.points["D"].p, still),
    )
    loads = (*gas, *weights(linkage, twin_motion), *inertia)
    forces = solve_forces(linkage, twin_motion, loads)
    rod = twin_motion.points["D"].p - twin_motion.points["C"].p
    r14 = forces.reactions["R14"].force
    tangential = (r14 * np.conj(rod / abs(rod))).imag
    assert abs(tangential[3]) == pytest.approx(2252, rel=0.01)
    assert abs(r14[3]) == pytest.approx(6653, rel=DRAWN)
    assert abs(forces.reactions["R54"].force[3]) == pytest.approx(3279, rel=DRAWN)
    assert abs(forces.reactions["R05"].force[3]) == pytest.approx(1411, rel=0.03)
    by_work = virtual_work_torque(linkage, twin_motion, loads)
    assert forces.torque == pytest.approx(by_work, abs=1e-9 * abs(by_work).max())
