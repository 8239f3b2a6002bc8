"""Sense of motions: the sign of a speed, or 0 where the speed is only rounding.

A relative speed is the difference of two speeds. Where they are equal, only rounding is left, and its sign is
meaningless. So each speed is compared with the speed of the whole mechanism, not with itself.
"""

from __future__ import annotations

import numpy as np

from reportgen.base.arrays import Complexes, Floats
from reportgen.machine.kinematics import Motion

STILL = 1e-12
"""A speed below this share of the mechanism's own is rounding."""


def sense_of(rate: Floats, pace: float) -> Floats:
    """Return the sign [N] of a rate [N]; 0 where the rate is negligible beside the mechanism's `pace` (same unit)."""
    return np.asarray(np.sign(moving(rate, pace)))


def moving(rate: Floats, pace: float) -> Floats:
    """Return a rate [N] with 0 where it is negligible beside the mechanism's `pace`, in the same unit."""
    return np.asarray(np.where(np.abs(rate) > STILL * pace, rate, 0.0))


def pace(motion: Motion, kind: str) -> tuple[float, float]:
    """Return the greatest speed of a mechanism and its greatest rate of change.

    For pins ("R") they are those of links (rad/s, rad/s²), for guides ("P") those of points (m/s, m/s²).  The change is
    at least the one by ω² of the fastest link: a mechanism that turns steadily changes its directions.
    """
    turning, fastest = greatest_speed(motion, "R"), greatest_speed(motion, kind)
    if kind == "R":
        return turning, max(largest(*(link.epsilon for link in motion.links.values())), turning**2)
    return fastest, max(largest(*(point.a for point in motion.points.values())), turning * fastest)


def greatest_speed(motion: Motion, kind: str) -> float:
    """Return the greatest speed of a mechanism: of links (rad/s) for pins ("R"), of points (m/s) for guides ("P")."""
    if kind == "R":
        return largest(*(link.omega for link in motion.links.values()))
    return largest(*(point.v for point in motion.points.values()))


def largest(*values: Floats | Complexes) -> float:
    """Return the greatest absolute value of arrays of any shape, in their unit; nan is ignored, 0 without values."""
    return max((float(np.nanmax(np.abs(each), initial=0.0)) for each in values), default=0.0)
