"""Springs as they are drawn: true to scale between their ends, held by the link that they turn, on page and sheet."""

from __future__ import annotations

import numpy as np
import pytest

import reportgen
from reportgen.case import MachineAnalysis
from reportgen.drawing import Hatch, Label, Polyline, style
from reportgen.drawing.animation import MovingBody, MovingVector
from reportgen.drawing.spring_drawings import OUTER, TEETH
from reportgen.formula import Symbol
from reportgen.page.motion_samples import Samples
from reportgen.report.context import ReportContext
from reportgen.report.mechanism_figures import scheme
from reportgen.sheets.plates import Sources, plates_of

TEXT = """
kind: four-bar
report: {language: en}
positions: {at: [50 deg, 110 deg, 200 deg]}
parameters:
  {AB: 120 mm, BC: 350 mm, CD: 300 mm, AD: 400 mm, omega1: 12 rad/s, m2: 5 kg, m3: 4 kg,
   E: {along: 150 mm, across: 60 mm},
   springs: [{link: 3, at: C, to: [300 mm, 420 mm], c: 4 N/mm, free: 90 mm},
             {link: 3, about: D, c: 5 N m/rad, free: 100 deg},
             {link: 2, at: E, to: {link: 1, at: B}, c: 2 kN/m, free: 100 mm}]}
"""


@pytest.fixture(scope="module")
def case() -> MachineAnalysis:
    found: MachineAnalysis = reportgen.open(TEXT).case
    return found


@pytest.fixture(scope="module")
def report(case: MachineAnalysis) -> ReportContext:
    return ReportContext(case)


def test_springs_of_the_scheme_are_as_long_as_they_are(report: ReportContext) -> None:
    """The scheme stands at the second position: between the ends lies l over the figure's own scale."""
    (scene,) = scheme(report).scenes
    lines = [item for item in scene.items if isinstance(item, Polyline) and len(item.points) == TEETH + 4]
    crank = next(abs(item.radius) for item in scene.items if getattr(item, "stroke", None) == style.THIN)
    scale = crank / 0.12
    lengths = [float(report.ledger[f"spring.l.{number}"].values[1]) for number in (1, 3)]
    drawn = [abs(line.points[-1] - line.points[0]) for line in lines]
    # The ledger's are measured on paper, to a hundredth of a millimetre.
    assert drawn == pytest.approx([length * scale for length in lengths], abs=0.02)
    labels = [item.content for item in scene.items if isinstance(item, Label)]
    assert {Symbol("c", "1"), Symbol("c", "2"), Symbol("c", "3")} <= {*labels}
    # The ground of the two pivots, and that of the place in the frame.
    assert sum(isinstance(item, Hatch) for item in scene.items) == 3


def test_a_torsion_spring_holds_its_link(case: MachineAnalysis) -> None:
    """On the page its outer end lies on DC at every sample, and a pulled spring runs from end to end."""
    samples = Samples(case)
    pane = samples.animation().panes[0]
    motion = samples.analysis.motion
    c, d = (motion.points[name].p for name in "CD")
    wound = next(
        item
        for item in pane.items
        if isinstance(item, MovingBody)
        and any(isinstance(part, Polyline) and len(part.points) > 40 for part in item.items)
    )
    assert wound.angle is not None
    assert np.exp(1j * wound.angle.values) == pytest.approx((c - d) / np.abs(c - d))
    outline = wound.items[0]
    assert isinstance(outline, Polyline)
    assert outline.points[-1] == pytest.approx(OUTER)
    lines = [item for item in pane.items if isinstance(item, MovingVector) and item.stroke == style.VISIBLE]
    assert len(lines) == 2 * (TEETH + 3)
    assert lines[0].start.values == pytest.approx(c * samples.scale)
    assert lines[TEETH + 2].end.values == pytest.approx((0.3 + 0.42j) * samples.scale)


def test_a_plate_shows_the_springs_and_no_curve_of_single_instants(
    case: MachineAnalysis, report: ReportContext
) -> None:
    """Machine and table of lengths; over a whole turn the curves of force and of torque stand with them."""
    plates = {plate.title: plate for plate in plates_of(Sources.of(case), "forces")}
    still = len(plates[report.words["plates"]["springs"]].scenes)
    assert report.words["plates"]["torque"] not in plates
    assert not [plate for plate in plates_of(Sources.of(case), "kinematics") if plate.layer == "curves"]
    turning = reportgen.open(TEXT.replace("at: [50 deg, 110 deg, 200 deg]", "count: 4")).case
    plates = {plate.title: plate for plate in plates_of(Sources.of(turning), "forces")}
    assert len(plates[report.words["plates"]["springs"]].scenes) == still + 2
    assert report.words["plates"]["torque"] in plates
