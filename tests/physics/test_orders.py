"""Orders of engines against published coefficients, figures computed apart, and Fourier analysis of exact forces."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from reportgen.balancing import balance_ids
from reportgen.balancing.counterweights import crank_rods
from reportgen.balancing.orders import BACKWARD, FORWARD, engine
from reportgen.balancing.piston_orders import acceleration_factor
from reportgen.balancing.shaking_force import seen_from_crank
from reportgen.cases import MachineCase, open_case
from reportgen.formula import Ref
from reportgen.formula.evaluation import evaluate
from reportgen.machine import Crank, Dyad, Guide, Inertia, Linkage, LinkPoint
from reportgen.machine.analysis import Machine
from tests.lanes import matrix
from tests.physics.test_shaking import machine_of

ASSIGNMENTS = Path(__file__).parents[2] / "assignments"

PLACES = 256
"""Even places of a turn; λ⁸ʰ fades below 1e-15 long before so many harmonics, λ being less than 1."""


def piston_order(ratio: float, order: int) -> float:
    """A_n by the n-th Fourier coefficient of the piston's way over r, which is cos θ + √(1 − λ² sin² θ)/λ."""
    angle = np.arange(PLACES) * (2 * np.pi / PLACES)
    x = np.cos(angle) + np.sqrt(1 - (ratio * np.sin(angle)) ** 2) / ratio
    return float(order**2 * 2 * np.mean(x * np.cos(order * angle)))


@pytest.mark.parametrize(
    ("ratio", "orders"),
    [
        (1 / 4, (0.25402504, -0.00409811, 0.00007438)),
        (1 / 3.6, (0.28333914, -0.00568698, 0.00012842)),
        (0.3, (0.30705066, -0.00723769, 0.00019194)),
    ],
)
def test_the_orders_of_a_piston(ratio: float, orders: tuple[float, ...]) -> None:
    """The series gives them to the digits that the figures have, and as the piston's way does."""
    λ = Ref("lambda")
    exact = [float(evaluate(acceleration_factor(n, λ, ratio), {"lambda": ratio})) for n in (2, 4, 6)]
    assert exact == pytest.approx(orders, abs=5e-9)
    assert exact == pytest.approx([piston_order(ratio, n) for n in (2, 4, 6)], abs=1e-12)


def layout(cylinders: list[tuple[float, float]], ratio: float = 0.25) -> Machine:
    """An engine of cylinders by the angles (degrees) of their pins on the crank and of their lines."""
    r, points, dyads, bodies = 0.04, [], [], []
    for number, (pin, bank) in enumerate(cylinders):
        rod, slider = 2 + 2 * number, 3 + 2 * number
        name = "A" if number == 0 else f"P{number}"
        if number:
            points.append(LinkPoint(name, 1, r * complex(np.exp(1j * math.radians(pin)))))
        dyads.append(Dyad("RRP", (rod, slider), name, f"B{number}", Guide(0j, math.radians(bank)), (r / ratio, 0.0)))
        points.append(LinkPoint(f"S{rod}", rod, complex(0.35 * r / ratio)))
        bodies += [Inertia(rod, f"S{rod}", 0.6), Inertia(slider, f"B{number}", 0.5)]
    linkage = Linkage({"O": 0j}, Crank("O", "A", r), tuple(dyads), tuple(points), tuple(bodies))
    return machine_of(linkage, 300.0)


LAYOUTS = {
    "twin 180": ([(0, 90), (180, 90)], (0, 2, 2)),
    "twin 360": ([(0, 90), (0, 90)], (2, 2, 2)),
    "twin 270": ([(0, 90), (270, 90)], (math.sqrt(2), 0, 2)),
    "in-line three": ([(0, 90), (120, 90), (240, 90)], (0, 0, 0)),
    "in-line four": ([(0, 90), (180, 90), (180, 90), (0, 90)], (0, 4, 4)),
    "in-line six": ([(n, 90) for n in (0, 120, 240, 240, 120, 0)], (0, 0, 0)),
    "boxer twin": ([(0, 0), (180, 180)], (0, 0, 0)),
    "V 60": ([(0, 60), (0, 120)], (1.5, math.sqrt(3) / 2, math.sqrt(3) / 2)),
    # Both order vectors of 90° are quarter turns apart: one sum is closed, the other of size 2, or √2 on one line.
    "V 90": ([(0, 45), (0, 135)], (1.0, math.sqrt(2), math.sqrt(2))),
}


