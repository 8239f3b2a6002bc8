"""Velocities by the base point: of a body whose centre nothing tells, and of two that hang between known points."""

from __future__ import annotations

from reportgen.ledger.instant.speeds import Board
from reportgen.ledger.instant.steps import COORDINATES, Axis, Equation, Step
from reportgen.ledger.instant.vectors import Vector, components, solved_for
from reportgen.notation.expressions import Symbol, sqrt, total
from reportgen.plane_motion.ways import perpendicular


def by_base_point(board: Board) -> bool:
    """One more velocity v_M = v_A + v_MA of a body that turns at a known rate, or the rates of two such bodies."""
    bodies = {body: names for body, names in board.layout.members.items() if body not in board.layout.centres}
    for body, names in bodies.items():
        base = next((name for name in names if board.knows(f"v.{name}")), "")
        new = next((name for name in names if not board.knows(f"v.{name}")), "")
        if base and new and board.knows(f"omega.{body}") and _point(board, body, new, base):
            return True
    for body, names in bodies.items():
        for other, others in bodies.items():
            shared = [name for name in names if name in others and not board.knows(f"v.{name}")]
            if body < other and shared and _between(board, body, other, shared[0]):
                return True
    return False


def from_base_point(board: Board) -> bool:
    """One more body in plane motion whose ω follows from a base point, or one more point of one whose ω is known."""
    layout = board.layout
    for body, names in layout.members.items():
        centre = layout.centres.get(body)
        if centre is not None and centre.by_joint:
            continue
        if centre is not None and centre.rule == "contact" and not board.knows(f"v.{centre.name}"):
            board.q.give(f"v.{centre.name}", 0.0)
        known = [name for name in names if board.knows(f"v.{name}")]
        new = [name for name in names if not board.knows(f"v.{name}")]
        if board.knows(f"omega.{body}"):
            moving = [name for name in known if board.q.si(f"v.{name}")]
            if known and new and _point(board, body, new[0], (moving or known)[0]):
                return True
            continue
        for base in sorted(known, key=lambda name: board.q.si(f"v.{name}") == 0):
            guided = [name for name in new if name in layout.ways]
            if any(_rate(board, body, point, base) for point in (*known, *guided) if point != base):
                return True
    return False


def _rate(board: Board, body: int, point: str, base: str) -> bool:
    """ω from v_B = v_A + v_BA, with v_B known, or its line: projected on AB, then on the perpendicular to it."""
    q, layout = board.q, board.layout
    arm = layout.points[point] - layout.points[base]
    line, new = board.way(arm), not board.knows(f"v.{point}")
    turn = board.motion.omega(body)
    way = board.way(board.at(point)) or layout.ways.get(point, 0j)
    if not line or (new and perpendicular(way, line)):
        return False
    whole, relative = Vector(f"v.{point}", way), Vector(f"v.{point}{base}", 1j * line * (1 if turn >= 0 else -1))
    bases = (board.velocity(base),) if q.si(f"v.{base}") else ()
    unknown = (whole.id, relative.id) if new else (relative.id,)
    equation = Equation((whole,), (*bases, relative), unknown)
    lines: tuple[str, ...] = ()
    axes: tuple[Axis, ...] = ()
    if new:
        axes = (Axis("ξ", line, point),)
        lines = (q.define(whole.id, solved_for(q, way, line, bases, ())).id,)
    elif not bases and not q.si(whole.id):
        return False
    wholes = (whole,) if q.si(whole.id) else ()
    if turn:
        q.define(relative.id, solved_for(q, relative.way, relative.way, wholes, bases))
        q.define(f"omega.{body}", q[relative.id] / board.length(base, point))
        axes = (*axes, Axis("η", relative.way, point))
        lines = (*lines, relative.id, f"omega.{body}")
    else:
        q.give(f"omega.{body}", 0.0)
    kind = "base-rate" if turn else "base-translation"
    kind = kind if new else "base-known"
    board.steps.append(Step(kind, lines, body, point, base, equation, axes))
    return True


def _relative(board: Board, body: int, point: str, base: str) -> Vector:
    arm = board.layout.points[point] - board.layout.points[base]
    return Vector(f"v.{point}{base}", board.way(1j * board.motion.omega(body) * arm))


def _point(board: Board, body: int, point: str, base: str) -> bool:
    q, relative = board.q, _relative(board, body, point, base)
    lines: tuple[str, ...] = ()
    if not board.knows(relative.id):
        lines = (q.define(relative.id, q[f"omega.{body}"] * board.length(base, point)).id,)
    parts = [one for one in (board.velocity(base), relative) if q.si(one.id)]
    squares, axes = [], []
    for axis, name in COORDINATES:
        if terms := components(q, parts, axis):
            one = q.define(f"v.{point}.{name}", total(terms), Symbol("v", f"{point}{name}"), "velocity")
            squares.append(one**2)
            axes.append(Axis(name, axis, point))
            lines = (*lines, one.id)
    if not squares:
        q.give(f"v.{point}", 0.0)
        return True
    q.define(f"v.{point}", sqrt(total(squares)))
    whole = board.velocity(point)
    equation = Equation((whole,), tuple(parts), (whole.id,))
    board.steps.append(Step("base-point", (*lines, whole.id), body, point, base, equation, tuple(axes)))
    return True


def _between(board: Board, body: int, other: int, point: str) -> bool:
    """v_A + v_CA = v_B + v_CB: two unknown sizes, the first by projection on the line CB."""
    q, members = board.q, board.layout.members
    bases = [next((n for n in members[one] if board.knows(f"v.{n}")), "") for one in (body, other)]
    if "" in bases or board.knows(f"omega.{body}") or board.knows(f"omega.{other}"):
        return False
    first, second = (_relative(board, one, point, base) for one, base in zip((body, other), bases, strict=True))
    line = board.way(board.layout.points[point] - board.layout.points[bases[1]])
    if not (first.way and second.way) or abs((line.conjugate() * first.way).real) < 1e-9:
        return False
    one, two = ((board.velocity(base),) if q.si(f"v.{base}") else () for base in bases)
    equation = Equation((*one, first), (*two, second), (first.id, second.id))
    q.define(first.id, solved_for(q, first.way, line, two, one))
    q.define(second.id, solved_for(q, second.way, second.way, (*one, first), two))
    lines = [first.id, second.id]
    for turning, vector, base in zip((body, other), (first, second), bases, strict=True):
        lines.append(q.define(f"omega.{turning}", q[vector.id] / board.length(base, point)).id)
    axes = Axis("ξ", line, point), Axis("η", second.way, point)
    board.steps.append(Step("two-bases", tuple(lines), body, point, bases[0], equation, axes))
    return True
