"""Points, links and guides of closed vector loops: their places, velocities and accelerations by formulas."""

from __future__ import annotations

from typing import Protocol

from reportgen.base.records import Record
from reportgen.catalogue.vector_components import STILL, VectorComponents, add, along, less, scaled, turned, typed
from reportgen.formula import NOTHING, Expression, Number, Ref, Symbol, minus, square
from reportgen.formula.calculation import Calculation


class Moving(Record):
    """A point: its coordinates, its velocity and its acceleration by components."""

    p: VectorComponents
    v: VectorComponents = STILL
    a: VectorComponents = STILL


class LoopBody(Record):
    """A link: the origin of its frame by name and motion, the frame's angle, ω and ε."""

    start: str
    origin: Moving
    angle: Expression
    omega: Expression = NOTHING
    eps: Expression = NOTHING

    def place(self, local: complex) -> VectorComponents:
        """Return the place of a point by its typed distances (m) along the link and across it."""
        e, (u, w) = along(self.angle), typed(local)
        return add(self.origin.p, scaled(u, e), scaled(w, turned(e)))

    def carried(self, at: VectorComponents) -> Moving:
        """Return the link's point at a place, with v = v_O + ω ir, a = a_O + ε ir − ω² r."""
        r = less(at, self.origin.p)
        v = add(self.origin.v, scaled(self.omega, turned(r)))
        inward = scaled(minus(square(self.omega)), r)
        return Moving(at, v, add(self.origin.a, scaled(self.eps, turned(r)), inward))


FRAME = LoopBody("", Moving(STILL), Number(0.0, unit="°"))


class LoopRail(Record):
    """A guide: a point of its line, its angle, the link that has it."""

    at: VectorComponents
    angle: Expression
    carrier: LoopBody
    link: int


class LoopIteration(Protocol):
    """Quantities that an iteration gives, with the part of the equations to which they belong."""

    @property
    def part(self) -> str: ...

    def enter(self, q: Calculation) -> tuple[Ref, ...]:
        """Enter all steps in a calculation that has the plans; return the quantities to print."""
        ...


class LoopLine(Record):
    """A quantity with its formula, and the name of the part of the equations to which it belongs."""

    id: str
    formula: Expression
    symbol: Symbol | str
    kind: str
    part: str
