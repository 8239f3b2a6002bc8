"""Orders of an engine's inertia forces: of one piston's acceleration, and their sums over all pistons.

A piston on a line through the crank's centre has a = −rω² Σ A_n cos nθ with A₁ = 1 and further even orders, θ the
crank's angle from that line. Cylinder j is at the angle β_j and has its pin at ψ_j on the crank; its order n is a
vector that turns forward with nφ, e^{i(β_j + n(ψ_j − β_j))}, and one that turns backward, e^{i(β_j − n(ψ_j − β_j))},
each of half its size.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from reportgen.balancing.counterweights import CrankRod, crank_rods
from reportgen.base.records import Record
from reportgen.machine import GROUND, Crank, Guide, Linkage

SAME = 1e-9
"""Largest relative difference of cylinders that count as alike."""
FORWARD, BACKWARD = 1, -1


class EngineCylinder(Record):
    """A cylinder in line with the crank's centre: its slider, its angle β and its pin's angle ψ on the crank (rad)."""

    slider: int
    bank: float
    pin: float

    def vector(self, order: int, sense: int) -> complex:
        """Return its vector of an order in the star that turns `FORWARD` or `BACKWARD`, at φ = 0 and with length 1."""
        return complex(np.exp(1j * (self.bank + sense * order * (self.pin - self.bank))))


class Engine(Record):
    """Equal cylinders: crank r and rod l (m), and the mass that reciprocates in each (kg)."""

    cylinders: tuple[EngineCylinder, ...]
    crank: float
    rod: float
    mass: float
    rods: tuple[CrankRod, ...]

    @property
    def in_line(self) -> bool:
        """True if all cylinders are in one plane with the shaft."""
        first = self.cylinders[0].bank
        return all(abs(np.exp(1j * (each.bank - first)) - 1) < SAME for each in self.cylinders)

    def star(self, order: int, sense: int) -> complex:
        """Return the sum of the cylinders' vectors of an order, each with length 1."""
        return sum(cylinder.vector(order, sense) for cylinder in self.cylinders)

    def force(self, order: int) -> float:
        """Return the greatest force of an order over m r ω² A_n: half the sum of both stars' resultants."""
        return (abs(self.star(order, FORWARD)) + abs(self.star(order, BACKWARD))) / 2


def engine(linkage: Linkage) -> Engine | None:
    """Return the engine formed by a linkage; None unless all its cylinders are alike and in line with the crank's
    centre.
    """
    rods, cylinders, lengths = crank_rods(linkage), [], []
    if not isinstance(linkage.driver, Crank):
        return None
    for rod, dyad in zip(rods, linkage.dyads, strict=False):
        guide = dyad.end
        assert isinstance(guide, Guide), "the rods of an engine end on guides"
        offset = (guide.at - linkage.ground[linkage.driver.centre]) * np.exp(-1j * guide.angle)
        if abs(offset.imag) > SAME * dyad.lengths[0]:
            return None
        bank = guide.angle if dyad.sign > 0 else guide.angle + np.pi
        cylinders.append(EngineCylinder(rod.slider, float(bank), float(np.angle(rod.pin))))
        lengths.append((abs(rod.pin), dyad.lengths[0], rod.reciprocating))
    if not lengths or not _alike(lengths) or not lengths[0][2]:
        return None
    crank, length, mass = lengths[0]
    return Engine(tuple(cylinders), float(crank), float(length), float(mass), rods)


def _alike(lengths: Sequence[tuple[float, float, float]]) -> bool:
    first = np.array(lengths[0])
    return bool(all(np.all(np.abs(np.array(own) - first) <= SAME * np.abs(first)) for own in lengths))


def on_sliders(linkage: Linkage) -> bool:
    """Return True if every group is a rod to a slider on the frame, as in an engine; a rod may be articulated on
    another one.
    """
    return not linkage.triads and all(
        dyad.kind == "RRP" and isinstance(dyad.end, Guide) and dyad.end.link == GROUND for dyad in linkage.dyads
    )
