"""The pose of a ternary link, the plate, on three legs of given lengths.

Unknown are the place d of the plate's first inner joint and the direction e^{iφ} of its axes. With the outer joints
P_j, the inner joints Q_j = d + q_j e^{iφ} and the unit vectors e_j along the legs, a leg demands |Q_j − P_j| = l_j. A
change of the pose by δ and θ changes that length by e_j·δ + m_j θ, m_j = (q_j e^{iφ}) × e_j. The determinant of the
rows (e_j, m_j) is 0 where the lines of the legs meet in one point or are parallel: a dead point.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from reportgen.base.records import Record
from reportgen.formula.constructions import Value, cross

EXACT = 1e-13
"""A correction of a pose smaller than this, relative to the longest leg, ends the iteration."""
SAME = 1e-7
"""Two poses nearer than this, relative to the longest leg, are one; a pose is found with the square of it."""


class Rows(Record):
    """The equations of the pose: unit vectors along the legs, their moments about d (m), the misses of length (m)."""

    along: tuple[Value, Value, Value]
    moments: tuple[Value, Value, Value]
    misses: tuple[Value, Value, Value]

    @classmethod
    def of(
        cls, lengths: Sequence[Value], locals_: Sequence[Value], outer: Sequence[Value], pose: tuple[Value, Value]
    ) -> Rows:
        """Return the equations at the pose d, e^{iφ}; `locals_` are the places q_j in the axes of the plate."""
        d, turn = pose
        rows = []
        for length, local, start in zip(lengths, locals_, outer, strict=True):
            arm = local * turn
            rod = d + arm - start
            reach = abs(rod)
            e = rod / reach
            rows.append((e, cross(arm, e), length - reach))
        along, moments, misses = zip(*rows, strict=True)
        return cls(along, moments, misses)

    @property
    def determinant(self) -> Value:
        """The determinant (m) of the rows; it does not depend on the point d."""
        (e, f, g), (k, m, n) = self.along, self.moments
        return k * cross(f, g) + m * cross(g, e) + n * cross(e, f)

    def solve(self, right: Sequence[Value]) -> tuple[Value, Value]:
        """Return δ and θ with e_j·δ + m_j θ = `right`_j, by Cramer's rule."""
        (e, f, g), (k, m, n), (x, y, z) = self.along, self.moments, right
        whole = self.determinant
        shift = 1j * (x * (m * g - n * f) + y * (n * e - k * g) + z * (k * f - m * e)) / whole
        return shift, (x * cross(f, g) + y * cross(g, e) + z * cross(e, f)) / whole


def refined_pose(
    lengths: Sequence[Value], locals_: Sequence[Value], outer: Sequence[Value], pose: tuple[Value, Value]
) -> tuple[Value, Value]:
    """Return d and e^{iφ} [N] that Newton's iteration reaches from a pose nearby; nan where it does not converge."""
    d, turn = pose
    size = np.max([np.max(np.abs(length)) for length in lengths])
    for _ in range(8):
        rows = Rows.of(lengths, locals_, outer, (d, turn))
        shift, theta = rows.solve(rows.misses)
        change = np.abs(shift) / size + np.abs(theta)
        d, turn = d + shift, turn * np.exp(1j * theta)
        if not np.any(change > EXACT):
            break
    lost = ~(change < SAME)
    return np.where(lost, np.nan, d), np.where(lost, np.nan, turn / np.abs(turn))


def plate_place(*given: Value) -> Value:
    """Return the place d of the plate's first inner joint; arguments as of `plate_turn`."""
    return _solved(*given)[0]


def plate_turn(*given: Value) -> Value:
    """Return the direction e^{iφ} of the plate's axes (dimensionless).

    Given are the outer joint and the length of each of the three legs, the places of the second and third inner joint
    in the plate's axes, and a pose nearby: d, e^{iφ}. All have one unit and broadcast together.
    """
    return _solved(*given)[1]


def _solved(*given: Value) -> tuple[Value, Value]:
    first, l1, second, l2, third, l3, local2, local3, d, turn = given
    return refined_pose((l1, l2, l3), (0j, local2, local3), (first, second, third), (d, turn))
