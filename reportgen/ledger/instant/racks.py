"""Accelerations of discs that roll on bodies in translation, as between two racks.

Along the racks the velocities of the centre and of the points of contact differ by ω times their distance, at any time;
so do the accelerations of the centre and of the racks by ε times it.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import permutations

from reportgen.catalogue import plane_motion_file as file
from reportgen.ledger.instant.board import Step, Vector
from reportgen.ledger.instant.parts import Parts
from reportgen.notation.expressions import Expression, Negative, Ref, signed, total
from reportgen.plane_motion.conditions import GROUND
from reportgen.plane_motion.ways import parallel


@dataclass(frozen=True, slots=True)
class Node:
    """The centre of a disc or a point of contact: the point whose acceleration it shares along the racks.

    That is the centre itself or a point of the rack; "" of the ground.  `value` is its acceleration along them.
    """

    name: str
    shares: str
    value: float
    known: bool


def by_rack(parts: Parts) -> bool:
    """ε of one more disc, or the acceleration of its centre or of a rack; whether there was one."""
    for body in parts.board.layout.members:
        u = _along(parts, body)
        nodes = [*_nodes(parts, body, u)] if u else []
        for one, other in permutations(nodes, 2):
            if not one.known or parts.board.layout.points[one.name] == parts.board.layout.points[other.name]:
                continue
            if other.known and not parts.board.knows(f"eps.{body}"):
                _rate(parts, body, u, one, other)
                return True
            if not other.known and parts.board.knows(f"eps.{body}"):
                _point(parts, body, u, one, other)
                return True
    return False


def _along(parts: Parts, body: int) -> complex:
    """The direction of the racks that a disc rolls on; 0 for a disc that rolls on none, or on other things too."""
    layout, ways = parts.board.layout, []
    for joint in layout.given.joints:
        if isinstance(joint, file.RollingOnLine) and joint.disc == body and joint.on != GROUND:
            centre, way = layout.centres.get(joint.on), layout.geometry.direction(joint)
            if centre is None or centre.rule != "translation" or not centre.by_joint or not parallel(centre.way, way):
                return 0j
            ways.append(way)
    return ways[0] if ways and all(parallel(way, ways[0]) for way in ways) else 0j


def _nodes(parts: Parts, body: int, u: complex) -> Iterator[Node]:
    layout = parts.board.layout
    disc = layout.given.disc(body)
    assert disc is not None
    yield _node(parts, disc.centre, disc.centre, u)
    for index, joint in enumerate(layout.given.joints):
        if isinstance(joint, file.RollingOnLine) and joint.disc == body:
            own = layout.own(joint.on) if joint.on != GROUND else [""]
            shares = next((name for name in own if name in parts.of), own[0] if own else "")
            yield _node(parts, layout.contacts[index], shares, u)


def _node(parts: Parts, name: str, shares: str, u: complex) -> Node:
    if not shares:
        return Node(name, "", 0.0, known=True)
    value = (u.conjugate() * parts.board.motion.a(shares)).real
    vectors = parts.of.get(shares)
    return Node(name, shares, value, vectors is not None and len(vectors) < 2)


def _size(parts: Parts, node: Node) -> Ref | None:
    """The size of a node's acceleration; None where it has none."""
    vectors = parts.board.nonzero(*parts.of[node.shares]) if node.shares else ()
    return parts.board.q[vectors[0].id] if vectors else None


def _turn(parts: Parts, u: complex, one: Node, other: Node) -> float:
    """How far the other node is from the one across the racks, with the sign of what ε adds along them."""
    points = parts.board.layout.points
    return (u.conjugate() * 1j * (points[other.name] - points[one.name])).real


def _rate(parts: Parts, body: int, u: complex, one: Node, other: Node) -> None:
    board, q = parts.board, parts.board.q
    sense = math.copysign(1.0, board.motion.epsilon(body)) * math.copysign(1.0, _turn(parts, u, one, other))
    sizes = ((_size(parts, other), other.value), (_size(parts, one), -one.value))
    terms = [signed(sense * value, size) for size, value in sizes if size is not None]
    arm = board.length(one.name, other.name)
    if terms:
        q.define(f"eps.{body}", _sum(terms) / arm)
    else:
        q.give(f"eps.{body}", 0.0)
    board.steps.append(Step("acceleration-rack", (arm.id, f"eps.{body}"), body, other.name, one.name))


def _point(parts: Parts, body: int, u: complex, one: Node, other: Node) -> None:
    board, q, id = parts.board, parts.board.q, f"a.{other.shares}"
    sense, size = math.copysign(1.0, other.value), _size(parts, one)
    terms = [signed(sense * one.value, size)] if size is not None else []
    arm = board.length(one.name, other.name)
    if q.si(f"eps.{body}"):
        turning = board.motion.epsilon(body) * _turn(parts, u, one, other)
        terms.append(signed(sense * turning, q[f"eps.{body}"] * arm))
    if terms:
        q.define(id, _sum(terms))
    else:
        q.give(id, 0.0)
    parts.of[other.shares] = (Vector(id, sense * u),) if other.value else ()
    board.steps.append(Step("acceleration-rack-point", (arm.id, id), body, other.shares, one.name))


def _sum(terms: list[Expression]) -> Expression:
    return total(sorted(terms, key=lambda term: isinstance(term, Negative)))
