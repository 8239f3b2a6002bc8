"""Separated links, their arms, the lever and the rule of 90°."""

from __future__ import annotations

import cmath
import math

import pytest

from reportgen.drawing import Arc, Arrow, Scene
from reportgen.drawing.force_drawings import ArmOf, Couple, Force, Sliding, bodies, coriolis, foot, lever
from reportgen.drawing.scheme import Looks
from reportgen.formula import Symbol
from tests.drawing.machines import OMEGA, R, at_positions, twin_engine, velocity_plan
from tests.drawing.overlaps import overlaps

EXACT = 1e-9
"""Rounding of drawn coordinates of some ten millimetres."""


def sketch(k: int) -> Scene:
    linkage = twin_engine()
    motion = at_positions(linkage)
    scale = 400.0
    point: dict[str, complex] = {name: complex(motion.points[name].p[k]) * scale for name in ("C", "D", "S4")}
    rod = point["D"] - point["C"]
    acceleration = complex(motion.points["S4"].a[k])
    acting = (
        Force(Symbol("P", "5"), point["D"], -1j, id="P5"),
        Force(Symbol("G", "5"), point["D"], -1j, id="G5"),
        Force(Symbol("P", "qt5"), point["D"], -complex(motion.points["D"].a[k]), id="Pqt5"),
        Force(Symbol("R", "05"), point["D"], 1, "reaction", "R05"),
        Force(Symbol("G", "4"), point["S4"], -1j, id="G4"),
        Force(Symbol("P", "qt4"), point["S4"], -acceleration, id="Pqt4"),
        Force(Symbol("R", "14", "n"), point["C"], rod, "reaction", "n"),
        Force(Symbol("R", "14", "t"), point["C"], 1j * rod, "reaction", "t"),
    )
    arms = (ArmOf(Symbol("h", "1"), point["D"], "Pqt4"), ArmOf(Symbol("h", "2"), point["D"], "G4"))
    couple = Couple(Symbol("M", "qt4"), point["S4"], -float(motion.links[4].epsilon[k]))
    return bodies(linkage, motion, k, scale, (4, 5), acting, arms=arms, turning=[couple], looks=Looks(centres=("S4",)))


@pytest.mark.parametrize("k", range(8))
def test_separated_links_are_clear(k: int) -> None:
    scene = sketch(k)
    assert overlaps(scene) == []
    forces = [item for item in scene.items if isinstance(item, Arrow) and item.name and not item.name.startswith("h ")]
    assert len(forces) == 8
    assert all(12 <= abs(arrow.end - arrow.start) <= 30 for arrow in forces)


def test_arms_are_the_distances_to_the_lines_of_action() -> None:
    about, at, way = 3 + 4j, 10 - 2j, 2 + 1j
    base = foot(about, at, at + way)
    assert ((base - about) * way.conjugate()).real == pytest.approx(0, abs=1e-12)
    assert ((base - at) * way.conjugate()).imag == pytest.approx(0, abs=1e-12)


@pytest.mark.parametrize("k", range(8))
def test_the_lever_is_the_plan_turned_by_a_right_angle(k: int) -> None:
    motion = at_positions(twin_engine())
    drawing = velocity_plan(motion, k)
    mu = OMEGA * R / 50

    def image(name: str) -> complex:
        return 1j * complex(motion.points[name].v[k]) / mu

    acting = [
        Force(Symbol("G", str(link)), image(name), -1j, id=f"G{link}")
        for link, name in ((2, "S2"), (3, "B"), (4, "S4"), (5, "D"))
    ]
    acting.append(Force(Symbol("P", "qt2"), image("S2"), -complex(motion.points["S2"].a[k]), id="Pqt2"))
    arms = [ArmOf(Symbol("h", force.id), 0j, force.id) for force in acting]
    scene = lever(drawing, acting, arms)
    assert overlaps(scene) == []
    ends = {point.label: point.at for point in drawing.scaled(1j).points}
    # The pin's image turned by +90° lies along A–O1: opposite to the crank for a positive ω1.
    crank = complex(motion.points["A"].p[k]) / R
    assert ends[Symbol("a")] == pytest.approx(-50 * crank, abs=1e-9)


@pytest.mark.parametrize("sense", [1.0, -1.0])
@pytest.mark.parametrize("angle", [0.0, 0.8, 2.5, -1.9])
def test_the_relative_velocity_is_turned_with_omega(angle: float, sense: float) -> None:
    velocity = cmath.rect(0.3, angle)
    scene = coriolis(
        Sliding(
            Symbol("B", "3"),
            (Symbol("v", "B3B2", over="vector"), velocity),
            (Symbol("a", "B3B2", "k", "vector"), 2j * sense * velocity),
            (Symbol("ω", "3"), sense),
        )
    )
    arrows = {item.name: item.end - item.start for item in scene.items if isinstance(item, Arrow)}
    assert cmath.phase(arrows["v"] / cmath.rect(1, angle)) == pytest.approx(0, abs=EXACT)
    assert cmath.phase(arrows["a"] / arrows["v"]) == pytest.approx(sense * math.pi / 2, abs=EXACT)
    quarter, turning = (item for item in scene.items if isinstance(item, Arc))
    assert quarter.stop - quarter.start == pytest.approx(sense * math.pi / 2, abs=EXACT)
    assert math.copysign(1, turning.stop - turning.start) == sense
