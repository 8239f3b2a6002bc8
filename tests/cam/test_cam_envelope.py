"""Random cams against an independent construction: the follower at many positions in the cam's frame, nothing else.

The follower is carried round the cam by points and rotations alone; its roller's circles, or its faces, must touch the
profile and never cut it.  Nothing here knows a derivative: normals are taken from neighbouring positions.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import pytest

from reportgen.cam.motion_laws import LAWS, FollowerMotion, law
from reportgen.cam.profile import Cam
from tests.lanes import matrix

FINE = 60_000
"""Positions of the follower in a turn: what neighbours 1e-4 rad apart miss of a curve is far below 1e-6 of its size."""
SMOOTH = [name for name in LAWS if name != "uniform"]


@dataclass(frozen=True)
class MovingBody:
    """The follower's end at every position, in the cam's frame: a point, and for a face its direction."""

    φ: np.ndarray
    points: np.ndarray
    faces: np.ndarray


def random_cam(seed: int) -> Cam:
    rng = np.random.default_rng(seed)
    phases = rng.uniform(60, 130, 2)
    far = rng.choice([0.0, rng.uniform(5, 40)])
    first, back = np.radians(phases)
    dwell = math.radians(far)
    translating, end = bool(rng.integers(2)), rng.choice(["knife", "roller", "flat"])
    stroke = rng.uniform(0.005, 0.03) if translating else math.radians(rng.uniform(5, 18))
    motion = FollowerMotion(
        stroke,
        (first, dwell, back, 2 * math.pi - first - back - dwell),
        law(rng.choice(SMOOTH)),
        law(rng.choice(SMOOTH)),
    )
    r0 = rng.uniform(0.03, 0.08)
    e = rng.uniform(-0.3, 0.3) * r0 if translating and end != "flat" else 0.0
    a = rng.uniform(1.9, 2.6) * r0
    return Cam(
        motion,
        translating,
        bool(end == "flat"),
        r0=r0,
        e=e,
        a=0.0 if translating else a,
        arm=0.0 if translating or end == "flat" else rng.uniform(0.8, 1.0) * a,
        opposite=int(rng.choice([1, -1])),
        roller=rng.uniform(0.05, 0.5) * r0 if end == "roller" else 0.0,
        turn=int(rng.choice([1, -1])),
    )


def carried(cam: Cam) -> MovingBody:
    """The follower put where its stroke puts it, and turned back with the frame: no derivatives."""
    φ = np.linspace(0, 2 * math.pi, FINE, endpoint=False)
    s = cam.motion(φ)[0]
    back = np.exp(-1j * cam.turn * φ)
    if cam.translating:
        if cam.flat:
            return MovingBody(φ, 1j * (cam.r0 + s) * back, back)
        lowest = math.sqrt(cam.r0**2 - cam.e**2)
        return MovingBody(φ, (cam.turn * cam.e + 1j * (lowest + s)) * back, back)
    # The pivot lies where the arm, lifting, turns against the cam or with it; the arm starts as the triangle wants it.
    side = cam.opposite * cam.turn
    if cam.flat:
        start = math.asin(cam.r0 / cam.a)
    else:
        start = math.acos((cam.a**2 + cam.arm**2 - cam.r0**2) / (2 * cam.a * cam.arm))
    arm = -side * np.exp(-1j * side * (start + s))
    tip = side * cam.a + (1.0 if cam.flat else cam.arm) * arm
    return MovingBody(φ, tip * back, arm * back)


def nearest(points: np.ndarray, others: np.ndarray, around: np.ndarray, reach: int) -> np.ndarray:
    """The least distance of each point from the polyline of others, and from those `around` it within a reach."""
    found = np.full(points.shape, np.inf)
    for step in range(-reach, reach):
        start, stop = others[(around + step) % others.size], others[(around + step + 1) % others.size]
        along = stop - start
        share = np.clip(((points - start) * along.conj()).real / np.maximum(np.abs(along) ** 2, 1e-30), 0, 1)
        found = np.minimum(found, np.abs(points - start - share * along))
    return found


SEEDS, BLOCKS = 1000, 20


@pytest.mark.parametrize("block", matrix(range(BLOCKS), [0]))
def test_random_cams(block: int) -> None:
    """Fifty of them: profile within 1e-6 r₀ of the envelope, signed α within 0.05°, undercut where there is a cusp."""
    count = SEEDS // BLOCKS
    for seed in range(block * count, (block + 1) * count):
        one_cam(seed)


def one_cam(seed: int) -> None:
    cam = random_cam(seed)
    if not cam.translating and cam.opposite < 0 and np.abs(cam.motion(np.linspace(0, 6.28, 400))[1]).max() > 0.9:
        return
    body = carried(cam)
    # Away from the corners of the motion, where neighbouring positions show one tangent.
    corners = np.array([edge for one in cam.motion.intervals for edge in (one.start, one.stop)])
    index = np.arange(0, FINE, 607)
    clear = np.abs(body.φ[index, None] - corners).min(axis=1) > 3 * 2 * math.pi / FINE
    index = index[clear]
    profile = cam.profile_at(body.φ[index])
    r0 = cam.r0
    if cam.flat:
        # Neighbouring faces meet at the point of contact: their lines are solved for where they cross.
        p, u = body.points, body.faces
        before, after = (index - 1) % FINE, (index + 1) % FINE
        cross = (u[before].conj() * u[after]).imag
        meet = p[before] + u[before] * ((p[after] - p[before]).conj() * u[after]).imag / cross
        # The crossing of two lines some 5e-4 rad apart is the envelope but for the square of that angle.
        assert np.abs(meet - profile.working).max() < 1e-6 * r0, seed
        # A cusp is where the point of contact runs back along the face as the face turns on.
        run = ((np.roll(meet, -1) - meet) * u[index].conj()).real[:-1] * cam.turn
        if abs(profile.rho.min()) > 0.05 * r0:
            assert bool((np.diff(np.sign(run)) != 0).any()) == bool(cam.undercut), seed
        return
    assert np.abs(body.points[index] - profile.pitch).max() < 1e-12 + 1e-9 * r0, seed
    chord = body.points[(index + 1) % FINE] - body.points[(index - 1) % FINE]
    outward = 1j * cam.turn * chord / np.abs(chord)
    # From the way in which the follower lifts to the normal, in the sense in which the cam turns.
    α = cam.turn * np.angle(outward / lifting(cam, body.φ[index]))
    assert np.degrees(np.abs(α - profile.alpha)).max() < 0.05, seed
    if not cam.roller:
        return
    # A point of the profile has the roller's radius from its own centre and is nearer to none, unless it is undercut.
    gap = nearest(profile.working, body.points, index, 40) - cam.roller
    far = np.abs(profile.working[:, None] - body.points[None, ::97]).min(axis=1) - cam.roller
    rho = cam.sampled().rho
    sharpest = rho[rho > 0].min()
    if not cam.undercut:
        assert sharpest > cam.roller, seed
        assert max(np.abs(gap).max(), -far.min()) < 1e-6 * r0, seed
    elif sharpest < 0.9 * cam.roller:
        # There the centres before and behind come nearer to the point than its own.
        worst = np.round(np.array(cam.undercut) / (2 * math.pi) * FINE).astype(int) % FINE
        points = cam.profile_at(np.array(cam.undercut)).working
        assert (nearest(points, body.points, worst, 1500) - cam.roller).min() < -1e-5 * r0, seed


def lifting(cam: Cam, φ: np.ndarray) -> np.ndarray:
    """The direction in the cam's frame in which the follower's point lifts."""
    back = np.exp(-1j * cam.turn * φ)
    if cam.translating:
        return 1j * back
    s = cam.motion(φ)[0]
    side = cam.opposite * cam.turn
    start = math.acos((cam.a**2 + cam.arm**2 - cam.r0**2) / (2 * cam.a * cam.arm))
    arm = -side * np.exp(-1j * side * (start + s))
    return -1j * side * arm * back
