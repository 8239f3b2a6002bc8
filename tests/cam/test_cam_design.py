"""Cams whose lengths are found: judged by the follower's own path, its normals taken from neighbouring places."""

from __future__ import annotations

import math
import warnings
from pathlib import Path

import numpy as np
import pytest

from reportgen.base.errors import Problem
from reportgen.base.records import replace
from reportgen.cam.case import CamCase
from reportgen.cam.inverse_design import CamLimits, least_oscillating
from reportgen.cam.motion_laws import FollowerMotion, law
from reportgen.cam.profile import Cam
from reportgen.cases import open_case
from reportgen.catalogue import examine
from tests.cam.test_cam_envelope import SMOOTH, carried, lifting
from tests.lanes import matrix

NEAR = 0.02
"""What neighbouring places miss of a pressure angle (degrees), and the least radius by the steps of a search."""
ROCKER = {
    "follower": "oscillating",
    "end": "roller",
    "psi_max": "15 deg",
    "arm": "132 mm",
    "a": "180 mm",
    "phases": "{rise: 72.58 deg, far: 0 deg, return: 72.58 deg}",
    "laws": "{rise: sine, return: sine}",
    "limits": "{rise: 40 deg, return: 50 deg}",
    "r0": "find",
}
FACE = {"end": "flat", "limits": "", "arm": ""}


def written(folder: Path, **changed: str) -> Path:
    """The file of a cam, what is changed to nothing left out."""
    rows = [f"  {key}: {value}" for key, value in {**ROCKER, **changed}.items() if value]
    file = folder / "a.yaml"
    file.write_text("\n".join(["kind: cam", "report: {language: en}", "parameters:", *rows]) + "\n", encoding="utf-8")
    return file


