"""Accelerations, step by step: by the base point, each vector equation with two unknown sizes, projected on an axis."""

from __future__ import annotations

from collections.abc import Callable
from itertools import permutations

from reportgen.catalogue import plane_motion_file as file
from reportgen.catalogue.plane_motion_places import unit
from reportgen.ledger.instant.board import Board, Equation, Projected, Step, Vector, components
from reportgen.ledger.instant.parts import Parts, Path, enter_end, enter_normal, enter_tangential, known_path, relative
from reportgen.ledger.instant.racks import by_rack
from reportgen.ledger.instant.slot_accelerations import by_slot
from reportgen.ledger.instant.speeds import enter_blocks
from reportgen.ledger.instant.trains import by_train
from reportgen.notation.expressions import sqrt
from reportgen.plane_motion.conditions import GROUND
from reportgen.plane_motion.ways import parallel, perpendicular


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
    if _by_rims(parts) or by_train(board, "eps") or by_rack(parts):
        return True
    return any(by_slot(parts, joint) for joint in board.layout.given.slots) or enter_blocks(board, "eps")


# --- about a known point --------------------------------------------------------------------------


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
    normal, tangential = relative(parts, body, point, base)
    lines = enter_normal(parts, body, point, base, normal) + enter_tangential(parts, body, point, base, tangential)
    own = parts.board.nonzero(normal, tangential)
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
            if point not in parts.of and (path := known_path(parts, point, body)) is not None:
                return _two_unknown(parts, body, point, base, path)
    return False


def _two_unknown(parts: Parts, body: int, point: str, base: str, path: Path) -> bool:
    """a_P = a_B + aⁿ + aᵗ with two unknown sizes: along BP there is no aᵗ, and across it there is no aⁿ."""
    board, q = parts.board, parts.board.q
    normal, tangential = relative(parts, body, point, base)
    line = board.way(board.layout.points[point] - board.layout.points[base])
    if perpendicular(line, path.unknown.way):
        return False
    lines = path.lines + enter_normal(parts, body, point, base, normal)
    bases = (*parts.of[base], *board.nonzero(normal))
    equation = Projected(board, (*path.known, path.unknown), (*bases, tangential), lines)
    equation.find(path.unknown, line, "ξ", point)
    size = equation.find(tangential, tangential.way, "η", point)
    equation.then(q.define(f"eps.{body}", size / board.length(base, point)))
    enter_end(parts, point, path, equation)
    equation.step("acceleration-base", body, point, base)
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
    arm, line = board.length(base, point), board.way(board.layout.points[point] - board.layout.points[base])
    normal, tangential = relative(parts, body, point, base)
    equation = Projected(board, parts.of[point], (*parts.of[base], normal, tangential))
    equation.then(q.define(f"omega.{body}", sqrt(equation.find(normal, line, "ξ", point) / arm)))
    equation.then(q.define(f"eps.{body}", equation.find(tangential, tangential.way, "η", point) / arm))
    equation.step("acceleration-free", body, point, base)
    return True


# --- the whole of a point's acceleration ------------------------------------------------------------


def _whole(parts: Parts, point: str) -> None:
    """The size of an acceleration from its parts: of one, of two at a right angle, or of its components."""
    board, q, vectors = parts.board, parts.board.q, parts.board.nonzero(*parts.of[point])
    if not vectors:
        q.give(f"a.{point}", 0.0)
        return
    whole = Projected(board, (), vectors)
    if len(vectors) == 1:
        whole.then(q.define(f"a.{point}", q[vectors[0].id]))
    elif len(vectors) == 2 and perpendicular(vectors[0].way, vectors[1].way):
        whole.then(q.define(f"a.{point}", sqrt(q[vectors[0].id] ** 2 + q[vectors[1].id] ** 2)))
    else:
        whole.find_sum("a", point)
    whole.step("acceleration-whole", GROUND, point)
