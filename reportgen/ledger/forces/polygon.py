"""Force plans: vertices head to tail, one scale for all positions, forces read between vertices."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from reportgen.ledger.forces.loads import Statics
from reportgen.ledger.kinematics.names import segment_symbol
from reportgen.notation.expressions import (
    Expression,
    Symbol,
    add,
    call,
    divide,
    evaluate,
    multiply,
    subtract,
)
from reportgen.notation.numbers import nice_up

PLAN_BOX = (0.160, 0.200)
"""Every force plan of a group fits into this box on paper (m): one scale serves them all."""
LETTERS = "efghijklmqrtuvwxyzabcd"
"""Vertices of a force plan in the order of drawing; n is where the unknown sides meet."""


@dataclass(frozen=True, slots=True)
class Side:
    """One force of a polygon, from vertex to vertex; `unknown` sides are found by closing it.

    `link` is the link it acts on.
    """

    name: str
    start: str
    end: str
    unknown: bool = False
    link: int = 0


@dataclass(frozen=True, slots=True)
class Polygon:
    """A group's force plan: its sides head to tail and the joints read from it.

    `reads` are further vectors read between vertices, e.g. the reaction in the inner joint.
    """

    name: str
    sides: tuple[Side, ...]
    reads: tuple[Side, ...] = ()


class Path:
    """The known forces of a plan laid head to tail from vertex e."""

    def __init__(self) -> None:
        self._letters = iter(LETTERS)
        self.first = self.last = next(self._letters)
        self.corners: dict[str, Expression] = {self.first: multiply(0.0)}
        self.sides: list[Side] = []

    def lay(self, name: str, link: int) -> None:
        """Lay the force `F.name` on from the last vertex."""
        letter = next(self._letters)
        self.corners[letter] = add(self.corners[self.last], f"F.{name}")
        self.sides.append(Side(name, self.last, letter, link=link))
        self.last = letter


def force_plan(statics: Statics, name: str, title: str, corners: Mapping[str, Expression]) -> str:
    """Choose μ_R so that the plan fits its box at every position, and enter the vertices on paper."""
    b = statics.b
    values = {id: family.values for id, family in b.families.items()}
    places = np.array([np.broadcast_to(evaluate(corner, values), (b.positions,)) for corner in corners.values()])
    places = places[:, np.isfinite(places).all(axis=0)]
    needed = 0.0
    if places.size:
        width, height = np.ptp(places.real, axis=0).max(), np.ptp(places.imag, axis=0).max()
        needed = max(width / PLAN_BOX[0], height / PLAN_BOX[1])
    mu = f"mu.R{name}"
    b.give(mu, Symbol("μ", title), "force scale", nice_up(max(needed, 1e-9) / 1e3) * 1e3)
    for letter, corner in corners.items():
        b.construct(f"plan.R{name}.{letter}", divide(corner, mu))
    return mu


def read(statics: Statics, plan: str, name: str, symbol: Symbol, id: str, start: str, end: str) -> None:
    """A force read from a plan between two vertices: its segment, its size and its vector."""
    b, mu = statics.b, f"mu.R{plan}"
    along = subtract(f"plan.R{plan}.{end}", f"plan.R{plan}.{start}")
    scale = statics.force
    segment = f"seg.{plan}.{name}"
    b.define(
        segment,
        segment_symbol(start, end),
        "segment",
        call("abs", along),
        scale=scale / float(b.value(mu)[0]),
    )
    b.define(id, symbol, "force", multiply(mu, segment), scale=scale)
    b.construct(f"F.{name}", multiply(mu, along))
    b.define(f"dir.{name}", Symbol("α", symbol.sub), "angle", call("heading", f"F.{name}"), scale=1.0)


def drawn_sides(statics: Statics, plan: str, sides: list[Side]) -> None:
    """The drawn lengths of a plan's known forces."""
    for side in sides:
        statics.b.define(
            f"seg.{plan}.{side.name}",
            segment_symbol(side.start, side.end),
            "segment",
            call("abs", divide(f"F.{side.name}", f"mu.R{plan}")),
            scale=PLAN_BOX[1],
        )
