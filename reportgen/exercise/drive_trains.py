"""Discs that drive each other by gears, belts and racks: rates from radii.

Seen from an arm that carries two discs, both turn about fixed points and their rims move equally fast.  So their
rotations relative to the arm, and the derivatives of these, are inversely proportional to the radii (Willis' formula).

A disc that rolls on bodies in translation, as between two racks: the velocities of its centre and its points of contact
differ along the racks by ω times their distance, and their accelerations by ε times it.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import permutations

from reportgen.base.records import Record
from reportgen.exercise import file
from reportgen.exercise.acceleration_steps import Parts
from reportgen.exercise.derivation import Derivation, Step, Vector
from reportgen.exercise.instant_centres import Layout
from reportgen.exercise.point_positions import parallel
from reportgen.exercise.rate_conditions import GROUND
from reportgen.formula import Chain, Expression, Negative, Product, Ref, Sum, ids, signed, total, vocabulary


class Pair(Record):
    """Two discs on an arm, each with its centre and the point of its rim where it meets the other disc or the belt."""

    arm: int
    discs: tuple[int, int]
    centres: tuple[str, str]
    rims: tuple[str, str]
    alike: bool
    """True if both turn in one sense against the arm, as in an inner meshing or by an open belt."""


def pairs(layout: Layout) -> Iterator[Pair]:
    """Yield the pairs of discs whose centres are on one moving body."""
    for index, joint in enumerate(layout.given.joints):
        if not isinstance(joint, file.Gears | file.RollingOnCircle | file.Belt):
            continue
        discs = [layout.given.disc(body) for body in joint.discs]
        centres = tuple(disc.centre for disc in discs if disc is not None)
        arms = (body for body in layout.members if body not in joint.discs)
        arm = next((body for body in arms if {*centres} <= {*layout.own(body), *_pivot(layout, body)}), None)
        if arm is None or len(centres) != 2:
            continue
        if isinstance(joint, file.Belt):
            rims, alike = layout.belts[index], not joint.crossed
        else:
            rims = (layout.contacts[index],) * 2
            first, second = (layout.points[rims[0]] - layout.points[name] for name in centres)
            alike = (first.conjugate() * second).real > 0
        yield Pair(arm, (joint.discs[0], joint.discs[1]), (centres[0], centres[1]), rims, alike)


def _pivot(layout: Layout, body: int) -> list[str]:
    centre = layout.centres.get(body)
    return [centre.name] if centre is not None and centre.rule == "pivot" else []


def by_train(derivation: Derivation, what: str = "omega") -> bool:
    """Enter the rotation, `omega` or `eps`, of one more disc from another disc and their arm; return False if none
    follows.
    """
    rate = ids.LINK_RATE[what]
    for pair in pairs(derivation.layout):
        for known_disc, new_disc in permutations(range(2)):
            known, new = pair.discs[known_disc], pair.discs[new_disc]
            rate_known = known == GROUND or derivation.knows(rate(known))
            if rate_known and new != GROUND and derivation.knows(rate(pair.arm)) and not derivation.knows(rate(new)):
                _enter(derivation, what, pair, known_disc)
                return True
    return False


def _enter(derivation: Derivation, what: str, pair: Pair, known_disc: int) -> None:
    """Enter ω₂ = (ω_c (r₂ + r₁) − ω₁ r₁)/r₂ with the senses of the rotations."""
    q, known, new, rate = derivation.q, pair.discs[known_disc], pair.discs[1 - known_disc], ids.LINK_RATE[what]
    radii = [derivation.length(centre, rim) for centre, rim in zip(pair.centres, pair.rims, strict=True)]
    first, second = radii[known_disc], radii[1 - known_disc]
    sense = math.copysign(1.0, derivation.motion.turn(what, new))
    terms: list[Expression] = []
    if arm := derivation.motion.turn(what, pair.arm):
        apart = q.si(second.id) - q.si(first.id) if pair.alike else 1.0
        reach = second + first if not pair.alike else second - first if apart > 0 else first - second
        if abs(apart) > 1e-9:
            terms.append(signed(sense * arm * apart, q[rate(pair.arm)] * reach))
    if driving := derivation.motion.turn(what, known):
        terms.append(signed(sense * driving * (1 if pair.alike else -1), q[rate(known)] * first))
    terms.sort(key=lambda term: isinstance(term, Negative))
    new_rate = q.define(rate(new), total(terms) / second) if terms else q.give(rate(new), 0.0)
    lines, relation = (first.id, second.id, new_rate.id), _relation(what, pair, radii)
    derivation.steps.append(
        Step(f"train-{what}", lines, new, pair.rims[1 - known_disc], frame=pair.arm, system=(relation,))
    )


def _relation(what: str, pair: Pair, radii: list[Ref]) -> Chain:
    """Return (ω₁ − ω_c) r₁ = −(ω₂ − ω_c) r₂ as an equation."""
    rate, sides = ids.LINK_RATE[what], list[Expression]()
    for body, radius in zip(pair.discs, radii, strict=True):
        arm, r = vocabulary.symbol(rate(pair.arm)), vocabulary.symbol(radius.id)
        against = Sum((vocabulary.symbol(rate(body)), Negative(arm)))
        sides.append(Negative(Product((arm, r))) if body == GROUND else Product((against, r)))
    first, second = sides
    if not pair.alike:
        second = second.of if isinstance(second, Negative) else Negative(second)
    return Chain((first, second))


# --- accelerations ----------------------------------------------------------------------------------


def by_rims(parts: Parts) -> bool:
    """Enter ε of one more of two discs with fixed centres, whose rims always move equally; return False if none
    follows.
    """
    derivation, q, layout = parts.derivation, parts.derivation.q, parts.derivation.layout
    for bodies, ends in layout.rims():
        if not layout.turn_on_ground(bodies):
            continue
        for (known, base), (new, point) in permutations(zip(bodies, ends, strict=True)):
            if derivation.knows_epsilon(known) and not derivation.knows_epsilon(new):
                r1, r2 = (
                    derivation.length(layout.centres[disc].name, end) for disc, end in ((known, base), (new, point))
                )
                eps = q.define(ids.angular_acceleration(new), q[ids.angular_acceleration(known)] * r1 / r2)
                derivation.steps.append(Step("acceleration-rims", (r1.id, r2.id, eps.id), new, point, base))
                return True
    return False


class Node(Record):
    """The centre of a disc or a point of contact, with the point whose acceleration it shares along the racks.

    `shares` is the centre itself or a point of the rack; "" on the ground.  `value` is the acceleration along the racks
    (m/s²).
    """

    name: str
    shares: str
    value: float
    known: bool


def by_rack(parts: Parts) -> bool:
    """Enter ε of one more disc, or the acceleration of its centre or of a rack; return False if none follows."""
    for body in parts.derivation.layout.members:
        u = _along(parts, body)
        nodes = [*_nodes(parts, body, u)] if u else []
        for known_node, new_node in permutations(nodes, 2):
            if (
                not known_node.known
                or parts.derivation.layout.points[known_node.name] == parts.derivation.layout.points[new_node.name]
            ):
                continue
            if new_node.known and not parts.derivation.knows_epsilon(body):
                _rate_of_disc(parts, body, u, known_node, new_node)
                return True
            if not new_node.known and parts.derivation.knows_epsilon(body):
                _acceleration_of(parts, body, u, known_node, new_node)
                return True
    return False


def _along(parts: Parts, body: int) -> complex:
    """Return the unit direction of the racks that a disc rolls on; 0 if it rolls on none, or also on other bodies."""
    layout, directions = parts.derivation.layout, []
    for joint in layout.given.joints:
        if isinstance(joint, file.RollingOnLine) and joint.disc == body and joint.on != GROUND:
            rack, u = layout.centres.get(joint.on), layout.geometry.direction(joint)
            if rack is None or rack.rule != "translation" or not rack.by_joint or not parallel(rack.direction, u):
                return 0j
            directions.append(u)
    return directions[0] if directions and all(parallel(u, directions[0]) for u in directions) else 0j


def _nodes(parts: Parts, body: int, u: complex) -> Iterator[Node]:
    layout = parts.derivation.layout
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
    value = (u.conjugate() * parts.derivation.motion.a(shares)).real
    vectors = parts.of.get(shares)
    return Node(name, shares, value, vectors is not None and len(vectors) < 2)


def _size(parts: Parts, node: Node) -> Ref | None:
    """Return the magnitude of a node's acceleration; None if it is zero."""
    vectors = parts.derivation.nonzero(*parts.of[node.shares]) if node.shares else ()
    return parts.derivation.q[vectors[0].id] if vectors else None


