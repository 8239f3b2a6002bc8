"""Published engines: greatest and least forces of V twins by the books' factor A₂ = λ, cylinders that differ.

Sources: Khurmi, Gupta, Theory of Machines, chapter 22 (V twins, four cylinders); books take the first term of each
factor, which the exact one exceeds by λ²/4 of itself. Bevan, The Theory of Machines, 3rd edition, chapter 14, as in the
textbook companion at https://tbc-python.fossee.in.
"""

from __future__ import annotations

import cmath
import math

import pytest

from reportgen.balancing import orders_ids
from reportgen.balancing.engine_calculation import EngineCalculation
from reportgen.balancing.engine_file import Parameters
from reportgen.formula.calculation import Calculation


def calculation(**given: object) -> Calculation:
    return EngineCalculation(Parameters.model_validate(given)).written()


def test_a_v_twin_of_sixty_degrees() -> None:
    """1.5 kg, stroke 100 mm, rods 250 mm, 2500 rpm: primary force 7710.7 N and 2570.2 N, secondary force 890.3 N."""
    sheet = calculation(
        r="50 mm",
        l="250 mm",
        n="2500 rpm",
        m3="1.5 kg",
        cylinders=[{"crank": "0 deg", "bank": "30 deg"}, {"crank": "0 deg", "bank": "-30 deg"}],
    )
    assert sheet.si(orders_ids.force(1)) == pytest.approx(7710.7, abs=0.6)
    assert sheet.si(orders_ids.least_force(1)) == pytest.approx(2570.2, abs=0.2)
    λ, exact = sheet.si("orders.lambda"), sheet.si(orders_ids.factor(2))
    assert sheet.si(orders_ids.force(2)) * λ / exact == pytest.approx(890.3, abs=0.1)
    assert exact / λ - 1 == pytest.approx(λ**2 / 4, rel=0.05)


def test_the_first_order_of_a_right_angled_v_turns_at_constant_size() -> None:
    """m r ω², at every angle of the crank; the second order moves along one line."""
    sheet = calculation(
        r="75 mm",
        l="300 mm",
        n="500 rpm",
        m3="11.5 kg",
        cylinders=[{"crank": "0 deg", "bank": "45 deg"}, {"crank": "0 deg", "bank": "-45 deg"}],
    )
    assert sheet.si(orders_ids.force(1)) == pytest.approx(sheet.si("orders.K"))
    assert sheet.si(orders_ids.least_force(1)) == pytest.approx(sheet.si("orders.K"))
    assert sheet.families[orders_ids.least_force(2)].at(1) == 0
    λ, exact = sheet.si("orders.lambda"), sheet.si(orders_ids.factor(2))
    # √2 m r² ω²/l, the book's 836 N.
    assert sheet.si(orders_ids.force(2)) * λ / exact == pytest.approx(836, abs=0.5)


def test_four_cylinders_with_masses_of_their_own() -> None:
    """Khurmi: 50, 60 and 50 kg in cylinders 1, 2 and 4, at 400, 200 and 200 mm from the third; primary balance.

    The third mass is 60 kg. About its plane the couples are in a triangle of the sides 20, 12 and 10.
    """
    second = math.acos((10**2 - 20**2 - 12**2) / (2 * 20 * 12))
    fourth = cmath.phase(20 + 12 * cmath.rect(1, second))
    third = cmath.phase(-(50 + cmath.rect(60, second) + cmath.rect(50, fourth)))
    exact = [0.0, *(math.degrees(angle) % 360 for angle in (second, third, fourth))]
    # Read off the drawing: 160°, 227° and 26°.
    assert exact == pytest.approx([0, 160, 227, 26], abs=3)
    places = zip(exact, (-400, -200, 0, 200), (50, 60, 60, 50), strict=True)
    cylinders = [{"crank": f"{θ:.12g} deg", "at": f"{z} mm", "m3": f"{m} kg"} for θ, z, m in places]
    sheet = calculation(r="150 mm", l="600 mm", n="300 rpm", m3="50 kg", cylinders=cylinders)
    for id in (orders_ids.force(1), orders_ids.couple(1), "orders.U", "orders.U.M"):
        assert sheet.families[id].at(1) == 0
    assert sheet.families[orders_ids.force(2)].at(1) > 0


def test_three_cylinders_around_one_crank() -> None:
    """Bevan 14.12, p. 517: 4 lb each, stroke 5 in, rods 9 in, 1500 rpm: 4.29 lb at 3.5 in and 266 lb."""
    cylinders = [{"crank": "0 deg", "bank": f"{bank} deg"} for bank in (0, 120, 240)]
    sheet = calculation(r="63.5 mm", l="228.6 mm", n="1500 rpm", m3="4 kg", cylinders=cylinders)
    ω, pound = 50 * math.pi, 32.2 * 0.3048
    assert sheet.si(orders_ids.force(1)) / ω**2 / (3.5 * 0.0254) == pytest.approx(4.29, abs=0.005)
    λ, exact = sheet.si("orders.lambda"), sheet.si(orders_ids.factor(2))
    assert sheet.si(orders_ids.force(2)) * λ / exact / pound == pytest.approx(266, abs=0.5)
