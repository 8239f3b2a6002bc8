"""Sliders of finite width: the place in the guide where the reaction acts, and whether the slider tilts.

A slider touches its guide along a face from x₁ to x₂, measured from its pin in the direction of the guide. The
reaction N across the guide acts at the place x where its moment about the pin equals that of the joint. If x lies
within the face, one side of the guide carries the slider. Otherwise the slider tilts until both ends bear, on
opposite sides:

    N₁ = N (x₂ − x)/(x₂ − x₁),   N₂ = N (x − x₁)/(x₂ − x₁).
"""

from __future__ import annotations

import numpy as np

from reportgen.base.arrays import Floats
from reportgen.base.records import Record


class Faces(Record):
    """The ends x₁ < x₂ (m) of a slider's face from its pin along the guide, and how far (m) it lies below the pin."""

    first: float
    last: float
    below: float = 0.0

    def ends(self, normal: Floats, moment: Floats) -> tuple[Floats, Floats]:
        """Return the reactions N₁, N₂ (N) [N] at both ends, for N (N) [N] with the moment N x (N·m) [N].

        N is positive to the left of the guide.
        """
        width = self.last - self.first
        return (normal * self.last - moment) / width, (moment - normal * self.first) / width

    def tilts(self, normal: Floats, moment: Floats) -> np.ndarray:
        """Return flags [N]: True if the reaction acts beyond the face, so that the two ends bear on opposite sides."""
        first, last = self.ends(normal, moment)
        return np.asarray(first * last < 0)
