"""Positions, velocities and accelerations as a plan solves them: definitions from the dyad kinds alone.

Ids: `p.B` a point; `drawn.AB` its drawn length; `seg.v.pb`, `seg.v.ab` segments of the velocity plan;
`v.B`, `v.BA`, `omega.2`; likewise `seg.a…`, `a.B`, `a.BA.n`, `a.BA.t`, `a.BA.k`, `a.BA.r`, `eps.2`.  Sizes
are positive; a signed angular velocity is `turn.omega.2` (anticlockwise positive).  Plan points `plan.v.b`,
`plan.a.b` are metres on paper.  Directions of guides and slots are `guide.3`, `slot.3`.  Ids of `centres` begin
with `ic.`.

Expected from the machine: lengths `l.AB` (else entered as given), and of a crank its angle `phi.1`, its
angular velocity `omega.1` and its drawn length `drawn.O1A`; of a sliding driver its coordinate `s.1` and the
speed `v.A` of its pin.
"""

from __future__ import annotations

import cmath
from collections.abc import Callable, Mapping, Sequence

from reportgen.derivation.equation_sides import Side, image, scheme, sides
from reportgen.derivation.kinematic_entries import (
    NOWHERE,
    POLES,
    Kinematics,
    PlacedLink,
    What,
    chosen_scale,
    crank,
    enter_centres,
    slide,
)
from reportgen.formula import (
    Expression,
    Symbol,
    call,
    circle_circle,
    circle_line,
    cross,
    ids,
    meet,
    quotient,
    sign,
    sqrt,
    turned,
    unit,
    vocabulary,
)
from reportgen.formula.calculation import Calculation
from reportgen.formula.vocabulary import drawn_length, on_plan, segment
from reportgen.machine import DRIVER, Crank, Dyad, DyadKind, Guide, Linkage, LinkPoint, under


def enter_kinematics(
    q: Calculation, linkage: Linkage, turn: int, worked: Sequence[int] = (), sense: int = 1, scaled: bool = True
) -> None:
    """Enter every kinematic quantity of a linkage, link by link in order of assembly.

    An accelerated driver runs faster with the `sense` +1, slower with −1; then `eps.1` or `a.A` is already entered.

    The plans are first solved on trial to find the scales at which those of the `worked` positions, counted from 1,
    fill their paper (those of all positions if none is named). If they are not `scaled`, the trial is skipped.
    """
    if not scaled:
        _enter(q, linkage, turn, sense)
        return
    trial = _enter(q.copy(), linkage, turn, sense)
    _enter(q, linkage, turn, sense, {what: chosen_scale(trial, what, worked) for what in ("v", "a")})


def _enter(
    q: Calculation, linkage: Linkage, turn: int, sense: int, scales: Mapping[str, float | None] | None = None
) -> Kinematics:
    for name, at in linkage.ground.items():
        # The machine has already placed the points that follow from given lengths.
        if ids.place(name) not in q:
            q.give(ids.place(name), complex(at), vocabulary.point(name), "length")
    plan = scheme(linkage)
    if isinstance(linkage.driver, Crank):
        k = crank(q, plan, linkage.driver, turn, sense, scales or {})
    else:
        k = slide(q, plan, linkage.driver, turn, sense, scales or {})
        places(k, DRIVER, None)
        for what in ("v", "a"):
            images(k, what, DRIVER, None)
    for dyad in linkage.dyads:
        group(k, dyad)
    enter_centres(k)
    return k


# --- a group's kinematics, kind by kind -----------------------------------------------------------
# Where its links lie, velocities and accelerations, the points of its links.
# Both follow from two vector equations for the point where the group's two sides meet (`sides`).


def velocity(k: Kinematics, first: Side, second: Side) -> None:
    """Solve v_M = v_P + v_MP, each side with one unknown size along a known direction: the second lines meet in m."""
    for side in (first, second):
        _guide_point(k, "v", side)
    start1, start2 = _start(k, "v", first), _start(k, "v", second)
    k.vertex("v", image(first.point), meet(start1, _sought(k, first), start2, _sought(k, second)))
    for side in (first, second):
        if not side.still:
            _relative_velocity(k, side)
    k.absolute("v", first.point)
    for side in (first, second):
        if side.still and (side.turns or side.turning):
            # Relative to a fixed point the velocity is the velocity itself.
            _enter_relative(k, side, k.q[ids.velocity(side.point)])


def acceleration(k: Kinematics, first: Side, second: Side) -> None:
    """Solve a_M = a_P + aⁿ_MP + aᵗ_MP or a_G + aᵏ_MG + aʳ_MG: known vectors first, then second lines meet in m′."""
    for side in (first, second):
        _guide_point(k, "a", side)
    starts = [_known_acceleration(k, side) for side in (first, second)]
    crossing = meet(starts[0], _sought(k, first), starts[1], _sought(k, second))
    k.vertex("a", image(first.point), crossing)
    same_letter = first.part == second.part
    for side, start in zip((first, second), starts, strict=True):
        _unknown_acceleration(k, side, start, same_letter)
    k.absolute("a", first.point)


