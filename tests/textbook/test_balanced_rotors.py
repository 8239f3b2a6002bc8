"""Published rotors: static and dynamic balance, a plane that is sought, masses that are sought.

Sources: Norton, Design of Machinery, chapter 12 (static and dynamic balance); Khurmi, Gupta, Theory of Machines,
chapter 21 (four masses on a shaft; its drawings differ from the exact values by up to 3 %); Bevan, The Theory of
Machines, 3rd edition, chapter 14, and Sarkar, Theory of Machines, 2002, chapter 8, with data, answers and pages of
the textbook companions at https://tbc-python.fossee.in (pounds are written as kg, inches as 25.4 mm).
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


def test_four_masses_in_one_plane() -> None:
    """Bevan 14.2, p. 491: 57.9 lb at 24 in, opposite to 23.28°; Sarkar 8.1, p. 221: 8.1 kg at 100 mm, 267.5°."""
    masses: list[tuple[str, float, float, float]]
    masses = [("200 kg", 228.6, 0, 0), ("300 kg", 177.8, 45, 0), ("240 kg", 254, 120, 0), ("260 kg", 304.8, 255, 0)]
    sheet = calculation(masses, planes={"A": "0 mm"}, correction={"r": "609.6 mm"})
    assert sheet.si(ids.mass("A")) == pytest.approx(57.9, abs=0.05)
    assert degrees(sheet, "A") == pytest.approx(180 + 23.28, abs=0.01)
    masses = [("12 kg", 40, 0, 0), ("10 kg", 50, 60, 0), ("18 kg", 60, 130, 0), ("15 kg", 30, 270, 0)]
    sheet = calculation(masses, planes={"A": "0 mm"}, correction={"r": "100 mm"})
    assert sheet.si(ids.mass("A")) == pytest.approx(8.1, abs=0.05)
    assert degrees(sheet, "A") == pytest.approx(267.5, abs=0.05)


@pytest.mark.parametrize(("place", "near", "far", "side"), [(-254, 144, 24, 0), (254, 96, 24, 180)])
def test_one_mass_and_two_planes(place: int, near: int, far: int, side: int) -> None:
    """Bevan 14.1, p. 491: 200 lb at 9 in, 10 in outside or inside the first of two planes 50 in apart."""
    masses = [("200 kg", 9 * 25.4, 0.0, float(place))]
    sheet = calculation(masses, planes={"A": "0 mm", "B": "1270 mm"}, correction={"r": "381 mm"})
    assert [sheet.si(ids.mass(plane)) for plane in "AB"] == pytest.approx([near, far])
    assert [degrees(sheet, plane) for plane in "AB"] == pytest.approx([180, side])
