"""The machines of the atlas against a witness that closes their joints itself, and against figures set for them."""

from __future__ import annotations

import math
import random
from pathlib import Path

import agreement
import linkages as made
import newton_euler as ne
import numpy as np
import pytest

from reportgen import api, catalogue
from reportgen.base.arrays import Complexes, Floats
from reportgen.base.atlas_words import machine_source
from reportgen.base.template_folders import atlas_files
from reportgen.base.yaml_source import plain, read_text
from reportgen.machine.analysis import Analysis
from reportgen.machine.kinematics import Motion, solve_motion

MACHINES = sorted(kind.partition("/")[2] for kind in atlas_files())
MISPLACED = 1e-3
"""How far (m, rad) the witness starts from the pose that it looks for."""
STEP = 1e-30
"""Of a complex step, which has no rounding error."""
PLACES = 7200


def analysis(name: str) -> Analysis:
    """The analysis of a machine's sample."""
    return api.analyse(api.load(min(catalogue.examples(f"atlas/{name}").values())))


def given(name: str) -> dict[str, float]:
    """The parameters of a machine's sample (SI)."""
    parameters = api.load(min(catalogue.examples(f"atlas/{name}").values())).parameters
    return {key: value.si for key, value in parameters if hasattr(value, "si")}


def turned(name: str) -> Motion:
    """The motion of a machine at many places of a turn from position 1."""
    machine = analysis(name).machine
    angle = np.linspace(0.0, 2 * np.pi, PLACES, endpoint=False)
    return solve_motion(machine.linkage, machine.angles(angle), machine.turn * machine.speed)


# --- the witness ----------------------------------------------------------------------------------


def gaps(joints: list[ne.Pin | ne.Slot], q: Complexes, column: dict[int, int], angle: float) -> Complexes:
    """Return how far the joints stand open at coordinates x, y, θ of each body; the driver comes last."""

    def turn(body: int) -> complex:
        return complex(q[column[body] + 2]) if body else 0j

    def place(body: int, local: complex) -> tuple[complex, complex]:
        c, s = np.cos(turn(body)), np.sin(turn(body))
        x, y = q[column[body] : column[body] + 2] if body else (0j, 0j)
        return x + c * local.real - s * local.imag, y + s * local.real + c * local.imag

    rows: list[complex] = []
    for joint in joints:
        (xa, ya), (xb, yb) = place(joint.a, complex(joint.local_a)), place(joint.b, complex(joint.local_b))
        if isinstance(joint, ne.Pin):
            rows += [xb - xa, yb - ya]
        else:
            along = turn(joint.a) + joint.angle
            apart = turn(joint.b) - turn(joint.a) - joint.turn
            rows += [np.cos(along) * (yb - ya) - np.sin(along) * (xb - xa), np.sin(apart)]
    return np.array([*rows, turn(1) - angle])


def closed(
    joints: list[ne.Pin | ne.Slot], near: dict[int, tuple[complex, float]], angle: float
) -> dict[int, tuple[complex, float]]:
    """The pose near another one in which the joints are closed, by Newton's method with complex steps."""
    column = {body: 3 * k for k, body in enumerate(sorted(near))}
    q = np.array([value for body in sorted(near) for value in (near[body][0].real, near[body][0].imag, near[body][1])])
    q = q + MISPLACED * np.cos(np.arange(q.size))
    for _ in range(8):
        steps = q + 1j * STEP * np.eye(q.size)
        jacobian = np.array([gaps(joints, row, column, angle).imag / STEP for row in steps]).T
        q = q - np.linalg.solve(jacobian, gaps(joints, q.astype(complex), column, angle).real)
    return {body: (complex(q[k], q[k + 1]), float(q[k + 2])) for body, k in column.items()}


@pytest.mark.parametrize("name", MACHINES)
def test_a_machine_moves_and_is_loaded_as_the_witness_says(name: str) -> None:
    """Places, velocities, accelerations, reactions and the balancing torque to 1e-9, by equilibrium and by work."""
    found = analysis(name)
    bodies, joints, keys = made.told(found.machine.linkage)
    angles = found.motion.driver
    poses = [closed(joints, pose, float(angles[k])) for k, pose in enumerate(made.poses(found.motion))]
    gravity = found.machine.linkage.gravity
    assert gravity == -9.81j
    applied = [
        [(one.link, complex(one.force[k]), complex(one.point[k]), float(one.couple[k])) for one in found.applied]
        for k in range(len(poses))
    ]
    loads = [[*agreement.weights(bodies, pose, gravity), *acting] for pose, acting in zip(poses, applied, strict=True)]
    agreement.prove(found, bodies, joints, keys, poses, loads)
    # The driver works: the loads oppose the motion over the cycle.
    assert float(np.mean(found.torque)) * found.machine.turn > 0


