"""The six-link lever mechanism against its published plans.

The source draws them at 0.02 (m/s)/mm and 2 (m/s²)/mm and gives no fixed points; those of the assignment are
fitted to its figures, which do not belong to one linkage: v_C, ω_CD, a_C and aⁿ_CD stay outside the rest.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from reportgen import api
from reportgen.derivation import write_ledger
from reportgen.machine.analysis import Analysis, motion_at

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


def changes_of_sign(values: np.ndarray) -> np.ndarray:
    """The indices before which a course over one closed turn changes its sign."""
    return np.flatnonzero(np.sign(values) != np.sign(np.roll(values, 1)))


def test_the_extreme_positions_are_those_of_the_motion() -> None:
    """Rocker and slider turn back where the fine motion says, after the crank's turns whose ratio is K."""
    solved = api.analyse(api.load(ASSIGNMENT))
    ledger = write_ledger(solved).ledger
    motion = motion_at(solved.machine, np.arange(3600) * (2 * np.pi / 3600))
    step = 2 * np.pi / 3600
    ends = changes_of_sign(motion.links[3].omega)
    turned = np.diff(ends)[0] * step
    ratio = max(turned, 2 * np.pi - turned) / min(turned, 2 * np.pi - turned)
    # Each end is found to half a step, of about half a turn.
    assert float(ledger["K"].values[0]) == pytest.approx(ratio, rel=4 * step / np.pi)
    assert float(ledger["swing"].values[0]) == pytest.approx(np.ptp(motion.links[3].angle), rel=1e-6)
    assert float(ledger["H.5"].values[0]) == pytest.approx(np.ptp(motion.points["F"].p.real), rel=1e-6)
    ends = changes_of_sign(motion.points["F"].v.real)
    found = sorted(float(ledger[id].values[0]) for id in ("phi.F1", "phi.F2"))
    assert found == pytest.approx(np.mod(motion.driver[ends], 2 * np.pi), abs=step)


@pytest.mark.parametrize(
    ("crank", "coupler", "D", "side"), [(34, 90, (-10, -106), "beyond"), (20, 95, (-10, -106), "before")]
)
def test_synthesis_finds_the_links_again(
    tmp_path: Path, crank: float, coupler: float, D: tuple[float, float], side: str
) -> None:
    """From the swing and K that links give by their dead points, the synthesis finds these links."""
    frame, rocker = np.hypot(*D), 60.0
    at_D, at_B = [], []
    for reach in (coupler + crank, coupler - crank):
        at_D.append(np.arccos((frame**2 + rocker**2 - reach**2) / (2 * frame * rocker)))
        at_B.append(np.arccos((frame**2 + reach**2 - rocker**2) / (2 * frame * reach)))
    θ = np.degrees(abs(at_B[0] - at_B[1]))
    swing, K = np.degrees(at_D[0] - at_D[1]), (180 + θ) / (180 - θ)
    text = ASSIGNMENT.read_text(encoding="utf-8")
    for old, new in (
        ("  AB: 34 mm\n  AC: 90 mm\n", f"  swing: {{angle: {swing:.10f} deg, K: {K:.12f}, B: {side}}}\n"),
        ("force:", "# force:"),
    ):
        assert text.count(old) == 1
        text = text.replace(old, new)
    path = tmp_path / "swing.yaml"
    path.write_text(text, encoding="utf-8")
    sheet = api.analyse(api.load(path)).machine.calculation
    # K is typed to twelve places, and θ, a difference of nearly equal angles, loses two of them.
    assert sheet.si("l.BA") == pytest.approx(crank / 1e3, rel=1e-7)
    assert sheet.si("l.AC") == pytest.approx(coupler / 1e3, rel=1e-7)
