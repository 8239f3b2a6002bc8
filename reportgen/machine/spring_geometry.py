"""Geometry of springs: the points of the links that their ends are attached to, independent of their force."""

from __future__ import annotations

import numpy as np

from reportgen.base.arrays import Complexes
from reportgen.base.records import Record
from reportgen.formula import Ref, ids
from reportgen.formula.calculation import Calculation
from reportgen.machine.kinematics import Motion


class Anchor(Record):
    """An end of a spring: a named point, or a place (m) of the frame that has no name."""

    name: str = ""
    place: complex = 0j

    def at(self, motion: Motion) -> Complexes | complex:
        """Return the place (m): [N] of a named point, one number for a place of the frame."""
        return motion.points[self.name].p if self.name else self.place

    def on(self, q: Calculation, number: int) -> Ref:
        """Return the end's place (m) in the calculation; a place of the frame is entered for spring `number`."""
        if self.name:
            return q[ids.place(self.name)]
        id = ids.spring_anchor(number)
        return q.find(id) or q.give(id, self.place, id, "length", hidden=True)


class Coil(Record):
    """A spring between two ends, by its number.

    A `wound` spring is coiled about its first end, a pin of the frame, and acts on the line to its second end.
    """

    number: int
    ends: tuple[Anchor, Anchor]
    wound: bool = False

    def at(self, motion: Motion) -> tuple[Complexes, Complexes]:
        """Return both ends (m) [N]."""
        first, last = (np.broadcast_to(end.at(motion), motion.driver.shape) for end in self.ends)
        return first, last
