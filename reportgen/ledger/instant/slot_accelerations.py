"""Accelerations of points that slide along lines of moving bodies: Coriolis' acceleration is part of them."""

from __future__ import annotations

from reportgen.catalogue import plane_motion_file as file
from reportgen.ledger.instant.board import Projected, Vector
from reportgen.ledger.instant.parts import Parts, enter_end, known_path
from reportgen.plane_motion.ways import parallel, perpendicular


def by_slot(parts: Parts, joint: file.SlotJoint) -> bool:
    """ε of a body from the acceleration of a point that slides along its line, or from ε that of the point.

    Both sides are projected on the normal to the line, along which the relative acceleration is nothing.
    """
    board, q, body, point = parts.board, parts.board.q, joint.on, joint.point
    base = _base(parts, body, point)
    if not base or not (board.knows(f"omega.{body}") and board.knows(f"v.{point}.r")):
        return False
    u, motion = board.layout.geometry.direction(joint), board.motion
    arm = board.way(board.layout.points[point] - board.layout.points[base])
    told = board.knows(f"eps.{body}")
    path = known_path(parts, point, body) if told and point not in parts.of else None
    if (point in parts.of) == told or (told and path is None) or not arm:
        return False
    if perpendicular(1j * arm, 1j * u) if path is None else parallel(path.unknown.way, u):
        return False
    name = f"{point}e" if parts.of[base] == () else f"{point}{base}"
    relative = board.at(point) - board.at(point, body)
    along = motion.a(point) - motion.a(point, body) - 2j * motion.omega(body) * relative
    normal = Vector(f"a.{name}.n", -arm)
    tangential = Vector(f"a.{name}.t", 1j * arm * (1 if motion.epsilon(body) >= 0 else -1))
    coriolis = Vector(f"a.{point}.k", board.way(2j * motion.omega(body) * relative))
    sliding = Vector(f"a.{point}.r", board.way(complex((u.conjugate() * along).real) * u))
    lines = () if path is None else path.lines
    length = board.length(base, point)
    if q.si(f"omega.{body}"):
        lines += (q.define(normal.id, q[f"omega.{body}"] ** 2 * length).id,)
        if q.si(f"v.{point}.r"):
            lines += (q.define(coriolis.id, 2 * q[f"omega.{body}"] * q[f"v.{point}.r"]).id,)
    if told and q.si(f"eps.{body}"):
        lines += (q.define(tangential.id, q[f"eps.{body}"] * length).id,)
    known = (*parts.of[base], *board.nonzero(normal, coriolis, *((tangential,) if told else ())))
    if path is None:
        equation = Projected(board, parts.of[point], (*known, tangential, sliding), lines)
        size = equation.find(tangential, 1j * u, "η", point)
        equation.then(q.define(f"eps.{body}", size / length))
        equation.step("acceleration-slot", body, point, base)
    else:
        equation = Projected(board, (*path.known, path.unknown), (*known, sliding), lines)
        equation.find(path.unknown, 1j * u, "η", point)
        enter_end(parts, point, path, equation)
        equation.step("acceleration-slot-point", body, point, base)
    return True


def _base(parts: Parts, body: int, point: str) -> str:
    """A point of a body, its pivot first, whose acceleration is known; not the one that slides."""
    centre = parts.board.layout.centres.get(body)
    if centre is not None and centre.rule == "pivot":
        return centre.name
    return next((name for name in parts.board.layout.own(body) if name in parts.of and name != point), "")
