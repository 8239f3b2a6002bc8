"""Cams of textbooks, and the laws by their largest values: reference figures to the digits printed."""

from __future__ import annotations

import math

import numpy as np
import pytest

from reportgen.cam.inverse_design import CamLimits, least_oscillating, least_translating
from reportgen.cam.motion_laws import LAWS, AccelerationGraph, FollowerLaw, FollowerMotion, evaluated, law
from reportgen.cam.profile import Cam

MM = 1e-3
LARGEST = {
    # V, A: of S(x), V(x), A(x) over x = φ/Φ
    "uniform": (1.0, 0.0),
    "parabolic": (2.0, 4.0),
    "cosine": (1.5708, 4.9348),
    "sine": (2.0, 6.2832),
    "3-4-5": (1.875, 5.7735),
    "4-5-6-7": (2.1875, 7.5132),
    "trapezoidal": (2.0, 5.3333),
}


def degrees(*angles: float) -> tuple[float, ...]:
    return tuple(math.radians(one) for one in angles)


def motion(stroke: float, phases: tuple[float, ...], rise: str, back: str) -> FollowerMotion:
    first, far, behind = degrees(*phases)
    return FollowerMotion(stroke, (first, far, behind, 2 * math.pi - first - far - behind), law(rise), law(back))


def worst(cam: Cam, phase: str, sign: int) -> tuple[float, float]:
    """Angle of the cam and ±α there, in degrees."""
    numbers = [n for n, one in enumerate(cam.motion.intervals) if one.phase == phase]
    φ, α = max((cam.worst(n, lambda one: sign * one.alpha) for n in numbers), key=lambda one: one[1])
    return math.degrees(φ), math.degrees(α)


@pytest.mark.parametrize("name", LAWS)
def test_the_laws(name: str) -> None:
    """Each ends at 1 from 0, has its published largest values, and each of its formulas is the next one's integral."""
    x = np.linspace(0, 1, 20001)
    S, V, A = law(name)(x)
    assert S[[0, -1]].tolist() == pytest.approx([0, 1], abs=1e-12)
    assert (np.abs(V).max(), np.abs(A).max()) == pytest.approx(LARGEST[name], abs=1e-4)
    for piece in law(name).pieces:
        inside = np.linspace(piece.start, piece.stop, 1001)[1:-1]
        for of, rate in ((piece.S, piece.V), (piece.V, piece.A)):
            # A step of 1e-5 leaves the difference quotient wrong by its square.
            slope = (evaluated(of, inside + 1e-5) - evaluated(of, inside - 1e-5)) / 2e-5
            assert slope == pytest.approx(evaluated(rate, inside), abs=1e-6)


def test_a_graph_of_acceleration_is_integrated_twice() -> None:
    """Accelerated by 3 over 0.4, decelerated by 2 over 0.6: V = 2 at the corner, A = 5 and −10/3."""
    one = FollowerLaw("table", AccelerationGraph(np.array([0, 0.4, 0.4, 1]), np.array([3.0, 3, -2, -2])))
    S, V, A = one(np.array([0.2, 0.4, 0.7, 1.0]))
    assert S.tolist() == pytest.approx([0.1, 0.4, 0.85, 1.0])
    assert V.tolist() == pytest.approx([1.0, 2.0, 1.0, 0.0], abs=1e-12)
    assert A.tolist() == pytest.approx([5.0, -10 / 3, -10 / 3, -10 / 3])


def test_C1_eccentric_circle() -> None:
    """2 in by a cosine 180°/180° on a prime circle of 2 in: r = 3 − cos φ; sin α = 1/3, ρ = 2√2 at cos φ = 1/3."""
    cam = Cam(motion(2, (180, 0, 180), "cosine", "cosine"), True, False, 2.0, roller=0.375)
    assert worst(cam, "rise", 1) == pytest.approx((math.degrees(math.acos(1 / 3)), 19.471), abs=5e-4)
    φ = np.linspace(0, 2 * math.pi, 73)
    assert np.abs(cam.profile_at(φ).pitch) == pytest.approx(3 - np.cos(φ))
    at = cam.profile_at(np.array([math.acos(1 / 3)]))
    assert at.rho[0] == pytest.approx(2 * math.sqrt(2))
    assert at.rho[0] - cam.roller == pytest.approx(2.453, abs=5e-4)


def test_C2_offset_roller() -> None:
    """h 50, cosine 120°, dwell 90°, parabolic 90°, r₀ 45, e 10, r_T 6."""
    cam = Cam(motion(50 * MM, (120, 90, 90), "cosine", "parabolic"), True, False, 45 * MM, 10 * MM, roller=6 * MM)
    assert cam.s0 == pytest.approx(43.8748 * MM, abs=5e-5 * MM)
    assert worst(cam, "rise", 1) == pytest.approx((49.6, 22.79), abs=0.05)
    assert worst(cam, "rise", 1)[1] == pytest.approx(22.79, abs=5e-3)
    assert worst(cam, "return", -1) == pytest.approx((255.0, 46.92), abs=5e-3)
    profile = cam.sampled()
    assert profile.rho[profile.rho > 0].min() == pytest.approx(45 * MM)
    assert (profile.rho[profile.rho > 0].min() - cam.roller) == pytest.approx(39 * MM)


