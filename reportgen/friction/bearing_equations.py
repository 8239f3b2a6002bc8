"""Exact equations for the forces that press joints with friction together, at one position.

Friction depends on the forces p that press joints together, and the reactions u are linear in friction:

    p_j = Σ |u_t|,  u_t = a_t + Σ b_tk p_k,  t over the reactions of joint j.

In a guide u is a number, and |u| = ±u: once the side on which each guide bears is known, the equations are linear. In a
pin u is a vector, and Newton's method solves for its size. `joints.solve_with_friction` uses them if its rounds do not
converge.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import chain, combinations, islice

import numpy as np
from numpy.typing import NDArray

from reportgen.base.arrays import Complexes, Flags, Floats
from reportgen.base.records import Record

MOST_STEPS = 40
"""Newton's method converges in ten steps or not at all."""
SETTLED = 1e-12
"""Residual of the equations, as a share of the greatest reaction, that counts as rounding."""
STARTS = (1.0, 0.0, 10.0)
"""Start values of Newton's method, as multiples of the forces without friction."""
MOST_PATTERNS = 1024
"""Largest number of choices of sides that are tried: enough for all choices of ten faces."""


class BearingEquations(Record):
    """The reactions (N) [T] that press joints at positions [N]: a = `base` [T, N], b = `slope` [T, J, N].

    `joint` [T] is the number of each reaction's joint, `guides` [T] is True for the reactions of guides.
    """

    joint: NDArray[np.int64]
    guides: Flags
    base: Complexes
    slope: Complexes

    def solve(self) -> Floats:
        """Return the forces p ≥ 0 (N) that press each joint [J, N], nan at a position without a solution.

        Among several solutions the one is chosen whose guides bear on the same sides as without friction, or as many of
        them as possible: it is the solution that develops from the frictionless one as friction grows.
        """
        count = self.slope.shape[1]
        solved = np.full((count, self.base.shape[1]), np.nan)
        natural = np.where(self.base.real < 0, -1.0, 1.0)
        for flipped in _patterns(int(self.guides.sum())):
            signs = natural.copy()
            signs[np.flatnonzero(self.guides)[list(flipped)]] *= -1
            for start in STARTS if not self.guides.all() else STARTS[:1]:
                at = np.flatnonzero(np.isnan(solved[0]))
                if not at.size:
                    return solved
                solved[:, at] = self._bearing(at, signs[:, at], start)
        return solved

    def _bearing(self, at: NDArray[np.int64], signs: Floats, start: float) -> Floats:
        """Return the forces at the positions `at` if the guides bear by `signs` [T, n]; nan where the equations
        contradict this.
        """
        base, slope = self.base[:, at], self.slope[:, :, at]
        belongs = (self.joint == np.arange(slope.shape[1])[:, None]).astype(np.float64)
        guides = self.guides[:, None]
        p = start * (belongs @ np.abs(base))
        with np.errstate(all="ignore"):
            for _ in range(MOST_STEPS):
                u = base + np.einsum("tkn,kn->tn", slope, p)
                along = np.where(guides, signs, np.conj(u) / np.where(u == 0, 1.0, np.abs(u)))
                left = p - belongs @ np.real(along * u)
                step = np.eye(len(p)) - np.einsum("jt,tn,tkn->njk", belongs, along, slope).real
                regular = np.abs(np.linalg.det(step)) > SETTLED
                step[~regular] = np.nan
                change = np.linalg.solve(step, left.T[:, :, None])[:, :, 0].T
                p = p - change
                if not (np.abs(change) > SETTLED * np.abs(p).max(axis=0)).any():
                    break
            u = base + np.einsum("tkn,kn->tn", slope, p)
            nothing = 1e3 * SETTLED * np.maximum(np.abs(base).max(axis=0), np.abs(u).max(axis=0))
            bears = (~guides | (signs * u.real >= -nothing)).all(axis=0)
            left = p - belongs @ np.where(guides, signs * u.real, np.abs(u))
            right = bears & (np.abs(left) <= nothing).all(axis=0) & (p >= -nothing).all(axis=0)
        return np.where(right, np.maximum(p, 0.0), np.nan)


def _patterns(guides: int) -> Iterator[tuple[int, ...]]:
    """Return the sets of guides that bear on the opposite side than without friction, starting with the empty set."""
    every = chain.from_iterable(combinations(range(guides), count) for count in range(guides + 1))
    return islice(every, MOST_PATTERNS)
