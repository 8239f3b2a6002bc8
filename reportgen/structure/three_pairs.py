"""A four-bar linkage through three pairs of positions of its crank and its follower, and its branch between them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cached_property

import numpy as np

from reportgen.base.arrays import Floats
from reportgen.base.records import Record

SINGULAR = 1e-9
"""Below this share of the largest product, the equations of two factors are dependent."""
AGREES = 1e-6
"""An angle of the follower belongs to a branch if it differs by less than this (rad); rounding is below 1e-9."""
SAMPLES = 721
"""Crank angles at which the branch is followed: steps of less than half a degree of a full turn."""


class ThreePairs(Record, dict=True):
    """Three pairs of angles from the frame line AD: `driver` φ and `follower` ψ (rad), with the length of the frame."""

    driver: Sequence[float]
    follower: Sequence[float]
    frame: float

    @cached_property
    def factors(self) -> tuple[float, float, float] | None:
        """K₁, K₂ and K₃ of Freudenstein's equation K₁ cos ψ − K₂ cos φ + K₃ = cos(φ − ψ).

        None if no finite lengths satisfy it at the three pairs.
        """
        φ, ψ = np.array(self.driver), np.array(self.follower)
        left = np.column_stack((np.cos(ψ), -np.cos(φ), np.ones(3)))
        size = float(np.prod(np.linalg.norm(left, axis=1)))
        if abs(np.linalg.det(left)) < SINGULAR * size:
            return None
        K1, K2, K3 = (float(K) for K in np.linalg.solve(left, np.cos(φ - ψ)))
        return None if min(abs(K1), abs(K2)) < SINGULAR else (K1, K2, K3)

    @cached_property
    def lengths(self) -> tuple[float, float, float] | None:
        """Crank a, coupler b and follower c; a or c is negative if the link points away from its angle.

        None if there are none.
        """
        if self.factors is None:
            return None
        K1, K2, K3 = self.factors
        a, c = self.frame / K1, self.frame / K2
        square = a**2 + c**2 + self.frame**2 - 2 * a * c * K3
        return (a, math.sqrt(square), c) if square > SINGULAR * self.frame**2 else None

    def _half_angle(self, φ: Floats) -> tuple[Floats, Floats]:
        """Return the direction about which the two branches lie on either side, and the cosine of their distance."""
        assert self.factors is not None
        K1, K2, K3 = self.factors
        across, along = -np.sin(φ), K1 - np.cos(φ)
        return np.arctan2(across, along), (K2 * np.cos(φ) - K3) / np.hypot(across, along)

    def angle(self, φ: Floats, side: int) -> Floats:
        """Return ψ (rad) of the branch on one `side` (±1); nan where the linkage cannot be assembled."""
        middle, cosine = self._half_angle(φ)
        with np.errstate(invalid="ignore"):
            angle: Floats = middle + side * np.arccos(cosine)
        return angle

    def side_of(self, k: int) -> int:
        """Return the branch on which pair `k` lies, 1 or −1."""
        φ, ψ = self.driver[k], self.follower[k]
        off = [abs(math.remainder(float(self.angle(np.array(φ), side)) - ψ, math.tau)) for side in (1, -1)]
        # Beside a dead point both are near, and rounding may leave neither.
        return -1 if math.isnan(off[0]) or off[1] < off[0] else 1

    @cached_property
    def side(self) -> int | None:
        """The branch on which all three pairs lie and that goes from the first to the last; else None."""
        sides = {self.side_of(k) for k in range(3)}
        if len(sides) > 1:
            return None
        return sides.pop() if self.moves_between(min(self.driver), max(self.driver)) else None

    def moves_between(self, first: float, last: float) -> bool:
        """Return True if the linkage can be assembled at all crank angles (rad) from the first to the last."""
        _, cosine = self._half_angle(np.linspace(first, last, SAMPLES))
        return bool(np.all(np.abs(cosine) < 1))