def test_C3_small_offset() -> None:
    """h 8, e 4, r₀ 60, r_T 4, sine 60°, dwell 10°, sine 60°."""
    cam = Cam(motion(8 * MM, (60, 10, 60), "sine", "sine"), True, False, 60 * MM, 4 * MM, roller=4 * MM)
    assert cam.s0 == pytest.approx(59.8665 * MM, abs=5e-5 * MM)
    assert worst(cam, "rise", 1) == pytest.approx((29.4, 10.03), abs=0.05)
    assert worst(cam, "return", -1) == pytest.approx((101, 16.83), abs=0.05)
    at, least = cam.worst(0, lambda one: np.where(one.rho > 0, -one.rho, -np.inf))
    assert (math.degrees(at), -least / MM) == pytest.approx((44.3, 39.82), abs=0.05)
    assert -least / MM == pytest.approx(39.82, abs=5e-3)


@pytest.mark.parametrize(("opposite", "rise", "back"), [(1, -23.96, -41.25), (-1, 41.25, 23.96)])
def test_C4_shaper_feed(opposite: int, rise: float, back: float) -> None:
    """l 132, a 180, r₀ 80, ψ 15°, sine 72.58°/72.58°: allowed (40°, 50°) where cam and follower turn oppositely.

    With its sign: where cam and arm turn the same way the cam drives it at 41.25°, beyond [α]; opposite to it the arm
    comes back at −41.25°, within [α′].  The other sense is the same cam run backwards.
    """
    moved = motion(math.radians(15), (72.58, 0, 72.58), "sine", "sine")
    cam = Cam(moved, False, False, 80 * MM, a=180 * MM, arm=132 * MM, opposite=opposite)
    assert math.degrees(cam.psi0) == pytest.approx(23.963, abs=5e-4)
    profile = cam.sampled(3600)
    up = np.degrees(profile.alpha[profile.φ < moved.phases[0]])
    down = np.degrees(profile.alpha[(profile.φ > moved.phases[0]) & (profile.φ < moved.starts["near"])])
    greatest = [float(one[np.abs(one).argmax()]) for one in (up, down)]
    assert greatest == pytest.approx([rise, back], abs=5e-3)
    assert np.abs(profile.pitch).max() / MM == pytest.approx(113.47, abs=5e-3)
    assert profile.rho[profile.rho > 0].min() / MM == pytest.approx(49.15, abs=5e-3)


def test_C5_limit_lines() -> None:
    """h 150, parabolic 90°, dwell 40°, cosine 80°, [α] 40°, [α′] 70°: the apex of both lines, and the central cam."""
    moved = motion(150 * MM, (90, 40, 80), "parabolic", "cosine")
    limits = CamLimits(*degrees(40, 70), 3 * MM)
    least = least_translating(moved, limits, None)
    assert least.apex is not None
    assert (least.apex.imag / MM, least.apex.real / MM) == pytest.approx((52.511, 83.992), abs=5e-4)
    assert abs(least.apex) / MM == pytest.approx(99.055, abs=5e-4)
    assert least_translating(moved, limits, 0.0).r0 / MM == pytest.approx(152.608, abs=5e-4)
    # The foot on the rise line is nearer still, and within both limits.
    assert least.r0 < abs(least.apex)
    cam = Cam(moved, True, False, least.r0, least.e)
    assert worst(cam, "rise", 1)[1] == pytest.approx(40)
    assert worst(cam, "return", -1)[1] < 70


@pytest.mark.parametrize(("opposite", "largest"), [(-1, 42.77), (1, 31.49)])
def test_C7_oscillating_roller(opposite: int, largest: float) -> None:
    """l 125, a 150, r₀ 50, ψ 15°, parabolic 75°, dwell 10°, 75°: the largest angle of the rise, amid it.

    There ψ = 7.5° and ψ′ = 2·15°/75° = 0.4, so that by hand tan α = (125·1.4 − 150 cos 25.695°)/(150 sin 25.695°) =
    0.6125 and α = 31.49° in opposite senses; tables at some steps beside that corner have 31.44°.
    """
    moved = motion(math.radians(15), (75, 10, 75), "parabolic", "parabolic")
    cam = Cam(moved, False, False, 50 * MM, a=150 * MM, arm=125 * MM, opposite=opposite)
    assert math.degrees(cam.psi0) == pytest.approx(18.195, abs=5e-4)
    assert worst(cam, "rise", 1)[1] == pytest.approx(largest, abs=5e-3)


def test_least_oscillating_keeps_the_limits() -> None:
    """With the least ψ₀ one limit is just reached and the other kept."""
    moved = motion(math.radians(15), (72.58, 0, 72.58), "sine", "sine")
    least = least_oscillating(moved, CamLimits(*degrees(40, 50), 3 * MM), 132 * MM, 1, 180 * MM)
    assert least is not None
    cam = Cam(moved, False, False, least.r0, a=180 * MM, arm=132 * MM)
    reached = worst(cam, "rise", 1)[1] / 40, worst(cam, "return", -1)[1] / 50
    assert max(reached) == pytest.approx(1)
    assert min(reached) < 1
