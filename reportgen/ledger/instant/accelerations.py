"""Accelerations, step by step: by the base point, each vector equation with two unknown sizes, projected on an axis."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from itertools import permutations

from reportgen.catalogue import plane_motion_file as file
from reportgen.catalogue.plane_motion_places import direction, unit
from reportgen.ledger.instant.speeds import Board, enter_blocks
from reportgen.ledger.instant.steps import COORDINATES, Axis, Equation, Step
from reportgen.ledger.instant.trains import by_train
from reportgen.ledger.instant.vectors import Vector, components, solved_for, towards
from reportgen.notation.expressions import Symbol, sqrt, total
from reportgen.plane_motion.conditions import GROUND
from reportgen.plane_motion.ways import parallel


@dataclass
class Parts:
    """The accelerations of points as vectors that add up to them; none for a point at rest or in uniform motion."""

    board: Board
    of: dict[str, tuple[Vector, ...]] = field(default_factory=dict)

    def vector(self, id: str, value: complex) -> Vector:
        return Vector(id, self.board.way(value))

    def nonzero(self, *vectors: Vector) -> tuple[Vector, ...]:
        """Those of the vectors that are on the board and are not nothing."""
        return tuple(one for one in vectors if self.board.knows(one.id) and self.board.q.si(one.id))


def enter_accelerations(board: Board, together: Callable[[Parts], bool]) -> None:
    """Given rates first; then every rate that follows from the velocities and from them.

    Where no vector equation gives more, `together` solves what is left as one system.
    """
    parts = Parts(board)
    _given(parts)
    while _next(parts) or together(parts):
        pass
    for asked in board.layout.given.find:
        if asked.what == "a" and asked.of in parts.of and not board.knows(asked.id):
            _whole(parts, asked.of)


def _given(parts: Parts) -> None:
    board = parts.board
    for rate in board.layout.given.given:
        match rate:
            case file.EpsilonOf(body=body, value=value):
                board.given(f"eps.{body}", value.si)
            case file.AccelerationOf(point=point, size=size, direction=angle) if size is not None:
                board.given(f"a.{point}", size.si)
                way = unit(angle.si) * (1 if size.si >= 0 else -1)
                parts.of[point] = (Vector(f"a.{point}", way),) if size.si else ()
            case file.FromRest(point=point, acceleration=acceleration, direction=angle):
                parts.of[point] = (Vector(f"a.{point}", unit(angle.si) * (1 if acceleration.si >= 0 else -1)),)
    for body, centre in board.layout.centres.items():
        if centre.rule == "pivot":
            parts.of[centre.name] = ()
        if centre.rule == "translation" and not board.knows(f"eps.{body}") and _held(board, body):
            board.q.give(f"eps.{body}", 0.0)


def _held(board: Board, body: int) -> bool:
    """Whether a joint keeps a body from turning, not only at the instant."""
    joints = board.layout.given.joints
    return any(
        one.body == body and (isinstance(one, file.Translation) or one.on == GROUND)
        for one in joints
        if isinstance(one, file.Slider | file.Translation)
    )


def _next(parts: Parts) -> bool:
    """One more body whose rate, or one of whose points becomes known; whether there was one."""
    board = parts.board
    for body in board.layout.members:
        names = board.layout.own(body)
        if _free(parts, body, names) or _rolling(parts, body) or _points(parts, body, names):
            return True
        if _by_base(parts, body, names):
            return True
    if _by_rims(parts) or by_train(board, "eps"):
        return True
    return any(_slot(parts, joint) for joint in board.layout.given.slots) or enter_blocks(board, "eps")


# --- about a known point --------------------------------------------------------------------------


def _relative(parts: Parts, body: int, point: str, base: str) -> tuple[Vector, Vector]:
    """The normal and the tangential acceleration of a point about another of its body, as vectors."""
    board = parts.board
    arm = board.layout.points[point] - board.layout.points[base]
    eps = board.motion.epsilon(body)
    pivot = board.layout.centres.get(body)
    fixed = pivot is not None and pivot.rule == "pivot" and pivot.name == base
    name = point if fixed else f"{point}{base}"
    return parts.vector(f"a.{name}.n", -arm), parts.vector(f"a.{name}.t", 1j * arm * (1 if eps >= 0 else -1))


def _enter_normal(parts: Parts, body: int, point: str, base: str, normal: Vector) -> tuple[str, ...]:
    """aⁿ = ω² l; no line where the body does not turn."""
    return _enter_part(parts, normal.id, f"omega.{body}", 2, base, point)


def _enter_tangential(parts: Parts, body: int, point: str, base: str, tangential: Vector) -> tuple[str, ...]:
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


def _points(parts: Parts, body: int, names: list[str]) -> bool:
    """The accelerations of points of a body whose ω and ε are known, about one whose acceleration is."""
    board = parts.board
    # The base point whose acceleration has the fewest parts, as the centre of a wheel or a pivot.
    known = [name for name in _with_pivot(parts, body, names) if name in parts.of]
    base = min(known, key=lambda name: len(parts.of[name]), default=None)
    new = [name for name in names if name not in parts.of]
    if base is None or not new or not (board.knows(f"omega.{body}") and board.knows(f"eps.{body}")):
        return False
    point = new[0]
    normal, tangential = _relative(parts, body, point, base)
    lines = _enter_normal(parts, body, point, base, normal) + _enter_tangential(parts, body, point, base, tangential)
    own = parts.nonzero(normal, tangential)
    parts.of[point] = (*parts.of[base], *own)
    equation = Equation((), parts.of[point])
    kind = "acceleration-point" if parts.of[base] else "acceleration-pivot"
    board.steps.append(Step(kind, lines, body, point, base, equation))
    return True


def _with_pivot(parts: Parts, body: int, names: list[str]) -> list[str]:
    """The points of a body, its pivot first."""
    centre = parts.board.layout.centres.get(body)
    return [centre.name, *names] if centre is not None and centre.rule == "pivot" else names


# --- two unknown sizes ----------------------------------------------------------------------------


def _by_base(parts: Parts, body: int, names: list[str]) -> bool:
    """ε of a body from one point with a known acceleration and another on a known path: projected on their line."""
    board = parts.board
    if board.knows(f"eps.{body}") or not board.knows(f"omega.{body}"):
        return False
    bases = [name for name in names if name in parts.of]
    for base in bases:
        for point in names:
            if point not in parts.of and (path := _path(parts, point, body)) is not None:
                return _two_unknown(parts, body, point, base, path)
    return False


@dataclass(frozen=True)
class Path:
    """What is known of the acceleration of a point, its part of unknown size, the body and base that it is about."""

    known: tuple[Vector, ...]
    unknown: Vector
    body: int = GROUND
    base: str = ""
    lines: tuple[str, ...] = ()


def _path(parts: Parts, point: str, body: int) -> Path | None:
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
            normal, tangential = _relative(parts, other, point, centre.name)
            lines = _enter_normal(parts, other, point, centre.name, normal)
            return Path(parts.nonzero(normal), tangential, other, centre.name, lines)
    for other in layout.members:
        names = layout.own(other)
        base = next((name for name in names if name in parts.of), "")
        if other != body and point in names and base and board.knows(f"omega.{other}"):
            normal, tangential = _relative(parts, other, point, base)
            lines = _enter_normal(parts, other, point, base, normal)
            return Path((*parts.of[base], *parts.nonzero(normal)), tangential, other, base, lines)
    return None


def _two_unknown(parts: Parts, body: int, point: str, base: str, path: Path) -> bool:
    known, unknown, lines = path.known, path.unknown, path.lines
    board, q = parts.board, parts.board.q
    normal, tangential = _relative(parts, body, point, base)
    across = board.way(board.layout.points[point] - board.layout.points[base])
    if abs((across.conjugate() * unknown.way).real) < 1e-9:
        return False
    lines += _enter_normal(parts, body, point, base, normal)
    bases = (*parts.of[base], *parts.nonzero(normal))
    equation = Equation((*known, unknown), (*bases, tangential), (unknown.id, tangential.id))
    q.define(unknown.id, solved_for(q, unknown.way, across, bases, known))
    # Now only the tangential acceleration about the base is unknown: perpendicular to the line.
    q.define(tangential.id, solved_for(q, tangential.way, tangential.way, (*known, unknown), bases))
    q.define(f"eps.{body}", q[tangential.id] / board.length(base, point))
    lines += (unknown.id, tangential.id, f"eps.{body}")
    parts.of[point] = (*known, *parts.nonzero(unknown))
    if path.body and not board.knows(f"eps.{path.body}"):
        q.define(f"eps.{path.body}", q[unknown.id] / board.length(path.base, point))
        lines += (f"eps.{path.body}",)
    axes = Axis("ξ", across, point), Axis("η", tangential.way, point)
    board.steps.append(Step("acceleration-base", lines, body, point, base, equation, axes))
    return True


# --- discs, free bodies, slots --------------------------------------------------------------------


def _rolling(parts: Parts, body: int) -> bool:
    """ε = aᵗ/r of a disc that rolls on the ground: what the acceleration of its centre is along the way it rolls."""
    board, q = parts.board, parts.board.q
    centre, disc = board.layout.centres.get(body), board.layout.given.disc(body)
    if centre is None or disc is None or centre.rule != "contact" or board.knows(f"eps.{body}"):
        return False
    if disc.centre not in parts.of:
        return False
    along = 1j * board.way(board.layout.points[disc.centre] - centre.at)
    terms = [one for one in parts.of[disc.centre] if parallel(one.way, along)]
    if len(terms) > 1 or any(components(q, [one], along) for one in parts.of[disc.centre] if one not in terms):
        return False
    radius = board.length(centre.name, disc.centre, centre.at)
    if terms:
        q.define(f"eps.{body}", q[terms[0].id] / radius)
    else:
        q.give(f"eps.{body}", 0.0)
    board.steps.append(Step("acceleration-rolling", (radius.id, f"eps.{body}"), body, disc.centre, centre.name))
    return True


def _by_rims(parts: Parts) -> bool:
    """ε of one more of two discs with fixed centres, whose rims move alike at any time."""
    board, q, layout = parts.board, parts.board.q, parts.board.layout
    for bodies, ends in layout.rims():
        if not layout.turn_on_ground(bodies):
            continue
        for (known, base), (new, point) in permutations(zip(bodies, ends, strict=True)):
            if board.knows(f"eps.{known}") and not board.knows(f"eps.{new}"):
                r1, r2 = (board.length(layout.centres[one].name, end) for one, end in ((known, base), (new, point)))
                q.define(f"eps.{new}", q[f"eps.{known}"] * r1 / r2)
                board.steps.append(Step("acceleration-rims", (r1.id, r2.id, f"eps.{new}"), new, point, base))
                return True
    return False


def _free(parts: Parts, body: int, names: list[str]) -> bool:
    """ω and ε of a body from the accelerations of two of its points."""
    board, q = parts.board, parts.board.q
    known = [name for name in names if name in parts.of]
    if board.knows(f"omega.{body}") or len(known) < 2 or body in board.layout.centres:
        return False
    base, point = known[0], known[1]
    arm = board.length(base, point)
    normal, tangential = _relative(parts, body, point, base)
    equation = Equation(parts.of[point], (*parts.of[base], normal, tangential), (normal.id, tangential.id))
    q.define(normal.id, solved_for(q, normal.way, normal.way, parts.of[point], parts.of[base]))
    q.define(f"omega.{body}", sqrt(q[normal.id] / arm))
    q.define(tangential.id, solved_for(q, tangential.way, tangential.way, parts.of[point], parts.of[base]))
    q.define(f"eps.{body}", q[tangential.id] / arm)
    lines = (normal.id, f"omega.{body}", tangential.id, f"eps.{body}")
    axes = (
        Axis("ξ", board.way(board.layout.points[point] - board.layout.points[base]), point),
        Axis("η", tangential.way, point),
    )
    board.steps.append(Step("acceleration-free", lines, body, point, base, equation, axes))
    return True


def _slot(parts: Parts, joint: file.SlotJoint) -> bool:
    """ε of a body with a pivot from the acceleration of a point that slides along its line: Coriolis' is part of it."""
    board, q, body, point = parts.board, parts.board.q, joint.on, joint.point
    centre = board.layout.centres.get(body)
    if centre is None or centre.rule != "pivot" or board.knows(f"eps.{body}") or point not in parts.of:
        return False
    if not (board.knows(f"omega.{body}") and board.knows(f"v.{point}.r")):
        return False
    u = direction(joint, board.layout.points)
    arm = board.way(board.layout.points[point] - centre.at)
    if not parallel(u, arm):
        return False
    motion = board.motion
    relative = board.at(point) - board.at(point, body)
    normal = Vector(f"a.{point}e.n", -arm)
    tangential = Vector(f"a.{point}e.t", 1j * arm * (1 if motion.epsilon(body) >= 0 else -1))
    coriolis = Vector(f"a.{point}.k", board.way(2j * motion.omega(body) * relative))
    along = motion.a(point) - motion.a(point, body) - 2j * motion.omega(body) * relative
    sliding = Vector(f"a.{point}.r", board.way(complex((u.conjugate() * along).real) * u))
    lines: tuple[str, ...] = ()
    length = board.length(centre.name, point)
    if q.si(f"omega.{body}"):
        q.define(normal.id, q[f"omega.{body}"] ** 2 * length)
        lines += (normal.id,)
        if q.si(f"v.{point}.r"):
            q.define(coriolis.id, 2 * q[f"omega.{body}"] * q[f"v.{point}.r"])
            lines += (coriolis.id,)
    known = parts.nonzero(normal, coriolis)
    equation = Equation(parts.of[point], (*known, tangential, sliding), (tangential.id, sliding.id))
    value = solved_for(q, tangential.way, 1j * u, parts.of[point], known)
    q.define(tangential.id, value)
    q.define(f"eps.{body}", q[tangential.id] / length)
    lines += (tangential.id, f"eps.{body}")
    axis = Axis("η", towards(1j * u, tangential.way), point)
    board.steps.append(Step("acceleration-slot", lines, body, point, centre.name, equation, (axis,)))
    return True


