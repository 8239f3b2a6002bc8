"""Slider-crank and single-cylinder engine of the catalogue, whole, against the independent witness.

The witness gets its bodies, joints, pose and loads from the numbers of the assignment alone; nothing of the
package under test but what it is to be compared with.
"""

from __future__ import annotations

import math

import newton_euler as ne
import numpy as np
import pytest
from agreement import Acting, Pose, prove, weights
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from reportgen import api
from reportgen.machine.analysis import Analysis

quick = settings(max_examples=25, deadline=None, suppress_health_check=list(HealthCheck))


def tenths(first: int, last: int) -> st.SearchStrategy[float]:
    return st.integers(first, last).map(lambda n: n / 10)


def machine(
    analysis: Analysis,
    *,
    r: float,
    rod: float,
    centre: float,
    guide: complex,
    at: complex,
    masses: dict[int, float],
    moment: float,
    gravity: float,
    loads: list[float],
) -> None:
    """Compare all positions; `loads` are the forces (N) on the slider along `guide` at each of them."""
    bodies = {
        1: ne.Body(masses.get(1, 0.0), 0.0, 0j),
        2: ne.Body(masses.get(2, 0.0), moment, complex(centre)),
        3: ne.Body(masses.get(3, 0.0), 0.0, 0j),
    }
    angle = float(np.angle(guide))
    joints: list[ne.Pin | ne.Slot] = [
        ne.Pin(0, 0j, 1, 0j),
        ne.Pin(1, complex(r), 2, 0j),
        ne.Pin(2, complex(rod), 3, 0j),
        ne.Slot(0, at, angle, 3, 0j, angle),
    ]
    poses: list[Pose] = []
    acting: list[list[Acting]] = []
    for phi, force in zip(map(float, analysis.motion.driver), loads, strict=True):
        pin = r * np.exp(1j * phi)
        # The slider's place by Pythagoras along the guide, the rod's direction from both.
        foot = at + guide * (np.conj(guide) * (pin - at)).real
        slider = complex(foot + guide * math.sqrt(rod**2 - abs(pin - foot) ** 2))
        poses.append({1: (0j, phi), 2: (complex(pin), float(np.angle(slider - pin))), 3: (slider, angle)})
        acting.append([(3, force * guide, slider, 0.0), *weights(bodies, poses[-1], -1j * gravity)])
    prove(analysis, bodies, joints, ["R01", "R12", "R23", "R03"], poses, acting)


@quick
@given(
    r=tenths(500, 3000),
    slack=tenths(13, 50),  # l over r + |e|: nearer to 1 the rod comes near square to the guide
    e=tenths(-2000, 2000),
    guide=st.integers(-180, 180),
    n=tenths(300, 30000),
    clockwise=st.booleans(),
    force=tenths(-9000, 9000),
    share=tenths(1, 9),
)
def test_slider_crank(
    tmp_path_factory: pytest.TempPathFactory,
    r: float,
    slack: float,
    e: float,
    guide: int,
    n: float,
    clockwise: bool,
    force: float,
    share: float,
) -> None:
    rod = slack * (r + abs(e))
    text = (
        f"kind: slider-crank\npositions: {{count: 7, direction: {'clockwise' if clockwise else 'anticlockwise'}}}\n"
        f"parameters: {{r: {r} mm, l: {rod} mm, e: {e} mm, guide: {guide} deg, n: {n} rpm, s: {share}, "
        f"m2: 3 kg, G3: 50 N, J2: 0.2 kg m2, g: 9.7 m/s2, force: {{by: constant, F: {force} N}}}}\n"
    )
    file = tmp_path_factory.mktemp("a") / "a.yaml"
    file.write_text(text)
    along = complex(np.exp(1j * math.radians(guide)))
    machine(
        api.analyse(api.load(file)),
        r=r / 1e3,
        rod=rod / 1e3,
        centre=share * rod / 1e3,
        guide=along,
        at=1j * along * e / 1e3,
        masses={2: 3.0, 3: 50 / 9.7},
        moment=0.2,
        gravity=9.7,
        loads=[force] * 7,
    )


@quick
@given(
    stroke=st.integers(60, 500),
    ratio=st.integers(1005, 1120),
    share=tenths(1, 8),
    n=tenths(3000, 30000),
    clockwise=st.booleans(),
    peak=st.integers(50, 400),
)
def test_engine_single(
    tmp_path_factory: pytest.TempPathFactory,
    stroke: int,
    ratio: int,
    share: float,
    n: float,
    clockwise: bool,
    peak: int,
) -> None:
    """The offset is a tenth to most of what the travel times allow; R and L come from a plain triangle."""
    theta = math.pi * (ratio / 1e3 - 1) / (ratio / 1e3 + 1)
    offset = share * 0.4 * stroke
    text = (
        f"kind: engine-single\npositions: {{count: 6, direction: {'clockwise' if clockwise else 'anticlockwise'}}}\n"
        f"parameters: {{H: {stroke} mm, e: {offset} mm, K: {ratio / 1e3}, D: 100 mm, n: {n} rpm, s: 0.4, "
        f"G1: 30 N, G2: 20 N, G3: 25 N, rho: 0.2}}\n"
        f"indicator: {{by: crank_angle, unit: N/cm2, angle: [0 deg, 300 deg, 400 deg, 720 deg], "
        f"p: [0, -1, {peak}, 2]}}\n"
    )
    file = tmp_path_factory.mktemp("a") / "a.yaml"
    file.write_text(text)
    # Product and sum of squares of the triangle's sides L + R and L − R, as roots of a quadratic.
    product = stroke * offset / math.sin(theta)
    squares = stroke**2 + 2 * product * math.cos(theta)
    outer = math.sqrt((squares + math.sqrt(squares**2 - 4 * product**2)) / 2)
    inner = product / outer
    analysis = api.analyse(api.load(file))
    rod = (outer + inner) / 2e3
    pressure = np.interp(np.degrees(analysis.cycle_angle), [0, 300, 400, 720], [0, -1e4, peak * 1e4, 2e4])
    machine(
        analysis,
        r=(outer - inner) / 2e3,
        rod=rod,
        centre=0.4 * rod,
        guide=1j,
        at=complex(offset / 1e3 if clockwise else -offset / 1e3),
        masses={1: 30 / 9.8, 2: 20 / 9.8, 3: 25 / 9.8},
        moment=20 / 9.8 * (0.2 * rod) ** 2,
        gravity=9.8,
        loads=list(-pressure * math.pi / 4 * 0.01),
    )
