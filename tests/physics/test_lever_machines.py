"""Slotted lever and shaper of the catalogue, whole, against the independent witness.

The witness gets its bodies, joints, pose and loads from the numbers of the assignment alone; nothing of the
package under test but what it is to be compared with.
"""

from __future__ import annotations

import math

import newton_euler as ne
import numpy as np
import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

from reportgen import api
from reportgen.analysis import Analysis

AGREEMENT = 1e-9
"""Of each quantity's greatest size over the turn."""
CONDITION = 1e4
"""The Jacobian mixes metres and radians: small machines condition it worse, and ε·10⁴·10 is still 1e-11."""
quick = settings(max_examples=25, deadline=None, suppress_health_check=list(HealthCheck))

Pairs = dict[str, list[tuple[complex, complex]]]


def analysed(text: str, factory: pytest.TempPathFactory) -> Analysis:
    file = factory.mktemp("a") / "a.yaml"
    file.write_text(text)
    return api.analyse(api.load(file))


def lever_pose(r: float, d: float, up: complex, phi: float) -> tuple[complex, complex, float]:
    """The pin, the pivot and the lever's direction, from the triangle of crank and centres."""
    pin, pivot = r * np.exp(1j * phi), -d * up
    return complex(pin), complex(pivot), float(np.angle(pin - pivot))


def agree(pairs: Pairs) -> None:
    for name, found in pairs.items():
        greatest = max(abs(theirs) for _, theirs in found)
        assert max(abs(ours - theirs) for ours, theirs in found) <= AGREEMENT * greatest, name


@quick
@given(
    r=st.integers(20, 200),
    share=st.one_of(st.integers(20, 85), st.integers(115, 300)),  # r/d in %: near 1 the block meets the pivot
    axis=st.integers(-180, 180),
    n=st.integers(10, 3000),
    clockwise=st.booleans(),
)
def test_slotted_lever(
    tmp_path_factory: pytest.TempPathFactory, r: int, share: int, axis: int, n: int, clockwise: bool
) -> None:
    d = 100 * r / share
    lever = 1.1 * (r + d)
    analysis = analysed(
        f"kind: slotted-lever\npositions: {{count: 7, direction: {'clockwise' if clockwise else 'anticlockwise'}}}\n"
        f"parameters: {{AB: {r} mm, AC: {d} mm, CD: {lever} mm, axis: {axis} deg, n: {n} rpm}}\n",
        tmp_path_factory,
    )
    motion, pairs = analysis.motion, Pairs()
    joints: list[ne.Pin | ne.Slot] = [
        ne.Pin(0, 0j, 1, 0j),
        ne.Pin(1, complex(r / 1e3), 2, 0j),
        ne.Slot(3, 0j, 0.0, 2, 0j, 0.0),
        ne.Pin(0, -d / 1e3 * np.exp(1j * math.radians(axis)), 3, 0j),
    ]
    bodies = {link: ne.Body(0.0, 0.0, 0j) for link in (1, 2, 3)}
    for k in range(7):
        phi = float(motion.driver[k])
        pin, pivot, psi = lever_pose(r / 1e3, d / 1e3, np.exp(1j * math.radians(axis)), phi)
        pose = {1: (0j, phi), 2: (pin, psi), 3: (pivot, psi)}
        answer = ne.solve(bodies, joints, True, motion.rate, pose, [], CONDITION)
        assert answer is not None
        arm = lever / 1e3 * np.exp(1j * psi)
        omega, epsilon = answer.velocity[3][1], answer.acceleration[3][1]
        for name, ours, theirs in (
            ("p", motion.points["D"].p[k], pivot + arm),
            ("v", motion.points["D"].v[k], 1j * omega * arm),
            ("a", motion.points["D"].a[k], (1j * epsilon - omega**2) * arm),
            ("ω", motion.links[3].omega[k], omega),
            ("ε", motion.links[3].epsilon[k], epsilon),
            ("ω", motion.links[2].omega[k], answer.velocity[2][1]),
        ):
            pairs.setdefault(name, []).append((complex(ours), complex(theirs)))
    assert abs(math.remainder(analysis.motion.driver[0] - math.radians(axis), 2 * math.pi)) < AGREEMENT
    agree(pairs)


