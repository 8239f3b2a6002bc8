"""Four-bar linkage, six-link lever mechanism and slotted lever, whole, against the independent witness.

The witness gets bodies, joints, pose and loads from the numbers of the assignment alone; places come from
circles met by a formula of its own.
"""

from __future__ import annotations

import cmath
import math
from pathlib import Path

import newton_euler as ne
import pytest
from agreement import Acting, Pose, prove, weights
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

from reportgen import api
from reportgen.machine.analysis import Analysis

GRAVITY = -9.81j
quick = settings(max_examples=25, deadline=None, suppress_health_check=list(HealthCheck))


def whole(first: int, last: int) -> st.SearchStrategy[int]:
    return st.integers(first, last)


def meeting(p: complex, to_p: float, t: complex, to_t: float, side: int) -> complex:
    """The point at given distances from p and t, on the left (+1) or right of the way from p to t."""
    way = t - p
    angle = math.acos((to_p**2 + abs(way) ** 2 - to_t**2) / (2 * to_p * abs(way)))
    return p + cmath.rect(to_p, cmath.phase(way) + side * angle)


def solved(folder: Path, text: str) -> Analysis:
    file = folder / "a.yaml"
    file.write_text(text)
    assume(not api.check(file))
    return api.analyse(api.load(file))


@quick
@given(
    crank=whole(20, 80),
    coupler=whole(100, 300),
    output=whole(100, 300),
    frame=whole(100, 300),
    speed=whole(1, 40),
    crossed=st.booleans(),
    clockwise=st.booleans(),
    torque=whole(0, 30),
    force=whole(0, 400),
)
def test_four_bar(
    tmp_path_factory: pytest.TempPathFactory,
    crank: int,
    coupler: int,
    output: int,
    frame: int,
    speed: int,
    crossed: bool,
    clockwise: bool,
    torque: int,
    force: int,
) -> None:
    lengths = sorted((crank, coupler, output, frame))
    # Not within a tenth of a change point, where rates run away.
    assume(lengths[0] + lengths[3] < 0.9 * (lengths[1] + lengths[2]))
    branch, direction = "crossed" if crossed else "open", "clockwise" if clockwise else "anticlockwise"
    analysis = solved(
        tmp_path_factory.mktemp("four"),
        f"kind: four-bar\npositions: {{count: 7, start: 10 deg, direction: {direction}}}\nparameters:\n"
        f"  {{AB: {crank} mm, BC: {coupler} mm, CD: {output} mm, AD: {frame} mm, frame: -20 deg,"
        f" branch: {branch}, omega1: {speed} rad/s, E: {{along: 50 mm, across: 30 mm}},"
        f" m1: 1 kg, m2: 2 kg, m3: 3 kg, s1: 0.25, s2: 0.6, J3: 0.02 kg m2,"
        f" torque: {{M: {torque} N m, sense: clockwise}}, force: {{P: {force} N, angle: 120 deg}}}}\n",
    )
    r, c, o, f = (length / 1000 for length in (crank, coupler, output, frame))
    fixed = cmath.rect(f, math.radians(-20))
    bodies = {
        1: ne.Body(1.0, r**2 / 12, complex(0.25 * r)),
        2: ne.Body(2.0, 2 * c**2 / 12, complex(0.6 * c)),
        3: ne.Body(3.0, 0.02, complex(o / 2)),
    }
    joints: list[ne.Pin | ne.Slot] = [
        ne.Pin(0, 0j, 1, 0j),
        ne.Pin(1, complex(r), 2, 0j),
        ne.Pin(2, complex(c), 3, complex(o)),
        ne.Pin(0, fixed, 3, 0j),
    ]
    poses: list[Pose] = []
    loads: list[list[Acting]] = []
    for phi in map(float, analysis.motion.driver):
        pin = cmath.rect(r, phi)
        joint = meeting(pin, c, fixed, o, -1 if crossed else 1)
        poses.append({1: (0j, phi), 2: (pin, cmath.phase(joint - pin)), 3: (fixed, cmath.phase(joint - fixed))})
        push = cmath.rect(force, math.radians(120))
        loads.append([(3, 0j, fixed, -float(torque)), (3, push, joint, 0.0)])
    loads = [acting + weights(bodies, pose, GRAVITY) for pose, acting in zip(poses, loads, strict=True)]
    prove(analysis, bodies, joints, ["R01", "R12", "R23", "R03"], poses, loads)


