"""A wide slider against figures of a second computation, a system of three equations for the reactions.

Horizontal guide through the pin E, faces from x₁ −0.10 to x₂ 0.22 m, the link at E pulls along 168°; m 52 kg.
"""

from __future__ import annotations

import cmath
import math

import numpy as np
import pytest

import reportgen
from reportgen.faces.ends import at_ends
from reportgen.machine.force_analysis import Load
from reportgen.machine.slider_faces import Faces

m, g, θ = 52.0, 9.81, math.radians(168)
FACES = Faces(-0.10, 0.22, 0.06)
LAST_DIGIT = 0.5e-6
"""Half a unit of the sixth decimal."""
CASES = [
    # F, its point; a; mass centre; R45, N, x_N, N_L, N_R
    (-400.0, 0.3 - 0.02j, -1.5, 0.05 + 0.03j, (-329.193672, 578.563213, 0.061957, 285.743459, 292.819754), False),
    (-1000.0, 0.35 - 0.12j, -3.2, 0.08 + 0.03j, (-852.223120, 687.307150, 0.241234, -45.606335, 732.913484), True),
]


@pytest.mark.parametrize(("F", "at", "a", "S", "wanted", "tilted"), CASES)
def test_both_ends(F: float, at: complex, a: float, S: complex, wanted: tuple[float, ...], tilted: bool) -> None:
    """Working force, weight and inertia force balanced: along the guide by the link at E, across it by the guide."""
    still = np.zeros(1)
    loads = [
        Load("P5", 5, still + complex(F), still + at, still),
        Load("G5", 5, still - 1j * m * g, still + S, still),
        Load("Pqt5", 5, still - complex(m * a), still + S, still),
    ]
    pull = -sum(load.force.real for load in loads) / math.cos(θ)
    N = -(sum(load.force.imag for load in loads) + pull * cmath.exp(1j * θ).imag)
    M = -sum(load.moment(0j) for load in loads)
    first, last = FACES.ends(N, M)
    assert [float(x[0]) for x in (pull, N, M / N, first, last)] == pytest.approx(wanted, abs=LAST_DIGIT)
    assert bool(FACES.tilts(N, M)[0]) is tilted


TEXT = """
kind: linkage
positions: {at: [20 deg, 100 deg, 250 deg]}
parameters:
  frame: {O: [0 mm, 0 mm]}
  driver: {type: crank, centre: O, pin: A, length: 100 mm, omega1: 12 rad/s}
  groups: [{type: RRP, links: [2, 3], joints: [A, B], length: 400 mm, guide: {angle: 30 deg}}]
  points: {T: {link: 3, at: [300 mm, -120 mm]}, S3: {link: 3, at: [80 mm, 30 mm]}}
  masses: [{link: 3, at: S3, m: 52 kg, J: 0.2 kg m2}]
  loads: [{by: constant, link: 3, at: T, F: 1000 N, direction: 210 deg}]
  faces: {3: {from: -100 mm, to: 220 mm, below: 60 mm}}
"""


def test_the_report_finds_them_from_the_plan() -> None:
    """N, x and both ends of the ledger are those of the analysis; they balance N and its moment."""
    model = reportgen.open(TEXT)
    values = {id: family.values for id, family in model.case.ledger.families.items()}
    analysis = model.case.analysis
    name, tilts, first, last = at_ends(analysis, 3)
    assert (name, tilts.any(), tilts.all()) == ("R03", True, False)
    for number, end in ((1, first), (2, last)):
        assert values[f"face.03.{number}"] == pytest.approx(end, nan_ok=True)
    N, x = values["N.03"], values["along.03"]
    assert (first + last)[tilts] == pytest.approx(N[tilts])
    assert (-0.10 * first + 0.22 * last)[tilts] == pytest.approx((N * x)[tilts])
    assert list(tilts) == [not -0.10 <= float(place) <= 0.22 for place in x]
    ends = [len(one["reactions_in_guides"]["R03"]["ends"]) for one in reportgen.solve(model.assignment)["positions"]]
    assert ends == [2 * int(one) for one in tilts]
