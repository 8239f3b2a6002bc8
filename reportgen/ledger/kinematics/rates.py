"""Velocities and accelerations of the point where the two sides of a group's equations meet."""

from __future__ import annotations

from reportgen.ledger.kinematics.linkage import NOWHERE, POLES, Kinematics, What
from reportgen.ledger.kinematics.sides import Side, image
from reportgen.notation.expressions import Expression, Symbol, cross, meet, quotient, sign, turned
from reportgen.notation.symbols import on_plan, segment


def velocity(k: Kinematics, one: Side, two: Side) -> None:
    """v_M = v_P + v_MP, each side with one unknown size along a known direction: two lines meet in m."""
    for side in (one, two):
        _guide_point(k, "v", side)
    start1, start2 = _start(k, "v", one), _start(k, "v", two)
    k.vertex("v", image(one.point), meet(start1, _sought(k, one), start2, _sought(k, two)))
    for side in (one, two):
        if not side.still:
            _relative_velocity(k, side)
    k.absolute("v", one.point)
    for side in (one, two):
        if side.still and (side.turns or side.turning):
            # Relative to a fixed point the velocity is the velocity itself.
            _enter_relative(k, side, k.q[f"v.{side.point}"])


def acceleration(k: Kinematics, one: Side, two: Side) -> None:
    """a_M = a_P + aⁿ_MP + aᵗ_MP or a_G + aᵏ_MG + aʳ_MG: known vectors first, then two lines meet in m′."""
    for side in (one, two):
        _guide_point(k, "a", side)
    starts = [_known_acceleration(k, side) for side in (one, two)]
    crossing = meet(starts[0], _sought(k, one), starts[1], _sought(k, two))
    k.vertex("a", image(one.point), crossing)
    same_letter = one.part == two.part
    for side, start in zip((one, two), starts, strict=True):
        _unknown_acceleration(k, side, start, same_letter)
    k.absolute("a", one.point)


def _guide_point(k: Kinematics, what: What, side: Side) -> None:
    """The point of a moving guide's link that lies under the sliding point."""
    if side.carrier is not None and not side.still:
        arm = k.place(side.point) - k.place(k.links[side.carrier].origin)
        k.vertex(what, image(side.base), k.image_at(what, side.carrier, arm))
        k.absolute(what, side.base)


def _start(k: Kinematics, what: What, side: Side) -> Expression:
    return NOWHERE if side.still else k.image(what, side.base)


def _sought(k: Kinematics, side: Side) -> Expression:
    """The direction of the unknown velocity or acceleration of a side."""
    return turned(k.q[f"rod.{side.link}"]) if side.turns else k.q[side.along]


def _along(k: Kinematics, side: Side) -> Expression:
    """The relative velocity on the plan, from the base's image to the point's."""
    return k.q[f"plan.v.{image(side.point)}"] - _start(k, "v", side)


def _symbol(base: str, side: Side, sup: str = "") -> Symbol:
    return Symbol(base, side.pair, sup)


def _relative_velocity(k: Kinematics, side: Side) -> None:
    """The velocity of the point relative to its base, and ω of the link that turns with it."""
    id = f"seg.v.{image(side.base)}{image(side.point)}"
    drawn = k.segment(id, on_plan(side.base), on_plan(side.point), _along(k, side), "v")
    _enter_relative(k, side, k.q["mu.v"] * drawn)


def _enter_relative(k: Kinematics, side: Side, definition: Expression) -> None:
    q, sizes = k.q, k.sizes
    relative = q.define(f"v.{side.relative}", definition, _symbol("v", side), scale=sizes.velocity)
    if side.turns:
        size, rotation = relative / q[f"l.{side.rod}"], f"omega.{side.link}"
        omega = q.define(rotation, size, scale=sizes.rotation)
        sense = sign(cross(q[f"rod.{side.link}"], _along(k, side)))
        q.define(f"turn.{rotation}", omega * sense, scale=sizes.rotation, of=rotation)


def _known_acceleration(k: Kinematics, side: Side) -> Expression:
    """Enter aⁿ = v²/l towards the base, or aᵏ = 2ω v_r square to v_r; gives where the unknown part starts."""
    q, start, part = k.q, _start(k, "a", side), side.part
    if not part:
        return start
    name, relative = f"{part}.{side.relative}", q[f"v.{side.relative}"]
    formula = relative**2 / q[f"l.{side.rod}"] if side.turns else 2 * q[f"omega.{side.turning}"] * relative
    known = q.define(f"a.{side.relative}.{part}", formula, _symbol("a", side, part), scale=k.sizes.acceleration)
    first = Symbol(POLES["a"]) if side.still else on_plan(side.base, True)
    last = Symbol(part, side.pair)
    drawn = q.define(f"seg.a.{name}", known / q["mu.a"], segment(first, last), scale=k.paper("a"))
    if side.turns:
        return k.vertex("a", name, start - drawn * (q[f"rod.{side.link}"] / q[f"l.{side.rod}"]))
    # The relative velocity turned by 90° in the sense of ω.
    across = turned(quotient(_along(k, side), relative / q["mu.v"]))
    return k.vertex("a", name, start + drawn * sign(k.omega(side.turning)) * across)


def _unknown_acceleration(k: Kinematics, side: Side, start: Expression, same_letter: bool) -> None:
    """The tangential or sliding part, from the end of what is known to the point's image; ε of a turning link.

    Where the known parts of both sides have the `same_letter`, n or k, their ends are told apart by their vectors.
    """
    if not side.sought:
        return
    q, relative = k.q, side.relative
    part, sup = side.sought, "τ" if side.turns else "r"
    along = q[f"plan.a.{image(side.point)}"] - start
    begin, end = Symbol(side.part), on_plan(side.point, True)
    if not begin.base:
        begin = on_plan(side.base, True)
    elif same_letter:
        begin, end = end, Symbol(begin.base, side.pair)
    drawn = k.segment(f"seg.a.{part}.{relative}", begin, end, along, "a")
    size = q["mu.a"] * drawn
    sought = q.define(f"a.{relative}.{part}", size, _symbol("a", side, sup), scale=k.sizes.acceleration)
    if side.turns:
        rotation, scale = f"eps.{side.link}", k.sizes.rotation**2
        eps = q.define(rotation, sought / q[f"l.{side.rod}"], scale=scale)
        sense = sign(cross(q[f"rod.{side.link}"], along))
        q.define(f"turn.{rotation}", eps * sense, scale=scale, of=rotation)
