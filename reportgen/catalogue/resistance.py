"""Forces and torques of one size: always the same way, or against the motion of the link they load."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np

from reportgen.catalogue.course import FULL_TURN, Floats
from reportgen.catalogue.laws import MotionAt
from reportgen.mechanism.motion import Motion

STEPS = 720
"""Steps of a turn in which a link is watched for turning back."""
HALVINGS = 50
ROUND = 1e-9
"""A position this near (rad) before a turning point already belongs to the way back."""


@dataclass(frozen=True)
class Constant:
    """The same size at every position."""

    size: float

    def value(self, angle: Floats, motion: Motion) -> Floats:
        return np.full(angle.shape, self.size)

    def breaks(self, motion_at: MotionAt) -> Iterable[float]:
        return ()


@dataclass(frozen=True)
class Opposing:
    """−`size`·sgn(rate), the sign of the rate changing at the cycle angles `reversals` of one turn.

    `before` is the rate's sign before the first of them.
    """

    size: float
    reversals: tuple[float, ...]
    before: float

    def value(self, angle: Floats, motion: Motion) -> Floats:
        passed = np.searchsorted(self.reversals, np.mod(angle + ROUND, FULL_TURN), side="right")
        return np.where(passed % 2, 1.0, -1.0) * self.before * self.size

    def breaks(self, motion_at: MotionAt) -> Iterable[float]:
        return self.reversals


def opposing(size: float, rate: Callable[[Floats], Floats]) -> Opposing:
    """What resists a `rate` over the cycle angle (0…2π) with a constant size."""
    edges = np.linspace(0.0, FULL_TURN, STEPS + 1) - FULL_TURN / STEPS / np.pi
    signs = np.sign(rate(edges))
    low, high = (edges[chosen] for chosen in _around(signs))
    first = signs[_around(signs)[0]]
    for _ in range(HALVINGS if low.size else 0):
        middle = (low + high) / 2
        same = np.sign(rate(middle)) == first
        low, high = np.where(same, middle, low), np.where(same, high, middle)
    found = np.sort(np.mod(high + ROUND, FULL_TURN) - ROUND)
    # The first of them in the turn is where the sign before it ends.
    after = rate(np.array([(found[0] + found[1]) / 2])) if found.size > 1 else -rate(np.array([0.0]))
    return Opposing(size, tuple(map(float, found)), -float(np.sign(after[0])))


def _around(signs: Floats) -> tuple[np.ndarray, np.ndarray]:
    """Indices on both sides of every change of sign."""
    changes = np.flatnonzero(signs[1:] != signs[:-1])
    return changes, changes + 1
