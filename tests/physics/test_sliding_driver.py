"""A linkage driven by a slider, as a whole assignment, against the independent witness and by energy."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import linkages as made
import numpy as np
import pytest
from agreement import prove

from reportgen import api
from reportgen.machine.analysis import Analysis, analyse
from reportgen.machine.load_laws import TravelLaw

FILE = Path(__file__).parents[2] / "assignments" / "linkage-slide.yaml"
WAYS, FORCES = (0.0, 0.06, 0.1, 0.12), (300.0, 380.0, 600.0, 900.0)
"""The file's table of the force on slider 5."""


@pytest.fixture(scope="module", params=["forwards", "backwards"])
def analysis(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Analysis:
    """The file at many positions; backwards the ram starts at the other end of its way."""
    text = FILE.read_text(encoding="utf-8").replace("count: 7", "count: 25")
    if request.param == "backwards":
        text = text.replace("start: 0 mm, end: 120 mm", "start: 120 mm, end: 0 mm")
    path = tmp_path_factory.mktemp("slide") / "slide.yaml"
    path.write_text(text, encoding="utf-8")
    return api.analyse(api.load(path))


def travelled(analysis: Analysis) -> np.ndarray:
    """The driver's way from its start (m)."""
    return np.abs(analysis.motion.driver - analysis.motion.driver[0])


def test_loads_are_those_of_the_file(analysis: Analysis) -> None:
    """The table over the way, from the file's own numbers; friction against the lever's rotation."""
    force, torque = analysis.applied
    assert force.force.imag == pytest.approx(np.interp(travelled(analysis), WAYS, FORCES), rel=1e-12)
    assert torque.couple == pytest.approx(-4 * np.sign(analysis.motion.links[3].omega), rel=1e-12)


def test_motion_reactions_and_effort_by_multipliers(analysis: Analysis) -> None:
    motion = analysis.motion
    poses = list(made.poses(motion))
    loads = [
        [
            (5, complex(0, np.interp(way, WAYS, FORCES)), complex(motion.points["F"].p[k]), 0.0),
            (3, 0j, poses[k][3][0], -4.0 * float(np.sign(motion.links[3].omega[k]))),
            (3, -60j, complex(motion.points["S3"].p[k]), 0.0),
            (5, -80j, complex(motion.points["F"].p[k]), 0.0),
        ]
        for k, way in enumerate(travelled(analysis))
    ]
    prove(analysis, *made.told(analysis.machine.linkage), poses, loads, turning=False)


def test_the_drivers_work_is_what_the_loads_take_and_the_links_gain(analysis: Analysis) -> None:
    """∫ P_cb ds by Simpson's rule between the table's corners, against −W and the energies at both ends."""
    machine, span = analysis.machine, WAYS[-1]
    work = 0.0
    for start, end in pairwise(WAYS):
        ways = np.linspace(start, end, 201)
        effort = analyse(machine, ways / span * 2 * np.pi).torque * machine.turn
        weights = np.ones(201)
        weights[1:-1:2], weights[2:-1:2] = 4, 2
        work += float(weights @ effort) * (end - start) / 600
    ends = analyse(machine, np.array([0.0, 2 * np.pi])).motion
    mass3, mass5, s3, f = 60 / 9.81, 80 / 9.81, ends.points["S3"], ends.points["F"]
    energy = mass3 * np.abs(s3.v) ** 2 / 2 + mass5 * np.abs(f.v) ** 2 / 2 + 0.04 * ends.links[3].omega ** 2
    energy = energy + 60 * s3.p.imag + 80 * f.p.imag
    turned = abs(float(ends.links[3].angle[1] - ends.links[3].angle[0]))
    by_ways = analyse(machine, np.linspace(0, 2 * np.pi, 12001))
    heights, pressed = by_ways.motion.points["F"].p.imag, np.interp(travelled(by_ways), WAYS, FORCES)
    resisted = float(np.sum((pressed[1:] + pressed[:-1]) / 2 * np.diff(heights)))
    # The trapezoidal sum errs by (Δs)² of 12 000 steps, far below 1e-7 of the work.
    assert work == pytest.approx(float(energy[1] - energy[0]) - resisted + 4 * turned, rel=1e-7)


def test_a_way_is_not_a_cycle() -> None:
    """At the end of the way the last value stands, not the first again."""
    law = TravelLaw((0.0, 0.1), (1.0, 5.0), 0.1)
    motion = api.analyse(api.load(FILE)).motion
    assert law.value(np.array([0.0, np.pi, 2 * np.pi]), motion) == pytest.approx([1, 3, 5])
    assert list(law.breaks(lambda angle: motion)) == pytest.approx([0, 2 * np.pi])