def by_fourier(machine: Machine, order: int) -> float:
    """The greatest force of an order (N), by Fourier analysis of the exact force, without the part that turns."""
    harmonics = seen_from_crank(machine).harmonics * machine.speed**2
    turning = sum(rod.turning * rod.pin for rod in crank_rods(machine.linkage)) * machine.speed**2
    forward = harmonics[order - 1] - (turning if order == 1 else 0)
    return float(abs(forward) + abs(harmonics[-order - 1]))


@pytest.mark.parametrize("name", LAYOUTS)
def test_known_layouts(name: str) -> None:
    """Over m r ω² A_n, as books have them; what Fourier analysis finds of the exact forces is the same."""
    cylinders, expected = LAYOUTS[name]
    machine = layout(cylinders)
    found = engine(machine.linkage)
    assert found is not None
    assert [found.force(order) for order in (1, 2, 4)] == pytest.approx(expected, abs=1e-12)
    unit = found.mass * found.crank * machine.speed**2
    for order in (1, 2, 4):
        size = unit * abs(piston_order(0.25, order))
        assert by_fourier(machine, order) == pytest.approx(size * found.force(order), abs=1e-9 * unit)


@pytest.mark.parametrize("seed", matrix(range(20), range(1)))
def test_any_layout_agrees_with_exact_forces(seed: int) -> None:
    """Ten layouts of up to twelve cylinders at any angles: stars against the Fourier analysis of their forces."""
    random = np.random.default_rng(seed)
    for _ in range(10):
        count, ratio = int(random.integers(1, 13)), float(random.uniform(0.15, 0.4))
        cylinders = [(0.0, float(random.uniform(0, 360)))]
        cylinders += [tuple(map(float, random.uniform(0, 360, 2))) for _ in range(count - 1)]
        machine = layout(cylinders, ratio)
        found = engine(machine.linkage)
        assert found is not None
        unit = found.mass * found.crank * machine.speed**2
        for order in (1, 2, 4, 6):
            size = unit * abs(piston_order(ratio, order))
            assert by_fourier(machine, order) == pytest.approx(size * found.force(order), abs=1e-9 * unit * count)


def test_a_v_engine_at_90_degrees_is_balanced_by_one_counterweight() -> None:
    """The first order turns forward alone: a counterweight of m r takes it whole."""
    found = engine(layout([(0, 45), (0, 135)]).linkage)
    assert found is not None
    assert abs(found.star(1, BACKWARD)) < 1e-12
    assert abs(found.star(1, FORWARD)) == pytest.approx(2.0)


def test_offset_cylinders_and_unlike_ones_are_no_such_engine() -> None:
    machine = layout([(0, 90), (180, 90)])
    first, second = machine.linkage.dyads
    offset = Linkage(
        machine.linkage.ground,
        machine.linkage.driver,
        (first, Dyad("RRP", second.links, second.start, second.middle, Guide(0.01 + 0j, math.pi / 2), second.lengths)),
        machine.linkage.points,
        machine.linkage.inertias,
    )
    assert engine(offset) is None


@pytest.mark.parametrize("name", matrix(("twin-180", "twin-270", "v-60"), ("twin-270", "v-60")))
def test_the_ledger_has_the_orders_of_its_forces(name: str) -> None:
    """By the formulas of the report, against Fourier analysis of the machine's own force."""
    case = open_case(ASSIGNMENTS / "balancing" / f"{name}.yaml")
    assert isinstance(case, MachineCase)
    machine, ledger = case.analysis.machine, case.ledger
    turning = sum(rod.turning * rod.pin for rod in crank_rods(machine.linkage))
    harmonics = seen_from_crank(machine).harmonics
    for order in (1, 2, 4):
        # Angles are counted from position 1, which changes no size.
        forward = abs(harmonics[order - 1] - (turning if order == 1 else 0))
        force = (forward + abs(harmonics[-order - 1])) * machine.speed**2
        assert ledger[balance_ids.order_force(order)].values[0] == pytest.approx(
            force, abs=1e-9 * abs(harmonics).max() * machine.speed**2
        )
    couples = {"twin-180": (1, 0, 0), "twin-270": (math.sqrt(0.5), 1, 0)}
    for order, couple in zip((1, 2, 4), couples.get(name, ()), strict=False):
        assert ledger[balance_ids.couple(order)].values[0] == pytest.approx(couple, abs=1e-12)
