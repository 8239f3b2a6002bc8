"""How a student works, by whatever way: each value found is changed by the mistake made there, rounded, written down.

The work goes on from what is written.  Nothing of the ledger or of marking is used.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np

MM, DEGREE = 1e-3, math.pi / 180
PRINTED = {"drawn": MM, "seg": MM, "ic.seg": MM, "h": MM, "F": 1e-4, "p": 1e4, "mu": 1e3} | dict.fromkeys(
    ("dir", "beta", "ic.angle", "theta", "alpha", "psi", "swing"), DEGREE
)
"""What one printed unit is in SI, by the first part of an id; 1 for all others."""
NOTHING = 1e-9
"""A vector shorter than this has no direction."""

Change = Callable[[float], float]
"""What a student makes of a value that should be another."""


def unit_of(id: str) -> float:
    """What one printed unit of a quantity is in SI."""
    first, *rest = id.split(".")
    return PRINTED.get(f"ic.{rest[0]}" if first == "ic" else first, 1.0)


@dataclass(kw_only=True)
class Student:
    """One position of a machine worked out; `changes` are mistakes by id.

    `figures` are written, all there are if 0; a drawn point is read up to `blunt` (m) beside where it lies, lengths to
    `step` mm.
    """

    changes: Mapping[str, Change] = field(default_factory=dict)
    figures: int = 4
    blunt: float = 0.0
    step: float = 0.1
    seed: int = 0
    written: dict[str, float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.rng = np.random.default_rng(self.seed)

    def say(self, id: str, value: float) -> float:
        """A value found; gives what is written, in SI."""
        if id in self.changes:
            value = self.changes[id](value)
        unit = unit_of(id)
        printed = value / unit
        if not self.figures:
            pass
        elif id.startswith("dir."):
            printed = float(round(printed % 360))
        elif unit == MM:
            printed = round(round(printed / self.step) * self.step, 2) if self.blunt else round(printed, 2)
        elif printed:
            printed = float(f"{printed:.{self.figures - 1}e}")
        self.written[id] = printed
        return printed * unit

    def measure(self, id: str, value: float, scale: float = 1.0) -> float:
        """A size read from a drawing, off at both ends; what is nearly nothing is seen to be nothing."""
        noise = self.rng.uniform(-self.blunt, self.blunt, 2).sum() * scale
        return self.say(id, abs(value) + noise if abs(value) > 2 * self.blunt * scale else abs(value))

    def direct(self, id: str, vector: complex, scale: float = 0.0) -> None:
        """Where a drawn vector points, if it has a length to show it."""
        if abs(vector) > max(NOTHING, 4 * self.blunt * scale):
            self.say(f"dir.{id}", float(np.angle(vector)) % (2 * np.pi))
