"""The cutting force of a machine tool: constant over the working stroke, less a share of it at each end."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from reportgen.cycle.indicator import AT_DEAD_CENTRE, crossings

Floats = NDArray[np.float64]
FULL_TURN = 2 * np.pi
EDGE = 1e-9
"""A share of the stroke this near to the tool's way in or out is rounding of it."""


@dataclass(frozen=True, slots=True)
class Cutting:
    """`force` (N) while the tool cuts; it runs free over the share `free` at each end of the working stroke.

    Angles (rad) are the crank's turn from the beginning of the working stroke, which ends at the angle
    `reversal`; a share is the way since then over the whole stroke.
    """

    force: float
    reversal: float
    free: float = 0.0

    def at(self, angle: Floats, share: Floats) -> Floats:
        """The force (N) [N]; at a dead centre that of the stroke which begins there."""
        turned = np.mod(angle + AT_DEAD_CENTRE, FULL_TURN) - AT_DEAD_CENTRE
        working = turned < self.reversal - AT_DEAD_CENTRE
        cuts = (share >= self.free - EDGE) & (share <= 1 - self.free + EDGE)
        return np.where(working & cuts, self.force, 0.0)

    def breaks(self, share_at: Callable[[Floats], Floats]) -> tuple[float, ...]:
        """The angles in [0, 2π) where the force jumps, rising; `share_at` gives shares at angles [N]."""
        if self.free == 0:
            return 0.0, self.reversal
        wanted = np.array([self.free, 1 - self.free])
        low, high = np.zeros(2), np.full(2, self.reversal)
        return tuple(map(float, crossings(lambda angle: share_at(angle) - wanted, low, high)))