def _guide_point(k: Kinematics, what: What, side: Side) -> None:
    """Enter the point of a moving guide's link that lies under the sliding point."""
    if side.carrier is not None and not side.still:
        arm = k.place(side.point) - k.place(k.links[side.carrier].origin)
        k.vertex(what, image(side.base), k.image_at(what, side.carrier, arm))
        k.absolute(what, side.base)


def _start(k: Kinematics, what: What, side: Side) -> Expression:
    return NOWHERE if side.still else k.image(what, side.base)


def _sought(k: Kinematics, side: Side) -> Expression:
    """Return the direction of the unknown velocity or acceleration of a side."""
    return turned(k.q[ids.rod(side.link)]) if side.turns else k.q[side.along]


def _along(k: Kinematics, side: Side) -> Expression:
    """Return the relative velocity on the plan, from the base's image to the point's."""
    return k.q[ids.plan_point("v", image(side.point))] - _start(k, "v", side)


def _symbol(base: str, side: Side, sup: str = "") -> Symbol:
    return Symbol(base, side.pair, sup)


def _relative_velocity(k: Kinematics, side: Side) -> None:
    """Enter the velocity of the point relative to its base, and ω of the link that turns with it."""
    id = ids.segment("v", image(side.base), image(side.point))
    drawn = k.segment(id, on_plan(side.base), on_plan(side.point), _along(k, side), "v")
    _enter_relative(k, side, k.q["mu.v"] * drawn)


def _enter_relative(k: Kinematics, side: Side, definition: Expression) -> None:
    q, sizes = k.q, k.sizes
    relative = q.define(ids.velocity(side.relative), definition, _symbol("v", side), scale=sizes.velocity)
    if side.turns:
        size, rotation = relative / q[ids.length(side.rod)], ids.angular_velocity(side.link)
        omega = q.define(rotation, size, scale=sizes.rotation)
        sense = sign(cross(q[ids.rod(side.link)], _along(k, side)))
        q.define(ids.signed("omega", side.link), omega * sense, scale=sizes.rotation, of=rotation)


def _known_acceleration(k: Kinematics, side: Side) -> Expression:
    """Enter aⁿ = v²/l towards the base, or aᵏ = 2ω v_r square to v_r; return the start of the unknown part."""
    q, start, part = k.q, _start(k, "a", side), side.part
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


def _unknown_acceleration(k: Kinematics, side: Side, start: Expression, same_letter: bool) -> None:
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
    sought = q.define(ids.acceleration(relative, part), size, _symbol("a", side, sup), scale=k.sizes.acceleration)
    if side.turns:
        rotation, scale = ids.angular_acceleration(side.link), k.sizes.rotation**2
        eps = q.define(rotation, sought / q[ids.length(side.rod)], scale=scale)
        sense = sign(cross(q[ids.rod(side.link)], along))
        q.define(ids.signed("eps", side.link), eps * sense, scale=scale, of=rotation)


OFF_LINE = 1e-9
"""A point counts as on the line of a link's joints if its distance from the line is below this share of its distance
from the origin.
"""


def group(k: Kinematics, dyad: Dyad) -> None:
    """Enter the places, velocities and accelerations of a group and of the points of its links."""
    both = sides(k.scheme, dyad)
    PLACES[dyad.kind](k, dyad)
    turns = {link: _turn_of(link, both) for link in dyad.links}
    for link, turn in turns.items():
        places(k, link, turn)
    _motion(k, dyad, "v", turns, lambda: velocity(k, *both))
    _motion(k, dyad, "a", turns, lambda: acceleration(k, *both))


def _motion(k: Kinematics, dyad: Dyad, what: What, turns: Mapping[int, Side | None], solve: Callable[[], None]) -> None:
    solve()
    for link in dyad.links:
        k.share_rotation(what, link)
    if dyad.kind == "RPP":
        _middle_of_rpp(k, dyad, what)
    for link, turn in turns.items():
        images(k, what, link, turn)


def _pin(end: str | Guide) -> str:
    assert isinstance(end, str)
    return end


def _guide(end: str | Guide) -> Guide:
    assert isinstance(end, Guide)
    return end


def _rod(k: Kinematics, link: int, start: str, middle: str) -> None:
    """Enter a rod of fixed length from an outer joint to the inner one; its unit axis, if it carries a guide."""
    rod = k.q.construct(ids.rod(link), k.place(middle) - k.place(start))
    ends = (end for dyad in k.scheme.linkage.dyads for end in (dyad.start, dyad.end))
    carries = any(isinstance(end, Guide) and end.link == link for end in ends)
    k.put(link, start, k.q.construct(ids.link_axis(link), unit(rod)) if carries else None, middle)


