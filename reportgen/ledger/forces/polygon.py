"""Force plans: vertices head to tail, a scale for each position, forces read between vertices."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from reportgen.ledger.forces.loads import Statics
from reportgen.ledger.scales import LEAST_FORCES, extents, own_scales
from reportgen.notation import ids
from reportgen.notation.evaluation import evaluate
from reportgen.notation.expressions import Expression, Number, Symbol, heading
from reportgen.notation.sheet import Sheet
from reportgen.notation.vocabulary import segment

LETTERS = "efghijklmqrtuvwxyzabcd"
"""Vertices of a force plan in the order of drawing; n is where the unknown edges meet."""


@dataclass(frozen=True, slots=True)
class Edge:
    """One force of a polygon, from vertex to vertex; `unknown` edges are found by closing it.

    `link` is the link it acts on.
    """

    name: str
    start: str
    end: str
    unknown: bool = False
    link: int = 0

    @property
    def is_reaction(self) -> bool:
        return self.name in ids.reaction_force

    @property
    def part(self) -> str:
        """The component of a reaction, n or t, "" for a whole force."""
        found = ids.reaction_force.read(self.name)
        return found["part"] if found else ""


@dataclass(frozen=True, slots=True)
class Polygon:
    """A group's force plan: its edges head to tail and the joints read from it.

    `reads` are further vectors read between vertices, e.g. the reaction in the inner joint.
    """

    name: str
    edges: tuple[Edge, ...]
    reads: tuple[Edge, ...] = ()

    @property
    def carried(self) -> tuple[Edge, ...]:
        """The reactions that groups solved before have left on these links."""
        return tuple(edge for edge in self.edges if edge.is_reaction and not edge.unknown and not edge.part)


class Path:
    """The known forces of a plan laid head to tail from vertex e."""

    def __init__(self, q: Sheet) -> None:
        self._q = q
        self._letters = iter(LETTERS)
        self.first = self.last = next(self._letters)
        self.corners: dict[str, Expression] = {self.first: Number(0.0)}
        self.edges: list[Edge] = []

    def lay(self, name: str, link: int) -> None:
        """Lay the force `F.name` on from the last vertex."""
        letter = next(self._letters)
        self.corners[letter] = self.corners[self.last] + self._q[ids.force_vector(name)]
        self.edges.append(Edge(name, self.last, letter, link=link))
        self.last = letter


Closing = Callable[[Mapping[str, Expression], Expression], Expression]
"""Where the unknown edges meet, from the vertices of the known ones and the scale that they are drawn at."""


def force_plan(statics: Statics, name: str, title: str, path: Path, closing: Closing | None = None) -> None:
    """Choose μ_R for each position so that its plan fills its space; lay the known forces and close the plan at n.

    Enters their drawn lengths and, on paper, the forces as they are laid (`laid.23.P3`) and the vertices.
    """
    q = statics.q
    corners = path.corners | ({} if closing is None else {"n": closing(path.corners, Number(1.0))})
    values = {id: family.values for id, family in q.families.items()}
    sizes = extents([np.asarray(evaluate(corner, values)) for corner in corners.values()], q.positions)
    μ = q.give(ids.force_scale(name), own_scales(sizes, LEAST_FORCES), Symbol("μ", title))
    vertices: dict[str, Expression] = {path.first: q.construct(ids.force_corner(name, path.first), Number(0.0))}
    for edge in path.edges:
        laid = q.construct(ids.laid_force(name, edge.name), q[ids.force_vector(edge.name)] / μ)
        letters = segment(edge.start, edge.end)
        q.define(
            ids.force_segment(name, edge.name), abs(laid), letters, scale=LEAST_FORCES, of=ids.force_vector(edge.name)
        )
        vertices[edge.end] = q.construct(ids.force_corner(name, edge.end), vertices[edge.start] + laid)
    if closing is not None:
        q.construct(ids.force_corner(name, "n"), closing(vertices, μ))


def read(statics: Statics, plan: str, name: str, symbol: Symbol, id: str, start: str, end: str) -> None:
    """A force read from a plan between two vertices: its segment, its size, its vector and its direction."""
    q, scale = statics.q, statics.force
    μ, along = q[ids.force_scale(plan)], q[ids.force_corner(plan, end)] - q[ids.force_corner(plan, start)]
    drawn = q.define(
        ids.force_segment(plan, name), abs(along), segment(start, end), scale=LEAST_FORCES, of=ids.force_vector(name)
    )
    q.define(id, μ * drawn, symbol, scale=scale)
    vector = q.construct(ids.force_vector(name), μ * along, of=id)
    q.define(ids.force_direction(name), heading(vector), Symbol("α", symbol.sub), scale=1.0, of=id)
