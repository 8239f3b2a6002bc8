"""The indicator diagram beside a cylinder of any direction."""

from __future__ import annotations

import cmath
import math

import pytest

from reportgen.figures.draft import finish
from reportgen.figures.indicator import Branch, Frame, Reading, beside, indicator
from reportgen.notation.expressions import Symbol
from tests.figures.overlaps import overlaps


@pytest.mark.parametrize("degrees", range(0, 360, 15))
def test_it_is_clear_on_both_sides_of_a_cylinder_in_any_direction(degrees: int) -> None:
    up = cmath.exp(1j * math.radians(degrees))
    top, bottom = 150 * up, 80 * up
    for side in (1j * up, -1j * up):
        start, end, mu = beside(top, bottom, side, 75.0, 640.0)
        assert abs(end - start) == pytest.approx(70)
        branches = (
            Branch("Expansion", (0, 0.1, 0.4, 1), (640, 400, 120, 30)),
            Branch("Exhaust", (0, 1), (2, 30)),
        )
        readings = [Reading(Symbol(str(n), "(3)"), n / 8, 640 * (1 - n / 8) ** 2) for n in range(9)]
        frame = Frame(start, end, side, mu, "p, N/cm²")
        assert overlaps(finish(indicator(frame, branches, readings))) == []