def told(file: Path) -> list[Problem]:
    """What `check` says of a file; a warning of a library is a fault of ours."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        return examine(file, "en")


def case_of(file: Path) -> CamCase:
    case = open_case(file, "en")
    assert isinstance(case, CamCase)
    return case


def pressure(cam: Cam) -> tuple[float, float, float]:
    """The largest α of the rise, the largest −α of the return, the largest size (degrees), without derivatives.

    From the way in which the follower lifts to the normal of its path in the cam's frame, in the sense of its rotation.
    """
    body = carried(cam)
    chord = np.roll(body.points, -1) - np.roll(body.points, 1)
    α = np.degrees(cam.turn * np.angle(1j * cam.turn * chord / lifting(cam, body.φ)))
    first, far, back, _ = cam.motion.phases
    rise, fall = α[body.φ < first], α[(body.φ > first + far) & (body.φ < first + far + back)]
    return float(rise.max()), float(-fall.min()), float(np.abs(np.concatenate((rise, fall))).max())


# --- the sense of an arm --------------------------------------------------------------------------


@pytest.mark.parametrize("seed", matrix(range(60), range(8)))
def test_the_least_cam_of_an_arm_is_that_of_a_search(seed: int) -> None:
    """In either sense the least ψ₀ reaches one limit, and less breaks it; where there is none, a search finds none."""
    rng = np.random.default_rng(seed)
    first, back = np.radians(rng.uniform(60, 120, 2))
    motion = FollowerMotion(
        math.radians(rng.uniform(8, 25)),
        (first, 0.2, back, 2 * math.pi - first - back - 0.2),
        law(rng.choice(SMOOTH)),
        law(rng.choice(SMOOTH)),
    )
    opposite, arm = 1 if seed % 2 else -1, 0.1
    a = float(rng.uniform(0.8, 1.8)) * arm
    limits = np.degrees(np.radians(rng.uniform(25, 60, 2)))
    if opposite < 0 and np.abs(motion(np.linspace(0, 6.28, 400))[1]).max() > 0.95:
        return

    def over(ψ0: float) -> float:
        """By how much the worst limit is passed (degrees)."""
        r0 = math.sqrt(a**2 + arm**2 - 2 * a * arm * math.cos(ψ0))
        cam = Cam(motion, False, False, r0, a=a, arm=arm, opposite=opposite)
        rise, fall, _ = pressure(cam)
        return float(max(rise - limits[0], fall - limits[1]))

    found = least_oscillating(motion, CamLimits(*np.radians(limits), 0.003), arm, opposite, a)
    if found is None:
        assert min(over(ψ0) for ψ0 in np.radians(np.arange(1, 179 - math.degrees(motion.stroke), 4))) > -NEAR
    else:
        assert over(found.psi0) == pytest.approx(0, abs=NEAR)
        assert over(found.psi0 - 0.02) > NEAR
        assert over(min(found.most, found.psi0 + 0.02)) <= NEAR


@pytest.mark.parametrize("lifts", ["with", "against"])
def test_a_found_cam_keeps_its_limits_in_either_sense(tmp_path: Path, lifts: str) -> None:
    """ψ 15°, l 132, a 180, sine 72.58°/72.58°, 40°/50°: r₀ 60 with the lift would reach 58.23° in the rise."""
    small = Cam(case_of(written(tmp_path)).solution.motion, False, False, 0.060, a=0.180, arm=0.132, opposite=-1)
    assert pressure(small)[0] == pytest.approx(58.23, abs=NEAR)
    file = written(tmp_path, lifts=lifts, direction="clockwise" if lifts == "with" else "anticlockwise")
    assert told(file) == []
    cam = case_of(file).solution.cam
    rise, fall, _ = pressure(cam)
    assert rise <= 40 + NEAR
    assert fall <= 50 + NEAR
    # The choice is the least one, rounded up to 5 mm: that much less breaks a limit.
    rise, fall, _ = pressure(replace(cam, r0=cam.r0 - 0.005))
    assert rise > 40 or fall > 50


def test_what_is_said_of_an_angle_is_so(tmp_path: Path) -> None:
    """With the lift r₀ 60 is warned of, with the angle that the path has, and where."""
    (warning,) = told(written(tmp_path, lifts="with", r0="60 mm", roller="10 mm"))
    assert warning.code == "cam-pressure"
    assert "58.2" in warning.message


# --- where no limit binds, and what cannot be ------------------------------------------------------

FREE = {"end": "knife", "psi_max": "4 deg", "limits": "{rise: 60 deg}"}


def test_a_limit_that_leaves_the_arm_free_is_no_hindrance(tmp_path: Path) -> None:
    """Nothing hinders an arm of 4°: the return decides, by the 80° that are usual with a spring; r₀ 60 passes, too."""
    assert told(written(tmp_path, **FREE, r0="60 mm")) == []
    file = written(tmp_path, **FREE)
    assert told(file) == []
    cam = case_of(file).solution.cam
    assert cam.r0 > abs(cam.a - cam.arm)
    assert max(pressure(cam)) <= 80
    assert max(pressure(replace(cam, r0=case_of(file).solution.designed.least.r0))) == pytest.approx(80, abs=NEAR)  # type: ignore[union-attr]


def test_an_offset_that_leaves_the_rise_free(tmp_path: Path) -> None:
    """An offset beyond c₁ by which s₀ is not bounded in the rise: the return decides in the same way."""
    follower = {"follower": "translating", "psi_max": "", "arm": "", "a": "", "h": "4 mm", "e": "30 mm"}
    file = written(tmp_path, **follower, limits="{rise: 60 deg}")
    assert told(file) == []
    cam = case_of(file).solution.cam
    assert cam.r0 > cam.e
    assert max(pressure(cam)) <= 80 + NEAR


@pytest.mark.parametrize("limits", ["{rise: 60 deg}", "{rise: 40 deg, return: 50 deg}"])
@pytest.mark.parametrize("lifts", ["with", "against"])
def test_the_best_distance_of_a_pivot(tmp_path: Path, lifts: str, limits: str) -> None:
    """A small swing whose best pivot is about an arm away, where r₀ is nearly |a − l|: found, and within its limits."""
    file = written(tmp_path, **FREE | {"limits": limits}, a="find", lifts=lifts)
    assert [one for one in told(file) if one.code != "cam-impact"] == []
    rise, fall, _ = pressure(case_of(file).solution.cam)
    assert rise <= (60 if "60" in limits else 40) + NEAR
    assert fall <= 80 + NEAR


def test_a_roller_that_finds_no_room_makes_the_cam_larger(tmp_path: Path) -> None:
    """Both sought: the least base circle by the limits is too sharp for 20 mm of curvature and a roller."""
    follower = {"follower": "translating", "psi_max": "", "arm": "", "a": "", "h": "40 mm", "e": "0 mm"}
    file = written(tmp_path, **follower, limits="{rise: 60 deg}", rho="20 mm", roller="find")
    assert told(file) == []
    cam = case_of(file).solution.cam
    assert cam.roller > 0
    assert cam.sampled().rho[cam.sampled().rho > 0].min() - cam.roller >= 0.020


def test_steep_angles_are_told_without_limits(tmp_path: Path) -> None:
    """An arm on a small base circle and no limits: the largest angle by its size, and where it is."""
    file = written(tmp_path, limits="", r0="52 mm", roller="5 mm", lifts="with")
    found = [one for one in told(file) if one.code == "cam-steep"]
    size = pressure(case_of(file).solution.cam)[2]
    assert size > 60
    said = [float(one.message.split("reaches ")[1].split("°")[0]) for one in found]
    assert max(said) == pytest.approx(size, abs=NEAR)
    assert [
        one for one in told(written(tmp_path, limits="", r0="90 mm", roller="5 mm")) if one.code == "cam-steep"
    ] == []


@pytest.mark.parametrize("psi", ["10 deg", "25 deg", "30 deg", "40 deg", "45 deg"])
def test_faces_that_swing_far(tmp_path: Path, psi: str) -> None:
    """A face is convex, or what hinders it is said; no division by zero on the way."""
    for lifts in ("with", "against"):
        file = written(tmp_path, **FACE, psi_max=psi, lifts=lifts)
        if not (found := told(file)):
            assert case_of(file).solution.cam.sampled().rho.min() >= 0.003
        else:
            assert {one.code for one in found} <= {"cam-overtakes", "cam-not-convex"}
