"""Velocities by the base point: of a body whose centre nothing tells, and of two that hang between known points."""

from __future__ import annotations

from reportgen.ledger.instant.board import Board, Projected, Vector
from reportgen.plane_motion.ways import perpendicular


def by_base_point(board: Board) -> bool:
    """One more velocity v_M = v_A + v_MA of a body that turns at a known rate, or the rates of two such bodies."""
    bodies = {body: names for body, names in board.layout.members.items() if body not in board.layout.centres}
    for body, names in bodies.items():
        known = [name for name in names if board.knows(f"v.{name}")]
        # A base point that is worked out by components itself comes last.
        base = min(known, key=lambda name: board.knows(f"v.{name}.x") or board.knows(f"v.{name}.y"), default="")
        new = next((name for name in names if name not in known), "")
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
    bases = board.nonzero(board.velocity(base))
    if not new and not bases and not q.si(whole.id):
        return False
    equation = Projected(board, (whole,), (*bases, relative))
    if new:
        equation.find(whole, line, "ξ", point)
    if turn:
        size = equation.find(relative, relative.way, "η", point)
        equation.then(q.define(f"omega.{body}", size / board.length(base, point)))
    else:
        q.give(f"omega.{body}", 0.0)
    kind = "base-rate" if turn else "base-translation"
    equation.step(kind if new else "base-known", body, point, base)
    return True


def _relative(board: Board, body: int, point: str, base: str) -> Vector:
    arm = board.layout.points[point] - board.layout.points[base]
    return Vector(f"v.{point}{base}", board.way(1j * board.motion.omega(body) * arm))


def _point(board: Board, body: int, point: str, base: str) -> bool:
    """v_B = v_A + v_BA with v_A and ω known, by its components along x and y."""
    q, relative = board.q, _relative(board, body, point, base)
    lines: tuple[str, ...] = ()
    if not board.knows(relative.id):
        lines = (q.define(relative.id, q[f"omega.{body}"] * board.length(base, point)).id,)
    parts = board.nonzero(board.velocity(base), relative)
    if not parts:
        q.give(f"v.{point}", 0.0)
        return True
    equation = Projected(board, (board.velocity(point),), parts, lines)
    equation.find_sum("v", point)
    equation.step("base-point", body, point, base)
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
    one, two = (board.nonzero(board.velocity(base)) for base in bases)
    equation = Projected(board, (*one, first), (*two, second))
    sizes = equation.find(first, line, "ξ", point), equation.find(second, second.way, "η", point)
    for turning, size, base in zip((body, other), sizes, bases, strict=True):
        equation.then(q.define(f"omega.{turning}", size / board.length(base, point)))
    equation.step("two-bases", body, point, bases[0])
    return True