def _rrr(k: Kinematics, dyad: Dyad) -> None:
    start, end, middle = _pin(dyad.start), _pin(dyad.end), dyad.middle
    k.length(start, middle, dyad.lengths[0])
    k.length(end, middle, dyad.lengths[1])
    first, second = k.drawn(start, middle), k.drawn(end, middle)
    k.q.construct(ids.place(middle), circle_circle(k.place(start), first, k.place(end), second, float(dyad.sign)))
    _rod(k, dyad.links[0], start, middle)
    _rod(k, dyad.links[1], end, middle)


def _rrp(k: Kinematics, dyad: Dyad) -> None:
    start, middle = _pin(dyad.start), dyad.middle
    i, j = dyad.links
    at, along = k.guide(j, _guide(dyad.end))
    k.length(start, middle, dyad.lengths[0])
    length = k.drawn(start, middle)
    k.q.construct(ids.place(middle), circle_line(k.place(start), length, at, along, float(dyad.sign)))
    _rod(k, i, start, middle)
    k.put(j, middle, along)


def _rpr(k: Kinematics, dyad: Dyad) -> None:
    """Place the slot's line as a tangent from P to the circle of radius e about T: u = TP/(s + i e)."""
    start, end, middle = _pin(dyad.start), _pin(dyad.end), dyad.middle
    i, j = dyad.links
    q, offset, mu = k.q, dyad.lengths[1], k.q["mu.l"]
    q.construct(ids.place(middle), k.place(start))
    rod = q.construct(ids.rod(j), k.place(start) - k.place(end))
    drawn = q.define(ids.drawn(end, middle), abs(rod) / q["drawing"], drawn_length(end, middle), scale=k.span())
    q.define(ids.length(end, middle), mu * drawn)
    along: Expression = float(dyad.sign) * abs(rod)
    if offset:
        e = k.length(end, f"H{j}", abs(offset))
        reach = sqrt(call("max", 0.0, abs(rod) ** 2 - e**2))
        along = float(dyad.sign) * reach + (1.0 if offset > 0 else -1.0) * turned(e)
    slot = q.construct(ids.slot(j), rod / along)
    k.put(i, start, slot)
    k.put(j, end, slot, middle)


def _prp(k: Kinematics, dyad: Dyad) -> None:
    (at1, along1), (at2, along2) = (
        k.guide(link, _guide(end)) for link, end in zip(dyad.links, (dyad.start, dyad.end), strict=True)
    )
    k.q.construct(ids.place(dyad.middle), meet(at1, along1, at2, along2))
    for link, along in zip(dyad.links, (along1, along2), strict=True):
        k.put(link, dyad.middle, along)


def _rpp(k: Kinematics, dyad: Dyad) -> None:
    start, middle = _pin(dyad.start), dyad.middle
    i, j = dyad.links
    at, along = k.guide(j, _guide(dyad.end))
    slot = k.q.construct(ids.slot(j), along * k.constant(ids.slot_on_link(j), cmath.exp(1j * dyad.slide_angle)))
    k.q.construct(ids.place(middle), meet(at, along, k.place(start), slot))
    k.q.construct(ids.place(under(start, j, k.scheme.owner)), k.place(start))
    k.put(i, start, along)
    k.put(j, middle, along)


def _middle_of_rpp(k: Kinematics, dyad: Dyad, what: What) -> None:
    """Enter the guided point Q of link j, from the point of j under P: they differ by j's rotation only."""
    middle, (_, j) = dyad.middle, dyad.links
    known = under(_pin(dyad.start), j, k.scheme.owner)
    arm = k.place(middle) - k.place(known)
    placed = k.links[j]
    k.put(j, known, placed.axis)
    k.vertex(what, image(middle), k.image_at(what, j, arm))
    k.links[j] = placed
    k.absolute(what, middle)


PLACES: Mapping[DyadKind, Callable[[Kinematics, Dyad], None]] = {
    "RRR": _rrr,
    "RRP": _rrp,
    "RPR": _rpr,
    "PRP": _prp,
    "RPP": _rpp,
}


# --- points of links --------------------------------------------------------------------------------


def _points(k: Kinematics, link: int) -> tuple[LinkPoint, ...]:
    """Return the named points of a link besides its joints."""
    return tuple(place for place in k.scheme.linkage.points if place.link == link)


def _off_line(point: LinkPoint) -> bool:
    """Return True if a point forms a triangle with its link's joints."""
    return abs(point.local.imag) > OFF_LINE * abs(point.local)