@quick
@given(
    crank=whole(25, 40),
    coupler=whole(85, 100),
    rocker=whole(55, 75),
    rod=whole(100, 140),
    place=whole(10, 60),
    speed=whole(5, 100),
    clockwise=st.booleans(),
    force=whole(-500, 500),
)
@pytest.mark.proof
def test_lever_six_bar(
    tmp_path_factory: pytest.TempPathFactory,
    crank: int,
    coupler: int,
    rocker: int,
    rod: int,
    place: int,
    speed: int,
    clockwise: bool,
    force: int,
) -> None:
    direction, sense = "clockwise" if clockwise else "anticlockwise", "right" if force >= 0 else "left"
    analysis = solved(
        tmp_path_factory.mktemp("six"),
        f"kind: lever-six-bar\npositions: {{count: 7, direction: {direction}}}\nparameters:\n"
        f"  {{AB: {crank} mm, AC: {coupler} mm, CD: {rocker} mm, CE: {place} mm, EF: {rod} mm,"
        f" D: {{x: -10 mm, y: -106 mm}}, guide: -73 mm, omega1: {speed} rad/s,"
        f" m1: 1 kg, m2: 2 kg, m3: 1.5 kg, m4: 0.5 kg, m5: 3 kg, s4: 0.3,"
        f" force: {{P: {abs(force)} N, sense: {sense}}}}}\n",
    )
    b, c, d, f = (length / 1000 for length in (crank, coupler, rocker, rod))
    e = c - place / 1000
    fixed, height = complex(-0.010, -0.106), -0.073
    bodies = {
        1: ne.Body(1.0, b**2 / 12, complex(b / 2)),
        2: ne.Body(2.0, 2 * c**2 / 12, complex(c / 2)),
        3: ne.Body(1.5, 1.5 * d**2 / 12, complex(d / 2)),
        4: ne.Body(0.5, 0.5 * f**2 / 12, complex(0.3 * f)),
        5: ne.Body(3.0, 0.0, 0j),
    }
    joints: list[ne.Pin | ne.Slot] = [
        ne.Pin(0, 0j, 1, 0j),
        ne.Pin(1, complex(b), 2, 0j),
        ne.Pin(2, complex(c), 3, complex(d)),
        ne.Pin(0, fixed, 3, 0j),
        ne.Pin(2, complex(e), 4, 0j),
        ne.Pin(4, complex(f), 5, 0j),
        ne.Slot(0, 1j * height, 0.0, 5, 0j, 0.0),
    ]
    poses: list[Pose] = []
    loads: list[list[Acting]] = []
    for phi in map(float, analysis.motion.driver):
        pin = cmath.rect(b, phi)
        joint = meeting(pin, c, fixed, d, 1)
        on_coupler = pin + (joint - pin) * e / c
        slider = complex(on_coupler.real - math.sqrt(f**2 - (height - on_coupler.imag) ** 2), height)
        poses.append(
            {
                1: (0j, phi),
                2: (pin, cmath.phase(joint - pin)),
                3: (fixed, cmath.phase(joint - fixed)),
                4: (on_coupler, cmath.phase(slider - on_coupler)),
                5: (slider, 0.0),
            }
        )
        loads.append([(5, complex(force), slider, 0.0)])
    loads = [acting + weights(bodies, pose, GRAVITY) for pose, acting in zip(poses, loads, strict=True)]
    prove(analysis, bodies, joints, ["R01", "R12", "R23", "R03", "R24", "R45", "R05"], poses, loads)


@quick
@given(
    crank=whole(20, 120),
    apart=whole(60, 160),
    speed=whole(1, 40),
    clockwise=st.booleans(),
    torque=whole(-30, 30),
    share=whole(1, 9),
)
def test_slotted_lever(
    tmp_path_factory: pytest.TempPathFactory,
    crank: int,
    apart: int,
    speed: int,
    clockwise: bool,
    torque: int,
    share: int,
) -> None:
    """Swinging (AB < AC) and turning right round; not within a tenth of the pin that meets the pivot."""
    assume(abs(crank - apart) > 0.1 * apart)
    direction, sense = "clockwise" if clockwise else "anticlockwise", "anticlockwise" if torque >= 0 else "clockwise"
    analysis = solved(
        tmp_path_factory.mktemp("lever"),
        f"kind: slotted-lever\npositions: {{count: 7, start: 10 deg, direction: {direction}}}\nparameters:\n"
        f"  {{AB: {crank} mm, AC: {apart} mm, CD: 300 mm, omega1: {speed} rad/s, m2: 0.5 kg, m3: 3 kg,"
        f" s3: 0.{share}, J3: 0.03 kg m2, torque: {{M: {abs(torque)} N m, sense: {sense}}}}}\n",
    )
    r, pivot = crank / 1000, -1j * apart / 1000
    bodies = {1: ne.Body(0.0, 0.0, 0j), 2: ne.Body(0.5, 0.0, 0j), 3: ne.Body(3.0, 0.03, complex(0.3 * share / 10))}
    joints: list[ne.Pin | ne.Slot] = [
        ne.Pin(0, 0j, 1, 0j),
        ne.Pin(1, complex(r), 2, 0j),
        ne.Slot(3, 0j, 0.0, 2, 0j, 0.0),
        ne.Pin(0, pivot, 3, 0j),
    ]
    poses: list[Pose] = []
    loads: list[list[Acting]] = []
    for phi in map(float, analysis.motion.driver):
        pin = cmath.rect(r, phi)
        lean = cmath.phase(pin - pivot)
        poses.append({1: (0j, phi), 2: (pin, lean), 3: (pivot, lean)})
        loads.append([(3, 0j, pivot, float(torque))])
    loads = [acting + weights(bodies, pose, GRAVITY) for pose, acting in zip(poses, loads, strict=True)]
    prove(analysis, bodies, joints, ["R01", "R12", "R32", "R03"], poses, loads)
