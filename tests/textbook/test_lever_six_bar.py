"""The six-link lever mechanism against its published plans.

The source draws them at 0.02 (m/s)/mm and 2 (m/s²)/mm and gives no fixed points; those of the assignment are
fitted to its figures, which do not belong to one linkage: v_C, ω_CD, a_C and aⁿ_CD stay outside the rest.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from reportgen import api
from reportgen.machine.analysis import Analysis
from reportgen.plans import write_ledger

ASSIGNMENT = Path(__file__).parents[2] / "assignments" / "lever-six-bar-01.yaml"
FITTED, CONTRADICTED, SQUARED = 0.0145, 0.035, 0.065
"""Agreement of the fitted fixed points: of most figures, of those of point C, of a square of these."""
HALF_A_MILLIMETRE = 0.5
"""Reading error of a drawn segment (mm)."""


@pytest.fixture(scope="module")
def solved() -> Analysis:
    """Position 2: the crank at 30°."""
    return api.analyse(api.load(ASSIGNMENT))


@pytest.mark.parametrize(
    ("id", "printed", "error"),
    [
        ("v.A", 3.026, 1e-4),
        ("v.C", 3.04, CONTRADICTED),
        ("v.E", 3.05, FITTED),
        ("v.F", 0.92, FITTED),
        ("omega.4", 24.5, FITTED),
        ("omega.3", 50.6, CONTRADICTED),
        ("a.A", 269.3, 1e-4),
        ("a.C", 172, CONTRADICTED),
        ("a.E", 200, FITTED),
        ("a.CD.n", 154.02, SQUARED),
        ("a.FE.n", 67.25, FITTED),
        ("v.S1", 1.52, FITTED),
        ("v.S2", 3.04, FITTED),
        # Printed as those of S4 and S3: the two stand exchanged in the source's table.
        ("v.S3", 1.52, CONTRADICTED),
        ("v.S4", 1.78, CONTRADICTED),
    ],
)
def test_printed_figures(solved: Analysis, id: str, printed: float, error: float) -> None:
    assert float(write_ledger(solved).ledger[id].at(2)) == pytest.approx(printed, rel=error)


def test_the_short_segment_of_the_coupler(solved: Analysis) -> None:
    """ac is drawn 12 mm long: v_AC and ω_AC are read to half a millimetre of it, aⁿ_AC to twice that."""
    ledger, reading = write_ledger(solved).ledger, HALF_A_MILLIMETRE / 12
    assert float(ledger["v.CA"].at(2)) == pytest.approx(0.24, rel=reading)
    assert float(ledger["omega.2"].at(2)) == pytest.approx(2.6, rel=reading)
    assert float(ledger["a.CA.n"].at(2)) == pytest.approx(0.64, rel=2 * reading)


def test_every_link_keeps_its_length(solved: Analysis) -> None:
    points = solved.motion.points
    rods = {"BA": 0.034, "AC": 0.090, "DC": 0.060, "EF": 0.110, "CE": 0.030, "AE": 0.060}
    for (one, other), length in ((tuple(name), length) for name, length in rods.items()):
        apart = np.abs(points[one].p - points[other].p)
        assert apart == pytest.approx(length, rel=1e-12)
    assert points["F"].p.imag == pytest.approx(-0.073, rel=1e-12)
    assert (points["F"].p.real < points["E"].p.real).all()


def test_the_slider_is_resisted_on_both_ways(solved: Analysis) -> None:
    """400 N against the slider over its two strokes take up 400 N times twice the stroke."""
    assignment = api.load(ASSIGNMENT).with_positions(360)
    fine = api.analyse(assignment)
    stroke = np.ptp(fine.motion.points["F"].p.real)
    # The ends of the stroke are stationary: a step of 1° misses less than 1e-4 of it.
    assert solved.summary.work == pytest.approx(-400 * 2 * stroke, rel=2e-4)
    force = np.array([load.force for load in fine.applied])[0].real
    assert (force * fine.motion.points["F"].v.real <= 0).all()