def _turn(parts: Parts, u: complex, node: Node, far_node: Node) -> float:
    """Return the distance (m) of the far node from the near one across the racks, with the sign of what ε adds along
    them.
    """
    points = parts.derivation.layout.points
    return (u.conjugate() * 1j * (points[far_node.name] - points[node.name])).real


def _rate_of_disc(parts: Parts, body: int, u: complex, node: Node, far_node: Node) -> None:
    derivation, q = parts.derivation, parts.derivation.q
    sense = math.copysign(1.0, derivation.motion.epsilon(body)) * math.copysign(1.0, _turn(parts, u, node, far_node))
    sizes = ((_size(parts, far_node), far_node.value), (_size(parts, node), -node.value))
    terms = [signed(sense * value, size) for size, value in sizes if size is not None]
    arm, id = derivation.length(node.name, far_node.name), ids.angular_acceleration(body)
    eps = q.define(id, _sum(terms) / arm) if terms else q.give(id, 0.0)
    derivation.steps.append(Step("acceleration-rack", (arm.id, eps.id), body, far_node.name, node.name))


def _acceleration_of(parts: Parts, body: int, u: complex, node: Node, far_node: Node) -> None:
    derivation, q = parts.derivation, parts.derivation.q
    id, eps = ids.acceleration(far_node.shares), ids.angular_acceleration(body)
    sense, size = math.copysign(1.0, far_node.value), _size(parts, node)
    terms = [signed(sense * node.value, size)] if size is not None else []
    arm = derivation.length(node.name, far_node.name)
    if q.si(eps):
        turning = derivation.motion.epsilon(body) * _turn(parts, u, node, far_node)
        terms.append(signed(sense * turning, q[eps] * arm))
    parts.of[far_node.shares] = (Vector(id, sense * u),) if far_node.value else ()
    if id in q:
        # These cases belong to the equations of motion.
        return
    a = q.define(id, _sum(terms)) if terms else q.give(id, 0.0)
    derivation.steps.append(Step("acceleration-rack-point", (arm.id, a.id), body, far_node.shares, node.name))


def _sum(terms: list[Expression]) -> Expression:
    return total(sorted(terms, key=lambda term: isinstance(term, Negative)))