@pytest.mark.parametrize("name", MACHINES)
def test_a_machine_turns_at_the_corners_of_its_bounds(name: str) -> None:
    """All parameters are at an end of their bounds, in some of the combinations; the loads take work in a cycle."""
    kind, chance = f"atlas/{name}", random.Random(name)
    top = machine_source(atlas_files()[kind]).top
    assert top is not None
    bounds = plain(top)["parameters"]
    for number in range(6):
        corner = {key: about[chance.choice(("least", "most"))] for key, about in bounds.items()}
        text = f"kind: {kind}\nparameters: {{{', '.join(f'{key}: {value}' for key, value in corner.items())}}}\n"
        assignment, faults = catalogue.understood(read_text(text), Path("x.yaml"))
        assert faults == [], corner
        if number < 3 and assignment is not None:
            run = api.analyse(assignment)
            assert not run.applied or run.summary.work < 0, corner


# --- figures set for the machines -----------------------------------------------------------------


def stroke(way: Floats) -> float:
    return float(np.ptp(way))


def longer_part(way: Floats) -> float:
    """The time ratio of a to-and-fro motion: the longer stroke over the shorter one."""
    first = abs(int(np.argmax(way)) - int(np.argmin(way))) / PLACES
    return max(first, 1 - first) / min(first, 1 - first)


def test_the_six_link_press_has_its_stroke_and_swing() -> None:
    """Its lengths, to 0.1 mm, are computed from H = 150 mm and a lever that swings 30° to both sides."""
    motion = turned("six-link-press")
    assert stroke(motion.points["D"].p.imag) == pytest.approx(0.150, abs=2e-4)
    angle = np.degrees(motion.links[3].angle)
    assert (angle.min(), angle.max()) == pytest.approx((-30, 30), abs=0.6)


def test_the_slotter_has_its_stroke_and_time_ratio() -> None:
    """r = O1O2·sin 30° makes K = 2, and O2B = H makes H = 100 mm, as the arm swings 30° to both sides."""
    way = turned("slotter-lever").points["C"].p.imag
    assert stroke(way) == pytest.approx(0.100, abs=1e-6)
    assert longer_part(way) == pytest.approx(2.0, abs=2e-3)


def test_whitworths_quick_return_has_its_closed_form() -> None:
    q, way = given("slotter-whitworth"), turned("slotter-whitworth").points["C"].p.imag
    half = math.acos(q["O1O2"] / q["O1A"])
    assert stroke(way) == pytest.approx(2 * q["O2B"], rel=1e-6)
    assert longer_part(way) == pytest.approx((math.pi - half) / half, rel=2e-3)


def test_chebyshevs_foot_is_straight_for_half_a_turn() -> None:
    """The foot stays within 1 % of the straight way and meets its mean line six times, as published of his linkage."""
    q, foot = given("walking-mechanism"), turned("walking-mechanism").points["C"].p
    half = foot[: PLACES // 2 + 1]
    assert np.ptp(half.imag) < 0.01 * np.ptp(half.real)
    assert np.ptp(half.real) == pytest.approx(4 * q["O1A"])
    assert foot.imag.max() > half.imag.max() + 0.8 * q["O1A"]
    middle = (half.imag.max() + half.imag.min()) / 2
    assert np.count_nonzero(np.diff(np.sign(foot.imag - middle))) == 6


def test_the_pump_jack_lifts_by_its_arc() -> None:
    q, angle = given("pump-jack"), turned("pump-jack").links[3].angle
    between = math.hypot(2.440, 2.970)

    def at(reach: float) -> float:
        return math.acos((q["O2B"] ** 2 + between**2 - reach**2) / (2 * q["O2B"] * between))

    swing = at(q["AB"] + q["O1A"]) - at(q["AB"] - q["O1A"])
    assert np.ptp(np.unwrap(angle)) == pytest.approx(swing, rel=1e-6)


def test_the_slide_of_the_drawing_press_rests_for_a_sixth_of_a_turn() -> None:
    way = turned("drawing-press").points["C"].p.imag
    assert np.count_nonzero(way < way.min() + 0.01 * stroke(way)) > PLACES / 6


def test_strokes_and_swings_have_their_closed_forms() -> None:
    q = given("hacksaw")
    ends = [math.sqrt((q["AB"] + sign * q["O1A"]) ** 2 - q["e"] ** 2) for sign in (1, -1)]
    assert stroke(turned("hacksaw").points["B"].p.real) == pytest.approx(ends[0] - ends[1], rel=1e-6)
    pump, motion = given("v-pump"), turned("v-pump")
    assert stroke(np.abs(motion.points["B"].p)) == pytest.approx(2 * pump["O1A"], rel=1e-6)
    wiper = turned("wiper")
    assert wiper.links[3].angle == pytest.approx(wiper.links[5].angle, abs=1e-12)
    sieve = np.unwrap(turned("sieve").links[3].angle)
    assert np.ptp(sieve) > 2 * np.pi - 0.01