# --- the whole of a point's acceleration ------------------------------------------------------------


def _whole(parts: Parts, point: str) -> None:
    """The size of an acceleration from its parts: of one, of two at a right angle, or of its components."""
    board, q, vectors = parts.board, parts.board.q, parts.nonzero(*parts.of[point])
    if not vectors:
        q.give(f"a.{point}", 0.0)
        return
    axes: tuple[Axis, ...] = ()
    if len(vectors) == 1:
        q.define(f"a.{point}", q[vectors[0].id])
        lines: tuple[str, ...] = (f"a.{point}",)
    elif len(vectors) == 2 and abs((vectors[0].way.conjugate() * vectors[1].way).real) < 1e-9:
        q.define(f"a.{point}", sqrt(q[vectors[0].id] ** 2 + q[vectors[1].id] ** 2))
        lines = (f"a.{point}",)
    else:
        lines = ()
        squares = []
        for axis, name in COORDINATES:
            terms = components(q, vectors, axis)
            if terms:
                one = q.define(f"a.{point}.{name}", total(terms), Symbol("a", f"{point}{name}"), "acceleration")
                squares.append(one**2)
                axes += (Axis(name, axis, point),)
                lines += (one.id,)
        q.define(f"a.{point}", sqrt(total(squares)))
        lines += (f"a.{point}",)
    equation = Equation((), vectors)
    board.steps.append(Step("acceleration-whole", lines, point=point, equation=equation, axes=axes))
