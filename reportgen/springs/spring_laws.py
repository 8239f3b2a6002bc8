"""Load laws of springs: a spring between two points, and a torsion spring about a pin."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TypeVar

import numpy as np

from reportgen.base.arrays import Complexes, Floats
from reportgen.formula import PI, Expression, Number, arg, cis, ids, quotient
from reportgen.formula.calculation import Calculation
from reportgen.machine.kinematics import Motion
from reportgen.machine.load_laws import Law, MotionAt
from reportgen.machine.loads import Direction
from reportgen.machine.spring_geometry import Anchor, Coil

Size = TypeVar("Size", Floats, Expression)
"""An array over positions, or an expression of a calculation."""


def pull(c: Size, length: Size, free: Size) -> Size:
    """Return F = c(l − l₀), positive where the spring is stretched and pulls."""
    return c * (length - free)


class SpringLaw(Law):
    """A spring of stiffness c (N/m) and free length l₀ (m) between two ends; the law of the force (N) on either end."""

    number: int
    ends: tuple[Anchor, Anchor]
    c: float
    free: float
    kind = "spring"

    def along(self, motion: Motion) -> Complexes:
        """Return the vector (m) from the first end to the second [N]."""
        return np.asarray(self.ends[1].at(motion) - self.ends[0].at(motion), dtype=np.complex128)

    def energy(self, motion: Motion) -> Floats:
        """Return ½c(l − l₀)² (J) [N]."""
        return np.asarray(self.c * (np.abs(self.along(motion)) - self.free) ** 2 / 2)

    def towards(self, end: int) -> Direction:
        """Return the direction of the pull at one of its ends, 0 or 1: towards the other end."""
        sense = -1.0 if end else 1.0

        def direction(motion: Motion) -> Complexes:
            along = self.along(motion)
            # A spring whose ends meet pulls in no direction.
            length = np.abs(along)
            return np.asarray(sense * along / np.where(length > 0, length, 1.0))

        return direction

    def value(self, angle: Floats, motion: Motion) -> Floats:
        """Return F = c(l − l₀) (N) [N]."""
        length = np.abs(self.along(motion))
        return pull(np.full_like(length, self.c), length, np.full_like(length, self.free))

    def breaks(self, motion_at: MotionAt) -> Iterable[float]:
        return ()

    @property
    def sizes(self) -> tuple[float, ...]:
        return (self.c,)

    @property
    def coil(self) -> Coil:
        return Coil(self.number, self.ends)

    def formula(self, q: Calculation, link: int) -> Expression:
        """Return F = c(l − l₀) as an expression, with l measured on the drawing."""
        number, first = self.number, self.ends[0].on(q, self.number)
        if ids.spring_length(number) not in q:
            apart = abs(self.ends[1].on(q, number) - first)
            drawn = q.define(ids.spring_on_paper(number), apart / q["drawing"])
            q.define(ids.spring_length(number), q["mu.l"] * drawn)
        c, length, free = (q[name(number)] for name in (ids.spring_rate, ids.spring_length, ids.spring_free))
        return pull(c, length, free)


def within_half_a_turn(angle: Floats | float) -> Floats:
    """Return an angle (rad) [N] without its whole turns, in (−π, π]."""
    return np.asarray(np.angle(np.exp(1j * np.asarray(angle))))


class TorsionLaw(Law):
    """A torsion spring of c (N·m/rad) on a link about a pin: M = −c(φ − φ₀), φ the link's angle, φ₀ = `free` (rad).

    The deflection φ − φ₀ lies within half a turn of `wound` (rad), which is 0 for a spring that is never wound further.
    The angle is that of the line from the pin to `point`, or for a slotted link that of its slot.
    """

    number: int
    link: int
    pin: str
    point: str
    c: float
    free: float
    wound: float = 0.0
    kind = "spring"

    def deflection(self, motion: Motion) -> Floats:
        """Return φ − φ₀ (rad) [N]."""
        return self.wound + within_half_a_turn(motion.links[self.link].angle - self.free - self.wound)

    def energy(self, motion: Motion) -> Floats:
        """Return ½c(φ − φ₀)² (J) [N]."""
        return np.asarray(self.c * self.deflection(motion) ** 2 / 2)

    def value(self, angle: Floats, motion: Motion) -> Floats:
        """Return M = −c(φ − φ₀) (N·m) [N]."""
        return -self.c * self.deflection(motion)

    def breaks(self, motion_at: MotionAt) -> Iterable[float]:
        return ()

    @property
    def sizes(self) -> tuple[float, ...]:
        return (self.c,)

    @property
    def coil(self) -> Coil:
        return Coil(self.number, (Anchor(self.pin), Anchor(self.point)), wound=True)

    def formula(self, q: Calculation, link: int) -> Expression:
        """Return M = −c θ as an expression, with θ = φ − φ₀ measured on the drawing in degrees."""
        free, slot = q[ids.spring_free(self.number)], q.find(ids.slot(link))
        line = slot if slot is not None else q[ids.place(self.point)] - q[ids.place(self.pin)]
        turned: Expression = arg(quotient(line, cis(free + self.wound if self.wound else free)))
        θ = q.define(ids.spring_turn(self.number), turned + self.wound if self.wound else turned, scale=1.0)
        return -(q[ids.spring_rate(self.number)] * θ * PI / Number(180.0, unit="°"))
