"""The figure of the 90° rule: what it turns, and which way."""

from __future__ import annotations

import cmath
import math

import pytest

from reportgen.figures.coriolis import Sliding, coriolis
from reportgen.figures.scene import Arc, Arrow
from reportgen.notation.expressions import Symbol

EXACT = 1e-9
"""Rounding of drawn coordinates of some ten millimetres."""


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
