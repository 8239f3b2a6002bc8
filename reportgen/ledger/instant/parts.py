"""What is known of accelerations: of points as vectors that add up to them, of paths but for one size."""

from __future__ import annotations

from dataclasses import dataclass, field

from reportgen.ledger.instant.board import Board, Projected, Vector
from reportgen.plane_motion.conditions import GROUND


@dataclass
class Parts:
    """The accelerations of points as vectors that add up to them; none for a point at rest or in uniform motion."""

    board: Board
    of: dict[str, tuple[Vector, ...]] = field(default_factory=dict)

    def vector(self, id: str, value: complex) -> Vector:
        return Vector(id, self.board.way(value))


def relative(parts: Parts, body: int, point: str, base: str) -> tuple[Vector, Vector]:
    """The normal and the tangential acceleration of a point about another of its body, as vectors."""
    board = parts.board
    arm = board.layout.points[point] - board.layout.points[base]
    eps = board.motion.epsilon(body)
    pivot = board.layout.centres.get(body)
    fixed = pivot is not None and pivot.rule == "pivot" and pivot.name == base
    name = point if fixed else f"{point}{base}"
    return parts.vector(f"a.{name}.n", -arm), parts.vector(f"a.{name}.t", 1j * arm * (1 if eps >= 0 else -1))


def enter_normal(parts: Parts, body: int, point: str, base: str, normal: Vector) -> tuple[str, ...]:
    """aⁿ = ω² l; no line where the body does not turn."""
    return _enter_part(parts, normal.id, f"omega.{body}", 2, base, point)


def enter_tangential(parts: Parts, body: int, point: str, base: str, tangential: Vector) -> tuple[str, ...]:
    """aᵗ = ε l; no line where the angular velocity does not change."""
    return _enter_part(parts, tangential.id, f"eps.{body}", 1, base, point)


def _enter_part(parts: Parts, id: str, rate: str, power: int, base: str, point: str) -> tuple[str, ...]:
    """A part of an acceleration from a rate of the body; the ids of its lines, none where the part is nothing."""
    board = parts.board
    if board.knows(id):
        return ()
    if board.q.si(rate) == 0:
        board.q.give(id, 0.0)
        return ()
    arm = board.length(base, point)
    board.q.define(id, (board.q[rate] if power == 1 else board.q[rate] ** power) * arm)
    return (arm.id, id)


@dataclass(frozen=True)
class Path:
    """What is known of the acceleration of a point, its part of unknown size, the body and base that it is about."""

    known: tuple[Vector, ...]
    unknown: Vector
    body: int = GROUND
    base: str = ""
    lines: tuple[str, ...] = ()


def known_path(parts: Parts, point: str, body: int) -> Path | None:
    """What is known of the acceleration of a point on a known path, its unknown part, and the body it turns with.

    On a straight line of the ground nothing is known; about a pivot, or another known point, the normal acceleration.
    """
    board, layout = parts.board, parts.board.layout
    actual = board.motion.a(point) if point in board.motion.system.points else 0j
    if point in layout.slots:
        u = layout.slots[point]
        return Path((), Vector(f"a.{point}", u if (u.conjugate() * actual).real >= 0 else -u))
    for other, centre in layout.centres.items():
        if other != body and centre.rule == "pivot" and point in layout.own(other) and board.knows(f"omega.{other}"):
            normal, tangential = relative(parts, other, point, centre.name)
            lines = enter_normal(parts, other, point, centre.name, normal)
            return Path(parts.board.nonzero(normal), tangential, other, centre.name, lines)
    for other in layout.members:
        names = layout.own(other)
        base = next((name for name in names if name in parts.of), "")
        if other != body and point in names and base and board.knows(f"omega.{other}"):
            normal, tangential = relative(parts, other, point, base)
            lines = enter_normal(parts, other, point, base, normal)
            return Path((*parts.of[base], *parts.board.nonzero(normal)), tangential, other, base, lines)
    return None


def enter_end(parts: Parts, point: str, path: Path, equation: Projected) -> None:
    """The whole acceleration of a point whose unknown part has been found, and the rate of the body it is about."""
    board, size = parts.board, parts.board.q[path.unknown.id]
    parts.of[point] = (*path.known, *board.nonzero(path.unknown))
    if path.body and not board.knows(f"eps.{path.body}"):
        equation.then(board.q.define(f"eps.{path.body}", size / board.length(path.base, point)))
