"""Ledger entries for the two sides of a group's vector equations: velocities, then accelerations.

Both follow from two expressions for the motion of the point where the group's two sides meet (`equation_sides`).
"""

from __future__ import annotations

from reportgen.derivation.equation_sides import Side, image
from reportgen.derivation.kinematic_entries import NOWHERE, POLES, Kinematics, What
from reportgen.formula import Expression, Symbol, cross, ids, meet, sign, turned, unit
from reportgen.formula.vocabulary import on_plan, segment


def velocity(k: Kinematics, first: Side, second: Side) -> None:
    """Solve v_M = v_P + v_MP, each side with one unknown size along a known direction: the second lines meet in m."""
    for side in (first, second):
        guide_point(k, "v", side)
    start1, start2 = start_of(k, "v", first), start_of(k, "v", second)
    k.vertex("v", image(first.point), meet(start1, sought(k, first), start2, sought(k, second)))
    for side in (first, second):
        if not side.still:
            relative_velocity(k, side)
    k.absolute("v", first.point)
    for side in (first, second):
        if side.still and (side.turns or side.turning):
            # Relative to a fixed point the velocity is the velocity itself.
            enter_relative(k, side, k.q[ids.velocity(side.point)])


def acceleration(k: Kinematics, first: Side, second: Side) -> None:
    """Solve a_M = a_P + aⁿ_MP + aᵗ_MP or a_G + aᵏ_MG + aʳ_MG: known vectors first, then second lines meet in m′."""
    for side in (first, second):
        guide_point(k, "a", side)
    starts = [known_acceleration(k, side) for side in (first, second)]
    crossing = meet(starts[0], sought(k, first), starts[1], sought(k, second))
    k.vertex("a", image(first.point), crossing)
    same_letter = first.part == second.part
    for side, start in zip((first, second), starts, strict=True):
        unknown_acceleration(k, side, start, same_letter)
    k.absolute("a", first.point)


def guide_point(k: Kinematics, what: What, side: Side) -> None:
    """Enter the point of a moving guide's link that lies under the sliding point."""
    if side.carrier is not None and not side.still:
        arm = k.place(side.point) - k.place(k.links[side.carrier].origin)
        k.vertex(what, image(side.base), k.image_at(what, side.carrier, arm))
        k.absolute(what, side.base)


def start_of(k: Kinematics, what: What, side: Side) -> Expression:
    return NOWHERE if side.still else k.image(what, side.base)


def sought(k: Kinematics, side: Side) -> Expression:
    """Return the direction of the unknown velocity or acceleration of a side."""
    return turned(k.q[ids.rod(side.link)]) if side.turns else k.q[side.along]


def _along(k: Kinematics, side: Side) -> Expression:
    """Return the relative velocity on the plan, from the base's image to the point's."""
    return k.q[ids.plan_point("v", image(side.point))] - start_of(k, "v", side)


def _symbol(base: str, side: Side, sup: str = "") -> Symbol:
    return Symbol(base, side.pair, sup)


def relative_velocity(k: Kinematics, side: Side) -> None:
    """Enter the velocity of the point relative to its base, and ω of the link that turns with it."""
    id = ids.segment("v", image(side.base), image(side.point))
    drawn = k.segment(id, on_plan(side.base), on_plan(side.point), _along(k, side), "v")
    enter_relative(k, side, k.q["mu.v"] * drawn)


def enter_relative(k: Kinematics, side: Side, definition: Expression) -> None:
    q, sizes = k.q, k.sizes
    relative = q.define(ids.velocity(side.relative), definition, _symbol("v", side), scale=sizes.velocity)
    if side.turns:
        size, rotation = relative / q[ids.length(side.rod)], ids.angular_velocity(side.link)
        omega = q.define(rotation, size, scale=sizes.rotation)
        sense = sign(cross(q[ids.rod(side.link)], _along(k, side)))
        q.define(ids.signed("omega", side.link), omega * sense, scale=sizes.rotation, of=rotation)


def known_acceleration(k: Kinematics, side: Side) -> Expression:
    """Enter aⁿ = v²/l towards the base, or aᵏ = 2ω v_r square to v_r; return the start of the unknown part."""
    q, start, part = k.q, start_of(k, "a", side), side.part
    if not part:
        return start
    corner, relative = ids.relative_corner(part, side.relative), q[ids.velocity(side.relative)]
    formula = (
        relative**2 / q[ids.length(side.rod)] if side.turns else 2 * q[ids.angular_velocity(side.turning)] * relative
    )
    known = q.define(
        ids.acceleration(side.relative, part), formula, _symbol("a", side, part), scale=k.sizes.acceleration
    )
    first = Symbol(POLES["a"]) if side.still else on_plan(side.base, True)
    last = Symbol(part, side.pair)
    drawn = q.define(
        ids.relative_segment(part, side.relative), known / q["mu.a"], segment(first, last), scale=k.paper("a")
    )
    if side.turns:
        laid: Expression = -(drawn * unit(q[ids.rod(side.link)]))
    else:
        # The relative velocity turned by 90° in the sense of ω.
        laid = drawn * sign(k.omega(side.turning)) * turned(unit(_along(k, side)))
    return k.vertex("a", corner, start + q.construct(ids.laid("a", corner), laid))


def unknown_acceleration(k: Kinematics, side: Side, start: Expression, same_letter: bool) -> None:
    """Enter the tangential or sliding part, from the end of the known parts to the point's image; and ε of a
    turning link.

    If the known parts of both sides have the `same_letter`, n or k, their ends are distinguished by their vectors.
    """
    if not side.sought:
        return
    q, relative = k.q, side.relative
    part, sup = side.sought, "τ" if side.turns else "r"
    along = q[ids.plan_point("a", image(side.point))] - start
    begin, end = Symbol(side.part), on_plan(side.point, True)
    if not begin.base:
        begin = on_plan(side.base, True)
    elif same_letter:
        begin, end = end, Symbol(begin.base, side.pair)
    drawn = k.segment(ids.relative_segment(part, relative), begin, end, along, "a")
    size = q["mu.a"] * drawn
    tangential = q.define(ids.acceleration(relative, part), size, _symbol("a", side, sup), scale=k.sizes.acceleration)
    if side.turns:
        rotation, scale = ids.angular_acceleration(side.link), k.sizes.rotation**2
        eps = q.define(rotation, tangential / q[ids.length(side.rod)], scale=scale)
        sense = sign(cross(q[ids.rod(side.link)], along))
        q.define(ids.signed("eps", side.link), eps * sense, scale=scale, of=rotation)
