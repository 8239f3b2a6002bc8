"""The way of a slider between its dead centres, and what the loads of a cycle need to know of it.

Angles are the driver's turn in the direction of rotation; a course counts them from its `top`, the dead
centre where crank and rod are stretched in one line.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from reportgen.mechanism.motion import Motion

Floats = NDArray[np.float64]
FULL_TURN = 2 * np.pi


@dataclass(frozen=True)
class Course:
    """The way of slider `link`, whose pin `pin` is joined by `rod` to `crank_pin`.

    `top` and `bottom` are the pin's places at the dead centres, `top_angle` and `bottom_angle` the
    driver's turn there, `phase` the slider's own cycle angle at position 1.
    """

    link: int
    rod: int
    pin: str
    crank_pin: str
    top: complex
    bottom: complex
    top_angle: float
    bottom_angle: float
    phase: float

    @property
    def stroke(self) -> float:
        """H, the distance of the dead centres (m)."""
        return abs(self.top - self.bottom)

    @property
    def inward(self) -> complex:
        """The unit vector from top to bottom."""
        return (self.bottom - self.top) / self.stroke

    @property
    def dead_centres(self) -> Floats:
        """Its own cycle angles over two turns at which it turns back [4]; the first is 0, the top."""
        way = (self.bottom_angle - self.top_angle) % FULL_TURN or np.pi
        return np.array([0.0, way, FULL_TURN, FULL_TURN + way])

    def fraction(self, motion: Motion) -> Floats:
        """s/H [N]: the pin's way from its top over the stroke."""
        way = np.real(np.conj(self.inward) * (motion.points[self.pin].p - self.top)) / self.stroke
        return np.asarray(np.clip(way, 0.0, 1.0))

    def fraction_rate(self, motion: Motion) -> Floats:
        """d(s/H)/dφ [N] over the driver's turn φ in the direction of rotation."""
        speed = np.real(np.conj(self.inward) * motion.points[self.pin].v)
        return np.asarray(speed / (self.stroke * abs(motion.rate)))