@quick
@given(
    a=st.integers(150, 400),
    swing=st.integers(10, 40),  # H/(2 l3) in %, the sine of the rocker's swing
    lift=st.integers(-50, 50),  # of the ram's line over the middle of D's arc, in % of l4
    n=st.integers(10, 300),
    clockwise=st.booleans(),
    force=st.integers(100, 5000),
    free=st.integers(0, 20),
    share=st.integers(1, 9),
)
def test_shaper(
    tmp_path_factory: pytest.TempPathFactory,
    a: int,
    swing: int,
    lift: int,
    n: int,
    clockwise: bool,
    force: int,
    free: int,
    share: int,
) -> None:
    l3, l4, sine = 2.0 * a, 0.5 * a, swing / 100
    stroke, l1 = 2 * l3 * sine, a * sine
    b = l3 * (1 + math.sqrt(1 - sine**2)) / 2 + lift / 100 * l4
    assume(l4 > 1.2 * max(l3 - b, b - l3 * math.sqrt(1 - sine**2)))
    analysis = analysed(
        f"kind: shaper\npositions: {{count: 7, direction: {'clockwise' if clockwise else 'anticlockwise'}}}\n"
        f"parameters: {{a: {a} mm, b: {b} mm, l3: {l3} mm, l4: {l4} mm, H: {stroke} mm, n: {n} rpm, "
        f"cutting: {{F: {force} N, free: {free / 100}}}, m2: 1.5 kg, G3: 200 N, s3: {share / 10}, J3: 0.9 kg m2, "
        f"m4: 4 kg, s4: 0.4, G5: 500 N, g: 9.7 m/s2}}\n",
        tmp_path_factory,
    )
    motion, reactions, pairs = analysis.motion, analysis.forces.reactions, Pairs()
    towards = -1.0 if clockwise else 1.0  # x against the working way
    angle = math.pi if clockwise else 0.0
    line = 1j * (b - a) / 1e3
    joints: list[ne.Pin | ne.Slot] = [
        ne.Pin(0, 0j, 1, 0j),
        ne.Pin(1, complex(l1 / 1e3), 2, 0j),
        ne.Slot(3, 0j, 0.0, 2, 0j, 0.0),
        ne.Pin(0, -1j * a / 1e3, 3, 0j),
        ne.Pin(3, complex(l3 / 1e3), 4, 0j),
        ne.Pin(4, complex(l4 / 1e3), 5, 0j),
        ne.Slot(0, line, angle, 5, 0j, angle),
    ]
    masses = {2: 1.5, 3: 200 / 9.7, 4: 4.0, 5: 500 / 9.7}
    centres = {2: 0j, 3: complex(share / 10 * l3 / 1e3), 4: complex(0.4 * l4 / 1e3), 5: 0j}
    moments = {2: 0.0, 3: 0.9, 4: 4 * (l4 / 1e3) ** 2 / 12, 5: 0.0}
    bodies = {1: ne.Body(0.0, 0.0, 0j)}
    bodies |= {link: ne.Body(masses[link], moments[link], centres[link]) for link in masses}
    half, theta = stroke / 2e3, math.asin(sine)
    for k in range(7):
        phi = float(motion.driver[k])
        pin, pivot, psi = lever_pose(l1 / 1e3, a / 1e3, 1j, phi)
        end = pivot + l3 / 1e3 * np.exp(1j * psi)
        rise = (line - end).imag
        drop = math.sqrt((l4 / 1e3) ** 2 - rise**2)
        ram = complex(end.real - towards * drop, line.imag)
        pose = {1: (0j, phi), 2: (pin, psi), 3: (pivot, psi), 4: (end, float(np.angle(ram - end))), 5: (ram, angle)}
        # From the beginning of the stroke: D stands at +half there, and E as far from D as it does at its end.
        first = half - math.sqrt((l4 / 1e3) ** 2 - ((b - l3 * math.cos(theta)) / 1e3) ** 2)
        done = (first - towards * ram.real) / (2 * half)
        works = math.cos(phi - math.pi / 2) > -math.sin(theta)
        cut = force if works and free / 100 <= done <= 1 - free / 100 else 0.0
        loads = [(5, cut * towards, ram, 0.0)]
        for link, mass in masses.items():
            at = pose[link][0] + centres[link] * np.exp(1j * pose[link][1])
            loads.append((link, -1j * mass * 9.7, complex(at), 0.0))
        answer = ne.solve(bodies, joints, True, motion.rate, pose, loads, CONDITION)
        assert answer is not None
        found = [
            ("p", motion.points["E"].p[k], ram),
            ("v", motion.points["E"].v[k], answer.velocity[5][0]),
            ("a", motion.points["E"].a[k], answer.acceleration[5][0]),
            ("M", analysis.torque[k], answer.effort),
            ("M", analysis.torque_by_work[k], answer.effort),
        ]
        for link in (3, 4):
            found.append(("ω", motion.links[link].omega[k], answer.velocity[link][1]))
            found.append(("ε", motion.links[link].epsilon[k], answer.acceleration[link][1]))
        for name, (wrench, _) in zip(("01", "12", "32", "03", "34", "45", "05"), answer.wrenches, strict=True):
            found.append(("R", reactions[f"R{name}"].force[k], wrench))
        for name, ours, theirs in found:
            pairs.setdefault(name, []).append((complex(ours), complex(theirs)))
    agree(pairs)
