"""A torque over the cycle as polynomials between cycle angles, which is fast to evaluate at any angle."""

from __future__ import annotations

import numpy as np

from reportgen.base.arrays import Floats
from reportgen.base.records import Record

SAME_ANGLE = 1e-9
"""Angles nearer than this (rad) count as one angle."""


class CycleTorque(Record):
    """Legendre polynomials between rising cycle angles `edges` [n + 1] (rad), by their `coefficients` [n, k] (N·m)."""

    edges: Floats
    coefficients: Floats

    def torque(self, angle: Floats) -> Floats:
        """Return the torque (N·m) [N] at cycle angles [N] (rad), which may lie beyond the cycle.

        At an edge it is the value just after it.
        """
        within = np.mod(angle, self.edges[-1])
        part = np.clip(np.searchsorted(self.edges, within + SAME_ANGLE, side="right") - 1, 0, len(self.edges) - 2)
        low, high = self.edges[part], self.edges[part + 1]
        place = np.polynomial.legendre.legvander(2 * (within - low) / (high - low) - 1, self.coefficients.shape[1] - 1)
        return np.asarray((place * self.coefficients[part]).sum(axis=-1))
