"""Published rotors: static and dynamic balance, a plane that is sought, masses that are sought.

Sources: Norton, Design of Machinery, chapter 12 (static and dynamic balance); Khurmi, Gupta, Theory of Machines,
chapter 21 (four masses on a shaft; its drawings differ from the exact values by up to 3 %).
"""

from __future__ import annotations

import cmath
import math

import pytest

from reportgen.balancing import rotor_ids as ids
from reportgen.balancing.rotor_calculation import RotorCalculation
from reportgen.balancing.rotor_file import Parameters
from reportgen.formula.calculation import Calculation


def calculation(masses: list[tuple[str, float, float, float]], **given: object) -> Calculation:
    """Masses as m, r (mm), angle (°) and z (mm)."""
    rows = [{"m": m, "r": f"{r} mm", "angle": f"{α} deg", "z": f"{z} mm"} for m, r, α, z in masses]
    return RotorCalculation(Parameters.model_validate({"masses": rows, **given})).written()


def degrees(sheet: Calculation, plane: str) -> float:
    return math.degrees(sheet.si(ids.direction(plane))) % 360


def test_static_balance() -> None:
    """Norton: 2.402 kg·m at 259.6°."""
    sheet = calculation([("1.2 kg", 1135, 113.4, 0), ("1.8 kg", 822, 48.8, 0)], planes={"A": "0 mm"})
    assert sheet.si(ids.unbalance("A")) == pytest.approx(2.402, abs=0.001)
    assert degrees(sheet, "A") == pytest.approx(259.6, abs=0.05)


def test_dynamic_balance() -> None:
    """Norton: three masses, planes 3.097 m apart."""
    masses = [("1.2 kg", 1135, 113.4, 854), ("1.8 kg", 822, 48.8, 1701), ("2.4 kg", 1040, 251.4, 2396)]
    sheet = calculation(masses, planes={"A": "0 mm", "B": "3097 mm"})
    for plane, size, angle in (("A", 0.881, 278.66), ("B", 0.904, 75.27)):
        assert sheet.si(ids.unbalance(plane)) == pytest.approx(size, abs=0.001)
        assert degrees(sheet, plane) == pytest.approx(angle, abs=0.05)


def test_the_plane_of_the_fourth_mass() -> None:
    """Khurmi: masses of 18 kg and 12.5 kg in planes B and C, that in plane A at 190°; D is sought in all."""
    masses = [("18 kg", 60, 0, 100), ("12.5 kg", 60, 100, 300)]
    correction = {"A": {"r": "80 mm", "angle": "190 deg"}, "B": {"r": "80 mm"}}
    sheet = calculation(masses, planes={"A": "0 mm", "B": "find"}, correction=correction)
    m_A, m_D, z = sheet.si(ids.mass("A")), sheet.si(ids.mass("B")), sheet.si(ids.station("B"))
    α = sheet.si(ids.direction("B"))
    bodies = [(18 * 0.06, 0.0, 0.1), (12.5 * 0.06, math.radians(100), 0.3), (m_D * 0.08, α, z)]
    assert abs(sum(U * cmath.rect(z, α) for U, α, z in bodies)) < 1e-12
    assert abs(sum(cmath.rect(U, α) for U, α, _ in bodies) + cmath.rect(m_A * 0.08, math.radians(190))) < 1e-12
    # Read off the drawing: 9.625 kg, 8.125 kg, 361.5 mm and 251°.
    assert (m_A, m_D, z) == pytest.approx((9.625, 8.125, 0.3615), rel=0.03)
    assert degrees(sheet, "B") == pytest.approx(251, abs=2)


def test_two_masses_of_four() -> None:
    """Khurmi: equal radii, equal distances, B of 7 kg, C and D at 90° and 240° from it; A is sought in all."""
    masses = [("7 kg", 100, 0, 100), ("find", 100, 90, 200), ("find", 100, 240, 300)]
    sheet = calculation(masses, planes={"A": "0 mm"}, correction={"r": "100 mm"})
    # By moments about A: m_D = 7/3/cos 60°, m_C = 3 m_D sin 60°/2.
    assert sheet.si(ids.mass("3")) == pytest.approx(14 / 3)
    assert sheet.si(ids.mass("2")) == pytest.approx(3.5 * math.sqrt(3))
    assert sheet.si(ids.mass("A")) == pytest.approx(5, rel=0.03)
    assert degrees(sheet, "A") == pytest.approx(205, abs=2)