def _turn_of(link: int, sides: tuple[Side, Side]) -> Side | None:
    """Return the side that a link turns on, None for one that slides."""
    return next((side for side in sides if side.turns and side.link == link), None)


def places(k: Kinematics, link: int, turn: Side | None) -> None:
    """Enter the places of a link's named points besides its joints.

    On a rod their axis is the line of the rod, otherwise the axis of the link's frame; `turn` is the side that the link
    turns on, None for a link that slides.
    """
    q, placed = k.q, k.links[link]
    for point in _points(k, link):
        x, y = point.local.real, point.local.imag
        k.distance(placed.origin, point.name, x, y)
        angle = k.constant(ids.point_turn(point.name), cmath.exp(1j * cmath.phase(point.local)) if point.local else 1)
        if turn is not None and not turn.measured:
            if _off_line(point):
                k.distance(turn.point, point.name, x, y, q[ids.length(turn.rod)])
            axis: Expression = unit(q[ids.rod(link)])
        else:
            axis = k.axis(link)
        length = k.drawn(placed.origin, point.name)
        q.construct(ids.place(point.name), k.place(placed.origin) + length * angle * axis)


def images(k: Kinematics, what: What, link: int, turn: Side | None) -> None:
    """Enter velocities or accelerations of a link's named points besides its joints.

    They follow by similarity if the link turns on a side (`turn`), otherwise from its rotation, or are those of its
    origin if it does not rotate.
    """
    placed = k.links[link]
    for point in _points(k, link):
        if turn is not None:
            _by_similarity(k, what, point, turn)
        elif placed.omega is not None:
            _by_rotation(k, what, point, placed)
        else:
            _by_translation(k, what, point, placed)


def _by_similarity(k: Kinematics, what: What, point: LinkPoint, turn: Side) -> None:
    """Enter a point by the similarity theorem: the figure in the plan is similar to that of the link, with the same
    sense.
    """
    q, base, tip = k.q, turn.base, turn.point
    first, last, new = "p" if turn.still else image(base), image(tip), image(point.name)
    along = k.image(what, tip) - k.image(what, base)
    ratio = q[ids.length(base, point.name)] / q[ids.length(turn.rod)]
    angle = q[ids.point_turn(point.name)]
    if turn.measured:
        id = ids.similar(point.name)
        if id not in q:
            q.construct(id, angle * quotient(k.axis(point.link), unit(q[ids.rod(point.link)])))
        angle = q[id]
    whole = ids.segment(what, first, last)
    letters = k.letter(what, base), on_plan(tip, what == "a")
    if whole not in q:
        k.segment(whole, *letters, along, what)
    target = on_plan(point.name, what == "a")
    part = q.define(ids.segment(what, first, new), ratio * q[whole], segment(letters[0], target))
    laid = q.construct(ids.laid(what, f"{first}{new}"), ratio * angle * along, of=part.id)
    k.vertex(what, new, k.image(what, base) + laid)
    if _off_line(point) and not turn.measured:
        leg_ratio = q[ids.length(tip, point.name)] / q[ids.length(turn.rod)]
        q.define(ids.segment(what, last, new), leg_ratio * q[whole], segment(letters[1], target))
    k.absolute(what, point.name)


def _by_rotation(k: Kinematics, what: What, point: LinkPoint, placed: PlacedLink) -> None:
    """Enter v_E = v_O + ω l_OE, a_E = a_O + ω² l_OE + ε l_OE, as the link turns about its origin."""
    q, name, link = k.q, point.name, point.link
    length, relative = q[ids.length(placed.origin, name)], f"{name}{placed.origin}"
    if point.local:
        omega, size = q[ids.angular_velocity(link)], k.sizes.of(what)
        if what == "v":
            q.define(ids.velocity(relative), omega * length, scale=size)
        else:
            q.define(ids.acceleration(relative, "n"), omega**2 * length, scale=size)
            if placed.eps is not None:
                q.define(ids.acceleration(relative, "t"), q[ids.angular_acceleration(link)] * length, scale=size)
    arm = k.place(name) - k.place(placed.origin)
    k.vertex(what, image(name), k.image_at(what, link, arm))
    k.absolute(what, name)


def _by_translation(k: Kinematics, what: What, point: LinkPoint, placed: PlacedLink) -> None:
    """Enter a point of a link that does not turn: all its points have one velocity and one acceleration."""
    q, name = k.q, point.name
    plan = k.vertex(what, image(name), k.image(what, placed.origin))
    k.segment(ids.segment(what, "p", image(name)), Symbol(POLES[what]), on_plan(name, what == "a"), abs(plan), what)
    rate = ids.POINT_RATE[what]
    same = NOWHERE if k.scheme.still(placed.origin) else q[rate(placed.origin)]
    q.define(rate(name), same, scale=k.sizes.of(what))
    k.direction(what, name)
